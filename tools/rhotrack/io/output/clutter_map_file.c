/* SPDX-License-Identifier: MIT */
#include "io/output/clutter_map_file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/common.h"
#include "base/state_file.h"
#include "io/csv/csv_table.h"
#include "io/csv/geodetic_columns.h"
#include "io/csv/row_cells.h"
#include "pipeline/pipeline.h"

/* sigma of echoes entered by hand, where no sigma is configured */
#define SIGMA_BY_HAND_M 30.0

#define SAVE_US 60000000

/*
 * Says in the head of a file that its last line is its checksum: without either of the two the
 * other one still tells of a damaged file. Files by hand, and of earlier versions, have neither.
 */
#define CHECKED_LINE                                                                               \
    "# Checked by the last line, the CRC-32 of all before it: remove both to change rows by "      \
    "hand.\n"
#define CHECKSUM_LINE "# CRC-32 %08" PRIx32 "\n"
#define CHECKSUM_LINE_BYTES 18

#define REASON_BYTES 1024

#define ALL_REGIONS (RHO_ECHO_TABLES - 1)
#define REGION_MAX (ALL_REGIONS - 1)

/*
 * Smallest value of each class of hits and gaps (rhotrack/detail/recurring_clutter_map.h), which
 * stands for the class in the file.
 */
static const uint16_t hits_of_class[RHO_ECHO_HIT_CLASSES] = {1, 2, 3, RHO_ECHO_KNOWN_HITS};
static const uint8_t unseen_of_class[RHO_ECHO_GAP_CLASSES] = {1, 2, 3, 5, 9};

/* Statistics of returns for a class of echoes in a region. */
struct return_counts {
    uint16_t hits;
    uint8_t region, unseen;
    float looks, returns;
};

struct clutter_row {
    bool is_echo;
    struct clutter_echo echo;
    struct return_counts counts;
};

/* The file that is read is one of plots or tracks: an error of the command line, no damage. */
static bool is_of_others;

/* Checks the columns; returns NULL where x_m and y_m, not lat_deg and lon_deg, give positions. */
static struct geodetic_columns *check_columns(const struct columns *columns,
                                              const struct parameters *parameters)
{
    struct geodetic_columns *geodetic = NULL;

    (void)columns_need(columns, COL_SENSOR_ID);
    /*
     * Refuses files of plots and tracks, which have positions and sensors too: the map would
     * overwrite them.
     */
    static const enum column_id others[] = {COL_T_S, COL_RANGE_M, COL_BEARING_RAD};

    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        if (columns->at[others[i]] >= 0) {
            is_of_others = true;
            table_fail_at_row(columns->table, TABLE_HEADER,
                              "column '%s' does not belong in a clutter map",
                              column_name(others[i]));
        }
    }
    if (columns->at[COL_LAT_DEG] >= 0) {
        geodetic = geodetic_open(columns->table, parameters);
    }
    (void)columns_need(columns, geodetic ? COL_LAT_DEG : COL_X_M);
    (void)columns_need(columns, geodetic ? COL_LON_DEG : COL_Y_M);
    if (columns->at[COL_LOOKS] >= 0) {
        (void)columns_need(columns, COL_HITS);
        (void)columns_need(columns, COL_UNSEEN);
        (void)columns_need(columns, COL_RETURNS);
    }
    return geodetic;
}

static bool read_count(const struct row_check *check, enum column_id column, int32_t min,
                       int32_t max, int32_t *value)
{
    return row_read_int32(check, column, value) &&
           ((*value >= min && *value <= max) ||
            row_refuse(check, "%s %" PRId32 " is outside %" PRId32 " .. %" PRId32,
                       column_name(column), *value, min, max));
}

static bool read_place(const struct row_check *check, struct geodetic_columns *geodetic,
                       struct clutter_echo *echo)
{
    double place_m[3];
    bool has_alt;

    if (!geodetic) {
        return row_read_position(check, COL_X_M, &echo->x_m) &&
               row_read_position(check, COL_Y_M, &echo->y_m);
    }
    if (!geodetic_read_place(geodetic, check, place_m, &has_alt)) {
        return false;
    }
    echo->x_m = (float)place_m[0];
    echo->y_m = (float)place_m[1];
    return true;
}

