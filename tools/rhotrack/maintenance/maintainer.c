/* SPDX-License-Identifier: MIT */
#include "maintenance/maintainer.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "maintenance/scan_clutter_density.h"
#include "rhotrack/detail/measurement.h"

#define AXES 3
/* Standard deviation of a velocity from which a filter learns nothing. */
#define SIGMA_NOTHING_MPS 1e5f
#define FACTOR_MAX 1e5f        /* on sigmas, which widens a gate to a whole scan */
#define SIGMA_LEAST_MPS2 1e-3f /* of an input that widens no gate */
#define LOG_DENSITY_MAX 69.0   /* ln of the largest clutter density that the tracker takes */

struct maintainer {
    enum maintainer_gate gate;
    double v_max_mps;
    bool is_started;
    uint32_t restarts;
    uint16_t misses_before; /* those before the last start */
    uint32_t fates[RHO_NUM_FATES];
    struct scan_clutter_density *density;
    struct rho_track_report track;
    struct rho_tracker tracker;
    struct rho_report report;
};

/*
 * Limits that end tracks do not hold for this one. Only hypotheses need a largest speed; without
 * input estimation no test finds an input, so that the filter has the same noise as with it.
 */
static struct rho_tracker_config config_of(enum maintainer_gate gate, bool has_input_estimation,
                                           const struct parameters *parameters)
{
    struct rho_tracker_config config;

    parameters_to_tracker(parameters, &config);
    config.gate = gate == MAINTAIN_BEST ? RHO_TRACKER_BEST : RHO_TRACKER_HOUGH;
    config.v_min_mps = 0.0f;
    config.v_max_mps = gate == MAINTAIN_BEST ? config.v_max_mps : RHO_LIMIT_SPEED_MPS;
    config.coast_scans_max = UINT8_MAX;
    if (!(config.hough_window_m > 0.0f) || gate != MAINTAIN_HOUGH) {
        config.hough_window_m = 2.0f * RHO_LIMIT_POSITION_M; /* the whole scan */
    }
    config.input.is_estimated = 1;
    config.input.noise_density = 0.0f;
    config.input.noise_m = (float)parameters->value[PARAMETER_FILTER_NOISE_M];
    config.input.noise_mps = (float)parameters->value[PARAMETER_FILTER_NOISE_MPS];
    if (!has_input_estimation) {
        config.input.threshold = FLT_MAX;
        config.input.sigma_mps2 = SIGMA_LEAST_MPS2;
    }
    return config;
}

struct maintainer *maintainer_new(enum maintainer_gate gate, bool has_input_estimation,
                                  const struct parameters *parameters)
{
    struct maintainer *maintainer = must_calloc(1, sizeof *maintainer);
    struct rho_tracker_config config;

    parameters_check_together(parameters);
    config = config_of(gate, has_input_estimation, parameters);
    maintainer->gate = gate;
    maintainer->density = scan_clutter_density_new();
    maintainer->v_max_mps = parameters->value[PARAMETER_V_MAX_MPS];
    must_succeed(rho_tracker_init(&maintainer->tracker, sizeof maintainer->tracker, &config),
                 "tracker");
    return maintainer;
}

void maintainer_free(struct maintainer *maintainer)
{
    if (maintainer) {
        scan_clutter_density_free(maintainer->density);
        free(maintainer);
    }
}

size_t maintainer_state_bytes(const struct maintainer *maintainer)
{
    return sizeof(struct rho_track) + (maintainer->gate == MAINTAIN_BEST
                                           ? RHO_HYPOTHESES_OF_TRACK * sizeof(struct rho_hypothesis)
                                           : 0);
}

/* Scans that the gates take. */

