/* SPDX-License-Identifier: MIT */
/* experiment_air_traffic_tables: the figures as tables. */
#include <math.h>

#include "experiment_air_traffic.h"

static bool has(const struct air_report *report, unsigned part)
{
    return (report->parts & part) != 0;
}

static double ratio(const struct air_result *of, size_t cutoff)
{
    return of->tracks[cutoff].gospa_m / of->limit[cutoff].gospa_m;
}

static struct grid traffic_grid(const struct air_report *report, enum air_group group)
{
    struct grid grid =
        grid_start(1, "case|aircraft|clutter|gospa m|localisation|missed|false|limit m|ratio|at "
                      "200 m|limit|ratio|"
                      "complete|limit|switches|fragments|delay|M|ms a scan|longest");

    for (size_t i = 0; i < air_num_cases(); i++) {
        const struct air_case *of = &air_cases[i];
        const struct air_result *result = &report->results[i];
        const struct air_figures *tracks = &result->tracks[0];
        if (of->group != group) {
            continue;
        }
        grid_row(
            &grid,
            "%s|%g|%g|%.0f|%.0f|%.3f|%.3f|%.0f|%.3f|%.0f|%.0f|%.3f|%.4f|%.4f|%.1f|%.1f|%.2f|%.1f|"
            "%.2f|%.1f",
            of->name, of->targets, of->clutter, tracks->gospa_m, tracks->localisation_m,
            tracks->missed, tracks->false_a_scan, result->limit[0].gospa_m, ratio(result, 0),
            result->tracks[1].gospa_m, result->limit[1].gospa_m, ratio(result, 1),
            tracks->completeness, result->limit[0].completeness, tracks->switches,
            tracks->fragments, tracks->delay_scans, result->min_scans, result->us / 1e3,
            result->max_us / 1e3);
    }
    return grid;
}

static struct grid parts_grid(const struct air_report *report)
{
    struct grid grid =
        grid_start(1, "case|aircraft|clutter|missed|limit|false|limit|localisation m|limit|rmse m|"
                      "limit|nees|limit|inside|velocity ratio|limit|inside|delay|limit");

    for (size_t i = 0; i < air_num_cases(); i++) {
        const struct air_case *of = &air_cases[i];
        const struct air_figures *tracks = &report->results[i].tracks[0];
        const struct air_figures *limit = &report->results[i].limit[0];
        if (of->group != AIR_GRID) {
            continue;
        }
        grid_row(&grid,
                 "%s|%g|%g|%.3f|%.3f|%.3f|%.3f|%.0f|%.0f|%.1f|%.1f|%.2f|%.2f|%.3f|%.2f|%.2f|%.3f|%."
                 "2f|%.2f",
                 of->name, of->targets, of->clutter, tracks->missed, limit->missed,
                 tracks->false_a_scan, limit->false_a_scan, tracks->localisation_m,
                 limit->localisation_m, tracks->rmse_m, limit->rmse_m, tracks->nees, limit->nees,
                 tracks->nees_inside, tracks->velocity_ratio, limit->velocity_ratio,
                 tracks->velocity_inside, tracks->delay_scans, limit->delay_scans);
    }
    return grid;
}

static struct grid operation_grid(const struct air_report *report)
{
    struct grid grid = grid_start(0, "wanted an hour|in clutter alone|false tracks an hour|false a "
                                     "scan|M|found by scan 3|4|5|6|8|"
                                     "10|complete|gospa m");
    static const size_t by[] = {3, 4, 5, 6, 8, 10};

    for (size_t i = 0; i < air_num_cases(); i++) {
        const struct air_result *of = &report->results[i];
        double share[6];
        if (air_cases[i].group != AIR_OPERATION) {
            continue;
        }
        for (size_t k = 0; k < 6; k++) {
            share[k] = of->found[by[k] - 1] / of->alive[by[k] - 1];
        }
        grid_row(&grid, "%s|%.2f|%.1f|%.3f|%.1f|%.3f|%.3f|%.3f|%.3f|%.3f|%.3f|%.4f|%.0f",
                 air_cases[i].name, of->alarms / of->alarm_hours, of->false_tracks / of->hours,
                 of->tracks[0].false_a_scan, of->min_scans, share[0], share[1], share[2], share[3],
                 share[4], share[5], of->tracks[0].completeness, of->tracks[0].gospa_m);
    }
    return grid;
}

static struct grid pairs_grid(const struct air_report *report)
{
    struct grid grid = grid_start(
        1,
        "two aircraft|runs|no switch|switches a run|a track is missing at the last four|complete");

    for (size_t i = 0; i < AIR_PAIRS; i++) {
        grid_row(&grid, "%s|%zu|%.3f|%.2f|%.3f|%.4f", air_pairs[i].name, report->pair_runs,
                 report->pairs[i].kept, report->pairs[i].switches, report->pairs[i].lost,
                 report->pairs[i].completeness);
    }
    return grid;
}

