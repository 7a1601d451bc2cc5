/* SPDX-License-Identifier: MIT */
/*
 * Clutter that comes back, through the step: it starts no tracks and takes no target's plots; what
 * is learned, forgotten, saved.
 */
#include "rhotrack/detail/clutter_map.h"
#include "tracker_setup.h"

/* A build may leave the map out: RHO_MAX_ECHOES 0. */
#if RHO_MAX_ECHOES > 0

#define TURN_S 4.0
#define RANGE_M 80000.0
#define TWO_PI 6.283185307179586

/* A turning radar of 30 m and 3 mrad in the origin, and the program's own thresholds. */
static void start(uint64_t seed, float v_min_mps)
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

static struct rho_clutter_map *map_of(void)
{
    return &tracker.clutter_map;
}

static struct rho_plot *see(double x_m, double y_m)
{
    const double range_m = hypot(x_m, y_m), cross_m = 0.003 * range_m;
    const double along = 30.0 * normal(), across = cross_m * normal();
    struct rho_plot *plot = add_plot(x_m + (along * x_m - across * y_m) / range_m,
                                     y_m + (along * y_m + across * x_m) / range_m, 30.0);

    plot->sigma_cross_m = (float)cross_m;
    return plot;
}

static void see_clutter_from(double least_m, int count)
{
    const double least = least_m * least_m / (RANGE_M * RANGE_M);

    for (int i = 0; i < count; i++) {
        const double range_m = RANGE_M * sqrt(uniform(least, 1.0));
        const double azimuth_rad = uniform(0.0, TWO_PI);

        see(range_m * cos(azimuth_rad), range_m * sin(azimuth_rad));
    }
}

static void see_clutter(int count)
{
    see_clutter_from(800.0, count);
}

/* Ten towers from 15 to 60 km. */
#define TOWERS 10

static double tower_x_m(int i)
{
    return (15000.0 + 5000.0 * i) * cos(0.3 + 0.61 * i);
}

static double tower_y_m(int i)
{
    return (15000.0 + 5000.0 * i) * sin(0.3 + 0.61 * i);
}

