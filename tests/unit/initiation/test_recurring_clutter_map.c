/* SPDX-License-Identifier: MIT */
/*
 * The clutter map within the tracker: repeated clutter starts no tracks and takes no target's
 * plots; what the map learns, forgets and is taught.
 */
#include "rhotrack/detail/recurring_clutter_map.h"
#include "rhotrack/operator.h"
#include "tracker_setup.h"

/* With RHO_MAX_ECHOES 0 there is no clutter map. */
#if RHO_MAX_ECHOES > 0

#define TURN_S 4.0
#define RANGE_M 80000.0
#define TWO_PI 6.283185307179586

/*
 * A rotating radar at the origin with sigmas of 30 m and 3 mrad, and the program's default
 * thresholds.
 */
static void start_tracker_with_radar(uint64_t seed, float v_min_mps)
{
    const struct rho_sensor radar = {.pd = 0.9f, .range_max_m = (float)RANGE_M};

    use_usual_configs(seed);
    rho_initiator_config_default(&initiation);
    config.v_min_mps = initiation.v_min_mps = v_min_mps;
    config.v_max_mps = initiation.v_max_mps = 350.0f;
    config.accel_max_mps2 = 20.0f;
    begin_tracker();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
}

static struct rho_clutter_map *clutter_map(void)
{
    return &tracker.clutter_map;
}

static struct rho_plot *add_radar_plot(double x_m, double y_m)
{
    const double range_m = hypot(x_m, y_m), cross_m = 0.003 * range_m;
    const double along = 30.0 * normal(), across = cross_m * normal();
    struct rho_plot *plot = add_plot(x_m + (along * x_m - across * y_m) / range_m,
                                     y_m + (along * y_m + across * x_m) / range_m, 30.0);

    plot->sigma_cross_m = (float)cross_m;
    return plot;
}

static void add_clutter_beyond_range(double range_min_m, int count)
{
    const double least = range_min_m * range_min_m / (RANGE_M * RANGE_M);

    for (int i = 0; i < count; i++) {
        const double range_m = RANGE_M * sqrt(uniform(least, 1.0));
        const double azimuth_rad = uniform(0.0, TWO_PI);

        add_radar_plot(range_m * cos(azimuth_rad), range_m * sin(azimuth_rad));
    }
}

static void add_clutter_plots(int count)
{
    add_clutter_beyond_range(800.0, count);
}

/* Ten towers at ranges of 15 to 60 km. */
#define TOWERS 10

static double tower_x_m(int i)
{
    return (15000.0 + 5000.0 * i) * cos(0.3 + 0.61 * i);
}

static double tower_y_m(int i)
{
    return (15000.0 + 5000.0 * i) * sin(0.3 + 0.61 * i);
}

static void add_tower_plots(double share)
{
    for (int i = 0; i < TOWERS; i++) {
        if (uniform(0.0, 1.0) < share) {
            add_radar_plot(tower_x_m(i), tower_y_m(i));
        }
    }
}

static double tower_distance_m(double x_m, double y_m)
{
    double least_m = 1e9;

    for (int i = 0; i < TOWERS; i++) {
        least_m = fmin(least_m, hypot(x_m - tower_x_m(i), y_m - tower_y_m(i)));
    }
    return least_m;
}

/*
 * Runs turns with towers and clutter; returns the number of rows of confirmed tracks within 1 km of
 * towers.
 */
static int run_turns(int *turn, int turns, double share, int clutter)
{
    int rows = 0;

    for (int end = *turn + turns; *turn < end; (*turn)++) {
        add_tower_plots(share);
        add_clutter_plots(clutter);
        step_at(TURN_S * *turn);
        for (unsigned i = 0; i < report.num_tracks; i++) {
            const struct rho_track_report *track = &report.tracks[i];

            rows += track->status != RHO_TRACK_TENTATIVE &&
                    tower_distance_m((double)track->state[0], (double)track->state[1]) < 1000.0;
        }
    }
    return rows;
}

static int count_known_echoes(const struct rho_clutter_map *map)
{
    uint32_t place = 0;
    int num = 0;

    while (rho_clutter_map_next_known(map, &place)) {
        num++;
    }
    return num;
}

static unsigned count_known_towers(void)
{
    const struct rho_echo *echo;
    uint32_t place = 0;
    unsigned count = 0;

    while ((echo = rho_clutter_map_next_known(clutter_map(), &place))) {
        count += tower_distance_m((double)echo->x_m, (double)echo->y_m) < 200.0;
    }
    return count;
}

/* Return probability in all regions of an echo with many hits that the last look saw. */
static double known_return_probability(void)
{
    return (double)rho_clutter_map_return_probability(clutter_map(), UINT8_MAX, 20, 1);
}

