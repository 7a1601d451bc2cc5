/* SPDX-License-Identifier: MIT */
/*
 * types: scans, plots (also made of range and azimuth), bearings, sensors, outcomes of calls, and
 * the words that the library uses for them. Plain data, a unit in every field name.
 *
 * Conventions, everywhere in rhotrack:
 *   frame     local Cartesian, metres: x east, y north, z up
 *   angles    radians; bearing, azimuth and heading counter-clockwise from +x (east); elevation up
 *             from the horizontal
 *   times     int64_t microseconds of one clock, any epoch; differences in float seconds
 *   lines     rho = x cos(theta) + y sin(theta), rho signed, theta in [0, pi); (rho, theta) and
 *             (-rho, theta +- pi) are one line; its tracks head to theta + pi/2 or theta - pi/2
 *   scores    natural logarithms of likelihood ratios, as integer thousandths of a nat (mnat)
 *   outcomes  every call that can fail returns an enum rho_status. Zero is success; a call that
 *             returns anything else has left its object unchanged, byte for byte. Headers of
 *             detail/ take pointers that are not NULL where nothing else is said
 *
 * Words:
 *   plot                  one detection by a radar, as a place
 *   look                  one sensor's detections at one time: a scan, or a part of a large one
 *   scan                  plots or bearings of one sensor, of a sector or of the whole circle
 *   revolution, turn      one whole circle of a rotating antenna: one scan, or several sectors
 *   scan assembly         making scans of the messages that carry their parts
 *   reorder buffer        holds scans back until older ones have arrived
 *   out-of-sequence scan  a scan that arrives after a newer one was processed; code: late
 *   time alignment        bringing estimates to one common time
 *   coverage              the places where a sensor can look; its field of view
 *   clutter               plots that no target caused
 *   echo                  a place that returns clutter again and again: a tower, a quay, sea spikes
 *   clutter map           the table of echoes, and how often they come back
 *   NIS                   normalised innovation squared, a chi-square variable: the square of the
 *                         Mahalanobis distance
 *   gate                  the region about a prediction in which a plot may belong to a track: a
 *                         limit of the NIS
 *   track score           log-likelihood ratio of target against clutter
 *   false-track rate      tracks that clutter alone starts, per hour
 *   kernel                two plots of different scans: the straight track through them
 *   vote                  a plot of another scan in the gate of a kernel
 *   fate                  the use that a step made of a plot: claimed by a track, held, refused
 *   held plot             an unclaimed plot, kept for this search and later ones
 *   hypotheses            alternative histories of a track, with other plots
 *   steady, agile, calm   models of motion: constant velocity, random acceleration; a calm target
 *                         has kept its velocity for about a minute, and seldom manoeuvres
 *   established           a track of 16 hits or more; a sensor that has been heard for long
 *   newcomer              a sensor that has not been heard for long, beside established ones
 *   merged plot           one plot of several unresolved targets
 *   split plots           several plots of one target
 *   sensor health         estimated errors of a sensor; a suspect sensor contradicts the others,
 *                         its witnesses
 *   manoeuvre interval    mean time between manoeuvres of a target
 *   row, batch            a look of each passive sensor; successive rows. Frame: looks of one time
 *   ghost                 a crossing of bearings at which there is no target
 *   oracle                in experiments: an algorithm that is told the truth
 *
 * Constant cost where none is said.
 * Stack: 100 bytes at most where nothing else is said. In all headers: the deepest call on a
 * Cortex-M4F, gcc 12.2 -Os, embedded profile; tools/lab/MEASUREMENTS.md has others.
 */
#ifndef RHOTRACK_TYPES_H
#define RHOTRACK_TYPES_H

#include <float.h>
#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"

/* Marks functions whose result must be used: the compiler warns where it is not. */
#if defined(__GNUC__)
#define RHO_MUST_CHECK __attribute__((warn_unused_result))
#else
#define RHO_MUST_CHECK
#endif

RHO_BEGIN_C

