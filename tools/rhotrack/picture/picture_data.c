/* SPDX-License-Identifier: MIT */
#include "picture/picture_data.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/csv/csv_table.h"
#include "io/csv/measurement_row.h"
#include "io/log/lcm_log.h"
#include "io/log/log_scans.h"
#include "io/log/log_table.h"
#include "io/rows/trajectory_row.h"
#include "io/scans/bearing_reader.h"
#include "rhotrack/message.h"

/* a first time at or beyond this is a clock's time: pictures then count from it */
#define LATE_US 1000000000

/*
 * Adds the radar of a record unless it is known already; a radar of Cartesian plots only where its
 * place is known.
 */
static void add_radar_once(struct picture_data *data, const struct measurement_row *record,
                           bool is_polar, const struct parameters *parameters)
{
    for (size_t i = 0; i < data->num_radars; i++) {
        if (data->radars[i].sensor_id == record->sensor_id) {
            return;
        }
    }
    if (!record->has_sensor && !is_polar) {
        return;
    }
    const struct rho_sensor *sensor = &record->sensor;
    const double range_max_m =
        parameters_value_of_sensor(parameters, record->sensor_id, SENSOR_RANGE_MAX_M,
                                   parameters->source[PARAMETER_RANGE_MAX_M] > SOURCE_DEFAULT
                                       ? parameters->value[PARAMETER_RANGE_MAX_M]
                                       : INFINITY);
    data->radars = must_make_room_for_one(data->radars, data->num_radars, &data->radars_capacity,
                                          sizeof *data->radars);
    data->radars[data->num_radars++] = (struct plot_radar){
        .sensor_id = record->sensor_id,
        .x_m = (double)sensor->x_m,
        .y_m = (double)sensor->y_m,
        .range_max_m = range_max_m,
        .sector_from_rad = record->has_sensor ? (double)sensor->sector_from_rad : 0.0,
        .sector_to_rad = record->has_sensor ? (double)sensor->sector_to_rad : 0.0};
}

/* Adds the plots of a table with the checks and conversions of the command track. */
static void add_plots_of_table(struct picture_data *data, const struct table *table,
                               const struct parameters *parameters)
{
    struct plot_points *points = &data->plots;
    struct measurement_columns columns =
        measurement_columns_find(table, parameters, RECORD_PLOTS, false);
    const bool is_polar = columns.in_file.at[COL_RANGE_M] >= 0;
    char reason[ROW_REASON_BYTES];
    for (size_t row = 0; row < table->num_rows; row++) {
        struct measurement_row record;
        if (!measurement_row_read(&columns, row, parameters, &record, reason)) {
            table_fail_at_row(table, row, "%s", reason);
        }
        if (record.has_measurement) {
            add_radar_once(data, &record, is_polar, parameters);
            points->list[points->count++] =
                (struct plot_point){.time_us = record.time_us - record.bias_us,
                                    .x_m = (double)record.plot.x_m,
                                    .y_m = (double)record.plot.y_m};
        }
    }
    measurement_columns_free(&columns);
}

static double nan_to_0(double number)
{
    return isnan(number) ? 0.0 : number;
}

/*
 * Adds the rows of a truth or tracks table, except rows without a place and rows of deleted tracks.
 */
static void add_truth_or_tracks(struct plot_points *points, const struct table *table,
                                const struct parameters *parameters)
{
    struct trajectory_columns columns = trajectory_columns_find(table, parameters);
    for (size_t row = 0; row < table->num_rows; row++) {
        if (!trajectory_row_has_place(&columns, row)) {
            continue;
        }
        const struct trajectory_row path = trajectory_row_read(&columns, row);
        if (path.status != RHO_MESSAGE_TRACK_DELETED) {
            points->list[points->count++] =
                (struct plot_point){.time_us = path.time_us,
                                    .id = path.id,
                                    .x_m = path.x_m,
                                    .y_m = path.y_m,
                                    .vx_mps = nan_to_0(path.vx_mps),
                                    .vy_mps = nan_to_0(path.vy_mps),
                                    .is_tentative = path.status == RHO_MESSAGE_TRACK_TENTATIVE,
                                    .table = table,
                                    .row = row};
        }
    }
    trajectory_columns_free(&columns);
}

static void add_points_of_table(struct picture_data *data, struct plot_points *points,
                                const struct table *table, const struct parameters *parameters)
{
    points->list =
        must_realloc(points->list, (points->count + table->num_rows + 1) * sizeof points->list[0]);
    if (points == &data->plots) {
        add_plots_of_table(data, table, parameters);
    } else {
        add_truth_or_tracks(points, table, parameters);
    }
}

