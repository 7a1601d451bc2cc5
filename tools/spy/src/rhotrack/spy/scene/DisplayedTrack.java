// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.util.Comparator;
import java.util.List;

/** A track as the views show it; `ellipse` is null where the track has no valid covariance. */
public record DisplayedTrack(int id, Status status, LocalPoint place, double height, double vx,
        double vy, int hits, int misses, double score, Ellipse ellipse) {
    public enum Status { TENTATIVE, CONFIRMED, COASTING, DELETED }

    /** The tracks in the order in which they get room: tentative ones last. */
    public static List<DisplayedTrack> byImportance(List<DisplayedTrack> tracks) {
        return tracks.stream()
                .sorted(Comparator.comparing((DisplayedTrack t) -> t.status == Status.TENTATIVE)
                        .thenComparing(DisplayedTrack::id))
                .toList();
    }

    public double speed() {
        return Math.hypot(vx, vy);
    }
}
