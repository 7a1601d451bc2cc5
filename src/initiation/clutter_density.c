/* SPDX-License-Identifier: MIT */
/*
 * clutter_density: the density of clutter at a place, on average over all sensors and for each
 * sensor.
 *
 * A density map has square cells over the area, or cells of range and azimuth about a radar: false
 * alarms are often spread evenly over a radar's resolution cells rather than over the ground, and
 * end at the radar's range. The kind of cells under which the plots are likelier is taken. Several
 * radars have a map each where all have cells of range and azimuth.
 */
#include <string.h>

#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "search.h"

/* Mean number of plots in a cell of a density map. */
#define PLOTS_PER_CELL 32u

/* Largest weight of the mean density against a cell's count, in plots: the map is then flat. */
#define PRIOR_PLOTS_MAX 1.0e6f

/*
 * Plots expected where none was seen, in searches after every scan: half a plot in area and window,
 * the median of a density without prior knowledge, so that clear skies differ from cluttered ones.
 * The density of a batch is at least one plot in the area and scan.
 */
#define PLOTS_UNSEEN 0.5f

/* Share of a radar's range below which the density per square metre rises no further. */
#define NEAR_SHARE 0.01f

/* Least number of plots that determine the sector of a radar for a map of range and azimuth. */
#define POLAR_PLOTS_MIN 16.0f

#define ALL_ROUND_RAD 5.0f
#define SECTOR_MIN_RAD 1.0e-3f

float rho_initiator_area_m2(const struct rho_initiator *initiator)
{
    float area = rho_extent_area_m2(&initiator->window.extent, initiator->window.side_min_m);
    return area > 1.0f ? area : 1.0f;
}

/* ---- cells ----------------------------------------------------------------------------------- */

static unsigned clamp_cell_count(float cells)
{
    if (!(cells >= 1.0f)) {
        return 1;
    }
    return cells < (float)RHO_MAX_DENSITY_CELLS ? (unsigned)cells : RHO_MAX_DENSITY_CELLS;
}

static unsigned cell_index_at(float v, float min, float side, unsigned cells)
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

/*
 * Index of the map's cell at a place. Sets *content_per_m2 to the map's content (m^2, or m rad) per
 * square metre there.
 */
static unsigned map_cell_at(const struct rho_density_map *map, float x_m, float y_m,
                            float *content_per_m2)
{
    float u = x_m, v = y_m;
    *content_per_m2 = 1.0f;
    if (map->is_polar) {
        float dx_m = x_m - map->sensor_x_m, dy_m = y_m - map->sensor_y_m;
        float near_m = NEAR_SHARE * (map->u0 + map->width);
        u = distance_m(dx_m, dy_m);
        v = rho_angle_difference(rho_atan2(dy_m, dx_m), map->middle_rad);
        *content_per_m2 = 1.0f / (u > near_m ? u : near_m);
    }
    return cell_index_at(v, map->v0, map->height, map->rows) * map->columns +
           cell_index_at(u, map->u0, map->width, map->columns);
}

/* True where each radar has a density map of its own; constant 0 in a build with one map. */
static int has_map_per_radar(const struct rho_initiator *initiator)
{
    return RHO_MAX_DENSITY_MAPS > 1 && initiator->num_maps > 1;
}

/* The density map that counts a sensor's plots: its own, or the common one. */
static const struct rho_density_map *
map_of_sensor_or_common_map(const struct rho_initiator *initiator, int32_t sensor_id)
{
    for (unsigned i = 1; has_map_per_radar(initiator) && i < initiator->num_maps; i++) {
        if (initiator->density[i].sensor_id == sensor_id) {
            return &initiator->density[i];
        }
    }
    return &initiator->density[0];
}

/* ---- laying it out --------------------------------------------------------------------------- */

static int is_same_unmoved_radar(const struct rho_sensor *a, const struct rho_sensor *b)
{
    float dx_m = a->x_m - b->x_m, dy_m = a->y_m - b->y_m;
    return a->sensor_id == b->sensor_id && dx_m * dx_m + dy_m * dy_m < 1.0f;
}

