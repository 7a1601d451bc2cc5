// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.util.ArrayDeque;
import java.util.ArrayList;
import java.util.Deque;
import java.util.Iterator;
import java.util.List;

/** The last looks of one sensor, newest last, each of one or several parts. */
public final class LookHistory<T> {
    /** A part of a look; `strength` fades from 1 (newest) towards 0. */
    public record Faded<T>(double strength, T content) {
    }

    private static final class Look<T> {
        final int scan;
        final List<T> contents = new ArrayList<>();

        Look(int scan) {
            this.scan = scan;
        }
    }

    /** Against a sender that puts no end to the parts of one look. */
    private static final int MAX_PARTS = 512;
    /** A sector of less than this is taken as this wide when looks are counted. */
    private static final double MIN_SECTOR_RAD = Math.toRadians(5);

    private final int turns;
    private final Deque<Look<T>> looks = new ArrayDeque<>();
    private int keep;
    private Integer epoch;

    /** Keeps so many looks; where a look is a sector only, so many whole turns of them. */
    public LookHistory(int turns) {
        this.turns = turns;
        keep = turns;
    }

    /** How many looks go round: 1 for a whole circle, which is what two zeros say. */
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
            looks.clear(); // the sensor has started again, its numbers too
        }
        epoch = newEpoch;
        keep = turns * looksPerTurn;
        Look<T> look = find(scan);
        if (look.contents.size() < MAX_PARTS) {
            look.contents.add(content);
        }
        while (looks.size() > keep) {
            looks.removeFirst();
        }
    }

    /**
     * A number that is not here is a new look, whatever it is: the view has no quarrel with a
     * sensor's counting.
     */
    private Look<T> find(int scan) {
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

    /** Oldest first, so that the newest is painted on top. */
    public List<Faded<T>> fading() {
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
