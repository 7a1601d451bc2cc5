/* SPDX-License-Identifier: MIT */
/*
 * Tracker, initiators and passive initiators driven by a script: its bytes are decoded into
 * configurations, descriptions of sensors and a sequence of good and bad calls: scans and frames of
 * a few moving targets, points or bodies of several plots, among clutter, with any number in any
 * field, time that stands still, jumps and goes back, sectors, full capacities, many plots at one
 * place, walls told and learned, an operator's commands, images saved and loaded. It uses the
 * public headers alone. After each call the guarantees of these headers are checked; the first one
 * broken is named. Built twice: with the embedded profile and bodies (fuzz_tracker), and with
 * capacities that a short script exhausts (fuzz_tracker_small).
 */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rhotrack/body.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/measurement.h"
#include "rhotrack/operator.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/snapshot.h"
#include "rhotrack/tracker.h"

#define PI 3.14159265358979323846

#define STEPS_MAX (RHO_MAX_PLOTS > 100 ? 60u : 160u)
#define FULL_SCANS_MAX 6u /* scans with very many plots per script: they are slow */
#define IMAGES_MAX 3u     /* images saved per script */
#define PLOTS_MAX (4u * RHO_MAX_PLOTS + 64u)
#define RADARS 6u
#define LOOKS_MAX 6u /* passive sensors */
#define BEARINGS_MAX (2u * RHO_MAX_BEARINGS + 8u)
#define LONE 2u /* the tracker uses initiators 0 and 1; the third one is called directly */
#define INITIATORS 3u
#define PASSIVES 2u
#define PARTS (1u + INITIATORS + PASSIVES)
#define IMAGE_MAX                                                                                  \
    (1024u + sizeof(struct rho_tracker) + INITIATORS * sizeof(struct rho_initiator) +              \
     PASSIVES * sizeof(struct rho_passive) + 8u * PARTS)

/* Smallest eigenvalue of a correlation matrix that float rounding may leave in the filters. */
#define CORRELATION_ROUNDING 1e-3

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* ---- a condition that is checked ------------------------------------------------------------- */

static unsigned step_number;

#define HOLDS(invariant, condition)                                                                \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fprintf(stderr, "invariant broken at step %u: %s\n  line %d: %s\n", step_number,       \
                    invariant, __LINE__, #condition);                                              \
            abort();                                                                               \
        }                                                                                          \
    } while (0)

/* ---- the script ------------------------------------------------------------------------------ */

struct script {
    const uint8_t *data;
    size_t size;
};

/* The next byte; 0 behind the end. */
static unsigned read_byte(struct script *script)
{
    if (script->size == 0) {
        return 0;
    }
    script->size--;
    return *script->data++;
}

static uint32_t read_word(struct script *script)
{
    uint32_t value = 0;

    for (unsigned i = 0; i < 4; i++) {
        value = value << 8 | read_byte(script);
    }
    return value;
}

static int64_t read_long_word(struct script *script)
{
    const uint64_t high = read_word(script), bits = high << 32 | read_word(script);
    int64_t value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

/* An extreme float: values near which arithmetic and limits change first. */
static float read_extreme_float(struct script *script)
{
    static const float numbers[] = {NAN,
                                    INFINITY,
                                    -INFINITY,
                                    1e30f,
                                    -1e30f,
                                    1e-40f,
                                    -1e-40f,
                                    FLT_MAX,
                                    -FLT_MAX,
                                    FLT_MIN,
                                    0.0f,
                                    -0.0f,
                                    RHO_LIMIT_POSITION_M,
                                    -RHO_LIMIT_POSITION_M,
                                    2000000.25f, /* just beyond the limit of positions */
                                    RHO_LIMIT_SPEED_MPS,
                                    -RHO_LIMIT_SPEED_MPS,
                                    RHO_LIMIT_SIGMA_MIN,
                                    RHO_LIMIT_SIGMA_MAX,
                                    RHO_LIMIT_SIGMA_RAD_MIN,
                                    RHO_LIMIT_SIGMA_RAD_MAX,
                                    3.14159265f,
                                    -3.14159265f,
                                    6.2831853f,
                                    1.0f,
                                    -1.0f,
                                    0.01f,
                                    0.999f,
                                    1e3f,
                                    1e4f,
                                    1e5f,
                                    1e6f};
    const unsigned which = read_byte(script);
    uint32_t bits;
    float number;

    if (which < sizeof numbers / sizeof numbers[0]) {
        return numbers[which];
    }
    if (which < 160) {
        return 0.25f * ((float)which - 96.0f);
    }
    if (which < 240) {
        return 1000.0f * ((float)which - 200.0f);
    }
    bits = read_word(script);
    memcpy(&number, &bits, sizeof number);
    return number;
}

/* ---- the simulated world --------------------------------------------------------------------- */

struct look_from {
    int32_t sensor_id;
    float x_m, y_m;
    uint32_t measures;
    unsigned sectors; /* sectors in a turn; 1: whole circle */
    unsigned next;    /* next sector */
};

static struct world {
    uint64_t random;
    int64_t time_us;
    /* time of the targets' motion, which does not follow time jumps that the tracker refuses */
    double clock_s;
    unsigned num_targets, full_scans, images;
    int has_bodies, learns_walls;
    struct look_from radars[RADARS], posts[LOOKS_MAX];
} world;

static double uniform(double from, double to)
{
    world.random = world.random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return from + (to - from) * (double)(world.random >> 11) / 9007199254740992.0;
}

static double target_m(unsigned target, int axis)
{
    const double t_s = fmod(world.clock_s, 300.0);

    return axis ? 6e3 + 1500.0 * target + 90.0 * t_s
                : -8e3 + 1200.0 * target + (target - 1.5) * 70.0 * t_s;
}

static void begin_world(struct script *script)
{
    static const int32_t ids[RADARS] = {1, 2, 3, -7, INT32_MAX, INT32_MIN};
    static const uint32_t measures[4] = {0, RHO_MEASURES_RANGE_RATE, RHO_MEASURES_Z,
                                         RHO_MEASURES_Z | RHO_MEASURES_RANGE_RATE |
                                             RHO_MEASURES_VELOCITY};
    const unsigned how = read_byte(script), turns = read_byte(script);

    memset(&world, 0, sizeof world);
    world.random = 1 + read_byte(script);
    world.num_targets = 1 + how % 6;
    world.has_bodies = how >> 7;
    world.learns_walls = turns >> 7;
    for (unsigned i = 0; i < RADARS; i++) {
        world.radars[i] = (struct look_from){.sensor_id = ids[i],
                                             .x_m = 4e3f * (float)i * (how & 64 ? 1.0f : 0.0f),
                                             .measures = measures[(how >> 3) & (i > 2 ? 0u : 3u)],
                                             .sectors = turns >> i & 1 ? 6u : 1u};
    }
    for (unsigned i = 0; i < LOOKS_MAX; i++) {
        world.posts[i] = (struct look_from){.sensor_id = 20 + (int32_t)i,
                                            .x_m = 9e3f * ((float)i - 1.0f),
                                            .y_m = i % 2 ? -3e3f : 500.0f * (float)i,
                                            .sectors = turns >> 6 & 1 ? 3u : 1u};
    }
}

/* The time of the next scan from one byte of the script: usually one interval later. */
static int64_t read_next_time_us(struct script *script)
{
    static const int64_t odd_us[] = {0,
                                     0,
                                     -1,
                                     1,
                                     -1000000,
                                     -5000000,
                                     -19000000,
                                     -21000000,
                                     60000000,
                                     100000,
                                     -100000,
                                     3600000000,
                                     100000000000,
                                     INT64_C(1000000000000000),
                                     INT64_C(-1000000000000000)};
    const unsigned how = read_byte(script);
    int64_t step_us = 250000 * (int64_t)(1 + how % 16), time_us;

    if (how >= 208) {
        const unsigned which = how - 208;

        if (which >= sizeof odd_us / sizeof odd_us[0]) {
            return which < 20   ? RHO_LIMIT_TIME_US
                   : which < 24 ? -RHO_LIMIT_TIME_US
                                : read_long_word(script);
        }
        step_us = odd_us[which];
    }
    if ((step_us > 0 && world.time_us > RHO_LIMIT_TIME_US - step_us) ||
        (step_us < 0 && world.time_us < -RHO_LIMIT_TIME_US - step_us)) {
        return world.time_us;
    }
    time_us = world.time_us + step_us;
    if (step_us >= -60000000 && step_us <= 60000000) {
        world.clock_s += 1e-6 * (double)step_us;
    }
    return time_us;
}

/* ---- the objects and what is known of them --------------------------------------------------- */

static struct pipeline {
    struct rho_tracker tracker;
    struct rho_initiator initiators[INITIATORS];
    struct rho_passive passives[PASSIVES];
    struct rho_report report;
    struct rho_reflector_learning learning; /* behind the report: it is in no image */
} chain, before, first_run;

/* all but the padding at the end */
#define OBJECTS_BYTES (offsetof(struct pipeline, learning) + sizeof(struct rho_reflector_learning))

/*
 * Bits for the objects that a call may change; `before` holds all objects as they were before the
 * call.
 */
#define TRACKER 1u /* and the report, and the learning of walls */
#define INITIATOR(i) (2u << (i))
#define PASSIVE(i) (2u << INITIATORS << (i))
#define ALL (PASSIVE(PASSIVES) - 1u)
static unsigned touched;

static void copy_objects_before(void)
{
    if (touched & TRACKER) {
        before.tracker = chain.tracker;
        before.report = chain.report;
        before.learning = chain.learning;
    }
    for (unsigned i = 0; i < INITIATORS; i++) {
        if (touched & INITIATOR(i)) {
            before.initiators[i] = chain.initiators[i];
        }
    }
    for (unsigned i = 0; i < PASSIVES; i++) {
        if (touched & PASSIVE(i)) {
            before.passives[i] = chain.passives[i];
        }
    }
    touched = 0;
}

/* Live tracks, as the reports list them. */
static struct known {
    unsigned num;
    uint32_t track_id[RHO_MAX_TRACKS];
    uint8_t was_confirmed[RHO_MAX_TRACKS];
    uint32_t highest;   /* highest identity ever reported */
    int was_renumbered; /* by the operator: identities need not be in their order */
    int was_batch;      /* the largest search of initiator 2 may have been a batch */
} known, known_first;

static _Alignas(RHO_SNAPSHOT_ALIGNMENT) uint8_t image[IMAGE_MAX];
static size_t image_bytes;
static struct known known_of_image;
static struct world world_of_image;

static int are_all_finite(const float *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(numbers[i])) {
            return 0;
        }
    }
    return 1;
}

