/* SPDX-License-Identifier: MIT */
/*
 * radar_capacities: capacities of a node for one radar (RHO_CONFIG_FILE): the embedded profile
 * without the features that one radar does not need. Library and node are compiled with it;
 * rhotrack/config.h gives the cost of each.
 */

/* Plots and polar plots, no bearings of passive sensors. */
#ifndef RHO_SCAN_KINDS
#define RHO_SCAN_KINDS 3
#endif

/* One scan is assembled at a time: scans of one radar do not interleave. */
#define RHO_MAX_OPEN_SCANS 1

/* Sensors: the one radar's sensor_id may change a few times. */
#ifndef RHO_MAX_SENSORS
#define RHO_MAX_SENSORS 4
#endif

/*
 * Only the hypothesis filter for plots (gate best); filters of other gates and of bearings are left
 * out.
 */
#define RHO_FILTERS 4

/* No merged plots of unresolved targets, to save flash. */
#define RHO_SHARES_PLOTS 0

/* No claims of plots beyond RHO_MAX_PLOTS: the scan assembler never makes larger scans. */
#define RHO_CLAIMS_BEYOND 0

/* No ambiguous range rates. */
#define RHO_AMBIGUOUS_RANGE_RATES 0

/* No reflectors that make mirror images. */
#ifndef RHO_MAX_REFLECTORS
#define RHO_MAX_REFLECTORS 0
#endif

/* No areas that an operator excludes. */
#ifndef RHO_MAX_EXCLUDED_AREAS
#define RHO_MAX_EXCLUDED_AREAS 0
#endif

/* No zones. */
#ifndef RHO_MAX_ZONES
#define RHO_MAX_ZONES 0
#endif

/* No Doppler notch; it would take 2.3 KB of flash. */
#ifndef RHO_DOPPLER_NOTCH
#define RHO_DOPPLER_NOTCH 0
#endif

/* No clutter map, to save flash. */
#define RHO_MAX_CLUTTER_CELLS 0

/* No sectors: each scan is a whole turn. */
#define RHO_SECTORS 0
