/* SPDX-License-Identifier: MIT */
#include "picture/page.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/scans/scan_reader.h"
#include "picture/page_parts.h"

/* ---- arrays of numbers, as the page's script reads them: little-endian, in base64 ---- */

struct bytes {
    uint8_t *data;
    size_t count, capacity;
};

static void add_bytes(struct bytes *bytes, uint64_t bits, size_t size)
{
    if (bytes->count + size > bytes->capacity) {
        bytes->capacity = 2 * bytes->capacity + 4096;
        bytes->data = must_realloc(bytes->data, bytes->capacity);
    }
    for (size_t i = 0; i < size; i++) {
        bytes->data[bytes->count++] = (uint8_t)(bits >> (8 * i));
    }
}

static void add_uint32(struct bytes *bytes, uint32_t value)
{
    add_bytes(bytes, value, sizeof value);
}

static void add_float(struct bytes *bytes, double value)
{
    const float rounded = (float)value;
    uint32_t bits;
    memcpy(&bits, &rounded, sizeof bits);
    add_bytes(bytes, bits, sizeof bits);
}

static void add_double(struct bytes *bytes, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    add_bytes(bytes, bits, sizeof bits);
}

/* The array as an element of the page, which has its name; frees it. */
static void put_array(FILE *file, const char *name, struct bytes *bytes)
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

/* ---- fates of plots ---- */

/* From FATE_OF_TRACK on: the track's index. */
#define LOST_SHARE 0.05 /* of plots that tracks took: rows of late scans may have another time */

enum { FATE_OF_NO_TRACK, FATE_OF_TENTATIVE, FATE_OF_TRACK };

/* A track took this plot of a scan. */
struct claim {
    int64_t time_us;
    int32_t sensor_id;
    uint32_t plot, fate;
    bool is_found; /* among the scans */
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

/* The confirmed tracks' identities, in their order. */
struct track_ids {
    int32_t *list;
    size_t count;
};

static struct track_ids find_ids(const struct plot_points *tracks)
{
    struct track_ids ids = {must_calloc(plot_data_count_identities(tracks) + 1, sizeof ids.list[0]),
                            0};
    struct plot_points one;
    size_t at = 0;
    while (plot_data_next_identity(tracks, &at, &one)) {
        ids.list[ids.count++] = one.list[0].id;
    }
    return ids;
}

static int by_id(const void *a, const void *b)
{
    const int32_t one = *(const int32_t *)a, other = *(const int32_t *)b;
    return (one > other) - (one < other);
}

static uint32_t track_fate(const struct track_ids *ids, int32_t track_id)
{
    const int32_t *found = bsearch(&track_id, ids->list, ids->count, sizeof ids->list[0], by_id);
    return found ? FATE_OF_TRACK + (uint32_t)(found - ids->list) : FATE_OF_TENTATIVE;
}

struct claims {
    struct claim *list;
    size_t count, capacity;
};

static void add_claims(struct claims *claims, const struct track_ids *ids,
                       const struct table *table)
{
    const int time = table_need_column(table, "t_s"), id = table_need_column(table, "track_id");
    const int sensor = table_find_column(table, "sensor_id"),
              plot = table_find_column(table, "plot");
    for (size_t row = 0; plot >= 0 && row < table->num_rows; row++) {
        const double index = table_number_or(table, row, plot, -1.0);
        struct claim claim = {0};
        if (!(index >= 0.0 && index <= UINT32_MAX) ||
            table_read_time_us(table, row, time, &claim.time_us) != NULL) {
            continue;
        }
        claim.plot = (uint32_t)index;
        claim.fate = track_fate(ids, (int32_t)table_number_or(table, row, id, -1.0));
        claim.sensor_id = (int32_t)table_number_or(table, row, sensor, 0.0);
        claims->list =
            must_grow(claims->list, claims->count, &claims->capacity, sizeof claims->list[0]);
        claims->list[claims->count++] = claim;
    }
}

static struct claims find_claims(const struct plot_data *data)
{
    struct claims claims = {NULL, 0, 0};
    struct track_ids ids = find_ids(&data->tracks);
    for (size_t i = 0; i < data->num_track_tables; i++) {
        add_claims(&claims, &ids, data->track_tables[i]);
    }
    free(ids.list);
    if (claims.count > 0) {
        qsort(claims.list, claims.count, sizeof claims.list[0], by_scan_and_plot);
    }
    return claims;
}

/* The fate of a plot; where two tracks took it, of the one that was confirmed. */
static uint32_t find_plot_fate(struct claims *claims, const struct rho_scan *scan, uint32_t plot)
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
        claims->list[low].is_found = true;
    }
    return fate;
}

