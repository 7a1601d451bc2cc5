/* SPDX-License-Identifier: MIT */
#include "settings/initiation_methods.h"

#include <math.h>
#include <string.h>

#include "base/common.h"

static const char *const names[NUM_METHODS] = {"kernel", "ht",      "mht",          "iht",
                                               "nht",    "passive", "passive-paper"};

const char *method_name(enum method method)
{
    return names[method];
}

bool method_takes_bearings(enum method method)
{
    return method == METHOD_PASSIVE || method == METHOD_PASSIVE_PAPER;
}

enum method track_start_method(const struct parameters *parameters)
{
    return (enum method)(METHOD_KERNEL + (int)parameters->value[PARAMETER_METHOD]);
}

enum method method_of_bearings(const struct parameters *parameters)
{
    return (enum method)(METHOD_PASSIVE + (int)parameters->value[PARAMETER_BEARINGS_METHOD]);
}

enum method method_must_find(const char *name)
{
    for (int i = 0; i < NUM_METHODS; i++) {
        if (!strcmp(names[i], name)) {
            return (enum method)i;
        }
    }
    fail(EXIT_USAGE, "no method '%s'; there are: " METHOD_NAMES, name);
}

static void suggest_bearing_parameters(struct parameters *parameters, double rho_cell_m,
                                       double theta_cell_rad, int prune)
{
    parameters_suggest(parameters, PARAMETER_SCANS, 8);
    parameters_suggest(parameters, PARAMETER_D_RHO_M, rho_cell_m);
    parameters_suggest(parameters, PARAMETER_D_THETA_RAD, theta_cell_rad);
    parameters_suggest(parameters, PARAMETER_V_MAX_MPS, 450);
    parameters_suggest(parameters, PARAMETER_PRUNE, prune);
}

void method_suggest_parameters(enum method method, struct parameters *parameters)
{
    if (method == METHOD_PASSIVE) {
        suggest_bearing_parameters(parameters, 2000, M_PI / 36, 0); /* prune: safe */
        parameters_suggest(parameters, PARAMETER_ACCEL_MAX_MPS2, 5);
    } else if (method == METHOD_PASSIVE_PAPER) {
        suggest_bearing_parameters(parameters, 1000, M_PI / 90, 1); /* prune: literal */
        parameters_suggest(parameters, PARAMETER_VOTE, 0);          /* vote: scans */
        /* values of the papers for ht, mht, iht, nht */
    } else if (method != METHOD_KERNEL) {
        parameters_suggest(parameters, PARAMETER_V_MIN_MPS, 100);
        parameters_suggest(parameters, PARAMETER_V_MAX_MPS, 400);
        parameters_suggest(parameters, PARAMETER_VOTE, 1); /* vote: counts */
    }
}

static enum rho_hough_method hough_method_of(enum method method,
                                             const struct parameters *parameters)
{
    switch (method) {
    case METHOD_HT:
        return RHO_HOUGH_HT;
    case METHOD_MHT:
        return RHO_HOUGH_MHT;
    case METHOD_IHT:
        return RHO_HOUGH_IHT;
    default:
        return parameters->value[PARAMETER_NHT_READING] > 0 ? RHO_HOUGH_NHT_C : RHO_HOUGH_NHT_A;
    }
}

/* Cells of rho on each side of 0 that hold all lines through plots within range_m. */
static double count_rho_cells_per_side(double range_m, double cell_m)
{
    return floor(range_m / cell_m) + 1.0;
}

/*
 * Smallest cell of rho, rounded up to three digits, whose number of cells does not exceed
 * RHO_MAX_RHO_CELLS.
 */
static double smallest_rho_cell_m(double range_m)
{
    double cell_m = 2.0 * range_m / (RHO_MAX_RHO_CELLS - 2);
    double digit_m = pow(10.0, floor(log10(cell_m)) - 2.0);

    cell_m = ceil(cell_m / digit_m) * digit_m;
    while (2.0 * count_rho_cells_per_side(range_m, cell_m) > RHO_MAX_RHO_CELLS) {
        cell_m += digit_m;
    }
    return cell_m;
}

