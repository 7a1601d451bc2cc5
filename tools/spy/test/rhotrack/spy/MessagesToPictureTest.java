// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.image.BufferedImage;
import java.io.ByteArrayOutputStream;
import java.io.DataOutputStream;
import java.io.IOException;
import java.util.Arrays;
import java.util.List;
import java.util.Map;
import java.awt.event.InputEvent;
import java.awt.event.MouseEvent;
import java.util.Random;
import lcm.lcm.LCMEncodable;
import rhotrack.accumulator_cell_t;
import rhotrack.accumulator_t;
import rhotrack.bearing_scan_t;
import rhotrack.body_list_t;
import rhotrack.body_t;
import rhotrack.clutter_map_t;
import rhotrack.direction_scan_t;
import rhotrack.direction_t;
import rhotrack.echo_t;
import rhotrack.ghost_matrix_t;
import rhotrack.ghost_t;
import rhotrack.hypotheses_t;
import rhotrack.hypothesis_t;
import rhotrack.learned_t;
import rhotrack.life_t;
import rhotrack.peak_list_t;
import rhotrack.peak_t;
import rhotrack.plane_row_t;
import rhotrack.plane_t;
import rhotrack.polar_plot_t;
import rhotrack.polar_scan_t;
import rhotrack.sensor_list_t;
import rhotrack.sensor_t;
import rhotrack.status_t;
import rhotrack.track_life_t;
import rhotrack.track_list_t;
import rhotrack.track_t;
import rhotrack.work_t;
import rhotrack.spy.scene.DisplayedTrack;
import rhotrack.spy.scene.MessageDecoder;
import rhotrack.spy.scene.Model;
import rhotrack.spy.scene.LocalPoint;
import rhotrack.spy.scene.Scene;

/** From messages, good and bad, to what is painted. */
final class MessagesToPictureTest {
    private MessagesToPictureTest() {
    }

    static void run(Checks check) {
        check.group("messages", () -> good(check));
        check.group("bad messages", () -> bad(check));
        check.group("mutated messages", () -> mutated(check));
        check.group("picture", () -> picture(check));
        check.group("bodies", () -> bodies(check));
        check.group("lives", () -> lives(check));
        check.group("thoughts", () -> thoughts(check));
        check.group("bad thoughts", () -> badThoughts(check));
        check.group("pictures of thoughts", () -> thoughtsInPictures(check));
        check.group("fingerprints", () -> {
            check.isTrue("tracks are known",
                    MessageDecoder.canDecode(track_list_t.LCM_FINGERPRINT));
            check.isTrue("a part of a message is none",
                    !MessageDecoder.canDecode(track_t.LCM_FINGERPRINT));
        });
    }

    private static byte[] bytes(LCMEncodable message) throws IOException {
        ByteArrayOutputStream bytes = new ByteArrayOutputStream();
        message.encode(new DataOutputStream(bytes));
        return bytes.toByteArray();
    }

    private static polar_scan_t polarScan() {
        polar_scan_t scan = new polar_scan_t();
        scan.sensor_id = 3;
        scan.num_parts = 1;
        scan.sensor_x_m = 100;
        polar_plot_t plot = new polar_plot_t();
        plot.range_m = 2000;
        scan.polar_plots = new polar_plot_t[] {plot};
        scan.num_polar_plots = 1;
        return scan;
    }

    private static track_list_t trackList(int scan, int status) {
        track_t track = new track_t();
        track.track_id = 12;
        track.status = (byte) status;
        track.x_m = 500;
        track.vx_mps = 100;
        track.covariance[0] = 900;
        track.covariance[2] = 400;
        track_list_t list = new track_list_t();
        list.scan = scan;
        list.num_parts = 1;
        list.num_tracks = 1;
        list.tracks = new track_t[] {track};
        return list;
    }

    private static bearing_scan_t bearings() {
        bearing_scan_t scan = new bearing_scan_t();
        scan.sensor_id = 2;
        scan.num_bearings = 2;
        scan.bearing_rad = new float[] {1, -2};
        return scan;
    }

