/* SPDX-License-Identifier: MIT */
/*
 * Operations on single echoes and their statistics, below the clutter map: an echo is compared with
 * a Kalman filter in double precision, counts with results by hand.
 */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/detail/recurring_clutter_map.h"

#define PI 3.14159265358979323846
#define V_MIN_MPS 20.0f
#define ALL_REGIONS (RHO_ECHO_TABLES - 1)

static struct rho_clutter_map map;

static void init_map(void)
{
    memset(&map, 0, sizeof map);
    rho_clutter_map_init(&map, V_MIN_MPS);
}

static struct rho_plot plot_at(float x_m, float y_m)
{
    return (struct rho_plot){
        .x_m = x_m, .y_m = y_m, .sigma_range_m = 10.0f, .sigma_cross_m = 40.0f};
}

static void a_place_is_viewed_by_direction_and_range(void **state)
{
    const struct rho_sensor sensor = {.x_m = 100.0f, .y_m = -50.0f};
    const struct echo_view view = rho_clutter_map_view(&sensor, 100.0f, 950.0f);
    const struct echo_view at_origin = rho_clutter_map_view(NULL, -3.0f, 0.0f);
    const struct echo_view none = rho_clutter_map_view(&sensor, 100.0f, -50.0f);

    (void)state;
    assert_true(view.along_x == 0.0f && view.along_y == 1.0f && view.range_m == 1000.0f);
    assert_true(fabsf(rho_clutter_map_azimuth_turns(&view) - 0.75f) < 1e-6f);
    assert_true(at_origin.along_x == -1.0f && at_origin.range_m == 3.0f);
    assert_true(none.range_m == 0.0f);
}

/* There are as many divisions in direction as in range; all regions must be met. */
static void regions_divide_directions_and_ranges(void **state)
{
    uint32_t met = 0;

    (void)state;
    for (int i = 0; i < 400; i++) {
        const double azimuth_rad = 2.0 * PI * i / 400.0, range_m = 1e4 * ((i * 7) % 400) / 400.0;
        const unsigned region = rho_clutter_map_region_at(
            NULL, 1e4f, (float)(range_m * cos(azimuth_rad)), (float)(range_m * sin(azimuth_rad)));

        assert_in_range(region, 0, RHO_ECHO_REGIONS * RHO_ECHO_REGIONS - 1);
        met |= 1u << (region % 32u);
    }
    assert_true(met == (RHO_ECHO_REGIONS * RHO_ECHO_REGIONS >= 32
                            ? UINT32_MAX
                            : (1u << RHO_ECHO_REGIONS * RHO_ECHO_REGIONS) - 1u));
    assert_int_equal(rho_clutter_map_region_at(NULL, 1e4f, 5e4f, 1.0f),
                     /* beyond the range: as at its end */
                     rho_clutter_map_region_at(NULL, 1e4f, 9.99e3f, 1.0f));
}

static void hits_are_grouped_into_four_classes(void **state)
{
    static const unsigned expected[] = {0, 0, 1, 2, 2, 2, 3, 3};

    (void)state;
    for (unsigned hits = 0; hits < sizeof expected / sizeof expected[0]; hits++) {
        assert_int_equal(rho_clutter_map_hit_class(hits), expected[hits]);
    }
    assert_int_equal(rho_clutter_map_hit_class(UINT16_MAX), 3);
    assert_int_equal(rho_clutter_map_hit_class(RHO_ECHO_KNOWN_HITS), 3);
    assert_int_equal(rho_clutter_map_hit_class(RHO_ECHO_KNOWN_HITS - 1), 2);
}

/* Ten looks at an echo of one hit, each with a weight of a half, of which four saw it again. */
static void return_probabilities_follow_counts_after_a_block(void **state)
{
    const struct rho_echo echo = {.hits = 1, .unseen = 1, .weight = 0.5f, .region = 0};
    float before, after;

    (void)state;
    init_map();
    before = rho_clutter_map_return_probability(&map, 0, 1, 1);
    for (int i = 0; i < 10; i++) {
        rho_clutter_map_count_look(&map, &echo);
        if (i < 4) {
            rho_clutter_map_count_return(&map, &echo);
        }
    }
    assert_true(rho_clutter_map_return_probability(&map, 0, 1, 1) ==
                before); /* counts are used from the next block on */
    for (int i = 0; i < 4; i++) {
        assert_true(rho_clutter_map_return_probability(&map, 0, 1, 1) == before);
        rho_clutter_map_age_counts(&map, 1.0f);
    }
    after = rho_clutter_map_return_probability(&map, 0, 1, 1);
    assert_true(after > 2.0f * before && after < 0.2f + before); /* moves towards 2 of 10 */
    assert_true(rho_clutter_map_return_probability(&map, 0, 2, 1) ==
                rho_clutter_map_return_probability(&map, 1, 2, 1));

    /* a moving target's returns are removed, down to 0 */
    const float returns[RHO_ECHO_HIT_CLASSES] = {100.0f};
    rho_clutter_map_remove_returns(&map, 0, returns);
    assert_true(rho_clutter_map_return_probability(&map, 0, 1, 1) < before);
    assert_true(map.tables[0][0].returns[0][0] >= 0.0f);
}

