/* SPDX-License-Identifier: MIT */
#include "io/csv/guess_origin.h"

#include <math.h>
#include <sys/stat.h>

#include "base/common.h"
#include "io/asterix/asterix_file.h"
#include "io/csv/table_stream.h"
#include "io/log/lcm_log.h"

#define ROWS_MAX 5000       /* largest number of rows previewed */
#define STEPS_MIN 20        /* fewest steps in azimuth from plot to plot that give a sense */
#define CLOCKWISE_SHARE 0.9 /* least share of rising steps */
#define HALF_TURN_RAD 3.15  /* a larger azimuth is not in -pi .. pi */

struct azimuths {
    double lowest, highest, last_s, last_rad, last_sensor;
    unsigned rising, falling;
};

/* Counts the step from the azimuth before as rising or falling. */
static void count_azimuth_step(struct azimuths *azimuths, double time_s, double sensor,
                               double azimuth_rad)
{
    const double step_rad = azimuth_rad - azimuths->last_rad;

    azimuths->lowest = fmin(azimuths->lowest, azimuth_rad);
    azimuths->highest = fmax(azimuths->highest, azimuth_rad);
    if (time_s > azimuths->last_s && fabs(sensor - azimuths->last_sensor) < 0.5 &&
        fabs(step_rad) < M_PI) {
        azimuths->rising += step_rad > 0;
        azimuths->falling += step_rad < 0;
    }
    azimuths->last_s = time_s;
    azimuths->last_sensor = sensor;
    azimuths->last_rad = azimuth_rad;
}

static bool are_compass_azimuths(const struct azimuths *azimuths)
{
    const unsigned steps = azimuths->rising + azimuths->falling;

    return azimuths->lowest >= 0 && azimuths->highest > HALF_TURN_RAD && steps >= STEPS_MIN &&
           azimuths->rising >= CLOCKWISE_SHARE * steps;
}

/* The number in a cell of the table's only row, or NaN where there is none. */
static double cell_number_or_nan(const struct table *table, int column)
{
    double value;

    return column < 0 || table_is_cell_empty(table, 0, column) ||
                   table_read_number(table, 0, column, &value) != NULL
               ? NAN
               : value;
}

static double cell_time_s_or_nan(const struct table *table, int column)
{
    int64_t time_us;

    return column < 0 || table_read_time_us(table, 0, column, &time_us) != NULL
               ? NAN
               : (double)time_us * 1e-6;
}

static void note_place_of_row(const struct table *table, const char *lat, const char *lon,
                              const char *alt, struct origin_and_azimuth_sense *look)
{
    const double lat_deg = cell_number_or_nan(table, table_find_column(table, lat));
    const double lon_deg = cell_number_or_nan(table, table_find_column(table, lon));

    if (!look->has_place && fabs(lat_deg) <= 90 && lon_deg >= -180 && lon_deg <= 360) {
        const double alt_m = alt ? cell_number_or_nan(table, table_find_column(table, alt)) : 0;

        *look = (struct origin_and_azimuth_sense){.has_place = true,
                                                  .lat_deg = lat_deg,
                                                  .lon_deg = lon_deg,
                                                  .alt_m = isnan(alt_m) ? 0 : alt_m};
    }
}

static bool is_plain_csv_file(const char *path)
{
    struct stat status;

    return !asterix_file_is_asterix(path) && stat(path, &status) == 0 && S_ISREG(status.st_mode) &&
           status.st_size > 0 && !lcm_log_is_log(path);
}

struct origin_and_azimuth_sense guess_origin_from_rows(const char *path)
{
    struct origin_and_azimuth_sense look = {.has_place = false};
    struct azimuths azimuths = {.lowest = INFINITY, .highest = -INFINITY, .last_s = INFINITY};
    struct table_stream *stream;
    const struct table *table;

    if (!is_plain_csv_file(path)) {
        return look;
    }
    stream = table_stream_open(path, NULL, true, false);
    table = table_stream_table(stream);
    if (table_find_column(table, "target_id") < 0 || table_find_column(table, "sensor_id") >= 0) {
        const int azimuth = table_find_column(table, "azimuth_rad"),
                  time = table_find_column(table, "t_s");
        const bool has_azimuth = azimuth >= 0;
        const bool may_have_place = table_find_column(table, "lat_deg") >= 0 ||
                                    table_find_column(table, "sensor_lat_deg") >= 0;

        for (unsigned row = 0;
             row < ROWS_MAX && (has_azimuth || (may_have_place && !look.has_place)) &&
             table_stream_next(stream) == TABLE_STREAM_ROW;
             row++) {
            const double azimuth_rad = cell_number_or_nan(table, azimuth);

            note_place_of_row(table, "sensor_lat_deg", "sensor_lon_deg", "sensor_alt_m", &look);
            /* of a target: its height is no height for the origin */
            note_place_of_row(table, "lat_deg", "lon_deg", NULL, &look);
            if (!isnan(azimuth_rad)) {
                const double sensor =
                    cell_number_or_nan(table, table_find_column(table, "sensor_id"));

                count_azimuth_step(&azimuths, cell_time_s_or_nan(table, time),
                                   isnan(sensor) ? 0 : sensor, azimuth_rad);
            }
        }
    }
    table_stream_close(stream);
    look.has_compass_azimuths = are_compass_azimuths(&azimuths);
    return look;
}
