/* SPDX-License-Identifier: MIT */
/*
 * initiator_rate: which scores may start and confirm a track, so that clutter makes as few tracks as wanted.
 *
 * initiator_chance tells how many sets of clutter plots reach a score at once. Beside them, tentative tracks that
 * chance started climb to the confirm threshold by more chance; the thresholds are where both together are what is
 * wanted.
 */
#include <float.h>

#include "initiator_chance.h"
#include "rhotrack/approx.h"

/* Chance sets a search that may start a tentative track: the rest of the evidence comes from the next scans. */
#define STARTS_A_SEARCH 0.1f

/* Scores between which a threshold is looked for; below the lower one every track in the gates is good enough. */
#define THRESHOLD_MIN_NAT (-10.0f)
#define THRESHOLD_MAX_NAT 60.0f
#define BISECTIONS 16

#define STEPS 12 /* of the integral over tentative starts */

/* The chances of a tentative track, by how much it lacks. */
#define CLIMB_STEP 0.5f
#define CLIMBS 48
#define CLIMB_SWEEPS 4

/* Targets that turn, of all; and what chance tracks of such they may add to those wanted. */
#define TURNING 0.1f

/* ---- tentative tracks ------------------------------------------------------------------------- */

struct climbs {
    float of[CLIMBS]; /* of u in the middle of each step */
};

/*
 * Probability that clutter lifts a tentative track by u or more before it is dropped, for u in steps of CLIMB_STEP. In
 * every scan a chance plot in the gate gives a gain between gain_nat and that less half the gate, all alike, with
 * density pd e^-gain_nat; else the miss is lost:
 *
 *     climb(u) = integral of density climb(u - gain) d gain + (1 - P(hit)) climb(u + miss),      climb(u <= 0) = 1
 *
 * Solved from what is nearest to 1 on, a few times over.
 */
static float climbed(const struct climbs *climbs, float u_nat)
{
    float place = u_nat / CLIMB_STEP;
    if (u_nat <= 0.0f) {
        return 1.0f;
    }
    return place < (float)CLIMBS ? climbs->of[(int)place] : 0.0f;
}

/* What a scan does to a tentative track of clutter. */
struct turn_of_luck {
    float gain_nat; /* of a perfect hit */
    float each;     /* probability of each step of the gain below it */
    unsigned gains; /* steps */
    float miss_nat; /* lost without a hit */
};

static struct turn_of_luck luck_of(const struct chance *chance, float start_nat)
{
    const struct search *search = chance->search;
    unsigned newest = search->num_scans - 1u;
    struct turn_of_luck luck = {.gain_nat = rho_initiator_gain_of_hit(chance),
                                .gains = (unsigned)(0.5f * RHO_GATE_CHI2_2D / CLIMB_STEP),
                                .miss_nat = -search->log_miss[newest]};
    luck.each = rho_initiator_stay_inside(chance, start_nat) * CLIMB_STEP *
                rho_exp(search->log_pd[newest] - luck.gain_nat);
    if (luck.each * (float)luck.gains > 1.0f) {
        /* clutter in every gate: of several plots the track takes one */
        luck.each = 1.0f / (float)luck.gains;
    }
    return luck;
}

static void find_climbs(struct climbs *climbs, const struct chance *chance, float start_nat)
{
    struct turn_of_luck luck = luck_of(chance, start_nat);
    float missed = 1.0f - luck.each * (float)luck.gains;
    for (int u = 0; u < CLIMBS; u++) {
        climbs->of[u] = 0.0f;
    }
    for (int sweep = 0; sweep < CLIMB_SWEEPS; sweep++) {
        for (int u = 0; u < CLIMBS; u++) {
            float at = CLIMB_STEP * ((float)u + 0.5f), sum = 0.0f;
            for (unsigned i = 0; i < luck.gains; i++) {
                sum += climbed(climbs, at - luck.gain_nat + CLIMB_STEP * ((float)i + 0.5f));
            }
            climbs->of[u] = luck.each * sum + missed * climbed(climbs, at + luck.miss_nat);
        }
    }
}

/* ---- thresholds ------------------------------------------------------------------------------- */

/*
 * Whether clutter has more tracks confirmed at s, a search, than wanted: sets that reach it at once, and those that start
 * below, from start_nat on, and climb. Whatever is left of the sets that start at all, at_start, climbs less likely than
 * what was summed so far: mostly that decides before the end.
 */
