// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.util.EnumSet;

/** The layers that the user has switched on. */
final class ViewOptions {
    enum Layer {
        PLOTS('P', "Plots"), BEARINGS('B', "Bearings"), TRAILS('H', "Trails"),
        ELLIPSES('E', "Ellipses"), LABELS('L', "Labels"), TRUTH('T', "Truth"),
        CLUTTER('M', "Clutter map"), GHOSTS('G', "Ghosts"), VOTES('V', "Votes");

        final char key;
        final String title;

        Layer(char key, String title) {
            this.key = key;
            this.title = title;
        }
    }

    private final EnumSet<Layer> shown = EnumSet.allOf(Layer.class);

    boolean shows(Layer layer) {
        return shown.contains(layer);
    }

    void toggle(Layer layer) {
        if (!shown.remove(layer)) {
            shown.add(layer);
        }
    }
}
