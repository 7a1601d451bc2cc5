// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.util.ArrayList;
import java.util.HashMap;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Map;
import java.util.TreeMap;
import java.util.function.Consumer;

/**
 * The state of sensors and tracker according to the messages received so far. Thread-safe: LCM's
 * thread stores messages, the painting thread takes copies.
 */
public final class Model {
    private static final int PLOT_TURNS = 12;
    private static final int BEARING_TURNS = 3;
    private static final int PEAK_LISTS = 6;
    /** Most sensors, as many as a tracker accepts. */
    private static final int MAX_CHANNELS = 64;

    private final Map<String, LookHistory<Scene.Plots>> plots = new LinkedHashMap<>();
    private final Map<String, LookHistory<Scene.Bearings>> bearings = new LinkedHashMap<>();
    private LookHistory<Scene.Peaks> peaks = new LookHistory<>(PEAK_LISTS);
    private ListAssembler<DisplayedTrack> trackParts = new ListAssembler<>();
    private ListAssembler<Scene.Truth> truthParts = new ListAssembler<>();
    private ListAssembler<Scene.Echo> echoParts = new ListAssembler<>();
    private ListAssembler<Scene.Body> bodyParts = new ListAssembler<>();
    private ListAssembler<Scene.Life> lifeParts = new ListAssembler<>();
    private TracksWithTrails tracks = new TracksWithTrails();
    private List<Scene.Truth> truth = List.of();
    private List<Scene.Echo> echoes = List.of();
    private List<Scene.Body> bodies = List.of();
    /** Probabilities of existence in RHO_LIFE, by track; and the tracker's epoch in it. */
    private Map<Integer, Double> existence = Map.of();
    private int existenceEpoch;
    private final Map<Integer, LocalPoint> sensors = new TreeMap<>();
    /** Sensor faults in RHO_SENSORS, by part of the list. */
    private final TreeMap<Integer, List<String>> sensorFaults = new TreeMap<>();
    /** Deviations from the stated noise and pd in RHO_LEARNED, by sensor. */
    private final TreeMap<Integer, List<String>> learned = new TreeMap<>();
    private final TrackerInternals internals = new TrackerInternals();
    private Scene.Status status;
    private Scene.Work work;
    private long statusNanos;
    private long tracksNanos;
    private long received;
    private long ignored;
    private long changes;

    public synchronized void addPlots(String channel, int epoch, int scan, int looksPerTurn,
            Scene.Plots look) {
        addLook(plots, PLOT_TURNS, channel, epoch, scan, looksPerTurn, look);
    }

    public synchronized void addBearings(String channel, int epoch, int scan, Scene.Bearings look) {
        addLook(bearings, BEARING_TURNS, channel, epoch, scan, 1, look);
        addSensor(look.sensorId(), look.sensor());
    }

    private static <T> void addLook(Map<String, LookHistory<T>> channels, int turns, String channel,
            int epoch, int scan, int looksPerTurn, T look) {
        if (channels.containsKey(channel) || channels.size() < MAX_CHANNELS) {
            channels.computeIfAbsent(channel, name -> new LookHistory<>(turns))
                    .add(epoch, scan, looksPerTurn, look);
        }
    }

    public synchronized void addSensor(int id, LocalPoint place) {
        if (sensors.containsKey(id) || sensors.size() < MAX_CHANNELS) {
            sensors.put(id, place);
        }
    }

    public synchronized void addPeaks(int scan, Scene.Peaks list) {
        peaks.add(0, scan, 1, list);
    }

    public synchronized void addTracks(int epoch, int scan, int part, int numParts,
            List<DisplayedTrack> marks) {
        trackParts.add(epoch, scan, part, numParts, marks).forEach(list -> {
            tracks.applyList(list);
            if (list.epoch() != existenceEpoch) {
                existence = Map.of(); // ids of another or restarted tracker
            }
        });
        tracksNanos = System.nanoTime();
    }

    public synchronized void addTruth(int scan, int part, int numParts, List<Scene.Truth> targets) {
        truthParts.add(0, scan, part, numParts, targets)
                .forEach(list -> truth = List.copyOf(list.items()));
    }

