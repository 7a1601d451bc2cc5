/* SPDX-License-Identifier: MIT */
#include "rhotrack/window.h"

#include <string.h>

#include "rhotrack/measurement.h"
#include "window_sigma.h"

#define WINDOW_MAGIC 0x57494e44u /* "WIND" */

#define ROW_MAX RHO_WINDOW_ROW

/* Where the area is not given: plots farther out than so many standard deviations are left out, in so many rounds, once
 * there are a dozen; and what it was before gives way to what it is now by this share a scan. */
#define OUTLIER_SIGMAS2 9.0f
#define OUTLIER_ROUNDS 3
#define OUTLIER_PLOTS 12.0f
#define EXTENT_DECAY 0.02f

/* Bins a plot that are worth their memory traffic when a scan has few plots. */
#define BINS_PER_PLOT 8u

/* ---- extents ---------------------------------------------------------------------------------- */

static float at_least(float v, float limit)
{
    return v > limit ? v : limit;
}

float rho_extent_width_m(const struct rho_extent *extent, float side_min_m)
{
    return at_least(extent->x_max_m - extent->x_min_m, side_min_m);
}

float rho_extent_height_m(const struct rho_extent *extent, float side_min_m)
{
    return at_least(extent->y_max_m - extent->y_min_m, side_min_m);
}

float rho_extent_area_m2(const struct rho_extent *extent, float side_min_m)
{
    return at_least(rho_extent_width_m(extent, side_min_m), 0.0f) *
           at_least(rho_extent_height_m(extent, side_min_m), 0.0f);
}

void rho_extent_add(struct rho_extent *extent, float x_m, float y_m)
{
    if (!(extent->x_min_m <= extent->x_max_m)) {
        extent->x_min_m = extent->x_max_m = x_m;
        extent->y_min_m = extent->y_max_m = y_m;
        return;
    }
    extent->x_min_m = x_m < extent->x_min_m ? x_m : extent->x_min_m;
    extent->x_max_m = x_m > extent->x_max_m ? x_m : extent->x_max_m;
    extent->y_min_m = y_m < extent->y_min_m ? y_m : extent->y_min_m;
    extent->y_max_m = y_m > extent->y_max_m ? y_m : extent->y_max_m;
}

static int is_usable_area(const struct rho_extent *area)
{
    return rho_is_coordinate(area->x_min_m) && rho_is_coordinate(area->x_max_m) &&
           rho_is_coordinate(area->y_min_m) && rho_is_coordinate(area->y_max_m) &&
           area->x_min_m < area->x_max_m && area->y_min_m < area->y_max_m;
}

/* ---- bins ------------------------------------------------------------------------------------- */

/* Cell of a coordinate among n, its border cells outside; NaN counts as the first. */
static int cell_of(float v_m, float origin_m, float cells_per_m, int n)
{
    float cell = (v_m - origin_m) * cells_per_m;
    if (!(cell > 0.0f)) {
        return 0;
    }
    return cell < (float)n ? (int)cell : n - 1;
}

static unsigned bin_of(const struct rho_window_scan *scan, float x_m, float y_m)
{
    int column = cell_of(x_m, scan->bin_x0_m, scan->bins_per_m_x, scan->bins_x);
    int row = cell_of(y_m, scan->bin_y0_m, scan->bins_per_m_y, scan->bins_y);
    return (unsigned)(row * scan->bins_x + column);
}

struct rho_window_bins rho_window_bins_under(const struct rho_window_scan *scan, float x0_m,
                                             float x1_m, float y0_m, float y1_m)
{
    struct rho_window_bins bins = {
        .column_first = cell_of(x0_m, scan->bin_x0_m, scan->bins_per_m_x, scan->bins_x),
        .column_last = cell_of(x1_m, scan->bin_x0_m, scan->bins_per_m_x, scan->bins_x),
        .row_first = cell_of(y0_m, scan->bin_y0_m, scan->bins_per_m_y, scan->bins_y),
        .row_last = cell_of(y1_m, scan->bin_y0_m, scan->bins_per_m_y, scan->bins_y),
    };
    return bins;
}

