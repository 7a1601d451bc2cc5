/* SPDX-License-Identifier: MIT */
#include "false_track_rate.h"

#include <float.h>

#include "clutter_density.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "target_model.h"

/* Rings of speeds over which the share of tracks that stay in the area is averaged. */
enum { RINGS = 8 };

static float log_of_sigma_code(uint16_t code)
{
    return rho_log(rho_window_decode_sigma(code));
}

static int are_logarithms_close(float a, float b)
{
    return a - b < 0.05f && b - a < 0.05f;
}

static int are_alike(const struct place_class *a, const struct place_class *b)
{
    return are_logarithms_close(a->log_density, b->log_density) &&
           are_logarithms_close(a->log_range, b->log_range) &&
           are_logarithms_close(a->log_cross, b->log_cross) &&
           are_logarithms_close(a->log_up, b->log_up) &&
           are_logarithms_close(a->log_range_rate, b->log_range_rate);
}

/* Samples evenly spaced held plots into classes of clutter and noise, with shares of the area. */
static void sample_place_classes(struct false_tracks *model)
{
    const struct search *search = model->search;
    unsigned total = 0, passed = 0;
    float sum = 0.0f;
    for (unsigned m = 0; m < search->num_scans; m++) {
        total += rho_search_scan(search, m)->num_plots;
    }
    if (total == 0) {
        return;
    }
    unsigned stride = (total + CLASSES_MAX - 1u) / CLASSES_MAX;
    for (unsigned m = 0; m < search->num_scans; m++) {
        const struct rho_window_scan *scan = rho_search_scan(search, m);
        for (unsigned i = 0; i < scan->num_plots; i++, passed++) {
            const struct rho_window_plot *plot = &scan->plots[i];
            if (passed % stride != stride / 2u) {
                continue;
            }
            struct place_class place = {
                .log_density =
                    rho_log(rho_density_mean_at(search->initiator, plot->x_m, plot->y_m)),
                .log_range = log_of_sigma_code(plot->sigma_range),
                .log_cross = log_of_sigma_code(plot->sigma_cross),
            };
            if (model->has_z) {
                place.log_up = log_of_sigma_code(plot->sigma_up);
            }
            if (model->has_range_rate) {
                place.log_range_rate = log_of_sigma_code(plot->sigma_range_rate);
            }
            /* the place stands for the area that has one such plot */
            place.share = rho_exp(-place.log_density);
            unsigned k = 0;
            while (k < model->num_classes && !are_alike(&model->classes[k], &place)) {
                k++;
            }
            if (k < model->num_classes) {
                model->classes[k].share += place.share;
            } else {
                model->classes[model->num_classes++] = place;
            }
        }
    }
    for (unsigned i = 0; i < model->num_classes; i++) {
        sum += model->classes[i].share;
    }
    for (unsigned i = 0; i < model->num_classes; i++) {
        model->classes[i].share /= sum;
    }
}

/* ln Gamma(k + 1), where k is a multiple of a half. */
static float log_gamma_of_k_plus_1(float k)
{
    float sum = 0.0f;
    while (k > 0.75f) {
        sum += rho_log(k);
        k -= 1.0f;
    }
    return k > 0.25f ? sum + 0.5f * LOG_PI + LOG_HALF : sum;
}

/*
 * Mean, over all choices of h = `hits` scans that include `first` and the newest, of h sum (t -
 * mean)^2 = sum over pairs of (t_i - t_j)^2.
 */
static float mean_hit_spread_s2(const struct search *search, unsigned first, unsigned hits)
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

/*
 * Share of the straight tracks that begin in the area, with any allowed velocity, and are still in
 * the area span_s later, where alone there are plots. The mean over rings of speed of equal
 * content, and over directions of a quadrant.
 */
static float share_staying_inside(const struct search *search, float span_s)
{
    static const float directions[4][2] = {{0.98078528f, 0.19509032f},
                                           {0.83146961f, 0.55557023f},
                                           {0.55557023f, 0.83146961f},
                                           /* cosine and sine of (2 i + 1) pi / 16 */
                                           {0.19509032f, 0.98078528f}};
    const struct rho_window *window = &search->initiator->window;
    const struct rho_initiator_config *config = &search->initiator->config;
    float side_min_m = window->side_min_m > 1.0f ? window->side_min_m : 1.0f;
    float width_m = rho_extent_width_m(&window->extent, side_min_m);
    float height_m = rho_extent_height_m(&window->extent, side_min_m);
    float least2 = config->v_min_mps * config->v_min_mps;
    float most2 = config->v_max_mps * config->v_max_mps, share = 0.0f;
    for (int ring = 0; ring < RINGS; ring++) {
        float part = ((float)ring + 0.5f) / (float)RINGS;
        float travelled_m = span_s * rho_sqrt(least2 + part * (most2 - least2));
        for (int i = 0; i < 4; i++) {
            const float dx_m = travelled_m * directions[i][0],
                        dy_m = travelled_m * directions[i][1];
            /* the share of a rectangle's points that this displacement leaves in it */
            share += (dx_m < width_m && dy_m < height_m
                          ? (1.0f - dx_m / width_m) * (1.0f - dy_m / height_m)
                          : 0.0f) /
                     (float)(4 * RINGS);
        }
    }
    return rho_larger(share, 1.0e-6f); /* a divisor */
}

