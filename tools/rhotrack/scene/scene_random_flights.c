/* SPDX-License-Identifier: MIT */
/*
 * scene_random_flights: draws random aircraft flights over an area with a constant number in the
 * air: where one flight ends another begins.
 *
 * A flight enters over the border of the area or takes off inside; it flies straight, turns, flies
 * holding patterns, changes its speed, and leaves over the border or lands. Some take-offs are
 * chosen so that they cross the path of another flight.
 */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "base/portable_math.h"
#include "scene/scene_path.h"

#define DEG_RAD (PORTABLE_PI / 180.0)
#define DRAFTS_MAX 1000 /* attempts at drawing a flight that lasts long enough */
#define MEETINGS_MAX 20 /* attempts at a take-off that meets another flight */

/*
 * Flights are drawn from this long before the scene's start, so that those in the air at the start
 * have any age.
 */
#define BEFORE_MIN_S 3600.0
#define BEFORE_MAX_S 7200.0

#define CRUISE_MIN_MPS 180.0
#define CRUISE_MAX_MPS 260.0
#define GROUND_MPS 80.0 /* speed at take-off and landing */
#define HOLD_MIN_MPS 110.0
#define HOLD_MAX_MPS 150.0
#define ACCEL_MIN_MPS2 0.5
#define ACCEL_MAX_MPS2 1.2
#define TURN_MIN_RADPS (1.5 * DEG_RAD)
#define TURN_MAX_RADPS (3.0 * DEG_RAD)
#define TURN_MAX_MPS2 8.0 /* largest lateral acceleration: fast aircraft turn slowly */

/* State of the generator: one slot for each aircraft that is always in the air. */
struct flight_generator {
    const struct target_item *item;
    struct random *random;
    /* latest flight of each slot, in the air from_s .. until_s; without legs: none yet */
    struct scene_path *slots;
    struct scene_path draft; /* the flight being drawn; until_s is its end so far */
    bool is_over;
};

static double draw_uniform_between(struct flight_generator *generator, double lo, double hi)
{
    return random_between(generator->random, lo, hi);
}

static bool is_inside_area(const struct flight_generator *generator, double x_m, double y_m)
{
    const double *box_m = generator->item->box_m;

    return x_m >= box_m[0] && x_m <= box_m[1] && y_m >= box_m[2] && y_m <= box_m[3];
}

static bool is_draft_inside_at(const struct flight_generator *generator, double t_s)
{
    struct motion at = path_motion_at(&generator->draft, t_s);

    return is_inside_area(generator, at.x_m, at.y_m);
}

static void start_draft_flight(struct flight_generator *generator, double start_s, double x_m,
                               double y_m, double speed_mps, double heading_rad)
{
    path_free(&generator->draft);
    generator->draft = (struct scene_path){.from_s = start_s, .until_s = start_s};
    path_begin_first_leg(&generator->draft, x_m, y_m, speed_mps, heading_rad);
    generator->is_over = false;
}

/*
 * Adds a leg to the draft, and ends the flight where the leg crosses the border. The area is
 * convex: a straight leg that ends inside is inside.
 */
static void add_draft_leg_up_to_border(struct flight_generator *generator, double duration_s,
                                       double turn_radps, double accel_mps2)
{
    double from_s = generator->draft.until_s, end_s = from_s + duration_s;

    if (generator->is_over) {
        return;
    }
    path_begin_next_leg(&generator->draft, from_s, accel_mps2, turn_radps);
    generator->draft.until_s = end_s;
    if (fabs(turn_radps) > 0.0 || !is_draft_inside_at(generator, end_s)) {
        double last_s = from_s;

        while (last_s + 1.0 < end_s && is_draft_inside_at(generator, last_s + 1.0)) {
            last_s += 1.0;
        }
        generator->is_over = last_s + 1.0 < end_s || !is_draft_inside_at(generator, end_s);
        generator->draft.until_s = generator->is_over ? last_s : end_s;
    }
}

static void add_straight_leg_to_draft(struct flight_generator *generator, double duration_s)
{
    add_draft_leg_up_to_border(generator, duration_s, 0.0, 0.0);
}

static void add_speed_change_to_draft(struct flight_generator *generator, double speed_mps)
{
    double change_mps =
        speed_mps - path_last_leg_speed_mps(&generator->draft, generator->draft.until_s);
    double accel_mps2 = draw_uniform_between(generator, ACCEL_MIN_MPS2, ACCEL_MAX_MPS2);

    add_draft_leg_up_to_border(generator, fabs(change_mps) / accel_mps2, 0.0,
                               change_mps < 0.0 ? -accel_mps2 : accel_mps2);
}

