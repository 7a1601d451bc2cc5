/* SPDX-License-Identifier: MIT */
/*
 * plot_groups: joins the plots of a scan that one extended target can have given into one plot,
 * from before the claims to the report.
 *
 * A step replaces the scan by one of the groups, in the order of their first plots, so that the
 * group of a plot never has a higher row than the plot. At the end of the step rows and fates are
 * turned into those of the plots again.
 */
#include "bodies.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/body_extent_filter.h"
#include "rhotrack/detail/measurement.h"

/*
 * True where one target can have given both plots, by distance and range rates. Range rates of a
 * rigid body differ only across the line of sight, by its turn and by its unknown speed across it.
 */
static int may_be_one_target(const struct rho_look *look, struct rho_work *work, uint32_t one,
                             uint32_t other)
{
    const struct rho_plot *a = &look->scan->plots[one], *b = &look->scan->plots[other];
    const float length_max_m = look->tracker->bodies.length_max_m;
    const float dx_m = b->x_m - a->x_m, dy_m = b->y_m - a->y_m;
    const float apart_m = length_max_m + LOOSE_SIGMAS * (rho_plot_sigma_m(a) + rho_plot_sigma_m(b));
    rho_work_spend(work, PAIR_UNITS);
    if (!(dx_m * dx_m + dy_m * dy_m <= apart_m * apart_m)) {
        return 0;
    }
    if (!(look->scan->measures & RHO_MEASURES_RANGE_RATE)) {
        return 1;
    }
    const float x_m = a->x_m - (look->sensor ? look->sensor->x_m : 0.0f),
                y_m = a->y_m - (look->sensor ? look->sensor->y_m : 0.0f);
    const float range_m = rho_sqrt(x_m * x_m + y_m * y_m) + 1e-3f;
    const float side_m = (x_m * dy_m - y_m * dx_m) / range_m;
    /* 0.41: root mean square distance of two random places on a body, over its length */
    const float most_m = rho_smaller(rho_magnitude(side_m) + a->sigma_cross_m + b->sigma_cross_m,
                                     0.41f * length_max_m);
    const float across_radps = look->tracker->config.v_max_mps / (3.0f * range_m);
    const float off_mps =
        rho_measurement_innovation_mps(look->sensor, a->range_rate_mps, b->range_rate_mps);
    const float error_m2ps2 = BODY_ERROR_SIGMAS * BODY_ERROR_SIGMAS *
                              (a->sigma_range_rate_mps * a->sigma_range_rate_mps +
                               b->sigma_range_rate_mps * b->sigma_range_rate_mps);
    const float turn_m2ps2 = LOOSE_SIGMAS * LOOSE_SIGMAS *
                             (TURN_USUAL_RADPS * TURN_USUAL_RADPS + across_radps * across_radps) *
                             most_m * most_m;
    return off_mps * off_mps <= error_m2ps2 + turn_m2ps2;
}

/* The outline of a track's body for gates: its length and heading may yet be other ones. */
static struct body_outline widened_outline(const struct rho_look *look, unsigned row)
{
    const struct rho_body_filter *body = &look->tracker->bodies.of[row];
    struct body_outline outline = rho_bodies_outline_track(look, row);
    /* the square of a half length is 3 times the variance of a place on the body */
    const float turned =
        body->has_heading ? 3.0f * body->heading_sigma_rad * body->heading_sigma_rad : 0.0f;
    outline.along_m2 = rho_body_along_bound_m2(body) + turned * body->across_m2;
    outline.across_m2 = body->across_m2 + turned * body->along_m2;
    return outline;
}

