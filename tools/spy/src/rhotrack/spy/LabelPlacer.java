// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Color;
import java.awt.Graphics2D;
import java.awt.geom.Line2D;
import java.awt.geom.Rectangle2D;
import java.util.ArrayList;
import java.util.List;

/**
 * Places labels beside their marks without overlap, in the order of the calls: important ones are
 * to come first. Labels without room are left out.
 */
final class LabelPlacer {
    /** Most labels placed: more would neither be read nor placed in reasonable time. */
    private static final int MAX_LABELS = 200;
    /**
     * Sides of the mark that are tried, in this order: right above, right below, left above, ...
     */
    private static final int[][] SIDES =
            {{1, -1}, {1, 1}, {-1, -1}, {-1, 1}, {1, 0}, {-1, 0}, {0, -1}, {0, 1}};

    /** Factor of the gap for the second try, where there is no room close to the mark. */
    private static final double FAR = 3;

    private final Rectangle2D screen;
    private final List<Rectangle2D> taken = new ArrayList<>();
    private int placed;

    LabelPlacer(double width, double height) {
        screen = new Rectangle2D.Double(2, 2, width - 4, height - 4);
    }

    /** Marks an area that labels must not cover. */
    void blockArea(double x, double y, double width, double height) {
        taken.add(new Rectangle2D.Double(x, y, width, height));
    }

    /**
     * Reserves and returns the area of a label of this size, `gap` pixels beside the mark; null
     * where there is no room.
     */
    Rectangle2D placeLabel(double markX, double markY, double gap, double width, double height) {
        if (placed >= MAX_LABELS || !screen.contains(markX, markY)) {
            return null;
        }
        for (double distance : new double[] {gap, FAR * gap}) {
            for (int[] side : SIDES) {
                Rectangle2D room = new Rectangle2D.Double(
                        besideMark(markX, side[0], distance, width),
                        besideMark(markY, side[1], distance, height), width, height);
                if (screen.contains(room) && taken.stream().noneMatch(room::intersects)) {
                    taken.add(room);
                    placed++;
                    return room;
                }
            }
        }
        return null;
    }

    private static double besideMark(double mark, int side, double gap, double size) {
        if (side == 0) {
            return mark - size / 2;
        }
        return side > 0 ? mark + gap : mark - gap - size;
    }

    /** Draws a line from the mark to its label, unless the label is close to the mark. */
    static void paintLeader(Graphics2D g, double markX, double markY, double gap, Rectangle2D room,
            Color colour) {
        double x = Math.max(room.getMinX(), Math.min(markX, room.getMaxX()));
        double y = Math.max(room.getMinY(), Math.min(markY, room.getMaxY()));
        double distance = Math.hypot(x - markX, y - markY);
        if (distance < 1.9 * gap) {
            return;
        }
        double start = gap / distance;
        g.setColor(Palette.withAlpha(colour, 0.7));
        g.setStroke(Palette.THIN);
        g.draw(new Line2D.Double(markX + start * (x - markX), markY + start * (y - markY), x, y));
    }
}