    private static direction_scan_t directions() {
        direction_t direction = new direction_t();
        direction.bearing_rad = -1;
        direction.elevation_rad = 0.5f;
        direction.has_elevation = 1;
        direction_scan_t scan = new direction_scan_t();
        scan.sensor_id = 4;
        scan.sensor_y_m = 50;
        scan.num_directions = 1;
        scan.directions = new direction_t[] {direction};
        return scan;
    }

    private static peak_list_t peaks() {
        peak_t peak = new peak_t();
        peak.rho_m = -300;
        peak.theta_rad = 1;
        peak_list_t list = new peak_list_t();
        list.num_peaks = 1;
        list.peaks = new peak_t[] {peak};
        return list;
    }

    private static sensor_list_t sensors(int part, int numParts, int id, int doubted, int silent) {
        sensor_t sensor = new sensor_t();
        sensor.sensor_id = (short) id;
        sensor.kind = sensor_t.POLAR;
        sensor.is_doubted = (byte) doubted;
        sensor.is_silent = (byte) silent;
        sensor_list_t list = new sensor_list_t();
        list.part = (short) part;
        list.num_parts = (short) numParts;
        list.num_sensors = 1;
        list.sensors = new sensor_t[] {sensor};
        return list;
    }

    private static clutter_map_t echoes(int scan, int part, int numParts, float x) {
        echo_t echo = new echo_t();
        echo.sensor_id = 3;
        echo.hits = 12;
        echo.x_m = x;
        echo.chance = 0.5f;
        clutter_map_t list = new clutter_map_t();
        list.scan = scan;
        list.part = (short) part;
        list.num_parts = (short) numParts;
        list.num_echoes = 1;
        list.echoes = new echo_t[] {echo};
        return list;
    }

    private static body_list_t bodies(int scan, double length) {
        body_t body = new body_t();
        body.track_id = 12;
        body.x_m = 500;
        body.length_m = (float) length;
        body.width_m = 100;
        body.heading_rad = 0.5f;
        body_list_t list = new body_list_t();
        list.scan = scan;
        list.num_parts = 1;
        list.num_bodies = 1;
        list.bodies = new body_t[] {body};
        return list;
    }

    private static void bodies(Checks check) throws IOException {
        Model model = new Model();
        AllViewsPanel panel = new AllViewsPanel(model);
        MessageDecoder decoder = new MessageDecoder(model);
        decoder.decode("RHO_POLAR_3", bytes(polarScan()));
        decoder.decode("RHO_TRACKS", bytes(trackList(1, track_t.CONFIRMED)));
        BufferedImage point = panel.paintToImage(900, 600);
        decoder.decode("RHO_BODIES", bytes(bodies(1, 400)));
        check.equal("a body", List.of(new Scene.Body(12, new LocalPoint(500, 0), 400, 100, 0.5)),
                model.scene().bodies());
        check.isTrue("is an outline",
                differ(point, panel.paintToImage(900, 600), 0, 40, 640, 560) > 50);
        decoder.decode("RHO_BODIES", bytes(bodies(2, -1)));
        body_list_t turned = bodies(3, 400);
        turned.bodies[0].heading_rad = Float.NaN;
        decoder.decode("RHO_BODIES", bytes(turned));
        turned = bodies(4, 400);
        turned.part = 1;
        decoder.decode("RHO_BODIES", bytes(turned));
        check.equal("bad ones", 3L, model.scene().health().ignored());
        check.equal("change nothing", 1, model.scene().bodies().size());
        model.clear();
        check.equal("forgotten", 0, model.scene().bodies().size());
    }

    private static life_t lives(int scan, int part, int numParts, int track, double existence,
            double visibility) {
        track_life_t life = new track_life_t();
        life.track_id = track;
        life.existence = (float) existence;
        life.visibility = (float) visibility;
        life_t list = new life_t();
        list.scan = scan;
        list.death_rate = 0.005f;
        list.hide_rate = 0.005f;
        list.appear_rate = 0.3f;
        list.lived_scans = 100;
        list.part = (short) part;
        list.num_parts = (short) numParts;
        list.num_tracks_total = (short) numParts;
        list.num_tracks = 1;
        list.tracks = new track_life_t[] {life};
        return list;
    }

