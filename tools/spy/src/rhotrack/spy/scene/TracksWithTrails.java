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

/** The tracks of the last list, with their trails of past positions. */
public final class TracksWithTrails {
    private static final int TRAIL = 80;
    /** Number of successive incomplete lists without a track after which the track is removed. */
    private static final int PATIENCE = 5;

    private static final class Entry {
        final Deque<LocalPoint> trail = new ArrayDeque<>();
        DisplayedTrack mark;
        int unseen;
    }

    private final Map<Integer, Entry> entries = new LinkedHashMap<>();
    private Integer epoch;

    /**
     * Takes over a list. Tracks that an incomplete list does not name are kept, so that nothing
     * flickers.
     */
    public void applyList(ListAssembler.Assembled<DisplayedTrack> list) {
        if (epoch != null && epoch != list.epoch()) {
            entries.clear(); // another or restarted tracker: its ids mean other tracks
        }
        epoch = list.epoch();
        Set<Integer> named = new HashSet<>();
        for (DisplayedTrack mark : list.items()) {
            named.add(mark.id());
            if (mark.status() == DisplayedTrack.Status.DELETED) {
                entries.remove(mark.id());
            } else {
                updateTrack(mark);
            }
        }
        int patience = list.complete() ? 0 : PATIENCE;
        entries.entrySet()
                .removeIf(e -> !named.contains(e.getKey()) && ++e.getValue().unseen > patience);
    }

    private void updateTrack(DisplayedTrack mark) {
        Entry entry = entries.computeIfAbsent(mark.id(), id -> new Entry());
        entry.mark = mark;
        entry.unseen = 0;
        entry.trail.addLast(mark.place());
        if (entry.trail.size() > TRAIL) {
            entry.trail.removeFirst();
        }
    }

    public List<DisplayedTrack> tracks() {
        List<DisplayedTrack> marks = new ArrayList<>();
        entries.values().forEach(entry -> marks.add(entry.mark));
        return marks;
    }

    /** The trail of each track, oldest position first, in the order of tracks(). */
    public List<List<LocalPoint>> trails() {
        Collection<Entry> all = entries.values();
        List<List<LocalPoint>> trails = new ArrayList<>();
        all.forEach(entry -> trails.add(List.copyOf(entry.trail)));
        return trails;
    }
}
