/* SPDX-License-Identifier: MIT */
#include "initiation/initiate_passive.h"

#include <cjson/cJSON.h>
#include <stdlib.h>

#include "base/common.h"
#include "initiation/last_bearings.h"
#include "io/output/initiated_output.h"
#include "pipeline/pipeline.h"
#include "rhotrack/detail/angle.h"
#include "settings/initiation_methods.h"

static enum rho_status push_passive_frame(void *object, const struct rho_frame *frame,
                                          uint8_t *fates)
{
    return rho_passive_push(object, frame, fates);
}

static enum rho_status search_passive_batch(void *object)
{
    return rho_passive_search(object);
}

static void write_found_tracks(const struct rho_passive *passive, int64_t time_us, const char *path)
{
    struct initiated_output *found = initiated_output_open(path);

    for (unsigned i = 0; i < passive->num_tracks; i++) {
        const struct rho_passive_track *track = &passive->tracks[i];
        struct rho_line line = rho_angle_line(track->x_m, track->y_m, track->vx_mps, track->vy_mps);
        struct initiated row = {.track_id = i + 1,
                                .time_us = time_us,
                                .has_state = true,
                                .x_m = track->x_m,
                                .y_m = track->y_m,
                                .vx_mps = track->vx_mps,
                                .vy_mps = track->vy_mps,
                                .rho_m = line.rho_m,
                                .theta_rad = line.theta_rad,
                                .scans = rho_count_bits(track->scans),
                                .sensor_pairs = rho_passive_sensor_pairs(track),
                                .score = (double)((float)track->score_mnat / 1000.0f),
                                .has_height = !track->is_level,
                                .z_m = track->z_m,
                                .vz_mps = track->vz_mps};

        initiated_output_add_row(found, &row);
    }
    initiated_output_close(found);
}

/* Adds the number of bearings of each track, in descending order, and their sum. */
static void add_track_hits_json(cJSON *object, const struct rho_passive *passive)
{
    int hits[RHO_MAX_PASSIVE_TRACKS], sum = 0;

    for (int i = 0; i < passive->num_tracks; i++) {
        hits[i] = passive->tracks[i].hits;
        sum += hits[i];
    }
    cJSON_AddNumberToObject(object, "votes", sum);
    cJSON_AddItemToObject(object, "peak_votes",
                          sort_descending_into_json_list(hits, passive->num_tracks));
}

static void print_search_json(const struct rho_passive *passive, const struct last_bearings *batch)
{
    const struct rho_passive_work *work = &passive->work;
    cJSON *object = cJSON_CreateObject();

    cJSON_AddStringToObject(object, "method", method_name(METHOD_PASSIVE));
    cJSON_AddNumberToObject(object, "scans", (double)batch->frames);
    cJSON_AddNumberToObject(object, "plots", (double)batch->bearings);
    cJSON_AddNumberToObject(object, "pairs", work->crossings);
    cJSON_AddNumberToObject(object, "candidates", work->crossings - work->ghosts);
    add_track_hits_json(object, passive);
    cJSON_AddNumberToObject(object, "tracks", passive->num_tracks);
    /* Score margins of candidates, without the tracks. */
    cJSON *list = cJSON_AddArrayToObject(object, "margins_nat");

    for (int i = 0; i < passive->num_tracks; i++) {
        cJSON_AddItemToArray(list, cJSON_CreateNumber(1e-3 * passive->tracks[i].margin_mnat));
    }
    cJSON_AddNumberToObject(object, "state_bytes", (double)sizeof *passive);
    cJSON_AddNumberToObject(object, "wall_us", (double)batch->wall_us);
    cJSON_AddNumberToObject(object, "sensors", passive->batch.num_sensors);
    cJSON_AddNumberToObject(object, "ghosts", work->ghosts);
    cJSON_AddNumberToObject(object, "hypotheses", work->hypotheses);
    cJSON_AddNumberToObject(object, "fits", work->fits);
    cJSON_AddNumberToObject(object, "points_dropped", work->points_dropped);
    cJSON_AddNumberToObject(object, "candidates_dropped", work->candidates_dropped);
    cJSON_AddNumberToObject(object, "bearings_no_room", (double)batch->num_lost);
    json_print_and_delete(object);
}

void initiate_passive(const struct command_line *line)
{
    struct rho_passive *passive = must_alloc(sizeof *passive);
    struct parameters parameters = line->parameters;
    struct bearing_reader *reader = last_bearings_open(line, &parameters);
    struct rho_passive_config config = method_passive_config(&parameters);
    struct bearings_search with = {passive, &passive->batch, push_passive_frame,
                                   search_passive_batch};

    must_succeed(rho_passive_init(passive, sizeof *passive, &config), "passive");
    struct last_bearings batch = last_bearings_search_and_close(&with, reader, &parameters);
    if (line->output || !line->json) {
        write_found_tracks(passive, batch.time_us, line->output);
    }
    if (line->json) {
        print_search_json(passive, &batch);
    }
    free(passive);
}