static void known_towers_start_no_tracks(void **state)
{
    const float v_min_mps[] = {30.0f, 0.0f};
    int rows = 0;

    (void)state;
    for (int k = 0; k < 2; k++) {
        int turn = 0;

        start_tracker_with_radar(11 + (uint64_t)k, v_min_mps[k]);
        (void)run_turns(&turn, 40, 0.5, 10);
        assert_int_equal(count_known_towers(), TOWERS);
        rows += run_turns(&turn, 200, 0.5, 10);
    }
    assert_int_equal(rows, 0);
}

static void places_of_known_towers_are_sharper_than_a_plot(void **state)
{
    const struct rho_echo *echo;
    uint32_t place = 0;
    double square = 0.0;
    int turn = 0, count = 0;

    (void)state;
    start_tracker_with_radar(3, 30.0f);
    (void)run_turns(&turn, 80, 0.5, 5);
    while ((echo = rho_clutter_map_next_known(clutter_map(), &place))) {
        const double off_m = tower_distance_m((double)echo->x_m, (double)echo->y_m);

        if (off_m < 500.0) {
            square += off_m * off_m / (double)(echo->along[0] + echo->across[0]);
            assert_true(echo->along[0] < 0.5f * 900.0f);
            assert_true(rho_clutter_map_is_echo_standing(echo));
            count++;
        }
    }
    assert_int_equal(count, TOWERS);
    assert_true(square / count < 3.0); /* 1 if the variances are right */
}

/* A target at 150 m/s passes over a tower; its track must go on with the target's own plots. */
static void a_target_that_passes_a_tower_keeps_its_plots(void **state)
{
    int own = 0, seen = 0, turn = 0;

    (void)state;
    for (int run = 0; run < 4; run++) {
        uint32_t track_id = 0;

        turn = 0;
        start_tracker_with_radar(20 + (uint64_t)run, 30.0f);
        (void)run_turns(&turn, 60, 0.5, 10);
        for (int i = -25; i <= 25; i++, turn++) {
            const double y_m = tower_y_m(3) + 150.0 * TURN_S * i;
            const struct rho_track_report *track = NULL;

            add_radar_plot(tower_x_m(3), y_m); /* row 0 is the target's plot */
            add_tower_plots(0.5);
            add_clutter_plots(10);
            step_at(TURN_S * turn);
            for (unsigned k = 0; k < report.num_tracks && i == -15; k++) {
                track_id = report.tracks[k].plot == 0 ? report.tracks[k].track_id : track_id;
            }
            if (i > -15) {
                track = report_of(track_id);
                assert_non_null(track);
                own += track->plot == 0;
                seen++;
            }
        }
    }
    assert_true(own >= seen - 4); /* one plot a run may be taken from the tower */
}

static void the_probability_of_a_return_is_learned_and_forgotten(void **state)
{
    const double shares[] = {0.5, 0.9};
    int turn = 0;

    (void)state;
    for (int k = 0; k < 2; k++) {
        turn = 0;
        start_tracker_with_radar(30, 30.0f);
        assert_true(known_return_probability() < 0.25);
        (void)run_turns(&turn, 150, shares[k], 10);
        assert_in_range(1000.0 * known_return_probability(), 1000.0 * shares[k] - 100.0,
                        1000.0 * shares[k] + 60.0);
    }
    (void)run_turns(&turn, 99, 0.0, 10);
    assert_int_equal(count_known_towers(), TOWERS);
    (void)run_turns(&turn, 20, 0.0, 10);
    assert_int_equal(count_known_towers(), 0);
    assert_int_equal(count_known_echoes(clutter_map()), 0);
}

/*
 * A tower starts no track where what never moved is clutter; an operator's start there is followed
 * until he drops it, and then the tower is clutter as before. With `targets` it is a track.
 */
static void an_operators_start_on_a_tower_is_a_track_until_it_is_dropped(void **state)
{
    const struct rho_operator_start start = {
        .x_m = (float)tower_x_m(3), .y_m = (float)tower_y_m(3), .sigma_m = 300.0f};
    int turn = 0;

    (void)state;
    start_tracker_with_radar(70, 0.0f);
    (void)run_turns(&turn, 150, 0.8, 10);
    assert_int_equal(run_turns(&turn, 20, 0.8, 10), 0);
    assert_int_equal(rho_tracker_start_at(&tracker, &start, &report), RHO_OK);
    const uint32_t track_id = report.tracks[report.num_tracks - 1].track_id;
    for (int i = 0; i < 200; i++) {
        (void)run_turns(&turn, 1, 0.8, 10);
        const struct rho_track_report *track = report_of(track_id);
        assert_non_null(track);
        assert_true(i < 3 || hypot((double)(track->state[0] - start.x_m),
                                   (double)(track->state[1] - start.y_m)) < 300.0);
    }
    assert_true(report_of(track_id)->hits > 140);
    assert_int_equal(rho_tracker_drop_track(&tracker, track_id, &report), RHO_OK);
    assert_int_equal(run_turns(&turn, 100, 0.8, 10), 0);

    turn = 0;
    start_tracker_with_radar(70, 0.0f);
    tracker.config.standing = RHO_STANDING_TARGETS;
    (void)run_turns(&turn, 30, 0.8, 10);
    assert_in_range(run_turns(&turn, 100, 0.8, 10), 100 * TOWERS * 97 / 100, 100 * TOWERS);
    assert_int_equal(count_known_echoes(clutter_map()), 0);
}

