/* SPDX-License-Identifier: MIT */
#include "maintenance/maintainer_of_one_track.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "maintenance/maintainer_by_multiple_hypotheses.h"
#include "maintenance/plot_distance.h"
#include "maintenance/scan_clutter_density.h"
#include "pipeline/pipeline.h"
#include "rhotrack/detail/gate.h"
#include "rhotrack/detail/input_estimation.h"
#include "rhotrack/detail/measurement.h"
#include "rhotrack/detail/track.h"

#define DEG_RAD 0.017453292519943295
#define AXES 3
/* Measurements that a track needs before the Hough gate chooses its plots. */
#define FIRST_ELIMINATION 3

struct maintainer {
    enum maintainer_gate gate;
    /* the hypotheses of the gate best; NULL: another gate, which uses the fields below */
    struct maintainer_hypotheses *best;
    struct scan_clutter_density *density;
    struct rho_input_config config;
    /* RHO_GATE_PLANE_... bits: planes of velocity space in which the Hough gate votes */
    uint8_t planes;
    float theta_cell_rad;
    struct rho_input input; /* filter after the last scan */
    /* time of `input`: the last plot's own time, or the last scan's without a plot */
    int64_t input_us;
    struct rho_input predicted;
    int64_t predicted_us;
    bool is_predicted; /* `predicted` is newer than `input` */
    /* the prediction was refused (a gap too long): the next plot restarts the track */
    bool is_lost;
    /* velocities estimated after the last plot and after the one before */
    float newest_mps[AXES], before_mps[AXES];
    unsigned measurements;
    unsigned long refused;
    bool has_sensor; /* `sensor` describes the sensor of the last scan */
    struct rho_sensor sensor;
    double pd;       /* detection probability of sensors without a description */
    bool is_started; /* set by maintainer_step_and_get_row at the first plot */
    struct rho_track_report track;
};

/* ---- What the parameters say ---- */

static struct rho_input_config input_config_of(const struct parameters *parameters,
                                               bool has_input_estimation)
{
    const double *value = parameters->value;
    float v_max_mps = (float)value[PARAMETER_V_MAX_MPS];
    struct rho_input_config config;

    rho_input_config_default(&config);
    config.is_estimated = has_input_estimation;
    config.model = value[PARAMETER_INPUT_MODEL] > 0.0 ? RHO_INPUT_PHYSICAL : RHO_INPUT_LITERAL;
    config.sigma_mps2 = (float)value[PARAMETER_INPUT_SIGMA_MPS2];
    config.threshold = rho_input_threshold_sigmas((float)value[PARAMETER_ONSET_CONFIDENCE]);
    config.gamma = (float)value[PARAMETER_GAMMA];
    config.noise_m = (float)value[PARAMETER_FILTER_NOISE_M];
    config.noise_mps = (float)value[PARAMETER_FILTER_NOISE_MPS];
    config.velocity_variance = v_max_mps * v_max_mps;
    config.initial_variance = (float)value[PARAMETER_INITIAL_VARIANCE];
    return config;
}

struct maintainer *maintainer_new(enum maintainer_gate gate, bool has_input_estimation,
                                  const struct parameters *parameters)
{
    struct maintainer *maintainer = must_calloc(1, sizeof *maintainer);

    parameters_check_together(parameters);
    maintainer->gate = gate;
    maintainer->density = scan_clutter_density_new();
    maintainer->config = input_config_of(parameters, has_input_estimation);
    maintainer->planes = (uint8_t)parameters->value[PARAMETER_PLANES];
    maintainer->theta_cell_rad = (float)(parameters->value[PARAMETER_GATE_THETA_DEG] * DEG_RAD);
    maintainer->pd = parameters->value[PARAMETER_PD];
    maintainer->track.track_id = 1;
    if (gate == MAINTAIN_BEST) {
        maintainer->best = maintainer_hypotheses_new(parameters);
    }
    return maintainer;
}

struct maintainer *maintainer_new_sharing_pool(const struct maintainer *first)
{
    struct maintainer *maintainer = must_calloc(1, sizeof *maintainer);

    maintainer->gate = first->gate;
    maintainer->density = scan_clutter_density_new();
    maintainer->config = first->config;
    maintainer->planes = first->planes;
    maintainer->theta_cell_rad = first->theta_cell_rad;
    maintainer->pd = first->pd;
    maintainer->track.track_id = 1;
    if (first->best) {
        maintainer->best = maintainer_hypotheses_new_sharing_pool(first->best);
    }
    return maintainer;
}