/* Whether the user set a sigma, for this sensor or for all. */
static bool is_sigma_configured(const struct parameters *parameters, int32_t sensor_id,
                                enum sensor_parameter_id own, enum parameter_id of_all)
{
    return parameters->source[of_all] >= SOURCE_CONFIG ||
           !isnan(parameters_value_of_sensor(parameters, sensor_id, own, NAN));
}

/* Sets an echo's sigmas to the noise of its sensor's plots at that range. */
static void set_sigmas_of_sensor(const struct parameters *parameters, struct clutter_echo *echo)
{
    double range_m = SIGMA_BY_HAND_M, cross_m = SIGMA_BY_HAND_M;
    const int32_t id = echo->sensor_id;

    if (is_sigma_configured(parameters, id, SENSOR_SIGMA_AZIMUTH_RAD,
                            PARAMETER_SIGMA_AZIMUTH_RAD) ||
        is_sigma_configured(parameters, id, SENSOR_SIGMA_RANGE_M, PARAMETER_SIGMA_RANGE_M)) {
        struct rho_sensor sensor;

        parameters_sensor_or_default(parameters, id, &sensor);
        range_m = parameters_value_of_sensor(parameters, id, SENSOR_SIGMA_RANGE_M,
                                             parameters->value[PARAMETER_SIGMA_RANGE_M]);
        cross_m =
            parameters_value_of_sensor(parameters, id, SENSOR_SIGMA_AZIMUTH_RAD,
                                       parameters->value[PARAMETER_SIGMA_AZIMUTH_RAD]) *
            hypot((double)echo->x_m - (double)sensor.x_m, (double)echo->y_m - (double)sensor.y_m);
    } else if (is_sigma_configured(parameters, id, SENSOR_SIGMA_M, PARAMETER_SIGMA_M)) {
        range_m = cross_m = parameters_value_of_sensor(parameters, id, SENSOR_SIGMA_M,
                                                       parameters->value[PARAMETER_SIGMA_M]);
    }
    echo->sigma_range_m = (float)fmax(range_m, (double)RHO_LIMIT_SIGMA_MIN);
    echo->sigma_cross_m = (float)fmax(cross_m, (double)RHO_LIMIT_SIGMA_MIN);
}

static bool read_sigma(const struct row_check *check, enum column_id column, float *value)
{
    return !row_has_cell(check, column) ||
           row_read_float(check, column, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_SIGMA_MAX, value);
}

static bool read_echo(const struct row_check *check, struct geodetic_columns *geodetic,
                      const struct parameters *parameters, struct clutter_echo *echo)
{
    int32_t hits = RHO_ECHO_KNOWN_HITS;

    if (!read_count(check, COL_SENSOR_ID, INT32_MIN, INT32_MAX, &echo->sensor_id) ||
        !read_place(check, geodetic, echo)) {
        return false;
    }
    set_sigmas_of_sensor(parameters, echo);
    if (!read_sigma(check, COL_SIGMA_M, &echo->sigma_range_m) ||
        !read_sigma(check, COL_SIGMA_M, &echo->sigma_cross_m) ||
        !read_sigma(check, COL_SIGMA_RANGE_M, &echo->sigma_range_m) ||
        !read_sigma(check, COL_SIGMA_CROSS_M, &echo->sigma_cross_m) ||
        (row_has_cell(check, COL_HITS) && !read_count(check, COL_HITS, 1, UINT16_MAX, &hits))) {
        return false;
    }
    echo->hits = (uint16_t)hits;
    return true;
}

/* Reads the looks and returns of a class of echoes. */
static bool read_return_counts(const struct row_check *check, struct return_counts *counts)
{
    int32_t hits, unseen, region = ALL_REGIONS;

    if (row_has_cell(check, COL_SENSOR_ID)) {
        return row_refuse(check, "a row has either a sensor, as an echo, or looks, not both");
    }
    if (!read_count(check, COL_HITS, 1, UINT16_MAX, &hits) ||
        !read_count(check, COL_UNSEEN, 1, UINT8_MAX, &unseen) ||
        (row_has_cell(check, COL_REGION) &&
         !read_count(check, COL_REGION, 0, REGION_MAX, &region)) ||
        !row_read_float(check, COL_LOOKS, 0.0f, 1e9f, &counts->looks) ||
        !row_read_float(check, COL_RETURNS, 0.0f, counts->looks, &counts->returns)) {
        return false;
    }
    counts->hits = (uint16_t)hits;
    counts->unseen = (uint8_t)unseen;
    counts->region = (uint8_t)region;
    return true;
}