    private static void lives(Checks check) throws IOException {
        Model model = new Model();
        AllViewsPanel panel = new AllViewsPanel(model);
        MessageDecoder decoder = new MessageDecoder(model);
        decoder.decode("RHO_TRACKS", bytes(trackList(1, track_t.CONFIRMED)));
        BufferedImage unknown = panel.paintToImage(1280, 800);
        decoder.decode("RHO_LIFE", bytes(lives(1, 0, 2, 12, 0.75, 0.5)));
        check.equal("half of a list", Map.of(), model.scene().existence());
        decoder.decode("RHO_LIFE", bytes(lives(1, 1, 2, 40, 1, 1)));
        check.equal("both parts", Map.of(12, 0.75, 40, 1.0), model.scene().existence());
        BufferedImage known = panel.paintToImage(1280, 800);
        check.isTrue("is in the table", differ(unknown, known, 900, 450, 1280, 770) > 10);
        check.equal("and nowhere else", 0, differ(unknown, known, 0, 40, 880, 760));
        decoder.decode("RHO_LIFE", bytes(lives(2, 0, 1, 12, 0.5, 0.5 + 5e-7)));
        check.equal("the next one, rounded", Map.of(12, 0.5), model.scene().existence());
        check.equal("all taken", 0L, model.scene().health().ignored());
        life_t[] bad = {lives(3, 1, 1, 12, 1, 1), lives(3, 0, 1, 12, 1.5, 1),
            lives(3, 0, 1, 12, 1, -0.1), lives(3, 0, 1, 12, Double.NaN, 0),
            lives(3, 0, 1, 12, 1, Double.NaN), lives(3, 0, 1, 12, 0.5, 0.51),
            lives(3, 0, 1, 12, 1, 1), lives(3, 0, 1, 12, 1, 1), lives(3, 0, 1, 12, 1, 1),
            lives(3, 0, 1, 12, 1, 1), lives(3, 0, 1, 12, 1, 1)};
        bad[6].death_rate = 1.5f;
        bad[7].hide_rate = Float.NaN;
        bad[8].appear_rate = 2.5f;
        bad[9].lived_scans = -1;
        bad[10].num_tracks = life_t.MAX_TRACKS + 1;
        bad[10].tracks = new track_life_t[bad[10].num_tracks];
        Arrays.fill(bad[10].tracks, bad[0].tracks[0]);
        for (life_t message : bad) {
            decoder.decode("RHO_LIFE", bytes(message));
        }
        check.equal("bad ones", (long) bad.length, model.scene().health().ignored());
        check.equal("change nothing", Map.of(12, 0.5), model.scene().existence());
        track_list_t restarted = trackList(1, track_t.CONFIRMED);
        restarted.epoch = 9;
        decoder.decode("RHO_TRACKS", bytes(restarted));
        check.equal("ids of a tracker that is gone", Map.of(), model.scene().existence());
        life_t anew = lives(1, 0, 1, 12, 0.25, 0.25);
        anew.epoch = 9;
        decoder.decode("RHO_LIFE", bytes(anew));
        check.equal("those of the new one", Map.of(12, 0.25), model.scene().existence());
        model.clear();
        check.equal("forgotten", Map.of(), model.scene().existence());
    }

    private static work_t work(long work, long most, long partial) {
        work_t message = new work_t();
        message.work = work;
        message.work_max = most;
        message.partial_steps = partial;
        message.events_not_logged = 9;
        return message;
    }

    private static learned_t learned(int id, double range, double cross, double pd) {
        learned_t message = new learned_t();
        message.sensor_id = (short) id;
        message.sigma_range_factor = (float) range;
        message.sigma_cross_factor = (float) cross;
        message.pd_stated = 0.9f;
        Arrays.fill(message.pd, 0.9f);
        message.pd[5] = (float) pd;
        return message;
    }

    /** The crossing of targets' bearings at (800, 0), and at (200, 300) one with this fate. */
    private static ghost_matrix_t ghosts(int scan, int part, int numParts, int reason) {
        ghost_t target = new ghost_t();
        target.x_m = 800;
        ghost_t other = new ghost_t();
        other.x_m = 200;
        other.y_m = 300;
        other.reason = (byte) reason;
        ghost_matrix_t matrix = new ghost_matrix_t();
        matrix.scan = scan;
        matrix.sensor_a_id = 2;
        matrix.sensor_b_id = 3;
        matrix.part = (short) part;
        matrix.num_parts = (short) numParts;
        matrix.num_elements = 2;
        matrix.elements = new ghost_t[] {target, other};
        return matrix;
    }

