/* SPDX-License-Identifier: MIT */
#include "rhotrack/track.h"

#include "rhotrack/approx.h"

#define SCORE_LIMIT_MNAT 1000000000

/* ---- life cycle ------------------------------------------------------------------------------- */

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
    /* one row a status, one column an event: start, confirm, update, miss, drop */
    static const uint8_t next[RHO_NUM_TRACK_STATUS][RHO_NUM_TRACK_EVENTS] = {
        [RHO_TRACK_FREE] = {RHO_TRACK_TENTATIVE, RHO_TRACK_FREE, RHO_TRACK_FREE, RHO_TRACK_FREE,
                            RHO_TRACK_FREE},
        /* neither plots nor misses are belief: only the score's threshold makes it, or ends it */
        [RHO_TRACK_TENTATIVE] = {RHO_TRACK_TENTATIVE, RHO_TRACK_CONFIRMED, RHO_TRACK_TENTATIVE,
                                 RHO_TRACK_TENTATIVE, RHO_TRACK_FREE},
        [RHO_TRACK_CONFIRMED] = {RHO_TRACK_CONFIRMED, RHO_TRACK_CONFIRMED, RHO_TRACK_CONFIRMED,
                                 RHO_TRACK_COASTING, RHO_TRACK_FREE},
        /* once believed, a plot is enough to go on */
        [RHO_TRACK_COASTING] = {RHO_TRACK_COASTING, RHO_TRACK_COASTING, RHO_TRACK_CONFIRMED,
                                RHO_TRACK_COASTING, RHO_TRACK_FREE},
    };
    if ((unsigned)status >= RHO_NUM_TRACK_STATUS || (unsigned)event >= RHO_NUM_TRACK_EVENTS) {
        return status;
    }
    return (enum rho_track_status)next[status][event];
}

static void apply(struct rho_track *track, enum rho_track_event event)
{
    track->status = (uint8_t)rho_track_next_status((enum rho_track_status)track->status, event);
}

/* ---- evidence --------------------------------------------------------------------------------- */

static void add_score(struct rho_track *track, int32_t mnat)
{
    int64_t score = (int64_t)track->score_mnat + mnat;
    score = score > SCORE_LIMIT_MNAT ? SCORE_LIMIT_MNAT : score;
    score = score < -SCORE_LIMIT_MNAT ? -SCORE_LIMIT_MNAT : score;
    track->score_mnat = (int32_t)score;
    if (track->score_mnat > track->score_max_mnat) {
        track->score_max_mnat = track->score_mnat;
    }
}

static void count_hit(struct rho_track *track)
{
    track->hits = (uint16_t)(track->hits < UINT16_MAX ? track->hits + 1 : UINT16_MAX);
    track->misses_in_row = 0;
}

void rho_track_miss(struct rho_track *track, int32_t loss_mnat)
{
    track->misses = (uint16_t)(track->misses < UINT16_MAX ? track->misses + 1 : UINT16_MAX);
    track->misses_in_row =
        (uint8_t)(track->misses_in_row < UINT8_MAX ? track->misses_in_row + 1 : UINT8_MAX);
    track->plot = -1;
    add_score(track, -loss_mnat);
    apply(track, RHO_TRACK_MISS);
}

void rho_track_lose(struct rho_track *track, int32_t loss_mnat)
{
    add_score(track, -loss_mnat);
}

static int has_ended(const struct rho_track *track, const struct rho_track_limits *limits)
{
    if (track->misses_in_row >= limits->misses_in_row_max) {
        return 1;
    }
    if (track->status == RHO_TRACK_TENTATIVE) {
        return track->score_mnat < limits->tentative_mnat;
    }
    return track->score_max_mnat - track->score_mnat >= limits->fall_mnat;
}

enum rho_track_status rho_track_judge(struct rho_track *track,
                                      const struct rho_track_limits *limits)
{
    if (track->status == RHO_TRACK_TENTATIVE && track->score_mnat >= limits->confirm_mnat) {
        apply(track, RHO_TRACK_CONFIRM);
    }
    if (has_ended(track, limits)) {
        apply(track, RHO_TRACK_DROP);
    }
    return (enum rho_track_status)track->status;
}

/* ---- estimate --------------------------------------------------------------------------------- */

static enum rho_status measure_velocity(struct rho_kalman *kalman, const struct rho_plot *plot,
                                        int has_z)
{
    float variance = plot->sigma_mps * plot->sigma_mps;
    enum rho_status status = rho_kalman_update(kalman, 3, plot->vx_mps, variance, 0);
    if (status == RHO_OK) {
        status = rho_kalman_update(kalman, 4, plot->vy_mps, variance, 0);
    }
    if (status == RHO_OK && has_z) {
        status = rho_kalman_update(kalman, 5, plot->vz_mps, variance, 0);
    }
    return status;
}

/* All that a plot measures, at its own time; the range rate last, for it is linearised where the position was found. */
static enum rho_status measure(struct rho_kalman *kalman, const struct rho_track_plot *seen,
                               const struct rho_track_model *model)
{
    const struct rho_plot *plot = &seen->plot;
    struct rho_measurement measurement;
    rho_measurement_open(plot, seen->measures, seen->sensor, &measurement);
    enum rho_status status = rho_kalman_update_position(
        kalman, &measurement, model->speed_sigma_mps * model->speed_sigma_mps);
    if (status == RHO_OK && (seen->measures & RHO_MEASURES_VELOCITY)) {
        status = measure_velocity(kalman, plot, measurement.has_z);
    }
    if (status == RHO_OK && (seen->measures & RHO_MEASURES_RANGE_RATE)) {
        status =
            rho_kalman_update_range_rate(kalman, seen->sensor, plot->range_rate_mps,
                                         plot->sigma_range_rate_mps * plot->sigma_range_rate_mps);
    }
    return status;
}