/*
 * Warns where tracks name plots that no scan of the files has: other files or settings made them.
 */
static void warn_of_lost_claims(const struct claims *claims)
{
    size_t lost = 0;
    for (size_t i = 0; i < claims->count; i++) {
        lost += !claims->list[i].is_found;
    }
    if ((double)lost > LOST_SHARE * (double)claims->count) {
        fprintf(stderr,
                "rhotrack: %zu of %zu plots that the tracks took are in no scan of the files, and "
                "have the colour of no track: give all inputs of the tracks, and the settings that "
                "made them (--config, --set scan_interval_s=...)\n",
                lost, claims->count);
    }
}

/* ---- what there is ---- */

static double seconds_since(int64_t time_us, int64_t zero_us)
{
    return (double)(time_us - zero_us) * 1e-6;
}

static void put_plots(FILE *file, const struct plot_data *data, const struct parameters *parameters,
                      int64_t zero_us)
{
    struct bytes time = {0}, first = {0}, x = {0}, y = {0}, fate = {0};
    struct claims claims = find_claims(data);
    uint32_t count = 0;
    if (data->num_plot_paths > 0) {
        struct scan_reader *reader =
            scan_reader_open_without_sensors(data->plot_paths, data->num_plot_paths, parameters);
        const struct rho_scan *scan;
        while ((scan = scan_reader_next(reader)) != NULL) {
            add_double(&time, seconds_since(scan->time_us, zero_us));
            add_uint32(&first, count);
            for (uint32_t i = 0; i < scan->num_plots; i++) {
                add_float(&x, (double)scan->plots[i].x_m);
                add_float(&y, (double)scan->plots[i].y_m);
                add_uint32(&fate, find_plot_fate(&claims, scan, i));
            }
            count += scan->num_plots;
        }
        scan_reader_close(reader);
        warn_of_lost_claims(&claims);
    }
    add_uint32(&first, count);
    put_array(file, "scan_time", &time);
    put_array(file, "scan_first", &first);
    put_array(file, "plot_x", &x);
    put_array(file, "plot_y", &y);
    put_array(file, "plot_fate", &fate);
    free(claims.list);
}

static double track_cell(const struct plot_point *point, const char *column)
{
    return table_number_or(point->table, point->row, table_find_column(point->table, column), NAN);
}

/* One row of a track; the script knows the order. */
static void add_track_row(struct bytes *rows, const struct plot_point *point)
{
    struct plot_ellipse ellipse;
    const bool has_ellipse = plot_data_sigma_ellipse(point, &ellipse);
    add_float(rows, point->x_m);
    add_float(rows, point->y_m);
    add_float(rows, track_cell(point, "z_m"));
    add_float(rows, point->vx_mps);
    add_float(rows, point->vy_mps);
    add_float(rows, has_ellipse ? ellipse.major_m : NAN);
    add_float(rows, has_ellipse ? ellipse.minor_m : NAN);
    add_float(rows, has_ellipse ? ellipse.angle_rad : NAN);
    add_float(rows, track_cell(point, "sigma_mps"));
    add_float(rows, track_cell(point, "hits"));
    add_float(rows, track_cell(point, "misses"));
    add_float(rows, track_cell(point, "score_nat"));
    add_float(rows, point->is_tentative ? 0.0 : 1.0);
}

