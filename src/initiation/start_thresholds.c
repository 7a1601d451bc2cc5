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

#include "false_track_rate.h"
#include "rhotrack/detail/approx.h"

/*
 * Most sets of clutter plots that may start a tentative track, expected a search; later scans
 * confirm or drop such tracks.
 */
#define FALSE_STARTS_MAX 0.1f

/* Bounds of thresholds, in nats. Every track in the gates reaches the lower bound. */
#define THRESHOLD_MIN_NAT (-10.0f)
#define THRESHOLD_MAX_NAT 60.0f
#define BISECTIONS 16

#define STEPS 12 /* steps of the integral over the scores at which tentative tracks start */

/*
 * Table of the probability that a tentative track of clutter climbs to the confirm threshold, by
 * the score that it still lacks: step in nats, number of steps, and sweeps of the solution.
 */
#define CLIMB_STEP 0.5f
#define CLIMBS 48
#define CLIMB_SWEEPS 4

/*
 * Prior share of targets that turn, and share of the wanted false tracks that turning sets may add.
 */
#define TURNING_SHARE 0.1f

/*
 * Most false tracks expected of a batch. M is the smallest number of votes that keeps this limit,
 * or N where none does.
 */
#define FALSE_TRACKS_MAX 0.1f

/*
 * Clutter counts as thin below this share of the thinnest sampled clutter: places of one class
 * differ by about as much.
 */
#define THIN_SHARE 0.9f

/* Scores that start and confirm tracks, and the least number of votes. */
struct thresholds {
    float start_nat, confirm_nat;
    unsigned min_scans;
};

/* ---- votes of a batch ------------------------------------------------------------------------ */

/*
 * ln of the expected number of false tracks with votes in h given scans: density^h sigma^(2h-4)
 * V(c) A pi (v_max^2 - v_min^2) h Stt, where V is the ball of 2h - 4 dimensions and Stt the spread
 * of the scan times (src/DESIGN.md derives it).
 */
static float log_false_tracks_in_scans(const struct search *search, unsigned h, float sigma_m,
                                       float spread_s2)
{
    const struct rho_initiator_config *config = &search->initiator->config;
    float degrees = (float)(2u * h - 4u);
    float log_ball =
        0.5f * degrees * (LOG_PI + rho_log(rho_initiator_chi2_limit(2u * h - 4u, SIGMAS_95))) -
        rho_initiator_log_factorial(h - 2u);
    float speeds = config->v_max_mps * config->v_max_mps - config->v_min_mps * config->v_min_mps;
    return (float)h * rho_log(search->initiator->density_per_m2) + degrees * rho_log(sigma_m) +
           log_ball + rho_log(rho_initiator_area_m2(search->initiator)) + LOG_PI + rho_log(speeds) +
           rho_log((float)h * spread_s2);
}

static float largest_sigma_with_process_noise_m(const struct search *search)
{
    float sigma_m = RHO_LIMIT_SIGMA_MIN;
    for (unsigned m = 0; m < search->num_scans; m++) {
        float scan_m = rho_window_scan_at(&search->initiator->window, m)->sigma_max_m;
        sigma_m = scan_m > sigma_m ? scan_m : sigma_m;
    }
    return rho_sqrt(sigma_m * sigma_m + search->fit_process_m2);
}

/*
 * Expected number of false tracks with votes of any h of the N scans: C(N, h) times the number for
 * h scans spread evenly over the window.
 */
static float expected_false_tracks(const struct search *search, unsigned h)
{
    float span_s = search->time_s[search->num_scans - 1u] - search->time_s[0];
    float spread_s2 = (float)(h * (h + 1u)) * span_s * span_s / (12.0f * (float)(h - 1u));
    float log_subsets = rho_initiator_log_factorial(search->num_scans) -
                        rho_initiator_log_factorial(h) -
                        rho_initiator_log_factorial(search->num_scans - h);
    return rho_exp(log_subsets +
                   log_false_tracks_in_scans(search, h, largest_sigma_with_process_noise_m(search),
                                             spread_s2));
}

static unsigned choose_min_votes(const struct search *search)
{
    unsigned m = search->num_scans;
    float model = m > 3 ? expected_false_tracks(search, m) : 0.0f;
    while (m > 3) {
        model += expected_false_tracks(search, m - 1u);
        if (!(model <= FALSE_TRACKS_MAX)) {
            break;
        }
        m--;
    }
    return m;
}

/* ---- tentative tracks ------------------------------------------------------------------------ */

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
    if (u_nat <= 0.0f) {
        return 1.0f;
    }
    return place < (float)CLIMBS ? climbs->of[(int)place] : 0.0f;
}

