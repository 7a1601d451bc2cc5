/* SPDX-License-Identifier: MIT */
/*
 * initiator_density: how dense clutter is, here and on average, and how many scans must vote for it.
 */
#include <string.h>

#include "initiator_search.h"
#include "rhotrack/approx.h"

/* The map gets as many cells as hold this many plots each in the mean. */
#define PLOTS_PER_CELL 32u

/* Plots of the mean density that a cell counts beside its own, at most: then the map is flat. */
#define PRIOR_PLOTS_MAX 1.0e6f

/* M is the smallest number of votes, down from N, with at most this many chance tracks a search; N where there is none. */
#define CHANCE_TRACKS_MAX 0.1f

/* ln of the targets expected in the area and window before any plot was seen: a half, so that one target and none are
 * equally likely. */
#define LOG_TARGETS_EXPECTED (-0.69314718f)

#define LOG_PI 1.14472989f

static float area_m2(const struct rho_initiator *initiator)
{
    float area = rho_extent_area_m2(&initiator->window.extent, initiator->window.side_min_m);
    return area > 1.0f ? area : 1.0f;
}

/* ---- the map ---------------------------------------------------------------------------------- */

static unsigned clamp_cells(float cells)
{
    if (!(cells >= 1.0f)) {
        return 1;
    }
    return cells < (float)RHO_MAX_DENSITY_CELLS ? (unsigned)cells : RHO_MAX_DENSITY_CELLS;
}

static unsigned cell_at(float v_m, float min_m, float side_m, unsigned cells)
{
    float cell = (v_m - min_m) * (float)cells / side_m;
    if (!(cell > 0.0f)) {
        return 0;
    }
    return cell < (float)cells ? (unsigned)cell : cells - 1u;
}

static unsigned map_cell(const struct rho_initiator *initiator, float x_m, float y_m)
{
    const struct rho_window *window = &initiator->window;
    float side_min_m = window->side_min_m > 1.0f ? window->side_min_m : 1.0f;
    unsigned column =
        cell_at(x_m, window->extent.x_min_m, rho_extent_width_m(&window->extent, side_min_m),
                initiator->density_columns);
    unsigned row =
        cell_at(y_m, window->extent.y_min_m, rho_extent_height_m(&window->extent, side_min_m),
                initiator->density_rows);
    return row * initiator->density_columns + column;
}

static void lay_map(struct rho_initiator *initiator, uint32_t num_plots)
{
    const struct rho_window *window = &initiator->window;
    float side_min_m = window->side_min_m > 1.0f ? window->side_min_m : 1.0f;
    uint32_t wanted = num_plots / PLOTS_PER_CELL + 1u;
    float cells = (float)wanted;
    float aspect = rho_extent_width_m(&window->extent, side_min_m) /
                   rho_extent_height_m(&window->extent, side_min_m);
    initiator->density_columns = (uint16_t)clamp_cells(rho_sqrt(cells * aspect));
    initiator->density_rows = (uint16_t)clamp_cells(cells / (float)initiator->density_columns);
    memset(initiator->density, 0, sizeof initiator->density);
}

static uint32_t count_plots(struct rho_initiator *initiator, uint16_t skip_flags, int into_map)
{
    uint32_t count = 0;
    for (unsigned m = 0; m < initiator->window.num_scans; m++) {
        const struct rho_window_scan *scan = rho_window_scan_at(&initiator->window, m);
        for (unsigned i = 0; i < scan->num_plots; i++) {
            const struct rho_window_plot *plot = &scan->plots[i];
            if (scan->marks[i] & skip_flags) {
                continue;
            }
            count++;
            if (into_map) {
                uint16_t *cell = &initiator->density[map_cell(initiator, plot->x_m, plot->y_m)];
                *cell = (uint16_t)(*cell < UINT16_MAX ? *cell + 1u : UINT16_MAX);
            }
        }
    }
    return count;
}

