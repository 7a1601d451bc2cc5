/* SPDX-License-Identifier: MIT */
/*
 * radar_capacities: the embedded profile but for what one radar does not need (RHO_CONFIG_FILE;
 * rhotrack/config.h says what each costs). Library and node are compiled with it.
 */

/* Plots and polar plots: passive sensors are none of this. */
#define RHO_SCAN_KINDS 3

/* One radar: no scans of others come in between, one is assembled at a time. */
#define RHO_MAX_OPEN_SCANS 1

/* Its identity may change a few times. */
#ifndef RHO_MAX_SENSORS
#define RHO_MAX_SENSORS 4
#endif

/*
 * Tracks of plots by hypotheses alone: the gate best. The filters of the others, and of bearings,
 * are left out.
 */
#define RHO_FILTERS 4

/* No plots of two targets: the flash is full. */
#define RHO_SHARES_PLOTS 0

/* The scan assembler's scans are never larger. */
#define RHO_CLAIMS_BEYOND 0

/* Its range rates, if it has any, are not ambiguous. */
#define RHO_AMBIGUOUS_RANGE_RATES 0

/* No walls before it. */
#ifndef RHO_MAX_REFLECTORS
#define RHO_MAX_REFLECTORS 0
#endif

/* No operator. */
#ifndef RHO_MAX_EXCLUDED_AREAS
#define RHO_MAX_EXCLUDED_AREAS 0
#endif

/* It sees targets at all range rates: 2.3 KB of flash. */
#ifndef RHO_DOPPLER_NOTCH
#define RHO_DOPPLER_NOTCH 0
#endif

/* Nor a memory of clutter, for the same reason. */
#define RHO_MAX_CLUTTER_CELLS 0

/* Its scans are whole turns. */
#define RHO_SECTORS 0
