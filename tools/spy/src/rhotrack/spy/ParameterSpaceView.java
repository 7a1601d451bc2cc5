// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.geom.Ellipse2D;
import java.awt.geom.Line2D;
import java.awt.geom.Rectangle2D;
import java.util.Comparator;
import java.util.List;
import java.util.Locale;
import javax.swing.JComponent;

import rhotrack.spy.scene.DisplayedTrack;
import rhotrack.spy.scene.Geometry;
import rhotrack.spy.scene.LookHistory;
import rhotrack.spy.scene.Scene;

/**
 * The parameter space of theta and rho: the candidates of the last searches, or an accumulator's
 * votes, and the lines of the tracks.
 */
@SuppressWarnings("serial") // views are never serialised
final class ParameterSpaceView extends JComponent {
    private static final int LEFT = 66;
    private static final int RIGHT = 16;
    private static final int TOP = 34;
    private static final int BOTTOM = 40;
    /** Most labels, for the best candidates: the others are many and mostly clutter. */
    private static final int MAX_LABELS = 12;
    private static final double LABEL_GAP = 9;
    private static final double RING = 8;
    private static final String[] THETAS = {"0", "\u03c0/4", "\u03c0/2", "3\u03c0/4", "\u03c0"};

    private final ViewOptions options;
    private Scene scene;
    private double rhoLimit;

    ParameterSpaceView(ViewOptions options) {
        this.options = options;
        setPreferredSize(new Dimension(420, 400));
    }

    void show(Scene newScene) {
        scene = newScene;
        repaint();
    }

    @Override
    protected void paintComponent(Graphics graphics) {
        Graphics2D g = (Graphics2D) graphics.create();
        Palette.enableAntialiasing(g);
        g.setColor(Palette.BACKGROUND);
        g.fillRect(0, 0, getWidth(), getHeight());
        g.setFont(Palette.BOLD);
        g.setColor(Palette.TEXT);
        Scene.Accumulator search = scene != null && options.shows(ViewOptions.Layer.VOTES)
                ? newestSearch() : null;
        g.drawString(search != null ? AccumulatorLayer.title(search) : "Parameter space", 14, 21);
        String note = search != null
                ? "\u25cb peak \u2002 \u25cf new track"
                : "speed \u00b7 scans hit \u2002 \u25cb track";
        g.setFont(Palette.SMALL);
        g.setColor(Palette.MUTED);
        g.drawString(note, getWidth() - RIGHT - g.getFontMetrics().stringWidth(note), 21);
        if (scene != null) {
            updateRhoLimit();
            if (search != null) {
                rhoLimit = Math.max(-search.rhoMin(), search.rhoMax());
                AccumulatorLayer.paintPlane(g, scene, search, this::screenX, this::screenY);
            }
            paintAxes(g);
            LabelPlacer labels = new LabelPlacer(getWidth(), getHeight() - BOTTOM);
            labels.blockArea(0, 0, LEFT, getHeight());
            labels.blockArea(0, 0, getWidth(), TOP);
            if (search != null) {
                AccumulatorLayer.paintCells(g, search, this::screenX, this::screenY, labels);
            } else {
                paintTracks(g, labels);
                paintPeaks(g, labels);
            }
        }
        g.dispose();
    }

    /** The newest accumulator of all pairs of sensors together; null where none is shown. */
    private Scene.Accumulator newestSearch() {
        return scene.internals().accumulators().stream()
                .filter(search -> !search.which().hasPair())
                .max(Comparator.comparingInt(Scene.Accumulator::scan))
                .orElse(null);
    }

    /**
     * Adapts the rho axis to the data: it grows at once, but shrinks only to a third, so that it
     * does not change with every scan.
     */
    private void updateRhoLimit() {
        double largest = 100;
        for (LookHistory.Faded<Scene.Peaks> list : scene.peaks()) {
            for (Scene.Peak peak : list.content().peaks()) {
                largest = Math.max(largest, Math.abs(peak.rho()));
            }
        }
        for (DisplayedTrack track : scene.tracks()) {
            largest = Math.max(largest, Math.hypot(track.place().x(), track.place().y()));
        }
        if (largest > rhoLimit || largest < rhoLimit / 3) {
            rhoLimit = 1.15 * largest;
        }
    }

    private double screenX(double theta) {
        return LEFT + theta / Math.PI * (getWidth() - LEFT - RIGHT);
    }

    private double screenY(double rho) {
        double middle = (TOP + getHeight() - BOTTOM) / 2.0;
        return middle - rho / rhoLimit * (getHeight() - TOP - BOTTOM) / 2.0;
    }

