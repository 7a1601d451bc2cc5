/* SPDX-License-Identifier: MIT */
#include "python_interface.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/common.h"
#include "io/asterix/asterix_file.h"
#include "io/asterix/asterix_plot_rows.h"
#include "io/log/lcm_log.h"
#include "io/log/log_table.h"
#include "io/rows/rows_from_csv.h"
#include "io/scans/bearing_reader.h"
#include "io/scans/merged_inputs.h"
#include "live/node_core.h"
#include "maintenance/maintainer.h"
#include "pipeline/pipeline.h"
#include "rhotrack/detail/measurement.h"
#include "settings/initiation_methods.h"
#include "settings/parameters.h"

/* ---- Failures ---- */

/*
 * A call that fails ends the command-line program; here it returns to the caller. The files that it
 * has open are closed (the linker's --wrap lists them); its memory, of a reader some kilobytes, is
 * lost.
 */
#define FILES_MAX 16

static _Thread_local struct {
    jmp_buf back;
    int exit_code;
    char message[8192];
    FILE *streams[FILES_MAX];
    int files[FILES_MAX]; /* 0: none */
} failure;

/* Stores the failure, closes open files and jumps back to the function that armed the handler. */
static _Noreturn void store_failure_and_jump_back(int exit_code, const char *message)
{
    failure.exit_code = exit_code;
    snprintf(failure.message, sizeof failure.message, "%s", message);
    for (int i = 0; i < FILES_MAX; i++) {
        if (failure.streams[i]) {
            fclose(failure.streams[i]);
        }
        if (failure.files[i]) {
            close(failure.files[i]);
        }
    }
    longjmp(failure.back, 1);
}

static jmp_buf *arm_failure_handler(void)
{
    memset(failure.streams, 0, sizeof failure.streams);
    memset(failure.files, 0, sizeof failure.files);
    fail_handler = store_failure_and_jump_back;
    return &failure.back;
}

/* Makes the function return `value` when a later call in it fails. */
#define RETURN_ON_FAILURE(value)                                                                   \
    if (setjmp(*arm_failure_handler())) {                                                          \
        return value;                                                                              \
    }

const char *program_last_failure(bool *is_usage)
{
    *is_usage = failure.exit_code == EXIT_USAGE;
    return failure.message;
}

int __real_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...)
{
    va_list arguments;

    va_start(arguments, flags);
    int file = __real_open(path, flags, flags & O_CREAT ? va_arg(arguments, int) : 0);
    va_end(arguments);
    for (int i = 0; i < FILES_MAX && file > 0; i++) {
        if (!failure.files[i]) {
            failure.files[i] = file;
            break;
        }
    }
    return file;
}

int __real_close(int file);
int __wrap_close(int file);
int __wrap_close(int file)
{
    for (int i = 0; i < FILES_MAX; i++) {
        failure.files[i] = failure.files[i] == file ? 0 : failure.files[i];
    }
    return __real_close(file);
}

FILE *__real_fopen(const char *path, const char *mode);
FILE *__wrap_fopen(const char *path, const char *mode);
FILE *__wrap_fopen(const char *path, const char *mode)
{
    FILE *stream = __real_fopen(path, mode);

    for (int i = 0; i < FILES_MAX; i++) {
        if (!failure.streams[i]) {
            failure.streams[i] = stream;
            break;
        }
    }
    return stream;
}

int __real_fclose(FILE *stream);
int __wrap_fclose(FILE *stream);
int __wrap_fclose(FILE *stream)
{
    for (int i = 0; i < FILES_MAX; i++) {
        failure.streams[i] = failure.streams[i] == stream ? NULL : failure.streams[i];
    }
    return __real_fclose(stream);
}

/* ---- Settings ---- */

struct parameters *program_settings_new(const struct parameters *from)
{
    RETURN_ON_FAILURE(NULL)
    struct parameters *settings = must_alloc(sizeof *settings);

    if (from) {
        *settings = *from;
    } else {
        parameters_set_defaults(settings);
    }
    return settings;
}

void program_settings_free(struct parameters *settings)
{
    free(settings);
}

bool program_settings_set(struct parameters *settings, const char *key, const char *value)
{
    char reason[PARAMETER_REASON_BYTES];

    RETURN_ON_FAILURE(false)
    if (!parameters_assign(settings, key, value, SOURCE_SET, reason)) {
        fail(EXIT_USAGE, "%s", reason);
    }
    return true;
}

bool program_settings_load(struct parameters *settings, const char *path)
{
    RETURN_ON_FAILURE(false)
    parameters_load_ini(settings, path);
    return true;
}

bool program_settings_check(const struct parameters *settings)
{
    RETURN_ON_FAILURE(false)
    parameters_check_together(settings);
    return true;
}

bool program_settings_get_parameter(const struct parameters *settings, int index,
                                    struct program_parameter *parameter)
{
    if (index < 0 || index >= NUM_PARAMETERS) {
        return false;
    }
    const enum parameter_id id = (enum parameter_id)index;
    const struct parameter_text text = parameters_text(id);

    *parameter = (struct program_parameter){.name = text.name,
                                            .unit = text.unit,
                                            .text = text.text,
                                            .min = text.min,
                                            .max = text.max,
                                            .is_number = !text.choices};
    if (text.has_default) {
        parameters_value_text(&text, text.value, parameter->initial);
    }
    if (parameters_has_value(settings, id)) {
        parameters_value_text(&text, settings->value[id], parameter->value);
    }
    snprintf(parameter->range, sizeof parameter->range, "%s", text.choices ? text.choices : "");
    return true;
}

