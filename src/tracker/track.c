/* SPDX-License-Identifier: MIT */
/* track: life cycle, score and estimate of one track; its filter is chosen at the start. */
#include "rhotrack/detail/track.h"

#include <string.h>

#include "plots.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"

const char *rho_track_status_name(enum rho_track_status status)
{
    static const char *const names[RHO_NUM_TRACK_STATUS] = {
        [RHO_TRACK_FREE] = "free",
        [RHO_TRACK_TENTATIVE] = "tentative",
        [RHO_TRACK_CONFIRMED] = "confirmed",
        [RHO_TRACK_COASTING] = "coasting",
    };
    return (unsigned)status < RHO_NUM_TRACK_STATUS ? names[status] : "unknown";
}

enum rho_track_status rho_track_next_status(enum rho_track_status status,
                                            enum rho_track_event event)
{
    /* rows: statuses; columns: the events start, confirm, update, miss, doubt, drop */
    static const uint8_t next[RHO_NUM_TRACK_STATUS][RHO_NUM_TRACK_EVENTS] = {
        [RHO_TRACK_FREE] = {RHO_TRACK_TENTATIVE, RHO_TRACK_FREE, RHO_TRACK_FREE, RHO_TRACK_FREE,
                            RHO_TRACK_FREE, RHO_TRACK_FREE},
        /* a plot or a miss alone changes nothing: thresholds of the score confirm and drop */
        [RHO_TRACK_TENTATIVE] = {RHO_TRACK_TENTATIVE, RHO_TRACK_CONFIRMED, RHO_TRACK_TENTATIVE,
                                 RHO_TRACK_TENTATIVE, RHO_TRACK_TENTATIVE, RHO_TRACK_FREE},
        [RHO_TRACK_CONFIRMED] = {RHO_TRACK_CONFIRMED, RHO_TRACK_CONFIRMED, RHO_TRACK_CONFIRMED,
                                 RHO_TRACK_COASTING, RHO_TRACK_TENTATIVE, RHO_TRACK_FREE},
        /* one plot is enough for a coasting track to be confirmed again */
        [RHO_TRACK_COASTING] = {RHO_TRACK_COASTING, RHO_TRACK_COASTING, RHO_TRACK_CONFIRMED,
                                RHO_TRACK_COASTING, RHO_TRACK_TENTATIVE, RHO_TRACK_FREE},
    };
    if ((unsigned)status >= RHO_NUM_TRACK_STATUS || (unsigned)event >= RHO_NUM_TRACK_EVENTS) {
        return status;
    }
    return (enum rho_track_status)next[status][event];
}

void rho_track_apply_event(struct rho_track *track, enum rho_track_event event)
{
    track->status = (uint8_t)rho_track_next_status((enum rho_track_status)track->status, event);
}

int32_t rho_score_to_mnat(float nat)
{
    float mnat = nat * 1000.0f;
    if (!(mnat > -(float)RHO_ASSIGNMENT_COST_MAX)) {
        return -RHO_ASSIGNMENT_COST_MAX;
    }
    return mnat < (float)RHO_ASSIGNMENT_COST_MAX ? (int32_t)mnat : RHO_ASSIGNMENT_COST_MAX;
}

void rho_track_add_score(struct rho_track *track, int32_t gain_mnat)
{
    int64_t score = (int64_t)track->score_mnat + gain_mnat;
    score = score > RHO_SCORE_MAX_MNAT ? RHO_SCORE_MAX_MNAT : score;
    score = score < -RHO_SCORE_MAX_MNAT ? -RHO_SCORE_MAX_MNAT : score;
    track->score_mnat = (int32_t)score;
    track->look_nat += 0.001f * (float)gain_mnat;
    if (track->score_mnat > track->score_max_mnat) {
        track->score_max_mnat = track->score_mnat;
    }
}

