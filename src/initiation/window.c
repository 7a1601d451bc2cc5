/* SPDX-License-Identifier: MIT */
#include "rhotrack/window.h"

#include <float.h>
#include <string.h>

#include "rhotrack/angle.h"
#include "rhotrack/measurement.h"
#include "window_extent.h"
#include "window_sigma.h"

#define WINDOW_MAGIC 0x57494e44u /* "WIND" */

#define ROW_MAX RHO_WINDOW_ROW

/* Sectors that are missing in between (lost, or late) do not end a turn, up to an eighth of it. What they would have seen counts as
 * not seen. */
#define SECTOR_GAP_RAD (RHO_TWO_PI / 8.0f)

/* Bins a plot that are worth their memory traffic when a scan has few plots. */
#define BINS_PER_PLOT 8u

/* ---- areas and bins ---------------------------------------------------------------------------- */

static float at_least(float v, float limit)
{
    return v > limit ? v : limit;
}

static int is_usable_area(const struct rho_extent *area)
{
    return rho_is_coordinate(area->x_min_m) && rho_is_coordinate(area->x_max_m) &&
           rho_is_coordinate(area->y_min_m) && rho_is_coordinate(area->y_max_m) &&
           area->x_min_m < area->x_max_m && area->y_min_m < area->y_max_m;
}

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

/* Decides who fits, beside those that are held. */
static unsigned admit(const struct rho_scan *scan, unsigned held, uint8_t *fates)
{
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
static void guess_extent_once(struct rho_window *window, const struct rho_scan *scan,
                              const uint8_t *fates)
{
    if (window->area_is_fixed || window->extent.x_min_m <= window->extent.x_max_m) {
        return;
    }
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        if (fates[i] == RHO_FATE_HELD) {
            rho_extent_add(&window->extent, scan->plots[i].x_m, scan->plots[i].y_m);
        }
    }
}

/* The scan that plots go into, and their scan's time after its own. */
struct entry {
    struct rho_window_scan *slot;
    const struct rho_scan *scan;
    const uint8_t *fates;
    struct rho_sigma_factors factors; /* of what plots say of their noise */
#if RHO_SECTORS
    float after_s;
#endif
};

static float within_limits(float sigma)
{
    const float least = sigma > RHO_LIMIT_SIGMA_MIN ? sigma : RHO_LIMIT_SIGMA_MIN;
    return least < RHO_LIMIT_SIGMA_MAX ? least : RHO_LIMIT_SIGMA_MAX;
}