static void add_and_consume_table(struct picture_data *data, struct table *table,
                                  const struct parameters *parameters)
{
    if (table_find_column(table, "track_id") >= 0) {
        add_points_of_table(data, &data->tracks, table, parameters);
        /*
         * Keeps a table of tracks: errors in its rows may be found only when they are compared with
         * the truth.
         */
        data->track_tables =
            must_make_room_for_one(data->track_tables, data->num_track_tables,
                                   &data->track_tables_capacity, sizeof(struct table *));
        data->track_tables[data->num_track_tables++] = table;
        return;
    }
    /* plots of a simulated scene have a column target_id as well */
    bool are_plots =
        table_find_column(table, "target_id") < 0 || table_find_column(table, "sensor_id") >= 0;
    add_points_of_table(data, are_plots ? &data->plots : &data->truth, table, parameters);
    table_free(table);
}

/* Adds the plots, truth and tracks of a CSV file or an LCM log; bearings are read later. */
static void add_points_of_file(struct picture_data *data, const char *path,
                               const struct parameters *parameters)
{
    static const struct rows_kind *const kinds[] = {&rows_kind_plots, &rows_kind_polar,
                                                    &rows_kind_truth, &rows_kind_tracks};
    size_t found = 0;
    unsigned scans;
    if (!lcm_log_is_log(path)) {
        add_and_consume_table(data, table_read_csv_or_asterix(path, parameters, false), parameters);
        return;
    }
    scans = log_scans_kinds(path);
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        struct table *table =
            log_table_read(path, kinds[i], false, i == 0 && scans != LOG_HAS_BEARINGS);
        if (table != NULL) {
            add_and_consume_table(data, table, parameters);
            found++;
        }
    }
    if (found == 0 && scans == 0) {
        fail(EXIT_USAGE, "%s: contains no messages of plots, bearings, truth or tracks", path);
    }
}

static void add_rays_of_scan(struct plot_rays *rays, const struct rho_bearing_scan *scan,
                             double length_m)
{
    size_t sensor = 0;
    while (rays->sensors[sensor].id != scan->sensor_id) {
        sensor++;
    }
    for (uint32_t i = 0; i < scan->num_bearings; i++) {
        double bearing_rad = (double)scan->bearings[i].bearing_rad;
        const struct plot_point *place = &rays->sensors[sensor];
        rays->list[rays->count++] =
            (struct plot_ray){.sensor = sensor,
                              .time_us = scan->time_us,
                              .x_m = place->x_m,
                              .y_m = place->y_m,
                              .end_x_m = place->x_m + length_m * cos(bearing_rad),
                              .end_y_m = place->y_m + length_m * sin(bearing_rad)};
    }
}

static void read_all_bearings(struct plot_rays *rays, char *const *paths, int num_paths,
                              const struct parameters *parameters)
{
    struct bearing_reader *reader = bearing_reader_open(paths, num_paths, parameters, false);
    const struct rho_frame *frame;
    const struct frame_sensor *sensors = bearing_reader_sensors(reader, &rays->num_sensors);
    rays->sensors = must_calloc(rays->num_sensors, sizeof rays->sensors[0]);
    for (size_t i = 0; i < rays->num_sensors; i++) {
        rays->sensors[i] = (struct plot_point){.id = sensors[i].sensor_id,
                                               .x_m = (double)sensors[i].x_m,
                                               .y_m = (double)sensors[i].y_m};
    }
    rays->list = must_calloc(bearing_reader_counts(reader).bearings + 1, sizeof rays->list[0]);
    while ((frame = bearing_reader_next(reader)) != NULL) {
        for (uint32_t i = 0; i < frame->num_scans; i++) {
            const struct rho_bearing_scan *scan = &frame->scans[i];
            add_rays_of_scan(rays, scan, parameters_range_max_m(parameters, scan->sensor_id));
        }
    }
    bearing_reader_close(reader);
}

static int by_id_and_time(const void *a, const void *b)
{
    const struct plot_point *one = a, *other = b;
    if (one->id != other->id) {
        return one->id < other->id ? -1 : 1;
    }
    return one->time_us < other->time_us ? -1 : one->time_us > other->time_us;
}

bool picture_data_next_identity(const struct plot_points *points, size_t *at,
                                struct plot_points *one)
{
    one->count = 0;
    if (*at >= points->count) {
        return false; /* an empty list may have no memory to point into */
    }
    one->list = points->list + *at;
    while (*at < points->count && points->list[*at].id == one->list[0].id) {
        ++*at;
        ++one->count;
    }
    return true;
}

size_t picture_data_count_identities(const struct plot_points *points)
{
    struct plot_points one;
    size_t at = 0, count = 0;
    while (picture_data_next_identity(points, &at, &one)) {
        count++;
    }
    return count;
}

static bool was_ever_confirmed(const struct plot_points *track)
{
    for (size_t i = 0; i < track->count; i++) {
        if (!track->list[i].is_tentative) {
            return true;
        }
    }
    return false;
}

