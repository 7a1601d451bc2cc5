/* SPDX-License-Identifier: MIT */
/*
 * initiator_density: how dense clutter is, here and on average, and for each sensor.
 *
 * The map has cells of equal sides over the area; or, about a radar, cells of range and azimuth: false alarms are often
 * spread evenly over a radar's resolution cells rather than over the ground, and end at its range, not at the sides
 * of a square. The plots tell which is likelier.
 */
#include <string.h>

#include "initiator_search.h"
#include "rhotrack/angle.h"
#include "rhotrack/approx.h"

/* The map gets as many cells as hold this many plots each in the mean. */
#define PLOTS_PER_CELL 32u

/* Plots of the mean density that a cell counts beside its own, at most: then the map is flat. */
#define PRIOR_PLOTS_MAX 1.0e6f

/*
 * A batch asks once: its density is never below one plot in the area and scan. Searches after every scan must tell
 * clear skies from cluttered ones: half a plot in the area and window is what is expected where none was seen (the
 * median of a density of which nothing else is known).
 */
#define PLOTS_UNSEEN 0.5f

/* Nearer to the radar than this share of its range, density rises no further. */
#define NEAR_SHARE 0.01f

/* Fewer plots do not tell where a radar looks. */
#define POLAR_PLOTS_MIN 16.0f

#define ALL_ROUND_RAD 5.0f
#define SECTOR_MIN_RAD 1.0e-3f

float rho_initiator_area_m2(const struct rho_initiator *initiator)
{
    float area = rho_extent_area_m2(&initiator->window.extent, initiator->window.side_min_m);
    return area > 1.0f ? area : 1.0f;
}

/* ---- cells ------------------------------------------------------------------------------------ */

static unsigned clamp_cells(float cells)
{
    if (!(cells >= 1.0f)) {
        return 1;
    }
    return cells < (float)RHO_MAX_DENSITY_CELLS ? (unsigned)cells : RHO_MAX_DENSITY_CELLS;
}

static unsigned cell_at(float v, float min, float side, unsigned cells)
{
    float cell = (v - min) * (float)cells / side;
    if (!(cell > 0.0f)) {
        return 0;
    }
    return cell < (float)cells ? (unsigned)cell : cells - 1u;
}

static float distance_m(float dx_m, float dy_m)
{
    return rho_sqrt(dx_m * dx_m + dy_m * dy_m);
}

/* A place's cell; per_m2: what one unit of the map's content is on the ground there. */
static unsigned map_cell(const struct rho_density_map *map, float x_m, float y_m, float *per_m2)
{
    float u = x_m, v = y_m;
    *per_m2 = 1.0f;
    if (map->is_polar) {
        float dx_m = x_m - map->sensor_x_m, dy_m = y_m - map->sensor_y_m;
        float near_m = NEAR_SHARE * (map->u0 + map->width);
        u = distance_m(dx_m, dy_m);
        v = rho_angle_difference(rho_atan2(dy_m, dx_m), map->middle_rad);
        *per_m2 = 1.0f / (u > near_m ? u : near_m);
    }
    return cell_at(v, map->v0, map->height, map->rows) * map->columns +
           cell_at(u, map->u0, map->width, map->columns);
}

/* ---- laying it out ---------------------------------------------------------------------------- */

static int is_same_place(const struct rho_sensor *a, const struct rho_sensor *b)
{
    float dx_m = a->x_m - b->x_m, dy_m = a->y_m - b->y_m;
    return a->sensor_id == b->sensor_id && dx_m * dx_m + dy_m * dy_m < 1.0f;
}

/* One radar whose plots have noise of their own directions, and which stayed where it is. */
static const struct rho_sensor *only_radar(const struct search *search)
{
    struct rho_window *window = &search->initiator->window;
    const struct rho_sensor *first = &rho_window_scan_at(window, 0)->sensor;
    int is_radar = 0;
    for (unsigned m = 0; m < window->num_scans && !search->is_isotropic; m++) {
        const struct rho_window_scan *scan = rho_window_scan_at(window, m);
        is_radar |= !scan->is_isotropic;
        if (!is_same_place(&scan->sensor, first)) {
            return 0;
        }
    }
    return is_radar ? first : 0;
}

/* The window's plots as the radar sees them. */
struct view {
    float plots, sum_x, sum_y; /* of unit vectors */
    float nearest_m, farthest_m, sum_log_range;
    float middle_rad, left_rad, right_rad; /* a sector that holds all, from its middle */
};