/* Draws a turn rate that the speed allows; its sign is the side, either with equal probability. */
static double draw_signed_turn_rate(struct flight_generator *generator)
{
    double speed_mps = path_last_leg_speed_mps(&generator->draft, generator->draft.until_s);
    double rate_radps = draw_uniform_between(generator, TURN_MIN_RADPS,
                                             fmin(TURN_MAX_RADPS, TURN_MAX_MPS2 / speed_mps));

    return random_below(generator->random, 2) == 0 ? rate_radps : -rate_radps;
}

/* Adds one to three rounds of a holding pattern at holding speed. */
static void add_holding_pattern_to_draft(struct flight_generator *generator)
{
    double rate_radps;
    uint64_t halves;

    add_speed_change_to_draft(generator,
                              draw_uniform_between(generator, HOLD_MIN_MPS, HOLD_MAX_MPS));
    rate_radps = draw_signed_turn_rate(generator);
    halves = 2 * (1 + random_below(generator->random, 3));
    for (uint64_t i = 0; i < halves; i++) {
        add_draft_leg_up_to_border(generator, PORTABLE_PI / fabs(rate_radps), rate_radps, 0.0);
        add_straight_leg_to_draft(generator, 60.0);
    }
    add_speed_change_to_draft(generator,
                              draw_uniform_between(generator, CRUISE_MIN_MPS, CRUISE_MAX_MPS));
}

static double duration_of_draft_flight_s(const struct flight_generator *generator)
{
    return generator->draft.until_s - generator->draft.from_s;
}

/*
 * Adds a straight leg, and then at random a turn, speed change, holding pattern, landing or none.
 */
static void add_random_manoeuvre_to_draft(struct flight_generator *generator)
{
    double what;

    add_straight_leg_to_draft(generator, draw_uniform_between(generator, 60.0, 300.0));
    what = random_uniform(generator->random);
    if (what < 0.5) {
        /* Adds a turn of 10 to 180 degrees to either side; small angles are more likely. */
        double share = random_uniform(generator->random);
        double angle_rad = (10.0 + 170.0 * share * share) * DEG_RAD;
        double rate_radps = draw_signed_turn_rate(generator);

        add_draft_leg_up_to_border(generator, angle_rad / fabs(rate_radps), rate_radps, 0.0);
    } else if (what < 0.65) {
        add_speed_change_to_draft(generator,
                                  draw_uniform_between(generator, CRUISE_MIN_MPS, CRUISE_MAX_MPS));
    } else if (what < 0.8) {
        add_holding_pattern_to_draft(generator);
    } else if (duration_of_draft_flight_s(generator) > 0.6 * generator->item->flights_least) {
        add_speed_change_to_draft(generator, GROUND_MPS);
        generator->is_over = true;
    }
}

/* Starts a flight at a random place of the border, within 60 degrees of straight inwards. */
static void start_draft_at_border(struct flight_generator *generator, double start_s)
{
    const double *box_m = generator->item->box_m;
    double width_m = box_m[1] - box_m[0], height_m = box_m[3] - box_m[2];
    double on_m = draw_uniform_between(generator, 0.0, 2.0 * (width_m + height_m));
    double speed_mps = draw_uniform_between(generator, CRUISE_MIN_MPS, CRUISE_MAX_MPS);
    double heading_rad = draw_uniform_between(generator, -60.0, 60.0) * DEG_RAD;

    if (on_m < 2.0 * width_m) {
        bool is_low = on_m < width_m;

        start_draft_flight(generator, start_s, box_m[0] + (is_low ? on_m : on_m - width_m),
                           is_low ? box_m[2] : box_m[3], speed_mps,
                           heading_rad + (is_low ? 0.5 : -0.5) * PORTABLE_PI);
    } else {
        bool is_left = on_m - 2.0 * width_m < height_m;

        start_draft_flight(generator, start_s, is_left ? box_m[0] : box_m[1],
                           box_m[2] + on_m - 2.0 * width_m - (is_left ? 0.0 : height_m), speed_mps,
                           heading_rad + (is_left ? 0.0 : PORTABLE_PI));
    }
}

/*
 * Starts a take-off whose path crosses that of another flight at 10 to 90 degrees, by computing its
 * start backwards from the meeting. False where the start would be outside the area, or the other
 * flight has ended by then.
 */