    private void paintAxes(Graphics2D g) {
        double bottom = getHeight() - BOTTOM;
        g.setStroke(Palette.THIN);
        g.setFont(Palette.SMALL);
        for (int i = 0; i < THETAS.length; i++) {
            double x = screenX(i * Math.PI / 4);
            g.setColor(Palette.GRID);
            g.draw(new Line2D.Double(x, TOP, x, bottom));
            drawCentred(g, THETAS[i], x, bottom + 15);
        }
        drawCentred(g, "\u03b8, rad", (LEFT + getWidth() - RIGHT) / 2.0, bottom + 32);
        double step =
                RoundStepsAndLengths.roundStep(rhoLimit / (getHeight() - TOP - BOTTOM) * 2 * 50);
        for (long k = (long) -Math.floor(rhoLimit / step); k * step <= rhoLimit; k++) {
            double y = screenY(k * step);
            g.setColor(k == 0 ? Palette.EDGE : Palette.GRID);
            g.draw(new Line2D.Double(LEFT, y, getWidth() - RIGHT, y));
            String text = RoundStepsAndLengths.formatLength(k * step, step);
            g.setColor(Palette.GRID_TEXT);
            g.drawString(text, LEFT - 8 - g.getFontMetrics().stringWidth(text), (float) y + 4);
        }
        g.setColor(Palette.GRID_TEXT);
        g.drawString("\u03c1", 12, (float) screenY(0) + 4);
    }

    private static void drawCentred(Graphics2D g, String text, double x, double y) {
        g.setColor(Palette.GRID_TEXT);
        g.drawString(text, (float) (x - g.getFontMetrics().stringWidth(text) / 2.0), (float) y);
    }

    private void paintTracks(Graphics2D g, LabelPlacer labels) {
        g.setStroke(Palette.LINE);
        for (DisplayedTrack track : scene.tracks()) {
            if (track.speed() > 0) {
                Geometry.Line line = Geometry.lineThroughTrack(track.place().x(), track.place().y(),
                        track.vx(), track.vy());
                g.setColor(Palette.withAlpha(Palette.ofStatus(track.status()), 0.75));
                double x = screenX(line.theta());
                double y = screenY(line.rho());
                g.draw(new Ellipse2D.Double(x - RING, y - RING, 2 * RING, 2 * RING));
                labels.blockArea(x - RING, y - RING, 2 * RING, 2 * RING);
            }
        }
    }

    private void paintPeaks(Graphics2D g, LabelPlacer labels) {
        double least = Double.POSITIVE_INFINITY;
        double most = Double.NEGATIVE_INFINITY;
        for (LookHistory.Faded<Scene.Peaks> list : scene.peaks()) {
            for (Scene.Peak peak : list.content().peaks()) {
                least = Math.min(least, peak.score());
                most = Math.max(most, peak.score());
            }
        }
        for (LookHistory.Faded<Scene.Peaks> list : scene.peaks()) {
            boolean newest = list.strength() == 1;
            for (Scene.Peak peak : list.content().peaks()) {
                double share = most > least ? (peak.score() - least) / (most - least) : 1;
                Color colour = Palette.withAlpha(Palette.rampColour(share),
                        newest ? 0.95 : 0.3 * list.strength());
                double radius = 2.5 + 4 * share;
                double x = screenX(peak.theta());
                double y = screenY(peak.rho());
                g.setColor(colour);
                g.fill(new Ellipse2D.Double(x - radius, y - radius, 2 * radius, 2 * radius));
                if (newest) {
                    labels.blockArea(x - radius, y - radius, 2 * radius, 2 * radius);
                }
            }
            if (newest) {
                paintLabels(g, labels, list.content().peaks());
            }
        }
    }

    private void paintLabels(Graphics2D g, LabelPlacer labels, List<Scene.Peak> peaks) {
        g.setFont(Palette.SMALL);
        List<Scene.Peak> best = peaks.stream()
                .sorted(Comparator.comparingDouble(Scene.Peak::score).reversed())
                .limit(MAX_LABELS)
                .toList();
        for (Scene.Peak peak : best) {
            String text =
                    String.format(Locale.ROOT, "%.0f m/s \u00b7 %d", peak.speed(), peak.scansHit());
            double x = screenX(peak.theta());
            double y = screenY(peak.rho());
            Rectangle2D room =
                    labels.placeLabel(x, y, LABEL_GAP, g.getFontMetrics().stringWidth(text), 13);
            if (room != null) {
                LabelPlacer.paintLeader(g, x, y, LABEL_GAP, room, Palette.MUTED);
                g.setColor(Palette.TEXT);
                g.drawString(text, (float) room.getX(), (float) room.getMaxY() - 3);
            }
        }
    }
}
