/* SPDX-License-Identifier: MIT */
/*
 * counted_pd: the P_D of a sensor by its looks at tracks: of all, and by place. Plots count at
 * confirmed tracks, bearings at all tracks, each by the probability that its target is there.
 *
 * The stated P_D counts as one look beside them, so that a sensor that sees less than it states
 * takes it out on itself and not on the tracks. A place is a ring of range and an octant of
 * azimuth. Each has the hits there over those that P_D of all looks expects: P_D at a place is that
 * of all looks, times the ratios of its ring and its octant where they are not 1 by chance. Misses
 * before a track ends are taken back from its place: its target has probably left. A track that may
 * stand, having moved, has a P_D of its own, and teaches no other, as radars leave out what stands;
 * and a miss tells that it stands on.
 */
#include <string.h>

#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "sensors.h"
#include "sight.h"

static int is_pd_learned(const struct rho_look *look)
{
    return look->row && look->tracker->config.learn_pd_min < 1.0f;
}

static float stated_pd(const struct rho_look *look)
{
    return look->sensor ? look->sensor->pd : look->tracker->config.pd;
}

static float limit_pd(const struct rho_tracker *tracker, float stated, float pd)
{
    return rho_larger(rho_smaller(pd, PD_MOST), tracker->config.learn_pd_min * stated);
}

static float pd_of_all(const struct rho_tracker *tracker, const struct rho_tracker_sensor *row,
                       float stated)
{
    return limit_pd(tracker, stated,
                    (row->hits + STATED_LOOKS * stated) / (row->looks + STATED_LOOKS));
}

/* Adds to a pair of counts, which are halved where there are more than `most`. */
static void add_counts(float *of, float *hits, float most, float more, float more_hits)
{
    const float keep = *of > most ? 0.5f : 1.0f;
    *of = keep * *of + more;
    *hits = keep * *hits + more_hits;
}

void rho_pd_count(struct rho_tracker_sensor *row, float visible, float hit)
{
    add_counts(&row->looks, &row->hits, COUNTED_LOOKS_MAX, visible, visible * hit);
}

void rho_pd_open(struct rho_look *look, const struct rho_tracker_sensor *row)
{
    look->pd = stated_pd(look);
    if (row && look->tracker->config.learn_pd_min < 1.0f) {
        look->pd = pd_of_all(look->tracker, row, look->pd);
    }
    if (rho_look_is_full(look)) {
        look->pd *= FULL_SHARE;
    }
    look->log_pd = rho_log(look->pd);
    look->log_miss = rho_log(1.0f - look->pd);
}

float rho_pd_most(const struct rho_look *look)
{
    float most = look->pd;
    for (unsigned i = 0; i < look->tracker->num_rows; i++) {
        const struct rho_tracker_sensor *row = &look->tracker->sensors[i];
        most = rho_larger(most, row->hits / (row->looks + STATED_LOOKS));
    }
    return most;
}

/* Where a track is, seen from the look's sensor. */
struct place {
    struct rho_pd_place *ring, *octant;
};

static struct place place_of(const struct rho_look *look, const struct rho_track *track)
{
    const struct rho_sensor *sensor = look->sensor;
    const float dx_m = track->kalman.state[0] - (sensor ? sensor->x_m : 0.0f);
    const float dy_m = track->kalman.state[1] - (sensor ? sensor->y_m : 0.0f);
    const float far_m = rho_sqrt(dx_m * dx_m + dy_m * dy_m);
    const float most_m = sensor ? sensor->range_max_m : far_m;
    const int ring = rho_cell_at(far_m / most_m * (float)RHO_LEARN_RINGS, RHO_LEARN_RINGS);
    const unsigned octant = (dy_m >= 0.0f ? 1u : 0u) + (dx_m >= 0.0f ? 2u : 0u) +
                            (rho_magnitude(dy_m) > rho_magnitude(dx_m) ? 4u : 0u);
    return (struct place){&look->row->places[ring], &look->row->places[RHO_LEARN_RINGS + octant]};
}

/* True of one that may stand, having moved, to the sensor that saw it last, but for a notch. */
static int is_at_rest(const struct rho_look *look, const struct rho_track *track)
{
    const struct rho_tracker_config *config = &look->tracker->config;
    const float *state = track->kalman.state, *p = track->kalman.covariance;
    const float speed2 = rho_square(state[RHO_VX]) + rho_square(state[RHO_VY]);
    return speed2 < rho_square(REST_SHARE * config->v_max_mps) && track->has_moved &&
           !(config->v_min_mps > 0.0f) && track->sensor_id == look->scan->sensor_id &&
           track->blind_percent <= BLIND_PERCENT_MAX &&
           speed2 < 0.5f * rho_square(REST_SIGMAS) *
                        (p[RHO_AT(RHO_VX, RHO_VX)] + p[RHO_AT(RHO_VY, RHO_VY)]);
}