/* Radars of the window's scans that did not move. */
struct radars {
    const struct rho_sensor *of[RHO_MAX_DENSITY_MAPS];
    unsigned count;
};

static int add_radar_unless_moved_or_full(struct radars *radars, const struct rho_sensor *sensor)
{
    for (unsigned i = 0; i < radars->count; i++) {
        if (radars->of[i]->sensor_id == sensor->sensor_id) {
            return is_same_unmoved_radar(radars->of[i], sensor);
        }
    }
    if (radars->count == RHO_MAX_DENSITY_MAPS) {
        return 0;
    }
    radars->of[radars->count++] = sensor;
    return 1;
}

/*
 * Lists the radars of the window's scans. Returns 1 where none of them moved, there is a density
 * map for each, and the noise of plots is anisotropic.
 */
static int list_radars_for_polar_maps(const struct search *search, struct radars *radars)
{
    struct rho_window *window = &search->initiator->window;
    int is_radar = 0;
    radars->count = 0;
    for (unsigned m = 0; m < window->num_scans && !rho_initiator_takes_isotropic_path(search);
         m++) {
        const struct rho_window_scan *scan = rho_window_scan_at(window, m);
        is_radar |= !scan->is_isotropic;
        if (!add_radar_unless_moved_or_full(radars, &scan->sensor)) {
            return 0;
        }
    }
    return is_radar;
}

/* Spread of one radar's plots in the window, in range and azimuth. */
struct polar_spread {
    float plots, sum_x, sum_y; /* number of plots; sum of their unit vectors from the radar */
    float nearest_m, farthest_m, sum_log_range;
    /* mean azimuth; ends of the sector that holds all plots, relative to the mean azimuth */
    float middle_rad, left_rad, right_rad;
    struct rho_extent extent;
};

/*
 * Adds a plot to the spread of a radar's plots. The first pass sums ranges and directions; the
 * second, with the mean azimuth known, widens the sector.
 */
static void add_plot_to_spread_in_pass(struct polar_spread *spread, float dx_m, float dy_m,
                                       int is_second_pass)
{
    if (is_second_pass) {
        float off_rad = rho_angle_difference(rho_atan2(dy_m, dx_m), spread->middle_rad);
        spread->left_rad = off_rad > spread->left_rad ? off_rad : spread->left_rad;
        spread->right_rad = off_rad < spread->right_rad ? off_rad : spread->right_rad;
        return;
    }
    float range_m = distance_m(dx_m, dy_m);
    if (!(range_m >= 1.0f)) {
        range_m = 1.0f;
    }
    spread->nearest_m =
        spread->plots < 1.0f || range_m < spread->nearest_m ? range_m : spread->nearest_m;
    spread->farthest_m = range_m > spread->farthest_m ? range_m : spread->farthest_m;
    spread->sum_log_range += rho_log(range_m);
    spread->sum_x += dx_m / range_m;
    spread->sum_y += dy_m / range_m;
    spread->plots += 1.0f;
}

static struct polar_spread polar_spread_of_plots(const struct search *search,
                                                 const struct rho_sensor *radar)
{
    struct rho_window *window = &search->initiator->window;
    struct polar_spread spread = {.plots = 0.0f, .extent = {1.0f, 0.0f, 1.0f, 0.0f}};
    for (int is_second_pass = 0; is_second_pass < 2; is_second_pass++) {
        spread.middle_rad = is_second_pass ? rho_atan2(spread.sum_y, spread.sum_x) : 0.0f;
        for (unsigned m = 0; m < window->num_scans; m++) {
            const struct rho_window_scan *scan = rho_window_scan_at(window, m);
            for (unsigned i = 0; i < scan->num_plots && scan->sensor.sensor_id == radar->sensor_id;
                 i++) {
                const struct rho_window_plot *plot = &scan->plots[i];
                add_plot_to_spread_in_pass(&spread, plot->x_m - radar->x_m, plot->y_m - radar->y_m,
                                           is_second_pass);
                rho_extent_add(&spread.extent, plot->x_m, plot->y_m);
            }
        }
    }
    return spread;
}