void method_widen_cells_to_range(struct parameters *parameters, double range_m)
{
    const double *value = parameters->value;
    const double eps_cells = value[PARAMETER_EPS_RHO_M] / value[PARAMETER_D_RHO_M];

    if (2.0 * count_rho_cells_per_side(range_m, value[PARAMETER_D_RHO_M]) > RHO_MAX_RHO_CELLS) {
        parameters_suggest(parameters, PARAMETER_D_RHO_M, smallest_rho_cell_m(range_m));
        parameters_suggest(parameters, PARAMETER_EPS_RHO_M,
                           eps_cells * smallest_rho_cell_m(range_m));
    }
}

static double must_count_rho_cells_per_side(double range_m, double cell_m)
{
    double cells = count_rho_cells_per_side(range_m, cell_m);

    if (2.0 * cells > RHO_MAX_RHO_CELLS) {
        fail(EXIT_USAGE,
             "plots %.0f m from the origin need %.0f cells of rho at d_rho_m %.9g, and %d is the "
             "limit: d_rho_m %.3g is enough",
             range_m, 2.0 * cells, cell_m, RHO_MAX_RHO_CELLS, smallest_rho_cell_m(range_m));
    }
    return cells;
}

/* Exit 2 where the neighbourhood of +-eps spans more cells than RHO_HOUGH_REACH_MAX. */
static void check_eps_cells(const struct parameters *parameters, enum parameter_id eps,
                            enum parameter_id cell)
{
    if (2.0 * parameters->value[eps] > RHO_HOUGH_REACH_MAX * parameters->value[cell]) {
        fail(EXIT_USAGE, "2 %s is more than %u cells of %s %.9g", parameters_name(eps),
             RHO_HOUGH_REACH_MAX, parameters_name(cell), parameters->value[cell]);
    }
}

struct rho_hough_config method_hough_config(enum method method, const struct parameters *parameters,
                                            double range_m)
{
    const double *value = parameters->value;
    struct rho_hough_config config;

    parameters_check_together(parameters);
    check_eps_cells(parameters, PARAMETER_EPS_RHO_M, PARAMETER_D_RHO_M);
    check_eps_cells(parameters, PARAMETER_EPS_THETA_RAD, PARAMETER_D_THETA_RAD);
    rho_hough_config_default(&config, hough_method_of(method, parameters));
    config.rho_cell_m = (float)value[PARAMETER_D_RHO_M];
    config.rho_max_m =
        (float)must_count_rho_cells_per_side(range_m, value[PARAMETER_D_RHO_M]) * config.rho_cell_m;
    config.theta_cell_rad = (float)value[PARAMETER_D_THETA_RAD];
    config.eps_rho_m = (float)value[PARAMETER_EPS_RHO_M];
    config.eps_theta_rad = (float)value[PARAMETER_EPS_THETA_RAD];
    config.v_min_mps = (float)value[PARAMETER_V_MIN_MPS];
    config.v_max_mps = (float)value[PARAMETER_V_MAX_MPS];
    config.p_false = (float)value[PARAMETER_P_FALSE];
    config.lambda_k = (float)value[PARAMETER_LAMBDA_K];
    config.uses_indeterminacy = value[PARAMETER_NHT_INDETERMINACY] > 0;
    config.votes = value[PARAMETER_VOTE] > 0 ? RHO_VOTES_POINTS : RHO_VOTES_SCANS;
    config.tau = (float)value[PARAMETER_TAU];
    config.votes_min = (float)value[PARAMETER_VOTES_MIN];
    return config;
}

/* margin of the accumulator beyond range_max_m, as with the customary cells */
#define MORE_SHARE 0.28

/*
 * Suggests larger cells of rho where the customary ones do not hold range_max_m plus half the
 * largest distance between passive sensors.
 */
static void suggest_wider_rho_cells(struct parameters *parameters, int rho_cells)
{
    const double range_m = parameters->value[PARAMETER_RANGE_MAX_M];
    const double half_m = range_m + 0.5 * parameters->passive_apart_m;

    if (half_m > 0.5 * rho_cells * parameters->value[PARAMETER_D_RHO_M]) {
        const double cell_m = fmax(half_m, (1 + MORE_SHARE) * range_m) / (0.5 * rho_cells);

        parameters_suggest(parameters, PARAMETER_D_RHO_M, ceil(cell_m / 100.0) * 100.0);
    }
}

