// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.util.Objects;

/** Counts what holds and names what does not. */
final class Checks {
    private int passed;
    private int failed;
    private String group = "";

    /** What the next checks belong to; an exception in them is a failure, not the end. */
    void group(String name, ThrowingRunnable checks) {
        group = name;
        try {
            checks.run();
        } catch (Exception e) {
            fail("threw " + e);
        }
    }

    interface ThrowingRunnable {
        void run() throws Exception;
    }

    void isTrue(String what, boolean holds) {
        if (holds) {
            passed++;
        } else {
            fail(what);
        }
    }

    void equal(String what, Object expected, Object actual) {
        isTrue(what + ": expected " + expected + ", is " + actual,
                Objects.equals(expected, actual));
    }

    void near(String what, double expected, double actual) {
        double tolerance = 1e-9 * Math.max(1, Math.abs(expected));
        isTrue(what + ": expected " + expected + ", is " + actual,
                Math.abs(expected - actual) <= tolerance);
    }

    private void fail(String what) {
        failed++;
        System.out.println("FAILED " + group + ": " + what);
    }

    /** Returns whether all held. */
    boolean report() {
        System.out.println(passed + " passed, " + failed + " failed");
        return failed == 0;
    }
}