/* Counts decay to a half within some 139 revolutions. */
static void counts_halve_in_about_139_revolutions(void **state)
{
    const struct rho_echo echo = {.hits = 1, .region = 0};
    double kept = 1.0;
    int turns = 0;

    (void)state;
    assert_true(rho_clutter_map_decay_factor(0.0f) == 1.0f);
    while (kept > 0.5) {
        kept *= (double)rho_clutter_map_decay_factor(1.0f);
        turns++;
    }
    assert_in_range(turns, 130, 145);
    init_map();
    rho_clutter_map_count_look(&map, &echo);
    for (int i = 0; i < 4 + turns; i++) {
        rho_clutter_map_age_counts(&map, 1.0f);
    }
    assert_true(fabsf(map.tables[0][ALL_REGIONS].looks[0][0] - 0.5f) < 0.03f);
}

/* A Kalman filter of place and speed on one axis, in double precision. */
struct axis {
    double place, speed, pp, ps, ss;
};

static void predict_reference_axis(struct axis *axis, double dt_s)
{
    axis->place += dt_s * axis->speed;
    axis->pp += dt_s * (2.0 * axis->ps + dt_s * axis->ss);
    axis->ps += dt_s * axis->ss;
}

static void update_reference_axis(struct axis *axis, double measured, double variance)
{
    const double gain_place = axis->pp / (axis->pp + variance);
    const double gain_speed = axis->ps / (axis->pp + variance);
    const double off = measured - axis->place;

    axis->place += gain_place * off;
    axis->speed += gain_speed * off;
    axis->ss -= gain_speed * axis->ps;
    axis->ps *= 1.0 - gain_place;
    axis->pp = (1.0 - gain_place) * axis->pp + 0.02 * variance;
}

/* The echo is due east of the radar: along the line of sight is x, across it is y. */
static void an_echo_agrees_with_a_kalman_filter_along_and_across(void **state)
{
    struct axis x = {5000.0, 0.0, 100.0, 0.0, 64.0}, y = {0.0, 0.0, 1600.0, 0.0, 64.0};
    struct rho_plot plot = plot_at(5000.0f, 0.0f);
    struct rho_echo echo;

    (void)state;
    init_map();
    rho_clutter_map_start_echo(&map, &echo, 7, 1000000, &plot);
    assert_int_equal(echo.sensor_id, 7);
    assert_int_equal(echo.hits, 1);
    for (int k = 1; k <= 6; k++) {
        plot = plot_at(5000.0f + (float)(k % 3) * 4.0f, (float)(k % 2) * 0.1f);
        rho_clutter_map_predict_echo(&echo, 1000000 + INT64_C(4000000) * k);
        echo.unseen = 3;
        rho_clutter_map_update_echo(&echo, NULL, &plot);
        predict_reference_axis(&x, 4.0);
        predict_reference_axis(&y, 4.0);
        update_reference_axis(&x, (double)plot.x_m, 100.0);
        update_reference_axis(&y, (double)plot.y_m, 1600.0);
        assert_int_equal(echo.hits, k + 1);
        assert_int_equal(echo.unseen, 0);
        assert_true(fabs(echo.x_m - x.place) < 0.05 && fabs(echo.y_m - y.place) < 0.05);
        assert_true(fabs(echo.vx_mps - x.speed) < 0.02);
        assert_true(fabs(echo.along[0] - x.pp) < 1e-3 * x.pp);
        assert_true(fabs(echo.across[0] - y.pp) < 1e-3 * y.pp);
        assert_true(fabs(echo.along[2] - x.ss) < 1e-3 * 64.0);
    }
}

/* An echo is lost after more misses than `kept`, which grows with its hits. */
static void echoes_with_more_hits_are_kept_longer(void **state)
{
    static const struct {
        uint16_t hits;
        uint8_t kept;
    } cases[] = {{1, 12}, {2, 16}, {3, 30}, {5, 30}, {6, 100}, {UINT16_MAX, 100}};

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct rho_echo echo = {.hits = cases[i].hits, .unseen = cases[i].kept};

        assert_false(rho_clutter_map_is_echo_lost(&echo));
        echo.unseen++;
        assert_true(rho_clutter_map_is_echo_lost(&echo));
    }
}

/*
 * In a full table the echoes with the most misses for their hits are dropped, while those just seen
 * stay.
 */