void maintainer_free(struct maintainer *maintainer)
{
    if (maintainer) {
        maintainer_hypotheses_free(maintainer->best);
        scan_clutter_density_free(maintainer->density);
        free(maintainer);
    }
}

size_t maintainer_state_bytes(const struct maintainer *maintainer)
{
    if (maintainer->best) {
        return maintainer_hypotheses_state_bytes();
    }
    return sizeof maintainer->input +
           (maintainer->gate == MAINTAIN_HOUGH
                ? sizeof maintainer->newest_mps + sizeof maintainer->before_mps
                : 0);
}

static void store_latest_sensor(struct maintainer *maintainer, const struct rho_sensor *sensor)
{
    maintainer->has_sensor = sensor;
    if (sensor) {
        maintainer->sensor = *sensor;
    }
}

/* ---- Start ---- */

/* Replaces unknown velocity components by the measured ones. */
static void set_start_velocity_from_measured_vector(struct rho_kalman *kalman,
                                                    const struct rho_plot *plot)
{
    const float velocity_mps[AXES] = {plot->vx_mps, plot->vy_mps, plot->vz_mps};

    for (int i = 0; i < AXES; i++) {
        if (rho_kalman_has_estimate_on_axis(kalman, i)) {
            kalman->state[i + 3] = velocity_mps[i];
            kalman->covariance[RHO_AT(i + 3, i + 3)] = plot->sigma_mps * plot->sigma_mps;
        }
    }
}

/* Records the velocity estimated after a measurement; the Hough gate uses the last two. */
static void record_estimated_velocity(struct maintainer *maintainer)
{
    struct rho_kalman kalman;

    rho_input_get_corrected_estimate(&maintainer->input, &kalman);
    for (int i = 0; i < AXES; i++) {
        maintainer->before_mps[i] = maintainer->newest_mps[i];
        maintainer->newest_mps[i] = kalman.state[i + 3];
    }
    maintainer->measurements++;
}

void maintainer_start(struct maintainer *maintainer, int64_t time_us, const struct rho_plot *plot,
                      uint32_t measures, const struct rho_sensor *sensor)
{
    struct rho_measurement seen;
    struct rho_kalman kalman;

    store_latest_sensor(maintainer, sensor);
    maintainer->is_predicted = false;
    rho_kalman_init(&kalman);
    rho_measurement_from_plot(plot, measures, sensor, &seen);
    must_succeed(rho_kalman_update_position(&kalman, &seen, maintainer->config.velocity_variance),
                 "start");
    if (measures & RHO_MEASURES_VELOCITY) {
        set_start_velocity_from_measured_vector(&kalman, plot);
    }
    if (maintainer->best) {
        maintainer_hypotheses_start(maintainer->best, time_us + plot->offset_us, time_us, &kalman,
                                    sensor);
        return;
    }
    if (maintainer->config.initial_variance > 0.0f) {
        rho_kalman_set_equal_variances(&kalman, maintainer->config.initial_variance);
    }
    must_succeed(rho_input_start(&maintainer->input, &maintainer->config, &kalman), "start");
    maintainer->measurements = 0;
    maintainer->input_us = time_us + plot->offset_us;
    maintainer->predicted = maintainer->input;
    maintainer->predicted_us = time_us;
    record_estimated_velocity(maintainer);
}

/* ---- Predictions ---- */

/*
 * Predicts the filter from the last plot's time to time_us, which may be earlier (a plot can be
 * later than the next scan's time). Returns false where the filter refuses.
 */
static bool predict_to_time(const struct maintainer *maintainer, int64_t time_us,
                            struct rho_input *predicted)
{
    float dt_s = rho_seconds_between(maintainer->input_us, time_us);

    *predicted = maintainer->input;
    return rho_input_predict(predicted, &maintainer->config, dt_s) == RHO_OK;
}

void maintainer_predict(struct maintainer *maintainer, int64_t time_us)
{
    bool was_lost = maintainer->is_lost;

    maintainer->is_predicted = true;
    maintainer->predicted_us = time_us;
    if (maintainer->best) {
        maintainer->is_lost = !maintainer_hypotheses_predict(maintainer->best, time_us);
    } else {
        maintainer->is_lost = !predict_to_time(maintainer, time_us, &maintainer->predicted);
    }
    maintainer->refused += maintainer->is_lost && !was_lost;
}

