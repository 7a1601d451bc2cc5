/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "scene/scene.h"
#include "scene/scene_observe.h"

static bool any_radar_measures_range_rate(const struct scene *scene)
{
    for (size_t i = 0; i < scene->num_radars; i++) {
        if (scene->sensors[i].has_range_rate) {
            return true;
        }
    }
    return false;
}

static bool has_velocity_radar(const struct scene *scene)
{
    for (size_t i = 0; i < scene->num_radars; i++) {
        if (scene->sensors[i].sigma_mps > 0.0) {
            return true;
        }
    }
    return false;
}

/*
 * Whether files need the column received_s: some scans arrive late, or a sensor's clock is biased.
 */
static bool needs_arrival_column(const struct scene *scene)
{
    for (size_t i = 0; i < scene->num_sensors; i++) {
        if (scene->sensors[i].late_share > 0.0 || scene->sensors[i].time_bias_s < 0.0 ||
            scene->sensors[i].time_bias_s > 0.0) {
            return true;
        }
    }
    return false;
}

/* Writes the cells scan and received_s, which all rows of a scan share. */
static void write_arrival_cells(const struct scene_run *run, const struct scene_scan *scan,
                                FILE *file)
{
    fprintf(file, ",%zu", scan->number + 1);
    if (needs_arrival_column(run->scene)) {
        fprintf(file, ",%.6f", scan->received_s);
    }
}

/* Writes the last cell of a row, target_id, and ends the line. */
static void end_row_with_target_id(int target_id, FILE *file)
{
    fprintf(file, ",%d\n", target_id);
}

static void write_polar_scan(const struct scene_run *run, const struct scene_scan *scan, FILE *file)
{
    const struct scene_sensor *sensor = &run->scene->sensors[scan->sensor];
    const char *no_rate = any_radar_measures_range_rate(run->scene) ? "," : "";
    char place[160];

    snprintf(place, sizeof place, ",%.3f,%.3f,%.7f,%.7f", sensor->told.x_m, sensor->told.y_m,
             scan->from_rad, scan->to_rad);
    fprintf(file, "%.6f,%d,,%s%s", scan->end_s + sensor->time_bias_s, sensor->sensor_id, no_rate,
            place);
    write_arrival_cells(run, scan, file);
    fprintf(file, ",\n");
    for (size_t i = 0; i < scan->num_plots; i++) {
        const struct scene_plot *plot = &scan->plots[i];

        fprintf(file, "%.6f,%d,%.2f,%.7f", plot->t_s + sensor->time_bias_s, sensor->sensor_id,
                plot->range_m, plot->azimuth_rad);
        if (sensor->has_range_rate) {
            fprintf(file, ",%.3f%s", plot->range_rate_mps, place);
        } else {
            fprintf(file, "%s%s", no_rate, place);
        }
        write_arrival_cells(run, scan, file);
        end_row_with_target_id(plot->target_id, file);
    }
}

static void write_cartesian_scan(const struct scene_run *run, const struct scene_scan *scan,
                                 FILE *file)
{
    const struct scene_sensor *sensor = &run->scene->sensors[scan->sensor];
    bool has_height = run->scene->has_heights, has_velocity = has_velocity_radar(run->scene);

    fprintf(file, "%.6f,%d,,%s,%s", scan->end_s, sensor->sensor_id, has_height ? "," : "",
            !has_velocity ? ""
            : has_height  ? ",,,,"
                          : ",,,");
    write_arrival_cells(run, scan, file);
    fprintf(file, ",\n");
    for (size_t i = 0; i < scan->num_plots; i++) {
        const struct scene_plot *plot = &scan->plots[i];

        fprintf(file, "%.6f,%d,%.3f,%.3f", plot->t_s, sensor->sensor_id, plot->x_m, plot->y_m);
        if (has_height) {
            fprintf(file, ",%.3f", plot->z_m);
        }
        fprintf(file, ",%g", sensor->told.sigma_m);
        if (has_velocity && sensor->sigma_mps > 0.0) {
            fprintf(file, ",%.4f,%.4f", plot->vx_mps, plot->vy_mps);
            if (has_height) {
                fprintf(file, ",%.4f", plot->vz_mps);
            }
            fprintf(file, ",%g", sensor->told.sigma_mps);
        } else if (has_velocity) {
            fprintf(file, has_height ? ",,,," : ",,,");
        }
        write_arrival_cells(run, scan, file);
        end_row_with_target_id(plot->target_id, file);
    }
}

