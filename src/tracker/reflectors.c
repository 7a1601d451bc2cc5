/* SPDX-License-Identifier: MIT */
/* reflectors: unclaimed plots at images of tracks in known walls start none; image tracks end. */
#include "rhotrack/reflectors.h"

#include <string.h>

#include "plots.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"
#include "step.h"

static int are_usable_walls(const struct rho_reflector *reflectors, unsigned num_reflectors)
{
    for (unsigned i = 0; i < num_reflectors; i++) {
        const struct rho_reflector *wall = &reflectors[i];
        const float x_m = wall->to_x_m - wall->from_x_m, y_m = wall->to_y_m - wall->from_y_m;
        if (!rho_is_coordinate(wall->from_x_m) || !rho_is_coordinate(wall->from_y_m) ||
            !rho_is_coordinate(wall->to_x_m) || !rho_is_coordinate(wall->to_y_m) ||
            !(x_m * x_m + y_m * y_m >= RHO_REFLECTOR_LEAST_M * RHO_REFLECTOR_LEAST_M)) {
            return 0;
        }
    }
    return 1;
}

enum rho_status rho_tracker_set_reflectors(struct rho_tracker *tracker,
                                           const struct rho_reflector *reflectors,
                                           unsigned num_reflectors)
{
    const enum rho_status status = rho_tracker_check(tracker, num_reflectors == 0 || reflectors);
    if (status != RHO_OK) {
        return status;
    }
    if (num_reflectors > RHO_MAX_REFLECTORS || !are_usable_walls(reflectors, num_reflectors)) {
        return num_reflectors > RHO_MAX_REFLECTORS ? RHO_ERROR_CAPACITY : RHO_ERROR_VALUE;
    }
    memset(tracker->reflectors, 0, sizeof tracker->reflectors);
    for (unsigned i = 0; i < num_reflectors; i++) {
        tracker->reflectors[i] = reflectors[i];
    }
    tracker->num_reflectors = (uint16_t)num_reflectors;
    return RHO_OK;
}

int rho_images_are_sound(const struct rho_tracker *tracker)
{
    return tracker->num_reflectors <= RHO_MAX_REFLECTORS &&
           are_usable_walls(tracker->reflectors, tracker->num_reflectors);
}

/* A wall: its beginning, unit vector along it, and length. */
struct wall {
    float x_m, y_m, along_x, along_y, length_m;
};

/* Signed distance of a place from the wall's line, > 0 on its left; and position along the line. */
static float wall_distance(const struct wall *wall, float x_m, float y_m, float *along_m)
{
    const float dx_m = x_m - wall->x_m, dy_m = y_m - wall->y_m;
    *along_m = dx_m * wall->along_x + dy_m * wall->along_y;
    return dy_m * wall->along_x - dx_m * wall->along_y;
}

/* Reflects a vector in the wall's line: the component across the wall changes its sign. */
static void reflect_vector(const struct wall *wall, float *x, float *y)
{
    const float along = *x * wall->along_x + *y * wall->along_y;
    const float kept = 2.0f * along;
    *x = kept * wall->along_x - *x;
    *y = kept * wall->along_y - *y;
}

/* Reflects a covariance: in the wall's axes the signs of components across the wall change. */
static void reflect_covariance(const struct wall *wall, float p[21])
{
    const float c = wall->along_x, s = wall->along_y;
    rho_linalg_rotate6(p, RHO_X, RHO_Y, c, s);
    rho_linalg_rotate6(p, RHO_VX, RHO_VY, c, s);
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        if (i != RHO_Y && i != RHO_VY) {
            float *y = &p[i > RHO_Y ? RHO_AT(i, RHO_Y) : RHO_AT(RHO_Y, i)];
            float *vy = &p[i > RHO_VY ? RHO_AT(i, RHO_VY) : RHO_AT(RHO_VY, i)];
            *y = -*y;
            *vy = -*vy;
        }
    }
    rho_linalg_rotate6(p, RHO_X, RHO_Y, c, -s);
    rho_linalg_rotate6(p, RHO_VX, RHO_VY, c, -s);
}

int rho_reflector_mirror_state(const struct rho_reflector *reflector,
                               const struct rho_sensor *sensor, float slack_m,
                               const struct rho_kalman *of, struct rho_kalman *image,
                               float *crossing_m)
{
    const float x_m = reflector->to_x_m - reflector->from_x_m,
                y_m = reflector->to_y_m - reflector->from_y_m;
    const float length_m = rho_sqrt(x_m * x_m + y_m * y_m);
    const struct wall wall = {reflector->from_x_m, reflector->from_y_m, x_m / length_m,
                              y_m / length_m, length_m};
    float sensor_along_m, image_along_m;
    *image = *of;
    image->state[RHO_X] -= wall.x_m;
    image->state[RHO_Y] -= wall.y_m;
    reflect_vector(&wall, &image->state[RHO_X], &image->state[RHO_Y]);
    reflect_vector(&wall, &image->state[RHO_VX], &image->state[RHO_VY]);
    image->state[RHO_X] += wall.x_m;
    image->state[RHO_Y] += wall.y_m;
    const float sensor_m = wall_distance(&wall, sensor ? sensor->x_m : 0.0f,
                                         sensor ? sensor->y_m : 0.0f, &sensor_along_m);
    const float image_m =
        wall_distance(&wall, image->state[RHO_X], image->state[RHO_Y], &image_along_m);
    if (!(sensor_m * image_m < 0.0f)) {
        return 0;
    }
    *crossing_m =
        sensor_along_m + (image_along_m - sensor_along_m) * sensor_m / (sensor_m - image_m);
    if (!(*crossing_m >= -slack_m && *crossing_m <= wall.length_m + slack_m)) {
        return 0;
    }
    reflect_covariance(&wall, image->covariance);
    return 1;
}