    private static accumulator_t search(int scan, float votes, int trackId) {
        accumulator_cell_t cell = new accumulator_cell_t();
        cell.rho_m = -300;
        cell.theta_rad = 1;
        cell.votes = votes;
        cell.scan_mask = 0xd;
        cell.track_id = trackId;
        accumulator_t search = new accumulator_t();
        search.scan = scan;
        search.method = accumulator_t.NHT;
        search.num_scans = 4;
        search.rho_min_m = -1000;
        search.rho_max_m = 1000;
        search.rho_cells = 400;
        search.theta_cells = 180;
        search.votes_max = votes;
        search.num_cells = 1;
        search.cells = new accumulator_cell_t[] {cell};
        return search;
    }

    private static plane_t plane(int scan, int part, int numParts, int votes) {
        plane_t plane = new plane_t();
        plane.scan = scan;
        plane.method = accumulator_t.NHT;
        plane.part = (short) part;
        plane.num_parts = (short) numParts;
        plane.num_rows = plane_t.MAX_ROWS;
        plane.rows = new plane_row_t[plane_t.MAX_ROWS];
        for (int i = 0; i < plane.rows.length; i++) {
            plane.rows[i] = new plane_row_t();
            Arrays.fill(plane.rows[i].votes, (byte) votes);
        }
        return plane;
    }

    private static hypotheses_t hypotheses(int trackId, float share) {
        hypotheses_t of = new hypotheses_t();
        of.track_id = trackId;
        of.calm = 0.25f;
        of.steady = 0.5f;
        of.maneuver = 0.25f;
        of.evidence = hypotheses_t.PLOTS;
        of.support = 0.75f;
        of.shared = 0.25f;
        of.num_hypotheses = 2;
        of.hypotheses = new hypothesis_t[] {new hypothesis_t(), new hypothesis_t()};
        of.hypotheses[0].share = share;
        of.hypotheses[0].x_m = 500;
        of.hypotheses[0].plots = new short[] {4, -1, 7};
        of.hypotheses[1].share = 1 - share;
        of.hypotheses[1].x_m = 500;
        of.hypotheses[1].y_m = 200;
        of.hypotheses[1].vy_mps = 100;
        return of;
    }

    private static void thoughts(Checks check) throws IOException {
        Model model = new Model();
        MessageDecoder decoder = new MessageDecoder(model);
        decoder.decode("RHO_TRACKS", bytes(trackList(1, track_t.CONFIRMED)));
        decoder.decode("RHO_GHOSTS", bytes(ghosts(1, 0, 2, ghost_t.UNMATCHED)));
        check.equal("half of a matrix", 0, model.scene().internals().ghosts().size());
        decoder.decode("RHO_GHOSTS", bytes(ghosts(1, 1, 2, ghost_t.APART)));
        check.equal("crossings of both parts that meet",
                List.of(new Scene.Crossing(new LocalPoint(800, 0), false),
                        new Scene.Crossing(new LocalPoint(200, 300), true),
                        new Scene.Crossing(new LocalPoint(800, 0), false)),
                model.scene().internals().ghosts().get(0).crossings());
        decoder.decode("RHO_ACCUMULATOR", bytes(search(1, 7, 12)));
        decoder.decode("RHO_ACCUMULATOR", bytes(search(2, 5, 0)));
        check.equal("the last search", List.of(new Scene.Cell(-300, 1, 5, 3, 0)),
                model.scene().internals().accumulators().get(0).cells());
        for (int part = 0; part < 4; part++) {
            check.equal("a plane needs all its parts", 0,
                    model.scene().internals().planes().size());
            decoder.decode("RHO_PLANE", bytes(plane(2, part, 4, 30 * part)));
        }
        check.equal("64 rows", 64, model.scene().internals().planes().get(0).rows().size());
        check.equal("in their order", (byte) 90,
                model.scene().internals().planes().get(0).rows().get(63)[5]);
        decoder.decode("RHO_HYPOTHESES", bytes(hypotheses(12, 0.75f)));
        Scene.Hypotheses of = model.scene().internals().hypotheses().get(12);
        check.equal("plots", List.of(4, -1, 7), of.list().get(0).plots());
        check.near("shares", 0.25, of.list().get(1).share());
        check.near("evidence", 0.75, of.support());
        check.equal("all taken", 0L, model.scene().health().ignored());
        decoder.decode("RHO_HYPOTHESES", bytes(hypotheses(13, 0.75f)));
        check.equal("of a track that is not there", null,
                model.scene().internals().hypotheses().get(13));
        decoder.decode("RHO_GHOSTS", bytes(ghosts(30, 0, 1, ghost_t.ROW)));
        check.equal("the newest matrix alone", 2,
                model.scene().internals().ghosts().get(0).crossings().size());
        model.clear();
        check.equal("forgotten",
                new Scene.Internals(List.of(), List.of(), List.of(), Map.of()),
                model.scene().internals());
    }

