/* SPDX-License-Identifier: MIT */
#include "scan_reader.h"

#include <stdlib.h>

#include "common.h"
#include "plot_source.h"

/* A file and its next scan. */
struct input_file {
    struct plot_source *source;
    struct plot_scan next;
    bool has_next;
};

struct scan_reader {
    struct input_file *files;
    int num_files;
    struct plot_scan now; /* handed out */
    uint64_t scans, plots;
};

static struct scan_reader *open_files(char *const *paths, int num_paths,
                                      const struct parameters *parameters,
                                      struct plot_source_options options)
{
    struct scan_reader *reader = must_calloc(1, sizeof *reader);

    reader->files = must_calloc((size_t)num_paths, sizeof *reader->files);
    reader->num_files = num_paths;
    for (int i = 0; i < num_paths; i++) {
        reader->files[i].source = plot_source_open(paths[i], parameters, options);
    }
    return reader;
}

struct scan_reader *scan_reader_open(char *const *paths, int num_paths,
                                     const struct parameters *parameters, bool keep_going)
{
    return open_files(paths, num_paths, parameters,
                      (struct plot_source_options){.keep_going = keep_going});
}

struct scan_reader *scan_reader_follow(char *path, const struct parameters *parameters,
                                       bool keep_going)
{
    return open_files(&path, 1, parameters,
                      (struct plot_source_options){.keep_going = keep_going, .follow = true});
}

struct scan_reader *scan_reader_open_any(char *const *paths, int num_paths,
                                         const struct parameters *parameters)
{
    return open_files(paths, num_paths, parameters,
                      (struct plot_source_options){.may_lack_sensor = true});
}

/* ---- Scans in order ---- */

/* Of the file whose next scan is the earliest, of equal ones the first; NULL past the last. */
static struct input_file *find_earliest(const struct scan_reader *reader)
{
    struct input_file *earliest = NULL;

    for (int i = 0; i < reader->num_files; i++) {
        struct input_file *file = &reader->files[i];

        if (file->has_next &&
            (!earliest || file->next.scan.time_us < earliest->next.scan.time_us)) {
            earliest = file;
        }
    }
    return earliest;
}

/* The next scan of all files. Returns false after the last. */
static bool read_scan(struct scan_reader *reader, struct plot_scan *scan)
{
    struct input_file *file;

    for (int i = 0; i < reader->num_files; i++) {
        file = &reader->files[i];
        file->has_next = file->has_next || plot_source_next(file->source, &file->next);
    }
    file = find_earliest(reader);
    if (!file) {
        return false;
    }
    *scan = file->next;
    file->has_next = false;
    reader->scans++;
    reader->plots += scan->scan.num_plots;
    return true;
}

const struct rho_scan *scan_reader_next(struct scan_reader *reader)
{
    plot_scan_free(&reader->now);
    return read_scan(reader, &reader->now) ? &reader->now.scan : NULL;
}

bool scan_reader_waits(const struct scan_reader *reader)
{
    return plot_source_waits(reader->files[0].source);
}

bool scan_reader_is_mid_row(const struct scan_reader *reader)
{
    return plot_source_is_mid_row(reader->files[0].source);
}

void scan_reader_complete(struct scan_reader *reader)
{
    plot_source_complete(reader->files[0].source);
}

void scan_reader_end(struct scan_reader *reader)
{
    plot_source_end(reader->files[0].source);
}

const char *scan_reader_why_over(const struct scan_reader *reader)
{
    return plot_source_why_over(reader->files[0].source);
}

const struct rho_sensor *scan_reader_sensor(const struct scan_reader *reader)
{
    return reader->now.has_sensor ? &reader->now.sensor : NULL;
}

uint64_t scan_reader_position(const struct scan_reader *reader)
{
    uint64_t bytes = 0;

    for (int i = 0; i < reader->num_files; i++) {
        bytes += plot_source_position(reader->files[i].source);
    }
    return bytes;
}

struct scan_reader_counts scan_reader_counts(const struct scan_reader *reader)
{
    struct scan_reader_counts counts = {.scans = reader->scans, .plots = reader->plots};

    for (int i = 0; i < reader->num_files; i++) {
        counts.rows_skipped += plot_source_rows_skipped(reader->files[i].source);
    }
    return counts;
}

void scan_reader_report(const struct scan_reader *reader)
{
    say_rows_skipped(scan_reader_counts(reader).rows_skipped);
}

void scan_reader_close(struct scan_reader *reader)
{
    if (!reader) {
        return;
    }
    for (int i = 0; i < reader->num_files; i++) {
        if (reader->files[i].has_next) {
            plot_scan_free(&reader->files[i].next);
        }
        plot_source_close(reader->files[i].source);
    }
    plot_scan_free(&reader->now);
    free(reader->files);
    free(reader);
}
