/* SPDX-License-Identifier: MIT */
/*
 * experiment_polar_track: the tracker over all turns, and beside each track a reference filter that
 * takes the same plots.
 */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "double_filter.h"
#include "experiment_polar.h"

/*
 * What the tool knows of a track: whose plots it took, and the reference filter through the same
 * plots.
 */
struct shadow {
    uint32_t track_id;
    bool is_confirmed, is_counted;
    int plots, target_plots; /* taken, and of these the target's */
    int target;              /* of its last target plot; -1: none yet */
    struct double_filter filter;
};

#define SHADOWS_MAX 256

struct shadowing {
    const struct polar_case *of;
    const struct simulation *simulation;
    struct pipeline *chain;
    struct polar_result *result;
    struct scenario_radar radar; /* range rate as the case has it */
    double noise_density, speed_sigma_mps;
    size_t num_shadows;
    struct shadow shadows[SHADOWS_MAX];
};

static void take(struct shadowing *all, struct shadow *shadow, size_t turn, size_t row)
{
    const struct simulated_scan *scan = &all->simulation->scans[turn];
    const struct simulated_plot *plot = &scan->plots[row];
    double t_s = scan->t_s + plot->offset_s;
    if (shadow->plots++ == 0) {
        shadow->filter = double_filter_open(&all->radar, t_s, plot, all->speed_sigma_mps);
    } else {
        double_filter_predict(&shadow->filter, t_s, all->noise_density);
        double_filter_update(&shadow->filter, &all->radar, plot);
    }
    if (plot->target_id >= 0) {
        shadow->target = plot->target_id;
        shadow->target_plots++;
    }
}

static struct shadow *shadow_of(struct shadowing *all, uint32_t track_id)
{
    for (size_t i = 0; i < all->num_shadows; i++) {
        if (all->shadows[i].track_id == track_id) {
            return &all->shadows[i];
        }
    }
    return NULL;
}

/*
 * The candidate that a new track came from, by the newest turn's row; its plots in the order of
 * time.
 */
static void take_start(struct shadowing *all, struct shadow *shadow, size_t turn, int newest_row)
{
    struct rho_initiator *initiator = all->chain->initiator;
    unsigned last = initiator->window.num_scans - 1u;
    for (unsigned i = 0; i < initiator->num_candidates; i++) {
        const struct rho_candidate *from = &initiator->candidates[i];
        const struct rho_window_scan *newest = rho_window_scan_at(&initiator->window, last);
        if ((newest->marks[from->plot[last]] & RHO_WINDOW_ROW) != (unsigned)newest_row) {
            continue;
        }
        for (unsigned m = 0; m <= last; m++) {
            const struct rho_window_scan *scan = rho_window_scan_at(&initiator->window, m);
            if ((unsigned)from->mask >> m & 1u) {
                take(all, shadow, turn + m - last, scan->marks[from->plot[m]] & RHO_WINDOW_ROW);
            }
        }
        return;
    }
}

/*
 * After its own predictions the reference goes back to the turn's time without noise, as the report
 * does.
 */
static void compare(struct shadowing *all, const struct shadow *shadow,
                    const struct rho_track_report *report, size_t turn)
{
    double t_s = all->simulation->scans[turn].t_s;
    struct polar_errors *errors = &all->result->errors;
    struct double_filter at = shadow->filter;
    struct truth_point truth = polar_truth(all->simulation, (size_t)shadow->target, t_s);
    double_filter_predict(&at, t_s, all->noise_density);
    double dx_m = report->state[0] - truth.x_m, dy_m = report->state[1] - truth.y_m;
    double range_m = hypot(truth.x_m, truth.y_m);
    errors->sum_m2[turn] += dx_m * dx_m + dy_m * dy_m;
    errors->along_m2[turn] += pow((dx_m * truth.x_m + dy_m * truth.y_m) / range_m, 2.0);
    errors->reference_m2[turn] +=
        pow(at.state[0] - truth.x_m, 2.0) + pow(at.state[1] - truth.y_m, 2.0);
    errors->sum_m2ps2[turn] +=
        pow(report->state[3] - truth.vx_mps, 2.0) + pow(report->state[4] - truth.vy_mps, 2.0);
    errors->count[turn]++;
}