static void random_clutter_has_almost_no_return_probability(void **state)
{
    int turn = 0;

    (void)state;
    start_tracker_with_radar(40, 30.0f);
    (void)run_turns(&turn, 150, 0.0, 20);
    assert_true(rho_clutter_map_return_probability(clutter_map(), UINT8_MAX, 1, 1) < 0.004f);
    assert_true(rho_clutter_map_return_probability(clutter_map(), UINT8_MAX, 1, 3) < 0.002f);
    assert_int_equal(count_known_echoes(clutter_map()), 0);
}

/*
 * Looks and returns learned in all regions for echoes of two hits and more; with speed_mps > 0 a
 * slow target flies far away.
 */
static void learn_with_slow_target(double speed_mps, double *looks, double *returns)
{
    *looks = *returns = 0.0;
    start_tracker_with_radar(50, 30.0f);
    for (int turn = 0; turn < 60; turn++) {
        const double azimuth_rad = 1.0 + speed_mps * TURN_S * turn / 70000.0;

        add_clutter_plots(20);
        if (speed_mps > 0.0) {
            const uint64_t after = random_state;

            add_radar_plot(70000.0 * cos(azimuth_rad), 70000.0 * sin(azimuth_rad));
            random_state = after; /* the clutter is equal with and without the target */
        }
        step_at(TURN_S * turn);
    }
    for (unsigned unseen = 1; unseen < 10; unseen += unseen < 3 ? 1 : unseen - 1) {
        for (unsigned hits = 1; hits < 7; hits += hits < 3 ? 1 : 3) {
            float some_looks, some_returns;

            rho_clutter_map_learned_looks_and_returns(clutter_map(), RHO_ECHO_TABLES - 1, hits,
                                                      unseen, &some_looks, &some_returns);
            *looks += (double)some_looks;
            *returns += (double)some_returns;
        }
    }
}

static void plots_of_a_tracked_target_teach_nothing(void **state)
{
    double looks, returns, looks_with, returns_with;

    (void)state;
    learn_with_slow_target(0.0, &looks, &returns);
    learn_with_slow_target(80.0, &looks_with, &returns_with);
    assert_int_equal(report.num_tracks, 1);
    assert_true(looks > 1000.0);
    assert_true(fabs(looks_with - looks) < 0.05 * looks);
    assert_true(returns_with < returns + 3.0);
}

/*
 * For targets that may stand still, a track counts as a target's after twelve plots and a move of
 * eight standard deviations of both places.
 */
static void a_slow_target_has_moved_after_eight_standard_deviations(void **state)
{
    (void)state;
    int early = 0, late = 0;
    start_tracker_with_radar(9, 0.0f);
    for (int turn = 0; turn < 120; turn++) {
        add_plot(20000.0 + 8.0 * TURN_S * turn, 5000.0, 30.0);
        step_at(TURN_S * turn);
        if (report.num_tracks != 1) {
            continue;
        }
        const struct rho_track *track = &tracker.tracks[0];
        const double x_m = (double)(report.tracks[0].state[0] - track->start_m[0]);
        const double y_m = (double)(report.tracks[0].state[1] - track->start_m[1]);
        const double sigma_m = (double)(report.tracks[0].sigma_m + track->start_sigma_m);
        const double sigmas = hypot(x_m, y_m) / sigma_m;
        if (sigmas < 7.5) {
            early++;
            assert_int_equal(track->has_moved, 0);
        } else if (sigmas > 8.5) {
            late++;
            assert_int_equal(track->has_moved, 1);
        }
    }
    assert_true(early > 5 && late > 5);
}

