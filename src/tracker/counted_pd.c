/* SPDX-License-Identifier: MIT */
/*
 * counted_pd: the P_D of a sensor by its looks at confirmed tracks, and by octant of azimuth.
 *
 * The stated P_D counts as a few looks beside them, so that a sensor that sees less than it states,
 * or does so in a sector, takes it out on itself and not on the tracks.
 */
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "sensors.h"
#include "sight.h"

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
    float pd = look->sensor ? look->sensor->pd : look->tracker->config.pd;
    const float least = look->tracker->config.learn_pd_min * pd;
    if (row && look->tracker->config.learn_pd_min < 1.0f) {
        pd = (row->hits + STATED_LOOKS * pd) / (row->looks + STATED_LOOKS);
        pd = rho_larger(rho_smaller(pd, PD_MOST), least);
    }
    look->log_pd = rho_log(pd);
    look->log_miss = rho_log(1.0f - pd);
}

/* Octant of a track's azimuth from the look's sensor, counter-clockwise from +x. */
static unsigned octant_of(const struct rho_look *look, const struct rho_track *track)
{
    const float dx_m = track->kalman.state[0] - (look->sensor ? look->sensor->x_m : 0.0f);
    const float dy_m = track->kalman.state[1] - (look->sensor ? look->sensor->y_m : 0.0f);
    const unsigned steep = rho_magnitude(dy_m) > rho_magnitude(dx_m);
    const unsigned quarter = dy_m >= 0.0f ? (dx_m >= 0.0f ? 0u : 1u) : dx_m < 0.0f ? 2u : 3u;
    return 2u * quarter + (quarter % 2u == 0u ? steep : 1u - steep);
}

struct detection rho_pd_detection(const struct rho_look *look, const struct rho_track *track,
                                  struct detection elsewhere)
{
    if (!look->row || !(look->tracker->config.learn_pd_min < 1.0f)) {
        return elsewhere;
    }
    const unsigned octant = octant_of(look, track);
    const float ratio = (rho_larger(look->row->octant_hits[octant], 0.0f) + OCTANT_HITS) /
                        (rho_larger(look->row->octant_expected[octant], 0.0f) + OCTANT_HITS);
    if (ratio > 1.0f - OCTANT_SAME && ratio < 1.0f + OCTANT_SAME) {
        return elsewhere;
    }
    const float pd = rho_smaller(ratio * rho_exp(elsewhere.log_pd), PD_MOST);
    return (struct detection){rho_log(pd), rho_log(1.0f - pd)};
}

void rho_pd_count_place(const struct rho_look *look, const struct rho_track *track, float visible,
                        float ratio)
{
    if (track->blind_percent > BLIND_PERCENT_MAX) {
        return;
    }
    const struct detection ring =
        rho_learning_detection(look, track, (struct detection){look->log_pd, look->log_miss});
    const float pd = rho_exp(rho_pd_detection(look, track, ring).log_pd);
    const float hit = rho_larger(1.0f - (1.0f - track->seen_share * pd) / ratio, 0.0f);
    const unsigned octant = octant_of(look, track);
    add_counts(&look->row->octant_expected[octant], &look->row->octant_hits[octant],
               COUNTED_LOOKS_MAX / 4.0f, visible * rho_exp(ring.log_pd), visible * hit);
    rho_pd_count(look->row, visible, hit);
}
