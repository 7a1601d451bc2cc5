// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Color;
import java.awt.Graphics2D;
import java.awt.geom.Line2D;
import java.util.Locale;
import java.util.Map;
import java.util.TreeMap;

import rhotrack.spy.scene.Scene;
import rhotrack.spy.scene.TrackMark;

/**
 * One row at the foot of the plan view that says what its marks mean; of sensors, truth and clutter
 * those that there are.
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

    static void paint(Graphics2D g, Scene scene, ViewOptions options, double vectorSeconds, int width, int height) {
        g.setColor(Palette.faded(Palette.BACKGROUND, 0.85));
        g.fillRect(0, height - HEIGHT, width, HEIGHT);
        Legend legend = new Legend(g, height);
        for (TrackMark.Status status : new TrackMark.Status[] {TrackMark.Status.CONFIRMED,
            TrackMark.Status.TENTATIVE, TrackMark.Status.COASTING}) {
            Symbols.track(g, status, legend.x, legend.y);
            legend.text(status.name().toLowerCase(Locale.ROOT));
        }
        if (vectorSeconds > 0) {
            legend.line(Palette.TEXT);
            legend.text("vector: " + seconds(vectorSeconds));
        }
        legend.sensors(scene, options);
        if (options.shows(ViewOptions.Layer.TRUTH) && !scene.truth().isEmpty()) {
            Symbols.truth(g, legend.x, legend.y);
            legend.text("truth");
        }
        if (options.shows(ViewOptions.Layer.GHOSTS) && !scene.thoughts().ghosts().isEmpty()) {
            g.setStroke(Palette.THIN);
            ThoughtLayer.paintCrossing(g, legend.x, legend.y, true);
            legend.text("ghost");
        }
        if (options.shows(ViewOptions.Layer.CLUTTER) && !scene.echoes().isEmpty()) {
            g.setColor(Palette.MUTED);
            g.setStroke(Palette.THIN);
            Symbols.echo(g, legend.x, legend.y);
            legend.text("clutter that comes back");
        }
    }

    private static String seconds(double seconds) {
        return seconds < 1 ? seconds + " s" : Math.round(seconds) + " s";
    }

    private void sensors(Scene scene, ViewOptions options) {
        Map<Integer, String> seen = new TreeMap<>();
        if (options.shows(ViewOptions.Layer.PLOTS)) {
            scene.plots().forEach(look -> seen.put(look.content().sensorId(), "plots"));
        }
        if (options.shows(ViewOptions.Layer.BEARINGS)) {
            scene.bearings().forEach(look -> seen.putIfAbsent(look.content().sensorId(), "bearings"));
        }
        int shown = 0;
        for (Map.Entry<Integer, String> sensor : seen.entrySet()) {
            if (++shown > 4) {
                return; // colours repeat from here on
            }
            if (sensor.getValue().equals("plots")) {
                g.setColor(Palette.ofSensor(sensor.getKey()));
                Symbols.plot(g, x, y, 4);
            } else {
                line(Palette.ofSensor(sensor.getKey()));
            }
            text(sensor.getValue() + " of S" + sensor.getKey());
        }
    }

    private void line(Color colour) {
        g.setColor(colour);
        g.setStroke(Palette.LINE);
        g.draw(new Line2D.Double(x - 4, y, x + 8, y));
        x += 4;
    }

    private void text(String text) {
        g.setFont(Palette.SMALL);
        g.setColor(Palette.MUTED);
        g.drawString(text, (float) x + 9, (float) y + 4);
        x += 9 + g.getFontMetrics().stringWidth(text) + 20;
    }
}
