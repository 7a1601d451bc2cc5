// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

/**
 * The little geometry that the views share. Angles are counter-clockwise from east unless they say
 * otherwise.
 */
public final class Geometry {
    /**
     * The line through a track's place along its velocity: x cos(theta) + y sin(theta) = rho, theta
     * in [0, pi).
     */
    public record Line(double rho, double theta) {
    }

    private Geometry() {
    }

    /** A slant range counts as ground range where there is no elevation (0). */
    public static Place fromPolar(Place sensor, double range, double azimuth, double elevation) {
        double ground = range * Math.cos(elevation);
        return new Place(sensor.x() + ground * Math.cos(azimuth), sensor.y() + ground * Math.sin(azimuth));
    }

    /** Clockwise from north, 0 to 360, as people read it. */
    public static double compassDegrees(double east, double north) {
        double degrees = Math.toDegrees(Math.atan2(east, north));
        return degrees < 0 ? degrees + 360 : degrees;
    }

    public static Line lineOf(double x, double y, double vx, double vy) {
        double theta = Math.atan2(vx, -vy); // the direction of (-vy, vx), the line's normal
        double sign = 1;
        if (theta < 0) {
            theta += Math.PI;
            sign = -1;
        }
        if (theta >= Math.PI) {
            theta -= Math.PI;
            sign = -sign;
        }
        double speed = Math.hypot(vx, vy);
        return new Line(sign * (vx * y - vy * x) / speed, theta);
    }
}
