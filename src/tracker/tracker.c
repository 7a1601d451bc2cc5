/* SPDX-License-Identifier: MIT */
#include "rhotrack/tracker.h"

#include <string.h>

#include "clutter_map.h"
#include "rhotrack/angle.h"
#include "rhotrack/approx.h"
#include "rhotrack/measurement.h"
#include "tracker_step.h"

#define TRACKER_MAGIC 0x5452434bu /* "TRCK" */

/* White acceleration that follows manoeuvres of accel_max: half of it, kept up for a second. */
#define ACCEL_SHARE 0.5f
#define ACCEL_TIME_S 1.0f

#define ALL_PLANES (RHO_GATE_PLANE_XY | RHO_GATE_PLANE_XZ | RHO_GATE_PLANE_YZ)

/* Memory of the smoothed clutter counts: ten scans. */
#define CLUTTER_SMOOTHING 0.1f

/* The build fails where the RAM formula of config.h is no longer an upper bound. */
typedef char rho_assert_tracker_ram[sizeof(struct rho_tracker) <= RHO_RAM_TRACKER_BYTES ? 1 : -1];

/* ---- what a step is asked ---------------------------------------------------------------------- */

int rho_tracker_is_ready(const struct rho_tracker *tracker)
{
    return tracker->magic == TRACKER_MAGIC;
}

int rho_tracker_is_late(const struct rho_tracker *tracker, int64_t time_us)
{
    return tracker->has_time && time_us < tracker->time_us;
}

int rho_tracker_is_time(int64_t time_us)
{
    return time_us <= RHO_LIMIT_TIME_US && time_us >= -RHO_LIMIT_TIME_US;
}

/* ---- sensors ---------------------------------------------------------------------------------- */

/* num_sensors where nothing was said of it. */
static unsigned place_of_sensor(const struct rho_tracker *tracker, int32_t sensor_id)
{
    unsigned place = 0;

    while (place < tracker->num_sensors && tracker->sensors[place].sensor_id != sensor_id) {
        place++;
    }
    return place;
}

const struct rho_sensor *rho_tracker_find_sensor(const struct rho_tracker *tracker,
                                                 int32_t sensor_id)
{
    unsigned place = place_of_sensor(tracker, sensor_id);

    return place < tracker->num_sensors ? &tracker->sensors[place] : NULL;
}

int rho_tracker_is_usable_sensor(const struct rho_sensor *sensor)
{
    return rho_measurement_is_sensor(sensor) && rho_is_within(sensor->pd, 0.01f, 0.999f) &&
           rho_is_within(sensor->range_min_m, 0.0f, 2.0f * RHO_LIMIT_POSITION_M) &&
           rho_is_within(sensor->range_max_m, 0.0f, 2.0f * RHO_LIMIT_POSITION_M) &&
           sensor->range_min_m < sensor->range_max_m &&
           rho_angle_is_sector(sensor->sector_from_rad, sensor->sector_to_rad);
}

/* ---- begin: which plots can be believed ------------------------------------------------------- */

static float larger(float a, float b)
{
    return a > b ? a : b;
}

/* What gates have to look for. */
static void note_widest(struct step *step, const struct rho_plot *plot)
{
    float offset_s = (float)plot->offset_us * 1e-6f;
    const float factor = rho_measurement_widest_factor(step->sensor);
    step->sigma_max_m = larger(step->sigma_max_m, factor * rho_plot_sigma_m(plot));
    step->offset_max_s = larger(step->offset_max_s, offset_s < 0.0f ? -offset_s : offset_s);
    if (step->scan->measures & RHO_MEASURES_Z) {
        step->sigma_max_m = larger(step->sigma_max_m, factor * plot->sigma_up_m);
    }
}

void rho_tracker_judge_plots(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    for (uint32_t i = 0; i < step->num_gated; i++) {
        const struct rho_plot *plot = &step->scan->plots[i];
        int valid = rho_measurement_is_valid(plot, step->scan->measures);
        if (valid && !rho_tracker_covers(step->sensor, plot, step->scan->measures)) {
            valid = 0;
            tracker->counters.plots_outside = rho_count(tracker->counters.plots_outside, 1);
        }
        step->report->fates[i] = (uint8_t)(valid ? RHO_FATE_HELD : RHO_FATE_INVALID);
        if (valid) {
            rho_extent_add(&tracker->extent, plot->x_m, plot->y_m);
            note_widest(step, plot);
        }
    }
}

