/* SPDX-License-Identifier: MIT */
/*
 * evaluate: tracks against truth.
 *
 * At every time of the truth the confirmed and coasting tracks are paired with the targets (gospa.h). From the pairs:
 *   gospa_m        root of the mean over the times of GOSPA^2; gospa_localisation_m the same of its localisation part;
 *                  gospa_missed, gospa_false: targets, tracks without a partner, mean a time
 *   ospa_m         mean over the times
 *   completeness   share of the (target, time) points that have a track
 *   false_per_scan tracks without a target, mean a time; false_per_hour: tracks without a target in most of their rows,
 *                  over the hours that the truth spans
 *   switches       how often a target's track is another than the one it had before
 *   delay_scans    mean over the targets found: times from a target's first to its first with a track
 *   rmse_m, rmse_mps  over the pairs, in z too where both files have it; nees: mean e^T P^-1 e of the position's x and y over the pairs (2 is consistent)
 */
#include <cjson/cJSON.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "common.h"
#include "gospa.h"
#include "log_table.h"
#include "table.h"

#define TIME_TOLERANCE_US 1000
#define NO_ID INT32_MIN

struct point {
    int64_t time_us;
    int32_t id;
    size_t row; /* in its table */
    struct gospa_place place;
    double vx_mps, vy_mps, vz_mps;
    double cov[3]; /* xx, yx, yy; NAN where not given */
};

struct points {
    struct point *list; /* by time, then as in the file */
    size_t count;
    bool has_z, has_velocity, has_vz, has_covariance;
};

/* A target or a track through its life. */
struct life {
    int32_t id, partner; /* partner: the track that a target had last */
    size_t rows, paired;
    size_t first_pair; /* rows until the first pair */
    size_t last_time;  /* of a track, the last that it has a row at, from 1 */
};

struct lives {
    struct life *list;
    size_t count;
};

struct evaluation {
    struct points truth, tracks;
    struct lives targets, track_lives;
    double cutoff_m;
    size_t times, switches;
    double squared_m2, localisation_m2, ospa_m;
    double error2_m2, error2_m2ps2, nees;
    size_t pairs, missed, false_rows;
};

/* ---- reading ---------------------------------------------------------------------------------- */

static void read_time_and_id(const struct table *table, size_t row, const char *id_name,
                             struct point *point)
{
    int time_column = table_need(table, "t_s"), id_column = table_need(table, id_name);
    const char *reason = table_time_us(table_cell(table, row, time_column), &point->time_us);
    if (reason != NULL) {
        table_fail(table, row, "t_s: '%s' %s", table_cell(table, row, time_column), reason);
    }
    reason = table_int32(table_cell(table, row, id_column), &point->id);
    if (reason != NULL) {
        table_fail(table, row, "%s: '%s' %s", id_name, table_cell(table, row, id_column), reason);
    }
}

static struct point read_point(const struct table *table, size_t row, const char *id_name)
{
    struct point point = {.row = row};
    read_time_and_id(table, row, id_name, &point);
    point.place.x_m = table_number_at(table, row, table_need(table, "x_m"));
    point.place.y_m = table_number_at(table, row, table_need(table, "y_m"));
    point.place.z_m = table_number_or(table, row, table_find(table, "z_m"), 0.0);
    point.vx_mps = table_number_or(table, row, table_find(table, "vx_mps"), NAN);
    point.vy_mps = table_number_or(table, row, table_find(table, "vy_mps"), NAN);
    point.vz_mps = table_number_or(table, row, table_find(table, "vz_mps"), 0.0);
    point.cov[0] = table_number_or(table, row, table_find(table, "cov_x_x"), NAN);
    point.cov[1] = table_number_or(table, row, table_find(table, "cov_y_x"), NAN);
    point.cov[2] = table_number_or(table, row, table_find(table, "cov_y_y"), NAN);
    return point;
}

