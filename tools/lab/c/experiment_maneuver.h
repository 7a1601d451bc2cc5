/* SPDX-License-Identifier: MIT */
/*
 * experiment_maneuver: targets that pull up to 30 g in clutter, followed by the methods of the
 * paper named in rhotrack/detail/input.h and by the default.
 *
 * The paper gives neither scenarios nor sizes of manoeuvres; the profiles (maneuver_path.h) and 10
 * g are ours, chosen so that the paper's velocity errors come out. References were measured by an
 * independent implementation in double precision, 500 runs a case (200 at 100 clutter plots).
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_MANEUVER_H
#define RHOTRACK_TOOL_EXPERIMENT_MANEUVER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "double_imm.h"
#include "maneuver_path.h"
#include "pipeline/maintainer.h"
#include "rhotrack/types.h"

#define MANEUVER_SCANS 161
#define MANEUVER_INTERVAL_S 0.25
#define MANEUVER_CLEAN_SCANS 3 /* the target alone, and always seen */
#define MANEUVER_JUDGED_SCAN                                                                       \
    8 /* errors count from here on, losses from the end of the clean scans */
#define MANEUVER_CLUTTER_MAX 100

/* ---- scenes ---------------------------------------------------------------------------------- */

/* Acceleration and noise of an interval T in the truth. */
enum maneuver_truth {
    MANEUVER_LITERAL, /* a T in the velocity alone; noise in each element of the state */
    MANEUVER_PHYSICAL /* a T^2 / 2 and a T; noise is acceleration */
};

enum maneuver_sensor {
    MANEUVER_PLACES,     /* x, y, z */
    MANEUVER_VELOCITIES, /* and vx, vy, vz */
    MANEUVER_POLAR,      /* range, azimuth; the target flies level at height 0 */
    MANEUVER_POLAR_3D    /* and elevation */
};

/*
 * Where the beam looks: at the truth, or where the tracker says, and a target outside is not seen.
 */
enum maneuver_beam { MANEUVER_AT_TRUTH, MANEUVER_AT_PREDICTION, MANEUVER_ALL_ROUND };

struct maneuver_setting {
    enum maneuver_profile profile;
    double pull_g;
    enum maneuver_truth truth;
    double
        /* literal: variance of each element; physical: sd of an axis, m/s^2; each interval */
        noise;
    enum maneuver_sensor sensor;
    double sigma_m, sigma_mps; /* of places, velocities; polar: of ranges, -- */
    double sigma_rad;          /* polar: of azimuth and elevation */
    unsigned clutter;          /* plots in the beam */
    double pd;
    enum maneuver_beam beam;
    double accel_max_g; /* what the tracker is told */
};

int64_t maneuver_time_us(size_t scan);
unsigned maneuver_axes(const struct maneuver_setting *setting); /* 2 or 3 */
uint32_t maneuver_measures(const struct maneuver_setting *setting);

/* What chance draws whatever the tracker does. */
struct maneuver_scene {
    const struct maneuver_setting *of;
    uint64_t seed, stream, run;           /* of the clutter's generators: one a scan */
    double truth[MANEUVER_SCANS][6];      /* place, velocity */
    double input_mps2[MANEUVER_SCANS][3]; /* from this scan to the next */
    double radius_m[MANEUVER_SCANS]; /* of the beam at the target's range: half of 1.2 degrees */
    double measured[MANEUVER_SCANS][6];
    bool is_seen[MANEUVER_SCANS]; /* where the beam looks at it */
};

void maneuver_scene_draw(struct maneuver_scene *scene, const struct maneuver_setting *of,
                         uint64_t seed, uint64_t stream, uint64_t run);

/*
 * The target is within the beam around a place; always where the beam looks at the truth or
 * everywhere, or in the clean scans.
 */
bool maneuver_is_in_beam(const struct maneuver_scene *scene, size_t scan, const double centre_m[3]);

/* One scan with its plots, the target's at a random row. */
struct maneuver_look {
    struct rho_scan scan;
    struct rho_plot plots[MANEUVER_CLUTTER_MAX + 1];
    int target_row; /* -1: not seen */
};

/*
 * Clutter lies uniformly within the beam around centre_m. A radar that measures velocities gives it
 * the one that would have brought it from previous_m in an interval.
 */
void maneuver_look_fill(struct maneuver_look *look, const struct maneuver_scene *scene, size_t scan,
                        const double centre_m[3], const double previous_m[3]);

/* The target's plot alone. */
struct rho_plot maneuver_plot(const struct maneuver_scene *scene, size_t scan);

/* ln of the clutter's density in all that a scan measures; 0.1 plots where there is none. */
double maneuver_log_density(const struct maneuver_scene *scene, size_t scan);

/* What was measured, with its true covariance. */
struct double_measured maneuver_measured(const struct maneuver_scene *scene, size_t scan);

/* ---- methods --------------------------------------------------------------------------------- */

