// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

/**
 * The ellipse of a two-dimensional covariance: semi-axes of one sigma, and where the long one
 * points.
 */
public record Ellipse(double major, double minor, double angle) {
    /**
     * Of the lower triangle xx, yx, yy. Null where that is no covariance, beyond what rounding to
     * float does to one: a tracker of another make must not make the view draw nonsense.
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
