/* SPDX-License-Identifier: MIT */
/*
 * start_thresholds: chooses M, and the scores that start and confirm a track, so that clutter alone
 * makes no more tracks than wanted.
 *
 * false_track_rate tells the expected number of sets of clutter plots that reach a score at once.
 * Besides, tentative false tracks climb to the confirm threshold by further clutter plots. The
 * thresholds are those at which the sum of both equals the wanted rate.
 */

#include <float.h>

#include "candidates.h"
#include "clutter_density.h"
#include "false_track_rate.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "target_model.h"

/* Accuracy of the numbers. */
enum {
    BISECTIONS = 16, /* of a threshold */
    STEPS = 12,      /* of the integral over the scores at which tentative tracks start */
    CLIMBS = 48,     /* steps of CLIMB_STEP in the table of probabilities to climb */
    CLIMB_SWEEPS = 4,
};

/*
 * Expected number of false tracks with votes of any h of the N scans: C(N, h) times the number for
 * h scans spread evenly over the window, density^h sigma^(2h-4) V(c) A pi (v_max^2 - v_min^2) h
 * Stt, where V is the ball of 2h - 4 dimensions and Stt the spread of the scan times (src/DESIGN.md
 * derives it). sigma: the largest of the scans, with process noise.
 */
static float expected_false_tracks(const struct search *search, unsigned h)
{
    const struct rho_initiator_config *config = &search->initiator->config;
    float span_s = search->time_s[search->num_scans - 1u] - search->time_s[0];
    float spread_s2 = (float)(h * (h + 1u)) * span_s * span_s / (12.0f * (float)(h - 1u));
    float log_subsets = rho_log_factorial(search->num_scans) - rho_log_factorial(h) -
                        rho_log_factorial(search->num_scans - h);
    float sigma_m = RHO_LIMIT_SIGMA_MIN, degrees = (float)(2u * h - 4u);
    for (unsigned m = 0; m < search->num_scans; m++) {
        sigma_m = rho_larger(rho_search_scan(search, m)->sigma_max_m, sigma_m);
    }
    sigma_m = rho_sqrt(sigma_m * sigma_m + search->fit_process_m2);
    float log_ball =
        0.5f * degrees * (LOG_PI + rho_log(rho_chi2_quantile(2u * h - 4u, SIGMAS_95))) -
        rho_log_factorial(h - 2u);
    float speeds = config->v_max_mps * config->v_max_mps - config->v_min_mps * config->v_min_mps;
    float log_tracks = (float)h * rho_log(search->initiator->density_per_m2) +
                       degrees * rho_log(sigma_m) + log_ball +
                       rho_log(rho_density_area_m2(search->initiator)) + LOG_PI + rho_log(speeds) +
                       rho_log((float)h * spread_s2);
    return rho_exp(log_subsets + log_tracks);
}

struct climb_table {
    float of[CLIMBS]; /* probability by the lacking score u, at the middle of each step */
};

/*
 * Probability that clutter lifts the score of a tentative track by u_nat or more before it is
 * dropped, from the table. In every scan a clutter plot in the gate adds between gain_nat and that
 * less half the gate, uniformly, with density pd e^-gain_nat; else the score loses the miss:
 *
 *     climb(u) = integral of density climb(u - gain) d gain + (1 - P(hit)) climb(u + miss)
 *     climb(u <= 0) = 1
 *
 * The table is solved in a few sweeps, from the values nearest to 1 on.
 */
static float climb_probability(const struct climb_table *climbs, float u_nat)
{
    float place = u_nat / CLIMB_STEP;
    return u_nat <= 0.0f ? 1.0f : place < (float)CLIMBS ? climbs->of[(int)place] : 0.0f;
}

