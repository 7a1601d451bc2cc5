/* SPDX-License-Identifier: MIT */
#include "registration/register.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "registration/register_data.h"

/* largest rms distance of two radars' tracks of one target before biases are corrected */
#define FIRST_GATE_M 3000.0
#define ROUNDS_MAX 10
/* a bias counts as known if its sigma is at most this share of a plot's noise */
#define KNOWN_SHARE 0.5

struct register_data *register_start(const struct parameters *parameters)
{
    struct register_data *data = must_calloc(1, sizeof *data);

    data->parameters = parameters;
    return data;
}

/* Index of the radar with this sensor_id, or of the place at which it is to be inserted. */
static size_t find_radar_index(const struct register_data *data, int32_t sensor_id)
{
    size_t at = 0;

    while (at < data->num_radars && data->radars[at].sensor.sensor_id < sensor_id) {
        at++;
    }
    return at;
}

/* The radar with this sensor_id, or NULL where no scan of it was added. */
static struct radar_data *find_radar(const struct register_data *data, int32_t sensor_id)
{
    size_t at = find_radar_index(data, sensor_id);

    return at < data->num_radars && data->radars[at].sensor.sensor_id == sensor_id
               ? &data->radars[at]
               : NULL;
}

static struct radar_data *find_or_add_radar(struct register_data *data,
                                            const struct rho_sensor *sensor)
{
    size_t at = find_radar_index(data, sensor->sensor_id);

    if (find_radar(data, sensor->sensor_id)) {
        return &data->radars[at];
    }
    data->radars = must_make_room_for_one(data->radars, data->num_radars, &data->radars_room,
                                          sizeof *data->radars);
    for (size_t i = data->num_radars++; i > at; i--) {
        data->radars[i] = data->radars[i - 1];
    }
    data->radars[at] = (struct radar_data){.sensor = *sensor};
    return &data->radars[at];
}

/*
 * Why the scan cannot be used for registration, or NULL. The radar is NULL for its first scan.
 * Polar plots are recognised by unequal sigmas: the library gives Cartesian plots equal ones.
 */
static const char *reason_scan_is_unfit(const struct rho_scan *scan, const struct radar_data *radar,
                                        const struct rho_sensor *sensor)
{
    if (radar && (radar->sensor.x_m != sensor->x_m || radar->sensor.y_m != sensor->y_m)) {
        return "it moves; register takes only radars that stand still";
    }
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        const struct rho_plot *plot = &scan->plots[i];

        if (plot->sigma_range_m == plot->sigma_cross_m && plot->sigma_range_m == plot->sigma_up_m) {
            return "its plots are not in range and azimuth";
        }
    }
    return NULL;
}

static struct radar_plot radar_plot_from_plot(const struct rho_plot *plot, int64_t scan_us,
                                              const struct rho_sensor *sensor)
{
    double x_m = (double)plot->x_m - (double)sensor->x_m;
    double y_m = (double)plot->y_m - (double)sensor->y_m;

    return (struct radar_plot){.time_us = scan_us + plot->offset_us,
                               .range_m = hypot(x_m, y_m),
                               .azimuth_rad = atan2(y_m, x_m),
                               .sigma_range_m = (double)plot->sigma_range_m,
                               .sigma_cross_m = (double)plot->sigma_cross_m,
                               .plot = *plot};
}

void register_add_unchecked_scan(struct register_data *data, const struct rho_scan *scan,
                                 const struct rho_sensor *sensor)
{
    struct radar_data *radar = find_or_add_radar(data, sensor);

    if (data->num_radars == 1 && radar->num_scans == 0) {
        data->start_us = scan->time_us;
    }
    radar->scans = must_make_room_for_one(radar->scans, radar->num_scans, &radar->scans_room,
                                          sizeof *radar->scans);
    radar->scans[radar->num_scans++] =
        (struct radar_scan){.time_us = scan->time_us,
                            .from_rad = (double)scan->sector_from_rad,
                            .to_rad = (double)scan->sector_to_rad,
                            .first = radar->num_plots,
                            .count = scan->num_plots};
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        radar->plots = must_make_room_for_one(radar->plots, radar->num_plots, &radar->plots_room,
                                              sizeof *radar->plots);
        radar->plots[radar->num_plots++] =
            radar_plot_from_plot(&scan->plots[i], scan->time_us, sensor);
    }
}

const char *register_add_scan(struct register_data *data, const struct rho_scan *scan,
                              const struct rho_sensor *sensor)
{
    const char *reason = reason_scan_is_unfit(scan, find_radar(data, sensor->sensor_id), sensor);

    if (!reason) {
        register_add_unchecked_scan(data, scan, sensor);
    }
    return reason;
}

size_t register_num_radars(const struct register_data *data)
{
    return data->num_radars;
}

