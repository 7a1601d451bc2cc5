/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/body_filter.h"

#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"

/* Plots that are remembered. */
#define PLOTS_REMEMBERED 500.0f
/* A speed of so many standard deviations has a direction. */
#define HEADING_SIGMAS 3.0f
/* Velocities are so much better than filters that expect manoeuvres say: share of the variance. */
#define TURNED_SHARE 0.7f
/* Plots that tell the length for a gate. */
#define FEW_PLOTS 4.0f
/* A body of which nothing but the heading is known is so many times as long as wide. */
#define ASPECT_PRIOR 3.0f
/* What the prior counts, and the least that any plots do. */
#define PRIOR_PLOTS 0.3f
#define WEIGHT_LEAST 0.01f
/* A body is usually so many times as long as wide, in the weight of its plots. */
#define ASPECT_USUAL 6.0f
/* It is never longer than so many times its width. */
#define ASPECT_MAX 16.0f
/* The least variance of a place on a body: 0.1 m of length. */
#define LEAST_M2 1e-3f

void rho_body_start(struct rho_body_filter *body, uint32_t track_id, float prior_m2)
{
    *body = (struct rho_body_filter){
        .track_id = track_id,
        .along_m2 = prior_m2,
        .across_m2 = prior_m2,
        .across_mean_m2 = prior_m2,
        .prior_m2 = prior_m2,
        .along_weight = PRIOR_PLOTS,
        .across_weight = PRIOR_PLOTS,
        .cos_heading = 1.0f,
        .heading_sigma_rad = RHO_PI,
        .plots = 1.0f,
    };
}

void rho_body_turn(struct rho_body_filter *body, const float velocity_mps[2],
                   const float covariance[3])
{
    const float speed_mps =
        rho_sqrt(velocity_mps[0] * velocity_mps[0] + velocity_mps[1] * velocity_mps[1]);
    if (!(speed_mps > 0.0f)) {
        return;
    }
    const float c = velocity_mps[0] / speed_mps, s = velocity_mps[1] / speed_mps;
    const float across_mps =
        rho_sqrt(s * s * covariance[0] - 2.0f * c * s * covariance[1] + c * c * covariance[2]);
    if (!(speed_mps > HEADING_SIGMAS * across_mps)) {
        return;
    }
    if (!body->has_heading) {
        body->across_m2 = body->across_mean_m2 = body->prior_m2 / (ASPECT_PRIOR * ASPECT_PRIOR);
    }
    body->cos_heading = c;
    body->sin_heading = s;
    body->heading_sigma_rad = across_mps / speed_mps;
    body->has_heading = 1;
}

void rho_body_to_axes(const struct rho_body_filter *body, const float xx_yx_yy[3], float axes[3])
{
    const float c = body->cos_heading, s = body->sin_heading;
    const float xx = xx_yx_yy[0], yx = xx_yx_yy[1], yy = xx_yx_yy[2];
    axes[0] = c * c * xx + 2.0f * c * s * yx + s * s * yy;
    axes[1] = c * s * (yy - xx) + (c * c - s * s) * yx;
    axes[2] = s * s * xx - 2.0f * c * s * yx + c * c * yy;
}

float rho_body_most_along_m2(const struct rho_body_filter *body)
{
    return body->along_m2 + body->prior_m2 * (FEW_PLOTS / (FEW_PLOTS + body->along_weight));
}

void rho_body_spread(const struct rho_body_filter *body, float xx_yx_yy[3])
{
    const float c = body->cos_heading, s = body->sin_heading;
    xx_yx_yy[0] = c * c * body->along_m2 + s * s * body->across_m2;
    xx_yx_yy[1] = c * s * (body->along_m2 - body->across_m2);
    xx_yx_yy[2] = s * s * body->along_m2 + c * c * body->across_m2;
}

/* The share of the length that is taken for width: mean square of the heading's error. */
static float turned_of(const struct rho_body_filter *body)
{
    return TURNED_SHARE * body->heading_sigma_rad * body->heading_sigma_rad;
}

static float usual_along_m2(const struct rho_body_filter *body)
{
    const float least_m2 = body->prior_m2 / 16.0f;
    return body->along_m2 > least_m2 ? body->along_m2 : least_m2;
}

