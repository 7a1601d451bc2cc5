/* SPDX-License-Identifier: MIT */
#include "scene/scene_observe.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "base/portable_math.h"
#include "scene/scene_persistent.h"

#define RANGE_LEAST_M 0.01 /* shortest range that a plot gets: the last digit in the file */
/*
 * fixed-point iterations for the time at which the beam meets a moving target; each reduces the
 * error by the ratio of the angular speeds, 1e-2 at worst in practice
 */
#define SIGHTING_ITERATIONS 16
#define SWAY_PHASE 0.618    /* turns of phase between the sways of two targets */
#define NEXT_PASS_TURNS 0.5 /* turns after a sighting before the same object can be seen again */

static double antenna_turn_sign(const struct scene_sensor *sensor)
{
    return sensor->is_counter_clockwise ? 1.0 : -1.0;
}

/* Number of complete turns in the scene, or of scans of a sensor that does not turn. */
static size_t count_turns(const struct scene *scene, const struct scene_sensor *sensor)
{
    double turns = (scene->duration_s - sensor->start_s) / sensor->turn_s;

    turns = sensor->turns ? floor(turns + 1e-9) : ceil(turns - 1e-9);
    return turns > 0.0 ? (size_t)turns : 0;
}

/* Share of a turn, 0 .. below 1, from t_s until the antenna points to the azimuth. */
static double turn_share_until_azimuth(const struct scene_sensor *sensor, double azimuth_rad,
                                       double t_s)
{
    double turns = (t_s - sensor->start_s) / sensor->turn_s;
    double way =
        antenna_turn_sign(sensor) * (azimuth_rad - sensor->start_rad) / PORTABLE_TURN - turns;

    way -= floor(way);
    return way < 1.0 ? way : 0.0;
}

static bool is_in_sector(const struct scene_coverage *coverage, double azimuth_rad)
{
    double width, way;

    if (!coverage->has_sector) {
        return true;
    }
    width = (coverage->to_rad - coverage->from_rad) / PORTABLE_TURN;
    way = (azimuth_rad - coverage->from_rad) / PORTABLE_TURN;
    width -= floor(width);
    way -= floor(way);
    return !(width > 0.0) || way <= width;
}

static bool is_in_coverage(const struct scene_coverage *coverage, double range_m,
                           double azimuth_rad)
{
    return range_m >= coverage->range_m.lo && range_m <= coverage->range_m.hi &&
           is_in_sector(coverage, azimuth_rad);
}

static bool is_place_in_coverage(const struct scene *scene, const struct scene_sensor *sensor,
                                 double x_m, double y_m)
{
    double dx_m = x_m - sensor->x_m, dy_m = y_m - sensor->y_m;
    const double *area_m = scene->area_m;

    if (sensor->is_cartesian) {
        return !scene->has_area ||
               (x_m >= area_m[0] && x_m <= area_m[1] && y_m >= area_m[2] && y_m <= area_m[3]);
    }
    return is_in_coverage(&sensor->coverage, portable_hypot(dx_m, dy_m),
                          portable_atan2(dy_m, dx_m));
}

bool scene_covers_place(const struct scene *scene, double x_m, double y_m)
{
    for (size_t i = 0; i < scene->num_sensors; i++) {
        if (is_place_in_coverage(scene, &scene->sensors[i], x_m, y_m)) {
            return true;
        }
    }
    return false;
}

static bool is_event_active(const struct scene_event *event, size_t sensor, double t_s)
{
    return (event->sensors >> sensor & 1) && t_s >= event->from_s && t_s < event->until_s;
}

/* Whether no outage of the sensor and no mask over the place is active. */
static bool is_free_of_outage_and_mask(const struct scene *scene, size_t sensor, double t_s,
                                       double range_m, double azimuth_rad)
{
    for (size_t i = 0; i < scene->num_events; i++) {
        const struct scene_event *event = &scene->events[i];

        if (is_event_active(event, sensor, t_s) &&
            (event->kind == EVENT_OUTAGE ||
             (event->kind == EVENT_MASK && is_in_coverage(&event->within, range_m, azimuth_rad)))) {
            return false;
        }
    }
    return true;
}

/* Whether a silent outage overlaps the scan, which then is never sent. */
static bool is_scan_silenced_by_outage(const struct scene *scene, size_t sensor, double start_s,
                                       double end_s)
{
    for (size_t i = 0; i < scene->num_events; i++) {
        const struct scene_event *event = &scene->events[i];

        if (event->kind == EVENT_OUTAGE && event->is_silent && (event->sensors >> sensor & 1) &&
            end_s >= event->from_s && start_s < event->until_s) {
            return true;
        }
    }
    return false;
}

/* State of a target at the time at which the sensor's beam passes it. */
struct sighting {
    double t_s;
    struct motion at;
    double range_m, azimuth_rad;
    uint64_t pass; /* number of the pass, counted for each target */
    int target_id;
    bool is_seen;
    size_t group; /* index of the first sighting of its group of unresolved targets */
};

struct fade {
    double from_s, until_s;
    const struct scene_event *event;
};

struct target_fades {
    size_t count, room;
    struct fade *fades;
};

struct observer {
    const struct scene *scene;
    const struct scene_sensor *sensor;
    size_t index; /* index of the sensor in the scene */
    uint64_t seed, run;
    size_t turns;
    double end_s;
    size_t num_plots, room;
    struct scene_plot *plots;
    size_t num_sightings, sightings_room;
    struct sighting *sightings;
};

static double pd_at_range(const struct scene_curve *curve, double range_m)
{
    size_t i = 0;

    while (i < curve->count && curve->range_m[i] < range_m) {
        i++;
    }
    if (i == 0 || i == curve->count) {
        return curve->value[i == 0 ? 0 : i - 1];
    }
    return curve->value[i - 1] + (curve->value[i] - curve->value[i - 1]) *
                                     (range_m - curve->range_m[i - 1]) /
                                     (curve->range_m[i] - curve->range_m[i - 1]);
}

