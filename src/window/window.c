/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/window.h"

#include <float.h>
#include <string.h>

#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"
#include "sigma_code.h"

float rho_extent_width_m(const struct rho_extent *extent, float side_min_m)
{
    return rho_larger(extent->x_max_m - extent->x_min_m, side_min_m);
}

float rho_extent_height_m(const struct rho_extent *extent, float side_min_m)
{
    return rho_larger(extent->y_max_m - extent->y_min_m, side_min_m);
}

float rho_extent_area_m2(const struct rho_extent *extent, float side_min_m)
{
    return rho_extent_width_m(extent, side_min_m) * rho_extent_height_m(extent, side_min_m);
}

void rho_extent_add(struct rho_extent *extent, float x_m, float y_m)
{
    if (!(extent->x_min_m <= extent->x_max_m)) {
        extent->x_min_m = extent->x_max_m = x_m;
        extent->y_min_m = extent->y_max_m = y_m;
        return;
    }
    extent->x_min_m = rho_smaller(x_m, extent->x_min_m);
    extent->x_max_m = rho_larger(x_m, extent->x_max_m);
    extent->y_min_m = rho_smaller(y_m, extent->y_min_m);
    extent->y_max_m = rho_larger(y_m, extent->y_max_m);
}

/* Mean, spread and extent of the held plots without outliers. */
struct plot_spread {
    /* number of plots; mean of x and y; sum of squares about the mean of x and y */
    float plots, mean_m[2], sum2_m2[2];
    struct rho_extent extent;
};

/* Adds a plot to mean and sum of squares (Welford), unless `before` makes it an outlier. */
static void add_plot(struct plot_spread *spread, const struct plot_spread *before, float x_m,
                     float y_m)
{
    const float place_m[2] = {x_m, y_m};
    const float dx_m = x_m - before->mean_m[0], dy_m = y_m - before->mean_m[1];
    if (before->plots >= OUTLIER_PLOTS &&
        (dx_m * dx_m * before->plots > OUTLIER_SIGMAS2 * before->sum2_m2[0] ||
         dy_m * dy_m * before->plots > OUTLIER_SIGMAS2 * before->sum2_m2[1])) {
        return;
    }
    spread->plots += 1.0f;
    for (int axis = 0; axis < 2; axis++) {
        float off_m = place_m[axis] - spread->mean_m[axis];
        spread->mean_m[axis] += off_m / spread->plots;
        spread->sum2_m2[axis] += off_m * (place_m[axis] - spread->mean_m[axis]);
    }
    rho_extent_add(&spread->extent, x_m, y_m);
}

/* A side moves outwards at once, and inwards slowly. */
static float moved_side_m(float was, float is, int is_wider)
{
    return is_wider ? is : was + EXTENT_DECAY * (is - was);
}

/* Outliers are left out: they would make clutter look thin. */
void rho_window_update_extent(struct rho_window *window)
{
    struct plot_spread spread = {0}, before;
    for (int round = 0; round < OUTLIER_ROUNDS; round++) {
        before = spread;
        spread = (struct plot_spread){.extent = {1.0f, 0.0f, 1.0f, 0.0f}};
        for (unsigned m = 0; m < window->num_scans; m++) {
            const struct rho_window_scan *held = rho_window_scan_at(window, m);
            for (unsigned i = 0; i < held->num_plots; i++) {
                add_plot(&spread, &before, held->plots[i].x_m, held->plots[i].y_m);
            }
        }
    }
    struct rho_extent *was = &window->extent, is = spread.extent;
    if (spread.plots < 1.0f) {
        return;
    }
    if (window->num_scans == 1) {
        *was = is;
    }
    was->x_min_m = moved_side_m(was->x_min_m, is.x_min_m, is.x_min_m < was->x_min_m);
    was->x_max_m = moved_side_m(was->x_max_m, is.x_max_m, is.x_max_m > was->x_max_m);
    was->y_min_m = moved_side_m(was->y_min_m, is.y_min_m, is.y_min_m < was->y_min_m);
    was->y_max_m = moved_side_m(was->y_max_m, is.y_max_m, is.y_max_m > was->y_max_m);
}

#define WINDOW_MAGIC 0x57494e44u /* "WIND" */

