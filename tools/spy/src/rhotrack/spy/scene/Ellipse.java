// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

/**
 * The one-sigma ellipse of a two-dimensional covariance: semi-axes, and direction of the major
 * axis.
 */
public record Ellipse(double major, double minor, double angle) {
    /**
     * Ellipse of the covariance with lower triangle xx, yx, yy; null where this is not positive
     * semidefinite, except for rounding to float: a faulty tracker must not make the view draw
     * nonsense.
     */
    public static Ellipse of(double xx, double yx, double yy) {
        double mean = (xx + yy) / 2;
        double spread = Math.hypot((xx - yy) / 2, yx);
        double smallest = mean - spread;
        boolean valid = xx >= 0 && yy >= 0 && Double.isFinite(spread) && smallest >= -1e-5 * mean;
        if (!valid || mean <= 0) {
            return null;
        }
        return new Ellipse(Math.sqrt(mean + spread), Math.sqrt(Math.max(smallest, 0)),
                Math.atan2(2 * yx, xx - yy) / 2);
    }
}
