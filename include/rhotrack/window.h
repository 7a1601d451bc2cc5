/* SPDX-License-Identifier: MIT */
/*
 * window: the last N scans of plots, binned for neighbour look-up.
 *
 * A ring of scans, oldest dropped first. Each scan's plots are sorted into bins over the area on entry, so that the
 * nearest plot to a predicted place is found in constant time while plots are spread out. Scans are addressed by age
 * order: 0 is the oldest held, num_scans - 1 the newest.
 *
 * A radar may say what it sees sector by sector (RHO_SECTORS). One that goes on where the newest held scan of the same sensor
 * ends becomes part of it, until the turn is whole: N scans are N turns. Sectors of several radars need a window each.
 *
 * Stack: 104 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_WINDOW_H
#define RHOTRACK_WINDOW_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/status.h"
#include "rhotrack/types.h"

/* A rectangle of the plane; empty while x_min_m > x_max_m. */
struct rho_extent {
    float x_min_m, x_max_m, y_min_m, y_max_m;
};

/* One held plot. */
struct rho_window_plot {
    float x_m, y_m, z_m;
    float offset_s; /* own time after the scan's */
    float range_rate_mps;
    /* standard deviations along, across and above the line of sight, and of the range rate: rho_window_sigma() */
    uint16_t sigma_range, sigma_cross, sigma_up, sigma_range_rate;
};

/* What is remembered of a held plot beside: the row that it had in its scan, and flags. */
#define RHO_WINDOW_TAKEN 0x8000u     /* belongs to a candidate accepted in the search under way */
#define RHO_WINDOW_INITIATED 0x4000u /* started a track: no longer there for look-ups */
#define RHO_WINDOW_ROW 0x3fffu

/* Held plots know how much denser clutter is in their place than the density map says, ln, in units of 1/12 nat. */
#define RHO_WINDOW_REPEATS_PER_NAT 12.0f

#if RHO_SECTORS
/* What came last of a scan that is held: all of it, or the sector that was added to it. */
struct rho_window_sector {
    int64_t time_us;
    float offset_min_s;       /* its plots' own times after the held scan's begin there */
    float width_rad;          /* how far the held scan goes round now */
    struct rho_extent extent; /* where its plots are; empty: there are none */
};
#endif

/* One held scan. plots[bin_start[c]] .. plots[bin_start[c + 1] - 1] lie in bin c = row * bins_x + column. */
struct rho_window_scan {
    int64_t time_us;
    uint32_t measures; /* RHO_MEASURES_...; of sectors: what all that have plots measure */
    float sector_from_rad, sector_to_rad;
    struct rho_sensor sensor; /* pd 0: not described; then at the origin, seeing everything */
    uint16_t num_plots;
    uint16_t num_unused; /* plots that started no track */
    uint16_t bins_x, bins_y;
    float bin_x0_m, bin_y0_m;
    float bins_per_m_x, bins_per_m_y;
    float sigma_max_m;                /* over the plots, along or across */
    float offset_min_s, offset_max_s; /* over the plots */
    int is_isotropic;                 /* every plot has the same noise along and across */
#if RHO_SECTORS
    struct rho_window_sector newest;
#endif
    uint16_t bin_start[RHO_MAX_BINS + 1];
    uint16_t marks[RHO_MAX_PLOTS]; /* row and flags of each plot */
#if RHO_MAX_ECHOES > 0
    uint8_t repeats
        [RHO_MAX_PLOTS]; /* ln of how much denser clutter is at the plot, by the clutter map */
#endif
    struct rho_window_plot plots[RHO_MAX_PLOTS];
};

struct rho_window {
    uint32_t magic; /* tells an initialised object */
    uint16_t scans_max;
    uint16_t num_scans;
    uint16_t first; /* ring place of the oldest */
    uint16_t area_is_fixed;
#if RHO_SECTORS
    uint16_t is_continued;  /* the last push went into the newest scan */
    uint16_t is_remeasured; /* ... and changed what that scan measures */
#endif
    float side_min_m; /* the area is taken at least this wide and high */
    struct rho_extent
        extent; /* fixed, or that of the plots held, without outliers; it shrinks slowly */
    struct rho_window_scan ring[RHO_MAX_SCANS];
};

/* Which plot is asked for: the nearest, in units of its own standard deviation, to a place that moves with the plots'
 * own times. All noise is taken as isotropic, the larger sigma of a plot. */