/* ln of the determinant of the normal equations of a fit (its Fisher information), all axes. */
static float log_fisher_determinant(const struct false_tracks *model,
                                    const struct place_class *place, float hits, float spread_s2)
{
    float cross = rho_log(spread_s2) - 4.0f * place->log_cross;
    float along = rho_log(spread_s2) - 4.0f * place->log_range;
    if (model->has_range_rate) {
        /* along the sight: hits / range^2 (S / range^2 + hits / rate^2), S = spread / hits */
        float slope = rho_log(spread_s2 / hits) - 2.0f * place->log_range;
        float rate = rho_log(hits) - 2.0f * place->log_range_rate;
        float larger = slope > rate ? slope : rate, smaller = slope > rate ? rate : slope;
        along = rho_log(hits) - 2.0f * place->log_range + larger +
                rho_log(1.0f + rho_exp(smaller - larger));
    }
    return cross + along + (model->has_z ? rho_log(spread_s2) - 4.0f * place->log_up : 0.0f);
}

/* Half the ln of the determinant of one hit's noise covariance. */
static float half_log_det_of_hit_noise(const struct false_tracks *model,
                                       const struct place_class *place)
{
    return place->log_range + place->log_cross + (model->has_z ? place->log_up : 0.0f) +
           (model->has_range_rate ? place->log_range_rate : 0.0f);
}

static float dimensions_of_hit(const struct false_tracks *model)
{
    return 2.0f + (model->has_z ? 1.0f : 0.0f) + (model->has_range_rate ? 1.0f : 0.0f);
}

static float log_widened_sigma(float log_sigma_m, float bend_m2)
{
    return 0.5f * rho_log(rho_exp(2.0f * log_sigma_m) + bend_m2);
}

/* Share of mode j in the residual of a bent track, as of a free beam; mode 1: the longest bow. */
static float bend_share_of_mode(unsigned j)
{
    const float waves = 3.0f / (float)(2u * j + 1u);
    return waves * waves * waves * waves;
}

/*
 * Noise of a plot about a straight track, widened by the bend that process noise gives tracks with
 * this number of hits from scan `first` on. For anisotropic noise the score takes process noise as
 * independent from plot to plot, so all dimensions are widened alike.
 */
static struct place_class noise_widened_by_bend(const struct false_tracks *model,
                                                const struct place_class *place, unsigned first,
                                                unsigned hits)
{
    struct place_class wide = *place;
    if (!(model->search->fit_process_m2 > 0.0f)) {
        return wide;
    }
    const float bend_m2 = model->bend_m2[first];
    const float scans = (float)(model->search->num_scans - first);
    if (rho_search_is_isotropic(model->search)) {
        /*
         * sigma of isotropic noise with the same determinant as noise and bend together: the
         * dimensions of the residual have very different variances, sigma^2 plus the bend of their
         * mode, and the determinant is their product (src/DESIGN.md)
         */
        const unsigned dimensions = hits - 2u;
        const float bent_m2 = bend_m2 * (float)hits / scans;
        float all = 0.0f, sum = 0.0f;
        for (unsigned j = 1; j <= dimensions; j++) {
            all += bend_share_of_mode(j);
        }
        for (unsigned j = 1; j <= dimensions; j++) {
            sum += log_widened_sigma(place->log_range, bent_m2 * bend_share_of_mode(j) / all);
        }
        wide.log_range = wide.log_cross = sum / (float)dimensions;
    } else {
        wide.log_range = log_widened_sigma(place->log_range, bend_m2 / (scans - 2.0f));
        wide.log_cross = log_widened_sigma(place->log_cross, bend_m2 / (scans - 2.0f));
        wide.log_up = log_widened_sigma(place->log_up, bend_m2 / (scans - 2.0f));
    }
    return wide;
}

