// SPDX-License-Identifier: MIT
package rhotrack.spy;

/**
 * Layout of a table's columns: each as wide as its cells, with equal gaps; the last columns are
 * left out where they do not fit.
 */
final class TableColumnWidths {
    static final double LEAST_GAP = 10;

    private TableColumnWidths() {
    }

    /** Right edges of the columns that fit into the width `room`; at least the first column. */
    static double[] rightEdges(double[] widths, double room) {
        int count = widths.length;
        while (count > 1 && totalWidth(widths, count) + count * LEAST_GAP > room) {
            count--;
        }
        double gap = Math.max(0, (room - totalWidth(widths, count)) / count);
        double[] edges = new double[count];
        double at = 0;
        for (int i = 0; i < count; i++) {
            at += gap + widths[i];
            edges[i] = at;
        }
        return edges;
    }

    private static double totalWidth(double[] widths, int count) {
        double sum = 0;
        for (int i = 0; i < count; i++) {
            sum += widths[i];
        }
        return sum;
    }
}
