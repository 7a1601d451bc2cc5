/* SPDX-License-Identifier: MIT */
/* One scene, followed by one method; and what became of it in figures. */
#include <math.h>
#include <string.h>

#include "experiment_maneuver.h"
#include "rhotrack/detail/input.h"

#define START_SIGMA_MPS 1000.0 /* sd of a velocity that is not measured, v_max of the tracker */
#define START_SIGMA_MPS2 200.0
#define PAPER_VARIANCE 500.0 /* P(0|0) and V(0) */
#define PAPER_INPUT_SIGMA_MPS2 22.360679774997898
#define PD_MAX 0.995
#define RANDOM_STREAM 200000 /* beside the scene's */

/*
 * The width of Singer's model a step of 0.25 s, as a share of the largest acceleration; how it
 * decays; sojourns.
 */
#define SINGER_SHARE 0.34
#define SINGER_KEEP 0.98
#define STAY 0.97
#define STEADY_MPS2 2.0

/* ---- the trace ------------------------------------------------------------------------------- */

static void note_estimate(struct maneuver_trace *trace, const struct maneuver_scene *scene,
                          size_t scan, const double state[6])
{
    for (unsigned i = 0; i < 3; i++) {
        bool is_open = i < maneuver_axes(scene->of);
        trace->off_m[scan][i] = is_open ? state[i] - scene->truth[scan][i] : 0.0;
        trace->off_mps[scan][i] = is_open ? state[i + 3] - scene->truth[scan][i + 3] : 0.0;
    }
}

static void note_plot(struct maneuver_trace *trace, size_t scan, const struct maneuver_look *look,
                      int row)
{
    trace->is_wrong[scan] = row >= 0 && row != look->target_row;
    trace->used_m[scan][0] = row >= 0 ? (double)look->plots[row].x_m : NAN;
    trace->used_m[scan][1] = row >= 0 ? (double)look->plots[row].y_m : NAN;
    trace->used_m[scan][2] = row >= 0 ? (double)look->plots[row].z_m : NAN;
}

/* ---- the library ----------------------------------------------------------------------------- */

static struct parameters parameters_of(const struct maneuver_setting *of,
                                       const struct maneuver_method *method)
{
    struct parameters parameters;
    parameters_default(&parameters);
    parameters_suggest(&parameters, PARAMETER_SIGMA_M, of->sigma_m);
    parameters_suggest(&parameters, PARAMETER_V_MAX_MPS, START_SIGMA_MPS);
    parameters_suggest(&parameters, PARAMETER_ACCEL_MAX_MPS2, of->accel_max_g * MANEUVER_G_MPS2);
    parameters_suggest(&parameters, PARAMETER_GAMMA, method->gamma);
    parameters_suggest(&parameters, PARAMETER_INPUT_MODEL,
                       method->has_physical_input ? RHO_INPUT_PHYSICAL : RHO_INPUT_LITERAL);
    parameters_suggest(&parameters, PARAMETER_FILTER_NOISE_M, method->filter_noise);
    parameters_suggest(&parameters, PARAMETER_FILTER_NOISE_MPS, method->filter_noise);
    parameters_suggest(&parameters, PARAMETER_INPUT_SIGMA_MPS2, PAPER_INPUT_SIGMA_MPS2);
    return parameters;
}

static double pd_of(const struct maneuver_setting *of, const struct maneuver_method *method)
{
    return method->assumed_pd > 0.0 ? method->assumed_pd : fmin(of->pd, PD_MAX);
}

/* A library's track of a scene, between scans. */
struct following {
    const struct maneuver_scene *scene;
    const struct maneuver_method *method;
    struct maintainer *maintainer;
    struct rho_sensor sensor;
    struct random random;
    double previous_m[3]; /* from where clutter seems to come: the truth, or the last estimate */
};

static void note_library(struct maneuver_trace *trace, struct following *following, size_t scan)
{
    struct maintainer_estimate estimate;
    double state[6];
    maintainer_estimate(following->maintainer, &estimate);
    for (int i = 0; i < 6; i++) {
        state[i] = (double)estimate.kalman.state[i];
    }
    note_estimate(trace, following->scene, scan, state);
    trace->hypotheses[scan] = estimate.num_hypotheses;
    bool is_led = following->scene->of->beam != MANEUVER_AT_TRUTH;
    memcpy(following->previous_m, is_led ? state : following->scene->truth[scan],
           sizeof following->previous_m);
}

/*
 * The gate of velocities in places alone: each plot gets the velocity that would have brought it
 * from the last estimate, known so badly that the filter learns nothing from it.
 */
static void give_velocities(struct maneuver_look *look, const double previous_m[3])
{
    for (uint32_t i = 0; i < look->scan.num_plots; i++) {
        struct rho_plot *plot = &look->plots[i];
        plot->vx_mps = (float)(((double)plot->x_m - previous_m[0]) / MANEUVER_INTERVAL_S);
        plot->vy_mps = (float)(((double)plot->y_m - previous_m[1]) / MANEUVER_INTERVAL_S);
        plot->vz_mps = (float)(((double)plot->z_m - previous_m[2]) / MANEUVER_INTERVAL_S);
        plot->sigma_mps = RHO_LIMIT_SIGMA_MAX;
    }
    look->scan.measures |= RHO_MEASURES_VELOCITY;
}