/* Stores a plot: assigns its scan, limits range and azimuth, and folds an ambiguous range rate. */
static void append_plot_to_scan(struct observer *observer, struct scene_plot plot)
{
    const struct scene_sensor *sensor = observer->sensor;
    double scans = (plot.t_s - sensor->start_s) / sensor->turn_s * (double)sensor->sectors;
    size_t last = observer->turns * sensor->sectors - 1;

    plot.scan = sensor->turns ? (size_t)fmax(0.0, floor(scans)) : (size_t)floor(scans + 0.5);
    plot.scan = plot.scan > last ? last : plot.scan;
    plot.range_m = fmax(RANGE_LEAST_M, plot.range_m);
    plot.azimuth_rad = portable_wrap_angle(plot.azimuth_rad);
    if (sensor->range_rate_span_mps > 0.0) {
        plot.range_rate_mps = remainder(plot.range_rate_mps, sensor->range_rate_span_mps);
    }
    observer->plots = must_make_room_for_one(observer->plots, observer->num_plots, &observer->room,
                                             sizeof *observer->plots);
    observer->plots[observer->num_plots++] = plot;
}

static double range_rate_of(const struct scene_sensor *sensor, const struct motion *at,
                            double range_m)
{
    return ((at->x_m - sensor->x_m) * at->vx_mps + (at->y_m - sensor->y_m) * at->vy_mps) /
           fmax(RANGE_LEAST_M, range_m);
}

/* Lasting error of a target's bearings, of each target in another phase. */
static double sway_of_sighting(const struct scene_sensor *sensor, const struct sighting *sighting)
{
    if (!(sensor->sway_rad > 0.0)) {
        return 0.0;
    }
    return sensor->sway_rad *
           portable_sin(PORTABLE_TURN * (sighting->t_s / sensor->sway_s +
                                         SWAY_PHASE * (double)sighting->target_id));
}

/*
 * Makes a plot of a sighting with biases and random noise. Three random numbers are drawn whichever
 * of range, azimuth, range rate and position the sensor measures.
 */
static struct scene_plot noisy_plot_of_sighting(const struct scene_sensor *sensor,
                                                const struct sighting *sighting,
                                                struct random *random)
{
    double first = random_normal(random), second = random_normal(random),
           third = random_normal(random);
    double sigma_rad = sensor->is_passive ? sensor->sigma_rad : sensor->sigma_azimuth_rad;

    struct scene_plot plot = {
        .t_s = sighting->t_s,
        .target_id = sighting->target_id,
        .range_m = sighting->range_m + sensor->range_bias_m + sensor->sigma_range_m * first,
        .azimuth_rad = sighting->azimuth_rad + sensor->azimuth_bias_rad +
                       sway_of_sighting(sensor, sighting) + sigma_rad * second,
        .range_rate_mps = range_rate_of(sensor, &sighting->at, sighting->range_m) +
                          sensor->sigma_range_rate_mps * third,
        .x_m = sighting->at.x_m + sensor->sigma_m * first,
        .y_m = sighting->at.y_m + sensor->sigma_m * second,
        .z_m = sighting->at.z_m + sensor->sigma_m * third};

    if (sensor->sigma_mps > 0.0) {
        plot.vx_mps = sighting->at.vx_mps + sensor->sigma_mps * random_normal(random);
        plot.vy_mps = sighting->at.vy_mps + sensor->sigma_mps * random_normal(random);
        plot.vz_mps = sighting->at.vz_mps + sensor->sigma_mps * random_normal(random);
    }
    if (sensor->sigma_elevation_rad > 0.0) {
        const double noisy_rad = portable_atan2(sighting->at.z_m - sensor->z_m, sighting->range_m) +
                                 sensor->sigma_elevation_rad * random_normal(random);

        plot.elevation_rad = fmax(-0.5 * PORTABLE_PI, fmin(0.5 * PORTABLE_PI, noisy_rad));
    }
    return plot;
}

/*
 * Finds the time after after_s at which the antenna points to the object, and its state then.
 * False: the object does not exist then.
 */
static bool find_next_sighting(const struct observer *observer, const struct scene_mover *mover,
                               double after_s, struct sighting *sighting)
{
    const struct scene_sensor *sensor = observer->sensor;
    double at_s = after_s;
    bool is_there = folded_motion_at(mover, sensor, at_s, &sighting->at);

    for (int i = 0; sensor->turns && i < SIGHTING_ITERATIONS; i++) {
        double azimuth_rad =
            portable_atan2(sighting->at.y_m - sensor->y_m, sighting->at.x_m - sensor->x_m);
        double ahead =
            turn_share_until_azimuth(sensor, azimuth_rad + sensor->azimuth_bias_rad, at_s);

        at_s += (i > 0 && ahead > 0.5 ? ahead - 1.0 : ahead) * sensor->turn_s;
        is_there = folded_motion_at(mover, sensor, at_s, &sighting->at);
    }
    sighting->t_s = at_s;
    sighting->range_m =
        portable_hypot(sighting->at.x_m - sensor->x_m, sighting->at.y_m - sensor->y_m);
    sighting->azimuth_rad =
        portable_atan2(sighting->at.y_m - sensor->y_m, sighting->at.x_m - sensor->x_m);
    return is_there;
}

/*
 * Calls `take` with each sighting at which the sensor could detect the object: in coverage, outside
 * outages and masks.
 */
