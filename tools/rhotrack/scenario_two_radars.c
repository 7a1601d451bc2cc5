/* SPDX-License-Identifier: MIT */
/*
 * scenario_two_radars: an en-route and a terminal radar that do not know of each other, and the aircraft that both see.
 *
 * The first stands in the origin, turns in interval_s and sees to 150 km; the second stands 80 km east of it, turns in
 * second_interval_s and sees to 100 km. Both turn clockwise, begin anywhere, and have biases: the first too much of range
 * and azimuth, the second too little by as much; the clock of the second is true_time_bias_s ahead.
 */
#include <math.h>
#include <stdlib.h>

#include "common.h"
#include "scenario_plan.h"
#include "scenario_record.h"

#define DEG_RAD 0.017453292519943295
#define NUM_RADARS 2
#define LEGS_MAX 64
#define DRAFTS_MAX 10000

static const struct radar_kind {
    double x_m, pd, range_min_m, range_max_m, sigma_range_m, sigma_azimuth_rad;
    double bias_sign;
} kinds[NUM_RADARS] = {
    {0.0, 0.9, 2000.0, 150000.0, 70.0, 0.0015, 1.0},
    {80000.0, 0.8, 1000.0, 100000.0, 40.0, 0.0020, -1.0},
};

/* Of an aircraft: straight, then a turn, and so on. */
#define SPEED_MIN_MPS 120.0
#define SPEED_MAX_MPS 250.0
#define STRAIGHT_MIN_S 60.0
#define STRAIGHT_MAX_S 300.0
#define TURN_MIN_RAD (20.0 * DEG_RAD)
#define TURN_MAX_RAD (120.0 * DEG_RAD)
#define TURN_MPS2 5.0
#define INSIDE_SHARE 0.8 /* of its time an aircraft is where both radars see it, at least */
#define MARGIN_M 2000.0  /* for turns that begin before and end after */
#define CHECK_S 5.0      /* so often it is looked at where it is */

/* ---- parameters ------------------------------------------------------------------------------- */

void suggest_two_radars(struct parameters *parameters)
{
    static const struct {
        enum parameter_id id;
        double value;
    } values[] = {{PARAMETER_TARGETS, 20},
                  {PARAMETER_SPACING_M, 9260}, /* 5 nautical miles, as on one level */
                  {PARAMETER_STEADY_S, 120},
                  {PARAMETER_COAST_SCANS_MAX, 12}, /* of both radars: half a minute */
                  {PARAMETER_SECOND_INTERVAL_S, 4},
                  {PARAMETER_SECTORS_PER_TURN, 32},
                  {PARAMETER_TRUE_RANGE_BIAS_M, 50},
                  {PARAMETER_TRUE_AZIMUTH_BIAS_RAD, 0.1 * DEG_RAD},
                  {PARAMETER_TRUE_TIME_BIAS_S, 0},
                  {PARAMETER_LATE_SHARE, 0.2},
                  {PARAMETER_LATE_MS, 300}};

    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        parameters_suggest(parameters, values[i].id, values[i].value);
    }
}

static struct scenario_antenna radar_of(const struct parameters *parameters, int32_t sensor_id,
                                        struct random *random)
{
    const struct radar_kind *kind = &kinds[sensor_id - 1];
    const double *value = parameters->value;
    struct scenario_antenna antenna = {
        .sensor_id = sensor_id,
        .x_m = parameters_of_sensor(parameters, sensor_id, SENSOR_X_M, kind->x_m),
        .y_m = parameters_of_sensor(parameters, sensor_id, SENSOR_Y_M, 0.0),
        .turn_s = value[sensor_id == 1 ? PARAMETER_INTERVAL_S : PARAMETER_SECOND_INTERVAL_S],
        .start_rad = random_between(random, -180.0 * DEG_RAD, 180.0 * DEG_RAD),
        .sectors = (size_t)value[PARAMETER_SECTORS_PER_TURN],
        .pd = parameters_of_sensor(parameters, sensor_id, SENSOR_PD, kind->pd),
        .range_min_m =
            parameters_of_sensor(parameters, sensor_id, SENSOR_RANGE_MIN_M, kind->range_min_m),
        .range_max_m =
            parameters_of_sensor(parameters, sensor_id, SENSOR_RANGE_MAX_M, kind->range_max_m),
        .sigma_range_m =
            parameters_of_sensor(parameters, sensor_id, SENSOR_SIGMA_RANGE_M, kind->sigma_range_m),
        .sigma_azimuth_rad = parameters_of_sensor(parameters, sensor_id, SENSOR_SIGMA_AZIMUTH_RAD,
                                                  kind->sigma_azimuth_rad),
        .range_bias_m = kind->bias_sign * value[PARAMETER_TRUE_RANGE_BIAS_M],
        .azimuth_bias_rad = kind->bias_sign * value[PARAMETER_TRUE_AZIMUTH_BIAS_RAD],
        .time_bias_s = sensor_id == 1 ? 0.0 : value[PARAMETER_TRUE_TIME_BIAS_S],
        .clutter_mean = value[PARAMETER_CLUTTER_PER_SCAN],
    };

