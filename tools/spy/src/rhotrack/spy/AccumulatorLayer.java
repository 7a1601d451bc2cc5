// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Color;
import java.awt.Graphics2D;
import java.awt.geom.Ellipse2D;
import java.awt.geom.Rectangle2D;
import java.util.Comparator;
import java.util.List;
import java.util.Locale;
import java.util.function.DoubleUnaryOperator;

import rhotrack.spy.scene.DisplayedTrack;
import rhotrack.spy.scene.Scene;

/**
 * An accumulator in the parameter space: its votes as an image, its peaks, and the lines that
 * started tracks.
 */
final class AccumulatorLayer {
    private static final double FULL = 127;
    private static final double PAIR_STRENGTH = 0.5;
    private static final double RADIUS = 5;
    private static final int MAX_LABELS = 8;
    private static final double LABEL_GAP = 9;
    private static final String[] METHODS = {"", "HT", "MHT", "IHT", "NHT", "passive paper"};

    private AccumulatorLayer() {
    }

    static String title(Scene.Accumulator search) {
        int method = Math.max(0, Math.min(METHODS.length - 1, search.which().method()));
        return "Votes: " + METHODS[method];
    }

    /**
     * Paints the planes of votes. Empty blocks stay dark; planes of single pairs of sensors are
     * faint, and the plane of all pairs is painted over them.
     */
    static void paintPlane(Graphics2D g, Scene scene, Scene.Accumulator search,
            DoubleUnaryOperator screenX, DoubleUnaryOperator screenY) {
        scene.internals().planes().stream()
                .filter(plane -> plane.which().method() == search.which().method()
                        && plane.scan() == search.scan())
                .sorted(Comparator.comparing((Scene.Plane plane) -> !plane.which().hasPair()))
                .forEach(plane -> paintPlane(g, plane, search, screenX, screenY));
    }

    private static void paintPlane(Graphics2D g, Scene.Plane plane, Scene.Accumulator search,
            DoubleUnaryOperator screenX, DoubleUnaryOperator screenY) {
        double strength = plane.which().hasPair() ? PAIR_STRENGTH : 1;
        int height = plane.rows().size();
        for (int theta = 0; theta < height; theta++) {
            byte[] row = plane.rows().get(theta);
            double left = screenX.applyAsDouble(theta * Math.PI / height);
            double right = screenX.applyAsDouble((theta + 1) * Math.PI / height);
            for (int i = 0; i < row.length; i++) {
                if (row[i] > 0) {
                    double share = row[i] / FULL;
                    double step = (search.rhoMax() - search.rhoMin()) / row.length;
                    double bottom = screenY.applyAsDouble(search.rhoMin() + i * step);
                    double top = screenY.applyAsDouble(search.rhoMin() + (i + 1) * step);
                    g.setColor(Palette.withAlpha(Palette.rampColour(share),
                            strength * (0.25 + 0.75 * share)));
                    g.fill(new Rectangle2D.Double(left, top, right - left + 0.5,
                            bottom - top + 0.5));
                }
            }
        }
    }

    /**
     * Paints the fullest cells as rings; a cell whose line has started a track is filled, with the
     * track's id.
     */
    static void paintCells(Graphics2D g, Scene.Accumulator search, DoubleUnaryOperator screenX,
            DoubleUnaryOperator screenY, LabelPlacer labels) {
        g.setStroke(Palette.LINE);
        List<Scene.Cell> cells = search.cells();
        for (Scene.Cell cell : cells) {
            double x = screenX.applyAsDouble(cell.theta());
            double y = screenY.applyAsDouble(cell.rho());
            Color colour = cell.trackId() > 0
                    ? Palette.ofStatus(DisplayedTrack.Status.CONFIRMED) : Palette.TEXT;
            Ellipse2D ring = new Ellipse2D.Double(x - RADIUS, y - RADIUS, 2 * RADIUS, 2 * RADIUS);
            g.setColor(colour);
            if (cell.trackId() > 0) {
                g.fill(ring);
            } else {
                g.draw(ring);
            }
            labels.blockArea(x - RADIUS, y - RADIUS, 2 * RADIUS, 2 * RADIUS);
        }
        g.setFont(Palette.SMALL);
        for (Scene.Cell cell : cells.subList(0, Math.min(MAX_LABELS, cells.size()))) {
            drawCellLabel(g, cell,
                    screenX.applyAsDouble(cell.theta()), screenY.applyAsDouble(cell.rho()), labels);
        }
    }

    private static void drawCellLabel(Graphics2D g, Scene.Cell cell, double x, double y,
            LabelPlacer labels) {
        String text = String.format(Locale.ROOT, "%.1f%s", cell.votes(),
                cell.trackId() > 0 ? " \u2192 track " + cell.trackId() : "");
        Rectangle2D room =
                labels.placeLabel(x, y, LABEL_GAP, g.getFontMetrics().stringWidth(text), 13);
        if (room != null) {
            LabelPlacer.paintLeader(g, x, y, LABEL_GAP, room, Palette.MUTED);
            g.setColor(Palette.withAlpha(Palette.BACKGROUND, 0.7));
            g.fill(room);
            g.setColor(Palette.TEXT);
            g.drawString(text, (float) room.getX(), (float) room.getMaxY() - 3);
        }
    }
}