static void look(struct view *view, float dx_m, float dy_m, int has_middle)
{
    if (has_middle) {
        float off_rad = rho_angle_difference(rho_atan2(dy_m, dx_m), view->middle_rad);
        view->left_rad = off_rad > view->left_rad ? off_rad : view->left_rad;
        view->right_rad = off_rad < view->right_rad ? off_rad : view->right_rad;
        return;
    }
    float range_m = distance_m(dx_m, dy_m);
    if (!(range_m >= 1.0f)) {
        range_m = 1.0f;
    }
    view->nearest_m = view->plots < 1.0f || range_m < view->nearest_m ? range_m : view->nearest_m;
    view->farthest_m = range_m > view->farthest_m ? range_m : view->farthest_m;
    view->sum_log_range += rho_log(range_m);
    view->sum_x += dx_m / range_m;
    view->sum_y += dy_m / range_m;
    view->plots += 1.0f;
}

static struct view view_of(const struct search *search, const struct rho_sensor *radar)
{
    struct rho_window *window = &search->initiator->window;
    struct view view = {.plots = 0.0f};
    for (int has_middle = 0; has_middle < 2; has_middle++) {
        view.middle_rad = has_middle ? rho_atan2(view.sum_y, view.sum_x) : 0.0f;
        for (unsigned m = 0; m < window->num_scans; m++) {
            const struct rho_window_scan *scan = rho_window_scan_at(window, m);
            for (unsigned i = 0; i < scan->num_plots; i++) {
                look(&view, scan->plots[i].x_m - radar->x_m, scan->plots[i].y_m - radar->y_m,
                     has_middle);
            }
        }
    }
    return view;
}

/* The ends of n places, evenly spread, fall short of the ends of what the radar sees by a share 1 / (n + 1) each, on
 * average; almost all round is all round. */
static void lay_sector(const struct rho_sensor *radar, const struct view *view,
                       struct rho_density_map *map)
{
    float wider = (view->plots + 1.0f) / (view->plots - 1.0f);
    float sector_rad = wider * (view->left_rad - view->right_rad);
    float depth_m = wider * (view->farthest_m - view->nearest_m);
    map->is_polar = 1;
    map->sensor_x_m = radar->x_m;
    map->sensor_y_m = radar->y_m;
    map->u0 = 0.5f * (view->farthest_m + view->nearest_m - depth_m);
    map->width = depth_m > 1.0f ? depth_m : 1.0f;
    map->v0 = -RHO_PI;
    map->height = RHO_TWO_PI;
    if (sector_rad < ALL_ROUND_RAD) {
        map->middle_rad = view->middle_rad + 0.5f * (view->left_rad + view->right_rad);
        map->height = sector_rad > SECTOR_MIN_RAD ? sector_rad : SECTOR_MIN_RAD;
        map->v0 = -0.5f * map->height;
    }
    map->content = map->width * map->height;
}

/* Where the plots are likelier if they are even in range and azimuth, 1 / (content range) a square metre, than if
 * they are even over the area. Returns 0 where they are not. */
static int lay_polar(const struct search *search, const struct rho_sensor *radar)
{
    struct rho_density_map *map = &search->initiator->density;
    struct view view = view_of(search, radar);
    if (view.plots < POLAR_PLOTS_MIN) {
        return 0;
    }
    lay_sector(radar, &view, map);
    return view.sum_log_range + view.plots * rho_log(map->content) <
           view.plots * rho_log(rho_initiator_area_m2(search->initiator));
}

static void lay_square(const struct rho_initiator *initiator, struct rho_density_map *map)
{
    const struct rho_window *window = &initiator->window;
    float side_min_m = window->side_min_m > 1.0f ? window->side_min_m : 1.0f;
    map->is_polar = 0;
    map->u0 = window->extent.x_min_m;
    map->v0 = window->extent.y_min_m;
    map->width = rho_extent_width_m(&window->extent, side_min_m);
    map->height = rho_extent_height_m(&window->extent, side_min_m);
    map->content = rho_initiator_area_m2(initiator);
}

/* Where the map lies follows from all plots held, whichever are counted. */
static void lay_map(struct search *search)
{
    struct rho_density_map *map = &search->initiator->density;
    const struct rho_sensor *radar = only_radar(search);
    memset(map, 0, sizeof *map);
    if (!radar || !lay_polar(search, radar)) {
        lay_square(search->initiator, map);
    }
}

