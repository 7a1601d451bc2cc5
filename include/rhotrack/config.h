/* SPDX-License-Identifier: MIT */
/*
 * config: the capacities that fix the size of every object, and their costs.
 *
 * Ten of them decide nearly all: they stand first, and few firmwares set others. Then come further
 * capacities, code that can be left out, passive sensors, and the papers' methods.
 *
 *     make budget RHO_CONFIG_FILE=my_config.h
 *
 * compiles the library with a file of capacities and says what it takes of flash and RAM, the
 * largest parts by name, for a Cortex-M4F or with CROSS= and CFLAGS= for another processor.
 *
 * Two profiles give the defaults: embedded (the default; a Cortex-M4F with 256 KiB of RAM) and
 * workstation (-DRHO_PROFILE_WORKSTATION; the command-line tools). Single capacities are overridden
 * with -D, or all in one file named by -DRHO_CONFIG_FILE='"my_config.h"', which is included first.
 * Library and application must be built with the same values: every init takes sizeof(object) and
 * refuses a mismatch (RHO_ERROR_SIZE).
 */
#ifndef RHOTRACK_CONFIG_H
#define RHOTRACK_CONFIG_H

#ifdef RHO_CONFIG_FILE
#include RHO_CONFIG_FILE
#endif

/* Declarations between these two are C's in C++, too. */
#ifdef __cplusplus
#define RHO_BEGIN_C extern "C" {
#define RHO_END_C }
#else
#define RHO_BEGIN_C
#define RHO_END_C
#endif

#ifdef RHO_PROFILE_WORKSTATION
#define RHO_CONFIG_PICK(embedded, workstation) (workstation)
#else
#define RHO_CONFIG_PICK(embedded, workstation) (embedded)
#endif

/*
 * ---- The ten that matter first ----
 *
 *                        embedded  workstation  one more takes, bytes of RAM, embedded profile
 *   RHO_MAX_PLOTS              256        10000  390: 35 a scan of the window, 56 an open scan
 *   RHO_MAX_TRACKS              32         2000  810
 *   RHO_MAX_HYPOTHESES          96         6000  410
 *   RHO_MAX_SCANS                7           12  9400: 35 a plot
 *   RHO_MAX_SENSORS              8           64  570
 *   RHO_MAX_ECHOES             128         8192  64; 0 saves 15 KB, and 10 KB of flash
 *   RHO_MAX_OPEN_SCANS           2           16  14600: 56 a plot; of messages alone
 *   RHO_WORK_MAX            500000      8000000  none: it bounds the time of a step
 *   RHO_FILTERS                  7            7  none; one filter saves 9 KB of flash or more
 *   RHO_SECTORS                  1            1  0 saves 5 KB of flash
 */

/*
 * Plots of one scan that are gated, and held for initiation; the rest get the fate NO_ROOM. With
 * RHO_SECTORS the limit of held plots is for a revolution: its sectors are one scan of the window.
 * RAM: linear. 1 .. 16383.
 */
#ifndef RHO_MAX_PLOTS
#define RHO_MAX_PLOTS RHO_CONFIG_PICK(256, 10000)
#endif

/* Tracks at a time; of more, the tentative one of the lowest score is dropped. 1 .. 8192. */
#ifndef RHO_MAX_TRACKS
#define RHO_MAX_TRACKS RHO_CONFIG_PICK(32, 2000)
#endif

/*
 * Hypotheses of all tracks together, up to eight a track: a straight track without clutter needs
 * one, a manoeuvring track in clutter eight. More than RHO_MAX_TRACKS where the tracker's gate is
 * `best`; 1 where it never is. RAM: 410 bytes each. 1 .. 65534.
 */
#ifndef RHO_MAX_HYPOTHESES
#define RHO_MAX_HYPOTHESES RHO_CONFIG_PICK(96, 6000)
#endif

/* Scans in the initiation window: more find tracks in denser clutter, later. 3 .. 12. */
#ifndef RHO_MAX_SCANS
#define RHO_MAX_SCANS RHO_CONFIG_PICK(7, 12)
#endif

/* Sensors in the tracker's table. 1 .. 256. */
#ifndef RHO_MAX_SENSORS
#define RHO_MAX_SENSORS RHO_CONFIG_PICK(8, 64)
#endif

