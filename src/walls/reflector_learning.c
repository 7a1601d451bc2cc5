/* SPDX-License-Identifier: MIT */
/*
 * reflector_learning: lines between tracks and their images are observed until they are walls.
 */
#include "rhotrack/reflectors.h"

#include <string.h>

#include "../tracker/images.h"
#include "../tracker/step.h"
#include "learned_line.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/gate.h"
#include "rhotrack/detail/linalg.h"

#define MAGIC 0x52464c4eu /* "RFLN" */

/* Work of a step: images; plots that are compared with them, over all images. */
#define IMAGES_MAX 16u
#define PLOTS_MAX 65536u

/* ---- witnesses ---- */
#define OBSERVED_PAIRS 3.0f /* from which a line is observed */
#define JUDGED_LOOKS 24
#define FOR_HITS 4 /* of these, and of each plot beside the image so many more: */
#define HITS_OF_OTHER 3

/* ---- walls ---- */
#define WALL_WITNESSES 4
#define WALL_RATIO 4
#define WALL_LATE_ONES 2
#define WALL_SPREAD 3.0f /* of distances at which witnesses passed, over what errors explain */
#define WALL_SIGMA 1.0f
#define MEMORY_WITNESSES 16 /* both counts are halved there */

/* Two lines are one where their ends are so near: tracks' sigmas. */
#define SAME_SIGMAS 6.0f

/* A line that is not known better than so has no use for its neighbours: m, m and 1. */
#define VARIANCE_MAX 1e12f
/* What rounding may leave of a covariance over the root of its variances' product, squared. */
#define VARIANCE_ROUNDING 1.01f

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

/* ---- places on a line ------------------------------------------------------------------------ */

static void place_on_line(const struct rho_learned_reflector *line, float along_m, float *x_m,
                          float *y_m)
{
    const float across_m = across_at(line, along_m);
    *x_m = line->x_m + along_m * line->cos_along - across_m * line->sin_along;
    *y_m = line->y_m + along_m * line->sin_along + across_m * line->cos_along;
}

/* How much farther a wall reaches than a short line, on either end. */
static float reach_beyond_line_m(const struct rho_learned_reflector *line)
{
    const float short_m = RHO_REFLECTOR_LEAST_M - (line->to_m - line->from_m);
    return short_m > 0.0f ? short_m : 0.0f;
}

static struct rho_reflector wall_of(const struct rho_learned_reflector *line)
{
    struct rho_reflector wall;
    const float more_m = reach_beyond_line_m(line);
    place_on_line(line, line->from_m - more_m, &wall.from_x_m, &wall.from_y_m);
    place_on_line(line, line->to_m + more_m, &wall.to_x_m, &wall.to_y_m);
    return wall;
}

/* ---- witnesses ------------------------------------------------------------------------------- */

/* The scan, and what a sensor could see of an image in it. */
struct look {
    const struct rho_scan *scan;
    const struct rho_sensor *sensor;
    const struct rho_report *report;
    float noise_density;
    const struct rho_tracker *tracker;
    unsigned images_left;
};

static int looked_at(const struct look *look, const struct rho_kalman *image)
{
    const struct rho_plot at = {
        .x_m = image->state[RHO_X], .y_m = image->state[RHO_Y], .z_m = image->state[RHO_Z]};
    const float from_x_m = look->sensor ? look->sensor->x_m : 0.0f,
                from_y_m = look->sensor ? look->sensor->y_m : 0.0f;
    return rho_tracker_covers(look->sensor, &at, look->scan->measures) &&
           rho_angle_in_sector(rho_atan2(at.y_m - from_y_m, at.x_m - from_x_m),
                               look->scan->sector_from_rad, look->scan->sector_to_rad);
}

/* The plot is the target's, or another one of its body. */
static int is_plot_of_target(const struct look *look, const struct rho_track_report *target,
                             uint32_t plot)
{
    const struct rho_groups *groups = &look->tracker->bodies.groups;
    return (int32_t)plot == target->plot ||
           (rho_tracker_has_bodies(look->tracker) && plot < RHO_BODY_PLOTS &&
            groups->of[plot] == groups->of[target->plot]);
}

