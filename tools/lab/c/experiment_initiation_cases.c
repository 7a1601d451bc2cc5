/* SPDX-License-Identifier: MIT */
#include "experiment_initiation.h"

#include <math.h>

#define DEG_RAD 0.017453292519943295
#define TURN_RAD (2.0 * DEG_RAD)
#define ACCELERATION_MPS2 10.0
#define WANDER_MPS 10.0
#define INTERVAL_S 2.0
#define SIGMA_M 10.0

#define CROSSING_BOX                                                                               \
    {                                                                                              \
        0, 4000, -1000, 1500                                                                       \
    }
#define RADAR_BOX                                                                                  \
    {                                                                                              \
        -25000, -1000, 13000, 29000                                                                \
    }
#define SQUARE_BOX                                                                                 \
    {                                                                                              \
        -2500, 2500, -2500, 2500                                                                   \
    }

/* Settings that most cases share. */
#define USUAL .min_scans = 5, .score_min_nat = -3.0
#define UNBARRED                                                                                   \
    {                                                                                              \
        .found_min = NAN, .false_max = NAN, .behind_max = NAN                                      \
    }

#define CROSSING(lambda, pd, scans, found, wrong)                                                  \
    {                                                                                              \
        .group = "B1", .name = "Table 1, " #lambda "/km^2, P_D " #pd, .paths = PATHS_CROSSING,     \
        .box = CROSSING_BOX, .clutter_per_km2 = (lambda), .true_pd = (pd), .min_scans = (scans),   \
        .score_min_nat = -3.0, .tolerance_m = 30.0, .bars = {                                      \
            (found),                                                                               \
            (wrong),                                                                               \
            0.02                                                                                   \
        }                                                                                          \
    }

#define RADAR(clutter)                                                                             \
    {                                                                                              \
        .group = "B2", .name = "Table 3, " #clutter " clutter plots a scan", .paths = PATHS_RADAR, \
        .box = RADAR_BOX, .clutter_per_scan = (clutter), .true_pd = 1.0, USUAL,                    \
        .tolerance_m = 120.0, .all_count = true, .bars = {                                         \
            0.99,                                                                                  \
            0.05,                                                                                  \
            NAN                                                                                    \
        }                                                                                          \
    }

#define SQUARE(label, found, ...)                                                                  \
    {                                                                                              \
        .group = "B3", .name = label, .paths = PATHS_STRAIGHT, .box = SQUARE_BOX,                  \
        .clutter_per_km2 = 1.0, .true_pd = 0.99, USUAL, .tolerance_m = 30.0, .all_count = true,    \
        .bars = {(found), 0.05, NAN}, __VA_ARGS__                                                  \
    }

#define TWO(x1, vx1, y1, vy1, x2, vx2, y2, vy2)                                                    \
    .start = {{x1, vx1, y1, vy1}, {x2, vx2, y2, vy2}}, .num_starts = 2
#define ONE(x, vx, y, vy) .start = {{x, vx, y, vy}}, .num_starts = 1

#define CLUTTER(score, wrong)                                                                      \
    {                                                                                              \
        .group = "B4", .name = "clutter only, 10/km^2, score_min " #score " nat",                  \
        .box = CROSSING_BOX, .clutter_per_km2 = 10.0, .true_pd = 0.99, .min_scans = 5,             \
        .score_min_nat = (score), .tolerance_m = 30.0, .bars = {                                   \
            NAN,                                                                                   \
            (wrong),                                                                               \
            NAN                                                                                    \
        }                                                                                          \
    }

#define MANOEUVRE(label, path, lambda, noise)                                                      \
    {                                                                                              \
        .group = "-", .name = label ", " #lambda "/km^2, process noise " #noise " m/s^2",          \
        .paths = (path), ONE(-1500, 250, 0, 0), .box = SQUARE_BOX, .clutter_per_km2 = (lambda),    \
        .true_pd = 0.99, USUAL, .process_noise_mps2 = (noise), .tolerance_m = 60.0,                \
        .bars = UNBARRED                                                                           \
    }

#define WANDER(lambda, noise)                                                                      \
    {                                                                                              \
        .group = "-",                                                                              \
        .name =                                                                                    \
            "Table 1 wandering 10 m/s a scan, " #lambda "/km^2, process noise " #noise " m/s^2",   \
        .paths = PATHS_WANDER, .box = CROSSING_BOX, .clutter_per_km2 = (lambda), .true_pd = 0.99,  \
        USUAL, .process_noise_mps2 = (noise), .tolerance_m = 60.0, .bars = UNBARRED                \
    }