/* Whether the bytes have the checksum that they speak of, or speak of none. */
static bool is_checksum_right(const uint8_t *bytes, size_t size)
{
    const size_t rows = size < CHECKSUM_LINE_BYTES ? 0 : size - CHECKSUM_LINE_BYTES;
    char expected[CHECKSUM_LINE_BYTES + 1];

    if (rows == 0) {
        return true; /* too short for its head, which the table's reader finds */
    }
    snprintf(expected, sizeof expected, CHECKSUM_LINE, state_file_crc(bytes, rows));
    return memcmp(bytes + rows, expected, CHECKSUM_LINE_BYTES) == 0 ||
           (memcmp(bytes + rows, expected, strcspn(CHECKSUM_LINE, "%")) != 0 &&
            !memmem(bytes, size, CHECKED_LINE, strlen(CHECKED_LINE)));
}

/* Exit 2 where a file's bytes are not those that were written. */
static void check_checksum(const char *path)
{
    size_t size;
    int error;
    uint8_t *bytes = state_file_read(path, "clutter map", &size, &error);

    if (bytes && !is_checksum_right(bytes, size)) {
        fail(EXIT_USAGE,
             "%s: the checksum is wrong: damaged, or changed by hand (remove the lines of # then)",
             path);
    }
    free(bytes);
}

/* Reads and checks all rows before any of them changes the map. */
static struct clutter_row *read_rows(const char *path, const struct parameters *parameters,
                                     size_t *count)
{
    if (regular_file_size_or_zero(path) > 0) { /* a pipe can be read once */
        check_checksum(path);
    }

    struct table *table = table_read(path, false);
    const struct columns columns = columns_find(table);
    struct geodetic_columns *geodetic = check_columns(&columns, parameters);
    struct clutter_row *rows = must_calloc(table->num_rows + 1, sizeof *rows);
    char reason[ROW_REASON_BYTES];

    for (size_t row = 0; row < table->num_rows; row++) {
        const struct row_check check = {.columns = &columns, .row = row, .reason = reason};

        rows[row].is_echo = !row_has_cell(&check, COL_LOOKS);
        if (!(rows[row].is_echo ? read_echo(&check, geodetic, parameters, &rows[row].echo)
                                : read_return_counts(&check, &rows[row].counts))) {
            table_fail_at_row(table, row, "%s", reason);
        }
    }
    *count = table->num_rows;
    geodetic_close(geodetic);
    table_free(table);
    return rows;
}

struct clutter_echo *
clutter_map_file_read_echoes(const char *path, const struct parameters *parameters, size_t *count)
{
    size_t num_rows;
    struct clutter_row *rows = read_rows(path, parameters, &num_rows);
    struct clutter_echo *echoes = must_calloc(num_rows + 1, sizeof *echoes);

    *count = 0;
    for (size_t i = 0; i < num_rows; i++) {
        if (rows[i].is_echo) {
            echoes[(*count)++] = rows[i].echo;
        }
    }
    free(rows);
    return echoes;
}

static void add_echo_to_map(struct rho_clutter_map *map, const struct clutter_echo *echo)
{
    must_succeed(rho_clutter_map_teach(map, echo->sensor_id, echo->x_m, echo->y_m,
                                       echo->sigma_range_m, echo->sigma_cross_m, echo->hits),
                 "clutter map");
}

static void add_return_counts_to_map(struct rho_clutter_map *map,
                                     const struct return_counts *counts)
{
    must_succeed(rho_clutter_map_teach_returns(map, counts->region, counts->hits, counts->unseen,
                                               counts->looks, counts->returns),
                 "clutter map");
}

static void load_file_into_map(const char *path, const struct parameters *parameters,
                               struct rho_clutter_map *map)
{
    size_t count, echoes = 0;
    struct clutter_row *rows = read_rows(path, parameters, &count);

    for (size_t i = 0; i < count; i++) {
        if (rows[i].is_echo) {
            add_echo_to_map(map, &rows[i].echo);
            echoes++;
        } else {
            add_return_counts_to_map(map, &rows[i].counts);
        }
    }
    fprintf(stderr, "rhotrack: %s: %zu echoes", path, echoes);
    if (map->echoes_dropped > 0) {
        fprintf(stderr, ", %" PRIu32 " of them dropped for lack of room", map->echoes_dropped);
    }
    fputc('\n', stderr);
    free(rows);
}

