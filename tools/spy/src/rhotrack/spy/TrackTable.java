// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.util.List;
import java.util.Locale;
import javax.swing.JComponent;

import rhotrack.spy.scene.Geometry;
import rhotrack.spy.scene.Scene;
import rhotrack.spy.scene.TrackMark;

/** The tracks as rows, as many as there is room for: confirmed and coasting ones first. */
@SuppressWarnings("serial") // nobody stores views
final class TrackTable extends JComponent {
    private static final int ROW = 20;
    private static final String[] TITLES = {"track", "speed", "course", "height", "hits", "score"};

    /** Cells are right-aligned, here, as shares of the width. */
    private static final double[] RIGHT_EDGES = {0.17, 0.39, 0.55, 0.74, 0.86, 1};

    private Scene scene;
    private int selected;

    TrackTable() {
        setPreferredSize(new Dimension(420, 300));
    }

    void show(Scene newScene) {
        scene = newScene;
        repaint();
    }

    /** 0: none. */
    void select(int track) {
        selected = track;
        repaint();
    }

    @Override
    protected void paintComponent(Graphics graphics) {
        Graphics2D g = (Graphics2D) graphics.create();
        Palette.smooth(g);
        g.setColor(Palette.BACKGROUND);
        g.fillRect(0, 0, getWidth(), getHeight());
        Scene.Hypotheses of = scene == null ? null : scene.thoughts().hypotheses().get(selected);
        if (of != null) {
            HypothesesTable.paint(g, of, getWidth());
            g.dispose();
            return;
        }
        g.setFont(Palette.SMALL);
        g.setColor(Palette.MUTED);
        row(g, 18, TITLES);
        g.setColor(Palette.EDGE);
        g.drawLine(14, 26, getWidth() - 16, 26);
        if (scene != null) {
            paintRows(g);
        }
        g.dispose();
    }

    private void paintRows(Graphics2D g) {
        List<TrackMark> tracks = TrackMark.byImportance(scene.tracks());
        int room = Math.max(1, (getHeight() - 32) / ROW);
        int shown = tracks.size() <= room ? tracks.size() : room - 1;
        int y = 44;
        for (TrackMark track : tracks.subList(0, shown)) {
            Symbols.track(g, track.status(), 20, y - 4);
            g.setColor(Palette.TEXT);
            g.setFont(Palette.PLAIN);
            row(g, y, Integer.toString(track.id()), String.format(Locale.ROOT, "%.0f m/s", track.speed()),
                    String.format(Locale.ROOT, "%03.0f\u00b0", Geometry.compassDegrees(track.vx(), track.vy())),
                    track.height() == 0 ? "\u2013" : String.format(Locale.ROOT, "%.0f m", track.height()),
                    Integer.toString(track.hits()), String.format(Locale.ROOT, "%.1f", track.score()));
            y += ROW;
        }
        if (shown < tracks.size()) {
            g.setColor(Palette.MUTED);
            g.drawString("and " + (tracks.size() - shown) + " more", 34, y);
        }
    }

    private void row(Graphics2D g, int y, String... cells) {
        for (int i = 0; i < cells.length; i++) {
            double right = 14 + RIGHT_EDGES[i] * (getWidth() - 30);
            g.drawString(cells[i], (float) (right - g.getFontMetrics().stringWidth(cells[i])), y);
        }
    }
}