/*
 * Echoes in the clutter map (rhotrack/detail/recurring_clutter_map.h), of all sensors together. 0
 * leaves the map out of the program. RAM: 64 bytes each. 0 .. 32767.
 */
#ifndef RHO_MAX_ECHOES
#define RHO_MAX_ECHOES RHO_CONFIG_PICK(128, 8192)
#endif

/*
 * Scans that are assembled, or wait in the reorder buffer. With 1, parts of two sensors' scans that
 * arrive interleaved displace each other. RAM: 56 bytes a plot of RHO_MAX_PLOTS. 1 .. 64.
 */
#ifndef RHO_MAX_OPEN_SCANS
#define RHO_MAX_OPEN_SCANS RHO_CONFIG_PICK(2, 16)
#endif

/* Default of work_max of the configs of tracker, initiator and passive search: units a step. */
#ifndef RHO_WORK_MAX
#define RHO_WORK_MAX RHO_CONFIG_PICK(500000, 8000000)
#endif

/*
 * Filters that tracks can have, a bit each, 1 << enum rho_track_filter: 1 a plain Kalman filter, 2
 * input estimation with its gate hough, 4 hypotheses. Code of the other filters is left out of the
 * program: a radar with the gate best needs 4 alone (10 KB less on a Cortex-M4), one with the gate
 * nearest 1. Configurations that ask for another filter are refused (CONFIG). RAM does not change:
 * without 4, set RHO_MAX_HYPOTHESES to 1. Default: all. 1 .. 7.
 */
#ifndef RHO_FILTERS
#define RHO_FILTERS 7
#endif

/*
 * 1: sectors and several radars. Successive sectors are one scan of the initiation window, and a
 * target between two sectors is seen once a revolution; out-of-sequence scans update tracks; sensor
 * health finds the sensor that contradicts the others. 0: left out of the program (5 KB less on a
 * Cortex-M4), every scan is a look of its own. RAM: 52 bytes a sensor.
 */
#ifndef RHO_SECTORS
#define RHO_SECTORS 1
#endif

/* Further capacities of trackers. */

/* Bins of a scan's look-up; more save tests. RAM: 2 bytes a bin and scan. 1 .. 32767. */
#ifndef RHO_MAX_BINS
#define RHO_MAX_BINS RHO_CONFIG_PICK(RHO_MAX_PLOTS < 14563 ? RHO_MAX_PLOTS * 9 / 4 : 32767, 16384)
#endif

/* Candidate tracks that a search keeps for the selection; the lowest give way. 1 .. 4096. */
#ifndef RHO_MAX_CANDIDATES
#define RHO_MAX_CANDIDATES RHO_CONFIG_PICK(32, 2048)
#endif

/* Plots in one track's gate that compete in the assignment; the nearest are kept. 1 .. 32. */
#ifndef RHO_MAX_GATE_PLOTS
#define RHO_MAX_GATE_PLOTS RHO_CONFIG_PICK(8, 16)
#endif

/*
 * Strips that the plots of a scan are sorted into, so that a track is compared with near plots
 * alone: of use from a million of tracks times plots. 1: no sorting. RAM: 2 bytes each, and 2 a
 * plot. 1 .. 16384.
 */
#ifndef RHO_PLOT_STRIPS
#define RHO_PLOT_STRIPS RHO_CONFIG_PICK(1, 1024)
#endif

/* Cells along each side of a clutter density map. RAM: 2 bytes a cell and map. 1 .. 64. */
#ifndef RHO_MAX_DENSITY_CELLS
#define RHO_MAX_DENSITY_CELLS RHO_CONFIG_PICK(8, 32)
#endif

/* Clutter density maps of an initiator: one a radar of its window, at most. 1 .. 8. */
#ifndef RHO_MAX_DENSITY_MAPS
#define RHO_MAX_DENSITY_MAPS RHO_CONFIG_PICK(1, 2)
#endif

/* Side of the map of a hundred scans' clutter, cells; 0: none. RAM: 2 bytes a cell. 0 .. 1024. */
#ifndef RHO_MAX_CLUTTER_CELLS
#define RHO_MAX_CLUTTER_CELLS RHO_CONFIG_PICK(16, 256)
#endif

/*
 * Regions of range, and as many of azimuth, of the echoes' return rate. RAM: 480 bytes a region, of
 * which there are RHO_ECHO_REGIONS squared. 1 .. 15.
 */
