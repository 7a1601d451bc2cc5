// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

/** A point of the local frame: metres east and north. */
public record Place(double x, double y) {
    /** Beyond this the messages' own limits are broken: such a place is nobody's. */
    private static final double LIMIT_M = 4e6;

    public boolean isSane() {
        return Math.abs(x) <= LIMIT_M && Math.abs(y) <= LIMIT_M; // false for NaN
    }
}