static void write_plots_file(const struct scene_run *run, const char *folder)
{
    const struct scene *scene = run->scene;
    char *path = path_join(folder, "plots.csv");
    struct output output = output_open(path);
    char cartesian[64];
    const char *columns = scene->sensors[0].is_cartesian ? cartesian
                          : any_radar_measures_range_rate(scene)
                              ? "range_m,azimuth_rad,range_rate_mps,sensor_x_m,"
                                "sensor_y_m,sector_from_rad,sector_to_rad"
                              : "range_m,azimuth_rad,sensor_x_m,sensor_y_m,"
                                "sector_from_rad,sector_to_rad";

    snprintf(cartesian, sizeof cartesian, "x_m,y_m%s,sigma_m%s", scene->has_heights ? ",z_m" : "",
             !has_velocity_radar(scene) ? ""
             : scene->has_heights       ? ",vx_mps,vy_mps,vz_mps,sigma_mps"
                                        : ",vx_mps,vy_mps,sigma_mps");
    fprintf(output.file, "t_s,sensor_id,%s,scan%s,target_id\n", columns,
            needs_arrival_column(scene) ? ",received_s" : "");
    for (size_t i = 0; i < run->num_scans; i++) {
        const struct scene_scan *scan = &run->scans[i];

        if (scan->sensor >= scene->num_radars) {
            continue;
        }
        if (scene->sensors[0].is_cartesian) {
            write_cartesian_scan(run, scan, output.file);
        } else {
            write_polar_scan(run, scan, output.file);
        }
    }
    output_close(&output);
    free(path);
}

/* Writes the bearings of a scan; an empty scan is a row without a bearing. */
static void write_bearing_scan(const struct scene_run *run, const struct scene_scan *scan,
                               FILE *file)
{
    const struct scene_sensor *sensor = &run->scene->sensors[scan->sensor];
    const bool has_elevations = run->scene->has_elevations;
    char place[96];

    snprintf(place, sizeof place, has_elevations ? "%d,%.3f,%.3f,%.3f" : "%d,%.3f,%.3f",
             sensor->sensor_id, sensor->told.x_m, sensor->told.y_m, sensor->z_m);
    for (size_t i = 0; i < scan->num_plots; i++) {
        fprintf(file, "%.6f,%s,%.8f%s", scan->plots[i].t_s + sensor->time_bias_s, place,
                scan->plots[i].azimuth_rad, has_elevations ? "," : "");
        if (sensor->sigma_elevation_rad > 0.0) {
            fprintf(file, "%.8f", scan->plots[i].elevation_rad);
        }
        write_arrival_cells(run, scan, file);
        end_row_with_target_id(scan->plots[i].target_id, file);
    }
    if (scan->num_plots == 0) {
        fprintf(file, "%.6f,%s,%s", scan->end_s + sensor->time_bias_s, place,
                has_elevations ? "," : "");
        write_arrival_cells(run, scan, file);
        fprintf(file, ",\n");
    }
}

static void write_bearings_file(const struct scene_run *run, const char *folder)
{
    char *path = path_join(folder, "bearings.csv");
    struct output output = output_open(path);

    fprintf(output.file, "t_s,sensor_id,sensor_x_m,sensor_y_m,%s,scan%s,target_id\n",
            run->scene->has_elevations ? "sensor_z_m,bearing_rad,elevation_rad" : "bearing_rad",
            needs_arrival_column(run->scene) ? ",received_s" : "");
    for (size_t i = 0; i < run->num_scans; i++) {
        if (run->scans[i].sensor >= run->scene->num_radars) {
            write_bearing_scan(run, &run->scans[i], output.file);
        }
    }
    output_close(&output);
    free(path);
}

