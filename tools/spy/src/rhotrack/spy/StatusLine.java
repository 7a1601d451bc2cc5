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

import rhotrack.spy.scene.Scene;
import rhotrack.spy.scene.TrackMark;

/** The foot of the window: how the tracker is doing, and how fresh what is shown is. */
@SuppressWarnings("serial") // nobody stores views
final class StatusLine extends JComponent {
    /** A tracker sends its status once a second. */
    private static final double STALE_S = 4;
    private static final int MAX_FAULTS = 6;
    private static final int ROW = 19;
    private static final int MARGIN = 14;
    private static final int PIECE_GAP = 12;
    private static final int GROUP_GAP = 14;

    private Scene scene;
    private boolean paused;

    /** A text and the space behind it. */
    record Piece(Color colour, String text, int space) {
    }

    private List<List<Piece>> rows = List.of();

    StatusLine() {
        setPreferredSize(new Dimension(100, ROW + 9));
        addComponentListener(new ComponentAdapter() {
            @Override
            public void componentResized(ComponentEvent event) {
                arrange();
            }
        });
    }

    void show(Scene newScene, boolean isPaused) {
        scene = newScene;
        paused = isPaused;
        arrange();
        repaint();
    }

    /** Its pieces in as many rows as they need. */
    private void arrange() {
        rows = rows(scene == null ? List.of() : groups(scene.health()), getWidth() - 2 * MARGIN,
                getFontMetrics(Palette.PLAIN));
        int height = rows.size() * ROW + 9;
        if (height != getPreferredSize().height) {
            setPreferredSize(new Dimension(100, height));
            revalidate();
        }
    }

    /** Groups stay together; one that does not fit begins the next row. At least one row. */
    static List<List<Piece>> rows(List<List<Piece>> groups, int room, FontMetrics font) {
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
        Palette.smooth(g);
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

    private List<List<Piece>> groups(Scene.Health health) {
        List<List<Piece>> groups = new ArrayList<>();
        Scene.Status status = health.status();
        groups.add(List.of(freshness(health)));
        if (status == null) {
            groups.add(List.of(piece(Palette.MUTED,
                    health.received() == 0 ? "waiting for RHO_ channels" : "no RHO_STATUS")));
            return groups;
        }
        groups.add(List.of(piece(Palette.MUTED, "scans"), piece(Palette.TEXT, status.accepted() + " accepted"),
                piece(fault(status.lost()), status.lost() + " lost"),
                piece(status.late() > 0 ? Palette.TEXT : Palette.MUTED, status.late() + " late"),
                piece(fault(status.bad()), status.bad() + " bad")));
        addFaults(groups, health.sensorFaults());
        groups.add(List.of(piece(Palette.MUTED, "tracks"),
                piece(Palette.of(TrackMark.Status.CONFIRMED), status.confirmed() + " confirmed"),
                piece(Palette.of(TrackMark.Status.TENTATIVE), status.tentative() + " tentative"),
                piece(Palette.of(TrackMark.Status.COASTING), status.coasting() + " coasting")));
        groups.add(List.of(piece(Palette.MUTED, "step"), piece(Palette.TEXT,
                String.format(Locale.ROOT, "%.0f \u00b5s, at most %.0f", status.stepUs(), status.stepMaxUs()))));
        addWork(groups, health.work());
        groups.add(List.of(piece(Palette.MUTED, "clutter"),
                piece(Palette.TEXT, String.format(Locale.ROOT, "%.3g /km\u00b2", status.clutterPerKm2()))));
        return groups;
    }

    /** Without a limit there is no share of it; what was not left out is not said. */
    private static void addWork(List<List<Piece>> groups, Scene.Work work) {
        List<Piece> group = new ArrayList<>();
        if (work != null && work.share() >= 0) {
            group.add(piece(Palette.MUTED, "work"));
            group.add(piece(Palette.TEXT, String.format(Locale.ROOT, "%.0f %%", 100 * work.share())));
        }
        if (work != null && work.partialSteps() > 0) {
            group.add(piece(Palette.WARNING, work.partialSteps() + " partial"));
        }
        if (work != null && work.notPrinted() > 0) {
            group.add(piece(Palette.WARNING, work.notPrinted() + " not printed"));
        }
        if (work != null && work.notLogged() > 0) {
            group.add(piece(Palette.WARNING, work.notLogged() + " not logged"));
        }
        if (!group.isEmpty()) {
            groups.add(group);
        }
    }

    private static void addFaults(List<List<Piece>> groups, List<String> faults) {
        for (String fault : faults.subList(0, Math.min(faults.size(), MAX_FAULTS))) {
            groups.add(List.of(piece(Palette.WARNING, fault)));
        }
        if (faults.size() > MAX_FAULTS) {
            groups.add(List.of(piece(Palette.WARNING, (faults.size() - MAX_FAULTS) + " more")));
        }
    }

    private Piece freshness(Scene.Health health) {
        if (paused) {
            return piece(Palette.WARNING, "PAUSED");
        }
        if (health.statusAge() > STALE_S) {
            return piece(Palette.WARNING, String.format(Locale.ROOT, "status %.0f s old", health.statusAge()));
        }
        return piece(Palette.MUTED, health.received() + " messages"
                + (health.ignored() > 0 ? ", " + health.ignored() + " not understood" : ""));
    }

    private static Color fault(int count) {
        return count > 0 ? Palette.WARNING : Palette.MUTED;
    }

    private static Piece piece(Color colour, String text) {
        return new Piece(colour, text, PIECE_GAP);
    }
}
