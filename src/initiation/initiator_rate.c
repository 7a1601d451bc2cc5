/* SPDX-License-Identifier: MIT */
/*
 * initiator_rate: which scores may start and confirm a track, so that clutter makes as few tracks as wanted.
 *
 * Of all sets of h clutter plots in given scans, the expected number whose score reaches s is (src/DESIGN.md derives it)
 *
 *     E(s) = births pd^h (1 - pd)^misses e^-c y^k / k!,      y = c - s,
 *
 * with c the score of a perfect fit, 2 k the dimensions of its residual (chi2 / 2 = c - score), and births the targets
 * expected in the prior. Summed over all sets that end at the newest scan it is the expected number of chance tracks a
 * search; the thresholds are where that sum is what is wanted.
 */
#include "initiator_search.h"
#include "rhotrack/approx.h"

#define LOG_PI 1.14472989f
#define LOG_TWO_PI 1.83787707f
#define LOG_HALF (-0.69314718f)

/* Chance sets a search that may start a tentative track: the rest of the evidence comes from the next scans. */
#define STARTS_A_SEARCH 0.1f

/* Scores between which a threshold is looked for; below the lower one every track in the gates is good enough. */
#define THRESHOLD_MIN_NAT (-20.0f)
#define THRESHOLD_MAX_NAT 60.0f
#define BISECTIONS 16

/* A tentative track's next place is known so much worse than its plot: determinants of both axes. */
#define PREDICTION_SPREAD 4.0f

#define NEVER_NAT (-1.0e6f)

#define STEPS 12 /* of the integral over tentative starts */

/* The chances of a tentative track, by how much it lacks. */
#define CLIMB_STEP 0.5f
#define CLIMBS 48
#define CLIMB_SWEEPS 4

#define RINGS 8 /* of speeds, for the share of tracks that stay in the area */
#define SHARE_MIN 1.0e-6f

/* More chance sets than that are too many in any case. */
#define WEIGHT_MAX 1.0e30f

/* Places with about the same clutter and noise. */
#define CLASSES_MAX 8

/* first scan to newest, and hits among them */
#define PATTERNS_MAX ((RHO_MAX_SCANS - 2) * (RHO_MAX_SCANS - 1) / 2)

struct place_class {
    float log_density;                                  /* of the clutter there */
    float log_range, log_cross, log_up, log_range_rate; /* of the sigmas */
    float share;                                        /* of the area */
};

/* Sets with the same number of hits, from the same first scan, in one class of places. */
struct pattern {
    uint16_t first, hits;
    float weight;     /* births, pattern of hits, choices of scans and e^-c, over Gamma(k + 1) */
    float best_nat;   /* c */
    float before_nat; /* c of the same track without its newest hit */
    float half_dimensions;
    float most; /* chi2 / 2 that a fit may have */
};

struct chance {
    const struct search *search;
    int has_z, has_range_rate;
    unsigned num_classes, num_patterns;
    struct place_class classes[CLASSES_MAX];
    struct pattern patterns[CLASSES_MAX * PATTERNS_MAX];
    float gain_nat;      /* of one more perfect hit */
    float climb[CLIMBS]; /* of u in the middle of each step */
};

/* ---- places ----------------------------------------------------------------------------------- */

/* Process noise widens what a plot says of a straight track. */
static float log_sigma_m(const struct search *search, uint16_t code)
{
    float sigma_m = rho_window_sigma(code);
    return 0.5f * rho_log(sigma_m * sigma_m + search->fit_process_m2);
}

static struct place_class class_of(const struct search *search, const struct rho_window_scan *scan,
                                   unsigned index)
{
    const struct rho_window_plot *plot = &scan->plots[index];
    struct place_class place = {
        .log_density = rho_log(rho_initiator_mean_density(search->initiator, plot->x_m, plot->y_m)),
        .log_range = log_sigma_m(search, plot->sigma_range),
        .log_cross = log_sigma_m(search, plot->sigma_cross),
        .log_up = log_sigma_m(search, plot->sigma_up),
        .log_range_rate = rho_log(rho_window_sigma(plot->sigma_range_rate)),
    };
    /* a plot stands for the area that has one plot like it */
    place.share = rho_exp(-place.log_density);
    return place;
}

