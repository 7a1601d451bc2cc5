/* SPDX-License-Identifier: MIT */
/*
 * bench_passive: times of a search of bearings and of the push of a frame, over several batches of
 * scene passive-clutter, and over batches as full as the capacities allow with bearings in random
 * directions: with a noise of 0.1 degrees, and with 0.5 rad, where every line is near every point.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/random.h"
#include "base/text_table.h"
#include "bench.h"
#include "lab_limits.h"
#include "pipeline/pipeline.h"
#include "rhotrack/passive.h"
#include "scenario_plots.h"

#define PI 3.141592653589793
#define SIGMA_RAD (0.1 * PI / 180.0)
#define COARSE_RAD 0.5
#define SCANS 8
#define SCAN_US 10000000
#define PUSHES 2000
#define WORST_MS_MOST 10.0

struct job {
    const char *name, *json_name;
    unsigned sensors, targets; /* 0 sensors: a full batch */
    int batches;
    double sigma_rad;
};

static const struct job jobs[] = {{"2 sensors, 2 targets", "2s2t", 2, 2, 20, SIGMA_RAD},
                                  {"2 sensors, 4 targets", "2s4t", 2, 4, 20, SIGMA_RAD},
                                  {"2 sensors, 6 targets", "2s6t", 2, 6, 20, SIGMA_RAD},
                                  {"3 sensors, 4 targets", "3s4t", 3, 4, 20, SIGMA_RAD},
                                  {"4 sensors, 6 targets", "4s6t", 4, 6, 5, SIGMA_RAD},
                                  {"full, by chance", "full", 0, 0, 1, SIGMA_RAD},
                                  {"full, 0.5 rad", "full_coarse", 0, 0, 1, COARSE_RAD}};

#define NUM_JOBS (sizeof jobs / sizeof jobs[0])
#define JOB_WITH_A_BAR 3