/* The score of a perfect fit to a pattern is that of rho_plot_set_score with chi-square 0. */
static struct pattern_score score_pattern(const struct false_tracks *model,
                                          const struct place_class *place,
                                          const struct pattern *pattern)
{
    const struct search *search = model->search;
    const unsigned first = pattern->first, hits = pattern->hits, newest = search->num_scans - 1u;
    const float h = (float)hits;
    const float log_hits =
        h * search->log_pd[newest] + (float)(newest - first + 1u - hits) * search->log_miss[newest];
    struct place_class wide = noise_widened_by_bend(model, place, first, hits);
    const float fisher = log_fisher_determinant(model, &wide, h, pattern->spread_s2);
    struct pattern_score score = {
        .best_nat = search->log_prior + log_hits - h * wide.log_density -
                    pattern->half_dimensions * LOG_TWO_PI -
                    h * half_log_det_of_hit_noise(model, &wide) - 0.5f * fisher +
                    rho_target_log_volume(search, model->has_z, model->has_z ? hits : 0u,
                                          model->has_range_rate ? hits : 0u) -
                    h * model->log_aliases};
    score.weight = 0.5f * place->share * pattern->inside *
                   rho_exp(log_hits + pattern->log_choices - score.best_nat -
                           log_gamma_of_k_plus_1(pattern->half_dimensions));
    /* numbers of false sets stay finite */
    score.weight = rho_smaller(score.weight, 1.0e30f);
    return score;
}

void rho_false_tracks_model(const struct search *search, struct false_tracks *model)
{
    /* heights or range rates that only some scans measure are left out: an upper bound */
    uint32_t measures = ~0u;
    const unsigned num_scans = search->num_scans;
    for (unsigned m = 0; m < num_scans; m++) {
        const struct rho_window_scan *scan = rho_search_scan(search, m);
        /* a scan without plots has no hit, whatever it measures */
        measures &= scan->num_plots > 0 ? scan->measures : ~0u;
    }
    model->search = search;
    model->has_z = (measures & RHO_MEASURES_Z) != 0;
    model->has_range_rate = (measures & RHO_MEASURES_RANGE_RATE) != 0;
    model->log_aliases = 0.0f;
    if (model->has_range_rate) {
        for (unsigned m = 0; m < num_scans; m++) {
            model->log_aliases += rho_measurement_log_aliases(&rho_search_scan(search, m)->sensor,
                                                              search->initiator->config.v_max_mps);
        }
        model->log_aliases = model->log_aliases / (float)num_scans;
    }
    model->num_classes = model->num_patterns = 0;
    model->least_hits = 3;
    sample_place_classes(model);
    for (unsigned first = 0; first + 3u <= num_scans; first++) {
        const unsigned between = num_scans - 2u - first;
        if (search->fit_process_m2 > 0.0f) {
            (void)rho_target_bend_m2(search, first, &model->bend_m2[first]);
        }
        for (unsigned hits = 3; hits <= num_scans - first; hits++) {
            const float half =
                0.5f * ((float)hits * dimensions_of_hit(model) - (model->has_z ? 6.0f : 4.0f));
            model->patterns[model->num_patterns++] = (struct pattern){
                .first = (uint16_t)first,
                .hits = (uint16_t)hits,
                .log_choices = rho_log_factorial(between) - rho_log_factorial(hits - 2u) -
                               rho_log_factorial(between + 2u - hits),
                .spread_s2 = mean_hit_spread_s2(search, first, hits),
                .inside = share_staying_inside(search, search->time_s[num_scans - 1u] -
                                                           search->time_s[first]),
                .half_dimensions = half,
                .most = 0.5f * rho_chi2_quantile((unsigned)(2.0f * half + 0.5f), SIGMAS_99_9),
            };
        }
    }
    for (unsigned i = 0; i < model->num_classes; i++) {
        for (unsigned k = 0; k < model->num_patterns; k++) {
            model->scores[i][k] = score_pattern(model, &model->classes[i], &model->patterns[k]);
        }
    }
}

/*
 * Number of false sets of a pattern, in all classes, that reach score_nat, and had not reached
 * start_nat a scan ago: weight y^k times the share of new ones. Without the newest hit their chi2 /
 * 2 is above `before`, and with it below y. Of the content of a ball, with the two dimensions of
 * one hit fewer, that share is 1 - k q^(k - 1) + (k - 1) q^k, q = before / y. Powers are multiplied
 * out rather than taken by logarithms, as the function is called often: k is a multiple of a half.
 */
