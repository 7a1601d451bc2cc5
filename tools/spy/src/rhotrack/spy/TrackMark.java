// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.util.Comparator;
import java.util.List;

/** One track as the views need it; `ellipse` is null where its covariance is none. */
record TrackMark(int id, Status status, Place place, double height, double vx, double vy, int hits, int misses,
        double score, Ellipse ellipse) {
    enum Status { TENTATIVE, CONFIRMED, COASTING, DELETED }

    /** Tentative ones last: where room is scarce, they do without. */
    static List<TrackMark> byImportance(List<TrackMark> tracks) {
        return tracks.stream()
                .sorted(Comparator.comparing((TrackMark t) -> t.status == Status.TENTATIVE)
                        .thenComparing(TrackMark::id))
                .toList();
    }

    double speed() {
        return Math.hypot(vx, vy);
    }
}
