// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Color;
import java.awt.Graphics2D;
import java.awt.geom.Ellipse2D;
import java.awt.geom.Line2D;

import rhotrack.spy.scene.LocalPoint;
import rhotrack.spy.scene.Scene;

/**
 * The tracker's internals in the plan view: crossings of bearings with ghosts struck out, and a
 * track's hypotheses.
 */
final class GhostsAndHypothesesLayer {
    private static final double RADIUS = 4.5;
    private static final double STROKE = 6.5;

    private GhostsAndHypothesesLayer() {
    }

    static void paintGhosts(Graphics2D g, Scene scene, ViewTransform view) {
        g.setStroke(Palette.THIN);
        for (Scene.Ghosts matrix : scene.internals().ghosts()) {
            for (Scene.Crossing crossing : matrix.crossings()) {
                paintCrossing(g, view.screenX(crossing.place().x()),
                        view.screenY(crossing.place().y()), crossing.pruned());
            }
        }
    }

    /** Paints a circle where bearings cross, struck out where the crossing is a ghost. */
    static void paintCrossing(Graphics2D g, double x, double y, boolean pruned) {
        g.setColor(Palette.withAlpha(pruned ? Palette.WARNING : Palette.TEXT, pruned ? 0.75 : 0.9));
        g.draw(new Ellipse2D.Double(x - RADIUS, y - RADIUS, 2 * RADIUS, 2 * RADIUS));
        if (pruned) {
            g.draw(new Line2D.Double(x - STROKE, y + STROKE, x + STROKE, y - STROKE));
        }
    }

    /**
     * Paints the position and velocity of each hypothesis of the selected track, likelier ones
     * brighter.
     */
    static void paintHypotheses(Graphics2D g, Scene scene, Integer track, ViewTransform view,
            double seconds) {
        Scene.Hypotheses of = track == null ? null : scene.internals().hypotheses().get(track);
        if (of == null) {
            return;
        }
        g.setStroke(Palette.LINE);
        for (int i = of.list().size() - 1; i >= 0; i--) {
            Scene.Hypothesis one = of.list().get(i);
            Color colour = Palette.withAlpha(Palette.ofHypothesis(i), 0.35 + 0.65 * one.share());
            LocalPoint to = new LocalPoint(one.place().x() + seconds * one.vx(),
                    one.place().y() + seconds * one.vy());
            double x = view.screenX(one.place().x());
            double y = view.screenY(one.place().y());
            g.setColor(colour);
            g.draw(new Line2D.Double(x, y, view.screenX(to.x()), view.screenY(to.y())));
            g.draw(new Ellipse2D.Double(x - 7, y - 7, 14, 14));
        }
    }
}