/* Lays out nearly square bins over the area, at most BINS_PER_PLOT for each plot expected. */
static void lay_out_bins(struct rho_window_scan *scan, const struct rho_window *window,
                         unsigned num_plots)
{
    float width_m = rho_extent_width_m(&window->extent, rho_larger(window->side_min_m, 1.0f));
    float height_m = rho_extent_height_m(&window->extent, rho_larger(window->side_min_m, 1.0f));
    unsigned limit = BINS_PER_PLOT * num_plots + 1u;
    unsigned bins = limit < RHO_MAX_BINS ? limit : RHO_MAX_BINS;
    unsigned columns = 1;
    /* most columns whose bins are at least as wide as high: columns^2 <= bins * width / height */
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

static uint16_t code_of_clamped_sigma(float sigma)
{
    return code_of_sigma(rho_smaller(rho_larger(sigma, RHO_LIMIT_SIGMA_MIN), RHO_LIMIT_SIGMA_MAX));
}

/*
 * Moves the plots of earlier sectors, with rows of other scans, to the new starts of their bins,
 * the last bin first. Afterwards each bin's start lies behind the plots that were moved there.
 */
static void move_earlier_plots_to_new_bins(struct rho_window_scan *slot)
{
    unsigned end = slot->num_plots;
    while (end > 0) {
        unsigned bin = rho_window_bin_at(slot, slot->plots[end - 1].x_m, slot->plots[end - 1].y_m);
        unsigned first = end - 1;
        while (first > 0 && rho_window_bin_at(slot, slot->plots[first - 1].x_m,
                                              slot->plots[first - 1].y_m) == bin) {
            first--;
        }
        unsigned to = slot->bin_start[bin];
        memmove(&slot->plots[to], &slot->plots[first], (end - first) * sizeof slot->plots[0]);
        memmove(&slot->marks[to], &slot->marks[first], (end - first) * sizeof slot->marks[0]);
        if (RHO_MAX_ECHOES > 0) {
            memmove(&slot->repeats[to], &slot->repeats[first], end - first);
        }
        for (unsigned i = to; i < to + end - first; i++) {
            slot->marks[i] |= RHO_WINDOW_ROW;
        }
        slot->bin_start[bin] = (uint16_t)(to + end - first);
        end = first;
    }
}

/*
 * Copies the plots with fate HELD into the slot, sorted by bin: a stable counting sort without a
 * second array, in which starts advance as bins fill, and are then shifted back.
 */
static void copy_plots_into_bins(struct rho_window *window, struct rho_window_scan *slot,
                                 const struct rho_scan *scan, const struct rho_sensor *sensor,
                                 const uint8_t *fates)
{
    const struct rho_sigma_factors factors = rho_measurement_sigma_factors(sensor);
    const float after_s = rho_seconds_between(slot->time_us, scan->time_us);
    unsigned bins = (unsigned)slot->bins_x * slot->bins_y;
    uint16_t *start = slot->bin_start;
    if (RHO_SECTORS && slot->num_plots > 0) {
        /* starts of the earlier sectors' bins become their counts */
        for (unsigned c = bins; c > 0; c--) {
            start[c] = (uint16_t)(start[c] - start[c - 1]);
        }
    } else {
        memset(start, 0, (bins + 1) * sizeof start[0]);
    }
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        if (fates[i] == RHO_FATE_HELD) {
            start[rho_window_bin_at(slot, scan->plots[i].x_m, scan->plots[i].y_m) + 1]++;
        }
    }
    for (unsigned c = 0; c < bins; c++) {
        start[c + 1] = (uint16_t)(start[c + 1] + start[c]);
    }
    if (RHO_SECTORS) {
        move_earlier_plots_to_new_bins(slot);
    }
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        const struct rho_plot *plot = &scan->plots[i];
        if (fates[i] != RHO_FATE_HELD) {
            continue;
        }
        const unsigned place = start[rho_window_bin_at(slot, plot->x_m, plot->y_m)]++;
        struct rho_window_plot *held = &slot->plots[place];
        *held = (struct rho_window_plot){
            .x_m = plot->x_m,
            .y_m = plot->y_m,
            .offset_s = after_s + (float)plot->offset_us * 1e-6f,
            .sigma_range = code_of_clamped_sigma(factors.range * plot->sigma_range_m),
            .sigma_cross = code_of_clamped_sigma(factors.cross * plot->sigma_cross_m),
        };
        slot->sigma_max_m = rho_larger(slot->sigma_max_m, sigma_of_code(larger_sigma_code(held)));
        if (scan->measures & RHO_MEASURES_Z) {
            held->z_m = plot->z_m;
            held->sigma_up = code_of_sigma(plot->sigma_up_m);
        }
        if (held->sigma_up) {
            /* a steep line of sight turns the upward noise into the horizontal plane */
            slot->sigma_max_m = rho_larger(slot->sigma_max_m, sigma_of_code(held->sigma_up));
        }
        if (scan->measures & RHO_MEASURES_RANGE_RATE) {
            held->range_rate_mps = plot->range_rate_mps;
            held->sigma_range_rate = code_of_sigma(plot->sigma_range_rate_mps);
        }
        slot->marks[place] = (uint16_t)i;
        if (RHO_MAX_ECHOES > 0) {
            slot->repeats[place] = 0;
        }
        slot->is_isotropic = slot->is_isotropic && held->sigma_range == held->sigma_cross;
        slot->offset_max_s = rho_larger(slot->offset_max_s, held->offset_s);
        slot->offset_min_s = rho_smaller(held->offset_s, slot->offset_min_s);
        if (RHO_SECTORS && held->offset_s < window->newest.offset_min_s) {
            window->newest.offset_min_s = held->offset_s;
        }
    }
    memmove(start + 1, start, bins * sizeof start[0]);
    start[0] = 0;
}

