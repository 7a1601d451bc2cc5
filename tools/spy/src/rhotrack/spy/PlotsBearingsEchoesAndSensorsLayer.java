// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Color;
import java.awt.Graphics2D;
import java.awt.geom.Line2D;
import java.awt.geom.Rectangle2D;
import java.util.Map;

import rhotrack.spy.scene.Bounds;
import rhotrack.spy.scene.LookHistory;
import rhotrack.spy.scene.LocalPoint;
import rhotrack.spy.scene.Scene;

/**
 * Plots and bearings, which fade with age, echoes of the clutter map, and the sensors' positions.
 */
final class PlotsBearingsEchoesAndSensorsLayer {
    private PlotsBearingsEchoesAndSensorsLayer() {
    }

    static void paintPlots(Graphics2D g, Scene scene, ViewTransform view) {
        for (LookHistory.Faded<Scene.Plots> look : scene.plots()) {
            double strength = look.strength();
            double size = strength == 1 ? 4 : 3;
            g.setColor(Palette.withAlpha(Palette.ofSensor(look.content().sensorId()),
                    0.08 + 0.8 * strength * strength));
            for (LocalPoint place : look.content().places()) {
                Symbols.drawPlot(g, view.screenX(place.x()), view.screenY(place.y()), size);
            }
        }
    }

    /** Paints echoes as hollow squares, so that plots within them remain visible. */
    static void paintEchoes(Graphics2D g, Scene scene, ViewTransform view) {
        g.setStroke(Palette.THIN);
        for (Scene.Echo echo : scene.echoes()) {
            g.setColor(Palette.withAlpha(Palette.MUTED, 0.35 + 0.5 * echo.chance()));
            Symbols.drawEcho(g, view.screenX(echo.place().x()), view.screenY(echo.place().y()));
        }
    }

    static void paintBearings(Graphics2D g, Scene scene, ViewTransform view) {
        Bounds visible = view.visibleBounds();
        g.setStroke(Palette.THIN);
        for (LookHistory.Faded<Scene.Bearings> look : scene.bearings()) {
            LocalPoint sensor = look.content().sensor();
            double reach = visible.farthestFrom(sensor);
            double strength = look.strength();
            Color colour = Palette.ofSensor(look.content().sensorId());
            g.setColor(Palette.withAlpha(colour, 0.4 * strength * strength));
            for (double angle : look.content().angles()) {
                g.draw(new Line2D.Double(view.screenX(sensor.x()), view.screenY(sensor.y()),
                        view.screenX(sensor.x() + reach * Math.cos(angle)),
                        view.screenY(sensor.y() + reach * Math.sin(angle))));
            }
        }
    }

    static void paintSensors(Graphics2D g, Scene scene, ViewTransform view, LabelPlacer labels) {
        for (Map.Entry<Integer, LocalPoint> sensor : scene.sensors().entrySet()) {
            double x = view.screenX(sensor.getValue().x());
            double y = view.screenY(sensor.getValue().y());
            Color colour = Palette.ofSensor(sensor.getKey());
            Symbols.drawSensor(g, colour, x, y);
            labels.blockArea(x - 8, y - 8, 16, 16);
            g.setFont(Palette.BOLD);
            String text = "S" + sensor.getKey();
            Rectangle2D room = labels.placeLabel(x, y, 8, g.getFontMetrics().stringWidth(text), 13);
            if (room != null) {
                g.drawString(text, (float) room.getX(), (float) room.getMaxY() - 2);
            }
        }
    }
}