    private static void badThoughts(Checks check) throws IOException {
        Model model = new Model();
        MessageDecoder decoder = new MessageDecoder(model);
        decoder.decode("RHO_GHOSTS", bytes(ghosts(1, 0, 1, 7)));
        decoder.decode("RHO_GHOSTS", bytes(ghosts(1, 1, 1, ghost_t.ROW)));
        ghost_matrix_t nowhere = ghosts(1, 0, 1, ghost_t.ROW);
        nowhere.elements[0].x_m = Float.NaN;
        decoder.decode("RHO_GHOSTS", bytes(nowhere));
        accumulator_t turned = search(1, 7, 12);
        turned.rho_max_m = -2000;
        decoder.decode("RHO_ACCUMULATOR", bytes(turned));
        decoder.decode("RHO_ACCUMULATOR", bytes(search(1, Float.POSITIVE_INFINITY, 12)));
        decoder.decode("RHO_PLANE", bytes(plane(1, 0, 1, -3)));
        decoder.decode("RHO_HYPOTHESES", bytes(hypotheses(12, 1.5f)));
        hypotheses_t more = hypotheses(12, 0.5f);
        more.calm = 1.5f;
        decoder.decode("RHO_HYPOTHESES", bytes(more));
        check.equal("all refused", 8L, model.scene().health().ignored());
        check.equal("nothing is thought",
                new Scene.Internals(List.of(), List.of(), List.of(), Map.of()),
                model.scene().internals());
        for (int i = 0; i < 300; i++) {
            ghost_matrix_t pair = ghosts(1, 0, 1, ghost_t.ROW);
            pair.sensor_a_id = (short) i;
            decoder.decode("RHO_GHOSTS", bytes(pair));
            accumulator_t of = search(1, 7, 12);
            of.has_pair = 1;
            of.sensor_a_id = (short) i;
            decoder.decode("RHO_ACCUMULATOR", bytes(of));
        }
        check.equal("no more pairs than there can be", 64,
                model.scene().internals().ghosts().size());
        check.equal("and no more searches", 64, model.scene().internals().accumulators().size());
    }

