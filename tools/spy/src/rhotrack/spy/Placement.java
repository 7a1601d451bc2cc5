// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Dimension;
import java.awt.Rectangle;
import java.util.List;

/** Where a window goes so that it does not cover another one. */
final class Placement {
    static final Dimension LEAST = new Dimension(640, 420);

    private Placement() {
    }

    /** Beside the other one where most of it fits, smaller if it must be; null: nowhere. */
    static Rectangle beside(Rectangle screen, Rectangle other, Dimension wanted) {
        int right = other.x + other.width;
        int below = other.y + other.height;
        Rectangle best = null;
        for (Rectangle free : List.of(
                new Rectangle(right, screen.y, screen.x + screen.width - right, screen.height),
                new Rectangle(screen.x, screen.y, other.x - screen.x, screen.height),
                new Rectangle(screen.x, below, screen.width, screen.y + screen.height - below),
                new Rectangle(screen.x, screen.y, screen.width, other.y - screen.y))) {
            Rectangle fitted = within(free, other, wanted);
            if (fitted.width >= LEAST.width && fitted.height >= LEAST.height
                    && (best == null || area(fitted) > area(best))) {
                best = fitted;
            }
        }
        return best;
    }

    /** As near to the other one as there is room. */
    private static Rectangle within(Rectangle free, Rectangle other, Dimension wanted) {
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
