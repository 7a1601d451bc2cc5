/* SPDX-License-Identifier: MIT */
/* bearing_looks: one sensor's bearings of a frame as a look: opened, claimed and updated. */
#include <string.h>

#include "batch_frame.h"
#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"

void rho_step_open_frame(struct rho_look *look)
{
    rho_pd_open(look, 0); /* default pd: no sensor's look is open yet */
    memset(look->fates, RHO_FATE_NO_ROOM, look->num_gated);
}

/* A sensor's description, at the position that its scan of bearings states. */
static struct rho_sensor sensor_of_scan(const struct rho_tracker *tracker,
                                        const struct rho_passive *passive,
                                        const struct rho_bearing_scan *scan)
{
    const struct rho_sensor *known = rho_sensors_find(tracker, scan->sensor_id);
    struct rho_sensor sensor = {.sensor_id = scan->sensor_id,
                                .pd = tracker->config.pd,
                                .range_max_m = 2.0f * RHO_LIMIT_POSITION_M};
    if (known) {
        sensor = *known;
    } else if (passive) {
        sensor.range_max_m = passive->config.range_max_m;
    }
    sensor.x_m = scan->x_m;
    sensor.y_m = scan->y_m;
    return sensor;
}

static int does_frame_cover(const struct step *step, const struct rho_track *track)
{
    for (uint32_t i = 0; i < step->frame->num_scans; i++) {
        const struct rho_bearing_scan *scan = &step->frame->scans[i];
        const struct rho_sensor sensor = sensor_of_scan(step->tracker, step->passive, scan);
        if (rho_measurement_covers(&sensor, scan->sector_from_rad, scan->sector_to_rad,
                                   track->kalman.state[0], track->kalman.state[1])) {
            return 1;
        }
    }
    return 0;
}

/* Returns the row of the sensor; NULL: there is no room for it. */
static struct rho_tracker_sensor *
open_look(struct rho_tracker *tracker, const struct rho_passive *passive, struct rho_look *look,
          const struct rho_bearing_scan *scan, uint32_t first, struct rho_sensor *sensor)
{
    struct rho_tracker_sensor *row = rho_sensors_hear(tracker, scan->sensor_id);
    *sensor = sensor_of_scan(tracker, passive, scan);
    if (row) {
        rho_pace_update(&row->pace, sensor, look->time_us, scan->sector_from_rad,
                        scan->sector_to_rad);
    }
    look->bearings = scan;
    look->sensor = sensor;
    /* false bearings: the mean number of unclaimed ones, over the sector or field of view */
    const float unclaimed = row ? row->unclaimed_bearings : 0.0f;
    float view_rad = scan->sector_to_rad - scan->sector_from_rad;
    view_rad = view_rad < 0.0f ? view_rad + RHO_TWO_PI : view_rad;
    if (!(view_rad > 0.0f)) {
        view_rad = passive ? passive->config.field_of_view_rad : RHO_TWO_PI;
    }
    look->log_false_bearings = rho_log((unclaimed > 1.0f ? unclaimed : 1.0f) / view_rad);
    look->num_gated = num_bearings_with_fates(look, scan, first);
    look->fates += first < RHO_MAX_PLOTS ? first : 0;
    rho_pd_open(look, row);
    rho_bearing_errors_open(look, row);
    return row;
}

static void validate_bearings(struct rho_tracker *tracker, const struct rho_look *look)
{
    for (uint32_t i = 0; i < look->num_gated; i++) {
        const struct rho_bearing *bearing = &look->bearings->bearings[i];
        int is_valid = is_usable_bearing(bearing);
        if (is_valid && !rho_coverage_holds_bearing(look->sensor, bearing->bearing_rad,
                                                    BEARING_SIGMAS * bearing->sigma_rad)) {
            is_valid = 0;
            tracker->counters.plots_outside = rho_count(tracker->counters.plots_outside, 1);
        }
        look->fates[i] = (uint8_t)(is_valid ? RHO_FATE_HELD : RHO_FATE_INVALID);
    }
}

