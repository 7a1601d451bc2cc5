/* SPDX-License-Identifier: MIT */
#include "rhotrack/track.h"

#include "rhotrack/approx.h"
#include "track_parts.h"

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
    /* one row a status, one column an event: start, confirm, update, miss, doubt, drop */
    static const uint8_t next[RHO_NUM_TRACK_STATUS][RHO_NUM_TRACK_EVENTS] = {
        [RHO_TRACK_FREE] = {RHO_TRACK_TENTATIVE, RHO_TRACK_FREE, RHO_TRACK_FREE, RHO_TRACK_FREE,
                            RHO_TRACK_FREE, RHO_TRACK_FREE},
        /* neither plots nor misses are belief: only the score's threshold makes it, or ends it */
        [RHO_TRACK_TENTATIVE] = {RHO_TRACK_TENTATIVE, RHO_TRACK_CONFIRMED, RHO_TRACK_TENTATIVE,
                                 RHO_TRACK_TENTATIVE, RHO_TRACK_TENTATIVE, RHO_TRACK_FREE},
        [RHO_TRACK_CONFIRMED] = {RHO_TRACK_CONFIRMED, RHO_TRACK_CONFIRMED, RHO_TRACK_CONFIRMED,
                                 RHO_TRACK_COASTING, RHO_TRACK_TENTATIVE, RHO_TRACK_FREE},
        /* once believed, a plot is enough to go on */
        [RHO_TRACK_COASTING] = {RHO_TRACK_COASTING, RHO_TRACK_COASTING, RHO_TRACK_CONFIRMED,
                                RHO_TRACK_COASTING, RHO_TRACK_TENTATIVE, RHO_TRACK_FREE},
    };
    if ((unsigned)status >= RHO_NUM_TRACK_STATUS || (unsigned)event >= RHO_NUM_TRACK_EVENTS) {
        return status;
    }
    return (enum rho_track_status)next[status][event];
}

void rho_track_apply(struct rho_track *track, enum rho_track_event event)
{
    track->status = (uint8_t)rho_track_next_status((enum rho_track_status)track->status, event);
}

/* ---- evidence --------------------------------------------------------------------------------- */

void rho_track_add_score(struct rho_track *track, int32_t mnat)
{
    int64_t score = (int64_t)track->score_mnat + mnat;
    score = score > SCORE_LIMIT_MNAT ? SCORE_LIMIT_MNAT : score;
    score = score < -SCORE_LIMIT_MNAT ? -SCORE_LIMIT_MNAT : score;
    track->score_mnat = (int32_t)score;
    if (track->score_mnat > track->score_max_mnat) {
        track->score_max_mnat = track->score_mnat;
    }
}

void rho_track_count_hit(struct rho_track *track)
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
    rho_track_add_score(track, -loss_mnat);
    rho_track_apply(track, RHO_TRACK_MISS);
}

void rho_track_lose(struct rho_track *track, int32_t loss_mnat)
{
    rho_track_add_score(track, -loss_mnat);
}

/* How far the evidence has fallen since it was best. */
static int32_t fall_of(const struct rho_track *track)
{
    return track->score_max_mnat - track->score_mnat;
}

static int has_ended(const struct rho_track *track, const struct rho_track_limits *limits)
{
    if (track->misses_in_row >= limits->misses_in_row_max) {
        return 1;
    }
    return track->is_believed ? fall_of(track) >= limits->fall_mnat
                              : track->score_mnat < limits->tentative_mnat;
}

enum rho_track_status rho_track_judge(struct rho_track *track,
                                      const struct rho_track_limits *limits)
{
    enum rho_track_event event = RHO_TRACK_DOUBT; /* of what was never believed, too */
    if (fall_of(track) < limits->doubt_mnat &&
        (track->is_believed || track->score_mnat >= limits->confirm_mnat)) {
        event = RHO_TRACK_CONFIRM;
        track->is_believed = 1;
    }
    rho_track_apply(track, has_ended(track, limits) ? RHO_TRACK_DROP : event);
    return (enum rho_track_status)track->status;
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
