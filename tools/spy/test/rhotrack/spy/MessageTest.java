// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.image.BufferedImage;
import java.io.ByteArrayOutputStream;
import java.io.DataOutputStream;
import java.io.IOException;
import java.util.Arrays;
import java.util.List;
import java.util.Random;
import lcm.lcm.LCMEncodable;
import rhotrack.bearing_scan_t;
import rhotrack.clutter_map_t;
import rhotrack.echo_t;
import rhotrack.learned_t;
import rhotrack.peak_list_t;
import rhotrack.peak_t;
import rhotrack.polar_plot_t;
import rhotrack.polar_scan_t;
import rhotrack.sensor_list_t;
import rhotrack.sensor_t;
import rhotrack.status_t;
import rhotrack.track_list_t;
import rhotrack.track_t;
import rhotrack.work_t;
import rhotrack.spy.scene.Decoder;
import rhotrack.spy.scene.Model;
import rhotrack.spy.scene.Place;
import rhotrack.spy.scene.Scene;
import rhotrack.spy.scene.TrackMark;

/** From messages, good and bad, to what is painted. */
final class MessageTest {
    private MessageTest() {
    }

    static void run(Checks check) {
        check.group("messages", () -> good(check));
        check.group("bad messages", () -> bad(check));
        check.group("mutated messages", () -> mutated(check));
        check.group("picture", () -> picture(check));
        check.group("fingerprints", () -> {
            check.isTrue("tracks are known", Decoder.knows(track_list_t.LCM_FINGERPRINT));
            check.isTrue("a part of a message is none", !Decoder.knows(track_t.LCM_FINGERPRINT));
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

    private static void good(Checks check) throws IOException {
        Model model = new Model();
        Decoder decoder = new Decoder(model);
        decoder.decode("RHO_POLAR_3", bytes(polarScan()));
        decoder.decode("RHO_TRACKS", bytes(trackList(1, track_t.COASTING)));
        decoder.decode("RHO_BEARINGS_2", bytes(bearings()));
        decoder.decode("RHO_PEAKS", bytes(peaks()));
        status_t status = new status_t();
        status.scans_bad = Integer.MAX_VALUE;
        status.messages_bad = 5;
        decoder.decode("RHO_STATUS", bytes(status));
        Scene scene = model.scene();
        check.equal("plots", List.of(new Place(2100, 0)), scene.plots().get(0).content().places());
        check.equal("sensors", new Place(100, 0), scene.sensors().get(3));
        check.equal("tracks", TrackMark.Status.COASTING, scene.tracks().get(0).status());
        check.near("ellipse", 30, scene.tracks().get(0).ellipse().major());
        check.equal("bearings", List.of(1.0, -2.0), scene.bearings().get(0).content().angles());
        check.near("peaks", -300, scene.peaks().get(0).content().peaks().get(0).rho());
        check.equal("counters stay at their limit", Integer.MAX_VALUE, scene.health().status().bad());
        decoder.decode("RHO_WORK", bytes(work(250, 1000, 3)));
        check.equal("work", new Scene.Work(0.25, 3, 0, 9), model.scene().health().work());
        decoder.decode("RHO_WORK", bytes(work(250, 0, 0)));
        check.equal("work without a limit", new Scene.Work(-1, 0, 0, 9), model.scene().health().work());
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
        check.equal("a clutter map", List.of(new Place(300, 0), new Place(400, 0)),
                model.scene().echoes().stream().map(Scene.Echo::place).toList());
        decoder.decode("RHO_CLUTTER", bytes(echoes(8, 0, 1, 500)));
        check.equal("the next one", List.of(new Scene.Echo(new Place(500, 0), 3, 12, 0.5)), model.scene().echoes());
        scene = model.scene();
        check.equal("all taken", 0L, scene.health().ignored());
        decoder.decode("RHO_TRACKS", bytes(trackList(2, track_t.DELETED)));
        check.equal("deleted", 0, model.scene().tracks().size());
    }

    private static void bad(Checks check) throws IOException {
        Model model = new Model();
        Decoder decoder = new Decoder(model);
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
        check.equal("all refused", 15L, model.scene().health().ignored());
        check.equal("nothing shown", 0, model.scene().tracks().size());
        track_list_t vague = trackList(1, track_t.CONFIRMED);
        vague.tracks[0].covariance[0] = Float.NaN;
        decoder.decode("RHO_TRACKS", bytes(vague));
        check.equal("a bad covariance costs the ellipse only", null, model.scene().tracks().get(0).ellipse());
    }

    private static void mutated(Checks check) throws IOException {
        Random random = new Random(1);
        Model model = new Model();
        Decoder decoder = new Decoder(model);
        byte[][] originals = {bytes(polarScan()), bytes(trackList(1, track_t.CONFIRMED)), bytes(bearings()),
            bytes(peaks()), bytes(new status_t()),
            bytes(sensors(0, 1, 3, 1, 0)), bytes(echoes(1, 0, 1, 300)), bytes(work(1, 2, 3)),
            bytes(learned(3, 2, 1, 0.6))};
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
        new ViewerPanel(model).picture(800, 600);
        check.isTrue("and painted", true);
    }

    private static void picture(Checks check) throws IOException {
        Model model = new Model();
        ViewerPanel panel = new ViewerPanel(model);
        BufferedImage before = panel.picture(900, 600);
        Decoder decoder = new Decoder(model);
        decoder.decode("RHO_POLAR_3", bytes(polarScan()));
        decoder.decode("RHO_STATUS", bytes(new status_t()));
        decoder.decode("RHO_WORK", bytes(work(1, 2, 3)));
        decoder.decode("RHO_TRACKS", bytes(trackList(1, track_t.CONFIRMED)));
        BufferedImage after = panel.picture(900, 600);
        int confirmed = Palette.of(TrackMark.Status.CONFIRMED).getRGB();
        check.isTrue("no track at first", count(before, confirmed) < count(after, confirmed));
    }

    private static int count(BufferedImage image, int colour) {
        int[] pixels = image.getRGB(0, 0, image.getWidth(), image.getHeight(), null, 0, image.getWidth());
        return (int) Arrays.stream(pixels).filter(pixel -> pixel == colour).count();
    }
}