/* Change of a tentative false track's score in one scan. */
struct clutter_gain {
    float gain_nat; /* score that a perfect hit adds */
    float each;     /* probability of a hit in each step of CLIMB_STEP below gain_nat */
    unsigned gains; /* number of such steps: half the gate */
    float miss_nat; /* score lost by a miss, positive */
};

static struct clutter_gain model_score_gain_per_scan_by_clutter(const struct false_tracks *model,
                                                                float start_nat)
{
    const struct search *search = model->search;
    unsigned newest = search->num_scans - 1u;
    struct clutter_gain gain = {.gain_nat = rho_initiator_least_gain_of_hit(model),
                                .gains = (unsigned)(0.5f * RHO_GATE_CHI2_2D / CLIMB_STEP),
                                .miss_nat = -search->log_miss[newest]};
    gain.each = rho_initiator_false_track_share_staying_in_area(model, start_nat) * CLIMB_STEP *
                rho_exp(search->log_pd[newest] - gain.gain_nat);
    if (gain.each * (float)gain.gains > 1.0f) {
        /* clutter in every gate: the track takes only one of several plots */
        gain.each = 1.0f / (float)gain.gains;
    }
    return gain;
}

static void solve_climb_probabilities(struct climb_table *climbs, const struct false_tracks *model,
                                      float start_nat)
{
    struct clutter_gain gain = model_score_gain_per_scan_by_clutter(model, start_nat);
    float missed = 1.0f - gain.each * (float)gain.gains;
    for (int u = 0; u < CLIMBS; u++) {
        climbs->of[u] = 0.0f;
    }
    for (int sweep = 0; sweep < CLIMB_SWEEPS; sweep++) {
        for (int u = 0; u < CLIMBS; u++) {
            float at = CLIMB_STEP * ((float)u + 0.5f), sum = 0.0f;
            for (unsigned i = 0; i < gain.gains; i++) {
                sum +=
                    climb_probability(climbs, at - gain.gain_nat + CLIMB_STEP * ((float)i + 0.5f));
            }
            climbs->of[u] =
                gain.each * sum + missed * climb_probability(climbs, at + gain.miss_nat);
        }
    }
}

/* ---- thresholds ------------------------------------------------------------------------------ */

/*
 * True where more false tracks are confirmed at the threshold s_nat than wanted: sets that reach it
 * at once, and sets that start below, from start_nat on, and climb. Sets not summed yet, up to
 * at_start, climb with a smaller probability than those summed so far, which mostly decides early.
 */
static int clutter_confirms_more_than(const struct climb_table *climbs,
                                      const struct false_tracks *model, float s_nat,
                                      float start_nat, float at_start, float wanted)
{
    float above = rho_initiator_false_sets_newly_above(model, s_nat, start_nat, FLT_MAX),
          sum = above;
    float lowest = s_nat - start_nat < CLIMB_STEP * (float)CLIMBS
                       ? start_nat
                       : s_nat - CLIMB_STEP * (float)CLIMBS;
    float step = (s_nat - lowest) / (float)STEPS;
    for (int i = 1; i <= STEPS; i++) {
        float climbs_up = climb_probability(climbs, step * ((float)i - 0.5f));
        if (sum > wanted || sum + (at_start - above) * climbs_up <= wanted) {
            break;
        }
        float below = rho_initiator_false_sets_newly_above(model, s_nat - step * (float)i,
                                                           start_nat, FLT_MAX);
        sum += (below - above) * climbs_up;
        above = below;
    }
    return sum > wanted;
}

/*
 * The lowest start threshold at which no more than FALSE_STARTS_MAX sets of clutter start a track.
 */
