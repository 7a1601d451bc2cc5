// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Color;
import java.awt.Dimension;
import java.awt.FontMetrics;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.event.ComponentAdapter;
import java.awt.event.ComponentEvent;
import java.util.ArrayList;
import java.util.List;
import java.util.Locale;
import javax.swing.JComponent;

import rhotrack.spy.scene.DisplayedTrack;
import rhotrack.spy.scene.Scene;

/**
 * The status line at the foot of the window: the tracker's counters, and the age of the shown data.
 */
@SuppressWarnings("serial") // views are never serialised
final class StatusLine extends JComponent {
    /** Age from which the status is stale: a tracker sends it once a second. */
    private static final double STALE_S = 4;
    private static final int MAX_FAULTS = 6;
    private static final int ROW = 19;
    private static final int MARGIN = 14;
    private static final int PIECE_GAP = 12;
    private static final int GROUP_GAP = 14;

    private Scene scene;
    private boolean paused;

    /** A coloured text and the space behind it in pixels. */
    record Piece(Color colour, String text, int space) {
    }

    private List<List<Piece>> rows = List.of();

    StatusLine() {
        setPreferredSize(new Dimension(100, ROW + 9));
        addComponentListener(new ComponentAdapter() {
            @Override
            public void componentResized(ComponentEvent event) {
                arrangeRows();
            }
        });
    }

    void show(Scene newScene, boolean isPaused) {
        scene = newScene;
        paused = isPaused;
        arrangeRows();
        repaint();
    }

    /** Distributes the pieces over as many rows as needed, and adapts the height. */
    private void arrangeRows() {
        rows = wrapIntoRows(scene == null ? List.of() : groupsOf(scene.health()),
                getWidth() - 2 * MARGIN, getFontMetrics(Palette.PLAIN));
        int height = rows.size() * ROW + 9;
        if (height != getPreferredSize().height) {
            setPreferredSize(new Dimension(100, height));
            revalidate();
        }
    }

    /**
     * Wraps groups of pieces into rows of width `room`: a group that does not fit begins the next
     * row. At least one row.
     */
    static List<List<Piece>> wrapIntoRows(List<List<Piece>> groups, int room, FontMetrics font) {
        List<List<Piece>> rows = new ArrayList<>();
        rows.add(new ArrayList<>());
        int free = room;
        for (List<Piece> group : groups) {
            int width = widthOf(group, font);
            if (width > free && free < room) {
                rows.add(new ArrayList<>());
                free = room;
            }
            rows.get(rows.size() - 1).addAll(group);
            rows.get(rows.size() - 1).add(new Piece(Palette.MUTED, "", GROUP_GAP));
            free -= width + GROUP_GAP;
        }
        return rows;
    }

    static int widthOf(List<Piece> pieces, FontMetrics font) {
        return pieces.stream().mapToInt(piece -> font.stringWidth(piece.text) + piece.space).sum();
    }

    @Override
    protected void paintComponent(Graphics graphics) {
        Graphics2D g = (Graphics2D) graphics.create();
        Palette.enableAntialiasing(g);
        g.setColor(Palette.PANEL);
        g.fillRect(0, 0, getWidth(), getHeight());
        g.setFont(Palette.PLAIN);
        for (int row = 0; row < rows.size(); row++) {
            int x = MARGIN;
            for (Piece piece : rows.get(row)) {
                g.setColor(piece.colour);
                g.drawString(piece.text, x, 19 + row * ROW);
                x += g.getFontMetrics().stringWidth(piece.text) + piece.space;
            }
        }
        g.dispose();
    }

