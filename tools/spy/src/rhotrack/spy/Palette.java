// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.BasicStroke;
import java.awt.Color;
import java.awt.Font;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import java.awt.Stroke;

import rhotrack.spy.scene.DisplayedTrack;

/**
 * Colours, strokes and fonts: bright for the tracker's output, muted for its input, faint for grids
 * and labels.
 */
final class Palette {
    static final Color BACKGROUND = new Color(0x0c1117);
    static final Color PANEL = new Color(0x141b23);
    static final Color EDGE = new Color(0x2a3541);
    static final Color GRID = new Color(0x1f2a35);
    static final Color GRID_TEXT = new Color(0x6f8496);
    static final Color TEXT = new Color(0xd5dde5);
    static final Color MUTED = new Color(0x8d9cab);
    static final Color WARNING = new Color(0xff8f5a);
    static final Color TRUTH = new Color(0xd5dde5);

    static final Font PLAIN = new Font(Font.SANS_SERIF, Font.PLAIN, 12);
    static final Font SMALL = new Font(Font.SANS_SERIF, Font.PLAIN, 11);
    static final Font BOLD = new Font(Font.SANS_SERIF, Font.BOLD, 12);

    static final Stroke THIN = new BasicStroke(1f);
    static final Stroke LINE = new BasicStroke(1.6f, BasicStroke.CAP_ROUND, BasicStroke.JOIN_ROUND);
    static final Stroke DASHED = new BasicStroke(1f, BasicStroke.CAP_BUTT, BasicStroke.JOIN_ROUND,
            1f, new float[] {3, 4}, 0);

    private static final Color CONFIRMED = new Color(0x57e389);
    private static final Color TENTATIVE = new Color(0xf6d04d);
    private static final Color COASTING = new Color(0xff7b63);
    private static final Color[] SENSORS =
            {new Color(0x6fb1f0), new Color(0xc09bf5), new Color(0x54cfc4), new Color(0xe88fbd)};
    /** Colours of a value from low to high. */
    private static final Color[] RAMP = {new Color(0x3b4a68), new Color(0x7a4f9a),
        new Color(0xd0567d), new Color(0xf79a5c), new Color(0xfbe27a)};

    private Palette() {
    }

    static Color ofStatus(DisplayedTrack.Status status) {
        return switch (status) {
            case CONFIRMED -> CONFIRMED;
            case TENTATIVE -> TENTATIVE;
            default -> COASTING;
        };
    }

    static Color ofSensor(int id) {
        return SENSORS[Math.floorMod(id - 1, SENSORS.length)];
    }

    /** Colour of hypothesis number `index`; 0 is the best one. */
    static Color ofHypothesis(int index) {
        return rampColour(1 - index / 7.0);
    }

    static Color withAlpha(Color colour, double strength) {
        int alpha = (int) Math.round(255 * Math.max(0, Math.min(1, strength)));
        return new Color(colour.getRed(), colour.getGreen(), colour.getBlue(), alpha);
    }

    static Color rampColour(double share) {
        double place = Math.max(0, Math.min(1, share)) * (RAMP.length - 1);
        int below = Math.min((int) place, RAMP.length - 2);
        return mixed(RAMP[below], RAMP[below + 1], place - below);
    }

    private static Color mixed(Color a, Color b, double share) {
        return new Color((int) (a.getRed() + share * (b.getRed() - a.getRed())),
                (int) (a.getGreen() + share * (b.getGreen() - a.getGreen())),
                (int) (a.getBlue() + share * (b.getBlue() - a.getBlue())));
    }

    static void enableAntialiasing(Graphics2D g) {
        g.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
        g.setRenderingHint(RenderingHints.KEY_TEXT_ANTIALIASING,
                RenderingHints.VALUE_TEXT_ANTIALIAS_ON);
        g.setRenderingHint(RenderingHints.KEY_STROKE_CONTROL, RenderingHints.VALUE_STROKE_PURE);
    }
}
