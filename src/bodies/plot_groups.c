/* SPDX-License-Identifier: MIT */
/*
 * plot_groups: joins the plots of a scan that one extended target can have given into one plot,
 * from before the claims to the report.
 *
 * A step replaces the scan by one of the groups, in the order of their first plots, so that the
 * group of a plot never has a higher row than the plot. At the end of the step rows and fates are
 * turned into those of the plots again.
 */
#include "../tracker/clutter.h"
#include "../tracker/sensors.h"
#include "../tracker/step.h"
#include "bodies.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/body_extent_filter.h"
#include "rhotrack/detail/measurement.h"

/* Largest distance of a plot from its track, standard deviations on each axis of the body. */
#define GATE_SIGMAS 3.0f
/*
 * Range rates of one target differ by noise up to RATE_SIGMAS, and by its turn: its largest rate at
 * a track's plot, its sigma between plots of no track, and its sigma in the misfit.
 */
#define RATE_SIGMAS 4.0f
#define TURN_RADPS 0.3f
#define TURN_USUAL_RADPS 0.1f
#define TURN_MISFIT_RADPS 0.3f
/* Root mean square distance of two random places on a body, over its length. */
#define APART_SHARE 0.41f
/* Sigmas of two plots by which they may be farther apart than the longest body. */
#define APART_SIGMAS 2.0f
/* Difference of misfits below which the body that explains a plot second best contends for it. */
#define CONTESTED_MISFIT 6.0f
/* Units of work: a plot compared with a body; with another plot; a plot passed over. */
#define TEST_UNITS 6u
#define PAIR_UNITS 2u
#define PASS_UNITS 1u

static float longest_body_m(const struct rho_tracker *tracker)
{
    return tracker->bodies.length_max_m;
}

/* ---- pairs of plots -------------------------------------------------------------------------- */

/*
 * True where one target may have both plots' range rates. Those of a rigid body differ only across
 * the line of sight, by its turn and by its unknown speed across the line of sight.
 */
static int have_range_rates_of_one_body(const struct rho_look *look, const struct rho_plot *one,
                                        const struct rho_plot *other)
{
    if (!(look->scan->measures & RHO_MEASURES_RANGE_RATE)) {
        return 1;
    }
    const float x_m = one->x_m - (look->sensor ? look->sensor->x_m : 0.0f),
                y_m = one->y_m - (look->sensor ? look->sensor->y_m : 0.0f);
    const float dx_m = other->x_m - one->x_m, dy_m = other->y_m - one->y_m;
    const float range_m = rho_sqrt(x_m * x_m + y_m * y_m) + 1e-3f;
    const float side_m = (x_m * dy_m - y_m * dx_m) / range_m;
    const float most_m =
        rho_smaller((side_m < 0.0f ? -side_m : side_m) + one->sigma_cross_m + other->sigma_cross_m,
                    APART_SHARE * longest_body_m(look->tracker));
    const float across_radps = look->tracker->config.v_max_mps / (3.0f * range_m);
    const float off_mps =
        rho_measurement_innovation_mps(look->sensor, one->range_rate_mps, other->range_rate_mps);
    const float variance =
        one->sigma_range_rate_mps * one->sigma_range_rate_mps +
        other->sigma_range_rate_mps * other->sigma_range_rate_mps +
        (TURN_USUAL_RADPS * TURN_USUAL_RADPS + across_radps * across_radps) * most_m * most_m;
    return off_mps * off_mps <= RATE_SIGMAS * RATE_SIGMAS * variance;
}

/* True where one target can have given both plots, by distance and range rates. */
static int may_be_plots_of_one_body(const struct rho_look *look, struct rho_work *work,
                                    uint32_t one, uint32_t other)
{
    const struct rho_plot *a = &look->scan->plots[one], *b = &look->scan->plots[other];
    const float dx_m = a->x_m - b->x_m, dy_m = a->y_m - b->y_m;
    const float most_m =
        longest_body_m(look->tracker) + APART_SIGMAS * (rho_plot_sigma_m(a) + rho_plot_sigma_m(b));
    rho_work_spend(work, PAIR_UNITS);
    return dx_m * dx_m + dy_m * dy_m <= most_m * most_m && have_range_rates_of_one_body(look, a, b);
}

