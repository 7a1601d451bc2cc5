/* SPDX-License-Identifier: MIT */
#include "live/prometheus_metrics.h"

#include <ctype.h>
#include <inttypes.h>
#include <string.h>

#include "base/common.h"
#include "live/command_words.h"
#include "live/node_loss_counts.h"
#include "pipeline/learned_report.h"
#include "rhotrack/command.h"

static void write_family_head(FILE *out, const char *name, const char *type, const char *help)
{
    fprintf(out, "# HELP rhotrack_%s %s\n# TYPE rhotrack_%s %s\n", name, help, name, type);
}

static void write_single_value(FILE *out, const char *name, const char *type, const char *help,
                               double value)
{
    write_family_head(out, name, type, help);
    fprintf(out, "rhotrack_%s %.15g\n", name, value);
}

static void write_counter(FILE *out, const char *name, const char *help, uint64_t count)
{
    write_family_head(out, name, "counter", help);
    fprintf(out, "rhotrack_%s %" PRIu64 "\n", name, count);
}

/* ---- Refusals, and all else that the last words of a node tell ---- */

/*
 * Writes a tally's name as a label: "scans late, dropped" becomes scans_late_dropped; stops at
 * brackets and colons, as the rest is an explanation.
 */
static void write_name_as_label_value(FILE *out, const char *name)
{
    for (bool is_between = false; *name && *name != '(' && *name != ':'; name++) {
        if (isalnum((unsigned char)*name)) {
            fprintf(out, "%s%c", is_between ? "_" : "", tolower((unsigned char)*name));
        }
        is_between = !isalnum((unsigned char)*name) && *name != '\'';
    }
}

static void write_tallies_of_kind(FILE *out, const char *family,
                                  const struct node_loss_counts *tallies, enum node_tally_kind kind)
{
    for (int i = 0; i < NODE_TALLIES; i++) {
        if (tallies[i].kind == kind) {
            fprintf(out, "rhotrack_%s{cause=\"", family);
            write_name_as_label_value(out, tallies[i].name);
            fprintf(out, "\"} %" PRIu64 "\n", tallies[i].count);
        }
    }
}

static void write_loss_tallies(FILE *out, const struct prometheus_metrics_source *source)
{
    struct node_loss_counts tallies[NODE_TALLIES];

    node_loss_counts_collect(source->core, source->transport, source->gate, tallies);
    write_family_head(out, "refused_total", "counter", "Refused or lost, by cause: faults.");
    write_tallies_of_kind(out, "refused_total", tallies, NODE_TALLY_FAULT);
    write_family_head(out, "missing", "gauge",
                      "Missing or refused by now, by cause; falls where a scan comes after all.");
    write_tallies_of_kind(out, "missing", tallies, NODE_TALLY_MAY_FALL);
    write_family_head(out, "noted_total", "counter", "Of the usual work, by cause.");
    write_tallies_of_kind(out, "noted_total", tallies, NODE_TALLY_USUAL);
}

/* ---- Counters of the library that have no row there ---- */

struct row {
    const char *name, *help;
    uint64_t count;
};

static void write_counter_rows(FILE *out, const struct row *rows, size_t num_rows)
{
    for (size_t i = 0; i < num_rows; i++) {
        write_counter(out, rows[i].name, rows[i].help, rows[i].count);
    }
}

