/* SPDX-License-Identifier: MIT */
/* Rows of scans as text, and what became of records. */
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "asterix_text.h"

#define PI 3.141592653589793

/* ---- Rows ---- */

/* A line under way. What a row holds is far below its room. */
static void put(char *line, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void put(char *line, const char *format, ...)
{
    size_t length = strlen(line);
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(line + length, ASTERIX_LINE_BYTES - length, format, arguments);
    va_end(arguments);
}

/* Clockwise from north as counter-clockwise from east, within +-pi. */
static double azimuth_rad(uint32_t azimuth)
{
    return remainder(PI / 2 - 2 * PI / ASTERIX_TURN * azimuth, 2 * PI);
}

void asterix_text_header(const struct asterix_columns *columns, char line[ASTERIX_LINE_BYTES])
{
    line[0] = '\0';
    put(line, "t_s,sensor_id,range_m,azimuth_rad,alt_m,range_rate_mps%s%s\n",
        columns->has_place ? ",sensor_lat_deg,sensor_lon_deg,sensor_alt_m" : "",
        columns->has_scan ? ",sector_from_rad,sector_to_rad,scan" : "");
}

static void put_mark(char *line, const struct asterix_mark *mark)
{
    put(line, ",%.6f,%.9f", mark->is_ground ? mark->ground_m : mark->range * ASTERIX_RANGE_M,
        azimuth_rad(mark->azimuth));
    if (mark->has_alt) {
        put(line, ",%.2f", mark->alt * ASTERIX_HEIGHT_M);
    } else {
        put(line, ",");
    }
    if (mark->has_doppler) {
        put(line, ",%d", mark->doppler_mps);
    } else {
        put(line, ",");
    }
}

static void put_place(char *line, const struct asterix_place *place)
{
    if (place->is_given) {
        put(line, ",%.9f,%.9f,%.0f", place->lat_deg, place->lon_deg, place->alt_m);
    } else {
        put(line, ",,,");
    }
}

/* The antenna turns clockwise: counter-clockwise the sector goes from its end to its start. */
static void put_scan(char *line, const struct asterix_scan *scan)
{
    if (scan->is_turn) {
        put(line, ",,,");
    } else {
        put(line, ",%.9f,%.9f,", azimuth_rad(scan->look.from + scan->look.advance),
            azimuth_rad(scan->look.from));
    }
    if (scan->is_numbered) {
        put(line, "%" PRId32, scan->number);
    }
}

void asterix_text_row(const struct asterix_columns *columns, const struct asterix_scan *scan,
                      const struct asterix_mark *mark, char line[ASTERIX_LINE_BYTES])
{
    int64_t time_us = asterix_time_us(mark ? mark->time_128 : scan->time_128);
    uint64_t magnitude = time_us < 0 ? 0 - (uint64_t)time_us : (uint64_t)time_us;

    line[0] = '\0';
    put(line, "%s%" PRIu64 ".%06" PRIu64 ",%" PRId32, time_us < 0 ? "-" : "", magnitude / 1000000,
        magnitude % 1000000, scan->sensor_id);
    if (mark) {
        put_mark(line, mark);
    } else {
        put(line, ",,,,");
    }
    if (columns->has_place) {
        put_place(line, &scan->place);
    }
    if (columns->has_scan) {
        put_scan(line, scan);
    }
    put(line, "\n");
}

struct asterix_rules asterix_text_rules(const struct parameters *parameters, double hold_s,
                                        double wait_s)
{
    return (struct asterix_rules){
        .hold_s = hold_s,
        .is_by_turn = parameters->value[PARAMETER_ASTERIX_SCANS] > 0.5,
        .interval_s = parameters->value[PARAMETER_SCAN_INTERVAL_S],
        .wait_s = wait_s,
    };
}

void asterix_text_suggest_origin(const char *path, const struct asterix_place *place,
                                 struct parameters *parameters)
{
    parameters_suggest(parameters, PARAMETER_ORIGIN_LAT_DEG, place->lat_deg);
    parameters_suggest(parameters, PARAMETER_ORIGIN_LON_DEG, place->lon_deg);
    parameters_suggest(parameters, PARAMETER_ORIGIN_ALT_M, place->alt_m);
    fprintf(stderr,
            "rhotrack: %s: the origin is origin_lat_deg=%.7f, origin_lon_deg=%.7f, "
            "origin_alt_m=%.0f\n",
            path, place->lat_deg, place->lon_deg, place->alt_m);
}

/* ---- What became of records ---- */

void asterix_text_report(const char *path, const struct asterix_counts *counts)
{
    const struct {
        uint64_t count;
        const char *text;
    } lines[] = {
        {counts->not_real, "plots simulated, of test targets or field monitors"},
        {counts->no_detection, "reports without a detection"},
        {counts->incomplete, "plots without source, time or place"},
        {counts->bad_times, "plots with bad times"},
        {counts->late, "plots late"},
        {counts->unplaced, "plots outside every known look of the antenna"},
        {counts->no_room, "plots of too many radars"},
        {counts->services_left, "antenna messages without source, time or sector, or late"},
        {counts->gaps, "gaps in the antenna's messages"},
        {counts->levels_left, "heights used for the range alone, in scans that have plots without"},
        {counts->levels_bad, "flight levels not valid"},
        {counts->dopplers_bad, "Doppler speeds doubtful"},
        {counts->dopplers_raw, "Doppler speeds ambiguous"},
        {counts->dopplers_left, "Doppler speeds left out, of scans that have plots without"},
    };
    const char *between = "";

    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        if (lines[i].count > 0) {
            if (!*between) {
                fprintf(stderr, "rhotrack: %s: ", path);
            }
            fprintf(stderr, "%s%" PRIu64 " %s", between, lines[i].count, lines[i].text);
            between = ", ";
        }
    }
    if (*between) {
        fputc('\n', stderr);
    }
}
