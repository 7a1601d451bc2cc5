// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

/**
 * Geometry that the views share. Angles are counter-clockwise from east unless stated otherwise.
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

    /**
     * The place at a range and azimuth from the sensor; with elevation 0 the range is taken as
     * ground range.
     */
    public static LocalPoint fromPolar(LocalPoint sensor, double range, double azimuth,
            double elevation) {
        double ground = range * Math.cos(elevation);
        return new LocalPoint(sensor.x() + ground * Math.cos(azimuth),
                sensor.y() + ground * Math.sin(azimuth));
    }

    /** Direction in degrees clockwise from north, 0 to 360. */
    public static double compassDegrees(double east, double north) {
        double degrees = Math.toDegrees(Math.atan2(east, north));
        return degrees < 0 ? degrees + 360 : degrees;
    }

    public static Line lineThroughTrack(double x, double y, double vx, double vy) {
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
