/* SPDX-License-Identifier: MIT */
#include "rhotrack/window.h"

#include <string.h>

#include "rhotrack/measurement.h"

#define WINDOW_MAGIC 0x57494e44u /* "WIND" */

#define ROW_MAX RHO_WINDOW_ROW

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
    return rho_is_within(area->x_min_m, -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M) &&
           rho_is_within(area->x_max_m, -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M) &&
           rho_is_within(area->y_min_m, -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M) &&
           rho_is_within(area->y_max_m, -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M) &&
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

/* Decides who fits, and grows the area over those. */
static unsigned admit(struct rho_window *window, const struct rho_scan *scan, uint8_t *fates)
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
        if (!window->area_is_fixed) {
            rho_extent_add(&window->extent, scan->plots[i].x_m, scan->plots[i].y_m);
        }
    }
    return held;
}

/* Exponent of the least code, 2^-10, as a float32 has it. */
#define SIGMA_EXPONENT (117u << 23)
#define SIGMA_SHIFT 12

static uint16_t sigma_code(float sigma)
{
    uint32_t bits;
    memcpy(&bits, &sigma, sizeof bits);
    return (uint16_t)((bits + (1u << (SIGMA_SHIFT - 1)) - SIGMA_EXPONENT) >> SIGMA_SHIFT);
}

