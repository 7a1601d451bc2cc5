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
#include "clutter_density.h"

#include <string.h>

#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"

float rho_density_area_m2(const struct rho_initiator *initiator)
{
    float area = rho_extent_area_m2(&initiator->window.extent, initiator->window.side_min_m);
    return area > 1.0f ? area : 1.0f;
}

static unsigned clamp_cell_count(float cells)
{
    const float most = (float)RHO_MAX_DENSITY_CELLS;
    return cells >= 1.0f ? (unsigned)(cells < most ? cells : most) : 1u;
}

static unsigned cell_at(float v, float min, float side, unsigned cells)
{
    return (unsigned)rho_cell_at((v - min) * (float)cells / side, (int)cells);
}

static float distance_m(float dx_m, float dy_m)
{
    return rho_sqrt(dx_m * dx_m + dy_m * dy_m);
}

/* Index of the map's cell at a place. Sets the map's content (m^2, or m rad) a square metre. */
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
    return cell_at(v, map->v0, map->height, map->rows) * map->columns +
           cell_at(u, map->u0, map->width, map->columns);
}

/* True where each radar has a density map of its own; constant 0 in a build with one map. */
static int has_map_per_radar(const struct rho_initiator *initiator)
{
    return RHO_MAX_DENSITY_MAPS > 1 && initiator->num_maps > 1;
}

/* The density map that counts a sensor's plots: its own, or the common one. */
static const struct rho_density_map *map_of_sensor(const struct rho_initiator *initiator,
                                                   int32_t sensor_id)
{
    for (unsigned i = 1; has_map_per_radar(initiator) && i < initiator->num_maps; i++) {
        if (initiator->density[i].sensor_id == sensor_id) {
            return &initiator->density[i];
        }
    }
    return &initiator->density[0];
}

/* Radars of the window's scans that did not move. */
struct radars {
    const struct rho_sensor *of[RHO_MAX_DENSITY_MAPS];
    unsigned count;
};

/*
 * Lists the radars of the window's scans. Returns 1 where none of them moved, there is a density
 * map for each, and the noise of plots is anisotropic.
 */
