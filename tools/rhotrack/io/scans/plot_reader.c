/* SPDX-License-Identifier: MIT */
#include "io/scans/plot_reader.h"

#include <stdlib.h>

#include "base/common.h"
#include "io/scans/merged_scan_files.h"

struct plot_reader {
    struct merged_scan_files files;
    struct sensor_scan now; /* the scan handed out */
    uint64_t scans, plots;
};

static struct plot_reader *open_reader(char *const *paths, int num_paths,
                                       const struct parameters *parameters,
                                       struct scan_source_options options)
{
    struct plot_reader *reader = must_calloc(1, sizeof *reader);

    options.kind = RECORD_PLOTS;
    reader->files = merged_scan_files_open(paths, num_paths, parameters, options);
    return reader;
}

struct plot_reader *plot_reader_open(char *const *paths, int num_paths,
                                     const struct parameters *parameters, bool keep_going)
{
    return open_reader(paths, num_paths, parameters,
                       (struct scan_source_options){.keep_going = keep_going});
}

struct plot_reader *plot_reader_follow(char *path, const struct parameters *parameters,
                                       bool keep_going)
{
    return open_reader(&path, 1, parameters,
                       (struct scan_source_options){.keep_going = keep_going, .follow = true});
}

struct plot_reader *plot_reader_open_sensorless(char *const *paths, int num_paths,
                                                const struct parameters *parameters)
{
    return open_reader(paths, num_paths, parameters,
                       (struct scan_source_options){.may_lack_sensor = true});
}

const struct rho_scan *plot_reader_next(struct plot_reader *reader)
{
    sensor_scan_free(&reader->now);
    if (!merged_scan_files_next(&reader->files, &reader->now)) {
        return NULL;
    }
    reader->scans++;
    reader->plots += reader->now.scan.num_plots;
    return &reader->now.scan;
}

/* The source of a followed file, which is the only file. */
static struct scan_source *followed_source(const struct plot_reader *reader)
{
    return reader->files.list[0].source;
}

bool plot_reader_waits(const struct plot_reader *reader)
{
    return scan_source_waits(followed_source(reader));
}

bool plot_reader_is_mid_row(const struct plot_reader *reader)
{
    return scan_source_is_mid_row(followed_source(reader));
}

void plot_reader_complete_scans(struct plot_reader *reader)
{
    scan_source_complete_scans(followed_source(reader));
}

void plot_reader_end_reading(struct plot_reader *reader)
{
    scan_source_end_reading(followed_source(reader));
}

const char *plot_reader_why_not_followed(const struct plot_reader *reader)
{
    return scan_source_why_not_followed(followed_source(reader));
}

const struct rho_sensor *plot_reader_sensor(const struct plot_reader *reader)
{
    return reader->now.has_sensor ? &reader->now.sensor : NULL;
}

uint64_t plot_reader_position(const struct plot_reader *reader)
{
    return merged_scan_files_bytes_read(&reader->files);
}

struct plot_reader_counts plot_reader_counts(const struct plot_reader *reader)
{
    return (struct plot_reader_counts){.scans = reader->scans,
                                       .plots = reader->plots,
                                       .rows_skipped =
                                           merged_scan_files_rows_skipped(&reader->files)};
}

void plot_reader_report_skipped(const struct plot_reader *reader)
{
    print_rows_skipped(plot_reader_counts(reader).rows_skipped);
}

void plot_reader_close(struct plot_reader *reader)
{
    if (!reader) {
        return;
    }
    merged_scan_files_close(&reader->files);
    sensor_scan_free(&reader->now);
    free(reader);
}