/* A copy with the origin that ASTERIX files suggest and the places of sensors in metres. */
static struct parameters *copy_placed_settings(const struct parameters *settings,
                                               char *const *paths, int num_paths)
{
    struct parameters *copy = must_alloc(sizeof *copy);
    struct asterix_place place = {.is_given = false};

    *copy = *settings;
    for (int i = 0; i < num_paths && !place.is_given && !parameters_has_origin(copy); i++) {
        place = asterix_file_radar_place(paths[i]);
        if (place.is_given) {
            asterix_set_default_origin(paths[i], &place, copy);
        }
    }
    parameters_locate_sensors(copy);
    return copy;
}

/* ---- Scans from files ---- */

static void *copy_list(const void *list, size_t count, size_t size)
{
    return count ? memcpy(must_calloc(count, size), list, count * size) : NULL;
}

static struct program_scan *add_empty_scan(struct program_scans *scans)
{
    scans->list =
        must_make_room_for_one(scans->list, scans->count, &scans->capacity, sizeof *scans->list);
    scans->list[scans->count] = (struct program_scan){.is_frame = false};
    return &scans->list[scans->count++];
}

static void add_copy_of_input(struct program_scans *scans, const struct input *input)
{
    struct program_scan *scan = add_empty_scan(scans);

    if (input->scan) {
        scan->scan = *input->scan;
        scan->scan.plots =
            copy_list(input->scan->plots, input->scan->num_plots, sizeof *input->scan->plots);
        scan->has_sensor = input->sensor;
        scan->sensor = input->sensor ? *input->sensor : scan->sensor;
        return;
    }
    struct rho_bearing_scan *looks =
        copy_list(input->frame->scans, input->frame->num_scans, sizeof *looks);

    for (uint32_t i = 0; i < input->frame->num_scans; i++) {
        looks[i].bearings =
            copy_list(looks[i].bearings, looks[i].num_bearings, sizeof *looks[i].bearings);
    }
    scan->is_frame = true;
    scan->frame = *input->frame;
    scan->frame.scans = looks;
}

struct program_scans *program_read_scans(char *const *paths, int num_paths,
                                         const struct parameters *settings, bool keep_going)
{
    RETURN_ON_FAILURE(NULL)
    struct parameters *parameters = copy_placed_settings(settings, paths, num_paths);
    struct merged_inputs *inputs = merged_inputs_open(paths, num_paths, parameters, keep_going);
    struct program_scans *scans = must_calloc(1, sizeof *scans);

    for (struct input input = merged_inputs_next(inputs); input.scan || input.frame;
         input = merged_inputs_next(inputs)) {
        add_copy_of_input(scans, &input);
    }
    merged_inputs_close(inputs);
    free(parameters);
    return scans;
}

void program_scans_free(struct program_scans *scans)
{
    for (size_t i = 0; i < scans->count; i++) {
        const struct program_scan *scan = &scans->list[i];

        free((void *)scan->scan.plots);
        for (uint32_t k = 0; k < scan->frame.num_scans; k++) {
            free((void *)scan->frame.scans[k].bearings);
        }
        free((void *)scan->frame.scans);
    }
    free(scans->list);
    free(scans);
}

/* ---- Rows of scans ---- */

static double us_to_seconds(int64_t time_us)
{
    return (double)time_us / 1e6;
}

static int64_t seconds_to_us(double time_s)
{
    return llround(time_s * 1e6);
}

/* A row with a time and a sensor; all other cells are NAN. */
static struct program_row make_empty_row(int64_t time_us, int32_t sensor_id)
{
    return (struct program_row){.t_s = us_to_seconds(time_us),
                                .sensor_id = sensor_id,
                                .x_m = NAN,
                                .y_m = NAN,
                                .z_m = NAN,
                                .vx_mps = NAN,
                                .vy_mps = NAN,
                                .vz_mps = NAN,
                                .range_m = NAN,
                                .azimuth_rad = NAN,
                                .elevation_rad = NAN,
                                .range_rate_mps = NAN,
                                .bearing_rad = NAN,
                                .sigma_m = NAN,
                                .sigma_mps = NAN,
                                .sigma_range_m = NAN,
                                .sigma_cross_m = NAN,
                                .sigma_up_m = NAN,
                                .sigma_azimuth_rad = NAN,
                                .sigma_elevation_rad = NAN,
                                .sigma_range_rate_mps = NAN,
                                .sigma_rad = NAN,
                                .snr_db = NAN,
                                .sector_from_rad = NAN,
                                .sector_to_rad = NAN,
                                .sensor_x_m = NAN,
                                .sensor_y_m = NAN,
                                .sensor_z_m = NAN};
}

/* True if the first plot does not give the scan's time, so that a row without a plot must. */
static bool is_scan_time_own(const struct rho_scan *scan)
{
    return scan->num_plots == 0 || scan->plots[0].offset_us != 0;
}

/* True if the first bearing does not give the look's time, so that a row without one must. */
static bool look_needs_time_row(const struct rho_bearing_scan *look)
{
    return look->num_bearings == 0 || look->bearings[0].offset_us != 0;
}

uint32_t program_scan_num_rows(const struct program_scan *scan)
{
    uint32_t count = 0;

    if (!scan->is_frame) {
        return scan->scan.num_plots + is_scan_time_own(&scan->scan);
    }
    for (uint32_t i = 0; i < scan->frame.num_scans; i++) {
        count += scan->frame.scans[i].num_bearings + look_needs_time_row(&scan->frame.scans[i]);
    }
    return count;
}

static void set_sector(struct program_row *row, float from_rad, float to_rad)
{
    if (from_rad < to_rad || from_rad > to_rad) {
        row->sector_from_rad = from_rad;
        row->sector_to_rad = to_rad;
    }
}

