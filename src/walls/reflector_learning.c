/* SPDX-License-Identifier: MIT */
/*
 * reflector_learning: learns which lines half way between tracks and their images are walls: counts
 * the tracks whose images are seen, and gives the tracker the lines with enough witnesses.
 */
#include "rhotrack/reflectors.h"

#include <string.h>

#include "../tracker/sensors.h"
#include "../tracker/step.h"
#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/gate.h"
#include "rhotrack/detail/linalg.h"
#include "wall_line.h"

enum { MAGIC = 0x52464c4e /* "RFLN" */ };

enum rho_status rho_reflector_learning_init(struct rho_reflector_learning *learning, size_t size)
{
    if (!learning) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *learning) {
        return RHO_ERROR_SIZE;
    }
    memset(learning, 0, sizeof *learning);
    learning->magic = MAGIC;
    return RHO_OK;
}

static void place_on_line(const struct rho_learned_reflector *line, float along_m, float *x_m,
                          float *y_m)
{
    const float across_m = line_across_at(line, along_m);
    *x_m = line->x_m + along_m * line->cos_along - across_m * line->sin_along;
    *y_m = line->y_m + along_m * line->sin_along + across_m * line->cos_along;
}

/* Length that is added at each end of a line shorter than the shortest wall. */
static float extension_of_short_line_m(const struct rho_learned_reflector *line)
{
    return rho_larger(RHO_REFLECTOR_LEAST_M - (line->to_m - line->from_m), 0.0f);
}

static struct rho_reflector wall_of_line(const struct rho_learned_reflector *line)
{
    struct rho_reflector wall;
    const float more_m = extension_of_short_line_m(line);
    place_on_line(line, line->from_m - more_m, &wall.from_x_m, &wall.from_y_m);
    place_on_line(line, line->to_m + more_m, &wall.to_x_m, &wall.to_y_m);
    return wall;
}

/* Witnesses */

/*
 * The scan of a step, the tracker's results, and the number of images that may still be looked for.
 */
struct observation {
    const struct rho_scan *scan;
    const struct rho_sensor *sensor;
    const struct rho_report *report;
    float noise_density;
    const struct rho_tracker *tracker;
    unsigned images_left;
};

/* Row of the nearest plot in the gate of an image, those of the target left out; -1: none. */
static int32_t nearest_other_plot(const struct observation *observation,
                                  const struct rho_kalman *image,
                                  const struct rho_track_report *target)
{
    const struct rho_groups *groups = &observation->tracker->bodies.groups;
    struct rho_gate gate;
    struct rho_gate_result result;
    float least = 0.0f;
    int32_t nearest = -1;
    rho_gate_open(&gate, image, observation->noise_density, observation->sensor,
                  observation->scan->measures);
    for (uint32_t i = 0; i < observation->scan->num_plots; i++) {
        const struct rho_plot *plot = &observation->scan->plots[i];
        const int is_of_target = (int32_t)i == target->plot ||
                                 (rho_bodies_are_used(observation->tracker) && i < RHO_BODY_PLOTS &&
                                  groups->of[i] == groups->of[target->plot]);
        if (!is_of_target && rho_measurement_is_valid_plot(plot, observation->scan->measures) &&
            rho_gate_test(&gate, plot, &result) && (nearest < 0 || result.distance2 < least)) {
            least = result.distance2;
            nearest = (int32_t)i;
        }
    }
    return nearest;
}

/*
 * Refines and lengthens a line by the plot of a target's image: the line is half way between both.
 * Returns the distance of that place from the line as it was before.
 */
