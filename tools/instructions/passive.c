/* SPDX-License-Identifier: MIT */
/*
 * passive: searches of a full batch of bearings; tools/gates/instructions.sh counts their
 * instructions. Three sensors give eight frames 10 s apart, with a bearing noise of 0.1 degrees.
 * Arguments: the number of targets; false bearings a look; batches, each with other bearings.
 * Prints the tracks and the fits of the last search.
 */
#include <stdlib.h>
#include <string.h>

#include "count.h"
#include "random_draws.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/passive.h"

#define SENSORS 3
#define FRAMES 8
#define TARGETS_MAX 8
#define INTERVAL_S 10.0f
#define SIGMA_RAD 0.00174533f
#define PD 0.9f

static struct rho_passive passive;
static struct rho_bearing bearings[SENSORS][RHO_MAX_BEARINGS];
static struct rho_bearing_scan scans[SENSORS];
static struct target {
    float x_m, y_m, vx_mps, vy_mps;
} targets[TARGETS_MAX];

static void draw_targets(int count)
{
    for (int i = 0; i < count; i++) {
        targets[i] = (struct target){.x_m = draw_uniform(30000.0f, 70000.0f),
                                     .y_m = draw_uniform(-30000.0f, 30000.0f),
                                     .vx_mps = draw_uniform(-250.0f, -150.0f),
                                     .vy_mps = draw_uniform(-150.0f, 150.0f)};
    }
}

static void add_bearing(struct rho_bearing_scan *scan, int sensor, float bearing_rad)
{
    if (scan->num_bearings < RHO_MAX_BEARINGS) {
        bearings[sensor][scan->num_bearings++] =
            (struct rho_bearing){.bearing_rad = bearing_rad, .sigma_rad = SIGMA_RAD};
    }
}

static struct rho_frame draw_frame(int frame, int num_targets, int num_false)
{
    const float t_s = INTERVAL_S * (float)frame;
    const int64_t time_us = (int64_t)(1e6f * INTERVAL_S) * frame;
    for (int sensor = 0; sensor < SENSORS; sensor++) {
        struct rho_bearing_scan *scan = &scans[sensor];
        *scan = (struct rho_bearing_scan){.time_us = time_us,
                                          .sensor_id = sensor + 1,
                                          .y_m = 10000.0f * (float)(sensor - 1),
                                          .bearings = bearings[sensor]};
        for (int i = 0; i < num_targets; i++) {
            const struct target *at = &targets[i];
            float true_rad =
                rho_atan2(at->y_m + at->vy_mps * t_s - scan->y_m, at->x_m + at->vx_mps * t_s);
            if (draw_uniform(0.0f, 1.0f) < PD) {
                add_bearing(scan, sensor, true_rad + draw_normal(SIGMA_RAD));
            }
        }
        for (int i = 0; i < num_false; i++) {
            add_bearing(scan, sensor, draw_uniform(-1.2f, 1.2f));
        }
    }
    return (struct rho_frame){.time_us = time_us, .num_scans = SENSORS, .scans = scans};
}

static int fill_bearing_batch(int num_targets, int num_false)
{
    struct rho_passive_config config;
    uint8_t fates[SENSORS * RHO_MAX_BEARINGS];
    int failed;
    rho_passive_config_default(&config);
    failed = rho_passive_init(&passive, sizeof passive, &config) != RHO_OK;
    draw_targets(num_targets);
    for (int frame = 0; frame < FRAMES; frame++) {
        struct rho_frame from = draw_frame(frame, num_targets, num_false);
        memset(fates, RHO_FATE_HELD, sizeof fates);
        failed |= rho_passive_push(&passive, &from, fates) != RHO_OK;
    }
    return failed;
}

int main(int argc, char **argv)
{
    int num_targets = argc == 4 ? atoi(argv[1]) : -1, batches = argc == 4 ? atoi(argv[3]) : 0,
        failed = 0;
    if (num_targets < 0 || num_targets > TARGETS_MAX || batches < 1) {
        fprintf(stderr, "passive: give 0 .. %d targets, false bearings a look, batches\n",
                TARGETS_MAX);
        return 2;
    }
    for (int i = 0; i < batches && !failed; i++) {
        failed = fill_bearing_batch(num_targets, atoi(argv[2]));
        count_begin();
        failed |= rho_passive_search(&passive) != RHO_OK;
        count_end();
    }
    printf("%u tracks, %lu fits\n", (unsigned)passive.num_tracks, (unsigned long)passive.work.fits);
    count_print_totals();
    return failed;
}