void maintainer_predicted_place(const struct maintainer *maintainer, double place_m[3])
{
    struct rho_kalman kalman;

    if (maintainer->best) {
        maintainer_hypotheses_predicted_place(maintainer->best, place_m);
        return;
    }
    rho_input_get_corrected_estimate(&maintainer->predicted, &kalman);
    for (int i = 0; i < AXES; i++) {
        place_m[i] = (double)kalman.state[i];
    }
}

/* Predicts the filter to a plot's own time; returns false where the filter refuses. */
static bool predict_to_plot_time(const struct maintainer *maintainer, const struct rho_plot *plot,
                                 struct rho_input *predicted)
{
    *predicted = maintainer->predicted;
    return plot->offset_us == 0 ||
           predict_to_time(maintainer, maintainer->predicted_us + plot->offset_us, predicted);
}

/*
 * Squared Mahalanobis distance of a plot from the prediction, whose covariance allows for the onset
 * of an input; INFINITY where it cannot be computed.
 */
static double squared_distance_to_plot(const struct maintainer *maintainer,
                                       const struct rho_plot *plot, uint32_t measures,
                                       const struct rho_sensor *sensor, int *dimensions)
{
    struct rho_input at;
    struct rho_kalman expected;
    double distance2 = NAN;

    if (predict_to_plot_time(maintainer, plot, &at)) {
        rho_input_estimate_with_all_inputs(&at, &expected);
        distance2 = plot_squared_mahalanobis(&expected, plot, measures, sensor, dimensions);
    }
    return isfinite(distance2) ? distance2 : INFINITY;
}

double maintainer_nis_per_dimension(const struct maintainer *maintainer,
                                    const struct rho_plot *plot, uint32_t measures)
{
    int dimensions = 1;
    double distance2;

    if (maintainer->best) {
        return maintainer_hypotheses_nis_of_mean_per_dimension(maintainer->best, plot, measures);
    }
    distance2 =
        squared_distance_to_plot(maintainer, plot, measures,
                                 maintainer->has_sensor ? &maintainer->sensor : NULL, &dimensions);
    return distance2 / dimensions;
}

/* ---- Choices: the row of a plot, or -1 ---- */

static int choose_random_plot(const struct rho_scan *scan, struct random *random)
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

static int choose_nearest_plot_without_limit(const struct maintainer *maintainer,
                                             const struct rho_scan *scan,
                                             const struct rho_sensor *sensor)
{
    double least = INFINITY;
    int chosen = -1;

    for (uint32_t i = 0; i < scan->num_plots; i++) {
        const struct rho_plot *plot = &scan->plots[i];
        double distance2 =
            rho_measurement_is_valid_plot(plot, scan->measures)
                ? squared_distance_to_plot(maintainer, plot, scan->measures, sensor, NULL)
                : INFINITY;

        if (distance2 < least) {
            least = distance2;
            chosen = (int)i;
        }
    }
    return chosen;
}

/* Planes that the Hough gate uses: without measured heights only xy; 0 if xy was not chosen. */
static uint8_t usable_hough_gate_planes(const struct maintainer *maintainer, uint32_t measures)
{
    return measures & RHO_MEASURES_Z ? maintainer->planes
                                     : (uint8_t)(maintainer->planes & RHO_GATE_PLANE_XY);
}

static int choose_plot_nearest_to_velocity_line(const struct rho_gate_hough *hough,
                                                const struct rho_scan *scan)
{
    float least_mps = INFINITY;
    int chosen = -1;

    for (uint32_t i = 0; i < scan->num_plots; i++) {
        const struct rho_plot *plot = &scan->plots[i];
        const float velocity_mps[AXES] = {plot->vx_mps, plot->vy_mps,
                                          scan->measures & RHO_MEASURES_Z ? plot->vz_mps : 0.0f};
        float off_mps = rho_measurement_is_valid_plot(plot, scan->measures)
                            ? rho_gate_hough_velocity_distance_from_lines_mps(hough, velocity_mps)
                            : INFINITY;

        if (off_mps < least_mps) {
            least_mps = off_mps;
            chosen = (int)i;
        }
    }
    return chosen;
}

static int choose_plot(const struct maintainer *maintainer, const struct rho_scan *scan,
                       const struct rho_sensor *sensor, struct random *random)
{
    struct rho_gate_hough hough;

    if (maintainer->gate == MAINTAIN_NONE) {
        return choose_random_plot(scan, random);
    }
    if (maintainer->gate == MAINTAIN_HOUGH && maintainer->measurements >= FIRST_ELIMINATION &&
        (scan->measures & RHO_MEASURES_VELOCITY) &&
        rho_gate_hough_init(&hough, usable_hough_gate_planes(maintainer, scan->measures),
                            maintainer->theta_cell_rad, maintainer->before_mps,
                            maintainer->newest_mps) == RHO_OK) {
        return choose_plot_nearest_to_velocity_line(&hough, scan);
    }
    return choose_nearest_plot_without_limit(maintainer, scan, sensor);
}

