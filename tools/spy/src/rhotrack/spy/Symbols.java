// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Color;
import java.awt.Graphics2D;
import java.awt.geom.Ellipse2D;
import java.awt.geom.Line2D;
import java.awt.geom.Path2D;
import java.awt.geom.Rectangle2D;

import rhotrack.spy.scene.DisplayedTrack;

/** The symbols in pictures, tables and legends. They differ in shape, not only in colour. */
final class Symbols {
    private Symbols() {
    }

    static void drawTrack(Graphics2D g, DisplayedTrack.Status status, double x, double y) {
        g.setColor(Palette.ofStatus(status));
        g.setStroke(Palette.LINE);
        switch (status) {
            case CONFIRMED -> g.fill(new Ellipse2D.Double(x - 4, y - 4, 8, 8));
            case TENTATIVE -> g.draw(new Ellipse2D.Double(x - 4, y - 4, 8, 8));
            default -> g.draw(polygon(x, y - 5, x + 5, y, x, y + 5, x - 5, y));
        }
    }

    static void drawPlot(Graphics2D g, double x, double y, double size) {
        g.fill(new Rectangle2D.Double(x - size / 2, y - size / 2, size, size));
    }

    static void drawEcho(Graphics2D g, double x, double y) {
        g.draw(new Rectangle2D.Double(x - 3.5, y - 3.5, 7, 7));
    }

    static void drawTruth(Graphics2D g, double x, double y) {
        g.setColor(Palette.withAlpha(Palette.TRUTH, 0.5));
        g.setStroke(Palette.THIN);
        g.draw(new Line2D.Double(x - 6, y, x + 6, y));
        g.draw(new Line2D.Double(x, y - 6, x, y + 6));
    }

    static void drawSensor(Graphics2D g, Color colour, double x, double y) {
        Path2D triangle = polygon(x, y - 7, x + 6.5, y + 5, x - 6.5, y + 5);
        g.setColor(Palette.BACKGROUND);
        g.fill(triangle);
        g.setColor(colour);
        g.setStroke(Palette.LINE);
        g.draw(triangle);
    }

    static void drawNorth(Graphics2D g, double x, double y) {
        g.setColor(Palette.MUTED);
        g.fill(polygon(x, y - 14, x + 6, y + 8, x, y + 3, x - 6, y + 8));
        g.setFont(Palette.BOLD);
        g.drawString("N", (float) (x - g.getFontMetrics().stringWidth("N") / 2.0),
                (float) (y + 22));
    }

    private static Path2D polygon(double... xy) {
        Path2D path = new Path2D.Double();
        path.moveTo(xy[0], xy[1]);
        for (int i = 2; i < xy.length; i += 2) {
            path.lineTo(xy[i], xy[i + 1]);
        }
        path.closePath();
        return path;
    }
}
