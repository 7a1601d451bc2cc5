/* SPDX-License-Identifier: MIT */
/*
 * scene_targets: reads the targets of a scene file, and draws the paths of a
 * run.
 */
#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/portable_math.h"
#include "scene/scene_path.h"

#define PLACE_MAX_M 2e6
#define SPEED_MAX_MPS 2e4
#define ACCEL_MAX_MPS2 1000.0
#define LEGS_MAX 1000
#define ITEMS_MAX 1000
#define GROUP_MAX 10000
#define TARGETS_MAX 100000
#define DRAFTS_MAX 10000
#define KEEP_STEP_S 1.0 /* interval at which a path is checked against its limits */
/* share of the largest allowed range beyond which random turns lead back to the centre */
#define TURN_BACK_SHARE .6

/* Adds legs that change the speed to to_mps at along_mps2 from t_s on; returns the end time. */
static double add_speed_change_legs(struct scene_path *path, double t_s, double to_mps,
                                    double along_mps2)
{
    double change_mps = to_mps - path_last_leg_speed_mps(path, t_s),
           for_s = fabs(change_mps) / along_mps2;

    if (for_s > 0.0) {
        path_begin_next_leg(path, t_s, change_mps > 0.0 ? along_mps2 : -along_mps2, 0.0);
        path_begin_next_leg(path, t_s + for_s, 0.0, 0.0);
        path->legs[path->num_legs - 1].speed_mps = to_mps;
    }
    return t_s + for_s;
}

/*
 * Duration of the parts of a turn with constant lateral acceleration and changing speed: each part
 * turns at the rate of its middle speed.
 */
#define PART_S 1.0

/* Adds the legs of one described step from t_s on; returns its end time. */
static double add_legs_of_step(struct scene_path *path, double t_s, const struct path_step *step)
{
    double speed_mps = path_last_leg_speed_mps(path, t_s), turn_radps = step->turn_radps,
           for_s = step->for_s;
    double along_mps2 = step->along_mps2;

    if (step->has_speed) {
        double change_mps = step->to_speed_mps - speed_mps;

        along_mps2 = change_mps < 0.0 ? -fabs(along_mps2) : fabs(along_mps2);
        for_s = fabs(change_mps) / fabs(along_mps2);
    }
    if (fabs(step->across_mps2) > 0.0) {
        turn_radps = speed_mps > PATH_STANDS_MPS ? step->across_mps2 / speed_mps : 0.0;
    }
    if (fabs(step->turn_rad) > 0.0) {
        turn_radps = step->turn_rad > 0.0 ? fabs(turn_radps) : -fabs(turn_radps);
        for_s = fabs(turn_radps) > 0.0 ? fabs(step->turn_rad / turn_radps) : 0.0;
    }
    if (along_mps2 < 0.0 && for_s > speed_mps / -along_mps2) {
        for_s = speed_mps / -along_mps2; /* the target has stopped by then */
    }
    if (fabs(step->across_mps2) > 0.0 && fabs(along_mps2) > 0.0) {
        size_t parts = (size_t)ceil(for_s / PART_S);

        for (size_t i = 0; i < parts; i++) {
            double part_s = for_s / (double)parts;
            double middle_mps = speed_mps + along_mps2 * part_s * ((double)i + 0.5);

            path_begin_next_leg(path, t_s + part_s * (double)i, along_mps2,
                                middle_mps > PATH_STANDS_MPS ? step->across_mps2 / middle_mps
                                                             : 0.0);
        }
    } else {
        path_begin_next_leg(path, t_s, along_mps2, turn_radps);
        memcpy(path->legs[path->num_legs - 1].accel_mps2, step->accel_mps2,
               sizeof step->accel_mps2);
    }
    path_begin_next_leg(path, t_s + for_s, 0.0, 0.0);
    if (step->has_speed) {
        path->legs[path->num_legs - 1].speed_mps = step->to_speed_mps;
    }
    return t_s + for_s;
}

