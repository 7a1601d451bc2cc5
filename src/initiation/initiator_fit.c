/* SPDX-License-Identifier: MIT */
/*
 * initiator_fit: the straight track through a set of plots, the plots nearest to it, and the set's score.
 */
#include "initiator_search.h"
#include "rhotrack/approx.h"
#include "rhotrack/linalg.h"

/* A plot misses the fitted track by its own noise and the fit's: 1 + leverage, which is 1.46 at the ends of seven
 * evenly spread hits. Fewer hits reach farther; their plots are gated a little too tightly, and the votes were cast
 * before. */
#define FIT_GATE_FACTOR 1.5f
/* The same of one with an acceleration, which is known less well at its ends. */
#define TURN_GATE_FACTOR 3.0f

#define FIT_ROUNDS 2

/* ---- process noise ---------------------------------------------------------------------------- */

/* How far one m/s^2 through the interval from scan l to l + 1 has moved the target by scan m. */
static float displacement_s2(const struct search *search, unsigned l, unsigned m)
{
    if (m <= l) {
        return 0.0f;
    }
    float interval_s = search->time_s[l + 1] - search->time_s[l];
    return interval_s * (0.5f * interval_s + search->time_s[m] - search->time_s[l + 1]);
}

/* Diagonal elements of H K H, H projecting off the straight lines over the scans from `first` on: how far process noise K
 * bends a track away from its own fit. Returns the largest; *sum_m2: all of them. */
float rho_initiator_bend_m2(const struct search *search, unsigned first, float *sum_m2)
{
    unsigned end = search->num_scans;
    float n = (float)(end - first), mean_s = 0.0f, spread_s2 = 0.0f, largest_m2 = 0.0f;
    float project[RHO_MAX_SCANS];
    *sum_m2 = 0.0f;
    for (unsigned m = first; m < end; m++) {
        mean_s += search->time_s[m] / n;
    }
    for (unsigned m = first; m < end; m++) {
        spread_s2 += (search->time_s[m] - mean_s) * (search->time_s[m] - mean_s);
    }
    for (unsigned r = first; r < end && spread_s2 > 0.0f; r++) {
        float bend = 0.0f;
        for (unsigned m = first; m < end; m++) {
            float lever = (search->time_s[r] - mean_s) * (search->time_s[m] - mean_s) / spread_s2;
            project[m] = (r == m ? 1.0f : 0.0f) - 1.0f / n - lever;
        }
        for (unsigned i = first; i < end; i++) {
            for (unsigned j = first; j < end; j++) {
                bend += project[i] * search->process_m2[RHO_AT(i, j)] * project[j];
            }
        }
        *sum_m2 += bend;
        largest_m2 = bend > largest_m2 ? bend : largest_m2;
    }
    return largest_m2;
}

void rho_initiator_prepare_process(struct search *search)
{
    float variance = search->initiator->config.process_noise_mps2;
    variance *= variance;
    for (unsigned i = 0; i < search->num_scans; i++) {
        for (unsigned j = 0; j <= i; j++) {
            float sum = 0.0f;
            for (unsigned l = 0; l < j; l++) {
                sum += displacement_s2(search, l, i) * displacement_s2(search, l, j);
            }
            search->process_m2[RHO_AT(i, j)] = variance * sum;
        }
    }
    search->fit_process_m2 =
        variance > 0.0f ? rho_initiator_bend_m2(search, 0, &(float){0.0f}) : 0.0f;
}

/* Variance by process noise of scan m's place between the places of scans a and b. */
float rho_initiator_process_gap_m2(const struct search *search, unsigned a, unsigned m, unsigned b)
{
    float al = (search->time_s[m] - search->time_s[a]) / (search->time_s[b] - search->time_s[a]);
    const unsigned scan[3] = {a, m, b};
    const float weight[3] = {al - 1.0f, 1.0f, -al};
    float sum = 0.0f;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            sum += weight[i] * weight[j] * search->process_m2[RHO_AT(scan[i], scan[j])];
        }
    }
    return sum > 0.0f ? sum : 0.0f;
}

static float variance_m2(const struct rho_window_plot *plot)
{
    float sigma_m = rho_window_sigma_m(plot);
    return sigma_m * sigma_m;
}

/* ---- least squares ---------------------------------------------------------------------------- */