static int by_int64(const void *a, const void *b)
{
    const int64_t *one = a, *other = b;

    return (*one > *other) - (*one < *other);
}

/*
 * Lists the end times of all scans in whole microseconds, sorted and without repetition, in new
 * memory.
 */
static int64_t *list_scan_ends_us(const struct scene_run *run, size_t *count)
{
    int64_t *times_us = must_calloc(run->num_scans + 1, sizeof *times_us);

    *count = 0;
    for (size_t i = 0; i < run->num_scans; i++) {
        times_us[i] = llround(run->scans[i].end_s * 1e6);
    }
    qsort(times_us, run->num_scans, sizeof *times_us, by_int64);
    for (size_t i = 0; i < run->num_scans; i++) {
        if (*count == 0 || times_us[i] > times_us[*count - 1]) {
            times_us[(*count)++] = times_us[i];
        }
    }
    return times_us;
}

static bool scene_has_bodies(const struct scene *scene)
{
    for (size_t i = 0; i < scene->targets.count; i++) {
        if (scene->targets.items[i].body.scatterers > 0) {
            return true;
        }
    }
    return false;
}

/* Writes truth.csv with the targets in the coverage of a sensor, and paths.csv with all targets. */
static void write_truth_and_paths_files(const struct scene_run *run, const char *folder)
{
    char *path = path_join(folder, "truth.csv"), *all_path = path_join(folder, "paths.csv");
    struct output truth = output_open(path), all = output_open(all_path);
    size_t num_times;
    int64_t *times_us = list_scan_ends_us(run, &num_times);

    const bool has_bodies = scene_has_bodies(run->scene);
    const char *columns = run->scene->has_heights ? "t_s,target_id,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps"
                                                  : "t_s,target_id,x_m,y_m,vx_mps,vy_mps";

    fprintf(truth.file, "%s%s\n", columns, has_bodies ? ",length_m,width_m" : "");
    fprintf(all.file, "%s,is_covered\n", columns);
    for (size_t i = 0; i < num_times; i++) {
        double t_s = (double)times_us[i] * 1e-6;

        for (size_t k = 0; k < run->num_paths; k++) {
            const struct scene_path *flight = &run->paths[k];
            struct motion at;
            bool is_covered;
            char row[160];

            if (t_s < flight->from_s || t_s >= flight->until_s) {
                continue;
            }
            at = path_motion_at(flight, t_s);
            is_covered = scene_covers_place(run->scene, at.x_m, at.y_m);
            if (run->scene->has_heights) {
                snprintf(row, sizeof row, "%.6f,%zu,%.3f,%.3f,%.3f,%.4f,%.4f,%.4f", t_s, k, at.x_m,
                         at.y_m, at.z_m, at.vx_mps, at.vy_mps, at.vz_mps);
            } else {
                snprintf(row, sizeof row, "%.6f,%zu,%.3f,%.3f,%.4f,%.4f", t_s, k, at.x_m, at.y_m,
                         at.vx_mps, at.vy_mps);
            }
            fprintf(all.file, "%s,%d\n", row, is_covered);
            if (is_covered && has_bodies) {
                const struct scene_body *body = &run->scene->targets.items[flight->item].body;

                fprintf(truth.file, "%s,%.3f,%.3f\n", row, body->length_m, body->width_m);
            } else if (is_covered) {
                fprintf(truth.file, "%s\n", row);
            }
        }
    }
    output_close(&truth);
    output_close(&all);
    free(times_us);
    free(path);
    free(all_path);
}

