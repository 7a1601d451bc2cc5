/* SPDX-License-Identifier: MIT */
/*
 * window: the last N scans of plots, binned for neighbour look-up.
 *
 * A ring of scans, oldest dropped first. The plots of a scan are sorted into bins over the area on
 * entry, so that the plot nearest to a predicted place is found in constant time while plots are
 * spread out. Scans are addressed by age order: 0 is the oldest held, num_scans - 1 the newest.
 *
 * A radar may report sector by sector (RHO_SECTORS). A sector that continues the newest held scan
 * of the same sensor becomes part of it until the revolution is complete: N scans are N
 * revolutions. Sectors of several radars need a window each.
 *
 * Stack: 104 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_WINDOW_H
#define RHOTRACK_WINDOW_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A rectangle of the plane; empty while x_min_m > x_max_m. */
struct rho_extent {
    float x_min_m, x_max_m, y_min_m, y_max_m;
};

/* One held plot. */
struct rho_window_plot {
    float x_m, y_m, z_m;
    float offset_s; /* own time after the scan's */
    float range_rate_mps;
    /*
     * sigmas along, across and above the line of sight, and of the range rate: rho_window_sigma()
     */
    uint16_t sigma_range, sigma_cross, sigma_up, sigma_range_rate;
};

/* The mark of a held plot: its row in the scan, and flags. */
#define RHO_WINDOW_TAKEN 0x8000u /* belongs to a candidate that the current search has accepted */
#define RHO_WINDOW_INITIATED 0x4000u /* started a track: look-ups skip it */
#define RHO_WINDOW_ROW 0x3fffu

/* Units of `repeats`: ln of the clutter map's density over the density map's, in 1/12 nat. */
#define RHO_WINDOW_REPEATS_PER_NAT 12.0f

/* The newest input: a whole scan, or the sector that was added last to the newest scan. */
struct rho_window_sector {
    int64_t time_us;
    float offset_min_s; /* least of its plots' own times, after the time of the held scan */
};

/* Held plots know how much denser clutter is at their place: with a clutter map alone. */
#define RHO_WINDOW_REPEATS (RHO_MAX_ECHOES > 0 ? RHO_MAX_PLOTS : 1)

/*
 * One held scan. plots[bin_start[c]] .. plots[bin_start[c + 1] - 1] lie in bin c = row * bins_x +
 * column.
 */
struct rho_window_scan {
    int64_t time_us;
    uint32_t measures; /* RHO_MEASURES_...; of sectors: common to all that have plots */
    float sector_from_rad, sector_to_rad;
    struct rho_sensor sensor; /* pd 0: not described; then at the origin, with full coverage */
    uint16_t num_plots;
    uint16_t num_unused; /* plots that started no track */
    uint16_t bins_x, bins_y;
    float bin_x0_m, bin_y0_m;
    float bins_per_m_x, bins_per_m_y;
    float sigma_max_m;                /* over the plots, along or across */
    float offset_min_s, offset_max_s; /* over the plots */
    int is_isotropic;                 /* every plot has the same noise along and across */
    uint16_t bin_start[RHO_MAX_BINS + 1];
    uint16_t marks[RHO_MAX_PLOTS]; /* row and flags of each plot */
    /* ln of how much denser the clutter map makes clutter at each plot */
    uint8_t repeats[RHO_WINDOW_REPEATS];
    struct rho_window_plot plots[RHO_MAX_PLOTS];
};

struct rho_window {
    uint32_t magic; /* tells an initialised object */
    uint16_t scans_max;
    uint16_t num_scans;
    uint16_t first; /* ring place of the oldest */
    uint16_t area_is_fixed;
    uint16_t is_continued;  /* the last push went into the newest scan */
    uint16_t is_remeasured; /* ... and changed what that scan measures */
    struct rho_window_sector newest;
    float side_min_m;         /* the area is taken at least this wide and high */
    struct rho_extent extent; /* fixed, or of the held plots without outliers; it shrinks slowly */
    struct rho_window_scan ring[RHO_MAX_SCANS];
};

/*
 * A look-up of the plot nearest, in units of its own standard deviation, to a place that moves with
 * the plots' own times. All noise is taken as isotropic, with the larger sigma of a plot.
 */
