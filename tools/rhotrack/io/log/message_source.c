/* SPDX-License-Identifier: MIT */
#include "io/log/message_source.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "io/log/lcm_log.h"
#include "io/rows/rows_from_csv.h"
#include "io/rows/rows_to_messages.h"
#include "io/rows/rows_turn_numbers.h"

/* One input file with its next message: a log, or a table's rows and their scans. */
struct input {
    const char *path;
    struct lcm_log_reader *log; /* NULL: the file is a table of rows */
    struct lcm_log_event log_event;
    struct rows_file file;
    struct rows_to_messages scans;
    struct rows_at at;
    struct rows_output output;
    bool has_event;
    struct message_event event;
};

struct message_source {
    struct input *inputs;
    int num_inputs;
    struct input *taken; /* input whose message was handed out; the next call advances it */
};

static void advance_to_next_message(struct input *input)
{
    if (input->log) {
        input->has_event = lcm_log_next(input->log, &input->log_event);
        input->event = (struct message_event){.utime = input->log_event.utime,
                                              .channel = input->log_event.channel,
                                              .data = input->log_event.data,
                                              .size = input->log_event.size};
    } else {
        input->has_event = rows_to_messages_next_message(&input->scans, &input->at, &input->output);
        input->event = (struct message_event){.utime = input->output.utime,
                                              .channel = input->output.channel,
                                              .data = input->output.data,
                                              .size = input->output.size};
    }
}

static void open_log_or_csv_input(struct input *input, const char *path,
                                  const struct parameters *parameters, bool keep_going)
{
    input->path = path;
    if (lcm_log_is_log(path)) {
        input->log = lcm_log_open(path);
    } else {
        rows_read_csv_or_asterix(&input->file, path, parameters, keep_going);
        rows_number_turns(&input->file, parameters);
        rows_to_messages_make_scans(&input->scans, &input->file,
                                    llround(parameters->value[PARAMETER_SCAN_INTERVAL_S] * 1e6));
    }
    advance_to_next_message(input);
    if (!input->has_event) {
        fail(EXIT_USAGE, "%s: contains no %s", path,
             input->log ? "event of an LCM log" : "good scan");
    }
}

struct message_source *message_source_open(char *const *paths, int num_paths,
                                           const struct parameters *parameters, bool keep_going)
{
    struct message_source *source = must_calloc(1, sizeof *source);

    source->num_inputs = num_paths;
    source->inputs = must_calloc((size_t)num_paths, sizeof *source->inputs);
    for (int i = 0; i < num_paths; i++) {
        open_log_or_csv_input(&source->inputs[i], paths[i], parameters, keep_going);
    }
    return source;
}

bool message_source_next(struct message_source *source, struct message_event *event)
{
    if (source->taken) {
        advance_to_next_message(source->taken);
    }
    source->taken = NULL;
    for (int i = 0; i < source->num_inputs; i++) {
        struct input *input = &source->inputs[i];

        if (input->has_event &&
            (!source->taken || input->event.utime < source->taken->event.utime)) {
            source->taken = input;
        }
    }
    if (!source->taken) {
        return false;
    }
    *event = source->taken->event;
    return true;
}

void message_source_report_skipped(const struct message_source *source)
{
    uint64_t rows_skipped = 0;

    for (int i = 0; i < source->num_inputs; i++) {
        if (source->inputs[i].log) {
            lcm_log_report_skipped(source->inputs[i].log);
        }
        rows_skipped += source->inputs[i].file.rows_skipped;
    }
    print_rows_skipped(rows_skipped);
}

void message_source_close(struct message_source *source)
{
    if (!source) {
        return;
    }
    for (int i = 0; i < source->num_inputs; i++) {
        lcm_log_close(source->inputs[i].log);
        rows_to_messages_free(&source->inputs[i].scans);
        rows_file_free(&source->inputs[i].file);
    }
    free(source->inputs);
    free(source);
}