static float mean_cell_count(const struct rho_initiator *initiator)
{
    float cells = (float)initiator->density_columns * (float)initiator->density_rows;
    float scans = (float)initiator->window.num_scans;
    return initiator->density_per_m2 * area_m2(initiator) * scans / cells;
}

/*
 * How many plots of the mean density each cell's own count is weighed against (empirical Bayes, gamma prior): mean^2 /
 * (variance - mean) over the cells. Where counts scatter no more than chance makes them, the mean is believed; where
 * clutter is patchy, the cells are.
 */
static float prior_plots(const struct rho_initiator *initiator)
{
    unsigned cells = (unsigned)initiator->density_columns * initiator->density_rows;
    float mean = mean_cell_count(initiator), variance = 0.0f;
    if (cells < 2) {
        return PRIOR_PLOTS_MAX; /* one cell is the mean */
    }
    for (unsigned c = 0; c < cells; c++) {
        float excess = (float)initiator->density[c] - mean;
        variance += excess * excess / (float)(cells - 1u);
    }
    float beyond_chance = variance - mean;
    return beyond_chance * PRIOR_PLOTS_MAX > mean * mean ? mean * mean / beyond_chance
                                                         : PRIOR_PLOTS_MAX;
}

/* The density where a cell of the map counts so many plots. */
static float density_of(const struct rho_initiator *initiator, float count)
{
    float prior = initiator->density_prior_plots;
    return initiator->density_per_m2 * (count + prior) / (mean_cell_count(initiator) + prior);
}

float rho_initiator_density(const struct rho_initiator *initiator, float x_m, float y_m)
{
    if (initiator->density_columns == 0) {
        return 0.0f;
    }
    return density_of(initiator, (float)initiator->density[map_cell(initiator, x_m, y_m)]);
}

/* The density that hit m of a set is measured against: the set's own plots are taken out of its cell, where they are in
 * it. */
float rho_initiator_log_density(const struct search *search, const struct plot_set *set, unsigned m)
{
    const struct rho_window_plot *plot = rho_initiator_plot(search, set, m);
    unsigned cell = map_cell(search->initiator, plot->x_m, plot->y_m);
    unsigned own = 0;
    for (unsigned k = 0; k < search->num_scans && !search->is_judging; k++) {
        if (set->mask >> k & 1u) {
            const struct rho_window_plot *other = rho_initiator_plot(search, set, k);
            own += map_cell(search->initiator, other->x_m, other->y_m) == cell;
        }
    }
    unsigned count = search->initiator->density[cell];
    return rho_log(density_of(search->initiator, (float)(count > own ? count - own : 0u)));
}

/* ---- how many votes --------------------------------------------------------------------------- */

static float log_factorial(unsigned n)
{
    float sum = 0.0f;
    for (unsigned i = 2; i <= n; i++) {
        sum += rho_log((float)i);
    }
    return sum;
}

/* Chi-square limit of 95 % for even degrees of freedom d = 2 h - 4: Wilson and Hilferty's approximation. */
static float chi2_95(unsigned degrees)
{
    float f = 2.0f / (9.0f * (float)degrees);
    float root = 1.0f - f + 1.6449f * rho_sqrt(f);
    return (float)degrees * root * root * root;
}

/*
 * ln of the expected number of chance tracks with votes in h given scans: density^h sigma^(2h-4) V(c) A pi (v_max^2 -
 * v_min^2) h Stt, V the ball of 2h - 4 dimensions, Stt the spread of the scan times (src/DESIGN.md derives it).
 */
static float log_chance(const struct search *search, unsigned h, float sigma_m, float spread_s2)
{
    const struct rho_initiator_config *config = &search->initiator->config;
    float degrees = (float)(2u * h - 4u);
    float log_ball =
        0.5f * degrees * (LOG_PI + rho_log(chi2_95(2u * h - 4u))) - log_factorial(h - 2u);
    float speeds = config->v_max_mps * config->v_max_mps - config->v_min_mps * config->v_min_mps;
    return (float)h * rho_log(search->initiator->density_per_m2) + degrees * rho_log(sigma_m) +
           log_ball + rho_log(area_m2(search->initiator)) + LOG_PI + rho_log(speeds) +
           rho_log((float)h * spread_s2);
}

