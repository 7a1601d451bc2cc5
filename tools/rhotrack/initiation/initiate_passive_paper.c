/* SPDX-License-Identifier: MIT */
#include "initiation/initiate_passive_paper.h"

#include <cjson/cJSON.h>
#include <stdlib.h>

#include "base/common.h"
#include "initiation/last_bearings.h"
#include "io/output/initiated_output.h"
#include "pipeline/pipeline.h"
#include "settings/initiation_methods.h"

static enum rho_status push_paper_frame(void *object, const struct rho_frame *frame, uint8_t *fates)
{
    return rho_passive_paper_push(object, frame, fates);
}

static enum rho_status search_paper_batch(void *object)
{
    return rho_passive_paper_search(object);
}

static void write_found_tracks(const struct rho_passive_paper *paper, int64_t time_us,
                               const char *path)
{
    struct initiated_output *found = initiated_output_open(path);

    for (unsigned i = 0; i < paper->num_lines; i++) {
        const struct rho_passive_paper_line *line = &paper->lines[i];
        struct initiated row = {.track_id = i + 1,
                                .time_us = time_us,
                                .has_state = line->has_state,
                                .x_m = line->x_m,
                                .y_m = line->y_m,
                                .vx_mps = line->vx_mps,
                                .vy_mps = line->vy_mps,
                                .rho_m = line->rho_m,
                                .theta_rad = line->theta_rad,
                                .scans = rho_count_bits(line->scans),
                                .sensor_pairs =
                                    paper->batch.num_sensors * (paper->batch.num_sensors - 1u) / 2u,
                                .score = line->votes};

        initiated_output_add_row(found, &row);
    }
    initiated_output_close(found);
}

static void print_search_json(const struct rho_passive_paper *paper,
                              const struct last_bearings *batch)
{
    const struct rho_passive_paper_work *work = &paper->work;
    cJSON *object = cJSON_CreateObject();

    cJSON_AddStringToObject(object, "method", method_name(METHOD_PASSIVE_PAPER));
    cJSON_AddNumberToObject(object, "scans", (double)batch->frames);
    cJSON_AddNumberToObject(object, "plots", (double)batch->bearings);
    cJSON_AddNumberToObject(object, "pairs", work->crossings);
    cJSON_AddNumberToObject(object, "candidates", work->crossings - work->ghosts);
    int votes[RHO_MAX_PASSIVE_LINES];

    for (int i = 0; i < paper->num_lines; i++) {
        votes[i] = paper->lines[i].votes;
    }
    cJSON_AddNumberToObject(object, "votes", paper->work.votes);
    cJSON_AddItemToObject(object, "peak_votes",
                          sort_descending_into_json_list(votes, paper->num_lines));
    cJSON_AddNumberToObject(object, "tracks", paper->num_lines);
    cJSON_AddNumberToObject(object, "state_bytes", (double)sizeof *paper);
    cJSON_AddNumberToObject(object, "wall_us", (double)batch->wall_us);
    cJSON_AddNumberToObject(object, "sensors", paper->batch.num_sensors);
    cJSON_AddNumberToObject(object, "votes_min", paper->votes_min);
    cJSON_AddNumberToObject(object, "ghosts", work->ghosts);
    cJSON_AddNumberToObject(object, "cells", work->cells);
    cJSON_AddNumberToObject(object, "lines", paper->num_lines + work->lines_dropped);
    cJSON_AddNumberToObject(object, "points_dropped", work->points_dropped);
    cJSON_AddNumberToObject(object, "lines_dropped", work->lines_dropped);
    cJSON_AddNumberToObject(object, "bearings_no_room", (double)batch->num_lost);
    json_print_and_delete(object);
}

static void warn_of_dropped_lines(const struct rho_passive_paper_work *work)
{
    if (work->points_dropped > 0) {
        fprintf(stderr, "rhotrack: %u crossings beyond %d a pair of sensors are left out\n",
                work->points_dropped, RHO_MAX_PAPER_CROSSINGS);
    }
    if (work->lines_dropped > 0) {
        fprintf(stderr, "rhotrack: %u lines beyond %d are left out; raise votes_min\n",
                work->lines_dropped, RHO_MAX_PASSIVE_LINES);
    }
}

void initiate_passive_paper(const struct command_line *line)
{
    struct rho_passive_paper *paper = must_alloc(sizeof *paper);
    struct parameters parameters = line->parameters;
    struct bearing_reader *reader = last_bearings_open(line, &parameters);
    struct rho_passive_paper_config config = method_passive_paper_config(&parameters);
    struct bearings_search with = {paper, &paper->batch, push_paper_frame, search_paper_batch};

    must_succeed(rho_passive_paper_init(paper, sizeof *paper, &config), "passive-paper");
    struct last_bearings batch = last_bearings_search_and_close(&with, reader, &parameters);
    warn_of_dropped_lines(&paper->work);
    if (line->output || !line->json) {
        write_found_tracks(paper, batch.time_us, line->output);
    }
    if (line->json) {
        print_search_json(paper, &batch);
    }
    free(paper);
}