static void check_scan_fits_gate(const struct maintainer *maintainer, const struct rho_scan *scan)
{
    if (maintainer->gate != MAINTAIN_HOUGH || scan->num_plots == 0) {
        return;
    }
    if (!(scan->measures & RHO_MEASURES_VELOCITY)) {
        fail(EXIT_USAGE,
             "gate hough needs velocities, and the scan at %.6f s has none: give columns 'vx_mps' "
             "and 'vy_mps'",
             (double)scan->time_us * 1e-6);
    }
    if (!(scan->measures & RHO_MEASURES_Z) &&
        !(maintainer->tracker.config.planes & RHO_GATE_PLANE_XY)) {
        fail(EXIT_USAGE, "gate hough: the scan at %.6f s has no heights, so planes must contain xy",
             (double)scan->time_us * 1e-6);
    }
}

/* Row of a valid plot drawn at random; -1: there is none. */
static int draw_plot(const struct rho_scan *scan, struct random *random)
{
    uint64_t left = 0;

    for (uint32_t i = 0; i < scan->num_plots; i++) {
        left += rho_measurement_is_valid_plot(&scan->plots[i], scan->measures) != 0;
    }
    left = left > 0 ? random_below(random, left) + 1 : 0;
    for (uint32_t i = 0; left > 0; i++) {
        left -= rho_measurement_is_valid_plot(&scan->plots[i], scan->measures) != 0;
        if (left == 0) {
            return (int)i;
        }
    }
    return -1;
}

/* Row of the plot with the least Mahalanobis distance in the gate, sigmas widened; -1: none. */
static int nearest_plot_in_gate(const struct rho_scan *scan, const struct rho_kalman *expected,
                                const struct rho_sensor *sensor, float factor)
{
    struct rho_kalman wide = *expected;
    struct rho_gate gate;
    struct rho_gate_result result;
    float least = INFINITY;
    int nearest = -1;

    for (int i = 0; i < RHO_TRIANGLE(RHO_KALMAN_STATES); i++) {
        wide.covariance[i] *= factor * factor;
    }
    rho_gate_open(&gate, &wide, 0.0f, sensor, scan->measures);
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        struct rho_plot plot = scan->plots[i];

        plot.sigma_range_m *= factor;
        plot.sigma_cross_m *= factor;
        plot.sigma_up_m *= factor;
        plot.sigma_range_rate_mps *= factor;
        if (rho_measurement_is_valid_plot(&scan->plots[i], scan->measures) &&
            rho_gate_test(&gate, &plot, &result) && result.distance2 < least) {
            least = result.distance2;
            nearest = (int)i;
        }
    }
    return nearest;
}

/* Row of the nearest plot, however far it is: the library's gate is widened until it has one. */
static int nearest_plot(const struct maintainer *maintainer, const struct rho_scan *scan,
                        const struct rho_sensor *sensor)
{
    const struct rho_track_model model = {.input = &maintainer->tracker.config.input};
    struct rho_track track = maintainer->tracker.tracks[0];
    struct rho_kalman expected;
    int nearest = -1;

    if (rho_track_predict(&track, scan->time_us, &model) == RHO_OK) {
        rho_track_estimate_for_gate(&track, &expected);
        float factor = 1.0f;
        while (nearest < 0 && factor <= FACTOR_MAX) {
            nearest = nearest_plot_in_gate(scan, &expected, sensor, factor);
            factor *= 10.0f;
        }
    }
    return nearest;
}

/*
 * Copies a chosen plot; the gate hough takes the only plot of a scan that has a velocity, so it
 * gets one that tells nothing.
 */
static struct rho_plot copy_chosen_plot(const struct rho_scan *scan, int row,
                                        const struct rho_track_report *track)
{
    struct rho_plot plot = scan->plots[row];

    if (!(scan->measures & RHO_MEASURES_VELOCITY)) {
        plot.vx_mps = track->state[RHO_VX];
        plot.vy_mps = track->state[RHO_VY];
        plot.vz_mps = track->state[RHO_VZ];
        plot.sigma_mps = SIGMA_NOTHING_MPS;
    }
    return plot;
}

/*
 * States the clutter density to the tracker, which counts clutter as uniform over heights and
 * velocities.
 */
