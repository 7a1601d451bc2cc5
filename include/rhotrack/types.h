/* SPDX-License-Identifier: MIT */
/*
 * types: what sensors say and what the library says of it. Plain data, a unit in every field name.
 *
 * Conventions, everywhere in rhotrack:
 *   frame     local Cartesian, metres: x east, y north, z up
 *   angles    radians; bearing, azimuth and heading counter-clockwise from +x (east); elevation up from the horizontal
 *   times     int64_t microseconds of one clock, any epoch; differences in float seconds
 *   lines     rho = x cos(theta) + y sin(theta), rho signed, theta in [0, pi); (rho, theta) and (-rho, theta +- pi)
 *             are one line; a track on it heads for theta + pi/2 or theta - pi/2
 *   scores    natural logarithms of likelihood ratios, as integer thousandths of a nat (mnat)
 *
 * Stack: 100 bytes at most where nothing else is said. All headers: a call with everything it calls, at most, on a Cortex-M4F,
 * gcc 12.2 -Os, embedded profile; src/SIZES.md has other processors.
 */
#ifndef RHOTRACK_TYPES_H
#define RHOTRACK_TYPES_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"

/* Limits of what is believed. Inputs beyond them get the fate INVALID; parameters beyond them are refused. */
#define RHO_LIMIT_POSITION_M 2.0e6f
#define RHO_LIMIT_SPEED_MPS 2.0e4f
#define RHO_LIMIT_SIGMA_MIN 1.0e-3f
#define RHO_LIMIT_SIGMA_MAX 1.0e5f
#define RHO_LIMIT_SIGMA_RAD_MIN 1.0e-6f /* of an angle */
#define RHO_LIMIT_SIGMA_RAD_MAX 0.5f
#define RHO_LIMIT_WORK 100000000 /* of a step, units */
#define RHO_LIMIT_BIAS_M 1.0e4f  /* of a sensor, either way */
#define RHO_LIMIT_BIAS_RAD 0.5f
#define RHO_LIMIT_BIAS_S 10.0f
#define RHO_LIMIT_SPAN_MIN_MPS 1.0f /* of ambiguous range rates */
#define RHO_LIMIT_SPAN_MAX_MPS (2.0f * RHO_LIMIT_SPEED_MPS)
#define RHO_LIMIT_OFFSET_US 60000000 /* a plot's own time from its scan's */
/* either side of 0; differences then fit 64 bits */
#define RHO_LIMIT_TIME_US INT64_C(4000000000000000000)

/* What the plots of a scan measure beside x_m and y_m; values to be or-ed. */
#define RHO_MEASURES_Z 1u
#define RHO_MEASURES_VELOCITY 2u
#define RHO_MEASURES_RANGE_RATE 4u

/*
 * One plot: a detection by a radar or any other sensor that measures positions.
 *
 * Its noise has the axes of the sensor's line of sight (sensor to plot): along it, across it in the horizontal plane,
 * and upwards at right angles to both. Equal values are isotropic noise. Fields that the scan does not measure are
 * ignored and may hold anything.
 */
struct rho_plot {
    int32_t offset_us; /* time of this plot after the scan's time: a rotating antenna's delay */
    float x_m, y_m, z_m;
    float vx_mps, vy_mps, vz_mps;
    float range_rate_mps; /* positive: receding; its sensor's span says whether it is ambiguous */
    float sigma_range_m, sigma_cross_m, sigma_up_m;
    float sigma_mps; /* of each velocity component */
    float sigma_range_rate_mps;
    float snr_db; /* 0 where unknown; passed on, not used */
};

/*
 * One plot as a radar measures it; rho_measurement_from_polar makes a rho_plot of it. Fields that the scan does not
 * measure are ignored and may hold anything.
 */
struct rho_polar_plot {
    int32_t offset_us;   /* as above */
    float range_m;       /* slant range; without elevation it is taken as ground range */
    float azimuth_rad;   /* counter-clockwise from +x, -pi .. pi */
    float elevation_rad; /* with RHO_MEASURES_Z: up from the horizontal, -pi/2 .. pi/2 */
    float range_rate_mps;
    float sigma_range_m, sigma_azimuth_rad, sigma_elevation_rad, sigma_range_rate_mps;
    float snr_db;
};

/* One look of one sensor: a whole turn, or a sector of it. The plots stay the caller's and are only read. */
struct rho_scan {
    int64_t time_us;
    int32_t sensor_id;
    uint32_t measures; /* RHO_MEASURES_... */
    /* counter-clockwise from .. to; equal: the whole circle */
    float sector_from_rad, sector_to_rad;
    uint32_t num_plots;
    const struct rho_plot *plots; /* num_plots of them; may be NULL for 0 */
};