/* The row of the nearest plot in the gate that is not the target's own, -1: none. */
static int32_t nearest_plot(const struct look *look, const struct rho_kalman *image,
                            const struct rho_track_report *target)
{
    struct rho_gate gate;
    struct rho_gate_result result;
    float least = 0.0f;
    int32_t nearest = -1;
    rho_gate_open(&gate, image, look->noise_density, look->sensor, look->scan->measures);
    for (uint32_t i = 0; i < look->scan->num_plots; i++) {
        const struct rho_plot *plot = &look->scan->plots[i];
        if (!is_plot_of_target(look, target, i) &&
            rho_measurement_is_valid(plot, look->scan->measures) &&
            rho_gate_test(&gate, plot, &result) && (nearest < 0 || result.distance2 < least)) {
            least = result.distance2;
            nearest = (int32_t)i;
        }
    }
    return nearest;
}

/* What is not known of the line widens the image's gate: twice its error, across it. */
static void widen_image_gate(const struct rho_learned_reflector *line, float along_m,
                             struct rho_kalman *image)
{
    const float variance_m2 = 4.0f * variance_at(line, along_m);
    const float c = line->cos_along, s = line->sin_along;
    image->covariance[RHO_AT(RHO_X, RHO_X)] += variance_m2 * s * s;
    image->covariance[RHO_AT(RHO_Y, RHO_X)] -= variance_m2 * s * c;
    image->covariance[RHO_AT(RHO_Y, RHO_Y)] += variance_m2 * c * c;
}

/* A target's image has a plot: the line is half way between both. How far off it was. */
static float learn_place(struct rho_learned_reflector *line, const struct look *look,
                         const struct rho_track_report *target, const struct rho_plot *plot,
                         float crossing_m)
{
    struct rho_measurement seen;
    float noise[6], along_m, across_m;
    rho_measurement_open(plot, 0, look->sensor, &seen);
    rho_measurement_covariance(&seen, noise);
    const float after_s = (float)plot->offset_us * 1e-6f;
    to_frame(line, 0.5f * (target->state[RHO_X] + after_s * target->state[RHO_VX] + plot->x_m),
             0.5f * (target->state[RHO_Y] + after_s * target->state[RHO_VY] + plot->y_m), &along_m,
             &across_m);
    const float variance_m2 =
        0.25f * (variance_along(target->covariance, RHO_X, -line->sin_along, line->cos_along) +
                 variance_along(noise, RHO_X, -line->sin_along, line->cos_along));
    const float off_m = across_m - across_at(line, along_m);
    refine_line(line, along_m, across_m, REPEATED * variance_m2);
    lengthen_line_to(line, crossing_m);
    line->sigma_m += 0.05f * (target->sigma_m - line->sigma_m);
    return off_m;
}

static int is_observed(const struct rho_learned_reflector *line)
{
    return line->is_taken && (line->is_used || line->pairs >= OBSERVED_PAIRS);
}

/* Counts one more witness: where it passed, and how far its images were off. */
static void note_distance(struct rho_learned_reflector *line, float distance_m, float off_m)
{
    const float gain = 1.0f / (float)line->witnesses_for, more_m = distance_m - line->distance_m;
    line->distance_m += gain * more_m;
    line->distance_m2 = (1.0f - gain) * (line->distance_m2 + gain * more_m * more_m);
    line->off_m2 += gain * (off_m * off_m - line->off_m2);
}

/*
 * The track is seen across another line that is observed: it may be an image in that one, which
 * has none itself, and says nothing against this line.
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
        if (other == line || !is_observed(other)) {
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

static void judge_by_witness(struct rho_reflector_learning *learning,
                             struct rho_learned_reflector *line, const struct rho_sensor *sensor,
                             const struct rho_reflector_witness *witness,
                             const struct rho_track_report *target)
{
    if (witness->hits < FOR_HITS + HITS_OF_OTHER * witness->other) {
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
        note_distance(line, off_m < 0.0f ? -off_m : off_m, witness->off_m / (float)witness->hits);
    }
    if (line->witnesses_for + line->witnesses_against >= MEMORY_WITNESSES) {
        line->witnesses_for /= 2;
        line->witnesses_against /= 2;
    }
}

/* The place of a witness, or a free one; NULL: there is none. */
static struct rho_reflector_witness *witness_of(struct rho_learned_reflector *line,
                                                uint32_t track_id)
{
    struct rho_reflector_witness *found = 0;
    for (unsigned i = 0; i < RHO_REFLECTOR_WITNESSES; i++) {
        struct rho_reflector_witness *witness = &line->witnesses[i];
        if (witness->track_id == track_id) {
            return witness;
        }
        if (!found && witness->track_id == 0) {
            found = witness;
        }
    }
    return found;
}

