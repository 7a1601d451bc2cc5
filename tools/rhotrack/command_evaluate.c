/* SPDX-License-Identifier: MIT */
/* evaluate: compares tracks with the truth, and reports GOSPA, OSPA, completeness and errors. */
#include <stdlib.h>

#include "base/common.h"
#include "command_line.h"
#include "commands.h"
#include "evaluation/evaluation.h"
#include "evaluation/evaluation_output.h"
#include "evaluation/evaluation_tables.h"
#include "io/csv/csv_table.h"
#include "io/log/log_table.h"
#include "next_command.h"

static void check_output_ending(const char *path)
{
    if (path != NULL && !path_ends_with(path, ".svg") && !path_ends_with(path, ".csv")) {
        fail(EXIT_USAGE,
             "evaluate: -o '%s' is neither NAME.svg (a picture) nor NAME.csv (figures over time)",
             path);
    }
}

/*
 * Exit 2 where the first file has tracks and the second a truth. Tracks may be compared with other
 * tracks, so track_id in the first file alone is no error.
 */
static void refuse_swapped_files(const struct table *truth, const struct table *tracks)
{
    if (table_find_column(truth, "track_id") >= 0 && table_find_column(tracks, "track_id") < 0 &&
        table_find_column(tracks, "target_id") >= 0) {
        fail(EXIT_USAGE, "%s has tracks and %s truth: evaluate TRUTH TRACKS", truth->path,
             tracks->path);
    }
}

static struct evaluation *evaluate_files(const struct command_line *line)
{
    struct table *truth = log_table_or_csv(line->arguments[0], &rows_kind_truth, line->keep_going);
    struct table *tracks =
        log_table_or_csv(line->arguments[1], &rows_kind_tracks, line->keep_going);
    refuse_swapped_files(truth, tracks);
    table_need_rows(truth);
    struct evaluation *e = evaluation_of_tables(truth, tracks, &line->parameters,
                                                line->parameters.value[PARAMETER_GOSPA_CUTOFF_M]);
    table_free(truth);
    table_free(tracks);
    return e;
}

/* Suggests an HTML page of the truth, the tracks, and the plots.csv beside the truth, if any. */
static void suggest_page(const struct command_line *line)
{
    char *files[2] = {line->arguments[0],
                      next_command_find_beside(line->arguments[0], "plots.csv")};

    if (path_ends_with(line->arguments[1], ".csv")) {
        next_command_print_page(line, files, files[1] ? 2 : 1, line->arguments[1]);
    }
    free(files[1]);
}

int command_evaluate(struct command_line *line)
{
    check_output_ending(line->output);
    refuse_output_that_is_an_input(line);
    struct evaluation *e = evaluate_files(line);
    if (line->output != NULL && path_ends_with(line->output, ".svg")) {
        evaluation_draw_gospa(e, line->output);
    } else if (line->output != NULL) {
        evaluation_write_csv_over_time(e, line->output);
    }
    if (line->json) {
        evaluation_print_json(e);
    } else {
        evaluation_print(e, line->by_target);
    }
    evaluation_free(e);
    suggest_page(line);
    return 0;
}