    private List<List<Piece>> groupsOf(Scene.Health health) {
        List<List<Piece>> groups = new ArrayList<>();
        Scene.Status status = health.status();
        groups.add(List.of(freshnessPiece(health)));
        if (status == null) {
            groups.add(List.of(spacedPiece(Palette.MUTED,
                    health.received() == 0 ? "waiting for RHO_ channels" : "no RHO_STATUS")));
            return groups;
        }
        groups.add(List.of(spacedPiece(Palette.MUTED, "scans"),
                spacedPiece(Palette.TEXT, status.accepted() + " accepted"),
                spacedPiece(colourOfCount(status.lost()), status.lost() + " lost"),
                spacedPiece(status.late() > 0 ? Palette.TEXT : Palette.MUTED,
                        status.late() + " late"),
                spacedPiece(colourOfCount(status.bad()), status.bad() + " bad")));
        addSensorFaults(groups, health.sensorFaults());
        groups.add(List.of(spacedPiece(Palette.MUTED, "tracks"),
                spacedPiece(Palette.ofStatus(DisplayedTrack.Status.CONFIRMED),
                        status.confirmed() + " confirmed"),
                spacedPiece(Palette.ofStatus(DisplayedTrack.Status.TENTATIVE),
                        status.tentative() + " tentative"),
                spacedPiece(Palette.ofStatus(DisplayedTrack.Status.COASTING),
                        status.coasting() + " coasting")));
        groups.add(List.of(spacedPiece(Palette.MUTED, "step"),
                spacedPiece(Palette.TEXT, String.format(Locale.ROOT,
                        "%.0f \u00b5s, at most %.0f", status.stepUs(), status.stepMaxUs()))));
        addWorkGroup(groups, health.work());
        groups.add(List.of(spacedPiece(Palette.MUTED, "clutter"),
                spacedPiece(Palette.TEXT,
                        String.format(Locale.ROOT, "%.3g /km\u00b2", status.clutterPerKm2()))));
        return groups;
    }

    /**
     * Adds the share of the work limit where there is a limit, and counters of skipped work that
     * are not 0.
     */
    private static void addWorkGroup(List<List<Piece>> groups, Scene.Work work) {
        List<Piece> group = new ArrayList<>();
        if (work != null && work.share() >= 0) {
            group.add(spacedPiece(Palette.MUTED, "work"));
            group.add(spacedPiece(Palette.TEXT,
                    String.format(Locale.ROOT, "%.0f %%", 100 * work.share())));
        }
        if (work != null && work.partialSteps() > 0) {
            group.add(spacedPiece(Palette.WARNING, work.partialSteps() + " partial"));
        }
        if (work != null && work.notPrinted() > 0) {
            group.add(spacedPiece(Palette.WARNING, work.notPrinted() + " not printed"));
        }
        if (work != null && work.notLogged() > 0) {
            group.add(spacedPiece(Palette.WARNING, work.notLogged() + " not logged"));
        }
        if (!group.isEmpty()) {
            groups.add(group);
        }
    }

    private static void addSensorFaults(List<List<Piece>> groups, List<String> faults) {
        for (String fault : faults.subList(0, Math.min(faults.size(), MAX_FAULTS))) {
            groups.add(List.of(spacedPiece(Palette.WARNING, fault)));
        }
        if (faults.size() > MAX_FAULTS) {
            groups.add(List.of(spacedPiece(Palette.WARNING,
                    (faults.size() - MAX_FAULTS) + " more")));
        }
    }

    private Piece freshnessPiece(Scene.Health health) {
        if (paused) {
            return spacedPiece(Palette.WARNING, "PAUSED");
        }
        if (health.statusAge() > STALE_S) {
            return spacedPiece(Palette.WARNING,
                    String.format(Locale.ROOT, "status %.0f s old", health.statusAge()));
        }
        return spacedPiece(Palette.MUTED, health.received() + " messages"
                + (health.ignored() > 0 ? ", " + health.ignored() + " not understood" : ""));
    }

    private static Color colourOfCount(int count) {
        return count > 0 ? Palette.WARNING : Palette.MUTED;
    }

    private static Piece spacedPiece(Color colour, String text) {
        return new Piece(colour, text, PIECE_GAP);
    }
}