static void for_each_detectable_sighting(struct observer *observer, const struct scene_mover *mover,
                                         void (*take)(struct observer *, const struct scene_mover *,
                                                      struct sighting *, uint64_t item),
                                         uint64_t item)
{
    const struct scene_sensor *sensor = observer->sensor;
    double end_s = fmin(observer->end_s, mover->until_s);
    double first_s = fmax(sensor->start_s, mover->from_s), after_s = first_s;
    uint64_t pass = 0;

    if (!sensor->turns) { /* the first scan at or after first_s */
        after_s = sensor->start_s +
                  ceil((first_s - sensor->start_s) / sensor->turn_s - 1e-9) * sensor->turn_s;
    }
    while (after_s < end_s) {
        struct sighting sighting = {.target_id = mover->target_id, .pass = pass};
        bool is_there = find_next_sighting(observer, mover, after_s, &sighting);

        if (is_there && sighting.t_s >= sensor->start_s && sighting.t_s < observer->end_s &&
            (sensor->is_cartesian || sighting.range_m > 0.0) &&
            is_place_in_coverage(observer->scene, sensor, sighting.at.x_m, sighting.at.y_m) &&
            is_free_of_outage_and_mask(observer->scene, observer->index, sighting.t_s,
                                       sighting.range_m, sighting.azimuth_rad)) {
            take(observer, mover, &sighting, item);
        }
        pass++;
        if (!sensor->turns) {
            size_t next = (size_t)floor((after_s - sensor->start_s) / sensor->turn_s + 1.5);

            after_s = sensor->start_s + (double)next * sensor->turn_s;
        } else {
            after_s = fmax(sighting.t_s, after_s) + NEXT_PASS_TURNS * sensor->turn_s;
        }
    }
}

static struct target_fades draw_fades_of_target(const struct scene *scene,
                                                const struct scene_path *path, uint64_t target,
                                                uint64_t seed, uint64_t run)
{
    struct target_fades fades = {.count = 0};

    for (size_t i = 0; i < scene->num_events; i++) {
        const struct scene_event *event = &scene->events[i];
        struct random random = scene_random_stream(seed, run, STREAM_FADES, i, target, 0);
        double from_s = fmax(0.0, event->from_s), until_s = fmin(scene->duration_s, event->until_s);
        uint64_t count =
            random_poisson(&random, event->per_hour / 3600.0 * fmax(0.0, until_s - from_s));

        if (event->kind != EVENT_FADES ||
            (event->has_targets && (path->item > 31 || !(event->targets >> path->item & 1)))) {
            continue;
        }
        count = event->per_hour > 0.0 ? count : 1;
        for (uint64_t k = 0; k < count; k++) {
            struct fade fade = {event->from_s, event->until_s, event};

            if (event->per_hour > 0.0) {
                fade.from_s = random_between(&random, from_s, until_s);
                fade.until_s = fade.from_s + random_in_span(&random, event->for_s);
            }
            fades.fades =
                must_make_room_for_one(fades.fades, fades.count, &fades.room, sizeof *fades.fades);
            fades.fades[fades.count++] = fade;
        }
    }
    return fades;
}

/* The P_D of a sighting by a sensor: pd, or less in a fade that counts at its place. */
static double faded_pd(const struct target_fades *fades, size_t sensor, const struct sighting *on,
                       double pd)
{
    for (size_t i = 0; i < fades->count; i++) {
        const struct fade *fade = &fades->fades[i];
        const struct scene_event *event = fade->event;

        if ((event->sensors >> sensor & 1) && on->t_s >= fade->from_s && on->t_s < fade->until_s &&
            is_in_coverage(&event->within, on->range_m, on->azimuth_rad)) {
            pd = fmin(pd, event->pd);
        }
    }
    return pd;
}

static void append_true_sighting_of_target(struct observer *observer,
                                           const struct scene_mover *mover,
                                           struct sighting *sighting, uint64_t item)
{
    (void)mover;
    (void)item;
    observer->sightings =
        must_make_room_for_one(observer->sightings, observer->num_sightings,
                               &observer->sightings_room, sizeof *observer->sightings);
    observer->sightings[observer->num_sightings++] = *sighting;
}

static struct random pass_random_stream(const struct observer *observer,
                                        const struct sighting *sighting)
{
    return scene_random_stream(observer->seed, observer->run, STREAM_TARGET, observer->index,
                               (uint64_t)sighting->target_id, sighting->pass);
}

static void add_split_plots(struct observer *observer, const struct sighting *sighting)
{
    const struct scene_sensor *sensor = observer->sensor;

    for (size_t i = 0; i < observer->scene->num_events; i++) {
        const struct scene_event *event = &observer->scene->events[i];
        struct random random;

        if (event->kind != EVENT_SPLIT || !is_event_active(event, observer->index, sighting->t_s)) {
            continue;
        }
        random = scene_random_stream(observer->seed, observer->run, STREAM_SPLIT,
                                     i * 64 + observer->index, (uint64_t)sighting->target_id,
                                     sighting->pass);
        if (random_uniform(&random) < event->share) {
            struct scene_plot second = noisy_plot_of_sighting(sensor, sighting, &random);

            second.range_m += sensor->sigma_range_m * random_in_span(&random, event->range_sigmas) +
                              random_in_span(&random, event->range_m);
            second.azimuth_rad +=
                sensor->sigma_azimuth_rad * random_in_span(&random, event->azimuth_sigmas) +
                random_in_span(&random, event->azimuth_rad);
            second.x_m += sensor->sigma_m * random_in_span(&random, event->range_sigmas);
            second.y_m += sensor->sigma_m * random_in_span(&random, event->azimuth_sigmas);
            append_plot_to_scan(observer, second);
        }
    }
}

/* Adds the mirror images of a detected target in the reflectors, as plots of no target. */
static void add_image_plots(struct observer *observer, const struct sighting *sighting)
{
    const struct scene_sensor *sensor = observer->sensor;

    for (size_t i = 0; !sensor->is_passive && i < observer->scene->reflectors.count; i++) {
        const struct scene_reflector *wall = &observer->scene->reflectors.items[i];
        struct random random = scene_random_stream(observer->seed, observer->run, STREAM_IMAGE,
                                                   i * 64 + observer->index,
                                                   (uint64_t)sighting->target_id, sighting->pass);
        struct sighting image = *sighting;

        if (random_uniform(&random) >= wall->probability ||
            !scene_reflector_image(wall, sensor->x_m, sensor->y_m, &sighting->at, &image.at) ||
            !is_place_in_coverage(observer->scene, sensor, image.at.x_m, image.at.y_m)) {
            continue;
        }
        image.target_id = -1;
        image.range_m = portable_hypot(image.at.x_m - sensor->x_m, image.at.y_m - sensor->y_m);
        image.azimuth_rad = portable_atan2(image.at.y_m - sensor->y_m, image.at.x_m - sensor->x_m);
        append_plot_to_scan(observer, noisy_plot_of_sighting(sensor, &image, &random));
    }
}

