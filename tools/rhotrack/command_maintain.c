/* SPDX-License-Identifier: MIT */
/* maintain: follows one track alone, started by the first plot and never dropped. */
#include <cjson/cJSON.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "commands.h"
#include "io/output/tracks_output.h"
#include "io/scans/bearing_reader.h"
#include "io/scans/plot_reader.h"
#include "maintenance/maintainer.h"

struct maintaining {
    struct maintainer *maintainer;
    enum maintainer_gate gate;
    struct random random; /* draws the plots of the gate none */
    uint64_t fates[RHO_NUM_FATES];
    uint64_t scans; /* scans that were stepped */
    int64_t sum_us, max_us;
};

/* ---- What was asked for ---- */

/* Sets the parameter gate from --gate where it was given, and returns the gate in force. */
static enum maintainer_gate apply_gate_option(struct command_line *line)
{
    if (line->gate) {
        parameters_set_gate(&line->parameters, line->gate);
    }
    return (enum maintainer_gate)line->parameters.value[PARAMETER_GATE];
}

static void warn_unused_option(const struct command_line *line, enum maintainer_gate gate)
{
    if (gate == MAINTAIN_BEST && line->no_input_estimation) {
        fputs("rhotrack: --no-input-estimation has no effect with --gate best\n", stderr);
    }
}

/*
 * With input_model literal an input changes the velocity alone, so that it cannot be observed in
 * position measurements.
 */
static void warn_of_unobservable_inputs(const struct command_line *line, enum maintainer_gate gate,
                                        const struct rho_scan *first)
{
    if (gate != MAINTAIN_BEST && !line->no_input_estimation &&
        !(first->measures & (RHO_MEASURES_VELOCITY | RHO_MEASURES_RANGE_RATE)) &&
        line->parameters.value[PARAMETER_INPUT_MODEL] <= 0.0) {
        fputs("rhotrack: positions alone do not show the inputs of input_model literal; use --set "
              "input_model=physical\n",
              stderr);
    }
}

/* ---- Steps ---- */

static void step_and_time_scan(struct maintaining *maintaining, const struct rho_scan *scan,
                               const struct rho_sensor *sensor)
{
    int64_t start_us = monotonic_clock_us(), took_us;

    (void)maintainer_step(maintaining->maintainer, scan, sensor, NAN, &maintaining->random);
    took_us = monotonic_clock_us() - start_us;
    maintaining->scans++;
    maintaining->sum_us += took_us;
    maintaining->max_us = took_us > maintaining->max_us ? took_us : maintaining->max_us;
    for (int i = 0; i < RHO_NUM_FATES; i++) {
        maintaining->fates[i] += maintainer_fates(maintaining->maintainer)[i];
    }
}

static void maintain_all_scans(struct maintaining *maintaining, struct plot_reader *reader,
                               const struct command_line *line, struct tracks_output *tracks)
{
    struct progress progress = progress_start("scans", 0);
    uint64_t bytes = regular_file_size_or_zero(line->arguments[0]);
    const struct rho_scan *scan;

    while ((scan = plot_reader_next(reader))) {
        bool was_started = maintainer_is_started(maintaining->maintainer);

        step_and_time_scan(maintaining, scan, plot_reader_sensor(reader));
        bool is_started = maintainer_is_started(maintaining->maintainer);
        if (is_started && !was_started) {
            warn_of_unobservable_inputs(line, maintaining->gate, scan);
        }
        if (is_started && tracks) {
            tracks_output_write_track(tracks, scan->time_us,
                                      maintainer_report(maintaining->maintainer));
        }
        progress_show_by_bytes(&progress, maintaining->scans, plot_reader_position(reader), bytes);
    }
    progress_end(&progress);
}

/* ---- What it comes to ---- */

static double mean_step_us(const struct maintaining *maintaining)
{
    return (double)maintaining->sum_us / (double)maintaining->scans;
}