static void write_input_counters(FILE *out, const struct prometheus_metrics_source *source)
{
    const struct rho_scan_assembler_counters *assembler =
        node_core_assembler_counters(source->core);
    const struct rho_node_counters *own = node_core_node_counters(source->core);
    const struct transport_counters network = transport_counters(source->transport);
    const struct row rows[] = {
        {"messages_received_total", "Messages of LCM that were looked at, of all programs.",
         network.received},
        {"messages_in_total", "The same without those that nodes publish.", source->messages_in},
        {"messages_sent_total", "Messages published.", network.sent},
        {"scans_accepted_total", "Scans of which a first part was taken.",
         assembler->scans_accepted},
        {"scans_out_of_sequence_total",
         "Scans behind a newer one of their sensor, used or not, and scans of a clock given up.",
         assembler->scans_late},
        {"bearings_total", "Bearings of accepted scans.", assembler->bearings_in},
        {"steps_total", "Steps of the tracker.", own->steps},
        {"plots_refused_total", "Plots of scans whose sensor the tracker does not take.",
         own->plots_refused},
        {"sensors_forgotten_total", "Descriptions of silent sensors given up for others.",
         own->sensors_forgotten},
        {"reports_not_printed_total", "Reports that standard output had no room for.",
         source->losses.reports_not_printed},
        {"events_not_logged_total", "Events that the log had no room for.",
         source->losses.events_not_logged},
        {"shown_left_out_total", "Messages of --show beyond its rate.",
         node_core_num_show_left_out(source->core)},
        {"metrics_pages_total", "Answers with this text.", source->pages_sent},
        {"metrics_refused_total", "Requests of something else, and clients that were too slow.",
         source->clients_refused},
    };

    write_counter_rows(out, rows, sizeof rows / sizeof *rows);
}

static void write_tracker_counters(FILE *out, const struct prometheus_metrics_source *source)
{
    const struct rho_tracker_counters *tracker = node_core_tracker_counters(source->core);
    const struct row rows[] = {
        {"tracker_scans_total", "Scans and frames that the tracker took.", tracker->scans_accepted},
        {"tracker_scans_stale_total", "Scans too old to be used.", tracker->scans_late},
        {"tracker_scans_retrodicted_total", "Scans out of sequence that updated tracks.",
         tracker->scans_retrodicted},
        {"plots_total", "Plots and bearings stepped.", tracker->plots_in},
        {"plots_initiated_total", "Plots held that started a track.", tracker->plots_initiated},
        {"plots_clutter_total", "Plots held that left the window unused.", tracker->plots_clutter},
        {"plots_excluded_total", "Plots in areas that an operator has excluded.",
         tracker->plots_excluded},
        {"tracks_started_total", "Tracks started.", tracker->tracks_started},
        {"tracks_confirmed_total", "Tracks confirmed.", tracker->tracks_confirmed},
        {"tracks_ended_total", "Tracks ended.", tracker->tracks_ended},
        {"tracks_unseen_total", "Of the ended: not looked at for too long.",
         tracker->tracks_unseen},
        {"tracks_too_fast_total", "Of the ended: faster than v_max_mps.", tracker->tracks_too_fast},
        {"tracks_dropped_total", "Of the ended: by an operator.", tracker->tracks_dropped},
        {"candidates_dropped_total", "Candidates of tracks, and crossings, beyond room or work.",
         tracker->candidates_dropped},
        {"sensors_suspected_total", "Times that a sensor became suspect.",
         tracker->sensors_suspected},
    };

    write_counter_rows(out, rows, sizeof rows / sizeof *rows);
    write_family_head(out, "plots_by_fate_total", "counter", "What became of plots and bearings.");
    for (int fate = 0; fate < RHO_NUM_FATES; fate++) {
        fprintf(out, "rhotrack_plots_by_fate_total{fate=\"");
        write_name_as_label_value(out, rho_fate_name((enum rho_fate)fate));
        fprintf(out, "\"} %" PRIu32 "\n", tracker->fates[fate]);
    }
}

/* ---- Now ---- */

static void write_track_counts(FILE *out, const struct prometheus_metrics_source *source)
{
    const struct rho_tracker *tracker = node_core_tracker_state(source->core);
    static const char *const names[RHO_NUM_TRACK_STATUS] = {NULL, "tentative", "confirmed",
                                                            "coasting"};
    const struct rho_report *report = node_core_last_report(source->core);
    unsigned counts[RHO_NUM_TRACK_STATUS] = {0};

    for (unsigned i = 0; i < report->num_tracks; i++) {
        counts[report->tracks[i].status]++;
    }
    write_family_head(out, "tracks", "gauge", "Tracks of the last step, by status.");
    for (int status = RHO_TRACK_TENTATIVE; status < RHO_NUM_TRACK_STATUS; status++) {
        fprintf(out, "rhotrack_tracks{status=\"%s\"} %u\n", names[status], counts[status]);
    }
    write_single_value(out, "echoes_standing", "gauge", "Echoes that stand and are clutter.",
                       (double)learned_report_num_standing(&tracker->clutter_map));
}