static void write_plot_to_row(struct program_row *row, const struct rho_plot *plot,
                              uint32_t measures)
{
    row->x_m = plot->x_m;
    row->y_m = plot->y_m;
    row->sigma_range_m = plot->sigma_range_m;
    row->sigma_cross_m = plot->sigma_cross_m;
    row->snr_db = plot->snr_db != 0.0f ? plot->snr_db : NAN;
    if (measures & RHO_MEASURES_Z) {
        row->z_m = plot->z_m;
        row->sigma_up_m = plot->sigma_up_m;
    }
    if (measures & RHO_MEASURES_VELOCITY) {
        row->vx_mps = plot->vx_mps;
        row->vy_mps = plot->vy_mps;
        row->vz_mps = plot->vz_mps;
        row->sigma_mps = plot->sigma_mps;
    }
    if (measures & RHO_MEASURES_RANGE_RATE) {
        row->range_rate_mps = plot->range_rate_mps;
        row->sigma_range_rate_mps = plot->sigma_range_rate_mps;
    }
}

static void write_rows_of_plots(const struct program_scan *from, struct program_row *rows)
{
    const struct rho_scan *scan = &from->scan;
    struct program_row common = make_empty_row(scan->time_us, scan->sensor_id);

    set_sector(&common, scan->sector_from_rad, scan->sector_to_rad);
    if (from->has_sensor) {
        common.sensor_x_m = from->sensor.x_m;
        common.sensor_y_m = from->sensor.y_m;
        common.sensor_z_m = from->sensor.z_m;
    }
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        rows[i] = common;
        rows[i].t_s = us_to_seconds(scan->time_us + scan->plots[i].offset_us);
        write_plot_to_row(&rows[i], &scan->plots[i], scan->measures);
    }
    if (is_scan_time_own(scan)) {
        rows[scan->num_plots] = common;
    }
}

/* Writes a row for each bearing, and one for the time if needed; returns the end of the rows. */
static struct program_row *write_rows_of_look(const struct rho_bearing_scan *look,
                                              struct program_row *rows)
{
    struct program_row common = make_empty_row(look->time_us, look->sensor_id);

    set_sector(&common, look->sector_from_rad, look->sector_to_rad);
    common.sensor_x_m = look->x_m;
    common.sensor_y_m = look->y_m;
    common.sensor_z_m = look->z_m != 0.0f ? look->z_m : NAN;
    for (uint32_t i = 0; i < look->num_bearings; i++) {
        const struct rho_bearing *bearing = &look->bearings[i];

        *rows = common;
        rows->t_s = us_to_seconds(look->time_us + bearing->offset_us);
        rows->bearing_rad = bearing->bearing_rad;
        rows->sigma_rad = bearing->sigma_rad;
        if (bearing->sigma_elevation_rad > 0.0f) {
            rows->elevation_rad = bearing->elevation_rad;
            rows->sigma_elevation_rad = bearing->sigma_elevation_rad;
        }
        rows++->snr_db = bearing->snr_db != 0.0f ? bearing->snr_db : NAN;
    }
    if (look_needs_time_row(look)) {
        *rows++ = common;
    }
    return rows;
}

void program_scan_write_rows(const struct program_scan *scan, struct program_row *rows)
{
    if (!scan->is_frame) {
        write_rows_of_plots(scan, rows);
        return;
    }
    for (uint32_t i = 0; i < scan->frame.num_scans; i++) {
        rows = write_rows_of_look(&scan->frame.scans[i], rows);
    }
}

/* ---- Scans from rows ---- */

/* The scan that is made of rows; messages of failures name the scan and the row, from 0. */
struct making {
    const struct parameters *settings;
    size_t scan;
    const struct program_row *first; /* the scan's first row */
};

static _Noreturn void fail_at_row(const struct making *making, const struct program_row *row,
                                  const char *why)
{
    fail(EXIT_USAGE, "scan %zu, row %td: %s", making->scan, row - making->first, why);
}

/* The limits of a plot's fields; the library refuses a plot without naming the field. */
#define FIELD(name, min, max)                                                                      \
    {                                                                                              \
#name, offsetof(struct program_row, name), min, max                                        \
    }
#define SIGMA(name) FIELD(name, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_SIGMA_MAX)
#define ANGLE_SIGMA(name) FIELD(name, RHO_LIMIT_SIGMA_RAD_MIN, RHO_LIMIT_SIGMA_RAD_MAX)
#define PLACE(name) FIELD(name, -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M)
#define SPEED(name) FIELD(name, -RHO_LIMIT_SPEED_MPS, RHO_LIMIT_SPEED_MPS)
static const struct {
    const char *name;
    size_t offset;
    float min, max;
} limits[] = {
    PLACE(x_m),
    PLACE(y_m),
    PLACE(z_m),
    FIELD(range_m, 1e-30f, RHO_LIMIT_POSITION_M),
    FIELD(azimuth_rad, -3.1415927f, 3.1415927f),
    FIELD(elevation_rad, -1.5707964f, 1.5707964f),
    SPEED(vx_mps),
    SPEED(vy_mps),
    SPEED(vz_mps),
    SPEED(range_rate_mps),
    SIGMA(sigma_m),
    SIGMA(sigma_range_m),
    SIGMA(sigma_cross_m),
    SIGMA(sigma_up_m),
    SIGMA(sigma_mps),
    SIGMA(sigma_range_rate_mps),
    ANGLE_SIGMA(sigma_azimuth_rad),
    ANGLE_SIGMA(sigma_elevation_rad),
};

/* Ends the call with a message that names the first field outside its limits, else with `why`. */
static _Noreturn void fail_at_plot_field(const struct making *making, const struct program_row *row,
                                         const char *why)
{
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        float value;

        memcpy(&value, (const char *)row + limits[i].offset, sizeof value);
        if (value < limits[i].min || value > limits[i].max) {
            fail(EXIT_USAGE, "scan %zu, row %td: %s %g is outside %g .. %g", making->scan,
                 row - making->first, limits[i].name, (double)value, (double)limits[i].min,
                 (double)limits[i].max);
        }
    }
    fail_at_row(making, row, why);
}

static bool is_row_polar(const struct program_row *row)
{
    return !isnan(row->range_m);
}

