// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.util.List;
import java.util.Map;

/**
 * What the views draw: an immutable copy of the model, so that painting needs no lock; a pause
 * keeps one copy.
 */
public record Scene(List<LookHistory.Faded<Plots>> plots,
        List<LookHistory.Faded<Bearings>> bearings, List<LookHistory.Faded<Peaks>> peaks,
        List<DisplayedTrack> tracks, List<List<LocalPoint>> trails, List<Truth> truth,
        List<Echo> echoes, List<Body> bodies, Map<Integer, Double> existence,
        Map<Integer, LocalPoint> sensors, Internals internals, Health health) {
    /** Plots of one look of a sensor, or of a part of the look. */
    public record Plots(int sensorId, List<LocalPoint> places) {
    }

    /** Bearings of one look, rad counter-clockwise from east. */
    public record Bearings(int sensorId, LocalPoint sensor, List<Double> angles) {
    }

    /** The candidate lines of one search. */
    public record Peaks(List<Peak> peaks) {
    }

    public record Peak(double rho, double theta, double speed, double score, int scansHit,
            int sensorPairs) {
    }

    public record Truth(int id, LocalPoint place, double vx, double vy) {
    }

    /** A clutter-map entry: a place that returns clutter again and again. */
    public record Echo(LocalPoint place, int sensorId, int hits, double chance) {
    }

    /** The estimated rectangle of an extended target, its length along the heading. */
    public record Body(int trackId, LocalPoint centre, double length, double width,
            double heading) {
    }

    /** RHO_LIFE: the probability that a track's target exists, visible or hidden. */
    public record Life(int trackId, double existence) {
    }

    /** The tracker's internals, where it was asked to publish them (--show). */
    public record Internals(List<Ghosts> ghosts, List<Accumulator> accumulators, List<Plane> planes,
            Map<Integer, Hypotheses> hypotheses) {
    }

    /** RHO_GHOSTS: the crossings of two sensors' bearings. */
    public record Ghosts(int scan, List<Crossing> crossings) {
    }

    /**
     * A crossing of two bearings; pruned: it is a ghost, as another crossing of one of its bearings
     * is the target.
     */
    public record Crossing(LocalPoint place, boolean pruned) {
    }

    /** Identity of an accumulator: of one pair of sensors, or of all pairs of a search. */
    public record Which(int method, boolean hasPair, int sensorA, int sensorB) {
    }

    /** RHO_ACCUMULATOR: the fullest cells of an accumulator; rho is measured from the origin. */
    public record Accumulator(Which which, int scan, LocalPoint origin, double rhoMin,
            double rhoMax, List<Cell> cells) {
    }

    /** A cell of an accumulator; trackId: the track that its line started, 0: none. */
    public record Cell(double rho, double theta, double votes, int scans, int trackId) {
    }

    /**
     * RHO_PLANE: the votes of an accumulator, 0 .. 127: rows of theta from 0 to pi, in each the
     * votes over rho.
     */
    public record Plane(Which which, int scan, List<byte[]> rows) {
    }

    /**
     * RHO_HYPOTHESES of one track; evidence: 0 none, 1 from plots, 2 from the line that started the
     * track.
     */
    public record Hypotheses(int trackId, int scan, double score, double calm, double steady,
            double maneuver, int evidence, double support, double shared, double clutter,
            List<Hypothesis> list) {
    }

    public record Hypothesis(double share, LocalPoint place, double vx, double vy,
            List<Integer> plots) {
    }

    /**
     * RHO_STATUS: the figures of the status line. Late scans arrived after newer ones of their
     * sensor; lost ones never arrived.
     */
    public record Status(int accepted, int lost, int late, int bad, int tentative, int confirmed,
            int coasting, double stepUs, double stepMaxUs, double clutterPerKm2) {
    }

    /**
     * RHO_WORK: work of the last step as a share of its limit, negative without a limit; counts of
     * skipped work.
     */
    public record Work(double share, long partialSteps, long notPrinted, long notLogged) {
    }

    /**
     * State of tracker and connection; ages in seconds, negative where nothing has been received.
     */
    public record Health(Status status, Work work, List<String> sensorFaults, double statusAge,
            double tracksAge, long received, long ignored) {
    }
}
