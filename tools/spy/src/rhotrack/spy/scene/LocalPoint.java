// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

/** A point of the local frame: metres east and north. */
public record LocalPoint(double x, double y) {
    /** Largest coordinate that messages may contain. */
    private static final double LIMIT_M = 4e6;

    public boolean isWithinLimits() {
        return Math.abs(x) <= LIMIT_M && Math.abs(y) <= LIMIT_M; // false for NaN
    }
}
