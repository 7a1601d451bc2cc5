/* SPDX-License-Identifier: MIT */
/*
 * register_tracks: makes tracks of each radar's plots alone: its scans in the order of
 * time, joined to turns.
 */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "registration/register_data.h"

#define TURN_RAD 6.283185307179586
#define SAME_RAD 1e-4 /* azimuths nearer than this count as equal */

static double sector_width_rad(const struct radar_scan *scan)
{
    double width = fmod(scan->to_rad - scan->from_rad, TURN_RAD);

    width = width < 0.0 ? width + TURN_RAD : width;
    return width < SAME_RAD ? TURN_RAD : width;
}

static bool begin_with_same_sector(const struct radar_scan *scan, const struct radar_scan *other)
{
    return fabs(remainder(scan->from_rad - other->from_rad, TURN_RAD)) < SAME_RAD;
}

/*
 * Makes one scan for the tracker of the plots of scans first .. end - 1; rows gives their indices
 * in radar->plots. Plots beyond RHO_MAX_PLOTS are left out.
 */
static struct rho_scan turn_as_scan(const struct radar_data *radar, size_t first, size_t end,
                                    size_t *rows, struct rho_plot *plots)
{
    const struct radar_scan *last = &radar->scans[end - 1];
    struct rho_scan turn = {
        .time_us = last->time_us, .sensor_id = radar->sensor.sensor_id, .plots = plots};

    if (end - first == 1) {
        turn.sector_from_rad = (float)last->from_rad;
        turn.sector_to_rad = (float)last->to_rad;
    }
    for (size_t i = first; i < end; i++) {
        const struct radar_scan *scan = &radar->scans[i];

        for (size_t j = 0; j < scan->count && turn.num_plots < RHO_MAX_PLOTS; j++) {
            const struct radar_plot *plot = &radar->plots[scan->first + j];

            plots[turn.num_plots] = plot->plot;
            plots[turn.num_plots].offset_us = (int32_t)(plot->time_us - turn.time_us);
            rows[turn.num_plots++] = scan->first + j;
        }
    }
    return turn;
}

/*
 * One past the last scan of the turn that begins with scan `first`. A turn ends when its sectors
 * make a full circle, when its first sector begins again, or after half of the largest offset of a
 * plot's time from its scan's.
 */
size_t register_find_scan_after_turn(const struct radar_data *radar, size_t first)
{
    const struct radar_scan *scans = radar->scans;
    double turned_rad = sector_width_rad(&scans[first]);
    size_t end = first + 1;

    while (end < radar->num_scans && turned_rad < TURN_RAD - SAME_RAD &&
           !begin_with_same_sector(&scans[end], &scans[first]) &&
           scans[end].time_us - scans[first].time_us < RHO_LIMIT_OFFSET_US / 2) {
        turned_rad += sector_width_rad(&scans[end++]);
    }
    return end;
}

/* The tracks reported while one radar's scans are stepped, with their track ids. */
struct following {
    struct register_data *data;
    size_t radar;
    size_t num_ids, ids_room;
    struct followed {
        uint32_t track_id;
        bool is_confirmed;
        struct radar_track track;
    } * ids;
};

static struct followed *find_or_add_followed_track(struct following *all, uint32_t track_id)
{
    for (size_t i = all->num_ids; i-- > 0;) { /* from the newest, which are looked up most often */
        if (all->ids[i].track_id == track_id) {
            return &all->ids[i];
        }
    }
    all->ids = must_make_room_for_one(all->ids, all->num_ids, &all->ids_room, sizeof *all->ids);
    all->ids[all->num_ids] =
        (struct followed){.track_id = track_id, .track = {.radar = all->radar}};
    return &all->ids[all->num_ids++];
}

static void record_reported_tracks(struct following *all, const struct rho_report *report,
                                   const size_t *rows)
{
    for (unsigned i = 0; i < report->num_tracks; i++) {
        const struct rho_track_report *from = &report->tracks[i];
        struct followed *followed = find_or_add_followed_track(all, from->track_id);
        struct radar_track *track = &followed->track;
        const bool is_first = track->count == 0;

        followed->is_confirmed |= from->status != RHO_TRACK_TENTATIVE;
        if (from->plot >= 0) {
            track->plots = must_make_room_for_one(track->plots, track->count, &track->capacity,
                                                  sizeof *track->plots);
            track->plots[track->count++] = rows[from->plot];
            track->earlier = is_first ? from->hits - 1u : track->earlier;
        }
    }
}

/* Moves the tracks that were ever confirmed into data, and frees the others. */
static void store_confirmed_tracks(struct following *all)
{
    struct register_data *data = all->data;

    for (size_t i = 0; i < all->num_ids; i++) {
        if (!all->ids[i].is_confirmed) {
            free(all->ids[i].track.plots);
            continue;
        }
        data->tracks = must_make_room_for_one(data->tracks, data->num_tracks, &data->tracks_room,
                                              sizeof *data->tracks);
        data->tracks[data->num_tracks++] = all->ids[i].track;
    }
    free(all->ids);
}

static int by_time(const void *a, const void *b)
{
    const struct radar_scan *one = a, *other = b;

    if (one->time_us != other->time_us) {
        return one->time_us > other->time_us ? 1 : -1;
    }
    return (one->first > other->first) - (one->first < other->first);
}

void register_track_one_radar(struct register_data *data, size_t radar_number,
                              struct pipeline *pipeline)
{
    struct radar_data *radar = &data->radars[radar_number];
    struct following all = {.data = data, .radar = radar_number};
    size_t *rows = must_calloc(RHO_MAX_PLOTS, sizeof *rows);

    if (radar->num_scans > 0) {
        qsort(radar->scans, radar->num_scans, sizeof *radar->scans, by_time);
    }
    radar->claimed = 0;
    pipeline_open(pipeline, data->parameters);
    must_succeed(rho_tracker_set_sensor(&pipeline->node->tracker, &radar->sensor), "sensor");
    for (size_t first = 0; first < radar->num_scans;) {
        size_t end = register_find_scan_after_turn(radar, first);
        struct rho_scan turn = turn_as_scan(radar, first, end, rows, pipeline->plots);

        pipeline_step(pipeline, &turn);
        record_reported_tracks(&all, &pipeline->node->report, rows);
        radar->claimed += pipeline->node->report.fates_total[RHO_FATE_CLAIMED];
        first = end;
    }
    store_confirmed_tracks(&all);
    free(rows);
}

void register_track_all_radars(struct register_data *data, struct pipeline *pipeline)
{
    for (size_t i = 0; i < data->num_radars; i++) {
        register_track_one_radar(data, i, pipeline);
    }
}
