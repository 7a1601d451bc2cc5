/* SPDX-License-Identifier: MIT */
/*
 * scenario_air_traffic: flights over an area, always as many in the air: where one ends another begins.
 *
 * A flight enters over the border or takes off inside and climbs; it flies straight, turns, holds, changes its speed,
 * and leaves over the border or descends and lands. Some take-offs are such that they meet another flight at an angle.
 * Flights are legs: straight with a constant acceleration, or arcs at constant speed, so places are exact. Each lasts
 * FLIGHT_SCANS_MIN scans or more; the recording cuts those that began before its first scan or end after its last.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common.h"
#include "scenario_plan.h"

#define PI 3.141592653589793
#define DEG_RAD (PI / 180.0)

#define FLIGHT_SCANS_MIN 40
#define LEGS_MAX 96
#define DRAFTS_MAX 1000 /* flights drawn anew until one lasts long enough */

/* Before the first scan flights come and go, so that those in the air there have any age. */
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

/* ---- flights ---------------------------------------------------------------------------------- */

struct motion {
    double x_m, y_m, heading_rad, speed_mps;
};

/* Either turns or accelerates. */
struct leg {
    double duration_s, turn_radps, accel_mps2;
};

struct flight {
    double start_s, end_s;
    struct motion start;
    size_t num_legs;
    struct leg legs[LEGS_MAX];
};

static struct motion moved(struct motion from, const struct leg *leg, double dt_s)
{
    double turn_rad = leg->turn_radps * dt_s;
    double arc_m = from.speed_mps * dt_s + 0.5 * leg->accel_mps2 * dt_s * dt_s;
    double chord_m = turn_rad != 0.0 ? arc_m * sin(turn_rad / 2.0) / (turn_rad / 2.0) : arc_m;
    double along_rad = from.heading_rad + turn_rad / 2.0;

    return (struct motion){.x_m = from.x_m + chord_m * cos(along_rad),
                           .y_m = from.y_m + chord_m * sin(along_rad),
                           .heading_rad = remainder(from.heading_rad + turn_rad, 2.0 * PI),
                           .speed_mps = from.speed_mps + leg->accel_mps2 * dt_s};
}

static struct motion flight_at(const struct flight *flight, double t_s)
{
    struct motion at = flight->start;
    double left_s = t_s - flight->start_s;

    for (size_t i = 0; i < flight->num_legs && left_s > 0.0; i++) {
        const struct leg *leg = &flight->legs[i];
        at = moved(at, leg, fmin(left_s, leg->duration_s));
        left_s -= leg->duration_s;
    }
    return at;
}

/* ---- one flight by chance --------------------------------------------------------------------- */

struct draft {
    const struct scenario_box *box;
    struct random *random;
    double least_s; /* that a flight lasts */
    struct flight flight;
    struct motion now; /* at the flight's end so far */
    bool is_over;
};

static bool is_inside(const struct scenario_box *box, const struct motion *at)
{
    return plan_box_holds(box, at->x_m, at->y_m);
}

static double draw(struct draft *draft, double lo, double hi)
{
    return random_between(draft->random, lo, hi);
}

static double age_s(const struct draft *draft)
{
    return draft->flight.end_s - draft->flight.start_s;
}

static void open_flight(struct draft *draft, double start_s, struct motion start)
{
    draft->flight.start_s = draft->flight.end_s = start_s;
    draft->flight.start = draft->now = start;
    draft->flight.num_legs = 0;
    draft->is_over = false;
}

/* How long the leg stays inside, in whole seconds. */
static double inside_s(const struct draft *draft, const struct leg *leg)
{
    unsigned last_s = 0;

    for (unsigned at_s = 1; at_s < leg->duration_s; at_s++) {
        struct motion at = moved(draft->now, leg, at_s);
        if (!is_inside(draft->box, &at)) {
            break;
        }
        last_s = at_s;
    }
    return last_s;
}