static struct rho_bearing gated_bearing(const struct rho_look *look, uint32_t i)
{
    struct rho_bearing bearing = look->bearings->bearings[i];
    bearing.sigma_rad = rho_sqrt(bearing.sigma_rad * bearing.sigma_rad + look->lasting_rad2);
    return bearing;
}

/*
 * ln of a bearing's density where its track is expected. Slopes of false bearings are taken to have
 * the density 1: they are as likely anywhere within a slope of one.
 */
static float density_nat(const struct rho_gate_result *at)
{
    return at->slope_nat - 0.5f * (RHO_LOG_TWO_PI + at->log_det + at->distance2);
}

/* *gain_nat: ln of pd times the bearing's density, over that of false ones. 0: outside the gate. */
static int score_bearing(const struct rho_look *look, const struct rho_gate *gate,
                         const struct rho_track *track, float log_pd, uint32_t i,
                         struct rho_gate_result *at, float *gain_nat)
{
    const struct rho_bearing_scan *scan = look->bearings;
    struct rho_bearing bearing = gated_bearing(look, i);
    /* the update by an earlier look of the frame may have moved the track from the frame's time */
    bearing.offset_us = (int32_t)(scan->time_us + bearing.offset_us - track->time_us);
    if (look->fates[i] != RHO_FATE_HELD || !rho_gate_test_bearing(gate, scan, &bearing, at)) {
        return 0;
    }
    *gain_nat = log_pd + density_nat(at) - look->log_false_bearings;
    return 1;
}

static void offer_bearings(struct rho_tracker *tracker, const struct rho_look *look, unsigned row)
{
    const struct rho_track *track = &tracker->tracks[row];
    const struct detection seen = rho_look_detection(look, track);
    struct rho_gate_result at;
    struct rho_gate gate;
    float gain_nat;
    rho_score_open_gate(look, track, 0, &gate);
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (score_bearing(look, &gate, track, seen.log_pd, i, &at, &gain_nat) &&
            gain_nat > seen.log_miss) {
            rho_score_add_pair(tracker, row, i, gain_nat - seen.log_miss);
        }
    }
}

/* The bearings in a track's gate, weighed by their probabilities. */
struct bearing_mix {
    struct rho_track_bearing as_one; /* the one bearing that changes the estimate as they all do */
    float hit;                       /* probability that one of them is the track's */
    float seeing;                    /* share of targets that no other track's bearing covers */
    float gain_nat;    /* ln of the likelihood of them all, or a miss, over that of clutter */
    float share;       /* information of the mix, over that of a certain bearing */
    float density_nat; /* ln of the density of the one of most weight */
};

/* Probability that a bearing is not the target's of the track that it was assigned. */
static float free_share(const struct rho_tracker *tracker, unsigned row, uint32_t i)
{
    const struct rho_assignment *assignment = &tracker->assignment;
    const int owner = assignment->column_row[i];
    float own = 0.0f, sum = 1.0f;
    if (owner < 0 || owner == (int)row) {
        return 1.0f;
    }
    for (unsigned k = 0; k < assignment->num_pairs[owner]; k++) {
        const struct rho_assignment_pair *pair = &assignment->pairs[owner][k];
        const float weight = rho_exp(rho_smaller(-0.001f * (float)pair->cost, RHO_LOOK_LIMIT_NAT));
        sum += weight;
        own = pair->column == (int)i ? weight : own;
    }
    return 1.0f - tracker->tracks[owner].visible * own / sum;
}

/* Bearing from the scan's sensor to where the track is expected at that time. */
static float expected_bearing_rad(const struct rho_bearing_scan *scan,
                                  const struct rho_track *track, int64_t time_us)
{
    const float *state = track->kalman.state;
    const float dt_s = rho_seconds_between(track->time_us, time_us);
    return rho_atan2(state[1] + state[4] * dt_s - scan->y_m,
                     state[0] + state[3] * dt_s - scan->x_m);
}

