/* SPDX-License-Identifier: MIT */
#include "io/turns/antenna_turns.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/turns/turn_search.h"

#define ROWS_MAX 6000        /* largest number of rows collected for the search */
#define SENSOR_ROWS_MAX 3000 /* largest number of rows collected of one sensor */
/* share of a plot's azimuth residual that corrects the antenna's angle */
#define GAIN 0.2
#define ASTRAY_RAD (M_PI / 3) /* a plot farther from the antenna's angle does not correct it */
#define LOST_TURNS 2.0        /* after so many turns without a plot the next plot sets the angle */
#define FILES_REMEMBERED 64   /* largest number of files remembered as reported */
#define TURN_RAD (2 * M_PI)

struct antenna {
    int32_t sensor_id;
    struct turn_rule rule;
    struct turn_plot *plots; /* rows collected for the search */
    size_t count, capacity, num_empty;
    bool is_running; /* a first row has been numbered */
    int64_t last_us; /* time of the newest row */
    /* angle turned since the first cut, at last_us, in the direction of turning */
    double turned_rad;
    int32_t number;
};

struct antenna_turns {
    struct antenna *list;
    size_t count, capacity, looked;
};

bool antenna_turns_are_wanted(const struct parameters *parameters)
{
    return parameters->source[PARAMETER_SCAN_INTERVAL_S] <= SOURCE_DEFAULT;
}

struct antenna_turns *antenna_turns_start(void)
{
    return must_calloc(1, sizeof(struct antenna_turns));
}

static struct antenna *find_antenna(const struct antenna_turns *turns, int32_t sensor_id)
{
    for (size_t i = 0; i < turns->count; i++) {
        if (turns->list[i].sensor_id == sensor_id) {
            return &turns->list[i];
        }
    }
    return NULL;
}

static struct antenna *find_or_add_antenna(struct antenna_turns *turns, int32_t sensor_id)
{
    struct antenna *antenna = find_antenna(turns, sensor_id);

    if (!antenna) {
        turns->list = must_make_room_for_one(turns->list, turns->count, &turns->capacity,
                                             sizeof *turns->list);
        antenna = &turns->list[turns->count++];
        *antenna = (struct antenna){.sensor_id = sensor_id};
    }
    return antenna;
}

void antenna_turns_add_empty_row(struct antenna_turns *turns, int32_t sensor_id)
{
    find_or_add_antenna(turns, sensor_id)->num_empty++;
}

bool antenna_turns_add_row(struct antenna_turns *turns, int32_t sensor_id, int64_t time_us,
                           double x_m, double y_m)
{
    struct antenna *antenna = find_or_add_antenna(turns, sensor_id);

    if (antenna->count < SENSOR_ROWS_MAX) {
        antenna->plots = must_make_room_for_one(antenna->plots, antenna->count, &antenna->capacity,
                                                sizeof *antenna->plots);
        antenna->plots[antenna->count++] = (struct turn_plot){time_us, x_m, y_m};
    }
    return ++turns->looked < ROWS_MAX;
}

/*
 * Whether the file's rules were reported before, remembered by a hash of its path from now on: a
 * file that is played in a loop is reported once.
 */
static bool test_and_set_file_reported(const char *path)
{
    static _Thread_local uint64_t said[FILES_REMEMBERED];
    static _Thread_local size_t num_said;
    const uint64_t sum = hash_bytes(path, strlen(path));

    for (size_t i = 0; i < num_said; i++) {
        if (said[i] == sum) {
            return true;
        }
    }
    if (num_said < FILES_REMEMBERED) {
        said[num_said++] = sum;
    }
    return false;
}