/* False of a plot that is surely out of the gate: a cheap test of most plots near a body. */
static int may_be_in_gate(const struct body_outline *outline, const struct rho_plot *plot)
{
    const float after_s = (float)plot->offset_us * 1e-6f;
    const float dx_m = plot->x_m - outline->place_m[0] - after_s * outline->velocity_mps[0],
                dy_m = plot->y_m - outline->place_m[1] - after_s * outline->velocity_mps[1];
    const float noise_m2 =
        plot->sigma_range_m * plot->sigma_range_m + plot->sigma_cross_m * plot->sigma_cross_m;
    return dx_m * dx_m + dy_m * dy_m <=
           BODY_GATE_SIGMAS * BODY_GATE_SIGMAS *
               (outline->along_m2 + outline->across_m2 + outline->error_m2[0] +
                outline->error_m2[2] + noise_m2);
}

/*
 * Returns 1 where a plot is in the gate of a body, and its range rate, if measured, agrees with the
 * track's velocity and a turn of the body. *misfit: -2 ln of the plot's likelihood.
 */
static int body_explains_plot(const struct rho_look *look, const struct body_outline *outline,
                              const struct rho_plot *plot, float *misfit)
{
    struct outline_fit fit;
    rho_bodies_fit_plot(look, outline, plot, &fit);
    const float along_m2 = outline->along_m2 + fit.noise_m2[0], across_m2 = fit.noise_m2[2];
    const float far = fit.along_m * fit.along_m / along_m2,
                wide = fit.across_m * fit.across_m / across_m2;
    float square = far + wide, size = along_m2 * across_m2;
    if (!(far <= BODY_GATE_SIGMAS * BODY_GATE_SIGMAS &&
          wide <= BODY_GATE_SIGMAS * BODY_GATE_SIGMAS)) {
        return 0;
    }
    if (fit.has_rate) {
        const float slack_mps =
            BODY_ERROR_SIGMAS * (rho_sqrt(fit.track_m2ps2) + rho_sqrt(fit.rate_m2ps2)) +
            TURN_RADPS * rho_sqrt(fit.dx_m * fit.dx_m + fit.dy_m * fit.dy_m);
        const float variance = rho_bodies_rate_variance(&fit, TURN_RADPS);
        if (!(rho_magnitude(fit.rate_mps) <= slack_mps)) {
            return 0;
        }
        square += fit.rate_mps * fit.rate_mps / variance;
        size *= variance;
    }
    *misfit = square + rho_log(size);
    return 1;
}

/* Gives each plot to the track whose body explains it best. */
static void find_owners(struct step *step)
{
    const struct rho_look *look = &step->look;
    struct rho_groups *groups = &step->tracker->bodies.groups;
    const float noise_m2 = look->sigma_max_m * look->sigma_max_m;
    for (unsigned row = 0; row < step->tracker->num_tracks; row++) {
        if (!rho_bodies_may_own(look, row)) {
            continue;
        }
        const struct body_outline outline = widened_outline(look, row);
        const float *place_m = outline.place_m, *velocity_mps = outline.velocity_mps;
        /* half side of a square that holds the gate in any direction, at any plot's time */
        const float moved_m = rho_bodies_moved_m(look, velocity_mps);
        const float half_m = 1.5f * BODY_GATE_SIGMAS *
                                 rho_sqrt(rho_larger(outline.error_m2[0] + outline.along_m2,
                                                     outline.error_m2[2] + outline.across_m2) +
                                          noise_m2) +
                             moved_m;
        struct plots_near near =
            rho_plots_near(step->tracker, place_m[0] - half_m, place_m[0] + half_m,
                           place_m[1] - half_m, place_m[1] + half_m);
        uint32_t passed = 0;
        for (uint32_t i; !rho_work_is_spent(&step->work) && rho_plots_next(look, &near, &i);) {
            const struct rho_plot *plot = &look->scan->plots[i];
            float misfit;
            if (step->report->fates[i] != RHO_FATE_HELD || !rho_plots_is_within(&near, plot)) {
                continue;
            }
            passed++;
            if (!may_be_in_gate(&outline, plot)) {
                continue;
            }
            rho_work_spend(&step->work, TEST_UNITS);
            if (!body_explains_plot(look, &outline, plot, &misfit)) {
                continue;
            }
            /* of two bodies that explain the plot about equally well the second contends for it */
            const unsigned owner = groups->owner[i];
            const float better = groups->misfit[i] - misfit;
            if (owner != RHO_NO_ROW && better <= 0.0f) {
                groups->contender[i] =
                    -better < CONTESTED_MISFIT ? (uint16_t)row : groups->contender[i];
                continue;
            }
            groups->contender[i] =
                owner != RHO_NO_ROW && better < CONTESTED_MISFIT ? (uint16_t)owner : RHO_NO_ROW;
            groups->owner[i] = (uint16_t)row;
            groups->misfit[i] = misfit;
        }
        rho_work_spend(&step->work, passed / RHO_WORK_PASSED_A_UNIT);
    }
}

