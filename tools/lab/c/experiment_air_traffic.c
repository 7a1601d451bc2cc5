/* SPDX-License-Identifier: MIT */
#include "experiment_air_traffic.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "experiment.h"

#define DEFAULT_RUNS 4

/* ---- JSON ------------------------------------------------------------------------------------ */

static cJSON *figures_json(const struct air_figures *of)
{
    cJSON *object = cJSON_CreateObject();

    json_add_number(object, "gospa_m", of->gospa_m);
    json_add_number(object, "gospa_localisation_m", of->localisation_m);
    json_add_number(object, "gospa_missed", of->missed);
    json_add_number(object, "gospa_false", of->false_a_scan);
    json_add_number(object, "completeness", of->completeness);
    json_add_number(object, "switches", of->switches);
    json_add_number(object, "fragments", of->fragments);
    json_add_number(object, "delay_scans", of->delay_scans);
    json_add_number(object, "rmse_m", of->rmse_m);
    json_add_number(object, "nees", of->nees);
    json_add_number(object, "nees_inside", of->nees_inside);
    json_add_number(object, "velocity_ratio", of->velocity_ratio);
    json_add_number(object, "velocity_inside", of->velocity_inside);
    return object;
}

static cJSON *case_json(const struct air_case *of, const struct air_result *result)
{
    static const char *const groups[] = {"grid", "stress", "operation"};
    cJSON *object = cJSON_CreateObject();

    cJSON_AddStringToObject(object, "part", groups[of->group]);
    cJSON_AddStringToObject(object, "case", of->name);
    json_add_number(object, "targets", of->targets);
    json_add_number(object, "clutter_per_scan", of->clutter);
    json_add_number(object, "scan_us", result->us);
    json_add_number(object, "min_scans", result->min_scans);
    json_add_number(object, "false_tracks_per_hour", result->false_tracks / result->hours);
    cJSON_AddItemToObject(object, "tracks", figures_json(&result->tracks[0]));
    cJSON_AddItemToObject(object, "tracks_200_m", figures_json(&result->tracks[1]));
    if (of->has_limit) {
        cJSON_AddItemToObject(object, "limit", figures_json(&result->limit[0]));
        cJSON_AddItemToObject(object, "limit_200_m", figures_json(&result->limit[1]));
    }
    return object;
}

static void cases_to_json(const struct air_report *report, cJSON *root)
{
    cJSON *list = cJSON_AddArrayToObject(root, "cases");

    for (size_t i = 0; i < air_num_cases() && report->results != NULL; i++) {
        if (report->results[i].us > 0.0) {
            cJSON_AddItemToArray(list, case_json(&air_cases[i], &report->results[i]));
        }
    }
}

static void pairs_to_json(const struct air_report *report, cJSON *root)
{
    cJSON *list = cJSON_AddArrayToObject(root, "pairs");

    for (size_t i = 0; i < AIR_PAIRS && report->pair_runs > 0; i++) {
        cJSON *object = cJSON_CreateObject();
        cJSON_AddStringToObject(object, "case", air_pairs[i].name);
        json_add_number(object, "runs", (double)report->pair_runs);
        json_add_number(object, "no_switch", report->pairs[i].kept);
        json_add_number(object, "switches", report->pairs[i].switches);
        json_add_number(object, "lost", report->pairs[i].lost);
        json_add_number(object, "completeness", report->pairs[i].completeness);
        cJSON_AddItemToArray(list, object);
    }
}

static void clutter_to_json(const struct air_report *report, cJSON *root)
{
    cJSON *list = cJSON_AddArrayToObject(root, "clutter");

    for (size_t i = 0; i < AIR_ALARMS && report->alarms[0].scans > 0.0; i++) {
        const struct air_alarm_result *of = &report->alarms[i];
        cJSON *object = cJSON_CreateObject();
        json_add_number(object, "clutter_per_scan", air_alarms[i].clutter);
        json_add_number(object, "wanted_per_hour", air_alarms[i].wanted_per_hour);
        json_add_number(object, "scans", of->scans);
        json_add_number(object, "false_tracks", of->confirmed);
        json_add_number(object, "per_hour", of->confirmed / of->hours);
        json_add_number(object, "scan_us", of->us);
        cJSON_AddItemToArray(list, object);
    }
}

static void rivals_to_json(const struct air_report *report, cJSON *root)
{
    cJSON *list = cJSON_AddArrayToObject(root, "rivals");

    for (size_t i = 0;
         i < AIR_RIVALS && (report->parts & AIR_PART_RIVALS) != 0 && report->rivals.missing == NULL;
         i++) {
        const struct air_rival *of = &report->rivals.others[i];
        cJSON *object = figures_json(&of->figures);
        cJSON_AddStringToObject(object, "tracker", of->name);
        json_add_number(object, "scan_us", of->us);
        cJSON_AddItemToArray(list, object);
    }
}

static void print_as_json(struct air_report *report)
{
    cJSON *root = json_experiment("air-traffic", report->num_runs, report->seed);

    cases_to_json(report, root);
    pairs_to_json(report, root);
    clutter_to_json(report, root);
    rivals_to_json(report, root);
    verdicts_to_json(&report->verdicts, root);
    json_print(root);
}

/* ---- tables ---------------------------------------------------------------------------------- */

static void print_tables(const struct air_report *report)
{
    struct air_table tables[AIR_TABLES];
    size_t count = air_tables(report, tables);

    printf("Air traffic over 500 x 500 km, a scan every 10 s, sigma 50 m, P_D 0.95: %zu runs, seed "
           "%llu\n",
           report->num_runs, (unsigned long long)report->seed);
    for (size_t i = 0; i < count; i++) {
        printf("\n%s\n%s\n\n", tables[i].heading, tables[i].text);
        grid_print(&tables[i].grid, stdout);
        grid_free(&tables[i].grid);
    }
    printf("\n");
    verdicts_print(&report->verdicts, stdout);
}

int experiment_air_traffic(const struct command_line *line)
{
    size_t num_runs = line->runs > 0 ? (size_t)line->runs : DEFAULT_RUNS;
    unsigned parts = line->method != NULL ? air_part_named(line->method) : AIR_PART_ALL;
    const char *folder = line->output != NULL ? line->output : "build/experiment/air-traffic";
    struct air_report report = air_measure(line->seed, num_runs, parts, folder);

    air_judge(&report);
    air_page(&report, folder);
    if (line->json) {
        print_as_json(&report);
    } else {
        print_tables(&report);
    }
    air_report_free(&report);
    return 0;
}