static void count_hit(struct rho_track *track)
{
    track->hits = (uint16_t)(track->hits < UINT16_MAX ? track->hits + 1 : UINT16_MAX);
    track->misses_in_row = 0;
}

void rho_track_count_miss(struct rho_track *track, int32_t loss_mnat)
{
    track->misses = (uint16_t)(track->misses < UINT16_MAX ? track->misses + 1 : UINT16_MAX);
    track->misses_in_row =
        (uint8_t)(track->misses_in_row < UINT8_MAX ? track->misses_in_row + 1 : UINT8_MAX);
    track->plot = -1;
    rho_track_add_score(track, -loss_mnat);
    rho_track_apply_event(track, RHO_TRACK_MISS);
}

static float root_mean_variance(const struct rho_kalman *kalman, int first)
{
    float sum = 0.0f;
    int axes = 0;
    for (int axis = 0; axis < 3; axis++) {
        if (rho_kalman_has_axis(kalman, axis)) {
            sum += kalman->covariance[RHO_AT(first + axis, first + axis)];
            axes++;
        }
    }
    return axes ? rho_sqrt(sum / (float)axes) : 0.0f;
}

float rho_track_sigma_m(const struct rho_track *track)
{
    return root_mean_variance(&track->kalman, 0);
}

float rho_track_sigma_mps(const struct rho_track *track)
{
    return root_mean_variance(&track->kalman, 3);
}

/* Number of axes on which a plot measures the velocity. */
static int num_velocities_of(const struct rho_track_plot *seen,
                             const struct rho_measurement *measurement)
{
    return !(seen->measures & RHO_MEASURES_VELOCITY) ? 0 : measurement->has_z ? 3 : 2;
}

/* Updates a state by what a plot measured; the range rate last, linearised at the new position. */
static enum rho_status update_state_by_plot(struct rho_kalman *kalman,
                                            const struct rho_track_plot *seen,
                                            const struct rho_track_model *model)
{
    const struct rho_plot *plot = &seen->plot;
    struct rho_measurement measurement;
    rho_measurement_from_plot(plot, seen->measures, seen->sensor, &measurement);
    enum rho_status status = rho_kalman_update_position(
        kalman, &measurement, model->speed_sigma_mps * model->speed_sigma_mps);
    const float velocity_mps[3] = {plot->vx_mps, plot->vy_mps, plot->vz_mps};
    const int num_velocities = num_velocities_of(seen, &measurement);
    for (int axis = 0; axis < num_velocities && status == RHO_OK; axis++) {
        status = rho_kalman_update(kalman, 3 + axis, velocity_mps[axis],
                                   plot->sigma_mps * plot->sigma_mps, 0);
    }
    if (status == RHO_OK && (seen->measures & RHO_MEASURES_RANGE_RATE)) {
        status =
            rho_kalman_update_range_rate(kalman, seen->sensor, plot->range_rate_mps,
                                         plot->sigma_range_rate_mps * plot->sigma_range_rate_mps);
    }
    return status;
}

static enum rho_status update_kalman(struct rho_track *track, const struct rho_track_plot *seen,
                                     const struct rho_track_model *model)
{
    struct rho_kalman kalman = track->kalman;
    enum rho_status status = rho_kalman_predict(
        &kalman, rho_seconds_between(track->time_us, seen->time_us), model->noise_density);
    if (status == RHO_OK) {
        status = update_state_by_plot(&kalman, seen, model);
    }
    if (status == RHO_OK) {
        track->kalman = kalman;
    }
    return status;
}

/* Copies the estimate of the input estimation filter, and its inputs, to the track. */
static void copy_input_estimate(struct rho_track *track)
{
    rho_input_estimate(&track->input, &track->kalman);
    for (int axis = 0; axis < 3; axis++) {
        int is_present = (track->input.present >> axis & 1u) != 0;
        track->accel_mps2[axis] = is_present ? track->input.input_mps2[axis] : 0.0f;
    }
    track->maneuver_probability = track->input.present ? 1.0f : 0.0f;
}