/*
 * Whether a covariance is positive semidefinite: its correlations plus a small multiple of the
 * identity have a Cholesky factor. Closed axes are all 0.
 */
static int is_covariance(const float *lower, int n)
{
    double factor[RHO_KALMAN_STATES][RHO_KALMAN_STATES] = {{0}};

    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= i; j++) {
            const double ii = (double)lower[RHO_AT(i, i)], jj = (double)lower[RHO_AT(j, j)];
            const double ij = (double)lower[RHO_AT(i, j)];
            double sum;

            if (!(ii >= 0.0) || ((ii <= 0.0 || jj <= 0.0) && (ij < 0.0 || ij > 0.0))) {
                return 0;
            }
            sum = ii > 0.0 && jj > 0.0 ? ij / sqrt(ii) / sqrt(jj) : 0.0;
            sum = i == j ? 1.0 + CORRELATION_ROUNDING : sum;
            for (int k = 0; k < j; k++) {
                sum -= factor[i][k] * factor[j][k];
            }
            if (i == j && !(sum > 0.0)) {
                return 0;
            }
            factor[i][j] = i == j ? sqrt(sum) : sum / factor[j][j];
        }
    }
    return 1;
}

/* ---- checks of the tracker ------------------------------------------------------------------- */

static void check_counters(void)
{
    const struct rho_tracker_counters *now = &chain.tracker.counters;
    uint32_t was[sizeof *now / 4], is[sizeof *now / 4];
    uint64_t fates = 0;

    memcpy(was, &before.tracker.counters, sizeof was);
    memcpy(is, now, sizeof is);
    for (size_t i = 0; i < sizeof is / sizeof is[0]; i++) {
        HOLDS("counters never go down", is[i] >= was[i]);
    }
    for (int fate = 0; fate < RHO_NUM_FATES; fate++) {
        fates += now->fates[fate];
    }
    HOLDS("the fates' counters add up to plots_in", fates == now->plots_in);
    HOLDS("plots_outside are of the invalid", now->plots_outside <= now->fates[RHO_FATE_INVALID]);
    HOLDS("plots_initiated are of the held",
          now->plots_initiated <= now->fates[RHO_FATE_HELD] + now->fates[RHO_FATE_GHOST]);
    HOLDS("tracks started and not ended live",
          now->tracks_started - now->tracks_ended == chain.tracker.num_tracks);
    HOLDS("tracks_unseen and tracks_too_fast are of the ended",
          now->tracks_unseen <= now->tracks_ended && now->tracks_too_fast <= now->tracks_ended);
}

static void check_fates(uint32_t num_plots)
{
    const struct rho_report *report = &chain.report;
    uint32_t seen[RHO_NUM_FATES] = {0},
             with_fate = num_plots < RHO_MAX_PLOTS ? num_plots : RHO_MAX_PLOTS;
    uint64_t total = 0;

    HOLDS("the report has the scan's plots", report->num_plots == num_plots);
    for (uint32_t i = 0; i < with_fate; i++) {
        HOLDS("each fate is one", report->fates[i] < RHO_NUM_FATES);
        seen[report->fates[i]]++;
    }
    for (int fate = 0; fate < RHO_NUM_FATES; fate++) {
        total += report->fates_total[fate];
        HOLDS("totals of fates have those of the list", seen[fate] <= report->fates_total[fate]);
        HOLDS("counters of fates move by the totals",
              chain.tracker.counters.fates[fate] - before.tracker.counters.fates[fate] ==
                  report->fates_total[fate]);
    }
    HOLDS("fates add up to the plots offered", total == num_plots);
}

static void check_track(const struct rho_track_report *track, uint32_t num_plots)
{
    HOLDS("a reported track is alive",
          track->status > RHO_TRACK_FREE && track->status < RHO_NUM_TRACK_STATUS);
    HOLDS("a reported state is finite", are_all_finite(track->state, RHO_KALMAN_STATES));
    HOLDS("a reported covariance is finite",
          are_all_finite(track->covariance, RHO_TRIANGLE(RHO_KALMAN_STATES)));
    HOLDS("a reported covariance is positive semidefinite",
          is_covariance(track->covariance, RHO_KALMAN_STATES));
    HOLDS("reported sigmas are finite and not negative",
          isfinite(track->sigma_m) && isfinite(track->sigma_mps) && track->sigma_m >= 0.0f &&
              track->sigma_mps >= 0.0f);
    HOLDS("a reported score is finite", isfinite(track->score_nat));
    HOLDS("a reported acceleration is finite", are_all_finite(track->accel_mps2, 3));
    HOLDS("a reported probability is one", rho_is_within(track->maneuver_probability, 0.0f, 1.0f));
    HOLDS("a reported track has a hypothesis", track->num_hypotheses >= 1);
    HOLDS("a reported age is not negative", track->update_age_us >= 0);
    HOLDS("a reported plot is one of the scan's or none",
          track->plot >= -1 && (track->plot < 0 || (uint32_t)track->plot < num_plots));
}

/* What can be asked about a track: its body and its evidence. */
static void check_body_and_evidence(unsigned track)
{
    struct rho_tracker_evidence evidence;
    struct rho_body body;

    if (rho_tracker_body_of(&chain.tracker, track, &body)) {
        const float sizes[] = {
            body.length_m,          body.width_m,       body.sigma_length_m, body.sigma_width_m,
            body.sigma_heading_rad, body.sigma_along_m, body.sigma_across_m, body.plots};

        HOLDS("a body is of this build", RHO_BODIES);
        HOLDS("a heading is finite", isfinite(body.heading_rad));
        for (unsigned i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
            HOLDS("a body's sizes and sigmas are finite and not negative",
                  isfinite(sizes[i]) && sizes[i] >= 0.0f);
        }
    }
    if (rho_tracker_evidence_of(&chain.tracker, track, &evidence)) {
        HOLDS("evidence is three probabilities", rho_is_within(evidence.support, 0.0f, 1.001f) &&
                                                     rho_is_within(evidence.shared, 0.0f, 1.001f) &&
                                                     rho_is_within(evidence.clutter, 0.0f, 1.001f));
        HOLDS("evidence adds up to 1",
              fabsf(evidence.support + evidence.shared + evidence.clutter - 1.0f) < 1e-3f);
    }
}

static unsigned find_known_track(const struct known *all, uint32_t track_id)
{
    unsigned place = 0;

    while (place < all->num && all->track_id[place] != track_id) {
        place++;
    }
    return place;
}

/* Adds a reported track to those known now; confirmed where it is, or was before. */
static void add_known_track(struct known *now, const struct rho_track_report *track)
{
    const unsigned place = find_known_track(&known, track->track_id);

    HOLDS("identities are unique",
          track->track_id > 0 && find_known_track(now, track->track_id) == now->num);
    now->track_id[now->num] = track->track_id;
    now->was_confirmed[now->num++] =
        (place < known.num && known.was_confirmed[place]) || track->status != RHO_TRACK_TENTATIVE;
}