static void see_towers(double share)
{
    for (int i = 0; i < TOWERS; i++) {
        if (uniform(0.0, 1.0) < share) {
            see(tower_x_m(i), tower_y_m(i));
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

/* Turns with towers and clutter. Returns how many rows of tracks near towers were believed. */
static int turn_on(int *turn, int turns, double share, int clutter)
{
    int rows = 0;

    for (int end = *turn + turns; *turn < end; (*turn)++) {
        see_towers(share);
        see_clutter(clutter);
        step_at(TURN_S * *turn);
        for (unsigned i = 0; i < report.num_tracks; i++) {
            const struct rho_track_report *track = &report.tracks[i];

            rows += track->status != RHO_TRACK_TENTATIVE &&
                    tower_distance_m((double)track->state[0], (double)track->state[1]) < 1000.0;
        }
    }
    return rows;
}

static int count_known(const struct rho_clutter_map *map)
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

    while ((echo = rho_clutter_map_next_known(map_of(), &place))) {
        count += tower_distance_m((double)echo->x_m, (double)echo->y_m) < 200.0;
    }
    return count;
}

/* Of all regions: what an echo with many hits that was just seen does next. */
static double known_chance(void)
{
    return (double)rho_clutter_map_return_probability(map_of(), UINT8_MAX, 20, 1);
}

/* ---- towers ---------------------------------------------------------------------------------- */

static void known_towers_start_no_tracks(void **state)
{
    const float v_min_mps[] = {30.0f, 0.0f};
    int rows = 0;

    (void)state;
    for (int k = 0; k < 2; k++) {
        int turn = 0;

        start(11 + (uint64_t)k, v_min_mps[k]);
        (void)turn_on(&turn, 40, 0.5, 10);
        assert_int_equal(count_known_towers(), TOWERS);
        rows += turn_on(&turn, 200, 0.5, 10);
    }
    assert_int_equal(rows, 0);
}

static void known_places_are_better_than_a_plot(void **state)
{
    const struct rho_echo *echo;
    uint32_t place = 0;
    double square = 0.0;
    int turn = 0, count = 0;

    (void)state;
    start(3, 30.0f);
    (void)turn_on(&turn, 80, 0.5, 5);
    while ((echo = rho_clutter_map_next_known(map_of(), &place))) {
        const double off_m = tower_distance_m((double)echo->x_m, (double)echo->y_m);

        if (off_m < 500.0) {
            square += off_m * off_m / (double)(echo->along[0] + echo->across[0]);
            assert_true(echo->along[0] < 0.5f * 900.0f);
            assert_true(rho_clutter_map_is_echo_standing(echo));
            count++;
        }
    }
    assert_int_equal(count, TOWERS);
    assert_true(square / count < 3.0); /* 1 where the variances are right */
}

/* A target at 150 m/s over a tower: the track goes on, with the target's plots. */
static void a_target_that_passes_keeps_its_plots(void **state)
{
    int own = 0, seen = 0, turn = 0;

    (void)state;
    for (int run = 0; run < 4; run++) {
        uint32_t track_id = 0;

        turn = 0;
        start(20 + (uint64_t)run, 30.0f);
        (void)turn_on(&turn, 60, 0.5, 10);
        for (int i = -25; i <= 25; i++, turn++) {
            const double y_m = tower_y_m(3) + 150.0 * TURN_S * i;
            const struct rho_track_report *track = NULL;

            see(tower_x_m(3), y_m); /* row 0 */
            see_towers(0.5);
            see_clutter(10);
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
    assert_true(own >= seen - 4); /* once a run beside the tower's plot */
}

/* ---- what is learned ------------------------------------------------------------------------- */

static void the_chance_of_a_return_is_learned_and_forgotten(void **state)
{
    const double shares[] = {0.5, 0.9};
    int turn = 0;

    (void)state;
    for (int k = 0; k < 2; k++) {
        turn = 0;
        start(30, 30.0f);
        assert_true(known_chance() < 0.25);
        (void)turn_on(&turn, 150, shares[k], 10);
        assert_in_range(1000.0 * known_chance(), 1000.0 * shares[k] - 100.0,
                        1000.0 * shares[k] + 60.0);
    }
    (void)turn_on(&turn, 99, 0.0, 10);
    assert_int_equal(count_known_towers(), TOWERS);
    (void)turn_on(&turn, 20, 0.0, 10);
    assert_int_equal(count_known_towers(), 0);
    assert_int_equal(count_known(map_of()), 0);
}

static void clutter_that_comes_nowhere_twice_has_no_chance(void **state)
{
    int turn = 0;

    (void)state;
    start(40, 30.0f);
    (void)turn_on(&turn, 150, 0.0, 20);
    assert_true(rho_clutter_map_return_probability(map_of(), UINT8_MAX, 1, 1) < 0.004f);
    assert_true(rho_clutter_map_return_probability(map_of(), UINT8_MAX, 1, 3) < 0.002f);
    assert_int_equal(count_known(map_of()), 0);
}

/*
 * Sums over the classes with two hits and more of what all regions learned, with and without a slow
 * target far away.
 */
static void learn_beside(double speed_mps, double *looks, double *returns)
{
    *looks = *returns = 0.0;
    start(50, 30.0f);
    for (int turn = 0; turn < 60; turn++) {
        const double azimuth_rad = 1.0 + speed_mps * TURN_S * turn / 70000.0;

        see_clutter(20);
        if (speed_mps > 0.0) {
            const uint64_t after = random_state;

            see(70000.0 * cos(azimuth_rad), 70000.0 * sin(azimuth_rad));
            random_state = after; /* clutter is the same */
        }
        step_at(TURN_S * turn);
    }
    for (unsigned unseen = 1; unseen < 10; unseen += unseen < 3 ? 1 : unseen - 1) {
        for (unsigned hits = 1; hits < 7; hits += hits < 3 ? 1 : 3) {
            float some_looks, some_returns;

            rho_clutter_map_learned_returns(map_of(), RHO_ECHO_TABLES - 1, hits, unseen,
                                            &some_looks, &some_returns);
            *looks += (double)some_looks;
            *returns += (double)some_returns;
        }
    }
}

static void plots_of_a_tracked_target_teach_nothing(void **state)
{
    double looks, returns, looks_with, returns_with;

    (void)state;
    learn_beside(0.0, &looks, &returns);
    learn_beside(80.0, &looks_with, &returns_with);
    assert_int_equal(report.num_tracks, 1);
    assert_true(looks > 1000.0);
    assert_true(fabs(looks_with - looks) < 0.05 * looks);
    assert_true(returns_with < returns + 3.0);
}

/*
 * Where targets may stand, a track is a target's when it is surely elsewhere than where it started:
 * after twelve plots, and eight standard deviations of both places.
 */
static void a_target_that_crawls_has_moved_in_the_end(void **state)
{
    (void)state;
    int early = 0, late = 0;
    start(9, 0.0f);
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

/* ---- taught, saved --------------------------------------------------------------------------- */

/* A map that another run has learned, as a file keeps it. */
static void carry_over(struct rho_clutter_map *to, const struct rho_clutter_map *from)
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

            rho_clutter_map_learned_returns(from, region, h, u, &looks, &returns);
            assert_int_equal(rho_clutter_map_teach_returns(to, region, h, u, looks, returns),
                             RHO_OK);
        }
    }
}

static void what_was_learned_is_known_from_the_first_scan(void **state)
{
    static struct rho_clutter_map learned;
    int turn = 0, rows = 0;

    (void)state;
    start(60, 30.0f);
    (void)turn_on(&turn, 100, 0.5, 10);
    learned = *map_of();
    for (int run = 0; run < 3; run++) {
        start(61 + (uint64_t)run, 30.0f);
        carry_over(map_of(), &learned);
        assert_int_equal(count_known(map_of()), count_known(&learned));
        assert_true(fabs(known_chance() - 0.5) < 0.1);
        turn = 1000000 * run; /* at any time */
        rows += turn_on(&turn, 60, 0.5, 10);
        assert_int_equal(count_known_towers(), TOWERS);
    }
    assert_int_equal(rows, 0);
}

static void towers_by_hand_start_no_tracks(void **state)
{
    int turn = 0, rows = 0;

    (void)state;
    for (int run = 0; run < 3; run++) {
        start(70 + (uint64_t)run, 30.0f);
        for (int i = 0; i < TOWERS; i++) {
            assert_int_equal(rho_clutter_map_teach(map_of(), 0, (float)tower_x_m(i),
                                                   (float)tower_y_m(i), 30.0f, 30.0f, 6),
                             RHO_OK);
        }
        for (unsigned unseen = 1; unseen < 10; unseen++) { /* half of the time, more or less */
            assert_int_equal(
                rho_clutter_map_teach_returns(map_of(), RHO_ECHO_TABLES - 1, 6, unseen, 20, 10),
                RHO_OK);
        }
        turn = 0;
        rows += turn_on(&turn, 60, 0.5, 10);
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
        start(80, 30.0f);
        assert_int_equal(
            rho_clutter_map_teach(map_of(), 0, 20000.0f, 0.0f, 30.0f, 30.0f, kept[k].hits), RHO_OK);
        for (int scan = 0; scan < kept[k].scans; scan++) {
            step_at(1e9 + TURN_S * scan); /* whatever the time is */
            assert_int_equal(map_of()->echoes[0].hits, kept[k].hits);
            assert_true(map_of()->echoes[0].along[0] == 900.0f);
            assert_true(map_of()->echoes[0].x_m == 20000.0f);
        }
        step_at(1e9 + TURN_S * kept[k].scans);
        assert_int_equal(map_of()->echoes[0].hits, 0);
    }
}

/* Of another sensor, or beyond what this one sees: its scans say nothing of it. */
static void what_nobody_looks_at_is_kept(void **state)
{
    (void)state;
    start(81, 30.0f);
    assert_int_equal(rho_clutter_map_teach(map_of(), 7, 20000.0f, 0.0f, 30.0f, 30.0f, 6), RHO_OK);
    assert_int_equal(rho_clutter_map_teach(map_of(), 0, 90000.0f, 0.0f, 30.0f, 30.0f, 6), RHO_OK);
    for (int scan = 0; scan < 150; scan++) {
        step_at(TURN_S * scan);
    }
    assert_int_equal(map_of()->echoes[0].hits, 6);
    assert_int_equal(map_of()->echoes[1].hits, 6);
    assert_int_equal(map_of()->echoes[0].unseen + map_of()->echoes[1].unseen, 0);
}

static void bad_values_are_refused_untouched(void **state)
{
    const float bad_m[] = {NAN, INFINITY, -INFINITY, 3e6f},
                bad_sigma_m[] = {NAN, INFINITY, 0.0f, -1.0f, 2e5f};
    static struct rho_clutter_map before;
    struct rho_clutter_map *map = map_of();
    float looks = 7.0f, returns = 7.0f;
    uint32_t place = 0;

    (void)state;
    start(90, 30.0f);
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
    rho_clutter_map_learned_returns(map, RHO_ECHO_TABLES, 1, 1, &looks, &returns);
    assert_true(looks == 0.0f && returns == 0.0f);
    rho_clutter_map_learned_returns(NULL, 0, 1, 1, &looks, NULL);
    assert_true(looks == 0.0f);
}

/* ---- room ------------------------------------------------------------------------------------ */

static void a_full_map_drops_what_was_missed_most(void **state)
{
    const int clutter = RHO_MAX_ECHOES / 8; /* each is kept for twelve scans */
    int turn = 0;

    (void)state;
    start(100, 30.0f);
    (void)turn_on(&turn, 40, 0.9, clutter);
    assert_true(map_of()->echoes_dropped > (uint32_t)clutter);
    assert_int_equal(count_known_towers(), TOWERS);
}

static void more_are_taught_than_there_is_room_for(void **state)
{
    uint32_t place = 0, count = 0;

    (void)state;
    start(101, 30.0f);
    for (int i = 0; i < RHO_MAX_ECHOES + 5; i++) {
        assert_int_equal(rho_clutter_map_teach(map_of(), 0, (float)i, 1.0f, 30.0f, 30.0f, 6),
                         RHO_OK);
    }
    while (rho_clutter_map_next_known(map_of(), &place)) {
        count++;
    }
    assert_int_equal(count, RHO_MAX_ECHOES);
    assert_int_equal(map_of()->echoes_dropped, 5);
}

/* Towers come first: the map looks at the first RHO_MAX_PLOTS. */
static void scans_of_more_plots_than_there_is_room_for(void **state)
{
    (void)state;
    start(102, 30.0f);
    for (int turn = 0; turn < 12; turn++) {
        struct rho_scan scan = {.time_us = llround(1e6 * TURN_S * turn), .plots = plots};

        see_towers(1.0);
        see_clutter_from(70000.0, RHO_MAX_PLOTS + 100);
        scan.num_plots = num_plots;
        assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
        check_fate_sums();
        num_plots = 0;
    }
    assert_int_equal(count_known_towers(), TOWERS);
}

/* ---- sectors, range rates -------------------------------------------------------------------- */

/* The same plots turn by turn, or each turn in eight sectors. */
static unsigned hits_of_towers(int sectors)
{
    const struct rho_echo *echo;
    uint32_t place = 0;
    unsigned hits = 0;

    start(110, 30.0f);
    for (int turn = 0; turn < 60; turn++) {
        static struct rho_plot seen[TOWERS];
        uint32_t count;

        see_towers(0.7);
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
    while ((echo = rho_clutter_map_next_known(map_of(), &place))) {
        hits += echo->hits;
    }
    return hits;
}

static void sectors_of_a_turn_look_once(void **state)
{
    float looks[2], returns[2];

    (void)state;
    for (int k = 0; k < 2; k++) {
        const unsigned hits = hits_of_towers(k == 0 ? 1 : 8);

        assert_int_equal(count_known_towers(), TOWERS);
        assert_in_range(hits, 390, 450); /* .7 of 600 */
        rho_clutter_map_learned_returns(map_of(), RHO_ECHO_TABLES - 1, 6, 1, &looks[k],
                                        &returns[k]);
        assert_true(looks[k] > 200.0f);
    }
    assert_true(fabsf(looks[1] - looks[0]) < 0.05f * looks[0]);
    assert_true(fabsf(returns[1] - returns[0]) < 0.1f * returns[0]);
}

/*
 * How much denser clutter is for a plot of this range rate at a known tower whose range rates are
 * 0.
 */
static double repeats_at_range_rate(double range_rate_mps)
{
    start(120, 30.0f);
    for (int turn = 0; turn <= 60; turn++) {
        see_clutter(10);
        for (uint32_t i = 0; i < num_plots; i++) {
            plots[i].range_rate_mps = (float)uniform(-300.0, 300.0);
        }
        for (int i = 0; i < TOWERS; i++) {
            if (turn == 60) {
                struct rho_plot *plot = add_plot(tower_x_m(i), tower_y_m(i), 30.0);

                plot->range_rate_mps = (float)range_rate_mps;
            } else if (uniform(0.0, 1.0) < 0.5) {
                see(tower_x_m(i), tower_y_m(i))->range_rate_mps = (float)(0.5 * normal());
            }
        }
        for (uint32_t i = 0; i < num_plots; i++) {
            plots[i].sigma_range_rate_mps = 0.5f;
        }
        step_scan((struct rho_scan){.time_us = llround(1e6 * TURN_S * turn),
                                    .measures = RHO_MEASURES_RANGE_RATE});
    }
    return expm1((double)map_of()->denser[10]) + expm1((double)map_of()->denser[15]);
}

static void what_stands_explains_no_fast_range_rate(void **state)
{
    (void)state;
    assert_true(repeats_at_range_rate(0.0) > 50.0 * repeats_at_range_rate(100.0));
}

/*
 * A radar of 24 GHz in a room, 20 scans a second: reflectors that are seen from the first scan on,
 * with a range rate of 0.
 */
#define REFLECTORS 6

static void see_in_room(double x_m, double y_m, double speed_mps)
{
    const double range_m = hypot(x_m, y_m), sigma_m = 0.15;
    const double dx_m = sigma_m * normal(), dy_m = sigma_m * normal();
    struct rho_plot *plot = add_plot(x_m + dx_m, y_m + dy_m, sigma_m);
    const double rate_mps = 0.1 * normal();

    plot->range_rate_mps = (float)(speed_mps * x_m / range_m + rate_mps);
    plot->sigma_range_rate_mps = 0.1f;
}

/* Believed tracks near the place. */
static int num_in_room(double x_m, double y_m)
{
    int num = 0;

    for (unsigned i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];

        num += track->status != RHO_TRACK_TENTATIVE &&
               hypot((double)track->state[0] - x_m, (double)track->state[1] - y_m) < 1.0;
    }
    return num;
}

/* Someone walks out 8 m, stands for 6 s and walks on. */
static double walked_m(double t_s)
{
    return 1.2 * (fmin(t_s, 7.0) + fmax(t_s - 13.0, 0.0));
}

static void reflectors_in_a_room_hold_no_tracks(void **state)
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
                see_in_room(20.0 + 8.0 * i, 12.0 * (i % 3) - 15.0, 0.0);
            }
        }
        if (uniform(0.0, 1.0) < 0.9) {
            see_in_room(30.0 + walked_m(t_s), 25.0, stands ? 0.0 : 1.2);
        }
        for (int i = 0; i < 5; i++) {
            const double x_m = uniform(5.0, 70.0);

            see_in_room(x_m, uniform(-40.0, 40.0), uniform(-20.0, 20.0));
        }
        step_scan(
            (struct rho_scan){.time_us = llround(1e6 * t_s), .measures = RHO_MEASURES_RANGE_RATE});
        for (int i = 0; i < REFLECTORS; i++) {
            const int num = num_in_room(20.0 + 8.0 * i, 12.0 * (i % 3) - 15.0);

            early += k < 60 ? num : 0;
            late += k < 60 ? 0 : num;
        }
        walks += num_in_room(30.0 + walked_m(t_s), 25.0) == 1;
    }
    assert_true(early > REFLECTORS * 10); /* nothing tells them from targets that stand */
    assert_true(late <= 2);               /* 1 of 2040 */
    assert_true(walks > 380);             /* of 400 */
    assert_true(map_of()->exact_plots > 0.9f * map_of()->rate_plots);
}

