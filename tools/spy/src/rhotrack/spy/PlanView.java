// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.Point;
import java.util.ArrayList;
import java.util.List;
import java.util.Locale;
import java.util.function.IntConsumer;
import javax.swing.JComponent;

import rhotrack.spy.scene.Bounds;
import rhotrack.spy.scene.DisplayedTrack;
import rhotrack.spy.scene.Geometry;
import rhotrack.spy.scene.LocalPoint;
import rhotrack.spy.scene.Scene;

/** The plan view of plots, tracks and sensors: north is up, east is right. */
@SuppressWarnings("serial") // views are never serialised
final class PlanView extends JComponent {
    private static final int FIT_MARGIN = 60;
    private static final double SELECT_PIXELS = 14;

    private final ViewTransform view = new ViewTransform();
    private final ViewOptions options;
    private Scene scene;
    private boolean follows = true;
    private Bounds fitted;
    private Point pointer;
    private Integer selected;
    private IntConsumer onSelect = id -> { };

    PlanView(ViewOptions options) {
        this.options = options;
        setPreferredSize(new Dimension(860, 700));
    }

    void show(Scene newScene) {
        scene = newScene;
        repaint();
    }

    /**
     * Fits the view to everything, and again as the scene grows, until the user moves the view.
     */
    void fit() {
        follows = true;
        fitted = null;
        repaint();
    }

    void zoomAbout(double x, double y, double factor) {
        follows = false;
        view.zoomAbout(x, y, factor);
        repaint();
    }

    void zoom(double factor) {
        zoomAbout(getWidth() / 2.0, getHeight() / 2.0, factor);
    }

    void pan(double right, double down) {
        follows = false;
        view.pan(right, down);
        repaint();
    }

    /** Sets the listener that is told the id of the clicked track; 0: none. */
    void setSelectionListener(IntConsumer listener) {
        onSelect = listener;
    }

    /** Selects the nearest track within SELECT_PIXELS, or none, and tells the listener. */
    void selectAt(double x, double y) {
        selected = null;
        double nearest = SELECT_PIXELS;
        for (DisplayedTrack track : scene == null ? List.<DisplayedTrack>of() : scene.tracks()) {
            double away = Math.hypot(view.screenX(track.place().x()) - x,
                    view.screenY(track.place().y()) - y);
            if (away <= nearest) {
                nearest = away;
                selected = track.id();
            }
        }
        onSelect.accept(selected == null ? 0 : selected);
        repaint();
    }

    /** The pixel at which a place is painted. */
    Point pixelOf(LocalPoint place) {
        return new Point((int) Math.round(view.screenX(place.x())),
                (int) Math.round(view.screenY(place.y())));
    }

    /**
     * Sets the pixel whose coordinates are written into the corner; null: the pointer has left the
     * view.
     */
    void setPointer(Point point) {
        pointer = point;
        repaint();
    }

    @Override
    protected void paintComponent(Graphics graphics) {
        Graphics2D g = (Graphics2D) graphics.create();
        Palette.enableAntialiasing(g);
        int width = getWidth();
        int height = getHeight() - Legend.HEIGHT;
        view.resize(width, height);
        g.setColor(Palette.BACKGROUND);
        g.fillRect(0, 0, width, getHeight());
        if (scene != null) {
            fitIfNeeded();
            paintScene(g, width, height);
        }
        g.dispose();
    }

    private void paintScene(Graphics2D g, int width, int height) {
        double seconds = TrackLayer.vectorSeconds(scene.tracks(), view.metresPerPixel());
        LabelPlacer labels = new LabelPlacer(width, height);
        labels.blockArea(width - 50, 0, 50, 60);
        labels.blockArea(0, 0, 290, 24);
        RangeRingsAndAxesLayer.paint(g, view, width, height);
        if (options.shows(ViewOptions.Layer.BEARINGS)) {
            PlotsBearingsEchoesAndSensorsLayer.paintBearings(g, scene, view);
        }
        if (options.shows(ViewOptions.Layer.GHOSTS)) {
            GhostsAndHypothesesLayer.paintGhosts(g, scene, view);
        }
        if (options.shows(ViewOptions.Layer.CLUTTER)) {
            PlotsBearingsEchoesAndSensorsLayer.paintEchoes(g, scene, view);
        }
        if (options.shows(ViewOptions.Layer.PLOTS)) {
            PlotsBearingsEchoesAndSensorsLayer.paintPlots(g, scene, view);
        }
        if (options.shows(ViewOptions.Layer.TRUTH)) {
            TrackLayer.paintTruth(g, scene, view, seconds);
        }
        if (options.shows(ViewOptions.Layer.TRAILS)) {
            TrackLayer.paintTrails(g, scene, view);
        }
        if (options.shows(ViewOptions.Layer.ELLIPSES)) {
            TrackLayer.paintEllipses(g, scene, view);
            TrackLayer.paintBodies(g, scene, view);
        }
        GhostsAndHypothesesLayer.paintHypotheses(g, scene, selected, view, seconds);
        TrackLayer.paintTracks(g, scene, view, seconds, labels);
        PlotsBearingsEchoesAndSensorsLayer.paintSensors(g, scene, view, labels);
        if (options.shows(ViewOptions.Layer.LABELS)) {
            TrackLayer.paintLabels(g, scene, view, labels);
        }
        Symbols.drawNorth(g, width - 26, 26);
        paintPointer(g);
        Legend.paint(g, scene, options, seconds, width, getHeight());
    }

    private void paintPointer(Graphics2D g) {
        g.setFont(Palette.SMALL);
        g.setColor(Palette.MUTED);
        if (pointer == null) {
            return;
        }
        double x = view.worldX(pointer.x);
        double y = view.worldY(pointer.y);
        g.drawString(String.format(Locale.ROOT, "x %.2f  y %.2f  range %.2f km   %03.0f\u00b0",
                x / 1000, y / 1000, Math.hypot(x, y) / 1000, Geometry.compassDegrees(x, y)),
                12, 18);
    }

    /**
     * Fits the view, while it follows the scene, only when something leaves it or it has become
     * much too large, so that it does not move all the time.
     */
    private void fitIfNeeded() {
        Bounds wanted = follows ? sceneBounds() : null;
        if (wanted == null) {
            return;
        }
        boolean tooLarge = fitted != null
                && Math.max(fitted.width() / wanted.width(),
                        fitted.height() / wanted.height()) > 2.5
                && Math.min(fitted.width() / wanted.width(),
                        fitted.height() / wanted.height()) > 1.5;
        if (fitted == null || tooLarge) {
            fitted = wanted;
        } else if (!fitted.contains(wanted)) {
            fitted = fitted.union(wanted);
        }
        view.fit(fitted, FIT_MARGIN); // every time, as the window's size may have changed
    }

    private Bounds sceneBounds() {
        List<LocalPoint> sure = new ArrayList<>(scene.sensors().values());
        scene.tracks().forEach(track -> sure.add(track.place()));
        scene.truth().forEach(target -> sure.add(target.place()));
        List<LocalPoint> doubtful = new ArrayList<>();
        scene.plots().forEach(look -> doubtful.addAll(look.content().places()));
        Bounds bounds = Bounds.of(sure);
        Bounds plots = Bounds.ofMost(doubtful);
        return bounds == null ? plots : bounds.union(plots);
    }
}