#ifndef RHO_ECHO_REGIONS
#define RHO_ECHO_REGIONS RHO_CONFIG_PICK(2, 8)
#endif

/* Directions of jamming strobes: a strobe is at least one wide. RAM: 3 bytes each. 8 .. 4096. */
#ifndef RHO_STROBE_BINS
#define RHO_STROBE_BINS RHO_CONFIG_PICK(360, 720)
#endif

/* Walls that reflect (reflectors.h); 0 saves 1.8 KB on a Cortex-M4. RAM: 16 bytes each. 0 .. 64. */
#ifndef RHO_MAX_REFLECTORS
#define RHO_MAX_REFLECTORS RHO_CONFIG_PICK(4, 16)
#endif

/* Areas that an operator can exclude; 0: none, nor frozen tracks. RAM: 16 bytes each. 0 .. 64. */
#ifndef RHO_MAX_EXCLUDED_AREAS
#define RHO_MAX_EXCLUDED_AREAS RHO_CONFIG_PICK(4, 16)
#endif

/* Zones (zones.h). 0 leaves them out of a node. RAM: 8 bytes a zone and track. 0 .. 30. */
#ifndef RHO_MAX_ZONES
#define RHO_MAX_ZONES RHO_CONFIG_PICK(16, 30)
#endif

/*
 * Initiation windows of a node (rhotrack/node.h): one a radar, or a pair of radars; the last one is
 * shared by all radars that come later. A node holds the first, the others are in storage that the
 * caller gives. RAM: 12 bytes each; above 1 also 57 a plot. 1 .. 1024.
 */
#ifndef RHO_MAX_WINDOWS
#define RHO_MAX_WINDOWS RHO_CONFIG_PICK(1, 257)
#endif

/* Operator's commands and settings that wait in a node. RAM: 230 bytes each; 0: none. 0 .. 255. */
#ifndef RHO_MAX_COMMANDS
#define RHO_MAX_COMMANDS RHO_CONFIG_PICK(0, 16)
#endif

/* Messages that a scan may be spread over. RAM: 2 bytes a part and open scan. 1 .. 32767. */
#ifndef RHO_MAX_PARTS
#define RHO_MAX_PARTS RHO_CONFIG_PICK(16, 512)
#endif

/* Code that can be left out. */

/*
 * 1: tracks start by the library's searches, rho_initiator and rho_passive. 0: left out of the
 * program (25 KB less on a Cortex-M4), a tracker that is given one refuses it (CONFIG), and the
 * caller starts tracks: by paper_starts.h, or its own.
 */
#ifndef RHO_SEARCHES
#define RHO_SEARCHES 1
#endif

/* 1: a node can start tracks by paper_starts.h; embedded default: where RHO_SEARCHES is 0. */
#ifndef RHO_PAPERS
#define RHO_PAPERS RHO_CONFIG_PICK(!(RHO_SEARCHES), 1)
#endif

/* 1: a node can learn walls; needs RHO_MAX_REFLECTORS. 0: left out (5.5 KB on a Cortex-M4). */
#ifndef RHO_LEARNS_REFLECTORS
#define RHO_LEARNS_REFLECTORS RHO_CONFIG_PICK(0, RHO_MAX_REFLECTORS > 0)
#endif

/*
 * Kinds of scans that are accepted, a bit each, 1 << enum rho_scan_assembler_kind: 1 plots, 2 polar
 * plots, 4 bearings. Code of the other kinds is left out of the program (with 2 alone 3.8 KB less
 * on a Cortex-M4): rho_scan_assembler refuses their messages (TYPE), and without 1 the initiator
 * has no faster search for plots whose noise has one axis. Default: all. 1 .. 7.
 */
#ifndef RHO_SCAN_KINDS
#define RHO_SCAN_KINDS 7
#endif

/*
 * 1: the arithmetic of Kalman filters is straight code, and skips axes that are not coupled. 0:
 * loops with the same results but for a zero's sign (1.2 KB less on a Cortex-M4 with filter 1).
 */
#ifndef RHO_FAST_UPDATES
#define RHO_FAST_UPDATES 1
#endif