static int are_alike(const struct place_class *a, const struct place_class *b)
{
    float difference =
        a->log_density - b->log_density + a->log_range - b->log_range + a->log_cross - b->log_cross;
    return difference < 0.05f && difference > -0.05f;
}

static void add_class(struct chance *chance, const struct place_class *place)
{
    for (unsigned i = 0; i < chance->num_classes; i++) {
        if (are_alike(&chance->classes[i], place)) {
            chance->classes[i].share += place->share;
            return;
        }
    }
    chance->classes[chance->num_classes++] = *place;
}

/* Every so many held plots are looked at: what clutter and noise are like where there are plots. */
static void sample_places(struct chance *chance)
{
    struct rho_window *window = &chance->search->initiator->window;
    unsigned total = 0, passed = 0;
    float sum = 0.0f;
    for (unsigned m = 0; m < window->num_scans; m++) {
        total += rho_window_scan_at(window, m)->num_plots;
    }
    if (total == 0) {
        return;
    }
    unsigned stride = (total + CLASSES_MAX - 1u) / CLASSES_MAX;
    for (unsigned m = 0; m < window->num_scans; m++) {
        const struct rho_window_scan *scan = rho_window_scan_at(window, m);
        for (unsigned i = 0; i < scan->num_plots; i++, passed++) {
            if (passed % stride == stride / 2u) {
                struct place_class place = class_of(chance->search, scan, i);
                add_class(chance, &place);
            }
        }
    }
    for (unsigned i = 0; i < chance->num_classes; i++) {
        sum += chance->classes[i].share;
    }
    for (unsigned i = 0; i < chance->num_classes; i++) {
        chance->classes[i].share /= sum;
    }
}

/* ---- patterns --------------------------------------------------------------------------------- */

static float log_factorial(unsigned n)
{
    float sum = 0.0f;
    for (unsigned i = 2; i <= n; i++) {
        sum += rho_log((float)i);
    }
    return sum;
}

/* ln Gamma(k + 1) for k a multiple of a half. */
static float log_gamma(float k)
{
    float sum = 0.0f;
    while (k > 0.75f) {
        sum += rho_log(k);
        k -= 1.0f;
    }
    return k > 0.25f ? sum + 0.5f * LOG_PI + LOG_HALF : sum;
}

/* Mean over the choices of h scans, the first of the span and the newest among them, of h sum (t - mean)^2 =
 * sum over pairs of (t_i - t_j)^2. */
static float mean_spread_s2(const struct search *search, unsigned first, unsigned hits)
{
    unsigned last = search->num_scans - 1u, between = last - first - 1u, inner = hits - 2u;
    float both = search->time_s[last] - search->time_s[first];
    float one = 0.0f, none = 0.0f;
    for (unsigned i = first + 1u; i < last; i++) {
        float before = search->time_s[i] - search->time_s[first];
        float after = search->time_s[last] - search->time_s[i];
        one += before * before + after * after;
        for (unsigned j = first + 1u; j < i; j++) {
            float gap = search->time_s[i] - search->time_s[j];
            none += gap * gap;
        }
    }
    float chosen = between > 0 ? (float)inner / (float)between : 0.0f;
    float chosen_too = between > 1 ? (float)(inner - (inner > 0)) / (float)(between - 1u) : 0.0f;
    return both * both + chosen * one + chosen * chosen_too * none;
}

/* What two points, both in an area of width x height, leave of a displacement: the share of the first point's area. */
static float room_for(float width_m, float height_m, float dx_m, float dy_m)
{
    return dx_m < width_m && dy_m < height_m ? (1.0f - dx_m / width_m) * (1.0f - dy_m / height_m)
                                             : 0.0f;
}