static enum rho_status update_input(struct rho_track *track, const struct rho_track_plot *seen,
                                    const struct rho_track_model *model)
{
    const struct rho_plot *plot = &seen->plot;
    const float velocity_mps[3] = {plot->vx_mps, plot->vy_mps, plot->vz_mps};
    struct rho_measurement measurement;
    struct rho_input input = track->input;
    enum rho_status status =
        rho_input_predict(&input, model->input, rho_seconds_between(track->time_us, seen->time_us));
    if (status == RHO_OK) {
        rho_measurement_from_plot(plot, seen->measures, seen->sensor, &measurement);
        status = rho_input_update_position(&input, model->input, &measurement);
    }
    for (int axis = 0; status == RHO_OK && axis < num_velocities_of(seen, &measurement); axis++) {
        status = rho_input_update_element(&input, model->input, 3 + axis, velocity_mps[axis],
                                          plot->sigma_mps * plot->sigma_mps);
    }
    if (status == RHO_OK && (seen->measures & RHO_MEASURES_RANGE_RATE)) {
        status =
            rho_input_update_range_rate(&input, model->input, seen->sensor, plot->range_rate_mps,
                                        plot->sigma_range_rate_mps * plot->sigma_range_rate_mps);
    }
    if (status == RHO_OK) {
        rho_input_decide(&input, model->input);
        track->input = input;
        track->is_undecided = 0;
        copy_input_estimate(track);
    }
    return status;
}

void rho_track_merge_estimates(struct rho_track *track, int64_t time_us,
                               const struct rho_track_model *model)
{
    struct rho_hypotheses_estimate estimate;
    /* a bearing measures nothing along its line of sight: inputs need those of several sensors */
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_INPUT) && track->is_undecided && model->input) {
        rho_input_decide(&track->input, model->input);
        copy_input_estimate(track);
        track->is_undecided = 0;
    }
    if (!RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES) ||
        rho_hypotheses_estimate(model->hypotheses, track->slot, time_us, &estimate) != RHO_OK) {
        return;
    }
    track->kalman = estimate.kalman;
    track->time_us = time_us;
    for (int axis = 0; axis < 3; axis++) {
        track->accel_mps2[axis] = estimate.accel_mps2[axis];
    }
    track->maneuver_probability = estimate.maneuver_probability;
}

void rho_track_estimate_for_gate(const struct rho_track *track, struct rho_kalman *expected)
{
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_INPUT)) {
        rho_input_gate_estimate(&track->input, expected);
    } else {
        *expected = track->kalman;
    }
}

float rho_track_noise_density(const struct rho_track *track, const struct rho_track_model *model)
{
    return RHO_TRACK_IS_BY(track, RHO_TRACK_INPUT) ? model->input->noise_density
                                                   : model->noise_density;
}

static enum rho_status update_filter(struct rho_track *track, const struct rho_track_plot *seen,
                                     const struct rho_track_model *model)
{
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_INPUT)) {
        return update_input(track, seen, model);
    }
    if (!RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        return update_kalman(track, seen, model);
    }
    enum rho_status status = rho_hypotheses_predict(model->hypotheses, track->slot, seen->time_us);
    if (status == RHO_OK) {
        struct rho_imm_plot plot;
        rho_imm_prepare_plot(&plot, &seen->plot, seen->measures, seen->sensor);
        status = rho_hypotheses_update(model->hypotheses, track->slot, &plot, seen->time_us);
    }
    return status;
}