static void set_clutter(struct maintainer *maintainer, const struct rho_scan *scan, double pd,
                        double log_density)
{
    const int axes = scan->measures & RHO_MEASURES_Z ? 3 : 2;
    const int rates = (scan->measures & RHO_MEASURES_VELOCITY ? axes : 0) +
                      (scan->measures & RHO_MEASURES_RANGE_RATE ? 1 : 0);
    struct rho_track_report predicted;
    double place_m[AXES];

    if (isnan(log_density)) {
        maintainer_predict(maintainer, scan->time_us, &predicted, place_m);
        log_density = scan_clutter_density_add(maintainer->density, scan, place_m, pd);
    }
    log_density += (axes - 2) * log((double)RHO_CLUTTER_HEIGHT_M) +
                   rates * log(2.0 * (double)maintainer->tracker.config.v_max_mps);
    must_succeed(rho_tracker_set_clutter(&maintainer->tracker,
                                         (float)exp(fmin(log_density, LOG_DENSITY_MAX))),
                 "clutter");
}

/* Starts. */

static int nearest_valid_plot(const struct rho_scan *scan, const float place_m[AXES])
{
    double least_m = INFINITY;
    int nearest = -1;

    for (uint32_t i = 0; i < scan->num_plots; i++) {
        const struct rho_plot *plot = &scan->plots[i];
        const double distance_m =
            hypot((double)(plot->x_m - place_m[0]), (double)(plot->y_m - place_m[1]));

        if (rho_measurement_is_valid_plot(plot, scan->measures) && distance_m < least_m) {
            least_m = distance_m;
            nearest = (int)i;
        }
    }
    return nearest;
}

static int first_valid_plot(const struct rho_scan *scan)
{
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        if (rho_measurement_is_valid_plot(&scan->plots[i], scan->measures)) {
            return (int)i;
        }
    }
    return -1;
}

/* Estimate at the scan's time from a plot's place and, where it is measured, velocity. */
static struct rho_kalman estimate_of_plot(const struct rho_plot *plot, uint32_t measures,
                                          const struct rho_sensor *sensor, double v_max_mps)
{
    const float velocity_mps[AXES] = {plot->vx_mps, plot->vy_mps, plot->vz_mps};
    struct rho_measurement seen;
    struct rho_kalman estimate;

    rho_kalman_init(&estimate);
    rho_measurement_from_plot(plot, measures, sensor, &seen);
    must_succeed(rho_kalman_update_position(&estimate, &seen, (float)(v_max_mps * v_max_mps)),
                 "start");
    for (int i = 0; i < AXES && measures & RHO_MEASURES_VELOCITY; i++) {
        if (rho_kalman_has_axis(&estimate, i)) {
            estimate.state[i + AXES] = velocity_mps[i];
            estimate.covariance[RHO_AT(i + AXES, i + AXES)] = plot->sigma_mps * plot->sigma_mps;
        }
    }
    /* refused where the place would be too uncertain: then it is at the plot's own time */
    (void)!rho_kalman_predict(&estimate, -1e-6f * (float)plot->offset_us, 0.0f);
    return estimate;
}

static void start_at_plot(struct maintainer *maintainer, const struct rho_scan *scan, int row,
                          const struct rho_sensor *sensor)
{
    const struct rho_kalman estimate =
        estimate_of_plot(&scan->plots[row], scan->measures, sensor, maintainer->v_max_mps);
    const uint16_t hits =
        (uint16_t)(maintainer->track.hits + (maintainer->track.hits < UINT16_MAX));

    must_succeed(rho_tracker_start_estimate(&maintainer->tracker, &estimate, scan->sensor_id, hits,
                                            0, &maintainer->report),
                 "start");
    maintainer->restarts += maintainer->is_started;
    maintainer->is_started = true;
    maintainer->misses_before = maintainer->track.misses;
}