    public synchronized void addEchoes(int epoch, int scan, int part, int numParts,
            List<Scene.Echo> known) {
        echoParts.add(epoch, scan, part, numParts, known)
                .forEach(list -> echoes = List.copyOf(list.items()));
    }

    public synchronized void addBodies(int epoch, int scan, int part, int numParts,
            List<Scene.Body> known) {
        bodyParts.add(epoch, scan, part, numParts, known)
                .forEach(list -> bodies = List.copyOf(list.items()));
    }

    public synchronized void addLives(int epoch, int scan, int part, int numParts,
            List<Scene.Life> lives) {
        lifeParts.add(epoch, scan, part, numParts, lives).forEach(list -> {
            Map<Integer, Double> known = new HashMap<>();
            list.items().forEach(life -> known.put(life.trackId(), life.existence()));
            existence = Map.copyOf(known);
            existenceEpoch = list.epoch();
        });
    }

    /** Stores a message about the tracker's internals. */
    public synchronized void storeInternals(Consumer<TrackerInternals> message) {
        message.accept(internals);
    }

    public synchronized void setStatus(Scene.Status newStatus) {
        status = newStatus;
        statusNanos = System.nanoTime();
    }

    public synchronized void setWork(Scene.Work newWork) {
        work = newWork;
    }

    /** Sets the faults in one part of the sensor list; parts beyond MAX_CHANNELS are dropped. */
    public synchronized void setSensorFaults(int part, int numParts, List<String> faults) {
        if (part < MAX_CHANNELS) {
            sensorFaults.put(part, List.copyOf(faults));
        }
        sensorFaults.tailMap(numParts).clear();
    }

    public synchronized void setLearned(int sensorId, List<String> notes) {
        if (learned.containsKey(sensorId) || learned.size() < MAX_CHANNELS) {
            learned.put(sensorId, List.copyOf(notes));
        }
    }

    public synchronized void countMessage(boolean good) {
        received++;
        ignored += good ? 0 : 1;
        changes++;
    }

    /**
     * A number that grows with each message: while it stays equal there is nothing new to paint.
     */
    public synchronized long changes() {
        return changes;
    }

    /** Clears everything except the counts of messages. */
    public synchronized void clear() {
        plots.clear();
        bearings.clear();
        sensors.clear();
        sensorFaults.clear();
        learned.clear();
        peaks = new LookHistory<>(PEAK_LISTS);
        trackParts = new ListAssembler<>();
        truthParts = new ListAssembler<>();
        echoParts = new ListAssembler<>();
        bodyParts = new ListAssembler<>();
        lifeParts = new ListAssembler<>();
        tracks = new TracksWithTrails();
        truth = List.of();
        echoes = List.of();
        bodies = List.of();
        existence = Map.of();
        internals.clear();
        changes++;
    }

    /** An immutable copy of the present state, for painting. */
    public synchronized Scene scene() {
        List<LookHistory.Faded<Scene.Plots>> allPlots = new ArrayList<>();
        plots.values().forEach(history -> allPlots.addAll(history.contentsWithStrength()));
        List<LookHistory.Faded<Scene.Bearings>> allBearings = new ArrayList<>();
        bearings.values().forEach(history -> allBearings.addAll(history.contentsWithStrength()));
        List<String> faults = new ArrayList<>();
        sensorFaults.values().forEach(faults::addAll);
        learned.values().forEach(faults::addAll);
        Scene.Health health = new Scene.Health(status, work, faults, secondsSince(statusNanos),
                secondsSince(tracksNanos), received, ignored);
        return new Scene(allPlots, allBearings, peaks.contentsWithStrength(), tracks.tracks(),
                tracks.trails(), truth, echoes, bodies, existence, new TreeMap<>(sensors),
                internals.copyFor(tracks.tracks()), health);
    }

    private static double secondsSince(long nanos) {
        return nanos == 0 ? -1 : (System.nanoTime() - nanos) / 1e9;
    }
}