static void forget_ended_witnesses(struct rho_learned_reflector *line,
                                   const struct rho_report *report)
{
    for (unsigned i = 0; i < RHO_REFLECTOR_WITNESSES; i++) {
        struct rho_reflector_witness *witness = &line->witnesses[i];
        unsigned row = 0;
        while (row < report->num_tracks && report->tracks[row].track_id != witness->track_id) {
            row++;
        }
        if (row == report->num_tracks) {
            witness->track_id = 0;
        }
    }
}

/* How far the gate of the image reaches, with plots as uncertain as the target's own. */
static float reach_of_gate(const struct look *look, const struct rho_track_report *target,
                           const struct rho_kalman *image)
{
    const float sigma_m = rho_plot_sigma_m(&look->scan->plots[target->plot]);
    struct rho_gate gate;
    float half_m[2];
    rho_gate_open(&gate, image, look->noise_density, look->sensor, look->scan->measures);
    rho_gate_box(&gate, sigma_m, 0.0f, half_m);
    return half_m[0] + half_m[1];
}

/* Neither is on the other's body: plots of the target's own would be taken for the image's. */
static int is_apart(const struct look *look, const struct rho_track_report *target,
                    const struct rho_kalman *image)
{
    const struct rho_tracker *tracker = look->tracker;
    const float dx_m = image->state[RHO_X] - target->state[RHO_X],
                dy_m = image->state[RHO_Y] - target->state[RHO_Y];
    const unsigned row = (unsigned)(target - look->report->tracks);
    struct rho_body body;
    if (!rho_tracker_has_bodies(tracker) || !rho_tracker_body_of(tracker, row, &body)) {
        return 1;
    }
    const float c = rho_cos(body.heading_rad), s = rho_sin(body.heading_rad);
    const float along_m = c * dx_m + s * dy_m, across_m = c * dy_m - s * dx_m;
    const float length_m = body.length_m + 3.0f * body.sigma_length_m,
                width_m = body.width_m + 3.0f * body.sigma_width_m;
    return along_m > length_m || along_m < -length_m || across_m > width_m || across_m < -width_m;
}

/* Looks for a plot at the track's image, and once as far beside it as the gate does not reach. */
static void look_at_image(struct rho_reflector_learning *learning,
                          struct rho_learned_reflector *line, struct look *look,
                          const struct rho_track_report *target)
{
    const struct rho_reflector wall = wall_of(line);
    struct rho_kalman of, image;
    float crossing_m;
    memcpy(of.state, target->state, sizeof of.state);
    memcpy(of.covariance, target->covariance, sizeof of.covariance);
    const float slack_m = line->is_used ? 0.1f * (line->to_m - line->from_m) : 0.0f;
    if (!rho_reflector_image(&wall, look->sensor, slack_m, &of, &image, &crossing_m) ||
        !looked_at(look, &image)) {
        return;
    }
    crossing_m += line->from_m - reach_beyond_line_m(line);
    widen_image_gate(line, crossing_m, &image);
    struct rho_reflector_witness *witness = witness_of(line, target->track_id);
    if (!witness || !is_apart(look, target, &image)) {
        return;
    }
    if (witness->track_id == 0) {
        *witness =
            (struct rho_reflector_witness){.track_id = target->track_id, .since = learning->steps};
    }
    look->images_left--;
    const int32_t nearest = nearest_plot(look, &image, target);
    const float off_m =
        nearest >= 0 ? learn_place(line, look, target, &look->scan->plots[nearest], crossing_m)
                     : 0.0f;
    if (witness->looks >= JUDGED_LOOKS || crossing_m < line->from_m || crossing_m > line->to_m) {
        return;
    }
    const float reach_m = reach_of_gate(look, target, &image);
    const float beside_m = witness->looks % 2u ? 2.0f * reach_m : -2.0f * reach_m;
    image.state[RHO_X] += beside_m * line->cos_along;
    image.state[RHO_Y] += beside_m * line->sin_along;
    witness->hits = (uint16_t)(witness->hits + (nearest >= 0));
    witness->off_m += off_m;
    witness->other = (uint16_t)(witness->other + (nearest_plot(look, &image, target) >= 0));
    witness->looks++;
    if (witness->looks == JUDGED_LOOKS) {
        judge_by_witness(learning, line, look->sensor, witness, target);
    }
}