static int start_or_restart(struct maintainer *maintainer, const struct rho_scan *scan,
                            const struct rho_sensor *sensor)
{
    const int row = maintainer->is_started ? nearest_valid_plot(scan, maintainer->track.state)
                                           : first_valid_plot(scan);

    if (row < 0 || maintainer->report.time_us != scan->time_us) { /* an out-of-sequence scan */
        return -1;
    }
    start_at_plot(maintainer, scan, row, sensor);
    return row;
}

/* Steps. */

/* Takes over the tracker's track: its status is that of the last look alone. */
static void update_track(struct maintainer *maintainer, int row)
{
    struct rho_track_report *track = &maintainer->track;
    const enum rho_track_status before = track->status;
    const uint16_t misses = track->misses;

    if (maintainer->report.num_tracks > 0) {
        *track = maintainer->report.tracks[0];
        track->misses = (uint16_t)(track->misses < UINT16_MAX - maintainer->misses_before
                                       ? track->misses + maintainer->misses_before
                                       : UINT16_MAX);
    }
    track->track_id = 1;
    track->plot = row;
    track->status = row >= 0                 ? RHO_TRACK_CONFIRMED
                    : track->misses > misses ? RHO_TRACK_COASTING
                                             : before;
}

/* Counts the plots of the whole scan, of which two gates show the tracker one. */
static void count_fates(struct maintainer *maintainer, const struct rho_scan *scan, int row)
{
    memset(maintainer->fates, 0, sizeof maintainer->fates);
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        const bool is_valid = rho_measurement_is_valid_plot(&scan->plots[i], scan->measures);

        maintainer->fates[(int64_t)i == row ? RHO_FATE_CLAIMED
                          : is_valid        ? RHO_FATE_HELD
                                            : RHO_FATE_INVALID]++;
    }
}

/* Its target exists and is visible, whatever was missed: no miss ends the track or lowers pd. */
static void keep_track(struct rho_tracker *tracker, int64_t time_us)
{
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        tracker->tracks[i].visible = 1.0f;
        tracker->tracks[i].hidden = 0.0f;
        tracker->tracks[i].lived_us = time_us;
    }
    for (unsigned i = 0; i < tracker->num_rows; i++) {
        tracker->sensors[i].blind = 0.0f;
    }
}

int maintainer_step(struct maintainer *maintainer, const struct rho_scan *scan,
                    const struct rho_sensor *sensor, double log_density, struct random *random)
{
    struct rho_scan shown = *scan;
    struct rho_plot plot;
    int chosen = 0, row;

    check_scan_fits_gate(maintainer, scan);
    if ((maintainer->gate == MAINTAIN_NONE || maintainer->gate == MAINTAIN_NEAREST) &&
        maintainer->tracker.num_tracks > 0) {
        chosen = maintainer->gate == MAINTAIN_NONE ? draw_plot(scan, random)
                                                   : nearest_plot(maintainer, scan, sensor);
        shown.num_plots = chosen >= 0;
        if (chosen >= 0) {
            plot = copy_chosen_plot(scan, chosen, &maintainer->track);
            shown.plots = &plot;
            shown.measures |= RHO_MEASURES_VELOCITY;
        }
    }
    if (sensor) {
        must_set_sensor(&maintainer->tracker, sensor);
    }
    if (maintainer->gate == MAINTAIN_BEST && maintainer->is_started) {
        set_clutter(maintainer, scan,
                    sensor ? (double)sensor->pd : (double)maintainer->tracker.config.pd,
                    log_density);
    }
    keep_track(&maintainer->tracker, shown.time_us);
    must_succeed(rho_tracker_step(&maintainer->tracker, NULL, &shown, &maintainer->report), "step");
    row = maintainer->report.num_tracks > 0 ? maintainer->report.tracks[0].plot
                                            : start_or_restart(maintainer, &shown, sensor);
    row = row >= 0 ? row + chosen : -1;
    update_track(maintainer, row);
    count_fates(maintainer, scan, row);
    return row;
}

const uint32_t *maintainer_fates(const struct maintainer *maintainer)
{
    return maintainer->fates;
}

bool maintainer_is_started(const struct maintainer *maintainer)
{
    return maintainer->is_started;
}

