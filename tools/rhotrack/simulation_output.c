/* SPDX-License-Identifier: MIT */
#include "simulation_output.h"

#include <math.h>
#include <stdlib.h>

#include "common.h"
#include "scenario_record.h"

static void write_plots(const struct simulation *simulation, const char *folder)
{
    char *path = path_join(folder, "plots.csv");
    struct output output = output_open(path);
    fprintf(output.file, "t_s,sensor_id,x_m,y_m,sigma_m\n");
    for (size_t i = 0; i < simulation->num_scans; i++) {
        const struct simulated_scan *scan = &simulation->scans[i];
        for (size_t j = 0; j < scan->num_plots; j++) {
            fprintf(output.file, "%.6f,0,%.3f,%.3f,%g\n", scan->t_s, scan->plots[j].x_m,
                    scan->plots[j].y_m, simulation->sigma_m);
        }
        if (scan->num_plots == 0) {
            fprintf(output.file, "%.6f,0,,,\n", scan->t_s);
        }
    }
    output_close(&output);
    free(path);
}

/* Every turn opens with a row that saw nothing, so that its scan has the turn's time. */
static void write_polar(const struct simulation *simulation, const char *folder)
{
    const struct scenario_radar *radar = &simulation->radar;
    char *path = path_join(folder, "polar.csv");
    struct output output = output_open(path);
    fprintf(output.file, "t_s,sensor_id,range_m,azimuth_rad%s\n",
            radar->has_range_rate ? ",range_rate_mps" : "");
    for (size_t i = 0; i < simulation->num_scans; i++) {
        const struct simulated_scan *scan = &simulation->scans[i];
        fprintf(output.file, "%.6f,0,,%s\n", scan->t_s, radar->has_range_rate ? "," : "");
        for (size_t j = 0; j < scan->num_plots; j++) {
            const struct simulated_plot *plot = &scan->plots[j];
            fprintf(output.file, "%.6f,0,%.2f,%.7f", scan->t_s + plot->offset_s, plot->range_m,
                    plot->azimuth_rad);
            if (radar->has_range_rate) {
                fprintf(output.file, ",%.3f", plot->range_rate_mps);
            }
            fprintf(output.file, "\n");
        }
    }
    output_close(&output);
    free(path);
}

static void write_truth(const struct simulation *simulation, const char *folder)
{
    char *path = path_join(folder, "truth.csv");
    struct output output = output_open(path);
    fprintf(output.file, "t_s,target_id,x_m,y_m,vx_mps,vy_mps\n");
    for (size_t i = 0; i < simulation->num_truth; i++) {
        const struct truth_point *point = &simulation->truth[i];
        fprintf(output.file, "%.6f,%d,%.3f,%.3f,%.4f,%.4f\n", point->t_s, point->target_id,
                point->x_m, point->y_m, point->vx_mps, point->vy_mps);
    }
    output_close(&output);
    free(path);
}

/* Times in the file are whole microseconds, and turns as many apart or one less: they must not join. */
static double whole_us(double interval_s)
{
    return floor(interval_s * 1e6 + 1e-3) * 1e-6;
}

static void write_radar(const struct scenario_radar *radar, double interval_s, FILE *file)
{
    fprintf(file, "scan_interval_s = %.8g\nsigma_range_m = %g\nsigma_azimuth_rad = %g\n",
            whole_us(interval_s), radar->sigma_range_m, radar->sigma_azimuth_rad);
    if (radar->has_range_rate) {
        fprintf(file, "sigma_range_rate_mps = %g\n", radar->sigma_range_rate_mps);
    }
}

/* How many misses in a row are none too many, and how long scans have to be waited for. */
static void write_patience(const struct scenario_record *record,
                           const struct parameters *parameters, FILE *file)
{
    fprintf(file, "coast_scans_max = %g\n", parameters->value[PARAMETER_COAST_SCANS_MAX]);
    if (parameters->value[PARAMETER_LATE_SHARE] > 0.0 && record->has_received) {
        double most_ms = parameters_text(PARAMETER_HOLD_MS).max;

        fprintf(file, "hold_ms = %g\n", fmin(parameters->value[PARAMETER_LATE_MS], most_ms));
    }
}

static void write_area(const struct scenario_box *area, FILE *file)
{
    fprintf(file, "area_x_min_m = %.3f\narea_x_max_m = %.3f\n", area->x_min_m, area->x_max_m);
    fprintf(file, "area_y_min_m = %.3f\narea_y_max_m = %.3f\n", area->y_min_m, area->y_max_m);
}

/* What a tracker should know of the scenario, for `track --config`. */
static void write_settings(const char *name, const struct simulation *simulation,
                           const struct parameters *parameters, const char *folder)
{
    static const enum parameter_id told[] = {PARAMETER_V_MIN_MPS, PARAMETER_V_MAX_MPS,
                                             PARAMETER_ACCEL_MAX_MPS2};
    static const enum parameter_id told_if_set[] = {
        PARAMETER_STEADY_S, PARAMETER_PROCESS_NOISE_MPS2, PARAMETER_RANGE_RATE_SPAN_MPS};
    char *path = path_join(folder, "scenario.ini");
    struct output output = output_open(path);
    fprintf(output.file, "# scenario %s: what a tracker may know beforehand\n", name);
    if (simulation->record != NULL) {
        write_patience(simulation->record, parameters, output.file);
    } else if (simulation->radar.is_used) {
        write_radar(&simulation->radar, simulation->interval_s, output.file);
    } else {
        fprintf(output.file, "sigma_m = %g\n", simulation->sigma_m);
    }
    if (simulation->pd > 0.0) {
        fprintf(output.file, "pd = %g\n", simulation->pd);
    }
    for (size_t i = 0; i < sizeof told / sizeof told[0]; i++) {
        fprintf(output.file, "%s = %g\n", parameters_name(told[i]), parameters->value[told[i]]);
    }
    for (size_t i = 0; i < sizeof told_if_set / sizeof told_if_set[0]; i++) {
        double value = parameters->value[told_if_set[i]];
        if (value > 0.0) {
            fprintf(output.file, "%s = %g\n", parameters_name(told_if_set[i]), value);
        }
    }
    write_area(&simulation->area, output.file);
    if (simulation->record != NULL) {
        record_write_sensors(simulation->record, output.file);
    }
    output_close(&output);
    free(path);
}

void simulation_write(const char *name, const struct simulation *simulation,
                      const struct parameters *parameters, const char *folder)
{
    make_folder(folder);
    if (simulation->record != NULL) {
        record_write(simulation->record, folder);
    } else if (simulation->radar.is_used) {
        write_polar(simulation, folder);
    } else {
        write_plots(simulation, folder);
    }
    write_truth(simulation, folder);
    write_settings(name, simulation, parameters, folder);
}