/* Standard deviation, within the limits that the map accepts. */
static float clamped_sigma_m_from_variance(float variance_m2)
{
    const float sigma_m = sqrtf(variance_m2);

    return fminf(fmaxf(sigma_m, RHO_LIMIT_SIGMA_MIN), RHO_LIMIT_SIGMA_MAX);
}

/* Reads the next known, stationary echo of the map; false after the last. */
static bool next_standing_echo(const struct rho_clutter_map *map, uint32_t *place,
                               struct clutter_echo *next)
{
    const struct rho_echo *echo;

    while ((echo = rho_clutter_map_next_known(map, place)) != NULL) {
        if (rho_clutter_map_is_echo_standing(echo) && rho_is_coordinate(echo->x_m) &&
            rho_is_coordinate(echo->y_m)) {
            *next = (struct clutter_echo){
                .sensor_id = echo->sensor_id,
                .x_m = echo->x_m,
                .y_m = echo->y_m,
                .sigma_range_m = clamped_sigma_m_from_variance(echo->along[0]),
                .sigma_cross_m = clamped_sigma_m_from_variance(echo->across[0]),
                .hits = echo->hits};
            return true;
        }
    }
    return false;
}

/* Reads the next class with statistics of returns; false after the last. */
static bool next_return_counts(const struct rho_clutter_map *map, unsigned *at,
                               struct return_counts *next)
{
    while (*at < RHO_ECHO_TABLES * RHO_ECHO_HIT_CLASSES * RHO_ECHO_GAP_CLASSES) {
        const unsigned i = (*at)++, classes = i / RHO_ECHO_GAP_CLASSES;

        *next = (struct return_counts){.region = (uint8_t)(classes / RHO_ECHO_HIT_CLASSES),
                                       .hits = hits_of_class[classes % RHO_ECHO_HIT_CLASSES],
                                       .unseen = unseen_of_class[i % RHO_ECHO_GAP_CLASSES]};
        rho_clutter_map_learned_looks_and_returns(map, next->region, next->hits, next->unseen,
                                                  &next->looks, &next->returns);
        if (next->looks > 0.0f) {
            return true;
        }
    }
    return false;
}

static void write_rows(FILE *file, const struct rho_clutter_map *map)
{
    struct clutter_echo echo;
    struct return_counts counts;

    fputs("# Clutter map. Rows with a sensor are echoes that stand; rows with looks, what was "
          "learned "
          "of their returns.\n" CHECKED_LINE
          "sensor_id,x_m,y_m,sigma_range_m,sigma_cross_m,hits,region,unseen,looks,returns\n",
          file);
    for (uint32_t place = 0; next_standing_echo(map, &place, &echo);) {
        char x[FLOAT_TEXT_BYTES], y[FLOAT_TEXT_BYTES], range[FLOAT_TEXT_BYTES],
            cross[FLOAT_TEXT_BYTES];

        fprintf(file, "%" PRId32 ",%s,%s,%s,%s,%u,,,,\n", echo.sensor_id,
                shortest_float_text(echo.x_m, x), shortest_float_text(echo.y_m, y),
                shortest_float_text(echo.sigma_range_m, range),
                shortest_float_text(echo.sigma_cross_m, cross), (unsigned)echo.hits);
    }
    for (unsigned at = 0; next_return_counts(map, &at, &counts);) {
        char looks[FLOAT_TEXT_BYTES], returns[FLOAT_TEXT_BYTES], region[8] = "";

        if (counts.region != ALL_REGIONS) {
            snprintf(region, sizeof region, "%u", (unsigned)counts.region);
        }
        fprintf(file, ",,,,,%u,%s,%u,%s,%s\n", (unsigned)counts.hits, region,
                (unsigned)counts.unseen, shortest_float_text(counts.looks, looks),
                shortest_float_text(counts.returns, returns));
    }
}

static bool write_map(FILE *file, const void *context)
{
    const struct rho_clutter_map *map = context;
    char *text = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&text, &size);
    bool is_good = memory != NULL;

    if (memory) {
        write_rows(memory, map);
        is_good = !ferror(memory);
        is_good = fclose(memory) == 0 && is_good;
    }
    is_good = is_good && fwrite(text, 1, size, file) == size &&
              fprintf(file, CHECKSUM_LINE, state_file_crc(text, size)) == CHECKSUM_LINE_BYTES;
    free(text);
    return is_good;
}