static struct rho_window_plot window_plot(const struct entry *entry, uint32_t row)
{
    const struct rho_scan *scan = entry->scan;
    const struct rho_plot *plot = &scan->plots[row];
    struct rho_window_plot held = {
        .x_m = plot->x_m,
        .y_m = plot->y_m,
#if RHO_SECTORS
        .offset_s = entry->after_s + seconds(plot->offset_us),
#else
        .offset_s = seconds(plot->offset_us),
#endif
        .sigma_range = sigma_code(within_limits(entry->factors.range * plot->sigma_range_m)),
        .sigma_cross = sigma_code(within_limits(entry->factors.cross * plot->sigma_cross_m)),
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
#if RHO_SECTORS
    if (plot->offset_s < slot->newest.offset_min_s) {
        slot->newest.offset_min_s = plot->offset_s;
    }
    rho_extent_add(&slot->newest.extent, plot->x_m, plot->y_m);
#endif
}

/* Where each bin's plots will begin, with those that come. */
static void lay_starts(const struct entry *entry)
{
    struct rho_window_scan *slot = entry->slot;
    unsigned bins = (unsigned)slot->bins_x * slot->bins_y;
    uint16_t *start = slot->bin_start;
    if (RHO_SECTORS && slot->num_plots > 0) {
        for (unsigned c = bins; c > 0; c--) { /* as many as there are */
            start[c] = (uint16_t)(start[c] - start[c - 1]);
        }
    } else {
        memset(start, 0, (bins + 1) * sizeof start[0]);
    }
    for (uint32_t i = 0; i < entry->scan->num_plots; i++) {
        const struct rho_plot *plot = &entry->scan->plots[i];
        if (entry->fates[i] == RHO_FATE_HELD) {
            start[bin_of(slot, plot->x_m, plot->y_m) + 1]++;
        }
    }
    for (unsigned c = 0; c < bins; c++) {
        start[c + 1] = (uint16_t)(start[c + 1] + start[c]);
    }
}

#if RHO_SECTORS
/* Plots that are there move up to where their bins begin now, the last bin first; the starts then are behind them. */
static void move_up(struct rho_window_scan *slot)
{
    unsigned end = slot->num_plots;
    while (end > 0) {
        unsigned bin = bin_of(slot, slot->plots[end - 1].x_m, slot->plots[end - 1].y_m);
        unsigned first = end - 1;
        while (first > 0 &&
               bin_of(slot, slot->plots[first - 1].x_m, slot->plots[first - 1].y_m) == bin) {
            first--;
        }
        unsigned to = slot->bin_start[bin];
        memmove(&slot->plots[to], &slot->plots[first], (end - first) * sizeof slot->plots[0]);
        memmove(&slot->marks[to], &slot->marks[first], (end - first) * sizeof slot->marks[0]);
#if RHO_MAX_ECHOES > 0
        memmove(&slot->repeats[to], &slot->repeats[first], end - first);
#endif
        slot->bin_start[bin] = (uint16_t)(to + end - first);
        end = first;
    }
}
#endif

/* Counting sort by bin, stable, without a second array: starts move up as bins fill, and are then shifted back. */
static void sort_into_bins(const struct entry *entry)
{
    struct rho_window_scan *slot = entry->slot;
    unsigned bins = (unsigned)slot->bins_x * slot->bins_y;
    uint16_t *start = slot->bin_start;
    lay_starts(entry);
#if RHO_SECTORS
    move_up(slot);
#endif
    for (uint32_t i = 0; i < entry->scan->num_plots; i++) {
        if (entry->fates[i] == RHO_FATE_HELD) {
            struct rho_window_plot plot = window_plot(entry, i);
            unsigned place = start[bin_of(slot, plot.x_m, plot.y_m)]++;
            slot->plots[place] = plot;
            slot->marks[place] = (uint16_t)i;
#if RHO_MAX_ECHOES > 0
            slot->repeats[place] = 0;
#endif
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
        window->first =
            (uint16_t)(window->first + 1u < window->scans_max ? window->first + 1u : 0u);
        window->num_scans--;
    }
    window->num_scans++;
    return rho_window_scan_at(window, window->num_scans - 1u);
}

/* ---- sectors ---------------------------------------------------------------------------------- */

#if RHO_SECTORS

static const struct rho_window_scan *newest_of(const struct rho_window *window)
{
    const unsigned end = (unsigned)window->first + window->num_scans; /* num_scans > 0 */
    return &window->ring[(end > window->scans_max ? end - window->scans_max : end) - 1u];
}

static int is_newest_older(const struct rho_window *window, int64_t time_us)
{
    return newest_of(window)->newest.time_us <= time_us;
}

static int is_equal(float a, float b)
{
    return a <= b && a >= b;
}

/* What the turn's plots are held with would not be that of the sector's. */
static int is_other_sensor(const struct rho_window_scan *held, const struct rho_sensor *sensor)
{
    const struct rho_sensor *was = &held->sensor;
    if (!sensor) {
        return was->pd > 0.0f;
    }
#if RHO_AMBIGUOUS_RANGE_RATES
    if (!is_equal(was->range_rate_span_mps, sensor->range_rate_span_mps)) {
        return 1;
    }
#endif
    return !(was->pd > 0.0f) || !is_equal(was->x_m, sensor->x_m) ||
           !is_equal(was->y_m, sensor->y_m) || !is_equal(was->z_m, sensor->z_m);
}

int rho_window_goes_on(const struct rho_window *window, const struct rho_scan *scan,
                       const struct rho_sensor *sensor)
{
    if (window->magic != WINDOW_MAGIC || window->num_scans == 0) {
        return 0;
    }
    const struct rho_window_scan *held = newest_of(window);
    return held->sensor.sensor_id == scan->sensor_id && !is_other_sensor(held, sensor) &&
           held->newest.time_us <= scan->time_us &&
           scan->time_us - held->time_us <= RHO_LIMIT_OFFSET_US &&
           rho_angle_sector_goes_on(held->sector_from_rad, held->sector_to_rad,
                                    scan->sector_from_rad, scan->sector_to_rad,
                                    SECTOR_GAP_RAD) != 0;
}

/* How many plots the turn will have that begins with so many in a sector: as the turn before, if there was one. */
static unsigned plots_of_turn(struct rho_window *window, const struct rho_scan *scan, unsigned held)
{
    const float turns =
        RHO_TWO_PI / rho_angle_sector_width(scan->sector_from_rad, scan->sector_to_rad);
    if (!(turns > 1.0f)) {
        return held;
    }
    if (window->num_scans < 2) {
        return RHO_MAX_PLOTS;
    }
    const unsigned before = rho_window_scan_at(window, window->num_scans - 2u)->num_plots;
    return held > before ? held : before;
}

/* A scan that has come, or what of one has. */
static void begin_sector(struct rho_window_scan *slot, const struct rho_scan *scan)
{
    slot->newest.time_us = scan->time_us;
    slot->newest.offset_min_s = FLT_MAX;
    slot->newest.extent = (struct rho_extent){1.0f, 0.0f, 1.0f, 0.0f};
    slot->newest.width_rad = rho_angle_sector_width(slot->sector_from_rad, slot->sector_to_rad);
}

static void widen_sector(struct rho_window_scan *slot, const struct rho_scan *scan)
{
    const unsigned ends =
        rho_angle_sector_goes_on(slot->sector_from_rad, slot->sector_to_rad, scan->sector_from_rad,
                                 scan->sector_to_rad, SECTOR_GAP_RAD);
    if (ends & RHO_ANGLE_GOES_ON_RIGHT) {
        slot->sector_from_rad = scan->sector_from_rad;
    } else {
        slot->sector_to_rad = scan->sector_to_rad;
    }
    if (ends == (RHO_ANGLE_GOES_ON_LEFT | RHO_ANGLE_GOES_ON_RIGHT)) {
        slot->sector_from_rad = slot->sector_to_rad = 0.0f; /* the turn is whole */
    }
}

/* A turn measures what all its plots do: a sector that saw nothing measures nothing, and takes nothing away. */
static void even_measures(struct rho_window *window, struct rho_window_scan *slot,
                          const struct rho_scan *scan, unsigned held)
{
    const uint32_t before = slot->measures;
    if (slot->num_plots == 0) {
        slot->measures = scan->measures;
    } else if (held > slot->num_plots) {
        slot->measures &= scan->measures;
    }
    window->is_remeasured = slot->measures != before;
}

static void add_sector(struct rho_window *window, const struct rho_scan *scan,
                       const struct rho_sensor *sensor, uint8_t *fates)
{
    struct rho_window_scan *slot = rho_window_scan_at(window, window->num_scans - 1u);
    const struct entry entry = {slot, scan, fates, rho_measurement_sigma_factors(sensor),
                                rho_seconds_between(slot->time_us, scan->time_us)};
    const unsigned held = admit(scan, slot->num_plots, fates);
    if (slot->num_plots == 0) {
        guess_extent_once(window, scan, fates);
        lay_bins(slot, window, plots_of_turn(window, scan, held));
    }
    even_measures(window, slot, scan, held);
    widen_sector(slot, scan);
    begin_sector(slot, scan);
    sort_into_bins(&entry);
    slot->sensor.pd = sensor ? sensor->pd : 0.0f;
    slot->num_unused = (uint16_t)(slot->num_unused + held - slot->num_plots);
    slot->num_plots = (uint16_t)held;
}

#else

static int is_newest_older(const struct rho_window *window, int64_t time_us)
{
    unsigned newest =
        ((unsigned)window->first + window->num_scans + window->scans_max - 1u) % window->scans_max;
    return window->ring[newest].time_us <= time_us;
}

int rho_window_goes_on(const struct rho_window *window, const struct rho_scan *scan,
                       const struct rho_sensor *sensor)
{
    (void)window, (void)scan, (void)sensor;
    return 0;
}

static unsigned plots_of_turn(struct rho_window *window, const struct rho_scan *scan, unsigned held)
{
    (void)window, (void)scan;
    return held;
}

#endif

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
    return window->num_scans == 0 || is_newest_older(window, time_us);
}

enum rho_status rho_window_check_push(const struct rho_window *window, const struct rho_scan *scan,
                                      const uint8_t *fates, const uint32_t *left_unused)
{
    if (!window || !scan || !left_unused || (scan->num_plots && (!scan->plots || !fates))) {
        return RHO_ERROR_NULL;
    }
#if RHO_SECTORS
    if (!rho_angle_is_sector(scan->sector_from_rad, scan->sector_to_rad)) {
        return RHO_ERROR_VALUE;
    }
#endif
    return rho_window_accepts(window, scan->time_us) ? RHO_OK : RHO_ERROR_STATE;
}

static void add_scan(struct rho_window *window, const struct rho_scan *scan,
                     const struct rho_sensor *sensor, uint8_t *fates, uint32_t *left_unused)
{
    struct rho_window_scan *slot = next_slot(window, left_unused);
    const struct entry entry = {.slot = slot,
                                .scan = scan,
                                .fates = fates,
                                .factors = rho_measurement_sigma_factors(sensor)};
    unsigned held = admit(scan, 0, fates);
    slot->time_us = scan->time_us;
    slot->measures = scan->measures;
    slot->sector_from_rad = scan->sector_from_rad;
    slot->sector_to_rad = scan->sector_to_rad;
    slot->sensor = sensor ? *sensor : (struct rho_sensor){.sensor_id = scan->sensor_id};
    slot->sensor.pd = sensor ? sensor->pd : 0.0f;
    slot->sensor.sigma_range_percent = slot->sensor.sigma_cross_percent = 0; /* plots have it */
    slot->num_plots = 0;
    slot->sigma_max_m = slot->offset_min_s = slot->offset_max_s = 0.0f;
    slot->is_isotropic = 1;
#if RHO_SECTORS
    begin_sector(slot, scan);
#endif
    guess_extent_once(window, scan, fates);
    lay_bins(slot, window, plots_of_turn(window, scan, held));
    sort_into_bins(&entry);
    slot->num_plots = slot->num_unused = (uint16_t)held;
    if (!window->area_is_fixed) {
        rho_window_follow_extent(window);
    }
}

enum rho_status rho_window_push(struct rho_window *window, const struct rho_scan *scan,
                                const struct rho_sensor *sensor, uint8_t *fates,
                                uint32_t *left_unused)
{
    enum rho_status status = rho_window_check_push(window, scan, fates, left_unused);
    if (status != RHO_OK) {
        return status;
    }
#if RHO_SECTORS
    window->is_continued = rho_window_goes_on(window, scan, sensor) != 0;
    window->is_remeasured = 0;
    if (window->is_continued) {
        add_sector(window, scan, sensor, fates);
        return RHO_OK;
    }
#endif
    add_scan(window, scan, sensor, fates, left_unused);
    return RHO_OK;
}

struct rho_window_scan *rho_window_scan_at(struct rho_window *window, unsigned m)
{
    const unsigned place = window->first + m;
    return &window->ring[place < window->scans_max ? place : place - window->scans_max];
}