    private static void thoughtsInPictures(Checks check) throws IOException {
        Model model = new Model();
        AllViewsPanel panel = new AllViewsPanel(model);
        MessageDecoder decoder = new MessageDecoder(model);
        decoder.decode("RHO_POLAR_3", bytes(polarScan()));
        decoder.decode("RHO_TRACKS", bytes(trackList(1, track_t.CONFIRMED)));
        BufferedImage before = panel.paintToImage(900, 600);
        decoder.decode("RHO_GHOSTS", bytes(ghosts(1, 0, 1, ghost_t.ROW)));
        BufferedImage ghosts = panel.paintToImage(900, 600);
        check.isTrue("ghosts are struck out", differ(before, ghosts, 0, 40, 640, 560) > 20);
        int calm = count(ghosts, Palette.rampColour(1).getRGB());
        decoder.decode("RHO_ACCUMULATOR", bytes(search(1, 7, 12)));
        for (int part = 0; part < 4; part++) {
            decoder.decode("RHO_PLANE", bytes(plane(1, part, 4, 127)));
        }
        BufferedImage votes = panel.paintToImage(900, 600);
        check.isTrue("a plane is an image",
                count(votes, Palette.rampColour(1).getRGB()) > calm + 5000);
        decoder.decode("RHO_HYPOTHESES", bytes(hypotheses(12, 0.75f)));
        BufferedImage unselected = panel.paintToImage(900, 600);
        check.equal("nobody has asked for hypotheses", 0,
                differ(votes, unselected, 0, 40, 640, 560));
        panel.selectTrack(12);
        BufferedImage selected = panel.paintToImage(900, 600);
        check.isTrue("they are in the plan", differ(unselected, selected, 0, 40, 640, 560) > 20);
        check.isTrue("and beside it", differ(unselected, selected, 660, 350, 900, 570) > 500);
        click(panel, 3, 3);
        check.equal("a click elsewhere", 0,
                differ(unselected, panel.paintToImage(900, 600), 0, 40, 900, 570));
        panel.selectTrack(0);
        check.equal("that with the most", 0,
                differ(selected, panel.paintToImage(900, 600), 0, 40, 900, 570));
    }

    /** On the plan view, as the pointer does it. */
    private static void click(java.awt.Container container, int x, int y) {
        for (java.awt.Component child : container.getComponents()) {
            if (child instanceof PlanView plan) {
                plan.dispatchEvent(new MouseEvent(plan, MouseEvent.MOUSE_CLICKED, 0,
                        InputEvent.BUTTON1_DOWN_MASK, x, y, 1, false));
            } else if (child instanceof java.awt.Container inner) {
                click(inner, x, y);
            }
        }
    }

    /** Pixels in a rectangle that are not the same. */
    private static int differ(BufferedImage a, BufferedImage b, int left, int top, int right,
            int bottom) {
        int differing = 0;
        for (int x = left; x < right; x++) {
            for (int y = top; y < bottom; y++) {
                differing += a.getRGB(x, y) == b.getRGB(x, y) ? 0 : 1;
            }
        }
        return differing;
    }