static float largest_sigma_m(const struct search *search)
{
    float sigma_m = RHO_LIMIT_SIGMA_MIN;
    for (unsigned m = 0; m < search->num_scans; m++) {
        float scan_m = rho_window_scan_at(&search->initiator->window, m)->sigma_max_m;
        sigma_m = scan_m > sigma_m ? scan_m : sigma_m;
    }
    return rho_sqrt(sigma_m * sigma_m + search->fit_process_m2);
}

/* Sum over the h - subsets of N scans is taken as C(N, h) times the subset spread evenly over the window. */
static float chance_tracks(const struct search *search, unsigned h)
{
    float span_s = search->time_s[search->num_scans - 1u] - search->time_s[0];
    float spread_s2 = (float)(h * (h + 1u)) * span_s * span_s / (12.0f * (float)(h - 1u));
    float log_subsets =
        log_factorial(search->num_scans) - log_factorial(h) - log_factorial(search->num_scans - h);
    return rho_exp(log_subsets + log_chance(search, h, largest_sigma_m(search), spread_s2));
}

static unsigned choose_min_scans(const struct search *search)
{
    unsigned m = search->num_scans;
    float chance = m > 3 ? chance_tracks(search, m) : 0.0f;
    while (m > 3) {
        chance += chance_tracks(search, m - 1u);
        if (!(chance <= CHANCE_TRACKS_MAX)) {
            break;
        }
        m--;
    }
    return m;
}

/* ---- before a search -------------------------------------------------------------------------- */

/*
 * A batch asks once: its density is never below one plot in the area and scan. Searches after every scan must tell clear
 * skies from cluttered ones: half a plot in the area and window is what is expected where none was seen (the median of a
 * density of which nothing else is known).
 */
#define PLOTS_UNSEEN 0.5f

static float mean_density(const struct search *search, float plots, float area)
{
    float mean =
        (plots + (search->keeps_rate ? PLOTS_UNSEEN : 0.0f)) / ((float)search->num_scans * area);
    float floor = search->keeps_rate ? 0.0f : 1.0f / area;
    return mean > floor ? mean : floor;
}

/* Counts the plots that are not skipped, and more_plots beside, over the area. */
void rho_initiator_measure_density(struct search *search, uint16_t skip_flags, float more_plots)
{
    struct rho_initiator *initiator = search->initiator;
    uint32_t plots = count_plots(initiator, skip_flags, 0);
    initiator->density_per_m2 = mean_density(search, (float)plots + more_plots, area_m2(initiator));
    lay_map(initiator, plots);
    (void)count_plots(initiator, skip_flags, 1);
    initiator->density_prior_plots = prior_plots(initiator);
}

void rho_initiator_prepare(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    const struct rho_initiator_config *config = &initiator->config;
    rho_initiator_measure_density(search, RHO_WINDOW_INITIATED, 0.0f);
    for (unsigned m = 0; m < search->num_scans; m++) {
        float sensor_pd = rho_window_scan_at(&initiator->window, m)->sensor.pd;
        float pd = sensor_pd > 0.0f ? sensor_pd : config->pd;
        search->log_pd[m] = rho_log(pd);
        search->log_miss[m] = rho_log(1.0f - pd);
    }
    /* targets are anywhere in the area, their velocities anywhere in the ring of allowed speeds */
    search->log_prior =
        LOG_TARGETS_EXPECTED - rho_log(area_m2(initiator)) - LOG_PI -
        rho_log(config->v_max_mps * config->v_max_mps - config->v_min_mps * config->v_min_mps);
    search->min_scans = config->min_scans    ? config->min_scans
                        : search->keeps_rate ? 3u
                                             : choose_min_scans(search);
}