/* Teaches a map what another one has learned, as a settings file does. */
static void teach_learned_map(struct rho_clutter_map *to, const struct rho_clutter_map *from)
{
    const uint16_t hits[] = {1, 2, 3, 6}, unseen[] = {1, 2, 3, 5, 9};
    const struct rho_echo *echo;
    uint32_t place = 0;
    float looks, returns;

    while ((echo = rho_clutter_map_next_known(from, &place))) {
        assert_int_equal(rho_clutter_map_teach(to, echo->sensor_id, echo->x_m, echo->y_m,
                                               sqrtf(echo->along[0]), sqrtf(echo->across[0]),
                                               echo->hits),
                         RHO_OK);
    }
    for (unsigned region = 0; region < RHO_ECHO_TABLES; region++) {
        for (int i = 0; i < RHO_ECHO_HIT_CLASSES * RHO_ECHO_GAP_CLASSES; i++) {
            const unsigned h = hits[i / RHO_ECHO_GAP_CLASSES], u = unseen[i % RHO_ECHO_GAP_CLASSES];

            rho_clutter_map_learned_looks_and_returns(from, region, h, u, &looks, &returns);
            assert_int_equal(rho_clutter_map_teach_returns(to, region, h, u, looks, returns),
                             RHO_OK);
        }
    }
}

static void a_taught_map_suppresses_towers_from_the_first_scan(void **state)
{
    static struct rho_clutter_map learned;
    int turn = 0, rows = 0;

    (void)state;
    start_tracker_with_radar(60, 30.0f);
    (void)run_turns(&turn, 100, 0.5, 10);
    learned = *clutter_map();
    for (int run = 0; run < 3; run++) {
        start_tracker_with_radar(61 + (uint64_t)run, 30.0f);
        teach_learned_map(clutter_map(), &learned);
        assert_int_equal(count_known_echoes(clutter_map()), count_known_echoes(&learned));
        assert_true(fabs(known_return_probability() - 0.5) < 0.1);
        turn = 1000000 * run; /* the first scan may be at any time */
        rows += run_turns(&turn, 60, 0.5, 10);
        assert_int_equal(count_known_towers(), TOWERS);
    }
    assert_int_equal(rows, 0);
}

/* After a change of the clock a map is as an empty one that was taught what it had learned. */
static void a_restarted_map_is_as_one_taught_anew(void **state)
{
    static struct rho_clutter_map taught, standing;
    struct rho_clutter_map *map = clutter_map();
    int turn = 0;

    (void)state;
    start_tracker_with_radar(60, 30.0f);
    (void)run_turns(&turn, 100, 0.5, 10);
    standing = *map;
    for (int i = 0; i < RHO_ECHO_PLACES; i++) {
        standing.echoes[i].hits *= (uint16_t)rho_clutter_map_is_echo_standing(&standing.echoes[i]);
    }
    start_tracker_with_radar(60, 30.0f);
    taught = *map;
    teach_learned_map(&taught, &standing);
    *map = standing;
    rho_clutter_map_restart(map);
    assert_true(count_known_echoes(map) >= TOWERS);
    assert_int_equal(count_known_echoes(map), count_known_echoes(&taught));
    assert_memory_equal(map->tables, taught.tables, sizeof taught.tables);
    for (int i = 0; i < RHO_ECHO_PLACES; i++) {
        const struct rho_echo *one = &map->echoes[i], *other = &taught.echoes[i];

        assert_int_equal(one->hits, other->hits);
        assert_int_equal(one->plot, other->plot);
        assert_int_equal(one->region, other->region);
        assert_true(one->time_us == other->time_us);
        assert_true(fabsf(one->x_m - other->x_m) + fabsf(one->y_m - other->y_m) <= 0.0f);
        assert_true(fabsf(one->along[0] - other->along[0]) <= 1e-6f * other->along[0]);
        assert_true(one->along[2] <= 0.0f);
    }
    assert_true(rho_clutter_map_is_sound(map));
    run_turns(&turn, 20, 0.5, 10);
    assert_int_equal(count_known_towers(), TOWERS);
}

static void towers_taught_by_hand_start_no_tracks(void **state)
{
    int turn = 0, rows = 0;

    (void)state;
    for (int run = 0; run < 3; run++) {
        start_tracker_with_radar(70 + (uint64_t)run, 30.0f);
        for (int i = 0; i < TOWERS; i++) {
            assert_int_equal(rho_clutter_map_teach(clutter_map(), 0, (float)tower_x_m(i),
                                                   (float)tower_y_m(i), 30.0f, 30.0f, 6),
                             RHO_OK);
        }
        for (unsigned unseen = 1; unseen < 10; unseen++) { /* towers return half of the time */
            assert_int_equal(rho_clutter_map_teach_returns(clutter_map(), RHO_ECHO_TABLES - 1, 6,
                                                           unseen, 20, 10),
                             RHO_OK);
        }
        turn = 0;
        rows += run_turns(&turn, 60, 0.5, 10);
    }
    assert_int_equal(rows, 0);
}

