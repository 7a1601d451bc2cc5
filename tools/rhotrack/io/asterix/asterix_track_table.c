/* SPDX-License-Identifier: MIT */
#include "io/asterix/asterix_track_table.h"

#include <inttypes.h>
#include <math.h>

#include "base/common.h"
#include "io/asterix/asterix_file.h"
#include "io/asterix/asterix_scans.h"
#include "io/csv/local_frame.h"
#include "io/rows/rows_in_memory.h"
#include "rhotrack/message.h"

enum column {
    AT_T_S,
    AT_TRACK_ID,
    AT_STATUS,
    AT_X_M,
    AT_Y_M,
    AT_Z_M,
    AT_VX_MPS,
    AT_VY_MPS,
    AT_VZ_MPS,
    AT_AX_MPS2,
    AT_AY_MPS2,
    AT_SIGMA_M,
    AT_SIGMA_MPS,
    AT_SENSOR_ID,
    NUM_COLUMNS
};

static const struct table_column all_columns[NUM_COLUMNS] = {
    [AT_T_S] = {.name = "t_s", .decimals = 6},
    [AT_TRACK_ID] = {.name = "track_id", .decimals = 0},
    [AT_STATUS] = {.name = "status", .decimals = 0, .word = rows_track_status_name},
    [AT_X_M] = {.name = "x_m", .decimals = 3},
    [AT_Y_M] = {.name = "y_m", .decimals = 3},
    [AT_Z_M] = {.name = "z_m", .decimals = 3},
    [AT_VX_MPS] = {.name = "vx_mps", .decimals = 2},
    [AT_VY_MPS] = {.name = "vy_mps", .decimals = 2},
    [AT_VZ_MPS] = {.name = "vz_mps", .decimals = 4},
    [AT_AX_MPS2] = {.name = "ax_mps2", .decimals = 2},
    [AT_AY_MPS2] = {.name = "ay_mps2", .decimals = 2},
    [AT_SIGMA_M] = {.name = "sigma_m", .decimals = 3},
    [AT_SIGMA_MPS] = {.name = "sigma_mps", .decimals = 3},
    [AT_SENSOR_ID] = {.name = "sensor_id", .decimals = 0},
};

struct reading {
    struct table *table;
    struct local_frame *frame; /* NULL where the origin is not set */
    bool has_time;
    /* time of the newest record, since the midnight before the first */
    int64_t time_128;
    /* line number of the next row in the CSV file that `convert` would write */
    uint32_t line;
    /* on_earth: number of incomplete records that have a place in I062/105 alone */
    uint64_t incomplete, on_earth;
};

bool asterix_file_has_only_tracks(const char *path)
{
    struct asterix_file *file;
    struct asterix_record record;
    bool has_radar, has_tracks;

    if (!asterix_file_is_asterix(path)) {
        return false;
    }
    file = asterix_file_open(path, true);
    has_radar = asterix_file_next_record(file, &record);
    has_tracks = asterix_file_skipped_blocks(file, ASTERIX_TRACKS) > 0;
    asterix_file_close(file);
    return has_tracks && !has_radar;
}

/*
 * Converts a time of day to a continuous time: half a day or more before the newest is the next
 * day.
 */
static int64_t time_since_first_midnight(struct reading *reading, uint32_t of_day_128)
{
    const int64_t day_128 = reading->time_128 - reading->time_128 % ASTERIX_DAY;
    int64_t time_128 = day_128 + of_day_128 % ASTERIX_DAY;

    if (reading->has_time && time_128 - reading->time_128 <= -ASTERIX_DAY / 2) {
        time_128 += ASTERIX_DAY;
    }
    reading->has_time = true;
    reading->time_128 = time_128 > reading->time_128 ? time_128 : reading->time_128;
    return time_128;
}

static double rms_sigma(double x, double y)
{
    return sqrt(0.5 * (x * x + y * y));
}

