/* SPDX-License-Identifier: MIT */
#include "evaluation/evaluation_figures.h"

#include <math.h>
#include <stdbool.h>

#include "evaluation/evaluation_state.h"

static void add_figure(struct evaluation_figures *figures, const char *name, double value)
{
    figures->list[figures->count].name = name;
    figures->list[figures->count++].value = value;
}

static void add_count_figure(struct evaluation_figures *figures, const char *name, size_t count)
{
    add_figure(figures, name, (double)count);
}

static void add_time_figure(struct evaluation_figures *figures, const char *name, int64_t time_us)
{
    add_figure(figures, name, (double)time_us * 1e-6);
}

static void add_error_figures(struct evaluation_figures *figures,
                              const struct evaluation_errors *errors)
{
    add_figure(figures, "rmse_m", errors->rmse_m);
    add_figure(figures, "median_m", errors->median_m);
    add_figure(figures, "p95_m", errors->p95_m);
    add_figure(figures, "rmse_mps", errors->rmse_mps);
    add_figure(figures, "median_mps", errors->median_mps);
    add_figure(figures, "p95_mps", errors->p95_mps);
    add_figure(figures, "nees", errors->nees);
    add_figure(figures, "nees_inside", errors->nees_inside);
    add_figure(figures, "place_ratio", errors->nees / EVALUATION_AXES);
    add_figure(figures, "velocity_ratio", errors->velocity_ratio);
    add_figure(figures, "velocity_inside", errors->velocity_inside);
}

struct evaluation_figures evaluation_figures_overall(const struct evaluation_result *result)
{
    struct evaluation_figures figures = {0};
    add_figure(&figures, "gospa_m", result->gospa_m);
    add_figure(&figures, "gospa_localisation_m", result->gospa_localisation_m);
    add_figure(&figures, "gospa_missed", result->gospa_missed);
    add_figure(&figures, "gospa_false", result->gospa_false);
    add_figure(&figures, "ospa_m", result->ospa_m);
    add_figure(&figures, "completeness", result->completeness);
    add_figure(&figures, "completeness_once_found", result->completeness_once_found);
    add_figure(&figures, "false_per_scan", result->false_per_scan);
    add_figure(&figures, "false_per_hour", result->false_per_hour);
    add_count_figure(&figures, "switches", result->switches);
    add_count_figure(&figures, "fragments", result->fragments);
    add_figure(&figures, "delay_scans", result->delay_scans);
    add_figure(&figures, "delay_s", result->delay_s);
    add_error_figures(&figures, &result->errors);
    add_count_figure(&figures, "targets", result->targets);
    add_count_figure(&figures, "targets_found", result->targets_found);
    add_count_figure(&figures, "tracks", result->tracks);
    add_count_figure(&figures, "false_tracks", result->false_tracks);
    add_count_figure(&figures, "pairs", result->errors.pairs);
    add_count_figure(&figures, "scans", result->scans);
    add_time_figure(&figures, "first_s", result->first_us);
    add_time_figure(&figures, "last_s", result->last_us);
    return figures;
}

struct evaluation_figures evaluation_figures_target(const struct evaluation_target *target)
{
    struct evaluation_figures figures = {0};
    bool is_found = target->paired > 0;
    add_figure(&figures, "target_id", target->id);
    add_time_figure(&figures, "first_s", target->first_us);
    add_time_figure(&figures, "last_s", target->last_us);
    add_figure(&figures, "found_s", is_found ? (double)target->found_us * 1e-6 : NAN);
    add_figure(&figures, "kept_until_s", is_found ? (double)target->kept_until_us * 1e-6 : NAN);
    add_count_figure(&figures, "scans", target->scans);
    add_figure(&figures, "completeness", (double)target->paired / (double)target->scans);
    add_count_figure(&figures, "switches", target->switches);
    add_count_figure(&figures, "fragments", target->fragments);
    add_figure(&figures, "delay_scans", is_found ? (double)target->delay_scans : NAN);
    add_error_figures(&figures, &target->errors);
    return figures;
}

struct evaluation_figures evaluation_motion_figures(const struct evaluation_errors *errors)
{
    struct evaluation_figures figures = {0};
    add_count_figure(&figures, "pairs", errors->pairs);
    add_error_figures(&figures, errors);
    return figures;
}

struct evaluation_figures evaluation_figures_scan(const struct evaluation_scan *scan)
{
    struct evaluation_figures figures = {0};
    add_time_figure(&figures, "t_s", scan->time_us);
    add_count_figure(&figures, "targets", scan->targets);
    add_count_figure(&figures, "tracks", scan->tracks);
    add_count_figure(&figures, "pairs", scan->pairs);
    add_figure(&figures, "gospa_m", scan->gospa_m);
    add_figure(&figures, "gospa_localisation_m", sqrt(scan->localisation_m2));
    add_count_figure(&figures, "gospa_missed", scan->targets - scan->pairs);
    add_count_figure(&figures, "gospa_false", scan->tracks - scan->pairs);
    add_figure(&figures, "ospa_m", scan->ospa_m);
    add_count_figure(&figures, "switches", scan->switches);
    add_count_figure(&figures, "fragments", scan->fragments);
    add_figure(&figures, "rmse_m", scan->rmse_m);
    add_figure(&figures, "rmse_mps", scan->rmse_mps);
    add_figure(&figures, "nees", scan->nees);
    add_figure(&figures, "velocity_ratio", scan->velocity_ratio);
    return figures;
}