static float refine_by_image(struct rho_learned_reflector *line,
                             const struct observation *observation,
                             const struct rho_track_report *target, const struct rho_plot *plot,
                             float crossing_m)
{
    struct rho_measurement seen;
    float noise[6], along_m, across_m;
    rho_measurement_from_plot(plot, 0, observation->sensor, &seen);
    rho_measurement_covariance(&seen, noise);
    const float after_s = (float)plot->offset_us * 1e-6f;
    to_line_frame(line, 0.5f * (target->state[RHO_X] + after_s * target->state[RHO_VX] + plot->x_m),
                  0.5f * (target->state[RHO_Y] + after_s * target->state[RHO_VY] + plot->y_m),
                  &along_m, &across_m);
    const float variance_m2 =
        0.25f * (variance_along(target->covariance, RHO_X, -line->sin_along, line->cos_along) +
                 variance_along(noise, RHO_X, -line->sin_along, line->cos_along));
    const float off_m = across_m - line_across_at(line, along_m);
    refine_line(line, along_m, across_m, (float)ALIKE_LOOKS * variance_m2);
    lengthen_line_to(line, crossing_m);
    line->sigma_m += 0.05f * (target->sigma_m - line->sigma_m);
    return off_m;
}

/* True of a line that is used as a wall, or that enough pairs of tracks support. */
static int is_worth_observing(const struct rho_learned_reflector *line)
{
    return line->is_taken && (line->is_used || line->pairs >= OBSERVED_PAIRS);
}

/*
 * True where another observed line lies between the sensor and the track. The track may then be an
 * image itself, which has no image of its own, and it does not count against this line.
 */
static int may_be_image_in_other(const struct rho_reflector_learning *learning,
                                 const struct rho_learned_reflector *line,
                                 const struct rho_sensor *sensor,
                                 const struct rho_track_report *track)
{
    const float x_m = sensor ? sensor->x_m : 0.0f, y_m = sensor ? sensor->y_m : 0.0f;
    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        const struct rho_learned_reflector *other = &learning->lines[i];
        float from_m, to_m;
        if (other == line || !is_worth_observing(other)) {
            continue;
        }
        const float sensor_m = off_line_m(other, x_m, y_m, &from_m);
        const float track_m = off_line_m(other, track->state[RHO_X], track->state[RHO_Y], &to_m);
        if (sensor_m * track_m < 0.0f) {
            const float at_m = from_m + (to_m - from_m) * sensor_m / (sensor_m - track_m);
            if (at_m >= other->from_m && at_m <= other->to_m) {
                return 1;
            }
        }
    }
    return 0;
}

static void count_verdict(struct rho_reflector_learning *learning,
                          struct rho_learned_reflector *line, const struct rho_sensor *sensor,
                          const struct rho_reflector_witness *witness,
                          const struct rho_track_report *target)
{
    if (witness->hits <= HITS_OF_OTHER * (witness->other + 1)) {
        line->witnesses_against =
            (uint16_t)(line->witnesses_against +
                       !may_be_image_in_other(learning, line, sensor, target));
    } else {
        float along_m;
        const float off_m = off_line_m(line, target->state[RHO_X], target->state[RHO_Y], &along_m);
        if (line->witnesses_for == 0) {
            line->first = learning->steps;
        } else if (witness->since > line->first && line->late_ones < UINT8_MAX) {
            line->late_ones++;
        }
        line->witnesses_for++;
        /* means of the distance at which witnesses passed, and of how far off the line they were */
        const float image_off_m = witness->off_m / (float)witness->hits;
        const float gain = 1.0f / (float)line->witnesses_for;
        const float more_m = rho_magnitude(off_m) - line->distance_m;
        line->distance_m += gain * more_m;
        line->distance_m2 = (1.0f - gain) * (line->distance_m2 + gain * more_m * more_m);
        line->off_m2 += gain * (image_off_m * image_off_m - line->off_m2);
    }
    if (line->witnesses_for + line->witnesses_against >= MEMORY_WITNESSES) {
        line->witnesses_for /= 2;
        line->witnesses_against /= 2;
    }
}

/*
 * True where the image is farther away than the target's body reaches: plots of the body would
 * otherwise be taken for the image's.
 */