/* ---- Updates ---- */

static bool update_by_measured_velocity(struct rho_input *input,
                                        const struct rho_input_config *config,
                                        const struct rho_plot *plot, int axes)
{
    const float velocity_mps[AXES] = {plot->vx_mps, plot->vy_mps, plot->vz_mps};
    float variance = plot->sigma_mps * plot->sigma_mps;

    for (int i = 0; i < axes && i < AXES; i++) {
        if (rho_kalman_has_estimate_on_axis(&input->bare, i) &&
            rho_input_update_filter_by_element(input, config, i + 3, velocity_mps[i], variance) !=
                RHO_OK) {
            return false;
        }
    }
    return true;
}

/*
 * Predicts the filter to the plot's time, updates it by all that the plot measures, and decides
 * whether an input is present. Returns false where a step is refused.
 */
static bool update_by_plot(const struct maintainer *maintainer, const struct rho_plot *plot,
                           uint32_t measures, const struct rho_sensor *sensor,
                           struct rho_input *input)
{
    const struct rho_input_config *config = &maintainer->config;
    struct rho_measurement seen;

    rho_measurement_from_plot(plot, measures, sensor, &seen);
    if (!predict_to_plot_time(maintainer, plot, input) ||
        rho_input_update_position(input, config, &seen) != RHO_OK ||
        ((measures & RHO_MEASURES_VELOCITY) &&
         !update_by_measured_velocity(input, config, plot, seen.has_z ? 3 : 2)) ||
        ((measures & RHO_MEASURES_RANGE_RATE) &&
         rho_input_update_range_rate(input, config, sensor, plot->range_rate_mps,
                                     plot->sigma_range_rate_mps * plot->sigma_range_rate_mps) !=
             RHO_OK)) {
        return false;
    }
    rho_input_test_and_end_inputs(input, config);
    return true;
}

/*
 * Updates the track with the chosen plot and returns its row. Without a plot, or where its update
 * is refused, the track coasts, and -1 is returned.
 */
static int update_or_coast(struct maintainer *maintainer, const struct rho_scan *scan,
                           const struct rho_sensor *sensor, int row)
{
    struct rho_input updated;
    bool is_taken =
        row >= 0 && update_by_plot(maintainer, &scan->plots[row], scan->measures, sensor, &updated);

    maintainer->is_predicted = false;
    maintainer->input = is_taken ? updated : maintainer->predicted;
    maintainer->input_us = scan->time_us + (is_taken ? scan->plots[row].offset_us : 0);
    if (is_taken) {
        record_estimated_velocity(maintainer);
    }
    maintainer->refused += row >= 0 && !is_taken;
    return is_taken ? row : -1;
}

/*
 * Restarts the track at the plot nearest to its last place, after a gap too long for a prediction.
 */
static int restart_at_nearest_plot(struct maintainer *maintainer, const struct rho_scan *scan,
                                   const struct rho_sensor *sensor)
{
    double last_m[AXES], least_m = INFINITY;
    int chosen = -1;

    maintainer_predicted_place(maintainer, last_m);
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        const struct rho_plot *plot = &scan->plots[i];
        double distance_m =
            rho_measurement_is_valid_plot(plot, scan->measures)
                ? hypot((double)plot->x_m - last_m[0], (double)plot->y_m - last_m[1])
                : INFINITY;

        if (distance_m < least_m) {
            least_m = distance_m;
            chosen = (int)i;
        }
    }
    if (chosen >= 0) {
        maintainer_start(maintainer, scan->time_us, &scan->plots[chosen], scan->measures, sensor);
    }
    return chosen;
}

int maintainer_update_and_get_row(struct maintainer *maintainer, const struct rho_scan *scan,
                                  const struct rho_sensor *sensor, double log_density, double pd,
                                  struct random *random)
{
    double place_m[AXES];

    store_latest_sensor(maintainer, sensor);
    if (maintainer->is_lost) {
        return restart_at_nearest_plot(maintainer, scan, sensor);
    }
    if (!maintainer->best) {
        return update_or_coast(maintainer, scan, sensor,
                               choose_plot(maintainer, scan, sensor, random));
    }
    maintainer_predicted_place(maintainer, place_m);
    maintainer->is_predicted = false;
    if (isnan(log_density)) {
        log_density = scan_clutter_density_add_and_get_log(maintainer->density, scan, place_m, pd);
    }
    return maintainer_hypotheses_update(maintainer->best, scan, sensor, log_density, pd);
}