/*
 * Mixes the bearings in a track's gate, as probabilistic data association does ("Bearings are
 * weighed" in src/DESIGN.md, with these letters). A bearing of more than half of W is claimed.
 * Where another track's bearing lies, a target may be behind it, and its miss says nothing.
 */
static struct bearing_mix mix_bearings(const struct rho_tracker *tracker,
                                       const struct rho_look *look, unsigned row)
{
    const struct rho_bearing_scan *scan = look->bearings;
    const struct rho_track *track = &tracker->tracks[row];
    const struct detection seen = rho_look_detection(look, track);
    struct bearing_mix mix = {.as_one = {.time_us = track->time_us,
                                         .sensor_id = scan->sensor_id,
                                         .x_m = scan->x_m,
                                         .y_m = scan->y_m,
                                         .row = -1}};
    float sum = rho_coverage_holds_track(look, scan->sector_from_rad, scan->sector_to_rad, track)
                    ? rho_exp(seen.log_miss)
                    : 1.0f;
    const float lasting_rad2 = look->lasting_looks * look->lasting_rad2;
    float covered = 0.0f, hit = 0.0f, mean = 0.0f, square = 0.0f, noise = 0.0f, total = 0.0f,
          best = 0.0f;
    struct rho_gate gate;
    rho_score_open_gate(look, track, 0, &gate);
    for (uint32_t i = 0; i < look->num_gated; i++) {
        const struct rho_bearing *bearing = &scan->bearings[i];
        struct rho_gate_result at;
        float gain_nat;
        if (!score_bearing(look, &gate, track, seen.log_pd, i, &at, &gain_nat)) {
            continue;
        }
        const float left = free_share(tracker, row, i);
        covered = rho_larger(covered, (1.0f - left) * rho_exp(-0.5f * at.distance2));
        const float weight = left * rho_exp(rho_smaller(gain_nat, RHO_LOOK_LIMIT_NAT));
        const int64_t time_us = scan->time_us + bearing->offset_us;
        const float off_rad =
            rho_angle_wrap(bearing->bearing_rad - expected_bearing_rad(scan, track, time_us));
        hit += weight;
        mean += weight * off_rad;
        square += weight * off_rad * off_rad;
        noise += weight * (bearing->sigma_rad * bearing->sigma_rad + lasting_rad2);
        total += weight * rho_exp(at.log_det);
        if (weight > best) {
            best = weight;
            mix.density_nat = density_nat(&at);
            mix.as_one.row = (int16_t)i;
            mix.as_one.time_us = time_us;
        }
    }
    sum += covered * (1.0f - sum) + hit;
    mix.seeing = 1.0f - covered;
    mix.hit = hit / sum;
    mix.gain_nat = rho_log(sum);
    mix.as_one.row = (int16_t)(best > 0.5f * sum ? mix.as_one.row : -1);
    if (mix.as_one.row >= 0) {
        mix.as_one.slope = rho_measurement_slope(scan, &scan->bearings[mix.as_one.row]);
    }
    if (hit > 0.0f) {
        const float variance = total / hit;
        mean /= sum;
        mix.share = hit / sum - (square / sum - mean * mean) / variance;
        const float share = rho_larger(mix.share, MIX_SHARE_MIN);
        mix.as_one.bearing_rad =
            rho_angle_wrap(expected_bearing_rad(scan, track, mix.as_one.time_us) + mean / share);
        mix.as_one.sigma_rad = rho_sqrt(variance / share - (variance - noise / hit));
    }
    return mix;
}

/*
 * Counts the bearings of tracks that the look covers, before it changes any: a sensor that sees
 * less than it states must not take it out on the tracks, nor keep them from being confirmed.
 */
static void learn_pd(const struct rho_tracker *tracker, struct rho_look *look,
                     struct rho_tracker_sensor *row)
{
    const struct rho_bearing_scan *scan = look->bearings;
    for (unsigned i = 0; row && !rho_look_is_full(look) && i < tracker->num_tracks; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        if (track->status != RHO_TRACK_FREE && rho_look_has_in_view(look, i) &&
            rho_coverage_holds_track(look, scan->sector_from_rad, scan->sector_to_rad, track)) {
            const struct bearing_mix mix = mix_bearings(tracker, look, i);
            rho_pd_count(row, track->visible * mix.seeing, mix.hit);
        }
    }
    rho_pd_open(look, row);
}

