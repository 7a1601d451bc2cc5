// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.FontMetrics;
import java.awt.Graphics2D;
import java.awt.geom.Ellipse2D;
import java.awt.geom.Line2D;

/** Range rings about the origin of the local frame, and the x and y axes. */
final class RangeRingsAndAxesLayer {
    /** Least distance of two rings in pixels. */
    private static final double MIN_GAP = 75;

    private RangeRingsAndAxesLayer() {
    }

    static void paint(Graphics2D g, ViewTransform view, int width, int height) {
        double originX = view.screenX(0);
        double originY = view.screenY(0);
        g.setColor(Palette.GRID);
        g.setStroke(Palette.THIN);
        g.draw(new Line2D.Double(0, originY, width, originY));
        g.draw(new Line2D.Double(originX, 0, originX, height));
        double step = RoundStepsAndLengths.roundStep(MIN_GAP * view.metresPerPixel());
        double gap = step / view.metresPerPixel();
        double nearX = Math.max(0, Math.max(-originX, originX - width));
        double nearY = Math.max(0, Math.max(-originY, originY - height));
        double farX = Math.max(Math.abs(originX), Math.abs(width - originX));
        double farY = Math.max(Math.abs(originY), Math.abs(height - originY));
        long first = Math.max(1, (long) Math.ceil(Math.hypot(nearX, nearY) / gap));
        long last = (long) (Math.hypot(farX, farY) / gap);
        for (long ring = first; ring <= last; ring++) {
            double radius = ring * gap;
            g.setColor(Palette.GRID);
            g.draw(new Ellipse2D.Double(originX - radius, originY - radius,
                    2 * radius, 2 * radius));
        }
        for (long ring = first; ring <= last; ring++) {
            drawRingLabel(g, RoundStepsAndLengths.formatLength(ring * step, step), originX,
                    originY, ring * gap, width, height);
        }
    }

    /**
     * Draws a ring's label on the ring, in the direction in which most of the picture lies as seen
     * from the origin.
     */
    private static void drawRingLabel(Graphics2D g, String text, double originX, double originY,
            double radius, int width, int height) {
        boolean originVisible = originX > 0 && originX < width && originY > 0 && originY < height;
        double right = width / 2.0 - originX;
        double down = height / 2.0 - originY;
        if (originVisible) {
            // One of the four diagonals, south-east unless another is clearly better, so that
            // labels do not move with every small pan.
            right = right < -0.15 * width ? -1 : 1;
            down = down < -0.15 * height ? -1 : 1;
        }
        double angle = Math.atan2(down, right);
        double x = originX + radius * Math.cos(angle);
        double y = originY + radius * Math.sin(angle);
        g.setFont(Palette.SMALL);
        FontMetrics metrics = g.getFontMetrics();
        int textWidth = metrics.stringWidth(text);
        g.setColor(Palette.BACKGROUND);
        g.fillRect((int) (x - textWidth / 2.0 - 3), (int) (y - 7), textWidth + 6, 14);
        g.setColor(Palette.GRID_TEXT);
        g.drawString(text, (float) (x - textWidth / 2.0), (float) (y + 4));
    }
}
