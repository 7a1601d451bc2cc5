// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.BorderLayout;
import java.awt.Color;
import java.awt.Component;
import java.awt.Container;
import java.awt.Graphics2D;
import java.awt.image.BufferedImage;
import java.util.Comparator;
import javax.swing.BorderFactory;
import javax.swing.JPanel;
import javax.swing.JSplitPane;
import javax.swing.Timer;
import javax.swing.plaf.basic.BasicSplitPaneUI;

import rhotrack.spy.scene.Model;
import rhotrack.spy.scene.Scene;

/** All views of one model, with their buttons and keys. It can paint itself without a window. */
@SuppressWarnings("serial") // views are never serialised
final class AllViewsPanel extends JPanel {
    private static final int REFRESH_MS = 100;
    /** Longest time without a refresh: ages in the status line grow even without messages. */
    private static final long LONGEST_REST_NANOS = 1_000_000_000L;
    private static final double PAN_PIXELS = 60;
    private static final double ZOOM_A_KEY = 1.4;

    private final Model model;
    private final ViewOptions options = new ViewOptions();
    private final PlanView plan = new PlanView(options);
    private final ParameterSpaceView peaks = new ParameterSpaceView(options);
    private final TrackTable table = new TrackTable();
    private final StatusLine status = new StatusLine();
    private final Timer timer = new Timer(REFRESH_MS, event -> refreshIfChanged());
    private Scene scene;
    private boolean paused;
    private long seen = -1;
    private long refreshed;

    AllViewsPanel(Model model) {
        super(new BorderLayout());
        this.model = model;
        setBackground(Palette.PANEL);
        setFocusable(true);
        add(createControls().component(), BorderLayout.NORTH);
        JSplitPane side = splitPane(JSplitPane.VERTICAL_SPLIT, peaks, table, 0.6);
        add(splitPane(JSplitPane.HORIZONTAL_SPLIT, plan, side, 0.7), BorderLayout.CENTER);
        add(status, BorderLayout.SOUTH);
        PointerControl.attach(plan);
        plan.setSelectionListener(table::selectTrack);
    }

    void start() {
        timer.start();
    }

    void stop() {
        timer.stop();
    }

    private ButtonRow createControls() {
        ButtonRow controls = new ButtonRow(this);
        controls.addButton("Pause", "SPACE", () -> paused, this::togglePause);
        controls.addButton("Fit", "F", () -> false, plan::fit);
        controls.addButton("Clear", "C", () -> false, this::clear);
        controls.addGap();
        for (ViewOptions.Layer layer : ViewOptions.Layer.values()) {
            controls.addButton(layer.title, String.valueOf(layer.key), () -> options.shows(layer),
                    () -> {
                        options.toggle(layer);
                        repaint();
                    });
        }
        controls.bindKey("typed +", () -> plan.zoom(ZOOM_A_KEY));
        controls.bindKey("typed -", () -> plan.zoom(1 / ZOOM_A_KEY));
        controls.bindKey("LEFT", () -> plan.pan(PAN_PIXELS, 0));
        controls.bindKey("RIGHT", () -> plan.pan(-PAN_PIXELS, 0));
        controls.bindKey("UP", () -> plan.pan(0, PAN_PIXELS));
        controls.bindKey("DOWN", () -> plan.pan(0, -PAN_PIXELS));
        return controls;
    }

    private static JSplitPane splitPane(int orientation, Component first, Component second,
            double weight) {
        JSplitPane split = new JSplitPane(orientation, true, first, second);
        // the default UI paints knobs and edges in light grey
        BasicSplitPaneUI plain = new BasicSplitPaneUI();
        split.setUI(plain);
        plain.getDivider().setBorder(BorderFactory.createEmptyBorder());
        split.setBackground(Palette.EDGE);
        split.setBorder(BorderFactory.createEmptyBorder());
        split.setDividerSize(3);
        split.setResizeWeight(weight);
        return split;
    }

    /**
     * Freezes the views or goes on; messages are received during the pause, and shown when it ends.
     */
    private void togglePause() {
        paused = !paused;
        status.show(scene, paused);
    }

    private void clear() {
        model.clear();
        plan.fit();
    }

    private void refreshIfChanged() {
        boolean rested = System.nanoTime() - refreshed > LONGEST_REST_NANOS;
        if (!paused && (rested || model.changes() != seen)) {
            refresh();
        }
    }

    private void refresh() {
        seen = model.changes();
        refreshed = System.nanoTime();
        scene = model.scene();
        plan.show(scene);
        peaks.show(scene);
        table.show(scene);
        status.show(scene, paused);
    }

    /** Selects a painted track as a click on it does; 0: the track with the most hypotheses. */
    void selectTrack(int id) {
        int wanted = id != 0 ? id : scene.internals().hypotheses().values().stream()
                .max(Comparator.comparingInt(of -> of.list().size()))
                .map(Scene.Hypotheses::trackId).orElse(0);
        scene.tracks().stream().filter(track -> track.id() == wanted).findFirst()
                .map(track -> plan.pixelOf(track.place()))
                .ifPresent(at -> plan.selectAt(at.x, at.y));
    }

    /**
     * Paints the model's present state to an image. The layout is computed here, as there is no
     * window.
     */
    BufferedImage paintToImage(int width, int height) {
        setSize(width, height);
        layOutRecursively(this);
        refresh();
        layOutRecursively(this); // the status line may need more rows
        BufferedImage image = new BufferedImage(width, height, BufferedImage.TYPE_INT_RGB);
        Graphics2D g = image.createGraphics();
        g.setColor(Color.BLACK);
        printAll(g);
        g.dispose();
        return image;
    }

    private static void layOutRecursively(Container container) {
        container.doLayout();
        for (Component child : container.getComponents()) {
            if (child instanceof Container inner) {
                layOutRecursively(inner);
            }
        }
    }
}
