// SPDX-License-Identifier: MIT
package rhotrack.spy.scene;

import java.io.ByteArrayInputStream;
import java.io.DataInputStream;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.util.ArrayList;
import java.util.List;
import java.util.Locale;
import rhotrack.accumulator_cell_t;
import rhotrack.accumulator_t;
import rhotrack.bearing_scan_t;
import rhotrack.body_list_t;
import rhotrack.body_t;
import rhotrack.clutter_map_t;
import rhotrack.direction_scan_t;
import rhotrack.echo_t;
import rhotrack.ghost_matrix_t;
import rhotrack.ghost_t;
import rhotrack.hypotheses_t;
import rhotrack.hypothesis_t;
import rhotrack.learned_t;
import rhotrack.life_t;
import rhotrack.peak_list_t;
import rhotrack.plane_row_t;
import rhotrack.plane_t;
import rhotrack.plot_scan_t;
import rhotrack.polar_scan_t;
import rhotrack.sensor_list_t;
import rhotrack.sensor_t;
import rhotrack.status_t;
import rhotrack.track_life_t;
import rhotrack.track_list_t;
import rhotrack.track_t;
import rhotrack.truth_list_t;
import rhotrack.work_t;

/**
 * Decodes LCM messages, checks them, and stores their content in the model. A message that is not
 * exactly valid (unknown fingerprint, counts or numbers out of bounds, bytes missing or left over)
 * is counted as ignored and changes nothing.
 */
public final class MessageDecoder {
    /** How far a visibility may exceed its existence by rounding. */
    private static final double ROUNDING = 1e-6;

    private final Model model;

    public MessageDecoder(Model model) {
        this.model = model;
    }

    /** Whether messages of this fingerprint can be shown. */
    public static boolean canDecode(long fingerprint) {
        return fingerprint == plot_scan_t.LCM_FINGERPRINT
                || fingerprint == polar_scan_t.LCM_FINGERPRINT
                || fingerprint == bearing_scan_t.LCM_FINGERPRINT
                || fingerprint == direction_scan_t.LCM_FINGERPRINT
                || fingerprint == track_list_t.LCM_FINGERPRINT
                || fingerprint == truth_list_t.LCM_FINGERPRINT
                || fingerprint == peak_list_t.LCM_FINGERPRINT
                || fingerprint == sensor_list_t.LCM_FINGERPRINT
                || fingerprint == status_t.LCM_FINGERPRINT
                || fingerprint == clutter_map_t.LCM_FINGERPRINT
                || fingerprint == work_t.LCM_FINGERPRINT
                || fingerprint == learned_t.LCM_FINGERPRINT
                || fingerprint == life_t.LCM_FINGERPRINT
                || fingerprint == ghost_matrix_t.LCM_FINGERPRINT
                || fingerprint == accumulator_t.LCM_FINGERPRINT
                || fingerprint == plane_t.LCM_FINGERPRINT
                || fingerprint == hypotheses_t.LCM_FINGERPRINT
                || fingerprint == body_list_t.LCM_FINGERPRINT;
    }

    public void decode(String channel, byte[] data) {
        boolean good = false;
        try {
            good = data.length >= Long.BYTES
                    && decodeByFingerprint(channel, data, ByteBuffer.wrap(data).getLong());
        } catch (IOException | RuntimeException e) {
            // The message is foreign or truncated; generated code throws RuntimeException for a bad
            // count.
            good = false;
        }
        model.countMessage(good);
    }