static enum rho_status predict_and_measure(struct rho_kalman *kalman, int64_t at_us,
                                           const struct rho_track_plot *seen,
                                           const struct rho_track_model *model)
{
    enum rho_status status =
        rho_kalman_predict(kalman, rho_seconds_between(at_us, seen->time_us), model->noise_density);
    return status == RHO_OK ? measure(kalman, seen, model) : status;
}

enum rho_status rho_track_start(struct rho_track *track, uint32_t track_id,
                                const struct rho_track_plot *plots, unsigned num_plots,
                                const struct rho_track_model *model, int32_t score_mnat)
{
    if (!track || !plots || !model) {
        return RHO_ERROR_NULL;
    }
    if (num_plots < 2) {
        return RHO_ERROR_VALUE;
    }
    const struct rho_track_plot *last = &plots[num_plots - 1];
    struct rho_track start = {
        .track_id = track_id,
        .status = RHO_TRACK_FREE,
        .hits = (uint16_t)num_plots,
        .plot = last->row,
        .sensor_id = last->sensor_id,
        .score_mnat = score_mnat,
        .score_max_mnat = score_mnat,
        .time_us = last->time_us,
        .updated_us = last->time_us,
    };
    rho_kalman_init(&start.kalman);
    enum rho_status status = measure(&start.kalman, &plots[0], model);
    for (unsigned i = 1; i < num_plots && status == RHO_OK; i++) {
        status = predict_and_measure(&start.kalman, plots[i - 1].time_us, &plots[i], model);
    }
    if (status == RHO_OK) {
        apply(&start, RHO_TRACK_START);
        *track = start;
    }
    return status;
}

enum rho_status rho_track_start_estimate(struct rho_track *track, uint32_t track_id,
                                         const struct rho_kalman *estimate, int64_t time_us,
                                         int32_t sensor_id, uint16_t hits, int32_t score_mnat)
{
    if (!track || !estimate) {
        return RHO_ERROR_NULL;
    }
    if (hits < 1 || !rho_kalman_is_open(estimate, 0) || !rho_kalman_is_open(estimate, 1)) {
        return RHO_ERROR_VALUE;
    }
    struct rho_track start = {
        .track_id = track_id,
        .status = RHO_TRACK_FREE,
        .hits = hits,
        .plot = -1,
        .sensor_id = sensor_id,
        .score_mnat = score_mnat,
        .score_max_mnat = score_mnat,
        .time_us = time_us,
        .updated_us = time_us,
        .kalman = *estimate,
    };
    apply(&start, RHO_TRACK_START);
    *track = start;
    return RHO_OK;
}

enum rho_status rho_track_predict(struct rho_track *track, int64_t time_us,
                                  const struct rho_track_model *model)
{
    if (!track || !model) {
        return RHO_ERROR_NULL;
    }
    enum rho_status status = rho_kalman_predict(
        &track->kalman, rho_seconds_between(track->time_us, time_us), model->noise_density);
    if (status == RHO_OK) {
        track->time_us = time_us;
    }
    return status;
}

static void take_sighting(struct rho_track *track, int64_t time_us, int32_t sensor_id, int16_t row)
{
    track->time_us = time_us;
    track->updated_us = time_us;
    track->sensor_id = sensor_id;
    track->plot = row;
}

enum rho_status rho_track_update(struct rho_track *track, const struct rho_track_plot *plot,
                                 const struct rho_track_model *model, int32_t gain_mnat)
{
    if (!track || !plot || !model) {
        return RHO_ERROR_NULL;
    }
    struct rho_kalman kalman = track->kalman;
    enum rho_status status = predict_and_measure(&kalman, track->time_us, plot, model);
    if (status != RHO_OK) {
        return status;
    }
    track->kalman = kalman;
    take_sighting(track, plot->time_us, plot->sensor_id, plot->row);
    count_hit(track);
    add_score(track, gain_mnat);
    apply(track, RHO_TRACK_UPDATE);
    return RHO_OK;
}

enum rho_status rho_track_update_bearing(struct rho_track *track,
                                         const struct rho_track_bearing *bearing,
                                         const struct rho_track_model *model, int32_t gain_mnat)
{
    if (!track || !bearing || !model) {
        return RHO_ERROR_NULL;
    }
    struct rho_kalman kalman = track->kalman;
    float dt_s = rho_seconds_between(track->time_us, bearing->time_us);
    enum rho_status status = rho_kalman_predict(&kalman, dt_s, model->noise_density);
    if (status == RHO_OK) {
        status = rho_kalman_update_bearing(&kalman, bearing->x_m, bearing->y_m,
                                           bearing->bearing_rad, bearing->sigma_rad);
    }
    if (status != RHO_OK) {
        return status;
    }
    if (track->plot < 0) {
        count_hit(track);
    }
    track->kalman = kalman;
    take_sighting(track, bearing->time_us, bearing->sensor_id, bearing->row);
    add_score(track, gain_mnat);
    apply(track, RHO_TRACK_UPDATE);
    return RHO_OK;
}

/* ---- accuracy --------------------------------------------------------------------------------- */

static float root_mean_variance(const struct rho_kalman *kalman, int first)
{
    float sum = 0.0f;
    int axes = 0;
    for (int axis = 0; axis < 3; axis++) {
        if (rho_kalman_is_open(kalman, axis)) {
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
