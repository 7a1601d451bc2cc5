/* SPDX-License-Identifier: MIT */
/* bearing_looks: the look of a scan of bearings: opened, claimed, and tracks updated by it. */
#include <string.h>

#include "phases.h"
#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"

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

/* Returns the row of the sensor; NULL: there is no room for it. */
static struct rho_tracker_sensor *open_look(struct rho_tracker *tracker,
                                            const struct rho_passive *passive,
                                            struct rho_look *look, struct rho_sensor *sensor)
{
    const struct rho_bearing_scan *scan = look->bearings;
    struct rho_tracker_sensor *row = rho_sensors_hear(tracker, scan->sensor_id);
    *sensor = sensor_of_scan(tracker, passive, scan);
    if (row) {
        rho_pace_update(&row->pace, sensor, look->time_us, scan->sector_from_rad,
                        scan->sector_to_rad);
    }
    look->sensor = sensor;
    /* false bearings: the mean number of unclaimed ones, over the sector or field of view */
    const float unclaimed = row ? row->unclaimed_bearings : 0.0f;
    float view_rad = scan->sector_to_rad - scan->sector_from_rad;
    view_rad = view_rad < 0.0f ? view_rad + RHO_TWO_PI : view_rad;
    if (!(view_rad > 0.0f)) {
        view_rad = passive ? passive->config.field_of_view_rad : RHO_TWO_PI;
    }
    look->log_false_bearings = rho_log((unclaimed > 1.0f ? unclaimed : 1.0f) / view_rad);
    memset(look->fates, RHO_FATE_NO_ROOM, look->num_gated);
    look->num_gated = look->num_gated < RHO_MAX_BEARINGS ? look->num_gated : RHO_MAX_BEARINGS;
    rho_pd_open(look, row);
    rho_bearing_errors_open(look, row);
    return row;
}

static void validate_bearings(struct rho_tracker *tracker, const struct rho_look *look)
{
    for (uint32_t i = 0; i < look->num_gated; i++) {
        const struct rho_bearing *bearing = &look->bearings->bearings[i];
        int is_valid = rho_bearing_is_valid(bearing) && bearing->offset_us <= RHO_LIMIT_OFFSET_US &&
                       bearing->offset_us >= -RHO_LIMIT_OFFSET_US;
        if (is_valid && !rho_coverage_holds_bearing(look->sensor, bearing->bearing_rad,
                                                    BEARING_SIGMAS * bearing->sigma_rad)) {
            is_valid = 0;
            tracker->counters.plots_outside = rho_count(tracker->counters.plots_outside, 1);
        }
        look->fates[i] = (uint8_t)(is_valid ? RHO_FATE_HELD : RHO_FATE_INVALID);
    }
}

/* ln of a bearing's density where a track expects it, and its variance. */
struct scored_bearing {
    float log_density, variance_rad2;
};

/* *gain_nat: ln of pd times the bearing's density, over that of false ones. 0: outside the gate. */
static int score_bearing(const struct rho_look *look, const struct rho_track *track,
                         const struct rho_weighed_bearings *weighed, float log_pd, uint32_t i,
                         struct scored_bearing *at, float *gain_nat)
{
    float density;
    if (look->fates[i] == RHO_FATE_INVALID ||
        !rho_track_score_bearing(track, &look->model, weighed, i, &density, &at->variance_rad2)) {
        return 0;
    }
    at->log_density = rho_log(density);
    *gain_nat = log_pd + at->log_density - look->log_false_bearings;
    return 1;
}

static struct rho_weighed_bearings unweighed_bearings(const struct rho_look *look)
{
    return (struct rho_weighed_bearings){.scan = look->bearings,
                                         .miss = 1.0f,
                                         .lasting_rad2 = look->lasting_rad2,
                                         .lasting_in_estimate_rad2 =
                                             look->lasting_looks * look->lasting_rad2};
}

static void offer_bearings(struct rho_tracker *tracker, const struct rho_look *look, unsigned row)
{
    const struct rho_track *track = &tracker->tracks[row];
    const struct detection seen = rho_look_detection(look, track);
    const struct rho_weighed_bearings unweighed = unweighed_bearings(look);
    struct scored_bearing at;
    float gain_nat;
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (score_bearing(look, track, &unweighed, seen.log_pd, i, &at, &gain_nat) &&
            gain_nat > seen.log_miss) {
            rho_score_add_pair(tracker, row, i, gain_nat - seen.log_miss);
        }
    }
}

