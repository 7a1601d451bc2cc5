// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.util.List;
import java.util.Map;

/**
 * What is to be drawn: an immutable copy of the model, so that painting needs no lock and a pause
 * is to keep one.
 */
public record Scene(List<LookHistory.Faded<Plots>> plots, List<LookHistory.Faded<Bearings>> bearings,
        List<LookHistory.Faded<Peaks>> peaks, List<TrackMark> tracks, List<List<Place>> trails, List<Truth> truth,
        List<Echo> echoes, List<Body> bodies, Map<Integer, Place> sensors, Thoughts thoughts, Health health) {
    /** Plots of (a part of) one look. */
    public record Plots(int sensorId, List<Place> places) {
    }

    /** Bearings of one look, rad counter-clockwise from east. */
    public record Bearings(int sensorId, Place sensor, List<Double> angles) {
    }

    /** The candidates of one search. */
    public record Peaks(List<Peak> peaks) {
    }

    public record Peak(double rho, double theta, double speed, double score, int scansHit, int sensorPairs) {
    }

    public record Truth(int id, Place place, double vx, double vy) {
    }

    /** Clutter that the tracker knows: it comes back to its place. */
    public record Echo(Place place, int sensorId, int hits, double chance) {
    }

    /** The rectangle of a track with a body, its length along the heading. */
    public record Body(int trackId, Place centre, double length, double width, double heading) {
    }

    /** What the tracker thought, where it was asked to show it. */
    public record Thoughts(List<Ghosts> ghosts, List<Accumulator> accumulators, List<Plane> planes,
            Map<Integer, Hypotheses> hypotheses) {
    }

    /** RHO_GHOSTS: the crossings of two sensors' bearings that meet. */
    public record Ghosts(int scan, List<Crossing> crossings) {
    }

    /** Pruned: another one is the target of one of its bearings. */
    public record Crossing(Place place, boolean pruned) {
    }

    /** Which of a search's accumulators: of all pairs of sensors, or of one. */
    public record Which(int method, boolean hasPair, int sensorA, int sensorB) {
    }

    /** RHO_ACCUMULATOR: the fullest cells; rho of the plane is measured from the origin. */
    public record Accumulator(Which which, int scan, Place origin, double rhoMin, double rhoMax,
            List<Cell> cells) {
    }

    /** trackId: of the track that the line started, 0: none. */
    public record Cell(double rho, double theta, double votes, int scans, int trackId) {
    }

    /** RHO_PLANE: rows of theta from 0 to pi, in each the votes over rho, 0 .. 127. */
    public record Plane(Which which, int scan, List<byte[]> rows) {
    }

    /** RHO_HYPOTHESES of one track; evidence: 0 none, 1 of plots, 2 of the line that started it. */
    public record Hypotheses(int trackId, int scan, double score, double calm, double steady, double maneuver,
            int evidence, double support, double shared, double clutter, List<Hypothesis> list) {
    }

    public record Hypothesis(double share, Place place, double vx, double vy, List<Integer> plots) {
    }

    /**
     * RHO_STATUS, the few figures that a status line has room for. Late scans came behind newer ones of
     * their sensor; lost ones have not come at all.
     */
    public record Status(int accepted, int lost, int late, int bad, int tentative, int confirmed, int coasting, double stepUs,
            double stepMaxUs, double clutterPerKm2) {
    }

    /**
     * RHO_WORK: work of the last step as a share of what it may be, negative where any is allowed;
     * what was left out.
     */
    public record Work(double share, long partialSteps, long notPrinted, long notLogged) {
    }

    /** How the messages themselves are doing; ages in seconds, negative where nothing came yet. */
    public record Health(Status status, Work work, List<String> sensorFaults, double statusAge, double tracksAge,
            long received, long ignored) {
    }
}
