/* SPDX-License-Identifier: MIT */
/*
 * scenario_record: what turning radars saw, in the order in which it arrived, and as files.
 *
 * A sector is a scan, whose time is its end, when it is known. It arrives then, by the true time, or late.
 */
#ifndef RHOTRACK_TOOL_SCENARIO_RECORD_H
#define RHOTRACK_TOOL_SCENARIO_RECORD_H

#include <stdio.h>

#include "scenario_antenna.h"

struct record_arrival {
    double received_s;
    size_t antenna, sector;
};

struct scenario_record {
    size_t num_antennas;
    struct scenario_antenna antennas[SCENARIO_SENSORS_MAX];
    struct antenna_view views[SCENARIO_SENSORS_MAX];
    bool has_received; /* the file says when scans arrived */
    size_t num_arrivals;
    struct record_arrival *arrivals; /* of all sectors, in the order of arrival */
};

/* Lets one more antenna watch. */
void record_watch(struct scenario_record *record, const struct scenario_antenna *antenna,
                  const struct antenna_targets *targets, size_t num_turns, struct random *random);

/* Lets all sectors arrive, this share of them so much late. After the last antenna. */
void record_arrive(struct scenario_record *record, double late_share, double late_s,
                   struct random *random);

/* A scan's time in whole microseconds, as its radar says it and files have it. */
int64_t record_scan_us(const struct scenario_record *record, const struct record_arrival *arrival);

/* All targets at all scans' ends by the true time, by time, then target, in new memory. The count goes to *num_truth, and to *num_times. */
struct truth_point *record_truth(const struct scenario_record *record,
                                 const struct antenna_targets *targets, size_t *num_truth,
                                 size_t *num_times);

/* FOLDER/polar.csv: rows in the order of arrival; each scan begins with one that saw nothing, which has its time. */
void record_write(const struct scenario_record *record, const char *folder);

/* A section of an INI file for each radar: what a tracker may know of it, its biases not. */
void record_write_sensors(const struct scenario_record *record, FILE *file);

void record_free(struct scenario_record *record); /* and what it holds; NULL: nothing */

#endif
