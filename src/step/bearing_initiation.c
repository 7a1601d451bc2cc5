/* SPDX-License-Identifier: MIT */
/*
 * bearing_initiation: the bearings of a look go into the batch of passive initiation, ghosts among
 * them are marked, and its best set of tracks is started, in place of tracks that it beats.
 */
#include "phases.h"
#include "policy.h"
#include "rhotrack/detail/bearing_crossing.h"

/*
 * 1 where a bearing has crossings with those of the newest looks of other sensors, and none can be
 * a target.
 */
static int is_ghost_bearing(const struct step *step, float bearing_rad)
{
    const struct rho_bearing_scan *scan = step->look.bearings;
    const struct rho_batch *batch = &step->passive->batch;
    struct rho_crossing_base base;
    struct rho_crossing crossing;
    int has_crossings = 0;
    for (unsigned s = 0; s < batch->num_sensors; s++) {
        unsigned k = batch->num_scans; /* one look ago at most: an older one tells nothing */
        while (k > 0 && k + 1u >= batch->num_scans && !batch->was_seen[k - 1u][s]) {
            k--;
        }
        const struct rho_batch_look *other = &batch->looks[k > 0 ? k - 1u : 0][s];
        if (k == 0 || k + 1u < batch->num_scans || batch->sensors[s].sensor_id == scan->sensor_id ||
            rho_crossing_set_base(&base, scan->x_m, scan->y_m, other->x_m, other->y_m) != RHO_OK) {
            continue;
        }
        for (unsigned j = 0; j < batch->num_bearings[k - 1u][s]; j++) {
            has_crossings = 1;
            if (rho_crossing_find(&base, bearing_rad, batch->bearings[k - 1u][s][j].bearing_rad,
                                  step->passive->config.range_max_m,
                                  &crossing) == RHO_CROSSING_MEETS) {
                return 0;
            }
        }
    }
    return has_crossings;
}

/* Tracks with bearings in the batch, with the number of these. */
struct owners_list {
    unsigned num, num_challenged;
    struct rho_passive_known known[2 * RHO_MAX_PASSIVE_TRACKS];
    uint16_t bearings[2 * RHO_MAX_PASSIVE_TRACKS];
};

/* What a plot or a person vouches for is safe. */
static void add_owner(const struct step *step, struct owners_list *list, uint32_t *track_id)
{
    for (unsigned i = 0; i < list->num; i++) {
        if (list->known[i].track_id == *track_id) {
            list->bearings[i]++;
            return;
        }
    }
    const unsigned row = rho_tracker_find_row(step->tracker, *track_id);
    *track_id = row < RHO_MAX_TRACKS ? *track_id : 0; /* of a track that has ended: nobody's */
    if (row < RHO_MAX_TRACKS && list->num < 2 * RHO_MAX_PASSIVE_TRACKS) {
        const struct rho_track *track = &step->tracker->tracks[row];
        const float *state = track->kalman.state;
        const float dt_s = rho_seconds_between(track->time_us, step->look.time_us);
        struct rho_passive_known *known = &list->known[list->num];
        list->bearings[list->num++] = 1;
        *known =
            (struct rho_passive_known){.track_id = *track_id,
                                       .x_m = state[0] + dt_s * state[3],
                                       .y_m = state[1] + dt_s * state[4],
                                       .z_m = state[2] + dt_s * state[5],
                                       .vx_mps = state[3],
                                       .vy_mps = state[4],
                                       .vz_mps = state[5],
                                       .is_level = !rho_kalman_has_axis(&track->kalman, RHO_Z)};
        known->is_safe =
            track->plot_sigma_m > 0.0f || track->is_operators || rho_track_is_frozen(track);
        list->num_challenged += !known->is_safe;
    }
}

