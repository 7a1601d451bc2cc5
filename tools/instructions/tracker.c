/* SPDX-License-Identifier: MIT */
/*
 * tracker: whole steps of a tracker that maintains eight tracks, for tools/instructions.sh to count the instructions of:
 * prediction, gates, assignment, updates, report; no initiation.
 *
 * Arguments: the gate (best, hough or nearest); polar (a radar's plots of 15 m x 3 mrad in range and azimuth, with range
 * rates) or cartesian (positions and velocities with isotropic noise); the plots of each target; sectors of a turn, a step
 * each. The target's own plot comes with clutter around it, 1.5 to 2.5 standard deviations off on each axis: in the gate,
 * and seldom the nearest. Prints tracks and plots a turn.
 */
#include <stdlib.h>
#include <string.h>

#include "count.h"
#include "draw.h"
#include "rhotrack/angle.h"
#include "rhotrack/approx.h"
#include "rhotrack/measurement.h"
#include "rhotrack/tracker.h"

#define TARGETS 8
#define EACH_MAX 10
#define START_TURNS 10
#define SECTORS_MAX 64
#define TURNS 100 /* the mean of whole numbers has two decimals */
#define INTERVAL_S 1.0f
#define SIGMA_RANGE_M 15.0f
#define SIGMA_RAD 0.003f
#define SIGMA_RATE_MPS 1.0f
#define SIGMA_M 10.0f
#define SIGMA_MPS 1.0f

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;
static struct rho_plot plots[TARGETS * EACH_MAX], looked_at[TARGETS * EACH_MAX];
static const struct rho_sensor sensor = {.sensor_id = 1, .pd = 0.95f, .range_max_m = 1e5f};

static int failed;

struct target {
    float x_m, y_m, vx_mps, vy_mps;
};

/* On a ring about the radar, flying round it. */
static struct target target_at(int target, float t_s)
{
    float bearing_rad = RHO_PI / 4.0f * ((float)target + 0.5f), range_m = 30000.0f;
    float vx_mps = -200.0f * rho_sin(bearing_rad), vy_mps = 200.0f * rho_cos(bearing_rad);
    return (struct target){range_m * rho_cos(bearing_rad) + vx_mps * t_s,
                           range_m * rho_sin(bearing_rad) + vy_mps * t_s, vx_mps, vy_mps};
}

/* The noise of the target's own plot; of clutter far enough out. */
static float off(int is_clutter, float sigma)
{
    float size = is_clutter ? draw_uniform(1.5f, 2.5f) : 0.0f;
    return is_clutter ? (draw_uniform(-1.0f, 1.0f) < 0.0f ? -size : size) * sigma
                      : draw_normal(sigma);
}

static struct rho_plot polar_plot(const struct target *target, int is_clutter)
{
    float range_m = rho_sqrt(target->x_m * target->x_m + target->y_m * target->y_m);
    struct rho_polar_plot polar = {
        .range_m = range_m + off(is_clutter, SIGMA_RANGE_M),
        .azimuth_rad =
            rho_angle_wrap(rho_atan2(target->y_m, target->x_m) + off(is_clutter, SIGMA_RAD)),
        .range_rate_mps = (target->x_m * target->vx_mps + target->y_m * target->vy_mps) / range_m +
                          off(is_clutter, SIGMA_RATE_MPS),
        .sigma_range_m = SIGMA_RANGE_M,
        .sigma_azimuth_rad = SIGMA_RAD,
        .sigma_range_rate_mps = SIGMA_RATE_MPS};
    struct rho_plot plot = {0};
    failed |= rho_measurement_from_polar(&polar, RHO_MEASURES_RANGE_RATE, &sensor, &plot) != RHO_OK;
    return plot;
}

static struct rho_plot cartesian_plot(const struct target *target, int is_clutter)
{
    return (struct rho_plot){.x_m = target->x_m + off(is_clutter, SIGMA_M),
                             .y_m = target->y_m + off(is_clutter, SIGMA_M),
                             .z_m = 3000.0f + off(is_clutter, SIGMA_M),
                             .vx_mps = target->vx_mps + off(is_clutter, SIGMA_MPS),
                             .vy_mps = target->vy_mps + off(is_clutter, SIGMA_MPS),
                             .vz_mps = off(is_clutter, SIGMA_MPS),
                             .sigma_range_m = SIGMA_M,
                             .sigma_cross_m = SIGMA_M,
                             .sigma_up_m = SIGMA_M,
                             .sigma_mps = SIGMA_MPS};
}