static int is_image_outside_body(const struct observation *observation,
                                 const struct rho_track_report *target,
                                 const struct rho_kalman *image)
{
    const struct rho_tracker *tracker = observation->tracker;
    const float dx_m = image->state[RHO_X] - target->state[RHO_X],
                dy_m = image->state[RHO_Y] - target->state[RHO_Y];
    const unsigned row = (unsigned)(target - observation->report->tracks);
    struct rho_body body;
    if (!rho_bodies_are_used(tracker) || !rho_tracker_body_of(tracker, row, &body)) {
        return 1;
    }
    const float c = rho_cos(body.heading_rad), s = rho_sin(body.heading_rad);
    const float along_m = c * dx_m + s * dy_m, across_m = c * dy_m - s * dx_m;
    const float length_m = body.length_m + ERROR_SIGMAS * body.sigma_length_m,
                width_m = body.width_m + ERROR_SIGMAS * body.sigma_width_m;
    return along_m > length_m || along_m < -length_m || across_m > width_m || across_m < -width_m;
}

/*
 * Looks for a plot at the image of a track in a line, and for comparison at a place beside it that
 * the gate does not reach. Counts both for the track's witness, and the verdict after JUDGED_LOOKS
 * looks.
 */
static void look_for_image(struct rho_reflector_learning *learning,
                           struct rho_learned_reflector *line, struct observation *observation,
                           const struct rho_track_report *target)
{
    const struct rho_scan *scan = observation->scan;
    const struct rho_sensor *sensor = observation->sensor;
    const struct rho_reflector wall = wall_of_line(line);
    struct rho_kalman of, image;
    float crossing_m;
    memcpy(of.state, target->state, sizeof of.state);
    memcpy(of.covariance, target->covariance, sizeof of.covariance);
    const float slack_m = line->is_used ? 0.1f * (line->to_m - line->from_m) : 0.0f;
    if (!rho_reflector_mirror_state(&wall, sensor, slack_m, &of, &image, &crossing_m)) {
        return;
    }
    const struct rho_plot at = {
        .x_m = image.state[RHO_X], .y_m = image.state[RHO_Y], .z_m = image.state[RHO_Z]};
    const float from_x_m = sensor ? sensor->x_m : 0.0f, from_y_m = sensor ? sensor->y_m : 0.0f;
    if (!rho_coverage_holds_plot(sensor, &at, scan->measures) ||
        !rho_angle_in_sector(rho_atan2(at.y_m - from_y_m, at.x_m - from_x_m), scan->sector_from_rad,
                             scan->sector_to_rad)) {
        return;
    }
    crossing_m += line->from_m - extension_of_short_line_m(line);
    /* the line's error moves the image twice as far, across the line */
    const float variance_m2 = 4.0f * line_variance_at(line, crossing_m);
    const float c = line->cos_along, s = line->sin_along;
    image.covariance[RHO_AT(RHO_X, RHO_X)] += variance_m2 * s * s;
    image.covariance[RHO_AT(RHO_Y, RHO_X)] -= variance_m2 * s * c;
    image.covariance[RHO_AT(RHO_Y, RHO_Y)] += variance_m2 * c * c;
    struct rho_reflector_witness *witness = NULL; /* the track's, or else a free one */
    for (unsigned i = 0; i < RHO_REFLECTOR_WITNESSES; i++) {
        struct rho_reflector_witness *other = &line->witnesses[i];
        if (other->track_id == target->track_id || (!witness && other->track_id == 0)) {
            witness = other;
        }
        if (other->track_id == target->track_id) {
            break;
        }
    }
    if (!witness || !is_image_outside_body(observation, target, &image)) {
        return;
    }
    if (witness->track_id == 0) {
        *witness =
            (struct rho_reflector_witness){.track_id = target->track_id, .since = learning->steps};
    }
    observation->images_left--;
    const int32_t nearest = nearest_other_plot(observation, &image, target);
    const float off_m =
        nearest >= 0 ? refine_by_image(line, observation, target, &scan->plots[nearest], crossing_m)
                     : 0.0f;
    if (witness->looks >= JUDGED_LOOKS || crossing_m < line->from_m || crossing_m > line->to_m) {
        return;
    }
    /* half sides of the image's gate, for a plot as uncertain as the target's */
    struct rho_gate gate;
    float half_m[2];
    rho_gate_open(&gate, &image, observation->noise_density, sensor, scan->measures);
    rho_gate_box(&gate, rho_plot_sigma_m(&scan->plots[target->plot]), 0.0f, half_m);
    const float reach_m = half_m[0] + half_m[1];
    const float beside_m = witness->looks % 2u ? 2.0f * reach_m : -2.0f * reach_m;
    image.state[RHO_X] += beside_m * line->cos_along;
    image.state[RHO_Y] += beside_m * line->sin_along;
    witness->hits = (uint16_t)(witness->hits + (nearest >= 0));
    witness->off_m += off_m;
    witness->other =
        (uint16_t)(witness->other + (nearest_other_plot(observation, &image, target) >= 0));
    witness->looks++;
    if (witness->looks == JUDGED_LOOKS) {
        count_verdict(learning, line, sensor, witness, target);
    }
}