    private static void good(Checks check) throws IOException {
        Model model = new Model();
        MessageDecoder decoder = new MessageDecoder(model);
        decoder.decode("RHO_POLAR_3", bytes(polarScan()));
        decoder.decode("RHO_TRACKS", bytes(trackList(1, track_t.COASTING)));
        decoder.decode("RHO_BEARINGS_2", bytes(bearings()));
        decoder.decode("RHO_PEAKS", bytes(peaks()));
        status_t status = new status_t();
        status.scans_bad = Integer.MAX_VALUE;
        status.messages_bad = 5;
        decoder.decode("RHO_STATUS", bytes(status));
        Scene scene = model.scene();
        check.equal("plots", List.of(new LocalPoint(2100, 0)),
                scene.plots().get(0).content().places());
        check.equal("sensors", new LocalPoint(100, 0), scene.sensors().get(3));
        check.equal("tracks", DisplayedTrack.Status.COASTING, scene.tracks().get(0).status());
        check.near("ellipse", 30, scene.tracks().get(0).ellipse().major());
        check.equal("bearings", List.of(1.0, -2.0), scene.bearings().get(0).content().angles());
        decoder.decode("RHO_DIRECTIONS_4", bytes(directions()));
        check.equal("directions", List.of(new Scene.Bearings(4, new LocalPoint(0, 50),
                List.of(-1.0))), model.scene().bearings().stream().map(b -> b.content())
                .filter(b -> b.sensorId() == 4).toList());
        check.near("peaks", -300, scene.peaks().get(0).content().peaks().get(0).rho());
        check.equal("counters stay at their limit", Integer.MAX_VALUE,
                scene.health().status().bad());
        status.scans_lost = 12;
        status.scans_late = 9;
        decoder.decode("RHO_STATUS", bytes(status));
        check.equal("skipped numbers that came after all are late", 9,
                model.scene().health().status().late());
        check.equal("and not lost", 3, model.scene().health().status().lost());
        status.scans_late = 20;
        decoder.decode("RHO_STATUS", bytes(status));
        check.equal("more late ones are none the less lost", 0,
                model.scene().health().status().lost());
        decoder.decode("RHO_WORK", bytes(work(250, 1000, 3)));
        check.equal("work", new Scene.Work(0.25, 3, 0, 9), model.scene().health().work());
        decoder.decode("RHO_WORK", bytes(work(250, 0, 0)));
        check.equal("work without a limit", new Scene.Work(-1, 0, 0, 9),
                model.scene().health().work());
        decoder.decode("RHO_SENSORS", bytes(sensors(0, 2, 3, 1, 0)));
        decoder.decode("RHO_SENSORS", bytes(sensors(1, 2, 4, 1, 1)));
        check.equal("faults of sensors", List.of("S3 doubted", "S4 doubted", "S4 silent"),
                model.scene().health().sensorFaults());
        decoder.decode("RHO_SENSORS", bytes(sensors(0, 1, 3, 0, 0)));
        check.equal("none any more", List.of(), model.scene().health().sensorFaults());
        decoder.decode("RHO_SENSORS", bytes(sensors(64, 32767, 5, 1, 0)));
        check.equal("no more parts than sensors", List.of(), model.scene().health().sensorFaults());
        decoder.decode("RHO_LEARNED", bytes(learned(3, 2.1, 1, 0.6)));
        decoder.decode("RHO_LEARNED", bytes(learned(4, 1, 1, 0.9)));
        check.equal("what of a sensor is not as stated",
                List.of("S3 noise 2.1, across 1.0 times as stated", "S3 pd down to 0.60"),
                model.scene().health().sensorFaults());
        decoder.decode("RHO_LEARNED", bytes(learned(3, 1, 1, 0.9)));
        check.equal("it is again", List.of(), model.scene().health().sensorFaults());
        decoder.decode("RHO_CLUTTER", bytes(echoes(7, 0, 2, 300)));
        check.equal("half of a clutter map", List.of(), model.scene().echoes());
        decoder.decode("RHO_CLUTTER", bytes(echoes(7, 1, 2, 400)));
        check.equal("a clutter map", List.of(new LocalPoint(300, 0), new LocalPoint(400, 0)),
                model.scene().echoes().stream().map(Scene.Echo::place).toList());
        decoder.decode("RHO_CLUTTER", bytes(echoes(8, 0, 1, 500)));
        check.equal("the next one", List.of(new Scene.Echo(new LocalPoint(500, 0), 3, 12, 0.5)),
                model.scene().echoes());
        scene = model.scene();
        check.equal("all taken", 0L, scene.health().ignored());
        decoder.decode("RHO_TRACKS", bytes(trackList(2, track_t.DELETED)));
        check.equal("deleted", 0, model.scene().tracks().size());
    }

    private static void bad(Checks check) throws IOException {
        Model model = new Model();
        MessageDecoder decoder = new MessageDecoder(model);
        byte[] whole = bytes(trackList(1, track_t.CONFIRMED));
        decoder.decode("RHO_TRACKS", new byte[0]);
        decoder.decode("RHO_TRACKS", new byte[7]);
        decoder.decode("RHO_TRACKS", Arrays.copyOf(whole, whole.length - 1));
        decoder.decode("RHO_TRACKS", Arrays.copyOf(whole, whole.length + 1));
        byte[] other = whole.clone();
        other[0] ^= 1; // another version's fingerprint
        decoder.decode("RHO_TRACKS", other);
        decoder.decode("RHO_TRACKS", bytes(trackList(1, 5)));
        track_list_t nowhere = trackList(1, track_t.CONFIRMED);
        nowhere.tracks[0].x_m = Float.NaN;
        decoder.decode("RHO_TRACKS", bytes(nowhere));
        track_list_t part = trackList(1, track_t.CONFIRMED);
        part.part = 1;
        decoder.decode("RHO_TRACKS", bytes(part));
        bearing_scan_t infinite = bearings();
        infinite.bearing_rad[0] = Float.POSITIVE_INFINITY;
        decoder.decode("RHO_BEARINGS_2", bytes(infinite));
        decoder.decode("RHO_BEARINGS_12", bytes(bearings())); // a sensor on another one's channel
        decoder.decode("RHO_DIRECTIONS_14", bytes(directions()));
        decoder.decode("RHO_CLUTTER", bytes(echoes(1, 0, 1, Float.NaN)));
        clutter_map_t sure = echoes(1, 0, 1, 300);
        sure.echoes[0].chance = 1.5f;
        decoder.decode("RHO_CLUTTER", bytes(sure));
        decoder.decode("RHO_WORK", bytes(work(-1, 1000, 0)));
        decoder.decode("RHO_LEARNED", bytes(learned(3, Double.NaN, 1, 0.6)));
        decoder.decode("RHO_LEARNED", bytes(learned(3, 2, 1, 1.5)));
        check.equal("nothing learned", List.of(), model.scene().health().sensorFaults());
        check.equal("no work", null, model.scene().health().work());
        check.equal("no echoes", List.of(), model.scene().echoes());
        check.equal("all refused", 16L, model.scene().health().ignored());
        check.equal("nothing shown", 0, model.scene().tracks().size());
        track_list_t vague = trackList(1, track_t.CONFIRMED);
        vague.tracks[0].covariance[0] = Float.NaN;
        decoder.decode("RHO_TRACKS", bytes(vague));
        check.equal("a bad covariance costs the ellipse only", null,
                model.scene().tracks().get(0).ellipse());
    }

