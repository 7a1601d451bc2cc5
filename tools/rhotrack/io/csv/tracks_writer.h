/* SPDX-License-Identifier: MIT */
/*
 * tracks_writer: writes tracks and initiated tracks as CSV. Times have microseconds, numbers the
 * fewest digits that keep float32.
 */
#ifndef RHOTRACK_TOOL_TRACKS_WRITER_H
#define RHOTRACK_TOOL_TRACKS_WRITER_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "rhotrack/initiator.h"
#include "rhotrack/tracker.h"

/*
 * Optional columns behind t_s,track_id,status,...,plot: the 21 of the covariance,
 * cov_x_x,cov_y_x,cov_y_y,...,cov_vz_vz (SI units), and those of the tracks' bodies in the tracker
 * (NULL: none), length_m, width_m, heading_rad, their sigmas, and sigma_along_m, sigma_across_m of
 * the centre; empty where a track has no known body.
 */
struct tracks_columns {
    bool covariance;
    const struct rho_tracker *bodies;
};
void tracks_write_header(FILE *file, struct tracks_columns columns);

/* Writes a time in seconds, with six decimals. */
void tracks_write_time(FILE *file, int64_t time_us);

/*
 * Writes one row: a track's estimate at time_us; tracker_index: the track's index in the tracker.
 */
void tracks_write_row(FILE *file, int64_t time_us, const struct rho_track_report *track,
                      unsigned tracker_index, struct tracks_columns columns);

/* Writes one row for each track of the report. */
void tracks_write_report(FILE *file, const struct rho_report *report,
                         struct tracks_columns columns);

/* Writes the header track_id,t_s,x_m,y_m,vx_mps,vy_mps,rho_m,theta_rad,scans,score,z_m,vz_mps. */
void initiated_write_header(FILE *file);

/* One initiated track. */
struct initiated {
    unsigned track_id;
    int64_t time_us; /* time of the batch's last scan, for which position and velocity hold */
    bool has_state;  /* false: the columns x_m .. vy_mps are empty */
    float x_m, y_m, vx_mps, vy_mps;
    float rho_m, theta_rad;
    unsigned scans;        /* number of scans that voted */
    unsigned sensor_pairs; /* number of pairs of passive sensors that confirm it; 0 for plots */
    double score;          /* score in nats, or votes */
    bool has_height;       /* false: the columns z_m and vz_mps are empty */
    float z_m, vz_mps;
};
void initiated_write_row(FILE *file, const struct initiated *row);

/* The row of a candidate, with its score in nats. */
struct initiated initiated_from_candidate(unsigned track_id, int64_t time_us,
                                          const struct rho_candidate *candidate);

#endif