static void add_legs_through_points(struct scene_path *path, const struct target_item *item)
{
    for (size_t i = 0; i + 1 < item->num_points; i++) {
        const double *from = item->points[i], *to = item->points[i + 1];
        double dx_m = to[1] - from[1], dy_m = to[2] - from[2];

        path_add_leg(path,
                     (struct path_leg){.t_s = from[0],
                                       .x_m = from[1],
                                       .y_m = from[2],
                                       .speed_mps = portable_hypot(dx_m, dy_m) / (to[0] - from[0]),
                                       .heading_rad = portable_atan2(dy_m, dx_m)});
    }
}

static void draw_random_deviations(struct scene_path *path, const struct target_item *item,
                                   double duration_s, struct random *random)
{
    double last_s = fmin(path->until_s, duration_s), t_s = item->shake_s;

    path->num_shakes = last_s > path->from_s ? (size_t)((last_s - path->from_s) / t_s) + 2 : 1;
    path->shake_s = t_s;
    path->shakes = must_calloc(path->num_shakes, sizeof *path->shakes);
    for (size_t i = 1; i < path->num_shakes; i++) {
        struct motion *to = &path->shakes[i];

        *to = path->shakes[i - 1];
        to->vx_mps += t_s * item->shake_mps2 * random_normal(random);
        to->vy_mps += t_s * item->shake_mps2 * random_normal(random);
        to->vz_mps += item->has_height ? t_s * item->shake_mps2 * random_normal(random) : 0.0;
        to->x_m += 0.5 * t_s * (path->shakes[i - 1].vx_mps + to->vx_mps);
        to->y_m += 0.5 * t_s * (path->shakes[i - 1].vy_mps + to->vy_mps);
        to->z_m += 0.5 * t_s * (path->shakes[i - 1].vz_mps + to->vz_mps);
    }
}

static struct scene_path path_from_description(const struct target_item *item, size_t index,
                                               const struct scene_path *parent)
{
    struct scene_path path = {.from_s = item->from_s, .until_s = item->until_s, .item = index};

    if (item->num_points > 0) {
        add_legs_through_points(&path, item);
        return path;
    }
    if (parent) {
        const struct path_leg *leg = path_leg_at(parent, item->from_s);
        struct motion at = path_motion_at(parent, item->from_s);

        path_begin_first_leg(
            &path, at.x_m, at.y_m,
            fmax(0.0, path_leg_speed_mps(leg, item->from_s) + item->speed_change_mps),
            path_leg_heading_rad(leg, item->from_s) + item->heading_change_rad);
        path.legs[0].z_m = at.z_m;
        path.legs[0].vz_mps = at.vz_mps;
    } else {
        path_begin_first_leg(&path, item->x_m, item->y_m, item->speed_mps, item->heading_rad);
        path.legs[0].z_m = item->z_m;
        path.legs[0].vz_mps = item->vz_mps;
    }
    double t_s = path.from_s;

    for (size_t i = 0; i < item->num_steps; i++) {
        t_s = add_legs_of_step(&path, t_s, &item->steps[i]);
    }
    return path;
}

static void draw_first_leg(const struct target_item *item, struct scene_path *path,
                           struct random *random)
{
    double x_m, y_m, heading_rad, speed_mps = random_in_span(random, item->speed);

    if (item->has_box) {
        x_m = random_between(random, item->box_m[0], item->box_m[1]);
        y_m = random_between(random, item->box_m[2], item->box_m[3]);
    } else {
        double lo = item->range.lo, hi = item->range.hi; /* uniform over the area */
        double range_m = sqrt(random_between(random, lo * lo, hi * hi));
        double azimuth_rad = random_in_span(random, item->azimuth);

        x_m = item->about_x_m + range_m * portable_cos(azimuth_rad);
        y_m = item->about_y_m + range_m * portable_sin(azimuth_rad);
    }
    heading_rad = random_in_span(random, item->heading);
    if (item->is_either && random_uniform(random) < 0.5) {
        heading_rad = -heading_rad;
    }
    if (item->is_relative) {
        heading_rad += portable_atan2(item->about_y_m - y_m, item->about_x_m - x_m);
    }
    path_begin_first_leg(path, x_m, y_m, speed_mps, portable_wrap_angle(heading_rad));
}