/* Nearly square bins over the area, as many as the plots are worth. */
static void lay_bins(struct rho_window_scan *scan, const struct rho_window *window,
                     unsigned num_plots)
{
    float width_m = rho_extent_width_m(&window->extent, at_least(window->side_min_m, 1.0f));
    float height_m = rho_extent_height_m(&window->extent, at_least(window->side_min_m, 1.0f));
    unsigned limit = BINS_PER_PLOT * num_plots + 1u;
    unsigned bins = limit < RHO_MAX_BINS ? limit : RHO_MAX_BINS;
    unsigned columns = 1;
    /* the most columns whose bins are not narrower than high: columns^2 <= bins * width / height */
    while (columns < bins &&
           (float)((columns + 1) * (columns + 1)) * height_m <= (float)bins * width_m) {
        columns++;
    }
    scan->bins_x = (uint16_t)columns;
    scan->bins_y = (uint16_t)(bins / columns);
    scan->bin_x0_m = window->extent.x_min_m;
    scan->bin_y0_m = window->extent.y_min_m;
    scan->bins_per_m_x = (float)scan->bins_x / width_m;
    scan->bins_per_m_y = (float)scan->bins_y / height_m;
}

/* ---- taking a scan in ------------------------------------------------------------------------- */

static float seconds(int32_t offset_us)
{
    return (float)offset_us * 1e-6f;
}

/* Decides who fits. */
static unsigned admit(const struct rho_scan *scan, uint8_t *fates)
{
    unsigned held = 0;
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        if (fates[i] != RHO_FATE_HELD) {
            continue;
        }
        if (held == RHO_MAX_PLOTS || i > ROW_MAX) {
            fates[i] = RHO_FATE_NO_ROOM;
            continue;
        }
        held++;
    }
    return held;
}

/* The first scan has bins before the area is known. */
static void guess_extent(struct rho_window *window, const struct rho_scan *scan,
                         const uint8_t *fates)
{
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        if (fates[i] == RHO_FATE_HELD) {
            rho_extent_add(&window->extent, scan->plots[i].x_m, scan->plots[i].y_m);
        }
    }
}

/* ---- the area that the plots show ------------------------------------------------------------- */

/* Plots within some standard deviations of a mean, one axis after the other. */
struct crowd {
    float plots, mean_m[2], sum2_m2[2]; /* of the last round: the others are outliers */
    struct rho_extent extent;
};

static int is_far(const struct crowd *crowd, float x_m, float y_m)
{
    float dx_m = x_m - crowd->mean_m[0], dy_m = y_m - crowd->mean_m[1];
    return crowd->plots >= OUTLIER_PLOTS &&
           (dx_m * dx_m * crowd->plots > OUTLIER_SIGMAS2 * crowd->sum2_m2[0] ||
            dy_m * dy_m * crowd->plots > OUTLIER_SIGMAS2 * crowd->sum2_m2[1]);
}

/* Welford's running mean and sum of squares. */
static void join(struct crowd *crowd, const struct crowd *before, float x_m, float y_m)
{
    const float place_m[2] = {x_m, y_m};
    if (is_far(before, x_m, y_m)) {
        return;
    }
    crowd->plots += 1.0f;
    for (int axis = 0; axis < 2; axis++) {
        float off_m = place_m[axis] - crowd->mean_m[axis];
        crowd->mean_m[axis] += off_m / crowd->plots;
        crowd->sum2_m2[axis] += off_m * (place_m[axis] - crowd->mean_m[axis]);
    }
    rho_extent_add(&crowd->extent, x_m, y_m);
}