static void lay_cells(struct rho_density_map *map, uint32_t num_plots)
{
    uint32_t wanted = num_plots / PLOTS_PER_CELL + 1u;
    float cells = (float)wanted;
    /* an arc of half the range is as long as azimuth times that */
    float aspect = map->is_polar ? 2.0f / map->height : map->width / map->height;
    map->columns = (uint16_t)clamp_cells(rho_sqrt(cells * aspect));
    map->rows = (uint16_t)clamp_cells(cells / (float)map->columns);
    memset(map->count, 0, sizeof map->count);
}

/* ---- counting --------------------------------------------------------------------------------- */

/* Plots that are not skipped: of each scan, and into the map. */
static void count_plots(struct rho_initiator *initiator, uint16_t skip_flags, int into_map,
                        uint32_t by_scan[RHO_MAX_SCANS])
{
    struct rho_density_map *map = &initiator->density;
    for (unsigned m = 0; m < initiator->window.num_scans; m++) {
        const struct rho_window_scan *scan = rho_window_scan_at(&initiator->window, m);
        by_scan[m] = 0;
        for (unsigned i = 0; i < scan->num_plots; i++) {
            const struct rho_window_plot *plot = &scan->plots[i];
            if (scan->marks[i] & skip_flags) {
                continue;
            }
            by_scan[m]++;
            if (into_map) {
                float per_m2;
                uint16_t *count = &map->count[map_cell(map, plot->x_m, plot->y_m, &per_m2)];
                *count = (uint16_t)(*count < UINT16_MAX ? *count + 1u : UINT16_MAX);
            }
        }
    }
}

/* Whole turns that the map counts. */
static float scans_of(const struct rho_initiator *initiator)
{
#if RHO_SECTORS
    return initiator->density.scans;
#else
    return (float)initiator->window.num_scans;
#endif
}

static float mean_cell_count(const struct rho_initiator *initiator)
{
    const struct rho_density_map *map = &initiator->density;
    float cells = (float)map->columns * (float)map->rows;
    return map->mean * map->content * scans_of(initiator) / cells;
}

/*
 * How many plots of the mean density each cell's own count is weighed against (empirical Bayes, gamma prior): mean^2 /
 * (variance - mean) over the cells. Where counts scatter no more than chance makes them, the mean is believed; where
 * clutter is patchy, the cells are.
 */
static float prior_plots(const struct rho_initiator *initiator)
{
    const struct rho_density_map *map = &initiator->density;
    unsigned cells = (unsigned)map->columns * map->rows;
    float mean = mean_cell_count(initiator), variance = 0.0f;
    if (cells < 2) {
        return PRIOR_PLOTS_MAX; /* one cell is the mean */
    }
    for (unsigned c = 0; c < cells; c++) {
        float excess = (float)map->count[c] - mean;
        variance += excess * excess / (float)(cells - 1u);
    }
    float beyond_chance = variance - mean;
    return beyond_chance * PRIOR_PLOTS_MAX > mean * mean ? mean * mean / beyond_chance
                                                         : PRIOR_PLOTS_MAX;
}

static float scans_held(const struct search *search)
{
#if RHO_SECTORS
    return search->scans_seen;
#else
    return (float)search->num_scans;
#endif
}

static float mean_density(const struct search *search, float plots, float content)
{
    float mean =
        (plots + (search->keeps_rate ? PLOTS_UNSEEN : 0.0f)) / (scans_held(search) * content);
    float floor = search->keeps_rate ? 0.0f : 1.0f / content;
    return mean > floor ? mean : floor;
}

/*
 * Plots a scan of each scan's sensor over those of all: one scan like the mean counts beside the sensor's own. 1 where
 * there is one sensor.
 */
static void measure_sensors(struct search *search, const uint32_t by_scan[RHO_MAX_SCANS],
                            uint32_t plots)
{
    struct rho_initiator *initiator = search->initiator;
    for (unsigned m = 0; m < search->num_scans; m++) {
        int32_t sensor_id = rho_window_scan_at(&initiator->window, m)->sensor.sensor_id;
        float own = 0.0f, scans = 0.0f;
        for (unsigned k = 0; k < search->num_scans; k++) {
            if (rho_window_scan_at(&initiator->window, k)->sensor.sensor_id == sensor_id) {
                own += (float)by_scan[k];
                scans += 1.0f;
            }
        }
        float share = plots > 0 ? own * (float)search->num_scans / (float)plots : scans;
        initiator->density.sensor_id[m] = sensor_id;
        initiator->density.sensor_ratio[m] = (share + 1.0f) / (scans + 1.0f);
        search->log_ratio[m] = rho_log(initiator->density.sensor_ratio[m]);
    }
}