/* One leg more, as far as the border. The area is convex: a straight leg that ends inside is inside. */
static void fly(struct draft *draft, double duration_s, double turn_radps, double accel_mps2)
{
    struct leg leg = {duration_s, turn_radps, accel_mps2};
    struct motion end = moved(draft->now, &leg, duration_s);

    if (draft->is_over) {
        return;
    }
    if (turn_radps != 0.0 || !is_inside(draft->box, &end)) {
        double most_s = inside_s(draft, &leg);
        draft->is_over = most_s + 1.0 < duration_s || !is_inside(draft->box, &end);
        leg.duration_s = draft->is_over ? most_s : duration_s;
        end = moved(draft->now, &leg, leg.duration_s);
    }
    draft->flight.legs[draft->flight.num_legs++] = leg;
    draft->flight.end_s += leg.duration_s;
    draft->now = end;
    draft->is_over = draft->is_over || draft->flight.num_legs == LEGS_MAX;
}

static void fly_straight(struct draft *draft, double duration_s)
{
    fly(draft, duration_s, 0.0, 0.0);
}

static void reach_speed(struct draft *draft, double speed_mps)
{
    double change_mps = speed_mps - draft->now.speed_mps;
    double accel_mps2 = draw(draft, ACCEL_MIN_MPS2, ACCEL_MAX_MPS2);

    fly(draft, fabs(change_mps) / accel_mps2, 0.0, change_mps < 0.0 ? -accel_mps2 : accel_mps2);
}

static double turn_rate(struct draft *draft)
{
    double most_radps = fmin(TURN_MAX_RADPS, TURN_MAX_MPS2 / draft->now.speed_mps);
    double rate_radps = draw(draft, TURN_MIN_RADPS, most_radps);

    return random_below(draft->random, 2) == 0 ? rate_radps : -rate_radps;
}

/* Small turns are more common than large ones. */
static void turn(struct draft *draft)
{
    double share = random_uniform(draft->random);
    double angle_rad = (10.0 + 170.0 * share * share) * DEG_RAD;
    double rate_radps = turn_rate(draft);

    fly(draft, angle_rad / fabs(rate_radps), rate_radps, 0.0);
}

/* One to three rounds of a race track, slowly. */
static void hold(struct draft *draft)
{
    reach_speed(draft, draw(draft, HOLD_MIN_MPS, HOLD_MAX_MPS));
    double rate_radps = turn_rate(draft);
    uint64_t halves = 2 * (1 + random_below(draft->random, 3));

    for (uint64_t i = 0; i < halves; i++) {
        fly(draft, PI / fabs(rate_radps), rate_radps, 0.0);
        fly_straight(draft, 60.0);
    }
    reach_speed(draft, draw(draft, CRUISE_MIN_MPS, CRUISE_MAX_MPS));
}

static void land(struct draft *draft)
{
    reach_speed(draft, GROUND_MPS);
    draft->is_over = true;
}

static void fly_on(struct draft *draft)
{
    fly_straight(draft, draw(draft, 60.0, 300.0));
    double what = random_uniform(draft->random);

    if (what < 0.5) {
        turn(draft);
    } else if (what < 0.65) {
        reach_speed(draft, draw(draft, CRUISE_MIN_MPS, CRUISE_MAX_MPS));
    } else if (what < 0.8) {
        hold(draft);
    } else if (age_s(draft) > 0.6 * draft->least_s) {
        land(draft);
    }
}

/* ---- how flights begin ------------------------------------------------------------------------ */