    private boolean decodeByFingerprint(String channel, byte[] data, long fingerprint)
            throws IOException {
        DataInputStream in = new DataInputStream(new ByteArrayInputStream(data));
        if (fingerprint == plot_scan_t.LCM_FINGERPRINT) {
            return storeIfValid(channel, new plot_scan_t(in), in);
        }
        if (fingerprint == polar_scan_t.LCM_FINGERPRINT) {
            return storeIfValid(channel, new polar_scan_t(in), in);
        }
        if (fingerprint == bearing_scan_t.LCM_FINGERPRINT) {
            return storeIfValid(channel, new bearing_scan_t(in), in);
        }
        if (fingerprint == direction_scan_t.LCM_FINGERPRINT) {
            return storeIfValid(channel, new direction_scan_t(in), in);
        }
        if (fingerprint == track_list_t.LCM_FINGERPRINT) {
            return storeIfValid(new track_list_t(in), in);
        }
        if (fingerprint == truth_list_t.LCM_FINGERPRINT) {
            return storeIfValid(new truth_list_t(in), in);
        }
        if (fingerprint == peak_list_t.LCM_FINGERPRINT) {
            return storeIfValid(new peak_list_t(in), in);
        }
        if (fingerprint == sensor_list_t.LCM_FINGERPRINT) {
            return storeIfValid(new sensor_list_t(in), in);
        }
        if (fingerprint == learned_t.LCM_FINGERPRINT) {
            return storeIfValid(new learned_t(in), in);
        }
        if (fingerprint == life_t.LCM_FINGERPRINT) {
            return storeIfValid(new life_t(in), in);
        }
        if (fingerprint == clutter_map_t.LCM_FINGERPRINT) {
            return storeIfValid(new clutter_map_t(in), in);
        }
        if (fingerprint == body_list_t.LCM_FINGERPRINT) {
            return storeIfValid(new body_list_t(in), in);
        }
        if (fingerprint == work_t.LCM_FINGERPRINT) {
            return storeIfValid(new work_t(in), in);
        }
        if (fingerprint == ghost_matrix_t.LCM_FINGERPRINT) {
            return storeIfValid(new ghost_matrix_t(in), in);
        }
        if (fingerprint == accumulator_t.LCM_FINGERPRINT) {
            return storeIfValid(new accumulator_t(in), in);
        }
        if (fingerprint == plane_t.LCM_FINGERPRINT) {
            return storeIfValid(new plane_t(in), in);
        }
        if (fingerprint == hypotheses_t.LCM_FINGERPRINT) {
            return storeIfValid(new hypotheses_t(in), in);
        }
        return fingerprint == status_t.LCM_FINGERPRINT && storeIfValid(new status_t(in), in);
    }

    private boolean storeIfValid(String channel, plot_scan_t scan, DataInputStream in)
            throws IOException {
        if (in.available() > 0 || scan.num_plots > plot_scan_t.MAX_PLOTS
                || !isValidPart(scan.part, scan.num_parts)
                || !endsWithSensorId(scan.sensor_id, channel)) {
            return false;
        }
        List<LocalPoint> places = new ArrayList<>();
        for (rhotrack.plot_t plot : scan.plots) {
            places.add(new LocalPoint(plot.x_m, plot.y_m));
        }
        if (!areWithinLimits(places)) {
            return false;
        }
        int looks = LookHistory.looksPerTurn(scan.sector_from_rad, scan.sector_to_rad);
        model.addPlots(channel, scan.epoch, scan.scan, looks,
                new Scene.Plots(scan.sensor_id, places));
        return true;
    }

    private boolean storeIfValid(String channel, polar_scan_t scan, DataInputStream in)
            throws IOException {
        LocalPoint sensor = new LocalPoint(scan.sensor_x_m, scan.sensor_y_m);
        if (in.available() > 0 || scan.num_polar_plots > polar_scan_t.MAX_POLAR_PLOTS
                || !sensor.isWithinLimits() || !isValidPart(scan.part, scan.num_parts)
                || !endsWithSensorId(scan.sensor_id, channel)) {
            return false;
        }
        List<LocalPoint> places = new ArrayList<>();
        for (rhotrack.polar_plot_t plot : scan.polar_plots) {
            double elevation = scan.has_elevation == 1 ? plot.elevation_rad : 0;
            places.add(Geometry.fromPolar(sensor, plot.range_m, plot.azimuth_rad, elevation));
        }
        if (!areWithinLimits(places)) {
            return false;
        }
        int looks = LookHistory.looksPerTurn(scan.sector_from_rad, scan.sector_to_rad);
        model.addSensor(scan.sensor_id, sensor);
        model.addPlots(channel, scan.epoch, scan.scan, looks,
                new Scene.Plots(scan.sensor_id, places));
        return true;
    }