/* ---- the same again -------------------------------------------------------------------------- */

static void the_same_scans_make_the_same_map(void **state)
{
    static struct rho_clutter_map first;
    int turn;

    (void)state;
    for (int k = 0; k < 2; k++) {
        turn = 0;
        memset(&tracker, k ? 0xa5 : 0, sizeof tracker);
        start(130, 30.0f);
        (void)turn_on(&turn, 40, 0.5, 20);
        if (k == 0) {
            first = *map_of();
        }
    }
    assert_memory_equal(&first, map_of(), sizeof first);
}

/* ---- sensors that go, and noise of millimetres ----------------------------------------------- */

/*
 * A sensor fills the map once, and is never heard again: the other one's towers find room all the
 * same.
 */
static void echoes_of_a_silent_sensor_make_room(void **state)
{
    const int num = RHO_MAX_ECHOES + 20 < RHO_MAX_PLOTS ? RHO_MAX_ECHOES + 20 : RHO_MAX_PLOTS;
    int turn = 1;

    (void)state;
    assert_true(num >= RHO_MAX_ECHOES);
    start(140, 30.0f);
    see_clutter(num);
    step_scan((struct rho_scan){.time_us = 0, .sensor_id = 7});
    (void)turn_on(&turn, 30, 1.0, 0);
    assert_int_equal(count_known_towers(), TOWERS);
}