static void list_owners(const struct step *step, struct owners_list *list)
{
    struct rho_batch *batch = &step->passive->batch;
    list->num = list->num_challenged = 0;
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            for (unsigned i = 0; i < batch->num_bearings[k][s]; i++) {
                add_owner(step, list, &batch->bearings[k][s][i].owner.track_id);
            }
        }
    }
    for (; list->num_challenged > CHALLENGED_MAX; list->num_challenged--) {
        unsigned most = list->num;
        for (unsigned i = 0; i < list->num; i++) {
            if (!list->known[i].is_safe &&
                (most == list->num || list->bearings[i] > list->bearings[most])) {
                most = i;
            }
        }
        list->known[most].is_safe = 1; /* beyond the room, those of most bearings are safe */
    }
}

/* Takes from a track begun anew the bearings that it had. */
static void release_bearings(struct rho_batch *batch, uint32_t track_id)
{
    struct rho_batch_bearing *bearings = &batch->bearings[0][0][0];
    for (unsigned i = 0; i < sizeof batch->bearings / sizeof *bearings; i++) {
        if (bearings[i].owner.track_id == track_id) {
            bearings[i].owner.track_id = 0;
        }
    }
}

/* Number of a found track's bearings that another track took. */
static unsigned count_shared(const struct rho_batch *batch, const struct rho_passive_track *found,
                             uint32_t track_id)
{
    unsigned shared = 0;
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            const unsigned place = found->claim[k][s];
            shared += place > 0 && batch->bearings[k][s][place - 1u].owner.track_id == track_id;
        }
    }
    return shared;
}

/*
 * Ends the beaten tracks whose bearings a found one takes. Returns the identity of the one that it
 * shares most with, for the found one to go on under; 0: none.
 */
static uint32_t end_beaten_tracks(struct step *step, struct owners_list *list,
                                  const struct rho_passive_track *found)
{
    uint32_t heir_id = 0;
    unsigned most = 0;
    for (unsigned i = 0; i < list->num; i++) {
        struct rho_passive_known *known = &list->known[i];
        known->is_beaten &= rho_tracker_find_row(step->tracker, known->track_id) < RHO_MAX_TRACKS;
        const unsigned shared =
            known->is_beaten ? count_shared(&step->passive->batch, found, known->track_id) : 0;
        const uint32_t gone_id = shared > most ? heir_id : known->track_id;
        if (shared > 0 && gone_id != 0) {
            rho_step_end_track(step, rho_tracker_find_row(step->tracker, gone_id));
        }
        heir_id = shared > most ? known->track_id : heir_id;
        most = shared > most ? shared : most;
        known->is_beaten &= shared == 0;
    }
    return heir_id;
}

/* Starts a track, or begins the one of this identity anew. */
static int admit_found_track(struct step *step, uint32_t heir_id, const struct rho_kalman *estimate,
                             int32_t sensor_id, const struct rho_passive_track *found)
{
    struct rho_tracker *tracker = step->tracker;
    const unsigned row = rho_tracker_find_row(tracker, heir_id);
    /* on the scale of starts from plots, by which the life of tracks goes */
    const int32_t start_mnat = step->passive->start_mnat > tracker->start_mnat
                                   ? step->passive->start_mnat
                                   : tracker->start_mnat;
    const int32_t score_mnat = found->score_mnat - step->passive->start_mnat + start_mnat;
    const uint32_t track_id = heir_id != 0 ? heir_id : tracker->next_track_id;
    struct rho_track track;
    if (row < RHO_MAX_TRACKS) {
        rho_track_free_hypotheses(&tracker->tracks[row], &step->look.model);
    }
    if (rho_track_start_estimate(&track, track_id, estimate, step->look.time_us, sensor_id,
                                 found->hits < RHO_ESTABLISHED_HITS ? found->hits
                                                                    : RHO_ESTABLISHED_HITS - 1u,
                                 &step->look.model, score_mnat) != RHO_OK) {
        if (row < RHO_MAX_TRACKS) {
            rho_step_end_track(step, row);
        }
        return 0;
    }
    if (row == RHO_MAX_TRACKS) {
        return rho_step_admit(step, &track, start_mnat);
    }
    rho_step_restart(step, row, &track, start_mnat);
    return 1;
}