int rho_window_continues_newest(const struct rho_window *window, const struct rho_scan *scan,
                                const struct rho_sensor *sensor)
{
    if (!RHO_SECTORS || window->magic != WINDOW_MAGIC || window->num_scans == 0) {
        return 0;
    }
    const struct rho_window_scan *held =
        &window->ring[(window->first + window->num_scans - 1u) % window->scans_max];
    const struct rho_sensor *was = &held->sensor;
    /* a sensor in another place or with another range-rate span, or described for one of both */
    const int is_changed =
        !sensor ? was->pd > 0.0f
                : !(was->pd > 0.0f) ||
                      !rho_is_equal(was->range_rate_span_mps, sensor->range_rate_span_mps) ||
                      !rho_is_equal(was->x_m, sensor->x_m) ||
                      !rho_is_equal(was->y_m, sensor->y_m) || !rho_is_equal(was->z_m, sensor->z_m);
    return held->sensor.sensor_id == scan->sensor_id && !is_changed &&
           window->newest.time_us <= scan->time_us &&
           scan->time_us - held->time_us <= RHO_LIMIT_OFFSET_US &&
           rho_angle_continued_ends(held->sector_from_rad, held->sector_to_rad,
                                    scan->sector_from_rad, scan->sector_to_rad,
                                    SECTOR_GAP_RAD) != 0;
}

enum rho_status rho_window_init(struct rho_window *window, size_t size, unsigned scans_max,
                                const struct rho_extent *area)
{
    if (!window) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *window) {
        return RHO_ERROR_SIZE;
    }
    if (scans_max < 1 || scans_max > RHO_MAX_SCANS ||
        (area && (!rho_is_coordinate(area->x_min_m) || !rho_is_coordinate(area->x_max_m) ||
                  !rho_is_coordinate(area->y_min_m) || !rho_is_coordinate(area->y_max_m) ||
                  !(area->x_min_m < area->x_max_m) || !(area->y_min_m < area->y_max_m)))) {
        return RHO_ERROR_CONFIG;
    }
    memset(window, 0, sizeof *window);
    window->magic = WINDOW_MAGIC;
    window->scans_max = (uint16_t)scans_max;
    window->area_is_fixed = area ? 1 : 0;
    window->extent = area ? *area : (struct rho_extent){1.0f, 0.0f, 1.0f, 0.0f};
    return RHO_OK;
}

int rho_window_accepts(const struct rho_window *window, int64_t time_us)
{
    return window->magic == WINDOW_MAGIC &&
           (window->num_scans == 0 || window->newest.time_us <= time_us);
}

enum rho_status rho_window_check_push(const struct rho_window *window, const struct rho_scan *scan,
                                      const uint8_t *fates, const uint32_t *left_unused)
{
    if (!window || !scan || !left_unused || (scan->num_plots && (!scan->plots || !fates))) {
        return RHO_ERROR_NULL;
    }
    if (RHO_SECTORS && !rho_angle_is_valid_sector(scan->sector_from_rad, scan->sector_to_rad)) {
        return RHO_ERROR_VALUE;
    }
    return rho_window_accepts(window, scan->time_us) ? RHO_OK : RHO_ERROR_STATE;
}