enum maneuver_kind {
    MANEUVER_LIBRARY,
    MANEUVER_CLAIRVOYANT, /* knows which plot is the target's, and the input */
    MANEUVER_TRUE_IMM     /* knows which plot is the target's */
};

struct maneuver_method {
    const char *name;
    enum maneuver_kind kind;
    enum maintainer_gate gate;
    bool has_input_estimation;
    bool has_physical_input;
    double gamma;
    double filter_noise; /* sd of each element an interval: root of the paper's Q */
    double assumed_pd;   /* 0: the true one, 0.995 at most */
};

/* What a method made of a scene, scan by scan. */
struct maneuver_trace {
    double off_m[MANEUVER_SCANS][3], off_mps[MANEUVER_SCANS][3]; /* estimate minus truth */
    double used_m[MANEUVER_SCANS][3]; /* place of the plot that was taken; NAN: none */
    bool is_wrong[MANEUVER_SCANS];    /* clutter was taken */
    double nis[MANEUVER_SCANS];       /* of the target's plot, over its dimensions; NAN: not seen */
    double hypotheses[MANEUVER_SCANS];
    unsigned long refused;
};

void maneuver_follow(struct maneuver_trace *trace, const struct maneuver_scene *scene,
                     const struct maneuver_method *method);

/* The same in figures. */
struct maneuver_outcome {
    bool is_inside; /* every axis, within the beam's radius */
    bool is_lost;   /* 3-D error beyond it, at any time */
    double most_off_m;
    double least_mps, most_mps;    /* extreme errors of velocity */
    double square_m2, square_mps2; /* mean square errors */
    double nis_sum;
    unsigned nis_count, wrong, scans; /* scans: in which a wrong plot can be taken */
    double hypotheses;                /* mean */
    unsigned long refused;
};
struct maneuver_outcome maneuver_outcome_of(const struct maneuver_trace *trace,
                                            const struct maneuver_scene *scene);

/* ---- cases ----------------------------------------------------------------------------------- */

#define MANEUVER_METHODS_MAX 12

/* Of the default; NAN: none. */
struct maneuver_bars {
    double lost_max,
        ratio_max; /* share of the runs; rms error over that of the IMM that knows the plots */
    bool has_nis;
};

/* Scenes, and the methods that all follow each of them. */
struct maneuver_case {
    const char *name;
    struct maneuver_setting setting;
    const struct maneuver_method *methods;
    size_t num_methods;
    size_t runs; /* customary */
    struct maneuver_bars bars;
};

/* The paper's: profiles x clutter, the methods of maneuver_paper_method. */
enum maneuver_paper_method {
    MANEUVER_I, /* input estimation without forgetting, as printed; velocities in the Hough gate */
    MANEUVER_I_FORGETS, /* gamma .5 */
    MANEUVER_II,        /* no input estimation */
    MANEUVER_III,       /* a plot at random */
    MANEUVER_NEAREST,   /* and gamma .5 */
    MANEUVER_KNOWS_ALL, /* plot and input */
    MANEUVER_DEFAULT,
    MANEUVER_PAPER_METHODS
};
extern const struct maneuver_case maneuver_paper_cases[];
extern const size_t maneuver_num_paper_cases;

/* What was measured elsewhere; NAN: not. */
struct maneuver_reference {
    double inside, wrong, most_off_m, rms_m;
};
extern const struct maneuver_reference maneuver_paper_references[][MANEUVER_PAPER_METHODS];

/*
 * The filter's Q; for each of MANEUVER_NOISES four methods: II, I with gamma 1, .7, .5. One case.
 */
#define MANEUVER_NOISES 3
#define MANEUVER_NOISE_METHODS 4
extern const double maneuver_noises[MANEUVER_NOISES]; /* Q over I */
extern const struct maneuver_case maneuver_noise_case;
extern const struct maneuver_reference
    maneuver_noise_references[MANEUVER_NOISES * MANEUVER_NOISE_METHODS];

/* The beam follows the prediction. */
enum maneuver_closed_method {
    MANEUVER_CLOSED_DEFAULT,
    MANEUVER_CLOSED_IMM, /* knows the plots */
    MANEUVER_CLOSED_ALL, /* knows plots and input */
    MANEUVER_CLOSED_PAPER,
    MANEUVER_CLOSED_NEAREST,
    MANEUVER_CLOSED_METHODS
};
extern const struct maneuver_case maneuver_closed_cases[];
extern const size_t maneuver_num_closed_cases;

/* Shares of lost runs. */
struct maneuver_lost_reference {
    double by_default, by_paper;
};
extern const struct maneuver_lost_reference maneuver_lost_references[];

/* The default told another P_D than the true 0.9. One case. */
#define MANEUVER_PDS 5
extern const struct maneuver_case maneuver_pd_case;
extern const double maneuver_pd_references[MANEUVER_PDS]; /* shares of lost runs */

#endif