static void look_at_images(struct rho_reflector_learning *learning, struct look *look,
                           const struct rho_report *report)
{
    for (unsigned k = 0; k < RHO_LEARNED_REFLECTORS && look->images_left > 0; k++) {
        struct rho_learned_reflector *line =
            &learning->lines[(learning->next_line + k) % RHO_LEARNED_REFLECTORS];
        if (!is_observed(line)) {
            continue;
        }
        forget_ended_witnesses(line, report);
        for (unsigned i = 0; i < report->num_tracks && look->images_left > 0; i++) {
            const struct rho_track_report *target = &report->tracks[i];
            if (is_target(target, look->scan)) {
                look_at_image(learning, line, look, target);
            }
        }
    }
    learning->next_line = (learning->next_line + 1u) % RHO_LEARNED_REFLECTORS;
}

/* ---- walls ----------------------------------------------------------------------------------- */

/* The line lies on the wall, or makes it longer; behind a gap another one may follow. */
static int is_on_known_wall(const struct rho_learned_reflector *line,
                            const struct rho_reflector *wall)
{
    const float limit_m = SAME_SIGMAS * line->sigma_m;
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

static int is_well_known(const struct rho_learned_reflector *line)
{
    const float limit_m2 = WALL_SIGMA * WALL_SIGMA * line->sigma_m * line->sigma_m;
    return variance_at(line, line->from_m) <= limit_m2 && variance_at(line, line->to_m) <= limit_m2;
}

/* Lanes mirror one another at one distance, but for errors and for cars' places in them. */
static int is_spread(const struct rho_learned_reflector *line)
{
    return line->distance_m2 >=
           WALL_SPREAD * WALL_SPREAD * (line->off_m2 + line->sigma_m * line->sigma_m);
}

static int is_wall(const struct rho_learned_reflector *line)
{
    return line->witnesses_for >= WALL_WITNESSES &&
           line->witnesses_for >= WALL_RATIO * line->witnesses_against &&
           line->late_ones >= WALL_LATE_ONES && is_spread(line) && is_well_known(line);
}

static void forget_line(struct rho_learned_reflector *line)
{
    line->is_taken = line->is_used = 0;
    line->pairs = 0.0f;
}

/* Walls that the tracker knows already are not learned. */
static void decide_on_line(struct rho_reflector_learning *learning,
                           const struct rho_tracker *tracker, struct rho_learned_reflector *line)
{
    if (line->witnesses_against > line->witnesses_for + 1) {
        forget_line(line);
    } else if (line->is_taken && !line->is_used && is_wall(line)) {
        line->is_used = learning->num_told + learning->num_used < RHO_MAX_REFLECTORS;
        for (unsigned i = 0; i < tracker->num_reflectors; i++) {
            if (is_on_known_wall(line, &tracker->reflectors[i])) {
                forget_line(line);
            }
        }
        learning->num_used = (uint16_t)(learning->num_used + line->is_used);
    }
}

int rho_reflector_learning_wall(const struct rho_reflector_learning *learning, unsigned place,
                                struct rho_reflector *reflector)
{
    if (!learning || !reflector || place >= RHO_LEARNED_REFLECTORS ||
        !learning->lines[place].is_used) {
        return 0;
    }
    *reflector = wall_of(&learning->lines[place]);
    return 1;
}

static int are_equal(const struct rho_reflector *a, const struct rho_reflector *b)
{
    return !(a->from_x_m < b->from_x_m || a->from_x_m > b->from_x_m || a->from_y_m < b->from_y_m ||
             a->from_y_m > b->from_y_m || a->to_x_m < b->to_x_m || a->to_x_m > b->to_x_m ||
             a->to_y_m < b->to_y_m || a->to_y_m > b->to_y_m);
}

/* The tracker has the walls that set_walls gave it last. */
static int are_walls_set(const struct rho_reflector_learning *learning,
                         const struct rho_tracker *tracker)
{
    const unsigned all = (unsigned)learning->num_told + learning->num_used;
    unsigned count = learning->num_told;
    struct rho_reflector wall;
    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS && count < all; i++) {
        if (!rho_reflector_learning_wall(learning, i, &wall)) {
            continue;
        }
        if (count >= tracker->num_reflectors || !are_equal(&wall, &tracker->reflectors[count])) {
            return 0;
        }
        count++;
    }
    return count == all && tracker->num_reflectors == all;
}