static bool counts(const struct table *table, size_t row)
{
    int column = table_find(table, "status");
    const char *status = column < 0 ? "confirmed" : table_cell(table, row, column);
    if (strcmp(status, "confirmed") == 0 || strcmp(status, "coasting") == 0) {
        return true;
    }
    if (strcmp(status, "tentative") != 0 && strcmp(status, "deleted") != 0) {
        table_fail(table, row, "status: '%s' is none of tentative, confirmed, coasting, deleted",
                   status);
    }
    return false;
}

static int by_time(const void *a, const void *b)
{
    const struct point *one = a, *other = b;
    if (one->time_us != other->time_us) {
        return one->time_us < other->time_us ? -1 : 1;
    }
    return one->row < other->row ? -1 : one->row > other->row;
}

static struct points read_points(const struct table *table, const char *id_name)
{
    struct points points = {.list = must_calloc(table->num_rows + 1, sizeof(struct point)),
                            .has_z = table_find(table, "z_m") >= 0,
                            .has_velocity = table_find(table, "vx_mps") >= 0,
                            .has_vz = table_find(table, "vz_mps") >= 0,
                            .has_covariance = table_find(table, "cov_y_y") >= 0};
    for (size_t row = 0; row < table->num_rows; row++) {
        struct point point = read_point(table, row, id_name);
        if (counts(table, row)) {
            points.list[points.count++] = point;
        }
    }
    qsort(points.list, points.count, sizeof points.list[0], by_time);
    return points;
}

/* What one of the two does not say is not compared: heights, and velocities upwards. */
static void level(struct points *truth, struct points *tracks)
{
    struct points *both[] = {truth, tracks};
    for (int i = 0; i < 2; i++) {
        for (size_t j = 0; j < both[i]->count; j++) {
            struct point *point = &both[i]->list[j];
            point->place.z_m = truth->has_z && tracks->has_z ? point->place.z_m : 0.0;
            point->vz_mps = truth->has_vz && tracks->has_vz ? point->vz_mps : 0.0;
        }
    }
}

/* ---- lives ------------------------------------------------------------------------------------ */

static int by_id(const void *a, const void *b)
{
    const struct life *one = a, *other = b;
    return one->id < other->id ? -1 : one->id > other->id;
}

static struct lives lives_of(const struct points *points)
{
    struct lives lives = {.list = must_calloc(points->count + 1, sizeof(struct life))};
    for (size_t i = 0; i < points->count; i++) {
        lives.list[i] = (struct life){.id = points->list[i].id, .partner = NO_ID};
    }
    qsort(lives.list, points->count, sizeof lives.list[0], by_id);
    for (size_t i = 0; i < points->count; i++) {
        if (lives.count == 0 || lives.list[lives.count - 1].id != lives.list[i].id) {
            lives.list[lives.count++] = lives.list[i];
        }
    }
    return lives;
}

static struct life *life_of(struct lives *lives, int32_t id)
{
    struct life key = {.id = id};
    return bsearch(&key, lives->list, lives->count, sizeof key, by_id);
}

/* ---- one time --------------------------------------------------------------------------------- */

static double nees_of(const struct point *track, double ex_m, double ey_m)
{
    double det = track->cov[0] * track->cov[2] - track->cov[1] * track->cov[1];
    return (ex_m * ex_m * track->cov[2] - 2.0 * ex_m * ey_m * track->cov[1] +
            ey_m * ey_m * track->cov[0]) /
           det;
}

static void count_pair(struct evaluation *e, const struct point *target, const struct point *track)
{
    struct life *life = life_of(&e->targets, target->id);
    double ex_m = track->place.x_m - target->place.x_m, ey_m = track->place.y_m - target->place.y_m;
    double ez_m = track->place.z_m - target->place.z_m;
    double evx = track->vx_mps - target->vx_mps, evy = track->vy_mps - target->vy_mps;
    double evz = track->vz_mps - target->vz_mps;

    if (life->partner != NO_ID && life->partner != track->id) {
        e->switches++;
    }
    if (life->paired++ == 0) {
        life->first_pair = life->rows - 1;
    }
    life->partner = track->id;
    life_of(&e->track_lives, track->id)->paired++;
    e->pairs++;
    e->error2_m2 += ex_m * ex_m + ey_m * ey_m + ez_m * ez_m;
    e->error2_m2ps2 += evx * evx + evy * evy + evz * evz;
    e->nees += nees_of(track, ex_m, ey_m);
}