/* Sign of a random turn: back to the centre where the target is far out, else either side. */
static double draw_turn_side(const struct target_item *item, const struct scene_path *path,
                             double t_s, struct random *random)
{
    double side = random_uniform(random) < 0.5 ? 1.0 : -1.0;
    struct motion at = path_motion_at(path, t_s);
    double x_m = item->about_x_m - at.x_m, y_m = item->about_y_m - at.y_m;

    if (item->has_keep && portable_hypot(x_m, y_m) > TURN_BACK_SHARE * item->keep.hi) {
        side = at.vx_mps * y_m - at.vy_mps * x_m > 0.0 ? 1.0 : -1.0;
    }
    return side;
}

static double add_random_turn_legs(const struct target_item *item, struct scene_path *path,
                                   double t_s, struct random *random)
{
    double across_mps2 = random_in_span(random, item->turn_across),
           speed_mps = path_last_leg_speed_mps(path, t_s);
    double side = draw_turn_side(item, path, t_s, random), for_s;
    double turn_radps = speed_mps > PATH_STANDS_MPS ? across_mps2 / speed_mps : 0.0;

    if (item->has_turn_for) {
        for_s = random_in_span(random, item->turn_for);
    } else {
        for_s = turn_radps > 0.0 ? random_in_span(random, item->turn_rad) / turn_radps : 0.0;
    }
    path_begin_next_leg(path, t_s, 0.0, side * turn_radps);
    path_begin_next_leg(path, t_s + for_s, 0.0, 0.0);
    return t_s + for_s;
}

static double add_random_stop_legs(const struct target_item *item, struct scene_path *path,
                                   double t_s, struct random *random)
{
    double speed_mps = path_last_leg_speed_mps(path, t_s),
           along_mps2 = random_in_span(random, item->stop_along);

    t_s =
        add_speed_change_legs(path, t_s, 0.0, along_mps2) + random_in_span(random, item->stop_for);
    return add_speed_change_legs(path, t_s, speed_mps, along_mps2);
}

/*
 * Adds random manoeuvres one after the other until end_s; each kind comes a random interval after
 * the end of its last one.
 */
static void add_random_manoeuvres(const struct target_item *item, struct scene_path *path,
                                  double end_s, struct random *random)
{
    double t_s = path->from_s;
    double turn_s = item->has_turns ? t_s + random_in_span(random, item->turn_every) : INFINITY;
    double change_s =
        item->has_changes ? t_s + random_in_span(random, item->change_every) : INFINITY;
    double stop_s = item->has_stops ? t_s + random_in_span(random, item->stop_every) : INFINITY;

    for (;;) {
        double next_s = fmin(turn_s, fmin(change_s, stop_s));

        t_s = fmax(t_s, next_s);
        if (!(t_s < end_s)) {
            return;
        }
        if (turn_s <= next_s) {
            t_s = add_random_turn_legs(item, path, t_s, random);
            turn_s = t_s + random_in_span(random, item->turn_every);
        } else if (change_s <= next_s) {
            double to_mps = random_in_span(random, item->change_speed);

            t_s = add_speed_change_legs(path, t_s, to_mps,
                                        random_in_span(random, item->change_along));
            change_s = t_s + random_in_span(random, item->change_every);
        } else {
            t_s = add_random_stop_legs(item, path, t_s, random);
            stop_s = t_s + random_in_span(random, item->stop_every);
        }
    }
}

static bool is_between(double number, double lo, double hi)
{
    return number >= lo && number <= hi;
}

/* Number of the item's rings (keep_discs_m) that contain the place. */
static size_t count_rings_containing(const struct target_item *item, const struct motion *at)
{
    size_t count = 0;

    for (size_t i = 0; i < item->num_keep_discs; i++) {
        const double *disc_m = item->keep_discs_m[i];
        double range_m = portable_hypot(at->x_m - disc_m[0], at->y_m - disc_m[1]);

        count += is_between(range_m, disc_m[2], disc_m[3]);
    }
    return count;
}

static bool is_inside_keep_range_and_box(const struct target_item *item, const struct motion *at)
{
    const double *box_m = item->keep_box_m;
    double range_m = portable_hypot(at->x_m - item->about_x_m, at->y_m - item->about_y_m);

    return (!item->has_keep || is_between(range_m, item->keep.lo, item->keep.hi)) &&
           (!item->has_keep_box ||
            (is_between(at->x_m, box_m[0], box_m[1]) && is_between(at->y_m, box_m[2], box_m[3])));
}

