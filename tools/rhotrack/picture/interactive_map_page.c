/* SPDX-License-Identifier: MIT */
#include "picture/interactive_map_page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/csv/columns.h"
#include "io/scans/plot_reader.h"
#include "picture/map_page_parts.h"

struct bytes {
    uint8_t *data;
    size_t count, capacity;
};

static void append_little_endian(struct bytes *bytes, uint64_t bits, size_t size)
{
    if (bytes->count + size > bytes->capacity) {
        bytes->capacity = 2 * bytes->capacity + 4096;
        bytes->data = must_realloc(bytes->data, bytes->capacity);
    }
    for (size_t i = 0; i < size; i++) {
        bytes->data[bytes->count++] = (uint8_t)(bits >> (8 * i));
    }
}

static void append_little_endian_uint32(struct bytes *bytes, uint32_t value)
{
    append_little_endian(bytes, value, sizeof value);
}

static void append_float(struct bytes *bytes, double value)
{
    const float rounded = (float)value;
    uint32_t bits;
    memcpy(&bits, &rounded, sizeof bits);
    append_little_endian(bytes, bits, sizeof bits);
}

static void append_double(struct bytes *bytes, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    append_little_endian(bytes, bits, sizeof bits);
}

/*
 * Writes the bytes as base64 into a script element of the page with the array's name as id, and
 * frees them.
 */
static void write_and_free_base64_array(FILE *file, const char *name, struct bytes *bytes)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

    fprintf(file, "<script type=\"text/plain\" id=\"%s\">", name);
    for (size_t i = 0; i < bytes->count; i += 3) {
        uint32_t three = 0;
        char text[5] = "====";
        for (size_t k = 0; k < 3; k++) {
            three = three << 8 | (i + k < bytes->count ? bytes->data[i + k] : 0);
        }
        for (size_t k = 0; k < 4 && i + k < bytes->count + 1; k++) {
            text[k] = digits[three >> (18 - 6 * k) & 63];
        }
        fputs(text, file);
    }
    fprintf(file, "</script>\n");
    free(bytes->data);
}

/*
 * share of unmatched claims that is tolerated without a warning: rows of late scans may have
 * another time
 */
#define UNMATCHED_SHARE 0.05

/* fate of a plot on the page; FATE_OF_TRACK + i: claimed by the confirmed track of index i */
enum { FATE_OF_NO_TRACK, FATE_OF_TENTATIVE, FATE_OF_TRACK };

/* A row of a tracks file that claims a plot of a scan. */
struct claim {
    int64_t time_us;
    int32_t sensor_id;
    uint32_t plot, fate;
    bool is_matched; /* the plot is in a scan that was read */
};

static int by_scan_and_plot(const void *a, const void *b)
{
    const struct claim *one = a, *other = b;
    if (one->time_us != other->time_us) {
        return one->time_us < other->time_us ? -1 : 1;
    }
    if (one->sensor_id != other->sensor_id) {
        return one->sensor_id < other->sensor_id ? -1 : 1;
    }
    return (one->plot > other->plot) - (one->plot < other->plot);
}

/* Ids of the confirmed tracks, ascending. */
struct track_ids {
    int32_t *list;
    size_t count;
};

static struct track_ids list_confirmed_track_ids(const struct plot_points *tracks)
{
    struct track_ids ids = {
        must_calloc(picture_data_count_identities(tracks) + 1, sizeof ids.list[0]), 0};
    struct plot_points one;
    size_t at = 0;
    while (picture_data_next_identity(tracks, &at, &one)) {
        ids.list[ids.count++] = one.list[0].id;
    }
    return ids;
}

static int by_id(const void *a, const void *b)
{
    const int32_t one = *(const int32_t *)a, other = *(const int32_t *)b;
    return (one > other) - (one < other);
}

/* Fate of a plot that a track has taken. */
static uint32_t fate_of_plot(const struct track_ids *ids, int32_t track_id)
{
    const int32_t *found = bsearch(&track_id, ids->list, ids->count, sizeof ids->list[0], by_id);
    return found ? FATE_OF_TRACK + (uint32_t)(found - ids->list) : FATE_OF_TENTATIVE;
}

struct claims {
    struct claim *list;
    size_t count, capacity;
};

static void add_claims_of_table(struct claims *claims, const struct track_ids *ids,
                                const struct table *table)
{
    const struct columns columns = columns_find(table);
    const int time = columns_need(&columns, COL_T_S), id = columns_need(&columns, COL_TRACK_ID);
    const int sensor = columns.at[COL_SENSOR_ID], plot = columns.at[COL_PLOT];
    for (size_t row = 0; plot >= 0 && row < table->num_rows; row++) {
        const double index = table_number_or(table, row, plot, -1.0);
        struct claim claim = {0};
        if (!(index >= 0.0 && index <= UINT32_MAX) ||
            table_read_time_us(table, row, time, &claim.time_us) != NULL) {
            continue;
        }
        claim.plot = (uint32_t)index;
        claim.fate = fate_of_plot(ids, (int32_t)table_number_or(table, row, id, -1.0));
        claim.sensor_id = (int32_t)table_number_or(table, row, sensor, 0.0);
        claims->list = must_make_room_for_one(claims->list, claims->count, &claims->capacity,
                                              sizeof claims->list[0]);
        claims->list[claims->count++] = claim;
    }
}

