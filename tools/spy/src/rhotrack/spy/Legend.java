// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Color;
import java.awt.Graphics2D;
import java.awt.geom.Line2D;
import java.util.Locale;
import java.util.Map;
import java.util.TreeMap;

import rhotrack.spy.scene.DisplayedTrack;
import rhotrack.spy.scene.Scene;

/**
 * The row at the foot of the plan view that explains its marks; sensors, truth and clutter are
 * listed only where there are any.
 */
final class Legend {
    static final int HEIGHT = 26;

    private final Graphics2D g;
    private final double y;
    private double x = 14;

    private Legend(Graphics2D g, int height) {
        this.g = g;
        y = height - HEIGHT / 2.0;
    }

    static void paint(Graphics2D g, Scene scene, ViewOptions options, double vectorSeconds,
            int width, int height) {
        g.setColor(Palette.withAlpha(Palette.BACKGROUND, 0.85));
        g.fillRect(0, height - HEIGHT, width, HEIGHT);
        Legend legend = new Legend(g, height);
        for (DisplayedTrack.Status status : new DisplayedTrack.Status[] {
            DisplayedTrack.Status.CONFIRMED, DisplayedTrack.Status.TENTATIVE,
            DisplayedTrack.Status.COASTING}) {
            Symbols.drawTrack(g, status, legend.x, legend.y);
            legend.drawText(status.name().toLowerCase(Locale.ROOT));
        }
        if (vectorSeconds > 0) {
            legend.drawLineSymbol(Palette.TEXT);
            legend.drawText("vector: " + formatSeconds(vectorSeconds));
        }
        legend.drawSensors(scene, options);
        if (options.shows(ViewOptions.Layer.TRUTH) && !scene.truth().isEmpty()) {
            Symbols.drawTruth(g, legend.x, legend.y);
            legend.drawText("truth");
        }
        if (options.shows(ViewOptions.Layer.GHOSTS) && !scene.internals().ghosts().isEmpty()) {
            g.setStroke(Palette.THIN);
            GhostsAndHypothesesLayer.paintCrossing(g, legend.x, legend.y, true);
            legend.drawText("ghost");
        }
        if (options.shows(ViewOptions.Layer.CLUTTER) && !scene.echoes().isEmpty()) {
            g.setColor(Palette.MUTED);
            g.setStroke(Palette.THIN);
            Symbols.drawEcho(g, legend.x, legend.y);
            legend.drawText("clutter that comes back");
        }
    }

    private static String formatSeconds(double seconds) {
        return seconds < 1 ? seconds + " s" : Math.round(seconds) + " s";
    }

    private void drawSensors(Scene scene, ViewOptions options) {
        Map<Integer, String> seen = new TreeMap<>();
        if (options.shows(ViewOptions.Layer.PLOTS)) {
            scene.plots().forEach(look -> seen.put(look.content().sensorId(), "plots"));
        }
        if (options.shows(ViewOptions.Layer.BEARINGS)) {
            scene.bearings()
                    .forEach(look -> seen.putIfAbsent(look.content().sensorId(), "bearings"));
        }
        int shown = 0;
        for (Map.Entry<Integer, String> sensor : seen.entrySet()) {
            if (++shown > 4) {
                return; // the colours of sensors repeat after four
            }
            if (sensor.getValue().equals("plots")) {
                g.setColor(Palette.ofSensor(sensor.getKey()));
                Symbols.drawPlot(g, x, y, 4);
            } else {
                drawLineSymbol(Palette.ofSensor(sensor.getKey()));
            }
            drawText(sensor.getValue() + " of S" + sensor.getKey());
        }
    }

    private void drawLineSymbol(Color colour) {
        g.setColor(colour);
        g.setStroke(Palette.LINE);
        g.draw(new Line2D.Double(x - 4, y, x + 8, y));
        x += 4;
    }

    private void drawText(String text) {
        g.setFont(Palette.SMALL);
        g.setColor(Palette.MUTED);
        g.drawString(text, (float) x + 9, (float) y + 4);
        x += 9 + g.getFontMetrics().stringWidth(text) + 20;
    }
}