/* 1: two tracks share the merged plot of unresolved targets. 0: left out (1 KB on a Cortex-M4). */
#ifndef RHO_SHARES_PLOTS
#define RHO_SHARES_PLOTS 1
#endif

/*
 * 1: tracks may claim plots of a scan beyond the first RHO_MAX_PLOTS, up to four times as many. 0:
 * left out (400 bytes less on a Cortex-M4). rho_scan_assembler never makes such scans.
 */
#ifndef RHO_CLAIMS_BEYOND
#define RHO_CLAIMS_BEYOND 1
#endif

/* 1: range rates may be ambiguous. 0: left out (1.5 KB on a Cortex-M4), and spans are refused. */
#ifndef RHO_AMBIGUOUS_RANGE_RATES
#define RHO_AMBIGUOUS_RANGE_RATES 1
#endif

/* 1: sensors may be blind at some range rates, and who rests. 0: left out (2.4 KB, Cortex-M4). */
#ifndef RHO_DOPPLER_NOTCH
#define RHO_DOPPLER_NOTCH 1
#endif

/* 1: what each track's gate offered is kept for rho_tracker_evidence_of. 0: left out. */
#ifndef RHO_KEEPS_OFFERS
#define RHO_KEEPS_OFFERS RHO_CONFIG_PICK(0, 1)
#endif

/* 1: targets may give several plots a scan (body.h). RAM: 70 bytes a plot, 76 a track. */
#ifndef RHO_BODIES
#define RHO_BODIES RHO_CONFIG_PICK(0, 1)
#endif
/* Numbers of plots and tracks for which objects have room in groups and bodies. */
#define RHO_BODY_PLOTS (RHO_BODIES ? RHO_MAX_PLOTS : 1)
#define RHO_BODY_TRACKS (RHO_BODIES ? RHO_MAX_TRACKS : 1)

/* 1: plots' sigmas are scaled, by the noise learned of a sensor, or by sensor health. */
#define RHO_SIGMAS_VARY ((RHO_SECTORS) || ((RHO_FILTERS)&4) != 0)

/* Passive sensors. */

/* Bearings of one scan of a passive sensor; the rest get NO_ROOM, and P_D counts half. 1 .. 64. */
#ifndef RHO_MAX_BEARINGS
#define RHO_MAX_BEARINGS RHO_CONFIG_PICK(8, 32)
#endif

/* Passive sensors, 2 .. 8; rows of a batch, 4 .. 16. RAM: 33 bytes a bearing, sensor and row. */
#ifndef RHO_MAX_PASSIVE_SENSORS
#define RHO_MAX_PASSIVE_SENSORS RHO_CONFIG_PICK(3, 8)
#endif
#ifndef RHO_MAX_PASSIVE_SCANS
#define RHO_MAX_PASSIVE_SCANS RHO_CONFIG_PICK(8, 16)
#endif

/* Crossings of bearings that a search keeps, the likeliest. RAM: 44 bytes each. 16 .. 65535. */
#ifndef RHO_MAX_PASSIVE_POINTS
#define RHO_MAX_PASSIVE_POINTS RHO_CONFIG_PICK(512, 2048)
#endif

/* Candidates of passive tracks, of twice the fits. RAM: 24 bytes, 1 a sensor and row. 8 .. 255. */
#ifndef RHO_MAX_PASSIVE_CANDIDATES
#define RHO_MAX_PASSIVE_CANDIDATES RHO_CONFIG_PICK(64, 96)
#endif

/* Most tracks that a batch of bearings starts. 1 .. 64, fewer than the candidates. */
#ifndef RHO_MAX_PASSIVE_TRACKS
#define RHO_MAX_PASSIVE_TRACKS RHO_CONFIG_PICK(8, 32)
#endif

/* Directions by which bearings are looked up. RAM: a bit a bearing, sensor and row. 32 .. 4096. */
#ifndef RHO_PASSIVE_BINS
#define RHO_PASSIVE_BINS RHO_CONFIG_PICK(128, 256)
#endif

/* The papers' methods (hough.h, passive_paper.h, paper_starts.h, publish.h). */

/* Cells of rho in a row of the Hough accumulator. RAM: 2 bytes a cell. 64 .. 32704. */
#ifndef RHO_MAX_RHO_CELLS
#define RHO_MAX_RHO_CELLS RHO_CONFIG_PICK(2048, 16384)
#endif