static struct claims collect_claims(const struct picture_data *data)
{
    struct claims claims = {NULL, 0, 0};
    struct track_ids ids = list_confirmed_track_ids(&data->tracks);
    for (size_t i = 0; i < data->num_track_tables; i++) {
        add_claims_of_table(&claims, &ids, data->track_tables[i]);
    }
    free(ids.list);
    if (claims.count > 0) {
        qsort(claims.list, claims.count, sizeof claims.list[0], by_scan_and_plot);
    }
    return claims;
}

/*
 * Fate of a plot, and marks its claims as matched; of two claims that of a confirmed track counts.
 */
static uint32_t match_plot_and_find_fate(struct claims *claims, const struct rho_scan *scan,
                                         uint32_t plot)
{
    const struct claim wanted = {scan->time_us, scan->sensor_id, plot, 0, false};
    size_t low = 0, high = claims->count;
    uint32_t fate = FATE_OF_NO_TRACK;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (by_scan_and_plot(&claims->list[middle], &wanted) < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    for (; low < claims->count && by_scan_and_plot(&claims->list[low], &wanted) == 0; low++) {
        fate = claims->list[low].fate > fate ? claims->list[low].fate : fate;
        claims->list[low].is_matched = true;
    }
    return fate;
}

/*
 * Warns where tracks claim plots that are in no scan of the files: the tracks were made from other
 * files or settings.
 */
static void warn_of_unmatched_claims(const struct claims *claims)
{
    size_t unmatched = 0;
    for (size_t i = 0; i < claims->count; i++) {
        unmatched += !claims->list[i].is_matched;
    }
    if ((double)unmatched > UNMATCHED_SHARE * (double)claims->count) {
        fprintf(stderr,
                "rhotrack: %zu of %zu plots that the tracks took are in no scan of the files, and "
                "have the colour of no track: give all inputs of the tracks, and the settings that "
                "made them (--config, --set scan_interval_s=...)\n",
                unmatched, claims->count);
    }
}

static double seconds_since(int64_t time_us, int64_t zero_us)
{
    return (double)(time_us - zero_us) * 1e-6;
}

static void write_plot_arrays(FILE *file, const struct picture_data *data,
                              const struct parameters *parameters, int64_t zero_us)
{
    struct bytes time = {0}, first = {0}, x = {0}, y = {0}, fate = {0};
    struct claims claims = collect_claims(data);
    uint32_t count = 0;
    if (data->num_plot_paths > 0) {
        struct plot_reader *reader =
            plot_reader_open_sensorless(data->plot_paths, data->num_plot_paths, parameters);
        const struct rho_scan *scan;
        while ((scan = plot_reader_next(reader)) != NULL) {
            append_double(&time, seconds_since(scan->time_us, zero_us));
            append_little_endian_uint32(&first, count);
            for (uint32_t i = 0; i < scan->num_plots; i++) {
                append_float(&x, (double)scan->plots[i].x_m);
                append_float(&y, (double)scan->plots[i].y_m);
                append_little_endian_uint32(&fate, match_plot_and_find_fate(&claims, scan, i));
            }
            count += scan->num_plots;
        }
        plot_reader_close(reader);
        warn_of_unmatched_claims(&claims);
    }
    append_little_endian_uint32(&first, count);
    write_and_free_base64_array(file, "scan_time", &time);
    write_and_free_base64_array(file, "scan_first", &first);
    write_and_free_base64_array(file, "plot_x", &x);
    write_and_free_base64_array(file, "plot_y", &y);
    write_and_free_base64_array(file, "plot_fate", &fate);
    free(claims.list);
}

/*
 * Appends one row of a track, its columns in the order of the constants X .. CONFIRMED in page.js.
 */
static void append_track_row(struct bytes *rows, const struct plot_point *point)
{
    struct plot_ellipse ellipse;
    const bool has_ellipse = picture_data_sigma_ellipse(point, &ellipse);
    append_float(rows, point->x_m);
    append_float(rows, point->y_m);
    append_float(rows, plot_data_number_in_column(point, "z_m"));
    append_float(rows, point->vx_mps);
    append_float(rows, point->vy_mps);
    append_float(rows, has_ellipse ? ellipse.major_m : NAN);
    append_float(rows, has_ellipse ? ellipse.minor_m : NAN);
    append_float(rows, has_ellipse ? ellipse.angle_rad : NAN);
    append_float(rows, plot_data_number_in_column(point, "sigma_mps"));
    append_float(rows, plot_data_number_in_column(point, "hits"));
    append_float(rows, plot_data_number_in_column(point, "misses"));
    append_float(rows, plot_data_number_in_column(point, "score_nat"));
    append_float(rows, point->is_tentative ? 0.0 : 1.0);
}

static void write_track_arrays(FILE *file, const struct plot_points *tracks, int64_t zero_us)
{
    struct bytes id = {0}, first = {0}, time = {0}, rows = {0};
    struct plot_points one;
    size_t at = 0;
    while (picture_data_next_identity(tracks, &at, &one)) {
        append_little_endian_uint32(&id, (uint32_t)one.list[0].id);
        append_little_endian_uint32(&first, (uint32_t)(one.list - tracks->list));
        for (size_t i = 0; i < one.count; i++) {
            append_double(&time, seconds_since(one.list[i].time_us, zero_us));
            append_track_row(&rows, &one.list[i]);
        }
    }
    append_little_endian_uint32(&first, (uint32_t)tracks->count);
    write_and_free_base64_array(file, "track_id", &id);
    write_and_free_base64_array(file, "track_first", &first);
    write_and_free_base64_array(file, "track_time", &time);
    write_and_free_base64_array(file, "track_row", &rows);
}

static void write_truth_arrays(FILE *file, const struct plot_points *truth)
{
    struct bytes first = {0}, place = {0};
    struct plot_points one;
    size_t at = 0;
    while (picture_data_next_identity(truth, &at, &one)) {
        append_little_endian_uint32(&first, (uint32_t)(one.list - truth->list));
        for (size_t i = 0; i < one.count; i++) {
            append_float(&place, one.list[i].x_m);
            append_float(&place, one.list[i].y_m);
        }
    }
    append_little_endian_uint32(&first, (uint32_t)truth->count);
    write_and_free_base64_array(file, "truth_first", &first);
    write_and_free_base64_array(file, "truth_place", &place);
}

static void write_bearing_line_arrays(FILE *file, const struct plot_rays *rays, int64_t zero_us)
{
    struct bytes time = {0}, line = {0};
    for (size_t i = 0; i < rays->count; i++) {
        const struct plot_ray *ray = &rays->list[i];
        append_double(&time, seconds_since(ray->time_us, zero_us));
        append_float(&line, ray->x_m);
        append_float(&line, ray->y_m);
        append_float(&line, ray->end_x_m);
        append_float(&line, ray->end_y_m);
    }
    write_and_free_base64_array(file, "ray_time", &time);
    write_and_free_base64_array(file, "ray_line", &line);
}

/*
 * Writes id, place, range and sector of all sensors; range is NaN for passive sensors and radars of
 * unknown range.
 */
static void write_sensor_array(FILE *file, const struct picture_data *data)
{
    struct bytes sensors = {0};
    for (size_t i = 0; i < data->num_radars; i++) {
        const struct plot_radar *radar = &data->radars[i];
        append_float(&sensors, (double)radar->sensor_id);
        append_float(&sensors, radar->x_m);
        append_float(&sensors, radar->y_m);
        append_float(&sensors, isfinite(radar->range_max_m) ? radar->range_max_m : NAN);
        append_float(&sensors, radar->sector_from_rad);
        append_float(&sensors, radar->sector_to_rad);
    }
    for (size_t i = 0; i < data->bearings.num_sensors; i++) {
        const struct plot_point *sensor = &data->bearings.sensors[i];
        append_float(&sensors, (double)sensor->id);
        append_float(&sensors, sensor->x_m);
        append_float(&sensors, sensor->y_m);
        append_float(&sensors, NAN);
        append_float(&sensors, 0.0);
        append_float(&sensors, 0.0);
    }
    write_and_free_base64_array(file, "sensors", &sensors);
}

bool html_page_path_is_html(const char *path)
{
    return path_ends_with(path, ".html");
}

void html_page_write(const char *path, const struct picture_data *data,
                     const struct parameters *parameters)
{
    struct output output = output_open(path);
    const int64_t zero_us = picture_data_time_origin_us(data);
    FILE *file = output.file;
    fprintf(file,
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width\">\n"
            "<title>rhotrack: %zu tracks, %zu plots</title>\n<style>\n%s</style></head>\n",
            picture_data_count_identities(&data->tracks), data->plots.count, page_style);
    fprintf(file, "<body data-zero-s=\"%.15g\">\n%s", (double)zero_us * 1e-6, page_html);
    write_plot_arrays(file, data, parameters, zero_us);
    write_track_arrays(file, &data->tracks, zero_us);
    write_truth_arrays(file, &data->truth);
    write_bearing_line_arrays(file, &data->bearings, zero_us);
    write_sensor_array(file, data);
    fprintf(file, "<!-- d3:\n%s-->\n<script>\n%s</script>\n<script>\n%s</script>\n</body></html>\n",
            page_licence, page_d3, page_script);
    output_close(&output);
}