const struct rho_track_report *maintainer_report(const struct maintainer *maintainer)
{
    return &maintainer->track;
}

unsigned long maintainer_refusals(const struct maintainer *maintainer)
{
    return maintainer->tracker.counters.updates_refused + maintainer->restarts;
}

/* Predictions. */

/* Adds part of a mixture's mean and second moments about `about`. */
static void add_part(const struct rho_kalman *part, const struct rho_kalman *about, double share,
                     double mean[RHO_KALMAN_STATES], double square[RHO_TRIANGLE(RHO_KALMAN_STATES)])
{
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        const double off = (double)part->state[i] - (double)about->state[i];

        mean[i] += share * off;
        for (int j = 0; j <= i; j++) {
            square[RHO_AT(i, j)] += share * ((double)part->covariance[RHO_AT(i, j)] +
                                             off * (double)(part->state[j] - about->state[j]));
        }
    }
}

/* Mean and covariance over the hypotheses, each predicted; *best is the best one's. */
static void predict_hypotheses(const struct rho_hypotheses *pool, uint16_t slot, int64_t time_us,
                               struct rho_kalman *best, struct rho_kalman *all)
{
    double mean[RHO_KALMAN_STATES] = {0.0}, square[RHO_TRIANGLE(RHO_KALMAN_STATES)] = {0.0};
    double shares = 0.0;
    bool has_best = false;

    for (unsigned i = 0; i < rho_hypotheses_count(pool, slot); i++) {
        const struct rho_hypothesis *hypothesis = rho_hypotheses_at(pool, slot, i);
        struct rho_imm imm = hypothesis->imm;
        struct rho_imm_step step;
        struct rho_kalman part;

        rho_imm_prepare_step(&step, &pool->model,
                             rho_seconds_between(hypothesis->time_us, time_us));
        if (rho_imm_predict(&imm, &step) == RHO_OK) {
            rho_imm_estimate(&imm, &part, NULL);
            *best = has_best ? *best : part;
            has_best = true;
            shares += (double)hypothesis->share;
            add_part(&part, best, (double)hypothesis->share, mean, square);
        }
    }
    *all = *best;
    for (int i = 0; has_best && i < RHO_KALMAN_STATES; i++) {
        all->state[i] += (float)(mean[i] / shares);
        for (int j = 0; j <= i; j++) {
            all->covariance[RHO_AT(i, j)] =
                (float)(square[RHO_AT(i, j)] / shares - mean[i] * mean[j] / (shares * shares));
        }
    }
}

void maintainer_predict(const struct maintainer *maintainer, int64_t time_us,
                        struct rho_track_report *predicted, double place_m[3])
{
    const struct rho_tracker *tracker = &maintainer->tracker;
    const struct rho_track_model model = {.input = &tracker->config.input};
    struct rho_track track = {.track_id = 1};
    struct rho_kalman best;

    *predicted = maintainer->track;
    memcpy(track.kalman.state, predicted->state, sizeof track.kalman.state);
    memcpy(track.kalman.covariance, predicted->covariance, sizeof track.kalman.covariance);
    best = track.kalman;
    if (tracker->num_tracks > 0 && maintainer->gate == MAINTAIN_BEST) {
        predict_hypotheses(&tracker->hypotheses, tracker->tracks[0].slot, time_us, &best,
                           &track.kalman);
    } else if (tracker->num_tracks > 0) {
        track = tracker->tracks[0];
        (void)!rho_track_predict(&track, time_us, &model); /* else it stays where it is */
        best = track.kalman;
    }
    memcpy(predicted->state, track.kalman.state, sizeof predicted->state);
    memcpy(predicted->covariance, track.kalman.covariance, sizeof predicted->covariance);
    predicted->sigma_m = rho_track_sigma_m(&track);
    predicted->sigma_mps = rho_track_sigma_mps(&track);
    for (int i = 0; i < AXES; i++) {
        place_m[i] = (double)best.state[i];
    }
}