void rho_tracker_set_pd(struct step *step)
{
    float pd = step->sensor ? step->sensor->pd : step->tracker->config.pd;
    step->log_pd = rho_log(pd);
    step->log_miss = rho_log(1.0f - pd);
}

enum rho_track_filter rho_tracker_filter_of(const struct rho_tracker_config *config)
{
    if (config->gate == RHO_TRACKER_BEST) {
        return RHO_TRACK_HYPOTHESES;
    }
    return config->input.is_estimated ? RHO_TRACK_INPUT : RHO_TRACK_KALMAN;
}

/* What targets may do, and who follows them. */
static void set_model(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    float accel_mps2 = ACCEL_SHARE * tracker->config.accel_max_mps2;
    step->log_height = rho_log(RHO_CLUTTER_HEIGHT_M);
    step->log_rates = rho_log(2.0f * tracker->config.v_max_mps);
#if RHO_AMBIGUOUS_RANGE_RATES
    step->log_range_rates = step->log_rates;
#endif
    step->model.speed_sigma_mps = tracker->config.v_max_mps;
    step->model.noise_density = accel_mps2 * accel_mps2 * ACCEL_TIME_S;
    if (rho_tracker_filter_of(&tracker->config) == RHO_TRACK_HYPOTHESES) {
        step->model.hypotheses = &tracker->hypotheses;
    } else if (tracker->config.input.is_estimated) {
        step->model.input = &tracker->config.input;
    }
}

static void begin(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    tracker->counters.scans_accepted = rho_count(tracker->counters.scans_accepted, 1);
    if (RHO_SECTORS && step->is_late) {
        rho_tracker_begin_late(step);
        return;
    }
    rho_tracker_forget_calm(tracker, step->time_us);
    tracker->time_us = step->time_us;
    tracker->has_time = 1;
}

/* ---- report ----------------------------------------------------------------------------------- */

/* Late scans, and those that do not reach the track: its one estimate moves, on with its acceleration, hypotheses stay. */
static void move_estimate(struct rho_track *at, float dt_s, float noise_density)
{
    if (rho_kalman_predict(&at->kalman, dt_s, noise_density) != RHO_OK) {
        return;
    }
    for (int axis = 0; axis < 3 && dt_s > 0.0f; axis++) {
        at->kalman.state[axis] += 0.5f * dt_s * dt_s * at->accel_mps2[axis];
        at->kalman.state[axis + 3] += dt_s * at->accel_mps2[axis];
    }
}

/* The track at the step's time: itself, or moved there in *at. */
static const struct rho_track *at_step(const struct step *step, const struct rho_track *track,
                                       struct rho_track *at)
{
    if (track->time_us == step->time_us) {
        return track;
    }
    *at = *track;
    /* back from the plot's own time to the scan's, without noise, or on: nothing to refuse */
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        move_estimate(at, rho_seconds_between(track->time_us, step->time_us),
                      step->model.noise_density);
    } else {
        (void)!rho_track_predict(at, step->time_us, &step->model);
    }
    return at;
}

static void report_track(const struct step *step, const struct rho_track *track,
                         struct rho_track_report *out)
{
    int64_t age_us = step->time_us - track->updated_us;
    struct rho_track moved;
    const struct rho_track *at = at_step(step, track, &moved);
    *out = (struct rho_track_report){
        .track_id = track->track_id,
        .status = (enum rho_track_status)track->status,
        .hits = track->hits,
        .misses = track->misses,
        .sensor_id = track->sensor_id,
        .plot = rho_tracker_is_late(step->tracker, step->time_us) ? -1 : track->plot,
        .update_age_us = age_us < 0           ? 0
                         : age_us < INT32_MAX ? (int32_t)age_us
                                              : INT32_MAX,
        .score_nat = (float)track->score_mnat * 0.001f,
        .sigma_m = rho_track_sigma_m(at),
        .sigma_mps = rho_track_sigma_mps(at),
        .maneuver_probability = at->maneuver_probability,
        .num_hypotheses = 1,
    };
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        out->num_hypotheses =
            (uint16_t)rho_hypotheses_count(&step->tracker->hypotheses, track->slot);
    }
    memcpy(out->accel_mps2, at->accel_mps2, sizeof out->accel_mps2);
    memcpy(out->state, at->kalman.state, sizeof out->state);
    memcpy(out->covariance, at->kalman.covariance, sizeof out->covariance);
}

