/* SPDX-License-Identifier: MIT */
#include "pipeline/plots_beside_tracks.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#define RING_LEAST_M 0.01
#define RINGS_A_DECADE 10
#define EQUAL_SIGMAS 3.0f /* velocities that differ by less may be equal */

#define LOOKS_LEAST 50 /* as calibrate needs for pd */
/*
 * Largest share of the plots within a ring that it holds itself, beyond a body's edge. Plots that
 * are spread evenly give .21 along a road and .37 on an area; people in a crowded room give .07.
 */
#define EDGE_SHARE 0.15
/*
 * Least ratio of the 90 % and 10 % quantiles of the nearest plot's distance. Bodies of the scenes
 * have 3.4 and more, convoys and formations 2.5 at most, a queue at a traffic light 3.0.
 */
#define SPREAD_LEAST 3.2
/*
 * Sensors seldom resolve targets that are nearer than this. Of bodies' looks a fifth to all have a
 * plot that near; of other targets' 3 %, though a third on lanes side by side at one speed.
 */
#define RESOLVED_SIGMAS 3.0f
#define UNRESOLVED_SHARE 0.1
#define EXTENT_SHARE 0.95 /* of the plots; noise puts the others farther off */
#define MARGIN 1.25       /* few plots of a scan are as far apart as the ends of their body */

/* Ring of a distance; BESIDE_RINGS: beyond all. */
static int ring_of(float square_m2)
{
    const double ring =
        0.5 * RINGS_A_DECADE * log10((double)square_m2 / (RING_LEAST_M * RING_LEAST_M));

    return (int)fmin(fmax(ring, 0.0), BESIDE_RINGS);
}

static float square_of_length(float x, float y)
{
    return x * x + y * y;
}

/* Whether two tracks may be parts of one target by their velocities. */
static bool have_equal_velocities(const struct rho_track_report *one,
                                  const struct rho_track_report *other)
{
    return square_of_length(one->state[RHO_VX] - other->state[RHO_VX],
                            one->state[RHO_VY] - other->state[RHO_VY]) <
           EQUAL_SIGMAS * EQUAL_SIGMAS * square_of_length(one->sigma_mps, other->sigma_mps);
}

static void add_look(struct plots_beside_tracks *beside, const struct rho_scan *scan,
                     const struct rho_report *report, const struct rho_track_report *track)
{
    const struct rho_plot *own = &scan->plots[track->plot];
    float nearest_m2 = INFINITY;

    for (unsigned i = 0; i < report->num_tracks; i++) {
        const struct rho_track_report *other = &report->tracks[i];

        if (other->plot >= 0 && other->plot != track->plot && have_equal_velocities(track, other)) {
            const struct rho_plot *plot = &scan->plots[other->plot];
            const float square_m2 = square_of_length(plot->x_m - own->x_m, plot->y_m - own->y_m);

            beside->plots[ring_of(square_m2)]++;
            nearest_m2 = fminf(nearest_m2, square_m2);
        }
    }
    beside->nearest[ring_of(nearest_m2)]++;
    beside->unresolved += nearest_m2 < RESOLVED_SIGMAS * RESOLVED_SIGMAS *
                                           square_of_length(own->sigma_range_m, own->sigma_cross_m);
    beside->looks++;
}

void plots_beside_tracks_add_scan(struct plots_beside_tracks *beside, const struct rho_scan *scan,
                                  const struct rho_report *report)
{
    for (unsigned i = 0; i < report->num_tracks; i++) {
        if (report->tracks[i].status == RHO_TRACK_CONFIRMED && report->tracks[i].plot >= 0) {
            add_look(beside, scan, report, &report->tracks[i]);
        }
    }
}

/*
 * First ring beyond a body's edge: half of the looks have a plot nearer than it, and the next ring
 * does not hold a smaller share of the plots within it. BESIDE_RINGS: there is none.
 */
static int ring_beyond_edge(const struct plots_beside_tracks *beside)
{
    double plots = 0.0, looks = 0.0;

    for (int ring = 0; ring + 1 < BESIDE_RINGS; ring++) {
        const double here = (double)beside->plots[ring], next = (double)beside->plots[ring + 1];

        if (2.0 * looks >= (double)beside->looks && here <= EDGE_SHARE * (plots + here) &&
            here * (plots + here) <= next * plots) {
            return ring;
        }
        plots += here;
        looks += (double)beside->nearest[ring];
    }
    return BESIDE_RINGS;
}

static double sum_counts(const uint64_t *counts, int end)
{
    double sum = 0.0;

    for (int ring = 0; ring < end; ring++) {
        sum += (double)counts[ring];
    }
    return sum;
}

/* Distance within which this share of the counts before the end is, of which there are some. */
static double quantile_m(const uint64_t *counts, int end, double share)
{
    double left = share * sum_counts(counts, end);
    int ring = 0;

    while (left > (double)counts[ring]) {
        left -= (double)counts[ring++];
    }
    return RING_LEAST_M * pow(10.0, (ring + left / (double)counts[ring]) / RINGS_A_DECADE);
}

/* The length or the next larger one of those that people state. */
static double round_up(double length_m)
{
    static const double stated[] = {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0};
    const double decade = pow(10.0, floor(log10(length_m)));
    size_t i = 0;

    while (stated[i] * decade < length_m && stated[i] < 10.0) {
        i++;
    }
    return stated[i] * decade;
}

struct found_body plots_beside_tracks_find_body(const struct plots_beside_tracks *beside)
{
    const int end = ring_beyond_edge(beside);
    struct found_body body = {0.0, 0.0, 0.0};

    if (beside->looks >= LOOKS_LEAST && end < BESIDE_RINGS &&
        (double)beside->unresolved >= UNRESOLVED_SHARE * (double)beside->looks &&
        quantile_m(beside->nearest, end, 0.9) >=
            SPREAD_LEAST * quantile_m(beside->nearest, end, 0.1)) {
        body.plots = sum_counts(beside->plots, end) / (double)beside->looks;
        body.distance_m = quantile_m(beside->plots, end, EXTENT_SHARE);
        body.body_max_m = fmin(round_up(MARGIN * body.distance_m), (double)RHO_LIMIT_BODY_M);
    }
    return body;
}

struct cJSON *found_body_json(const struct found_body *body)
{
    cJSON *object = cJSON_CreateObject();

    cJSON_AddNumberToObject(object, "body_max_m", body->body_max_m);
    cJSON_AddNumberToObject(object, "plots", body->plots);
    cJSON_AddNumberToObject(object, "distance_m", body->distance_m);
    return object;
}