bool clutter_map_file_write(const char *path, const struct rho_clutter_map *map)
{
    return state_file_replace(path, write_map, map);
}

/* ---- Restore ---- */

/* How the process that tries a file ends, beside 0 and the program's exit codes. */
#define EXIT_OF_OTHERS 3

static int reason_pipe;

static void send_reason_and_exit(int exit_code, const char *message)
{
    (void)!write(reason_pipe, message, strlen(message));
    _exit(is_of_others ? EXIT_OF_OTHERS : exit_code);
}

/*
 * Reads the rows in a process of its own, which a bad file ends wherever its fault shows. Returns
 * whether they are good; else reason has `FILE:LINE: what is wrong`.
 */
static bool try_rows(const char *path, const struct parameters *parameters,
                     char reason[REASON_BYTES])
{
    int ends[2], status = 0;
    size_t count;
    ssize_t got;
    pid_t reader;

    if (pipe2(ends, O_CLOEXEC) != 0 || (reader = fork()) < 0) {
        fail(EXIT_RUNTIME, "%s: cannot be tried: %s", path, strerror(errno));
    }
    if (reader == 0) {
        reason_pipe = ends[1];
        fail_handler = send_reason_and_exit;
        free(read_rows(path, parameters, &count));
        _exit(0);
    }
    close(ends[1]);
    snprintf(reason, REASON_BYTES, "%s: its reader fails", path);
    got = read(ends[0], reason, REASON_BYTES - 1);
    reason[got > 0 ? (size_t)got : strlen(reason)] = '\0';
    close(ends[0]);
    waitpid(reader, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == EXIT_OF_OTHERS) {
        fail(EXIT_USAGE, "%s", reason);
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == EXIT_RUNTIME) {
        fail(EXIT_RUNTIME, "%s", reason);
    }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

static void say_start_of_map(const char *path, const char *why)
{
    fprintf(stderr, "rhotrack: %s: %s; the clutter map starts empty\n", path, why);
}

bool clutter_map_file_restore(const char *path, const struct parameters *parameters,
                              struct rho_clutter_map *map)
{
    const char *then = map ? "the clutter map starts empty" : "the snapshot has the clutter map";
    char reason[REASON_BYTES];
    size_t size;
    int error;
    uint8_t *bytes = state_file_read(path, "clutter map", &size, &error);
    const bool is_there = bytes != NULL;

    free(bytes);
    if (error) {
        snprintf(reason, sizeof reason, "%s: %s", path, strerror(error));
        return state_file_set_aside(path, reason, then);
    }
    if (size > 0 && !try_rows(path, parameters, reason)) {
        return state_file_set_aside(path, reason, then);
    }
    if (map && size > 0) {
        load_file_into_map(path, parameters, map);
    } else if (map) {
        say_start_of_map(path, is_there ? "is empty" : "does not exist yet");
    }
    return true;
}

/* ---- The file of a batch ---- */

struct clutter_map_file clutter_map_file_open(const char *path, const struct parameters *parameters,
                                              struct rho_clutter_map *map)
{
    struct clutter_map_file file = {.path = path, .saved_us = monotonic_clock_us()};
    size_t size;
    int error;
    uint8_t *bytes;

    if (!path) {
        return file;
    }
    bytes = state_file_read(path, "clutter map", &size, &error);
    if (error) {
        fail(EXIT_USAGE, "%s: %s", path, strerror(error));
    }
    if (bytes) {
        load_file_into_map(path, parameters, map);
    } else {
        say_start_of_map(path, "does not exist yet");
    }
    free(bytes);
    if (!state_file_is_writable(path)) {
        fail(EXIT_RUNTIME, "%s: cannot be written: %s", path, strerror(errno));
    }
    return file;
}

bool clutter_map_file_save(struct clutter_map_file *file, const struct rho_clutter_map *map)
{
    if (!file->path) {
        return true;
    }
    file->saved_us = monotonic_clock_us();
    if (!clutter_map_file_write(file->path, map)) {
        fprintf(stderr, "rhotrack: %s: cannot be written: %s\n", file->path, strerror(errno));
        return false;
    }
    return true;
}

bool clutter_map_file_save_if_due(struct clutter_map_file *file, const struct rho_clutter_map *map)
{
    return !file->path || monotonic_clock_us() < file->saved_us + SAVE_US ||
           clutter_map_file_save(file, map);
}