static void put_tracks(FILE *file, const struct plot_points *tracks, int64_t zero_us)
{
    struct bytes id = {0}, first = {0}, time = {0}, rows = {0};
    struct plot_points one;
    size_t at = 0;
    while (plot_data_next_identity(tracks, &at, &one)) {
        add_uint32(&id, (uint32_t)one.list[0].id);
        add_uint32(&first, (uint32_t)(one.list - tracks->list));
        for (size_t i = 0; i < one.count; i++) {
            add_double(&time, seconds_since(one.list[i].time_us, zero_us));
            add_track_row(&rows, &one.list[i]);
        }
    }
    add_uint32(&first, (uint32_t)tracks->count);
    put_array(file, "track_id", &id);
    put_array(file, "track_first", &first);
    put_array(file, "track_time", &time);
    put_array(file, "track_row", &rows);
}

static void put_truth(FILE *file, const struct plot_points *truth)
{
    struct bytes first = {0}, place = {0};
    struct plot_points one;
    size_t at = 0;
    while (plot_data_next_identity(truth, &at, &one)) {
        add_uint32(&first, (uint32_t)(one.list - truth->list));
        for (size_t i = 0; i < one.count; i++) {
            add_float(&place, one.list[i].x_m);
            add_float(&place, one.list[i].y_m);
        }
    }
    add_uint32(&first, (uint32_t)truth->count);
    put_array(file, "truth_first", &first);
    put_array(file, "truth_place", &place);
}

static void put_bearings(FILE *file, const struct plot_rays *rays, int64_t zero_us)
{
    struct bytes time = {0}, line = {0};
    for (size_t i = 0; i < rays->count; i++) {
        const struct plot_ray *ray = &rays->list[i];
        add_double(&time, seconds_since(ray->time_us, zero_us));
        add_float(&line, ray->x_m);
        add_float(&line, ray->y_m);
        add_float(&line, ray->end_x_m);
        add_float(&line, ray->end_y_m);
    }
    put_array(file, "ray_time", &time);
    put_array(file, "ray_line", &line);
}

/* NaN where it is not said: radars without a range, passive sensors. */
static void put_sensors(FILE *file, const struct plot_data *data)
{
    struct bytes sensors = {0};
    for (size_t i = 0; i < data->num_radars; i++) {
        const struct plot_radar *radar = &data->radars[i];
        add_float(&sensors, (double)radar->sensor_id);
        add_float(&sensors, radar->x_m);
        add_float(&sensors, radar->y_m);
        add_float(&sensors, isfinite(radar->range_max_m) ? radar->range_max_m : NAN);
        add_float(&sensors, radar->sector_from_rad);
        add_float(&sensors, radar->sector_to_rad);
    }
    for (size_t i = 0; i < data->bearings.num_sensors; i++) {
        const struct plot_point *sensor = &data->bearings.sensors[i];
        add_float(&sensors, (double)sensor->id);
        add_float(&sensors, sensor->x_m);
        add_float(&sensors, sensor->y_m);
        add_float(&sensors, NAN);
        add_float(&sensors, 0.0);
        add_float(&sensors, 0.0);
    }
    put_array(file, "sensors", &sensors);
}

bool page_path_is_html(const char *path)
{
    return path_ends_with(path, ".html");
}

void page_write(const char *path, const struct plot_data *data, const struct parameters *parameters)
{
    struct output output = output_open(path);
    const int64_t zero_us = plot_data_first_shown_us(data);
    FILE *file = output.file;
    fprintf(file,
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width\">\n"
            "<title>rhotrack: %zu tracks, %zu plots</title>\n<style>\n%s</style></head>\n",
            plot_data_count_identities(&data->tracks), data->plots.count, page_style);
    fprintf(file, "<body data-zero-s=\"%.15g\">\n%s", (double)zero_us * 1e-6, page_html);
    put_plots(file, data, parameters, zero_us);
    put_tracks(file, &data->tracks, zero_us);
    put_truth(file, &data->truth);
    put_bearings(file, &data->bearings, zero_us);
    put_sensors(file, data);
    fprintf(file, "<!-- d3:\n%s-->\n<script>\n%s</script>\n<script>\n%s</script>\n</body></html>\n",
            page_licence, page_d3, page_script);
    output_close(&output);
}