static bool row_has_plot(const struct program_row *row)
{
    return is_row_polar(row) || !isnan(row->x_m) || !isnan(row->y_m);
}

static float value_or_default(float value, double default_value)
{
    return isnan(value) ? (float)default_value : value;
}

static double sensor_value_or_general(const struct making *making, int32_t sensor_id,
                                      enum sensor_parameter_id id, enum parameter_id general_id)
{
    return parameters_value_of_sensor(making->settings, sensor_id, id,
                                      making->settings->value[general_id]);
}

static int64_t row_time_us(const struct making *making, const struct program_row *row)
{
    if (!(fabs(row->t_s) <= 1e-6 * (double)RHO_LIMIT_TIME_US)) {
        fail_at_row(making, row, "t_s is not a time");
    }
    return seconds_to_us(row->t_s);
}

static int32_t row_offset_us(const struct making *making, const struct program_row *row,
                             int64_t scan_us)
{
    const int64_t offset_us = row_time_us(making, row) - scan_us;

    if (offset_us < -RHO_LIMIT_OFFSET_US || offset_us > RHO_LIMIT_OFFSET_US) {
        fail_at_row(making, row, "t_s is more than a minute from the scan's");
    }
    return (int32_t)offset_us;
}

static uint32_t row_measures(const struct program_row *row)
{
    return (isnan(is_row_polar(row) ? row->elevation_rad : row->z_m) ? 0 : RHO_MEASURES_Z) |
           (isnan(row->vx_mps) || is_row_polar(row) ? 0 : RHO_MEASURES_VELOCITY) |
           (isnan(row->range_rate_mps) ? 0 : RHO_MEASURES_RANGE_RATE);
}

static void check_row_fits_scan(const struct making *making, const struct program_row *row,
                                const struct rho_scan *scan)
{
    const uint32_t differing = row_measures(row) ^ scan->measures;

    if (row->sensor_id != scan->sensor_id) {
        fail_at_row(making, row, "sensor_id differs from that of the scan's first row");
    }
    if (differing) {
        fail_at_row(making, row,
                    differing & RHO_MEASURES_Z
                        ? "z_m or elevation_rad is in some rows of the scan alone"
                    : differing & RHO_MEASURES_VELOCITY
                        ? "vx_mps is in some rows of the scan alone"
                        : "range_rate_mps is in some rows of the scan alone");
    }
}

static void make_polar_plot(const struct making *making, const struct program_row *row,
                            const struct rho_scan *scan, const struct rho_sensor *sensor,
                            struct rho_plot *plot)
{
    const int32_t id = row->sensor_id;
    struct rho_sensor seen_from = *sensor;
    const struct rho_polar_plot polar = {
        .range_m = row->range_m,
        .azimuth_rad = row->azimuth_rad,
        .elevation_rad = row->elevation_rad,
        .range_rate_mps = row->range_rate_mps,
        .sigma_range_m = value_or_default(
            row->sigma_range_m,
            sensor_value_or_general(making, id, SENSOR_SIGMA_RANGE_M, PARAMETER_SIGMA_RANGE_M)),
        .sigma_azimuth_rad = value_or_default(
            row->sigma_azimuth_rad, sensor_value_or_general(making, id, SENSOR_SIGMA_AZIMUTH_RAD,
                                                            PARAMETER_SIGMA_AZIMUTH_RAD)),
        .sigma_elevation_rad =
            value_or_default(row->sigma_elevation_rad,
                             sensor_value_or_general(making, id, SENSOR_SIGMA_ELEVATION_RAD,
                                                     PARAMETER_SIGMA_ELEVATION_RAD)),
        .sigma_range_rate_mps =
            value_or_default(row->sigma_range_rate_mps,
                             sensor_value_or_general(making, id, SENSOR_SIGMA_RANGE_RATE_MPS,
                                                     PARAMETER_SIGMA_RANGE_RATE_MPS)),
        .snr_db = value_or_default(row->snr_db, 0.0)};

    seen_from.time_bias_s = 0.0f;
    if (isnan(row->azimuth_rad)) {
        fail_at_row(making, row, "azimuth_rad is missing or not a number");
    }
    if (rho_measurement_from_polar(&polar, scan->measures, &seen_from, plot) != RHO_OK) {
        fail_at_plot_field(making, row,
                           "range_m, azimuth_rad, elevation_rad or a sigma is out of range");
    }
}

static void make_cartesian_plot(const struct making *making, const struct program_row *row,
                                struct rho_plot *plot)
{
    const int32_t id = row->sensor_id;
    const float sigma_m = value_or_default(
        row->sigma_m, sensor_value_or_general(making, id, SENSOR_SIGMA_M, PARAMETER_SIGMA_M));

    *plot = (struct rho_plot){
        .x_m = row->x_m,
        .y_m = row->y_m,
        .z_m = value_or_default(row->z_m, 0.0),
        .vx_mps = value_or_default(row->vx_mps, 0.0),
        .vy_mps = value_or_default(row->vy_mps, 0.0),
        .vz_mps = value_or_default(row->vz_mps, 0.0),
        .range_rate_mps = value_or_default(row->range_rate_mps, 0.0),
        .sigma_range_m = value_or_default(row->sigma_range_m, (double)sigma_m),
        .sigma_cross_m = value_or_default(row->sigma_cross_m, (double)sigma_m),
        .sigma_up_m = value_or_default(row->sigma_up_m, (double)sigma_m),
        .sigma_mps =
            value_or_default(row->sigma_mps, sensor_value_or_general(making, id, SENSOR_SIGMA_MPS,
                                                                     PARAMETER_SIGMA_MPS)),
        .sigma_range_rate_mps =
            value_or_default(row->sigma_range_rate_mps,
                             sensor_value_or_general(making, id, SENSOR_SIGMA_RANGE_RATE_MPS,
                                                     PARAMETER_SIGMA_RANGE_RATE_MPS)),
        .snr_db = value_or_default(row->snr_db, 0.0)};
    if (isnan(row->x_m) || isnan(row->y_m)) {
        fail_at_row(making, row,
                    isnan(row->x_m) ? "x_m is missing or not a number"
                                    : "y_m is missing or not a number");
    }
    if (!rho_measurement_is_valid_plot(plot, row_measures(row))) {
        fail_at_plot_field(making, row, "x_m, y_m, z_m, a velocity or a sigma is out of range");
    }
}