static void taught_echoes_that_are_not_there_are_forgotten(void **state)
{
    const struct {
        uint16_t hits;
        int scans;
    } kept[] = {{1, 12}, {2, 16}, {5, 30}, {6, 100}, {65535, 100}};

    (void)state;
    for (size_t k = 0; k < sizeof kept / sizeof kept[0]; k++) {
        start_tracker_with_radar(80, 30.0f);
        assert_int_equal(
            rho_clutter_map_teach(clutter_map(), 0, 20000.0f, 0.0f, 30.0f, 30.0f, kept[k].hits),
            RHO_OK);
        for (int scan = 0; scan < kept[k].scans; scan++) {
            step_at(1e9 + TURN_S * scan); /* whatever the time is */
            assert_int_equal(clutter_map()->echoes[0].hits, kept[k].hits);
            assert_true(clutter_map()->echoes[0].along[0] == 900.0f);
            assert_true(clutter_map()->echoes[0].x_m == 20000.0f);
        }
        step_at(1e9 + TURN_S * kept[k].scans);
        assert_int_equal(clutter_map()->echoes[0].hits, 0);
    }
}

/* Echoes of another sensor, and beyond the range of this one, are not looked at. */
static void echoes_outside_all_coverage_are_kept(void **state)
{
    (void)state;
    start_tracker_with_radar(81, 30.0f);
    assert_int_equal(rho_clutter_map_teach(clutter_map(), 7, 20000.0f, 0.0f, 30.0f, 30.0f, 6),
                     RHO_OK);
    assert_int_equal(rho_clutter_map_teach(clutter_map(), 0, 90000.0f, 0.0f, 30.0f, 30.0f, 6),
                     RHO_OK);
    for (int scan = 0; scan < 150; scan++) {
        step_at(TURN_S * scan);
    }
    assert_int_equal(clutter_map()->echoes[0].hits, 6);
    assert_int_equal(clutter_map()->echoes[1].hits, 6);
    assert_int_equal(clutter_map()->echoes[0].unseen + clutter_map()->echoes[1].unseen, 0);
}

static void bad_values_are_refused_and_change_nothing(void **state)
{
    const float bad_m[] = {NAN, INFINITY, -INFINITY, 3e6f},
                bad_sigma_m[] = {NAN, INFINITY, 0.0f, -1.0f, 2e5f};
    static struct rho_clutter_map before;
    struct rho_clutter_map *map = clutter_map();
    float looks = 7.0f, returns = 7.0f;
    uint32_t place = 0;

    (void)state;
    start_tracker_with_radar(90, 30.0f);
    before = *map;
    for (int i = 0; i < 4; i++) {
        assert_int_equal(rho_clutter_map_teach(map, 0, bad_m[i], 0, 1, 1, 6), RHO_ERROR_VALUE);
        assert_int_equal(rho_clutter_map_teach(map, 0, 0, bad_m[i], 1, 1, 6), RHO_ERROR_VALUE);
    }
    for (int i = 0; i < 5; i++) {
        assert_int_equal(rho_clutter_map_teach(map, 0, 0, 0, bad_sigma_m[i], 1, 6),
                         RHO_ERROR_VALUE);
        assert_int_equal(rho_clutter_map_teach(map, 0, 0, 0, 1, bad_sigma_m[i], 6),
                         RHO_ERROR_VALUE);
    }
    assert_int_equal(rho_clutter_map_teach(map, 0, 0, 0, 1, 1, 0), RHO_ERROR_VALUE);
    assert_int_equal(rho_clutter_map_teach(NULL, 0, 0, 0, 1, 1, 6), RHO_ERROR_NULL);
    assert_int_equal(rho_clutter_map_teach_returns(map, RHO_ECHO_TABLES, 1, 1, 1, 1),
                     RHO_ERROR_VALUE);
    assert_int_equal(rho_clutter_map_teach_returns(map, 0, 0, 1, 1, 1), RHO_ERROR_VALUE);
    assert_int_equal(rho_clutter_map_teach_returns(map, 0, 1, 0, 1, 1), RHO_ERROR_VALUE);
    assert_int_equal(rho_clutter_map_teach_returns(map, 0, 1, 1, 1, 2), RHO_ERROR_VALUE);
    assert_int_equal(rho_clutter_map_teach_returns(map, 0, 1, 1, NAN, 0), RHO_ERROR_VALUE);
    assert_int_equal(rho_clutter_map_teach_returns(map, 0, 1, 1, 1, NAN), RHO_ERROR_VALUE);
    assert_int_equal(rho_clutter_map_teach_returns(map, 0, 1, 1, 2e9f, 1), RHO_ERROR_VALUE);
    assert_int_equal(rho_clutter_map_teach_returns(map, 0, 1, 1, -1, -1), RHO_ERROR_VALUE);
    assert_int_equal(rho_clutter_map_teach_returns(NULL, 0, 1, 1, 1, 1), RHO_ERROR_NULL);
    assert_memory_equal(map, &before, sizeof before);
    assert_null(rho_clutter_map_next_known(NULL, &place));
    assert_null(rho_clutter_map_next_known(map, NULL));
    assert_null(rho_clutter_map_next_known(map, &place));
    assert_int_equal(rho_clutter_map_is_echo_standing(NULL), 0);
    rho_clutter_map_learned_looks_and_returns(map, RHO_ECHO_TABLES, 1, 1, &looks, &returns);
    assert_true(looks == 0.0f && returns == 0.0f);
    rho_clutter_map_learned_looks_and_returns(NULL, 0, 1, 1, &looks, NULL);
    assert_true(looks == 0.0f);
}