/* Plots without a place in fates[] have a fate all the same: that of a late scan, or NO_ROOM. */
static void count_fates(const struct step *step)
{
    struct rho_tracker_counters *counters = &step->tracker->counters;
    struct rho_report *report = step->report;
    for (uint32_t i = 0; i < step->num_gated; i++) {
        report->fates_total[report->fates[i]]++;
    }
    uint32_t others = step->num_inputs - step->num_gated;
    if (RHO_CLAIMS_BEYOND) {
        report->fates_total[RHO_FATE_CLAIMED] += step->num_beyond_claimed;
        report->fates_total[RHO_FATE_INVALID] += step->num_beyond_invalid;
        others -= step->num_beyond_claimed + step->num_beyond_invalid;
    }
    report->fates_total[step->is_late ? RHO_FATE_STALE : RHO_FATE_NO_ROOM] += others;
    for (int fate = 0; fate < RHO_NUM_FATES; fate++) {
        counters->fates[fate] = rho_count(counters->fates[fate], report->fates_total[fate]);
    }
    counters->plots_in = rho_count(counters->plots_in, step->num_inputs);
}

void rho_tracker_smooth(float *mean, float newest)
{
    *mean += CLUTTER_SMOOTHING * (newest - *mean);
}

static void note_unclaimed(struct step *step)
{
    float unclaimed = 0.0f;
    for (uint32_t i = 0; i < step->num_gated; i++) {
        uint8_t fate = step->report->fates[i];
        unclaimed += fate == RHO_FATE_HELD || fate == RHO_FATE_NO_ROOM ? 1.0f : 0.0f;
    }
    rho_tracker_smooth(&step->tracker->unclaimed_plots, unclaimed * rho_tracker_turns(step));
}

void rho_tracker_close(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    count_fates(step);
    tracker->counters.hypotheses_cut = tracker->hypotheses.hypotheses_cut;
    step->report->num_tracks = tracker->num_tracks;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        report_track(step, &tracker->tracks[i], &step->report->tracks[i]);
    }
}

/* ---- public ----------------------------------------------------------------------------------- */

void rho_tracker_config_default(struct rho_tracker_config *config)
{
    *config = (struct rho_tracker_config)
    {
        .pd = 0.9f, .v_max_mps = 700.0f, .accel_max_mps2 = 30.0f,
#if RHO_SECTORS
        .late_max_s = 20.0f,
#endif
        .learn_noise_min = 0.7f, .learn_noise_max = 4.0f, .learn_pd_min = 0.5f,
        .coast_scans_max = 5, .work_max = RHO_WORK_MAX,
        .gate = RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) ? RHO_TRACKER_BEST : RHO_TRACKER_NEAREST,
        .planes = RHO_GATE_PLANE_XY | RHO_GATE_PLANE_XZ | RHO_GATE_PLANE_YZ,
        .theta_cell_rad = 5.0f * (RHO_PI / 180.0f),
    };
    rho_input_config_default(&config->input);
    config->input.is_estimated = (RHO_FILTERS) == 1 << RHO_TRACK_INPUT;
}

int rho_tracker_is_usable(const struct rho_tracker_config *config)
{
    return rho_is_within(config->pd, 0.01f, 0.999f) &&
           rho_is_within(config->v_max_mps, 1.0f, RHO_LIMIT_SPEED_MPS) &&
           rho_is_within(config->accel_max_mps2, 0.0f, 1000.0f) &&
           rho_is_within(config->steady_s, 0.0f, 1e5f) &&
           rho_is_within(config->v_min_mps, 0.0f, config->v_max_mps) &&
           rho_tracker_is_late_usable(config) &&
           rho_is_within(config->learn_noise_min, 0.1f, 1.0f) &&
           rho_is_within(config->learn_noise_max, 1.0f, 10.0f) &&
           rho_is_within(config->learn_pd_min, 0.1f, 1.0f) && config->coast_scans_max >= 1 &&
           config->coast_scans_max <= UINT8_MAX && config->gate < RHO_NUM_TRACKER_GATES &&
           RHO_HAS_FILTER(rho_tracker_filter_of(config)) &&
           (config->gate != RHO_TRACKER_BEST || RHO_MAX_HYPOTHESES > RHO_MAX_TRACKS) &&
           (config->gate != RHO_TRACKER_HOUGH || RHO_HAS_FILTER(RHO_TRACK_INPUT)) &&
           (!RHO_HAS_FILTER(RHO_TRACK_INPUT) || rho_input_is_usable(&config->input)) &&
           config->planes > 0 && config->planes <= ALL_PLANES &&
           rho_is_within(config->theta_cell_rad, 1e-3f, RHO_HALF_PI) &&
           config->work_max <= RHO_LIMIT_WORK;
}

