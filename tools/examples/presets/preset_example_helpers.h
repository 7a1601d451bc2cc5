/* SPDX-License-Identifier: MIT */
/*
 * preset_example_helpers: shared by the six example programs in this folder: tracker and initiator,
 * the scan being filled, and a target whose plots have noise. Angles are in degrees as in data
 * sheets; azimuths clockwise from north.
 */
#include <math.h>
#include <stdio.h>

#include "rhotrack/rhotrack.h"

#define DEGREE 0.01745329252f
#define NUM_PLOTS 16

struct target {
    float x_m, y_m, z_m, vx_mps, vy_mps;
};

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;
static struct rho_settings settings;
static struct rho_sensor radar = {.sensor_id = 1};
static struct rho_plot plots[NUM_PLOTS];
static struct rho_scan scan = {.sensor_id = 1, .plots = plots};

/*
 * Checks the settings and initialises tracker and initiator with them and the radar; 0 where that
 * fails.
 */
static int init_tracking(void)
{
    struct rho_settings_fault fault;
    struct rho_tracker_config maintain;
    struct rho_initiator_config start;
    if (rho_settings_check(&settings, &fault) != RHO_OK) {
        printf("%s is %g, not %g .. %g\n", fault.field, (double)fault.value, (double)fault.min,
               (double)fault.max);
        return 0;
    }
    rho_tracker_config_default(&maintain);
    rho_initiator_config_default(&start);
    rho_settings_apply(&settings, &maintain, &start, NULL);
    rho_settings_apply_sensor(&settings, &radar);
    return rho_tracker_init(&tracker, sizeof tracker, &maintain) == RHO_OK &&
           rho_initiator_init(&initiator, sizeof initiator, &start) == RHO_OK &&
           rho_tracker_set_sensor(&tracker, &radar) == RHO_OK;
}

/* Random number in -1.7 .. 1.7 of variance close to 1, by a linear congruential generator. */
static float noise(void)
{
    static uint32_t seed = 1;
    seed = seed * 1664525u + 1013904223u;
    return (float)(seed >> 8) * (3.4f / 16777216.0f) - 1.7f;
}

/* Adds a plot with measured values to the scan; plots that cannot be converted are left out. */
static void add_measured_plot(float range_m, float azimuth_deg, float elevation_deg,
                              float range_rate_mps)
{
    struct rho_polar_plot polar = {.range_m = range_m,
                                   .azimuth_rad = remainderf(90.0f - azimuth_deg, 360.0f) * DEGREE,
                                   .elevation_rad = elevation_deg * DEGREE,
                                   .range_rate_mps = range_rate_mps};
    rho_settings_apply_noise(&settings, &polar);
    if (scan.num_plots < NUM_PLOTS &&
        rho_measurement_from_polar(&polar, scan.measures, &radar, &plots[scan.num_plots]) ==
            RHO_OK) {
        scan.num_plots++;
    }
}

/* Adds a plot of the target at a time to the scan, with the radar's biases and noise. */
static void add_target_plot(const struct target *target, float time_s)
{
    float x_m = target->x_m + target->vx_mps * time_s - radar.x_m;
    float y_m = target->y_m + target->vy_mps * time_s - radar.y_m;
    float z_m = target->z_m - radar.z_m, ground_m = hypotf(x_m, y_m);
    float range_m = scan.measures & RHO_MEASURES_Z ? hypotf(ground_m, z_m) : ground_m;
    float rate_mps = (x_m * target->vx_mps + y_m * target->vy_mps) / range_m +
                     settings.sigma_range_rate_mps * noise();
    if (radar.range_rate_span_mps > 0.0f) {
        rate_mps = remainderf(rate_mps, radar.range_rate_span_mps);
    }
    add_measured_plot(
        range_m + radar.range_bias_m + settings.sigma_range_m * noise(),
        (atan2f(x_m, y_m) - radar.azimuth_bias_rad + settings.sigma_azimuth_rad * noise()) / DEGREE,
        (atan2f(z_m, ground_m) + settings.sigma_elevation_rad * noise()) / DEGREE, rate_mps);
}

/* Steps the scan and empties it for the next one; 0 where the scan is refused. */
static int step_scan(float time_s)
{
    scan.time_us = (int64_t)((double)time_s * 1e6);
    if (rho_tracker_step(&tracker, &initiator, &scan, &report) != RHO_OK) {
        return 0;
    }
    scan.num_plots = 0;
    return 1;
}

/*
 * Prints the tracks, and returns the exit code: 0 where the only track is confirmed and close to
 * the target.
 */
static int print_tracks(const struct target *target, float time_s)
{
    int found = 0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];
        float off_m = hypotf(track->state[0] - target->x_m - target->vx_mps * time_s,
                             track->state[1] - target->y_m - target->vy_mps * time_s);
        printf("track %u, %s: %.0f m off, %.1f m/s, sigma %.1f m\n", (unsigned)track->track_id,
               rho_track_status_name(track->status), (double)off_m,
               (double)hypotf(track->state[3], track->state[4]), (double)track->sigma_m);
        found += track->status == RHO_TRACK_CONFIRMED && off_m < 4.0f * track->sigma_m;
    }
    return found == 1 && report.num_tracks == 1 ? 0 : 1;
}