/* Weighted moments of a set about its own mean: no large numbers are subtracted. */
struct moments {
    float weight, time_s, x_m, y_m; /* sum of weights 1 / sigma^2, and weighted means */
    float tt, tx, ty;               /* weighted sums of products about the means */
};

static struct moments moments_of(const struct search *search, const struct plot_set *set)
{
    struct moments sum = {0};
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (set->mask >> m & 1u) {
            const struct rho_window_plot *plot = rho_initiator_plot(search, set, m);
            float w = 1.0f / variance_m2(plot);
            sum.weight += w;
            sum.time_s += w * rho_initiator_plot_time_s(search, set, m);
            sum.x_m += w * plot->x_m;
            sum.y_m += w * plot->y_m;
        }
    }
    sum.time_s /= sum.weight;
    sum.x_m /= sum.weight;
    sum.y_m /= sum.weight;
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (set->mask >> m & 1u) {
            const struct rho_window_plot *plot = rho_initiator_plot(search, set, m);
            float w = 1.0f / variance_m2(plot);
            float t_s = rho_initiator_plot_time_s(search, set, m) - sum.time_s;
            sum.tt += w * t_s * t_s;
            sum.tx += w * t_s * (plot->x_m - sum.x_m);
            sum.ty += w * t_s * (plot->y_m - sum.y_m);
        }
    }
    return sum;
}

/* 0 where the plots do not determine a line. */
int rho_initiator_fit(const struct search *search, const struct plot_set *set, struct line_fit *fit)
{
    if (!rho_initiator_is_isotropic(search)) {
        return rho_initiator_own_fit(search, set, fit);
    }
    struct moments sum = moments_of(search, set);
    if (!(sum.tt > 0.0f)) {
        return 0;
    }
    *fit = (struct line_fit){.vx_mps = sum.tx / sum.tt, .vy_mps = sum.ty / sum.tt};
    fit->x_m = sum.x_m - fit->vx_mps * sum.time_s;
    fit->y_m = sum.y_m - fit->vy_mps * sum.time_s;
    return 1;
}

/* The plot of scan m nearest to the fitted track; -1: none. */
static int nearest(struct search *search, const struct line_fit *fit, float factor, unsigned m)
{
    const struct rho_window_scan *scan = rho_window_scan_at(&search->initiator->window, m);
    float bend_m2 = factor * search->fit_process_m2;
    struct rho_window_query query = {
        .x_m = fit->x_m + fit->vx_mps * search->time_s[m],
        .y_m = fit->y_m + fit->vy_mps * search->time_s[m],
        .vx_mps = fit->vx_mps,
        .vy_mps = fit->vy_mps,
        .variance_m2 = bend_m2,
        .sigma_factor = factor,
        .gate_chi2 = RHO_GATE_CHI2_2D,
        .reach_m =
            rho_sqrt(RHO_GATE_CHI2_2D * (bend_m2 + factor * scan->sigma_max_m * scan->sigma_max_m)),
        .skip_flags = search->skip_flags,
    };
    return rho_window_nearest(scan, &query, &search->initiator->work.window);
}