/*
 * Number of plots that a scan will hold when its revolution is complete. For a sector: as many as
 * the revolution before, or RHO_MAX_PLOTS where the window has none; at least `held`.
 */
static unsigned expected_plots(struct rho_window *window, const struct rho_scan *scan,
                               unsigned held)
{
    const float width_rad = rho_angle_sector_width(scan->sector_from_rad, scan->sector_to_rad);
    if (!RHO_SECTORS || !(RHO_TWO_PI / width_rad > 1.0f)) {
        return held;
    }
    if (window->num_scans < 2) {
        return RHO_MAX_PLOTS;
    }
    const unsigned before = rho_window_scan_at(window, window->num_scans - 2u)->num_plots;
    return held > before ? held : before;
}

enum rho_status rho_window_push(struct rho_window *window, const struct rho_scan *scan,
                                const struct rho_sensor *sensor, uint8_t *fates,
                                uint32_t *left_unused)
{
    enum rho_status status = rho_window_check_push(window, scan, fates, left_unused);
    if (status != RHO_OK) {
        return status;
    }
    window->is_continued = rho_window_continues_newest(window, scan, sensor) != 0;
    window->is_remeasured = 0;
    if (!window->is_continued) {
        if (window->num_scans == window->scans_max) {
            *left_unused = rho_count(*left_unused, window->ring[window->first].num_unused);
            window->first =
                (uint16_t)(window->first + 1u < window->scans_max ? window->first + 1u : 0u);
            window->num_scans--;
        }
        window->num_scans++;
    }
    struct rho_window_scan *slot = rho_window_scan_at(window, window->num_scans - 1u);
    if (!window->is_continued) {
        slot->time_us = scan->time_us;
        slot->measures = scan->measures;
        slot->sector_from_rad = scan->sector_from_rad;
        slot->sector_to_rad = scan->sector_to_rad;
        slot->sensor = sensor ? *sensor : (struct rho_sensor){.sensor_id = scan->sensor_id};
        /* the held plots' sigmas include these factors */
        slot->sensor.sigma_range_percent = slot->sensor.sigma_cross_percent = 0;
        slot->num_plots = slot->num_unused = 0;
        slot->sigma_max_m = slot->offset_min_s = slot->offset_max_s = 0.0f;
        slot->is_isotropic = 1;
    }
    /* the first scan's plots give the extent, as bins are needed before the area is known */
    const int has_extent =
        window->area_is_fixed || window->extent.x_min_m <= window->extent.x_max_m;
    unsigned held = slot->num_plots;
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        if (fates[i] != RHO_FATE_HELD) {
            continue;
        }
        if (held == RHO_MAX_PLOTS || i >= RHO_WINDOW_ROW) {
            fates[i] = RHO_FATE_NO_ROOM;
            continue;
        }
        held++;
        if (!has_extent) {
            rho_extent_add(&window->extent, scan->plots[i].x_m, scan->plots[i].y_m);
        }
    }
    if (slot->num_plots == 0) {
        lay_out_bins(slot, window, expected_plots(window, scan, held));
    }
    if (RHO_SECTORS && window->is_continued) {
        /* the revolution measures what all its sectors with plots measure */
        const uint32_t measured = slot->measures;
        if (held > slot->num_plots || slot->num_plots == 0) {
            slot->measures = scan->measures & (slot->num_plots == 0 ? ~0u : measured);
        }
        window->is_remeasured = slot->measures != measured;
        const unsigned ends =
            rho_angle_continued_ends(slot->sector_from_rad, slot->sector_to_rad,
                                     scan->sector_from_rad, scan->sector_to_rad, SECTOR_GAP_RAD);
        if (ends & RHO_ANGLE_CONTINUES_RIGHT) {
            slot->sector_from_rad = scan->sector_from_rad;
        } else {
            slot->sector_to_rad = scan->sector_to_rad;
        }
        if (ends == (RHO_ANGLE_CONTINUES_LEFT | RHO_ANGLE_CONTINUES_RIGHT)) {
            slot->sector_from_rad = slot->sector_to_rad = 0.0f; /* the revolution is complete */
        }
        slot->sensor.pd = sensor ? sensor->pd : 0.0f;
    }
    window->newest = (struct rho_window_sector){.time_us = scan->time_us, .offset_min_s = FLT_MAX};
    copy_plots_into_bins(window, slot, scan, sensor, fates);
    slot->num_unused = (uint16_t)(slot->num_unused + held - slot->num_plots);
    slot->num_plots = (uint16_t)held;
    if (!window->is_continued && !window->area_is_fixed) {
        rho_window_update_extent(window);
    }
    return RHO_OK;
}