static void write_time_histogram(FILE *out, const char *name, const char *help,
                                 const struct node_core_times *times)
{
    uint64_t within = 0;

    write_family_head(out, name, "histogram", help);
    for (int i = 0; i < NODE_CORE_BOUNDS; i++) {
        within += times->within[i];
        fprintf(out, "rhotrack_%s_bucket{le=\"%g\"} %" PRIu64 "\n", name,
                (double)node_core_bounds_us[i] * 1e-6, within);
    }
    fprintf(out,
            "rhotrack_%s_bucket{le=\"+Inf\"} %" PRIu64 "\nrhotrack_%s_sum %.6f\nrhotrack_%s_count "
            "%" PRIu64 "\n",
            name, times->count, name, (double)times->sum_us * 1e-6, name, times->count);
}

static void write_times_and_work(FILE *out, const struct prometheus_metrics_source *source)
{
    const struct rho_tracker *tracker = node_core_tracker_state(source->core);
    const struct node_core_times *steps = node_core_step_histogram(source->core);
    const struct node_core_times *latencies = node_core_latencies(source->core);

    write_time_histogram(out, "step_seconds", "Time of a step.", steps);
    write_single_value(out, "step_seconds_max", "gauge", "Longest step since the start.",
                       (double)steps->max_us * 1e-6);
    write_time_histogram(out, "latency_seconds",
                         "From the reception of a scan's last message to its tracks.", latencies);
    write_single_value(out, "latency_seconds_max", "gauge", "Longest latency since the start.",
                       (double)latencies->max_us * 1e-6);
    write_single_value(out, "step_work", "gauge", "Units of work of the last step.",
                       tracker->work.work);
    write_single_value(out, "step_work_worst", "gauge", "Units of work of the worst step.",
                       tracker->work.work_worst);
    write_single_value(out, "step_work_max", "gauge", "Units of work that a step may do; 0: any.",
                       tracker->config.work_max);
    write_counter(out, "partial_steps_total", "Steps that left something out.",
                  tracker->work.partial_steps);
    write_counter(out, "plots_not_tried_total", "Plots left out with all that they might go with.",
                  tracker->work.plots_not_tried);
}

/* ---- An operator's commands that are in force ---- */

static void write_settings(FILE *out, const char *name, const char *help,
                           const struct rho_settings *settings)
{
    float values[COMMAND_SETTINGS + 1];

    command_words_setting_values(settings, values);
    write_family_head(out, name, "gauge", help);
    for (int field = 1; field <= COMMAND_SETTINGS; field++) {
        fprintf(out, "rhotrack_%s{name=\"%s\"} %.7g\n", name, rho_command_setting_name(field),
                (double)values[field]);
    }
}

static void write_commands_in_force(FILE *out, const struct prometheus_metrics_source *source)
{
    write_single_value(out, "excluded_areas", "gauge", "Areas that an operator has excluded.",
                       node_core_tracker_state(source->core)->num_excluded);
    write_settings(out, "setting", "Settings in force, which an operator may change.",
                   node_core_settings(source->core));
    write_settings(out, "setting_configured", "The same settings as they are configured.",
                   node_core_told_settings(source->core));
}

/* ---- Sensors ---- */

/* Writes a sensor's labels: sensor="1",name="north". */
static void write_sensor_labels(FILE *out, const struct prometheus_metrics_source *source,
                                int32_t sensor_id)
{
    const char *name = parameters_sensor_name(source->parameters, sensor_id);

    fprintf(out, "sensor=\"%" PRId32 "\",name=\"%s\"", sensor_id, name ? name : "");
}

