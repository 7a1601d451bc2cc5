/* SPDX-License-Identifier: MIT */
/*
 * The CSV readers on any file: the table itself, plots to scans, bearings to frames, and what the plot command reads
 * (truth and tracks, too). The first byte says which, whether bad rows are skipped, and whether rows of half a second are
 * one scan; the rest is the file.
 *
 * A reader that refuses its file calls fail(), which ends the program. Here it jumps out of the reader (linked with
 * --wrap=fail), and the files that it had open are closed (the streams by --wrap=fopen and its like), and what it had
 * allocated is given back by the hooks of the sanitizer's allocator. So leaks of runs that do not fail are still found.
 */
#include <limits.h>
#include <math.h>
#include <sanitizer/allocator_interface.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "common.h"
#include "frame_reader.h"
#include "local_frame.h"
#include "parameters.h"
#include "plot_data.h"
#include "rhotrack/types.h"
#include "scan_reader.h"
#include "table.h"

static void must(bool holds)
{
    if (!holds) {
        abort();
    }
}

/* ---- What a run allocates ---- */

#define KEPT_MAX 65536

static const volatile void *kept[KEPT_MAX];
static size_t num_kept;
static bool is_keeping;

static void on_malloc(const volatile void *memory, size_t size)
{
    (void)size;
    if (is_keeping && memory) {
        must(num_kept < KEPT_MAX);
        kept[num_kept++] = memory;
    }
}

static void on_free(const volatile void *memory)
{
    for (size_t i = num_kept; is_keeping && i > 0; i--) {
        if (kept[i - 1] == memory) {
            kept[i - 1] = kept[--num_kept];
            return;
        }
    }
}

static void free_kept(void)
{
    is_keeping = false;
    while (num_kept > 0) {
        free((void *)(uintptr_t)kept[--num_kept]);
    }
}

/* Files that a run opened and did not close: those behind the first one that was free. */
static int first_free_file(void)
{
    int file = dup(STDERR_FILENO);

    must(file >= 0 && close(file) == 0);
    return file;
}

/* ---- Streams that a run has open ---- */

/*
 * The C library lists its open streams: one whose memory is given back while it is open breaks that list, and the program
 * may then run in a circle when it ends.
 */
#define STREAMS_MAX 16

static FILE *streams[STREAMS_MAX];
static size_t num_streams;

static FILE *keep_stream(FILE *stream)
{
    if (stream && is_keeping) {
        must(num_streams < STREAMS_MAX);
        streams[num_streams++] = stream;
    }
    return stream;
}

FILE *__real_fopen(const char *path, const char *mode);
FILE *__wrap_fopen(const char *path, const char *mode);
FILE *__wrap_fopen(const char *path, const char *mode)
{
    return keep_stream(__real_fopen(path, mode));
}

FILE *__real_open_memstream(char **text, size_t *size);
FILE *__wrap_open_memstream(char **text, size_t *size);
FILE *__wrap_open_memstream(char **text, size_t *size)
{
    return keep_stream(__real_open_memstream(text, size));
}

int __real_fclose(FILE *stream);
int __wrap_fclose(FILE *stream);
int __wrap_fclose(FILE *stream)
{
    for (size_t i = 0; i < num_streams; i++) {
        if (streams[i] == stream) {
            streams[i] = streams[--num_streams];
            break;
        }
    }
    return __real_fclose(stream);
}

static void close_streams(void)
{
    while (num_streams > 0) {
        must(__real_fclose(streams[--num_streams]) == 0);
    }
}

/* ---- fail() ---- */

static jmp_buf refused;

_Noreturn void __wrap_fail(int exit_code, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* One line that names the file or says what is wrong; exit 2. */
_Noreturn void __wrap_fail(int exit_code, const char *format, ...)
{
    char message[8192];
    va_list arguments;

    va_start(arguments, format);
    must(vsnprintf(message, sizeof message, format, arguments) > 0);
    va_end(arguments);
    must(exit_code == EXIT_USAGE);
    close_streams(); /* before the jump: a stream into memory writes where its opener's variables are */
    longjmp(refused, 1);
}

/* ---- The readers ---- */

static bool is_within(float v, float limit)
{
    return v >= -limit && v <= limit; /* false for NaN */
}

static void read_table(const char *path, bool keep_going)
{
    struct table *table = table_read(path, keep_going);
    int64_t time_us;
    int32_t integer;
    double number;

    for (size_t row = 0; row < table->num_rows; row++) {
        must(row == 0 || table->lines[row] > table->lines[row - 1]);
        for (size_t column = 0; column < table->num_columns; column++) {
            const char *cell = table_cell(table, row, (int)column);

            must(table_number(cell, &number) || isfinite((float)number));
            must(table_time_us(cell, &time_us) ||
                 (time_us >= -RHO_LIMIT_TIME_US && time_us <= RHO_LIMIT_TIME_US));
            (void)table_int32(cell, &integer);
        }
    }
    table_free(table);
}

static void check_scan(const struct rho_scan *scan)
{
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        const struct rho_plot *plot = &scan->plots[i];

        must(is_within(plot->x_m, RHO_LIMIT_POSITION_M) &&
             is_within(plot->y_m, RHO_LIMIT_POSITION_M));
        must(is_within(plot->z_m, RHO_LIMIT_POSITION_M) && is_within(plot->snr_db, INFINITY));
        must(is_within(plot->vx_mps, RHO_LIMIT_SPEED_MPS) &&
             is_within(plot->vy_mps, RHO_LIMIT_SPEED_MPS));
        must(is_within(plot->vz_mps, RHO_LIMIT_SPEED_MPS));
        must(plot->offset_us >= -RHO_LIMIT_OFFSET_US && plot->offset_us <= RHO_LIMIT_OFFSET_US);
    }
}