/* Starts the filter that the model asks for from the track's Kalman estimate. */
static enum rho_status start_filter(struct rho_track *track, const struct rho_track_model *model)
{
    const enum rho_track_filter filter = model->hypotheses ? RHO_TRACK_HYPOTHESES
                                         : model->input    ? RHO_TRACK_INPUT
                                                           : RHO_TRACK_KALMAN;
    if (!RHO_HAS_FILTER(filter)) {
        return RHO_ERROR_CONFIG;
    }
    track->filter = (uint8_t)filter;
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        return rho_hypotheses_open(model->hypotheses, &track->kalman, track->time_us, &track->slot);
    }
    return RHO_TRACK_IS_BY(track, RHO_TRACK_INPUT)
               ? rho_input_start(&track->input, model->input, &track->kalman)
               : RHO_OK;
}

/* Stores the velocity after a hit; a later plot of the same step replaces the newest velocity. */
static void store_velocity_after_hit(struct rho_track *track, int is_first_of_step)
{
    if (is_first_of_step && track->num_velocities < UINT8_MAX) {
        track->num_velocities++;
    }
    for (int axis = 0; axis < 3 && RHO_HAS_FILTER(RHO_TRACK_INPUT); axis++) {
        if (is_first_of_step) {
            track->before_mps[axis] = track->newest_mps[axis];
        }
        track->newest_mps[axis] = track->kalman.state[3 + axis];
    }
}

/* With a configured initial variance, input estimation begins at the estimate of all plots. */
static enum rho_status restart_input(struct rho_track *track, const struct rho_track_model *model)
{
    if (!RHO_TRACK_IS_BY(track, RHO_TRACK_INPUT) || !(model->input->initial_variance > 0.0f)) {
        return RHO_OK;
    }
    rho_kalman_set_equal_variances(&track->kalman, model->input->initial_variance);
    return rho_input_start(&track->input, model->input, &track->kalman);
}

/* Clears all bytes, padding too, so that the same plots give the same bytes; sets id and score. */
static void init_track(struct rho_track *track, uint32_t track_id, int32_t score_mnat)
{
    memset(track, 0, sizeof *track);
    track->track_id = track_id;
    track->status = RHO_TRACK_FREE;
    track->score_mnat = score_mnat;
    track->score_max_mnat = score_mnat;
}

void rho_track_keep_plot(struct rho_track *track, const struct rho_plot *plot)
{
    track->plot_m[0] = plot->x_m;
    track->plot_m[1] = plot->y_m;
    track->plot_sigma_m = rho_plot_sigma_m(plot);
    track->has_new_plot = 1;
}

enum rho_status rho_track_start(struct rho_track *track, uint32_t track_id,
                                const struct rho_track_plot *plots, unsigned num_plots,
                                const struct rho_track_model *model, int32_t score_mnat)
{
    if (!track || !plots || !model || num_plots < 1) {
        return track && plots && model ? RHO_ERROR_VALUE : RHO_ERROR_NULL;
    }
    const struct rho_track_plot *last = &plots[num_plots - 1];
    struct rho_track start;
    init_track(&start, track_id, score_mnat);
    start.hits = (uint16_t)num_plots;
    start.plot = last->row;
    start.sensor_id = last->sensor_id;
    start.time_us = plots[0].time_us;
    start.updated_us = last->time_us;
    rho_track_keep_plot(&start, &last->plot);
    rho_kalman_init(&start.kalman);
    enum rho_status status = update_state_by_plot(&start.kalman, &plots[0], model);
    if (status == RHO_OK) {
        status = start_filter(&start, model);
    }
    if (status != RHO_OK) {
        return status;
    }
    store_velocity_after_hit(&start, 1);
    for (unsigned i = 1; i < num_plots && status == RHO_OK; i++) {
        status = update_filter(&start, &plots[i], model);
        start.time_us = plots[i].time_us;
        store_velocity_after_hit(&start, 1);
    }
    rho_track_merge_estimates(&start, start.time_us, model);
    if (status == RHO_OK) {
        status = restart_input(&start, model);
    }
    if (status != RHO_OK) {
        rho_track_free_hypotheses(&start, model);
        return status;
    }
    for (unsigned i = 0; RHO_SECTORS && i + 1 < num_plots; i++) {
        start.is_shared |= (uint8_t)(plots[i].sensor_id != last->sensor_id);
    }
    rho_track_apply_event(&start, RHO_TRACK_START);
    *track = start;
    return RHO_OK;
}