struct rho_window_query {
    float x_m, y_m;       /* where, at the scan's time */
    float vx_mps, vy_mps; /* moves on with the plot's offset */
    float variance_m2;    /* of the place, an axis */
    float sigma_factor;   /* a plot's sigma^2 counts this many times */
    /* plots with distance^2 / (variance_m2 + sigma_factor sigma^2) there or beyond are none */
    float gate_chi2;
    float reach_m;       /* no plot in the gate is farther, before its own time moves the place */
    uint16_t skip_flags; /* plots with any of these flags are not there */
};

/* Covariance in the plane, and the variance of the height. */
struct rho_window_noise {
    float xx_m2, xy_m2, yy_m2, zz_m2;
};

/* The same question where each plot has its own covariance, heights and range rates count as far as the scan has
 * them. */
struct rho_window_place {
    float x_m, y_m, z_m;
    float vx_mps, vy_mps, vz_mps;
    float ax_mps2, ay_mps2;                 /* to the plot's own time; reach_m allows for it */
    struct rho_window_noise noise;          /* of the place */
    struct rho_window_noise velocity_noise; /* of the velocity, (m/s)^2 */
#if RHO_AMBIGUOUS_RANGE_RATES
    float more_mps[3]; /* what range rates say of the velocity beside: for range rates alone */
#endif
    float factor; /* of the plots' covariances, and of the sum's gate */
    int has_z;    /* z_m and vz_mps are known */
    float reach_m;
    uint16_t skip_flags;
};

/* Work done, for measurement: moves with each look-up and saturates. */
struct rho_window_work {
    uint32_t lookups;   /* queries */
    uint32_t distances; /* plots compared */
    uint32_t
        passed; /* rows of bins, and what else costs as much: two for a plot in its own noise */
};

/*
 * Prepares an empty window of scans_max scans (1 .. RHO_MAX_SCANS).
 *   size        sizeof(struct rho_window) of the caller
 *   area        the rectangle that is binned; NULL: the extent of the plots seen lately, outliers left out
 *   side_min_m  >= 0: the area counts as at least this wide and high (targets move by so much within the window)
 * Errors: NULL, SIZE, CONFIG (scans_max, an area that is empty or beyond RHO_LIMIT_POSITION_M, side_min_m).
 * Cost: sizeof(window) bytes cleared. Stack: 88 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_window_init(struct rho_window *window, size_t size,
                                               unsigned scans_max, const struct rho_extent *area,
                                               float side_min_m);

/* True where a scan of this time can be pushed: the window is initialised, and holds no newer scan. Constant cost. */
int rho_window_accepts(const struct rho_window *window, int64_t time_us);

/*
 * True where a scan would become part of the newest one held: a sector of the same sensor in the same place, beside what
 * that one has seen so far, or an eighth of a turn on at most, and within RHO_LIMIT_OFFSET_US of its time. The scan then
 * measures what all its sectors with plots do. Constant cost.
 */
int rho_window_goes_on(const struct rho_window *window, const struct rho_scan *scan,
                       const struct rho_sensor *sensor);

/* What rho_window_push would say, without taking anything. Constant cost. */
RHO_MUST_CHECK enum rho_status rho_window_check_push(const struct rho_window *window,
                                                     const struct rho_scan *scan,
                                                     const uint8_t *fates,
                                                     const uint32_t *left_unused);

/*
 * Takes the plots of a scan whose fate is RHO_FATE_HELD. A scan that goes on with the newest one becomes part of it, its plots'
 * own times then count from that one's; before any other the oldest scan leaves when the window is full.
 *   scan    a valid scan, not older than the newest held; its plots are copied
 *   sensor  copied, but of a scan that goes on its pd alone; NULL: not described, at the origin
 *   fates   one a plot; a HELD plot beyond RHO_MAX_PLOTS, or of row 16384 and up, becomes NO_ROOM
 *   left_unused  counts the plots that leave the window without having started a track
 * Errors: NULL, VALUE (RHO_SECTORS: a sector that is none), STATE (not initialised, or the scan is older than the newest). Plots outside the area are kept in its
 * border bins. Cost: RHO_MAX_PLOTS copies, RHO_MAX_BINS additions; where the area is not given, three looks at all
 * plots held. Stack: 224 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_window_push(struct rho_window *window,
                                               const struct rho_scan *scan,
                                               const struct rho_sensor *sensor, uint8_t *fates,
                                               uint32_t *left_unused);

/* The scan of age order m, 0 (oldest) .. num_scans - 1 (newest); m is not checked. Constant cost. */
struct rho_window_scan *rho_window_scan_at(struct rho_window *window, unsigned m);