/* ---- a track's body -------------------------------------------------------------------------- */

/* Body of a track, predicted to the scan's time. */
struct predicted_body {
    const struct rho_body_filter *body;
    const struct rho_track *track;
    float place_m2[3]; /* variances of place by body and prediction: along, cross, across */
    float rate_sigma_mps;
};

static struct predicted_body body_outline_and_place_variances(const struct rho_tracker *tracker,
                                                              unsigned row)
{
    const struct rho_track *track = &tracker->tracks[row];
    const float *p = track->kalman.covariance;
    const float place_m2[3] = {p[RHO_AT(0, 0)], p[RHO_AT(0, 1)], p[RHO_AT(1, 1)]};
    struct predicted_body outline = {.body = &tracker->bodies.of[row],
                                     .track = track,
                                     .rate_sigma_mps = rho_track_sigma_mps(track)};
    rho_body_rotate_covariance(outline.body, place_m2, outline.place_m2);
    /* the square of a half length is 3 times the variance of a place on the body */
    const float turned = outline.body->has_heading ? 3.0f * outline.body->heading_sigma_rad *
                                                         outline.body->heading_sigma_rad
                                                   : 0.0f;
    outline.place_m2[0] += rho_body_along_bound_m2(outline.body) + turned * outline.body->across_m2;
    outline.place_m2[2] += outline.body->across_m2 + turned * outline.body->along_m2;
    return outline;
}

/* Distance that a track moves between the scan's time and that of the plot farthest from it. */
static float distance_moved_in_largest_plot_offset_m(const struct rho_look *look,
                                                     const struct predicted_body *outline)
{
    const float vx_mps = outline->track->kalman.state[RHO_VX],
                vy_mps = outline->track->kalman.state[RHO_VY];
    return look->offset_max_s * rho_sqrt(vx_mps * vx_mps + vy_mps * vy_mps);
}

/* Half side of a square about the track that holds the gate of its body in any direction. */
static float half_search_box_m(const struct rho_look *look, const struct predicted_body *outline)
{
    const float noise_m2 = look->sigma_max_m * look->sigma_max_m;
    return 1.5f * GATE_SIGMAS *
               rho_sqrt(rho_larger(outline->place_m2[0], outline->place_m2[2]) + noise_m2) +
           distance_moved_in_largest_plot_offset_m(look, outline);
}

/*
 * True where a plot's range rate, if measured, agrees with the track's velocity and a turn of the
 * body. Adds to the misfit -2 ln of the likelihood of the range rate.
 */
static int range_rate_agrees_add_misfit(const struct rho_look *look,
                                        const struct predicted_body *outline,
                                        const struct rho_plot *plot, float apart_m, float *misfit)
{
    struct range_rate_residual rate;
    if (!rho_bodies_rate_residual(look, look->scan, outline->track, plot, &rate)) {
        return 1;
    }
    const float slack_mps =
        RATE_SIGMAS * (outline->rate_sigma_mps + rho_sqrt(rate.variance_m2ps2)) +
        TURN_RADPS * apart_m;
    const float turn_mps = TURN_MISFIT_RADPS * apart_m;
    const float variance = outline->rate_sigma_mps * outline->rate_sigma_mps + rate.variance_m2ps2 +
                           turn_mps * turn_mps;
    *misfit += rate.mps * rate.mps / variance + rho_log(variance);
    return rate.mps <= slack_mps && rate.mps >= -slack_mps;
}