static struct gospa_place *places_of(const struct point *points, size_t count)
{
    struct gospa_place *places = must_calloc(count + 1, sizeof *places);
    for (size_t i = 0; i < count; i++) {
        places[i] = points[i].place;
    }
    return places;
}

static void evaluate_time(struct evaluation *e, const struct point *targets, size_t num_targets,
                          const struct point *tracks, size_t num_tracks)
{
    struct gospa_place *target_places = places_of(targets, num_targets);
    struct gospa_place *track_places = places_of(tracks, num_tracks);
    int *track_of = must_calloc(num_targets + 1, sizeof *track_of);
    struct gospa gospa =
        gospa_compare(target_places, num_targets, track_places, num_tracks, e->cutoff_m, track_of);
    for (size_t i = 0; i < num_tracks; i++) {
        life_of(&e->track_lives, tracks[i].id)->rows++;
    }
    for (size_t i = 0; i < num_targets; i++) {
        life_of(&e->targets, targets[i].id)->rows++;
        if (track_of[i] >= 0) {
            count_pair(e, &targets[i], &tracks[track_of[i]]);
        }
    }
    e->times++;
    e->squared_m2 += gospa.squared_m2;
    e->localisation_m2 += gospa.localisation_m2;
    e->ospa_m += gospa.ospa_m;
    e->missed += gospa.missed;
    e->false_rows += gospa.false_tracks;
    free(target_places);
    free(track_places);
    free(track_of);
}

/* End of the points from `from` that have its time, within the tolerance. */
static size_t end_of_time(const struct points *points, size_t from, int64_t time_us)
{
    while (from < points->count && points->list[from].time_us <= time_us + TIME_TOLERANCE_US) {
        from++;
    }
    return from;
}

static void check_time(const struct evaluation *e, const struct table *table, size_t at,
                       int64_t time_us)
{
    if (at < e->tracks.count && e->tracks.list[at].time_us < time_us - TIME_TOLERANCE_US) {
        table_fail(table, e->tracks.list[at].row, "the truth has no such time within 1 ms");
    }
}

/* Scans of several sensors at one time give a track a row each: the last one is what is known at that time. The rows that
 * count go to the end of the range; where they begin. */
static size_t keep_last(struct evaluation *e, size_t begin, size_t end)
{
    size_t kept = end;

    for (size_t i = end; i-- > begin;) {
        struct life *life = life_of(&e->track_lives, e->tracks.list[i].id);

        if (life->last_time != e->times + 1) {
            life->last_time = e->times + 1;
            e->tracks.list[--kept] = e->tracks.list[i];
        }
    }
    return kept;
}

static void evaluate_all(struct evaluation *e, const struct table *tracks_table)
{
    size_t target = 0, track = 0;
    while (target < e->truth.count) {
        int64_t time_us = e->truth.list[target].time_us;
        check_time(e, tracks_table, track, time_us);
        size_t target_end = end_of_time(&e->truth, target, time_us);
        size_t track_end = end_of_time(&e->tracks, track, time_us);
        track = keep_last(e, track, track_end);
        evaluate_time(e, &e->truth.list[target], target_end - target, &e->tracks.list[track],
                      track_end - track);
        target = target_end;
        track = track_end;
    }
    check_time(e, tracks_table, track, INT64_MAX);
}

/* ---- result ----------------------------------------------------------------------------------- */

struct result {
    const char *name;
    double value; /* NAN: null */
};

static double mean(double sum, size_t count)
{
    return count == 0 ? NAN : sum / (double)count;
}

