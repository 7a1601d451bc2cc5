// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.util.ArrayDeque;
import java.util.ArrayList;
import java.util.Deque;
import java.util.Iterator;
import java.util.List;

/** The last looks of one sensor, newest last; a look may come in several parts. */
public final class LookHistory<T> {
    /**
     * The content of a part of a look; `strength` falls with the look's age from 1 (newest) towards
     * 0.
     */
    public record Faded<T>(double strength, T content) {
    }

    private static final class Look<T> {
        final int scan;
        final List<T> contents = new ArrayList<>();

        Look(int scan) {
            this.scan = scan;
        }
    }

    /** Most parts of a look, so that a faulty sender cannot fill the memory. */
    private static final int MAX_PARTS = 512;
    /** Least width of a sector in the number of looks a turn. */
    private static final double MIN_SECTOR_RAD = Math.toRadians(5);

    private final int turns;
    private final Deque<Look<T>> looks = new ArrayDeque<>();
    private int keep;
    private Integer epoch;

    /** Keeps the looks of the last `turns` turns of the antenna. */
    public LookHistory(int turns) {
        this.turns = turns;
        keep = turns;
    }

    /**
     * Number of looks in a turn by the width of their sector; 1 for a full circle, as which equal
     * limits count.
     */
    public static int looksPerTurn(double fromRad, double toRad) {
        double width = toRad - fromRad;
        if (width < 0) {
            width += 2 * Math.PI;
        }
        boolean circle = width <= 0 || width >= 2 * Math.PI - 1e-3 || Double.isNaN(width);
        return circle ? 1 : (int) Math.ceil(2 * Math.PI / Math.max(width, MIN_SECTOR_RAD) - 1e-6);
    }

    public void add(int newEpoch, int scan, int looksPerTurn, T content) {
        if (epoch != null && epoch != newEpoch) {
            looks.clear(); // the sensor was restarted, and its scan numbers begin anew
        }
        epoch = newEpoch;
        keep = turns * looksPerTurn;
        Look<T> look = findOrAddLook(scan);
        if (look.contents.size() < MAX_PARTS) {
            look.contents.add(content);
        }
        while (looks.size() > keep) {
            looks.removeFirst();
        }
    }

    /**
     * The look of this scan number; a number that is not in the history begins a new look, even if
     * it is lower than the last one.
     */
    private Look<T> findOrAddLook(int scan) {
        Iterator<Look<T>> newestFirst = looks.descendingIterator();
        while (newestFirst.hasNext()) {
            Look<T> look = newestFirst.next();
            if (look.scan == scan) {
                return look;
            }
        }
        Look<T> look = new Look<>(scan);
        looks.addLast(look);
        return look;
    }

    /**
     * The contents of all looks with their strength, oldest first, so that the newest is painted on
     * top.
     */
    public List<Faded<T>> contentsWithStrength() {
        List<Faded<T>> all = new ArrayList<>();
        int age = looks.size();
        for (Look<T> look : looks) {
            age--;
            double strength = 1 - (double) age / keep;
            look.contents.forEach(content -> all.add(new Faded<>(strength, content)));
        }
        return all;
    }
}