enum rho_status rho_track_start_estimate(struct rho_track *track, uint32_t track_id,
                                         const struct rho_kalman *estimate, int64_t time_us,
                                         int32_t sensor_id, uint16_t hits,
                                         const struct rho_track_model *model, int32_t score_mnat)
{
    if (!track || !estimate || !model) {
        return RHO_ERROR_NULL;
    }
    if (hits < 1 || !rho_kalman_has_axis(estimate, 0) || !rho_kalman_has_axis(estimate, 1)) {
        return RHO_ERROR_VALUE;
    }
    struct rho_track start;
    init_track(&start, track_id, score_mnat);
    start.hits = hits;
    start.plot = -1;
    start.sensor_id = sensor_id;
    start.time_us = time_us;
    start.updated_us = time_us;
    start.kalman = *estimate;
    enum rho_status status = start_filter(&start, model);
    if (status == RHO_OK) {
        status = restart_input(&start, model);
    }
    if (status != RHO_OK) {
        return status;
    }
    rho_track_merge_estimates(&start, time_us, model);
    store_velocity_after_hit(&start, 1);
    rho_track_apply_event(&start, RHO_TRACK_START);
    *track = start;
    return RHO_OK;
}

static void loosen(float *covariance, float velocity_m2ps2)
{
    covariance[RHO_AT(RHO_VX, RHO_VX)] += velocity_m2ps2;
    covariance[RHO_AT(RHO_VY, RHO_VY)] += velocity_m2ps2;
}

void rho_track_loosen(struct rho_track *track, const struct rho_track_model *model,
                      float velocity_m2ps2)
{
    loosen(track->kalman.covariance, velocity_m2ps2);
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_INPUT)) {
        loosen(track->input.bare.covariance, velocity_m2ps2);
    } else if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        rho_hypotheses_loosen(model->hypotheses, track->slot, velocity_m2ps2);
    }
}

void rho_track_free_hypotheses(struct rho_track *track, const struct rho_track_model *model)
{
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        rho_hypotheses_close(model->hypotheses, track->slot);
        track->slot = RHO_HYPOTHESES_SLOTS; /* none: the freed slot may go to another track */
    }
}

enum rho_status rho_track_predict(struct rho_track *track, int64_t time_us,
                                  const struct rho_track_model *model)
{
    enum rho_status status;
    if (!track || !model) {
        return RHO_ERROR_NULL;
    }
    const float dt_s = rho_seconds_between(track->time_us, time_us);
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_INPUT)) {
        status = rho_input_predict(&track->input, model->input, dt_s);
        copy_input_estimate(track);
    } else if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        status = rho_hypotheses_predict(model->hypotheses, track->slot, time_us);
        if (status == RHO_OK) {
            /* a rough merged estimate until rho_track_merge_estimates at the end of the step */
            status = rho_kalman_predict(&track->kalman, dt_s, 0.0f);
        }
    } else {
        status = rho_kalman_predict(&track->kalman, dt_s, model->noise_density);
    }
    track->time_us = status == RHO_OK ? time_us : track->time_us;
    return status;
}

enum rho_status rho_track_return(struct rho_track *track, int64_t time_us,
                                 const struct rho_track_model *model)
{
    enum rho_status status = RHO_OK;
    if (!track || !model) {
        return RHO_ERROR_NULL;
    }
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_INPUT)) {
        return rho_track_predict(track, time_us, model); /* input estimation has noise per scan */
    }
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        status = rho_hypotheses_move(model->hypotheses, track->slot, time_us);
    }
    if (status == RHO_OK) {
        const float dt_s = rho_seconds_between(track->time_us, time_us);
        status = rho_kalman_predict(&track->kalman, dt_s, 0.0f);
    }
    track->time_us = status == RHO_OK ? time_us : track->time_us;
    return status;
}

