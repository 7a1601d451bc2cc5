/* SPDX-License-Identifier: MIT */
/*
 * scene_flights: aircraft over an area, always as many in the air: where one ends another begins.
 *
 * A flight enters over the border or takes off inside and climbs; it flies straight, turns, holds,
 * changes its speed, and leaves over the border or descends and lands. Some take-offs are such that
 * they meet another flight at an angle.
 */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "base/portable_math.h"
#include "scene/scene_path.h"

#define DEG_RAD (PORTABLE_PI / 180.0)
#define DRAFTS_MAX 1000 /* flights drawn anew until one lasts long enough */
#define PARTNERS_MAX 20 /* flights tried to meet */

/* Before the scene's start flights come and go, so that those in the air then have any age. */
#define BEFORE_MIN_S 3600.0
#define BEFORE_MAX_S 7200.0

#define CRUISE_MIN_MPS 180.0
#define CRUISE_MAX_MPS 260.0
#define GROUND_MPS 80.0 /* at take-off and landing */
#define HOLD_MIN_MPS 110.0
#define HOLD_MAX_MPS 150.0
#define ACCEL_MIN_MPS2 0.5
#define ACCEL_MAX_MPS2 1.2
#define TURN_MIN_RADPS (1.5 * DEG_RAD)
#define TURN_MAX_RADPS (3.0 * DEG_RAD)
#define TURN_MAX_MPS2 8.0 /* across: fast aircraft turn slowly */

struct sky {
    const struct target_item *item;
    struct random *random;
    struct scene_path *slots; /* the flight in each, from_s .. until_s; without legs: none yet */
    struct scene_path draft;  /* until_s: its end so far */
    bool is_over;
};

static double draw_number(struct sky *sky, double lo, double hi)
{
    return random_between(sky->random, lo, hi);
}

static bool is_inside(const struct sky *sky, double x_m, double y_m)
{
    const double *box_m = sky->item->box_m;

    return x_m >= box_m[0] && x_m <= box_m[1] && y_m >= box_m[2] && y_m <= box_m[3];
}

static bool is_inside_at(const struct sky *sky, double t_s)
{
    struct motion at = path_motion_at(&sky->draft, t_s);

    return is_inside(sky, at.x_m, at.y_m);
}

/* ---- one random flight ---- */

static void open_flight(struct sky *sky, double start_s, double x_m, double y_m, double speed_mps,
                        double heading_rad)
{
    path_free(&sky->draft);
    sky->draft = (struct scene_path){.from_s = start_s, .until_s = start_s};
    path_begin_first_leg(&sky->draft, x_m, y_m, speed_mps, heading_rad);
    sky->is_over = false;
}

/*
 * One leg more, as far as the border. The area is convex: a straight leg that ends inside is
 * inside.
 */
static void fly_leg(struct sky *sky, double duration_s, double turn_radps, double accel_mps2)
{
    double from_s = sky->draft.until_s, end_s = from_s + duration_s;

    if (sky->is_over) {
        return;
    }
    path_begin_next_leg(&sky->draft, from_s, accel_mps2, turn_radps);
    sky->draft.until_s = end_s;
    if (fabs(turn_radps) > 0.0 || !is_inside_at(sky, end_s)) {
        double last_s = from_s;

        while (last_s + 1.0 < end_s && is_inside_at(sky, last_s + 1.0)) {
            last_s += 1.0;
        }
        sky->is_over = last_s + 1.0 < end_s || !is_inside_at(sky, end_s);
        sky->draft.until_s = sky->is_over ? last_s : end_s;
    }
}

static void fly_straight(struct sky *sky, double duration_s)
{
    fly_leg(sky, duration_s, 0.0, 0.0);
}

static void reach_speed(struct sky *sky, double speed_mps)
{
    double change_mps = speed_mps - path_speed_mps(&sky->draft, sky->draft.until_s);
    double accel_mps2 = draw_number(sky, ACCEL_MIN_MPS2, ACCEL_MAX_MPS2);

    fly_leg(sky, fabs(change_mps) / accel_mps2, 0.0, change_mps < 0.0 ? -accel_mps2 : accel_mps2);
}

