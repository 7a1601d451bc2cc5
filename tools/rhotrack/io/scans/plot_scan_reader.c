/* SPDX-License-Identifier: MIT */
#include "io/scans/plot_scan_reader.h"

#include <stdlib.h>

#include "base/common.h"
#include "io/scans/merged_scan_files.h"

struct plot_scan_reader {
    struct merged_scan_files files;
    struct sensor_scan now; /* the scan handed out */
    uint64_t scans, plots;
};

static struct plot_scan_reader *open_reader(char *const *paths, int num_paths,
                                            const struct parameters *parameters,
                                            struct scans_of_one_file_options options)
{
    struct plot_scan_reader *reader = must_calloc(1, sizeof *reader);

    options.kind = RECORD_PLOTS;
    reader->files = merged_scan_files_open(paths, num_paths, parameters, options);
    return reader;
}

struct plot_scan_reader *plot_scan_reader_open(char *const *paths, int num_paths,
                                               const struct parameters *parameters, bool keep_going)
{
    return open_reader(paths, num_paths, parameters,
                       (struct scans_of_one_file_options){.keep_going = keep_going});
}

struct plot_scan_reader *plot_scan_reader_follow(char *path, const struct parameters *parameters,
                                                 bool keep_going)
{
    return open_reader(
        &path, 1, parameters,
        (struct scans_of_one_file_options){.keep_going = keep_going, .follow = true});
}

struct plot_scan_reader *
plot_scan_reader_open_sensor_id_optional(char *const *paths, int num_paths,
                                         const struct parameters *parameters)
{
    return open_reader(paths, num_paths, parameters,
                       (struct scans_of_one_file_options){.may_lack_sensor = true});
}

const struct rho_scan *plot_scan_reader_next(struct plot_scan_reader *reader)
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
static struct scans_of_one_file *followed_source(const struct plot_scan_reader *reader)
{
    return reader->files.list[0].source;
}

bool plot_scan_reader_waits_for_rows(const struct plot_scan_reader *reader)
{
    return scans_of_one_file_waits_for_rows(followed_source(reader));
}

bool plot_scan_reader_is_mid_row(const struct plot_scan_reader *reader)
{
    return scans_of_one_file_is_mid_row(followed_source(reader));
}

void plot_scan_reader_complete_scans_so_far(struct plot_scan_reader *reader)
{
    scans_of_one_file_complete_scans_so_far(followed_source(reader));
}

void plot_scan_reader_end_reading(struct plot_scan_reader *reader)
{
    scans_of_one_file_end_reading(followed_source(reader));
}

const char *plot_scan_reader_why_cannot_be_followed(const struct plot_scan_reader *reader)
{
    return scans_of_one_file_why_cannot_be_followed(followed_source(reader));
}

const struct rho_sensor *plot_scan_reader_sensor(const struct plot_scan_reader *reader)
{
    return reader->now.has_sensor ? &reader->now.sensor : NULL;
}

uint64_t plot_scan_reader_position(const struct plot_scan_reader *reader)
{
    return merged_scan_files_bytes_read(&reader->files);
}

struct plot_scan_reader_counts plot_scan_reader_counts(const struct plot_scan_reader *reader)
{
    return (struct plot_scan_reader_counts){.scans = reader->scans,
                                            .plots = reader->plots,
                                            .rows_skipped =
                                                merged_scan_files_rows_skipped(&reader->files)};
}

void plot_scan_reader_report_skipped(const struct plot_scan_reader *reader)
{
    print_rows_skipped(plot_scan_reader_counts(reader).rows_skipped);
}

void plot_scan_reader_close(struct plot_scan_reader *reader)
{
    if (!reader) {
        return;
    }
    merged_scan_files_close(&reader->files);
    sensor_scan_free(&reader->now);
    free(reader);
}