/* Makes a scan of rows; a row without a plot gives the scan's time, else the first plot does. */
static void make_scan_of_plots(const struct making *making, const struct program_row *rows,
                               uint32_t count, struct program_scan *made)
{
    struct rho_scan *scan = &made->scan;
    struct rho_plot *plots;
    const struct program_row *measured = NULL, *own = NULL;

    for (uint32_t i = 0; i < count; i++) {
        measured = !measured && row_has_plot(&rows[i]) ? &rows[i] : measured;
        own = !own && !row_has_plot(&rows[i]) ? &rows[i] : own;
    }
    scan->time_us = row_time_us(making, own ? own : rows);
    scan->sensor_id = rows->sensor_id;
    scan->sector_from_rad = value_or_default(rows->sector_from_rad, 0.0);
    scan->sector_to_rad = value_or_default(rows->sector_to_rad, 0.0);
    scan->measures = measured ? row_measures(measured) : 0;
    made->has_sensor = parameters_to_sensor(making->settings, rows->sensor_id, &made->sensor) ||
                       !isnan(rows->sensor_x_m) || !isnan(rows->sensor_z_m);
    parameters_sensor_or_default(making->settings, rows->sensor_id, &made->sensor);
    made->sensor.x_m = value_or_default(rows->sensor_x_m, (double)made->sensor.x_m);
    made->sensor.y_m = value_or_default(rows->sensor_y_m, (double)made->sensor.y_m);
    made->sensor.z_m = value_or_default(rows->sensor_z_m, (double)made->sensor.z_m);
    scan->plots = plots = must_calloc(count, sizeof *plots);
    for (uint32_t i = 0; i < count; i++) {
        if (row_has_plot(&rows[i])) {
            struct rho_plot *plot = &plots[scan->num_plots++];

            check_row_fits_scan(making, &rows[i], scan);
            if (is_row_polar(&rows[i])) {
                make_polar_plot(making, &rows[i], scan, &made->sensor, plot);
            } else {
                make_cartesian_plot(making, &rows[i], plot);
            }
            plot->offset_us = row_offset_us(making, &rows[i], scan->time_us);
        }
    }
}

static void make_look_of_rows(const struct making *making, const struct program_row *rows,
                              uint32_t count, struct rho_bearing_scan *look)
{
    struct rho_bearing *bearings = must_calloc(count, sizeof *bearings);
    const struct program_row *own = rows;

    for (uint32_t i = count; i-- > 0;) {
        own = isnan(rows[i].bearing_rad) ? &rows[i] : own;
    }
    *look =
        (struct rho_bearing_scan){.time_us = row_time_us(making, own),
                                  .sensor_id = rows->sensor_id,
                                  .x_m = rows->sensor_x_m,
                                  .y_m = rows->sensor_y_m,
                                  .z_m = value_or_default(rows->sensor_z_m, 0.0),
                                  .sector_from_rad = value_or_default(rows->sector_from_rad, 0.0),
                                  .sector_to_rad = value_or_default(rows->sector_to_rad, 0.0),
                                  .bearings = bearings};
    if (!rho_is_coordinate(look->x_m) || !rho_is_coordinate(look->y_m) ||
        !rho_is_coordinate(look->z_m)) {
        fail_at_row(making, rows, "sensor_x_m, sensor_y_m and sensor_z_m are not a place");
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!isnan(rows[i].bearing_rad)) {
            const double sigma_rad = sensor_value_or_general(making, rows->sensor_id,
                                                             SENSOR_SIGMA_RAD, PARAMETER_SIGMA_RAD);
            struct rho_bearing *bearing = &bearings[look->num_bearings++];

            *bearing =
                (struct rho_bearing){.offset_us = row_offset_us(making, &rows[i], look->time_us),
                                     .bearing_rad = rows[i].bearing_rad,
                                     .sigma_rad = value_or_default(rows[i].sigma_rad, sigma_rad),
                                     .snr_db = value_or_default(rows[i].snr_db, 0.0)};
            if (!isnan(rows[i].elevation_rad)) {
                bearing->elevation_rad = rows[i].elevation_rad;
                bearing->sigma_elevation_rad = value_or_default(
                    rows[i].sigma_elevation_rad,
                    sensor_value_or_general(making, rows->sensor_id, SENSOR_SIGMA_ELEVATION_RAD,
                                            PARAMETER_SIGMA_ELEVATION_RAD));
            }
            if (!rho_bearing_is_valid(bearing)) {
                fail_at_row(making, &rows[i], "a bearing, an elevation or a sigma is out of range");
            }
        }
    }
}

/* Makes a frame of looks; successive rows of one sensor are a look. */
static void make_frame_of_looks(const struct making *making, const struct program_row *rows,
                                uint32_t count, struct program_scan *made)
{
    struct rho_bearing_scan *looks = must_calloc(count, sizeof *looks);
    struct rho_frame *frame = &made->frame;

    made->is_frame = true;
    *frame = (struct rho_frame){.time_us = INT64_MAX, .scans = looks};
    for (uint32_t first = 0, i = 1; i <= count; i++) {
        if (i == count || rows[i].sensor_id != rows[first].sensor_id) {
            struct rho_bearing_scan *look = &looks[frame->num_scans++];

            make_look_of_rows(making, &rows[first], i - first, look);
            frame->time_us = look->time_us < frame->time_us ? look->time_us : frame->time_us;
            first = i;
        }
    }
}