/* Returns 1 where a plot is in the gate of a body. *misfit: -2 ln of the plot's likelihood. */
static int body_explains_plot(const struct rho_look *look, const struct predicted_body *outline,
                              const struct rho_plot *plot, float *misfit)
{
    float axes[3];
    const float after_s = (float)plot->offset_us * 1e-6f, *state = outline->track->kalman.state;
    const float c = outline->body->cos_heading, s = outline->body->sin_heading;
    const float dx_m = plot->x_m - state[0] - after_s * state[3],
                dy_m = plot->y_m - state[1] - after_s * state[4];
    const float along_m = c * dx_m + s * dy_m, across_m = c * dy_m - s * dx_m;
    rho_bodies_noise_axes(look, outline->body, plot, axes);
    const float along_m2 = outline->place_m2[0] + axes[0],
                across_m2 = outline->place_m2[2] + axes[2];
    const float far = along_m * along_m / along_m2, wide = across_m * across_m / across_m2;
    *misfit = far + wide + rho_log(along_m2) + rho_log(across_m2);
    return far <= GATE_SIGMAS * GATE_SIGMAS && wide <= GATE_SIGMAS * GATE_SIGMAS &&
           range_rate_agrees_add_misfit(look, outline, plot, rho_sqrt(dx_m * dx_m + dy_m * dy_m),
                                        misfit);
}

/* Plots in a square of the given half side about the track's place. */
static struct plots_near plots_near_body(const struct rho_tracker *tracker,
                                         const struct predicted_body *outline, float half_m)
{
    const float *state = outline->track->kalman.state;
    return rho_plots_near(tracker, state[0] - half_m, state[0] + half_m, state[1] - half_m,
                          state[1] + half_m);
}

/* Gives the plot to this track if its body explains it better than that of the present owner. */
static void assign_plot_to_better_body(struct rho_groups *groups, unsigned row, uint32_t plot,
                                       float misfit)
{
    const unsigned owner = groups->owner[plot];
    const float better = groups->misfit[plot] - misfit;
    if (owner != RHO_NO_ROW && better <= 0.0f) {
        if (-better < CONTESTED_MISFIT) {
            groups->contender[plot] = (uint16_t)row;
        }
        return;
    }
    groups->contender[plot] =
        owner != RHO_NO_ROW && better < CONTESTED_MISFIT ? (uint16_t)owner : RHO_NO_ROW;
    groups->owner[plot] = (uint16_t)row;
    groups->misfit[plot] = misfit;
}

/* Gives each plot to the track whose body explains it best, then ends tracks of one target. */
static void find_owners_of_plots_and_end_duplicates(struct step *step)
{
    struct rho_groups *groups = &step->tracker->bodies.groups;
    float misfit;
    for (unsigned row = 0; row < step->tracker->num_tracks; row++) {
        if (!rho_bodies_may_own(&step->look, row)) {
            continue;
        }
        const struct predicted_body outline = body_outline_and_place_variances(step->tracker, row);
        struct plots_near near =
            plots_near_body(step->tracker, &outline, half_search_box_m(&step->look, &outline));
        for (uint32_t i;
             !rho_work_is_spent(&step->work) && rho_plots_next(&step->look, &near, &i);) {
            const struct rho_plot *plot = &step->look.scan->plots[i];
            if (step->report->fates[i] != RHO_FATE_HELD || !rho_plots_is_within(&near, plot)) {
                continue;
            }
            rho_work_spend(&step->work, TEST_UNITS);
            if (body_explains_plot(&step->look, &outline, plot, &misfit)) {
                assign_plot_to_better_body(groups, row, i, misfit);
            }
        }
    }
    rho_bodies_end_duplicates(step);
}

/* ---- groups ---------------------------------------------------------------------------------- */

static void begin_group(struct rho_groups *groups, uint32_t plot)
{
    const unsigned group = groups->count++;
    groups->first[group] = (uint16_t)plot;
    groups->last[group] = (uint16_t)plot;
    groups->of[plot] = (uint16_t)group;
}

static void add_plot_to_group(struct rho_groups *groups, unsigned group, uint32_t plot)
{
    groups->next[groups->last[group]] = (uint16_t)plot;
    groups->last[group] = (uint16_t)plot;
    groups->of[plot] = (uint16_t)group;
}