/* Whether the place is at least spacing_m from all other targets at the time. */
static bool is_far_from_others(const struct target_item *item, const struct motion *at, double t_s,
                               const struct scene_paths *others)
{
    for (size_t i = 0; item->spacing_m > 0.0 && i < others->count; i++) {
        const struct scene_path *other = &others->paths[i];

        if (t_s >= other->from_s && t_s < other->until_s) {
            struct motion its = path_motion_at(other, t_s);

            if (portable_hypot(at->x_m - its.x_m, at->y_m - its.y_m) < item->spacing_m) {
                return false;
            }
        }
    }
    return true;
}

static bool path_keeps_areas_and_spacing(const struct target_item *item,
                                         const struct scene_path *path, double end_s,
                                         const struct scene_paths *others)
{
    double first_s = fmax(0.0, path->from_s);
    bool is_kept =
        item->has_keep || item->has_keep_box || item->num_keep_discs > 0 || item->spacing_m > 0.0;
    size_t count = is_kept && end_s >= first_s ? (size_t)((end_s - first_s) / KEEP_STEP_S) + 1 : 0;
    size_t in_all = 0;

    for (size_t i = 0; i < count; i++) {
        double t_s = first_s + (double)i * KEEP_STEP_S;
        struct motion at = path_motion_at(path, t_s);
        size_t discs = count_rings_containing(item, &at);

        if (!is_inside_keep_range_and_box(item, &at) || (item->num_keep_discs > 0 && discs == 0) ||
            !is_far_from_others(item, &at, t_s, others)) {
            return false;
        }
        in_all += discs == item->num_keep_discs;
    }
    return (double)in_all >= item->keep_all_share * (double)count;
}

static const char *name_of_limit(const struct target_item *item)
{
    return item->spacing_m > 0.0      ? "its place, spacing_m from others"
           : item->num_keep_discs > 0 ? "keep_discs_m"
           : item->has_keep_box       ? "keep_box_m"
                                      : "keep_range_m";
}

static struct scene_path draw_path_within_limits(const struct target_draft *draft, double from_s,
                                                 double until_s, const struct scene_paths *others,
                                                 struct random *random)
{
    double end_s = fmin(until_s, draft->duration_s);

    for (int i = 0; i < DRAFTS_MAX; i++) {
        struct scene_path path = {.from_s = from_s, .until_s = until_s, .item = draft->index};

        draw_first_leg(draft->item, &path, random);
        add_random_manoeuvres(draft->item, &path, end_s, random);
        if (path_keeps_areas_and_spacing(draft->item, &path, end_s, others)) {
            return path;
        }
        path_free(&path);
    }
    fail(EXIT_USAGE,
         "%s: targets[%zu]: none of %d random paths keeps within %s; take a shorter life_s, less "
         "speed, or turns that lead back",
         draft->file, draft->index, DRAFTS_MAX, name_of_limit(draft->item));
}

/*
 * Draws the paths of one member of a group: a single one, or with is_replaced one after the other
 * with pauses, the first beginning somewhere in its life.
 */
static void draw_successive_paths(struct scene_paths *paths, const struct target_draft *draft,
                                  struct random *random)
{
    const struct target_item *item = draft->item;
    double life_s = item->has_life ? random_in_span(random, item->life) : INFINITY;
    double from_s = random_in_span(random, item->from);

    if (item->is_replaced) {
        from_s -= life_s * random_uniform(random);
    }
    for (;;) {
        double until_s = from_s + life_s;

        if (until_s > 0.0) {
            paths_add(paths, draw_path_within_limits(draft, from_s, until_s, paths, random));
        }
        from_s = until_s;
        if (!item->is_replaced) {
            return;
        }
        from_s += random_in_span(random, item->pause);
        life_s = random_in_span(random, item->life);
        if (!(from_s < draft->duration_s)) {
            return;
        }
    }
}