static void check_identities(void)
{
    const struct rho_report *report = &chain.report;
    struct known now = {.was_renumbered = known.was_renumbered, .was_batch = known.was_batch};

    HOLDS("tracks and ended tracks are within their capacities",
          report->num_tracks <= RHO_MAX_TRACKS && report->num_ended <= RHO_MAX_TRACKS);
    for (unsigned i = 0; i < report->num_tracks; i++) {
        const uint32_t track_id = report->tracks[i].track_id;

        add_known_track(&now, &report->tracks[i]);
        HOLDS("identities are in their order",
              known.was_renumbered || i == 0 || track_id > report->tracks[i - 1].track_id);
        HOLDS("identities are never used again",
              find_known_track(&known, track_id) < known.num || track_id > known.highest);
        HOLDS("identities are below the next one", track_id < chain.tracker.next_track_id);
    }
    now.highest = chain.tracker.next_track_id - 1;
    for (unsigned i = 0; i < report->num_ended; i++) {
        HOLDS("an ended track is not alive", find_known_track(&now, report->ended[i]) == now.num);
        HOLDS("an ended track was there", find_known_track(&known, report->ended[i]) < known.num);
        for (unsigned j = 0; j < i; j++) {
            HOLDS("a track ends once", report->ended[j] != report->ended[i]);
        }
    }
    for (unsigned i = 0; i < known.num; i++) {
        int is_told =
            find_known_track(&now, known.track_id[i]) < now.num || !known.was_confirmed[i];

        for (unsigned j = 0; j < report->num_ended && !is_told; j++) {
            is_told = report->ended[j] == known.track_id[i];
        }
        HOLDS("a confirmed track that is gone is among the ended", is_told);
    }
    known = now;
}

/*
 * A plot that a track names is valid and has the fate CLAIMED; one that a new track names, which is
 * a plot that it was found in, the fate HELD.
 */
static void check_claimed_plots_fate_and_validity(const struct rho_scan *scan)
{
    for (unsigned i = 0; i < chain.report.num_tracks; i++) {
        const int32_t plot = chain.report.tracks[i].plot;
        const int is_new = find_known_track(&known, chain.report.tracks[i].track_id) == known.num;

        HOLDS("a plot that a track claimed is claimed, one that it was found in is held",
              plot < 0 || plot >= RHO_MAX_PLOTS ||
                  chain.report.fates[plot] == (is_new ? RHO_FATE_HELD : RHO_FATE_CLAIMED));
        HOLDS("a plot that a track claimed is valid",
              plot < 0 || rho_measurement_is_valid_plot(&scan->plots[plot], scan->measures));
    }
}

/* ---- checks of the initiators ---------------------------------------------------------------- */

static unsigned count_bits(uint32_t mask)
{
    unsigned count = 0;

    for (; mask; mask &= mask - 1) {
        count++;
    }
    return count;
}

static void check_candidates(struct rho_initiator *initiator)
{
    for (unsigned i = 0; i < initiator->num_candidates; i++) {
        const struct rho_candidate *candidate = &initiator->candidates[i];
        const float numbers[] = {candidate->x_m,    candidate->y_m, candidate->vx_mps,
                                 candidate->vy_mps, candidate->z_m, candidate->vz_mps};

        HOLDS("a candidate is finite", are_all_finite(numbers, 6));
        HOLDS("a candidate's hits are its scans", count_bits(candidate->mask) == candidate->hits);
        HOLDS("candidates are the best first",
              i == 0 || initiator->candidates[i - 1].score_mnat >= candidate->score_mnat);
    }
}

/* Bounds the work of a search; a batch has work_max for each scan in which kernels end. */
static void check_search_work(const struct rho_initiator *initiator, int is_batch)
{
    const struct rho_initiator_budget *budget = &initiator->budget;
    uint64_t most = initiator->config.work_max;

    HOLDS("work_worst is the worst", budget->work_worst >= budget->work);
    if (most == 0) {
        return;
    }
    most *= is_batch ? initiator->config.scans : 1u;
    most += RHO_INITIATOR_WORK_BEYOND;
    HOLDS("a search works no more than work_max and RHO_INITIATOR_WORK_BEYOND",
          budget->work <= most);
    HOLDS("the worst search worked no more", budget->work_worst <= most);
}

static void check_step_work(const struct rho_tracker *tracker)
{
    const uint64_t most = (uint64_t)tracker->config.work_max + RHO_TRACKER_WORK_BEYOND;

    HOLDS("the tracker's work_worst is the worst", tracker->work.work_worst >= tracker->work.work);
    HOLDS("a step works no more than work_max and RHO_TRACKER_WORK_BEYOND",
          tracker->config.work_max == 0 || tracker->work.work_worst <= most);
    HOLDS("what is left out makes steps partial",
          tracker->work.plots_not_tried == 0 || tracker->work.partial_steps > 0);
}

static void check_passive_tracks(struct rho_passive *passive)
{
    HOLDS("tracks of bearings are within their capacity",
          passive->num_tracks <= RHO_MAX_PASSIVE_TRACKS);
    for (unsigned i = 0; i < passive->num_tracks; i++) {
        const struct rho_passive_track *track = &passive->tracks[i];
        const float numbers[] = {track->x_m, track->y_m, track->vx_mps, track->vy_mps, track->chi2};
        unsigned hits = 0;

        for (unsigned k = 0; k < RHO_MAX_PASSIVE_SCANS; k++) {
            for (unsigned s = 0; s < RHO_MAX_PASSIVE_SENSORS; s++) {
                hits += track->claim[k][s] > 0;
            }
        }
        HOLDS("a track of bearings is finite", are_all_finite(numbers, 5));
        HOLDS("its covariance is finite", are_all_finite(track->covariance, 10));
        HOLDS("its covariance is positive semidefinite", is_covariance(track->covariance, 4));
        HOLDS("its hits are its claims", hits == track->hits);
    }
}

/* Checks the objects that the call may have changed. */
static void check_objects(void)
{
    HOLDS("the tracker is sound", !(touched & TRACKER) || rho_tracker_is_sound(&chain.tracker));
    HOLDS("what was learned of walls is sound",
          !(touched & TRACKER) || rho_reflector_learning_is_sound(&chain.learning));
    check_step_work(&chain.tracker);
    for (unsigned i = 0; i < INITIATORS; i++) {
        if (!(touched & INITIATOR(i))) {
            continue;
        }
        HOLDS("the initiator is sound", rho_initiator_is_sound(&chain.initiators[i]));
        check_candidates(&chain.initiators[i]);
        check_search_work(&chain.initiators[i], i == LONE && known.was_batch);
    }
    for (unsigned i = 0; i < PASSIVES; i++) {
        if (touched & PASSIVE(i)) {
            HOLDS("the passive initiator is sound", rho_passive_is_sound(&chain.passives[i]));
            check_passive_tracks(&chain.passives[i]);
        }
    }
}

static void check_unchanged(enum rho_status status)
{
    HOLDS("an outcome is one", status > RHO_OK && status < RHO_NUM_STATUS);
    HOLDS("a refused call leaves all objects and the report as they were",
          memcmp(&before, &chain, OBJECTS_BYTES) == 0);
}

/* A scan older than late_max_s changes only counters. */
static void check_only_counters_changed(void)
{
    HOLDS("a scan that is too late counts",
          chain.tracker.counters.scans_late > before.tracker.counters.scans_late);
    before.tracker.counters = chain.tracker.counters;
    HOLDS("a scan that is too late changes counters alone",
          memcmp(&before.tracker, &chain.tracker, sizeof chain.tracker) == 0 &&
              memcmp(before.initiators, chain.initiators, sizeof chain.initiators) == 0 &&
              memcmp(before.passives, chain.passives, sizeof chain.passives) == 0);
}

/* Checks after an accepted step; scan is NULL for a frame of bearings. */
static void check_step(uint32_t num_plots, int64_t time_us, const struct rho_scan *scan)
{
    const int is_late = before.tracker.has_time && time_us < before.tracker.time_us;

    check_fates(num_plots);
    check_counters();
    if (scan) {
        check_claimed_plots_fate_and_validity(scan);
    }
    check_identities();
    for (unsigned i = 0; i < chain.report.num_tracks; i++) {
        check_track(&chain.report.tracks[i], num_plots);
        check_body_and_evidence(i);
    }
    HOLDS("time never goes back",
          !before.tracker.has_time || chain.tracker.time_us >= before.tracker.time_us);
    HOLDS("the newest scan's time is the tracker's", is_late || chain.tracker.time_us == time_us);
    if (chain.tracker.counters.scans_late > before.tracker.counters.scans_late) {
        HOLDS("only a late scan is refused as late", is_late);
        HOLDS("all plots of a scan that is too late are stale",
              chain.report.fates_total[RHO_FATE_STALE] == num_plots);
        check_only_counters_changed();
    }
    check_objects();
}