static double span_hours(const struct points *truth)
{
    return truth->count == 0
               ? 0.0
               : (double)(truth->list[truth->count - 1].time_us - truth->list[0].time_us) / 3.6e9;
}

static size_t false_lives(const struct lives *tracks)
{
    size_t count = 0;
    for (size_t i = 0; i < tracks->count; i++) {
        count += 2 * tracks->list[i].paired < tracks->list[i].rows;
    }
    return count;
}

#define NUM_RESULTS 16

static void fill_results(const struct evaluation *e, struct result results[NUM_RESULTS])
{
    size_t found = 0;
    double delay = 0.0, hours = span_hours(&e->truth);
    bool velocity = e->truth.has_velocity && e->tracks.has_velocity;
    for (size_t i = 0; i < e->targets.count; i++) {
        found += e->targets.list[i].paired > 0;
        delay += e->targets.list[i].paired > 0 ? (double)e->targets.list[i].first_pair : 0.0;
    }
    const struct result all[NUM_RESULTS] = {
        {"gospa_m", sqrt(mean(e->squared_m2, e->times))},
        {"gospa_localisation_m", sqrt(mean(e->localisation_m2, e->times))},
        {"gospa_missed", mean((double)e->missed, e->times)},
        {"gospa_false", mean((double)e->false_rows, e->times)},
        {"ospa_m", mean(e->ospa_m, e->times)},
        {"completeness", mean((double)e->pairs, e->truth.count)},
        {"false_per_scan", mean((double)e->false_rows, e->times)},
        {"false_per_hour", hours > 0.0 ? (double)false_lives(&e->track_lives) / hours : NAN},
        {"switches", (double)e->switches},
        {"delay_scans", mean(delay, found)},
        {"rmse_m", sqrt(mean(e->error2_m2, e->pairs))},
        {"rmse_mps", velocity ? sqrt(mean(e->error2_m2ps2, e->pairs)) : NAN},
        {"nees", e->tracks.has_covariance ? mean(e->nees, e->pairs) : NAN},
        {"targets", (double)e->targets.count},
        {"targets_found", (double)found},
        {"tracks", (double)e->track_lives.count},
    };
    memcpy(results, all, sizeof all);
}

static void print_results(const struct result *results, bool as_json)
{
    cJSON *object = as_json ? cJSON_CreateObject() : NULL;
    for (size_t i = 0; i < NUM_RESULTS; i++) {
        bool known = isfinite(results[i].value);
        if (as_json) {
            json_add_number(object, results[i].name, results[i].value);
        } else if (known) {
            printf("%-22s %12.6g\n", results[i].name, results[i].value);
        } else {
            printf("%-22s %12s\n", results[i].name, "-");
        }
    }
    if (as_json) {
        json_print(object);
    }
}

int command_evaluate(struct command_line *line)
{
    if (line->num_arguments != 2) {
        fail(EXIT_USAGE, "evaluate: give a truth file and a tracks file");
    }
    struct table *truth = log_table_or_csv(line->arguments[0], &rows_kind_truth, line->keep_going);
    struct table *tracks =
        log_table_or_csv(line->arguments[1], &rows_kind_tracks, line->keep_going);
    table_need_rows(truth);
    struct evaluation e = {.cutoff_m = line->parameters.value[PARAMETER_GOSPA_CUTOFF_M]};
    struct result results[NUM_RESULTS];
    e.truth = read_points(truth, "target_id");
    e.tracks = read_points(tracks, "track_id");
    level(&e.truth, &e.tracks);
    e.targets = lives_of(&e.truth);
    e.track_lives = lives_of(&e.tracks);
    evaluate_all(&e, tracks);
    fill_results(&e, results);
    print_results(results, line->json);
    free(e.truth.list);
    free(e.tracks.list);
    free(e.targets.list);
    free(e.track_lives.list);
    table_free(truth);
    table_free(tracks);
    return 0;
}