/* Points whose cells the accumulator remembers. RAM: 20 bytes a point. 64 .. 4096. */
#ifndef RHO_ACCUMULATOR_SPARSE_MAX
#define RHO_ACCUMULATOR_SPARSE_MAX RHO_CONFIG_PICK(256, 1024)
#endif

/*
 * Bins of rho in which the accumulator counts points, to skip those that cannot reach min_votes.
 * About 4 bins a point of RHO_ACCUMULATOR_SPARSE_MAX; fewer bins skip less. RAM: 4 bytes a bin. A
 * power of two, 64 .. 16384.
 */
#ifndef RHO_ACCUMULATOR_BINS
#define RHO_ACCUMULATOR_BINS RHO_CONFIG_PICK(1024, 4096)
#endif

/* Cells behind those of a row, which has guard cells at its ends and is read by 64 cells. */
#define RHO_ACCUMULATOR_PADDING 66

/* Cells with votes of the papers' methods. RAM: 8 bytes each. A power of two, 256 .. 4194304. */
#ifndef RHO_MAX_HOUGH_CELLS
#define RHO_MAX_HOUGH_CELLS RHO_CONFIG_PICK(4096, 131072)
#endif

/* Pairs of plots of successive scans, of the papers. RAM: 32 bytes a pair. 16 .. 65534. */
#ifndef RHO_MAX_HOUGH_KERNELS
#define RHO_MAX_HOUGH_KERNELS RHO_CONFIG_PICK(256, 16384)
#endif

/* Hash chains by which the papers' methods find pairs of plots on a line. RAM: 2 bytes each. */
#define RHO_HOUGH_CHAINS RHO_CONFIG_PICK(256, 16384)

/*
 * The paper's passive method: lines that it finds, 1 .. 255; cells of its accumulator, RAM: a byte
 * a cell, and 3 bytes a cell of rho; crossings of a pair of sensors, 16 .. 65535, RAM: 8 bytes
 * each.
 */
#ifndef RHO_MAX_PASSIVE_LINES
#define RHO_MAX_PASSIVE_LINES 24
#endif
#ifndef RHO_PAPER_THETA_CELLS
#define RHO_PAPER_THETA_CELLS 90
#endif
#ifndef RHO_PAPER_RHO_CELLS
#define RHO_PAPER_RHO_CELLS 256
#endif
#ifndef RHO_MAX_PAPER_CROSSINGS
#define RHO_MAX_PAPER_CROSSINGS RHO_CONFIG_PICK(512, 4096)
#endif

/* Ranges: where a value is outside, a compiler says that the size of this array is negative. */

#define RHO_CONFIG_RANGE(name, least, most)                                                        \
    typedef char name##_must_be_##least##_to_##most[(name) >= (least) && (name) <= (most) ? 1 : -1]

RHO_CONFIG_RANGE(RHO_MAX_SCANS, 3, 12);
RHO_CONFIG_RANGE(RHO_MAX_PLOTS, 1, 16383);
RHO_CONFIG_RANGE(RHO_MAX_BINS, 1, 32767);
RHO_CONFIG_RANGE(RHO_MAX_CANDIDATES, 1, 4096);
RHO_CONFIG_RANGE(RHO_WORK_MAX, 0, 100000000);
RHO_CONFIG_RANGE(RHO_MAX_DENSITY_MAPS, 1, 8);
RHO_CONFIG_RANGE(RHO_MAX_DENSITY_CELLS, 1, 64);
RHO_CONFIG_RANGE(RHO_MAX_RHO_CELLS, 64, 32704);
RHO_CONFIG_RANGE(RHO_ACCUMULATOR_SPARSE_MAX, 64, 4096);
#if RHO_ACCUMULATOR_BINS < 64 || RHO_ACCUMULATOR_BINS > 16384 ||                                   \
    (RHO_ACCUMULATOR_BINS & (RHO_ACCUMULATOR_BINS - 1)) != 0
#error "RHO_ACCUMULATOR_BINS must be a power of two, 64 .. 16384"
#endif
#if RHO_MAX_HOUGH_CELLS < 256 || RHO_MAX_HOUGH_CELLS > 4194304 ||                                  \
    (RHO_MAX_HOUGH_CELLS & (RHO_MAX_HOUGH_CELLS - 1))