/* Walls */

/*
 * True where both ends of a line lie on a known wall or its extension, and the two overlap. A line
 * behind a gap is a wall of its own.
 */
static int does_line_lie_on_wall(const struct rho_learned_reflector *line,
                                 const struct rho_reflector *wall)
{
    const float limit_m = APART_SIGMAS * line->sigma_m;
    float x_m[2], y_m[2], along_m[2];
    place_on_line(line, line->from_m, &x_m[0], &y_m[0]);
    place_on_line(line, line->to_m, &x_m[1], &y_m[1]);
    const float along_x_m = wall->to_x_m - wall->from_x_m,
                along_y_m = wall->to_y_m - wall->from_y_m;
    const float length_m = rho_sqrt(along_x_m * along_x_m + along_y_m * along_y_m);
    for (int i = 0; i < 2; i++) {
        const float off_m =
            ((y_m[i] - wall->from_y_m) * along_x_m - (x_m[i] - wall->from_x_m) * along_y_m) /
            length_m;
        if (!(off_m <= limit_m && off_m >= -limit_m)) {
            return 0;
        }
        along_m[i] =
            ((x_m[i] - wall->from_x_m) * along_x_m + (y_m[i] - wall->from_y_m) * along_y_m) /
            length_m;
    }
    return (along_m[0] >= -limit_m || along_m[1] >= -limit_m) &&
           (along_m[0] <= length_m + limit_m || along_m[1] <= length_m + limit_m);
}

static void forget_line(struct rho_learned_reflector *line)
{
    line->is_taken = line->is_used = 0;
    line->pairs = 0.0f;
}

/*
 * Forgets a line with more witnesses against it than for it; uses it as a wall where it passes as
 * one, unless the tracker knows that wall already.
 */
static void judge_line(struct rho_reflector_learning *learning, const struct rho_tracker *tracker,
                       const struct rho_sensor *sensor, struct rho_learned_reflector *line)
{
    const float sigma_m2 = line->sigma_m * line->sigma_m;
    float along_m;
    const float sensor_m =
        off_line_m(line, sensor ? sensor->x_m : 0.0f, sensor ? sensor->y_m : 0.0f, &along_m);
    if (line->witnesses_against > line->witnesses_for + 1) {
        forget_line(line);
        return;
    }
    /*
     * The line must be as precise as tracks' places are, and the distances at which witnesses
     * passed must spread more than errors explain: two lanes mirror one another at one distance,
     * but for errors and for the cars' places in their lanes. A line through the sensor is no wall:
     * what it sees along one is nobody's image.
     */
    if (!line->is_taken || line->is_used || line->witnesses_for < WALL_WITNESSES ||
        line->witnesses_for < WALL_WITNESSES * line->witnesses_against ||
        line->late_ones < WALL_LATE_ONES ||
        !(line->distance_m2 >= ERROR_SIGMAS * ERROR_SIGMAS * (line->off_m2 + sigma_m2)) ||
        !(sensor_m * sensor_m > ERROR_SIGMAS * ERROR_SIGMAS * sigma_m2) ||
        !(line_variance_at(line, line->from_m) <= sigma_m2) ||
        !(line_variance_at(line, line->to_m) <= sigma_m2)) {
        return;
    }
    line->is_used = learning->num_told + learning->num_used < RHO_MAX_REFLECTORS;
    for (unsigned i = 0; i < tracker->num_reflectors; i++) {
        if (does_line_lie_on_wall(line, &tracker->reflectors[i])) {
            forget_line(line);
        }
    }
    learning->num_used = (uint16_t)(learning->num_used + line->is_used);
}

