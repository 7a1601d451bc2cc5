/* SPDX-License-Identifier: MIT */
#include "scenario_record.h"

#include <math.h>
#include <stdlib.h>

#include "common.h"

void record_watch(struct scenario_record *record, const struct scenario_antenna *antenna,
                  const struct antenna_targets *targets, size_t num_turns, struct random *random)
{
    if (record->num_antennas == SCENARIO_SENSORS_MAX) {
        fail(EXIT_RUNTIME, "more than %d antennas", SCENARIO_SENSORS_MAX);
    }
    record->antennas[record->num_antennas] = *antenna;
    record->views[record->num_antennas] = antenna_watch(antenna, targets, num_turns, random);
    record->num_antennas++;
}

/* ---- arrivals --------------------------------------------------------------------------------- */

static int by_arrival(const void *a, const void *b)
{
    const struct record_arrival *one = a, *other = b;

    if (one->received_s != other->received_s) {
        return one->received_s > other->received_s ? 1 : -1;
    }
    if (one->antenna != other->antenna) {
        return one->antenna > other->antenna ? 1 : -1;
    }
    return (one->sector > other->sector) - (one->sector < other->sector);
}

void record_arrive(struct scenario_record *record, double late_share, double late_s,
                   struct random *random)
{
    size_t count = 0;

    for (size_t a = 0; a < record->num_antennas; a++) {
        count += record->views[a].num_sectors;
    }
    record->arrivals = must_calloc(count + 1, sizeof *record->arrivals);
    for (size_t a = 0; a < record->num_antennas; a++) {
        for (size_t i = 0; i < record->views[a].num_sectors; i++) {
            bool is_late = random_uniform(random) < late_share;
            double end_s = record->views[a].sectors[i].end_s - record->antennas[a].time_bias_s;

            record->arrivals[record->num_arrivals++] = (struct record_arrival){
                .received_s = end_s + (is_late ? late_s : 0.0), .antenna = a, .sector = i};
        }
    }
    qsort(record->arrivals, record->num_arrivals, sizeof *record->arrivals, by_arrival);
}

/* ---- truth ------------------------------------------------------------------------------------ */

int64_t record_scan_us(const struct scenario_record *record, const struct record_arrival *arrival)
{
    return llround(record->views[arrival->antenna].sectors[arrival->sector].end_s * 1e6);
}

static int by_number(const void *a, const void *b)
{
    const int64_t *one = a, *other = b;

    return (*one > *other) - (*one < *other);
}

/* When the scans ended, by the true time, each once, in new memory. */
static int64_t *times_of(const struct scenario_record *record, size_t *count)
{
    int64_t *times_us = must_calloc(record->num_arrivals + 1, sizeof *times_us);
    size_t kept = 0;

    for (size_t i = 0; i < record->num_arrivals; i++) {
        const struct record_arrival *arrival = &record->arrivals[i];
        double bias_s = record->antennas[arrival->antenna].time_bias_s;

        times_us[i] = record_scan_us(record, arrival) - llround(bias_s * 1e6);
    }
    qsort(times_us, record->num_arrivals, sizeof *times_us, by_number);
    for (size_t i = 0; i < record->num_arrivals; i++) {
        if (kept == 0 || times_us[i] > times_us[kept - 1]) {
            times_us[kept++] = times_us[i];
        }
    }
    *count = kept;
    return times_us;
}

struct truth_point *record_truth(const struct scenario_record *record,
                                 const struct antenna_targets *targets, size_t *num_truth,
                                 size_t *num_times)
{
    int64_t *times_us = times_of(record, num_times);
    struct truth_point *truth = must_calloc(*num_times * targets->count + 1, sizeof *truth);

    *num_truth = 0;
    for (size_t i = 0; i < *num_times; i++) {
        for (size_t target = 0; target < targets->count; target++) {
            double t_s = (double)times_us[i] * 1e-6;

            if (targets->at(targets->context, target, t_s, &truth[*num_truth])) {
                truth[(*num_truth)++].t_s = t_s;
            }
        }
    }
    free(times_us);
    return truth;
}

/* ---- files ------------------------------------------------------------------------------------ */

static bool measures_range_rate(const struct scenario_record *record)
{
    for (size_t a = 0; a < record->num_antennas; a++) {
        if (record->antennas[a].has_range_rate) {
            return true;
        }
    }
    return false;
}

static void write_scan(const struct scenario_record *record, const struct record_arrival *arrival,
                       bool has_rate_column, FILE *file)
{
    const struct scenario_antenna *antenna = &record->antennas[arrival->antenna];
    const struct antenna_sector *sector = &record->views[arrival->antenna].sectors[arrival->sector];
    const char *no_rate = has_rate_column ? "," : "";
    char tail[160], received[32] = "";

    if (record->has_received) {
        snprintf(received, sizeof received, ",%.6f", arrival->received_s);
    }
    snprintf(tail, sizeof tail, ",%.3f,%.3f,%.7f,%.7f,%zu%s", antenna->x_m, antenna->y_m,
             sector->from_rad, sector->to_rad, arrival->sector + 1, received);
    fprintf(file, "%.6f,%d,,%s%s\n", sector->end_s, antenna->sensor_id, no_rate, tail);
    for (size_t i = 0; i < sector->num_plots; i++) {
        const struct antenna_plot *plot = &sector->plots[i];

        fprintf(file, "%.6f,%d,%.2f,%.7f", plot->t_s, antenna->sensor_id, plot->range_m,
                plot->azimuth_rad);
        if (antenna->has_range_rate) {
            fprintf(file, ",%.3f%s\n", plot->range_rate_mps, tail);
        } else {
            fprintf(file, "%s%s\n", no_rate, tail);
        }
    }
}

void record_write(const struct scenario_record *record, const char *folder)
{
    char *path = path_join(folder, "polar.csv");
    struct output output = output_open(path);
    bool has_rate_column = measures_range_rate(record);

    fprintf(output.file,
            "t_s,sensor_id,range_m,azimuth_rad%s,sensor_x_m,sensor_y_m,sector_from_rad,"
            "sector_to_rad,scan%s\n",
            has_rate_column ? ",range_rate_mps" : "", record->has_received ? ",received_s" : "");
    for (size_t i = 0; i < record->num_arrivals; i++) {
        write_scan(record, &record->arrivals[i], has_rate_column, output.file);
    }
    output_close(&output);
    free(path);
}

void record_write_sensors(const struct scenario_record *record, FILE *file)
{
    for (size_t a = 0; a < record->num_antennas; a++) {
        const struct scenario_antenna *antenna = &record->antennas[a];

        fprintf(file, "\n[sensor %d]\nx_m = %.3f\ny_m = %.3f\npd = %g\n", antenna->sensor_id,
                antenna->x_m, antenna->y_m, antenna->pd);
        fprintf(file, "sigma_range_m = %g\nsigma_azimuth_rad = %g\n", antenna->sigma_range_m,
                antenna->sigma_azimuth_rad);
        if (antenna->has_range_rate) {
            fprintf(file, "sigma_range_rate_mps = %g\n", antenna->sigma_range_rate_mps);
        }
        fprintf(file, "range_min_m = %g\nrange_max_m = %g\n", antenna->range_min_m,
                antenna->range_max_m);
    }
}

void record_free(struct scenario_record *record)
{
    if (!record) {
        return;
    }
    for (size_t a = 0; a < record->num_antennas; a++) {
        antenna_view_free(&record->views[a]);
    }
    free(record->arrivals);
    free(record);
}