/* ---- configurations -------------------------------------------------------------------------- */

static const uint32_t works[8] = {RHO_WORK_MAX, 0, 1, 1000, 20000, RHO_LIMIT_WORK, 60, 5000};

static int configure_tracker(struct script *script)
{
    struct rho_tracker_config config;
    const unsigned how = read_byte(script);
    enum rho_status status;

    rho_tracker_config_default(&config);
    config.gate = (uint8_t)(how % 4 == 3 ? 0 : how % 4);
    config.input.is_estimated = how >> 2 & 1;
    config.input.model = how >> 3 & 1;
    config.v_max_mps = how >> 4 & 1 ? 300.0f : 700.0f;
    for (unsigned edits = how >> 5; edits > 0; edits--) {
        float *const floats[] = {
            &config.pd,
            &config.v_min_mps,
            &config.v_max_mps,
            &config.accel_max_mps2,
            &config.steady_s,
#if RHO_SECTORS
            &config.late_max_s,
#endif
            &config.theta_cell_rad,
            &config.input.sigma_mps2,
            &config.input.threshold,
            &config.input.gamma,
            &config.input.noise_density,
            &config.input.noise_m,
            &config.input.noise_mps,
            &config.input.velocity_variance
        };
        const unsigned field = read_byte(script), num = sizeof floats / sizeof floats[0];

        if (field % 16 < num) {
            *floats[field % 16] = read_extreme_float(script);
        } else if (field < 128) {
            config.coast_scans_max = (uint16_t)read_byte(script);
        } else if (field < 192) {
            config.planes = (uint8_t)read_byte(script);
        } else {
            config.work_max = works[read_byte(script) % 8];
        }
    }
    status = rho_tracker_init(&chain.tracker, sizeof chain.tracker, &config);
    if (status != RHO_OK) {
        check_unchanged(status);
        rho_tracker_config_default(&config);
        status = rho_tracker_init(&chain.tracker, sizeof chain.tracker, &config);
    }
    return status == RHO_OK &&
           rho_reflector_learning_init(&chain.learning, sizeof chain.learning) == RHO_OK &&
           (!RHO_BODIES || !world.has_bodies ||
            rho_tracker_set_body_max(&chain.tracker, 300.0f) == RHO_OK);
}

static int configure_initiator(struct script *script, struct rho_initiator *initiator)
{
    struct rho_initiator_config config;
    const unsigned how = read_byte(script);
    enum rho_status status;

    rho_initiator_config_default(&config);
    config.work_max = works[how % 8];
    /* 0 saves the thresholds, the costliest part of a step */
    config.false_tracks_per_hour = how >> 3 & 1 ? 0.0f : 1.0f;
    config.scans = (uint16_t)(how >> 4 & 1 ? 3 : config.scans);
    for (unsigned edits = how >> 5; edits > 0; edits--) {
        float *const floats[] = {&config.v_min_mps,
                                 &config.v_max_mps,
                                 &config.pd,
                                 &config.false_tracks_per_hour,
                                 &config.score_min_nat,
                                 &config.process_noise_mps2,
                                 &config.turn_mps2,
                                 &config.area.x_min_m,
                                 &config.area.x_max_m,
                                 &config.area.y_min_m,
                                 &config.area.y_max_m};
        const unsigned field = read_byte(script) % 17;

        if (field < 11) {
            *floats[field] = read_extreme_float(script);
        } else if (field < 13) {
            config.scans = (uint16_t)(read_byte(script) % (RHO_MAX_SCANS + 2));
        } else if (field < 15) {
            config.min_scans = (uint16_t)(read_byte(script) % (RHO_MAX_SCANS + 2));
        } else {
            const float half_m = 1e3f * (float)(1 + read_byte(script));

            config.area_is_fixed = 1;
            config.area = (struct rho_extent){-half_m, half_m, -half_m, half_m};
        }
    }
    status = rho_initiator_init(initiator, sizeof *initiator, &config);
    if (status != RHO_OK) {
        check_unchanged(status);
        rho_initiator_config_default(&config);
        status = rho_initiator_init(initiator, sizeof *initiator, &config);
    }
    return status == RHO_OK;
}

static int configure_passive(struct script *script, struct rho_passive *passive)
{
    struct rho_passive_config config;
    const unsigned how = read_byte(script);
    enum rho_status status;

    rho_passive_config_default(&config);
    config.scans = how & 1                                ? RHO_BATCH_SCANS_MIN
                   : config.scans < RHO_MAX_PASSIVE_SCANS ? config.scans
                                                          : RHO_MAX_PASSIVE_SCANS;
    for (unsigned edits = how >> 6; edits > 0; edits--) {
        float *const floats[] = {&config.range_max_m, &config.v_max_mps, &config.pd,
                                 &config.field_of_view_rad, &config.false_tracks_per_hour};

        *floats[read_byte(script) % 5] = read_extreme_float(script);
    }
    status = rho_passive_init(passive, sizeof *passive, &config);
    if (status != RHO_OK) {
        check_unchanged(status);
        rho_passive_config_default(&config);
        config.scans = 4;
        status = rho_passive_init(passive, sizeof *passive, &config);
    }
    return status == RHO_OK;
}

/* Initialises the objects in memory filled with any byte. */
static void start_objects(struct script *script, int fill)
{
    int is_ready = 1;

    memset(&chain, fill, sizeof chain);
    memset(&chain.report, 0, sizeof chain.report);
    memcpy(&before, &chain, sizeof chain); /* padding, too */
    memset(&known, 0, sizeof known);
    image_bytes = 0;
    step_number = 0;
    begin_world(script);
    is_ready = configure_tracker(script);
    touched = TRACKER;
    copy_objects_before();
    for (unsigned i = 0; i < INITIATORS; i++) {
        is_ready = configure_initiator(script, &chain.initiators[i]) && is_ready;
        touched = INITIATOR(i);
        copy_objects_before();
    }
    for (unsigned i = 0; i < PASSIVES; i++) {
        is_ready = configure_passive(script, &chain.passives[i]) && is_ready;
        touched = PASSIVE(i);
        copy_objects_before();
    }
    HOLDS("default configurations are taken", is_ready);
    touched = ALL;
    check_objects();
    copy_objects_before();
}

/* ---- scans of plots -------------------------------------------------------------------------- */

static struct rho_plot plot_at(double x_m, double y_m)
{
    return (struct rho_plot){.x_m = (float)x_m,
                             .y_m = (float)y_m,
                             .z_m = (float)uniform(900, 1100),
                             .vx_mps = (float)uniform(-90, 90),
                             .vy_mps = 90.0f,
                             .range_rate_mps = (float)uniform(-90, 90),
                             .sigma_range_m = 20.0f,
                             .sigma_cross_m = 30.0f,
                             .sigma_up_m = 50.0f,
                             .sigma_mps = 20.0f,
                             .sigma_range_rate_mps = 40.0f};
}

static int is_in_sector(const struct rho_scan *scan, const struct look_from *from, double x_m,
                        double y_m)
{
    const double azimuth_rad = atan2(y_m - (double)from->y_m, x_m - (double)from->x_m);
    const double width_rad =
        fmod((double)scan->sector_to_rad - (double)scan->sector_from_rad + 4 * PI, 2 * PI);

    return from->sectors < 2 ||
           fmod(azimuth_rad - (double)scan->sector_from_rad + 4 * PI, 2 * PI) < width_rad;
}

/* Sets the next sector, computed in float as a radar's program would. */
static void set_next_sector(struct look_from *from, float *sector_from_rad, float *sector_to_rad)
{
    const float width_rad = (float)(2 * PI / from->sectors);

    if (from->sectors > 1) {
        *sector_from_rad = (float)-PI + width_rad * (float)from->next;
        *sector_to_rad = (float)-PI + width_rad * (float)(from->next + 1);
        from->next = (from->next + 1) % from->sectors;
    }
}

/*
 * Adds clutter: spread out, in one place, on a target, or on a moving line; few plots, or more than
 * the capacity.
 */
