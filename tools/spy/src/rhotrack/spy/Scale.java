// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.util.Locale;

/** Round steps for rings and axes, and how lengths are written. */
final class Scale {
    private Scale() {
    }

    /** The smallest 1, 2 or 5 times a power of ten that is not below `least`. */
    static double roundStep(double least) {
        if (!(least > 0) || Double.isInfinite(least)) {
            return 1;
        }
        double power = Math.pow(10, Math.floor(Math.log10(least)));
        for (double factor : new double[] {1, 2, 5}) {
            if (factor * power >= least * (1 - 1e-9)) {
                return factor * power;
            }
        }
        return 10 * power;
    }

    /** A length that is a multiple of a step, in m or km, with the digits that the step needs. */
    static String length(double metres, double step) {
        if (step < 100 && Math.abs(metres) < 1000) {
            return number(metres, step) + " m";
        }
        return number(metres / 1000, step / 1000) + " km";
    }

    private static String number(double value, double step) {
        int digits = (int) Math.max(0, Math.min(6, Math.ceil(-Math.log10(step) - 1e-9)));
        String text = String.format(Locale.ROOT, "%." + digits + "f", value);
        return text.startsWith("-") ? "\u2212" + text.substring(1) : text;
    }
}
