/* SPDX-License-Identifier: MIT */
/*
 * starts: phase 2 of the search. Two crossings are a constant-velocity hypothesis; those that most
 * bearings agree with are fitted to the bearings.
 */
#include <string.h>

#include "passive_search.h"
#include "policy.h"

/* Parts of a look in which agreements are kept: those of 128 looks, the most, fit 16 bits. */
#define AGREEMENT_PARTS 500.0f

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
    const struct rho_batch_bearing *a = rho_passive_bearing_of(search, point, s[0]);
    const struct rho_batch_bearing *b = rho_passive_bearing_of(search, point, s[1]);
    const float apart = search->at[k][s[0]].step - middle;
    const float by =
        apart < 0.0f || apart > 0.0f ? apart / (a->cosine * b->sine - a->sine * b->cosine) : 0.0f;
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
    float most_m = (search->passive->config.v_max_mps + SPEED_SLACK_MPS) * steps * search->half_s;
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
    state_m[RHO_PASSIVE_Z] = state_m[RHO_PASSIVE_DZ] = 0.0f;
    state_m[RHO_PASSIVE_DX] = x;
    state_m[RHO_PASSIVE_DY] = y;
    state_m[RHO_PASSIVE_X] = a->x_m - from[0][0] * x - from[0][1] * y;
    state_m[RHO_PASSIVE_Y] = a->y_m - from[1][0] * x - from[1][1] * y;
    return 1;
}

/* Lists for each crossing the later ones with which the bearings agree best. */
static void list_partners(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    const unsigned apart =
        1u + (unsigned)(PAIR_ROWS_SHARE * (float)(passive->batch.num_scans - 2u));
    const uint32_t phase_end = search->work_end;
    for (uint32_t i = 0; i < passive->num_points; i++) {
        struct rho_passive_partner *best = passive->partners[i];
        memset(best, 0, sizeof passive->partners[i]);
        /* each has a like share of the work; later ones of the newest row come first in the list */
        const uint32_t spent = passive->work.spent;
        const uint32_t left = phase_end > spent ? phase_end - spent : 0;
        rho_passive_allow(search, left / (passive->num_points - i));
        rho_passive_spend(search, passive->num_points / 8u);
        for (uint32_t j = 0; j < passive->num_points; j++) {
            float state_m[RHO_PASSIVE_STATES];
            if (passive->points[j].scan < passive->points[i].scan + apart ||
                !rho_passive_connect_crossings(search, &passive->points[i], &passive->points[j],
                                               state_m)) {
                continue;
            }
            if (!rho_passive_has_work(search)) {
                passive->work.candidates_dropped = rho_count(passive->work.candidates_dropped, 1);
                break;
            }
            unsigned place = RHO_PASSIVE_PARTNERS - 1u;
            const uint16_t agreement =
                (uint16_t)(AGREEMENT_PARTS *
                           rho_passive_agreement(search, state_m,
                                                 (float)best[place].agreement / AGREEMENT_PARTS));
            passive->work.hypotheses = rho_count(passive->work.hypotheses, 1);
            if (agreement > best[place].agreement) {
                for (; place > 0 && agreement > best[place - 1u].agreement; place--) {
                    best[place] = best[place - 1u];
                }
                best[place] = (struct rho_passive_partner){agreement, (uint16_t)j};
            }
        }
    }
}

static int claims_crossing(const struct rho_passive_candidate *candidate,
                           const struct rho_passive_point *point)
{
    const uint8_t *claim = candidate->claim[point->scan];
    const unsigned a = point->sensors / 8u, b = point->sensors % 8u;
    return claim[a] == point->claim[a] && claim[b] == point->claim[b];
}

/* Whether a candidate has the bearings of both crossings: a fit would find it again. */
static int is_found(const struct rho_passive *passive, const struct rho_passive_point *a,
                    const struct rho_passive_point *b)
{
    for (unsigned i = 0; i < passive->num_candidates; i++) {
        if (claims_crossing(&passive->candidates[i], a) &&
            claims_crossing(&passive->candidates[i], b)) {
            return 1;
        }
    }
    return 0;
}

static void claim_crossing(struct rho_passive_candidate *candidate,
                           const struct rho_passive_point *point)
{
    const unsigned a = point->sensors / 8u, b = point->sensors % 8u;
    candidate->claim[point->scan][a] = point->claim[a];
    candidate->claim[point->scan][b] = point->claim[b];
}

/* Gives a state the height that the slopes of its crossings tell. Returns 0 where none has one. */
static int find_height(const struct rho_passive_search *search, const struct rho_passive_point *a,
                       const struct rho_passive_point *b, float state_m[RHO_PASSIVE_STATES])
{
    struct rho_passive_candidate of = {.known = 0};
    memcpy(of.state_m, state_m, sizeof of.state_m);
    claim_crossing(&of, a);
    claim_crossing(&of, b);
    const int has_height = rho_passive_equate_claims(search, &of).num_slopes > 0 &&
                           rho_passive_step_to_claims(search, &of);
    memcpy(state_m, of.state_m, sizeof of.state_m);
    return has_height;
}

void rho_passive_fit_pairs(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    rho_passive_allow(search, search->work_share);
    list_partners(search);
    rho_passive_allow(search, search->work_share);
    for (unsigned fits = 0; fits < FITS_MAX;) {
        struct rho_passive_partner *best = 0;
        uint32_t of = 0;
        rho_passive_spend(search, passive->num_points / 8u);
        for (uint32_t i = 0; i < passive->num_points; i++) {
            for (unsigned n = 0; n < RHO_PASSIVE_PARTNERS; n++) {
                struct rho_passive_partner *one = &passive->partners[i][n];
                if (one->agreement > (best ? best->agreement : 0u)) {
                    best = one;
                    of = i;
                }
            }
        }
        if (!best) {
            return;
        }
        if (!rho_passive_has_work(search)) {
            passive->work.candidates_dropped = rho_count(passive->work.candidates_dropped, 1);
            return;
        }
        const struct rho_passive_point *a = &passive->points[of];
        const struct rho_passive_point *b = &passive->points[best->point];
        float state_m[RHO_PASSIVE_STATES];
        best->agreement = 0;
        if (!is_found(passive, a, b) && rho_passive_connect_crossings(search, a, b, state_m)) {
            rho_passive_fit_nearest(
                search, search->has_slopes && find_height(search, a, b, state_m), state_m);
            rho_passive_offer_if_track(search, state_m);
            fits++;
        }
    }
}