static enum rho_status open_hypotheses(struct rho_tracker *tracker)
{
    struct rho_imm_model model;
    rho_imm_model_default(&model, tracker->config.accel_max_mps2, tracker->config.v_max_mps);
    model.speed_max_mps = tracker->config.v_max_mps;
    model.steady_s = larger(model.steady_s, tracker->config.steady_s);
    return rho_hypotheses_init(&tracker->hypotheses, sizeof tracker->hypotheses, &model);
}

enum rho_status rho_tracker_init(struct rho_tracker *tracker, size_t size,
                                 const struct rho_tracker_config *config)
{
    if (!tracker || !config) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *tracker) {
        return RHO_ERROR_SIZE;
    }
    if (!rho_tracker_is_usable(config)) {
        return RHO_ERROR_CONFIG;
    }
    enum rho_status status;
    struct rho_tracker_config copy = *config;
    memset(tracker, 0, sizeof *tracker);
    tracker->config = copy;
    tracker->next_track_id = 1;
    tracker->looks_max = 1;
    tracker->extent = (struct rho_extent){1.0f, 0.0f, 1.0f, 0.0f};
#if RHO_MAX_ECHOES > 0
    rho_clutter_map_init(&tracker->clutter_map, copy.v_min_mps);
#endif
    status = RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) ? open_hypotheses(tracker) : RHO_OK;
    if (status != RHO_OK) {
        return status;
    }
    tracker->magic = TRACKER_MAGIC;
    return rho_assignment_init(&tracker->assignment, sizeof tracker->assignment);
}

enum rho_status rho_tracker_set_sensor(struct rho_tracker *tracker, const struct rho_sensor *sensor)
{
    if (!tracker || !sensor) {
        return RHO_ERROR_NULL;
    }
    if (!rho_tracker_is_ready(tracker)) {
        return RHO_ERROR_STATE;
    }
    if (!rho_tracker_is_usable_sensor(sensor)) {
        return RHO_ERROR_CONFIG;
    }
    unsigned place = place_of_sensor(tracker, sensor->sensor_id);
    if (place == RHO_MAX_SENSORS) {
        return RHO_ERROR_CAPACITY;
    }
    tracker->sensors[place] = *sensor;
    if (place == tracker->num_sensors) {
        memset(&tracker->learned[place], 0, sizeof tracker->learned[place]);
    }
    tracker->num_sensors =
        (uint16_t)(place < tracker->num_sensors ? tracker->num_sensors : place + 1u);
    return RHO_OK;
}

enum rho_status rho_tracker_forget_sensor(struct rho_tracker *tracker, int32_t sensor_id)
{
    if (!tracker) {
        return RHO_ERROR_NULL;
    }
    if (!rho_tracker_is_ready(tracker)) {
        return RHO_ERROR_STATE;
    }
    unsigned place = place_of_sensor(tracker, sensor_id);
    if (place == tracker->num_sensors) {
        return RHO_ERROR_STATE;
    }
    tracker->num_sensors--;
    tracker->sensors[place] = tracker->sensors[tracker->num_sensors];
    memset(&tracker->sensors[tracker->num_sensors], 0, sizeof tracker->sensors[0]);
    tracker->learned[place] = tracker->learned[tracker->num_sensors];
    memset(&tracker->learned[tracker->num_sensors], 0, sizeof tracker->learned[0]);
    rho_tracker_forget_look(tracker, sensor_id);
    rho_tracker_forget_pace(tracker, sensor_id);
    rho_tracker_forget_second_plots(tracker, sensor_id);
    return RHO_OK;
}