/* A look that tells next to nothing of a track leaves its estimate alone; its score counts all. */
static void update_by_bearings(struct rho_tracker *tracker, const struct rho_look *look,
                               struct rho_tracker_sensor *own, struct rho_batch_owner *owners)
{
    float unclaimed = 0.0f;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (track->status == RHO_TRACK_FREE || !rho_look_has_in_view(look, row)) {
            continue;
        }
        const struct bearing_mix mix = mix_bearings(tracker, look, row);
        const int32_t gain_mnat = rho_score_to_mnat(mix.gain_nat);
        unclaimed -= mix.hit;
        if (mix.as_one.row >= 0 && own) {
            rho_bearing_errors_compare(look, &own->bearing_errors, track,
                                       &look->bearings->bearings[mix.as_one.row]);
        }
        if (!(mix.share > MIX_SHARE_MIN)) {
            rho_track_add_score(track, gain_mnat);
        } else if (rho_track_update_bearing(track, &mix.as_one, &look->model, gain_mnat) !=
                   RHO_OK) {
            tracker->counters.updates_refused = rho_count(tracker->counters.updates_refused, 1);
        } else if (mix.as_one.row >= 0) {
            look->fates[mix.as_one.row] = RHO_FATE_CLAIMED;
            if (owners) {
                owners[mix.as_one.row] = (struct rho_batch_owner){track->track_id, mix.density_nat};
            }
        }
    }
    for (uint32_t i = 0; i < look->num_gated; i++) {
        unclaimed += look->fates[i] != RHO_FATE_INVALID ? 1.0f : 0.0f;
    }
    if (own) {
        rho_clutter_smooth_mean(&own->unclaimed_bearings, rho_larger(unclaimed, 0.0f));
    }
    rho_life_weigh(tracker, look);
}

/*
 * Claims and updates look by look: each sensor meets the gates that those before it left.
 * *owners: gets the tracks of the bearings, where it has room for them.
 */
void rho_step_take_frame(struct step *step, struct frame_owners *owners)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_look *look = &step->look;
    const uint32_t num_gated = look->num_gated;
    uint8_t *fates = look->fates;
    struct rho_sensor sensor;
    uint32_t first = 0;
    rho_life_pass(tracker, look);
    for (uint32_t i = 0; i < step->frame->num_scans; i++) {
        const struct rho_bearing_scan *scan = &step->frame->scans[i];
        struct rho_tracker_sensor *own =
            open_look(tracker, step->passive, look, scan, first, &sensor);
        validate_bearings(tracker, look);
        /* both counts are within the capacities: nothing to refuse */
        (void)!rho_assignment_begin(&tracker->assignment, tracker->num_tracks, look->num_gated);
        for (unsigned row = 0; row < tracker->num_tracks; row++) {
            if (tracker->tracks[row].status != RHO_TRACK_FREE && rho_look_has_in_view(look, row)) {
                offer_bearings(tracker, look, row);
            }
        }
        rho_score_solve(tracker);
        learn_pd(tracker, look, own);
        update_by_bearings(tracker, look, own, i < RHO_MAX_PASSIVE_SENSORS ? owners->of[i] : 0);
        first = rho_count(first, scan->num_bearings);
        look->num_gated = num_gated;
        look->fates = fates;
    }
    /* the look is again the whole frame, of no sensor */
    look->bearings = 0;
    look->sensor = 0;
    rho_pd_open(look, 0);
    /*
     * A frame without a bearing of a track is one miss, however many sensors looked. The score is
     * left alone: the update has lowered it for each sensor.
     */
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (track->status != RHO_TRACK_FREE && !rho_track_is_frozen(track) && track->plot < 0 &&
            does_frame_cover(step, track)) {
            rho_track_count_miss(track, 0);
        }
    }
}
