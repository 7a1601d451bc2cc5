/* SPDX-License-Identifier: MIT */
#include "picture/plan_view_map.h"

#include <inttypes.h>
#include <math.h>

/* margin around everything that is drawn, as a share of the longer side */
#define MARGIN 0.05
#define MARGIN_MIN_M 10.0 /* smallest margin, for a map of a single place */
/* pixels of the picture for axes and legend beside the map, in each direction */
#define AXES_PIXELS 200
#define RADARS_RINGED 3
#define RINGS 4 /* range rings about a radar, or somewhat more: their spacing is rounded down */
#define RING_POINTS 144
#define MARKER_PIXELS 14.0

struct map_box map_box_empty(void)
{
    return (struct map_box){INFINITY, -INFINITY, INFINITY, -INFINITY};
}

void map_box_include(struct map_box *box, double x_m, double y_m)
{
    box->x_min_m = fmin(box->x_min_m, x_m);
    box->x_max_m = fmax(box->x_max_m, x_m);
    box->y_min_m = fmin(box->y_min_m, y_m);
    box->y_max_m = fmax(box->y_max_m, y_m);
}

void map_box_include_points(struct map_box *box, const struct plot_points *points)
{
    for (size_t i = 0; i < points->count; i++) {
        map_box_include(box, points->list[i].x_m, points->list[i].y_m);
    }
}

void map_box_include_radars(struct map_box *box, const struct picture_data *data)
{
    for (size_t i = 0; i < data->num_radars; i++) {
        map_box_include(box, data->radars[i].x_m, data->radars[i].y_m);
    }
}

static double longer_side_m(const struct map_box *box)
{
    return fmax(box->x_max_m - box->x_min_m, box->y_max_m - box->y_min_m);
}

static bool is_inside_box(const struct map_box *box, double x_m, double y_m)
{
    return x_m > box->x_min_m && x_m < box->x_max_m && y_m > box->y_min_m && y_m < box->y_max_m;
}

struct map map_start(const struct picture *picture, struct map_box box)
{
    if (!(box.x_min_m <= box.x_max_m)) {
        map_box_include(&box, 0.0, 0.0);
    }
    const double margin_m = fmax(MARGIN_MIN_M, MARGIN * longer_side_m(&box));
    map_box_include(&box, box.x_min_m - margin_m, box.y_min_m - margin_m);
    map_box_include(&box, box.x_max_m + margin_m, box.y_max_m + margin_m);
    const double unit_m = longer_side_m(&box) > MAP_KILOMETRES_FROM_M ? 1000.0 : 1.0;
    const char *unit = unit_m > 1.0 ? "km" : "m";
    fprintf(picture->script,
            "set size ratio -1\n"
            "set xlabel 'x east (%s)'\nset ylabel 'y north (%s)'\n"
            "set xrange [%.9g:%.9g]\nset yrange [%.9g:%.9g]\n",
            unit, unit, box.x_min_m / unit_m, box.x_max_m / unit_m, box.y_min_m / unit_m,
            box.y_max_m / unit_m);
    return (struct map){.script = picture->script,
                        .unit_m = unit_m,
                        .pixels_per_m =
                            fmin((picture->width - AXES_PIXELS) / (box.x_max_m - box.x_min_m),
                                 (picture->height - AXES_PIXELS) / (box.y_max_m - box.y_min_m)),
                        .box = box};
}

void map_write_point(const struct map *map, const struct plot_point *point, int64_t zero_us)
{
    fprintf(map->script, "%.6g %.6g %.6g %d\n", point->x_m / map->unit_m, point->y_m / map->unit_m,
            (double)(point->time_us - zero_us) * 1e-6, point->id);
}

void map_write_points(const struct map *map, const char *name, const struct plot_points *points)
{
    fprintf(map->script, "$%s << EOD\n", name);
    for (size_t i = 0; i < points->count; i++) {
        if (i > 0 && points->list[i].id != points->list[i - 1].id) {
            fprintf(map->script, "\n\n");
        }
        map_write_point(map, &points->list[i], 0);
    }
    fprintf(map->script, "EOD\n");
}