static float find_threshold_limiting_false_starts(const struct false_tracks *model)
{
    float low = THRESHOLD_MIN_NAT, high = THRESHOLD_MAX_NAT;
    if (rho_initiator_false_sets_newly_above(model, low, low, FALSE_STARTS_MAX) <=
        FALSE_STARTS_MAX) {
        return low;
    }
    for (int i = 0; i < BISECTIONS; i++) {
        float middle = 0.5f * (low + high);
        if (rho_initiator_false_sets_newly_above(model, middle, middle, FALSE_STARTS_MAX) >
            FALSE_STARTS_MAX) {
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
    float at_start = rho_initiator_false_sets_newly_above(model, start_nat, start_nat, FLT_MAX);
    if (at_start <= wanted) {
        return low;
    }
    solve_climb_probabilities(&climbs, model, start_nat);
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

/*
 * Chooses M, the fewest hits whose start threshold a target is likely to reach, and that threshold.
 * Where there is none, a full window starts sets with hits in all scans; a window that still fills
 * starts none: M is then beyond the number of scans held.
 */
static unsigned choose_least_hits_that_let_targets_start(struct false_tracks *model,
                                                         float *start_nat)
{
    unsigned num_scans = model->search->num_scans;
    unsigned wanted = model->search->initiator->config.min_scans;
    for (model->least_hits = wanted > 3u ? wanted : 3u; model->least_hits <= num_scans;
         model->least_hits++) {
        *start_nat = find_threshold_limiting_false_starts(model);
        if (model->num_classes == 0 ||
            rho_initiator_lets_half_of_targets_start(model, *start_nat)) {
            return model->least_hits;
        }
    }
    model->least_hits = num_scans;
    return num_scans == model->search->initiator->config.scans ? num_scans : num_scans + 1u;
}

/*
 * Sets the hits that each span needs, and the limit of thin clutter. Long spans have room for more
 * misses, each of which lowers the score, so they need more hits than M.
 */
static void set_span_hits_and_thin_clutter_limit(struct rho_initiator *initiator,
                                                 const struct false_tracks *model, float start_nat)
{
    initiator->thin_clutter = THIN_SHARE * rho_initiator_least_clutter_plots_in_noise(model);
    for (unsigned first = 0; first < RHO_MAX_SCANS; first++) {
        initiator->span_hits[first] =
            (uint8_t)rho_initiator_least_hits_reaching_start_from(model, first, start_nat);
    }
}

static void find_min_hits_and_score_thresholds(const struct search *search,
                                               struct thresholds *thresholds)
{
    const struct rho_initiator_config *config = &search->initiator->config;
    struct false_tracks model;
    thresholds->start_nat = THRESHOLD_MAX_NAT;
    rho_initiator_model_false_tracks(search, &model);
    thresholds->min_scans =
        choose_least_hits_that_let_targets_start(&model, &thresholds->start_nat);
    if (HAS_SPAN_HITS) {
        set_span_hits_and_thin_clutter_limit(search->initiator, &model, thresholds->start_nat);
    }
    thresholds->confirm_nat =
        find_confirm_threshold(&model, config->false_tracks_per_hour * search->interval_s / 3600.0f,
                               thresholds->start_nat);
}

static void store_min_scans_and_thresholds(struct search *search,
                                           const struct thresholds *thresholds)
{
    struct rho_initiator *initiator = search->initiator;
    search->min_scans = thresholds->min_scans;
    search->score_min_nat = thresholds->start_nat;
    initiator->start_mnat = rho_initiator_nat_to_mnat(thresholds->start_nat);
    initiator->confirm_mnat = rho_initiator_nat_to_mnat(thresholds->confirm_nat);
}

/*
 * Sets M and the thresholds of a search. Without a false-track rate to keep, one threshold starts
 * and confirms tracks. A further sector of a revolution keeps those of the first sector.
 */
void rho_initiator_set_min_scans_and_thresholds(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    const struct rho_initiator_config *config = &initiator->config;
    if (search->is_continued) {
        search->min_scans = initiator->min_scans;
        search->score_min_nat = (float)initiator->start_mnat * 0.001f;
        return;
    }
    struct thresholds thresholds = {config->score_min_nat, config->score_min_nat,
                                    config->min_scans};
    if (search->keeps_rate && search->num_scans >= 3) {
        find_min_hits_and_score_thresholds(search, &thresholds);
    } else if (thresholds.min_scans == 0) {
        thresholds.min_scans = search->keeps_rate ? 3u : choose_min_votes(search);
    }
    store_min_scans_and_thresholds(search, &thresholds);
    initiator->min_scans = (uint16_t)search->min_scans;
}

/* Finds the thresholds anew, for the clutter density measured last. */
void rho_initiator_update_thresholds(struct search *search)
{
    struct thresholds thresholds;
    find_min_hits_and_score_thresholds(search, &thresholds);
    store_min_scans_and_thresholds(search, &thresholds);
}

/* ---- turns ----------------------------------------------------------------------------------- */

/*
 * ln of the prior of a turn. The expected sets of clutter that reach the score s are at most S
 * TURNING_SHARE / 2 e^-s, with S scans in which they may begin, as the score is a likelihood ratio.
 * Where the thresholds would let more than TURNING_SHARE of the wanted false tracks through, the
 * prior is lowered.
 */
float rho_initiator_log_turn_prior(const struct search *search)
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

void rho_initiator_assume_turning_targets(struct search *search, int turns)
{
    search->turn_mps2 = turns ? search->initiator->config.turn_mps2 : 0.0f;
    search->log_turn = turns ? search->log_turning : 0.0f;
    search->is_isotropic = search->has_one_noise && !turns;
}