    antenna.start_s = sensor_id == 1 ? 0.0 : random_between(random, 0.0, antenna.turn_s);
    return antenna;
}

/* ---- aircraft --------------------------------------------------------------------------------- */

struct leg {
    double start_s, turn_radps;
    double x_m, y_m, heading_rad;
};

struct aircraft {
    double speed_mps;
    size_t num_legs;
    struct leg legs[LEGS_MAX];
};

static struct truth_point along(const struct aircraft *aircraft, const struct leg *leg, double t_s)
{
    double turn_rad = leg->turn_radps * (t_s - leg->start_s);
    double arc_m = aircraft->speed_mps * (t_s - leg->start_s);
    double chord_m =
        fabs(turn_rad) > 1e-12 ? arc_m * sin(turn_rad / 2.0) / (turn_rad / 2.0) : arc_m;

    return (struct truth_point){
        .t_s = t_s,
        .x_m = leg->x_m + chord_m * cos(leg->heading_rad + turn_rad / 2.0),
        .y_m = leg->y_m + chord_m * sin(leg->heading_rad + turn_rad / 2.0),
        .vx_mps = aircraft->speed_mps * cos(leg->heading_rad + turn_rad),
        .vy_mps = aircraft->speed_mps * sin(leg->heading_rad + turn_rad),
    };
}

static struct truth_point aircraft_at(const struct aircraft *aircraft, double t_s)
{
    size_t leg = 0;

    while (leg + 1 < aircraft->num_legs && aircraft->legs[leg + 1].start_s <= t_s) {
        leg++;
    }
    return along(aircraft, &aircraft->legs[leg], t_s);
}

static bool fly(const void *context, size_t target, double t_s, struct truth_point *truth)
{
    const struct aircraft *aircraft = context;

    *truth = aircraft_at(&aircraft[target], t_s);
    truth->target_id = (int)target;
    return true;
}

static void add_leg(struct aircraft *aircraft, double start_s, double turn_radps)
{
    const struct truth_point at = aircraft_at(aircraft, start_s);

    aircraft->legs[aircraft->num_legs++] = (struct leg){.start_s = start_s,
                                                        .turn_radps = turn_radps,
                                                        .x_m = at.x_m,
                                                        .y_m = at.y_m,
                                                        .heading_rad = atan2(at.vy_mps, at.vx_mps)};
}

static struct aircraft draft_aircraft(const struct scenario_antenna radars[NUM_RADARS],
                                      double duration_s, struct random *random)
{
    struct aircraft aircraft = {.speed_mps = random_between(random, SPEED_MIN_MPS, SPEED_MAX_MPS),
                                .num_legs = 1};
    double range_m = radars[1].range_max_m * sqrt(random_uniform(random));
    double azimuth_rad = random_between(random, 0.0, 360.0 * DEG_RAD);
    double t_s = random_between(random, 0.0, STRAIGHT_MAX_S);

    aircraft.legs[0] = (struct leg){.heading_rad = random_between(random, 0.0, 360.0 * DEG_RAD),
                                    .x_m = radars[1].x_m + range_m * cos(azimuth_rad),
                                    .y_m = radars[1].y_m + range_m * sin(azimuth_rad)};
    while (t_s < duration_s && aircraft.num_legs + 2 <= LEGS_MAX) {
        double turn_rad = random_between(random, TURN_MIN_RAD, TURN_MAX_RAD);
        double turn_radps = TURN_MPS2 / aircraft.speed_mps;

        add_leg(&aircraft, t_s, random_uniform(random) < 0.5 ? turn_radps : -turn_radps);
        t_s += turn_rad / turn_radps;
        add_leg(&aircraft, t_s, 0.0);
        t_s += random_between(random, STRAIGHT_MIN_S, STRAIGHT_MAX_S);
    }
    return aircraft;
}

static bool sees(const struct scenario_antenna *radar, const struct truth_point *at)
{
    double range_m = hypot(at->x_m - radar->x_m, at->y_m - radar->y_m);

    return range_m >= radar->range_min_m + MARGIN_M && range_m <= radar->range_max_m - MARGIN_M;
}

/* Always seen by one of the radars, and by both for most of its time. */
static bool is_common(const struct aircraft *aircraft,
                      const struct scenario_antenna radars[NUM_RADARS], double duration_s)
{
    size_t both = 0, count = (size_t)(duration_s / CHECK_S) + 1;

    for (size_t i = 0; i < count; i++) {
        const struct truth_point at = aircraft_at(aircraft, CHECK_S * (double)i);
        bool first = sees(&radars[0], &at), second = sees(&radars[1], &at);

        both += first && second;
        if (!first && !second) {
            return false;
        }
    }
    return (double)both >= INSIDE_SHARE * (double)count;
}