static int by_time(const void *a, const void *b)
{
    const struct sighting *one = a, *other = b;

    if (one->t_s < other->t_s || one->t_s > other->t_s) {
        return one->t_s > other->t_s ? 1 : -1;
    }
    return (one->target_id > other->target_id) - (one->target_id < other->target_id);
}

static bool are_unresolved(const struct scene_sensor *sensor, const struct sighting *one,
                           const struct sighting *other)
{
    if (sensor->is_cartesian) {
        return portable_hypot(one->at.x_m - other->at.x_m, one->at.y_m - other->at.y_m) <
               sensor->resolution_m;
    }
    if (sensor->is_passive) {
        return false;
    }
    return fabs(one->range_m - other->range_m) < sensor->resolution_m &&
           fabs(portable_wrap_angle(one->azimuth_rad - other->azimuth_rad)) <
               sensor->resolution_rad;
}

/*
 * Groups sightings, sorted by time, that the sensor does not resolve: pairwise unresolved ones get
 * one group number.
 */
static void number_unresolved_groups(struct observer *observer)
{
    const struct scene_sensor *sensor = observer->sensor;
    double window_s =
        sensor->turns ? sensor->resolution_rad / PORTABLE_TURN * sensor->turn_s * 1.01 : 0.0;

    for (size_t i = 0; i < observer->num_sightings; i++) {
        observer->sightings[i].group = i;
    }
    for (size_t i = 0; sensor->resolution_m > 0.0 && i < observer->num_sightings; i++) {
        for (size_t k = i + 1; k < observer->num_sightings &&
                               observer->sightings[k].t_s - observer->sightings[i].t_s <= window_s;
             k++) {
            if (are_unresolved(sensor, &observer->sightings[i], &observer->sightings[k])) {
                size_t from = observer->sightings[k].group, to = observer->sightings[i].group;
                size_t low = from < to ? from : to;

                for (size_t m = low; m <= k; m++) {
                    if (observer->sightings[m].group == from ||
                        observer->sightings[m].group == to) {
                        observer->sightings[m].group = low;
                    }
                }
            }
        }
    }
}

/*
 * Mean of the sightings in the group that begins with index first; detected where any of them is.
 */
static struct sighting merge_sighting_group(const struct observer *observer, size_t first)
{
    struct sighting middle = observer->sightings[first];
    double dx_m = 0, dy_m = 0, vx_mps = 0, vy_mps = 0, range_m = 0, way_rad = 0, t_s = 0, n = 0;
    double z_m = 0, vz_mps = 0;
    double window_s = 0.25 * observer->sensor->turn_s;

    for (size_t i = first; i < observer->num_sightings &&
                           observer->sightings[i].t_s - observer->sightings[first].t_s <= window_s;
         i++) {
        const struct sighting *one = &observer->sightings[i];

        if (one->group != first) {
            continue;
        }
        if (!middle.is_seen && one->is_seen) {
            middle.target_id = one->target_id;
        }
        middle.is_seen = middle.is_seen || one->is_seen;
        dx_m += one->at.x_m - middle.at.x_m;
        dy_m += one->at.y_m - middle.at.y_m;
        vx_mps += one->at.vx_mps;
        vy_mps += one->at.vy_mps;
        z_m += one->at.z_m;
        vz_mps += one->at.vz_mps;
        range_m += one->range_m;
        way_rad += portable_wrap_angle(one->azimuth_rad - middle.azimuth_rad);
        t_s += one->t_s;
        n += 1.0;
    }
    middle.at = (struct motion){.x_m = middle.at.x_m + dx_m / n,
                                .y_m = middle.at.y_m + dy_m / n,
                                .vx_mps = vx_mps / n,
                                .vy_mps = vy_mps / n,
                                .z_m = z_m / n,
                                .vz_mps = vz_mps / n};
    middle.range_m = range_m / n;
    middle.azimuth_rad += way_rad / n;
    middle.t_s = t_s / n;
    return middle;
}

#define HEADING_RATE_S 0.01 /* interval over which the turn rate is computed from headings */

static double path_heading_rad(const struct scene_path *path, double t_s)
{
    const struct motion at = path_motion_at(path, t_s);

    return portable_hypot(at.vx_mps, at.vy_mps) > PATH_STANDS_MPS
               ? portable_atan2(at.vy_mps, at.vx_mps)
               : path_leg_heading_rad(path_leg_at(path, t_s), t_s);
}

/*
 * Sighting of a point on the body when the beam passes the body's centre: the point moves and turns
 * with the body.
 */
static struct sighting sighting_of_body_point(const struct scene_sensor *sensor,
                                              const struct sighting *centre,
                                              const struct scene_path *path,
                                              const double place_m[2])
{
    const double t_s = centre->t_s, turn_rad = path_heading_rad(path, t_s);
    const double turn_radps =
        portable_wrap_angle(path_heading_rad(path, t_s + HEADING_RATE_S) - turn_rad) /
        HEADING_RATE_S;
    const double c = portable_cos(turn_rad), s = portable_sin(turn_rad);
    const double x_m = c * place_m[0] - s * place_m[1], y_m = s * place_m[0] + c * place_m[1];
    struct sighting on = *centre;

    on.at.x_m += x_m;
    on.at.y_m += y_m;
    on.at.vx_mps -= turn_radps * y_m;
    on.at.vy_mps += turn_radps * x_m;
    on.range_m = portable_hypot(on.at.x_m - sensor->x_m, on.at.y_m - sensor->y_m);
    on.azimuth_rad = portable_atan2(on.at.y_m - sensor->y_m, on.at.x_m - sensor->x_m);
    return on;
}

