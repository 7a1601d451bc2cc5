// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.util.ArrayList;
import java.util.HashSet;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Map;
import java.util.Set;
import java.util.TreeMap;

/**
 * The tracker's internals that it publishes on request: ghosts, accumulators, planes and hypotheses
 * of its last steps.
 */
public final class TrackerInternals {
    /**
     * Most accumulators or ghost matrices: the pairs of sensors of a search, with room for two
     * methods.
     */
    private static final int MAX_PICTURES = 64;
    /** Most tracks with hypotheses: the most that a tracker has. */
    private static final int MAX_TRACKS = 8192;
    /** Steps after which a ghost matrix is dropped: its sensors have gone. */
    private static final int GHOST_STEPS = 20;

    private record Pair(int a, int b) {
    }

    private final Map<Pair, ListAssembler<Scene.Crossing>> ghostParts = new LinkedHashMap<>();
    private final Map<Pair, Scene.Ghosts> ghosts = new LinkedHashMap<>();
    private final Map<Scene.Which, Scene.Accumulator> accumulators = new LinkedHashMap<>();
    private final Map<Scene.Which, ListAssembler<byte[]>> planeParts = new LinkedHashMap<>();
    private final Map<Scene.Which, Scene.Plane> planes = new LinkedHashMap<>();
    private final TreeMap<Integer, Scene.Hypotheses> hypotheses = new TreeMap<>();
    private int newestScan;

    private static <K, V> boolean hasRoom(Map<K, V> map, K key) {
        return map.containsKey(key) || map.size() < MAX_PICTURES;
    }

    void addGhosts(int sensorA, int sensorB, int epoch, int scan, int part, int numParts,
            List<Scene.Crossing> crossings) {
        Pair pair = new Pair(sensorA, sensorB);
        newestScan = scan;
        if (hasRoom(ghostParts, pair)) {
            ghostParts.computeIfAbsent(pair, key -> new ListAssembler<>())
                    .add(epoch, scan, part, numParts, crossings)
                    .forEach(list -> ghosts.put(pair,
                            new Scene.Ghosts(list.scan(), List.copyOf(list.items()))));
        }
    }

    void addAccumulator(Scene.Accumulator accumulator) {
        if (hasRoom(accumulators, accumulator.which())) {
            accumulators.put(accumulator.which(), accumulator);
        }
    }

    void addPlane(Scene.Which which, int epoch, int scan, int part, int numParts,
            List<byte[]> rows) {
        if (hasRoom(planeParts, which)) {
            planeParts.computeIfAbsent(which, key -> new ListAssembler<>())
                    .add(epoch, scan, part, numParts, rows).stream()
                    .filter(ListAssembler.Assembled::complete)
                    .forEach(list -> planes.put(which,
                            new Scene.Plane(which, list.scan(), List.copyOf(list.items()))));
        }
    }

    void addHypotheses(Scene.Hypotheses of) {
        if (hypotheses.containsKey(of.trackId()) || hypotheses.size() < MAX_TRACKS) {
            hypotheses.put(of.trackId(), of);
        }
    }

    void clear() {
        ghostParts.clear();
        ghosts.clear();
        accumulators.clear();
        planeParts.clear();
        planes.clear();
        hypotheses.clear();
    }

    /**
     * A copy of the internals, without hypotheses of tracks that have ended and without old ghosts.
     */
    Scene.Internals copyFor(List<DisplayedTrack> tracks) {
        Set<Integer> ids = new HashSet<>();
        tracks.forEach(track -> ids.add(track.id()));
        hypotheses.keySet().removeIf(id -> !ids.contains(id) && !ids.isEmpty());
        List<Scene.Ghosts> newest = new ArrayList<>(ghosts.values());
        newest.removeIf(matrix -> Math.abs(newestScan - matrix.scan()) > GHOST_STEPS);
        return new Scene.Internals(newest, List.copyOf(accumulators.values()),
                List.copyOf(planes.values()), new TreeMap<>(hypotheses));
    }
}