static double draw_turn_rate(struct sky *sky)
{
    double speed_mps = path_speed_mps(&sky->draft, sky->draft.until_s);
    double rate_radps =
        draw_number(sky, TURN_MIN_RADPS, fmin(TURN_MAX_RADPS, TURN_MAX_MPS2 / speed_mps));

    return random_below(sky->random, 2) == 0 ? rate_radps : -rate_radps;
}

/* Small turns are more common than large ones. */
static void fly_turn(struct sky *sky)
{
    double share = random_uniform(sky->random);
    double angle_rad = (10.0 + 170.0 * share * share) * DEG_RAD;
    double rate_radps = draw_turn_rate(sky);

    fly_leg(sky, angle_rad / fabs(rate_radps), rate_radps, 0.0);
}

/* One to three rounds of a race track, slowly. */
static void fly_holding(struct sky *sky)
{
    double rate_radps;
    uint64_t halves;

    reach_speed(sky, draw_number(sky, HOLD_MIN_MPS, HOLD_MAX_MPS));
    rate_radps = draw_turn_rate(sky);
    halves = 2 * (1 + random_below(sky->random, 3));
    for (uint64_t i = 0; i < halves; i++) {
        fly_leg(sky, PORTABLE_PI / fabs(rate_radps), rate_radps, 0.0);
        fly_straight(sky, 60.0);
    }
    reach_speed(sky, draw_number(sky, CRUISE_MIN_MPS, CRUISE_MAX_MPS));
}

static double flight_age_s(const struct sky *sky)
{
    return sky->draft.until_s - sky->draft.from_s;
}

static void fly_next_manoeuvre(struct sky *sky)
{
    double what;

    fly_straight(sky, draw_number(sky, 60.0, 300.0));
    what = random_uniform(sky->random);
    if (what < 0.5) {
        fly_turn(sky);
    } else if (what < 0.65) {
        reach_speed(sky, draw_number(sky, CRUISE_MIN_MPS, CRUISE_MAX_MPS));
    } else if (what < 0.8) {
        fly_holding(sky);
    } else if (flight_age_s(sky) > 0.6 * sky->item->flights_least) {
        reach_speed(sky, GROUND_MPS);
        sky->is_over = true;
    }
}

/* ---- how flights begin ---- */

/* Anywhere on the border, within 60 degrees of straight in. */
static void enter_over_border(struct sky *sky, double start_s)
{
    const double *box_m = sky->item->box_m;
    double width_m = box_m[1] - box_m[0], height_m = box_m[3] - box_m[2];
    double on_m = draw_number(sky, 0.0, 2.0 * (width_m + height_m));
    double speed_mps = draw_number(sky, CRUISE_MIN_MPS, CRUISE_MAX_MPS);
    double heading_rad = draw_number(sky, -60.0, 60.0) * DEG_RAD;

    if (on_m < 2.0 * width_m) {
        bool is_low = on_m < width_m;

        open_flight(sky, start_s, box_m[0] + (is_low ? on_m : on_m - width_m),
                    is_low ? box_m[2] : box_m[3], speed_mps,
                    heading_rad + (is_low ? 0.5 : -0.5) * PORTABLE_PI);
    } else {
        bool is_left = on_m - 2.0 * width_m < height_m;

        open_flight(sky, start_s, is_left ? box_m[0] : box_m[1],
                    box_m[2] + on_m - 2.0 * width_m - (is_left ? 0.0 : height_m), speed_mps,
                    heading_rad + (is_left ? 0.0 : PORTABLE_PI));
    }
}

static void take_off(struct sky *sky, double start_s)
{
    const double *box_m = sky->item->box_m;
    double x_m = draw_number(sky, box_m[0], box_m[1]), y_m = draw_number(sky, box_m[2], box_m[3]);

    open_flight(sky, start_s, x_m, y_m, GROUND_MPS, draw_number(sky, -PORTABLE_PI, PORTABLE_PI));
    reach_speed(sky, draw_number(sky, CRUISE_MIN_MPS, CRUISE_MAX_MPS));
}

/*
 * A take-off that comes close to another flight at 10 to 90 degrees: backwards along its own
 * straight path from there. False where that would begin outside, or the other is not there then.
 */