struct column {
    const char *name, *type, *help;
};

static void write_sensor_states(FILE *out, const struct prometheus_metrics_source *source)
{
    static const struct column columns[] = {
        {"sensor_scans_total", "counter", "Scans of the sensor; stays at 65535."},
        {"sensor_silent", "gauge", "1: nothing was heard for jump_max_s."},
        {"sensor_off_clock", "gauge", "1: its clock is not the common one."},
        {"sensor_suspect", "gauge", "1: it contradicts the others."},
        {"sensor_heard_seconds", "gauge", "Since its last scan came."},
        {"sensor_interval_seconds", "gauge", "From scan to scan; 0: not known."},
        {"sensor_seen_share", "gauge", "Of the others' tracks that it should see."},
        {"sensor_innovation_factor", "gauge",
         "Variance of its innovations over what its sigmas say; 1: as stated."},
    };
    static const char *const kinds[] = {"", "plots", "polar", "bearings"};
    struct rho_message_sensor sensors[RHO_MAX_SENSORS];
    const unsigned count = node_core_list_sensors(source->core, sensors);

    for (size_t i = 0; i < sizeof columns / sizeof *columns; i++) {
        write_family_head(out, columns[i].name, columns[i].type, columns[i].help);
        for (unsigned k = 0; k < count; k++) {
            const struct rho_message_sensor *sensor = &sensors[k];
            const double values[sizeof columns / sizeof *columns] = {
                sensor->scans,
                sensor->is_silent,
                sensor->is_off_clock,
                sensor->is_doubted,
                sensor->heard_age_us * 1e-6,
                sensor->interval_us * 1e-6,
                (double)sensor->seen_share,
                (double)sensor->innovation_factor,
            };

            fprintf(out, "rhotrack_%s{", columns[i].name);
            write_sensor_labels(out, source, sensor->sensor_id);
            fprintf(out, ",kind=\"%s\"} %.9g\n", kinds[sensor->kind & 3], values[i]);
        }
    }
}

struct learned {
    int32_t sensor_id;
    struct rho_tracker_known known;
};

static void write_learned_noise(FILE *out, const struct prometheus_metrics_source *source,
                                const struct learned *learned, unsigned count)
{
    write_family_head(out, "sensor_noise_factor", "gauge",
                      "Learned noise over the stated one, along the line of sight and across.");
    for (unsigned i = 0; i < count; i++) {
        for (int is_cross = 0; is_cross < 2; is_cross++) {
            const float factor =
                is_cross ? learned[i].known.cross_factor : learned[i].known.range_factor;

            fputs("rhotrack_sensor_noise_factor{", out);
            write_sensor_labels(out, source, learned[i].sensor_id);
            fprintf(out, ",axis=\"%s\"} %.9g\n", is_cross ? "cross" : "range", (double)factor);
        }
    }
}

static void write_learned_pd(FILE *out, const struct prometheus_metrics_source *source,
                             const struct learned *learned, unsigned count)
{
    write_family_head(out, "sensor_pd", "gauge",
                      "Learned probability of detection, by ring of range from the inside.");
    for (unsigned i = 0; i < count; i++) {
        for (int ring = 0; ring < RHO_LEARN_RINGS; ring++) {
            fputs("rhotrack_sensor_pd{", out);
            write_sensor_labels(out, source, learned[i].sensor_id);
            fprintf(out, ",ring=\"%d\"} %.9g\n", ring, (double)learned[i].known.pd[ring]);
        }
    }
}

/* Writes each sensor's sample size: of its looks where is_looks, else of its innovations. */
static void write_num_samples(FILE *out, const struct prometheus_metrics_source *source,
                              const char *name, const char *help, const struct learned *learned,
                              unsigned count, bool is_looks)
{
    write_family_head(out, name, "gauge", help);
    for (unsigned i = 0; i < count; i++) {
        fprintf(out, "rhotrack_%s{", name);
        write_sensor_labels(out, source, learned[i].sensor_id);
        fprintf(out, "} %" PRIu32 "\n",
                is_looks ? learned[i].known.looks : learned[i].known.innovations);
    }
}

