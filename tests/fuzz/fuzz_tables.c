/* SPDX-License-Identifier: MIT */
/*
 * The CSV readers on any file: the table itself, plots to scans, bearings to frames, and what the
 * plot command reads (truth and tracks, too). The first byte selects the reader, whether bad rows
 * are skipped, whether rows within half a second are one scan, and whether numbers of frames are
 * times; the rest is the file.
 */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "catch_reader_fail.h"
#include "io/csv/csv_table.h"
#include "io/csv/local_frame.h"
#include "io/scans/bearing_reader.h"
#include "io/scans/plot_reader.h"
#include "picture/picture_data.h"
#include "rhotrack/types.h"
#include "settings/parameters.h"

static void abort_unless(bool holds)
{
    if (!holds) {
        abort();
    }
}

/* ---- The readers ---- */

static bool is_within(float v, float limit)
{
    return v >= -limit && v <= limit; /* false for NaN, too */
}

static void read_table_and_check_cells(const char *path, bool keep_going)
{
    struct table *table = table_read(path, keep_going);
    int64_t time_us;
    int32_t integer;
    double number;

    for (size_t row = 0; row < table->num_rows; row++) {
        abort_unless(row == 0 || table->lines[row] > table->lines[row - 1]);
        for (size_t column = 0; column < table->num_columns; column++) {
            abort_unless(table_read_number(table, row, (int)column, &number) ||
                         isfinite((float)number));
            abort_unless(table_read_time_us(table, row, (int)column, &time_us) ||
                         (time_us >= -RHO_LIMIT_TIME_US && time_us <= RHO_LIMIT_TIME_US));
            (void)table_read_int32(table, row, (int)column, &integer);
        }
    }
    table_free(table);
}

static void check_scan(const struct rho_scan *scan)
{
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        const struct rho_plot *plot = &scan->plots[i];

        abort_unless(is_within(plot->x_m, RHO_LIMIT_POSITION_M) &&
                     is_within(plot->y_m, RHO_LIMIT_POSITION_M));
        abort_unless(is_within(plot->z_m, RHO_LIMIT_POSITION_M) &&
                     is_within(plot->snr_db, INFINITY));
        abort_unless(is_within(plot->vx_mps, RHO_LIMIT_SPEED_MPS) &&
                     is_within(plot->vy_mps, RHO_LIMIT_SPEED_MPS));
        abort_unless(is_within(plot->vz_mps, RHO_LIMIT_SPEED_MPS));
        abort_unless(plot->offset_us >= -RHO_LIMIT_OFFSET_US &&
                     plot->offset_us <= RHO_LIMIT_OFFSET_US);
    }
}

static void read_scans(char *path, const struct parameters *parameters, bool keep_going)
{
    struct plot_reader *reader = plot_reader_open(&path, 1, parameters, keep_going);
    const struct rho_scan *scan;
    int64_t before_us = INT64_MIN;
    uint64_t num_scans = 0;

    while ((scan = plot_reader_next(reader))) {
        abort_unless(scan->time_us >= before_us);
        before_us = scan->time_us;
        num_scans++;
        check_scan(scan);
        (void)plot_reader_sensor(reader);
    }
    abort_unless(num_scans == plot_reader_counts(reader).scans);
    plot_reader_close(reader);
}

static void check_frame(const struct rho_frame *frame)
{
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        const struct rho_bearing_scan *scan = &frame->scans[i];

        abort_unless(i == 0 || scan->sensor_id > scan[-1].sensor_id);
        abort_unless(is_within(scan->x_m, RHO_LIMIT_POSITION_M) &&
                     is_within(scan->y_m, RHO_LIMIT_POSITION_M) &&
                     is_within(scan->z_m, RHO_LIMIT_POSITION_M));
        for (uint32_t k = 0; k < scan->num_bearings; k++) {
            abort_unless(is_within(scan->bearings[k].bearing_rad, 3.1415928f));
            abort_unless(is_within(scan->bearings[k].sigma_rad, RHO_LIMIT_SIGMA_RAD_MAX));
            abort_unless(is_within(scan->bearings[k].elevation_rad, 1.5707964f));
            abort_unless(is_within(scan->bearings[k].sigma_elevation_rad, RHO_LIMIT_SIGMA_RAD_MAX));
        }
    }
}