/* Gives the tracker the walls that were told, and behind them those learned. */
static enum rho_status set_walls(struct rho_reflector_learning *learning,
                                 struct rho_tracker *tracker)
{
    struct rho_reflector walls[RHO_MAX_REFLECTORS > 0 ? RHO_MAX_REFLECTORS : 1];
    unsigned count = learning->num_told;
    memcpy(walls, tracker->reflectors, count * sizeof walls[0]);
    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS && count != RHO_MAX_REFLECTORS; i++) {
        count += rho_reflector_learning_wall(learning, i, &walls[count]) != 0;
    }
    learning->num_used = (uint16_t)(count - learning->num_told);
    return rho_tracker_set_reflectors(tracker, walls, count);
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
    if (!are_walls_set(learning, tracker)) {
        learning->num_told = tracker->num_reflectors; /* others were told */
        learning->num_used = 0;
    }
    const unsigned of_plots = scan->num_plots > 0 ? PLOTS_MAX / (2u * scan->num_plots) : IMAGES_MAX;
    struct look look = {.scan = scan,
                        .sensor = rho_tracker_find_sensor(tracker, scan->sensor_id),
                        .noise_density = 1.0f,
                        .tracker = tracker,
                        .report = report,
                        .images_left = of_plots < IMAGES_MAX ? of_plots + 1u : IMAGES_MAX};
    const int has_walls = learning->num_used > 0;
    learning->steps++;
    rho_reflector_learning_note_pairs(learning, look.sensor, scan, report);
    look_at_images(learning, &look, report);
    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        decide_on_line(learning, tracker, &learning->lines[i]);
    }
    unsigned num_used = 0;
    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        num_used += learning->lines[i].is_used;
    }
    return has_walls || num_used > 0 ? set_walls(learning, tracker) : RHO_OK;
}

/* ---- objects of unknown origin --------------------------------------------------------------- */

static int has_sound_variance(const struct rho_learned_reflector *line)
{
    const float *p = line->variance;
    return rho_is_within(p[0], 0.0f, VARIANCE_MAX) && rho_is_within(p[2], 0.0f, VARIANCE_MAX) &&
           p[1] * p[1] <= VARIANCE_ROUNDING * p[0] * p[2];
}

static int has_sound_witnesses(const struct rho_learned_reflector *line)
{
    unsigned i = 0;
    while (i < RHO_REFLECTOR_WITNESSES && rho_is_within(line->witnesses[i].off_m, -1e9f, 1e9f)) {
        i++;
    }
    return i == RHO_REFLECTOR_WITNESSES && rho_is_within(line->distance_m, 0.0f, 1e9f) &&
           rho_is_within(line->distance_m2, 0.0f, 1e18f) &&
           rho_is_within(line->off_m2, 0.0f, 1e18f);
}

/* Of a line that is taken: places on it can be walls of a tracker. */
static int has_sound_places(const struct rho_learned_reflector *line)
{
    const float one = line->cos_along * line->cos_along + line->sin_along * line->sin_along;
    if (!rho_is_within(one, 0.999f, 1.001f) || !(line->from_m <= line->to_m)) {
        return 0;
    }
    const struct rho_reflector wall = wall_of(line);
    return rho_is_coordinate(wall.from_x_m) && rho_is_coordinate(wall.from_y_m) &&
           rho_is_coordinate(wall.to_x_m) && rho_is_coordinate(wall.to_y_m);
}

static int is_sound_line(const struct rho_learned_reflector *line)
{
    return line->is_taken <= 1 && line->is_used <= line->is_taken && rho_is_coordinate(line->x_m) &&
           rho_is_coordinate(line->y_m) && rho_is_coordinate(line->offset_m) &&
           rho_is_within(line->slope, -10.0f, 10.0f) && has_sound_variance(line) &&
           rho_is_coordinate(line->from_m) && rho_is_coordinate(line->to_m) &&
           (!line->is_taken || has_sound_places(line)) && has_sound_witnesses(line) &&
           rho_is_within(line->pairs, -1.0f, 1e9f) && rho_is_within(line->sigma_m, 0.0f, 1e6f);
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