/* The plot nearest to the fitted track in every scan. factor widens the gate's variance. */
void rho_initiator_collect(struct search *search, const struct line_fit *fit, float factor,
                           struct plot_set *set)
{
    set->mask = set->hits = 0;
    for (unsigned m = 0; m < search->num_scans; m++) {
        int plot = rho_initiator_is_isotropic(search)
                       ? nearest(search, fit, factor, m)
                       : rho_initiator_own_nearest(search, fit, factor, m);
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

static int is_wanted(const struct search *search, const struct plot_set *set)
{
    return set->hits >= search->min_scans &&
           (set->mask & search->wanted_mask) == search->wanted_mask;
}

static int is_fast_enough(const struct search *search, const struct line_fit *fit)
{
    const struct rho_initiator_config *config = &search->initiator->config;
    float speed2 = fit->vx_mps * fit->vx_mps + fit->vy_mps * fit->vy_mps;
    return speed2 >= config->v_min_mps * config->v_min_mps &&
           speed2 <= config->v_max_mps * config->v_max_mps;
}

/*
 * Fits the set, and lets every scan vote again along the fit, until nothing changes (FIT_ROUNDS times at most). 0 where
 * too few scans vote, or the speed is no target's.
 */
int rho_initiator_settle(struct search *search, struct plot_set *set, struct line_fit *fit)
{
    const float factor = search->turn_mps2 > 0.0f ? TURN_GATE_FACTOR : FIT_GATE_FACTOR;
    search->initiator->work.fits = rho_count(search->initiator->work.fits, 1);
    if (!rho_initiator_fit(search, set, fit)) {
        return 0;
    }
    for (int round = 0; round < FIT_ROUNDS; round++) {
        struct plot_set before = *set;
        rho_initiator_collect(search, fit, factor, set);
        if (!is_wanted(search, set)) {
            return 0;
        }
        if (is_same_set(search, &before, set)) {
            break;
        }
        if (!rho_initiator_fit(search, set, fit)) {
            return 0;
        }
    }
    return is_fast_enough(search, fit);
}

/* ---- score ------------------------------------------------------------------------------------ */

/* What the plots' geometry contributes: determinants and the residual, both axes. */
struct evidence {
    float log_det_noise;  /* ln det V */
    float log_det_fisher; /* ln det A^T V^-1 A, A the line's design matrix */
    float chi2;           /* residual, two axes */
};

/* Independent noise: V is diagonal, and everything follows from the moments. */
static struct evidence evidence_straight(const struct search *search, const struct plot_set *set)
{
    struct moments sum = moments_of(search, set);
    float vx_mps = sum.tx / sum.tt, vy_mps = sum.ty / sum.tt;
    struct evidence evidence = {.log_det_fisher = rho_log(sum.weight * sum.tt)};
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (set->mask >> m & 1u) {
            const struct rho_window_plot *plot = rho_initiator_plot(search, set, m);
            float t_s = rho_initiator_plot_time_s(search, set, m) - sum.time_s;
            float rx_m = plot->x_m - sum.x_m - vx_mps * t_s;
            float ry_m = plot->y_m - sum.y_m - vy_mps * t_s;
            float noise_m2 = variance_m2(plot);
            evidence.chi2 += (rx_m * rx_m + ry_m * ry_m) / noise_m2;
            evidence.log_det_noise += rho_log(noise_m2);
        }
    }
    return evidence;
}

static float dot(unsigned n, const float *a, const float *b)
{
    float sum = 0.0f;
    for (unsigned i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/*
 * Squared residual of y off the columns one and t, all whitened; fisher = [one.one, one.t, t.t] and
 * its determinant. The residuals are formed and then squared: a difference of squares would cancel.
 */
static float residual_chi2(unsigned n, const float *one, const float *t, const float *y,
                           const float fisher[3], float determinant)
{
    float by_one = dot(n, one, y), by_t = dot(n, t, y), chi2 = 0.0f;
    float place = (by_one * fisher[2] - by_t * fisher[1]) / determinant;
    float slope = (by_t * fisher[0] - by_one * fisher[1]) / determinant;
    for (unsigned i = 0; i < n; i++) {
        float residual = y[i] - place * one[i] - slope * t[i];
        chi2 += residual * residual;
    }
    return chi2;
}

/* The columns of the regression, one row a hit, about the moments' means. */
struct columns {
    float one[RHO_MAX_SCANS], t[RHO_MAX_SCANS], x[RHO_MAX_SCANS], y[RHO_MAX_SCANS];
    float noise[RHO_TRIANGLE(RHO_MAX_SCANS)]; /* V */
};

static unsigned fill_columns(const struct search *search, const struct plot_set *set,
                             struct columns *columns)
{
    struct moments sum = moments_of(search, set);
    unsigned scan[RHO_MAX_SCANS], n = 0;
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (set->mask >> m & 1u) {
            const struct rho_window_plot *plot = rho_initiator_plot(search, set, m);
            columns->one[n] = 1.0f;
            columns->t[n] = rho_initiator_plot_time_s(search, set, m) - sum.time_s;
            columns->x[n] = plot->x_m - sum.x_m;
            columns->y[n] = plot->y_m - sum.y_m;
            scan[n] = m;
            for (unsigned j = 0; j <= n; j++) {
                columns->noise[RHO_AT(n, j)] = search->process_m2[RHO_AT(m, scan[j])];
            }
            columns->noise[RHO_AT(n, n)] += variance_m2(plot);
            n++;
        }
    }
    return n;
}

/* Process noise couples the scans: whiten with the Cholesky factor of V. 0 where V is singular. */
static int evidence_bent(const struct search *search, const struct plot_set *set,
                         struct evidence *evidence)
{
    struct columns c;
    unsigned n = fill_columns(search, set, &c);
    if (rho_linalg_cholesky((int)n, c.noise, c.noise) != RHO_OK) {
        return 0;
    }
    rho_linalg_forward((int)n, c.noise, c.one);
    rho_linalg_forward((int)n, c.noise, c.t);
    rho_linalg_forward((int)n, c.noise, c.x);
    rho_linalg_forward((int)n, c.noise, c.y);
    const float fisher[3] = {dot(n, c.one, c.one), dot(n, c.one, c.t), dot(n, c.t, c.t)};
    float determinant = fisher[0] * fisher[2] - fisher[1] * fisher[1];
    if (!(determinant > 0.0f)) {
        return 0;
    }
    evidence->log_det_noise = rho_linalg_log_determinant((int)n, c.noise);
    evidence->log_det_fisher = rho_log(determinant);
    evidence->chi2 = residual_chi2(n, c.one, c.t, c.x, fisher, determinant) +
                     residual_chi2(n, c.one, c.t, c.y, fisher, determinant);
    return 1;
}

int32_t rho_initiator_mnat(float nat)
{
    float mnat = nat * 1000.0f;
    if (!(mnat > -1.0e9f)) {
        return -1000000000;
    }
    return mnat < 1.0e9f ? (int32_t)(mnat + (mnat < 0.0f ? -0.5f : 0.5f)) : 1000000000;
}

/* Did the sensor of scan m look where the fitted track was? */
static int looked(const struct search *search, const struct line_fit *fit, unsigned m)
{
    const struct rho_window_scan *scan = rho_window_scan_at(&search->initiator->window, m);
    float t_s = search->time_s[m];
    return rho_measurement_looks_at(rho_window_sensor(scan), scan->sector_from_rad,
                                    scan->sector_to_rad,
                                    fit->x_m + (fit->vx_mps + 0.5f * fit->ax_mps2 * t_s) * t_s,
                                    fit->y_m + (fit->vy_mps + 0.5f * fit->ay_mps2 * t_s) * t_s);
}

/*
 * ln of the pattern of hits and misses, each hit over the clutter's density there. A track that begins with the newest
 * scans may have been born meanwhile: after every scan the search asks again, so its misses count from its first hit.
 */
static float log_pattern(const struct search *search, const struct plot_set *set,
                         const struct line_fit *fit)
{
    float sum = 0.0f;
    int is_born = search->kind == RHO_SEARCH_BATCH;
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (set->mask >> m & 1u) {
            sum += search->log_pd[m] - rho_initiator_log_density(search, set, m);
            is_born = 1;
        } else if (is_born && looked(search, fit, m)) {
            sum += search->log_miss[m];
        }
    }
    return sum;
}

/* The plots' joint density with position and velocity integrated out (isotropic: both axes, hence no factor 1/2 but
 * chi2's). 0 where the plots do not determine a line. */
static int log_likelihood(const struct search *search, const struct plot_set *set,
                          struct set_score *score, float *nat)
{
    struct evidence evidence;
    if (!rho_initiator_is_isotropic(search)) {
        return rho_initiator_own_evidence(search, set, nat, &score->chi2, &score->dimensions);
    }
    if (!(search->fit_process_m2 > 0.0f)) {
        evidence = evidence_straight(search, set);
    } else if (!evidence_bent(search, set, &evidence)) {
        return 0;
    }
    score->chi2 = evidence.chi2;
    score->dimensions = 2u * set->hits - 4u;
    *nat = -((float)(set->hits - 2u) * LOG_TWO_PI + evidence.log_det_noise +
             evidence.log_det_fisher + 0.5f * evidence.chi2);
    return 1;
}

/* ln [ P(plots | one target) / P(plots | clutter) ]. Returns 0 where the plots do not determine a line. */
int rho_initiator_score(const struct search *search, const struct plot_set *set,
                        const struct line_fit *fit, struct set_score *score)
{
    float nat;
    if (!log_likelihood(search, set, score, &nat)) {
        return 0;
    }
    score->mnat = rho_initiator_mnat(search->log_prior + search->log_turn +
                                     log_pattern(search, set, fit) + nat);
    return 1;
}