size_t map_num_plots_drawn(size_t count)
{
    return count < MAP_PLOTS_MAX ? count : MAP_PLOTS_MAX;
}

/*
 * Samples one plot of each of MAP_PLOTS_MAX equal parts of the list, at a pseudo-random place
 * within the part, so that samples do not follow the period of the scans.
 */
static size_t sampled_plot_index(size_t k, size_t count)
{
    if (count <= MAP_PLOTS_MAX) {
        return k;
    }
    const double within = (double)((uint32_t)k * UINT32_C(2654435761)) / 4294967296.0;
    return (size_t)(((double)k + within) * (double)count / MAP_PLOTS_MAX);
}

void map_write_sampled_plots(const struct map *map, const struct plot_points *plots,
                             int64_t zero_us)
{
    fprintf(map->script, "$plots << EOD\n");
    for (size_t k = 0; k < map_num_plots_drawn(plots->count); k++) {
        map_write_point(map, &plots->list[sampled_plot_index(k, plots->count)], zero_us);
    }
    fprintf(map->script, "EOD\n");
}

void map_draw_plots(const struct map *map, const struct plot_points *plots)
{
    const size_t drawn = map_num_plots_drawn(plots->count);
    if (plots->count == 0) {
        return;
    }
    /* more plots are drawn smaller and more transparent: alpha 0 is opaque, 255 invisible */
    const double density = fmin(1.0, sqrt((double)drawn / MAP_PLOTS_MAX));
    fprintf(map->script,
            ", \\\n $plots using 1:2 with points pt 7 ps %.2f lc rgb '#%02x808080' notitle"
            ", \\\n NaN with points pt 7 ps 0.5 lc rgb '#9a9a9a' title '",
            0.34 - 0.16 * density, (unsigned)(70.0 + 90.0 * density));
    if (drawn < plots->count) {
        fprintf(map->script, "%zu of %zu plots'", drawn, plots->count);
    } else {
        fprintf(map->script, "plots'");
    }
}

size_t map_points_between_markers(const struct map *map, const struct plot_points *path)
{
    struct map_box box = map_box_empty();
    map_box_include_points(&box, path);
    const double pixels =
        hypot(box.x_max_m - box.x_min_m, box.y_max_m - box.y_min_m) * map->pixels_per_m;
    const double markers = fmax(1.0, pixels / MARKER_PIXELS);
    return (size_t)fmax(1.0, ceil((double)path->count / markers));
}

double map_round_down_to_1_2_5(double value)
{
    const double decade = pow(10.0, floor(log10(fmax(value, 1e-9))));
    return value >= 5.0 * decade ? 5.0 * decade : value >= 2.0 * decade ? 2.0 * decade : decade;
}

/*
 * Radius of the largest range ring: distance to the farthest corner of the map, or the radar's
 * maximum range if that is less.
 */
static double farthest_ring_radius_m(const struct map *map, const struct plot_radar *radar)
{
    const double x_m =
        fmax(fabs(map->box.x_min_m - radar->x_m), fabs(map->box.x_max_m - radar->x_m));
    const double y_m =
        fmax(fabs(map->box.y_min_m - radar->y_m), fabs(map->box.y_max_m - radar->y_m));
    return fmin(hypot(x_m, y_m), radar->range_max_m);
}

/* Writes the point in this distance and direction from the radar as a row of the data block. */
static void put_point(const struct map *map, const struct plot_radar *radar, double radius_m,
                      double angle_rad)
{
    fprintf(map->script, "%.9g %.9g\n", (radar->x_m + radius_m * cos(angle_rad)) / map->unit_m,
            (radar->y_m + radius_m * sin(angle_rad)) / map->unit_m);
}

/* Writes an arc about the radar as rows of the data block. */
static void put_arc(const struct map *map, const struct plot_radar *radar, double radius_m,
                    double from_rad, double turn_rad)
{
    for (int i = 0; i <= RING_POINTS; i++) {
        put_point(map, radar, radius_m, from_rad + turn_rad * i / RING_POINTS);
    }
}

/*
 * Labels a ring where it crosses the north axis of the radar inside the map, else the east, south
 * or west axis.
 */
