/* SPDX-License-Identifier: MIT */
/*
 * reflectors: walls, guard rails and quays that show targets a second time; told to a tracker, or
 * learned from what they show.
 *
 * A smooth wall sends part of an echo round: a sensor sees the target's image behind the wall, as
 * far behind as the target is before it, with the velocity and the range rate of the image.
 *
 *      image  x        x' = x - 2 n (n . (x - a))      n: normal of the wall, a: a place on it
 *             :
 *      =======:====|   the wall, from .. to            Only where the line of sight to the image
 *            /:    |                                   crosses the wall it is seen.
 *     sensor  target
 *
 * Of walls that are told, or learned, the tracker knows where the images of its tracks would be.
 * Plots that no track claims, and are where the image of one is, with its range rate where that is
 * measured, are GHOST (enum rho_fate): they start nothing. A young track that moves as the image of
 * another one ends. A target behind the wall is found where its motion differs from the image's.
 *
 * Walls that nobody told of are learned:
 *
 *     rho_reflector_learning_init(&learning, sizeof learning);
 *     ...
 *     rho_tracker_step(&tracker, &initiator, &scan, &report);
 *     rho_reflector_learning_step(&learning, &tracker, &scan, &report);
 *
 * A wall shows images as long as it is not known, and images have tracks. Where two tracks move as
 * a target and its image would, the line half way between them may be a wall, and is observed: a
 * wall shows every target that passes, at its place and with its range rate, to a sensor that sees
 * the target itself. So each track that comes along is a witness. Of the first 24 looks that have
 * a plot of it, those with a plot where its image would be are counted; and those with a plot where
 * the image is not, a little further along the line, as clutter and other traffic give them. A
 * track that is seen across another such line may be an image itself, and says nothing against.
 *
 * A line becomes a wall of the tracker's, behind those that it was told, when
 *
 * - four witnesses speak for it, four times as many as against it;
 * - two of them came after the first one had spoken: targets that keep in formation are not images;
 * - the distances at which they passed spread three times as much as tracks' errors, and places
 *   half way to the images, explain: two lanes mirror one another in their middle, at one distance
 *   but for where in its lane each car is; and
 * - the line is known as well as a track's place.
 *
 * It is refined from then on, its ends move apart as images are seen farther along, and it is
 * forgotten when more witnesses speak against it than for it.
 *
 * Work and memory are bounded, and not counted in the tracker's units: a step compares 256 pairs of
 * tracks and looks for 16 images at most, fewer where there are many plots.
 *
 * Stack: 104 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_REFLECTORS_H
#define RHOTRACK_REFLECTORS_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rho_report;
struct rho_tracker;

/* A straight wall, between two places at least so far apart. */
#define RHO_REFLECTOR_LEAST_M 1.0f
struct rho_reflector {
    float from_x_m, from_y_m, to_x_m, to_y_m;
};

/*
 * Tells a tracker all walls that it is to know, from the next step on.
 *   reflectors  num_reflectors of them, 0 .. RHO_MAX_REFLECTORS; copied. NULL for 0
 * Errors: NULL, STATE (not initialised), CAPACITY, VALUE (a place that is no coordinate, or two too
 * near each other); nothing is changed. Constant cost.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_set_reflectors(struct rho_tracker *tracker,
                                                          const struct rho_reflector *reflectors,
                                                          unsigned num_reflectors);

/* ---- Learned --------------------------------------------------------------------------------- */

#define RHO_LEARNED_REFLECTORS 6  /* lines, observed and used */
#define RHO_REFLECTOR_WITNESSES 6 /* tracks that a line is observed with at a time */

/* A track beside a line. */
struct rho_reflector_witness {
    uint32_t track_id;    /* 0: none */
    uint16_t looks;       /* that had a plot of it */
    uint16_t hits, other; /* of these: with a plot at its image; beside that */
    float off_m;          /* sum of places half way to the image, across the line */
    uint32_t since;       /* steps of the learning when it came */
};

/* A line, in a frame of its own: a place, a direction. */
struct rho_learned_reflector {
    float x_m, y_m, cos_along, sin_along;
    float offset_m, slope; /* across the frame at its place; and more a metre along */
    float variance[3];     /* of both: m^2, m, 1 */
    float from_m, to_m;    /* along: where lines of sight to images cross it */
    float pairs;           /* of tracks that it mirrors */
    float sigma_m;         /* of its witnesses' places, smoothed */
    float distance_m;      /* at which witnesses that spoke for it passed: mean */
    float distance_m2;     /* ... and variance */
    float off_m2;   /* of places half way to their images, a witness's mean: across the line */
    uint32_t first; /* steps of the learning when the first one had spoken */
    uint16_t witnesses_for, witnesses_against;
    uint8_t late_ones; /* of those for it: came after the first one had spoken; saturates */
    uint8_t is_taken, is_used;
    struct rho_reflector_witness witnesses[RHO_REFLECTOR_WITNESSES];
};

struct rho_reflector_learning {
    uint32_t magic;
    uint32_t steps;
    uint32_t next_pair, next_line;
    uint16_t num_told, num_used; /* walls of the tracker: told; and behind them learned */
    struct rho_learned_reflector lines[RHO_LEARNED_REFLECTORS];
};

/* Nothing is learned. Errors: NULL, SIZE. Cost: its bytes. */
RHO_MUST_CHECK enum rho_status rho_reflector_learning_init(struct rho_reflector_learning *learning,
                                                           size_t size);

/*
 * Learns from a step of the tracker, and puts what it has learned behind the walls that the tracker
 * was told; rho_tracker_set_reflectors may tell others between two steps. Scans out of sequence are
 * left out. Errors: NULL, STATE (one of both is not initialised), CAPACITY (RHO_MAX_REFLECTORS is
 * 0), VALUE (the report is not of this scan); nothing is changed.
 * Cost: tracks; where they move as images 200 instructions a pair; and where a line is observed,
 * the plots of a scan, 16 times at most. Stack: 1.5 KB.
 */
RHO_MUST_CHECK enum rho_status rho_reflector_learning_step(struct rho_reflector_learning *learning,
                                                           struct rho_tracker *tracker,
                                                           const struct rho_scan *scan,
                                                           const struct rho_report *report);

/*
 * The wall that was learned at this place, 0 .. RHO_LEARNED_REFLECTORS - 1. 0, and *reflector is
 * unchanged: there is none that is used. Constant cost.
 */
int rho_reflector_learning_wall(const struct rho_reflector_learning *learning, unsigned place,
                                struct rho_reflector *reflector);

/* 1: an object of unknown origin (a snapshot) that can be worked with. Constant cost. */
int rho_reflector_learning_is_sound(const struct rho_reflector_learning *learning);

#ifdef __cplusplus
}
#endif

#endif