struct scene_path *targets_draw_paths(const struct scene_targets *targets, const char *file,
                                      double duration_s, uint64_t seed, uint64_t run,
                                      uint64_t source, size_t *count)
{
    struct scene_paths paths = {.count = 0};
    size_t *first = must_calloc(targets->count + 1, sizeof *first);

    for (size_t i = 0; i < targets->count; i++) {
        const struct target_item *item = &targets->items[i];
        const struct target_draft draft = {file, item, i, duration_s};

        first[i] = paths.count;
        if (item->flights > 0) {
            struct random random = scene_random_stream(seed, run, STREAM_PATH, source, i, 0);

            flights_draw_random(&draft, &paths, &random);
        } else if (item->count == 0) {
            const struct scene_path *parent =
                item->has_parent ? &paths.paths[first[item->parent]] : NULL;
            struct scene_path path = path_from_description(item, i, parent);
            struct random random = scene_random_stream(seed, run, STREAM_PATH, source, i, 0);

            if (item->shake_s > 0.0) {
                draw_random_deviations(&path, item, duration_s, &random);
            }
            paths_add(&paths, path);
        }
        for (size_t k = 0; k < item->count; k++) {
            struct random random = scene_random_stream(seed, run, STREAM_PATH, source, i, k);

            draw_successive_paths(&paths, &draft, &random);
        }
        if (paths.count > TARGETS_MAX) {
            fail(EXIT_USAGE, "%s: targets: more than %d of them", file, TARGETS_MAX);
        }
    }
    free(first);
    *count = paths.count;
    return paths.paths;
}

/* Reads a list of two or three numbers as x, y and z; three set *has_height. */
static bool read_xy_or_xyz(struct json_object *object, const char *key, double max,
                           double vector[3], bool *has_height)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object->item, key);
    size_t count = cJSON_GetArraySize(item) == 3 ? 3 : 2;

    *has_height = *has_height || count == 3;
    return json_read_numbers(object, key, count, -max, max, vector);
}

static struct path_step read_leg(struct json_object object, bool *has_height)
{
    static const char *const others[] = {"along_mps2", "across_mps2", "turn_degps", "turn_deg",
                                         "to_speed_mps"};
    struct path_step step = {0};

    step.for_s = json_read_number(&object, "for_s", 0, 1e6, 0);
    step.along_mps2 = json_read_number(&object, "along_mps2", -ACCEL_MAX_MPS2, ACCEL_MAX_MPS2, 0);
    step.across_mps2 = json_read_number(&object, "across_mps2", -ACCEL_MAX_MPS2, ACCEL_MAX_MPS2, 0);
    step.turn_radps = json_read_number(&object, "turn_degps", -360, 360, 0) * PORTABLE_PI / 180.0;
    step.turn_rad = json_read_number(&object, "turn_deg", -36000, 36000, 0) * PORTABLE_PI / 180.0;
    step.has_speed = json_has_key(&object, "to_speed_mps");
    step.to_speed_mps = json_read_number(&object, "to_speed_mps", 0, SPEED_MAX_MPS, 0);
    if (read_xy_or_xyz(&object, "accel_mps2", ACCEL_MAX_MPS2, step.accel_mps2, has_height)) {
        for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
            json_exclude_keys(&object, "accel_mps2", others[i]);
        }
    }
    json_exclude_keys(&object, "across_mps2", "turn_degps");
    json_exclude_keys(&object, "for_s", "to_speed_mps");
    json_exclude_keys(&object, "for_s", "turn_deg");
    json_exclude_keys(&object, "to_speed_mps", "turn_deg");
    if (step.has_speed && !(fabs(step.along_mps2) > 0.0)) {
        json_fail_key(&object, "to_speed_mps", "needs along_mps2, other than 0");
    }
    if (fabs(step.turn_rad) > 0.0 && !(fabs(step.across_mps2) + fabs(step.turn_radps) > 0.0)) {
        json_fail_key(&object, "turn_deg", "needs across_mps2 or turn_degps, other than 0");
    }
    if (!json_has_key(&object, "for_s") && !step.has_speed && !json_has_key(&object, "turn_deg")) {
        json_fail(&object.place, "has no end: give for_s, to_speed_mps or turn_deg");
    }
    json_refuse_unknown_keys(&object);
    return step;
}