/* Anywhere on the border, within 60 degrees of straight in. */
static void enter(struct draft *draft, double start_s)
{
    const struct scenario_box *box = draft->box;
    double width_m = box->x_max_m - box->x_min_m, height_m = box->y_max_m - box->y_min_m;
    double on_m = draw(draft, 0.0, 2.0 * (width_m + height_m));
    struct motion start = {.speed_mps = draw(draft, CRUISE_MIN_MPS, CRUISE_MAX_MPS),
                           .heading_rad = draw(draft, -60.0, 60.0) * DEG_RAD};

    if (on_m < 2.0 * width_m) {
        bool is_low = on_m < width_m;
        start.x_m = box->x_min_m + (is_low ? on_m : on_m - width_m);
        start.y_m = is_low ? box->y_min_m : box->y_max_m;
        start.heading_rad += is_low ? PI / 2.0 : -PI / 2.0;
    } else {
        bool is_left = on_m - 2.0 * width_m < height_m;
        start.x_m = is_left ? box->x_min_m : box->x_max_m;
        start.y_m = box->y_min_m + on_m - 2.0 * width_m - (is_left ? 0.0 : height_m);
        start.heading_rad += is_left ? 0.0 : PI;
    }
    open_flight(draft, start_s, start);
}

static void take_off(struct draft *draft, double start_s)
{
    const struct scenario_box *box = draft->box;
    struct motion start = {.x_m = draw(draft, box->x_min_m, box->x_max_m),
                           .y_m = draw(draft, box->y_min_m, box->y_max_m),
                           .heading_rad = draw(draft, -PI, PI),
                           .speed_mps = GROUND_MPS};

    open_flight(draft, start_s, start);
    reach_speed(draft, draw(draft, CRUISE_MIN_MPS, CRUISE_MAX_MPS));
}

/*
 * A take-off that comes close to another flight at 10 to 90 degrees: backwards along its own straight path from there.
 * False where that would begin outside.
 */
static bool take_off_towards(struct draft *draft, double start_s, const struct flight *other)
{
    double span_s = draw(draft, 240.0, 400.0), cruise_mps = draw(draft, 180.0, 260.0);
    double accel_mps2 = (cruise_mps - GROUND_MPS) / draw(draft, 160.0, 200.0);
    double climb_s = (cruise_mps - GROUND_MPS) / accel_mps2;
    double path_m = cruise_mps * span_s - 0.5 * (cruise_mps - GROUND_MPS) * climb_s;
    double side_rad = random_below(draft->random, 2) == 0 ? DEG_RAD : -DEG_RAD;
    struct motion meeting = flight_at(other, start_s + span_s);
    struct motion start = {.speed_mps = GROUND_MPS};

    start.heading_rad = meeting.heading_rad + side_rad * draw(draft, 10.0, 90.0);
    start.x_m =
        meeting.x_m - path_m * cos(start.heading_rad) + 100.0 * random_normal(draft->random);
    start.y_m =
        meeting.y_m - path_m * sin(start.heading_rad) + 100.0 * random_normal(draft->random);
    if (other->num_legs == 0 || other->end_s < start_s + span_s + 60.0 ||
        !is_inside(draft->box, &start)) {
        return false;
    }
    open_flight(draft, start_s, start);
    fly(draft, climb_s, 0.0, accel_mps2);
    fly_straight(draft, span_s - climb_s + 60.0);
    return true;
}

/* ---- all flights ------------------------------------------------------------------------------ */

struct sky {
    struct draft draft;
    double crossing_share, end_s; /* after the last scan */
    size_t num_slots;
    struct flight *flights; /* in the air, one a slot */
    int next_id;
};

#define PARTNERS_MAX 20 /* flights tried to meet */

static void begin(struct sky *sky, double start_s)
{
    struct draft *draft = &sky->draft;
    double how = random_uniform(draft->random);

    for (int i = 0; how < sky->crossing_share && i < PARTNERS_MAX; i++) {
        const struct flight *other = &sky->flights[random_below(draft->random, sky->num_slots)];
        if (take_off_towards(draft, start_s, other)) {
            return;
        }
    }
    if (random_uniform(draft->random) < 0.6) {
        enter(draft, start_s);
    } else {
        take_off(draft, start_s);
    }
}

