/* SPDX-License-Identifier: MIT */
/* bodies: targets of several plots a scan. Private to src/bodies and src/step. */
#ifndef RHOTRACK_BODIES_H
#define RHOTRACK_BODIES_H

#include "../tracker/plots.h"
#include "../tracker/step.h"

/* In struct rho_groups: a row that stands for no plot, no group or no track. */
#define RHO_NO_ROW UINT16_MAX

/* plot_groups.c (RHO_BODIES): replaces the step's scan by `grouped`, a plot for each group */
void rho_bodies_group(struct step *step);
/* Before the report: restores the scan, and turns fates and rows of groups into those of plots. */
void rho_bodies_ungroup(struct rho_tracker *tracker, struct rho_look *look,
                        const struct rho_scan *scan);
/* body_extents.c (RHO_BODIES): puts the bodies in the order of the tracks, with new ones added */
void rho_bodies_align(struct rho_tracker *tracker);
/* Updates each track's body with the plots of its group, before rho_bodies_ungroup. */
void rho_bodies_update(struct rho_tracker *tracker, const struct rho_look *look,
                       const struct rho_scan *scan);

/* outline.c: where a look's plots of a body are expected */
struct body_outline {
    float place_m[2], velocity_mps[3]; /* of its centre, at the track's time */
    float ahead_s;                     /* to the look's time; 0 before the update: predicted */
    float velocity_m2ps2[3];           /* covariance of the velocity: xx, yx, yy */
    float cos_heading, sin_heading;
    float along_m2, across_m2; /* variances of a place on the body */
    float error_m2[3];         /* covariance of the predicted place: along, cross, across */
    float plots;               /* mean number of plots a look */
    float rates_m2ps2;         /* variance of range rates by limbs, or by two velocities */
};
/* Width of the widest body of a length: people are round. */
float rho_bodies_widest_m(float longest_m, float length_m);
/* That of a track's body of a length, whose heading may be off; the longest's length at most. */
float rho_bodies_width_most_m(const struct rho_tracker *tracker, unsigned row, float length_m);
/* The most that a target moves between a look's time and one of its plots, if this fast. */
float rho_bodies_moved_m(const struct rho_look *look, const float velocity_mps[2]);
struct body_outline rho_bodies_outline_track(const struct rho_look *look, unsigned row);
/* One body in place of two tracks' outlines, in the axes of the first, as the longest at most. */
struct body_outline rho_bodies_join_outlines(const struct rho_look *look, unsigned row,
                                             unsigned other_row, const struct body_outline *of,
                                             const struct body_outline *of_other);
/* A plot relative to an outline's centre, at the plot's time. */
struct outline_fit {
    float dx_m, dy_m, along_m, across_m; /* distance in x and y, and along and across the body */
    float noise_m2[3];                   /* covariance of the place: along, cross, across */
    int has_rate;                        /* 1: a range rate was measured; else what follows is 0 */
    float rate_mps;                      /* less that of a target there with the velocity */
    float rate_m2ps2;                    /* variance by the noise of rate and azimuth, by limbs */
    float line_turn_m2ps2; /* the azimuth's part of it: its error turns the line of sight */
    float sight_line[2];   /* unit vector from the sensor to the plot, x and y */
    float track_m2ps2;     /* by rho_bodies_fit_plot: of the outline's velocity along it */
};
/* Fits a plot, whose noise is its own. A plot at the sensor has no range rate. */
void rho_bodies_see_plot(const struct rho_look *look, const struct body_outline *outline,
                         const struct rho_plot *plot, struct outline_fit *fit);
/* The same, with the noise of outline and plot: of the place, and of the body's width. */
void rho_bodies_fit_plot(const struct rho_look *look, const struct body_outline *outline,
                         const struct rho_plot *plot, struct outline_fit *fit);
/* Variance of such a fit's range rate, where a turn of the body spreads the rates of its places. */
float rho_bodies_rate_variance(const struct outline_fit *fit, float turn_radps);
/* Density of a plot's place and range rate by an outline, times its number of plots. */
float rho_bodies_density(const struct rho_look *look, const struct body_outline *outline,
                         const struct rho_plot *plot);

/* The first plot, from this one of a group on, that no other track contends for; or RHO_NO_ROW. */
static inline unsigned rho_bodies_next_own_plot(const struct rho_groups *groups, unsigned plot)
{
    while (plot != RHO_NO_ROW && groups->contender[plot] != RHO_NO_ROW) {
        plot = groups->next[plot];
    }
    return plot;
}

/* body_split_evidence.c: reasons for which a body is taken to be two targets */
enum rho_body_split {
    RHO_BODY_ONE, /* no reason: one target */
    RHO_BODY_TOO_WIDE,
    RHO_BODY_TOO_LONG,
    RHO_BODY_MOVES_APART /* range rates differ from part to part by more than a turn explains */
};
/*
 * Sums of products of deviations from a look's mean: of the place along the line of sight (far),
 * across it (side), of the range rate; then of their variances by noise and by errors of velocity
 * and azimuths; of plots less one.
 */
enum { BODY_FAR, BODY_SIDE, BODY_RATE }; /* rows of the products: RHO_AT(BODY_SIDE, BODY_FAR) */
enum { BODY_SIDE_NOISE = 6, BODY_RATE_NOISE, BODY_RATE_UNKNOWN, BODY_PLOTS_BEYOND_ONE };
/* Sums over a look's plots of one track alone, which are 0 at first. */
struct body_sums {
    float n, values[3], of[RHO_BODY_SUMS]; /* plots; far, side, rate; products without the mean */
    float first_m, last_m, noise_m2; /* along the body: extreme places, largest plot variance */
};
void rho_bodies_sum_plot(struct body_sums *sums, const struct rho_plot *plot,
                         const struct outline_fit *at);
/* Adds them to the evidence that the track's body is two targets. */
void rho_bodies_add_doubt(struct rho_tracker *tracker, const struct rho_look *look,
                          const struct body_sums *sums, unsigned row);
/* Variance of a body's range rates, by that evidence, that no turn or error explains: by limbs. */
float rho_bodies_limbs_m2ps2(const struct rho_body_filter *body);
/* The reason, by that evidence, for which a track's body is two targets; or RHO_BODY_ONE. */
enum rho_body_split rho_bodies_split_reason(const struct rho_tracker *tracker, unsigned row);
/* True of a live track in view within RHO_BODY_TRACKS: plots may be grouped for it. */
static inline int rho_bodies_may_own(const struct rho_look *look, unsigned row)
{
    return RHO_BODIES && row < RHO_BODY_TRACKS &&
           look->tracker->tracks[row].status != RHO_TRACK_FREE && rho_look_has_in_view(look, row);
}
/* body_extents.c: begins the body of a track anew, of unknown extent */
void rho_bodies_begin(struct rho_tracker *tracker, unsigned row);
/* Prior variance of a place on a body, on each axis. */
float rho_bodies_prior_m2(const struct rho_tracker *tracker);
/* True once the body's first heading and the track's first velocity are corrected. */
int rho_bodies_is_settled(const struct rho_tracker *tracker, unsigned row);

/* sudden_turns.c: a body that turns at once keeps its plots; its velocity becomes uncertain */
void rho_bodies_follow_turns(struct step *step);
/* The most, on an axis, by which a turn changes the velocity of a target. */
float rho_bodies_turn_most_mps(const struct rho_tracker *tracker);

/* duplicate_tracks.c: leaves one of two tracks of one target, with the plots of both */
void rho_bodies_end_duplicates(struct step *step);

#endif