/*
 * Index of the plot nearest to the query's place, or -1 where none is in the gate. Ties go to the lower index.
 * Cost: bins under the gate's square, and their plots. Stack: 104 bytes.
 */
int rho_window_nearest(const struct rho_window_scan *scan, const struct rho_window_query *query,
                       struct rho_window_work *work);

/*
 * The same for a place with its own covariance: the plot with the least squared Mahalanobis distance, position plus
 * height plus range rate, within the gate of as many dimensions. Correlations of height and range rate with the
 * position are neglected. Cost: as above, 60 instructions a plot. Stack: 272 bytes.
 */
int rho_window_nearest_to(const struct rho_window_scan *scan, const struct rho_window_place *place,
                          struct rho_window_work *work);

/* A held plot's covariance, from its line of sight. Cost: a division, with z two more. */
struct rho_window_noise rho_window_noise(const struct rho_window_scan *scan,
                                         const struct rho_window_plot *plot);

/* A held plot's range rate, as a place's velocity would have it. */
struct rho_window_range_rate {
    float error_mps; /* measured minus expected, an ambiguous one the nearest */
    float variance;  /* of that */
    float along[3];  /* the line of sight: derivative by the velocity */
};

#if RHO_AMBIGUOUS_RANGE_RATES
/* Fills *seen; 0, and nothing is filled, for a plot in the sensor's place. Cost: 100 instructions. Stack: 160 bytes. */
int rho_window_see_range_rate(const struct rho_window_scan *scan,
                              const struct rho_window_plot *plot,
                              const struct rho_window_place *place,
                              struct rho_window_range_rate *seen);
#endif

/*
 * Squared distance of a held plot's range rate from what the place's velocity would show there, in units of its
 * variance. The line of sight is the plot's, whose own error turns the velocity. 0 for a plot in the sensor's place.
 * Cost: 100 instructions. Stack: 160 bytes.
 */
float rho_window_range_rate_distance2(const struct rho_window_scan *scan,
                                      const struct rho_window_plot *plot,
                                      const struct rho_window_place *place);

/* The held plot as it was pushed, but for its own velocity and snr, which are 0; sigmas are rounded to 2^-12 of
 * themselves, the offset to float32. Constant cost. */
struct rho_plot rho_window_plot_of(const struct rho_window_scan *scan, unsigned index);

/* The scan's sensor, or NULL where it was not described. */
const struct rho_sensor *rho_window_sensor(const struct rho_window_scan *scan);

/* A standard deviation as a window holds it: 5 bits of exponent and 11 of mantissa, 2^-12 relative error from
 * RHO_LIMIT_SIGMA_MIN to RHO_LIMIT_SIGMA_MAX; numbers of 12 significant bits are exact. Constant cost. */
float rho_window_sigma(uint16_t code);

/* One number for a held plot's noise: the larger of its sigmas along and across. Constant cost. */
float rho_window_sigma_m(const struct rho_window_plot *plot);

/*
 * Bins whose columns and rows touch [x0, x1] x [y0, y1]; outside the area, its border bins. first and last are both
 * included. Constant cost.
 */
struct rho_window_bins {
    int column_first, column_last, row_first, row_last;
};
struct rho_window_bins rho_window_bins_under(const struct rho_window_scan *scan, float x0_m,
                                             float x1_m, float y0_m, float y1_m);

/* Sides and content of an extent, at least side_min_m a side; 0 where it is empty and side_min_m is 0. */
float rho_extent_width_m(const struct rho_extent *extent, float side_min_m);
float rho_extent_height_m(const struct rho_extent *extent, float side_min_m);
float rho_extent_area_m2(const struct rho_extent *extent, float side_min_m);

/* Grows an extent to hold the point. Constant cost. */
void rho_extent_add(struct rho_extent *extent, float x_m, float y_m);

/*
 * True where the object may be worked with, wherever its bytes come from (a snapshot, memory that outlived a reset): counts and
 * places are within what they count, numbers within their limits. rho_snapshot_load asks it. Cost: all plots held. Stack: 150 bytes.
 */
int rho_window_is_sound(const struct rho_window *window);

#endif