static void add_plot_to_group(struct rho_groups *groups, unsigned group, uint32_t plot)
{
    groups->next[groups->last[group]] = (uint16_t)plot;
    groups->last[group] = (uint16_t)plot;
    groups->of[plot] = (uint16_t)group;
}

/*
 * Forms the groups, in the order of their first plots: one a track, the others by place, of plots
 * that may all be of one target. Plots in excluded areas stay alone: they start no track.
 */
static void form_groups(struct rho_tracker *tracker, const struct rho_look *look,
                        struct rho_work *work)
{
    struct rho_groups *groups = &tracker->bodies.groups;
    const float most_m = tracker->bodies.length_max_m + 2.0f * LOOSE_SIGMAS * look->sigma_max_m;
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
        const unsigned group = groups->count++;
        groups->first[group] = groups->last[group] = (uint16_t)i;
        groups->of[i] = (uint16_t)group;
        if (owner != RHO_NO_ROW) {
            of_track[owner] = groups->of[i];
            continue;
        }
        if (look->fates[i] != RHO_FATE_HELD || rho_areas_exclude(look, i)) {
            continue;
        }
        const struct rho_plot *plot = &look->scan->plots[i];
        struct plots_near near = rho_plots_near(tracker, plot->x_m - most_m, plot->x_m + most_m,
                                                plot->y_m - most_m, plot->y_m + most_m);
        for (uint32_t k; !rho_work_is_spent(work) && rho_plots_next(look, &near, &k);) {
            rho_work_spend(work, PASS_UNITS);
            if (look->fates[k] != RHO_FATE_HELD || groups->of[k] != RHO_NO_ROW ||
                groups->owner[k] != RHO_NO_ROW || rho_areas_exclude(look, k)) {
                continue;
            }
            unsigned of = groups->first[group];
            while (of != RHO_NO_ROW && may_be_one_target(look, work, of, k)) {
                of = groups->next[of];
            }
            if (of == RHO_NO_ROW) {
                add_plot_to_group(groups, group, k);
            }
        }
    }
}

/* Mean of a group's plots, by differences from the first: sums of coordinates would be rounded. */
static struct rho_plot mean_plot(const struct rho_look *look, unsigned group, unsigned *count)
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

static float sigma_within_limits(float sigma)
{
    sigma = rho_larger(sigma, RHO_LIMIT_SIGMA_MIN);
    return sigma < RHO_LIMIT_SIGMA_MAX ? sigma : RHO_LIMIT_SIGMA_MAX;
}