void register_free(struct register_data *data)
{
    for (size_t i = 0; i < data->num_radars; i++) {
        free(data->radars[i].scans);
        free(data->radars[i].plots);
    }
    for (size_t i = 0; i < data->num_tracks; i++) {
        free(data->tracks[i].plots);
    }
    free(data->radars);
    free(data->tracks);
    free(data);
}

/*
 * The radar that the parameters name, else the first one with plots: the time of a radar without
 * plots says nothing of the others' times.
 */
static size_t find_reference_radar(const struct register_data *data)
{
    const struct parameters *parameters = data->parameters;

    if (parameters_has_value(parameters, PARAMETER_REFERENCE_SENSOR)) {
        int32_t sensor_id = (int32_t)parameters->value[PARAMETER_REFERENCE_SENSOR];

        const struct radar_data *radar = find_radar(data, sensor_id);

        if (!radar || radar->num_plots == 0) {
            fail(EXIT_USAGE, "reference_sensor %d: the input has no plots of this radar",
                 (int)sensor_id);
        }
        return (size_t)(radar - data->radars);
    }
    for (size_t i = 0; i < data->num_radars; i++) {
        if (data->radars[i].num_plots > 0) {
            return i;
        }
    }
    return 0;
}

/*
 * Mean noise of a plot of the radar in range, azimuth and time (range noise over speed_mps); 0 for
 * a radar without plots.
 */
static void mean_plot_noise(const struct radar_data *radar, double speed_mps,
                            double noise[NUM_REGISTER_KINDS])
{
    double range_m = 0.0, azimuth_rad = 0.0;

    for (size_t i = 0; i < radar->num_plots; i++) {
        range_m += radar->plots[i].sigma_range_m;
        azimuth_rad += radar->plots[i].sigma_cross_m / radar->plots[i].range_m;
    }
    noise[REGISTER_RANGE] = range_m / fmax(1.0, (double)radar->num_plots);
    noise[REGISTER_AZIMUTH] = azimuth_rad / fmax(1.0, (double)radar->num_plots);
    noise[REGISTER_TIME] = noise[REGISTER_RANGE] / speed_mps;
}

static void fill_radar_result(const struct register_data *data, size_t radar_number,
                              const struct solution *solution, struct register_radar *out)
{
    const struct radar_data *radar = &data->radars[radar_number];
    const double configured[NUM_REGISTER_KINDS] = {(double)radar->sensor.range_bias_m,
                                                   (double)radar->sensor.azimuth_bias_rad,
                                                   (double)radar->sensor.time_bias_s};
    double noise[NUM_REGISTER_KINDS];

    *out = (struct register_radar){.sensor_id = radar->sensor.sensor_id,
                                   .scans = radar->num_scans,
                                   .plots = radar->num_plots,
                                   .common_plots = solution->radar_plots[radar_number]};
    for (size_t i = 0; i < data->num_tracks; i++) {
        out->tracks += data->tracks[i].radar == radar_number;
    }
    mean_plot_noise(radar, solution->speed_mps, noise);
    for (size_t kind = 0; kind < NUM_REGISTER_KINDS; kind++) {
        double sigma = solution->sigma[radar_number * NUM_REGISTER_KINDS + kind];
        bool is_known = out->common_plots > 0 && sigma <= KNOWN_SHARE * noise[kind];

        out->biases[kind] =
            (struct register_bias){.value = configured[kind] + (is_known ? radar->bias[kind] : 0.0),
                                   .sigma = sigma,
                                   .is_known = is_known};
    }
}

static struct register_result make_result(const struct register_data *data, size_t reference,
                                          const struct solution *solution, size_t rounds)
{
    struct register_result result = {.num_radars = data->num_radars,
                                     .reference = reference,
                                     .targets = register_num_common_targets(data),
                                     .segments = solution->segments,
                                     .segments_left_out = solution->segments_left_out,
                                     .plots = solution->plots,
                                     .misfit = solution->misfit,
                                     .rounds = rounds};

    result.radars = must_calloc(data->num_radars + 1, sizeof *result.radars);
    for (size_t i = 0; i < data->num_radars; i++) {
        fill_radar_result(data, i, solution, &result.radars[i]);
    }
    return result;
}

struct register_result register_estimate_biases(struct register_data *data,
                                                struct pipeline *pipeline)
{
    size_t reference = find_reference_radar(data), rounds = 1;
    struct solution solution;
    struct register_result result;

    register_track_all_radars(data, pipeline);
    register_update_matches(data, FIRST_GATE_M, 0.0);
    solution = register_solve_biases(data, reference);
    while (rounds < ROUNDS_MAX && register_update_matches(data, FIRST_GATE_M, solution.misfit)) {
        bias_solution_free(&solution);
        solution = register_solve_biases(data, reference);
        rounds++;
    }
    result = make_result(data, reference, &solution, rounds);
    bias_solution_free(&solution);
    return result;
}

void register_result_free(struct register_result *result)
{
    free(result->radars);
}