/*
 * Lays out a map over the range and azimuth of a radar's plots, a little wider: the extremes of n
 * evenly spread plots fall short of each end of the coverage by a share 1 / (n + 1) on average. A
 * sector of more than ALL_ROUND_RAD becomes the whole circle.
 */
static void lay_out_polar_map(const struct rho_sensor *radar, const struct polar_spread *spread,
                              struct rho_density_map *map)
{
    float wider = (spread->plots + 1.0f) / (spread->plots - 1.0f);
    float sector_rad = wider * (spread->left_rad - spread->right_rad);
    float depth_m = wider * (spread->farthest_m - spread->nearest_m);
    map->is_polar = 1;
    map->sensor_x_m = radar->x_m;
    map->sensor_y_m = radar->y_m;
    map->u0 = 0.5f * (spread->farthest_m + spread->nearest_m - depth_m);
    map->width = depth_m > 1.0f ? depth_m : 1.0f;
    map->v0 = -RHO_PI;
    map->height = RHO_TWO_PI;
    if (sector_rad < ALL_ROUND_RAD) {
        map->middle_rad = spread->middle_rad + 0.5f * (spread->left_rad + spread->right_rad);
        map->height = sector_rad > SECTOR_MIN_RAD ? sector_rad : SECTOR_MIN_RAD;
        map->v0 = -0.5f * map->height;
    }
    map->content = map->width * map->height;
}

/*
 * Lays out a map in range and azimuth. Returns 0 where the plots are too few, or likelier under an
 * even density over the area than under one in range and azimuth, 1 / (content range) a square
 * metre.
 */
static int lay_out_polar_map_is_likelier(const struct search *search,
                                         const struct rho_sensor *radar, int is_only_radar,
                                         struct rho_density_map *map)
{
    struct polar_spread spread = polar_spread_of_plots(search, radar);
    float area_m2 = is_only_radar ? rho_initiator_area_m2(search->initiator)
                                  : rho_extent_area_m2(&spread.extent, 1.0f);
    if (spread.plots < POLAR_PLOTS_MIN) {
        return 0;
    }
    lay_out_polar_map(radar, &spread, map);
    return spread.sum_log_range + spread.plots * rho_log(map->content) <
           spread.plots * rho_log(area_m2);
}

static void lay_out_cartesian_map(const struct rho_initiator *initiator,
                                  struct rho_density_map *map)
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

/*
 * Lays out the density maps by all plots held, also those that are not counted later. Radars whose
 * clutter is even in range and azimuth have a map each; otherwise all sensors share one map over
 * the area.
 */
static void lay_out_density_maps(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    struct radars radars = {.count = 0};
    int is_polar = list_radars_for_polar_maps(search, &radars);
    memset(initiator->density, 0, sizeof initiator->density);
    for (unsigned i = 0; i < radars.count && is_polar; i++) {
        is_polar = lay_out_polar_map_is_likelier(search, radars.of[i], radars.count == 1,
                                                 &initiator->density[i]);
        initiator->density[i].sensor_id = radars.of[i]->sensor_id;
    }
    initiator->num_maps = is_polar ? (uint16_t)radars.count : 1;
    if (!is_polar) {
        lay_out_cartesian_map(initiator, &initiator->density[0]);
    }
}

static void set_grid_and_clear_counts(struct rho_density_map *map, uint32_t num_plots)
{
    uint32_t wanted = num_plots / PLOTS_PER_CELL + 1u;
    float cells = (float)wanted;
    /* ratio of a cell's sides, in range and azimuth: the range over the arc at half the range */
    float aspect = map->is_polar ? 2.0f / map->height : map->width / map->height;
    map->columns = (uint8_t)clamp_cell_count(rho_sqrt(cells * aspect));
    map->rows = (uint8_t)clamp_cell_count(cells / (float)map->columns);
    memset(map->count, 0, sizeof map->count);
}