struct rho_window_query {
    float x_m, y_m;       /* where, at the scan's time */
    float vx_mps, vy_mps; /* moves on with the plot's offset */
    float variance_m2;    /* of the place, an axis */
    float sigma_factor;   /* of the sigma^2 of plots */
    /* limit of distance^2 / (variance_m2 + sigma_factor sigma^2), exclusive */
    float gate_chi2;
    float gate_radius_m; /* bound of the gate in metres, before plots' own times */
    uint16_t skip_flags; /* plots with any of these flags are skipped */
};

/* Covariance in the plane, and the variance of the height. */
struct rho_window_noise {
    float xx_m2, xy_m2, yy_m2, zz_m2;
};

/*
 * The same look-up with the covariance of each plot, and its height and range rate where measured.
 */
struct rho_window_place {
    float x_m, y_m, z_m;
    float vx_mps, vy_mps, vz_mps;
    float ax_mps2, ay_mps2;                 /* to the plot's own time; reach_m allows for it */
    struct rho_window_noise noise;          /* of the place */
    struct rho_window_noise velocity_noise; /* of the velocity, (m/s)^2 */
    /* correction of the velocity by an ambiguous range rate; counts for range rates alone */
    float more_mps[3];
    float factor; /* of the plots' covariances, and of the sum's gate */
    int has_z;    /* z_m and vz_mps are known */
    float gate_radius_m;
    uint16_t skip_flags;
};

/* Counters of the work of look-ups; they saturate. */
struct rho_window_work {
    uint32_t lookups;   /* queries */
    uint32_t distances; /* plots compared */
    uint32_t passed;    /* rows of bins, and other work of the same cost */
};

/*
 * Prepares an empty window of scans_max scans (1 .. RHO_MAX_SCANS).
 *   size        sizeof(struct rho_window) of the caller
 *   area        the rectangle that is binned; NULL: the extent of recent plots without outliers
 *   side_min_m  >= 0: least width and height of the area (the travel of targets within the window)
 * Errors: NULL, SIZE, CONFIG (scans_max, an area that is empty or beyond RHO_LIMIT_POSITION_M,
 * side_min_m). Cost: sizeof(window) bytes cleared. Stack: 88 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_window_init(struct rho_window *window, size_t size,
                                               unsigned scans_max, const struct rho_extent *area,
                                               float side_min_m);

/*
 * True where a scan of this time can be pushed: the window is initialised, and holds no newer scan.
 * Constant cost.
 */
int rho_window_accepts(const struct rho_window *window, int64_t time_us);

/*
 * True where a scan would become part of the newest one held: a sector of the same sensor in the
 * same place, next to the sectors so far with a gap of an eighth of a revolution at most, and
 * within RHO_LIMIT_OFFSET_US of their time. The scan then measures what all its sectors with plots
 * measure. Constant cost.
 */
int rho_window_continues(const struct rho_window *window, const struct rho_scan *scan,
                         const struct rho_sensor *sensor);

/* The status that rho_window_push would return; nothing is taken. Constant cost. */
RHO_MUST_CHECK enum rho_status rho_window_check_push(const struct rho_window *window,
                                                     const struct rho_scan *scan,
                                                     const uint8_t *fates,
                                                     const uint32_t *left_unused);

/*
 * Takes the plots of a scan whose fate is RHO_FATE_HELD. A scan that continues the newest one
 * becomes part of it, and its plots' own times then count from the time of that one. Before any
 * other scan the oldest one leaves a full window.
 *   scan    a valid scan, not older than the newest held; its plots are copied
 *   sensor  copied; of a scan that continues, its pd alone; NULL: not described, at the origin
 *   fates   one a plot; a HELD plot beyond RHO_MAX_PLOTS, or of row 16384 and up, becomes NO_ROOM
 *   left_unused  counts the plots that leave the window without having started a track
 * Errors: NULL, VALUE (with RHO_SECTORS: an invalid sector), STATE (not initialised, or the scan is
 * older than the newest). Plots outside the area are kept in its border bins. Cost: RHO_MAX_PLOTS
 * copies, RHO_MAX_BINS additions; without a given area, three passes over all plots held.
 * Stack: 240 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_window_push(struct rho_window *window,
                                               const struct rho_scan *scan,
                                               const struct rho_sensor *sensor, uint8_t *fates,
                                               uint32_t *left_unused);

/*
 * The scan of age order m, 0 (oldest) .. num_scans - 1 (newest); m is not checked. Constant cost.
 */