/* The later one of a plot's time and the last update's: a plot may be out of sequence. */
static int64_t later_update_time_us(const struct rho_track *track, int64_t time_us)
{
    return RHO_SECTORS && time_us < track->updated_us ? track->updated_us : time_us;
}

static void store_claimed_plot(struct rho_track *track, int64_t time_us, int32_t sensor_id,
                               int16_t row)
{
    track->is_shared |= (uint8_t)(RHO_SECTORS && track->sensor_id != sensor_id);
    track->updated_us = time_us;
    track->sensor_id = sensor_id;
    track->plot = row;
}

enum rho_status rho_track_update_by_plot(struct rho_track *track, const struct rho_track_plot *plot,
                                         const struct rho_track_model *model, int32_t gain_mnat)
{
    if (!track || !plot || !model) {
        return RHO_ERROR_NULL;
    }
    enum rho_status status = update_filter(track, plot, model);
    if (status != RHO_OK) {
        return status;
    }
    track->time_us = plot->time_us;
    if (!RHO_SECTORS || plot->time_us >= track->updated_us) {
        store_velocity_after_hit(track, 1); /* an older plot leaves both velocities */
    }
    store_claimed_plot(track, later_update_time_us(track, plot->time_us), plot->sensor_id,
                       plot->row);
    count_hit(track);
    rho_track_add_score(track, gain_mnat);
    rho_track_apply_event(track, RHO_TRACK_UPDATE);
    return RHO_OK;
}

enum rho_status rho_track_commit_scan(struct rho_track *track,
                                      const struct rho_hypotheses_scan *scan, int32_t sensor_id,
                                      const struct rho_track_model *model)
{
    struct rho_hypotheses_outcome outcome;
    if (!track || !scan || !model || !RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        return track && scan && model ? RHO_ERROR_STATE : RHO_ERROR_NULL;
    }
    enum rho_status status = rho_hypotheses_commit(model->hypotheses, track->slot, scan, &outcome);
    if (status != RHO_OK) {
        return status;
    }
    track->plot = -1;
    rho_track_add_score(track, rho_score_to_mnat(outcome.gain_nat));
    if (outcome.row >= 0) {
        store_claimed_plot(
            track, later_update_time_us(track, scan->time_us + scan->plots[outcome.row].offset_us),
            sensor_id, outcome.row);
        count_hit(track);
        rho_track_apply_event(track, RHO_TRACK_UPDATE);
    }
    return RHO_OK;
}

/* As rho_bearing_expect, by an estimate at from_us, at the bearing's own time. */
static int expect_bearing(struct rho_kalman estimate, int64_t from_us, float noise_density,
                          const struct rho_weighed_bearings *look, unsigned i,
                          struct rho_expected_bearing *expected)
{
    const int64_t time_us = look->scan->time_us + look->scan->bearings[i].offset_us;
    return rho_kalman_predict(&estimate, rho_seconds_between(from_us, time_us), noise_density) ==
               RHO_OK &&
           rho_bearing_expect(&estimate, look, i, expected);
}

int rho_track_score_bearing(const struct rho_track *track, const struct rho_track_model *model,
                            const struct rho_weighed_bearings *look, unsigned i, float *density,
                            float *variance_rad2)
{
    struct rho_expected_bearing expected;
    struct rho_kalman at;
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        return rho_hypotheses_score_bearing(model->hypotheses, track->slot, look, i, density,
                                            variance_rad2);
    }
    rho_track_estimate_for_gate(track, &at);
    if (!expect_bearing(at, track->time_us, rho_track_noise_density(track, model), look, i,
                        &expected)) {
        return 0;
    }
    *density = expected.density;
    *variance_rad2 = expected.variance_rad2;
    return expected.nis <= RHO_GATE_CHI2_1D;
}