static void a_full_map_drops_the_most_missed_echoes(void **state)
{
    const int clutter = RHO_MAX_ECHOES / 8; /* random clutter is kept for twelve scans */
    int turn = 0;

    (void)state;
    start_tracker_with_radar(100, 30.0f);
    (void)run_turns(&turn, 40, 0.9, clutter);
    assert_true(clutter_map()->echoes_dropped > (uint32_t)clutter);
    assert_int_equal(count_known_towers(), TOWERS);
}

static void echoes_taught_beyond_the_capacity_are_dropped_and_counted(void **state)
{
    uint32_t place = 0, count = 0;

    (void)state;
    start_tracker_with_radar(101, 30.0f);
    for (int i = 0; i < RHO_MAX_ECHOES + 5; i++) {
        assert_int_equal(rho_clutter_map_teach(clutter_map(), 0, (float)i, 1.0f, 30.0f, 30.0f, 6),
                         RHO_OK);
    }
    while (rho_clutter_map_next_known(clutter_map(), &place)) {
        count++;
    }
    assert_int_equal(count, RHO_MAX_ECHOES);
    assert_int_equal(clutter_map()->echoes_dropped, 5);
}

/* The map looks at the first RHO_MAX_PLOTS plots, which include the towers. */
static void the_map_learns_from_scans_with_too_many_plots(void **state)
{
    (void)state;
    start_tracker_with_radar(102, 30.0f);
    for (int turn = 0; turn < 12; turn++) {
        struct rho_scan scan = {.time_us = llround(1e6 * TURN_S * turn), .plots = plots};

        add_tower_plots(1.0);
        add_clutter_beyond_range(70000.0, RHO_MAX_PLOTS + 100);
        scan.num_plots = num_plots;
        assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
        check_fate_sums();
        num_plots = 0;
    }
    assert_int_equal(count_known_towers(), TOWERS);
}

/* Hits of known towers from the same plots in whole turns, or in turns of eight sectors. */
static unsigned sum_tower_hits_of_turns_in_sectors(int sectors)
{
    const struct rho_echo *echo;
    uint32_t place = 0;
    unsigned hits = 0;

    start_tracker_with_radar(110, 30.0f);
    for (int turn = 0; turn < 60; turn++) {
        static struct rho_plot seen[TOWERS];
        uint32_t count;

        add_tower_plots(0.7);
        count = num_plots;
        memcpy(seen, plots, count * sizeof seen[0]);
        num_plots = 0;
        for (int s = 0; s < sectors; s++) {
            const double from_rad = TWO_PI * s / sectors, to_rad = TWO_PI * (s + 1) / sectors;
            struct rho_scan scan = {.time_us =
                                        llround(1e6 * TURN_S * (turn + (s + 1.0) / sectors))};

            if (sectors > 1) {
                scan.sector_from_rad = (float)remainder(from_rad, TWO_PI);
                scan.sector_to_rad = (float)remainder(to_rad, TWO_PI);
            }
            for (uint32_t i = 0; i < count; i++) {
                const double angle_rad = atan2((double)seen[i].y_m, (double)seen[i].x_m);
                const double azimuth_rad = angle_rad < 0.0 ? angle_rad + TWO_PI : angle_rad;

                if (azimuth_rad >= from_rad && azimuth_rad < to_rad) {
                    plots[num_plots++] = seen[i];
                }
            }
            step_scan(scan);
        }
    }
    while ((echo = rho_clutter_map_next_known(clutter_map(), &place))) {
        hits += echo->hits;
    }
    return hits;
}

static void sectors_of_a_turn_count_as_one_look(void **state)
{
    float looks[2], returns[2];

    (void)state;
    for (int k = 0; k < 2; k++) {
        const unsigned hits = sum_tower_hits_of_turns_in_sectors(k == 0 ? 1 : 8);

        assert_int_equal(count_known_towers(), TOWERS);
        assert_in_range(hits, 390, 450); /* 0.7 of 600 */
        rho_clutter_map_learned_looks_and_returns(clutter_map(), RHO_ECHO_TABLES - 1, 6, 1,
                                                  &looks[k], &returns[k]);
        assert_true(looks[k] > 200.0f);
    }
    assert_true(fabsf(looks[1] - looks[0]) < 0.05f * looks[0]);
    assert_true(fabsf(returns[1] - returns[0]) < 0.1f * returns[0]);
}