static bool draft_take_off_to_meet(struct flight_generator *generator, double start_s,
                                   const struct scene_path *other)
{
    double span_s = draw_uniform_between(generator, 240.0, 400.0),
           cruise_mps = draw_uniform_between(generator, CRUISE_MIN_MPS, CRUISE_MAX_MPS);
    double accel_mps2 = (cruise_mps - GROUND_MPS) / draw_uniform_between(generator, 160.0, 200.0);
    double climb_s = (cruise_mps - GROUND_MPS) / accel_mps2;
    double path_m = cruise_mps * span_s - 0.5 * (cruise_mps - GROUND_MPS) * climb_s;
    double side_rad = random_below(generator->random, 2) == 0 ? DEG_RAD : -DEG_RAD;
    double angle_rad = side_rad * draw_uniform_between(generator, 10.0, 90.0), heading_rad, x_m,
           y_m;
    struct motion meeting;

    if (other->num_legs == 0 || other->until_s < start_s + span_s + 60.0) {
        return false;
    }
    meeting = path_motion_at(other, start_s + span_s);
    heading_rad = portable_atan2(meeting.vy_mps, meeting.vx_mps) + angle_rad;
    x_m =
        meeting.x_m - path_m * portable_cos(heading_rad) + 100.0 * random_normal(generator->random);
    y_m =
        meeting.y_m - path_m * portable_sin(heading_rad) + 100.0 * random_normal(generator->random);
    if (!is_inside_area(generator, x_m, y_m)) {
        return false;
    }
    start_draft_flight(generator, start_s, x_m, y_m, GROUND_MPS, heading_rad);
    add_draft_leg_up_to_border(generator, climb_s, 0.0, accel_mps2);
    add_straight_leg_to_draft(generator, span_s - climb_s + 60.0);
    return true;
}

static void start_random_draft(struct flight_generator *generator, double start_s)
{
    double how = random_uniform(generator->random);

    for (int i = 0; how < generator->item->crossing_share && i < MEETINGS_MAX; i++) {
        if (draft_take_off_to_meet(
                generator, start_s,
                &generator->slots[random_below(generator->random, generator->item->flights)])) {
            return;
        }
    }
    if (random_uniform(generator->random) < 0.6) {
        start_draft_at_border(generator, start_s);
    } else {
        const double *box_m = generator->item->box_m;
        double x_m = draw_uniform_between(generator, box_m[0], box_m[1]),
               y_m = draw_uniform_between(generator, box_m[2], box_m[3]);

        start_draft_flight(generator, start_s, x_m, y_m, GROUND_MPS,
                           draw_uniform_between(generator, -PORTABLE_PI, PORTABLE_PI));
        add_speed_change_to_draft(generator,
                                  draw_uniform_between(generator, CRUISE_MIN_MPS, CRUISE_MAX_MPS));
    }
}

static void draw_long_enough_flight(struct flight_generator *generator,
                                    const struct target_draft *draft, double start_s)
{
    for (int i = 0; i < DRAFTS_MAX; i++) {
        start_random_draft(generator, start_s);
        while (!generator->is_over) {
            add_random_manoeuvre_to_draft(generator);
        }
        if (duration_of_draft_flight_s(generator) >= generator->item->flights_least) {
            generator->draft.item = draft->index;
            return;
        }
    }
    fail(EXIT_USAGE,
         "%s: targets[%zu]: no flight of %g s fits into box_m; take a larger one, or a smaller "
         "least_s",
         draft->file, draft->index, generator->item->flights_least);
}

/* The slot whose flight ends first. */
static struct scene_path *find_first_ending_slot(const struct flight_generator *generator)
{
    struct scene_path *best = generator->slots;

    for (size_t i = 1; i < generator->item->flights; i++) {
        best = generator->slots[i].until_s < best->until_s ? &generator->slots[i] : best;
    }
    return best;
}

/* Frees a flight that ended before the scene's start. */
static void free_if_ended_before_start(struct scene_path *flight)
{
    if (!(flight->until_s > 0.0)) {
        path_free(flight);
    }
}

/*
 * Draws flights in the order of their start, so that a new flight can be made to meet those already
 * drawn.
 */
void flights_draw_random(const struct target_draft *draft, struct scene_paths *paths,
                         struct random *random)
{
    struct flight_generator generator = {
        .item = draft->item,
        .random = random,
        .slots = must_calloc(draft->item->flights, sizeof *generator.slots)};
    struct scene_path *slot;

    for (size_t i = 0; i < draft->item->flights; i++) {
        generator.slots[i].until_s = -draw_uniform_between(&generator, BEFORE_MIN_S, BEFORE_MAX_S);
    }
    for (slot = find_first_ending_slot(&generator); slot->until_s <= draft->duration_s;
         slot = find_first_ending_slot(&generator)) {
        draw_long_enough_flight(&generator, draft, slot->until_s);
        free_if_ended_before_start(slot);
        *slot = generator.draft;
        generator.draft = (struct scene_path){.num_legs = 0};
        if (slot->until_s > 0.0) {
            paths_add(paths, *slot);
        }
    }
    free(generator.slots);
}