    private static void mutated(Checks check) throws IOException {
        Random random = new Random(1);
        Model model = new Model();
        MessageDecoder decoder = new MessageDecoder(model);
        byte[][] originals = {bytes(polarScan()), bytes(trackList(1, track_t.CONFIRMED)),
            bytes(bearings()), bytes(directions()), bytes(peaks()), bytes(new status_t()),
            bytes(sensors(0, 1, 3, 1, 0)), bytes(echoes(1, 0, 1, 300)), bytes(work(1, 2, 3)),
            bytes(learned(3, 2, 1, 0.6)), bytes(ghosts(1, 0, 1, ghost_t.ROW)),
            bytes(search(1, 7, 12)), bytes(plane(1, 0, 4, 127)), bytes(hypotheses(12, 0.7f)),
            bytes(bodies(1, 400)), bytes(lives(1, 0, 1, 12, 0.75, 0.5))};
        int rounds = 20000;
        for (int i = 0; i < rounds; i++) {
            byte[] message = originals[i % originals.length].clone();
            for (int k = random.nextInt(4); k >= 0; k--) {
                message[8 + random.nextInt(message.length - 8)] = (byte) random.nextInt(256);
            }
            decoder.decode(i % 2 == 0 ? "RHO_POLAR_3" : "RHO_BEARINGS_2", message);
        }
        for (int id = 0; id < 300; id++) {
            polar_scan_t scan = polarScan();
            scan.sensor_id = (short) id;
            decoder.decode("RHO_POLAR_" + id, bytes(scan));
        }
        check.equal("all counted", rounds + 300L, model.scene().health().received());
        check.isTrue("no more sensors than a tracker takes", model.scene().sensors().size() == 64);
        new AllViewsPanel(model).paintToImage(800, 600);
        check.isTrue("and painted", true);
    }

    private static void picture(Checks check) throws IOException {
        Model model = new Model();
        AllViewsPanel panel = new AllViewsPanel(model);
        BufferedImage before = panel.paintToImage(900, 600);
        MessageDecoder decoder = new MessageDecoder(model);
        decoder.decode("RHO_POLAR_3", bytes(polarScan()));
        decoder.decode("RHO_STATUS", bytes(new status_t()));
        decoder.decode("RHO_WORK", bytes(work(1, 2, 3)));
        decoder.decode("RHO_TRACKS", bytes(trackList(1, track_t.CONFIRMED)));
        BufferedImage after = panel.paintToImage(900, 600);
        int confirmed = Palette.ofStatus(DisplayedTrack.Status.CONFIRMED).getRGB();
        check.isTrue("no track at first", count(before, confirmed) < count(after, confirmed));
    }

    private static int count(BufferedImage image, int colour) {
        int[] pixels =
                image.getRGB(0, 0, image.getWidth(), image.getHeight(), null, 0, image.getWidth());
        return (int) Arrays.stream(pixels).filter(pixel -> pixel == colour).count();
    }
}