/* Reads the target that this one splits from. */
static void read_split_parent(struct json_object *object, struct target_item *item,
                              const struct scene_targets *before)
{
    const struct target_item *parent;

    item->has_parent = true;
    item->parent = json_read_count(object, "parent", 0, ITEMS_MAX, 0);
    if (item->parent >= before->count || before->items[item->parent].count > 0 ||
        before->items[item->parent].flights > 0) {
        json_fail_key(object, "parent", "targets[%zu] is not an earlier path", item->parent);
    }
    parent = &before->items[item->parent];
    json_require_key(object, "from_s");
    if (item->from_s < parent->from_s || item->from_s > parent->until_s) {
        json_fail_key(object, "from_s", "the parent does not exist at that time");
    }
    item->speed_change_mps =
        json_read_number(object, "speed_change_mps", -SPEED_MAX_MPS, SPEED_MAX_MPS, 0);
    item->heading_change_rad =
        json_read_number(object, "heading_change_rad", -PORTABLE_TURN, PORTABLE_TURN, 0);
}

static void read_path_points(struct json_object *object, struct target_item *item)
{
    static const char *const others[] = {"at_m",   "velocity_mps", "speed_mps", "heading_rad",
                                         "from_s", "parent",       "legs"};
    struct json_list list = json_read_list(object, "points", LEGS_MAX);

    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        json_exclude_keys(object, "points", others[i]);
    }
    if (list.count < 2) {
        json_fail(&list.place, "must be two or more, each [t_s, x_m, y_m]");
    }
    item->num_points = list.count;
    item->points = must_calloc(list.count, sizeof *item->points);
    for (size_t i = 0; i < list.count; i++) {
        json_element_numbers(&list, i, 3, -PLACE_MAX_M, PLACE_MAX_M, item->points[i]);
        if (i > 0 && item->points[i][0] <= item->points[i - 1][0]) {
            json_fail(&list.place, "times must increase");
        }
    }
    item->from_s = item->points[0][0];
}

static void read_random_accelerations(struct json_object *object, struct target_item *item)
{
    struct json_object shake;

    if (json_read_object(object, "shake", &shake)) {
        json_require_key(&shake, "every_s");
        json_require_key(&shake, "sigma_mps2");
        item->shake_s = json_read_number(&shake, "every_s", 0.01, 1e6, 0);
        item->shake_mps2 = json_read_number(&shake, "sigma_mps2", 0, ACCEL_MAX_MPS2, 0);
        json_refuse_unknown_keys(&shake);
    }
}

static void read_described_path(struct json_object *object, struct target_item *item,
                                const struct scene_targets *before)
{
    double place_m[3] = {0};

    item->from_s = json_read_number(object, "from_s", -1e6, 1e6, 0);
    item->until_s = json_read_number(object, "until_s", -1e6, 1e6, INFINITY);
    read_random_accelerations(object, item);
    if (json_has_key(object, "points")) {
        read_path_points(object, item);
    }
    if (item->until_s <= item->from_s) {
        json_fail_key(object, "until_s", "is not after from_s");
    }
    if (item->num_points > 0) {
        return;
    }
    if (json_has_key(object, "parent")) {
        read_split_parent(object, item, before);
    } else {
        json_require_key(object, "at_m");
        read_xy_or_xyz(object, "at_m", PLACE_MAX_M, place_m, &item->has_height);
        item->x_m = place_m[0];
        item->y_m = place_m[1];
        item->z_m = place_m[2];
        double velocity_mps[3] = {0};

        json_exclude_keys(object, "velocity_mps", "speed_mps");
        json_exclude_keys(object, "velocity_mps", "heading_rad");
        item->speed_mps = json_read_number(object, "speed_mps", 0, SPEED_MAX_MPS, 0);
        item->heading_rad =
            json_read_number(object, "heading_rad", -PORTABLE_TURN, PORTABLE_TURN, 0);
        if (read_xy_or_xyz(object, "velocity_mps", SPEED_MAX_MPS, velocity_mps,
                           &item->has_height)) {
            item->vz_mps = velocity_mps[2];
            item->speed_mps = portable_hypot(velocity_mps[0], velocity_mps[1]);
            item->heading_rad = portable_atan2(velocity_mps[1], velocity_mps[0]);
        } else {
            json_require_key(object, "speed_mps");
            json_require_key(object, "heading_rad");
        }
    }
    struct json_list list = json_read_list(object, "legs", LEGS_MAX);

    item->num_steps = list.count;
    item->steps = must_calloc(list.count + 1, sizeof *item->steps);
    for (size_t i = 0; i < list.count; i++) {
        item->steps[i] = read_leg(json_element(&list, i), &item->has_height);
    }
}