/* Adds a plot for each detected scatterer of a body, and its images; no split plots. */
static void add_body_plots(struct observer *observer, const struct scene_body *body,
                           const struct scene_path *path, const struct sighting *centre,
                           const struct target_fades *fades)
{
    const struct scene_sensor *sensor = observer->sensor;
    const uint64_t target = (uint64_t)centre->target_id;
    struct random stay =
        scene_random_stream(observer->seed, observer->run, STREAM_BODY, 0, target, 0);
    struct random look = scene_random_stream(observer->seed, observer->run, STREAM_LOOK,
                                             observer->index, target, centre->pass);
    double places_m[SCENE_SCATTERERS_MAX][2];

    scene_body_draw_scatterers(body, body->is_anew ? &look : &stay, places_m);
    for (size_t i = 0; i < body->scatterers; i++) {
        struct sighting on = sighting_of_body_point(sensor, centre, path, places_m[i]);

        if (body->limbs_mps > 0.0) {
            on.at.vx_mps += body->limbs_mps * random_normal(&look);
            on.at.vy_mps += body->limbs_mps * random_normal(&look);
        }
        const double pd = faded_pd(
            fades, observer->index, &on,
            scene_notch_pd(&sensor->notch, range_rate_of(sensor, &on.at, on.range_m), body->seen));

        if (random_uniform(&look) < pd &&
            is_place_in_coverage(observer->scene, sensor, on.at.x_m, on.at.y_m)) {
            append_plot_to_scan(observer, noisy_plot_of_sighting(sensor, &on, &look));
            add_image_plots(observer, &on);
        }
    }
}

/* Adds the plots of extended targets, and removes them from the sightings: point targets remain. */
static void add_plots_of_all_bodies(struct observer *observer, const struct scene_run *run,
                                    const struct target_fades *fades)
{
    size_t points = 0;

    for (size_t i = 0; i < observer->num_sightings; i++) {
        const struct sighting one = observer->sightings[i];
        const struct scene_path *path = &run->paths[one.target_id];
        const struct scene_body *body = &run->scene->targets.items[path->item].body;

        if (body->scatterers > 0) {
            add_body_plots(observer, body, path, &one, &fades[one.target_id]);
        } else {
            observer->sightings[points++] = one;
        }
    }
    observer->num_sightings = points;
}

static void observe_targets(struct observer *observer, const struct scene_run *run,
                            const struct target_fades *fades)
{
    for (size_t i = 0; i < run->num_paths; i++) {
        const struct scene_path *path = &run->paths[i];
        const struct scene_mover mover = {.path = path,
                                          .from_s = path->from_s,
                                          .until_s = path->until_s,
                                          .pd = -1.0,
                                          .target_id = (int)i};

        for_each_detectable_sighting(observer, &mover, append_true_sighting_of_target, 0);
    }
    if (observer->num_sightings > 0) {
        qsort(observer->sightings, observer->num_sightings, sizeof *observer->sightings, by_time);
    }
    add_plots_of_all_bodies(observer, run, fades);
    for (size_t i = 0; i < observer->num_sightings; i++) {
        struct sighting *one = &observer->sightings[i];
        struct random random = pass_random_stream(observer, one);
        double pd = scene_notch_pd(&observer->sensor->notch,
                                   range_rate_of(observer->sensor, &one->at, one->range_m),
                                   pd_at_range(&observer->sensor->pd, one->range_m));

        one->is_seen =
            random_uniform(&random) < faded_pd(&fades[one->target_id], observer->index, one, pd);
    }
    number_unresolved_groups(observer);
    for (size_t i = 0; i < observer->num_sightings; i++) {
        if (observer->sightings[i].group == i) {
            struct sighting middle = merge_sighting_group(observer, i);
            struct random random = pass_random_stream(observer, &observer->sightings[i]);

            random_uniform(&random); /* skip the number that decided the detection */
            if (middle.is_seen) {
                append_plot_to_scan(observer,
                                    noisy_plot_of_sighting(observer->sensor, &middle, &random));
                add_split_plots(observer, &middle);
                add_image_plots(observer, &middle);
            }
        }
    }
}

/* Adds a plot of an object of the clutter that stays from scan to scan. */
static void add_persistent_clutter(struct observer *observer, const struct scene_mover *mover,
                                   struct sighting *sighting, uint64_t item)
{
    struct random random =
        scene_random_stream(observer->seed, observer->run, STREAM_CLUTTER,
                            (item >> 32) * 64 + observer->index, item & UINT32_MAX, sighting->pass);

    if (random_uniform(&random) < mover->pd) {
        append_plot_to_scan(observer, noisy_plot_of_sighting(observer->sensor, sighting, &random));
    }
}

static void observe_persistent_clutter(struct observer *observer, const struct scene_run *run,
                                       size_t source)
{
    struct scene_path *paths;
    size_t count, num_paths;
    struct scene_mover *movers = draw_persistent_clutter(run->scene, source, run->seed, run->run,
                                                         &count, &paths, &num_paths);

    for (size_t i = 0; i < count; i++) {
        for_each_detectable_sighting(observer, &movers[i], add_persistent_clutter,
                                     (uint64_t)source << 32 | i);
    }
    for (size_t i = 0; i < num_paths; i++) {
        path_free(&paths[i]);
    }
    free(paths);
    free(movers);
}

/*
 * Stores a clutter plot at the time at which the antenna passes it in this turn, unless hidden or
 * out of coverage.
 */
static void store_clutter_plot(struct observer *observer, size_t turn, double range_m,
                               double azimuth_rad, double x_m, double y_m, double rate_mps)
{
    const struct scene_sensor *sensor = observer->sensor;
    double turn_s = sensor->start_s + (double)turn * sensor->turn_s, t_s = turn_s;

    if (sensor->turns) {
        t_s += turn_share_until_azimuth(sensor, azimuth_rad + sensor->azimuth_bias_rad,
                                        sensor->start_s) *
               sensor->turn_s;
    }
    if (range_m > 0.0 &&
        is_free_of_outage_and_mask(observer->scene, observer->index, t_s, range_m, azimuth_rad) &&
        (sensor->is_cartesian || is_in_coverage(&sensor->coverage, range_m, azimuth_rad))) {
        append_plot_to_scan(
            observer, (struct scene_plot){.t_s = t_s,
                                          .target_id = -1,
                                          .range_m = range_m + sensor->range_bias_m,
                                          .azimuth_rad = azimuth_rad + sensor->azimuth_bias_rad,
                                          .range_rate_mps = rate_mps,
                                          .x_m = x_m,
                                          .y_m = y_m});
    }
}