/*
 * Ratio of clutter densities with and without the map, for a plot of this range rate at a known
 * tower whose range rate is 0.
 */
static double clutter_ratio_at_range_rate(double range_rate_mps)
{
    start_tracker_with_radar(120, 30.0f);
    for (int turn = 0; turn <= 60; turn++) {
        add_clutter_plots(10);
        for (uint32_t i = 0; i < num_plots; i++) {
            plots[i].range_rate_mps = (float)uniform(-300.0, 300.0);
        }
        for (int i = 0; i < TOWERS; i++) {
            if (turn == 60) {
                struct rho_plot *plot = add_plot(tower_x_m(i), tower_y_m(i), 30.0);

                plot->range_rate_mps = (float)range_rate_mps;
            } else if (uniform(0.0, 1.0) < 0.5) {
                add_radar_plot(tower_x_m(i), tower_y_m(i))->range_rate_mps =
                    (float)(0.5 * normal());
            }
        }
        for (uint32_t i = 0; i < num_plots; i++) {
            plots[i].sigma_range_rate_mps = 0.5f;
        }
        step_scan((struct rho_scan){.time_us = llround(1e6 * TURN_S * turn),
                                    .measures = RHO_MEASURES_RANGE_RATE});
    }
    return expm1((double)clutter_map()->denser[10]) + expm1((double)clutter_map()->denser[15]);
}

static void a_standing_echo_does_not_explain_a_fast_range_rate(void **state)
{
    (void)state;
    assert_true(clutter_ratio_at_range_rate(0.0) > 50.0 * clutter_ratio_at_range_rate(100.0));
}

/*
 * A 24 GHz radar in a room, 20 scans a second, with reflectors of range rate 0 from the first scan
 * on.
 */
#define REFLECTORS 6

static void add_room_plot(double x_m, double y_m, double vx_mps)
{
    const double range_m = hypot(x_m, y_m), sigma_m = 0.15;
    const double dx_m = sigma_m * normal(), dy_m = sigma_m * normal();
    struct rho_plot *plot = add_plot(x_m + dx_m, y_m + dy_m, sigma_m);
    const double rate_mps = 0.1 * normal();

    plot->range_rate_mps = (float)(vx_mps * x_m / range_m + rate_mps);
    plot->sigma_range_rate_mps = 0.1f;
}

/* Number of confirmed tracks within 1 m. */
static int count_tracks_in_room(double x_m, double y_m)
{
    int num = 0;

    for (unsigned i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];

        num += track->status != RHO_TRACK_TENTATIVE &&
               hypot((double)track->state[0] - x_m, (double)track->state[1] - y_m) < 1.0;
    }
    return num;
}

/* Way of a person who walks for 7 s, stands for 6 s and walks on. */
static double walked_m(double t_s)
{
    return 1.2 * (fmin(t_s, 7.0) + fmax(t_s - 13.0, 0.0));
}

static void reflectors_in_a_room_keep_no_tracks(void **state)
{
    const struct rho_sensor radar = {.pd = 0.9f, .range_max_m = 80.0f};
    int early = 0, late = 0, walks = 0;

    (void)state;
    use_usual_configs(77);
    rho_initiator_config_default(&initiation);
    config.v_max_mps = initiation.v_max_mps = 30.0f;
    config.accel_max_mps2 = 8.0f;
    begin_tracker();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    for (int k = 0; k < 400; k++) {
        const double t_s = 0.05 * k;
        const int stands = t_s > 7.0 && t_s < 13.0;

        for (int i = 0; i < REFLECTORS; i++) {
            if (uniform(0.0, 1.0) < 0.8) {
                add_room_plot(20.0 + 8.0 * i, 12.0 * (i % 3) - 15.0, 0.0);
            }
        }
        if (uniform(0.0, 1.0) < 0.9) {
            add_room_plot(30.0 + walked_m(t_s), 25.0, stands ? 0.0 : 1.2);
        }
        for (int i = 0; i < 5; i++) {
            const double x_m = uniform(5.0, 70.0);

            add_room_plot(x_m, uniform(-40.0, 40.0), uniform(-20.0, 20.0));
        }
        step_scan(
            (struct rho_scan){.time_us = llround(1e6 * t_s), .measures = RHO_MEASURES_RANGE_RATE});
        for (int i = 0; i < REFLECTORS; i++) {
            const int num = count_tracks_in_room(20.0 + 8.0 * i, 12.0 * (i % 3) - 15.0);

            early += k < 60 ? num : 0;
            late += k < 60 ? 0 : num;
        }
        walks += count_tracks_in_room(30.0 + walked_m(t_s), 25.0) == 1;
    }
    /* at first nothing tells reflectors from standing targets */
    assert_true(early > REFLECTORS * 10);
    assert_true(late <= 2);   /* 1 of 2040 seen */
    assert_true(walks > 380); /* of 400 scans */
    assert_true(clutter_map()->exact_plots > 0.9f * clutter_map()->rate_plots);
}