/* Makes one plot of a group: the mean, with the noise of the plots and of places on the body. */
static void make_group_plot(const struct rho_look *look, unsigned group, struct rho_plot *out)
{
    const struct rho_bodies *bodies = &look->tracker->bodies;
    const unsigned first = bodies->groups.first[group], owner = bodies->groups.owner[first];
    struct rho_measurement seen;
    float spread[3]; /* n times the variance of the mean by random places on the body: xx, yx, yy */
    unsigned count;
    *out = mean_plot(look, group, &count);
    if (look->fates[first] != RHO_FATE_HELD) {
        return;
    }
    const float n = (float)count;
    if (owner != RHO_NO_ROW) { /* the share of the variance of a place that n plots leave */
        const struct rho_body_filter *body = &bodies->of[owner];
        const float share =
            body->plots < SETTLED_LOOKS ? 1.0f : rho_body_mean_variance_share(body, count);
        rho_body_place_covariance(body, spread);
        for (int i = 0; i < 3; i++) {
            spread[i] *= share;
        }
    } else { /* the spread of the plots, with the prior as one plot more */
        spread[0] = spread[2] = rho_bodies_prior_m2(look->tracker);
        spread[1] = 0.0f;
        for (unsigned i = first; i != RHO_NO_ROW; i = bodies->groups.next[i]) {
            const float dx_m = look->scan->plots[i].x_m - out->x_m,
                        dy_m = look->scan->plots[i].y_m - out->y_m;
            spread[0] += dx_m * dx_m;
            spread[1] += dx_m * dy_m;
            spread[2] += dy_m * dy_m;
        }
        for (int i = 0; i < 3; i++) {
            spread[i] /= n;
        }
    }
    rho_measurement_from_plot(out, 0, look->sensor, &seen);
    const float c = seen.cos_azimuth, s = seen.sin_azimuth;
    const float along_m2 = c * c * spread[0] + 2.0f * c * s * spread[1] + s * s * spread[2];
    const float across_m2 = s * s * spread[0] - 2.0f * c * s * spread[1] + c * c * spread[2];
    out->sigma_range_m =
        sigma_within_limits(rho_sqrt((out->sigma_range_m * out->sigma_range_m + along_m2) / n));
    out->sigma_cross_m =
        sigma_within_limits(rho_sqrt((out->sigma_cross_m * out->sigma_cross_m + across_m2) / n));
    float off_m2 = 0.0f, off_m2ps2 = 0.0f; /* squared differences of heights and of range rates */
    for (unsigned i = first; i != RHO_NO_ROW; i = bodies->groups.next[i]) {
        const struct rho_plot *plot = &look->scan->plots[i];
        const float off_mps =
            rho_measurement_innovation_mps(look->sensor, plot->range_rate_mps, out->range_rate_mps);
        off_m2 += (plot->z_m - out->z_m) * (plot->z_m - out->z_m);
        off_m2ps2 += off_mps * off_mps;
    }
    if (look->scan->measures & RHO_MEASURES_Z) {
        out->sigma_up_m =
            sigma_within_limits(rho_sqrt((out->sigma_up_m * out->sigma_up_m + off_m2 / n) / n));
    }
    if (look->scan->measures & RHO_MEASURES_RANGE_RATE) {
        out->sigma_range_rate_mps = sigma_within_limits(
            rho_sqrt((out->sigma_range_rate_mps * out->sigma_range_rate_mps + off_m2ps2 / n) / n));
    }
}

void rho_bodies_group(struct step *step)
{
    struct rho_look *look = &step->look;
    struct rho_scan *grouped = step->grouped;
    step->whole = look->scan;
    struct rho_groups *groups = &step->tracker->bodies.groups;
    rho_bodies_align(step->tracker);
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
            look->offset_max_s = rho_larger(look->offset_max_s, rho_magnitude(offset_s));
        }
    }
    rho_plots_index(step->tracker, look);
    rho_work_begin_phase(step->tracker, &step->work, RHO_WORK_GROUPS_SHARE);
    find_owners(step);
    rho_bodies_follow_turns(step);
    rho_bodies_end_duplicates(step);
    form_groups(step->tracker, look, &step->work);
    step->work.is_partial |= rho_work_is_spent(&step->work);
    for (unsigned group = 0; group < groups->count; group++) {
        make_group_plot(look, group, &groups->plots[group]);
    }
    *grouped = *look->scan;
    grouped->plots = groups->plots;
    grouped->num_plots = groups->count;
    look->scan = grouped;
    look->num_inputs = look->num_gated = groups->count;
    look->sigma_max_m = look->offset_max_s = 0.0f;
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
