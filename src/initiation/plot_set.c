/* SPDX-License-Identifier: MIT */
/*
 * plot_set: fits a track to a set of plots, associates the plots of every scan with the fit, and
 * scores the set.
 *
 * The arithmetic is in isotropic_fit where noise is isotropic and sets are straight, and in
 * anisotropic_fit elsewhere.
 */
#include <string.h>

#include "candidates.h"
#include "clutter_density.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

int rho_plot_set_fit(const struct search *search, const struct plot_set *set, struct line_fit *fit)
{
    return rho_search_is_isotropic(search) ? rho_isotropic_fit(search, set, fit)
                                           : rho_anisotropic_fit(search, set, fit);
}

static float x_at(const struct line_fit *fit, float t_s)
{
    return fit->x_m + (fit->vx_mps + 0.5f * fit->ax_mps2 * t_s) * t_s;
}

static float y_at(const struct line_fit *fit, float t_s)
{
    return fit->y_m + (fit->vy_mps + 0.5f * fit->ay_mps2 * t_s) * t_s;
}

/* Index of the plot of scan m nearest to the fit, in a gate widened by variance_factor; or -1. */
static int nearest_to_fit(struct search *search, const struct line_fit *fit, float variance_factor,
                          unsigned m)
{
    const struct rho_window_scan *scan = rho_search_scan(search, m);
    struct rho_window_work *work = &search->initiator->work.window;
    const float t_s = search->time_s[m], bend_m2 = variance_factor * search->fit_process_m2;
    const float gate_radius_m = rho_sqrt(
        search->gate_chi2 * (bend_m2 + variance_factor * scan->sigma_max_m * scan->sigma_max_m));
    const struct rho_window_place place = {
        .x_m = x_at(fit, t_s),
        .y_m = y_at(fit, t_s),
        .z_m = fit->z_m + fit->vz_mps * t_s,
        .vx_mps = fit->vx_mps + fit->ax_mps2 * t_s,
        .vy_mps = fit->vy_mps + fit->ay_mps2 * t_s,
        .ax_mps2 = fit->ax_mps2,
        .ay_mps2 = fit->ay_mps2,
        .vz_mps = fit->vz_mps,
        .noise = {bend_m2, 0.0f, bend_m2, bend_m2},
        .factor = variance_factor,
        .has_z = fit->has_z,
        .gate_radius_m = gate_radius_m,
        .skip_flags = search->skip_flags,
    };
    return rho_search_is_isotropic(search)
               ? rho_window_nearest_isotropic(scan, &place, search->gate_chi2, work)
               : rho_window_nearest_plot(scan, &place, work);
}

void rho_plot_set_associate(struct search *search, const struct line_fit *fit,
                            float variance_factor, struct plot_set *set)
{
    set->mask = set->hits = 0;
    for (unsigned m = 0; m < search->num_scans; m++) {
        int plot = nearest_to_fit(search, fit, variance_factor, m);
        set->plot[m] = (uint16_t)(plot < 0 ? 0 : plot);
        if (plot >= 0) {
            set->mask |= 1u << m;
            set->hits++;
        }
    }
}

int rho_plot_set_refine(struct search *search, struct plot_set *set, struct line_fit *fit)
{
    const struct rho_initiator_config *config = &search->initiator->config;
    const float factor = search->turn_mps2 > 0.0f ? TURN_GATE_FACTOR : FIT_GATE_FACTOR;
    search->initiator->work.fits = rho_count(search->initiator->work.fits, 1);
    if (!rho_plot_set_fit(search, set, fit)) {
        return 0;
    }
    for (int round = 0; round < FIT_ROUNDS; round++) {
        struct plot_set before = *set;
        rho_plot_set_associate(search, fit, factor, set);
        if (set->hits < search->min_scans ||
            (set->mask & search->wanted_mask) != search->wanted_mask) {
            return 0;
        }
        /* scans without a plot have index 0 */
        if (before.mask == set->mask &&
            memcmp(before.plot, set->plot, search->num_scans * sizeof set->plot[0]) == 0) {
            break;
        }
        if (!rho_plot_set_fit(search, set, fit)) {
            return 0;
        }
    }
    const float speed2 = fit->vx_mps * fit->vx_mps + fit->vy_mps * fit->vy_mps;
    return speed2 >= config->v_min_mps * config->v_min_mps &&
           speed2 <= config->v_max_mps * config->v_max_mps;
}

int32_t rho_nat_to_mnat(float nat)
{
    float mnat = nat * 1000.0f;
    if (!(mnat > -(float)SCORE_MAX_MNAT)) {
        return -SCORE_MAX_MNAT;
    }
    return mnat < (float)SCORE_MAX_MNAT ? (int32_t)(mnat + (mnat < 0.0f ? -0.5f : 0.5f))
                                        : SCORE_MAX_MNAT;
}

/* True where scan m covered the place of the fitted track. */
static int did_scan_cover_track(const struct search *search, const struct line_fit *fit, unsigned m)
{
    const struct rho_window_scan *scan = rho_search_scan(search, m);
    float t_s = search->time_s[m];
    return rho_measurement_covers(rho_window_sensor_if_described(scan), scan->sector_from_rad,
                                  scan->sector_to_rad, x_at(fit, t_s), y_at(fit, t_s));
}

int rho_plot_set_score(const struct search *search, const struct plot_set *set,
                       const struct line_fit *fit, struct set_score *score)
{
    float nat, hits = 0.0f;
    /* after every scan, misses count from the first hit on: the track may be born there */
    int is_born = search->kind == RHO_SEARCH_BATCH;
    if (!(rho_search_is_isotropic(search) ? rho_isotropic_likelihood(search, set, score, &nat)
                                          : rho_anisotropic_likelihood(search, set, score, &nat))) {
        return 0;
    }
    /* probabilities of hits and misses, each hit divided by the clutter density at its plot */
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (set->mask >> m & 1u) {
            hits += search->log_pd[m] - rho_density_log_of_hit(search, set, m);
            is_born = 1;
        } else if (is_born && did_scan_cover_track(search, fit, m)) {
            hits += search->log_miss[m];
        }
    }
    score->mnat = rho_nat_to_mnat(search->log_prior + search->log_turn + hits + nat);
    return 1;
}