static void echoes_with_most_misses_are_dropped_first(void **state)
{
    unsigned left = 0;

    (void)state;
    init_map();
    for (unsigned i = 0; i < RHO_ECHO_PLACES; i++) {
        map.echoes[i] = (struct rho_echo){.hits = (uint16_t)(i % 2 ? 10 : 2),
                                          .unseen = (uint8_t)(i % 4 < 2 ? 0 : 5),
                                          .was_looked_at = 1};
    }
    rho_clutter_map_free_places(&map, 1, 0);
    assert_int_equal(map.echoes_dropped, RHO_ECHO_PLACES > 2 ? 1 : 0);
    rho_clutter_map_free_places(&map, RHO_ECHO_PLACES, 0);
    for (unsigned i = 0; i < RHO_ECHO_PLACES; i++) {
        assert_int_equal(map.echoes[i].hits > 0, i % 4 < 2);
        left += map.echoes[i].hits > 0;
    }
    assert_int_equal(map.echoes_dropped, RHO_ECHO_PLACES - left);
}

/*
 * All echoes of a full map were just seen: the taught one is dropped and counted. Once an echo was
 * missed it is replaced.
 */
static void a_taught_echo_does_not_replace_one_just_seen(void **state)
{
    static struct rho_clutter_map before;

    (void)state;
    init_map();
    for (unsigned i = 0; i < RHO_ECHO_PLACES; i++) {
        map.echoes[i] = (struct rho_echo){.hits = 1, .was_looked_at = 1};
    }
    before = map;
    assert_int_equal(rho_clutter_map_teach(&map, 7, 100.0f, 200.0f, 30.0f, 30.0f, UINT16_MAX),
                     RHO_OK);
    assert_int_equal(map.echoes_dropped, before.echoes_dropped + 1u);
    before.echoes_dropped = map.echoes_dropped;
    assert_memory_equal(&map, &before, sizeof map);
    map.echoes[0].unseen = 1;
    assert_int_equal(rho_clutter_map_teach(&map, 7, 100.0f, 200.0f, 30.0f, 30.0f, UINT16_MAX),
                     RHO_OK);
    assert_int_equal(map.echoes[0].sensor_id, 7);
    assert_int_equal(map.echoes_dropped, before.echoes_dropped + 1u);
}

static void a_damaged_map_is_not_sound(void **state)
{
    const struct rho_plot plot = plot_at(5000.0f, 0.0f);
    static struct rho_clutter_map sound;

    (void)state;
    init_map();
    rho_clutter_map_start_echo(&map, &map.echoes[0], 7, 1000000, &plot);
    assert_true(rho_clutter_map_is_sound(&map));
    sound = map;
    map.echoes[0].x_m = NAN;
    assert_false(rho_clutter_map_is_sound(&map));
    map = sound;
    map.first_echo = RHO_ECHO_PLACES;
    assert_false(rho_clutter_map_is_sound(&map));
    map = sound;
    map.tables[2][ALL_REGIONS].looks[3][4] = INFINITY;
    assert_false(rho_clutter_map_is_sound(&map));
    map = sound;
    map.exact_plots = map.rate_plots + 1.0f;
    assert_false(rho_clutter_map_is_sound(&map));
    map = sound;
    map.time_us = INT64_MAX;
    assert_false(rho_clutter_map_is_sound(&map));
}

/*
 * The prior for targets that may stand is 0.003 with a weight of three looks, for all regions; the
 * result is the prior of one region with a weight of two.
 */
static void prior_of_returns_is_lower_if_targets_may_stand_still(void **state)
{
    static const double looks[] = {0.0, 40.0}, returns[] = {0.0, 12.0};
    (void)state;
    for (int i = 0; i < 4; i++) {
        init_map();
        map.v_min_mps = i < 2 ? 0.0f : V_MIN_MPS;
        struct rho_echo_returns *all = &map.tables[0][ALL_REGIONS], *here = &map.tables[0][0];
        all->looks[3][0] = 2.0f * (float)looks[i % 2];
        all->returns[3][0] = 3.0f * (float)returns[i % 2];
        here->looks[3][0] = (float)looks[i % 2];
        here->returns[3][0] = (float)returns[i % 2];
        const double prior = i < 2 ? 0.003 : 0.2;
        const double mean = (3.0 * returns[i % 2] + 3.0 * prior) / (2.0 * looks[i % 2] + 3.0);
        assert_float_equal(rho_clutter_map_return_probability(&map, 0, 20, 1),
                           (returns[i % 2] + 2.0 * mean) / (looks[i % 2] + 2.0), 1e-6);
        here->looks[3][0] = here->returns[3][0] = all->looks[3][0] = all->returns[3][0] = 1e6f;
        assert_float_equal(rho_clutter_map_return_probability(&map, 0, 20, 1), 0.98, 1e-6);
    }
}