static void read_frames(char *path, const struct parameters *parameters, bool keep_going)
{
    struct bearing_reader *reader = bearing_reader_open(&path, 1, parameters, keep_going);
    const struct rho_frame *frame;
    int64_t before_us = INT64_MIN;
    uint64_t num_frames = 0;

    while ((frame = bearing_reader_next(reader))) {
        abort_unless(frame->time_us >= before_us && frame->num_scans <= RHO_MAX_SENSORS);
        before_us = frame->time_us;
        num_frames++;
        check_frame(frame);
    }
    abort_unless(num_frames == bearing_reader_num_frames(reader));
    bearing_reader_close(reader);
}

static void read_plot_command_data(char *path, const struct parameters *parameters)
{
    struct picture_data data = picture_data_read(&path, 1, parameters);

    picture_data_free(&data);
}

/* ---- One run ---- */

struct reading {
    char *path;
    struct parameters parameters;
    unsigned which;
};

static void read_file(void *context)
{
    const struct reading *reading = context;
    const bool keep_going = (reading->which & 4) != 0;

    switch (reading->which & 3) {
    case 0:
        read_table_and_check_cells(reading->path, keep_going);
        break;
    case 1:
        read_scans(reading->path, &reading->parameters, keep_going);
        break;
    case 2:
        read_frames(reading->path, &reading->parameters, keep_going);
        break;
    default:
        read_plot_command_data(reading->path, &reading->parameters);
    }
}

/* With an origin set, latitudes and longitudes are read, and sensor 3 has a geodetic place. */
static void set_origin(struct parameters *parameters, bool is_set)
{
    const enum parameter_source source = is_set ? SOURCE_SET : SOURCE_UNSET;

    parameters->source[PARAMETER_ORIGIN_LAT_DEG] = source;
    parameters->source[PARAMETER_ORIGIN_LON_DEG] = source;
    parameters->value[PARAMETER_ORIGIN_LAT_DEG] = 50.0;
    parameters->value[PARAMETER_ORIGIN_LON_DEG] = 10.0;
    parameters->num_sensors = is_set ? 1 : 0;
    parameters->sensors[0] = (struct sensor_parameters){.sensor_id = 3};
    for (int id = SENSOR_LAT_DEG; id <= SENSOR_LON_DEG; id++) {
        parameters->sensors[0].source[id] = source;
        parameters->sensors[0].value[id] = 20.0;
    }
}

/*
 * Creates what PROJ keeps for the whole process before the first run's memory is counted; PROJ
 * works without its database.
 */
static void open_what_the_process_keeps(struct parameters *parameters)
{
    abort_unless(setenv("PROJ_DATA", "/nonexistent", 1) == 0);
    set_origin(parameters, true);
    local_frame_close(parameters_open_local_frame(parameters));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct reading reading;

    if (!reading.path) {
        reading.path = refusal_write_file(data, 0);
        parameters_set_defaults(&reading.parameters);
        open_what_the_process_keeps(&reading.parameters);
        refusal_install_hooks();
    }
    if (size == 0) {
        return 0;
    }
    refusal_write_file(data + 1, size - 1);
    set_origin(&reading.parameters, (data[0] & 16) != 0);
    reading.parameters.value[PARAMETER_SCAN_INTERVAL_S] = (data[0] & 8) != 0 ? 0.5 : 0.0;
    reading.parameters.value[PARAMETER_FRAME_RATE_HZ] = (data[0] & 32) != 0 ? 10.0 : 0.0;
    reading.which = data[0];
    refusal_is_refused(read_file, &reading);
    return 0;
}