static void store_clutter_plot_at_xy(struct observer *observer, size_t turn, double x_m, double y_m,
                                     double rate_mps)
{
    double dx_m = x_m - observer->sensor->x_m, dy_m = y_m - observer->sensor->y_m;

    store_clutter_plot(observer, turn, portable_hypot(dx_m, dy_m), portable_atan2(dy_m, dx_m), x_m,
                       y_m, rate_mps);
}

/* Limits of the sector, or of the full circle; *to_rad is above *from_rad. */
static void azimuth_limits(const struct scene_coverage *coverage, double *from_rad, double *to_rad)
{
    *from_rad = coverage->has_sector ? coverage->from_rad : -PORTABLE_PI;
    *to_rad = coverage->has_sector ? coverage->to_rad : PORTABLE_PI;
    *to_rad += *to_rad <= *from_rad ? PORTABLE_TURN : 0.0;
}

static void add_uniform_clutter_plot(struct observer *observer, const struct scene_clutter *clutter,
                                     size_t turn, struct random *random)
{
    const struct scene_sensor *sensor = observer->sensor;
    const struct scene_coverage *coverage = &sensor->coverage;
    double rate_max_mps =
        clutter->rate_max_mps > 0.0 ? clutter->rate_max_mps : observer->scene->v_max_mps;
    double rate_mps = clutter->rate_sigma_mps > 0.0
                          ? clutter->rate_sigma_mps * random_normal(random)
                          : random_between(random, -rate_max_mps, rate_max_mps);

    if (clutter->has_box || sensor->is_cartesian) {
        const double *box_m = clutter->has_box ? clutter->box_m : observer->scene->area_m;
        double x_m = random_between(random, box_m[0], box_m[1]);

        store_clutter_plot_at_xy(observer, turn, x_m, random_between(random, box_m[2], box_m[3]),
                                 rate_mps);
    } else {
        struct json_span range =
            clutter->within.range_m.lo < 0.0 ? coverage->range_m : clutter->within.range_m;
        double from_rad, to_rad, range_m = random_in_span(random, range);

        azimuth_limits(clutter->within.has_sector ? &clutter->within : coverage, &from_rad,
                       &to_rad);
        store_clutter_plot(observer, turn, range_m, random_between(random, from_rad, to_rad), 0, 0,
                           rate_mps);
    }
}

static void add_clutter_cell_plot(struct observer *observer, const struct scene_clutter *clutter,
                                  size_t turn, struct random *random)
{
    const struct scene_sensor *sensor = observer->sensor;
    double t_s = sensor->start_s + ((double)turn + (sensor->turns ? 0.5 : 0.0)) * sensor->turn_s;
    double x_m = clutter->x_m + clutter->vx_mps * t_s, y_m = clutter->y_m + clutter->vy_mps * t_s;
    double rate_mps = clutter->rate_sigma_mps * random_normal(random);
    struct motion at;

    if (clutter->is_disc) {
        double radius_m = clutter->radius_m * sqrt(random_uniform(random));
        double angle_rad = random_between(random, -PORTABLE_PI, PORTABLE_PI);

        x_m += radius_m * portable_cos(angle_rad);
        y_m += radius_m * portable_sin(angle_rad);
    } else {
        x_m += clutter->radius_m * random_normal(random);
        y_m += clutter->radius_m * random_normal(random);
    }
    at = (struct motion){
        .x_m = x_m, .y_m = y_m, .vx_mps = clutter->vx_mps, .vy_mps = clutter->vy_mps};
    rate_mps += range_rate_of(sensor, &at, portable_hypot(x_m - sensor->x_m, y_m - sensor->y_m));
    store_clutter_plot_at_xy(observer, turn, x_m, y_m, rate_mps);
}

static void add_strobe_plot(struct observer *observer, const struct scene_clutter *clutter,
                            size_t turn, struct random *random)
{
    const struct scene_sensor *sensor = observer->sensor;
    double t_s = sensor->start_s + (double)turn * sensor->turn_s;
    struct json_span range =
        clutter->within.range_m.lo < 0.0 ? sensor->coverage.range_m : clutter->within.range_m;
    double azimuth_rad = clutter->azimuth_rad + clutter->azimuth_radps * t_s +
                         clutter->width_rad * (random_uniform(random) - 0.5);
    double range_m = random_in_span(random, range);
    double rate_mps =
        random_between(random, -observer->scene->v_max_mps, observer->scene->v_max_mps);

    azimuth_rad = portable_wrap_angle(azimuth_rad);
    store_clutter_plot(observer, turn, range_m, azimuth_rad,
                       sensor->x_m + range_m * portable_cos(azimuth_rad),
                       sensor->y_m + range_m * portable_sin(azimuth_rad), rate_mps);
}

/*
 * Adds clutter plots uniform in a ball (without heights: a disc) about the target, as wide as the
 * beam there.
 */
static void add_clutter_about_target(struct observer *observer, const struct scene_clutter *clutter,
                                     size_t turn, const struct scene_path *path,
                                     struct random *random)
{
    const struct scene_sensor *sensor = observer->sensor;
    double t_s = sensor->start_s + ((double)turn + (sensor->turns ? 0.5 : 0.0)) * sensor->turn_s;
    struct motion at = path_motion_at(path, t_s), last = path_motion_at(path, t_s - sensor->turn_s);
    double ground_m = portable_hypot(at.x_m - sensor->x_m, at.y_m - sensor->y_m);
    double radius_m = portable_hypot(ground_m, at.z_m) * portable_sin(0.5 * clutter->width_rad);
    double x, y, z;