/* The bearings in a track's gate, weighed by their probabilities. */
struct gated_bearings {
    struct rho_weighed_bearings weighed;
    int16_t row;       /* the one of most weight; -1: none is in the gate */
    int is_claimed;    /* it is more probable than all else */
    float hit;         /* probability that one of them is the track's */
    float seeing;      /* share of targets that no other track's bearing covers */
    float gain_nat;    /* ln of the likelihood of what no other track explains, or a miss */
    float density_nat; /* ln of the density of the one of most weight */
};

/* The two largest probabilities that a bearing is a track's, and the row of the first. */
struct bearing_claims {
    struct bearing_claim {
        float most, next;
        unsigned row;
    } of[RHO_MAX_BEARINGS];
};

static void list_claims(const struct rho_tracker *tracker, struct bearing_claims *claims)
{
    const struct rho_assignment *assignment = &tracker->assignment;
    memset(claims, 0, sizeof *claims);
    for (unsigned row = 0; row < assignment->num_rows; row++) {
        float weight[RHO_MAX_GATE_PLOTS], sum = 1.0f;
        for (unsigned k = 0; k < assignment->num_pairs[row]; k++) {
            weight[k] = rho_exp(
                rho_smaller(-0.001f * (float)assignment->pairs[row][k].cost, RHO_LOOK_LIMIT_NAT));
            sum += weight[k];
        }
        for (unsigned k = 0; k < assignment->num_pairs[row]; k++) {
            struct bearing_claim *claim = &claims->of[assignment->pairs[row][k].column];
            const float share = tracker->tracks[row].visible * weight[k] / sum;
            claim->next = rho_larger(claim->next, rho_smaller(share, claim->most));
            claim->row = share > claim->most ? row : claim->row;
            claim->most = rho_larger(claim->most, share);
        }
    }
}

/*
 * Weighs the bearings in a track's gate ("Bearings are weighed" in src/DESIGN.md, with these
 * letters). A bearing of more than half of W is claimed. Where another track's bearing lies, a
 * target may be behind it, and its miss says nothing; nor does a hit by what another track explains
 * as well, though the estimate of the track that it was assigned takes it whole: else a ghost that
 * takes the bearings of a track beside it would live by them.
 */
static struct gated_bearings weigh_bearings(const struct rho_tracker *tracker,
                                            const struct rho_look *look,
                                            const struct bearing_claims *claims, unsigned row)
{
    const struct rho_bearing_scan *scan = look->bearings;
    const struct rho_track *track = &tracker->tracks[row];
    const struct detection seen = rho_look_detection(look, track);
    struct gated_bearings found = {.weighed = unweighed_bearings(look), .row = -1};
    const float missed =
        rho_coverage_holds_track(look, scan->sector_from_rad, scan->sector_to_rad, track)
            ? rho_exp(seen.log_miss)
            : 1.0f;
    const float pd_over_false = rho_exp(seen.log_pd - look->log_false_bearings);
    float covered = 0.0f, hit = 0.0f, told = 0.0f, best = 0.0f;
    for (uint32_t i = 0; i < look->num_gated; i++) {
        struct scored_bearing at;
        float gain_nat;
        if (!score_bearing(look, track, &found.weighed, seen.log_pd, i, &at, &gain_nat)) {
            continue;
        }
        const struct bearing_claim *claim = &claims->of[i]; /* another track's: `rival` */
        const float rival = claim->row == row ? claim->next : claim->most;
        const float left = tracker->assignment.column_row[i] == (int)row ? 1.0f : 1.0f - rival;
        const float gain = rho_exp(rho_smaller(gain_nat, RHO_LOOK_LIMIT_NAT));
        const float weight = left * gain;
        /* how near it is: its density over that of a bearing at the centre */
        const float log_centre = -0.5f * (RHO_LOG_TWO_PI + rho_log(at.variance_rad2));
        const float nearness = rho_exp(rho_smaller(at.log_density - log_centre, 0.0f));
        covered = rho_larger(covered, rival * nearness);
        found.weighed.weight[i] = left * pd_over_false;
        hit += weight;
        told += (1.0f - rival) * gain;
        if (weight > best) {
            best = weight;
            found.density_nat = at.log_density;
            found.row = (int16_t)i;
        }
    }
    found.weighed.miss = missed + covered * (1.0f - missed);
    const float sum = found.weighed.miss + hit;
    found.seeing = 1.0f - covered;
    found.hit = hit / sum;
    found.gain_nat = rho_log(found.weighed.miss + told);
    found.is_claimed = best > 0.5f * sum;
    if (found.is_claimed) {
        found.weighed.slope = rho_measurement_slope(scan, &scan->bearings[found.row]);
    }
    return found;
}

