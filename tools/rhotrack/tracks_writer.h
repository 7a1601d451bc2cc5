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
 * t_s,track_id,status,...,plot; with covariance 21 columns more:
 * cov_x_x,cov_y_x,cov_y_y,...,cov_vz_vz (SI units).
 */
void tracks_write_header(FILE *file, bool with_covariance);

/* One row a track of the report. */
void tracks_write_report(FILE *file, const struct rho_report *report, bool with_covariance);

/* track_id,t_s,x_m,y_m,vx_mps,vy_mps,rho_m,theta_rad,scans,score */
void initiated_write_header(FILE *file);

/* A candidate at the time of the batch's last scan; score in nats. */
void initiated_write_row(FILE *file, unsigned track_id, int64_t time_us,
                         const struct rho_candidate *candidate);

#endif