static enum rho_status check_step(const struct rho_tracker *tracker,
                                  const struct rho_initiator *initiator,
                                  const struct rho_scan *scan, const struct rho_report *report)
{
    if (!tracker || !scan || !report || (scan->num_plots && !scan->plots)) {
        return RHO_ERROR_NULL;
    }
    if (!rho_tracker_is_ready(tracker)) {
        return RHO_ERROR_STATE;
    }
    if (!rho_angle_is_sector(scan->sector_from_rad, scan->sector_to_rad) ||
        !rho_tracker_is_time(scan->time_us)) {
        return RHO_ERROR_VALUE;
    }
    /* a late scan is not pushed, but asks for the density */
    return !initiator ||
                   rho_initiator_accepts(initiator, rho_tracker_is_late(tracker, scan->time_us)
                                                        ? RHO_LIMIT_TIME_US
                                                        : scan->time_us)
               ? RHO_OK
               : RHO_ERROR_STATE;
}

/* A scan older than what was stepped: counted, and nothing else. */
static void refuse_late(struct step *step)
{
    memset(step->report->fates, RHO_FATE_STALE, step->num_gated);
    step->tracker->counters.scans_late = rho_count(step->tracker->counters.scans_late, 1);
}

static void claim(struct step *step)
{
#if RHO_CLAIMS_BEYOND
    if (step->num_inputs > RHO_MAX_PLOTS) {
        rho_tracker_claim_parts(step);
        return;
    }
#endif
    rho_tracker_judge_plots(step);
    rho_tracker_sort_plots(step);
    rho_tracker_look_at_clutter(step);
    rho_tracker_claim(step);
    rho_tracker_watch(step);
    rho_tracker_learn(step);
    rho_tracker_update(step);
}

static void take_in(struct step *step)
{
    const unsigned place = place_of_sensor(step->tracker, step->scan->sensor_id);
    if (place < step->tracker->num_sensors) {
        step->sensor = &step->tracker->sensors[place];
        step->learned = &step->tracker->learned[place];
    }
    rho_tracker_set_pd(step);
    rho_tracker_note_look(step);
    if (!step->is_late) {
        const struct rho_sensor nowhere = {.sensor_id = step->scan->sensor_id};
        rho_tracker_note_pace(step->tracker, step->sensor ? step->sensor : &nowhere, step->time_us,
                              step->scan->sector_from_rad, step->scan->sector_to_rad);
    }
    rho_tracker_set_noise(step);
#if RHO_AMBIGUOUS_RANGE_RATES
    step->log_range_rates -=
        rho_measurement_log_aliases(step->sensor, step->tracker->config.v_max_mps);
#endif
    step->range_rates_mps = rho_exp(rho_tracker_log_range_rates(step));
    rho_tracker_predict(step);
    claim(step);
    rho_tracker_expect_second_plots(step);
    rho_tracker_age(step);
    if (RHO_SECTORS && step->is_late) {
        rho_tracker_end_late(step);
        return;
    }
    rho_tracker_initiate(step);
    rho_tracker_learn_clutter(step);
    rho_tracker_settle(step);
    note_unclaimed(step);
}

int rho_tracker_open(struct step *step)
{
    struct rho_report *report = step->report;
    step->num_gated = step->num_inputs < RHO_MAX_PLOTS ? step->num_inputs : RHO_MAX_PLOTS;
    memset(report, 0, sizeof *report);
    report->time_us = step->time_us;
    report->num_plots = step->num_inputs;
    set_model(step);
    step->is_late = rho_tracker_is_late(step->tracker, step->time_us);
    if (step->is_late && !rho_tracker_takes_late(step)) {
        refuse_late(step);
        return 0;
    }
    begin(step);
    return 1;
}

enum rho_status rho_tracker_step(struct rho_tracker *tracker, struct rho_initiator *initiator,
                                 const struct rho_scan *scan, struct rho_report *report)
{
    enum rho_status status = check_step(tracker, initiator, scan, report);
    if (status != RHO_OK) {
        return status;
    }
    struct step step = {
        .tracker = tracker,
        .initiator = initiator,
        .scan = scan,
        .report = report,
        .time_us = scan->time_us,
        .num_inputs = scan->num_plots,
    };
    if (rho_tracker_open(&step)) {
        take_in(&step);
        rho_tracker_end_work(&step);
    }
    rho_tracker_close(&step);
    return RHO_OK;
}