static float false_sets_of_pattern(const struct false_tracks *model, unsigned pattern_index,
                                   float score_nat, float start_nat)
{
    const struct pattern *pattern = &model->patterns[pattern_index];
    const float half = pattern->half_dimensions;
    /*
     * the pattern with one hit fewer that begins a scan later: patterns are listed by their first
     * scan, then by hits. Too few hits start no track
     */
    const unsigned less = pattern_index + model->search->num_scans - pattern->first - 3u;
    const int had_start = pattern->hits > model->least_hits;
    float sum = 0.0f;
    if (pattern->hits < model->least_hits) {
        return 0.0f;
    }
    for (unsigned i = 0; i < model->num_classes; i++) {
        const struct pattern_score *score = &model->scores[i][pattern_index];
        float y = score->best_nat - score_nat, before = 0.0f;
        if (!(y > 0.0f)) {
            continue;
        }
        if (had_start) {
            before = rho_smaller(model->scores[i][less].best_nat - start_nat,
                                 model->patterns[less].most);
        }
        y = rho_smaller(y, pattern->most);
        if (before >= y) {
            continue;
        }
        unsigned halves = (unsigned)(2.0f * half + 0.5f);
        float q = before / y, content = halves % 2u ? rho_sqrt(y) : 1.0f;
        float raised = halves % 2u ? rho_sqrt(q) : 1.0f; /* q^(k - 1) */
        for (; halves >= 4u; halves -= 2u) {
            content *= y;
            raised *= q;
        }
        float share = before > 0.0f ? 1.0f - half * raised + (half - 1.0f) * raised * q : 1.0f;
        sum += score->weight * (content * y) * share;
    }
    return sum;
}

float rho_false_tracks_above(const struct false_tracks *model, float score_nat, float start_nat,
                             float stop_at_sum)
{
    float sum = 0.0f;
    for (unsigned k = 0; k < model->num_patterns && sum <= stop_at_sum; k++) {
        sum += false_sets_of_pattern(model, k, score_nat, start_nat);
    }
    return sum;
}

float rho_false_tracks_staying(const struct false_tracks *model, float start_nat)
{
    const struct search *search = model->search;
    unsigned newest = search->num_scans - 1u;
    float stay[RHO_MAX_SCANS], sum = 0.0f, all = 0.0f;
    for (unsigned first = 0; first + 3u <= search->num_scans; first++) {
        float span_s = search->time_s[newest] - search->time_s[first];
        stay[first] = share_staying_inside(search, span_s + search->interval_s) /
                      share_staying_inside(search, span_s);
    }
    for (unsigned k = 0; k < model->num_patterns; k++) {
        float sets = false_sets_of_pattern(model, k, start_nat, start_nat);
        sum += sets * stay[model->patterns[k].first];
        all += sets;
    }
    return all > 0.0f ? sum / all : 1.0f;
}

float rho_false_tracks_least_gain(const struct false_tracks *model)
{
    const struct search *search = model->search;
    float least = FLT_MAX;
    for (unsigned i = 0; i < model->num_classes; i++) {
        const struct place_class wide =
            noise_widened_by_bend(model, &model->classes[i], search->num_scans - 3u, 3);
        float gain = search->log_pd[search->num_scans - 1u] - wide.log_density -
                     0.5f * dimensions_of_hit(model) * LOG_TWO_PI -
                     half_log_det_of_hit_noise(model, &wide) - rho_log(PREDICTION_SPREAD) +
                     rho_target_log_volume(search, 0, 0, model->has_range_rate ? 1u : 0u) -
                     model->log_aliases;
        least = gain < least ? gain : least;
    }
    return least;
}

/* Score of a perfect fit to a pattern, in the class of places where it is highest. */
static float best_score_in_any_class(const struct false_tracks *model, unsigned pattern_index)
{
    float best = -FLT_MAX;
    for (unsigned i = 0; i < model->num_classes; i++) {
        float here = model->scores[i][pattern_index].best_nat;
        best = here > best ? here : best;
    }
    return best;
}

/*
 * True where a pattern with the least number of hits has a margin over start_nat of its mean chi2 /
 * 2 or more, so that at least half of the targets with this pattern start.
 */
int rho_false_tracks_let_start(const struct false_tracks *model, float start_nat)
{
    for (unsigned k = 0; k < model->num_patterns; k++) {
        const struct pattern *pattern = &model->patterns[k];
        if (pattern->hits == model->least_hits &&
            best_score_in_any_class(model, k) - start_nat >= pattern->half_dimensions) {
            return 1;
        }
    }
    return 0;
}

unsigned rho_false_tracks_least_hits(const struct false_tracks *model, unsigned first,
                                     float start_nat)
{
    for (unsigned k = 0; k < model->num_patterns; k++) {
        const struct pattern *pattern = &model->patterns[k];
        if (pattern->first == first && pattern->hits >= model->least_hits &&
            best_score_in_any_class(model, k) >= start_nat - BEST_MARGIN_NAT) {
            return pattern->hits;
        }
    }
    return model->search->num_scans + 1u;
}

float rho_false_tracks_thinnest(const struct false_tracks *model)
{
    float least = 0.0f;
    for (unsigned i = 0; i < model->num_classes; i++) {
        const struct place_class *place = &model->classes[i];
        const float here = place->log_density + place->log_range + place->log_cross;
        least = here < least ? here : least;
    }
    return rho_exp(least);
}