static void the_same_scans_make_the_same_map(void **state)
{
    static struct rho_clutter_map first;
    int turn;

    (void)state;
    for (int k = 0; k < 2; k++) {
        turn = 0;
        memset(&tracker, k ? 0xa5 : 0, sizeof tracker);
        start_tracker_with_radar(130, 30.0f);
        (void)run_turns(&turn, 40, 0.5, 20);
        if (k == 0) {
            first = *clutter_map();
        }
    }
    assert_memory_equal(&first, clutter_map(), sizeof first);
}

/*
 * A sensor fills the map once and falls silent; towers of another sensor must replace its echoes.
 */
static void echoes_of_a_silent_sensor_are_replaced(void **state)
{
    const int num = RHO_MAX_ECHOES + 20 < RHO_MAX_PLOTS ? RHO_MAX_ECHOES + 20 : RHO_MAX_PLOTS;
    int turn = 1;

    (void)state;
    assert_true(num >= RHO_MAX_ECHOES);
    start_tracker_with_radar(140, 30.0f);
    add_clutter_plots(num);
    step_scan((struct rho_scan){.time_us = 0, .sensor_id = 7});
    (void)run_turns(&turn, 30, 1.0, 0);
    assert_int_equal(count_known_towers(), TOWERS);
}

static void echoes_of_millimetre_plots_keep_valid_variances(void **state)
{
    (void)state;
    start_tracker_with_radar(141, 100.0f);
    for (int turn = 0; turn < 200; turn++) {
        for (int i = 0; i < TOWERS && turn % 20 < 3; i++) {
            (void)add_plot(tower_x_m(i), tower_y_m(i) + 0.001 * normal(), 0.001 * (i + 1));
        }
        step_at(TURN_S * turn + 0.0137 * (double)(turn * turn % 71));
        for (unsigned i = 0; i < RHO_MAX_ECHOES; i++) {
            const struct rho_echo *echo = &clutter_map()->echoes[i];

            assert_true(echo->along[0] >= 0.0f && echo->along[2] >= 0.0f);
            assert_true(echo->across[0] >= 0.0f && echo->across[2] >= 0.0f);
        }
        for (int i = 0; i < TOWERS && turn % 20 < 3; i++) {
            assert_true(isfinite(clutter_map()->denser[i]));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(echoes_of_a_silent_sensor_are_replaced),
        cmocka_unit_test(echoes_of_millimetre_plots_keep_valid_variances),
        cmocka_unit_test(known_towers_start_no_tracks),
        cmocka_unit_test(places_of_known_towers_are_sharper_than_a_plot),
        cmocka_unit_test(a_target_that_passes_a_tower_keeps_its_plots),
        cmocka_unit_test(the_probability_of_a_return_is_learned_and_forgotten),
        cmocka_unit_test(an_operators_start_on_a_tower_is_a_track_until_it_is_dropped),
        cmocka_unit_test(random_clutter_has_almost_no_return_probability),
        cmocka_unit_test(plots_of_a_tracked_target_teach_nothing),
        cmocka_unit_test(a_slow_target_has_moved_after_eight_standard_deviations),
        cmocka_unit_test(a_taught_map_suppresses_towers_from_the_first_scan),
        cmocka_unit_test(a_restarted_map_is_as_one_taught_anew),
        cmocka_unit_test(towers_taught_by_hand_start_no_tracks),
        cmocka_unit_test(taught_echoes_that_are_not_there_are_forgotten),
        cmocka_unit_test(echoes_outside_all_coverage_are_kept),
        cmocka_unit_test(bad_values_are_refused_and_change_nothing),
        cmocka_unit_test(a_full_map_drops_the_most_missed_echoes),
        cmocka_unit_test(echoes_taught_beyond_the_capacity_are_dropped_and_counted),
        cmocka_unit_test(the_map_learns_from_scans_with_too_many_plots),
        cmocka_unit_test(sectors_of_a_turn_count_as_one_look),
        cmocka_unit_test(a_standing_echo_does_not_explain_a_fast_range_rate),
        cmocka_unit_test(reflectors_in_a_room_keep_no_tracks),
        cmocka_unit_test(the_same_scans_make_the_same_map),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
