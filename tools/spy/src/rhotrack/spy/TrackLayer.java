// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Color;
import java.awt.FontMetrics;
import java.awt.Graphics2D;
import java.awt.Shape;
import java.awt.geom.AffineTransform;
import java.awt.geom.Ellipse2D;
import java.awt.geom.Line2D;
import java.awt.geom.Path2D;
import java.awt.geom.Rectangle2D;
import java.util.List;
import java.util.Locale;

import rhotrack.spy.scene.DisplayedTrack;
import rhotrack.spy.scene.Ellipse;
import rhotrack.spy.scene.LocalPoint;
import rhotrack.spy.scene.Scene;

/** Tracks with trails, ellipses, bodies, vectors and labels, and the true targets where known. */
final class TrackLayer {
    private static final double SIGMAS = 3;
    /** Least length of the median track's velocity vector. */
    private static final double VECTOR_PIXELS = 22;
    /** Smallest ellipse drawn: smaller ones are hidden by the track's symbol. */
    private static final double MIN_ELLIPSE_PIXELS = 4.5;

    private static final double LABEL_GAP = 6;

    private TrackLayer() {
    }

    /** Seconds of motion that velocity vectors show, a round number; 0 where nothing moves. */
    static double vectorSeconds(List<DisplayedTrack> tracks, double metresPerPixel) {
        double[] speeds = tracks.stream()
                .mapToDouble(DisplayedTrack::speed).filter(v -> v > 0).sorted().toArray();
        if (speeds.length == 0) {
            return 0;
        }
        return RoundStepsAndLengths.roundStep(
                VECTOR_PIXELS * metresPerPixel / speeds[speeds.length / 2]);
    }

    static void paintTruth(Graphics2D g, Scene scene, ViewTransform view, double seconds) {
        for (Scene.Truth target : scene.truth()) {
            double x = view.screenX(target.place().x());
            double y = view.screenY(target.place().y());
            Symbols.drawTruth(g, x, y);
            drawVector(g, target.place(), target.vx() * seconds, target.vy() * seconds, view);
        }
    }

    static void paintTrails(Graphics2D g, Scene scene, ViewTransform view) {
        g.setStroke(Palette.THIN);
        for (int i = 0; i < scene.tracks().size(); i++) {
            List<LocalPoint> trail = scene.trails().get(i);
            Color colour = Palette.ofStatus(scene.tracks().get(i).status());
            for (int k = 1; k < trail.size(); k++) {
                LocalPoint from = trail.get(k - 1);
                LocalPoint to = trail.get(k);
                g.setColor(Palette.withAlpha(colour, 0.1 + 0.5 * k / trail.size()));
                g.draw(new Line2D.Double(view.screenX(from.x()), view.screenY(from.y()),
                        view.screenX(to.x()), view.screenY(to.y())));
            }
        }
    }

    static void paintEllipses(Graphics2D g, Scene scene, ViewTransform view) {
        for (DisplayedTrack track : scene.tracks()) {
            Ellipse ellipse = track.ellipse();
            double scale = SIGMAS / view.metresPerPixel();
            if (ellipse == null || ellipse.major() * scale < MIN_ELLIPSE_PIXELS) {
                continue;
            }
            double a = ellipse.major() * scale;
            double b = ellipse.minor() * scale;
            AffineTransform place = AffineTransform.getTranslateInstance(
                    view.screenX(track.place().x()), view.screenY(track.place().y()));
            place.rotate(-ellipse.angle()); // the y axis of the screen points down
            Shape outline =
                    place.createTransformedShape(new Ellipse2D.Double(-a, -b, 2 * a, 2 * b));
            g.setColor(Palette.withAlpha(Palette.ofStatus(track.status()), 0.1));
            g.fill(outline);
            g.setColor(Palette.withAlpha(Palette.ofStatus(track.status()), 0.6));
            g.setStroke(Palette.THIN);
            g.draw(outline);
        }
    }

    static void paintBodies(Graphics2D g, Scene scene, ViewTransform view) {
        g.setColor(Palette.TEXT);
        g.setStroke(Palette.THIN);
        for (Scene.Body body : scene.bodies()) {
            double length = body.length() / view.metresPerPixel();
            double width = body.width() / view.metresPerPixel();
            AffineTransform place = AffineTransform.getTranslateInstance(
                    view.screenX(body.centre().x()), view.screenY(body.centre().y()));
            place.rotate(-body.heading()); // the y axis of the screen points down
            g.draw(place.createTransformedShape(
                    new Rectangle2D.Double(-length / 2, -width / 2, length, width)));
        }
    }

    static void paintTracks(Graphics2D g, Scene scene, ViewTransform view, double seconds,
            LabelPlacer labels) {
        for (DisplayedTrack track : scene.tracks()) {
            g.setColor(Palette.ofStatus(track.status()));
            g.setStroke(Palette.LINE);
            drawVector(g, track.place(), track.vx() * seconds, track.vy() * seconds, view);
            double x = view.screenX(track.place().x());
            double y = view.screenY(track.place().y());
            Symbols.drawTrack(g, track.status(), x, y);
            labels.blockArea(x - 5, y - 5, 10, 10);
        }
        for (DisplayedTrack track : scene.tracks()) {
            blockAreasOnVector(track, view, seconds, labels);
        }
    }

    private static void drawVector(Graphics2D g, LocalPoint from, double east, double north,
            ViewTransform view) {
        Path2D line = new Path2D.Double();
        line.moveTo(view.screenX(from.x()), view.screenY(from.y()));
        line.lineTo(view.screenX(from.x() + east), view.screenY(from.y() + north));
        g.draw(line);
    }

    /**
     * Keeps labels off the vector by a few small boxes along it: one box around a slanting line
     * would take too much room.
     */
    private static void blockAreasOnVector(DisplayedTrack track, ViewTransform view, double seconds,
            LabelPlacer labels) {
        for (double share : new double[] {0.35, 0.65, 1}) {
            double x = view.screenX(track.place().x() + share * seconds * track.vx());
            double y = view.screenY(track.place().y() + share * seconds * track.vy());
            labels.blockArea(x - 3, y - 3, 6, 6);
        }
    }

    /** Paints id and speed of tracks; confirmed tracks get room first. */
    static void paintLabels(Graphics2D g, Scene scene, ViewTransform view, LabelPlacer labels) {
        FontMetrics bold = g.getFontMetrics(Palette.BOLD);
        FontMetrics small = g.getFontMetrics(Palette.SMALL);
        for (DisplayedTrack track : DisplayedTrack.byImportance(scene.tracks())) {
            String id = Integer.toString(track.id());
            String speed = String.format(Locale.ROOT, "%.0f m/s", track.speed());
            double x = view.screenX(track.place().x());
            double y = view.screenY(track.place().y());
            int idWidth = bold.stringWidth(id) + 6;
            Rectangle2D room =
                    labels.placeLabel(x, y, LABEL_GAP, idWidth + small.stringWidth(speed), 14);
            if (room == null) {
                continue;
            }
            LabelPlacer.paintLeader(g, x, y, LABEL_GAP, room, Palette.ofStatus(track.status()));
            g.setColor(Palette.withAlpha(Palette.BACKGROUND, 0.6));
            g.fill(room);
            float left = (float) room.getX();
            float baseline = (float) room.getMaxY() - 3;
            g.setColor(Palette.ofStatus(track.status()));
            g.setFont(Palette.BOLD);
            g.drawString(id, left, baseline);
            g.setColor(Palette.MUTED);
            g.setFont(Palette.SMALL);
            g.drawString(speed, left + idWidth, baseline);
        }
    }
}
