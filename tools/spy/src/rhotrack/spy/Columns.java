// SPDX-License-Identifier: MIT
package rhotrack.spy;

/** Columns as wide as their cells, with equal gaps; where they do not fit, the last ones go. */
final class Columns {
    static final double LEAST_GAP = 10;

    private Columns() {
    }

    /** Right edges of the columns that there is room for, the first one in any case. */
    static double[] rightEdges(double[] widths, double room) {
        int count = widths.length;
        while (count > 1 && total(widths, count) + count * LEAST_GAP > room) {
            count--;
        }
        double gap = Math.max(0, (room - total(widths, count)) / count);
        double[] edges = new double[count];
        double at = 0;
        for (int i = 0; i < count; i++) {
            at += gap + widths[i];
            edges[i] = at;
        }
        return edges;
    }

    private static double total(double[] widths, int count) {
        double sum = 0;
        for (int i = 0; i < count; i++) {
            sum += widths[i];
        }
        return sum;
    }
}
