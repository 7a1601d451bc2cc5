// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.util.List;
import java.util.Locale;
import java.util.Map;
import javax.swing.JComponent;

import rhotrack.spy.scene.DisplayedTrack;
import rhotrack.spy.scene.Geometry;
import rhotrack.spy.scene.Scene;

/**
 * The table of tracks, as many rows as fit, confirmed and coasting ones first; or the hypotheses of
 * the selected track.
 */
@SuppressWarnings("serial") // views are never serialised
final class TrackTable extends JComponent {
    private static final int ROW = 20;
    private static final String[] TITLES =
            {"track", "speed", "course", "height", "exists", "hits", "score"};
    private static final String UNKNOWN = "\u2013";

    private static final int LEFT = 26; // left edge of the first column, behind the symbols
    private static final int RIGHT = 16;

    private Scene scene;
    private int selected;

    TrackTable() {
        setPreferredSize(new Dimension(420, 300));
    }

    void show(Scene newScene) {
        scene = newScene;
        repaint();
    }

    /** Selects the track whose hypotheses are shown in place of the table; 0: none. */
    void selectTrack(int track) {
        selected = track;
        repaint();
    }

    @Override
    protected void paintComponent(Graphics graphics) {
        Graphics2D g = (Graphics2D) graphics.create();
        Palette.enableAntialiasing(g);
        g.setColor(Palette.BACKGROUND);
        g.fillRect(0, 0, getWidth(), getHeight());
        Scene.Hypotheses of = scene == null ? null : scene.internals().hypotheses().get(selected);
        if (of != null) {
            TrackHypothesesTable.paint(g, of, getWidth());
            g.dispose();
            return;
        }
        paintTable(g, scene == null ? List.of() : DisplayedTrack.byImportance(scene.tracks()),
                scene == null ? Map.of() : scene.existence());
        g.dispose();
    }

    private void paintTable(Graphics2D g, List<DisplayedTrack> tracks,
            Map<Integer, Double> existence) {
        int room = Math.max(1, (getHeight() - 32) / ROW);
        List<DisplayedTrack> shown =
                tracks.subList(0, tracks.size() <= room ? tracks.size() : room - 1);
        List<String[]> cells = shown.stream()
                .map(track -> cellsOf(track, existence.get(track.id()))).toList();
        double[] edges =
                TableColumnWidths.rightEdges(columnWidths(g, cells), getWidth() - LEFT - RIGHT);
        g.setFont(Palette.SMALL);
        g.setColor(Palette.MUTED);
        drawRow(g, 18, edges, TITLES);
        g.setColor(Palette.EDGE);
        g.drawLine(14, 26, getWidth() - RIGHT, 26);
        int y = 44;
        for (int i = 0; i < shown.size(); i++) {
            Symbols.drawTrack(g, shown.get(i).status(), 20, y - 4);
            g.setColor(Palette.TEXT);
            g.setFont(Palette.PLAIN);
            drawRow(g, y, edges, cells.get(i));
            y += ROW;
        }
        if (shown.size() < tracks.size()) {
            g.setColor(Palette.MUTED);
            g.drawString("and " + (tracks.size() - shown.size()) + " more", 34, y);
        }
    }

    /** The cells of a track; exists: probability that its target exists, null: not known. */
    static String[] cellsOf(DisplayedTrack track, Double exists) {
        return new String[] {Integer.toString(track.id()),
            String.format(Locale.ROOT, "%.0f m/s", track.speed()),
            String.format(Locale.ROOT, "%03.0f\u00b0",
                    Geometry.compassDegrees(track.vx(), track.vy())),
            track.height() == 0 ? UNKNOWN : String.format(Locale.ROOT, "%.0f m", track.height()),
            exists == null ? UNKNOWN : String.format(Locale.ROOT, "%.0f %%", 100 * exists),
            Integer.toString(track.hits()), String.format(Locale.ROOT, "%.1f", track.score())};
    }

    static double[] columnWidths(Graphics2D g, List<String[]> rows) {
        double[] widths = new double[TITLES.length];
        for (int i = 0; i < TITLES.length; i++) {
            widths[i] = g.getFontMetrics(Palette.SMALL).stringWidth(TITLES[i]);
            for (String[] row : rows) {
                widths[i] =
                        Math.max(widths[i], g.getFontMetrics(Palette.PLAIN).stringWidth(row[i]));
            }
        }
        return widths;
    }

    /** Draws a row of right-aligned cells. */
    private static void drawRow(Graphics2D g, int y, double[] edges, String... cells) {
        for (int i = 0; i < edges.length; i++) {
            g.drawString(cells[i],
                    (float) (LEFT + edges[i] - g.getFontMetrics().stringWidth(cells[i])), y);
        }
    }
}