#error "RHO_MAX_HOUGH_CELLS must be a power of two, 256 .. 4194304"
#endif
RHO_CONFIG_RANGE(RHO_MAX_HOUGH_KERNELS, 16, 65534);
RHO_CONFIG_RANGE(RHO_MAX_BEARINGS, 1, 64);
RHO_CONFIG_RANGE(RHO_MAX_PASSIVE_SENSORS, 2, 8);
RHO_CONFIG_RANGE(RHO_MAX_PASSIVE_SCANS, 4, 16);
RHO_CONFIG_RANGE(RHO_MAX_PASSIVE_POINTS, 16, 65535);
RHO_CONFIG_RANGE(RHO_MAX_PASSIVE_CANDIDATES, 8, 255);
typedef char RHO_MAX_PASSIVE_CANDIDATES_must_exceed_TRACKS
    [RHO_MAX_PASSIVE_CANDIDATES > RHO_MAX_PASSIVE_TRACKS ? 1 : -1];
RHO_CONFIG_RANGE(RHO_MAX_PASSIVE_TRACKS, 1, 64);
RHO_CONFIG_RANGE(RHO_MAX_PASSIVE_LINES, 1, 255);
RHO_CONFIG_RANGE(RHO_PAPER_THETA_CELLS, 18, 1024);
RHO_CONFIG_RANGE(RHO_PAPER_RHO_CELLS, 16, 4096);
RHO_CONFIG_RANGE(RHO_MAX_PAPER_CROSSINGS, 16, 65535);
RHO_CONFIG_RANGE(RHO_PASSIVE_BINS, 32, 4096);
RHO_CONFIG_RANGE(RHO_MAX_TRACKS, 1, 8192);
RHO_CONFIG_RANGE(RHO_MAX_HYPOTHESES, 1, 65534);
RHO_CONFIG_RANGE(RHO_FILTERS, 1, 7);
RHO_CONFIG_RANGE(RHO_SCAN_KINDS, 1, 7);
RHO_CONFIG_RANGE(RHO_MAX_GATE_PLOTS, 1, 32);
RHO_CONFIG_RANGE(RHO_MAX_CLUTTER_CELLS, 0, 1024);
RHO_CONFIG_RANGE(RHO_MAX_ECHOES, 0, 32767);
RHO_CONFIG_RANGE(RHO_ECHO_REGIONS, 1, 15);
RHO_CONFIG_RANGE(RHO_STROBE_BINS, 8, 4096);
RHO_CONFIG_RANGE(RHO_MAX_ZONES, 0, 30);
RHO_CONFIG_RANGE(RHO_SEARCHES, 0, 1);
RHO_CONFIG_RANGE(RHO_KEEPS_OFFERS, 0, 1);
RHO_CONFIG_RANGE(RHO_SECTORS, 0, 1);
RHO_CONFIG_RANGE(RHO_SHARES_PLOTS, 0, 1);
RHO_CONFIG_RANGE(RHO_CLAIMS_BEYOND, 0, 1);
RHO_CONFIG_RANGE(RHO_FAST_UPDATES, 0, 1);
RHO_CONFIG_RANGE(RHO_AMBIGUOUS_RANGE_RATES, 0, 1);
RHO_CONFIG_RANGE(RHO_DOPPLER_NOTCH, 0, 1);
RHO_CONFIG_RANGE(RHO_MAX_REFLECTORS, 0, 64);
RHO_CONFIG_RANGE(RHO_MAX_EXCLUDED_AREAS, 0, 64);
RHO_CONFIG_RANGE(RHO_BODIES, 0, 1);
RHO_CONFIG_RANGE(RHO_PLOT_STRIPS, 1, 16384);
RHO_CONFIG_RANGE(RHO_MAX_SENSORS, 1, 256);
RHO_CONFIG_RANGE(RHO_MAX_OPEN_SCANS, 1, 64);
RHO_CONFIG_RANGE(RHO_MAX_WINDOWS, 1, 1024);
RHO_CONFIG_RANGE(RHO_MAX_COMMANDS, 0, 255);
RHO_CONFIG_RANGE(RHO_PAPERS, 0, 1);
RHO_CONFIG_RANGE(RHO_LEARNS_REFLECTORS, 0, 1);
#if RHO_LEARNS_REFLECTORS && RHO_MAX_REFLECTORS == 0
#error "RHO_LEARNS_REFLECTORS needs RHO_MAX_REFLECTORS"
#endif
RHO_CONFIG_RANGE(RHO_MAX_PARTS, 1, 32767);