/* Computes the image of a track in a wall. Returns 0 where the sensor cannot see it. */
static int make_image(const struct rho_look *look, struct rho_work *work, unsigned reflector,
                      const struct rho_track *track, struct rho_kalman *image)
{
    float crossing_m;
    rho_work_spend(work, IMAGE_UNITS);
    return rho_reflector_mirror_state(&look->tracker->reflectors[reflector], look->sensor,
                                      BESIDE_WALL_SIGMAS * rho_track_sigma_m(track), &track->kalman,
                                      image, &crossing_m);
}

/* True of a live track at the step's time with enough hits: the scan may also show its images. */
static int may_have_images(const struct rho_look *look, unsigned row)
{
    const struct rho_track *track = &look->tracker->tracks[row];
    return track->status != RHO_TRACK_FREE && track->hits >= IMAGED_HITS &&
           track->time_us == look->time_us;
}

static void mark_ghosts(const struct rho_look *look, struct rho_work *work,
                        const struct rho_kalman *image)
{
    struct rho_gate gate;
    struct rho_gate_result result;
    float half_m[2];
    rho_gate_open(&gate, image, look->model.noise_density, look->sensor, look->scan->measures);
    rho_gate_box(&gate, look->sigma_max_m, look->offset_max_s, half_m);
    struct plots_near near = rho_plots_near(
        look->tracker, image->state[RHO_X] - half_m[0], image->state[RHO_X] + half_m[0],
        image->state[RHO_Y] - half_m[1], image->state[RHO_Y] + half_m[1]);
    for (uint32_t i; rho_plots_next(look, &near, &i) && !rho_work_is_spent(work);) {
        const struct rho_plot *plot = &look->scan->plots[i];
        const float dx_m = plot->x_m - image->state[RHO_X], dy_m = plot->y_m - image->state[RHO_Y];
        if (look->fates[i] == RHO_FATE_HELD && dx_m <= half_m[0] && dx_m >= -half_m[0] &&
            dy_m <= half_m[1] && dy_m >= -half_m[1]) {
            rho_work_spend(work, IMAGE_TEST_UNITS);
            if (rho_gate_test(&gate, plot, &result)) {
                look->fates[i] = RHO_FATE_GHOST;
            }
        }
    }
}

void rho_images_mark_plots(const struct rho_look *look, struct rho_work *work)
{
    struct rho_kalman image;
    rho_work_begin_phase(look->tracker, work, RHO_WORK_IMAGES_SHARE);
    for (unsigned row = 0; row < look->tracker->num_tracks; row++) {
        for (unsigned i = 0; may_have_images(look, row) && i < look->tracker->num_reflectors; i++) {
            if (rho_work_is_spent(work)) {
                work->is_partial = 1;
                return;
            }
            if (make_image(look, work, i, &look->tracker->tracks[row], &image)) {
                mark_ghosts(look, work, &image);
            }
        }
    }
}

/* True where a track agrees with an image in horizontal place and velocity. */
static int agrees_with_image(const struct rho_track *track, const struct rho_kalman *image)
{
    static const uint8_t of[4] = {RHO_X, RHO_Y, RHO_VX, RHO_VY};
    float s[RHO_TRIANGLE(4)], off[4], chi2, log_det;
    int place = 0;
    for (int i = 0; i < 4; i++) {
        off[i] = track->kalman.state[of[i]] - image->state[of[i]];
        for (int j = 0; j <= i; j++, place++) {
            s[place] = track->kalman.covariance[RHO_AT(of[i], of[j])] +
                       image->covariance[RHO_AT(of[i], of[j])];
        }
    }
    return rho_linalg_gated_nis(4, s, off, IMAGE_CHI2, &chi2, &log_det);
}

static int is_image_of_other(const struct rho_look *look, struct rho_work *work, unsigned row)
{
    const struct rho_tracker *tracker = look->tracker;
    struct rho_kalman image;
    for (unsigned other = 0; other < tracker->num_tracks; other++) {
        const struct rho_track *of = &tracker->tracks[other];
        for (unsigned i = 0;
             other != row && may_have_images(look, other) && i < tracker->num_reflectors; i++) {
            if (rho_work_is_spent(work)) {
                work->is_partial = 1;
                return 0;
            }
            if (make_image(look, work, i, of, &image) &&
                agrees_with_image(&tracker->tracks[row], &image)) {
                return 1;
            }
        }
    }
    return 0;
}

void rho_images_end_tracks(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    rho_work_begin_phase(tracker, &step->work, RHO_WORK_IMAGES_SHARE);
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        const float looks = (float)track->hits + (float)track->misses;
        if (track->status != RHO_TRACK_FREE && track->time_us == step->look.time_us &&
            (!rho_life_is_established(track) || (float)track->hits < IMAGE_SHARE * looks) &&
            is_image_of_other(&step->look, &step->work, row)) {
            rho_life_end(step, track);
        }
    }
    rho_life_remove_ended(tracker);
}