static void read_scans(char *path, const struct parameters *parameters, bool keep_going)
{
    struct scan_reader *reader = scan_reader_open(&path, 1, parameters, keep_going);
    const struct rho_scan *scan;
    int64_t before_us = INT64_MIN;
    uint64_t num_scans = 0;

    while ((scan = scan_reader_next(reader))) {
        must(scan->time_us >= before_us);
        before_us = scan->time_us;
        num_scans++;
        check_scan(scan);
        (void)scan_reader_sensor(reader);
    }
    must(num_scans == scan_reader_counts(reader).scans);
    scan_reader_close(reader);
}

static void check_frame(const struct rho_frame *frame)
{
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        const struct rho_bearing_scan *scan = &frame->scans[i];

        must(i == 0 || scan->sensor_id > scan[-1].sensor_id);
        must(is_within(scan->x_m, RHO_LIMIT_POSITION_M) &&
             is_within(scan->y_m, RHO_LIMIT_POSITION_M));
        for (uint32_t k = 0; k < scan->num_bearings; k++) {
            must(is_within(scan->bearings[k].bearing_rad, 3.1415928f));
            must(is_within(scan->bearings[k].sigma_rad, RHO_LIMIT_SIGMA_RAD_MAX));
        }
    }
}

static void read_frames(char *path, const struct parameters *parameters, bool keep_going)
{
    struct frame_reader *reader = frame_reader_open(&path, 1, parameters, keep_going);
    const struct rho_frame *frame;
    int64_t before_us = INT64_MIN;
    uint64_t num_frames = 0;

    while ((frame = frame_reader_next(reader))) {
        must(frame->time_us >= before_us && frame->num_scans <= RHO_MAX_SENSORS);
        before_us = frame->time_us;
        num_frames++;
        check_frame(frame);
    }
    must(num_frames == frame_reader_total(reader));
    frame_reader_close(reader);
}

static void read_drawing(char *path, const struct parameters *parameters)
{
    struct plot_data data = plot_data_read(&path, 1, parameters);

    plot_data_free(&data);
}

/* ---- One run ---- */

static void read_file(char *path, const struct parameters *parameters, unsigned which)
{
    const bool keep_going = (which & 4) != 0;

    switch (which & 3) {
    case 0:
        read_table(path, keep_going);
        break;
    case 1:
        read_scans(path, parameters, keep_going);
        break;
    case 2:
        read_frames(path, parameters, keep_going);
        break;
    default:
        read_drawing(path, parameters);
    }
}

/* Where there is an origin latitudes and longitudes are read, and sensor 3 stands on the earth. */
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

/* What PROJ keeps for the whole program is there before a run's memory is looked at. It does without its database. */
static void warm_up(struct parameters *parameters)
{
    must(setenv("PROJ_DATA", "/nonexistent", 1) == 0);
    set_origin(parameters, true);
    local_frame_close(parameters_open_origin(parameters));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int file = -1;
    static char path[64];
    static struct parameters parameters;
    int first_free;

    if (file < 0) {
        file = memfd_create("fuzz.csv", 0);
        must(file >= 0);
        snprintf(path, sizeof path, "/proc/self/fd/%d", file);
        parameters_default(&parameters);
        warm_up(&parameters);
        must(__sanitizer_install_malloc_and_free_hooks(on_malloc, on_free) != 0);
    }
    if (size == 0) {
        return 0;
    }
    first_free = first_free_file();
    must(ftruncate(file, 0) == 0 && pwrite(file, data + 1, size - 1, 0) == (ssize_t)(size - 1));
    set_origin(&parameters, (data[0] & 16) != 0);
    parameters.value[PARAMETER_SCAN_INTERVAL_S] = (data[0] & 8) != 0 ? 0.5 : 0.0;
    is_keeping = true;
    if (setjmp(refused) == 0) {
        read_file(path, &parameters, data[0]);
        is_keeping = false;
        num_kept = 0;
        must(num_streams == 0);
    } else {
        free_kept();
        must(close_range((unsigned)first_free, (unsigned)first_free + 8, 0) == 0);
    }
    return 0;
}