/* One bearing of a sensor that measures nothing else. */
struct rho_bearing {
    int32_t offset_us; /* time of this bearing after the scan's time */
    float bearing_rad; /* from the sensor to the target, -pi .. pi */
    float sigma_rad;   /* RHO_LIMIT_SIGMA_RAD_MIN .. RHO_LIMIT_SIGMA_RAD_MAX */
    float snr_db;      /* 0 where unknown; passed on, not used */
};

/* One look of one passive sensor. The bearings stay the caller's and are only read. */
struct rho_bearing_scan {
    int64_t time_us;
    int32_t sensor_id;
    float x_m, y_m; /* the sensor's place, the same at every look */
    /* counter-clockwise from .. to; equal: the whole circle */
    float sector_from_rad, sector_to_rad;
    uint32_t num_bearings;
    const struct rho_bearing *bearings; /* num_bearings of them; may be NULL for 0 */
};

/* Looks of several passive sensors at one time. */
struct rho_frame {
    int64_t time_us;
    uint32_t num_scans;
    const struct rho_bearing_scan *scans; /* one a sensor at most */
};

/* What is known of a sensor. Scans of a sensor that was never described use the tracker's defaults: it may see any place. */
struct rho_sensor {
    int32_t sensor_id;
    float x_m, y_m, z_m;
    /* probability that a target in the sensor's reach yields a plot, 0 < pd < 1 */
    float pd;
    /* plots farther than 4 standard deviations outside of these are INVALID, targets there neither seen nor missed */
    float range_min_m; /* 0: none */
    float range_max_m;
    /* where the sensor can look at all; equal: the whole circle */
    float sector_from_rad, sector_to_rad;
    /* what it measures too much of, taken off by rho_measurement_from_polar; time: plots are so much older than said. Feeds take
     * it off the scan's time, so that scans are in the right order; who makes scans without a feed should do so too */
    float range_bias_m, azimuth_bias_rad, time_bias_s;
    /*
     * how many hundredths of the sigmas of its plots' places count, along the line of sight and
     * across it; 0: all, as 100. The tracker sets both, whatever the caller does: by the noise that
     * it has learned, and of a sensor that it doubts
     */
    uint16_t sigma_range_percent, sigma_cross_percent;
#if RHO_AMBIGUOUS_RANGE_RATES
    /* range rates are known up to multiples of this, within +-span/2 or anywhere; 0: they are not ambiguous */
    float range_rate_span_mps;
#endif
};

/*
 * What became of an input at the step that took it: exactly one of these. The fates of a scan add up to its plots.
 */
enum rho_fate {
    RHO_FATE_CLAIMED = 0, /* updated a track */
    RHO_FATE_HELD,        /* kept for initiation; may start a track now or later */
    RHO_FATE_GHOST, /* a bearing whose crossings are all false; kept all the same, for it may be a target's
                             that the other sensors missed */
    RHO_FATE_STALE, /* its scan is older than what was already stepped */
    RHO_FATE_INVALID, /* not finite, outside the limits above, or of its sensor's range limits or sector */
    RHO_FATE_NO_ROOM, /* beyond a capacity */
    RHO_NUM_FATES     /* count of the values above, not a fate */
};

/* Name of a fate in lower case ("claimed", ...); "unknown" for any other value. Constant cost, no stack. */
const char *rho_fate_name(enum rho_fate fate);

/* One number for a plot's noise: the larger of its horizontal sigmas. Constant cost. */
float rho_plot_sigma_m(const struct rho_plot *plot);

/* a + n that stops at UINT32_MAX: every counter of the library moves this way. Constant cost. */
static inline uint32_t rho_count(uint32_t counter, uint32_t n)
{
    uint32_t sum = counter + n;
    return sum < n ? UINT32_MAX : sum;
}

/* Bits that are set in a mask of scans. */
unsigned rho_count_bits(uint32_t mask);

/* Seconds from one time to another, any two: rounded once for spans to 2^24 us, relative error 1.2e-7 beyond. */
float rho_seconds_between(int64_t from_us, int64_t to_us);

/* Microseconds that have gone by since then, any two times; 0 where then is not before now. */
uint64_t rho_elapsed_us(int64_t now_us, int64_t then_us);

/* True where v is finite and lo <= v <= hi; false for NaN. */
int rho_is_within(float v, float lo, float hi);

/* True where `count` numbers are finite. */
int rho_are_finite(const float *values, size_t count);

/* True of what an object can hold as a time: within RHO_LIMIT_TIME_US either way, and some own times of plots beyond. */
int rho_is_stored_time(int64_t time_us);

/* True where a coordinate is finite and within RHO_LIMIT_POSITION_M either way. */
int rho_is_coordinate(float v_m);

#endif