/* The frames of a batch, with the scans and bearings that they point to. */
struct recording {
    unsigned num_frames;
    struct rho_frame frames[RHO_MAX_PASSIVE_SCANS];
    struct rho_bearing_scan scans[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
    struct rho_bearing bearings[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS][RHO_MAX_BEARINGS];
};

struct figures {
    double mean_ms, worst_ms, push_us; /* times of a search, and of a frame's push */
    double tracks, hypotheses, fits;   /* mean numbers per batch */
};

/* ---- batches --------------------------------------------------------------------------------- */

static struct rho_bearing_scan *add_scan_to_frame(struct recording *recording, unsigned k,
                                                  size_t sensor, double x_m, double y_m)
{
    struct rho_frame *frame = &recording->frames[k];
    struct rho_bearing_scan *scan = &recording->scans[k][frame->num_scans++];
    *frame = (struct rho_frame){.time_us = (int64_t)k * SCAN_US,
                                .num_scans = frame->num_scans,
                                .scans = recording->scans[k]};
    *scan = (struct rho_bearing_scan){.time_us = frame->time_us,
                                      .sensor_id = (int32_t)sensor + 1,
                                      .x_m = (float)x_m,
                                      .y_m = (float)y_m,
                                      .bearings = recording->bearings[k][sensor]};
    return scan;
}

static void add_bearing_unless_full(struct recording *recording, unsigned k, size_t sensor,
                                    struct rho_bearing_scan *scan, double bearing_rad,
                                    double sigma_rad)
{
    if (scan->num_bearings < RHO_MAX_BEARINGS) {
        recording->bearings[k][sensor][scan->num_bearings++] =
            (struct rho_bearing){.bearing_rad = (float)bearing_rad, .sigma_rad = (float)sigma_rad};
    }
}

static void record_bearing_frames(struct recording *recording, const struct job *job, uint64_t seed,
                                  uint64_t run)
{
    struct parameters parameters;
    parameters_set_defaults(&parameters);
    suggest_passive_parameters(&parameters);
    parameters_suggest(&parameters, PARAMETER_SIGMA_RAD, job->sigma_rad);
    const struct scenario_bearings of = {
        .num_sensors = job->sensors, .num_targets = job->targets, .false_mean = 1.0};
    struct simulation *simulation = simulate_passive(&of, &parameters, seed, run);
    *recording = (struct recording){.num_frames = SCANS};
    for (size_t i = 0; i < simulation->num_looks; i++) {
        const struct simulated_look *look = &simulation->looks[i];
        unsigned k = (unsigned)(i / simulation->passive.num_sensors);
        struct rho_bearing_scan *scan = add_scan_to_frame(
            recording, k, look->sensor, simulation->passive.sensors[look->sensor].x_m,
            simulation->passive.sensors[look->sensor].y_m);
        for (size_t j = 0; j < look->num_bearings; j++) {
            add_bearing_unless_full(recording, k, look->sensor, scan, look->bearings[j].bearing_rad,
                                    job->sigma_rad);
        }
    }
    simulation_free(simulation);
}

static void fill_random_bearings(struct recording *recording, double sigma_rad, uint64_t seed)
{
    struct random random = random_start(seed, 79, 0);
    *recording = (struct recording){.num_frames = RHO_MAX_PASSIVE_SCANS};
    for (unsigned k = 0; k < RHO_MAX_PASSIVE_SCANS; k++) {
        for (size_t sensor = 0; sensor < RHO_MAX_PASSIVE_SENSORS; sensor++) {
            double direction_rad = 2.0 * PI * (double)sensor / RHO_MAX_PASSIVE_SENSORS;
            struct rho_bearing_scan *scan = add_scan_to_frame(
                recording, k, sensor, 1e4 * cos(direction_rad), 1e4 * sin(direction_rad));
            for (int i = 0; i < RHO_MAX_BEARINGS; i++) {
                add_bearing_unless_full(recording, k, sensor, scan,
                                        random_between(&random, -PI / 2.0, PI / 2.0), sigma_rad);
            }
        }
    }
}

/* ---- times ----------------------------------------------------------------------------------- */

static void push_frame(struct rho_passive *passive, const struct rho_frame *frame)
{
    uint8_t fates[RHO_MAX_PASSIVE_SENSORS * RHO_MAX_BEARINGS];
    memset(fates, RHO_FATE_HELD, sizeof fates);
    must_succeed(rho_passive_push(passive, frame, fates), "passive");
}

static void fill_batch_from_recording(struct rho_passive *passive,
                                      const struct recording *recording)
{
    struct rho_passive_config config;
    rho_passive_config_default(&config);
    config.scans = (uint16_t)recording->num_frames;
    must_succeed(rho_passive_init(passive, sizeof *passive, &config), "passive");
    for (unsigned k = 0; k < recording->num_frames; k++) {
        push_frame(passive, &recording->frames[k]);
    }
}

static double fastest_search_ms(struct rho_passive *passive)
{
    double best_us = INFINITY;
    for (int round = 0; round < BENCH_ROUNDS; round++) {
        int64_t start_us = monotonic_clock_us();
        must_succeed(rho_passive_search(passive), "passive");
        best_us = fmin(best_us, (double)(monotonic_clock_us() - start_us));
    }
    return best_us / 1e3;
}

/* The batch is full, so that each pushed frame drops the oldest. */
static double fastest_push_us(struct rho_passive *passive, const struct recording *recording)
{
    double best_us = INFINITY;
    int64_t time_us = passive->batch.time_us[recording->num_frames - 1];
    for (int round = 0; round < BENCH_ROUNDS; round++) {
        int64_t start_us = monotonic_clock_us();
        for (unsigned i = 0; i < PUSHES; i++) {
            struct rho_bearing_scan scans[RHO_MAX_PASSIVE_SENSORS];
            struct rho_frame frame = recording->frames[i % recording->num_frames];
            memcpy(scans, frame.scans, frame.num_scans * sizeof scans[0]);
            frame.scans = scans;
            frame.time_us = time_us += SCAN_US;
            for (uint32_t k = 0; k < frame.num_scans; k++) {
                scans[k].time_us = time_us;
            }
            push_frame(passive, &frame);
        }
        best_us = fmin(best_us, (double)(monotonic_clock_us() - start_us) / PUSHES);
    }
    return best_us;
}

static struct figures measure_batches_of_job(struct rho_passive *passive, const struct job *job,
                                             uint64_t seed)
{
    static struct recording recording;
    struct figures figures = {.push_us = INFINITY};
    for (int run = 0; run < job->batches; run++) {
        if (job->sensors > 0) {
            record_bearing_frames(&recording, job, seed, (uint64_t)run);
        } else {
            fill_random_bearings(&recording, job->sigma_rad, seed);
        }
        fill_batch_from_recording(passive, &recording);
        double ms = fastest_search_ms(passive);
        figures.mean_ms += ms / job->batches;
        figures.worst_ms = fmax(figures.worst_ms, ms);
        figures.tracks += (double)passive->num_tracks / job->batches;
        figures.hypotheses += (double)passive->work.hypotheses / job->batches;
        figures.fits += (double)passive->work.fits / job->batches;
    }
    figures.push_us = fastest_push_us(passive, &recording);
    return figures;
}

/* ---- the table ------------------------------------------------------------------------------- */

static void add_job_json(cJSON *json, const struct job *job, const struct figures *figures)
{
    const struct {
        const char *name;
        double value;
    } numbers[] = {{"ms", figures->mean_ms},
                   {"worst_ms", figures->worst_ms},
                   {"push_us", figures->push_us},
                   {"tracks", figures->tracks},
                   {"hypotheses", figures->hypotheses},
                   {"fits", figures->fits}};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        char name[48];
        snprintf(name, sizeof name, "%s_%s", job->json_name, numbers[i].name);
        cJSON_AddNumberToObject(json, name, numbers[i].value);
    }
}