static bool take_off_towards(struct sky *sky, double start_s, const struct scene_path *other)
{
    double span_s = draw_number(sky, 240.0, 400.0),
           cruise_mps = draw_number(sky, CRUISE_MIN_MPS, CRUISE_MAX_MPS);
    double accel_mps2 = (cruise_mps - GROUND_MPS) / draw_number(sky, 160.0, 200.0);
    double climb_s = (cruise_mps - GROUND_MPS) / accel_mps2;
    double path_m = cruise_mps * span_s - 0.5 * (cruise_mps - GROUND_MPS) * climb_s;
    double side_rad = random_below(sky->random, 2) == 0 ? DEG_RAD : -DEG_RAD;
    double angle_rad = side_rad * draw_number(sky, 10.0, 90.0), heading_rad, x_m, y_m;
    struct motion meeting;

    if (other->num_legs == 0 || other->until_s < start_s + span_s + 60.0) {
        return false;
    }
    meeting = path_motion_at(other, start_s + span_s);
    heading_rad = portable_atan2(meeting.vy_mps, meeting.vx_mps) + angle_rad;
    x_m = meeting.x_m - path_m * portable_cos(heading_rad) + 100.0 * random_normal(sky->random);
    y_m = meeting.y_m - path_m * portable_sin(heading_rad) + 100.0 * random_normal(sky->random);
    if (!is_inside(sky, x_m, y_m)) {
        return false;
    }
    open_flight(sky, start_s, x_m, y_m, GROUND_MPS, heading_rad);
    fly_leg(sky, climb_s, 0.0, accel_mps2);
    fly_straight(sky, span_s - climb_s + 60.0);
    return true;
}

/* ---- all flights ---- */

static void begin_flight(struct sky *sky, double start_s)
{
    double how = random_uniform(sky->random);

    for (int i = 0; how < sky->item->crossing_share && i < PARTNERS_MAX; i++) {
        if (take_off_towards(sky, start_s,
                             &sky->slots[random_below(sky->random, sky->item->flights)])) {
            return;
        }
    }
    if (random_uniform(sky->random) < 0.6) {
        enter_over_border(sky, start_s);
    } else {
        take_off(sky, start_s);
    }
}

static void draw_flight(struct sky *sky, const struct target_draft *draft, double start_s)
{
    for (int i = 0; i < DRAFTS_MAX; i++) {
        begin_flight(sky, start_s);
        while (!sky->is_over) {
            fly_next_manoeuvre(sky);
        }
        if (flight_age_s(sky) >= sky->item->flights_least) {
            sky->draft.item = draft->index;
            return;
        }
    }
    fail(EXIT_USAGE,
         "%s: targets[%zu]: no flight of %g s fits into box_m; take a larger one, or a smaller "
         "least_s",
         draft->file, draft->index, sky->item->flights_least);
}

/* The one that ends first. */
static struct scene_path *first_ending_slot(const struct sky *sky)
{
    struct scene_path *best = sky->slots;

    for (size_t i = 1; i < sky->item->flights; i++) {
        best = sky->slots[i].until_s < best->until_s ? &sky->slots[i] : best;
    }
    return best;
}

/* Flights that ended before the scene are not kept. */
static void drop_flight_before_start(struct scene_path *flight)
{
    if (!(flight->until_s > 0.0)) {
        path_free(flight);
    }
}

/* In the order of time, so that a flight that begins knows those it could meet. */
void flights_draw(const struct target_draft *draft, struct scene_paths *paths,
                  struct random *random)
{
    struct sky sky = {.item = draft->item,
                      .random = random,
                      .slots = must_calloc(draft->item->flights, sizeof *sky.slots)};
    struct scene_path *slot;

    for (size_t i = 0; i < draft->item->flights; i++) {
        sky.slots[i].until_s = -draw_number(&sky, BEFORE_MIN_S, BEFORE_MAX_S);
    }
    for (slot = first_ending_slot(&sky); slot->until_s <= draft->duration_s;
         slot = first_ending_slot(&sky)) {
        draw_flight(&sky, draft, slot->until_s);
        drop_flight_before_start(slot);
        *slot = sky.draft;
        sky.draft = (struct scene_path){.num_legs = 0};
        if (slot->until_s > 0.0) {
            paths_add(paths, *slot);
        }
    }
    free(sky.slots);
}