static enum rho_status update_by_bearings(struct rho_track *track,
                                          const struct rho_weighed_bearings *look, int64_t time_us,
                                          const struct rho_track_model *model)
{
    const struct rho_bearing_scan *scan = look->scan;
    const float dt_s = rho_seconds_between(track->time_us, time_us);
    const float noise_density = rho_track_noise_density(track, model);
    struct rho_bearing_mix mix = {.hit = 0.0f};
    struct rho_kalman at;
    enum rho_status status;
    float off_rad, sigma_rad;
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        status = rho_hypotheses_update_bearings(model->hypotheses, track->slot, time_us, look);
        /* merged at once, for the next sensor's bearings */
        rho_track_merge_estimates(track, time_us, model);
        return status;
    }
    rho_track_estimate_for_gate(track, &at);
    for (unsigned i = 0; i < RHO_MAX_BEARINGS; i++) {
        struct rho_expected_bearing expected;
        if (look->weight[i] > 0.0f &&
            expect_bearing(at, track->time_us, noise_density, look, i, &expected)) {
            rho_bearing_mix_add(&mix, look, i, &expected);
        }
    }
    if (!rho_is_finite(mix.hit)) {
        return RHO_ERROR_VALUE;
    }
    status = rho_kalman_predict(&at, dt_s, noise_density);
    if (status != RHO_OK || !rho_bearing_mix_as_one(&mix, look->miss, &off_rad, &sigma_rad)) {
        return status;
    }
    const float bearing_rad = rho_angle_wrap(
        rho_atan2(at.state[RHO_Y] - scan->y_m, at.state[RHO_X] - scan->x_m) + off_rad);
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_INPUT)) {
        struct rho_input input = track->input;
        status = rho_input_predict(&input, model->input, dt_s);
        if (status == RHO_OK) {
            status = rho_input_update_bearing(&input, model->input, scan->x_m, scan->y_m,
                                              bearing_rad, sigma_rad);
        }
        if (status == RHO_OK) {
            status = rho_input_update_slope(&input, model->input, &look->slope);
        }
        if (status == RHO_OK) {
            track->input = input;
            track->is_undecided = 1;
            copy_input_estimate(track);
        }
    } else {
        struct rho_kalman kalman = track->kalman;
        status = rho_kalman_predict(&kalman, dt_s, model->noise_density);
        if (status == RHO_OK) {
            status =
                rho_kalman_update_bearing(&kalman, scan->x_m, scan->y_m, bearing_rad, sigma_rad);
        }
        if (status == RHO_OK) {
            status =
                rho_kalman_update_slope(&kalman, &look->slope, rho_square(model->speed_sigma_mps));
        }
        if (status == RHO_OK) {
            track->kalman = kalman;
        }
    }
    track->time_us = status == RHO_OK ? time_us : track->time_us;
    return status;
}

enum rho_status rho_track_update_bearings(struct rho_track *track,
                                          const struct rho_weighed_bearings *look, int16_t row,
                                          int is_claimed, const struct rho_track_model *model,
                                          int32_t gain_mnat)
{
    if (!track || !look || !model) {
        return RHO_ERROR_NULL;
    }
    const int64_t time_us = look->scan->time_us + look->scan->bearings[row].offset_us;
    enum rho_status status = update_by_bearings(track, look, time_us, model);
    if (status != RHO_OK) {
        return status;
    }
    rho_track_add_score(track, gain_mnat);
    if (is_claimed) {
        store_velocity_after_hit(track, track->plot < 0);
        if (track->plot < 0) {
            count_hit(track);
        }
        store_claimed_plot(track, time_us, look->scan->sensor_id, row);
        rho_track_apply_event(track, RHO_TRACK_UPDATE);
    }
    return RHO_OK;
}