static void label_range_ring(const struct map *map, const struct plot_radar *radar, double radius_m)
{
    static const int east[4] = {0, 1, 0, -1}, north[4] = {1, 0, -1, 0};
    for (int i = 0; i < 4; i++) {
        const double x_m = radar->x_m + radius_m * east[i], y_m = radar->y_m + radius_m * north[i];
        if (is_inside_box(&map->box, x_m, y_m)) {
            fprintf(map->script,
                    "set label '%.9g %s' at %.9g,%.9g left front font ',10' tc rgb '#888888' "
                    "offset 0.2,0.4\n",
                    radius_m / map->unit_m, map->unit_m > 1.0 ? "km" : "m", x_m / map->unit_m,
                    y_m / map->unit_m);
            return;
        }
    }
}

/* Spacing of the radar's range rings in metres, and their number in *count. */
static double ring_spacing_m(const struct map *map, const struct plot_radar *radar, int *count)
{
    const double farthest_m = fmax(farthest_ring_radius_m(map, radar), 1.0);
    const double step_m = map_round_down_to_1_2_5(farthest_m / RINGS);
    *count = (int)floor(farthest_m / step_m + 1e-9);
    return step_m;
}

static void put_range_rings(const struct map *map, const struct plot_radar *radar)
{
    int count;
    const double step_m = ring_spacing_m(map, radar, &count);
    for (int ring = 1; ring <= count; ring++) {
        put_arc(map, radar, ring * step_m, 0.0, 2.0 * M_PI);
        fputc('\n', map->script);
    }
}

static void label_radar_and_rings(const struct map *map, const struct plot_radar *radar,
                                  bool is_ringed)
{
    int count;
    const double step_m = ring_spacing_m(map, radar, &count);
    for (int ring = 1; ring <= count && is_ringed; ring++) {
        label_range_ring(map, radar, ring * step_m);
    }
    fprintf(map->script,
            "set label 'S%" PRId32 "' at %.9g,%.9g point pt 9 ps 1.2 lc rgb '#000000' offset "
            "0.8,-0.6 front\n",
            radar->sensor_id, radar->x_m / map->unit_m, radar->y_m / map->unit_m);
}

static void put_coverage_outline(const struct map *map, const struct plot_radar *radar)
{
    const double turn_rad =
        fmod(radar->sector_to_rad - radar->sector_from_rad + 4.0 * M_PI, 2.0 * M_PI);
    if (isinf(radar->range_max_m)) {
        return;
    }
    if (turn_rad < 1e-6) {
        put_arc(map, radar, radar->range_max_m, 0.0, 2.0 * M_PI);
    } else {
        put_point(map, radar, 0.0, 0.0);
        put_arc(map, radar, radar->range_max_m, radar->sector_from_rad, turn_rad);
        put_point(map, radar, 0.0, 0.0);
    }
    fputc('\n', map->script);
}

void map_write_range_rings(const struct map *map, const struct plot_radar *radars, size_t count)
{
    fprintf(map->script, "$rings << EOD\n");
    for (size_t i = 0; i < count && count <= RADARS_RINGED; i++) {
        put_range_rings(map, &radars[i]);
    }
    fprintf(map->script, "NaN NaN\nEOD\n$coverage << EOD\n");
    for (size_t i = 0; i < count; i++) {
        put_coverage_outline(map, &radars[i]);
    }
    fprintf(map->script, "NaN NaN\nEOD\n");
    for (size_t i = 0; i < count; i++) {
        label_radar_and_rings(map, &radars[i], count <= RADARS_RINGED);
    }
}

void map_draw_range_rings(const struct map *map, const struct plot_radar *radars, size_t count)
{
    bool is_limited = false;
    for (size_t i = 0; i < count; i++) {
        is_limited |= !isinf(radars[i].range_max_m);
    }
    if (count > 0 && count <= RADARS_RINGED) {
        fprintf(map->script, ", \\\n $rings using 1:2 with lines lw 0.6 lc rgb '#c8c8c8' notitle");
    }
    if (is_limited) {
        fprintf(map->script, ", \\\n $coverage using 1:2 with lines lw 1 dt 2 lc rgb '#7090b0' "
                             "title 'coverage'");
    }
}