/*
 * Share of the straight tracks that begin in the area, with any velocity allowed, and are still in it span_s later:
 * chance has no plots outside. Mean over rings of equal content and directions of a quadrant.
 */
static float share_inside(const struct search *search, float span_s)
{
    static const float directions[4][2] = {{0.98078528f, 0.19509032f},
                                           {0.83146961f, 0.55557023f},
                                           {0.55557023f, 0.83146961f},
                                           {0.19509032f, 0.98078528f}}; /* (2 i + 1) pi / 16 */
    const struct rho_window *window = &search->initiator->window;
    const struct rho_initiator_config *config = &search->initiator->config;
    float side_min_m = window->side_min_m > 1.0f ? window->side_min_m : 1.0f;
    float width_m = rho_extent_width_m(&window->extent, side_min_m);
    float height_m = rho_extent_height_m(&window->extent, side_min_m);
    float least2 = config->v_min_mps * config->v_min_mps;
    float most2 = config->v_max_mps * config->v_max_mps, share = 0.0f;
    for (int ring = 0; ring < RINGS; ring++) {
        float part = ((float)ring + 0.5f) / (float)RINGS;
        float reach_m = span_s * rho_sqrt(least2 + part * (most2 - least2));
        for (int i = 0; i < 4; i++) {
            share += room_for(width_m, height_m, reach_m * directions[i][0],
                              reach_m * directions[i][1]) /
                     (float)(4 * RINGS);
        }
    }
    return share > SHARE_MIN ? share : SHARE_MIN;
}

/* ln det of the normal equations, all axes. */
static float log_fisher(const struct chance *chance, const struct place_class *place, float hits,
                        float spread_s2)
{
    float cross = rho_log(spread_s2) - 4.0f * place->log_cross;
    float along = rho_log(spread_s2) - 4.0f * place->log_range;
    if (chance->has_range_rate) {
        /* hits / range^2 (S / range^2 + hits / rate^2), S = spread / hits */
        float slope = rho_log(spread_s2 / hits) - 2.0f * place->log_range;
        float rate = rho_log(hits) - 2.0f * place->log_range_rate;
        float larger = slope > rate ? slope : rate, smaller = slope > rate ? rate : slope;
        along = rho_log(hits) - 2.0f * place->log_range + larger +
                rho_log(1.0f + rho_exp(smaller - larger));
    }
    return cross + along + (chance->has_z ? rho_log(spread_s2) - 4.0f * place->log_up : 0.0f);
}

/* Half the log of the noise's determinant of one hit, and of what the clutter's other dimensions are spread over. */
static float log_noise(const struct chance *chance, const struct place_class *place)
{
    return place->log_range + place->log_cross + (chance->has_z ? place->log_up : 0.0f) +
           (chance->has_range_rate ? place->log_range_rate : 0.0f);
}

static float dimensions_of_hit(const struct chance *chance)
{
    return 2.0f + (chance->has_z ? 1.0f : 0.0f) + (chance->has_range_rate ? 1.0f : 0.0f);
}

static float log_hits_and_misses(const struct search *search, unsigned first, unsigned hits)
{
    unsigned newest = search->num_scans - 1u;
    return (float)hits * search->log_pd[newest] +
           (float)(newest - first + 1u - hits) * search->log_miss[newest];
}

static float half_dimensions(const struct chance *chance, unsigned hits)
{
    return 0.5f * ((float)hits * dimensions_of_hit(chance) - (chance->has_z ? 6.0f : 4.0f));
}

/* The score of a perfect fit: rho_initiator_score with chi2 = 0. */
static float best_score(const struct chance *chance, const struct place_class *place,
                        unsigned first, unsigned hits)
{
    const struct search *search = chance->search;
    float h = (float)hits;
    float fisher = log_fisher(chance, place, h, mean_spread_s2(search, first, hits));
    return search->log_prior + log_hits_and_misses(search, first, hits) - h * place->log_density -
           half_dimensions(chance, hits) * LOG_TWO_PI - h * log_noise(chance, place) -
           0.5f * fisher +
           rho_initiator_log_room(search, chance->has_z, chance->has_z ? hits : 0u,
                                  chance->has_range_rate ? hits : 0u);
}