static int fits_all_in_group(const struct rho_look *look, struct rho_work *work, unsigned group,
                             uint32_t plot)
{
    const struct rho_groups *groups = &look->tracker->bodies.groups;
    for (unsigned i = groups->first[group]; i != RHO_NO_ROW; i = groups->next[i]) {
        if (!may_be_plots_of_one_body(look, work, i, plot)) {
            return 0;
        }
    }
    return 1;
}

/*
 * Adds plots of no track that may be of one target with all plots of the group. Plots in excluded
 * areas stay alone, as they start no track.
 */
static void add_plots_that_fit_all_in_group(struct rho_tracker *tracker,
                                            const struct rho_look *look, struct rho_work *work,
                                            unsigned group)
{
    struct rho_groups *groups = &tracker->bodies.groups;
    const struct rho_plot *plot = &look->scan->plots[groups->first[group]];
    const float most_m = longest_body_m(tracker) + 2.0f * APART_SIGMAS * look->sigma_max_m;
    struct plots_near near = rho_plots_near(tracker, plot->x_m - most_m, plot->x_m + most_m,
                                            plot->y_m - most_m, plot->y_m + most_m);
    for (uint32_t i; !rho_work_is_spent(work) && rho_plots_next(look, &near, &i);) {
        rho_work_spend(work, PASS_UNITS);
        if (look->fates[i] == RHO_FATE_HELD && groups->of[i] == RHO_NO_ROW &&
            groups->owner[i] == RHO_NO_ROW && !rho_areas_exclude(look, i) &&
            fits_all_in_group(look, work, group, i)) {
            add_plot_to_group(groups, group, i);
        }
    }
}

/* Forms the groups, in the order of their first plots: one for each track, the others by place. */
static void form_plot_groups(struct rho_tracker *tracker, const struct rho_look *look,
                             struct rho_work *work)
{
    struct rho_groups *groups = &tracker->bodies.groups;
    uint16_t of_track[RHO_BODY_TRACKS];
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        of_track[row] = RHO_NO_ROW;
    }
    for (uint32_t i = 0; i < look->num_gated; i++) {
        const unsigned owner = groups->owner[i];
        if (groups->of[i] != RHO_NO_ROW) {
            continue;
        }
        if (owner != RHO_NO_ROW && of_track[owner] != RHO_NO_ROW) {
            add_plot_to_group(groups, of_track[owner], i);
            continue;
        }
        begin_group(groups, i);
        if (owner != RHO_NO_ROW) {
            of_track[owner] = groups->of[i];
        } else if (look->fates[i] == RHO_FATE_HELD && !rho_areas_exclude(look, i)) {
            add_plots_that_fit_all_in_group(tracker, look, work, groups->of[i]);
        }
    }
}

/* ---- a group as one plot --------------------------------------------------------------------- */

/* Sum over a group's plots of the squared difference of range rates from the mean. */
static float sum_of_squared_rate_errors(const struct rho_look *look, unsigned group,
                                        const struct rho_plot *mean)
{
    const struct rho_groups *groups = &look->tracker->bodies.groups;
    float sum = 0.0f;
    for (unsigned i = groups->first[group]; i != RHO_NO_ROW; i = groups->next[i]) {
        const float off_mps = rho_measurement_innovation_mps(
            look->sensor, look->scan->plots[i].range_rate_mps, mean->range_rate_mps);
        sum += off_mps * off_mps;
    }
    return sum;
}