static void write_learned(FILE *out, const struct prometheus_metrics_source *source)
{
    const struct rho_tracker *tracker = node_core_tracker_state(source->core);
    struct learned learned[RHO_MAX_SENSORS];
    unsigned count = 0;

    for (uint32_t i = 0; i < tracker->num_sensors; i++) {
        learned[count].sensor_id = tracker->sensors[i].sensor.sensor_id;
        count += rho_tracker_known_of(tracker, learned[count].sensor_id, &learned[count].known) ==
                 RHO_OK;
    }
    write_learned_noise(out, source, learned, count);
    write_learned_pd(out, source, learned, count);
    write_num_samples(out, source, "sensor_innovations",
                      "Innovations that the noise is learned of.", learned, count, false);
    write_num_samples(out, source, "sensor_looks",
                      "Looks that the probability of detection is learned of.", learned, count,
                      true);
}

/* ---- Tracks' lives ---- */

static void write_life(FILE *out, const struct prometheus_metrics_source *source)
{
    const struct rho_tracker_life life = rho_tracker_life(node_core_tracker_state(source->core));

    write_single_value(out, "life_death_rate", "gauge",
                       "Learned rate at which targets leave, by scan interval.",
                       (double)life.death);
    write_single_value(out, "life_hide_rate", "gauge",
                       "Learned rate at which visible targets are hidden, by scan interval.",
                       (double)life.hide);
    write_single_value(out, "life_appear_rate", "gauge",
                       "Rate at which hidden targets are visible again, by scan interval.",
                       (double)life.appear);
    write_single_value(out, "life_lived_scans", "gauge",
                       "Scan intervals that the rates of death and hiding are learned of.",
                       (double)life.lived_scans);
}

/* ---- Zones ---- */

static void write_zones(FILE *out, const struct rho_zones *zones)
{
    static const struct column columns[] = {
        {"zone_entered_total", "counter", "Tracks that entered the zone."},
        {"zone_left_total", "counter", "Tracks that left it."},
        {"zone_ended_total", "counter", "Tracks that ended in it."},
        {"zone_along_total", "counter", "Of those that left: along its heading."},
        {"zone_against_total", "counter", "Of those that left: against it."},
        {"zone_tracks", "gauge", "Tracks inside."},
        {"zone_queued", "gauge", "Tracks of its queue."},
    };

    for (size_t i = 0; i < sizeof columns / sizeof *columns; i++) {
        write_family_head(out, columns[i].name, columns[i].type, columns[i].help);
        for (unsigned k = 0; k < zones->num_zones; k++) {
            const struct rho_zone_counts *counts = &zones->counts[k];
            const uint32_t values[sizeof columns / sizeof *columns] = {
                counts->entered, counts->left,   counts->ended, counts->along,
                counts->against, counts->inside, counts->queued};

            fprintf(out, "rhotrack_%s{zone=\"%" PRId32 "\"} %" PRIu32 "\n", columns[i].name,
                    zones->zones[k].zone_id, values[i]);
        }
    }
    write_counter(out, "zone_events_dropped_total", "Events of zones beyond a step's room.",
                  zones->events_dropped);
}

void prometheus_metrics_write(FILE *out, const struct prometheus_metrics_source *source)
{
    write_input_counters(out, source);
    write_loss_tallies(out, source);
    write_single_value(out, "publishing", "gauge", "0: another node publishes (--standby); else 1.",
                       source->is_publishing);
    write_tracker_counters(out, source);
    write_track_counts(out, source);
    write_times_and_work(out, source);
    write_commands_in_force(out, source);
    write_sensor_states(out, source);
    write_learned(out, source);
    write_life(out, source);
    if (node_core_zones(source->core)) {
        write_zones(out, node_core_zones(source->core));
    }
}
