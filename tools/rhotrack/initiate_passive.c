/* SPDX-License-Identifier: MIT */
#include "initiate_passive.h"

#include <cjson/cJSON.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "chain.h"
#include "common.h"
#include "frame_reader.h"
#include "method.h"
#include "rhotrack/angle.h"
#include "tracks_writer.h"

struct batch {
    struct rho_passive *passive;
    uint64_t frames, bearings, num_lost; /* lost: the library had no room for them */
    int64_t time_us;                     /* of the last frame */
    int64_t wall_us;
};

/* ---- The batch ---- */

static void push(struct batch *batch, const struct rho_frame *frame)
{
    size_t count = 0;
    uint8_t *fates;

    for (uint32_t i = 0; i < frame->num_scans; i++) {
        count += frame->scans[i].num_bearings;
    }
    fates = must_alloc(count + 1);
    memset(fates, RHO_FATE_HELD, count + 1);
    int64_t start_us = clock_us();
    must_succeed(rho_passive_push(batch->passive, frame, fates), "passive");
    batch->wall_us += clock_us() - start_us;
    for (size_t i = 0; i < count; i++) {
        batch->num_lost += fates[i] != RHO_FATE_HELD;
    }
    free(fates);
    batch->frames++;
    batch->bearings += count;
    batch->time_us = frame->time_us;
}

static void check_sensors(const struct frame_reader *reader)
{
    size_t count;

    frame_reader_need_pair(reader);
    frame_reader_sensors(reader, &count);
    if (count > RHO_MAX_PASSIVE_SENSORS) {
        fail(EXIT_USAGE, "%zu passive sensors; at most %d are searched together", count,
             RHO_MAX_PASSIVE_SENSORS);
    }
}

static void search(struct batch *batch, const struct command_line *line)
{
    struct rho_passive_config config = method_passive(&line->parameters);
    struct frame_reader *reader = frame_reader_open(line->arguments, line->num_arguments,
                                                    &line->parameters, line->keep_going);
    const struct rho_frame *frame;

    check_sensors(reader);
    must_succeed(rho_passive_init(batch->passive, sizeof *batch->passive, &config), "passive");
    frame_reader_skip(reader, config.scans);
    while ((frame = frame_reader_next(reader))) {
        push(batch, frame);
    }
    int64_t start_us = clock_us();
    must_succeed(rho_passive_search(batch->passive), "passive");
    batch->wall_us += clock_us() - start_us;
    frame_reader_report(reader);
    if (batch->num_lost) {
        fprintf(stderr, "rhotrack: %" PRIu64 " bearings beyond %d a scan are left out\n",
                batch->num_lost, RHO_MAX_BEARINGS);
    }
    frame_reader_close(reader);
}

/* ---- What it found ---- */

static unsigned count_scans(const struct rho_passive_track *track)
{
    unsigned count = 0;

    for (unsigned mask = track->scans; mask; mask &= mask - 1) {
        count++;
    }
    return count;
}

static void write_found(const struct batch *batch, const char *path)
{
    struct output output = output_open(path);

    initiated_write_header(output.file);
    for (unsigned i = 0; i < batch->passive->num_tracks; i++) {
        const struct rho_passive_track *track = &batch->passive->tracks[i];
        struct rho_line line = rho_angle_line(track->x_m, track->y_m, track->vx_mps, track->vy_mps);
        struct initiated row = {.track_id = i + 1,
                                .time_us = batch->time_us,
                                .has_state = true,
                                .x_m = track->x_m,
                                .y_m = track->y_m,
                                .vx_mps = track->vx_mps,
                                .vy_mps = track->vy_mps,
                                .rho_m = line.rho_m,
                                .theta_rad = line.theta_rad,
                                .scans = count_scans(track),
                                .score = (double)((float)track->score_mnat / 1000.0f)};

        initiated_write_row(output.file, &row);
    }
    output_close(&output);
}

static int compare_descending(const void *a, const void *b)
{
    return *(const int *)b - *(const int *)a;
}

/* Bearings of each track, descending, and their number. */
static void add_votes(cJSON *object, const struct rho_passive *passive)
{
    int hits[RHO_MAX_PASSIVE_TRACKS], sum = 0;

    for (int i = 0; i < passive->num_tracks; i++) {
        hits[i] = passive->tracks[i].hits;
        sum += hits[i];
    }
    qsort(hits, passive->num_tracks, sizeof *hits, compare_descending);
    cJSON_AddNumberToObject(object, "votes", sum);
    cJSON_AddItemToObject(object, "peak_votes", cJSON_CreateIntArray(hits, passive->num_tracks));
}

static void print_json(const struct batch *batch)
{
    const struct rho_passive *passive = batch->passive;
    const struct rho_passive_work *work = &passive->work;
    cJSON *object = cJSON_CreateObject();

    cJSON_AddStringToObject(object, "method", method_name(METHOD_PASSIVE));
    cJSON_AddNumberToObject(object, "scans", (double)batch->frames);
    cJSON_AddNumberToObject(object, "plots", (double)batch->bearings);
    cJSON_AddNumberToObject(object, "pairs", work->crossings);
    cJSON_AddNumberToObject(object, "candidates", work->crossings - work->ghosts);
    add_votes(object, passive);
    cJSON_AddNumberToObject(object, "tracks", passive->num_tracks);
    cJSON_AddNumberToObject(object, "state_bytes", (double)sizeof *passive);
    cJSON_AddNumberToObject(object, "wall_us", (double)batch->wall_us);
    cJSON_AddNumberToObject(object, "sensors", passive->batch.num_sensors);
    cJSON_AddNumberToObject(object, "ghosts", work->ghosts);
    cJSON_AddNumberToObject(object, "lines", work->peaks);
    cJSON_AddNumberToObject(object, "hypotheses", work->hypotheses);
    cJSON_AddNumberToObject(object, "fits", work->fits);
    cJSON_AddNumberToObject(object, "points_dropped", work->points_dropped);
    cJSON_AddNumberToObject(object, "candidates_dropped", work->candidates_dropped);
    cJSON_AddNumberToObject(object, "bearings_no_room", (double)batch->num_lost);
    json_print(object);
}

void initiate_passive(const struct command_line *line)
{
    struct batch batch = {.passive = must_alloc(sizeof *batch.passive)};

    search(&batch, line);
    if (line->output || !line->json) {
        write_found(&batch, line->output);
    }
    if (line->json) {
        print_json(&batch);
    }
    free(batch.passive);
}
