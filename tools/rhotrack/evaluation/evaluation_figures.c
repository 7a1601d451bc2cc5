/* SPDX-License-Identifier: MIT */
#include "evaluation/evaluation_figures.h"

#include <math.h>
#include <stdbool.h>

#include "evaluation/evaluation_parts.h"

static void add(struct evaluation_figures *figures, const char *name, double value)
{
    figures->list[figures->count].name = name;
    figures->list[figures->count++].value = value;
}

static void add_count(struct evaluation_figures *figures, const char *name, size_t count)
{
    add(figures, name, (double)count);
}

static void add_time(struct evaluation_figures *figures, const char *name, int64_t time_us)
{
    add(figures, name, (double)time_us * 1e-6);
}

static void add_errors(struct evaluation_figures *figures, const struct evaluation_errors *errors)
{
    add(figures, "rmse_m", errors->rmse_m);
    add(figures, "median_m", errors->median_m);
    add(figures, "p95_m", errors->p95_m);
    add(figures, "rmse_mps", errors->rmse_mps);
    add(figures, "median_mps", errors->median_mps);
    add(figures, "p95_mps", errors->p95_mps);
    add(figures, "nees", errors->nees);
    add(figures, "nees_inside", errors->nees_inside);
    add(figures, "place_ratio", errors->nees / EVALUATION_AXES);
    add(figures, "velocity_ratio", errors->velocity_ratio);
    add(figures, "velocity_inside", errors->velocity_inside);
}

struct evaluation_figures evaluation_figures_all(const struct evaluation_result *result)
{
    struct evaluation_figures figures = {0};
    add(&figures, "gospa_m", result->gospa_m);
    add(&figures, "gospa_localisation_m", result->gospa_localisation_m);
    add(&figures, "gospa_missed", result->gospa_missed);
    add(&figures, "gospa_false", result->gospa_false);
    add(&figures, "ospa_m", result->ospa_m);
    add(&figures, "completeness", result->completeness);
    add(&figures, "completeness_once_found", result->completeness_once_found);
    add(&figures, "false_per_scan", result->false_per_scan);
    add(&figures, "false_per_hour", result->false_per_hour);
    add_count(&figures, "switches", result->switches);
    add_count(&figures, "fragments", result->fragments);
    add(&figures, "delay_scans", result->delay_scans);
    add(&figures, "delay_s", result->delay_s);
    add_errors(&figures, &result->errors);
    add_count(&figures, "targets", result->targets);
    add_count(&figures, "targets_found", result->targets_found);
    add_count(&figures, "tracks", result->tracks);
    add_count(&figures, "false_tracks", result->false_tracks);
    add_count(&figures, "pairs", result->errors.pairs);
    add_count(&figures, "scans", result->scans);
    add_time(&figures, "first_s", result->first_us);
    add_time(&figures, "last_s", result->last_us);
    return figures;
}

struct evaluation_figures evaluation_figures_target(const struct evaluation_target *target)
{
    struct evaluation_figures figures = {0};
    bool is_found = target->paired > 0;
    add(&figures, "target_id", target->id);
    add_time(&figures, "first_s", target->first_us);
    add_time(&figures, "last_s", target->last_us);
    add(&figures, "found_s", is_found ? (double)target->found_us * 1e-6 : NAN);
    add(&figures, "kept_until_s", is_found ? (double)target->kept_until_us * 1e-6 : NAN);
    add_count(&figures, "scans", target->scans);
    add(&figures, "completeness", (double)target->paired / (double)target->scans);
    add_count(&figures, "switches", target->switches);
    add_count(&figures, "fragments", target->fragments);
    add(&figures, "delay_scans", is_found ? (double)target->delay_scans : NAN);
    add_errors(&figures, &target->errors);
    return figures;
}

struct evaluation_figures evaluation_figures_motion(const struct evaluation_errors *errors)
{
    struct evaluation_figures figures = {0};
    add_count(&figures, "pairs", errors->pairs);
    add_errors(&figures, errors);
    return figures;
}

struct evaluation_figures evaluation_figures_scan(const struct evaluation_scan *scan)
{
    struct evaluation_figures figures = {0};
    add_time(&figures, "t_s", scan->time_us);
    add_count(&figures, "targets", scan->targets);
    add_count(&figures, "tracks", scan->tracks);
    add_count(&figures, "pairs", scan->pairs);
    add(&figures, "gospa_m", scan->gospa_m);
    add(&figures, "gospa_localisation_m", sqrt(scan->localisation_m2));
    add_count(&figures, "gospa_missed", scan->targets - scan->pairs);
    add_count(&figures, "gospa_false", scan->tracks - scan->pairs);
    add(&figures, "ospa_m", scan->ospa_m);
    add_count(&figures, "switches", scan->switches);
    add_count(&figures, "fragments", scan->fragments);
    add(&figures, "rmse_m", scan->rmse_m);
    add(&figures, "rmse_mps", scan->rmse_mps);
    add(&figures, "nees", scan->nees);
    add(&figures, "velocity_ratio", scan->velocity_ratio);
    return figures;
}