/* 99.9 % of chi-square: Wilson and Hilferty's approximation. */
float rho_initiator_chi2_max(unsigned dimensions)
{
    float f = 2.0f / (9.0f * (float)dimensions);
    float root = 1.0f - f + 3.0902f * rho_sqrt(f);
    return (float)dimensions * root * root * root;
}

static void add_pattern(struct chance *chance, const struct place_class *place, unsigned first,
                        unsigned hits, unsigned least)
{
    const struct search *search = chance->search;
    unsigned newest = search->num_scans - 1u, between = newest - first - 1u;
    float best = best_score(chance, place, first, hits), half = half_dimensions(chance, hits);
    float choices =
        log_factorial(between) - log_factorial(hits - 2u) - log_factorial(between + 2u - hits);
    float inside = share_inside(search, search->time_s[newest] - search->time_s[first]);
    float weight =
        0.5f * place->share * inside *
        rho_exp(log_hits_and_misses(search, first, hits) + choices - best - log_gamma(half));
    chance->patterns[chance->num_patterns++] = (struct pattern){
        .first = (uint16_t)first,
        .hits = (uint16_t)hits,
        .weight = weight < WEIGHT_MAX ? weight : WEIGHT_MAX,
        .best_nat = best,
        /* a scan ago it was as long, by a hit less */
        .before_nat = hits > least ? best_score(chance, place, first + 1u, hits - 1u) : NEVER_NAT,
        .half_dimensions = half,
        .most = 0.5f * rho_initiator_chi2_max((unsigned)(2.0f * half + 0.5f)),
    };
}

static void lay_patterns(struct chance *chance)
{
    unsigned num_scans = chance->search->num_scans;
    unsigned least = chance->search->initiator->config.min_scans;
    least = least > 3u ? least : 3u;
    chance->num_patterns = 0;
    for (unsigned i = 0; i < chance->num_classes; i++) {
        for (unsigned first = 0; first + 3u <= num_scans; first++) {
            for (unsigned hits = least; hits <= num_scans - first; hits++) {
                add_pattern(chance, &chance->classes[i], first, hits, least);
            }
        }
    }
}

/* What one more perfect hit adds to a tentative track, in the class with the most clutter a noise cell. */
static void find_gain(struct chance *chance)
{
    const struct search *search = chance->search;
    chance->gain_nat = THRESHOLD_MAX_NAT;
    for (unsigned i = 0; i < chance->num_classes; i++) {
        const struct place_class *place = &chance->classes[i];
        float gain = search->log_pd[search->num_scans - 1u] - place->log_density -
                     0.5f * dimensions_of_hit(chance) * LOG_TWO_PI - log_noise(chance, place) -
                     rho_log(PREDICTION_SPREAD) +
                     rho_initiator_log_room(search, 0, 0, chance->has_range_rate ? 1u : 0u);
        chance->gain_nat = gain < chance->gain_nat ? gain : chance->gain_nat;
    }
}

/* ---- how many --------------------------------------------------------------------------------- */

/* v^k for k a multiple of a half: asked for too often for logarithms. */
static float power(float v, float k)
{
    unsigned halves = (unsigned)(2.0f * k + 0.5f);
    float product = halves % 2u ? rho_sqrt(v) : 1.0f;
    for (; halves >= 2u; halves -= 2u) {
        product *= v;
    }
    return product;
}

/*
 * Share of a pattern's sets whose track had not started without its newest hit: its chi2 / 2 then was above `before`, and
 * is below y with it. Of a ball's content, with one hit's two dimensions fewer, 1 - k q^(k - 1) + (k - 1) q^k, q = before / y.
 */
