// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.util.Arrays;
import java.util.List;

/** A rectangle of the local frame, in metres. */
public record Bounds(double west, double south, double east, double north) {
    /** Number of places from which the outermost ones are left out. */
    private static final int ENOUGH_TO_TRIM = 60;

    public static Bounds of(List<LocalPoint> places) {
        return of(places, 0);
    }

    /**
     * Bounds of the places without the outermost 2 % on each side, so that one wild plot does not
     * shrink the view of the others.
     */
    public static Bounds ofMost(List<LocalPoint> places) {
        return of(places, places.size() < ENOUGH_TO_TRIM ? 0 : places.size() / 50);
    }

    private static Bounds of(List<LocalPoint> places, int trim) {
        if (places.isEmpty()) {
            return null;
        }
        double[] xs = places.stream().mapToDouble(LocalPoint::x).toArray();
        double[] ys = places.stream().mapToDouble(LocalPoint::y).toArray();
        Arrays.sort(xs);
        Arrays.sort(ys);
        int last = xs.length - 1 - trim;
        return new Bounds(xs[trim], ys[trim], xs[last], ys[last]);
    }

    public Bounds union(Bounds other) {
        return other == null ? this
                : new Bounds(Math.min(west, other.west), Math.min(south, other.south),
                        Math.max(east, other.east), Math.max(north, other.north));
    }

    public boolean contains(Bounds other) {
        return west <= other.west && south <= other.south
                && east >= other.east && north >= other.north;
    }

    /** Distance of the farthest corner from the place. */
    public double farthestFrom(LocalPoint place) {
        return Math.hypot(Math.max(Math.abs(west - place.x()), Math.abs(east - place.x())),
                Math.max(Math.abs(south - place.y()), Math.abs(north - place.y())));
    }

    public double width() {
        return east - west;
    }

    public double height() {
        return north - south;
    }
}