static void solve_climbs(struct climb_table *climbs, const struct false_tracks *model,
                         float start_nat)
{
    const struct search *search = model->search;
    const unsigned newest = search->num_scans - 1u;
    const float gain_nat = rho_false_tracks_least_gain(model); /* score that a perfect hit adds */
    const float miss_nat = -search->log_miss[newest];          /* and that a miss takes */
    /* steps of CLIMB_STEP in half the gate, and the probability of a hit in each */
    const unsigned gains = (unsigned)(0.5f * RHO_GATE_CHI2_2D / CLIMB_STEP);
    float each = rho_false_tracks_staying(model, start_nat) * CLIMB_STEP *
                 rho_exp(search->log_pd[newest] - gain_nat);
    if (each * (float)gains > 1.0f) {
        /* clutter in every gate: the track takes only one of several plots */
        each = 1.0f / (float)gains;
    }
    const float missed = 1.0f - each * (float)gains;
    for (int u = 0; u < CLIMBS; u++) {
        climbs->of[u] = 0.0f;
    }
    for (int sweep = 0; sweep < CLIMB_SWEEPS; sweep++) {
        for (int u = 0; u < CLIMBS; u++) {
            float at = CLIMB_STEP * ((float)u + 0.5f), sum = 0.0f;
            for (unsigned i = 0; i < gains; i++) {
                sum += climb_probability(climbs, at - gain_nat + CLIMB_STEP * ((float)i + 0.5f));
            }
            climbs->of[u] = each * sum + missed * climb_probability(climbs, at + miss_nat);
        }
    }
}

/*
 * True where more false tracks are confirmed at the threshold s_nat than wanted: sets that reach it
 * at once, and sets that start below, from start_nat on, and climb. Sets not summed yet, up to
 * at_start, climb with a smaller probability than those summed so far, which mostly decides early.
 */
static int clutter_confirms_more_than(const struct climb_table *climbs,
                                      const struct false_tracks *model, float s_nat,
                                      float start_nat, float at_start, float wanted)
{
    float above = rho_false_tracks_above(model, s_nat, start_nat, FLT_MAX), sum = above;
    float lowest = s_nat - start_nat < CLIMB_STEP * (float)CLIMBS
                       ? start_nat
                       : s_nat - CLIMB_STEP * (float)CLIMBS;
    float step = (s_nat - lowest) / (float)STEPS;
    for (int i = 1; i <= STEPS; i++) {
        float climbs_up = climb_probability(climbs, step * ((float)i - 0.5f));
        if (sum > wanted || sum + (at_start - above) * climbs_up <= wanted) {
            break;
        }
        float below = rho_false_tracks_above(model, s_nat - step * (float)i, start_nat, FLT_MAX);
        sum += (below - above) * climbs_up;
        above = below;
    }
    return sum > wanted;
}