static struct rho_scan draw_scan(int step, int is_polar, int each)
{
    for (int i = 0; i < TARGETS; i++) {
        struct target target = target_at(i, INTERVAL_S * (float)step);
        for (int k = 0; k < each; k++) {
            plots[each * i + k] =
                is_polar ? polar_plot(&target, k > 0) : cartesian_plot(&target, k > 0);
        }
    }
    return (struct rho_scan){.time_us = (int64_t)(1e6f * INTERVAL_S) * step,
                             .sensor_id = sensor.sensor_id,
                             .measures = is_polar ? RHO_MEASURES_RANGE_RATE
                                                  : RHO_MEASURES_Z | RHO_MEASURES_VELOCITY,
                             .num_plots = (uint32_t)(TARGETS * each),
                             .plots = plots};
}

static int open_tracker(const char *gate)
{
    struct rho_tracker_config config;
    struct rho_initiator_config start;
    rho_tracker_config_default(&config);
    rho_initiator_config_default(&start);
    config.gate = strcmp(gate, "hough") == 0     ? RHO_TRACKER_HOUGH
                  : strcmp(gate, "nearest") == 0 ? RHO_TRACKER_NEAREST
                                                 : RHO_TRACKER_BEST;
    config.input.is_estimated = config.gate == RHO_TRACKER_HOUGH;
    return rho_tracker_init(&tracker, sizeof tracker, &config) != RHO_OK ||
           rho_initiator_init(&initiator, sizeof initiator, &start) != RHO_OK ||
           rho_tracker_set_sensor(&tracker, &sensor) != RHO_OK;
}

/* The part of a turn that the radar looks at in one of so many sectors. */
static struct rho_scan sector_of(const struct rho_scan *turn, int sector, int sectors)
{
    struct rho_scan scan = *turn;
    const float width_rad = RHO_TWO_PI / (float)sectors;
    if (sectors == 1) {
        return scan;
    }
    scan.time_us += (int64_t)(1e6f * INTERVAL_S) * sector / sectors;
    scan.sector_from_rad = width_rad * (float)sector - RHO_PI;
    scan.sector_to_rad = width_rad * (float)(sector + 1) - RHO_PI;
    scan.plots = looked_at;
    scan.num_plots = 0;
    for (uint32_t i = 0; i < turn->num_plots; i++) {
        float azimuth_rad = rho_atan2(turn->plots[i].y_m, turn->plots[i].x_m);
        if (azimuth_rad >= scan.sector_from_rad && azimuth_rad < scan.sector_to_rad) {
            looked_at[scan.num_plots++] = turn->plots[i];
        }
    }
    return scan;
}

static void step(const struct rho_scan *scan, int is_start)
{
    if (is_start) {
        failed |= rho_tracker_step(&tracker, &initiator, scan, &report) != RHO_OK;
        return;
    }
    count_begin();
    failed |= rho_tracker_step(&tracker, NULL, scan, &report) != RHO_OK;
    count_end();
}

int main(int argc, char **argv)
{
    int each = argc == 5 ? atoi(argv[3]) : 0, sectors = argc == 5 ? atoi(argv[4]) : 0;
    uint32_t tracks = 0;
    if (each < 1 || each > EACH_MAX || sectors < 1 || sectors > SECTORS_MAX) {
        fprintf(stderr,
                "tracker: give a gate, polar or cartesian, 1 .. %d plots, 1 .. %d sectors\n",
                EACH_MAX, SECTORS_MAX);
        return 2;
    }
    failed = open_tracker(argv[1]);
    for (int turn = 0; turn < START_TURNS + TURNS && !failed; turn++) {
        int is_start = turn < START_TURNS;
        struct rho_scan whole = draw_scan(turn, strcmp(argv[2], "polar") == 0, is_start ? 1 : each);
        for (int sector = 0; sector < (is_start ? 1 : sectors); sector++) {
            struct rho_scan scan = sector_of(&whole, sector, is_start ? 1 : sectors);
            step(&scan, is_start);
        }
        tracks += is_start ? 0 : report.num_tracks;
    }
    printf("%lu.%02lu tracks, %d plots\n", (unsigned long)tracks / TURNS,
           (unsigned long)tracks % TURNS, TARGETS * each);
    count_report();
    return failed;
}
