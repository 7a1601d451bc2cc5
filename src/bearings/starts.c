/* SPDX-License-Identifier: MIT */
/*
 * starts: phase 3 of the search. Two crossings of a line are a constant-velocity hypothesis; those
 * that most bearings agree with are fitted to the bearings.
 */
#include "passive_search.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/types.h"

/* Indices of two crossings in passive->points; crossing a is of an earlier scan than crossing b. */
struct pair {
    uint16_t a, b;
};

/* The pairs of crossings with the highest agreement so far, best first. */
struct best_pairs {
    unsigned count;
    float agreement[FITS_PER_LINE];
    struct pair pair[FITS_PER_LINE];
};

/* Lists the indices of the crossings on a line, within their errors. Returns their number. */
static unsigned collect_crossings(const struct rho_passive_search *search,
                                  const struct rho_passive_line *line, uint16_t *index)
{
    const struct rho_passive *passive = search->passive;
    float least_m = LINE_CELLS * passive->config.rho_cell_m;
    unsigned count = 0;
    for (uint32_t i = 0; i < passive->num_points; i++) {
        const struct rho_passive_point *point = &passive->points[i];
        float off_m = point->x_m * line->cosine + point->y_m * line->sine - line->rho_m;
        float reach_m = SPREAD_SIGMAS * rho_passive_rho_sigma_m(point, line->cosine, line->sine);
        reach_m = reach_m > least_m ? reach_m : least_m;
        if (!(off_m < reach_m && -off_m < reach_m)) {
            continue;
        }
        if (count < LINE_POINTS_MAX) {
            index[count++] = (uint16_t)i;
        } else {
            search->passive->work.line_points_dropped =
                rho_count(search->passive->work.line_points_dropped, 1);
        }
    }
    return count;
}

/*
 * The 2 x 2 matrix that takes a target's displacement to how far from its middle place the rays of
 * bearings of two times meet: R^-1 diag(step) R, with the rows of R across the rays, and the middle
 * step times the unit matrix where the times are one.
 */
static void crossing_times(const struct rho_passive_search *search,
                           const struct rho_passive_point *point, float times[2][2])
{
    const unsigned k = point->scan, s[2] = {point->sensors / 8u, point->sensors % 8u};
    const float middle = rho_passive_crossing_step(search, point);
    const struct rho_batch_bearing *a =
        &search->passive->batch.bearings[k][s[0]][point->bearing[0]];
    const struct rho_batch_bearing *b =
        &search->passive->batch.bearings[k][s[1]][point->bearing[1]];
    const float apart = search->at[k][s[0]].step - middle;
    const float by = apart < 0.0f || apart > 0.0f
                         ? apart / (a->cosine * b->sine - a->sine * b->cosine)
                         : 0.0f;
    const float mixed = by * (a->sine * b->cosine + a->cosine * b->sine);
    times[0][0] = middle - mixed;
    times[0][1] = 2.0f * by * a->cosine * b->cosine;
    times[1][0] = -2.0f * by * a->sine * b->sine;
    times[1][1] = middle + mixed;
}