static void an_echo_counts_as_moving_from_four_sigmas_of_speed(void **state)
{
    struct rho_echo echo = {.along = {1.0f, 0.0f, 3.0f}, .across = {1.0f, 0.0f, 1.0f}};
    (void)state;
    echo.vx_mps = 7.9f;
    assert_true(rho_clutter_map_is_echo_standing(&echo));
    echo.vx_mps = 8.1f;
    assert_false(rho_clutter_map_is_echo_standing(&echo));
}

static void at_most_a_billion_looks_can_be_taught(void **state)
{
    (void)state;
    init_map();
    assert_int_equal(rho_clutter_map_teach_returns(&map, 0, 1, 1, 1e9f, 0.0f), RHO_OK);
    assert_int_equal(rho_clutter_map_teach_returns(&map, 0, 1, 1, 1.01e9f, 0.0f), RHO_ERROR_VALUE);
}

#if RHO_MAX_ECHOES > 2

/* Number of the echo, 0 or 1, that a full map drops. */
static int dropped_echo_of(struct rho_echo first, struct rho_echo second)
{
    init_map();
    for (unsigned i = 0; i < RHO_ECHO_PLACES; i++) {
        map.echoes[i] = (struct rho_echo){.hits = 9, .was_looked_at = 1};
    }
    map.echoes[0] = first;
    map.echoes[1] = second;
    rho_clutter_map_free_places(&map, 1, 1000000000);
    assert_int_equal(map.echoes[0].hits == 0, map.echoes[1].hits != 0);
    return map.echoes[1].hits == 0;
}

/*
 * The order is by eighths of misses a hit, with at most 16 hits; a minute without a look counts as
 * a miss.
 */
static void echoes_with_more_misses_a_hit_are_dropped_first(void **state)
{
    const struct rho_echo often = {.hits = 40, .unseen = 10, .was_looked_at = 1},
                          less = {.hits = 16, .unseen = 8, .was_looked_at = 1},
                          seldom = {.hits = 8, .unseen = 3, .was_looked_at = 1},
                          more = {.hits = 16, .unseen = 5, .was_looked_at = 1},
                          missed_6 = {.hits = 16, .unseen = 6, .was_looked_at = 1},
                          missed_3 = {.hits = 16, .unseen = 3, .was_looked_at = 1},
                          not_looked_at = {.hits = 16, .time_us = 1000000000 - 250000000},
                          of_later = {.hits = 16, .time_us = RHO_LIMIT_TIME_US};
    (void)state;
    assert_int_equal(dropped_echo_of(often, less), 0);
    assert_int_equal(dropped_echo_of(seldom, more), 0);
    assert_int_equal(dropped_echo_of(not_looked_at, missed_6), 1);
    assert_int_equal(dropped_echo_of(not_looked_at, missed_3), 0);
    /* of a time to come, as an image of a tracker may hold it: one miss */
    assert_int_equal(dropped_echo_of(of_later, missed_3), 1);
    /* from 64 eighths on echoes are equal, and the later one is dropped */
    const struct rho_echo once_5 = {.hits = 1, .unseen = 5, .was_looked_at = 1},
                          once_7 = {.hits = 1, .unseen = 7, .was_looked_at = 1},
                          once_8 = {.hits = 1, .unseen = 8, .was_looked_at = 1},
                          once_9 = {.hits = 1, .unseen = 9, .was_looked_at = 1};
    assert_int_equal(dropped_echo_of(once_7, once_5), 0);
    assert_int_equal(dropped_echo_of(once_9, once_8), 1);
}

#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_place_is_viewed_by_direction_and_range),
        cmocka_unit_test(regions_divide_directions_and_ranges),
        cmocka_unit_test(hits_are_grouped_into_four_classes),
        cmocka_unit_test(return_probabilities_follow_counts_after_a_block),
        cmocka_unit_test(counts_halve_in_about_139_revolutions),
        cmocka_unit_test(an_echo_agrees_with_a_kalman_filter_along_and_across),
        cmocka_unit_test(echoes_with_more_hits_are_kept_longer),
        cmocka_unit_test(echoes_with_most_misses_are_dropped_first),
        cmocka_unit_test(a_taught_echo_does_not_replace_one_just_seen),
        cmocka_unit_test(a_damaged_map_is_not_sound),
        cmocka_unit_test(prior_of_returns_is_lower_if_targets_may_stand_still),
        cmocka_unit_test(an_echo_counts_as_moving_from_four_sigmas_of_speed),
        cmocka_unit_test(at_most_a_billion_looks_can_be_taught),
#if RHO_MAX_ECHOES > 2
        cmocka_unit_test(echoes_with_more_misses_a_hit_are_dropped_first),
#endif
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