static void report_rule(const struct antenna *antenna, const char *path)
{
    const struct turn_rule *rule = &antenna->rule;

    fprintf(stderr, "rhotrack: %s: sensor %" PRId32 ": ", path, antenna->sensor_id);
    if (rule->kind == TURN_UNKNOWN) {
        fprintf(stderr,
                "each row has its own time, %.3g s apart, and neither azimuths (seen from its "
                "place, sensor.%" PRId32
                ".x_m and y_m) nor gaps show turns of an antenna: set scan_interval_s to the time "
                "of a turn to gather them, or to 0 to make each time a scan\n",
                rule->turn_s, antenna->sensor_id);
        return;
    }
    fprintf(stderr,
            "the rows of a turn differ in time; they are gathered into %s %.4g s%s by %s; "
            "scan_interval_s=0 makes each time a scan\n",
            rule->kind == TURN_AZIMUTHS ? "turns of" : "scans,", rule->turn_s,
            rule->kind == TURN_AZIMUTHS ? "" : " apart,",
            rule->kind == TURN_GAPS ? "the gaps between them"
            : rule->rate_rad_s < 0  ? "azimuth, clockwise"
                                    : "azimuth, counter-clockwise");
}

bool antenna_turns_find_rules(struct antenna_turns *turns, const char *path, double v_max_mps)
{
    const bool was_said = test_and_set_file_reported(path);
    bool has_any = false;

    for (size_t i = 0; i < turns->count; i++) {
        struct antenna *antenna = &turns->list[i];

        antenna->rule =
            turn_search_find_rule(antenna->plots, antenna->count, antenna->num_empty, v_max_mps);
        if (antenna->rule.kind != TURN_NONE && !was_said) {
            report_rule(antenna, path);
        }
        has_any |= antenna->rule.kind >= TURN_AZIMUTHS;
    }
    return has_any;
}

/*
 * Angle that the antenna has turned since its cut when it points at the place, within half a turn
 * of a guess.
 */
static double turned_angle_at_place(const struct turn_rule *rule, const double place_m[2],
                                    double guess_rad)
{
    double since_cut = atan2(place_m[1], place_m[0]) - rule->cut_rad;

    since_cut = rule->rate_rad_s < 0 ? -since_cut : since_cut;
    return guess_rad + remainder(since_cut - guess_rad, TURN_RAD);
}

/* Advances the antenna's angle and turn number to a row; a gap of several turns counts as one. */
static void advance_antenna_to_row(struct antenna *antenna, int64_t time_us, const double *place_m)
{
    const struct turn_rule *rule = &antenna->rule;
    const double rest_s = (double)(time_us - antenna->last_us) * 1e-6;
    double here_rad;

    if (!antenna->is_running || rest_s > LOST_TURNS * rule->turn_s) {
        antenna->turned_rad = TURN_RAD * (antenna->number + 0.5);
        antenna->turned_rad = place_m ? turned_angle_at_place(rule, place_m, antenna->turned_rad)
                                      : antenna->turned_rad;
        here_rad = antenna->turned_rad;
        antenna->number++;
    } else {
        antenna->turned_rad += fabs(rule->rate_rad_s) * rest_s;
        here_rad = place_m ? turned_angle_at_place(rule, place_m, antenna->turned_rad)
                           : antenna->turned_rad;
        here_rad =
            fabs(here_rad - antenna->turned_rad) > ASTRAY_RAD ? antenna->turned_rad : here_rad;
        antenna->turned_rad += GAIN * (here_rad - antenna->turned_rad);
    }
    antenna->number = (int32_t)fmax(antenna->number, floor(here_rad / TURN_RAD) + 1);
}

int32_t antenna_turns_number_row(struct antenna_turns *turns, int32_t sensor_id, int64_t time_us,
                                 const double place_m[2])
{
    struct antenna *antenna = find_antenna(turns, sensor_id);

    if (!antenna || antenna->rule.kind < TURN_AZIMUTHS) {
        return 0;
    }
    if (antenna->rule.kind == TURN_AZIMUTHS) {
        advance_antenna_to_row(antenna, time_us, place_m);
    } else {
        antenna->number +=
            !antenna->is_running || time_us - antenna->last_us > antenna->rule.gap_us;
    }
    antenna->is_running = true;
    antenna->last_us = time_us;
    return antenna->number;
}

void antenna_turns_free(struct antenna_turns *turns)
{
    if (!turns) {
        return;
    }
    for (size_t i = 0; i < turns->count; i++) {
        free(turns->list[i].plots);
    }
    free(turns->list);
    free(turns);
}