static float share_new(float k, float y, float before)
{
    float q = before / y;
    if (!(before > 0.0f)) {
        return 1.0f;
    }
    if (q >= 1.0f) {
        return 0.0f;
    }
    float raised = power(q, k - 1.0f);
    return 1.0f - k * raised + (k - 1.0f) * raised * q;
}

/* Sets of a pattern that reach s, of tracks that had not started at start_nat before. */
static float sets_of(const struct pattern *pattern, float s_nat, float start_nat)
{
    float k = pattern->half_dimensions, y = pattern->best_nat - s_nat;
    if (!(y > 0.0f)) {
        return 0.0f;
    }
    y = y < pattern->most ? y : pattern->most;
    return pattern->weight * power(y, k) * share_new(k, y, pattern->before_nat - start_nat);
}

/* Chance tracks a search that are new at start_nat, and whose score reaches s at once. */
static float sets_above(const struct chance *chance, float s_nat, float start_nat)
{
    float sum = 0.0f;
    for (unsigned i = 0; i < chance->num_patterns; i++) {
        sum += sets_of(&chance->patterns[i], s_nat, start_nat);
    }
    return sum;
}

/* Share of the tracks that start by chance whose next place is still in the area. */
static float stay_inside(const struct chance *chance, float start_nat)
{
    const struct search *search = chance->search;
    unsigned newest = search->num_scans - 1u;
    float interval_s = (search->time_s[newest] - search->time_s[0]) / (float)newest;
    float stay[RHO_MAX_SCANS], sum = 0.0f, all = 0.0f;
    for (unsigned first = 0; first + 3u <= search->num_scans; first++) {
        float span_s = search->time_s[newest] - search->time_s[first];
        stay[first] = share_inside(search, span_s + interval_s) / share_inside(search, span_s);
    }
    for (unsigned i = 0; i < chance->num_patterns; i++) {
        float sets = sets_of(&chance->patterns[i], start_nat, start_nat);
        sum += sets * stay[chance->patterns[i].first];
        all += sets;
    }
    return all > 0.0f ? sum / all : 1.0f;
}

/*
 * Probability that clutter lifts a tentative track by u or more before it is dropped, for u in steps of CLIMB_STEP. In
 * every scan a chance plot in the gate gives a gain between gain_nat and that less half the gate, all alike, with density
 * pd e^-gain_nat; else the miss is lost:
 *
 *     climb(u) = integral of density climb(u - gain) d gain + (1 - P(hit)) climb(u + miss),      climb(u <= 0) = 1
 *
 * Solved from what is nearest to 1 on, a few times over.
 */
static float climbed(const struct chance *chance, float u_nat)
{
    float place = u_nat / CLIMB_STEP;
    if (u_nat <= 0.0f) {
        return 1.0f;
    }
    return place < (float)CLIMBS ? chance->climb[(int)place] : 0.0f;
}

static void find_climbs(struct chance *chance, float start_nat)
{
    const struct search *search = chance->search;
    unsigned newest = search->num_scans - 1u;
    float gain = chance->gain_nat;
    float each =
        stay_inside(chance, start_nat) * CLIMB_STEP * rho_exp(search->log_pd[newest] - gain);
    unsigned gains = (unsigned)(0.5f * GATE_CHI2 / CLIMB_STEP);
    float hit = each * (float)gains;
    if (hit > 1.0f) { /* clutter in every gate: of several plots the track takes one */
        each /= hit;
        hit = 1.0f;
    }
    for (int u = 0; u < CLIMBS; u++) {
        chance->climb[u] = 0.0f;
    }
    for (int sweep = 0; sweep < CLIMB_SWEEPS; sweep++) {
        for (int u = 0; u < CLIMBS; u++) {
            float at = CLIMB_STEP * ((float)u + 0.5f), sum = 0.0f;
            for (unsigned i = 0; i < gains; i++) {
                sum += each * climbed(chance, at - gain + CLIMB_STEP * ((float)i + 0.5f));
            }
            chance->climb[u] = sum + (1.0f - hit) * climbed(chance, at - search->log_miss[newest]);
        }
    }
}