/* ---- counting -------------------------------------------------------------------------------- */

/*
 * Number of plots of scan m without a mark of skip_flags. Also counts these plots in the map's
 * cells where `map` is not NULL.
 */
static uint32_t count_plots_of_scan(struct rho_initiator *initiator, unsigned m,
                                    uint16_t skip_flags, struct rho_density_map *map)
{
    const struct rho_window_scan *scan = rho_window_scan_at(&initiator->window, m);
    uint32_t plots = 0;
    for (unsigned i = 0; i < scan->num_plots; i++) {
        const struct rho_window_plot *plot = &scan->plots[i];
        if (scan->marks[i] & skip_flags) {
            continue;
        }
        plots++;
        if (map) {
            float per_m2;
            uint16_t *count = &map->count[map_cell_at(map, plot->x_m, plot->y_m, &per_m2)];
            *count = (uint16_t)(*count < UINT16_MAX ? *count + 1u : UINT16_MAX);
        }
    }
    return plots;
}

static float mean_cell_count(const struct rho_density_map *map)
{
    float cells = (float)map->columns * (float)map->rows;
    return map->mean * map->content * map->scans / cells;
}

/*
 * Weight of the mean density against the count of a cell (empirical Bayes, gamma prior): mean^2 /
 * (variance - mean) over the cells. Poisson counts give the mean all weight; patchy clutter gives
 * the cells weight.
 */
static float weight_of_mean_density(const struct rho_density_map *map)
{
    unsigned cells = (unsigned)map->columns * map->rows;
    float mean = mean_cell_count(map), variance = 0.0f;
    if (cells < 2) {
        return PRIOR_PLOTS_MAX; /* a single cell has the mean density */
    }
    for (unsigned c = 0; c < cells; c++) {
        float excess = (float)map->count[c] - mean;
        variance += excess * excess / (float)(cells - 1u);
    }
    float excess = variance - mean;
    return excess * PRIOR_PLOTS_MAX > mean * mean ? mean * mean / excess : PRIOR_PLOTS_MAX;
}

static float mean_density(const struct search *search, float plots, float scans, float content)
{
    float mean = (plots + (search->keeps_rate ? PLOTS_UNSEEN : 0.0f)) / (scans * content);
    float floor = search->keeps_rate ? 0.0f : 1.0f / content;
    return mean > floor ? mean : floor;
}

/*
 * Sets, for each scan held, the plots a scan of its sensor over the mean of all sensors, and ln of
 * this ratio. One scan of mean density is added to the sensor's own. The ratio is 1 where there is
 * one sensor, or each sensor has a map.
 */
static void set_sensor_density_ratios(struct search *search, const uint32_t by_scan[RHO_MAX_SCANS],
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
        initiator->sensor_id[m] = sensor_id;
        initiator->sensor_ratio[m] =
            has_map_per_radar(initiator) ? 1.0f : (share + 1.0f) / (scans + 1.0f);
        search->log_ratio[m] = rho_log(initiator->sensor_ratio[m]);
    }
}

/* Counts the plots of a map's scans in its cells, and sets its mean density. */
static void fill_density_map(struct search *search, struct rho_density_map *map,
                             uint16_t skip_flags, const uint32_t by_scan[RHO_MAX_SCANS],
                             float more_plots)
{
    struct rho_initiator *initiator = search->initiator;
    float scans = 0.0f, all = (float)search->num_scans;
    uint32_t plots = 0;
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (map_of_sensor_or_common_map(
                initiator, rho_window_scan_at(&initiator->window, m)->sensor.sensor_id) == map) {
            plots += by_scan[m];
            scans += 1.0f;
        }
    }
    set_grid_and_clear_counts(map, plots);
    map->scans = search->scans_seen * scans / all;
    map->mean =
        mean_density(search, (float)plots + more_plots * scans / all, map->scans, map->content);
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (map_of_sensor_or_common_map(
                initiator, rho_window_scan_at(&initiator->window, m)->sensor.sensor_id) == map) {
            (void)count_plots_of_scan(initiator, m, skip_flags, map);
        }
    }
    map->prior_plots = weight_of_mean_density(map);
}