static float usual_across_m2(const struct rho_body_filter *body)
{
    return usual_along_m2(body) / (ASPECT_USUAL * ASPECT_USUAL);
}

/*
 * One axis: the mean of the squares of n plots, less what is not the body's. Its variance is
 * 2 (v + own)^2 / n: with v as a body of this length has it, whatever the mean is now, it counts as
 * n (v / (v + own))^2 plots without noise.
 */
static void learn(float *mean_m2, float *weight, float kept, float usual_m2, float squares_m2,
                  float own_m2, float n)
{
    const float share = usual_m2 / (usual_m2 + own_m2);
    const float more = n * share * share;
    *weight = kept * *weight + more;
    *mean_m2 += more / *weight * (squares_m2 / n - own_m2 - *mean_m2);
    *weight = *weight > WEIGHT_LEAST ? *weight : WEIGHT_LEAST;
}

void rho_body_add(struct rho_body_filter *body, const struct rho_body_look *look)
{
    const float n = (float)look->num_plots;
    if (look->num_plots > body->most_plots) {
        body->most_plots = (uint16_t)look->num_plots;
    }
    if (look->num_plots == 0 || !body->has_heading) {
        return;
    }
    const float kept = n < PLOTS_REMEMBERED ? 1.0f - n / PLOTS_REMEMBERED : 0.0f;
    const float turned = turned_of(body);
    const float along_m2 = look->noise_along_m2 / n + turned * body->across_m2;
    const float across_m2 = look->noise_across_m2 / n + turned * body->along_m2;
    learn(&body->along_m2, &body->along_weight, kept, usual_along_m2(body), look->along_m2,
          along_m2, n);
    body->along_m2 = body->along_m2 > LEAST_M2 ? body->along_m2 : LEAST_M2;
    learn(&body->across_mean_m2, &body->across_weight, kept, usual_across_m2(body), look->across_m2,
          across_m2, n);
    const float least_m2 = body->along_m2 / (ASPECT_MAX * ASPECT_MAX);
    body->across_m2 = body->across_mean_m2 > least_m2 ? body->across_mean_m2 : least_m2;
    body->plots = kept * body->plots + n;
}

/*
 * L = root(12 v): dL = 6 dv / L, and dv = root(2 / weight) v. Beside it: of scatterers that stay
 * where they are, each anywhere in its part of the body, N are seen, whose own variance is off by
 * a share of 2 / N^1.5, however many looks there are. And what headings add lasts: turned_m2.
 */
static float side_m(const struct rho_body_filter *body, float spread_m2, float usual_m2,
                    float turned_m2, float weight, float *sigma_m)
{
    const float length_m = rho_sqrt(12.0f * spread_m2);
    const float most = (float)body->most_plots;
    const float stays_m = length_m / (most * rho_sqrt(most));
    const float drawn_m =
        6.0f * (spread_m2 > usual_m2 ? spread_m2 : usual_m2) * rho_sqrt(2.0f / weight) / length_m;
    const float turned_m = 6.0f * turned_m2 / length_m;
    *sigma_m = rho_sqrt(drawn_m * drawn_m + stays_m * stays_m + turned_m * turned_m);
    return length_m;
}

void rho_body_shape(const struct rho_body_filter *body, struct rho_body *shape)
{
    const float most = (float)body->most_plots;
    *shape = (struct rho_body){
        .heading_rad = rho_atan2(body->sin_heading, body->cos_heading),
        .sigma_heading_rad = body->heading_sigma_rad,
        /* the mean of such scatterers is off by L / N^1.5 root 12 */
        .sigma_along_m = rho_sqrt(body->along_m2 / (most * most * most)),
        .sigma_across_m = rho_sqrt(body->across_m2 / (most * most * most)),
        .plots = body->plots,
    };
    const float turned = turned_of(body);
    shape->length_m = side_m(body, body->along_m2, usual_along_m2(body), turned * body->across_m2,
                             body->along_weight, &shape->sigma_length_m);
    shape->width_m = side_m(body, body->across_m2, usual_across_m2(body), turned * body->along_m2,
                            body->across_weight, &shape->sigma_width_m);
}