/* Chance tracks a search that are confirmed at s: sets that reach it at once, and those that start below, from `start_nat`
 * on, and climb. */
static float tracks_confirmed(const struct chance *chance, float s_nat, float start_nat)
{
    float above = sets_above(chance, s_nat, start_nat), sum = above;
    float lowest = s_nat - start_nat < CLIMB_STEP * (float)CLIMBS
                       ? start_nat
                       : s_nat - CLIMB_STEP * (float)CLIMBS;
    float step = (s_nat - lowest) / (float)STEPS;
    for (int i = 1; i <= STEPS && step > 0.0f; i++) {
        float below = sets_above(chance, s_nat - step * (float)i, start_nat);
        sum += (below - above) * climbed(chance, step * ((float)i - 0.5f));
        above = below;
    }
    return sum;
}

/* The lowest start threshold with no more chance starts than allowed. */
static float start_threshold(const struct chance *chance)
{
    float low = THRESHOLD_MIN_NAT, high = THRESHOLD_MAX_NAT;
    if (sets_above(chance, low, low) <= STARTS_A_SEARCH) {
        return low;
    }
    for (int i = 0; i < BISECTIONS; i++) {
        float middle = 0.5f * (low + high);
        if (sets_above(chance, middle, middle) > STARTS_A_SEARCH) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return high;
}

static float confirm_threshold(const struct chance *chance, float wanted, float start_nat)
{
    float low = start_nat, high = THRESHOLD_MAX_NAT;
    if (tracks_confirmed(chance, low, start_nat) <= wanted) {
        return low;
    }
    for (int i = 0; i < BISECTIONS; i++) {
        float middle = 0.5f * (low + high);
        if (tracks_confirmed(chance, middle, start_nat) > wanted) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return high;
}

/* The fewest hits that may reach the start threshold: a target's chi2 / 2 has mean k and variance k. */
static unsigned least_hits(const struct chance *chance, float start_nat)
{
    unsigned least = chance->search->num_scans;
    for (unsigned i = 0; i < chance->num_patterns; i++) {
        const struct pattern *pattern = &chance->patterns[i];
        float likely = pattern->half_dimensions - 2.0f * rho_sqrt(pattern->half_dimensions);
        if (pattern->hits < least &&
            pattern->best_nat - start_nat > (likely > 0.0f ? likely : 0.0f)) {
            least = pattern->hits;
        }
    }
    return least;
}

void rho_initiator_find_rate(struct search *search, struct rate *rate)
{
    const struct rho_initiator *initiator = search->initiator;
    struct chance chance;
    uint32_t measures =
        rho_window_scan_at(&search->initiator->window, search->num_scans - 1u)->measures;
    float interval_s = (search->time_s[search->num_scans - 1u] - search->time_s[0]) /
                       (float)(search->num_scans - 1u);
    chance.search = search;
    chance.has_z = (measures & RHO_MEASURES_Z) != 0;
    chance.has_range_rate = (measures & RHO_MEASURES_RANGE_RATE) != 0;
    chance.num_classes = 0;
    sample_places(&chance);
    lay_patterns(&chance);
    rate->start_nat = start_threshold(&chance);
    find_gain(&chance);
    find_climbs(&chance, rate->start_nat);
    rate->confirm_nat = confirm_threshold(
        &chance, initiator->config.false_tracks_per_hour * interval_s / 3600.0f, rate->start_nat);
    rate->min_scans = least_hits(&chance, rate->start_nat);
}

static int32_t to_mnat(float nat)
{
    return (int32_t)(nat * 1000.0f + (nat < 0.0f ? -0.5f : 0.5f));
}

void rho_initiator_use_rate(struct search *search, const struct rate *rate)
{
    struct rho_initiator *initiator = search->initiator;
    search->score_min_nat = rate->start_nat;
    initiator->start_mnat = to_mnat(rate->start_nat);
    initiator->confirm_mnat = to_mnat(rate->confirm_nat);
}