/* True where the bins' starts ascend and plots lie in their bins, as pushes move plots by bins. */
static int has_sound_bins(const struct rho_window_scan *scan)
{
    const unsigned num_bins = (unsigned)scan->bins_x * scan->bins_y;
    if (num_bins < 1 || num_bins > RHO_MAX_BINS || scan->bin_start[0] != 0 ||
        scan->bin_start[num_bins] != scan->num_plots) {
        return 0;
    }
    for (unsigned bin = 0; bin < num_bins; bin++) {
        if (scan->bin_start[bin] > scan->bin_start[bin + 1] ||
            scan->bin_start[bin + 1] > scan->num_plots) {
            return 0;
        }
        for (unsigned i = scan->bin_start[bin]; i < scan->bin_start[bin + 1]; i++) {
            const struct rho_window_plot *plot = &scan->plots[i];
            if (rho_window_bin_at(scan, plot->x_m, plot->y_m) != bin) {
                return 0;
            }
        }
    }
    return 1;
}

static int is_sound_scan(const struct rho_window_scan *scan)
{
    if (!rho_is_stored_time(scan->time_us) ||
        !rho_angle_is_valid_sector(scan->sector_from_rad, scan->sector_to_rad) ||
        !rho_measurement_is_valid_site(&scan->sensor) ||
        !rho_is_within(scan->sensor.pd, 0.0f, 1.0f) || scan->num_plots > RHO_MAX_PLOTS ||
        scan->num_unused > scan->num_plots || !rho_are_finite(&scan->bin_x0_m, 1) ||
        !rho_are_finite(&scan->bin_y0_m, 1) || !rho_is_within(scan->bins_per_m_x, 0.0f, 1e6f) ||
        !rho_is_within(scan->bins_per_m_y, 0.0f, 1e6f) ||
        !rho_is_within(scan->sigma_max_m, 0.0f, 1e7f) || !rho_are_finite(&scan->offset_min_s, 1) ||
        !rho_are_finite(&scan->offset_max_s, 1)) {
        return 0;
    }
    for (unsigned i = 0; i < scan->num_plots; i++) {
        const struct rho_window_plot *plot = &scan->plots[i];
        if (!rho_is_coordinate(plot->x_m) || !rho_is_coordinate(plot->y_m) ||
            !rho_is_coordinate(plot->z_m) ||
            !rho_is_within(plot->offset_s, -2e-6f * RHO_LIMIT_OFFSET_US,
                           2e-6f * RHO_LIMIT_OFFSET_US) ||
            !rho_are_finite(&plot->range_rate_mps, 1)) {
            return 0;
        }
    }
    return has_sound_bins(scan);
}

int rho_window_is_sound(const struct rho_window *window)
{
    int64_t before_us = INT64_MIN;
    if (window->scans_max < 1 || window->scans_max > RHO_MAX_SCANS ||
        window->num_scans > window->scans_max || window->first >= window->scans_max ||
        !rho_is_within(window->side_min_m, 0.0f, 1e30f) ||
        !rho_is_coordinate(window->extent.x_min_m) || !rho_is_coordinate(window->extent.x_max_m) ||
        !rho_is_coordinate(window->extent.y_min_m) || !rho_is_coordinate(window->extent.y_max_m)) {
        return 0;
    }
    for (unsigned m = 0; m < window->num_scans; m++) {
        const struct rho_window_scan *scan = &window->ring[(window->first + m) % window->scans_max];
        if (scan->time_us < before_us || !is_sound_scan(scan)) {
            return 0;
        }
        before_us = scan->time_us;
    }
    if (window->num_scans > 0) {
        /* the record of the newest sector, or whole scan, must fit to the newest held scan */
        const struct rho_window_sector *newest = &window->newest;
        if (!rho_is_stored_time(newest->time_us) || newest->time_us < before_us ||
            newest->time_us - before_us > RHO_LIMIT_OFFSET_US ||
            !rho_are_finite(&newest->offset_min_s, 1)) {
            return 0;
        }
    }
    return rho_window_accepts(window, INT64_MAX);
}