/* Solves (times of b - times of a) d = b - a: four bearings, each linear in place and velocity. */
int rho_passive_connect_crossings(const struct rho_passive_search *search,
                                  const struct rho_passive_point *a,
                                  const struct rho_passive_point *b,
                                  float state_m[RHO_PASSIVE_STATES])
{
    float steps = rho_passive_crossing_step(search, b) - rho_passive_crossing_step(search, a);
    float dx_m = b->x_m - a->x_m, dy_m = b->y_m - a->y_m;
    float most_m =
        (search->passive->config.v_max_mps + SPEED_SLACK_MPS) * steps * search->half_s;
    float way2_m2 = dx_m * dx_m + dy_m * dy_m;
    /* uncertainty of the crossings is added only where needed: it costs a square root */
    if (way2_m2 > most_m * most_m) {
        most_m += rho_sqrt(rho_passive_uncertainty_m2(a) + rho_passive_uncertainty_m2(b));
        if (way2_m2 > most_m * most_m) {
            return 0;
        }
    }
    float from[2][2], to[2][2];
    crossing_times(search, a, from);
    crossing_times(search, b, to);
    const float xx = to[0][0] - from[0][0], xy = to[0][1] - from[0][1];
    const float yx = to[1][0] - from[1][0], yy = to[1][1] - from[1][1];
    const float size = xx * yy - xy * yx;
    if (!(size > 0.1f * steps * steps)) {
        return 0;
    }
    const float x = (yy * dx_m - xy * dy_m) / size, y = (xx * dy_m - yx * dx_m) / size;
    state_m[RHO_PASSIVE_DX] = x;
    state_m[RHO_PASSIVE_DY] = y;
    state_m[RHO_PASSIVE_X] = a->x_m - from[0][0] * x - from[0][1] * y;
    state_m[RHO_PASSIVE_Y] = a->y_m - from[1][0] * x - from[1][1] * y;
    return 1;
}

/* Lists the pairs of a line's crossings that agree best with the bearings. */
static void list_best_pairs(struct rho_passive_search *search, const uint16_t *index,
                            unsigned count, struct best_pairs *best)
{
    struct rho_passive *passive = search->passive;
    for (unsigned i = 0; i < count; i++) {
        unsigned scan_min = passive->points[index[i]].scan + (passive->batch.num_scans + 1u) / 3u;
        for (unsigned j = 0; j < count; j++) {
            struct pair pair = {index[i], index[j]};
            float state_m[RHO_PASSIVE_STATES];
            if (passive->points[pair.b].scan < scan_min ||
                !rho_passive_connect_crossings(search, &passive->points[pair.a],
                                               &passive->points[pair.b], state_m)) {
                continue;
            }
            float least = best->count < FITS_PER_LINE ? -1.0f : best->agreement[FITS_PER_LINE - 1u];
            float agreement = rho_passive_agreement(search, state_m, least);
            passive->work.hypotheses = rho_count(passive->work.hypotheses, 1);
            if (!(agreement > least)) {
                continue;
            }
            unsigned place = best->count < FITS_PER_LINE ? best->count++ : FITS_PER_LINE - 1u;
            for (; place > 0 && agreement > best->agreement[place - 1u]; place--) {
                best->agreement[place] = best->agreement[place - 1u];
                best->pair[place] = best->pair[place - 1u];
            }
            best->agreement[place] = agreement;
            best->pair[place] = pair;
        }
    }
}

void rho_passive_fit_line_pairs(struct rho_passive_search *search,
                                const struct rho_passive_line *line)
{
    uint16_t index[LINE_POINTS_MAX];
    struct best_pairs best = {.count = 0};
    list_best_pairs(search, index, collect_crossings(search, line, index), &best);
    for (unsigned i = 0; i < best.count; i++) {
        const struct pair pair = best.pair[i];
        /* the entry of the pair in the table of fitted pairs, which may hold another pair */
        struct rho_passive_fitted *fitted =
            &search->passive->fitted[(pair.a * 61u + pair.b) % RHO_PASSIVE_PAIRS];
        float state_m[RHO_PASSIVE_STATES];
        /*
         * Neighbouring lines share pairs of crossings. Fitting a pair again gives no track if it
         * gave none before; otherwise it gives a duplicate, unless a candidate has been removed.
         */
        int is_useless = fitted->a == pair.a && fitted->b == pair.b &&
                         (fitted->when == UINT16_MAX || fitted->when == search->candidates_removed);
        const struct rho_passive_point *points = search->passive->points;
        if (is_useless || !rho_passive_connect_crossings(search, &points[pair.a], &points[pair.b],
                                                         state_m)) {
            continue;
        }
        rho_passive_fit_nearest(search, state_m, 0);
        int is_track = rho_passive_offer_if_track(search, state_m);
        *fitted = (struct rho_passive_fitted){
            .a = pair.a, .b = pair.b, .when = is_track ? search->candidates_removed : UINT16_MAX};
    }
}