/* Counts the plots that are not skipped, and more_plots beside, over the map as it was laid. */
void rho_initiator_measure_density(struct search *search, uint16_t skip_flags, float more_plots)
{
    struct rho_initiator *initiator = search->initiator;
    uint32_t by_scan[RHO_MAX_SCANS] = {0}, plots = 0;
    count_plots(initiator, skip_flags, 0, by_scan);
    for (unsigned m = 0; m < search->num_scans; m++) {
        plots += by_scan[m];
    }
    lay_cells(&initiator->density, plots);
#if RHO_SECTORS
    initiator->density.scans = search->scans_seen;
    search->is_continued = 0; /* all plots are in the map now */
#endif
    initiator->density.mean =
        mean_density(search, (float)plots + more_plots, initiator->density.content);
    initiator->density_per_m2 =
        mean_density(search, (float)plots + more_plots, rho_initiator_area_m2(initiator));
    count_plots(initiator, skip_flags, 1, by_scan);
    initiator->density.prior_plots = prior_plots(initiator);
    measure_sensors(search, by_scan, plots);
}

void rho_initiator_begin_density(struct search *search)
{
#if RHO_SECTORS
    if (search->is_continued) {
        for (unsigned m = 0; m < search->num_scans; m++) {
            search->log_ratio[m] = rho_log(search->initiator->density.sensor_ratio[m]);
        }
        return;
    }
#endif
    lay_map(search);
    rho_initiator_measure_density(search, RHO_WINDOW_INITIATED, 0.0f);
}

/* ---- asking ----------------------------------------------------------------------------------- */

/* The density where a cell of the map counts so many plots. */
static float density_of(const struct rho_initiator *initiator, float count)
{
    float prior = initiator->density.prior_plots;
    return initiator->density.mean * (count + prior) / (mean_cell_count(initiator) + prior);
}

float rho_initiator_mean_density(const struct rho_initiator *initiator, float x_m, float y_m)
{
    float per_m2;
    unsigned cell = map_cell(&initiator->density, x_m, y_m, &per_m2);
    float density = density_of(initiator, (float)initiator->density.count[cell]) * per_m2;
    return rho_initiator_remembered(initiator, x_m, y_m, density);
}

float rho_initiator_density(const struct rho_initiator *initiator, int32_t sensor_id, float x_m,
                            float y_m)
{
    const struct rho_density_map *map = &initiator->density;
    if (map->columns == 0) {
        return 0.0f;
    }
    float ratio = 1.0f;
    for (unsigned m = 0; m < RHO_MAX_SCANS; m++) {
        if (map->sensor_ratio[m] > 0.0f && map->sensor_id[m] == sensor_id) {
            ratio = map->sensor_ratio[m];
            break;
        }
    }
    return rho_initiator_mean_density(initiator, x_m, y_m) * ratio;
}

/* A scan's plots; of a turn's further sectors they are not. */
static int is_in_map(const struct search *search, unsigned m)
{
#if RHO_SECTORS
    return !search->is_continued || m + 1u < search->num_scans;
#else
    (void)search, (void)m;
    return 1;
#endif
}

/* The density that hit m of a set is measured against: the set's own plots are taken out of its cell, where they are in
 * it. */
float rho_initiator_log_density(const struct search *search, const struct plot_set *set, unsigned m)
{
    const struct rho_window_plot *plot = rho_initiator_plot(search, set, m);
    const struct rho_density_map *map = &search->initiator->density;
    float per_m2, other_per_m2;
    unsigned cell = map_cell(map, plot->x_m, plot->y_m, &per_m2), own = 0;
    for (unsigned k = 0; k < search->num_scans && !search->is_left_out; k++) {
        if ((set->mask >> k & 1u) && is_in_map(search, k)) {
            const struct rho_window_plot *other = rho_initiator_plot(search, set, k);
            own += map_cell(map, other->x_m, other->y_m, &other_per_m2) == cell;
        }
    }
    unsigned count = map->count[cell];
    float density = density_of(search->initiator, (float)(count > own ? count - own : 0u)) * per_m2;
    density = rho_initiator_remembered(search->initiator, plot->x_m, plot->y_m, density);
    float log_density = rho_log(density) + search->log_ratio[m];
#if RHO_MAX_ECHOES > 0
    log_density += (float)rho_window_scan_at(&search->initiator->window, m)->repeats[set->plot[m]] /
                   RHO_WINDOW_REPEATS_PER_NAT;
#endif
    return log_density;
}