static void draw_flight(struct sky *sky, double start_s)
{
    struct draft *draft = &sky->draft;

    for (int i = 0; i < DRAFTS_MAX; i++) {
        begin(sky, start_s);
        while (!draft->is_over) {
            fly_on(draft);
        }
        if (age_s(draft) >= draft->least_s) {
            return;
        }
    }
    fail(EXIT_USAGE,
         "scenario air-traffic: no flight of %d scans fits into the area; take a larger area or a "
         "shorter interval_s",
         FLIGHT_SCANS_MIN);
}

/* The flight's places at the scans it is in the air; an identity where there are any. */
static void record(struct sky *sky, const struct scenario_plan *plan, size_t slot)
{
    const struct flight *flight = &sky->flights[slot];
    double first = fmax(0.0, ceil(flight->start_s / plan->interval_s));
    bool is_seen = false;

    for (size_t scan = (size_t)first; scan < plan->num_scans; scan++) {
        double t_s = (double)scan * plan->interval_s;
        if (t_s >= flight->end_s) {
            break;
        }
        struct motion at = flight_at(flight, t_s);
        *plan_truth(plan, scan, slot) =
            (struct truth_point){.t_s = t_s,
                                 .target_id = sky->next_id,
                                 .x_m = at.x_m,
                                 .y_m = at.y_m,
                                 .vx_mps = at.speed_mps * cos(at.heading_rad),
                                 .vy_mps = at.speed_mps * sin(at.heading_rad)};
        is_seen = true;
    }
    sky->next_id += is_seen;
}

/* The slot whose flight ends first. */
static size_t next_slot(const struct sky *sky)
{
    size_t best = 0;

    for (size_t i = 1; i < sky->num_slots; i++) {
        if (sky->flights[i].end_s < sky->flights[best].end_s) {
            best = i;
        }
    }
    return best;
}

static int by_identity(const void *a, const void *b)
{
    const struct truth_point *one = a, *other = b;

    return (one->target_id > other->target_id) - (one->target_id < other->target_id);
}

/* In the order of time, so that a flight that begins knows those it could meet. */
static void fill_sky(struct sky *sky, struct scenario_plan *plan)
{
    for (size_t i = 0; i < sky->num_slots; i++) {
        sky->flights[i].end_s = -random_between(sky->draft.random, BEFORE_MIN_S, BEFORE_MAX_S);
    }
    for (;;) {
        size_t slot = next_slot(sky);
        if (sky->flights[slot].end_s > sky->end_s) {
            break;
        }
        draw_flight(sky, sky->flights[slot].end_s);
        sky->flights[slot] = sky->draft.flight;
        record(sky, plan, slot);
    }
    for (size_t scan = 0; scan < plan->num_scans; scan++) {
        qsort(plan_truth(plan, scan, 0), plan->num_targets, sizeof *plan->truth, by_identity);
    }
}

struct scenario_plan plan_air_traffic(const struct parameters *parameters, struct random *random)
{
    size_t num_targets = (size_t)parameters->value[PARAMETER_TARGETS];
    size_t num_scans = (size_t)parameters->value[PARAMETER_NUM_SCANS];
    double interval_s = parameters->value[PARAMETER_INTERVAL_S];
    struct scenario_plan plan = plan_start(num_targets, num_scans, interval_s);
    struct scenario_box box = plan_box_of(parameters);
    struct sky sky = {
        .draft = {.box = &box, .random = random, .least_s = FLIGHT_SCANS_MIN * interval_s},
        .crossing_share = parameters->value[PARAMETER_CROSSING_SHARE],
        .end_s = (double)num_scans * interval_s,
        .num_slots = num_targets,
        .flights = must_calloc(num_targets + 1, sizeof *sky.flights)};

    if (num_targets > 0) {
        fill_sky(&sky, &plan);
    }
    free(sky.flights);
    plan.num_identities = (size_t)sky.next_id;
    return plan;
}
