// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.util.ArrayDeque;
import java.util.ArrayList;
import java.util.Deque;
import java.util.List;

/** Puts the parts of lists together. Parts may come in any order, twice, or never. */
public final class ListAssembler<T> {
    /** A list: `complete` is false where parts are missing. */
    public record Assembled<T>(int epoch, int scan, boolean complete, List<T> items) {
    }

    private record Key(int epoch, int scan) {
    }

    /**
     * So many lists back a late part is known as such. A log that is played in a loop must count as
     * new.
     */
    private static final int REMEMBERED = 2;
    /**
     * As many items as a list may have by its own count; a sender of endless parts fills no memory.
     */
    private static final int MAX_ITEMS = 32767;

    private final Deque<Key> done = new ArrayDeque<>();
    private Key current;
    private List<List<T>> parts;
    private int missing;
    private int items;

    /**
     * Takes a part. Returns the lists that are now to be shown, oldest first: the one before
     * without what is missing, when a new one begins; and the new one once it is whole.
     */
    public List<Assembled<T>> add(int epoch, int scan, int part, int numParts, List<T> content) {
        List<Assembled<T>> ready = new ArrayList<>();
        Key key = new Key(epoch, scan);
        if (numParts < 1 || part < 0 || part >= numParts || done.contains(key)) {
            return ready;
        }
        if (!key.equals(current)) {
            if (current != null) {
                ready.add(finish());
            }
            begin(key, numParts);
        }
        if (parts.size() != numParts || parts.get(part) != null || items + content.size() > MAX_ITEMS) {
            return ready;
        }
        parts.set(part, List.copyOf(content));
        items += content.size();
        missing--;
        if (missing == 0) {
            ready.add(finish());
        }
        return ready;
    }

    private void begin(Key key, int numParts) {
        current = key;
        missing = numParts;
        items = 0;
        parts = new ArrayList<>();
        for (int i = 0; i < numParts; i++) {
            parts.add(null);
        }
    }

    private Assembled<T> finish() {
        List<T> all = new ArrayList<>();
        for (List<T> part : parts) {
            if (part != null) {
                all.addAll(part);
            }
        }
        Assembled<T> list = new Assembled<>(current.epoch, current.scan, missing == 0, all);
        done.addLast(current);
        if (done.size() > REMEMBERED) {
            done.removeFirst();
        }
        current = null;
        parts = null;
        return list;
    }
}