static void follow_scan(struct maneuver_trace *trace, struct following *following, size_t scan)
{
    const struct maneuver_scene *scene = following->scene;
    struct maintainer *maintainer = following->maintainer;
    struct maneuver_look look;
    double centre_m[3];
    maintainer_predict(maintainer, maneuver_time_us(scan));
    if (scene->of->beam == MANEUVER_AT_TRUTH) {
        memcpy(centre_m, scene->truth[scan], sizeof centre_m);
    } else {
        maintainer_where(maintainer, centre_m);
    }
    maneuver_look_fill(&look, scene, scan, centre_m, following->previous_m);
    trace->nis[scan] =
        look.target_row < 0
            ? NAN
            : maintainer_nis(maintainer, &look.plots[look.target_row], look.scan.measures);
    if (following->method->gate == MAINTAIN_HOUGH && scene->of->sensor == MANEUVER_PLACES) {
        give_velocities(&look, following->previous_m);
    }
    int row = maintainer_update(maintainer, &look.scan, &following->sensor,
                                maneuver_log_density(scene, scan),
                                pd_of(scene->of, following->method), &following->random);
    note_plot(trace, scan, &look, row);
    note_library(trace, following, scan);
}

static void follow_by_library(struct maneuver_trace *trace, const struct maneuver_scene *scene,
                              const struct maneuver_method *method)
{
    struct parameters parameters = parameters_of(scene->of, method);
    struct following following = {
        .scene = scene,
        .method = method,
        .maintainer = maintainer_new(method->gate, method->has_input_estimation, &parameters),
        .sensor = {.pd = (float)pd_of(scene->of, method), .range_max_m = 2e5f},
        .random = random_start(scene->seed, scene->stream + RANDOM_STREAM, scene->run)};
    struct rho_plot first = maneuver_plot(scene, 0);
    maintainer_start(following.maintainer, maneuver_time_us(0), &first,
                     maneuver_measures(scene->of), &following.sensor);
    note_library(trace, &following, 0);
    for (size_t scan = 1; scan < MANEUVER_SCANS; scan++) {
        follow_scan(trace, &following, scan);
    }
    trace->refused = maintainer_refused(following.maintainer);
    maintainer_free(following.maintainer);
}

/* ---- the references -------------------------------------------------------------------------- */

static struct double_gaussian reference_start(const struct maneuver_scene *scene)
{
    struct double_measured measured = maneuver_measured(scene, 0);
    struct double_gaussian start = {.mean = {0.0}};
    bool is_literal = scene->of->truth == MANEUVER_LITERAL;
    for (size_t i = 0; i < 3; i++) {
        start.covariance.at[i + 3][i + 3] = START_SIGMA_MPS * START_SIGMA_MPS;
        start.covariance.at[i + 6][i + 6] = START_SIGMA_MPS2 * START_SIGMA_MPS2;
    }
    for (size_t i = 0; i < measured.size; i++) {
        start.mean[i] = measured.value[i];
        for (size_t j = 0; j < measured.size; j++) {
            start.covariance.at[i][j] =
                is_literal ? PAPER_VARIANCE * (i == j) : measured.covariance[i][j];
        }
    }
    return start;
}

/* What the truth does to an axis with an input, an interval. */
static void effect_of_input(const struct maneuver_setting *of, double effect[2])
{
    const double t_s = MANEUVER_INTERVAL_S;
    effect[0] = of->truth == MANEUVER_PHYSICAL ? t_s * t_s / 2.0 : 0.0;
    effect[1] = t_s;
}

static void note_reference(struct maneuver_trace *trace, const struct maneuver_scene *scene,
                           size_t scan, const double mean[DOUBLE_STATES], bool is_fed)
{
    note_estimate(trace, scene, scan, mean);
    for (int i = 0; i < 3; i++) {
        trace->used_m[scan][i] = is_fed ? scene->measured[scan][i] : NAN;
    }
    trace->hypotheses[scan] = 1.0;
}

static double reference_nis(const struct double_gaussian *predicted,
                            const struct double_measured *measured, bool is_fed)
{
    return is_fed ? double_gaussian_distance2(predicted, measured, NULL) / (double)measured->size
                  : NAN;
}