/* Never nearer than that to one of those before. */
static bool is_apart(const struct aircraft *aircraft, const struct aircraft *others,
                     size_t num_others, double spacing_m, double duration_s)
{
    for (size_t i = 0; CHECK_S * (double)i <= duration_s; i++) {
        const struct truth_point at = aircraft_at(aircraft, CHECK_S * (double)i);

        for (size_t j = 0; j < num_others; j++) {
            const struct truth_point other = aircraft_at(&others[j], CHECK_S * (double)i);

            if (hypot(at.x_m - other.x_m, at.y_m - other.y_m) < spacing_m) {
                return false;
            }
        }
    }
    return true;
}

static void draw_aircraft(struct aircraft *aircraft, size_t count,
                          const struct scenario_antenna radars[NUM_RADARS], double spacing_m,
                          double duration_s, struct random *random)
{
    int drafts = 0;

    for (size_t i = 0; i < count; drafts++) {
        if (drafts == DRAFTS_MAX) {
            fail(EXIT_USAGE,
                 "scenario two-radars: no aircraft stays where both radars see it, "
                 "spacing_m from others, for the whole run; take fewer scans or targets");
        }
        aircraft[i] = draft_aircraft(radars, duration_s, random);
        if (is_common(&aircraft[i], radars, duration_s) &&
            is_apart(&aircraft[i], aircraft, i, spacing_m, duration_s)) {
            i++;
            drafts = 0;
        }
    }
}

/* ---- the simulation --------------------------------------------------------------------------- */

/* Where the radars may see anything. */
static struct scenario_box area_of(const struct scenario_antenna radars[NUM_RADARS])
{
    struct scenario_box box = {INFINITY, -INFINITY, INFINITY, -INFINITY};

    for (int i = 0; i < NUM_RADARS; i++) {
        box.x_min_m = fmin(box.x_min_m, radars[i].x_m - radars[i].range_max_m);
        box.x_max_m = fmax(box.x_max_m, radars[i].x_m + radars[i].range_max_m);
        box.y_min_m = fmin(box.y_min_m, radars[i].y_m - radars[i].range_max_m);
        box.y_max_m = fmax(box.y_max_m, radars[i].y_m + radars[i].range_max_m);
    }
    return box;
}

static struct scenario_record *watch(const struct scenario_antenna radars[NUM_RADARS],
                                     const struct antenna_targets *targets, double duration_s,
                                     const struct parameters *parameters, struct random *random)
{
    struct scenario_record *record = must_calloc(1, sizeof *record);

    for (int i = 0; i < NUM_RADARS; i++) {
        double turns = floor((duration_s - radars[i].start_s) / radars[i].turn_s + 1e-9);

        record_watch(record, &radars[i], targets, turns > 0.0 ? (size_t)turns : 0, random);
    }
    /* a clock that is off says other times than those of arrival, in another order */
    record->has_received =
        parameters->value[PARAMETER_LATE_SHARE] > 0.0 || radars[1].time_bias_s != 0.0;
    record_arrive(record, parameters->value[PARAMETER_LATE_SHARE],
                  parameters->value[PARAMETER_LATE_MS] * 1e-3, random);
    return record;
}

struct simulation *simulate_two_radars(const struct parameters *parameters, struct random *random)
{
    struct simulation *simulation = must_calloc(1, sizeof *simulation);
    size_t num_targets = (size_t)parameters->value[PARAMETER_TARGETS];
    double interval_s = parameters->value[PARAMETER_INTERVAL_S];
    double duration_s = parameters->value[PARAMETER_NUM_SCANS] * interval_s;
    struct aircraft *aircraft = must_calloc(num_targets + 1, sizeof *aircraft);
    struct antenna_targets targets = {.count = num_targets, .context = aircraft, .at = fly};
    struct scenario_antenna radars[NUM_RADARS];

    for (int i = 0; i < NUM_RADARS; i++) {
        radars[i] = radar_of(parameters, i + 1, random);
    }
    draw_aircraft(aircraft, num_targets, radars, parameters->value[PARAMETER_SPACING_M], duration_s,
                  random);
    simulation->num_targets = simulation->targets_a_scan = num_targets;
    simulation->interval_s = interval_s;
    simulation->area = area_of(radars);
    simulation->record = watch(radars, &targets, duration_s, parameters, random);
    simulation->truth =
        record_truth(simulation->record, &targets, &simulation->num_truth, &simulation->num_times);
    free(aircraft);
    return simulation;
}