static void read_random_turns(struct json_object *object, struct target_item *item)
{
    struct json_object turns;

    item->has_turns = json_read_object(object, "turns", &turns);
    if (item->has_turns) {
        json_require_key(&turns, "every_s");
        json_require_key(&turns, "across_mps2");
        item->turn_every = json_read_span(&turns, "every_s", 0.1, 1e6, (struct json_span){0});
        item->turn_across =
            json_read_span(&turns, "across_mps2", 1e-3, ACCEL_MAX_MPS2, (struct json_span){0});
        item->has_turn_for = json_has_key(&turns, "for_s");
        item->turn_for = json_read_span(&turns, "for_s", 0.1, 1e6, (struct json_span){0});
        item->turn_rad = json_read_span(&turns, "turn_deg", 0.1, 3600, (struct json_span){20, 90});
        item->turn_rad.lo *= PORTABLE_PI / 180.0;
        item->turn_rad.hi *= PORTABLE_PI / 180.0;
        json_exclude_keys(&turns, "for_s", "turn_deg");
        json_refuse_unknown_keys(&turns);
    }
}

static void read_random_speed_changes(struct json_object *object, struct target_item *item)
{
    struct json_object changes;

    item->has_changes = json_read_object(object, "speed_changes", &changes);
    if (item->has_changes) {
        json_require_key(&changes, "every_s");
        json_require_key(&changes, "along_mps2");
        item->change_every = json_read_span(&changes, "every_s", 0.1, 1e6, (struct json_span){0});
        item->change_speed =
            json_read_span(&changes, "to_speed_mps", 0, SPEED_MAX_MPS, item->speed);
        item->change_along =
            json_read_span(&changes, "along_mps2", 1e-3, ACCEL_MAX_MPS2, (struct json_span){0});
        json_refuse_unknown_keys(&changes);
    }
}

static void read_random_stops(struct json_object *object, struct target_item *item)
{
    struct json_object stops;

    item->has_stops = json_read_object(object, "stops", &stops);
    if (item->has_stops) {
        json_require_key(&stops, "every_s");
        json_require_key(&stops, "for_s");
        json_require_key(&stops, "along_mps2");
        item->stop_every = json_read_span(&stops, "every_s", 0.1, 1e6, (struct json_span){0});
        item->stop_for = json_read_span(&stops, "for_s", 0, 1e6, (struct json_span){0});
        item->stop_along =
            json_read_span(&stops, "along_mps2", 1e-3, ACCEL_MAX_MPS2, (struct json_span){0});
        json_refuse_unknown_keys(&stops);
    }
}

static void read_life_times(struct json_object *object, struct target_item *item)
{
    item->from = json_read_span(object, "from_s", -1e6, 1e6, (struct json_span){0, 0});
    item->has_life = json_has_key(object, "life_s");
    item->life = json_read_span(object, "life_s", 1e-3, 1e6, (struct json_span){0, 0});
    item->is_replaced = json_read_flag(object, "is_replaced", false);
    item->pause = json_read_span(object, "pause_s", 0, 1e6, (struct json_span){0, 0});
    if (item->is_replaced) {
        json_require_key(object, "life_s");
    }
    if (json_has_key(object, "pause_s") && !item->is_replaced) {
        json_fail_key(object, "pause_s", "needs is_replaced");
    }
}

static void read_start_box(struct json_object *object, struct target_item *item)
{
    const double *box_m = item->box_m;

    item->has_box = json_read_numbers(object, "box_m", 4, -PLACE_MAX_M, PLACE_MAX_M, item->box_m);
    if (item->has_box && (box_m[0] > box_m[1] || box_m[2] > box_m[3])) {
        json_fail_key(object, "box_m", "must be [x_min, x_max, y_min, y_max]");
    }
}