struct rho_window_scan *rho_window_scan_at(struct rho_window *window, unsigned m);

/*
 * Index of the plot nearest to the query's place, or -1 where none is in the gate. Ties go to the
 * lower index. Cost: bins under the gate's square, and their plots. Stack: 104 bytes.
 */
int rho_window_nearest(const struct rho_window_scan *scan, const struct rho_window_query *query,
                       struct rho_window_work *work);

/*
 * The same for a place with its own covariance: the plot with the least NIS, position plus height
 * plus range rate, within the gate of as many dimensions. Correlations of height and range rate
 * with the position are neglected. Cost: as above, 60 instructions a plot. Stack: 272 bytes.
 */
int rho_window_nearest_to(const struct rho_window_scan *scan, const struct rho_window_place *place,
                          struct rho_window_work *work);

/* A held plot's covariance, from its line of sight. Cost: a division, with z two more. */
struct rho_window_noise rho_window_noise(const struct rho_window_scan *scan,
                                         const struct rho_window_plot *plot);

/* The range rate of a held plot against the velocity of a place. */
struct rho_window_range_rate {
    float error_mps; /* measured minus expected, by the nearest multiple where ambiguous */
    float variance;  /* of error_mps */
    float along[3];  /* the line of sight: derivative by the velocity */
};

/*
 * Fills *seen. Returns 0, and fills nothing, for a plot at the sensor's position. Cost: 100
 * instructions. Stack: 160 bytes.
 */
int rho_window_see_range_rate(const struct rho_window_scan *scan,
                              const struct rho_window_plot *plot,
                              const struct rho_window_place *place,
                              struct rho_window_range_rate *seen);

/*
 * NIS of a held plot's range rate against the velocity of the place. The line of sight is that of
 * the plot, whose error turns it. 0 for a plot at the sensor's position. Cost: 100 instructions.
 * Stack: 160 bytes.
 */
float rho_window_range_rate_distance2(const struct rho_window_scan *scan,
                                      const struct rho_window_plot *plot,
                                      const struct rho_window_place *place);

/*
 * The held plot as it was pushed, without its velocity and snr, which are 0. Sigmas are rounded to
 * 2^-12 of themselves, the offset to float32. Constant cost.
 */
struct rho_plot rho_window_plot_of(const struct rho_window_scan *scan, unsigned index);

/* The scan's sensor, or NULL where it was not described. */
const struct rho_sensor *rho_window_sensor(const struct rho_window_scan *scan);

/*
 * A standard deviation from its code: 5 bits of exponent and 11 of mantissa, 2^-12 relative error
 * from RHO_LIMIT_SIGMA_MIN to RHO_LIMIT_SIGMA_MAX; numbers of 12 significant bits are exact.
 * Constant cost.
 */
float rho_window_sigma(uint16_t code);

/* The larger of a held plot's sigmas along and across. Constant cost. */
float rho_window_sigma_m(const struct rho_window_plot *plot);

/*
 * Bins whose columns and rows touch [x0, x1] x [y0, y1]; outside the area, its border bins. first
 * and last are both included. Constant cost.
 */
struct rho_window_bins {
    int column_first, column_last, row_first, row_last;
};
struct rho_window_bins rho_window_bins_under(const struct rho_window_scan *scan, float x0_m,
                                             float x1_m, float y0_m, float y1_m);

/* The bin of a place; outside the area a border bin. Constant cost. */
unsigned rho_window_bin_of(const struct rho_window_scan *scan, float x_m, float y_m);

/*
 * Sides and content of an extent, at least side_min_m a side; 0 where it is empty and side_min_m is
 * 0.
 */
float rho_extent_width_m(const struct rho_extent *extent, float side_min_m);
float rho_extent_height_m(const struct rho_extent *extent, float side_min_m);
float rho_extent_area_m2(const struct rho_extent *extent, float side_min_m);

/* Grows an extent to hold the point. Constant cost. */
void rho_extent_add(struct rho_extent *extent, float x_m, float y_m);

/*
 * True where an object of unknown origin (a snapshot, memory that outlived a reset) is consistent:
 * counts, indices and numbers are within their limits. rho_snapshot_load calls it. Cost: all plots
 * held. Stack: 150 bytes.
 */
int rho_window_is_sound(const struct rho_window *window);

#ifdef __cplusplus
}
#endif

#endif