    private boolean storeIfValid(String channel, bearing_scan_t scan, DataInputStream in)
            throws IOException {
        if (in.available() > 0 || scan.num_bearings > bearing_scan_t.MAX_BEARING_RAD) {
            return false;
        }
        List<Double> angles = new ArrayList<>();
        for (float angle : scan.bearing_rad) {
            angles.add((double) angle);
        }
        LocalPoint sensor = new LocalPoint(scan.sensor_x_m, scan.sensor_y_m);
        return storeIfValid(channel, scan.epoch, scan.scan,
                new Scene.Bearings(scan.sensor_id, sensor, angles));
    }

    private boolean storeIfValid(String channel, direction_scan_t scan, DataInputStream in)
            throws IOException {
        if (in.available() > 0 || scan.num_directions > direction_scan_t.MAX_DIRECTIONS) {
            return false;
        }
        List<Double> angles = new ArrayList<>();
        for (rhotrack.direction_t direction : scan.directions) {
            angles.add((double) direction.bearing_rad);
        }
        LocalPoint sensor = new LocalPoint(scan.sensor_x_m, scan.sensor_y_m);
        return storeIfValid(channel, scan.epoch, scan.scan,
                new Scene.Bearings(scan.sensor_id, sensor, angles));
    }

    private boolean storeIfValid(String channel, int epoch, int scan, Scene.Bearings bearings) {
        if (!bearings.sensor().isWithinLimits()
                || !endsWithSensorId(bearings.sensorId(), channel)) {
            return false;
        }
        for (double angle : bearings.angles()) {
            if (!(Math.abs(angle) <= 4)) {
                return false;
            }
        }
        model.addBearings(channel, epoch, scan, bearings);
        return true;
    }

    private boolean storeIfValid(track_list_t list, DataInputStream in) throws IOException {
        if (in.available() > 0 || list.num_tracks > track_list_t.MAX_TRACKS
                || !isValidPart(list.part, list.num_parts)) {
            return false;
        }
        List<DisplayedTrack> marks = new ArrayList<>();
        for (track_t track : list.tracks) {
            DisplayedTrack mark = trackMarkOf(track);
            if (mark == null) {
                return false;
            }
            marks.add(mark);
        }
        model.addTracks(list.epoch, list.scan, list.part, list.num_parts, marks);
        return true;
    }

    private static DisplayedTrack trackMarkOf(track_t track) {
        LocalPoint place = new LocalPoint(track.x_m, track.y_m);
        DisplayedTrack.Status[] states = DisplayedTrack.Status.values();
        boolean known = track.status >= track_t.TENTATIVE && track.status <= track_t.DELETED;
        if (!known || !place.isWithinLimits()
                || !areFinite(track.z_m, track.vx_mps, track.vy_mps, track.score_nat)) {
            return null;
        }
        Ellipse ellipse = Ellipse.of(track.covariance[0], track.covariance[1], track.covariance[2]);
        return new DisplayedTrack(track.track_id, states[track.status - track_t.TENTATIVE], place,
                track.z_m, track.vx_mps, track.vy_mps, track.hits, track.misses,
                track.score_nat, ellipse);
    }

    private boolean storeIfValid(body_list_t list, DataInputStream in) throws IOException {
        if (in.available() > 0 || list.num_bodies > body_list_t.MAX_BODIES
                || !isValidPart(list.part, list.num_parts)) {
            return false;
        }
        List<Scene.Body> bodies = new ArrayList<>();
        for (body_t body : list.bodies) {
            LocalPoint centre = new LocalPoint(body.x_m, body.y_m);
            boolean within = body.length_m >= 0 && body.length_m <= 1e5
                    && body.width_m >= 0 && body.width_m <= 1e5;
            if (!centre.isWithinLimits() || !within || !(Math.abs(body.heading_rad) <= 4)) {
                return false;
            }
            bodies.add(new Scene.Body(body.track_id, centre, body.length_m, body.width_m,
                    body.heading_rad));
        }
        model.addBodies(list.epoch, list.scan, list.part, list.num_parts, bodies);
        return true;
    }