static void follow_clairvoyantly(struct maneuver_trace *trace, const struct maneuver_scene *scene)
{
    const struct maneuver_setting *of = scene->of;
    struct double_gaussian track = reference_start(scene);
    double effect[2];
    effect_of_input(of, effect);
    struct double_model model = of->truth == MANEUVER_LITERAL
                                    ? double_model_noisy(MANEUVER_INTERVAL_S, of->noise, of->noise)
                                    : double_model_steady(MANEUVER_INTERVAL_S, effect, of->noise);
    note_reference(trace, scene, 0, track.mean, true);
    for (size_t scan = 1; scan < MANEUVER_SCANS; scan++) {
        double shift[DOUBLE_STATES] = {0.0};
        struct double_measured measured = maneuver_measured(scene, scan);
        for (unsigned i = 0; i < maneuver_axes(of); i++) {
            shift[i] = effect[0] * scene->input_mps2[scan - 1][i];
            shift[i + 3] = effect[1] * scene->input_mps2[scan - 1][i];
        }
        double_gaussian_predict(&track, &model, shift);
        bool is_fed = scene->is_seen[scan] && maneuver_is_in_beam(scene, scan, track.mean);
        trace->nis[scan] = reference_nis(&track, &measured, is_fed);
        if (is_fed) {
            double_gaussian_update(&track, &measured);
        }
        note_reference(trace, scene, scan, track.mean, is_fed);
    }
}

static void follow_by_true_imm(struct maneuver_trace *trace, const struct maneuver_scene *scene)
{
    const struct maneuver_setting *of = scene->of;
    struct double_gaussian start = reference_start(scene), estimate;
    double effect[2];
    effect_of_input(of, effect);
    struct double_imm imm = {
        .num_models = 2,
        .stay = STAY,
        .model = {double_model_steady(MANEUVER_INTERVAL_S, effect, STEADY_MPS2),
                  double_model_singer(MANEUVER_INTERVAL_S, SINGER_KEEP,
                                      SINGER_SHARE * of->accel_max_g * MANEUVER_G_MPS2)}};
    double_imm_start(&imm, &start);
    note_reference(trace, scene, 0, start.mean, true);
    for (size_t scan = 1; scan < MANEUVER_SCANS; scan++) {
        struct double_measured measured = maneuver_measured(scene, scan);
        double_imm_predict(&imm);
        double_imm_estimate(&imm, &estimate);
        bool is_fed = scene->is_seen[scan] && maneuver_is_in_beam(scene, scan, estimate.mean);
        trace->nis[scan] = reference_nis(&estimate, &measured, is_fed);
        if (is_fed) {
            double_imm_update(&imm, &measured);
            double_imm_estimate(&imm, &estimate);
        }
        note_reference(trace, scene, scan, estimate.mean, is_fed);
    }
}

void maneuver_follow(struct maneuver_trace *trace, const struct maneuver_scene *scene,
                     const struct maneuver_method *method)
{
    memset(trace, 0, sizeof *trace);
    trace->nis[0] = NAN;
    for (int i = 0; i < 3; i++) {
        trace->used_m[0][i] = scene->measured[0][i];
    }
    switch (method->kind) {
    case MANEUVER_CLAIRVOYANT:
        follow_clairvoyantly(trace, scene);
        break;
    case MANEUVER_TRUE_IMM:
        follow_by_true_imm(trace, scene);
        break;
    case MANEUVER_LIBRARY:
    default:
        follow_by_library(trace, scene, method);
        break;
    }
}

/* ---- in figures ------------------------------------------------------------------------------ */

/* From the end of the clean scans on. */
static void judge_scan(struct maneuver_outcome *outcome, const struct maneuver_trace *trace,
                       double radius_m, size_t scan)
{
    double square_m2 = 0.0;
    for (int i = 0; i < 3; i++) {
        double off_m = fabs(trace->off_m[scan][i]), off_mps = trace->off_mps[scan][i];
        square_m2 += off_m * off_m;
        outcome->most_off_m = fmax(outcome->most_off_m, off_m);
        outcome->is_inside &= off_m <= radius_m;
        outcome->least_mps = fmin(outcome->least_mps, off_mps);
        outcome->most_mps = fmax(outcome->most_mps, off_mps);
    }
    outcome->is_lost |= !(square_m2 <= radius_m * radius_m);
    outcome->wrong += trace->is_wrong[scan];
    outcome->scans++;
}

static void measure_scan(struct maneuver_outcome *outcome, const struct maneuver_trace *trace,
                         size_t scan)
{
    const double share = 1.0 / (MANEUVER_SCANS - MANEUVER_JUDGED_SCAN);
    for (int i = 0; i < 3; i++) {
        outcome->square_m2 += share * trace->off_m[scan][i] * trace->off_m[scan][i];
        outcome->square_mps2 += share * trace->off_mps[scan][i] * trace->off_mps[scan][i];
    }
    outcome->hypotheses += share * trace->hypotheses[scan];
    if (!isnan(trace->nis[scan])) {
        outcome->nis_sum += trace->nis[scan];
        outcome->nis_count++;
    }
}

struct maneuver_outcome maneuver_outcome_of(const struct maneuver_trace *trace,
                                            const struct maneuver_scene *scene)
{
    struct maneuver_outcome outcome = {.is_inside = true, .refused = trace->refused};
    for (size_t scan = MANEUVER_CLEAN_SCANS; scan < MANEUVER_SCANS; scan++) {
        judge_scan(&outcome, trace, scene->radius_m[scan], scan);
    }
    for (size_t scan = MANEUVER_JUDGED_SCAN; scan < MANEUVER_SCANS; scan++) {
        measure_scan(&outcome, trace, scan);
    }
    return outcome;
}
