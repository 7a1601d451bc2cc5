// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Color;
import java.awt.Graphics2D;
import java.awt.geom.Ellipse2D;
import java.util.List;
import java.util.Locale;
import java.util.stream.Collectors;

import rhotrack.spy.scene.Scene;

/**
 * The selected track: bars of its motion models' probabilities and its evidence, and its hypotheses
 * as rows.
 */
final class TrackHypothesesTable {
    private static final int LEFT = 14;
    private static final int ROW = 19;
    private static final String[] MODELS = {"calm", "steady", "manoeuvres"};
    private static final String[] EVIDENCE = {"support", "shared", "clutter"};
    private static final Color[] COLOURS =
            {new Color(0x57b98a), new Color(0xd8c35a), new Color(0xd0567d)};

    private TrackHypothesesTable() {
    }

    static void paint(Graphics2D g, Scene.Hypotheses of, int width) {
        g.setFont(Palette.BOLD);
        g.setColor(Palette.TEXT);
        g.drawString(String.format(Locale.ROOT, "Track %d, score %.1f", of.trackId(), of.score()),
                LEFT, 20);
        drawShareBar(g, 30, width, MODELS, of.calm(), of.steady(), of.maneuver());
        if (of.evidence() > 0) {
            drawShareBar(g, 62, width, EVIDENCE, of.support(), of.shared(), of.clutter());
        }
        g.setFont(Palette.SMALL);
        g.setColor(Palette.MUTED);
        g.drawString("hypothesis", LEFT + 16, 112);
        g.drawString("speed", LEFT + width * 0.36f, 112);
        g.drawString("its last plots", LEFT + width * 0.53f, 112);
        int y = 112 + ROW;
        for (int i = 0; i < of.list().size(); i++) {
            drawHypothesisRow(g, of.list().get(i), i, y, width);
            y += ROW;
        }
    }

    private static void drawShareBar(Graphics2D g, int y, int width, String[] names,
            double... shares) {
        double x = LEFT;
        g.setFont(Palette.SMALL);
        for (int i = 0; i < shares.length; i++) {
            double part = shares[i] * (width - 2 * LEFT);
            g.setColor(COLOURS[i]);
            g.fillRect((int) x, y, (int) Math.ceil(part), 8);
            x += part;
        }
        float at = LEFT;
        for (int i = 0; i < shares.length; i++) {
            String text = String.format(Locale.ROOT, "%s %.2f", names[i], shares[i]);
            g.setColor(COLOURS[i]);
            g.drawString(text, at, y + 21);
            at += g.getFontMetrics().stringWidth(text) + 16;
        }
    }

    private static void drawHypothesisRow(Graphics2D g, Scene.Hypothesis one, int index, int y,
            int width) {
        List<Integer> known = one.plots().stream().filter(plot -> plot >= -1).toList();
        String plots = known.stream().map(plot -> plot < 0 ? "miss" : Integer.toString(plot))
                .collect(Collectors.joining(", "));
        g.setColor(Palette.ofHypothesis(index));
        g.fill(new Ellipse2D.Double(LEFT, y - 9, 9, 9));
        g.setFont(Palette.PLAIN);
        g.setColor(Palette.TEXT);
        g.drawString(String.format(Locale.ROOT, "%.3f", one.share()), LEFT + 16, y);
        g.drawString(String.format(Locale.ROOT, "%.0f m/s", Math.hypot(one.vx(), one.vy())),
                LEFT + width * 0.36f, y);
        g.drawString(plots, LEFT + width * 0.53f, y);
    }
}