static const struct initiation_case cases[] = {
    CROSSING(0, 1, 5, 0.995, 0.01),
    CROSSING(0, 0.99, 5, 0.995, 0.01),
    CROSSING(1, 1, 5, 0.995, 0.01),
    CROSSING(1, 0.99, 5, 0.995, 0.01),
    CROSSING(10, 0.99, 5, 0.98, 0.06),
    CROSSING(10, 0.9, 5, 0.82, 0.13),
    CROSSING(30, 0.99, 6, 0.80, 0.18),
    RADAR(0),
    RADAR(10),
    RADAR(100),
    SQUARE("parallel, 20 m", 0.97, TWO(-1500, 250, 0, 0, -1500, 250, 20, 0)),
    SQUARE("parallel, 30 m", 0.97, TWO(-1500, 250, 0, 0, -1500, 250, 30, 0)),
    SQUARE("parallel, 50 m", 0.92, TWO(-1500, 250, 0, 0, -1500, 250, 50, 0)),
    SQUARE("parallel, 100 m", 0.97, TWO(-1500, 250, 0, 0, -1500, 250, 100, 0)),
    SQUARE("crossing at 10 deg", 0.97, TWO(-1500, 250, -130, 21.9, -1500, 250, 130, -21.9)),
    SQUARE("crossing at 90 deg", 0.97, TWO(-1500, 250, 0, 0, 0, 0, -1500, 250)),
    SQUARE("same line, opposite", 0.97, TWO(-1500, 250, 300, 0, 1500, -250, 300, 0)),
    SQUARE("same line, 300 m ahead", 0.97, TWO(-1500, 250, 300, 0, -1200, 250, 300, 0)),
    SQUARE("same line, 500 m ahead", 0.97, TWO(-1700, 250, 300, 0, -1200, 250, 300, 0)),
    SQUARE("same line, overtaking", 0.97, TWO(-1600, 300, 300, 0, -1000, 180, 300, 0)),
    SQUARE("through the origin", 0.97, ONE(-1200, 173.2, -693, 100)),
    SQUARE("vertical, x = 500 m", 0.97, ONE(500, 0, -1500, 250)),
    SQUARE("vertical, x = -500 m", 0.97, ONE(-500, 0, -1500, 250)),
    SQUARE("vertical, x = 0", 0.97, ONE(0, 0, -1500, 250)),
    SQUARE("horizontal, y = -500 m", 0.97, ONE(-1500, 250, -500, 0)),
    SQUARE("mirror lines, y = +-500 m", 0.97, TWO(-1500, 250, 500, 0, -1500, 250, -500, 0)),
    SQUARE("slow, 105 m/s", 0.97, ONE(-600, 105, 200, 0)),
    SQUARE("fast, 395 m/s", 0.97, ONE(-2300, 395, 200, 0)),
    CLUTTER(-3, 0.12),
    CLUTTER(0, 0.005),
    {.group = "-",
     .name = "Table 1, 5/km^2 with a hot spot of 50/km^2",
     .paths = PATHS_CROSSING,
     .box = CROSSING_BOX,
     .clutter_per_km2 = 5.0,
     .spot = {2000, 3000, -700, 300},
     .spot_per_km2 = 45.0,
     .true_pd = 0.99,
     USUAL,
     .tolerance_m = 30.0,
     .bars = {0.98, 0.10, NAN}},
    MANOEUVRE("turn of 2 deg a scan", PATHS_TURN, 1, 0),
    MANOEUVRE("turn of 2 deg a scan", PATHS_TURN, 1, 2.5),
    MANOEUVRE("turn of 2 deg a scan", PATHS_TURN, 10, 5),
    MANOEUVRE("10 m/s^2 along the path", PATHS_ACCELERATE, 1, 0),
    MANOEUVRE("10 m/s^2 along the path", PATHS_ACCELERATE, 1, 10),
    WANDER(1, 0),
    WANDER(1, 2.5),
    WANDER(1, 5),
};

size_t initiation_num_cases(void)
{
    return sizeof cases / sizeof cases[0];
}

const struct initiation_case *initiation_case_at(size_t index)
{
    return &cases[index];
}

static const struct scenario_state crossing_starts[3] = {
    {300, 280.0, 400, 49.0}, {3000, -173.2, 300, -100.0}, {2100, -173.2, 1300, -100.0}};

static struct scenario_plan paths_of(const struct initiation_case *of, struct random *random)
{
    static const size_t fixed_targets[] = {
        [PATHS_CROSSING] = 3, [PATHS_WANDER] = 3, [PATHS_RADAR] = RADAR_TABLE_TARGETS};
    bool is_fixed =
        of->paths == PATHS_CROSSING || of->paths == PATHS_WANDER || of->paths == PATHS_RADAR;
    struct scenario_plan plan =
        plan_start(is_fixed ? fixed_targets[of->paths] : of->num_starts, INITIATION_SCANS,
                   of->paths == PATHS_RADAR ? RADAR_TABLE_INTERVAL_S : INTERVAL_S);
    for (size_t i = 0; i < plan.num_targets; i++) {
        struct scenario_state start = is_fixed ? crossing_starts[i] : of->start[i];
        switch (of->paths) {
        case PATHS_TURN:
            plan_turn(&plan, i, start, TURN_RAD);
            break;
        case PATHS_ACCELERATE:
            plan_accelerate(&plan, i, start, ACCELERATION_MPS2);
            break;
        case PATHS_WANDER:
            plan_wander(&plan, i, start, WANDER_MPS, random);
            break;
        default:
            plan_straight(&plan, i, start);
        }
    }
    if (of->paths == PATHS_RADAR) {
        plan_radar_table(&plan);
    }
    return plan;
}

static double area_km2(const struct scenario_box *box)
{
    return (box->x_max_m - box->x_min_m) * (box->y_max_m - box->y_min_m) * 1e-6;
}

struct scenario_plan initiation_plan(const struct initiation_case *of, struct random *random)
{
    struct scenario_plan plan = paths_of(of, random);
    plan.sigma_m = of->paths == PATHS_RADAR ? RADAR_TABLE_SIGMA_M : SIGMA_M;
    plan.noise_m = of->paths == PATHS_RADAR ? 0.0 : SIGMA_M;
    plan.pd = of->true_pd;
    plan.box = of->box;
    plan.clutter_mean = of->clutter_per_scan + of->clutter_per_km2 * area_km2(&of->box);
    plan.spot = of->spot;
    plan.spot_mean = of->spot_per_km2 * area_km2(&of->spot);
    return plan;
}