/* The outcome of every call that can fail. */
enum rho_status {
    RHO_OK = 0,
    RHO_ERROR_NULL, /* a pointer that must point somewhere is NULL */
    /* sizeof(object) differs: library and caller were built with other capacities */
    RHO_ERROR_SIZE,
    RHO_ERROR_CONFIG,   /* a parameter of a configuration is outside its range */
    RHO_ERROR_VALUE,    /* a number of an input is not finite or outside its range */
    RHO_ERROR_CAPACITY, /* an input has more elements than a RHO_MAX_... of the build holds */
    RHO_ERROR_SINGULAR, /* a matrix that must be positive definite is not */
    RHO_ERROR_STATE,    /* the object was never initialised, or does not have the thing asked for */
    /* errors of decoding a message: */
    RHO_ERROR_SHORT,    /* the bytes end too early */
    RHO_ERROR_TYPE,     /* the fingerprint differs: another message, or another version of it */
    RHO_ERROR_COUNT,    /* the count of a list is negative, or more than the message may hold */
    RHO_ERROR_TRAILING, /* bytes follow the end of the message */
    RHO_NUM_STATUS      /* number of outcomes, not an outcome */
};

/* Name of an outcome for logs ("ok", "null", ...); "unknown" for any other value. No stack. */
const char *rho_status_name(enum rho_status status);

/* Limits of inputs. Plots beyond them get the fate INVALID; parameters beyond them are refused. */
#define RHO_LIMIT_POSITION_M 2.0e6f
#define RHO_LIMIT_SPEED_MPS 2.0e4f
#define RHO_LIMIT_SIGMA_MIN 1.0e-3f
#define RHO_LIMIT_SIGMA_MAX 1.0e5f
#define RHO_LIMIT_SIGMA_RAD_MIN 1.0e-6f /* standard deviation of an angle */
#define RHO_LIMIT_SIGMA_RAD_MAX 0.5f
#define RHO_LIMIT_WORK 100000000 /* limit of the work of a step, units */
#define RHO_LIMIT_BIAS_M 1.0e4f  /* bias of a sensor, either way */
#define RHO_LIMIT_BIAS_RAD 0.5f
#define RHO_LIMIT_BIAS_S 10.0f
#define RHO_LIMIT_SPAN_MIN_MPS 1.0f /* span of ambiguous range rates */
#define RHO_LIMIT_SPAN_MAX_MPS (2.0f * RHO_LIMIT_SPEED_MPS)
#define RHO_LIMIT_OFFSET_US 60000000 /* time of a plot before or after its scan's */
/* Times either side of 0; their differences fit 64 bits. */
#define RHO_LIMIT_TIME_US INT64_C(4000000000000000000)

/* Quantities that plots of a scan measure besides x_m and y_m; values to be or-ed. */
#define RHO_MEASURES_Z 1u
#define RHO_MEASURES_VELOCITY 2u
#define RHO_MEASURES_RANGE_RATE 4u

/*
 * One plot: a detection by a radar or any other sensor that measures positions.
 *
 * Its noise has the axes of the sensor's line of sight (sensor to plot): along it, across it in the
 * horizontal plane, and upwards at right angles to both. Equal values are isotropic noise. Fields
 * that the scan does not measure are ignored and may hold anything.
 */
struct rho_plot {
    int32_t offset_us; /* time of this plot after the scan's time: a rotating antenna's delay */
    float x_m, y_m, z_m;
    float vx_mps, vy_mps, vz_mps;
    /* positive: receding. Ambiguous where the sensor's range_rate_span_mps is not 0 */
    float range_rate_mps;
    float sigma_range_m, sigma_cross_m, sigma_up_m;
    float sigma_mps; /* standard deviation of each velocity component */
    float sigma_range_rate_mps;
    float snr_db; /* signal-to-noise ratio, 0 where unknown; passed on, not used */
};

/*
 * One plot as a radar measures it; rho_measurement_from_polar makes a rho_plot of it. Fields that
 * the scan does not measure are ignored and may hold anything.
 */
struct rho_polar_plot {
    int32_t offset_us;   /* time of this plot after the scan's time: a rotating antenna's delay */
    float range_m;       /* slant range; without elevation it is taken as ground range */
    float azimuth_rad;   /* counter-clockwise from +x, -pi .. pi */
    float elevation_rad; /* with RHO_MEASURES_Z: up from the horizontal, -pi/2 .. pi/2 */
    float range_rate_mps;
    float sigma_range_m, sigma_azimuth_rad, sigma_elevation_rad, sigma_range_rate_mps;
    float snr_db;
};