static void drop_never_confirmed_tracks(struct plot_points *tracks)
{
    struct plot_points one;
    size_t at = 0, kept = 0;
    while (picture_data_next_identity(tracks, &at, &one)) {
        if (was_ever_confirmed(&one)) {
            memmove(tracks->list + kept, one.list, one.count * sizeof one.list[0]);
            kept += one.count;
        }
    }
    tracks->count = kept;
}

static void sort_by_id_and_time(struct plot_points *points)
{
    if (points->count > 0) {
        qsort(points->list, points->count, sizeof points->list[0], by_id_and_time);
    }
}

static size_t count_points(const struct picture_data *data)
{
    return data->plots.count + data->tracks.count + data->truth.count;
}

struct picture_data picture_data_read(char *const *paths, int num_paths,
                                      const struct parameters *parameters)
{
    struct picture_data data = {0};
    char **bearings = must_calloc((size_t)num_paths, sizeof bearings[0]);
    int num_bearings = 0;
    data.plot_paths = must_calloc((size_t)num_paths, sizeof data.plot_paths[0]);
    for (int i = 0; i < num_paths; i++) {
        bool is_log = lcm_log_is_log(paths[i]);
        bool has_bearings = is_log ? (log_scans_kinds(paths[i]) & LOG_HAS_BEARINGS) != 0
                                   : bearing_reader_is_bearings(paths[i]);
        if (has_bearings) {
            bearings[num_bearings++] = paths[i];
        }
        size_t before = count_points(&data), plots_before = data.plots.count;
        if (is_log || !has_bearings) {
            add_points_of_file(&data, paths[i], parameters);
        }
        if (data.plots.count > plots_before) {
            data.plot_paths[data.num_plot_paths++] = paths[i];
        }
        data.bearings.has_own_file |= has_bearings && count_points(&data) == before;
    }
    if (num_bearings > 0) {
        read_all_bearings(&data.bearings, bearings, num_bearings, parameters);
    }
    free(bearings);
    sort_by_id_and_time(&data.tracks);
    sort_by_id_and_time(&data.truth);
    drop_never_confirmed_tracks(&data.tracks);
    return data;
}

/* The earliest time of the points, or otherwise_us if that is earlier. */
static int64_t earliest_time_us(const struct plot_points *points, int64_t otherwise_us)
{
    for (size_t i = 0; i < points->count; i++) {
        otherwise_us =
            points->list[i].time_us < otherwise_us ? points->list[i].time_us : otherwise_us;
    }
    return otherwise_us;
}

int64_t picture_data_time_origin_us(const struct picture_data *data)
{
    int64_t zero_us = earliest_time_us(&data->truth, INT64_MAX);
    zero_us = earliest_time_us(&data->plots, earliest_time_us(&data->tracks, zero_us));
    for (size_t i = 0; i < data->bearings.count; i++) {
        const int64_t time_us = data->bearings.list[i].time_us;
        zero_us = time_us < zero_us ? time_us : zero_us;
    }
    return zero_us == INT64_MAX || llabs(zero_us) < LATE_US ? 0 : zero_us;
}

void picture_data_write_time_label(const struct picture_data *data, char *text, size_t size)
{
    const int64_t zero_us = picture_data_time_origin_us(data);
    if (zero_us == 0) {
        snprintf(text, size, "time (s)");
    } else {
        snprintf(text, size, "time (s), from %.15g on", (double)zero_us * 1e-6);
    }
}

double plot_data_number_in_column(const struct plot_point *track, const char *column)
{
    return table_number_or(track->table, track->row, table_find_column(track->table, column), NAN);
}

bool picture_data_sigma_ellipse(const struct plot_point *track, struct plot_ellipse *ellipse)
{
    const double xx = plot_data_number_in_column(track, "cov_x_x"),
                 yx = plot_data_number_in_column(track, "cov_y_x");
    const double yy = plot_data_number_in_column(track, "cov_y_y"),
                 sigma_m = plot_data_number_in_column(track, "sigma_m");
    if (isnan(xx) || isnan(yx) || isnan(yy)) {
        *ellipse = (struct plot_ellipse){sigma_m, sigma_m, 0.0};
        return !isnan(sigma_m);
    }
    const double mean = 0.5 * (xx + yy), spread = hypot(0.5 * (xx - yy), yx);
    *ellipse = (struct plot_ellipse){.major_m = sqrt(mean + spread),
                                     .minor_m = sqrt(fmax(mean - spread, 0.0)),
                                     .angle_rad = 0.5 * atan2(2.0 * yx, xx - yy)};
    return true;
}

void picture_data_free(struct picture_data *data)
{
    free(data->plots.list);
    free(data->tracks.list);
    free(data->truth.list);
    free(data->bearings.list);
    free(data->bearings.sensors);
    free(data->radars);
    free(data->plot_paths);
    for (size_t i = 0; i < data->num_track_tables; i++) {
        table_free(data->track_tables[i]);
    }
    free(data->track_tables);
}