static int list_radars(const struct search *search, struct radars *radars)
{
    const unsigned num_scans = search->initiator->window.num_scans;
    int is_radar = 0;
    radars->count = 0;
    for (unsigned m = 0; m < num_scans && !rho_search_is_isotropic(search); m++) {
        const struct rho_window_scan *scan = rho_search_scan(search, m);
        const struct rho_sensor *sensor = &scan->sensor;
        unsigned i = 0;
        is_radar |= !scan->is_isotropic;
        while (i < radars->count && radars->of[i]->sensor_id != sensor->sensor_id) {
            i++;
        }
        if (i < radars->count) {
            float dx_m = radars->of[i]->x_m - sensor->x_m, dy_m = radars->of[i]->y_m - sensor->y_m;
            if (!(dx_m * dx_m + dy_m * dy_m < 1.0f)) {
                return 0;
            }
        } else if (radars->count == RHO_MAX_DENSITY_MAPS) {
            return 0;
        } else {
            radars->of[radars->count++] = sensor;
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

/* Spread of a radar's plots: first ranges and the mean azimuth, then the sector about it. */
static struct polar_spread polar_spread_of_plots(const struct search *search,
                                                 const struct rho_sensor *radar)
{
    struct polar_spread spread = {.plots = 0.0f, .extent = {1.0f, 0.0f, 1.0f, 0.0f}};
    for (unsigned m = 0; m < search->num_scans; m++) {
        const struct rho_window_scan *scan = rho_search_scan(search, m);
        for (unsigned i = 0; i < scan->num_plots && scan->sensor.sensor_id == radar->sensor_id;
             i++) {
            float dx_m = scan->plots[i].x_m - radar->x_m, dy_m = scan->plots[i].y_m - radar->y_m;
            const float range_m = rho_larger(distance_m(dx_m, dy_m), 1.0f);
            spread.nearest_m =
                spread.plots < 1.0f || range_m < spread.nearest_m ? range_m : spread.nearest_m;
            spread.farthest_m = rho_larger(range_m, spread.farthest_m);
            spread.sum_log_range += rho_log(range_m);
            spread.sum_x += dx_m / range_m;
            spread.sum_y += dy_m / range_m;
            spread.plots += 1.0f;
            rho_extent_add(&spread.extent, scan->plots[i].x_m, scan->plots[i].y_m);
        }
    }
    spread.middle_rad = rho_atan2(spread.sum_y, spread.sum_x);
    for (unsigned m = 0; m < search->num_scans; m++) {
        const struct rho_window_scan *scan = rho_search_scan(search, m);
        for (unsigned i = 0; i < scan->num_plots && scan->sensor.sensor_id == radar->sensor_id;
             i++) {
            float dx_m = scan->plots[i].x_m - radar->x_m, dy_m = scan->plots[i].y_m - radar->y_m;
            float off_rad = rho_angle_difference(rho_atan2(dy_m, dx_m), spread.middle_rad);
            spread.left_rad = rho_larger(off_rad, spread.left_rad);
            spread.right_rad = rho_smaller(off_rad, spread.right_rad);
        }
    }
    return spread;
}

/*
 * Lays out a map over the range and azimuth of a radar's plots, a little wider: the extremes of n
 * evenly spread plots fall short of each end of the coverage by a share 1 / (n + 1) on average. A
 * sector of more than ALL_ROUND_RAD becomes the whole circle. Returns 0 where the plots are too
 * few, or likelier under an even density over the area than under one in range and azimuth, 1 /
 * (content range) a square metre.
 */
static int lay_out_polar_map(const struct search *search, const struct rho_sensor *radar,
                             int is_only_radar, struct rho_density_map *map)
{
    struct polar_spread spread = polar_spread_of_plots(search, radar);
    float area_m2 = is_only_radar ? rho_density_area_m2(search->initiator)
                                  : rho_extent_area_m2(&spread.extent, 1.0f);
    if (2.0f * spread.plots < (float)PLOTS_PER_CELL) {
        return 0;
    }
    float wider = (spread.plots + 1.0f) / (spread.plots - 1.0f);
    float sector_rad = wider * (spread.left_rad - spread.right_rad);
    float depth_m = wider * (spread.farthest_m - spread.nearest_m);
    map->is_polar = 1;
    map->sensor_x_m = radar->x_m;
    map->sensor_y_m = radar->y_m;
    map->u0 = 0.5f * (spread.farthest_m + spread.nearest_m - depth_m);
    map->width = depth_m > 1.0f ? depth_m : 1.0f;
    map->v0 = -RHO_PI;
    map->height = RHO_TWO_PI;
    if (sector_rad < ALL_ROUND_RAD) {
        map->middle_rad = spread.middle_rad + 0.5f * (spread.left_rad + spread.right_rad);
        map->height = rho_larger(sector_rad, 1.0e-3f); /* plots in one direction have a width */
        map->v0 = -0.5f * map->height;
    }
    map->content = map->width * map->height;
    return spread.sum_log_range + spread.plots * rho_log(map->content) <
           spread.plots * rho_log(area_m2);
}

/*
 * Lays out the density maps by all plots held, also those that are not counted later. Radars whose
 * clutter is even in range and azimuth have a map each; otherwise all share one over the area.
 */
static void lay_out_density_maps(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    struct radars radars = {.count = 0};
    int is_polar = list_radars(search, &radars);
    memset(initiator->density, 0, sizeof initiator->density);
    for (unsigned i = 0; i < radars.count && is_polar; i++) {
        is_polar =
            lay_out_polar_map(search, radars.of[i], radars.count == 1, &initiator->density[i]);
        initiator->density[i].sensor_id = radars.of[i]->sensor_id;
    }
    initiator->num_maps = is_polar ? (uint16_t)radars.count : 1;
    if (!is_polar) {
        const struct rho_extent *extent = &initiator->window.extent;
        struct rho_density_map *map = &initiator->density[0];
        float side_min_m = rho_larger(initiator->window.side_min_m, 1.0f);
        map->is_polar = 0;
        map->u0 = extent->x_min_m;
        map->v0 = extent->y_min_m;
        map->width = rho_extent_width_m(extent, side_min_m);
        map->height = rho_extent_height_m(extent, side_min_m);
        map->content = rho_density_area_m2(initiator);
    }
}

/* Number of plots of scan m without these marks; counts them in the map's cells, if not NULL. */
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
 * (variance - mean) over the cells: Poisson counts give the mean all weight, patchy clutter less.
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

/* True where a map counts the plots of scan m. */
static int is_map_of_scan(const struct search *search, const struct rho_density_map *map,
                          unsigned m)
{
    return map_of_sensor(search->initiator, rho_search_scan(search, m)->sensor.sensor_id) == map;
}

/* Counts the plots of a map's scans in its cells, and sets its mean density. */
static void fill_density_map(struct search *search, struct rho_density_map *map,
                             uint16_t skip_flags, const uint32_t by_scan[RHO_MAX_SCANS],
                             float more_plots)
{
    float scans = 0.0f, all = (float)search->num_scans;
    uint32_t plots = 0;
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (is_map_of_scan(search, map, m)) {
            plots += by_scan[m];
            scans += 1.0f;
        }
    }
    const uint32_t whole_cells = plots / PLOTS_PER_CELL + 1u;
    const float cells = (float)whole_cells;
    /* ratio of a cell's sides, in range and azimuth: the range over the arc at half the range */
    const float aspect = map->is_polar ? 2.0f / map->height : map->width / map->height;
    map->columns = (uint8_t)clamp_cell_count(rho_sqrt(cells * aspect));
    map->rows = (uint8_t)clamp_cell_count(cells / (float)map->columns);
    memset(map->count, 0, sizeof map->count);
    map->scans = search->scans_seen * scans / all;
    map->mean =
        mean_density(search, (float)plots + more_plots * scans / all, map->scans, map->content);
    for (unsigned m = 0; m < search->num_scans; m++) {
        if (is_map_of_scan(search, map, m)) {
            (void)count_plots_of_scan(search->initiator, m, skip_flags, map);
        }
    }
    map->prior_plots = weight_of_mean_density(map);
}

void rho_density_measure(struct search *search, uint16_t skip_flags, float more_plots)
{
    struct rho_initiator *initiator = search->initiator;
    uint32_t by_scan[RHO_MAX_SCANS] = {0}, plots = 0;
    for (unsigned m = 0; m < search->num_scans; m++) {
        by_scan[m] = count_plots_of_scan(initiator, m, skip_flags, 0);
        plots += by_scan[m];
    }
    search->is_continued = 0; /* the maps now count the newest sector's plots, too */
    initiator->density_per_m2 = mean_density(search, (float)plots + more_plots, search->scans_seen,
                                             rho_density_area_m2(initiator));
    for (unsigned i = 0; i < initiator->num_maps; i++) {
        fill_density_map(search, &initiator->density[i], skip_flags, by_scan, more_plots);
    }
    /*
     * by scan: the plots a scan of its sensor over the mean of all sensors; one scan of mean
     * density is added to the sensor's own. 1 where there is one sensor, or each has a map
     */
    for (unsigned m = 0; m < search->num_scans; m++) {
        int32_t sensor_id = rho_search_scan(search, m)->sensor.sensor_id;
        float own = 0.0f, scans = 0.0f;
        for (unsigned k = 0; k < search->num_scans; k++) {
            if (rho_search_scan(search, k)->sensor.sensor_id == sensor_id) {
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

void rho_density_begin(struct search *search)
{
    if (search->is_continued) {
        for (unsigned m = 0; m < search->num_scans; m++) {
            search->log_ratio[m] = rho_log(search->initiator->sensor_ratio[m]);
        }
        return;
    }
    lay_out_density_maps(search);
    rho_density_measure(search, RHO_WINDOW_INITIATED, 0.0f);
}

/* Density of a cell with so many plots, shrunk towards the mean; per unit of the map's content. */
static float density_of_cell_count(const struct rho_density_map *map, float count)
{
    float prior = map->prior_plots;
    return map->mean * (count + prior) / (mean_cell_count(map) + prior);
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
        /* a radar has no clutter beyond its range */
        const int is_beyond =
            map->is_polar &&
            distance_m(x_m - map->sensor_x_m, y_m - map->sensor_y_m) > map->u0 + map->width;
        sum += is_beyond ? 0.0f : map->scans * density_in_map(map, x_m, y_m);
        scans += map->scans;
    }
    return sum > 0.0f ? sum / scans : first;
}

float rho_density_mean_at(const struct rho_initiator *initiator, float x_m, float y_m)
{
    return rho_clutter_memory_raise(initiator, x_m, y_m,
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
           (rho_clutter_memory_raise(initiator, x_m, y_m, held_per_m2) / held_per_m2);
}

float rho_initiator_density(const struct rho_initiator *initiator, int32_t sensor_id, float x_m,
                            float y_m)
{
    const struct rho_density_map *map = map_of_sensor(initiator, sensor_id);
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
    return rho_density_mean_at(initiator, x_m, y_m) * ratio;
}

float rho_density_log_of_hit(const struct search *search, const struct plot_set *set, unsigned m)
{
    struct rho_initiator *initiator = search->initiator;
    const struct rho_window_scan *scan = rho_search_scan(search, m);
    const struct rho_window_plot *plot = rho_search_plot(search, set, m);
    const struct rho_density_map *map = map_of_sensor(initiator, scan->sensor.sensor_id);
    float per_m2, other_per_m2;
    unsigned cell = map_cell_at(map, plot->x_m, plot->y_m, &per_m2), count = map->count[cell];
    unsigned own = 0; /* of the set's own plots, those that the cell counts */
    /* the map does not count a further sector of a revolution */
    const unsigned counted = search->is_continued ? search->num_scans - 1u : search->num_scans;
    for (unsigned k = 0; k < counted && !search->is_left_out; k++) {
        if ((set->mask >> k & 1u) && is_map_of_scan(search, map, k)) {
            const struct rho_window_plot *other = rho_search_plot(search, set, k);
            own += map_cell_at(map, other->x_m, other->y_m, &other_per_m2) == cell;
        }
    }
    float density = density_of_cell_count(map, (float)(count > own ? count - own : 0u)) * per_m2;
    density = has_map_per_radar(initiator)
                  ? map_density_with_memory(initiator, plot->x_m, plot->y_m, density)
                  : rho_clutter_memory_raise(initiator, plot->x_m, plot->y_m, density);
    float log_density = rho_log(density) + search->log_ratio[m];
    if (RHO_MAX_ECHOES > 0) {
        log_density += (float)scan->repeats[set->plot[m]] / RHO_WINDOW_REPEATS_PER_NAT;
    }
    return log_density;
}