    private boolean storeIfValid(truth_list_t list, DataInputStream in) throws IOException {
        if (in.available() > 0 || list.num_targets > truth_list_t.MAX_TARGETS
                || !isValidPart(list.part, list.num_parts)) {
            return false;
        }
        List<Scene.Truth> targets = new ArrayList<>();
        for (rhotrack.truth_t target : list.targets) {
            LocalPoint place = new LocalPoint(target.x_m, target.y_m);
            if (!place.isWithinLimits() || !areFinite(target.vx_mps, target.vy_mps)) {
                return false;
            }
            targets.add(new Scene.Truth(target.target_id, place, target.vx_mps, target.vy_mps));
        }
        model.addTruth(list.scan, list.part, list.num_parts, targets);
        return true;
    }

    private boolean storeIfValid(peak_list_t list, DataInputStream in) throws IOException {
        if (in.available() > 0 || list.num_peaks > peak_list_t.MAX_PEAKS) {
            return false;
        }
        List<Scene.Peak> peaks = new ArrayList<>();
        for (rhotrack.peak_t peak : list.peaks) {
            boolean within = peak.theta_rad >= 0 && peak.theta_rad < 3.15
                    && Math.abs(peak.rho_m) <= 4e6;
            if (!within || !areFinite(peak.speed_mps, peak.score_nat)) {
                return false;
            }
            peaks.add(new Scene.Peak(peak.rho_m, peak.theta_rad, peak.speed_mps, peak.score_nat,
                    peak.scans_hit, peak.sensor_pairs));
        }
        model.addPeaks(list.scan, new Scene.Peaks(peaks));
        return true;
    }

    private boolean storeIfValid(ghost_matrix_t matrix, DataInputStream in) throws IOException {
        if (in.available() > 0 || matrix.num_elements > ghost_matrix_t.MAX_ELEMENTS
                || !isValidPart(matrix.part, matrix.num_parts)) {
            return false;
        }
        List<Scene.Crossing> crossings = new ArrayList<>();
        for (ghost_t element : matrix.elements) {
            LocalPoint place = new LocalPoint(element.x_m, element.y_m);
            if (!place.isWithinLimits() || element.reason < ghost_t.KEPT
                    || element.reason > ghost_t.UNMATCHED) {
                return false;
            }
            boolean meets = element.reason == ghost_t.KEPT || element.reason > ghost_t.RANGE;
            if (meets) {
                crossings.add(new Scene.Crossing(place, element.reason != ghost_t.KEPT));
            }
        }
        model.storeInternals(internals -> internals.addGhosts(matrix.sensor_a_id,
                matrix.sensor_b_id, matrix.epoch, matrix.scan, matrix.part, matrix.num_parts,
                crossings));
        return true;
    }

    private boolean storeIfValid(accumulator_t search, DataInputStream in) throws IOException {
        LocalPoint origin = new LocalPoint(search.origin_x_m, search.origin_y_m);
        boolean within = search.rho_min_m >= -1e7 && search.rho_min_m < search.rho_max_m
                && search.rho_max_m <= 1e7;
        if (in.available() > 0 || search.num_cells > accumulator_t.MAX_CELLS
                || !origin.isWithinLimits() || !within || !areFinite(search.votes_max)) {
            return false;
        }
        List<Scene.Cell> cells = new ArrayList<>();
        for (accumulator_cell_t cell : search.cells) {
            if (!(cell.theta_rad >= 0 && cell.theta_rad <= 6.3)
                    || !areFinite(cell.rho_m, cell.votes)) {
                return false;
            }
            cells.add(new Scene.Cell(cell.rho_m, cell.theta_rad, cell.votes,
                    Integer.bitCount(cell.scan_mask), cell.track_id));
        }
        Scene.Which which = new Scene.Which(search.method, search.has_pair != 0, search.sensor_a_id,
                search.sensor_b_id);
        model.storeInternals(internals -> internals.addAccumulator(new Scene.Accumulator(which,
                search.scan, origin, search.rho_min_m, search.rho_max_m, cells)));
        return true;
    }