static bool is_targets(const struct shadow *shadow)
{
    return 2 * shadow->target_plots > shadow->plots;
}

static void follow(struct shadowing *all, const struct rho_track_report *report, size_t turn)
{
    struct shadow *shadow = shadow_of(all, report->track_id);
    if (shadow == NULL) {
        if (all->num_shadows == SHADOWS_MAX) {
            fail(EXIT_RUNTIME, "more than %d tracks in a run", SHADOWS_MAX);
        }
        shadow = &all->shadows[all->num_shadows++];
        *shadow = (struct shadow){.track_id = report->track_id, .target = -1};
        take_start(all, shadow, turn, report->plot);
    } else if (report->plot >= 0) {
        take(all, shadow, turn, (size_t)report->plot);
    } else {
        double_filter_predict(&shadow->filter, all->simulation->scans[turn].t_s,
                              all->noise_density);
    }
    if (report->status == RHO_TRACK_TENTATIVE) {
        return;
    }
    if (!shadow->is_confirmed) {
        shadow->is_confirmed = true;
        all->result->confirmed += is_targets(shadow);
        all->result->confirm_at += is_targets(shadow) ? (double)turn + 1.0 : 0.0;
    }
    if (is_targets(shadow)) {
        compare(all, shadow, report, turn);
    }
}

/* Targets with a confirmed track in the report. */
static int count_tracked(struct shadowing *all)
{
    bool is_tracked[POLAR_TARGETS_MAX] = {false};
    int tracked = 0;
    for (unsigned i = 0; i < all->chain->report->num_tracks; i++) {
        const struct rho_track_report *report = &all->chain->report->tracks[i];
        const struct shadow *shadow = shadow_of(all, report->track_id);
        if (report->status != RHO_TRACK_TENTATIVE && is_targets(shadow)) {
            tracked += !is_tracked[shadow->target];
            is_tracked[shadow->target] = true;
        }
    }
    return tracked;
}

static void count_tracks(struct shadowing *all)
{
    all->result->tracked = count_tracked(all);
    for (size_t i = 0; i < all->num_shadows; i++) {
        all->result->false_tracks += all->shadows[i].is_confirmed && !is_targets(&all->shadows[i]);
    }
}

void polar_track(const struct polar_case *of, const struct parameters *parameters,
                 const struct simulation *simulation, struct pipeline *chain,
                 struct polar_result *result)
{
    struct rho_tracker_config config;
    parameters_to_tracker(parameters, &config);
    pipeline_open(chain, parameters);
    if (of->span_mps > 0.0) {
        struct rho_sensor sensor = polar_sensor(of, parameters);
        must_succeed(rho_tracker_set_sensor(chain->tracker, &sensor), "sensor");
    }
    struct shadowing *all = must_calloc(1, sizeof *all);
    double accel_mps2 = 0.5 * config.accel_max_mps2; /* src/DESIGN.md: kept up for a second */
    *all = (struct shadowing){.of = of,
                              .simulation = simulation,
                              .chain = chain,
                              .result = result,
                              .radar = simulation->radar,
                              .noise_density = accel_mps2 * accel_mps2,
                              .speed_sigma_mps = config.v_max_mps};
    all->radar.has_range_rate = of->has_range_rate;
    for (size_t turn = 0; turn < simulation->num_scans; turn++) {
        struct rho_scan scan = polar_scan(of, simulation, turn, chain->plots);
        pipeline_step(chain, &scan);
        for (unsigned i = 0; i < chain->report->num_tracks; i++) {
            follow(all, &chain->report->tracks[i], turn);
        }
        if (turn + 1 == POLAR_PROMPT) {
            result->prompt = count_tracked(all);
        }
    }
    count_tracks(all);
    free(all);
}