static void read_rings_to_stay_within(struct json_object *object, struct target_item *item)
{
    struct json_list list = json_read_list(object, "keep_discs_m", KEEP_DISCS_MAX);

    for (size_t i = 0; i < list.count; i++) {
        double *disc_m = item->keep_discs_m[i];

        json_element_numbers(&list, i, 4, -PLACE_MAX_M, PLACE_MAX_M, disc_m);
        if (disc_m[2] > disc_m[3] || disc_m[3] < 0.0) {
            json_fail(&list.place, "must be [x, y, from, to]");
        }
    }
    item->num_keep_discs = list.count;
    if (json_has_key(object, "keep_all_share") && list.count == 0) {
        json_fail_key(object, "keep_all_share", "needs keep_discs_m");
    }
    item->keep_all_share = json_read_number(object, "keep_all_share", 0, 1, 0);
}

static void read_random_targets(struct json_object *object, struct target_item *item)
{
    static const struct json_span all_round = {-PORTABLE_PI, PORTABLE_PI};

    item->count = json_read_count(object, "count", 1, GROUP_MAX, 0);
    read_life_times(object, item);
    json_read_xy(object, "about_m", PLACE_MAX_M, &item->about_x_m, &item->about_y_m);
    read_start_box(object, item);
    item->range = json_read_span(object, "range_m", 0, PLACE_MAX_M, (struct json_span){0});
    item->azimuth = json_read_span(object, "azimuth_rad", -PORTABLE_TURN, PORTABLE_TURN, all_round);
    json_exclude_keys(object, "box_m", "range_m");
    json_exclude_keys(object, "box_m", "azimuth_rad");
    if (!item->has_box) {
        json_require_key(object, "range_m");
    }
    json_require_key(object, "speed_mps");
    item->speed = json_read_span(object, "speed_mps", 0, SPEED_MAX_MPS, (struct json_span){0});
    json_exclude_keys(object, "heading_rad", "inbound_rad");
    item->heading = json_read_span(object, "heading_rad", -PORTABLE_TURN, PORTABLE_TURN, all_round);
    item->is_relative = item->is_either = json_has_key(object, "inbound_rad");
    item->heading = json_read_span(object, "inbound_rad", 0, PORTABLE_PI, item->heading);
    item->has_keep = json_has_key(object, "keep_range_m");
    item->keep = json_read_span(object, "keep_range_m", 0, PLACE_MAX_M, (struct json_span){0});
    item->has_keep_box =
        json_read_numbers(object, "keep_box_m", 4, -PLACE_MAX_M, PLACE_MAX_M, item->keep_box_m);
    read_rings_to_stay_within(object, item);
    item->spacing_m = json_read_number(object, "spacing_m", 0, PLACE_MAX_M, 0);
    read_random_turns(object, item);
    read_random_speed_changes(object, item);
    read_random_stops(object, item);
}

struct scene_targets targets_read(struct json_object *object, const char *key)
{
    struct json_list list = json_read_list(object, key, ITEMS_MAX);
    struct scene_targets targets = {.items = must_calloc(list.count + 1, sizeof *targets.items)};

    for (; targets.count < list.count; targets.count++) {
        struct json_object one = json_element(&list, targets.count);
        struct target_item *item = &targets.items[targets.count];

        json_read_text(&one, "text", NULL);
        item->body = scene_body_read(&one);
        json_exclude_keys(&one, "count", "flights");
        if (json_has_key(&one, "flights")) {
            item->flights = json_read_count(&one, "flights", 1, GROUP_MAX, 0);
            json_require_key(&one, "box_m");
            read_start_box(&one, item);
            json_require_key(&one, "least_s");
            item->flights_least = json_read_number(&one, "least_s", 1, 1e5, 0);
            item->crossing_share = json_read_number(&one, "crossing_share", 0, 1, 0);
        } else if (json_has_key(&one, "count")) {
            read_random_targets(&one, item);
        } else {
            read_described_path(&one, item, &targets);
        }
        json_refuse_unknown_keys(&one);
    }
    return targets;
}

void targets_free(struct scene_targets *targets)
{
    for (size_t i = 0; i < targets->count; i++) {
        free(targets->items[i].steps);
        free(targets->items[i].points);
    }
    free(targets->items);
    *targets = (struct scene_targets){.count = 0};
}