static int confirms_more(const struct climbs *climbs, const struct chance *chance, float s_nat,
                         float start_nat, float at_start, float wanted)
{
    float above = rho_initiator_sets_above(chance, s_nat, start_nat, FLT_MAX), sum = above;
    float lowest = s_nat - start_nat < CLIMB_STEP * (float)CLIMBS
                       ? start_nat
                       : s_nat - CLIMB_STEP * (float)CLIMBS;
    float step = (s_nat - lowest) / (float)STEPS;
    for (int i = 1; i <= STEPS; i++) {
        float climbs_up = climbed(climbs, step * ((float)i - 0.5f));
        if (sum > wanted || sum + (at_start - above) * climbs_up <= wanted) {
            break;
        }
        float below = rho_initiator_sets_above(chance, s_nat - step * (float)i, start_nat, FLT_MAX);
        sum += (below - above) * climbs_up;
        above = below;
    }
    return sum > wanted;
}

/* The lowest start threshold with no more chance starts than allowed. */
static float start_threshold(const struct chance *chance)
{
    float low = THRESHOLD_MIN_NAT, high = THRESHOLD_MAX_NAT;
    if (rho_initiator_sets_above(chance, low, low, STARTS_A_SEARCH) <= STARTS_A_SEARCH) {
        return low;
    }
    for (int i = 0; i < BISECTIONS; i++) {
        float middle = 0.5f * (low + high);
        if (rho_initiator_sets_above(chance, middle, middle, STARTS_A_SEARCH) > STARTS_A_SEARCH) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return high;
}

static float confirm_threshold(const struct chance *chance, float wanted, float start_nat)
{
    struct climbs climbs;
    float low = start_nat, high = THRESHOLD_MAX_NAT;
    float at_start = rho_initiator_sets_above(chance, start_nat, start_nat, FLT_MAX);
    if (at_start <= wanted) {
        return low;
    }
    find_climbs(&climbs, chance, start_nat);
    for (int i = 0; i < BISECTIONS; i++) {
        float middle = 0.5f * (low + high);
        if (confirms_more(&climbs, chance, middle, start_nat, at_start, wanted)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return high;
}

/*
 * M: the fewest hits whose threshold a target is likely to reach. Where there is none, a full window starts what has
 * all hits, and one that fills waits: M beyond the scans held.
 */
static unsigned choose_least_hits(struct chance *chance, float *start_nat)
{
    unsigned num_scans = chance->search->num_scans;
    unsigned wanted = chance->search->initiator->config.min_scans;
    for (chance->least_hits = wanted > 3u ? wanted : 3u; chance->least_hits <= num_scans;
         chance->least_hits++) {
        *start_nat = start_threshold(chance);
        if (chance->num_classes == 0 || rho_initiator_leaves_room(chance, *start_nat)) {
            return chance->least_hits;
        }
    }
    chance->least_hits = num_scans;
    return num_scans == chance->search->initiator->config.scans ? num_scans : num_scans + 1u;
}

void rho_initiator_find_rate(struct search *search, struct rate *rate)
{
    const struct rho_initiator_config *config = &search->initiator->config;
    struct chance chance;
    rate->start_nat = THRESHOLD_MAX_NAT;
    rho_initiator_lay_chance(search, &chance);
    rate->min_scans = choose_least_hits(&chance, &rate->start_nat);
    rate->confirm_nat = confirm_threshold(
        &chance, config->false_tracks_per_hour * search->interval_s / 3600.0f, rate->start_nat);
}

void rho_initiator_use_rate(struct search *search, const struct rate *rate)
{
    struct rho_initiator *initiator = search->initiator;
    search->score_min_nat = rate->start_nat;
    initiator->start_mnat = rho_initiator_mnat(rate->start_nat);
    initiator->confirm_mnat = rho_initiator_mnat(rate->confirm_nat);
}

/* ---- turns ----------------------------------------------------------------------------------- */

/*
 * How likely a target turns, ln. Sets of clutter that reach s are at most S TURNING / 2 e^-s, S the
 * scans that they may begin in: a score is a likelihood ratio. Thresholds that let more through
 * than TURNING of what is wanted are too low for turns.
 */
float rho_initiator_log_turning(const struct search *search)
{
    const struct rho_initiator *initiator = search->initiator;
    float wanted = initiator->config.false_tracks_per_hour * search->interval_s / 3600.0f;
    if (!search->keeps_rate || !(wanted > 0.0f)) {
        return rho_log(TURNING);
    }
    float log_sets = rho_log(0.5f * (float)search->num_scans);
    float start_nat = log_sets - rho_log(STARTS_A_SEARCH) - 0.001f * (float)initiator->start_mnat;
    float confirm_nat = log_sets - rho_log(wanted) - 0.001f * (float)initiator->confirm_mnat;
    float more_nat = start_nat > confirm_nat ? start_nat : confirm_nat;
    return rho_log(TURNING) - (more_nat > 0.0f ? more_nat : 0.0f);
}

void rho_initiator_let_turn(struct search *search, int turns)
{
    search->turn_mps2 = turns ? search->initiator->config.turn_mps2 : 0.0f;
    search->log_turn = turns ? search->log_turning : 0.0f;
    search->is_isotropic = search->has_one_noise && !turns;
}