/* The lowest start threshold that lets FALSE_STARTS_MAX sets of clutter start, or fewer. */
static float find_start_threshold(const struct false_tracks *model)
{
    float low = THRESHOLD_MIN_NAT, high = THRESHOLD_MAX_NAT;
    if (rho_false_tracks_above(model, low, low, FALSE_STARTS_MAX) <= FALSE_STARTS_MAX) {
        return low;
    }
    for (int i = 0; i < BISECTIONS; i++) {
        float middle = 0.5f * (low + high);
        if (rho_false_tracks_above(model, middle, middle, FALSE_STARTS_MAX) > FALSE_STARTS_MAX) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return high;
}

static float find_confirm_threshold(const struct false_tracks *model, float wanted, float start_nat)
{
    struct climb_table climbs;
    float low = start_nat, high = THRESHOLD_MAX_NAT;
    float at_start = rho_false_tracks_above(model, start_nat, start_nat, FLT_MAX);
    if (at_start <= wanted) {
        return low;
    }
    solve_climbs(&climbs, model, start_nat);
    for (int i = 0; i < BISECTIONS; i++) {
        float middle = 0.5f * (low + high);
        if (clutter_confirms_more_than(&climbs, model, middle, start_nat, at_start, wanted)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return high;
}

static void store_thresholds(struct search *search, unsigned min_scans, float start_nat,
                             float confirm_nat)
{
    search->min_scans = min_scans;
    search->score_min_nat = start_nat;
    search->initiator->start_mnat = rho_nat_to_mnat(start_nat);
    search->initiator->confirm_mnat = rho_nat_to_mnat(confirm_nat);
}

/*
 * M is the fewest hits whose start threshold a target is likely to reach. Where there is none, a
 * full window starts sets with hits in all scans; a window that still fills starts none: M is then
 * beyond the number of scans held.
 */
void rho_thresholds_update(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    const struct rho_initiator_config *config = &initiator->config;
    const unsigned num_scans = search->num_scans;
    float start_nat = THRESHOLD_MAX_NAT;
    struct false_tracks model;
    rho_false_tracks_model(search, &model);
    model.least_hits = config->min_scans > 3u ? config->min_scans : 3u;
    for (; model.least_hits <= num_scans; model.least_hits++) {
        start_nat = find_start_threshold(&model);
        if (model.num_classes == 0 || rho_false_tracks_let_start(&model, start_nat)) {
            break;
        }
    }
    unsigned min_scans = model.least_hits;
    if (min_scans > num_scans) {
        model.least_hits = num_scans;
        min_scans = num_scans == config->scans ? num_scans : num_scans + 1u;
    }
    if (HAS_SPAN_HITS) {
        /* long spans have room for more misses, which lower the score: they need more hits */
        initiator->thin_clutter = THIN_SHARE * rho_false_tracks_thinnest(&model);
        for (unsigned first = 0; first < RHO_MAX_SCANS; first++) {
            initiator->span_hits[first] =
                (uint8_t)rho_false_tracks_least_hits(&model, first, start_nat);
        }
    }
    const float wanted = config->false_tracks_per_hour * search->interval_s / 3600.0f;
    store_thresholds(search, min_scans, start_nat,
                     find_confirm_threshold(&model, wanted, start_nat));
}

/*
 * Without a false-track rate to keep, one threshold starts and confirms tracks. A further sector of
 * a revolution keeps those of the first sector.
 */
void rho_thresholds_set(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    const struct rho_initiator_config *config = &initiator->config;
    if (search->is_continued) {
        search->min_scans = initiator->min_scans;
        search->score_min_nat = (float)initiator->start_mnat * 0.001f;
        return;
    }
    if (search->keeps_rate && search->num_scans >= 3) {
        rho_thresholds_update(search);
    } else {
        unsigned min_scans = config->min_scans;
        if (min_scans == 0) {
            min_scans = search->keeps_rate ? 3u : search->num_scans;
            /* of a batch: the fewest votes that make few false tracks, N where none do */
            float sum = min_scans > 3 ? expected_false_tracks(search, min_scans) : 0.0f;
            while (min_scans > 3) {
                sum += expected_false_tracks(search, min_scans - 1u);
                if (!(sum <= FALSE_STARTS_MAX)) {
                    break;
                }
                min_scans--;
            }
        }
        store_thresholds(search, min_scans, config->score_min_nat, config->score_min_nat);
    }
    initiator->min_scans = (uint16_t)search->min_scans;
}

/*
 * ln of the prior of a turn. The expected sets of clutter that reach the score s are at most S
 * TURNING_SHARE / 2 e^-s, with S scans in which they may begin, as the score is a likelihood ratio.
 * Where more than TURNING_SHARE of the wanted false tracks would pass, the prior is lowered.
 */
float rho_thresholds_log_turn(const struct search *search)
{
    const struct rho_initiator *initiator = search->initiator;
    float wanted = initiator->config.false_tracks_per_hour * search->interval_s / 3600.0f;
    if (!search->keeps_rate || !(wanted > 0.0f)) {
        return rho_log(TURNING_SHARE);
    }
    float log_sets = rho_log(0.5f * (float)search->num_scans);
    float start_nat = log_sets - rho_log(FALSE_STARTS_MAX) - 0.001f * (float)initiator->start_mnat;
    float confirm_nat = log_sets - rho_log(wanted) - 0.001f * (float)initiator->confirm_mnat;
    float more_nat = start_nat > confirm_nat ? start_nat : confirm_nat;
    return rho_log(TURNING_SHARE) - (more_nat > 0.0f ? more_nat : 0.0f);
}
