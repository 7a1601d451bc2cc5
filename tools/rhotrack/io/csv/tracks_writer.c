/* SPDX-License-Identifier: MIT */
#include "io/csv/tracks_writer.h"

#include <inttypes.h>

#include "base/common.h"
#include "rhotrack/detail/angle.h"

void tracks_write_time(FILE *file, int64_t time_us)
{
    char text[TIME_TEXT_BYTES];

    fputs(decimal_seconds_text(time_us, text), file);
}

/* Writes a comma and the number with the fewest digits that keep float32. */
static void write_comma_and_shortest_float(FILE *file, float value)
{
    char text[FLOAT_TEXT_BYTES];

    fputc(',', file);
    fputs(shortest_float_text(value, text), file);
}

void tracks_write_header(FILE *file, struct tracks_columns columns)
{
    static const char *const states[RHO_KALMAN_STATES] = {"x", "y", "z", "vx", "vy", "vz"};

    fputs("t_s,track_id,status,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps,ax_mps2,ay_mps2,az_mps2,"
          "sigma_m,sigma_mps,hits,misses,sensor_id,plot",
          file);
    for (int i = 0; columns.covariance && i < RHO_KALMAN_STATES; i++) {
        for (int j = 0; j <= i; j++) {
            fprintf(file, ",cov_%s_%s", states[i], states[j]);
        }
    }
    if (columns.bodies) {
        fputs(",length_m,width_m,heading_rad,sigma_length_m,sigma_width_m,sigma_heading_rad,"
              "sigma_along_m,sigma_across_m",
              file);
    }
    fputc('\n', file);
}

static void write_body_cells(FILE *file, const struct rho_tracker *tracker, unsigned tracker_index)
{
    struct rho_body body;

    if (!rho_tracker_body_of(tracker, tracker_index, &body)) {
        fputs(",,,,,,,,", file);
        return;
    }
    write_comma_and_shortest_float(file, body.length_m);
    write_comma_and_shortest_float(file, body.width_m);
    write_comma_and_shortest_float(file, body.heading_rad);
    write_comma_and_shortest_float(file, body.sigma_length_m);
    write_comma_and_shortest_float(file, body.sigma_width_m);
    write_comma_and_shortest_float(file, body.sigma_heading_rad);
    write_comma_and_shortest_float(file, body.sigma_along_m);
    write_comma_and_shortest_float(file, body.sigma_across_m);
}

void tracks_write_row(FILE *file, int64_t time_us, const struct rho_track_report *track,
                      unsigned tracker_index, struct tracks_columns columns)
{
    tracks_write_time(file, time_us);
    fprintf(file, ",%" PRIu32 ",%s", track->track_id, rho_track_status_name(track->status));
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        write_comma_and_shortest_float(file, track->state[i]);
    }
    for (int i = 0; i < 3; i++) {
        write_comma_and_shortest_float(file, track->accel_mps2[i]);
    }
    write_comma_and_shortest_float(file, track->sigma_m);
    write_comma_and_shortest_float(file, track->sigma_mps);
    fprintf(file, ",%u,%u,%" PRId32 ",%" PRId32, (unsigned)track->hits, (unsigned)track->misses,
            track->sensor_id, track->plot);
    for (int i = 0; columns.covariance && i < RHO_TRIANGLE(RHO_KALMAN_STATES); i++) {
        write_comma_and_shortest_float(file, track->covariance[i]);
    }
    if (columns.bodies) {
        write_body_cells(file, columns.bodies, tracker_index);
    }
    fputc('\n', file);
}

void tracks_write_report(FILE *file, const struct rho_report *report, struct tracks_columns columns)
{
    for (unsigned i = 0; i < report->num_tracks; i++) {
        if (!report->tracks[i].is_in_doubt) {
            tracks_write_row(file, report->time_us, &report->tracks[i], i, columns);
        }
    }
}

void initiated_write_header(FILE *file)
{
    fputs("track_id,t_s,x_m,y_m,vx_mps,vy_mps,rho_m,theta_rad,scans,score,z_m,vz_mps\n", file);
}

void initiated_write_row(FILE *file, const struct initiated *row)
{
    fprintf(file, "%u,", row->track_id);
    tracks_write_time(file, row->time_us);
    if (row->has_state) {
        write_comma_and_shortest_float(file, row->x_m);
        write_comma_and_shortest_float(file, row->y_m);
        write_comma_and_shortest_float(file, row->vx_mps);
        write_comma_and_shortest_float(file, row->vy_mps);
    } else {
        fputs(",,,,", file);
    }
    write_comma_and_shortest_float(file, row->rho_m);
    write_comma_and_shortest_float(file, row->theta_rad);
    fprintf(file, ",%u", row->scans);
    write_comma_and_shortest_float(file, (float)row->score);
    if (row->has_height) {
        write_comma_and_shortest_float(file, row->z_m);
        write_comma_and_shortest_float(file, row->vz_mps);
    } else {
        fputs(",,", file);
    }
    fputc('\n', file);
}

struct initiated initiated_from_candidate(unsigned track_id, int64_t time_us,
                                          const struct rho_candidate *candidate)
{
    struct rho_line line =
        rho_angle_line(candidate->x_m, candidate->y_m, candidate->vx_mps, candidate->vy_mps);

    return (struct initiated){.track_id = track_id,
                              .time_us = time_us,
                              .has_state = true,
                              .x_m = candidate->x_m,
                              .y_m = candidate->y_m,
                              .vx_mps = candidate->vx_mps,
                              .vy_mps = candidate->vy_mps,
                              .rho_m = line.rho_m,
                              .theta_rad = line.theta_rad,
                              .scans = candidate->hits,
                              .score = (double)((float)candidate->score_mnat / 1000.0f),
                              .has_height = candidate->has_z,
                              .z_m = candidate->z_m,
                              .vz_mps = candidate->vz_mps};
}