/* Exit 2 where parameters do not suit the methods for bearings. */
static void check_bearing_parameters(const struct parameters *parameters)
{
    const double *value = parameters->value;

    parameters_check_together(parameters);
    if (value[PARAMETER_SCANS] < RHO_BATCH_SCANS_MIN) {
        fail(EXIT_USAGE, "scans %.9g are too few for bearings: %u or more", value[PARAMETER_SCANS],
             RHO_BATCH_SCANS_MIN);
    }
    if (value[PARAMETER_RANGE_MAX_M] < 1000 || value[PARAMETER_RANGE_MAX_M] > 500000) {
        fail(EXIT_USAGE, "range_max_m %.9g is outside 1000 .. 500000 m for bearings",
             value[PARAMETER_RANGE_MAX_M]);
    }
}

/* Exit 2 where parameters do not suit the accumulator for bearings. */
static void check_paper_cells(const struct parameters *parameters)
{
    const double *value = parameters->value;
    const int rho_cells = RHO_PAPER_RHO_CELLS, theta_cells = RHO_PAPER_THETA_CELLS;
    double cells = 2.0 * value[PARAMETER_RANGE_MAX_M] / value[PARAMETER_D_RHO_M];

    if (cells > rho_cells) {
        fail(EXIT_USAGE, "range_max_m %.9g needs %.0f cells of d_rho_m %.9g; the limit is %d",
             value[PARAMETER_RANGE_MAX_M], ceil(cells), value[PARAMETER_D_RHO_M], rho_cells);
    }
    if (M_PI / value[PARAMETER_D_THETA_RAD] > theta_cells + 0.5) {
        fail(EXIT_USAGE, "d_theta_rad %.9g needs %.0f cells over half a turn; the limit is %d",
             value[PARAMETER_D_THETA_RAD], ceil(M_PI / value[PARAMETER_D_THETA_RAD]), theta_cells);
    }
}

static enum rho_ghost_rule ghost_rule_of(const struct parameters *parameters)
{
    static const enum rho_ghost_rule rules[3] = {RHO_GHOST_SAFE, RHO_GHOST_LITERAL,
                                                 RHO_GHOST_NO_RULE};

    return rules[(int)parameters->value[PARAMETER_PRUNE]];
}

struct rho_passive_config method_passive_config(const struct parameters *parameters)
{
    struct rho_passive_config config;
    struct rho_settings settings;

    check_bearing_parameters(parameters);
    settings = parameters_to_settings(parameters);
    rho_passive_config_default(&config);
    rho_settings_apply(&settings, NULL, NULL, &config);
    config.scans = (uint16_t)parameters->value[PARAMETER_SCANS];
    return config;
}

struct rho_passive_paper_config method_passive_paper_config(const struct parameters *parameters)
{
    struct parameters fitted = *parameters;
    const double *value = fitted.value;
    struct rho_passive_paper_config config;

    suggest_wider_rho_cells(&fitted, RHO_PAPER_RHO_CELLS);
    check_bearing_parameters(&fitted);
    check_paper_cells(&fitted);
    if (value[PARAMETER_VOTES_MIN] > 255) {
        fail(EXIT_USAGE, "votes_min %.9g is more than 255, the most that passive-paper counts",
             value[PARAMETER_VOTES_MIN]);
    }
    rho_passive_paper_config_default(&config);
    config.scans = (uint16_t)value[PARAMETER_SCANS];
    config.votes_min = (uint16_t)ceil(value[PARAMETER_VOTES_MIN]);
    config.range_max_m = (float)value[PARAMETER_RANGE_MAX_M];
    config.rho_cell_m = (float)value[PARAMETER_D_RHO_M];
    config.theta_cell_rad = (float)value[PARAMETER_D_THETA_RAD];
    config.votes = value[PARAMETER_VOTE] > 0 ? RHO_VOTES_POINTS : RHO_VOTES_SCANS;
    config.rule = ghost_rule_of(parameters);
    return config;
}
