/* SPDX-License-Identifier: MIT */
/*
 * isotropic_fit: least-squares fit of a straight track to plots with isotropic noise, equal along
 * and across the line of sight, and the likelihood of a set.
 */
#include "candidates.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"

static float plot_variance_m2(const struct rho_window_plot *plot)
{
    return rho_square(rho_window_larger_sigma_m(plot));
}

/* Weighted moments of a set's plots about their mean, so that no large numbers are subtracted. */
struct moments {
    /* sum of the weights 1 / sigma^2; weighted means of time and place */
    float weight, time_s, x_m, y_m;
    float tt, tx, ty; /* weighted sums of products of time and place about the means */
};

static struct moments moments_of_set(const struct search *search, const struct plot_set *set)
{
    struct moments sum = {0};
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (set->mask >> m & 1u) {
            const struct rho_window_plot *plot = rho_search_plot(search, set, m);
            float w = 1.0f / plot_variance_m2(plot);
            sum.weight += w;
            sum.time_s += w * rho_search_plot_time_s(search, set, m);
            sum.x_m += w * plot->x_m;
            sum.y_m += w * plot->y_m;
        }
    }
    sum.time_s /= sum.weight;
    sum.x_m /= sum.weight;
    sum.y_m /= sum.weight;
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (set->mask >> m & 1u) {
            const struct rho_window_plot *plot = rho_search_plot(search, set, m);
            float w = 1.0f / plot_variance_m2(plot);
            float t_s = rho_search_plot_time_s(search, set, m) - sum.time_s;
            sum.tt += w * t_s * t_s;
            sum.tx += w * t_s * (plot->x_m - sum.x_m);
            sum.ty += w * t_s * (plot->y_m - sum.y_m);
        }
    }
    return sum;
}

int rho_isotropic_fit(const struct search *search, const struct plot_set *set, struct line_fit *fit)
{
    struct moments sum = moments_of_set(search, set);
    if (!(sum.tt > 0.0f)) {
        return 0;
    }
    *fit = (struct line_fit){.vx_mps = sum.tx / sum.tt, .vy_mps = sum.ty / sum.tt};
    fit->x_m = sum.x_m - fit->vx_mps * sum.time_s;
    fit->y_m = sum.y_m - fit->vy_mps * sum.time_s;
    return 1;
}

/* Likelihood terms of a straight line; V: covariance of the plots' noise on one axis. */
struct likelihood_terms {
    float log_det_noise;  /* ln det V */
    float log_det_fisher; /* ln det A^T V^-1 A, A the line's design matrix */
    float chi2;           /* chi-square of the residual, both axes */
};

static float dot_product(unsigned n, const float *a, const float *b)
{
    float sum = 0.0f;
    for (unsigned i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/*
 * Squared residual of y off a straight line, with the columns one, t and y whitened by the noise;
 * fisher = [one.one, one.t, t.t], and its determinant. The residuals are formed before they are
 * squared, as a difference of squares would cancel.
 */
static float residual_chi2(unsigned n, const float *one, const float *t, const float *y,
                           const float fisher[3], float determinant)
{
    float by_one = dot_product(n, one, y), by_t = dot_product(n, t, y), chi2 = 0.0f;
    float place = (by_one * fisher[2] - by_t * fisher[1]) / determinant;
    float slope = (by_t * fisher[0] - by_one * fisher[1]) / determinant;
    for (unsigned i = 0; i < n; i++) {
        float residual = y[i] - place * one[i] - slope * t[i];
        chi2 += residual * residual;
    }
    return chi2;
}

/* Columns of a line's regression: a row for each plot, about the means of time and place. */
struct columns {
    float one[RHO_MAX_SCANS], t[RHO_MAX_SCANS], x[RHO_MAX_SCANS], y[RHO_MAX_SCANS];
    /* V: covariance of the plots' noise and of process noise */
    float noise[RHO_TRIANGLE(RHO_MAX_SCANS)];
};

/*
 * Likelihood terms with process noise, which correlates the scans: the columns are whitened with
 * the Cholesky factor of V. Returns 0 where V is singular.
 */
static int likelihood_with_process_noise(const struct search *search, const struct plot_set *set,
                                         struct likelihood_terms *terms)
{
    struct columns c;
    struct moments sum = moments_of_set(search, set);
    unsigned scan[RHO_MAX_SCANS], n = 0;
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (set->mask >> m & 1u) {
            const struct rho_window_plot *plot = rho_search_plot(search, set, m);
            c.one[n] = 1.0f;
            c.t[n] = rho_search_plot_time_s(search, set, m) - sum.time_s;
            c.x[n] = plot->x_m - sum.x_m;
            c.y[n] = plot->y_m - sum.y_m;
            scan[n] = m;
            for (unsigned j = 0; j <= n; j++) {
                c.noise[RHO_AT(n, j)] = search->process_m2[RHO_AT(m, scan[j])];
            }
            c.noise[RHO_AT(n, n)] += plot_variance_m2(plot);
            n++;
        }
    }
    if (rho_linalg_cholesky((int)n, c.noise, c.noise) != RHO_OK) {
        return 0;
    }
    rho_linalg_forward((int)n, c.noise, c.one);
    rho_linalg_forward((int)n, c.noise, c.t);
    rho_linalg_forward((int)n, c.noise, c.x);
    rho_linalg_forward((int)n, c.noise, c.y);
    const float fisher[3] = {dot_product(n, c.one, c.one), dot_product(n, c.one, c.t),
                             dot_product(n, c.t, c.t)};
    float determinant = fisher[0] * fisher[2] - fisher[1] * fisher[1];
    if (!(determinant > 0.0f)) {
        return 0;
    }
    terms->log_det_noise = rho_linalg_log_determinant((int)n, c.noise);
    terms->log_det_fisher = rho_log(determinant);
    terms->chi2 = residual_chi2(n, c.one, c.t, c.x, fisher, determinant) +
                  residual_chi2(n, c.one, c.t, c.y, fisher, determinant);
    return 1;
}

/* The sum over both axes has no factor 1/2, except for chi-square. */
int rho_isotropic_likelihood(const struct search *search, const struct plot_set *set,
                             struct set_score *score, float *nat)
{
    struct likelihood_terms terms;
    if (search->fit_process_m2 > 0.0f) {
        if (!likelihood_with_process_noise(search, set, &terms)) {
            return 0;
        }
    } else {
        /* without process noise V is diagonal, and all terms follow from the moments */
        struct moments sum = moments_of_set(search, set);
        float vx_mps = sum.tx / sum.tt, vy_mps = sum.ty / sum.tt;
        terms = (struct likelihood_terms){.log_det_fisher = rho_log(sum.weight * sum.tt)};
        for (unsigned m = 0; m < search->num_scans; m++) {
            if (set->mask >> m & 1u) {
                const struct rho_window_plot *plot = rho_search_plot(search, set, m);
                float t_s = rho_search_plot_time_s(search, set, m) - sum.time_s;
                float rx_m = plot->x_m - sum.x_m - vx_mps * t_s;
                float ry_m = plot->y_m - sum.y_m - vy_mps * t_s;
                float noise_m2 = plot_variance_m2(plot);
                terms.chi2 += (rx_m * rx_m + ry_m * ry_m) / noise_m2;
                terms.log_det_noise += rho_log(noise_m2);
            }
        }
    }
    score->chi2 = terms.chi2;
    score->dimensions = 2u * set->hits - 4u;
    *nat = -((float)(set->hits - 2u) * LOG_TWO_PI + terms.log_det_noise + terms.log_det_fisher +
             0.5f * terms.chi2);
    return 1;
}