static uint32_t add_clutter(struct script *script, struct rho_plot *plots, uint32_t num)
{
    const unsigned how = read_byte(script);
    uint32_t more =
        how % 8 < 6 || world.full_scans >= FULL_SCANS_MAX
            ? read_byte(script) % 16
            : (how % 8 == 6 ? RHO_MAX_PLOTS / 2 : 2 * RHO_MAX_PLOTS) + read_byte(script);

    world.full_scans += more > RHO_MAX_PLOTS / 2;
    for (; more > 0 && num < PLOTS_MAX; more--) {
        switch (how / 8 % 4) {
        case 0:
            plots[num++] = plot_at(uniform(-2e4, 2e4), uniform(-2e4, 2e4));
            break;
        case 1:
            plots[num++] = plot_at(target_m(0, 0), target_m(0, 1));
            break;
        case 2:
            plots[num] = plots[num > 0 ? num - 1 : 0];
            plots[num] = num > 0 ? plots[num - 1] : plot_at(5e3, 5e3);
            num++;
            break;
        default:
            plots[num] = plot_at(300.0 * (double)more, 4e3 + 20 * world.clock_s);
            plots[num++].offset_us = (int32_t)more * 1000;
        }
    }
    return num;
}

static void edit_plot(struct script *script, struct rho_plot *plot)
{
    float *const floats[] = {&plot->x_m,
                             &plot->y_m,
                             &plot->z_m,
                             &plot->vx_mps,
                             &plot->vy_mps,
                             &plot->vz_mps,
                             &plot->range_rate_mps,
                             &plot->sigma_range_m,
                             &plot->sigma_cross_m,
                             &plot->sigma_up_m,
                             &plot->sigma_mps,
                             &plot->sigma_range_rate_mps,
                             &plot->snr_db};
    const unsigned field = read_byte(script) % 16;

    if (field < 13) {
        *floats[field] = read_extreme_float(script);
    } else if (field < 15) {
        plot->offset_us = 1000000 * ((int32_t)read_byte(script) % 128 - 64);
    } else {
        const uint32_t bits = read_word(script);

        memcpy(&plot->offset_us, &bits, sizeof bits);
    }
}

/* Changes a field of the whole scan. */
static void edit_scan(struct script *script, struct rho_scan *scan)
{
    switch (read_byte(script) % 8) {
    case 0:
        scan->sector_from_rad = read_extreme_float(script);
        break;
    case 1:
        scan->sector_to_rad = read_extreme_float(script);
        break;
    case 2:
        scan->measures = read_word(script);
        break;
    case 3:
        scan->plots = NULL;
        break;
    case 4:
        scan->num_plots = 0;
        break;
    case 5:
        scan->sensor_id = (int32_t)read_byte(script) - 100;
        break;
    default: /* makes all plots equal */
        for (uint32_t i = 1; i < scan->num_plots; i++) {
            ((struct rho_plot *)(uintptr_t)scan->plots)[i] = scan->plots[0];
        }
    }
}

/*
 * Bits of a scan's first byte: 0 .. 2 radar, 3 and 4 initiator, 5 clutter, 6 changed plots, 7
 * changed scan.
 */
static struct rho_scan make_scan(struct script *script, unsigned how, struct rho_plot *plots)
{
    struct look_from *from = &world.radars[how % 8 % RADARS];
    struct rho_scan scan = {.time_us = read_next_time_us(script),
                            .sensor_id = from->sensor_id,
                            .measures = from->measures,
                            .plots = plots};

    set_next_sector(from, &scan.sector_from_rad, &scan.sector_to_rad);
    for (unsigned i = 0; i < world.num_targets; i++) {
        const double x_m = target_m(i, 0) + uniform(-20, 20);
        const double y_m = target_m(i, 1) + uniform(-20, 20);

        if (uniform(0, 1) < 0.9 && is_in_sector(&scan, from, x_m, y_m)) {
            plots[scan.num_plots++] = plot_at(x_m, y_m);
        }
        for (int more = world.has_bodies ? (int)uniform(0, 4) : 0; more > 0; more--) {
            plots[scan.num_plots++] = plot_at(x_m + uniform(-150, 150), y_m + uniform(-30, 30));
        }
    }
    if (how & 32) {
        scan.num_plots = add_clutter(script, plots, scan.num_plots);
    }
    if (how & 64) {
        for (unsigned edits = 1 + read_byte(script) % 4; edits > 0 && scan.num_plots > 0; edits--) {
            edit_plot(script, &plots[read_byte(script) % scan.num_plots]);
        }
    }
    if (how & 128) {
        edit_scan(script, &scan);
    }
    return scan;
}

/* Copies the plots into memory of exactly their size. */
static struct rho_plot *copy_plots_to_exact_memory(const struct rho_scan *scan)
{
    const size_t bytes = scan->num_plots * sizeof *scan->plots;
    struct rho_plot *plots = malloc(bytes > 0 ? bytes : 1);

    HOLDS("there is memory", plots);
    if (scan->plots) {
        memcpy(plots, scan->plots, bytes);
    }
    return plots;
}

static void step_scan(struct script *script)
{
    static struct rho_plot plots[PLOTS_MAX];
    const unsigned how = read_byte(script), which = how >> 3 & 3;
    struct rho_scan scan = make_scan(script, how, plots);
    struct rho_plot *exact = copy_plots_to_exact_memory(&scan);
    enum rho_status status;

    scan.plots = scan.plots ? exact : NULL;
    touched = TRACKER | (which == 3 ? 0u : INITIATOR(which % 2));
    status = rho_tracker_step(&chain.tracker, which == 3 ? NULL : &chain.initiators[which % 2],
                              &scan, &chain.report);
    if (status == RHO_OK) {
        check_step(scan.num_plots, scan.time_us, &scan);
        world.time_us = chain.tracker.time_us;
        if (world.learns_walls) {
            HOLDS("walls are learned from any step",
                  rho_reflector_learning_step(&chain.learning, &chain.tracker, &scan,
                                              &chain.report) == RHO_OK);
            check_objects();
        }
    } else {
        check_unchanged(status);
    }
    free(exact);
}

/* ---- an initiator without a tracker ---------------------------------------------------------- */

static void search_or_consume_own_initiator(struct script *script)
{
    struct rho_initiator *lone = &chain.initiators[LONE];
    const unsigned how = read_byte(script);
    enum rho_status status;

    touched = INITIATOR(LONE);
    if (how % 4 == 0 && lone->num_candidates > 0) {
        const unsigned used =
            rho_initiator_consume(lone, &lone->candidates[how / 4 % lone->num_candidates]);

        HOLDS("no more plots are used than the window has scans", used <= RHO_MAX_SCANS);
    } else {
        known.was_batch |= how & 1;
        status = rho_initiator_search(lone, how & 1 ? RHO_SEARCH_BATCH : RHO_SEARCH_NEWEST);
        HOLDS("a search is taken", status == RHO_OK);
    }
    check_objects();
}

static void push_to_own_initiator(struct script *script)
{
    static struct rho_plot plots[PLOTS_MAX];
    static uint8_t fates[PLOTS_MAX], fates_before[PLOTS_MAX];
    struct rho_initiator *lone = &chain.initiators[LONE];
    const unsigned how = read_byte(script);
    struct rho_scan scan = make_scan(script, how & ~128u, plots);
    struct rho_plot *exact = copy_plots_to_exact_memory(&scan);
    uint32_t left_unused = 0;
    enum rho_status status;

    scan.plots = exact;
    if (scan.time_us > RHO_LIMIT_TIME_US || scan.time_us < -RHO_LIMIT_TIME_US) {
        scan.time_us = world.time_us; /* pushes need valid scans */
    }
    for (uint32_t i = 0; i < scan.num_plots; i++) {
        const int is_held = rho_measurement_is_valid_plot(&scan.plots[i], scan.measures);

        fates[i] = fates_before[i] = (uint8_t)(is_held ? RHO_FATE_HELD : RHO_FATE_INVALID);
    }
    touched = INITIATOR(LONE);
    status = rho_initiator_push(lone, &scan, NULL, fates, &left_unused);
    if (status == RHO_OK) {
        for (uint32_t i = 0; i < scan.num_plots; i++) {
            HOLDS("a held plot stays so or finds no room, and others stay what they are",
                  fates[i] == fates_before[i] ||
                      (fates_before[i] == RHO_FATE_HELD && fates[i] == RHO_FATE_NO_ROOM));
        }
        HOLDS("no candidate outlives a push", lone->num_candidates == 0);
        world.time_us = scan.time_us > world.time_us ? scan.time_us : world.time_us;
    } else {
        check_unchanged(status);
        HOLDS("a refused push leaves the fates",
              left_unused == 0 && memcmp(fates, fates_before, scan.num_plots) == 0);
    }
    free(exact);
    check_objects();
}

/* ---- frames of bearings ---------------------------------------------------------------------- */

/* of all targets above the passive sensors */
#define HEIGHT_M 2000.0

struct bearings {
    struct rho_bearing_scan looks[LOOKS_MAX];
    struct rho_bearing bearings[LOOKS_MAX][BEARINGS_MAX];
};

static void add_bearings_of_targets(struct rho_bearing_scan *look, const struct look_from *from,
                                    struct rho_bearing *bearings)
{
    const struct rho_scan sector = {.sector_from_rad = look->sector_from_rad,
                                    .sector_to_rad = look->sector_to_rad};

