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
 * Stack: 160 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_WINDOW_H
#define RHOTRACK_WINDOW_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

/* A rectangle of the plane; empty while x_min_m > x_max_m. */
struct rho_extent {
    float x_min_m, x_max_m, y_min_m, y_max_m;
};

/* True where a place is in a rectangle, sides included. */
static inline int rho_extent_holds(const struct rho_extent *extent, float x_m, float y_m)
{
    return x_m >= extent->x_min_m && x_m <= extent->x_max_m && y_m >= extent->y_min_m &&
           y_m <= extent->y_max_m;
}

/* One held plot of a window. */
struct rho_window_plot {
    float x_m, y_m, z_m;
    float offset_s; /* time of this plot after the held scan's time */
    float range_rate_mps;
    /*
     * codes of the sigmas along, across and above the line of sight, and of the range rate:
     * rho_window_decode_sigma() decodes them
     */
    uint16_t sigma_range, sigma_cross, sigma_up, sigma_range_rate;
};

/*
 * Mark of a held plot: its row in the pushed scan, or RHO_WINDOW_ROW where it came with an earlier
 * sector than the newest of its scan; and flags.
 */
#define RHO_WINDOW_TAKEN 0x8000u /* belongs to a candidate that the current search has accepted */
#define RHO_WINDOW_INITIATED 0x4000u /* started a track: look-ups skip it */
#define RHO_WINDOW_ROW 0x3fffu

/* Units of `repeats` in a nat: ln of the clutter map's density over the density map's. */
#define RHO_WINDOW_REPEATS_PER_NAT 12.0f

/* The newest input of a window: a whole scan, or the sector added last to the newest scan. */
struct rho_window_sector {
    int64_t time_us;
    float offset_min_s; /* least offset of its plots, after the time of the held scan */
};

/*
 * Length of `repeats`, the coded logarithm of the clutter map's density ratio at each held plot;
 * without a clutter map the array has one unused element.
 */
#define RHO_WINDOW_REPEATS (RHO_MAX_ECHOES > 0 ? RHO_MAX_PLOTS : 1)

/* A held scan. Bin c, row * bins_x + column, has plots[bin_start[c]] .. [bin_start[c + 1] - 1]. */
struct rho_window_scan {
    int64_t time_us;
    /* RHO_MEASURES_... or-ed; of a revolution: common to all sectors with plots */
    uint32_t measures;
    float sector_from_rad, sector_to_rad;
    /* the sensor's description; pd 0: it has none, is at the origin and covers every place */
    struct rho_sensor sensor;
    uint16_t num_plots;
    uint16_t num_unused; /* plots that started no track */
    uint16_t bins_x, bins_y;
    float bin_x0_m, bin_y0_m;
    float bins_per_m_x, bins_per_m_y;
    float sigma_max_m; /* largest sigma of a plot, along, across or above the line of sight */
    float offset_min_s, offset_max_s; /* least and largest offset of a plot */
    int is_isotropic;                 /* every plot has the same noise along and across */
    uint16_t bin_start[RHO_MAX_BINS + 1];
    uint16_t marks[RHO_MAX_PLOTS]; /* by plots: row in the pushed scan, and flags */
    /* by plots: ln of the ratio by which the clutter map raises the clutter density, coded */
    uint8_t repeats[RHO_WINDOW_REPEATS];
    struct rho_window_plot plots[RHO_MAX_PLOTS];
};

struct rho_window {
    uint32_t magic; /* tells an initialised window from other memory */
    uint16_t scans_max;
    uint16_t num_scans;
    uint16_t first; /* place of the oldest scan in the ring */
    uint16_t area_is_fixed;
    uint16_t is_continued; /* the last push added a sector to the newest scan */
    /* the sector that the last push added changed what the newest scan measures */
    uint16_t is_remeasured;
    struct rho_window_sector newest;
    float side_min_m; /* least width and height that the area is taken to have */
    /* the given area, or the extent of the held plots without outliers; that shrinks slowly */
    struct rho_extent extent;
    struct rho_window_scan ring[RHO_MAX_SCANS];
};

