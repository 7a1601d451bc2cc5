/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/body_extent_filter.h"

#include "policy.h"
#include "rhotrack/detail/approx.h"

/* Memory of a body's variances, as a weight. */
#define WEIGHT_MOST (PLOTS_MOST / SQUARES_OF_BODY)

/* Extent along one axis of a body before any plot: the prior's variance. */
static struct rho_body_side prior_side(float m2, float weight)
{
    return (struct rho_body_side){m2, weight, 2.0f * m2 * m2 / weight, 1.0f};
}

void rho_body_filter_init(struct rho_body_filter *body, uint32_t track_id, float prior_m2,
                          float aspect)
{
    *body = (struct rho_body_filter){
        .track_id = track_id,
        .along_m2 = prior_m2,
        .across_m2 = prior_m2,
        .prior_m2 = prior_m2,
        .aspect = aspect,
        .along = prior_side(prior_m2, PRIOR_WEIGHT),
        .across = prior_side(prior_m2, WIDTH_PRIOR_WEIGHT),
        .cos_heading = 1.0f,
        .heading_sigma_rad = RHO_PI,
        .slope_weight = SLOPE_WEIGHT,
        .plots = 1.0f,
        .plots_a_look = 1.0f,
    };
}

void rho_body_set_heading(struct rho_body_filter *body, float cos_heading, float sin_heading,
                          float sigma_rad)
{
    if (!body->has_heading) {
        const float width_m2 = body->prior_m2 / (body->aspect * body->aspect);
        body->across_m2 = width_m2;
        body->across = prior_side(width_m2, WIDTH_PRIOR_WEIGHT);
    }
    body->cos_heading = cos_heading;
    body->sin_heading = sin_heading;
    body->heading_sigma_rad = sigma_rad;
    body->has_heading = 1;
}

void rho_body_set_heading_if_moving(struct rho_body_filter *body, const float velocity_mps[2],
                                    const float covariance[3])
{
    const float speed_mps =
        rho_sqrt(velocity_mps[0] * velocity_mps[0] + velocity_mps[1] * velocity_mps[1]);
    if (!(speed_mps > 0.0f)) {
        return;
    }
    const float c = velocity_mps[0] / speed_mps, s = velocity_mps[1] / speed_mps;
    const float across_m2ps2 =
        s * s * covariance[0] - 2.0f * c * s * covariance[1] + c * c * covariance[2];
    /* of one who stops only the velocity across the line of sight is left: noise turns no body */
    const float most_m2ps2 = rho_larger(across_m2ps2, covariance[0] + covariance[2] - across_m2ps2);
    if (speed_mps * speed_mps > HEADING_SIGMAS * HEADING_SIGMAS * most_m2ps2) {
        rho_body_set_heading(body, c, s, rho_sqrt(rho_larger(across_m2ps2, 0.0f)) / speed_mps);
    }
}

void rho_body_rotate_covariance(float cos_heading, float sin_heading, const float xx_yx_yy[3],
                                float axes[3])
{
    const float c = cos_heading, s = sin_heading;
    const float xx = xx_yx_yy[0], yx = xx_yx_yy[1], yy = xx_yx_yy[2];
    axes[0] = c * c * xx + 2.0f * c * s * yx + s * s * yy;
    axes[1] = c * s * (yy - xx) + (c * c - s * s) * yx;
    axes[2] = s * s * xx - 2.0f * c * s * yx + c * c * yy;
}

float rho_body_along_bound_m2(const struct rho_body_filter *body)
{
    const float few = FEW_PLOTS / SQUARES_OF_BODY;
    return body->along_m2 + body->prior_m2 * (few / (few + body->along.weight));
}

void rho_body_place_covariance(const struct rho_body_filter *body, float xx_yx_yy[3])
{
    const float c = body->cos_heading, s = body->sin_heading;
    xx_yx_yy[0] = c * c * body->along_m2 + s * s * body->across_m2;
    xx_yx_yy[1] = c * s * (body->along_m2 - body->across_m2);
    xx_yx_yy[2] = s * s * body->along_m2 + c * c * body->across_m2;
}

/* Mean square of the heading's error: the share of the squared length that appears as width. */
static float mean_square_heading_error(const struct rho_body_filter *body)
{
    return TURNED_SHARE * body->heading_sigma_rad * body->heading_sigma_rad;
}

static float floored_along_m2(const struct rho_body_filter *body)
{
    return rho_larger(body->along_m2, body->prior_m2 / 16.0f);
}

float rho_body_mean_variance_share(const struct rho_body_filter *body, unsigned n)
{
    const float most = (float)(n > body->most_plots ? n : body->most_plots);
    return n <= 1 ? 1.0f : (most - (float)n) / (most - 1.0f) + ANEW_SHARE / (most * most);
}

/* Variance of n plots' mean square times n / 2, over v^2; v: the body's, own: the noise. */
static float relative_square_variance(float v_m2, float own_m2)
{
    const float own = own_m2 / v_m2;
    return (own + 2.0f) * own + SQUARES_OF_BODY;
}

/*
 * Updates one axis' extent by the mean square of n plots' places less their noise. The plots'
 * weight is that of a body of usual variance, so that it does not depend on the measured one.
 */