    for (unsigned i = 0; i < world.num_targets; i++) {
        const double x_m = target_m(i, 0), y_m = target_m(i, 1);
        const double east_m = x_m - (double)look->x_m, north_m = y_m - (double)look->y_m;
        const double bearing_rad = atan2(north_m, east_m);

        if (uniform(0, 1) < 0.95 && is_in_sector(&sector, from, x_m, y_m)) {
            bearings[look->num_bearings++] = (struct rho_bearing){
                .bearing_rad =
                    (float)remainder(bearing_rad + uniform(-2e-3, 2e-3), 2 * PI) * 0.9999f,
                .sigma_rad = 0.002f,
                /* of every other target */
                .elevation_rad = (float)atan2(HEIGHT_M, hypot(east_m, north_m)),
                .sigma_elevation_rad = i % 2 ? 0.004f : 0.0f};
        }
    }
}

static void edit_frame(struct script *script, struct rho_frame *frame, struct bearings *seen)
{
    const unsigned which = read_byte(script), s = read_byte(script) % LOOKS_MAX;
    struct rho_bearing_scan *look = &seen->looks[s];
    struct rho_bearing *bearing = &seen->bearings[s][read_byte(script) % BEARINGS_MAX];

    switch (which % 15) {
    case 0:
        look->x_m = read_extreme_float(script);
        break;
    case 1:
        look->y_m = read_extreme_float(script);
        break;
    case 2:
        look->sector_from_rad = read_extreme_float(script);
        break;
    case 3:
        look->sector_to_rad = read_extreme_float(script);
        break;
    case 4:
        look->time_us += (int64_t)read_byte(script) * 500000 - 64000000;
        break;
    case 5:
        look->sensor_id = (int32_t)read_byte(script) % 32;
        break;
    case 6:
        look->bearings = NULL;
        break;
    case 7:
        frame->scans = NULL;
        break;
    case 8:
        look->time_us = read_long_word(script);
        break;
    case 9:
        bearing->offset_us = (int32_t)(read_word(script) >> 1);
        break;
    case 10:
        bearing->sigma_rad = read_extreme_float(script);
        break;
    case 11:
        look->z_m = read_extreme_float(script);
        break;
    case 12:
        bearing->elevation_rad = read_extreme_float(script);
        break;
    case 13:
        bearing->sigma_elevation_rad = read_extreme_float(script);
        break;
    default:
        bearing->bearing_rad = read_extreme_float(script);
    }
}

/*
 * Bits of a frame's first byte: 0 .. 2 sensors, 3 without passive initiation, 4 more bearings, 5
 * and 6 changes.
 */
static struct rho_frame make_frame(struct script *script, unsigned how, struct bearings *seen)
{
    struct rho_frame frame = {.time_us = read_next_time_us(script),
                              .num_scans = how % 8 < LOOKS_MAX ? how % 8 : 3,
                              .scans = seen->looks};

    memset(seen, 0, sizeof *seen);
    for (uint32_t s = 0; s < LOOKS_MAX; s++) {
        struct look_from *from = &world.posts[s];
        struct rho_bearing_scan *look = &seen->looks[s];

        *look = (struct rho_bearing_scan){.time_us = frame.time_us,
                                          .sensor_id = from->sensor_id,
                                          .x_m = from->x_m,
                                          .y_m = from->y_m,
                                          .bearings = seen->bearings[s]};
        set_next_sector(from, &look->sector_from_rad, &look->sector_to_rad);
        add_bearings_of_targets(look, from, seen->bearings[s]);
    }
    if (how & 16) {
        struct rho_bearing_scan *look = &seen->looks[read_byte(script) % LOOKS_MAX];

        for (unsigned more = read_byte(script) % BEARINGS_MAX;
             more > 0 && look->num_bearings < BEARINGS_MAX; more--) {
            ((struct rho_bearing *)(uintptr_t)look->bearings)[look->num_bearings++] =
                (struct rho_bearing){.bearing_rad = (float)uniform(-3.14, 3.14),
                                     .sigma_rad = 0.003f};
        }
    }
    for (unsigned edits = how >> 5 & 3; edits > 0; edits--) {
        edit_frame(script, &frame, seen);
    }
    return frame;
}

/* Steps the looks of a frame, one after the other. */
static void step_frame(struct script *script)
{
    static struct bearings seen;
    const unsigned how = read_byte(script);
    const struct rho_frame frame = make_frame(script, how, &seen);

    for (uint32_t s = 0; frame.scans && s < frame.num_scans; s++) {
        const struct rho_bearing_scan *look = &frame.scans[s];
        enum rho_status status;

        copy_objects_before(); /* what the look before it has touched */
        touched = TRACKER | (how & 8 ? 0u : PASSIVE(0));
        status = rho_tracker_step_bearings(&chain.tracker, how & 8 ? NULL : &chain.passives[0],
                                           look, &chain.report);
        if (status == RHO_OK) {
            check_step(look->num_bearings, look->time_us, NULL);
            world.time_us = chain.tracker.time_us;
        } else {
            check_unchanged(status);
        }
    }
}

/* Challenges tracks that are known by the script, of which some have been given bearings. */
static void challenge_known_tracks(struct script *script, struct rho_passive *lone)
{
    struct rho_passive_known known_tracks[RHO_MAX_PASSIVE_TRACKS + 2];
    const unsigned how = read_byte(script), num = how % (RHO_MAX_PASSIVE_TRACKS + 3);
    unsigned num_rivals = 0;
    enum rho_status status;

    for (unsigned i = 0; i < num; i++) {
        known_tracks[i] = (struct rho_passive_known){.track_id = 1 + i,
                                                     .x_m = (float)uniform(-5e4, 5e4),
                                                     .y_m = (float)uniform(-5e4, 5e4),
                                                     .vx_mps = (float)uniform(-300, 300),
                                                     .vy_mps = (float)uniform(-300, 300),
                                                     .is_safe = how & 128 && i % 2,
                                                     .is_beaten = 7};
        num_rivals += !known_tracks[i].is_safe;
    }
    status = rho_passive_challenge(lone, known_tracks, num);
    HOLDS("as many tracks as there is room for are challenged",
          status == (num_rivals > RHO_MAX_PASSIVE_TRACKS ? RHO_ERROR_CAPACITY : RHO_OK));
    for (unsigned i = 0; i < num; i++) {
        HOLDS("a safe track is not beaten", known_tracks[i].is_beaten <= !known_tracks[i].is_safe);
    }
}

static void use_own_passive_initiator(struct script *script)
{
    static struct bearings seen;
    static uint8_t fates[LOOKS_MAX * BEARINGS_MAX], fates_before[LOOKS_MAX * BEARINGS_MAX];
    struct rho_passive *lone = &chain.passives[1];
    const unsigned how = read_byte(script);
    struct rho_frame frame;
    enum rho_status status, accepts;

    touched = PASSIVE(1);
    if (how & 128) {
        if (how & 1 && lone->num_tracks > 0) {
            HOLDS("a track of the last search has bearings to take",
                  rho_passive_give(lone, &lone->tracks[0], 1 + how % 4) == lone->tracks[0].hits);
            lone->num_tracks = 0; /* each found track may be taken once */
        } else if (how & 2) {
            challenge_known_tracks(script, lone);
        } else {
            status = rho_passive_search(lone);
            HOLDS("a search is taken", status == RHO_OK);
        }
        check_objects();
        return;
    }
    frame = make_frame(script, how, &seen);
    memset(fates, RHO_FATE_HELD, sizeof fates);
    memcpy(fates_before, fates, sizeof fates);
    accepts = rho_passive_accepts(lone, &frame);
    status = rho_passive_push(lone, &frame, fates);
    HOLDS("rho_passive_push does what rho_passive_accepts said", status == accepts);
    if (status != RHO_OK) {
        check_unchanged(status);
        HOLDS("a refused frame leaves the fates", memcmp(fates, fates_before, sizeof fates) == 0);
    } else if (frame.time_us > world.time_us && frame.time_us <= RHO_LIMIT_TIME_US) {
        /* batches accept any time, so the world's clock need not follow */
        world.time_us = frame.time_us;
    }
    check_objects();
}

/* ---- other calls ----------------------------------------------------------------------------- */