static void join_all(struct crowd *crowd, const struct crowd *before, struct rho_window *window)
{
    *crowd = (struct crowd){.extent = {1.0f, 0.0f, 1.0f, 0.0f}};
    for (unsigned m = 0; m < window->num_scans; m++) {
        const struct rho_window_scan *held = rho_window_scan_at(window, m);
        for (unsigned i = 0; i < held->num_plots; i++) {
            join(crowd, before, held->plots[i].x_m, held->plots[i].y_m);
        }
    }
}

static float decayed(float was, float is, int is_wider)
{
    return is_wider ? is : was + EXTENT_DECAY * (is - was);
}

/* Outliers would make clutter look thin everywhere. */
static void follow_extent(struct rho_window *window)
{
    struct crowd crowd = {0}, before;
    for (int round = 0; round < OUTLIER_ROUNDS; round++) {
        before = crowd;
        join_all(&crowd, &before, window);
    }
    struct rho_extent *was = &window->extent, is = crowd.extent;
    if (crowd.plots < 1.0f) {
        return;
    }
    if (window->num_scans == 1) {
        *was = is;
    }
    was->x_min_m = decayed(was->x_min_m, is.x_min_m, is.x_min_m < was->x_min_m);
    was->x_max_m = decayed(was->x_max_m, is.x_max_m, is.x_max_m > was->x_max_m);
    was->y_min_m = decayed(was->y_min_m, is.y_min_m, is.y_min_m < was->y_min_m);
    was->y_max_m = decayed(was->y_max_m, is.y_max_m, is.y_max_m > was->y_max_m);
}

static struct rho_window_plot window_plot(const struct rho_scan *scan, uint32_t row)
{
    const struct rho_plot *plot = &scan->plots[row];
    struct rho_window_plot held = {
        .x_m = plot->x_m,
        .y_m = plot->y_m,
        .offset_s = seconds(plot->offset_us),
        .sigma_range = sigma_code(plot->sigma_range_m),
        .sigma_cross = sigma_code(plot->sigma_cross_m),
    };
    if (scan->measures & RHO_MEASURES_Z) {
        held.z_m = plot->z_m;
        held.sigma_up = sigma_code(plot->sigma_up_m);
    }
    if (scan->measures & RHO_MEASURES_RANGE_RATE) {
        held.range_rate_mps = plot->range_rate_mps;
        held.sigma_range_rate = sigma_code(plot->sigma_range_rate_mps);
    }
    return held;
}

static void widen_ranges(struct rho_window_scan *slot, const struct rho_window_plot *plot)
{
    slot->sigma_max_m = at_least(slot->sigma_max_m, sigma_of(larger_sigma(plot)));
    if (plot->sigma_up) {
        /* a high line of sight brings it down into the plane */
        slot->sigma_max_m = at_least(slot->sigma_max_m, sigma_of(plot->sigma_up));
    }
    slot->is_isotropic = slot->is_isotropic && plot->sigma_range == plot->sigma_cross;
    slot->offset_max_s = at_least(slot->offset_max_s, plot->offset_s);
    slot->offset_min_s = plot->offset_s < slot->offset_min_s ? plot->offset_s : slot->offset_min_s;
}

/* Counting sort by bin, stable, without a second array: starts move up as bins fill, and are then shifted back. */
static void sort_into_bins(struct rho_window_scan *slot, const struct rho_scan *scan,
                           const uint8_t *fates)
{
    unsigned bins = (unsigned)slot->bins_x * slot->bins_y;
    uint16_t *start = slot->bin_start;
    memset(start, 0, (bins + 1) * sizeof start[0]);
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        if (fates[i] == RHO_FATE_HELD) {
            start[bin_of(slot, scan->plots[i].x_m, scan->plots[i].y_m) + 1]++;
        }
    }
    for (unsigned c = 0; c < bins; c++) {
        start[c + 1] = (uint16_t)(start[c + 1] + start[c]);
    }
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        if (fates[i] == RHO_FATE_HELD) {
            struct rho_window_plot plot = window_plot(scan, i);
            unsigned place = start[bin_of(slot, plot.x_m, plot.y_m)]++;
            slot->plots[place] = plot;
            slot->marks[place] = (uint16_t)i;
            widen_ranges(slot, &plot);
        }
    }
    memmove(start + 1, start, bins * sizeof start[0]);
    start[0] = 0;
}

