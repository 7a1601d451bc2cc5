/* SPDX-License-Identifier: MIT */
/*
 * tracks_writer: tracks and initiated tracks as CSV. Times to the microsecond, numbers in the
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
 * Columns behind t_s,track_id,status,...,plot: 21 of the covariance,
 * cov_x_x,cov_y_x,cov_y_y,...,cov_vz_vz (SI units), and those of the tracks' bodies in the tracker
 * (NULL: none), length_m, width_m, heading_rad, sigmas of these, and sigma_along_m,
 * sigma_across_m of the centre; empty where a body is not known.
 */
struct tracks_columns {
    bool covariance;
    const struct rho_tracker *bodies;
};
void tracks_write_header(FILE *file, struct tracks_columns columns);

/* Seconds, to the microsecond. */
void tracks_write_time(FILE *file, int64_t time_us);

/* One row: a track's estimate at time_us; its place among the tracker's. */
void tracks_write_row(FILE *file, int64_t time_us, const struct rho_track_report *track,
                      unsigned place, struct tracks_columns columns);

/* One row a track of the report. */
void tracks_write_report(FILE *file, const struct rho_report *report,
                         struct tracks_columns columns);

/* track_id,t_s,x_m,y_m,vx_mps,vy_mps,rho_m,theta_rad,scans,score */
void initiated_write_header(FILE *file);

/* One track found. */
struct initiated {
    unsigned track_id;
    int64_t time_us; /* of the batch's last scan, which place and velocity are for */
    bool has_state;  /* else the columns x_m .. vy_mps are empty */
    float x_m, y_m, vx_mps, vy_mps;
    float rho_m, theta_rad;
    unsigned scans;        /* that voted */
    unsigned sensor_pairs; /* of passive sensors, that confirm it; else 0 */
    double score;          /* nats or votes */
};
void initiated_write_row(FILE *file, const struct initiated *row);

/* A candidate's row; its score is in nats. */
struct initiated initiated_from(unsigned track_id, int64_t time_us,
                                const struct rho_candidate *candidate);

#endif