static void describe_sensor(struct script *script)
{
    const unsigned how = read_byte(script);
    const struct look_from *from =
        how & 8 ? &world.posts[how % 8 % LOOKS_MAX] : &world.radars[how % 8 % RADARS];
    struct rho_sensor sensor = {.sensor_id = from->sensor_id,
                                .x_m = from->x_m,
                                .y_m = from->y_m,
                                .pd = 0.9f,
                                .range_max_m = 50e3f};
    enum rho_status status;

    for (unsigned edits = how >> 4 & 3; edits > 0; edits--) {
        float *const floats[] = {
            &sensor.x_m,
            &sensor.y_m,
            &sensor.z_m,
            &sensor.pd,
            &sensor.range_min_m,
            &sensor.range_max_m,
            &sensor.sector_from_rad,
            &sensor.sector_to_rad,
            &sensor.range_bias_m,
            &sensor.azimuth_bias_rad,
            &sensor.time_bias_s,
#if RHO_AMBIGUOUS_RANGE_RATES
            &sensor.range_rate_span_mps,
#endif
        };
        *floats[read_byte(script) % (sizeof floats / sizeof floats[0])] =
            read_extreme_float(script);
    }
#if RHO_AMBIGUOUS_RANGE_RATES
    if (how & 64) {
        sensor.range_rate_span_mps = 1.0f + (float)read_byte(script);
    }
#endif
    if (how & 128) {
        sensor.sensor_id =
            (int32_t)read_byte(script) + 100; /* one more sensor, of an unused number */
    }
    touched = TRACKER;
    status = rho_tracker_set_sensor(&chain.tracker, &sensor);
    if (status != RHO_OK) {
        check_unchanged(status);
        HOLDS("a table with room refuses no sensor for it",
              status != RHO_ERROR_CAPACITY || chain.tracker.num_sensors == RHO_MAX_SENSORS);
    }
    check_objects();
}

static void forget_sensor(struct script *script)
{
    const unsigned how = read_byte(script);
    const int32_t sensor_id = how & 8    ? world.posts[how % 8 % LOOKS_MAX].sensor_id
                              : how & 16 ? (int32_t)how
                                         : world.radars[how % 8 % RADARS].sensor_id;
    enum rho_status status;

    touched = TRACKER;
    status = rho_tracker_forget_sensor(&chain.tracker, sensor_id);
    if (status != RHO_OK) {
        check_unchanged(status);
    }
    check_objects();
}

static void list_snapshot_parts(struct rho_snapshot_part parts[PARTS])
{
    unsigned num = 0;

    parts[num++] =
        (struct rho_snapshot_part){RHO_SNAPSHOT_TRACKER, 0, &chain.tracker, sizeof chain.tracker};
    for (unsigned i = 0; i < INITIATORS; i++) {
        parts[num++] = (struct rho_snapshot_part){RHO_SNAPSHOT_INITIATOR, (int32_t)i,
                                                  &chain.initiators[i], sizeof chain.initiators[i]};
    }
    for (unsigned i = 0; i < PASSIVES; i++) {
        parts[num++] = (struct rho_snapshot_part){RHO_SNAPSHOT_PASSIVE, (int32_t)i,
                                                  &chain.passives[i], sizeof chain.passives[i]};
    }
}

static void save_image(const struct rho_snapshot_part parts[PARTS])
{
    const enum rho_status status =
        rho_snapshot_save(parts, PARTS, 0, image, sizeof image, &image_bytes);

    HOLDS("objects that were stepped can be saved", status == RHO_OK);
    HOLDS("an image is as large as it was said", image_bytes == rho_snapshot_size(parts, PARTS));
    HOLDS("saving changes nothing", memcmp(&before, &chain, OBJECTS_BYTES) == 0);
    world.images++;
    known_of_image = known;
    world_of_image = world;
}

/* Loads the image into objects whose memory holds other bytes. */
static void load_image_over_other_bytes(const struct rho_snapshot_part parts[PARTS])
{
    memset(&chain, 0x77, offsetof(struct pipeline, report));
    HOLDS("what was saved can be loaded",
          rho_snapshot_load(parts, PARTS, image, image_bytes) == RHO_OK);
}

/* Saves an image and mostly loads it at once; or loads the last one, whatever was stepped since. */
static void save_or_load(struct script *script)
{
    struct rho_snapshot_part parts[PARTS];
    const unsigned how = read_byte(script);

    list_snapshot_parts(parts);
    touched = ALL;
    if (image_bytes == 0 || (how & 1 && world.images < IMAGES_MAX)) {
        save_image(parts);
        if (!(how & 2)) {
            load_image_over_other_bytes(parts);
            HOLDS("what is loaded is what was saved, byte for byte",
                  memcmp(&before, &chain, OBJECTS_BYTES) == 0);
        }
    } else {
        load_image_over_other_bytes(parts);
        known = known_of_image;
        world_of_image.images = world.images;
        world_of_image.full_scans = world.full_scans;
        world = world_of_image;
    }
    check_objects();
}

/* An identity that is alive, or any. */
static uint32_t read_track_id(struct script *script)
{
    const unsigned which = read_byte(script);

    return chain.report.num_tracks > 0 && which < 224
               ? chain.report.tracks[which % chain.report.num_tracks].track_id
               : (which < 240 ? which : read_word(script));
}

static enum rho_status start_track_by_hand(struct script *script)
{
    struct rho_operator_start start = {.x_m = (float)target_m(0, 0),
                                       .y_m = (float)target_m(0, 1),
                                       .sigma_m = 100.0f,
                                       .sigma_mps = 50.0f};
    float *const floats[] = {&start.x_m,    &start.y_m,    &start.sigma_m,
                             &start.vx_mps, &start.vy_mps, &start.sigma_mps};

    for (unsigned edits = read_byte(script) % 4; edits > 0; edits--) {
        *floats[read_byte(script) % 6] = read_extreme_float(script);
    }
    return rho_tracker_start_at(&chain.tracker, &start, &chain.report);
}

/* Starts a track from any estimate, as a filter of the caller may. */
static enum rho_status start_estimate(struct script *script)
{
    struct rho_kalman estimate;

    rho_kalman_init(&estimate);
    for (unsigned i = 0; i < RHO_KALMAN_STATES; i++) {
        estimate.state[i] = i < 2 ? (float)uniform(-1e4, 1e4) : 0.0f;
        estimate.covariance[RHO_AT(i, i)] = 1e4f;
    }
    for (unsigned edits = read_byte(script) % 4; edits > 0; edits--) {
        const unsigned field = read_byte(script);
        const float number = read_extreme_float(script);

        if (field % 2) {
            estimate.state[field / 2 % RHO_KALMAN_STATES] = number;
        } else {
            estimate.covariance[field / 2 % RHO_TRIANGLE(RHO_KALMAN_STATES)] = number;
        }
    }
    return rho_tracker_start_estimate(&chain.tracker, &estimate, world.radars[0].sensor_id, 1,
                                      (int32_t)read_byte(script) * 100 - 5000, &chain.report);
}

static enum rho_status tell_walls(struct script *script)
{
    struct rho_reflector walls[RHO_MAX_REFLECTORS + 2];
    const unsigned num = read_byte(script) % (RHO_MAX_REFLECTORS + 2);

    for (unsigned i = 0; i < num; i++) {
        const float x_m = read_extreme_float(script);

        walls[i] = (struct rho_reflector){x_m, -2e4f, x_m + 500.0f, 2e4f};
    }
    return rho_tracker_set_reflectors(&chain.tracker, walls, num);
}

static enum rho_status exclude_area(struct script *script)
{
    const float x_m = read_extreme_float(script), y_m = read_extreme_float(script);
    const struct rho_extent area = {x_m - 4e3f, x_m + 4e3f, y_m - 4e3f, y_m + 4e3f};

    return rho_tracker_exclude_area(&chain.tracker, &area);
}

static enum rho_status reconfigure_tracker(struct script *script)
{
    struct rho_tracker_config config = chain.tracker.config;
    float *const floats[] = {&config.pd, &config.v_min_mps, &config.v_max_mps,
                             &config.accel_max_mps2, &config.steady_s};
    const unsigned field = read_byte(script) % 8;

    if (field < 5) {
        *floats[field] = read_extreme_float(script);
    } else {
        config.coast_scans_max = (uint16_t)read_byte(script);
    }
    return rho_tracker_reconfigure(&chain.tracker, &config);
}

static enum rho_status reconfigure_initiator(struct script *script)
{
    struct rho_initiator_config config = chain.initiators[0].config;
    float *const floats[] = {&config.v_min_mps, &config.v_max_mps, &config.pd,
                             &config.false_tracks_per_hour};
    const unsigned field = read_byte(script) % 8;

    touched = INITIATOR(0);
    if (field < 4) {
        *floats[field] = read_extreme_float(script);
    } else if (field < 6) {
        config.scans = (uint16_t)(read_byte(script) % (RHO_MAX_SCANS + 2));
    } else {
        config.area_is_fixed = 1;
        config.area = (struct rho_extent){-1e4f, 1e4f, -1e4f, 1e4f};
    }
    return rho_initiator_reconfigure(&chain.initiators[0], &config);
}