    private boolean storeIfValid(plane_t plane, DataInputStream in) throws IOException {
        if (in.available() > 0 || plane.num_rows > plane_t.MAX_ROWS
                || !isValidPart(plane.part, plane.num_parts)) {
            return false;
        }
        List<byte[]> rows = new ArrayList<>();
        for (plane_row_t row : plane.rows) {
            for (byte votes : row.votes) {
                if (votes < 0) {
                    return false;
                }
            }
            rows.add(row.votes);
        }
        Scene.Which which = new Scene.Which(plane.method, plane.has_pair != 0, plane.sensor_a_id,
                plane.sensor_b_id);
        model.storeInternals(internals -> internals.addPlane(which, plane.epoch, plane.scan,
                plane.part, plane.num_parts, rows));
        return true;
    }

    private boolean storeIfValid(hypotheses_t of, DataInputStream in) throws IOException {
        if (in.available() > 0 || of.num_hypotheses > hypotheses_t.MAX_HYPOTHESES
                || !areFinite(of.score_nat)
                || !areWithin0And1(of.calm, of.steady, of.maneuver, of.support, of.shared,
                        of.clutter)) {
            return false;
        }
        List<Scene.Hypothesis> list = new ArrayList<>();
        for (hypothesis_t one : of.hypotheses) {
            LocalPoint place = new LocalPoint(one.x_m, one.y_m);
            if (!place.isWithinLimits() || !areWithin0And1(one.share)
                    || !areFinite(one.vx_mps, one.vy_mps)) {
                return false;
            }
            List<Integer> plots = new ArrayList<>();
            for (short plot : one.plots) {
                plots.add((int) plot);
            }
            list.add(new Scene.Hypothesis(one.share, place, one.vx_mps, one.vy_mps, plots));
        }
        model.storeInternals(internals -> internals.addHypotheses(
                new Scene.Hypotheses(of.track_id, of.scan, of.score_nat, of.calm, of.steady,
                of.maneuver, of.evidence, of.support, of.shared, of.clutter, list)));
        return true;
    }

    private static boolean areWithin0And1(float... values) {
        for (float value : values) {
            if (!(value >= 0 && value <= 1)) {
                return false;
            }
        }
        return true;
    }

    private boolean storeIfValid(status_t status, DataInputStream in) throws IOException {
        if (in.available() > 0
                || !areFinite(status.step_us, status.step_max_us, status.clutter_per_km2)) {
            return false;
        }
        // scans_lost counts every skipped scan number, including scans that arrived late
        int lost = Math.max(0, status.scans_lost - status.scans_late);
        model.setStatus(new Scene.Status(status.scans_accepted, lost, status.scans_late,
                saturatedSum(status.scans_bad, status.messages_bad), status.tracks_tentative,
                status.tracks_confirmed, status.tracks_coasting, status.step_us, status.step_max_us,
                status.clutter_per_km2));
        return true;
    }

    private boolean storeIfValid(work_t work, DataInputStream in) throws IOException {
        if (in.available() > 0 || work.work < 0 || work.work_max < 0 || work.partial_steps < 0
                || work.reports_not_printed < 0 || work.events_not_logged < 0) {
            return false;
        }
        model.setWork(new Scene.Work(work.work_max == 0 ? -1 : (double) work.work / work.work_max,
                work.partial_steps, work.reports_not_printed, work.events_not_logged));
        return true;
    }