float rho_window_sigma(uint16_t code)
{
    uint32_t bits = ((uint32_t)code << SIGMA_SHIFT) + SIGMA_EXPONENT;
    float sigma;
    memcpy(&sigma, &bits, sizeof sigma);
    return sigma;
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

static uint16_t larger_sigma(const struct rho_window_plot *plot)
{
    return plot->sigma_range > plot->sigma_cross ? plot->sigma_range : plot->sigma_cross;
}

float rho_window_sigma_m(const struct rho_window_plot *plot)
{
    return rho_window_sigma(larger_sigma(plot));
}

static void widen_ranges(struct rho_window_scan *slot, const struct rho_window_plot *plot)
{
    slot->sigma_max_m = at_least(slot->sigma_max_m, rho_window_sigma_m(plot));
    if (plot->sigma_up) {
        /* a high line of sight brings it down into the plane */
        slot->sigma_max_m = at_least(slot->sigma_max_m, rho_window_sigma(plot->sigma_up));
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

enum rho_status rho_window_push(struct rho_window *window, const struct rho_scan *scan,
                                const struct rho_sensor *sensor, uint8_t *fates,
                                uint32_t *left_unused)
{
    if (!window || !scan || !left_unused || (scan->num_plots && (!scan->plots || !fates))) {
        return RHO_ERROR_NULL;
    }
    if (!rho_window_accepts(window, scan->time_us)) {
        return RHO_ERROR_STATE;
    }
    struct rho_window_scan *slot = next_slot(window, left_unused);
    unsigned held = admit(window, scan, fates);
    slot->time_us = scan->time_us;
    slot->measures = scan->measures;
    slot->sector_from_rad = scan->sector_from_rad;
    slot->sector_to_rad = scan->sector_to_rad;
    slot->sensor = sensor ? *sensor : (struct rho_sensor){.sensor_id = scan->sensor_id};
    slot->sensor.pd = sensor ? sensor->pd : 0.0f;
    slot->num_plots = slot->num_unused = (uint16_t)held;
    slot->sigma_max_m = slot->offset_min_s = slot->offset_max_s = 0.0f;
    slot->is_isotropic = 1;
    lay_bins(slot, window, held);
    sort_into_bins(slot, scan, fates);
    return RHO_OK;
}

struct rho_window_scan *rho_window_scan_at(struct rho_window *window, unsigned m)
{
    return &window->ring[(window->first + m) % window->scans_max];
}

/* The best plot so far: distance2 / variance is compared by cross-multiplication. */
struct nearest {
    int index;
    float distance2_m2;
    float variance_m2;
};

static void compare_plots(struct nearest *best, const struct rho_window_scan *scan, unsigned from,
                          unsigned to, const struct rho_window_query *query)
{
    for (unsigned i = from; i < to; i++) {
        const struct rho_window_plot *plot = &scan->plots[i];
        float dx_m = plot->x_m - query->x_m - query->vx_mps * plot->offset_s;
        float dy_m = plot->y_m - query->y_m - query->vy_mps * plot->offset_s;
        float distance2_m2 = dx_m * dx_m + dy_m * dy_m;
        float sigma_m = rho_window_sigma_m(plot);
        float variance_m2 = query->variance_m2 + query->sigma_factor * sigma_m * sigma_m;
        if (distance2_m2 * best->variance_m2 < best->distance2_m2 * variance_m2 &&
            !(scan->marks[i] & query->skip_flags)) {
            best->index = (int)i;
            best->distance2_m2 = distance2_m2;
            best->variance_m2 = variance_m2;
        }
    }
}

/* How far the plots' own times can move the place along one axis, forth or back. */
static float shift_min(const struct rho_window_scan *scan, float v_mps)
{
    return v_mps * (v_mps > 0.0f ? scan->offset_min_s : scan->offset_max_s);
}

static float shift_max(const struct rho_window_scan *scan, float v_mps)
{
    return v_mps * (v_mps > 0.0f ? scan->offset_max_s : scan->offset_min_s);
}

static struct rho_window_bins bins_around(const struct rho_window_scan *scan, float x_m, float y_m,
                                          float vx_mps, float vy_mps, float reach_m)
{
    return rho_window_bins_under(
        scan, x_m - reach_m + shift_min(scan, vx_mps), x_m + reach_m + shift_max(scan, vx_mps),
        y_m - reach_m + shift_min(scan, vy_mps), y_m + reach_m + shift_max(scan, vy_mps));
}

int rho_window_nearest(const struct rho_window_scan *scan, const struct rho_window_query *query,
                       struct rho_window_work *work)
{
    struct rho_window_bins bins =
        bins_around(scan, query->x_m, query->y_m, query->vx_mps, query->vy_mps, query->reach_m);
    /* a plot exactly on the gate counts as outside */
    struct nearest best = {.index = -1, .distance2_m2 = query->gate_chi2, .variance_m2 = 1.0f};
    unsigned compared = 0;
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned from = start[bins.column_first], to = start[bins.column_last + 1];
        compare_plots(&best, scan, from, to, query);
        compared += to - from;
    }
    work->lookups = rho_count(work->lookups, 1);
    work->distances = rho_count(work->distances, compared);
    return best.index;
}

/* ---- plots with their own covariance ---------------------------------------------------------- */

#define RANGE_LEAST_M2 1.0f /* nearer to the sensor there is no line of sight */

const struct rho_sensor *rho_window_sensor(const struct rho_window_scan *scan)
{
    return scan->sensor.pd > 0.0f ? &scan->sensor : 0;
}

struct rho_plot rho_window_plot_of(const struct rho_window_scan *scan, unsigned index)
{
    const struct rho_window_plot *held = &scan->plots[index];
    struct rho_plot plot = {
        .offset_us = (int32_t)(held->offset_s * 1e6f + (held->offset_s < 0.0f ? -0.5f : 0.5f)),
        .x_m = held->x_m,
        .y_m = held->y_m,
        .z_m = held->z_m,
        .range_rate_mps = held->range_rate_mps,
        .sigma_range_m = rho_window_sigma(held->sigma_range),
        .sigma_cross_m = rho_window_sigma(held->sigma_cross),
        .sigma_up_m = rho_window_sigma(held->sigma_up),
        .sigma_range_rate_mps = rho_window_sigma(held->sigma_range_rate),
    };
    return plot;
}

static float squared_sigma(uint16_t code)
{
    float sigma = rho_window_sigma(code);
    return sigma * sigma;
}

struct rho_window_noise rho_window_noise(const struct rho_window_scan *scan,
                                         const struct rho_window_plot *plot)
{
    float dx_m = plot->x_m - scan->sensor.x_m, dy_m = plot->y_m - scan->sensor.y_m;
    float ground2_m2 = dx_m * dx_m + dy_m * dy_m;
    float along_m2 = squared_sigma(plot->sigma_range), cross_m2 = squared_sigma(plot->sigma_cross);
    struct rho_window_noise noise = {.zz_m2 = squared_sigma(plot->sigma_up)};
    if (!(ground2_m2 >= RANGE_LEAST_M2)) {
        noise.xx_m2 = noise.yy_m2 = at_least(along_m2, cross_m2);
        return noise;
    }
    if (scan->measures & RHO_MEASURES_Z) {
        float dz_m = plot->z_m - scan->sensor.z_m;
        float rise = dz_m * dz_m / (ground2_m2 + dz_m * dz_m); /* sin^2 of the elevation */
        float up_m2 = noise.zz_m2;
        noise.zz_m2 = up_m2 + rise * (along_m2 - up_m2);
        along_m2 += rise * (up_m2 - along_m2);
    }
    float excess = (along_m2 - cross_m2) / ground2_m2;
    noise.xx_m2 = cross_m2 + excess * dx_m * dx_m;
    noise.xy_m2 = excess * dx_m * dy_m;
    noise.yy_m2 = cross_m2 + excess * dy_m * dy_m;
    return noise;
}

float rho_window_range_rate_distance2(const struct rho_window_scan *scan,
                                      const struct rho_window_plot *plot,
                                      const struct rho_window_place *place)
{
    int use_z = place->has_z && (scan->measures & RHO_MEASURES_Z);
    const float state[6] = {plot->x_m,     plot->y_m,     plot->z_m,
                            place->vx_mps, place->vy_mps, place->vz_mps};
    const struct rho_window_noise *noise = &place->velocity_noise;
    float row[6], rate_mps;
    if (!rho_measurement_range_rate(state, &scan->sensor, use_z, row, &rate_mps)) {
        return 0.0f;
    }
    const float *turn = row, *u = row + 3; /* by the position, by the velocity */
    float error_mps = plot->range_rate_mps - rate_mps;
    float turned2 = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    float variance = place->factor * (squared_sigma(plot->sigma_range_rate) +
                                      turned2 * squared_sigma(larger_sigma(plot))) +
                     noise->xx_m2 * u[0] * u[0] + 2.0f * noise->xy_m2 * u[0] * u[1] +
                     noise->yy_m2 * u[1] * u[1] + noise->zz_m2 * u[2] * u[2];
    return error_mps * error_mps / variance;
}

/* Squared distance of a plot from the place, all dimensions; `limit` or more as soon as it is known to be. */
static float distance2_to(const struct rho_window_scan *scan, const struct rho_window_plot *plot,
                          const struct rho_window_place *place, float limit)
{
    float dx_m = plot->x_m - place->x_m - place->vx_mps * plot->offset_s;
    float dy_m = plot->y_m - place->y_m - place->vy_mps * plot->offset_s;
    if (dx_m * dx_m + dy_m * dy_m > place->reach_m * place->reach_m) {
        return limit;
    }
    struct rho_window_noise noise = rho_window_noise(scan, plot);
    float xx = place->noise.xx_m2 + place->factor * noise.xx_m2;
    float xy = place->noise.xy_m2 + place->factor * noise.xy_m2;
    float yy = place->noise.yy_m2 + place->factor * noise.yy_m2;
    float scaled = yy * dx_m * dx_m - 2.0f * xy * dx_m * dy_m + xx * dy_m * dy_m;
    float determinant = xx * yy - xy * xy;
    if (!(scaled < limit * determinant)) {
        return limit;
    }
    float distance2 = scaled / determinant;
    if ((scan->measures & RHO_MEASURES_Z) && place->has_z) {
        float dz_m = plot->z_m - place->z_m - place->vz_mps * plot->offset_s;
        distance2 += dz_m * dz_m / (place->noise.zz_m2 + place->factor * noise.zz_m2);
    }
    if ((scan->measures & RHO_MEASURES_RANGE_RATE) && distance2 < limit) {
        distance2 += rho_window_range_rate_distance2(scan, plot, place);
    }
    return distance2;
}

static float gate_chi2(const struct rho_window_scan *scan, const struct rho_window_place *place)
{
    int more = ((scan->measures & RHO_MEASURES_Z) && place->has_z ? 1 : 0) +
               ((scan->measures & RHO_MEASURES_RANGE_RATE) ? 1 : 0);
    return more == 0 ? RHO_WINDOW_CHI2_2D : more == 1 ? RHO_WINDOW_CHI2_3D : RHO_WINDOW_CHI2_4D;
}

int rho_window_nearest_to(const struct rho_window_scan *scan, const struct rho_window_place *place,
                          struct rho_window_work *work)
{
    struct rho_window_bins bins =
        bins_around(scan, place->x_m, place->y_m, place->vx_mps, place->vy_mps, place->reach_m);
    float best = gate_chi2(scan, place);
    int index = -1;
    unsigned compared = 0;
    for (int row = bins.row_first; row <= bins.row_last; row++) {
        const uint16_t *start = &scan->bin_start[row * scan->bins_x];
        unsigned from = start[bins.column_first], to = start[bins.column_last + 1];
        for (unsigned i = from; i < to; i++) {
            float distance2 = distance2_to(scan, &scan->plots[i], place, best);
            if (distance2 < best && !(scan->marks[i] & place->skip_flags)) {
                best = distance2;
                index = (int)i;
            }
        }
        compared += to - from;
    }
    work->lookups = rho_count(work->lookups, 1);
    work->distances = rho_count(work->distances, compared);
    return index;
}