static struct rho_window_scan *next_slot(struct rho_window *window, uint32_t *left_unused)
{
    if (window->num_scans == window->scans_max) {
        *left_unused = rho_count(*left_unused, window->ring[window->first].num_unused);
        window->first = (uint16_t)((window->first + 1u) % window->scans_max);
        window->num_scans--;
    }
    window->num_scans++;
    return rho_window_scan_at(window, window->num_scans - 1u);
}

/* ---- public ----------------------------------------------------------------------------------- */

enum rho_status rho_window_init(struct rho_window *window, size_t size, unsigned scans_max,
                                const struct rho_extent *area, float side_min_m)
{
    if (!window) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *window) {
        return RHO_ERROR_SIZE;
    }
    if (scans_max < 1 || scans_max > RHO_MAX_SCANS || (area && !is_usable_area(area)) ||
        !rho_is_within(side_min_m, 0.0f, 2.0f * RHO_LIMIT_POSITION_M)) {
        return RHO_ERROR_CONFIG;
    }
    memset(window, 0, sizeof *window);
    window->magic = WINDOW_MAGIC;
    window->scans_max = (uint16_t)scans_max;
    window->area_is_fixed = area ? 1 : 0;
    window->side_min_m = side_min_m;
    window->extent = area ? *area : (struct rho_extent){1.0f, 0.0f, 1.0f, 0.0f};
    return RHO_OK;
}

int rho_window_accepts(const struct rho_window *window, int64_t time_us)
{
    if (window->magic != WINDOW_MAGIC) {
        return 0;
    }
    unsigned newest =
        ((unsigned)window->first + window->num_scans + window->scans_max - 1u) % window->scans_max;
    return window->num_scans == 0 || window->ring[newest].time_us <= time_us;
}

enum rho_status rho_window_check_push(const struct rho_window *window, const struct rho_scan *scan,
                                      const uint8_t *fates, const uint32_t *left_unused)
{
    if (!window || !scan || !left_unused || (scan->num_plots && (!scan->plots || !fates))) {
        return RHO_ERROR_NULL;
    }
    return rho_window_accepts(window, scan->time_us) ? RHO_OK : RHO_ERROR_STATE;
}

enum rho_status rho_window_push(struct rho_window *window, const struct rho_scan *scan,
                                const struct rho_sensor *sensor, uint8_t *fates,
                                uint32_t *left_unused)
{
    enum rho_status status = rho_window_check_push(window, scan, fates, left_unused);
    if (status != RHO_OK) {
        return status;
    }
    struct rho_window_scan *slot = next_slot(window, left_unused);
    unsigned held = admit(scan, fates);
    slot->time_us = scan->time_us;
    slot->measures = scan->measures;
    slot->sector_from_rad = scan->sector_from_rad;
    slot->sector_to_rad = scan->sector_to_rad;
    slot->sensor = sensor ? *sensor : (struct rho_sensor){.sensor_id = scan->sensor_id};
    slot->sensor.pd = sensor ? sensor->pd : 0.0f;
    slot->num_plots = slot->num_unused = (uint16_t)held;
    slot->sigma_max_m = slot->offset_min_s = slot->offset_max_s = 0.0f;
    slot->is_isotropic = 1;
    if (!window->area_is_fixed && !(window->extent.x_min_m <= window->extent.x_max_m)) {
        guess_extent(window, scan, fates);
    }
    lay_bins(slot, window, held);
    sort_into_bins(slot, scan, fates);
    if (!window->area_is_fixed) {
        follow_extent(window);
    }
    return RHO_OK;
}

struct rho_window_scan *rho_window_scan_at(struct rho_window *window, unsigned m)
{
    return &window->ring[(window->first + m) % window->scans_max];
}
