/* SPDX-License-Identifier: MIT */
/*
 * operator: lets a person start, drop, renumber and freeze tracks by hand, and exclude areas in
 * which no tracks are to start, such as a wind farm, a junction or a harbour basin. All functions
 * are called between two steps.
 *
 *     rho_tracker_step(&tracker, &initiator, &scan, &report);
 *     if (rho_tracker_drop_track(&tracker, 12, &report) != RHO_OK) {
 *         ... there is no such track
 *     }
 *
 * Functions with a report update the tracks in the last step's report: they are to be called before
 * the report is used or published. A refused call changes nothing, but a start for which there is
 * no room is counted in tracks_no_room.
 *
 * Tracks that start or end by hand are counted in tracks_started and tracks_ended, dropped ones in
 * tracks_dropped, too. rhotrack/command.h does the same by messages.
 *
 * Stack: 100 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_OPERATOR_H
#define RHOTRACK_OPERATOR_H

#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/tracker.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

/* Highest track identity that a person can give; later tracks get identities above it. */
#define RHO_LIMIT_TRACK_ID (1u << 30)

/* Start of a track by an operator: position and velocity at the time of the last step. */
struct rho_operator_start {
    /* position, within RHO_LIMIT_POSITION_M, and its sigma, 1e-3 .. 1e5 m */
    float x_m, y_m, sigma_m;
    /* velocity, and its sigma, 1e-3 .. 1e5 m/s; sigma 0: the velocity is not known */
    float vx_mps, vy_mps, sigma_mps;
};

/*
 * Starts a track at a place, as if the sensor that was heard last had seen it there. It is
 * confirmed at once, or tentative where many objects are seldom seen (tracker.h), and ends as
 * others do where no plots follow. It counts as a target's, though it may never move: until it
 * ends, echoes of the clutter map where it is are no clutter, and it may be slower than v_min. A
 * full tracker gives up the tentative track that most probably has no target. Errors: NULL, STATE
 * (not initialised, no step so far, the report is not the last step's), VALUE (a number outside its
 * range), CAPACITY (no room), and those of rho_track_start. Cost: the report. Stack: 3.1 KB.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_start_at(struct rho_tracker *tracker,
                                                    const struct rho_operator_start *start,
                                                    struct rho_report *report);

/*
 * Ends a track. Its plots may start another one: rho_tracker_exclude_area prevents that.
 * Errors: NULL, STATE (as above), VALUE (no such track), CAPACITY (the report has no room for
 * another ended track: drop it after the next step). Cost: the report. Stack: 1.6 KB.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_drop_track(struct rho_tracker *tracker,
                                                      uint32_t track_id, struct rho_report *report);

/*
 * Gives a track another identity, for example that of a lost track which it continues. The report
 * lists the old identity as ended.
 *   new_id  1 .. RHO_LIMIT_TRACK_ID, of no live track; the next track's is above it
 * Errors: as rho_tracker_drop_track, and VALUE for new_id. Cost: the report. Stack: 2 KB.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_renumber_track(struct rho_tracker *tracker,
                                                          uint32_t track_id, uint32_t new_id,
                                                          struct rho_report *report);

/*
 * Freezes a confirmed or coasting track, or thaws it. A frozen track coasts straight on: it takes
 * no plots, has no misses and does not end, until it is thawed or dropped. So it passes clutter, a
 * jammer or a crossing that would lead it away. Others may start from its plots. With input
 * estimation it keeps its inputs. A thawed track goes on from where it would be, with an
 * uncertainty that has grown meanwhile. Errors: NULL, CONFIG (RHO_MAX_EXCLUDED_AREAS is 0), STATE
 * (as above, or the track is tentative), VALUE (no such track). Cost: the report. Stack: 1.6 KB.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_freeze_track(struct rho_tracker *tracker,
                                                        uint32_t track_id, int is_frozen,
                                                        struct rho_report *report);

/*
 * Excludes an area, sides included: from the next step on its plots start no tracks. Tracks still
 * take them. A plot there that no track claims is GHOST (enum rho_fate), and counted in
 * plots_excluded; bearings are not touched.
 *   area  copied; min below max
 * Errors: NULL, STATE (not initialised), CAPACITY (RHO_MAX_EXCLUDED_AREAS are there), VALUE (a side
 * that is no coordinate, or turned round). Constant cost; a step's grows by plots times areas.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_exclude_area(struct rho_tracker *tracker,
                                                        const struct rho_extent *area);

/* Removes the areas that contain a place. Errors: NULL, STATE, VALUE (none does). Cost: areas. */
RHO_MUST_CHECK enum rho_status rho_tracker_include_place(struct rho_tracker *tracker, float x_m,
                                                         float y_m);

RHO_END_C

#endif