static void start_found_track(struct step *step, struct owners_list *list,
                              const struct rho_passive_track *found)
{
    static const uint8_t place[6] = {0, 1, 3, 4, 2, 5}; /* in a state of three axes */
    struct rho_tracker *tracker = step->tracker;
    const struct rho_batch *batch = &step->passive->batch;
    const float state[6] = {found->x_m,    found->y_m, found->vx_mps,
                            found->vy_mps, found->z_m, found->vz_mps};
    struct rho_kalman estimate;
    rho_kalman_init(&estimate);
    for (int i = 0; i < (found->is_level ? 4 : 6); i++) {
        estimate.state[place[i]] = state[i];
        for (int j = 0; j <= i; j++) {
            estimate.covariance[RHO_AT(place[i], place[j])] = found->covariance[RHO_AT(i, j)];
        }
    }
    /* the track is of a sensor with a bearing in its newest scan */
    int32_t sensor_id = batch->sensors[0].sensor_id;
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            sensor_id = found->claim[k][s] ? batch->sensors[s].sensor_id : sensor_id;
        }
    }
    const uint32_t heir_id = end_beaten_tracks(step, list, found);
    const uint32_t track_id = heir_id != 0 ? heir_id : tracker->next_track_id;
    if (admit_found_track(step, heir_id, &estimate, sensor_id, found)) {
        if (heir_id != 0) {
            release_bearings(&step->passive->batch, heir_id);
        }
        const uint32_t given = rho_passive_give(step->passive, found, track_id);
        tracker->counters.plots_initiated = rho_count(tracker->counters.plots_initiated, given);
    }
}

/* Ghosts stay in the batch: the other sensors may have missed the target of such a bearing. */
static void mark_ghosts(const struct step *step)
{
    const struct rho_look *look = &step->look;
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (look->fates[i] == RHO_FATE_HELD &&
            is_ghost_bearing(step, look->bearings->bearings[i].bearing_rad)) {
            look->fates[i] = RHO_FATE_GHOST;
        }
    }
}

/* Searches once a row, with all that is followed challenged. */
void rho_step_initiate_bearings(struct step *step, const struct rho_batch_owner *owners)
{
    struct rho_tracker_counters *counters = &step->tracker->counters;
    struct rho_passive *passive = step->passive;
    struct owners_list list;
    if (!RHO_SEARCHES || !passive) {
        rho_step_replace_fates(&step->look, RHO_FATE_HELD, RHO_FATE_NO_ROOM);
        return;
    }
    struct rho_bearing_scan held = *step->look.bearings; /* those with fates */
    held.num_bearings = step->look.num_gated;
    const struct rho_frame frame = {.time_us = held.time_us, .scans = &held, .num_scans = 1};
    /* cannot fail: rho_tracker_step_bearings has asked whether the batch accepts the look */
    (void)!rho_batch_push(&passive->batch, &frame, step->look.fates, owners);
    mark_ghosts(step);
    counters->plots_clutter = rho_count(counters->plots_clutter, passive->batch.num_left);
    passive->num_tracks = 0;
    if (!passive->batch.is_due) {
        return;
    }
    list_owners(step, &list);
    (void)!rho_passive_challenge(passive, list.known, list.num);
    const uint32_t dropped =
        rho_count(passive->work.candidates_dropped, passive->work.points_dropped);
    counters->candidates_dropped = rho_count(counters->candidates_dropped, dropped);
    for (unsigned i = 0; i < passive->num_tracks; i++) {
        const struct rho_passive_track *found = &passive->tracks[i];
        /* margins miss the rivals among crossings left out, which two sensors cannot tell apart */
        const int has_rivals =
            passive->work.points_dropped > 0 && rho_passive_sensor_pairs(found) < 3u;
        /* without a bearing of the last two scans, a started track may claim the newer ones */
        const int is_recent = (unsigned)found->scans >> (passive->batch.num_scans - 2u) != 0;
        if (is_recent && !has_rivals && found->score_mnat >= passive->start_mnat &&
            found->margin_mnat >= MARGIN_MIN_MNAT) {
            start_found_track(step, &list, found);
        }
    }
}