static void echoes_of_millimetres_keep_their_variances(void **state)
{
    (void)state;
    start(141, 100.0f);
    for (int turn = 0; turn < 200; turn++) {
        for (int i = 0; i < TOWERS && turn % 20 < 3; i++) {
            (void)add_plot(tower_x_m(i), tower_y_m(i) + 0.001 * normal(), 0.001 * (i + 1));
        }
        step_at(TURN_S * turn + 0.0137 * (double)(turn * turn % 71));
        for (unsigned i = 0; i < RHO_MAX_ECHOES; i++) {
            const struct rho_echo *echo = &map_of()->echoes[i];

            assert_true(echo->along[0] >= 0.0f && echo->along[2] >= 0.0f);
            assert_true(echo->across[0] >= 0.0f && echo->across[2] >= 0.0f);
        }
        for (int i = 0; i < TOWERS && turn % 20 < 3; i++) {
            assert_true(isfinite(map_of()->denser[i]));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(echoes_of_a_silent_sensor_make_room),
        cmocka_unit_test(echoes_of_millimetres_keep_their_variances),
        cmocka_unit_test(known_towers_start_no_tracks),
        cmocka_unit_test(known_places_are_better_than_a_plot),
        cmocka_unit_test(a_target_that_passes_keeps_its_plots),
        cmocka_unit_test(the_chance_of_a_return_is_learned_and_forgotten),
        cmocka_unit_test(clutter_that_comes_nowhere_twice_has_no_chance),
        cmocka_unit_test(plots_of_a_tracked_target_teach_nothing),
        cmocka_unit_test(a_target_that_crawls_has_moved_in_the_end),
        cmocka_unit_test(what_was_learned_is_known_from_the_first_scan),
        cmocka_unit_test(towers_by_hand_start_no_tracks),
        cmocka_unit_test(taught_echoes_that_are_not_there_are_forgotten),
        cmocka_unit_test(what_nobody_looks_at_is_kept),
        cmocka_unit_test(bad_values_are_refused_untouched),
        cmocka_unit_test(a_full_map_drops_what_was_missed_most),
        cmocka_unit_test(more_are_taught_than_there_is_room_for),
        cmocka_unit_test(scans_of_more_plots_than_there_is_room_for),
        cmocka_unit_test(sectors_of_a_turn_look_once),
        cmocka_unit_test(what_stands_explains_no_fast_range_rate),
        cmocka_unit_test(reflectors_in_a_room_hold_no_tracks),
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