static struct grid clutter_grid(const struct air_report *report)
{
    struct grid grid = grid_start(
        0,
        "clutter a scan|wanted an hour|scans|hours|false tracks|an hour|95 % limits|M|ms a scan");

    for (size_t i = 0; i < AIR_ALARMS; i++) {
        const struct air_alarm_result *of = &report->alarms[i];
        grid_row(&grid, "%g|%g|%.0f|%.1f|%.0f|%.2f|%.2f .. %.2f|%.2f|%.2f", air_alarms[i].clutter,
                 air_alarms[i].wanted_per_hour, of->scans, of->hours, of->confirmed,
                 of->confirmed / of->hours, of->low_per_hour, of->high_per_hour, of->min_scans,
                 of->us / 1e3);
    }
    return grid;
}

static void rival_row(struct grid *grid, const struct air_rival *of, const struct air_rival *own)
{
    grid_row(grid, "%s|%.0f|%.0f|%.3f|%.3f|%.4f|%.1f|%.2f|%.3f|%.3f|%.0f", of->name,
             of->figures.gospa_m, of->figures.localisation_m, of->figures.missed,
             of->figures.false_a_scan, of->figures.completeness, of->figures.switches,
             of->figures.delay_scans, of->us / 1e3, own->figures.gospa_m / of->figures.gospa_m,
             of->us / own->us);
}

static struct grid rivals_grid(const struct air_report *report)
{
    struct grid grid =
        grid_start(1, "tracker|gospa m|localisation|missed|false|complete|switches|delay|"
                      "ms a scan|rhotrack's gospa over it|its time over rhotrack's");

    rival_row(&grid, &report->rivals.own, &report->rivals.own);
    for (size_t i = 0; i < AIR_RIVALS && report->rivals.missing == NULL; i++) {
        rival_row(&grid, &report->rivals.others[i], &report->rivals.own);
    }
    return grid;
}

size_t air_tables(const struct air_report *report, struct air_table tables[AIR_TABLES])
{
    size_t count = 0;

    if (has(report, AIR_PART_GRID)) {
        tables[count++] = (struct air_table){"Aircraft and clutter",
                                             "GOSPA (p 2, alpha 2) with a cutoff of 1 km and, "
                                             "further right, 200 m; missed and false: a "
                                             "scan. Limit: the same filter and the same rules with "
                                             "true association. Delay: scans of "
                                             "an aircraft before it has a track. M: hits in 7 "
                                             "scans that start a track. Time: mean of "
                                             "the fastest run.",
                                             traffic_grid(report, AIR_GRID)};
        tables[count++] = (struct air_table){
            "Parts of GOSPA",
            "Beside the limit's. Nees: of places, 2 where the covariance is right.",
            parts_grid(report)};
    }
    if (has(report, AIR_PART_STRESS)) {
        tables[count++] = (struct air_table){
            "What else goes wrong",
            "50 aircraft, 100 clutter plots a scan, and:", traffic_grid(report, AIR_STRESS)};
    }
    if (has(report, AIR_PART_OPERATION)) {
        tables[count++] =
            (struct air_table){"Detection against false tracks",
                               "50 aircraft, 1000 clutter plots a scan, false_tracks_per_hour "
                               "varied. False tracks an hour: "
                               "confirmed ones in the same clutter alone; and with the aircraft, "
                               "those that have none in "
                               "more than half of their scans. Found by scan k of their life.",
                               operation_grid(report)};
    }
    if (has(report, AIR_PART_PAIRS)) {
        tables[count++] = (struct air_table){
            "Pairs",
            "0.004 clutter plots a km^2. Parallel for 5 minutes, all the time or after they met "
            "and before they "
            "part at 10 degrees. Scans at which those that cross or meet are within 395 m do not "
            "count: who is who is not to be seen there.",
            pairs_grid(report)};
    }
    if (has(report, AIR_PART_CLUTTER)) {
        tables[count++] = (struct air_table){"Clutter alone",
                                             "Every confirmed track is false. 100 000 scans of "
                                             "each: `rhotrack experiment air-traffic "
                                             "--method clutter --runs 200`.",
                                             clutter_grid(report)};
    }
    if (has(report, AIR_PART_RIVALS)) {
        tables[count++] = (struct air_table){
            "Beside Stone Soup",
            report->rivals.missing != NULL
                ? report->rivals.missing
                : "The same plots: 50 aircraft, 100 clutter plots a scan, 120 scans; two runs at "
                  "most. Stone Soup as "
                  "tests/bench/air_traffic_stonesoup.py sets it up, which is best for such plots.",
            rivals_grid(report)};
    }
    return count;
}