/*
 * Counts the bearings of tracks that the look covers, before it changes any: a sensor that sees
 * less than it states must not take it out on the tracks, nor keep them from being confirmed.
 */
static void learn_pd(const struct rho_tracker *tracker, struct rho_look *look,
                     const struct bearing_claims *claims, struct rho_tracker_sensor *row)
{
    const struct rho_bearing_scan *scan = look->bearings;
    for (unsigned i = 0; row && !rho_look_is_full(look) && i < tracker->num_tracks; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        if (track->status != RHO_TRACK_FREE && rho_look_has_in_view(look, i) &&
            rho_coverage_holds_track(look, scan->sector_from_rad, scan->sector_to_rad, track)) {
            const struct gated_bearings found = weigh_bearings(tracker, look, claims, i);
            rho_pd_count(row, track->visible * found.seeing, found.hit);
        }
    }
    rho_pd_open(look, row);
}

static void update_by_bearings(struct rho_tracker *tracker, const struct rho_look *look,
                               const struct bearing_claims *claims, struct rho_tracker_sensor *own,
                               struct rho_batch_owner *owners)
{
    float unclaimed = 0.0f;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (track->status == RHO_TRACK_FREE || !rho_look_has_in_view(look, row)) {
            continue;
        }
        const struct gated_bearings found = weigh_bearings(tracker, look, claims, row);
        const int32_t gain_mnat = rho_score_to_mnat(found.gain_nat);
        unclaimed -= found.hit;
        if (found.is_claimed && own) {
            rho_bearing_errors_compare(look, &own->bearing_errors, track,
                                       &look->bearings->bearings[found.row]);
        }
        if (found.row < 0) {
            rho_track_add_score(track, gain_mnat);
        } else if (rho_track_update_bearings(track, &found.weighed, found.row, found.is_claimed,
                                             &look->model, gain_mnat) != RHO_OK) {
            tracker->counters.updates_refused = rho_count(tracker->counters.updates_refused, 1);
        } else if (found.is_claimed && (owners[found.row].track_id == 0 ||
                                        tracker->assignment.column_row[found.row] == (int)row)) {
            look->fates[found.row] = RHO_FATE_CLAIMED;
            owners[found.row] = (struct rho_batch_owner){track->track_id, found.density_nat};
        }
    }
    for (uint32_t i = 0; i < look->num_gated; i++) {
        unclaimed += look->fates[i] != RHO_FATE_INVALID ? 1.0f : 0.0f;
    }
    if (own) {
        rho_clutter_smooth_mean(&own->unclaimed_bearings, rho_larger(unclaimed, 0.0f));
    }
}

/* Scores are left alone: the update has lowered them. */
static void count_misses(struct rho_tracker *tracker, const struct rho_look *look)
{
    const struct rho_bearing_scan *scan = look->bearings;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (track->status != RHO_TRACK_FREE && track->plot < 0 && rho_look_has_in_view(look, row) &&
            rho_coverage_holds_track(look, scan->sector_from_rad, scan->sector_to_rad, track)) {
            rho_track_count_miss(track, 0);
        }
    }
}

void rho_step_take_bearings(struct step *step, struct rho_sensor *sensor,
                            struct rho_batch_owner *owners)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_look *look = &step->look;
    rho_life_pass(tracker, look);
    struct rho_tracker_sensor *own = open_look(tracker, step->passive, look, sensor);
    struct bearing_claims claims;
    validate_bearings(tracker, look);
    /* both counts are within the capacities: nothing to refuse */
    (void)!rho_assignment_begin(&tracker->assignment, tracker->num_tracks, look->num_gated);
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        if (tracker->tracks[row].status != RHO_TRACK_FREE && rho_look_has_in_view(look, row)) {
            offer_bearings(tracker, look, row);
        }
    }
    rho_score_solve(tracker);
    list_claims(tracker, &claims);
    learn_pd(tracker, look, &claims, own);
    update_by_bearings(tracker, look, &claims, own, owners);
    count_misses(tracker, look);
}
