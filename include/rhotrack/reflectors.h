/* SPDX-License-Identifier: MIT */
/*
 * reflectors: walls, guard rails and quays, whose reflections show targets a second time. The
 * caller tells a tracker where they are, or they are learned from the images that they show.
 *
 * A smooth wall reflects part of an echo: a sensor sees the target's image behind the wall, as far
 * behind it as the target is in front, with the velocity and the range rate of the image.
 *
 *      image  x        x' = x - 2 n (n . (x - a))      n: normal of the wall, a: a place on it
 *             :
 *      =======:====|   the wall, from .. to            Only where the line of sight to the image
 *            /:    |                                   crosses the wall it is seen.
 *     sensor  target
 *
 * The tracker computes where the images of its tracks in known walls, told or learned, would be. A
 * plot that no track claims and that lies at such an image, with the image's range rate where that
 * is measured, gets the fate GHOST and starts no track. A young track that moves as the image of
 * another track ends. A target behind the wall is found where its motion differs from the image's.
 *
 * Unknown walls are learned:
 *
 *     rho_reflector_learning_init(&learning, sizeof learning);
 *     ...
 *     rho_tracker_step(&tracker, &initiator, &scan, &report);
 *     rho_reflector_learning_step(&learning, &tracker, &scan, &report);
 *
 * While a wall is unknown, the images that it shows become tracks. Where two tracks move as a
 * target and its image would, the line half way between them may be a wall, and is observed: a wall
 * shows the image of every target that passes to a sensor that sees the target itself. So each
 * track that passes a line is a witness. In its first 24 looks with a plot of the track, two counts
 * are made: looks with a plot at the track's image, and looks with a plot a little further along
 * the line, where only clutter and other traffic give plots. By these counts the witness speaks for
 * the line or against it. A track on the far side of another such line may be an image itself, and
 * does not speak against a line.
 *
 * A line becomes a wall of the tracker, behind the walls that it was told, when
 *
 * - four witnesses speak for the line, and four times as many as against it;
 * - two of these came after the first one had spoken: targets in formation are not images;
 * - the distances at which the witnesses passed spread three times as much as errors of tracks and
 *   images explain: two lanes mirror one another in the line between them, but all cars at nearly
 *   one distance; and
 * - the line is known as precisely as a track's place.
 *
 * A learned wall is refined further, its ends move apart as images are seen farther along, and it
 * is forgotten when more witnesses speak against it than for it.
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

RHO_BEGIN_C

struct rho_report;
struct rho_tracker;

/* A straight wall, between two places at least RHO_REFLECTOR_LEAST_M apart. */
#define RHO_REFLECTOR_LEAST_M 1.0f
struct rho_reflector {
    float from_x_m, from_y_m, to_x_m, to_y_m;
};

/*
 * Replaces the walls that a tracker knows, from the next step on.
 *   reflectors  num_reflectors of them, 0 .. RHO_MAX_REFLECTORS; copied. NULL for 0
 * Errors: NULL, STATE (not initialised), CAPACITY, VALUE (a place that is no coordinate, or two too
 * near each other); nothing is changed. Constant cost.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_set_reflectors(struct rho_tracker *tracker,
                                                          const struct rho_reflector *reflectors,
                                                          unsigned num_reflectors);

/* Walls that are learned. */

#define RHO_LEARNED_REFLECTORS 6 /* largest number of lines that are observed or used as walls */
/* Largest number of tracks with which a line is observed at a time. */
#define RHO_REFLECTOR_WITNESSES 6

/* A witness: a track beside a line, at whose image plots are looked for. */
struct rho_reflector_witness {
    uint32_t track_id; /* the track; 0: the witness is free */
    uint16_t looks;    /* looks that had a plot of the track */
    /* looks with a plot at the image; with a plot beside the image */
    uint16_t hits, other;
    float off_m;    /* sum of the distances, across the line, of places half way to the image */
    uint32_t since; /* step of the learning in which the witness came */
};

/* A line that may be a wall. Its frame has an origin and a direction. */
struct rho_learned_reflector {
    float x_m, y_m, cos_along, sin_along;
    /* place of the line across the frame at the origin; change a metre along */
    float offset_m, slope;
    float variance[3]; /* covariance of offset and slope: m^2, m, 1 */
    /* ends of the line along its frame: where lines of sight to images cross it */
    float from_m, to_m;
    float pairs;       /* pairs of tracks that the line mirrors */
    float sigma_m;     /* sigma of its witnesses' places, smoothed */
    float distance_m;  /* mean distance at which witnesses for the line passed */
    float distance_m2; /* variance of the distance at which witnesses for the line passed */
    /* across the line: mean square of the witnesses' mean distance of places half way to images */
    float off_m2;
    uint32_t first; /* step of the learning in which the first witness had spoken for the line */
    uint16_t witnesses_for, witnesses_against;
    /* witnesses for the line that came after the first one had spoken; saturates */
    uint8_t late_ones;
    uint8_t is_taken, is_used;
    struct rho_reflector_witness witnesses[RHO_REFLECTOR_WITNESSES];
};

struct rho_reflector_learning {
    uint32_t magic;
    uint32_t steps;
    uint32_t next_pair, next_line;
    /* walls of the tracker: that it was told; learned ones behind them */
    uint16_t num_told, num_used;
    struct rho_learned_reflector lines[RHO_LEARNED_REFLECTORS];
};

/* Initialises an object that has learned nothing. Errors: NULL, SIZE. Cost: its bytes. */
RHO_MUST_CHECK enum rho_status rho_reflector_learning_init(struct rho_reflector_learning *learning,
                                                           size_t size);

/*
 * Learns walls from a step of the tracker, and puts the learned ones behind the walls that the
 * tracker was told; rho_tracker_set_reflectors may tell others between two steps. Out-of-sequence
 * scans are left out. Errors: NULL, STATE (learning or tracker is not initialised), CAPACITY
 * (RHO_MAX_REFLECTORS is 0), VALUE (the report is not of this scan); nothing is changed.
 * Cost: at most 256 pairs of tracks, 200 instructions each where they move as images; and where a
 * line is observed, the plots of the scan, 16 times at most. Stack: 1.5 KB.
 */
RHO_MUST_CHECK enum rho_status rho_reflector_learning_step(struct rho_reflector_learning *learning,
                                                           struct rho_tracker *tracker,
                                                           const struct rho_scan *scan,
                                                           const struct rho_report *report);

/*
 * Gives the wall that line `place` has become, 0 .. RHO_LEARNED_REFLECTORS - 1. Returns 0, and
 * *reflector is unchanged, where that line is not used as a wall. Constant cost.
 */
int rho_reflector_learning_wall(const struct rho_reflector_learning *learning, unsigned place,
                                struct rho_reflector *reflector);

/* True where an object of unknown origin (a snapshot) is sound. Constant cost. Stack: 112 bytes. */
int rho_reflector_learning_is_sound(const struct rho_reflector_learning *learning);

RHO_END_C

#endif