/* One scan of one sensor, a revolution or a sector. The plots are the caller's, and only read. */
struct rho_scan {
    int64_t time_us;
    int32_t sensor_id;
    uint32_t measures; /* quantities measured besides x_m and y_m: RHO_MEASURES_... or-ed */
    /* covered sector, counter-clockwise from .. to; equal: the whole circle */
    float sector_from_rad, sector_to_rad;
    uint32_t num_plots;
    const struct rho_plot *plots; /* num_plots plots; may be NULL for 0 */
};

/* One bearing of a sensor that measures no range; with an elevation it is a direction in space. */
struct rho_bearing {
    int32_t offset_us; /* time of this bearing after the scan's time */
    float bearing_rad; /* from the sensor to the target, -pi .. pi */
    float sigma_rad;   /* standard deviation, RHO_LIMIT_SIGMA_RAD_MIN .. RHO_LIMIT_SIGMA_RAD_MAX */
    float snr_db;      /* signal-to-noise ratio, 0 where unknown; passed on, not used */
    float elevation_rad;       /* up from the horizontal, -pi/2 .. pi/2 */
    float sigma_elevation_rad; /* standard deviation, as sigma_rad; 0: no elevation is measured */
};

/* One scan of one passive sensor. The bearings belong to the caller and are only read. */
struct rho_bearing_scan {
    int64_t time_us;
    int32_t sensor_id;
    float x_m, y_m; /* position of the sensor at this look */
    float z_m;      /* its height, for elevations */
    /* covered sector, counter-clockwise from .. to; equal: the whole circle */
    float sector_from_rad, sector_to_rad;
    uint32_t num_bearings;
    const struct rho_bearing *bearings; /* num_bearings bearings; may be NULL for 0 */
};

/* Scans of several passive sensors at one time. */
struct rho_frame {
    int64_t time_us;
    uint32_t num_scans;
    const struct rho_bearing_scan *scans; /* num_scans scans, one a sensor at most */
};

/* A sensor. One without a description has the tracker's defaults and covers every place. */
struct rho_sensor {
    int32_t sensor_id;
    float x_m, y_m, z_m;
    /* probability that a target in the coverage yields a plot, 0 < pd < 1 */
    float pd;
    /* range limits: plots over 4 sigma outside are INVALID, targets neither seen nor missed */
    float range_min_m; /* 0: no lower limit */
    float range_max_m;
    /* azimuths of the coverage; equal: the whole circle */
    float sector_from_rad, sector_to_rad;
    /*
     * Biases: measured minus true. rho_measurement_from_polar subtracts them; a positive time bias
     * means that plots are older than reported. The scan assembler subtracts it from the time of
     * the scan, so that scans are in order. Callers that make scans themselves should do the same.
     */
    float range_bias_m, azimuth_bias_rad, time_bias_s;
    /*
     * per cent of the plots' sigmas that count, along the line of sight and across it; 0 counts as
     * 100. The tracker overwrites both by the noise that it has learned, and by sensor health. A
     * build without RHO_SIGMAS_VARY does not read them
     */
    uint16_t sigma_range_percent, sigma_cross_percent;
    /*
     * ambiguity span: range rates are known up to multiples of it, within +-span/2 or anywhere. 0:
     * they are not ambiguous, the only value that a build without RHO_AMBIGUOUS_RANGE_RATES accepts
     */
    float range_rate_span_mps;
    /*
     * blind range rates of a clutter filter: a target whose range rate over ground is within
     * notch_mps of 0, or of a multiple of blind_speed_mps, is not seen, and its misses there say
     * little. blind_speed_mps is more than twice notch_mps, or 0: only the notch at 0. notch_mps 0:
     * no blind range rates. A build without RHO_DOPPLER_NOTCH does not read them
     */
    float notch_mps, blind_speed_mps;
    /*
     * resolution cell of the sensor: two targets nearer to each other than this in range, azimuth
     * and range rate give one plot. Range and azimuth resolution are learned where they are 0 (gate
     * best); with 0 the range rate does not tell targets apart. A build without RHO_SHARES_PLOTS
     * does not read them
     */
    float resolution_range_m, resolution_azimuth_rad, resolution_range_rate_mps;
};