    if (!is_place_in_coverage(observer->scene, sensor, at.x_m, at.y_m)) {
        return;
    }
    for (uint64_t i = 0; i < clutter->count; i++) {
        size_t before = observer->num_plots;

        do {
            x = random_between(random, -1.0, 1.0);
            y = random_between(random, -1.0, 1.0);
            z = observer->scene->has_heights ? random_between(random, -1.0, 1.0) : 0.0;
        } while (x * x + y * y + z * z > 1.0);
        store_clutter_plot_at_xy(observer, turn, at.x_m + radius_m * x, at.y_m + radius_m * y,
                                 range_rate_of(sensor, &at, ground_m));
        if (observer->num_plots > before) {
            struct scene_plot *plot = &observer->plots[before];

            plot->z_m = at.z_m + radius_m * z;
            plot->vx_mps = (plot->x_m - last.x_m) / sensor->turn_s;
            plot->vy_mps = (plot->y_m - last.y_m) / sensor->turn_s;
            plot->vz_mps = (plot->z_m - last.z_m) / sensor->turn_s;
        }
    }
}

static void observe_clutter_about_targets(struct observer *observer, const struct scene_run *run,
                                          size_t source)
{
    const struct scene_clutter *clutter = &observer->scene->clutter[source];

    for (size_t turn = 0; turn < observer->turns; turn++) {
        double t_s = observer->sensor->start_s + (double)turn * observer->sensor->turn_s;

        for (size_t i = 0; i < run->num_paths && t_s >= clutter->from_s && t_s < clutter->until_s;
             i++) {
            struct random random =
                scene_random_stream(observer->seed, observer->run, STREAM_CLUTTER,
                                    source * 64 + observer->index, turn, i);

            if (t_s >= run->paths[i].from_s && t_s < run->paths[i].until_s) {
                add_clutter_about_target(observer, clutter, turn, &run->paths[i], &random);
            }
        }
    }
}

/* Mean number of clutter plots a scan, by number or by density over the area. */
static double mean_clutter_plots_per_scan(const struct scene *scene,
                                          const struct scene_clutter *clutter)
{
    const double *box_m = clutter->has_box ? clutter->box_m : scene->area_m;

    return clutter->plots +
           clutter->plots_per_km2 * (box_m[1] - box_m[0]) * (box_m[3] - box_m[2]) * 1e-6;
}

/* Adds the plots of uniform, cell and strobe clutter, which are drawn anew each scan. */
static void observe_scan_clutter(struct observer *observer, size_t source)
{
    const struct scene_clutter *clutter = &observer->scene->clutter[source];
    double mean = mean_clutter_plots_per_scan(observer->scene, clutter);

    for (size_t turn = 0; turn < observer->turns; turn++) {
        double t_s = observer->sensor->start_s + (double)turn * observer->sensor->turn_s;
        struct random random = scene_random_stream(observer->seed, observer->run, STREAM_CLUTTER,
                                                   source * 64 + observer->index, turn, 0);
        uint64_t count = random_poisson(&random, mean);

        if (t_s < clutter->from_s || t_s >= clutter->until_s) {
            continue;
        }
        for (uint64_t i = 0; i < count; i++) {
            if (clutter->kind == CLUTTER_UNIFORM) {
                add_uniform_clutter_plot(observer, clutter, turn, &random);
            } else if (clutter->kind == CLUTTER_CELL) {
                add_clutter_cell_plot(observer, clutter, turn, &random);
            } else {
                add_strobe_plot(observer, clutter, turn, &random);
            }
        }
    }
}

/* A number of a geometric distribution. */
static uint64_t draw_geometric(struct random *random, double mean)
{
    uint64_t count = 0;

    while (random_uniform(random) < mean / (1.0 + mean)) {
        count++;
    }
    return count;
}

/* False bearings have elevations of 0 to 45 degrees. */
static void observe_false_bearings(struct observer *observer)
{
    const struct scene_sensor *sensor = observer->sensor;

    for (size_t turn = 0; turn < observer->turns; turn++) {
        struct random random = scene_random_stream(observer->seed, observer->run, STREAM_BEARINGS,
                                                   observer->index, turn, 0);
        uint64_t count = sensor->is_geometric ? draw_geometric(&random, sensor->false_bearings)
                                              : random_poisson(&random, sensor->false_bearings);

        for (uint64_t i = 0; i < count; i++) {
            const size_t before = observer->num_plots;

            store_clutter_plot(
                observer, turn, 0.5 * (sensor->coverage.range_m.lo + sensor->coverage.range_m.hi),
                random_between(&random, sensor->false_from_rad, sensor->false_to_rad), 0, 0, 0);
            if (sensor->sigma_elevation_rad > 0.0 && observer->num_plots > before) {
                observer->plots[before].elevation_rad =
                    random_between(&random, 0.0, 0.25 * PORTABLE_PI);
            }
        }
    }
}

static int by_scan_and_time(const void *a, const void *b)
{
    const struct scene_plot *one = a, *other = b;
    const double pairs[][2] = {
        {one->t_s, other->t_s},         {one->azimuth_rad, other->azimuth_rad},
        {one->range_m, other->range_m}, {one->x_m, other->x_m},
        {one->y_m, other->y_m},         {one->target_id, other->target_id}};

    if (one->scan != other->scan) {
        return one->scan > other->scan ? 1 : -1;
    }
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        if (pairs[i][0] < pairs[i][1] || pairs[i][0] > pairs[i][1]) {
            return pairs[i][0] > pairs[i][1] ? 1 : -1;
        }
    }
    return 0;
}

/*
 * Azimuth at which sector `index` of a turn begins; wrapped, so that it is the same number in every
 * turn.
 */
static double sector_border_rad(const struct scene_sensor *sensor, size_t index)
{
    double share = (double)(index % sensor->sectors) / (double)sensor->sectors;

    return portable_wrap_angle(sensor->start_rad +
                               antenna_turn_sign(sensor) * PORTABLE_TURN * share);
}