/* P_D of a visible target at the track's place; of one at rest its own, if that is less. */
static float pd_at(const struct rho_look *look, struct place at, const struct rho_track *track,
                   int rests)
{
    const float own = rests ? 1.0f - track->rest_miss : 1.0f;
    const float ratio =
        rho_larger((1.0f + at.ring->excess) * (1.0f + at.octant->excess), PLACE_LEAST);
    const float there = ratio * look->pd, pd = own < there ? own : there;
    return pd < look->pd || pd > look->pd ? limit_pd(look->tracker, stated_pd(look), pd) : pd;
}

int rho_pd_miss_at_rest(const struct rho_look *look, const struct rho_track *track,
                        struct rho_notch_look *miss)
{
    if (!is_at_rest(look, track) || !is_pd_learned(look)) {
        return 0;
    }
    const float moving = 1.0f - pd_at(look, place_of(look, track), track, 0);
    *miss = (struct rho_notch_look){.pd = 1.0f - moving / rho_larger(track->rest_miss, moving),
                                    .rest_mps = 0.5f * REST_SHARE * look->tracker->config.v_max_mps,
                                    .may_stand = 1};
    return miss->pd > 0.0f;
}

struct detection rho_pd_detection(const struct rho_look *look, const struct rho_track *track)
{
    const float pd = is_pd_learned(look)
                         ? pd_at(look, place_of(look, track), track, is_at_rest(look, track))
                         : look->pd;
    return pd < look->pd || pd > look->pd ? (struct detection){rho_log(pd), rho_log(1.0f - pd)}
                                          : (struct detection){look->log_pd, look->log_miss};
}

/* pd: P_D of all places, by the same looks. */
static void count_at(struct rho_pd_place *place, float looks, float hits, float pd)
{
    add_counts(&place->looks, &place->hits, COUNTED_LOOKS_MAX / 4.0f, looks, hits);
    place->looks = rho_larger(place->looks, place->hits); /* misses were halved, then taken back */
    const float expected = pd * place->looks;
    const float excess =
        (place->hits - expected) / (expected + PLACE_LOOKS * (1.0f - rho_smaller(pd, PD_MOST)));
    place->excess = excess > -PLACE_SAME && excess < PLACE_SAME ? 0.0f : excess;
}

static void count_at_both(const struct rho_look *look, struct place at, float looks, float hits)
{
    const float pd = look->row->looks > 0.0f ? look->row->hits / look->row->looks : 0.0f;
    const float ring = 1.0f + at.ring->excess;
    count_at(at.ring, looks * (1.0f + at.octant->excess), hits, pd);
    count_at(at.octant, looks * ring, hits, pd);
}

static int teaches_place(const struct rho_look *look, const struct rho_track *track)
{
    return track->blind_percent <= BLIND_PERCENT_MAX && is_pd_learned(look);
}

void rho_pd_count_place(const struct rho_look *look, struct rho_track *track, float visible,
                        float ratio)
{
    if (teaches_place(look, track)) {
        const struct place at = place_of(look, track);
        const int rests = is_at_rest(look, track);
        const float pd = pd_at(look, at, track, rests);
        const float hit = rho_larger(1.0f - (1.0f - track->seen_share * pd) / ratio, 0.0f);
        if (rests) {
            track->rest_miss += visible * (1.0f - hit - track->rest_miss) / REST_LOOKS;
        } else {
            rho_pd_count(look->row, visible, hit);
            count_at_both(look, at, visible, visible * hit);
            track->unseen += visible;
        }
        track->unseen *= 1.0f - hit;
    }
}

void rho_pd_take_back(const struct rho_look *look, const struct rho_track *track)
{
    if (teaches_place(look, track)) {
        count_at_both(look, place_of(look, track), -track->unseen, 0.0f);
    }
}

void rho_pd_forget(struct rho_tracker_sensor *row)
{
    row->looks = row->hits = 0.0f;
    memset(row->places, 0, sizeof row->places);
}

float rho_pd_in_ring(const struct rho_tracker *tracker, const struct rho_tracker_sensor *row,
                     unsigned ring)
{
    const float stated = row->sensor.pd;
    const float of_all = pd_of_all(tracker, row, stated);
    const float pd = limit_pd(tracker, stated, of_all * (1.0f + row->places[ring].excess));
    return tracker->config.learn_pd_min < 1.0f && rho_magnitude(pd - stated) >= PLACE_SAME * stated
               ? pd
               : stated;
}

int rho_pd_is_sound(const struct rho_tracker_sensor *row)
{
    int sound = rho_is_within(row->looks, 0.0f, 1e9f) && rho_is_within(row->hits, 0.0f, row->looks);
    for (unsigned i = 0; i < RHO_PD_PLACES; i++) {
        const struct rho_pd_place *at = &row->places[i];
        sound = sound && rho_is_within(at->hits, 0.0f, 1e9f) &&
                rho_is_within(at->looks, 0.0f, 1e9f) && rho_is_within(at->excess, -1.0f, 1e9f);
    }
    return sound;
}