/* Fills velocity, acceleration and sigmas. */
static void put_motion_cells(const struct asterix_track *track, double *cells)
{
    if (track->has_velocity) {
        cells[AT_VX_MPS] = track->vx_mps;
        cells[AT_VY_MPS] = track->vy_mps;
    }
    if (track->has_climb) {
        cells[AT_VZ_MPS] = track->climb_mps;
    }
    if (track->has_accel) {
        cells[AT_AX_MPS2] = track->ax_mps2;
        cells[AT_AY_MPS2] = track->ay_mps2;
    }
    if (track->has_sigma) {
        cells[AT_SIGMA_M] = rms_sigma(track->sigma_x_m, track->sigma_y_m);
        cells[AT_SIGMA_MPS] = rms_sigma(track->sigma_vx_mps, track->sigma_vy_mps);
    }
}

static void add_track_row(struct reading *reading, const struct asterix_track *track)
{
    const bool is_placed =
        track->has_place || (track->has_geodetic && reading->frame && fabs(track->lat_deg) <= 90);
    double *cells;

    if (!track->has_time || !track->has_number || !is_placed) {
        reading->incomplete++;
        reading->on_earth += track->has_geodetic;
        return;
    }
    cells = table_add_row_of_numbers(
        reading->table, asterix_time_us(time_since_first_midnight(reading, track->time_128)),
        reading->line++);
    cells[AT_TRACK_ID] = track->number;
    cells[AT_STATUS] = track->is_last        ? RHO_MESSAGE_TRACK_DELETED
                       : track->is_tentative ? RHO_MESSAGE_TRACK_TENTATIVE
                       : track->is_coasting  ? RHO_MESSAGE_TRACK_COASTING
                                             : RHO_MESSAGE_TRACK_CONFIRMED;
    if (track->has_geodetic && reading->frame) {
        const double geodetic[3] = {track->lat_deg, track->lon_deg,
                                    track->has_altitude ? track->alt_m : 0};
        double place_m[3];

        local_frame_to_local(reading->frame, geodetic, place_m);
        cells[AT_X_M] = place_m[0];
        cells[AT_Y_M] = place_m[1];
        cells[AT_Z_M] = track->has_altitude ? place_m[2] : (double)NAN;
    } else {
        cells[AT_X_M] = track->x_m;
        cells[AT_Y_M] = track->y_m;
    }
    put_motion_cells(track, cells);
    if (track->source.is_given) {
        cells[AT_SENSOR_ID] = asterix_sensor_id(&track->source);
    }
}

/* Exit 2 where there were no tracks; reports tracks that were incomplete. */
static void check_tracks_found(const struct reading *reading, const char *path)
{
    if (reading->table->num_rows == 0 && reading->on_earth > 0) {
        fail(EXIT_USAGE,
             "%s: its tracks (CAT062) have positions in latitude and longitude only (I062/105): %s",
             path, parameters_no_origin);
    }
    if (reading->table->num_rows == 0) {
        fail(EXIT_USAGE, "%s: contains no track (CAT062) with time, number and place", path);
    }
    if (reading->incomplete > 0) {
        fprintf(stderr, "rhotrack: %s: %" PRIu64 " tracks without time, number or place left out\n",
                path, reading->incomplete);
    }
}

struct table *asterix_track_table_read(const char *path, const struct parameters *parameters,
                                       bool keep_going)
{
    struct reading reading = {.table = table_make_empty_of_numbers(path, all_columns, NUM_COLUMNS),
                              .line = 2};
    struct asterix_file *file = asterix_file_open_tracks(path, keep_going);
    struct asterix_record record;

    if (parameters && parameters_has_origin(parameters)) {
        reading.frame = parameters_open_local_frame(parameters);
    }
    while (asterix_file_next_record(file, &record)) {
        struct asterix_track track;

        asterix_track_read(&record, &track);
        add_track_row(&reading, &track);
    }
    asterix_file_report_skipped(file);
    asterix_file_close(file);
    local_frame_close(reading.frame);
    check_tracks_found(&reading, path);
    return reading.table;
}