/*
 * Measures the clutter density in the maps as they are laid out: counts all plots without a mark of
 * skip_flags, and adds more_plots to the mean.
 */
void rho_initiator_measure_density(struct search *search, uint16_t skip_flags, float more_plots)
{
    struct rho_initiator *initiator = search->initiator;
    uint32_t by_scan[RHO_MAX_SCANS] = {0}, plots = 0;
    for (unsigned m = 0; m < search->num_scans; m++) {
        by_scan[m] = count_plots_of_scan(initiator, m, skip_flags, 0);
        plots += by_scan[m];
    }
    search->is_continued = 0; /* the maps now count the newest sector's plots, too */
    initiator->density_per_m2 = mean_density(search, (float)plots + more_plots, search->scans_seen,
                                             rho_initiator_area_m2(initiator));
    for (unsigned i = 0; i < initiator->num_maps; i++) {
        fill_density_map(search, &initiator->density[i], skip_flags, by_scan, more_plots);
    }
    set_sensor_density_ratios(search, by_scan, plots);
}

void rho_initiator_measure_or_keep_density(struct search *search)
{
    if (search->is_continued) {
        for (unsigned m = 0; m < search->num_scans; m++) {
            search->log_ratio[m] = rho_log(search->initiator->sensor_ratio[m]);
        }
        return;
    }
    lay_out_density_maps(search);
    rho_initiator_measure_density(search, RHO_WINDOW_INITIATED, 0.0f);
}

/* ---- asking ---------------------------------------------------------------------------------- */

/*
 * Density of a map's cell with this count of plots, shrunk towards the mean density; per unit of
 * the map's content (m^2 or m rad).
 */
static float density_of_cell_count(const struct rho_density_map *map, float count)
{
    float prior = map->prior_plots;
    return map->mean * (count + prior) / (mean_cell_count(map) + prior);
}

/* True where a place is beyond the range of a radar's map: a radar has no clutter there. */
static int is_beyond_radar_range(const struct rho_density_map *map, float x_m, float y_m)
{
    return map->is_polar &&
           distance_m(x_m - map->sensor_x_m, y_m - map->sensor_y_m) > map->u0 + map->width;
}

/* Clutter density at a place, per square metre and scan, from one map. */
static float density_in_map(const struct rho_density_map *map, float x_m, float y_m)
{
    float per_m2;
    unsigned cell = map_cell_at(map, x_m, y_m, &per_m2);
    return density_of_cell_count(map, (float)map->count[cell]) * per_m2;
}

/* Clutter density at a place, mean over the scans held, without the clutter memory. */
static float density_of_held_scans(const struct rho_initiator *initiator, float x_m, float y_m)
{
    float sum = 0.0f, scans = 0.0f, first = density_in_map(&initiator->density[0], x_m, y_m);
    if (!has_map_per_radar(initiator)) {
        return first;
    }
    for (unsigned i = 0; i < initiator->num_maps; i++) {
        const struct rho_density_map *map = &initiator->density[i];
        sum += is_beyond_radar_range(map, x_m, y_m) ? 0.0f
                                                    : map->scans * density_in_map(map, x_m, y_m);
        scans += map->scans;
    }
    return sum > 0.0f ? sum / scans : first;
}

float rho_initiator_mean_clutter_density(const struct rho_initiator *initiator, float x_m,
                                         float y_m)
{
    return rho_initiator_density_with_memory(initiator, x_m, y_m,
                                             density_of_held_scans(initiator, x_m, y_m));
}