/* ---- The estimate ---- */

void maintainer_estimate(const struct maintainer *maintainer, struct maintainer_estimate *estimate)
{
    struct rho_input now = maintainer->predicted;

    if (maintainer->best) {
        maintainer_hypotheses_mean_estimate(maintainer->best, estimate);
        return;
    }
    if (!maintainer->is_predicted) {
        now = maintainer->input;
        if (maintainer->input_us != maintainer->predicted_us) {
            (void)predict_to_time(maintainer, maintainer->predicted_us, &now);
        }
    }
    *estimate =
        (struct maintainer_estimate){.maneuver_probability = now.present != 0, .num_hypotheses = 1};
    rho_input_get_corrected_estimate(&now, &estimate->kalman);
    for (int i = 0; i < AXES; i++) {
        estimate->accel_mps2[i] = now.present & (1u << i) ? now.input_mps2[i] : 0.0f;
    }
}

/* ---- Scan by scan ---- */

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
    if (usable_hough_gate_planes(maintainer, scan->measures) == 0) {
        fail(EXIT_USAGE, "gate hough: the scan at %.6f s has no heights, so planes must contain xy",
             (double)scan->time_us * 1e-6);
    }
}

static void count_hit_or_miss(struct rho_track_report *track, const struct rho_scan *scan, int row)
{
    uint16_t *count = row >= 0 ? &track->hits : &track->misses;

    *count = (uint16_t)(*count + (*count < UINT16_MAX));
    track->status = row >= 0 ? RHO_TRACK_CONFIRMED : RHO_TRACK_COASTING;
    if (row >= 0) {
        track->sensor_id = scan->sensor_id;
    }
}

static int update_if_covered_and_get_row(struct maintainer *maintainer, const struct rho_scan *scan,
                                         const struct rho_sensor *sensor, double log_density,
                                         struct random *random)
{
    double place_m[AXES];
    int row;

    if (!maintainer->is_predicted || maintainer->predicted_us != scan->time_us) {
        maintainer_predict(maintainer, scan->time_us);
    }
    maintainer_predicted_place(maintainer, place_m);
    if (!rho_measurement_covers(sensor, scan->sector_from_rad, scan->sector_to_rad,
                                (float)place_m[0], (float)place_m[1])) {
        return -1;
    }
    row = maintainer_update_and_get_row(maintainer, scan, sensor, log_density,
                                        sensor ? (double)sensor->pd : maintainer->pd, random);
    count_hit_or_miss(&maintainer->track, scan, row);
    return row;
}

int maintainer_step_and_get_row(struct maintainer *maintainer, const struct rho_scan *scan,
                                const struct rho_sensor *sensor, double log_density,
                                struct random *random)
{
    int row = -1;

    check_scan_fits_gate(maintainer, scan);
    if (maintainer->is_started) {
        row = update_if_covered_and_get_row(maintainer, scan, sensor, log_density, random);
    } else if (scan->num_plots > 0) {
        row = 0;
        maintainer->is_started = true;
        maintainer_start(maintainer, scan->time_us, &scan->plots[0], scan->measures, sensor);
        count_hit_or_miss(&maintainer->track, scan, row);
    }
    maintainer->track.plot = row;
    return row;
}

bool maintainer_is_started(const struct maintainer *maintainer)
{
    return maintainer->is_started;
}

const struct rho_track_report *maintainer_report(struct maintainer *maintainer)
{
    struct rho_track_report *track = &maintainer->track;
    struct rho_track sigmas = {.track_id = 1};
    struct maintainer_estimate estimate;

    maintainer_estimate(maintainer, &estimate);
    memcpy(track->state, estimate.kalman.state, sizeof track->state);
    memcpy(track->covariance, estimate.kalman.covariance, sizeof track->covariance);
    memcpy(track->accel_mps2, estimate.accel_mps2, sizeof track->accel_mps2);
    sigmas.kalman = estimate.kalman;
    track->sigma_m = rho_track_sigma_m(&sigmas);
    track->sigma_mps = rho_track_sigma_mps(&sigmas);
    return track;
}

unsigned long maintainer_num_filter_refusals(const struct maintainer *maintainer)
{
    return maintainer->refused +
           (maintainer->best ? maintainer_hypotheses_num_updates_refused(maintainer->best) : 0);
}
