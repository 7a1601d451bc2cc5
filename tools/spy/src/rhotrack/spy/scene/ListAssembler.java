// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.util.ArrayDeque;
import java.util.ArrayList;
import java.util.Deque;
import java.util.List;

/**
 * Assembles lists that are sent in several messages. Parts may come in any order, twice, or never.
 */
public final class ListAssembler<T> {
    /** An assembled list; `complete` is false where parts are missing. */
    public record Assembled<T>(int epoch, int scan, boolean complete, List<T> items) {
    }

    private record Key(int epoch, int scan) {
    }

    /**
     * Number of finished lists whose late parts are recognised and dropped; small, as a log that is
     * played in a loop repeats its numbers.
     */
    private static final int REMEMBERED = 2;
    /** Most items of a list, so that a sender of endless parts cannot fill the memory. */
    private static final int MAX_ITEMS = 32767;

    private final Deque<Key> done = new ArrayDeque<>();
    private Key current;
    private List<List<T>> parts;
    private int missing;
    private int items;

    /**
     * Adds a part, and returns the lists that are finished by it, oldest first: the previous list,
     * incomplete, where a new one begins; and the new one where it is complete.
     */
    public List<Assembled<T>> add(int epoch, int scan, int part, int numParts, List<T> content) {
        List<Assembled<T>> ready = new ArrayList<>();
        Key key = new Key(epoch, scan);
        if (numParts < 1 || part < 0 || part >= numParts || done.contains(key)) {
            return ready;
        }
        if (!key.equals(current)) {
            if (current != null) {
                ready.add(finishList());
            }
            beginList(key, numParts);
        }
        if (parts.size() != numParts || parts.get(part) != null
                || items + content.size() > MAX_ITEMS) {
            return ready;
        }
        parts.set(part, List.copyOf(content));
        items += content.size();
        missing--;
        if (missing == 0) {
            ready.add(finishList());
        }
        return ready;
    }

    private void beginList(Key key, int numParts) {
        current = key;
        missing = numParts;
        items = 0;
        parts = new ArrayList<>();
        for (int i = 0; i < numParts; i++) {
            parts.add(null);
        }
    }

    private Assembled<T> finishList() {
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