int rho_reflector_learning_wall(const struct rho_reflector_learning *learning, unsigned place,
                                struct rho_reflector *reflector)
{
    if (!learning || !reflector || place >= RHO_LEARNED_REFLECTORS ||
        !learning->lines[place].is_used) {
        return 0;
    }
    *reflector = wall_of_line(&learning->lines[place]);
    return 1;
}

/* Lists the walls that the tracker was told, and behind them learned ones; returns their number. */
static unsigned list_walls(const struct rho_reflector_learning *learning,
                           const struct rho_tracker *tracker, struct rho_reflector *walls)
{
    unsigned count = learning->num_told;
    memcpy(walls, tracker->reflectors, count * sizeof walls[0]);
    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS && count != RHO_MAX_REFLECTORS; i++) {
        count += rho_reflector_learning_wall(learning, i, &walls[count]) != 0;
    }
    return count;
}

enum rho_status rho_reflector_learning_step(struct rho_reflector_learning *learning,
                                            struct rho_tracker *tracker,
                                            const struct rho_scan *scan,
                                            const struct rho_report *report)
{
    if (!learning || !tracker || !scan || !report || (scan->num_plots && !scan->plots)) {
        return RHO_ERROR_NULL;
    }
    if (learning->magic != MAGIC || !rho_tracker_is_ready(tracker)) {
        return RHO_ERROR_STATE;
    }
    if (RHO_MAX_REFLECTORS == 0) {
        return RHO_ERROR_CAPACITY;
    }
    if (scan->time_us < tracker->time_us) {
        return RHO_OK;
    }
    if (report->time_us != scan->time_us || report->num_tracks > RHO_MAX_TRACKS) {
        return RHO_ERROR_VALUE;
    }
    struct rho_reflector walls[RHO_MAX_REFLECTORS > 0 ? RHO_MAX_REFLECTORS : 1];
    unsigned count = list_walls(learning, tracker, walls);
    if (count != (unsigned)learning->num_told + learning->num_used ||
        count != tracker->num_reflectors ||
        memcmp(walls, tracker->reflectors, count * sizeof walls[0]) != 0) {
        /* not the walls that the last step gave the tracker: the caller has told it others */
        learning->num_told = tracker->num_reflectors;
        learning->num_used = 0;
    }
    const unsigned of_plots = scan->num_plots > 0 ? PLOTS_MAX / (2u * scan->num_plots) : IMAGES_MAX;
    struct observation observation = {.scan = scan,
                                      .sensor = rho_sensors_find(tracker, scan->sensor_id),
                                      .noise_density = 1.0f,
                                      .tracker = tracker,
                                      .report = report,
                                      .images_left =
                                          of_plots < IMAGES_MAX ? of_plots + 1u : IMAGES_MAX};
    const int has_walls = learning->num_used > 0;
    learning->steps++;
    rho_reflector_learning_pairs(learning, observation.sensor, scan, report);
    /* looks for the images of all tracks in each line worth observing, up to the limit of images */
    for (unsigned k = 0; k < RHO_LEARNED_REFLECTORS && observation.images_left > 0; k++) {
        struct rho_learned_reflector *line =
            &learning->lines[(learning->next_line + k) % RHO_LEARNED_REFLECTORS];
        if (!is_worth_observing(line)) {
            continue;
        }
        for (unsigned i = 0; i < RHO_REFLECTOR_WITNESSES; i++) { /* forgets ended ones */
            unsigned row = 0;
            while (row < report->num_tracks &&
                   report->tracks[row].track_id != line->witnesses[i].track_id) {
                row++;
            }
            if (row == report->num_tracks) {
                line->witnesses[i].track_id = 0;
            }
        }
        for (unsigned i = 0; i < report->num_tracks && observation.images_left > 0; i++) {
            const struct rho_track_report *target = &report->tracks[i];
            if (may_have_image(target, scan)) {
                look_for_image(learning, line, &observation, target);
            }
        }
    }
    learning->next_line = (learning->next_line + 1u) % RHO_LEARNED_REFLECTORS;
    unsigned num_used = 0;
    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        judge_line(learning, tracker, observation.sensor, &learning->lines[i]);
        num_used += learning->lines[i].is_used;
    }
    if (!has_walls && num_used == 0) {
        return RHO_OK;
    }
    count = list_walls(learning, tracker, walls);
    learning->num_used = (uint16_t)(count - learning->num_told);
    return rho_tracker_set_reflectors(tracker, walls, count);
}

