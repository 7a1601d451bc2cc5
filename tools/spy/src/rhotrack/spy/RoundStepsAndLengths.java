// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.util.Locale;

/** Round steps of rings and axes, and lengths as text. */
final class RoundStepsAndLengths {
    private RoundStepsAndLengths() {
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

    /** A length as text in m or km, with the digits that multiples of `step` need. */
    static String formatLength(double metres, double step) {
        if (step < 100 && Math.abs(metres) < 1000) {
            return formatNumber(metres, step) + " m";
        }
        return formatNumber(metres / 1000, step / 1000) + " km";
    }

    private static String formatNumber(double value, double step) {
        int digits = (int) Math.max(0, Math.min(6, Math.ceil(-Math.log10(step) - 1e-9)));
        String text = String.format(Locale.ROOT, "%." + digits + "f", value);
        return text.startsWith("-") ? "\u2212" + text.substring(1) : text;
    }
}