/* Mean of a group's plots, by differences from the first: sums of coordinates would be rounded. */
static struct rho_plot mean_plot_of_group(const struct rho_look *look, unsigned group,
                                          unsigned *count)
{
    const struct rho_groups *groups = &look->tracker->bodies.groups;
    const struct rho_plot *first = &look->scan->plots[groups->first[group]];
    struct rho_plot mean = *first, sum = {0};
    float n = 0.0f, offset_us = 0.0f;
    *count = 0;
    for (unsigned i = groups->first[group]; i != RHO_NO_ROW; i = groups->next[i]) {
        const struct rho_plot *plot = &look->scan->plots[i];
        offset_us += (float)(plot->offset_us - first->offset_us);
        sum.x_m += plot->x_m - first->x_m;
        sum.y_m += plot->y_m - first->y_m;
        sum.z_m += plot->z_m - first->z_m;
        sum.vx_mps += plot->vx_mps - first->vx_mps;
        sum.vy_mps += plot->vy_mps - first->vy_mps;
        sum.vz_mps += plot->vz_mps - first->vz_mps;
        sum.range_rate_mps += rho_measurement_innovation_mps(look->sensor, plot->range_rate_mps,
                                                             first->range_rate_mps);
        n += 1.0f;
        ++*count;
    }
    mean.offset_us += (int32_t)(offset_us / n);
    mean.x_m += sum.x_m / n;
    mean.y_m += sum.y_m / n;
    mean.z_m += sum.z_m / n;
    mean.vx_mps += sum.vx_mps / n;
    mean.vy_mps += sum.vy_mps / n;
    mean.vz_mps += sum.vz_mps / n;
    mean.range_rate_mps += sum.range_rate_mps / n;
    return mean;
}

/*
 * n times the variance of the mean of n plots by their random places on the body: xx, yx, yy. With
 * a track it is the share of the variance of a place that n plots leave; without, it is the spread
 * of the plots, with the prior as one plot more.
 */
static void place_on_body_variance_of_group_mean(const struct rho_look *look, unsigned group,
                                                 const struct rho_plot *mean, unsigned count,
                                                 float xx_yx_yy[3])
{
    const struct rho_bodies *bodies = &look->tracker->bodies;
    const struct rho_groups *groups = &bodies->groups;
    const unsigned owner = groups->owner[groups->first[group]];
    if (owner != RHO_NO_ROW) {
        const float share = bodies->of[owner].plots < RHO_BODY_NEW_PLOTS
                                ? 1.0f
                                : rho_body_mean_variance_share(&bodies->of[owner], count);
        rho_body_place_covariance(&bodies->of[owner], xx_yx_yy);
        for (int i = 0; i < 3; i++) {
            xx_yx_yy[i] *= share;
        }
        return;
    }
    xx_yx_yy[0] = xx_yx_yy[2] = rho_bodies_prior_m2(look->tracker);
    xx_yx_yy[1] = 0.0f;
    for (unsigned i = groups->first[group]; i != RHO_NO_ROW; i = groups->next[i]) {
        const float dx_m = look->scan->plots[i].x_m - mean->x_m,
                    dy_m = look->scan->plots[i].y_m - mean->y_m;
        xx_yx_yy[0] += dx_m * dx_m;
        xx_yx_yy[1] += dx_m * dy_m;
        xx_yx_yy[2] += dy_m * dy_m;
    }
    for (int i = 0; i < 3; i++) {
        xx_yx_yy[i] /= (float)count;
    }
}

static float sigma_within_limits(float sigma)
{
    sigma = rho_larger(sigma, RHO_LIMIT_SIGMA_MIN);
    return sigma < RHO_LIMIT_SIGMA_MAX ? sigma : RHO_LIMIT_SIGMA_MAX;
}

/* Makes one plot of a group: the mean, with the noise of the plots and of places on the body. */
static void make_group_plot(const struct rho_look *look, unsigned group, struct rho_plot *out)
{
    struct rho_measurement seen;
    float spread[3];
    unsigned count;
    *out = mean_plot_of_group(look, group, &count);
    if (look->fates[look->tracker->bodies.groups.first[group]] != RHO_FATE_HELD) {
        return;
    }
    const float n = (float)count;
    place_on_body_variance_of_group_mean(look, group, out, count, spread);
    rho_measurement_from_plot(out, 0, look->sensor, &seen);
    const float c = seen.cos_azimuth, s = seen.sin_azimuth;
    const float along_m2 = c * c * spread[0] + 2.0f * c * s * spread[1] + s * s * spread[2];
    const float across_m2 = s * s * spread[0] - 2.0f * c * s * spread[1] + c * c * spread[2];
    out->sigma_range_m =
        sigma_within_limits(rho_sqrt((out->sigma_range_m * out->sigma_range_m + along_m2) / n));
    out->sigma_cross_m =
        sigma_within_limits(rho_sqrt((out->sigma_cross_m * out->sigma_cross_m + across_m2) / n));
    if (look->scan->measures & RHO_MEASURES_RANGE_RATE) {
        out->sigma_range_rate_mps =
            sigma_within_limits(rho_sqrt((out->sigma_range_rate_mps * out->sigma_range_rate_mps +
                                          sum_of_squared_rate_errors(look, group, out) / n) /
                                         n));
    }
}

