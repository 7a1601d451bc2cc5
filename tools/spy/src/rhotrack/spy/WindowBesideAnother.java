// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Dimension;
import java.awt.Rectangle;
import java.util.List;

/** Placement of a window beside another one, without covering it. */
final class WindowBesideAnother {
    static final Dimension LEAST = new Dimension(640, 420);

    private WindowBesideAnother() {
    }

    /**
     * Bounds for the window beside the other one, where most of the wanted size fits; null where
     * not even LEAST fits.
     */
    static Rectangle beside(Rectangle screen, Rectangle other, Dimension wanted) {
        int right = other.x + other.width;
        int below = other.y + other.height;
        Rectangle best = null;
        for (Rectangle free : List.of(
                new Rectangle(right, screen.y, screen.x + screen.width - right, screen.height),
                new Rectangle(screen.x, screen.y, other.x - screen.x, screen.height),
                new Rectangle(screen.x, below, screen.width, screen.y + screen.height - below),
                new Rectangle(screen.x, screen.y, screen.width, other.y - screen.y))) {
            Rectangle fitted = cutToFreeArea(free, other, wanted);
            if (fitted.width >= LEAST.width && fitted.height >= LEAST.height
                    && (best == null || area(fitted) > area(best))) {
                best = fitted;
            }
        }
        return best;
    }

    /** The wanted size, cut to the free area, as near to the other window as possible. */
    private static Rectangle cutToFreeArea(Rectangle free, Rectangle other, Dimension wanted) {
        int width = Math.min(free.width, wanted.width);
        int height = Math.min(free.height, wanted.height);
        return new Rectangle(clamp(other.x, free.x, free.x + free.width - width),
                clamp(other.y, free.y, free.y + free.height - height), width, height);
    }

    private static int clamp(int value, int least, int most) {
        return Math.max(least, Math.min(value, most));
    }

    private static long area(Rectangle rectangle) {
        return (long) rectangle.width * rectangle.height;
    }
}