/* Covariance of a place in the plane, and the variance of its height. */
struct rho_window_plot_noise {
    float xx_m2, xy_m2, yy_m2, zz_m2;
};

/* A moving place, to which the nearest plot is looked up, each plot at its own time. */
struct rho_window_place {
    float x_m, y_m, z_m;          /* at the scan's time */
    float vx_mps, vy_mps, vz_mps; /* by which the place moves on with the plot's offset */
    float ax_mps2, ay_mps2; /* acceleration over the plot's offset; gate_radius_m allows for it */
    struct rho_window_plot_noise noise;          /* covariance of the place */
    struct rho_window_plot_noise velocity_noise; /* covariance of the velocity, (m/s)^2 */
    /* correction of the velocity by an alias of a range rate; applied to range rates alone */
    float more_mps[3];
    float factor;        /* factor of the plots' variances */
    int has_z;           /* z_m and vz_mps are known */
    float gate_radius_m; /* largest radius of the gate, before the plots' offsets */
    uint16_t skip_flags; /* plots with any of these flags are skipped */
};

/* Counters of the work of look-ups; they saturate. */
struct rho_window_work {
    uint32_t lookups;   /* look-ups of a nearest plot */
    uint32_t distances; /* plots compared */
    uint32_t passed;    /* rows of bins, and other work of the same cost */
};

/*
 * Prepares an empty window of scans_max scans (1 .. RHO_MAX_SCANS).
 *   size  sizeof(struct rho_window) of the caller
 *   area  the rectangle that is binned; NULL: the extent of recent plots without outliers
 * Errors: NULL, SIZE, CONFIG (scans_max, an area that is empty or beyond RHO_LIMIT_POSITION_M).
 * Cost: sizeof(window) bytes cleared. Stack: 88 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_window_init(struct rho_window *window, size_t size,
                                               unsigned scans_max, const struct rho_extent *area);

/* Updates the extent of a window without a given area by the plots held, after a push. */
void rho_window_update_extent(struct rho_window *window);

/* True where the window is initialised and holds no scan newer than time_us. Constant cost. */
int rho_window_accepts(const struct rho_window *window, int64_t time_us);

/*
 * True where a scan would become part of the newest one held: a sector of the same sensor in the
 * same place, next to the sectors so far with a gap of an eighth of a revolution at most, and
 * within RHO_LIMIT_OFFSET_US of their time. The scan measures what all these do. Constant cost.
 */
int rho_window_continues_newest(const struct rho_window *window, const struct rho_scan *scan,
                                const struct rho_sensor *sensor);

/* The status that rho_window_push would return; nothing is changed. Constant cost. */
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
 * Stack: 248 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_window_push(struct rho_window *window,
                                               const struct rho_scan *scan,
                                               const struct rho_sensor *sensor, uint8_t *fates,
                                               uint32_t *left_unused);

/* The scan of age order m, 0 (oldest) .. num_scans - 1, which is not checked. Constant cost. */
struct rho_window_scan *rho_window_scan_at(struct rho_window *window, unsigned m);

/*
 * Index of the plot nearest to a place of straight motion, or -1 where none is in the gate. The
 * noise of any plot is taken as isotropic, with the larger of its sigmas, and that of the place as
 * noise.xx_m2 on each axis; heights and range rates do not count. Ties go to the lower index.
 *   gate_chi2  limit, exclusive, of distance^2 / (noise.xx_m2 + factor sigma^2)
 * Cost: bins under the gate's square, and their plots. Stack: 120 bytes.
 */
int rho_window_nearest_isotropic(const struct rho_window_scan *scan,
                                 const struct rho_window_place *place, float gate_chi2,
                                 struct rho_window_work *work);