static void update_side(struct rho_body_side *side, float usual_m2, float seen_m2, float own_m2,
                        float n)
{
    const float more = n / relative_square_variance(usual_m2, own_m2);
    const float v_m2 = rho_larger(side->mean_m2, PLACE_LEAST_M2);
    side->weight *= more < WEIGHT_MOST ? 1.0f - more / WEIGHT_MOST : 0.0f;
    side->weight += more;
    const float gain = more / side->weight;
    side->mean_m2 += gain * (seen_m2 - side->mean_m2);
    side->prior_share *= 1.0f - gain;
    side->variance_m4 =
        (1.0f - gain) * (1.0f - gain) * side->variance_m4 +
        gain * gain * 2.0f / n * v_m2 * v_m2 * relative_square_variance(v_m2, own_m2);
}

void rho_body_add_plots(struct rho_body_filter *body, const struct rho_body_look *look)
{
    const float n = (float)look->num_plots;
    if (look->num_plots > body->most_plots) {
        body->most_plots = (uint16_t)look->num_plots;
    }
    if (look->num_plots == 0 || !body->has_heading) {
        return;
    }
    const float along_m2 =
        look->noise_along_m2 / n + mean_square_heading_error(body) * body->across_m2;
    update_side(&body->along, floored_along_m2(body), look->along_m2 / n - along_m2, along_m2, n);
    body->along_m2 = rho_larger(body->along.mean_m2, PLACE_LEAST_M2);
    /*
     * An error of the heading turns all plots of a look: their apparent slope is the sum of the
     * scatterers' own (learned, as it lasts) and of this error, whose expected share is subtracted.
     */
    const float usual_m2 = floored_along_m2(body) / (body->aspect * body->aspect);
    const float noise_m2 = look->noise_across_m2 / n;
    const float missed = rho_body_mean_variance_share(body, look->num_plots);
    const float sum_along_m2 = rho_larger(look->along_m2, n * PLACE_LEAST_M2);
    const float slope = look->cross_m2 / sum_along_m2;
    const float slope_variance = (noise_m2 + missed * usual_m2) / sum_along_m2;
    const float turned = mean_square_heading_error(body);
    const float k = turned / (turned + slope_variance);
    const float off = slope - body->slope, left = (1.0f - k) * (1.0f - k) * turned;
    /* number of plots whose information is used up by the heading's error */
    const float gone = 2.0f * k - k * k;
    const float squares_m2 = look->across_m2 - 2.0f * k * off * look->cross_m2 +
                             k * k * sum_along_m2 * (off * off + 1.0f / body->slope_weight);
    const float own_m2 = noise_m2 + left * body->along_m2;
    const float most_m2 = (n + rho_larger(STRAY_SQUARES, n * STRAY_SQUARES_EACH)) *
                          (rho_larger(usual_m2, body->across_m2) + own_m2);
    const float sum_m2 = rho_smaller(squares_m2, most_m2) - (n - gone) * noise_m2;
    if (n - gone > LEAST_PLOTS) {
        update_side(&body->across, usual_m2, sum_m2 / (n - missed * gone) - left * body->along_m2,
                    own_m2, n - gone);
    }
    const float more = 1.0f / (slope_variance + TURNED_LOOKS * turned);
    body->slope_weight *= 1.0f - rho_smaller(n / PLOTS_MOST, 1.0f);
    body->slope_weight += more;
    body->slope += more / body->slope_weight * off;
    body->across_m2 = rho_larger(body->across.mean_m2, body->along_m2 / (ASPECT_MAX * ASPECT_MAX));
    body->plots = rho_smaller(body->plots + n, PLOTS_MOST);
}

/*
 * Length L = root(12 v) and its sigma, dL = 6 dv / L. Besides the error of v: of N scatterers that
 * stay in their parts of the body, the variance is off by a share of 2 / N^1.5, however many looks
 * there are. turned_m2, the error due to headings, lasts too.
 */
static float side_length_m(const struct rho_body_filter *body, const struct rho_body_side *side,
                           float spread_m2, float turned_m2, float *sigma_m)
{
    const float length_m = rho_sqrt(12.0f * spread_m2);
    const float most = (float)body->most_plots;
    const float told = 1.0f - side->prior_share;
    const float stays_m = told * length_m / (most * rho_sqrt(most)) *
                          (1.0f + told * told * FEW_PLACES / (most * most * most));
    *sigma_m = rho_sqrt(stays_m * stays_m + 36.0f / (length_m * length_m) *
                                                (side->variance_m4 + turned_m2 * turned_m2));
    return length_m;
}

void rho_body_shape(const struct rho_body_filter *body, struct rho_body *shape)
{
    const float most = (float)body->most_plots;
    *shape = (struct rho_body){
        .heading_rad = rho_atan2(body->sin_heading, body->cos_heading),
        .sigma_heading_rad = body->heading_sigma_rad,
        /* the mean of N scatterers, one in each part, has a sigma of L / (N^1.5 root 12) */
        .sigma_along_m = rho_sqrt(body->along_m2 / (most * most * most)),
        .sigma_across_m = rho_sqrt(body->across_m2 / (most * most * most)),
        .plots = body->plots,
    };
    /* a heading error e, at most as uncertain as the slope s, adds (s + e)^2 - s^2 to its square */
    const float turned = rho_smaller(mean_square_heading_error(body), 1.0f / body->slope_weight);
    const float off = rho_sqrt(turned * (turned + 4.0f * body->slope * body->slope));
    shape->length_m = side_length_m(body, &body->along, body->along_m2, turned * body->across_m2,
                                    &shape->sigma_length_m);
    shape->width_m = side_length_m(body, &body->across, body->across_m2, off * body->along_m2,
                                   &shape->sigma_width_m);
}