struct program_scans *program_scans_from_rows(const struct program_row *rows,
                                              const uint32_t *counts, const bool *are_frames,
                                              size_t count, const struct parameters *settings)
{
    struct program_scans *volatile scans = NULL;

    if (setjmp(*arm_failure_handler())) {
        if (scans) {
            program_scans_free(scans);
        }
        return NULL;
    }
    struct parameters *parameters = copy_placed_settings(settings, NULL, 0);

    scans = must_calloc(1, sizeof *scans);
    for (size_t i = 0; i < count; i++) {
        const struct making making = {.settings = parameters, .scan = i, .first = rows};

        if (counts[i] == 0) {
            fail(EXIT_USAGE, "scan %zu has no row: a scan that saw nothing is a row without a plot",
                 i);
        }
        (are_frames[i] ? make_frame_of_looks : make_scan_of_plots)(&making, rows, counts[i],
                                                                   add_empty_scan(scans));
        rows += counts[i];
    }
    free(parameters);
    return scans;
}

/* ---- Tables ---- */

const char *program_kind_of_file(const char *path)
{
    RETURN_ON_FAILURE(NULL)
    if (lcm_log_is_log(path) || asterix_file_is_asterix(path)) {
        return "scans";
    }
    struct table *header = table_read_header(path);
    const char *kind =
        table_find_column(header, "status") >= 0 && table_find_column(header, "track_id") >= 0
            ? "tracks"
        : table_find_column(header, "target_id") >= 0 && table_find_column(header, "sensor_id") < 0
            ? "truth"
            : "scans";

    table_free(header);
    return kind;
}

struct program_table *program_read_table(const char *path, const char *kind_name,
                                         const struct parameters *settings, bool keep_going)
{
    RETURN_ON_FAILURE(NULL)
    struct parameters *parameters = copy_placed_settings(settings, NULL, 0);
    const struct rows_kind *kind =
        strcmp(kind_name, "truth") == 0 ? &rows_kind_truth : &rows_kind_tracks;
    struct table *table = log_table_or_csv(path, kind, keep_going);
    struct program_table *made = must_calloc(1, sizeof *made);
    const char **names = must_calloc((size_t)kind->num_columns, sizeof *names);
    struct rows_file file;

    (void)rows_read_table_and_has_any(&file, path, table, parameters, keep_going);
    for (int i = 0; i < kind->num_columns; i++) {
        names[i] = column_name(kind->columns[i].id);
    }
    *made = (struct program_table){
        .num_columns = kind->num_columns,
        .num_rows = file.rows.count,
        .names = names,
        .t_s = must_calloc(file.rows.count, sizeof(double)),
        .cells = must_calloc(file.rows.count * (size_t)kind->num_columns, sizeof(double))};
    for (size_t i = 0; i < made->num_rows; i++) {
        const struct row *row = &file.rows.list[i];

        made->t_s[i] = us_to_seconds(row->time_us);
        memcpy(&made->cells[i * (size_t)kind->num_columns], rows_cells(&file.rows, row),
               (size_t)kind->num_columns * sizeof(double));
    }
    rows_file_free(&file);
    table_free(table);
    free(parameters);
    return made;
}

void program_table_free(struct program_table *table)
{
    free((void *)table->names);
    free(table->t_s);
    free(table->cells);
    free(table);
}

/* ---- The tracker ---- */

static void add_track(struct program_tracks *tracks, int64_t time_us,
                      const struct rho_track_report *track)
{
    const char *status = rho_track_status_name(track->status);

    if (tracks->count == tracks->capacity) {
        tracks->capacity = 2 * tracks->capacity + 64;
        tracks->list = must_realloc(tracks->list, tracks->capacity * sizeof *tracks->list);
        if (tracks->has_covariances) {
            tracks->covariances =
                must_realloc(tracks->covariances, tracks->capacity * sizeof *tracks->covariances);
        }
        if (tracks->has_bodies) {
            tracks->bodies =
                must_realloc(tracks->bodies, tracks->capacity * sizeof *tracks->bodies);
        }
    }
    struct program_track *row = &tracks->list[tracks->count];

    *row = (struct program_track){.t_s = us_to_seconds(time_us),
                                  .track_id = track->track_id,
                                  .x_m = track->state[RHO_X],
                                  .y_m = track->state[RHO_Y],
                                  .z_m = track->state[RHO_Z],
                                  .vx_mps = track->state[RHO_VX],
                                  .vy_mps = track->state[RHO_VY],
                                  .vz_mps = track->state[RHO_VZ],
                                  .ax_mps2 = track->accel_mps2[0],
                                  .ay_mps2 = track->accel_mps2[1],
                                  .az_mps2 = track->accel_mps2[2],
                                  .sigma_m = track->sigma_m,
                                  .sigma_mps = track->sigma_mps,
                                  .hits = track->hits,
                                  .misses = track->misses,
                                  .sensor_id = track->sensor_id,
                                  .plot = track->plot,
                                  .update_age_us = track->update_age_us,
                                  .score_nat = track->score_nat,
                                  .maneuver_probability = track->maneuver_probability};
    for (size_t k = 0; status[k] && k < sizeof row->status / sizeof *row->status; k++) {
        row->status[k] = (unsigned char)status[k];
    }
    if (tracks->has_covariances) {
        memcpy(tracks->covariances[tracks->count], track->covariance, sizeof track->covariance);
    }
    tracks->count++;
}