/*
 * Index of the plot with the least NIS about a place with its own covariance: position plus height
 * plus range rate where measured, within the gate of as many dimensions; -1 where none is in the
 * gate. Correlations of height and range rate with the position are neglected. Cost: bins under the
 * gate's square, 60 instructions a plot in them. Stack: 272 bytes.
 */
int rho_window_nearest_plot(const struct rho_window_scan *scan,
                            const struct rho_window_place *place, struct rho_window_work *work);

/* Covariance of a held plot, by sigmas and line of sight. Cost: a division, with z three. */
struct rho_window_plot_noise rho_window_plot_noise(const struct rho_window_scan *scan,
                                                   const struct rho_window_plot *plot);

/* Innovation of a held plot's range rate, against the velocity of a place. */
struct rho_window_range_rate {
    /* measured minus expected, by the nearest alias where the range rate is ambiguous */
    float error_mps;
    float variance; /* variance of error_mps */
    float along[3]; /* unit vector of the line of sight: derivative by the velocity */
};

/*
 * Compares a held plot's range rate with the velocity of a place. Returns 0, and fills nothing, for
 * a plot at the sensor's position. Cost: 100 instructions. Stack: 160 bytes.
 */
int rho_window_compare_range_rate(const struct rho_window_scan *scan,
                                  const struct rho_window_plot *plot,
                                  const struct rho_window_place *place,
                                  struct rho_window_range_rate *seen);

/*
 * NIS of a held plot's range rate against the velocity of a place; 0 for a plot at the sensor's
 * position. The line of sight is the plot's, and its error by the plot's noise is included. Cost:
 * 100 instructions. Stack: 160 bytes.
 */
float rho_window_range_rate_nis(const struct rho_window_scan *scan,
                                const struct rho_window_plot *plot,
                                const struct rho_window_place *place);

/*
 * A held plot as rho_plot, as it was pushed, but with velocity and snr 0. Sigmas are rounded to
 * 2^-12 of themselves, the offset to float32. Constant cost.
 */
struct rho_plot rho_window_unpack_plot(const struct rho_window_scan *scan, unsigned index);

/* The sensor of a held scan, or NULL where it has no description. */
const struct rho_sensor *rho_window_sensor_if_described(const struct rho_window_scan *scan);

/*
 * Decodes a standard deviation: 5 bits of exponent and 11 of mantissa, 2^-12 relative error from
 * RHO_LIMIT_SIGMA_MIN to RHO_LIMIT_SIGMA_MAX; 12 significant bits are exact. Constant cost.
 */
float rho_window_decode_sigma(uint16_t code);

/* The larger of a held plot's sigmas along and across. Constant cost. */
float rho_window_larger_sigma_m(const struct rho_window_plot *plot);

/*
 * Bins whose columns and rows touch a rectangle; outside the area, its border bins. first and last
 * are both included. Constant cost.
 */
struct rho_window_bins {
    int column_first, column_last, row_first, row_last;
};
struct rho_window_bins rho_window_bins_under(const struct rho_window_scan *scan,
                                             const struct rho_extent *under);

/* Index of the bin at a place; outside the area a border bin. Constant cost. */
unsigned rho_window_bin_at(const struct rho_window_scan *scan, float x_m, float y_m);

/*
 * Width, height and area of an extent, whose sides count as at least side_min_m; 0 where it is
 * empty and side_min_m is 0.
 */
float rho_extent_width_m(const struct rho_extent *extent, float side_min_m);
float rho_extent_height_m(const struct rho_extent *extent, float side_min_m);
float rho_extent_area_m2(const struct rho_extent *extent, float side_min_m);

/* Grows an extent so that it holds a point. Constant cost. */
void rho_extent_add(struct rho_extent *extent, float x_m, float y_m);

/*
 * True where counts, indices and numbers of an object of unknown origin are within their limits, as
 * rho_snapshot_load asks. Cost: all plots held. Stack: 150 bytes.
 */
int rho_window_is_sound(const struct rho_window *window);

RHO_END_C

#endif
