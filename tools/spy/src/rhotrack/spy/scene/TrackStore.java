// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.util.ArrayDeque;
import java.util.ArrayList;
import java.util.Collection;
import java.util.Deque;
import java.util.HashSet;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Map;
import java.util.Set;

/** The tracks of the last list, and where they came from. */
public final class TrackStore {
    private static final int TRAIL = 80;
    /** So many lists in a row that lack parts may not name a track before it goes. */
    private static final int PATIENCE = 5;

    private static final class Entry {
        final Deque<Place> trail = new ArrayDeque<>();
        TrackMark mark;
        int unseen;
    }

    private final Map<Integer, Entry> entries = new LinkedHashMap<>();
    private Integer epoch;

    /**
     * A list with parts missing says nothing of the tracks that it does not name: these stay, so
     * nothing flickers.
     */
    public void apply(ListAssembler.Assembled<TrackMark> list) {
        if (epoch != null && epoch != list.epoch()) {
            entries.clear(); // another tracker, or it was restarted: its numbers mean other tracks
        }
        epoch = list.epoch();
        Set<Integer> named = new HashSet<>();
        for (TrackMark mark : list.items()) {
            named.add(mark.id());
            if (mark.status() == TrackMark.Status.DELETED) {
                entries.remove(mark.id());
            } else {
                update(mark);
            }
        }
        int patience = list.complete() ? 0 : PATIENCE;
        entries.entrySet().removeIf(e -> !named.contains(e.getKey()) && ++e.getValue().unseen > patience);
    }

    private void update(TrackMark mark) {
        Entry entry = entries.computeIfAbsent(mark.id(), id -> new Entry());
        entry.mark = mark;
        entry.unseen = 0;
        entry.trail.addLast(mark.place());
        if (entry.trail.size() > TRAIL) {
            entry.trail.removeFirst();
        }
    }

    public List<TrackMark> tracks() {
        List<TrackMark> marks = new ArrayList<>();
        entries.values().forEach(entry -> marks.add(entry.mark));
        return marks;
    }

    /** Oldest place first; one trail a track, in the order of tracks(). */
    public List<List<Place>> trails() {
        Collection<Entry> all = entries.values();
        List<List<Place>> trails = new ArrayList<>();
        all.forEach(entry -> trails.add(List.copyOf(entry.trail)));
        return trails;
    }
}
