/* SPDX-License-Identifier: MIT */
/*
 * track_fit_associate_and_score: fits a track to a set of plots, associates the plots of every scan
 * with the fit, and scores the set.
 *
 * The arithmetic is in isotropic_fit where noise is isotropic and sets are straight, and in
 * anisotropic_fit elsewhere.
 */
#include "rhotrack/detail/approx.h"
#include "search.h"

/*
 * Variance of a plot about the fitted track over the plot's own: 1 + leverage, which is 1.46 at the
 * ends of seven evenly spread hits. Fewer hits have a larger leverage; their gates are a little too
 * tight, but their votes were counted before.
 */
#define FIT_GATE_FACTOR 1.5f
/*
 * Variance of a plot about a fitted turning track over the plot's own: the acceleration makes the
 * ends of the fit less certain.
 */
#define TURN_GATE_FACTOR 3.0f

#define FIT_ROUNDS 2

/* ---- fit ------------------------------------------------------------------------------------- */

/* Fits a track to a set of plots. Returns 0 where the plots do not determine a track. */
int rho_initiator_fit_track_if_determined(const struct search *search, const struct plot_set *set,
                                          struct line_fit *fit)
{
    return rho_initiator_takes_isotropic_path(search)
               ? rho_initiator_fit_isotropic(search, set, fit)
               : rho_initiator_fit_anisotropic(search, set, fit);
}

/*
 * Makes the set of the plots nearest to the fitted track, one a scan at most. `variance_factor`
 * widens the gate's variance.
 */
void rho_initiator_associate_plots(struct search *search, const struct line_fit *fit,
                                   float variance_factor, struct plot_set *set)
{
    set->mask = set->hits = 0;
    for (unsigned m = 0; m < search->num_scans; m++) {
        int plot = rho_initiator_takes_isotropic_path(search)
                       ? rho_initiator_nearest_plot_isotropic(search, fit, variance_factor, m)
                       : rho_initiator_nearest_plot_anisotropic(search, fit, variance_factor, m);
        set->plot[m] = (uint16_t)(plot < 0 ? 0 : plot);
        if (plot >= 0) {
            set->mask |= 1u << m;
            set->hits++;
        }
    }
}

static int is_same_set(const struct search *search, const struct plot_set *a,
                       const struct plot_set *b)
{
    if (a->mask != b->mask) {
        return 0;
    }
    for (unsigned m = 0; m < search->num_scans; m++) {
        if ((a->mask >> m & 1u) && a->plot[m] != b->plot[m]) {
            return 0;
        }
    }
    return 1;
}

static int has_enough_votes_and_wanted_scans(const struct search *search,
                                             const struct plot_set *set)
{
    return set->hits >= search->min_scans &&
           (set->mask & search->wanted_mask) == search->wanted_mask;
}

static int has_target_speed(const struct search *search, const struct line_fit *fit)
{
    const struct rho_initiator_config *config = &search->initiator->config;
    float speed2 = fit->vx_mps * fit->vx_mps + fit->vy_mps * fit->vy_mps;
    return speed2 >= config->v_min_mps * config->v_min_mps &&
           speed2 <= config->v_max_mps * config->v_max_mps;
}

/*
 * Fits a set and associates the plots of every scan with the fit, until the set stays the same,
 * FIT_ROUNDS times at most. Returns 0 where too few scans have a plot, or the speed is outside
 * v_min .. v_max.
 */
int rho_initiator_refine_set(struct search *search, struct plot_set *set, struct line_fit *fit)
{
    const float factor = search->turn_mps2 > 0.0f ? TURN_GATE_FACTOR : FIT_GATE_FACTOR;
    search->initiator->work.fits = rho_count(search->initiator->work.fits, 1);
    if (!rho_initiator_fit_track_if_determined(search, set, fit)) {
        return 0;
    }
    for (int round = 0; round < FIT_ROUNDS; round++) {
        struct plot_set before = *set;
        rho_initiator_associate_plots(search, fit, factor, set);
        if (!has_enough_votes_and_wanted_scans(search, set)) {
            return 0;
        }
        if (is_same_set(search, &before, set)) {
            break;
        }
        if (!rho_initiator_fit_track_if_determined(search, set, fit)) {
            return 0;
        }
    }
    return has_target_speed(search, fit);
}

/* ---- score ----------------------------------------------------------------------------------- */

int32_t rho_initiator_nat_to_mnat(float nat)
{
    float mnat = nat * 1000.0f;
    if (!(mnat > -1.0e9f)) {
        return -1000000000;
    }
    return mnat < 1.0e9f ? (int32_t)(mnat + (mnat < 0.0f ? -0.5f : 0.5f)) : 1000000000;
}

/* True where scan m covered the place of the fitted track. */
static int did_scan_cover_track(const struct search *search, const struct line_fit *fit, unsigned m)
{
    const struct rho_window_scan *scan = rho_window_scan_at(&search->initiator->window, m);
    float t_s = search->time_s[m];
    return rho_measurement_covers(rho_window_sensor_if_described(scan), scan->sector_from_rad,
                                  scan->sector_to_rad,
                                  fit->x_m + (fit->vx_mps + 0.5f * fit->ax_mps2 * t_s) * t_s,
                                  fit->y_m + (fit->vy_mps + 0.5f * fit->ay_mps2 * t_s) * t_s);
}

/*
 * ln of the probability of the hits and misses, each hit divided by the clutter density at its
 * plot. A track may have been born within the window: in a search after every scan, misses count
 * from the first hit on.
 */
static float log_detection_ratio(const struct search *search, const struct plot_set *set,
                                 const struct line_fit *fit)
{
    float sum = 0.0f;
    int is_born = search->kind == RHO_SEARCH_BATCH;
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (set->mask >> m & 1u) {
            sum += search->log_pd[m] - rho_initiator_log_density_of_hit(search, set, m);
            is_born = 1;
        } else if (is_born && did_scan_cover_track(search, fit, m)) {
            sum += search->log_miss[m];
        }
    }
    return sum;
}

/*
 * Sets the score ln [ P(plots | one target) / P(plots | clutter) ] of a set of plots. Returns 0
 * where the plots do not determine a track.
 */
int rho_initiator_score_set_if_determined(const struct search *search, const struct plot_set *set,
                                          const struct line_fit *fit, struct set_score *score)
{
    float nat;
    const int is_line = rho_initiator_takes_isotropic_path(search)
                            ? rho_initiator_log_likelihood_isotropic(search, set, score, &nat)
                            : rho_initiator_log_likelihood_anisotropic(search, set, score, &nat);
    if (!is_line) {
        return 0;
    }
    score->mnat = rho_initiator_nat_to_mnat(search->log_prior + search->log_turn +
                                            log_detection_ratio(search, set, fit) + nat);
    return 1;
}