/* Tracks changed by hand: the report lists those alive, and others as ended. */
static void note_tracks_changed_by_hand(void)
{
    struct known now = {.highest = chain.tracker.next_track_id - 1,
                        .was_renumbered = known.was_renumbered,
                        .was_batch = known.was_batch};

    for (unsigned i = 0; i < chain.report.num_tracks; i++) {
        add_known_track(&now, &chain.report.tracks[i]);
        check_track(&chain.report.tracks[i], chain.report.num_plots);
    }
    HOLDS("the report has room for those ended", chain.report.num_ended <= RHO_MAX_TRACKS);
    known = now;
    check_counters();
}

/* What a person or a caller changes between two steps. */
static void change_by_hand(struct script *script)
{
    const unsigned what = read_byte(script) % 16;
    uint32_t track_id;
    float x_m;
    enum rho_status status;

    touched = TRACKER;
    switch (what) {
    case 0:
    case 1:
        status = start_track_by_hand(script);
        break;
    case 2:
        status = start_estimate(script);
        break;
    case 3:
    case 4:
        status = rho_tracker_drop_track(&chain.tracker, read_track_id(script), &chain.report);
        break;
    case 5:
    case 6:
        track_id = read_track_id(script);
        status = rho_tracker_renumber_track(&chain.tracker, track_id, read_track_id(script),
                                            &chain.report);
        known.was_renumbered |= status == RHO_OK;
        break;
    case 7:
    case 8:
        track_id = read_track_id(script);
        status = rho_tracker_freeze_track(&chain.tracker, track_id, read_byte(script) & 1,
                                          &chain.report);
        break;
    case 9:
        status = exclude_area(script);
        break;
    case 10:
        x_m = read_extreme_float(script);
        status = rho_tracker_include_place(&chain.tracker, x_m, read_extreme_float(script));
        break;
    case 11:
        status = rho_tracker_set_body_max(&chain.tracker, read_extreme_float(script));
        break;
    case 12:
    case 13:
        status = tell_walls(script);
        break;
    case 14:
        status = reconfigure_tracker(script);
        break;
    default:
        status = reconfigure_initiator(script);
    }
    if (what <= 2 && status == RHO_ERROR_CAPACITY) {
        HOLDS("a start without room is counted once",
              chain.tracker.counters.tracks_no_room - before.tracker.counters.tracks_no_room <= 1);
        before.tracker.counters.tracks_no_room = chain.tracker.counters.tracks_no_room;
    }
    if (status != RHO_OK) {
        check_unchanged(status);
    } else if (what <= 8) {
        note_tracks_changed_by_hand();
    }
    check_objects();
}

/* Makes calls with wrong arguments, which are refused and change nothing. */
static void make_refused_calls(struct script *script)
{
    static struct rho_plot plot;
    const struct rho_scan scan = {.time_us = world.time_us, .num_plots = 1, .plots = &plot};
    const struct rho_scan no_plots = {.time_us = world.time_us, .num_plots = 1};
    const struct rho_bearing_scan look = {.time_us = world.time_us};
    const struct rho_bearing_scan no_bearings = {.time_us = world.time_us, .num_bearings = 1};
    struct rho_tracker *tracker = &chain.tracker;
    struct rho_initiator *initiator = &chain.initiators[0];
    struct rho_report *report = &chain.report;
    static struct rho_initiator empty_initiator;
    static struct rho_passive empty_passive;
    static struct rho_tracker empty;
    uint32_t left;
    uint8_t fate;
    enum rho_status status;

    switch (read_byte(script) % 16) {
    case 0:
        status = rho_tracker_step(NULL, initiator, &scan, report);
        break;
    case 1:
        status = rho_tracker_step(tracker, initiator, NULL, report);
        break;
    case 2:
        status = rho_tracker_step(tracker, initiator, &scan, NULL);
        break;
    case 3:
        status = rho_tracker_step(tracker, initiator, &no_plots, report);
        break;
    case 4:
        status = rho_tracker_step(tracker, &empty_initiator, &scan, report);
        break;
    case 5:
        status = rho_tracker_step(&empty, initiator, &scan, report);
        break;
    case 6:
        status = rho_tracker_step_bearings(tracker, &empty_passive,
                                           &(struct rho_bearing_scan){.time_us = RHO_LIMIT_TIME_US},
                                           report);
        break;
    case 7:
        status = rho_tracker_step_bearings(tracker, NULL, &no_bearings, report);
        break;
    case 8:
        status = rho_tracker_step_bearings(tracker, NULL, &look, NULL);
        break;
    case 9:
        status = rho_tracker_set_sensor(tracker, NULL);
        break;
    case 10:
        status = rho_tracker_init(tracker, sizeof *tracker - 1, &tracker->config);
        break;
    case 11:
        status = rho_initiator_init(initiator, 0, &initiator->config);
        break;
    case 12:
        status = rho_initiator_push(initiator, NULL, NULL, &fate, &left);
        break;
    case 13:
        status = rho_passive_init(&chain.passives[0], 1, &chain.passives[0].config);
        break;
    case 14:
        status = rho_passive_push(&chain.passives[0], NULL, &fate);
        break;
    default:
        status = rho_initiator_search(&empty_initiator, RHO_SEARCH_NEWEST);
    }
    check_unchanged(status);
}

static void check_learned_of_sensor(int32_t sensor_id)
{
    struct rho_tracker_known known_of_sensor;

    if (rho_tracker_known_of(&chain.tracker, sensor_id, &known_of_sensor) != RHO_OK) {
        return;
    }
    HOLDS("factors on sigmas are finite and above 0",
          rho_is_within(known_of_sensor.range_factor, 1e-6f, 1e6f) &&
              rho_is_within(known_of_sensor.cross_factor, 1e-6f, 1e6f));
    for (unsigned ring = 0; ring < RHO_LEARN_RINGS; ring++) {
        HOLDS("a learned pd is one", rho_is_within(known_of_sensor.pd[ring], 0.0f, 1.0f));
    }
    HOLDS("a notch and a resolution cell are finite and not negative",
          rho_is_within(known_of_sensor.notch_mps, 0.0f, 1e6f) &&
              rho_is_within(known_of_sensor.resolution_range_sigmas, 0.0f, 1e6f) &&
              rho_is_within(known_of_sensor.resolution_cross_sigmas, 0.0f, 1e6f));
}

static void call_queries(struct script *script)
{
    const float x_m = read_extreme_float(script), y_m = read_extreme_float(script);

    for (unsigned i = 0; i < RADARS; i++) {
#if RHO_SECTORS
        const struct rho_tracker_look *look =
            rho_tracker_look_of(&chain.tracker, world.radars[i].sensor_id);

        HOLDS("a look of a sensor is finite",
              !look || (isfinite(look->seen_share) && isfinite(look->distance2) &&
                        isfinite(look->sigma_m)));
#endif
        check_learned_of_sensor(world.radars[i].sensor_id);
        if (rho_is_coordinate(x_m) && rho_is_coordinate(y_m)) {
            const float density = rho_initiator_density(&chain.initiators[i % INITIATORS],
                                                        world.radars[i].sensor_id, x_m, y_m);

            HOLDS("a density is finite and not negative", isfinite(density) && density >= 0.0f);
        }
    }
    HOLDS("questions change nothing", memcmp(&before, &chain, OBJECTS_BYTES) == 0);
}

/* ---- one run --------------------------------------------------------------------------------- */

static void run_script(const uint8_t *data, size_t size, int fill)
{
    static void (*const rare[])(struct script *) = {describe_sensor,
                                                    describe_sensor,
                                                    forget_sensor,
                                                    save_or_load,
                                                    push_to_own_initiator,
                                                    push_to_own_initiator,
                                                    push_to_own_initiator,
                                                    search_or_consume_own_initiator,
                                                    search_or_consume_own_initiator,
                                                    use_own_passive_initiator,
                                                    use_own_passive_initiator,
                                                    use_own_passive_initiator,
                                                    make_refused_calls,
                                                    call_queries};
    struct script script = {data, size};

    start_objects(&script, fill);
    for (step_number = 1; step_number <= STEPS_MAX && script.size > 0; step_number++) {
        const unsigned what = read_byte(&script);

        if (what < 128) {
            step_scan(&script);
        } else if (what < 176) {
            step_frame(&script);
        } else if (what >= 232) {
            change_by_hand(&script);
        } else {
            rare[what % (sizeof rare / sizeof rare[0])](&script);
        }
        copy_objects_before();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    run_script(data, size, 0x3c);
    if (size > 0 && data[size - 1] % 8 == 0) {
        first_run = chain;
        known_first = known;
        run_script(data, size, 0xc3);
        HOLDS("the same script gives the same bytes",
              memcmp(&first_run, &chain, OBJECTS_BYTES) == 0 &&
                  memcmp(&known_first, &known, sizeof known) == 0);
    }
    return 0;
}