/*
 * RAM formula, in bytes: upper bounds of the objects' sizes that the build asserts
 * (accumulator.c, hough.c, initiator.c, tracker_setup.c). Embedded: initiator 66 KiB at
 * most. A node also holds the caller's scan (56 bytes a plot) and report.
 */
#define RHO_RAM_WINDOW_BYTES                                                                       \
    (RHO_MAX_SCANS * (31 * RHO_MAX_PLOTS + 2 * (RHO_MAX_BINS + 1) + 160) + 120)
#define RHO_RAM_INITIATOR_BYTES                                                                    \
    (RHO_RAM_WINDOW_BYTES + RHO_MAX_CANDIDATES * (2 * RHO_MAX_SCANS + 44) +                        \
     RHO_MAX_DENSITY_MAPS * (2 * RHO_MAX_DENSITY_CELLS * RHO_MAX_DENSITY_CELLS + 68) +             \
     2 * RHO_MAX_CLUTTER_CELLS * RHO_MAX_CLUTTER_CELLS + RHO_MAX_PLOTS + 410)
#define RHO_RAM_LARGER(a, b) ((a) > (b) ? (a) : (b))
#define RHO_RAM_ACCUMULATOR_BYTES                                                                  \
    (2 * RHO_MAX_RHO_CELLS + 20 * RHO_ACCUMULATOR_SPARSE_MAX + 4 * RHO_ACCUMULATOR_BINS + 256)
/* Hough transform: the larger of the accumulator, and of vote cells with pairs of plots or a row */
#define RHO_RAM_HOUGH_BYTES                                                                        \
    (RHO_RAM_LARGER(RHO_RAM_ACCUMULATOR_BYTES,                                                     \
                    8 * RHO_MAX_HOUGH_CELLS +                                                      \
                        RHO_RAM_LARGER(4 * RHO_MAX_RHO_CELLS,                                      \
                                       32 * RHO_MAX_HOUGH_KERNELS + 2 * RHO_HOUGH_CHAINS)) +       \
     128)
#define RHO_RAM_HYPOTHESES_BYTES (410 * RHO_MAX_HYPOTHESES + 17 * (RHO_MAX_TRACKS + 1) + 2048)
#define RHO_RAM_STRIPS_BYTES                                                                       \
    (2 * (RHO_PLOT_STRIPS + (RHO_PLOT_STRIPS > 1 ? RHO_MAX_PLOTS : 1)) + 16)
#define RHO_RAM_CLUTTER_MAP_BYTES                                                                  \
    (RHO_MAX_ECHOES > 0 ? 64 * RHO_MAX_ECHOES + 10 * RHO_MAX_PLOTS + 3 * RHO_STROBE_BINS +         \
                              480 * (RHO_ECHO_REGIONS * RHO_ECHO_REGIONS + 1) + 40                 \
                        : 1080)
#define RHO_RAM_SECOND_PLOTS_BYTES (76 * RHO_MAX_SENSORS)
#define RHO_RAM_TRACKER_BYTES                                                                      \
    (RHO_MAX_TRACKS * (560 + 8 * RHO_MAX_GATE_PLOTS) + 16 * RHO_MAX_PLOTS +                        \
     (252 + 52 * RHO_SECTORS) * RHO_MAX_SENSORS + RHO_RAM_HYPOTHESES_BYTES +                       \
     RHO_RAM_STRIPS_BYTES + RHO_RAM_CLUTTER_MAP_BYTES + RHO_RAM_SECOND_PLOTS_BYTES +               \
     16 * (RHO_MAX_REFLECTORS + RHO_MAX_EXCLUDED_AREAS) + 78 * RHO_BODY_PLOTS +                    \
     168 * RHO_BODY_TRACKS + 640)
#define RHO_RAM_SCAN_ASSEMBLER_BYTES                                                               \
    (RHO_MAX_OPEN_SCANS * (56 * RHO_MAX_PLOTS + 24 * RHO_MAX_BEARINGS + 2 * RHO_MAX_PARTS + 136) + \
     280 * RHO_MAX_SENSORS + 528)

#endif