/* The use that a step made of an input: every plot or bearing gets exactly one fate. */
enum rho_fate {
    RHO_FATE_CLAIMED = 0, /* updated a track */
    RHO_FATE_HELD,        /* kept for initiation; may start a track now or later */
    /*
     * a bearing whose crossings are all false; kept, as the other sensors may have missed its
     * target. Or a plot that starts no track: where a wall would show the image of a track
     * (reflectors.h), or in an excluded area (operator.h)
     */
    RHO_FATE_GHOST,
    RHO_FATE_STALE, /* its scan is older than the scans that were already processed */
    /* not finite, or outside the RHO_LIMIT_..., or the range limits or the sector of its sensor */
    RHO_FATE_INVALID,
    RHO_FATE_NO_ROOM, /* beyond a capacity of the build */
    RHO_NUM_FATES     /* number of fates, not a fate */
};

/* Name of a fate in lower case ("claimed", ...); "unknown" for any other value. No stack. */
const char *rho_fate_name(enum rho_fate fate);

/* The larger of a plot's horizontal sigmas, where one number must do for its noise. */
float rho_plot_sigma_m(const struct rho_plot *plot);

/*
 * Converts a polar plot: the sensor's biases are subtracted (range, azimuth, time), the place is
 * converted without bias, and the noise of the angles becomes metres across the line of sight.
 *   measures  RHO_MEASURES_Z: the elevation counts; RHO_MEASURES_RANGE_RATE: the range rate counts
 *   sensor    NULL: at the origin, without biases
 *   plot      offset, place, range rate, snr and sigmas are filled, the rest is 0
 * The mean of r cos(a + noise) is r cos(a) exp(-sigma^2 / 2): the converted place falls short of
 * the true one by r sigma^2 / 2 along the line of sight, and is moved out again. The noise of the
 * angles also spreads the place along the line of sight, with the variance r^2 sigma^4 / 2, which
 * sigma_range_m gets. Errors: NULL, VALUE (range not in 0 .. RHO_LIMIT_POSITION_M, exclusive of 0,
 * azimuth beyond +-pi, elevation beyond +-pi/2, a sigma outside its limits, range rate beyond
 * RHO_LIMIT_SPEED_MPS, the place or offset beyond its limit, also once the biases are off; any of
 * it not finite); *plot is unchanged. Cost: two sines and cosines. Stack: 220 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_measurement_from_polar(const struct rho_polar_plot *polar,
                                                          uint32_t measures,
                                                          const struct rho_sensor *sensor,
                                                          struct rho_plot *plot);

/* The sum of a counter and n; saturates at UINT32_MAX, as every counter of the library does. */
static inline uint32_t rho_count(uint32_t counter, uint32_t n)
{
    uint32_t sum = counter + n;
    return sum < n ? UINT32_MAX : sum;
}

/* Number of bits that are set in a mask of scans. */
unsigned rho_count_bits(uint32_t mask);

/* Seconds from from_us to to_us, any times: rounded once up to 2^24 us, beyond within 1.2e-7. */
float rho_seconds_between(int64_t from_us, int64_t to_us);

/* Microseconds from then_us to now_us, any two times; 0 where then_us is not before now_us. */
uint64_t rho_elapsed_us(int64_t now_us, int64_t then_us);

/* True where v is finite and lo <= v <= hi; false for NaN. */
int rho_is_within(float v, float lo, float hi);

/* Neither infinite nor NaN. No stack. Where rarely called, rho_are_finite(&v, 1) is smaller. */
static inline int rho_is_finite(float v)
{
    return v >= -FLT_MAX && v <= FLT_MAX;
}

/* True where all `count` values are finite. */
int rho_are_finite(const float *values, size_t count);
/* The same of values within lo and hi. */
int rho_are_within(const float *values, size_t count, float lo, float hi);

/* True where an object may hold a time: within RHO_LIMIT_TIME_US and a plot's offset. */
int rho_is_stored_time(int64_t time_us);

/* True where a coordinate is finite and within RHO_LIMIT_POSITION_M either way. */
int rho_is_coordinate(float v_m);

RHO_END_C

#endif