static int is_sound_line(const struct rho_learned_reflector *line)
{
    const float *p = line->variance; /* of the offset, m^2, and of the slope */
    const float one = line->cos_along * line->cos_along + line->sin_along * line->sin_along;
    for (unsigned i = 0; i < RHO_REFLECTOR_WITNESSES; i++) {
        if (!rho_is_within(line->witnesses[i].off_m, -1e9f, 1e9f)) {
            return 0;
        }
    }
    if (line->is_taken > 1 || line->is_used > line->is_taken || !rho_is_coordinate(line->x_m) ||
        !rho_is_coordinate(line->y_m) || !rho_is_coordinate(line->offset_m) ||
        !rho_is_within(line->slope, -10.0f, 10.0f) || !rho_is_within(p[0], 0.0f, 1e12f) ||
        !rho_is_within(p[2], 0.0f, 1e12f) ||
        !(p[1] * p[1] <= 1.01f * p[0] * p[2]) || /* rounding allowed for */
        !rho_is_coordinate(line->from_m) || !rho_is_coordinate(line->to_m) ||
        !rho_is_within(line->distance_m, 0.0f, 1e9f) ||
        !rho_is_within(line->distance_m2, 0.0f, 1e18f) ||
        !rho_is_within(line->off_m2, 0.0f, 1e18f) || !rho_is_within(line->pairs, -1.0f, 1e9f) ||
        !rho_is_within(line->sigma_m, 0.0f, 1e6f)) {
        return 0;
    }
    if (!line->is_taken) {
        return 1;
    }
    if (!rho_is_within(one, 0.999f, 1.001f) || !(line->from_m <= line->to_m)) {
        return 0;
    }
    /* the places of a line that is in use can be a wall of the tracker */
    const struct rho_reflector wall = wall_of_line(line);
    return rho_is_coordinate(wall.from_x_m) && rho_is_coordinate(wall.from_y_m) &&
           rho_is_coordinate(wall.to_x_m) && rho_is_coordinate(wall.to_y_m);
}

int rho_reflector_learning_is_sound(const struct rho_reflector_learning *learning)
{
    if (learning->magic != MAGIC || learning->num_told > RHO_MAX_REFLECTORS ||
        learning->num_used > RHO_MAX_REFLECTORS || learning->next_line >= RHO_LEARNED_REFLECTORS) {
        return 0;
    }
    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        if (!is_sound_line(&learning->lines[i])) {
            return 0;
        }
    }
    return 1;
}