static void print_summary(const struct maintaining *maintaining,
                          const struct plot_reader_counts *counts)
{
    const struct rho_track_report *track = maintainer_report(maintaining->maintainer);

    fprintf(stderr,
            "rhotrack: %" PRIu64 " scans, %" PRIu64 " plots: %u claimed, %u misses, %lu updates "
            "refused",
            maintaining->scans, counts->plots, (unsigned)track->hits, (unsigned)track->misses,
            maintainer_refusals(maintaining->maintainer));
    if (counts->rows_skipped) {
        fprintf(stderr, ", %" PRIu64 " bad rows skipped", counts->rows_skipped);
    }
    fprintf(stderr, "; %.0f us a scan, %" PRId64 " at most\n", mean_step_us(maintaining),
            maintaining->max_us);
}

static cJSON *num_plots_by_fate_json(const struct maintaining *maintaining)
{
    cJSON *object = cJSON_CreateObject();

    for (int i = 0; i < RHO_NUM_FATES; i++) {
        cJSON_AddNumberToObject(object, rho_fate_name((enum rho_fate)i),
                                (double)maintaining->fates[i]);
    }
    return object;
}

static void print_run_json(const struct maintaining *maintaining, const struct command_line *line,
                           const struct plot_reader_counts *counts)
{
    struct parameter_text gate = parameters_text(PARAMETER_GATE);
    char word[PARAMETER_VALUE_BYTES];
    cJSON *object = cJSON_CreateObject();

    cJSON_AddStringToObject(object, "gate", parameters_value_text(&gate, maintaining->gate, word));
    cJSON_AddBoolToObject(object, "input_estimation",
                          maintaining->gate != MAINTAIN_BEST && !line->no_input_estimation);
    cJSON_AddNumberToObject(object, "scans", (double)maintaining->scans);
    cJSON_AddNumberToObject(object, "plots", (double)counts->plots);
    cJSON_AddNumberToObject(object, "rows_skipped", (double)counts->rows_skipped);
    cJSON_AddNumberToObject(object, "tracks_confirmed", 1);
    cJSON_AddNumberToObject(object, "misses", maintainer_report(maintaining->maintainer)->misses);
    cJSON_AddItemToObject(object, "fates", num_plots_by_fate_json(maintaining));
    cJSON_AddNumberToObject(object, "mean_us", mean_step_us(maintaining));
    cJSON_AddNumberToObject(object, "max_us", (double)maintaining->max_us);
    cJSON_AddNumberToObject(object, "state_bytes",
                            (double)maintainer_state_bytes(maintaining->maintainer));
    cJSON_AddNumberToObject(object, "updates_refused",
                            (double)maintainer_refusals(maintaining->maintainer));
    json_print_and_delete(object);
}

static struct plot_reader *open_plot_reader(const struct command_line *line)
{
    if (bearing_reader_is_bearings(line->arguments[0])) {
        fail(EXIT_USAGE, "%s: maintain takes plots, but this file has bearings",
             line->arguments[0]);
    }
    return plot_reader_open(line->arguments, 1, &line->parameters, line->keep_going);
}

int command_maintain(struct command_line *line)
{
    bool has_file = line->output || !line->json;
    struct maintaining maintaining = {.gate = apply_gate_option(line),
                                      .random = random_start(line->seed, 0, 0)};
    struct plot_reader *reader;
    struct plot_reader_counts counts;
    struct tracks_output *tracks;

    warn_unused_option(line, maintaining.gate);
    maintaining.maintainer =
        maintainer_new(maintaining.gate, !line->no_input_estimation, &line->parameters);
    reader = open_plot_reader(line);
    tracks =
        has_file ? tracks_output_open(line->output, &line->parameters, line->covariance) : NULL;
    maintain_all_scans(&maintaining, reader, line, tracks);
    counts = plot_reader_counts(reader);
    if (counts.plots == 0) {
        fail(EXIT_USAGE, "%s: no plot to start the track from", line->arguments[0]);
    }
    tracks_output_close(tracks);
    print_summary(&maintaining, &counts);
    if (line->json) {
        print_run_json(&maintaining, line, &counts);
    }
    plot_reader_close(reader);
    maintainer_free(maintaining.maintainer);
    return 0;
}