static void print_table_and_verdicts(const struct text_table *table,
                                     const struct verdicts *verdicts)
{
    printf("passive: batches of %d scans, 0.1 deg, P_D 0.9, a false bearing a look; full: %d "
           "sensors, %d scans, %d bearings\nobject: %zu bytes\n",
           SCANS, RHO_MAX_PASSIVE_SENSORS, RHO_MAX_PASSIVE_SCANS, RHO_MAX_BEARINGS,
           sizeof(struct rho_passive));
    text_table_print(table, stdout);
    printf("\n");
    verdicts_print(verdicts, stdout);
    printf("\n");
}

void bench_passive(const struct bench *bench)
{
    struct rho_passive *passive = must_alloc(sizeof *passive);
    cJSON *json = bench->json ? cJSON_AddObjectToObject(bench->json, "passive") : NULL;
    struct verdicts verdicts = verdicts_start();
    struct text_table table =
        text_table_start(1, "batch|ms a search|worst ms|us a push|tracks|hypotheses|fits");
    for (size_t i = 0; i < NUM_JOBS; i++) {
        struct figures figures = measure_batches_of_job(passive, &jobs[i], bench->seed);
        text_table_add_row(&table, "%s|%.2f|%.2f|%.2f|%.2f|%.0f|%.0f", jobs[i].name,
                           figures.mean_ms, figures.worst_ms, figures.push_us, figures.tracks,
                           figures.hypotheses, figures.fits);
        if (i == JOB_WITH_A_BAR) {
            verdicts_add_at_most(&verdicts, figures.worst_ms, WORST_MS_MOST,
                                 "%s: ms of the slowest of %d searches", jobs[i].name,
                                 jobs[i].batches);
        }
        if (json) {
            add_job_json(json, &jobs[i], &figures);
        }
    }
    if (json) {
        cJSON_AddNumberToObject(json, "state_bytes", (double)sizeof *passive);
        verdicts_move_to_json(&verdicts, json);
    } else {
        print_table_and_verdicts(&table, &verdicts);
    }
    verdicts_free(&verdicts);
    text_table_free(&table);
    free(passive);
}