/*
 * Raises a density from one of several maps by the clutter memory. The memory is common to all
 * sensors, so it raises each sensor's density by the same factor as their mean.
 */
static float map_density_with_memory(const struct rho_initiator *initiator, float x_m, float y_m,
                                     float density_per_m2)
{
    const float held_per_m2 = density_of_held_scans(initiator, x_m, y_m);
    return density_per_m2 *
           (rho_initiator_density_with_memory(initiator, x_m, y_m, held_per_m2) / held_per_m2);
}

float rho_initiator_density(const struct rho_initiator *initiator, int32_t sensor_id, float x_m,
                            float y_m)
{
    const struct rho_density_map *map = map_of_sensor_or_common_map(initiator, sensor_id);
    float ratio = 1.0f;
    if (initiator->num_maps == 0) {
        return 0.0f;
    }
    if (has_map_per_radar(initiator) && map->sensor_id == sensor_id) {
        return map_density_with_memory(initiator, x_m, y_m, density_in_map(map, x_m, y_m));
    }
    for (unsigned m = 0; m < RHO_MAX_SCANS; m++) {
        if (initiator->sensor_ratio[m] > 0.0f && initiator->sensor_id[m] == sensor_id) {
            ratio = initiator->sensor_ratio[m];
            break;
        }
    }
    return rho_initiator_mean_clutter_density(initiator, x_m, y_m) * ratio;
}

/*
 * True where the density map counts the plots of scan m: a further sector of a revolution is not
 * counted.
 */
static int does_map_count_scan(const struct search *search, unsigned m)
{
    return !search->is_continued || m + 1u < search->num_scans;
}

/* Number of the set's own plots that a cell of the map counts. */
static unsigned count_set_plots_in_cell(const struct search *search, const struct plot_set *set,
                                        const struct rho_density_map *map, unsigned cell)
{
    unsigned own = 0;
    for (unsigned k = 0; k < search->num_scans && !search->is_left_out; k++) {
        const struct rho_window_scan *scan = rho_window_scan_at(&search->initiator->window, k);
        if ((set->mask >> k & 1u) && does_map_count_scan(search, k) &&
            map_of_sensor_or_common_map(search->initiator, scan->sensor.sensor_id) == map) {
            const struct rho_window_plot *other = rho_initiator_plot_of_set(search, set, k);
            float per_m2;
            own += map_cell_at(map, other->x_m, other->y_m, &per_m2) == cell;
        }
    }
    return own;
}

/*
 * ln of the clutter density that hit m of a set is compared with: the set's own plots are taken out
 * of the cell, and the clutter map's echoes are added.
 */
float rho_initiator_log_density_of_hit(const struct search *search, const struct plot_set *set,
                                       unsigned scan_index)
{
    struct rho_initiator *initiator = search->initiator;
    const struct rho_window_scan *scan = rho_window_scan_at(&initiator->window, scan_index);
    const struct rho_window_plot *plot = rho_initiator_plot_of_set(search, set, scan_index);
    const struct rho_density_map *map =
        map_of_sensor_or_common_map(initiator, scan->sensor.sensor_id);
    float per_m2;
    unsigned cell = map_cell_at(map, plot->x_m, plot->y_m, &per_m2), count = map->count[cell];
    unsigned own = count_set_plots_in_cell(search, set, map, cell);
    float density = density_of_cell_count(map, (float)(count > own ? count - own : 0u)) * per_m2;
    density = has_map_per_radar(initiator)
                  ? map_density_with_memory(initiator, plot->x_m, plot->y_m, density)
                  : rho_initiator_density_with_memory(initiator, plot->x_m, plot->y_m, density);
    float log_density = rho_log(density) + search->log_ratio[scan_index];
    if (RHO_MAX_ECHOES > 0) {
        log_density += (float)scan->repeats[set->plot[scan_index]] / RHO_WINDOW_REPEATS_PER_NAT;
    }
    return log_density;
}