/* ---- the scan -------------------------------------------------------------------------------- */

/*
 * Clears the groups; fates are HELD for valid plots and INVALID for others. Finds the largest noise
 * and time offset of the valid plots.
 */
static void clear_groups_set_fates_find_largest_noise(struct rho_tracker *tracker,
                                                      struct rho_look *look)
{
    struct rho_groups *groups = &tracker->bodies.groups;
    groups->count = 0;
    look->sigma_max_m = look->offset_max_s = 0.0f;
    for (uint32_t i = 0; i < look->num_gated; i++) {
        const struct rho_plot *plot = &look->scan->plots[i];
        const float offset_s = (float)plot->offset_us * 1e-6f;
        const int is_valid = rho_measurement_is_valid_plot(plot, look->scan->measures);
        groups->of[i] = groups->next[i] = groups->owner[i] = RHO_NO_ROW;
        groups->contender[i] = RHO_NO_ROW;
        look->fates[i] = (uint8_t)(is_valid ? RHO_FATE_HELD : RHO_FATE_INVALID);
        if (is_valid) {
            look->sigma_max_m = rho_larger(look->sigma_max_m, rho_plot_sigma_m(plot));
            look->offset_max_s =
                rho_larger(look->offset_max_s, offset_s < 0.0f ? -offset_s : offset_s);
        }
    }
}

void rho_bodies_group(struct step *step)
{
    struct rho_scan *grouped = &step->grouped;
    step->whole = step->look.scan;
    struct rho_groups *groups = &step->tracker->bodies.groups;
    rho_bodies_align(step->tracker);
    clear_groups_set_fates_find_largest_noise(step->tracker, &step->look);
    rho_plots_index(step->tracker, &step->look);
    rho_work_begin_phase(step->tracker, &step->work, RHO_WORK_GROUPS_SHARE);
    find_owners_of_plots_and_end_duplicates(step);
    form_plot_groups(step->tracker, &step->look, &step->work);
    step->work.is_partial |= rho_work_is_spent(&step->work);
    for (unsigned group = 0; group < groups->count; group++) {
        make_group_plot(&step->look, group, &groups->plots[group]);
    }
    *grouped = *step->look.scan;
    grouped->plots = groups->plots;
    grouped->num_plots = groups->count;
    step->look.scan = grouped;
    step->look.num_inputs = step->look.num_gated = groups->count;
    step->look.sigma_max_m = step->look.offset_max_s = 0.0f;
}

void rho_bodies_ungroup(struct rho_tracker *tracker, struct rho_look *look,
                        const struct rho_scan *scan)
{
    const struct rho_groups *groups = &tracker->bodies.groups;
    look->scan = scan;
    look->num_inputs = scan->num_plots;
    look->num_gated = look->num_inputs < RHO_MAX_PLOTS ? look->num_inputs : RHO_MAX_PLOTS;
    /* backwards, as the row of a group is at most that of its plots */
    for (uint32_t i = look->num_gated; i-- > 0;) {
        look->fates[i] = look->fates[groups->of[i]];
    }
    for (unsigned row = 0; RHO_BODIES && row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (track->plot > 0) { /* the first plot of group 0 is plot 0 */
            track->plot = (int16_t)groups->first[track->plot];
        }
    }
}