static void write_sensor_settings(const struct scene_sensor *sensor, FILE *file)
{
    const struct scene_stated *told = &sensor->told;

    fprintf(file, "\n[sensor %d]\nx_m = %.3f\ny_m = %.3f\npd = %.9g\n", sensor->sensor_id,
            told->x_m, told->y_m, told->pd);
    if (sensor->is_passive) {
        fprintf(file, "sigma_rad = %.9g\n", told->sigma_rad);
        if (told->sigma_elevation_rad > 0.0) {
            fprintf(file, "sigma_elevation_rad = %.9g\n", told->sigma_elevation_rad);
        }
    } else {
        fprintf(file, "sigma_range_m = %.9g\nsigma_azimuth_rad = %.9g\n", told->sigma_range_m,
                told->sigma_azimuth_rad);
    }
    if (sensor->has_range_rate) {
        fprintf(file, "sigma_range_rate_mps = %.9g\n", told->sigma_range_rate_mps);
        if (sensor->range_rate_span_mps > 0.0) {
            fprintf(file, "range_rate_span_mps = %.9g\n", sensor->range_rate_span_mps);
        }
    }
    scene_notch_write_settings(&told->notch, file);
    fprintf(file, "range_min_m = %.9g\nrange_max_m = %.9g\n", told->coverage.range_m.lo,
            fmax(1.0, told->coverage.range_m.hi));
    if (told->coverage.has_sector) {
        fprintf(file, "sector_from_rad = %.9g\nsector_to_rad = %.9g\n", told->coverage.from_rad,
                told->coverage.to_rad);
    }
    if (fabs(told->range_bias_m) > 0.0) {
        fprintf(file, "range_bias_m = %.9g\n", told->range_bias_m);
    }
    if (fabs(told->azimuth_bias_rad) > 0.0) {
        fprintf(file, "azimuth_bias_rad = %.9g\n", told->azimuth_bias_rad);
    }
    if (fabs(told->time_bias_s) > 0.0) {
        fprintf(file, "time_bias_s = %.9g\n", told->time_bias_s);
    }
}

static void write_settings_file(const struct scene *scene, const char *scene_name,
                                const char *folder)
{
    char *path = path_join(folder, "scenario.ini"), *name = must_copy_text(scene_name);
    struct output output = output_open(path);

    mask_control_characters(name); /* of a file that may have any: no line of its own */
    fprintf(output.file, "# scene %s: what a tracker may know beforehand\n%s", name,
            scene->settings);
    free(name);
    if (scene->num_radars > 0 && scene->sensors[0].is_cartesian) {
        fprintf(output.file, "sigma_m = %.9g\npd = %.9g\n", scene->sensors[0].told.sigma_m,
                scene->sensors[0].told.pd);
        for (size_t i = 0; i < scene->num_radars; i++) {
            if (scene->sensors[i].sigma_mps > 0.0) {
                fprintf(output.file, "sigma_mps = %.9g\n", scene->sensors[i].told.sigma_mps);
                break;
            }
        }
    }
    if (scene->has_area) {
        fprintf(output.file, "area_x_min_m = %.3f\narea_x_max_m = %.3f\n", scene->area_m[0],
                scene->area_m[1]);
        fprintf(output.file, "area_y_min_m = %.3f\narea_y_max_m = %.3f\n", scene->area_m[2],
                scene->area_m[3]);
    }
    scene_reflectors_write_told(&scene->reflectors, output.file);
    for (size_t i = 0; i < scene->num_sensors; i++) {
        if (!scene->sensors[i].is_cartesian) {
            write_sensor_settings(&scene->sensors[i], output.file);
        }
    }
    output_close(&output);
    free(path);
}

void scene_simulate(const struct scene *scene, const char *name, const char *folder, uint64_t seed,
                    uint64_t run_number)
{
    struct scene_run *run = scene_observe(scene, seed, run_number);

    make_folder_with_parents(folder);
    if (scene->num_radars > 0) {
        write_plots_file(run, folder);
    }
    if (scene->num_sensors > scene->num_radars) {
        write_bearings_file(run, folder);
    }
    write_truth_and_paths_files(run, folder);
    write_settings_file(scene, name, folder);
    scene_run_free(run);
}