static struct scene_scan make_scan(const struct observer *observer, size_t number)
{
    const struct scene_sensor *sensor = observer->sensor;
    double scan_s = sensor->turn_s / (double)sensor->sectors;
    struct scene_scan scan = {.sensor = observer->index,
                              .number = number,
                              .end_s = sensor->start_s +
                                       (double)(number + (sensor->turns ? 1 : 0)) * scan_s};

    if (sensor->sectors > 1) {
        double first_rad = sector_border_rad(sensor, number),
               last_rad = sector_border_rad(sensor, number + 1);

        scan.from_rad = sensor->is_counter_clockwise ? first_rad : last_rad;
        scan.to_rad = sensor->is_counter_clockwise ? last_rad : first_rad;
    } else if (sensor->told.coverage.has_sector) {
        scan.from_rad =
            portable_wrap_angle(sensor->told.coverage.from_rad + sensor->azimuth_bias_rad);
        scan.to_rad = portable_wrap_angle(sensor->told.coverage.to_rad + sensor->azimuth_bias_rad);
    }
    return scan;
}

/*
 * Makes the sensor's scans of its sorted plots, draws late arrivals, and stores scans that no
 * outage silences.
 */
static void store_scans_of_sensor(struct scene_run *run, const struct observer *observer,
                                  size_t *room)
{
    const struct scene_sensor *sensor = observer->sensor;
    double scan_s = sensor->turns ? sensor->turn_s / (double)sensor->sectors : 0.0;
    size_t taken = 0;

    for (size_t i = 0; i < observer->turns * sensor->sectors; i++) {
        struct scene_scan scan = make_scan(observer, i);
        struct random random = scene_random_stream(observer->seed, observer->run, STREAM_ARRIVAL,
                                                   observer->index, i, 0);

        scan.plots = observer->plots ? observer->plots + taken : NULL;
        while (taken < observer->num_plots && observer->plots[taken].scan == i) {
            taken++;
            scan.num_plots++;
        }
        scan.received_s = scan.end_s;
        if (random_uniform(&random) < sensor->late_share) {
            scan.received_s += sensor->late_s;
        }
        if (!is_scan_silenced_by_outage(run->scene, observer->index, scan.end_s - scan_s,
                                        scan.end_s)) {
            run->scans =
                must_make_room_for_one(run->scans, run->num_scans, room, sizeof *run->scans);
            run->scans[run->num_scans++] = scan;
        }
    }
}

static int by_arrival(const void *a, const void *b)
{
    const struct scene_scan *one = a, *other = b;

    if (one->received_s < other->received_s || one->received_s > other->received_s) {
        return one->received_s > other->received_s ? 1 : -1;
    }
    if (one->sensor != other->sensor) {
        return one->sensor > other->sensor ? 1 : -1;
    }
    return (one->number > other->number) - (one->number < other->number);
}

static void observe_whole_run_with_sensor(struct observer *observer, const struct scene_run *run,
                                          const struct target_fades *fades)
{
    observe_targets(observer, run, fades);
    for (size_t i = 0; !observer->sensor->is_passive && i < run->scene->num_clutter; i++) {
        enum clutter_kind kind = run->scene->clutter[i].kind;

        if (!(run->scene->clutter[i].sensors >> observer->index & 1)) {
            continue;
        }
        if (kind == CLUTTER_UNIFORM || kind == CLUTTER_CELL || kind == CLUTTER_STROBE) {
            observe_scan_clutter(observer, i);
        } else if (kind == CLUTTER_ABOUT_TARGETS) {
            observe_clutter_about_targets(observer, run, i);
        } else {
            observe_persistent_clutter(observer, run, i);
        }
    }
    if (observer->sensor->is_passive) {
        observe_false_bearings(observer);
    }
    if (observer->num_plots > 0) {
        qsort(observer->plots, observer->num_plots, sizeof *observer->plots, by_scan_and_time);
    }
}

struct scene_run *scene_observe(const struct scene *scene, uint64_t seed, uint64_t run_number)
{
    struct scene_run *run = must_calloc(1, sizeof *run);
    struct target_fades *fades;
    size_t room = 0;

    run->scene = scene;
    run->seed = seed;
    run->run = run_number;
    run->paths = targets_draw_paths(&scene->targets, scene->name, scene->duration_s, seed,
                                    run_number, 0, &run->num_paths);
    fades = must_calloc(run->num_paths + 1, sizeof *fades);
    for (size_t i = 0; i < run->num_paths; i++) {
        fades[i] = draw_fades_of_target(scene, &run->paths[i], i, seed, run_number);
    }
    for (size_t i = 0; i < scene->num_sensors; i++) {
        struct scene_sensor sensor = scene->sensors[i];
        struct random random = scene_random_stream(seed, run_number, STREAM_START, i, 0, 0);
        struct observer observer = {
            .scene = scene, .sensor = &sensor, .index = i, .seed = seed, .run = run_number};

        sensor.start_s = random_in_span(&random, sensor.starts_s);
        sensor.start_rad = random_in_span(&random, sensor.starts_rad);
        observer.turns = count_turns(scene, &sensor);
        observer.end_s = sensor.start_s + (double)observer.turns * sensor.turn_s;
        if (observer.turns > 0) {
            observe_whole_run_with_sensor(&observer, run, fades);
            store_scans_of_sensor(run, &observer, &room);
        }
        run->plots[i] = observer.plots;
        free(observer.sightings);
    }
    if (run->num_scans > 0) {
        qsort(run->scans, run->num_scans, sizeof *run->scans, by_arrival);
    }
    for (size_t i = 0; i < run->num_paths; i++) {
        free(fades[i].fades);
    }
    free(fades);
    return run;
}

void scene_run_free(struct scene_run *run)
{
    for (size_t i = 0; i < run->num_paths; i++) {
        path_free(&run->paths[i]);
    }
    for (size_t i = 0; i < run->scene->num_sensors; i++) {
        free(run->plots[i]);
    }
    free(run->paths);
    free(run->scans);
    free(run);
}
