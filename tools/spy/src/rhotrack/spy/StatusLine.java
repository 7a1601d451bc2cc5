// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.Graphics2D;
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

    private Scene scene;
    private boolean paused;

    StatusLine() {
        setPreferredSize(new Dimension(100, 28));
    }

    void show(Scene newScene, boolean isPaused) {
        scene = newScene;
        paused = isPaused;
        repaint();
    }

    @Override
    protected void paintComponent(Graphics graphics) {
        Graphics2D g = (Graphics2D) graphics.create();
        Palette.smooth(g);
        g.setColor(Palette.PANEL);
        g.fillRect(0, 0, getWidth(), getHeight());
        g.setFont(Palette.PLAIN);
        if (scene != null) {
            paintHealth(g, scene.health());
        }
        g.dispose();
    }

    private void paintHealth(Graphics2D g, Scene.Health health) {
        Scene.Status status = health.status();
        float x = 14;
        if (status == null) {
            x = text(g, x, Palette.MUTED, health.received() == 0 ? "waiting for RHO_ channels" : "no RHO_STATUS");
        } else {
            x = text(g, x, Palette.MUTED, "scans");
            x = text(g, x, Palette.TEXT, status.accepted() + " accepted");
            x = text(g, x, fault(status.lost()), status.lost() + " lost");
            x = text(g, x, fault(status.late()), status.late() + " late");
            x = text(g, x, fault(status.bad()), status.bad() + " bad") + 14;
            x = paintFaults(g, x, health.sensorFaults());
            x = text(g, x, Palette.MUTED, "tracks");
            x = text(g, x, Palette.of(TrackMark.Status.CONFIRMED), status.confirmed() + " confirmed");
            x = text(g, x, Palette.of(TrackMark.Status.TENTATIVE), status.tentative() + " tentative");
            x = text(g, x, Palette.of(TrackMark.Status.COASTING), status.coasting() + " coasting") + 14;
            x = text(g, x, Palette.MUTED, "step");
            x = text(g, x, Palette.TEXT, String.format(Locale.ROOT, "%.0f \u00b5s, at most %.0f", status.stepUs(),
                    status.stepMaxUs())) + 14;
            x = paintWork(g, x, health.work());
            x = text(g, x, Palette.MUTED, "clutter");
            x = text(g, x, Palette.TEXT, String.format(Locale.ROOT, "%.3g /km\u00b2", status.clutterPerKm2()));
        }
        paintFreshness(g, health, x);
    }

    /** Without a limit there is no share of it; what was not left out is not said. */
    private float paintWork(Graphics2D g, float from, Scene.Work work) {
        float x = from;
        if (work != null && work.share() >= 0) {
            x = text(g, x, Palette.MUTED, "work");
            x = text(g, x, Palette.TEXT, String.format(Locale.ROOT, "%.0f %%", 100 * work.share()));
        }
        if (work != null && work.partialSteps() > 0) {
            x = text(g, x, Palette.WARNING, work.partialSteps() + " partial");
        }
        if (work != null && work.notPrinted() > 0) {
            x = text(g, x, Palette.WARNING, work.notPrinted() + " not printed");
        }
        if (work != null && work.notLogged() > 0) {
            x = text(g, x, Palette.WARNING, work.notLogged() + " not logged");
        }
        return x + 14;
    }

    private float paintFaults(Graphics2D g, float from, List<String> faults) {
        float x = from;
        for (String fault : faults.subList(0, Math.min(faults.size(), MAX_FAULTS))) {
            x = text(g, x, Palette.WARNING, fault) + 14;
        }
        if (faults.size() > MAX_FAULTS) {
            x = text(g, x, Palette.WARNING, (faults.size() - MAX_FAULTS) + " more") + 14;
        }
        return x;
    }

    private void paintFreshness(Graphics2D g, Scene.Health health, float free) {
        String text = health.received() + " messages";
        Color colour = Palette.MUTED;
        if (health.ignored() > 0) {
            text += ", " + health.ignored() + " not understood";
        }
        if (health.statusAge() > STALE_S) {
            text = String.format(Locale.ROOT, "status %.0f s old", health.statusAge());
            colour = Palette.WARNING;
        }
        if (paused) {
            text = "PAUSED";
            colour = Palette.WARNING;
        }
        float x = Math.max(free, getWidth() - 14 - g.getFontMetrics().stringWidth(text));
        text(g, x, colour, text);
    }

    private static Color fault(int count) {
        return count > 0 ? Palette.WARNING : Palette.MUTED;
    }

    /** Returns where the next text begins. */
    private float text(Graphics2D g, float x, Color colour, String text) {
        g.setColor(colour);
        g.drawString(text, x, 19);
        return x + g.getFontMetrics().stringWidth(text) + 12;
    }
}