    private boolean storeIfValid(sensor_list_t list, DataInputStream in) throws IOException {
        if (in.available() > 0 || list.num_sensors > sensor_list_t.MAX_SENSORS
                || !isValidPart(list.part, list.num_parts)) {
            return false;
        }
        List<String> faults = new ArrayList<>();
        for (sensor_t sensor : list.sensors) {
            if (sensor.is_doubted != 0) {
                faults.add("S" + sensor.sensor_id + " doubted");
            }
            if (sensor.is_silent != 0) {
                faults.add("S" + sensor.sensor_id + " silent");
            } else if (sensor.is_off_clock != 0) {
                faults.add("S" + sensor.sensor_id + " off the clock");
            }
        }
        model.setSensorFaults(list.part, list.num_parts, faults);
        return true;
    }

    private boolean storeIfValid(learned_t learned, DataInputStream in) throws IOException {
        double range = learned.sigma_range_factor, cross = learned.sigma_cross_factor,
                least = learned.pd_stated;
        if (in.available() > 0 || !(range >= 0 && range <= 100) || !(cross >= 0 && cross <= 100)) {
            return false;
        }
        for (float pd : learned.pd) {
            if (!(pd >= 0 && pd <= 1)) {
                return false;
            }
            least = Math.min(least, pd);
        }
        List<String> notes = new ArrayList<>();
        if (range != 1 || cross != 1) {
            notes.add(String.format(Locale.ROOT, "S%d noise %.1f, across %.1f times as stated",
                    learned.sensor_id, range, cross));
        }
        if (least < learned.pd_stated) {
            notes.add(String.format(Locale.ROOT, "S%d pd down to %.2f", learned.sensor_id, least));
        }
        model.setLearned(learned.sensor_id, notes);
        return true;
    }

    private boolean storeIfValid(life_t list, DataInputStream in) throws IOException {
        if (in.available() > 0 || list.num_tracks > life_t.MAX_TRACKS
                || !isValidPart(list.part, list.num_parts)
                || !areWithin0And1(list.death_rate, list.hide_rate, list.appear_rate / 2)
                || !(list.lived_scans >= 0 && list.lived_scans <= 1e9)) {
            return false;
        }
        List<Scene.Life> lives = new ArrayList<>();
        for (track_life_t life : list.tracks) {
            if (!areWithin0And1(life.existence, life.visibility)
                    || life.visibility > life.existence + ROUNDING) {
                return false;
            }
            lives.add(new Scene.Life(life.track_id, life.existence));
        }
        model.addLives(list.epoch, list.scan, list.part, list.num_parts, lives);
        return true;
    }

    private boolean storeIfValid(clutter_map_t list, DataInputStream in) throws IOException {
        if (in.available() > 0 || list.num_echoes > clutter_map_t.MAX_ECHOES
                || !isValidPart(list.part, list.num_parts)) {
            return false;
        }
        List<Scene.Echo> echoes = new ArrayList<>();
        for (echo_t echo : list.echoes) {
            LocalPoint place = new LocalPoint(echo.x_m, echo.y_m);
            if (!place.isWithinLimits() || echo.hits < 1
                    || !(echo.chance >= 0 && echo.chance <= 1)) {
                return false;
            }
            echoes.add(new Scene.Echo(place, echo.sensor_id, echo.hits, echo.chance));
        }
        model.addEchoes(list.epoch, list.scan, list.part, list.num_parts, echoes);
        return true;
    }

    private static int saturatedSum(int a, int b) {
        return (int) Math.min(Integer.MAX_VALUE, (long) a + b);
    }

    private static boolean isValidPart(int part, int numParts) {
        return part >= 0 && part < numParts;
    }

    /**
     * Whether the channel's name ends with the sensor's id: otherwise its data would be drawn in
     * another sensor's colour.
     */
    private static boolean endsWithSensorId(int sensorId, String channel) {
        return channel.endsWith("_" + sensorId);
    }

    private static boolean areWithinLimits(List<LocalPoint> places) {
        return places.stream().allMatch(LocalPoint::isWithinLimits);
    }

    private static boolean areFinite(float... numbers) {
        for (float number : numbers) {
            if (!Float.isFinite(number)) {
                return false;
            }
        }
        return true;
    }
}