/* Appends the report's tracks, with their bodies if the tracker estimates bodies. */
static void add_tracks_of_report(struct program_tracks *tracks, const struct rho_report *report,
                                 const struct rho_tracker *tracker)
{
    tracks->has_bodies = tracker->bodies.length_max_m > 0.0f;
    for (unsigned i = 0; i < report->num_tracks; i++) {
        if (report->tracks[i].is_in_doubt) {
            continue;
        }
        add_track(tracks, report->time_us, &report->tracks[i]);
        if (tracks->has_bodies) {
            struct rho_body *body = &tracks->bodies[tracks->count - 1];

            *body = (struct rho_body){NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
            (void)rho_tracker_body_of(tracker, i, body);
        }
    }
}

void program_tracks_free(struct program_tracks *tracks)
{
    free(tracks->list);
    free(tracks->covariances);
    free(tracks->bodies);
}

struct program_pipeline *program_pipeline_new(const struct parameters *settings,
                                              bool has_covariances)
{
    RETURN_ON_FAILURE(NULL)
    parameters_check_together(settings);
    pipeline_options_to_parameters((struct parameters *)settings, &(struct pipeline_options){NULL});
    struct program_pipeline *made = must_calloc(1, sizeof *made);

    made->settings = copy_placed_settings(settings, NULL, 0);
    made->pipeline = must_alloc(sizeof *made->pipeline);
    *made->pipeline = pipeline_allocate();
    made->tracker = &made->pipeline->node->tracker;
    made->report = &made->pipeline->node->report;
    made->tracks.has_covariances = has_covariances;
    pipeline_open(made->pipeline, made->settings);
    made->learning = pipeline_learning(made->pipeline);
    return made;
}

void program_pipeline_free(struct program_pipeline *made)
{
    pipeline_free(made->pipeline);
    free(made->pipeline);
    free(made->settings);
    program_tracks_free(&made->tracks);
    free(made);
}

static void set_sensor_of_tracker(const struct program_pipeline *made,
                                  const struct rho_sensor *sensor)
{
    must_succeed(rho_tracker_set_sensor(made->tracker, sensor), "sensor");
}

static int compare_looks_by_sensor_id(const void *a, const void *b)
{
    const struct rho_bearing_scan *const *one = a, *const *other = b;

    return ((*one)->sensor_id > (*other)->sensor_id) - ((*one)->sensor_id < (*other)->sensor_id);
}

/* Tells the tracker all passive sensors of the scans before the first step. */
static void set_passive_sensors_of_tracker(const struct program_pipeline *made,
                                           const struct program_scans *scans)
{
    const struct rho_bearing_scan *known[RHO_MAX_SENSORS];
    size_t num_known = 0;

    for (size_t i = 0; i < scans->count; i++) {
        for (uint32_t k = 0; k < scans->list[i].frame.num_scans; k++) {
            const struct rho_bearing_scan *look = &scans->list[i].frame.scans[k];
            size_t place = 0;

            while (place < num_known && known[place]->sensor_id != look->sensor_id) {
                place++;
            }
            if (place == num_known && num_known < RHO_MAX_SENSORS) {
                known[num_known++] = look;
            }
        }
    }
    qsort(known, num_known, sizeof *known, compare_looks_by_sensor_id);
    for (size_t i = 0; i < num_known; i++) {
        const int32_t id = known[i]->sensor_id;
        struct rho_sensor sensor;

        if (parameters_to_sensor(made->settings, id, &sensor)) {
            sensor.x_m = known[i]->x_m;
            sensor.y_m = known[i]->y_m;
            sensor.range_max_m = (float)parameters_range_max_m(made->settings, id);
            set_sensor_of_tracker(made, &sensor);
        }
    }
}

/* Opens the pipeline; bearings alone in the first scans suggest the parameters of `passive`. */
static void open_pipeline_for_scans(struct program_pipeline *made,
                                    const struct program_scans *scans)
{
    bool has_plots = false, has_bearings = false;

    for (size_t i = 0; i < scans->count; i++) {
        has_plots |= !scans->list[i].is_frame;
        has_bearings |= scans->list[i].is_frame;
    }
    if (!made->is_open && scans->count > 0) {
        made->is_open = true;
        if (!has_plots) {
            method_suggest_parameters(METHOD_PASSIVE, made->settings);
            pipeline_open(made->pipeline, made->settings);
        }
    }
    if (has_bearings && !made->pipeline->has_bearings) {
        pipeline_open_passive(made->pipeline, made->settings);
    }
    if (has_bearings) {
        set_passive_sensors_of_tracker(made, scans);
    }
}

bool program_pipeline_run(struct program_pipeline *made, const struct program_scans *scans,
                          bool collects_tracks)
{
    RETURN_ON_FAILURE(false)
    made->tracks.count = 0;
    open_pipeline_for_scans(made, scans);
    for (size_t i = 0; i < scans->count; i++) {
        const struct program_scan *scan = &scans->list[i];

        if (scan->is_frame) {
            pipeline_step_frame(made->pipeline, &scan->frame, NULL, NULL);
        } else {
            if (scan->has_sensor) {
                set_sensor_of_tracker(made, &scan->sensor);
            }
            pipeline_step(made->pipeline, &scan->scan);
            made->min_scans =
                rho_node_window(made->pipeline->node, made->pipeline->node->windows.newest)
                    ->min_scans;
        }
        if (collects_tracks) {
            add_tracks_of_report(&made->tracks, made->report, made->tracker);
        }
    }
    return true;
}

/* ---- Tracks alone ---- */

struct program_maintainer {
    struct maintainer *maintainer;
    struct random random; /* draws plots for the gate "none" */
};

struct program_maintainers *program_maintainers_new(const struct parameters *settings, size_t count,
                                                    bool has_input_estimation, uint64_t seed,
                                                    bool has_covariances)
{
    RETURN_ON_FAILURE(NULL)
    parameters_check_together(settings);
    struct program_maintainers *made = must_calloc(1, sizeof *made);
    const enum maintainer_gate gate = (enum maintainer_gate)settings->value[PARAMETER_GATE];

    made->count = count;
    made->list = must_calloc(count, sizeof *made->list);
    made->refused = must_calloc(count, sizeof *made->refused);
    made->hypotheses = must_calloc(count, sizeof *made->hypotheses);
    made->tracks.has_covariances = has_covariances;
    for (size_t i = 0; i < count; i++) {
        made->list[i] = (struct program_maintainer){
            .maintainer = maintainer_new(gate, has_input_estimation, settings),
            .random = random_start(seed, 0, i)};
    }
    return made;
}

void program_maintainers_free(struct program_maintainers *made)
{
    for (size_t i = 0; i < made->count; i++) {
        maintainer_free(made->list[i].maintainer);
    }
    program_tracks_free(&made->tracks);
    free(made->hypotheses);
    free(made->refused);
    free(made->list);
    free(made);
}

static void append_track_of_maintainer(struct program_maintainers *made, size_t index,
                                       int64_t time_us, const struct rho_track_report *report)
{
    struct rho_track_report track = *report;

    track.track_id = (uint32_t)index + 1;
    add_track(&made->tracks, time_us, &track);
    made->hypotheses[index] = track.num_hypotheses;
    made->refused[index] = maintainer_refusals(made->list[index].maintainer);
}

bool program_maintainers_predict(struct program_maintainers *made, double t_s, double *places_m)
{
    RETURN_ON_FAILURE(false)
    made->tracks.count = 0;
    if (!(fabs(t_s) <= 1e-6 * (double)RHO_LIMIT_TIME_US)) {
        fail(EXIT_USAGE, "t_s is not a time");
    }
    for (size_t i = 0; i < made->count; i++) {
        double *place_m = &places_m[3 * i];
        struct rho_track_report predicted;

        place_m[0] = place_m[1] = place_m[2] = NAN;
        if (maintainer_is_started(made->list[i].maintainer)) {
            maintainer_predict(made->list[i].maintainer, seconds_to_us(t_s), &predicted, place_m);
            append_track_of_maintainer(made, i, seconds_to_us(t_s), &predicted);
        }
    }
    return true;
}

bool program_maintainers_run(struct program_maintainers *made, const struct program_scans *scans,
                             const double *log_densities)
{
    RETURN_ON_FAILURE(false)
    made->tracks.count = 0;
    for (size_t i = 0; i < scans->count; i++) {
        const struct program_scan *scan = &scans->list[i];
        struct program_maintainer *one = &made->list[i % made->count];

        if (scan->is_frame) {
            fail(EXIT_USAGE, "scan %zu: a track alone takes plots, but these are bearings", i);
        }
        (void)maintainer_step(one->maintainer, &scan->scan, scan->has_sensor ? &scan->sensor : NULL,
                              log_densities ? log_densities[i] : NAN, &one->random);
        if (maintainer_is_started(one->maintainer)) {
            append_track_of_maintainer(made, i % made->count, scan->scan.time_us,
                                       maintainer_report(one->maintainer));
        }
    }
    return true;
}

/* ---- Initiation ---- */

static struct parameters copy_with_method_suggestions(const struct parameters *settings,
                                                      enum method method)
{
    struct parameters copy = *settings;

    method_suggest_parameters(method, &copy);
    return copy;
}

bool program_initiator_config(const struct parameters *settings,
                              struct rho_initiator_config *config)
{
    RETURN_ON_FAILURE(false)
    parameters_to_initiator(settings, config);
    return true;
}

bool program_hough_config(const struct parameters *settings, const char *method, double range_m,
                          struct rho_hough_config *config)
{
    RETURN_ON_FAILURE(false)
    const struct parameters copy = copy_with_method_suggestions(settings, method_must_find(method));

    *config = method_hough_config(method_must_find(method), &copy, range_m);
    return true;
}

bool program_passive_config(const struct parameters *settings, struct rho_passive_config *config)
{
    RETURN_ON_FAILURE(false)
    const struct parameters copy = copy_with_method_suggestions(settings, METHOD_PASSIVE);

    *config = method_passive_config(&copy);
    return true;
}

bool program_passive_paper_config(const struct parameters *settings,
                                  struct rho_passive_paper_config *config)
{
    RETURN_ON_FAILURE(false)
    const struct parameters copy = copy_with_method_suggestions(settings, METHOD_PASSIVE_PAPER);

    *config = method_passive_paper_config(&copy);
    return true;
}

/* ---- The node ---- */

struct program_node {
    struct parameters *settings;
    struct node_core *core;
};

struct program_node *program_node_new(const struct parameters *settings, int32_t epoch,
                                      program_send *send, void *context)
{
    RETURN_ON_FAILURE(NULL)
    const struct node_core_events events = {.context = context, .send = send};
    struct program_node *node = must_calloc(1, sizeof *node);

    node->settings = copy_placed_settings(settings, NULL, 0);
    node->core = node_core_open(node->settings, epoch, &events);
    return node;
}

void program_node_free(struct program_node *node)
{
    node_core_close(node->core);
    free(node->settings);
    free(node);
}

bool program_node_take_or_step(struct program_node *node, const char *channel, const uint8_t *data,
                               size_t size, int64_t now_us)
{
    RETURN_ON_FAILURE(false)
    if (channel) {
        node_core_take_message(node->core, channel, data, size, now_us);
    } else if (now_us == INT64_MAX) {
        node_core_flush(node->core);
    } else {
        node_core_tick(node->core, now_us);
    }
    return true;
}

bool program_node_send_status(struct program_node *node)
{
    static const struct node_core_losses none;

    RETURN_ON_FAILURE(false)
    node_core_send_status(node->core, &none);
    return true;
}

int64_t program_node_due_us(const struct program_node *node)
{
    return node_core_due_us(node->core);
}

bool program_node_get_tracks(struct program_node *node, struct program_tracks *tracks)
{
    RETURN_ON_FAILURE(false)
    tracks->count = 0;
    add_tracks_of_report(tracks, node_core_last_report(node->core),
                         node_core_tracker_state(node->core));
    return true;
}
