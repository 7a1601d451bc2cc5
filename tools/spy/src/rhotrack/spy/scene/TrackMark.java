// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.util.Comparator;
import java.util.List;

/** One track as the views need it; `ellipse` is null where its covariance is none. */
public record TrackMark(int id, Status status, Place place, double height, double vx, double vy, int hits, int misses,
        double score, Ellipse ellipse) {
    public enum Status { TENTATIVE, CONFIRMED, COASTING, DELETED }

    /** Tentative ones last: where room is scarce, they do without. */
    public static List<TrackMark> byImportance(List<TrackMark> tracks) {
        return tracks.stream()
                .sorted(Comparator.comparing((TrackMark t) -> t.status == Status.TENTATIVE)
                        .thenComparing(TrackMark::id))
                .toList();
    }

    public double speed() {
        return Math.hypot(vx, vy);
    }
}
