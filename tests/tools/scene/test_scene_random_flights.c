/* SPDX-License-Identifier: MIT */
/*
 * Random flights of scenes: constant number in the air, within box and speed limits; how they begin
 * and end; meetings.
 */
#include "scene_text.h"

#define HALF_M 250000.0
#define STEP_S 10.0

static struct scene_path *flights_of(size_t flights, double crossing_share, double duration_s,
                                     uint64_t seed, size_t *count)
{
    char text[1024];
    struct scene *scene;
    struct scene_path *paths;

    snprintf(text, sizeof text,
             SCENE("%g", "{\"interval_s\": 10, \"sigma_m\": 50}",
                   ", \"targets\": [{\"flights\": %zu, \"box_m\": [-250e3, 250e3, -250e3, 250e3], "
                   "\"least_s\": 400, \"crossing_share\": %g}]"),
             duration_s, flights, crossing_share);
    scene = scene_of_text(text);
    paths = targets_draw_paths(&scene->targets, "test.json", duration_s, seed, 0, 0, count);
    scene_free(scene);
    return paths;
}

static void free_flights(struct scene_path *paths, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        path_free(&paths[i]);
    }
    free(paths);
}

static double speed_of(const struct motion *at)
{
    return hypot(at->vx_mps, at->vy_mps);
}

static void the_number_of_flights_in_the_air_is_constant(void **state)
{
    (void)state;
    size_t count;
    struct scene_path *paths = flights_of(50, 0.2, 3000, 1, &count);

    for (double t_s = 0.0; t_s < 3000.0; t_s += 7.3) {
        size_t there = 0;

        for (size_t i = 0; i < count; i++) {
            there += t_s >= paths[i].from_s && t_s < paths[i].until_s;
        }
        assert_int_equal(there, 50);
    }
    free_flights(paths, count);
}

/* Of 400 flights, as many begin in the first half as in the second. */
static void flights_begin_and_end_evenly_over_time(void **state)
{
    (void)state;
    size_t count, early = 0, late = 0;
    struct scene_path *paths = flights_of(400, 0.2, 4000, 1, &count);

    for (size_t i = 0; i < count; i++) {
        assert_true(paths[i].until_s - paths[i].from_s >= 400.0);
        assert_true(paths[i].until_s > 0.0 && paths[i].from_s <= 4000.0);
        early += paths[i].from_s > 0.0 && paths[i].from_s <= 2000.0;
        late += paths[i].from_s > 2000.0;
    }
    assert_true(early > 400);
    assert_near((double)early, (double)late, 4.0 * sqrt((double)(early + late)));
    free_flights(paths, count);
}

/* Shares of the steps, in straight flight, turns and speed changes. */
struct tally {
    double steps, turning, slow, changing;
};

static void check_step(const struct motion *from, const struct motion *to, struct tally *tally)
{
    double speed_mps = speed_of(to), change_mps = fabs(speed_mps - speed_of(from));
    double mean_mps = 0.5 * (speed_mps + speed_of(from));
    double turned_rad = fabs(remainder(
        atan2(to->vy_mps, to->vx_mps) - atan2(from->vy_mps, from->vx_mps), PORTABLE_TURN));
    double way_m = hypot(to->x_m - from->x_m, to->y_m - from->y_m);

    assert_true(fabs(to->x_m) <= HALF_M && fabs(to->y_m) <= HALF_M);
    assert_true(speed_mps >= 80.0 - 1e-6 && speed_mps <= 260.0 + 1e-6);
    assert_true(turned_rad <= STEP_S * 3.0 * PORTABLE_PI / 180.0 + 1e-9);
    /* 8 m/s^2 across, and up to 12 m/s for a speed change */
    assert_true(turned_rad * speed_mps <= STEP_S * 8.0 + 12.0);
    assert_true(change_mps <= STEP_S * 1.2 + 1e-6);
    /* the step's length is at most its speed's, and an arc of 30 degrees is 1.2 % shorter */
    assert_true(way_m <= STEP_S * (mean_mps + 6.0) && way_m >= 0.985 * STEP_S * (mean_mps - 6.0));
    tally->steps += 1.0;
    tally->turning += turned_rad > 1e-6;
    tally->slow += speed_mps < 150.0;
    tally->changing += change_mps > 1e-6;
}

static void flights_stay_within_box_speed_and_turn_limits(void **state)
{
    (void)state;
    size_t count;
    struct scene_path *paths = flights_of(200, 0.2, 2000, 1, &count);
    struct tally tally = {0};

    for (size_t i = 0; i < count; i++) {
        for (double t_s = paths[i].from_s; t_s + STEP_S < paths[i].until_s; t_s += STEP_S) {
            struct motion from = path_motion_at(&paths[i], t_s),
                          to = path_motion_at(&paths[i], t_s + STEP_S);

            check_step(&from, &to, &tally);
        }
    }
    print_message("turning %.3f, slow %.3f, changing speed %.3f\n", tally.turning / tally.steps,
                  tally.slow / tally.steps, tally.changing / tally.steps);
    assert_true(tally.turning > 0.1 * tally.steps && tally.turning < 0.4 * tally.steps);
    assert_true(tally.slow > 0.1 * tally.steps && tally.slow < 0.6 * tally.steps);
    assert_true(tally.changing > 0.1 * tally.steps && tally.changing < 0.7 * tally.steps);
    free_flights(paths, count);
}

/* Whether a flight is within one second of flight from the border. */
static bool is_at_border(const struct motion *at)
{
    return fmax(fabs(at->x_m), fabs(at->y_m)) > HALF_M - 261.0;
}

static void flights_begin_at_the_border_or_on_the_ground(void **state)
{
    (void)state;
    size_t count;
    struct scene_path *paths = flights_of(400, 0.2, 2000, 1, &count);
    double begun = (double)count, entered = 0.0, left = 0.0;

    for (size_t i = 0; i < count; i++) {
        struct motion first = path_motion_at(&paths[i], paths[i].from_s);
        struct motion last = path_motion_at(&paths[i], paths[i].until_s);
        bool enters = is_at_border(&first), leaves = is_at_border(&last);

        assert_true(enters || fabs(speed_of(&first) - 80.0) < 1e-6);
        assert_true(leaves || fabs(speed_of(&last) - 80.0) < 1e-6);
        entered += enters;
        left += leaves;
    }
    print_message("of %.0f %.0f enter, %.0f leave\n", begun, entered, left);
    assert_true(entered > 0.2 * begun && entered < 0.8 * begun);
    assert_true(left > 0.2 * begun && left < 0.8 * begun);
    free_flights(paths, count);
}

/* Counts pairs of flights that are within 1 km of each other at some scan. */
static size_t count_pairs_within_1_km(double crossing_share)
{
    size_t count, meetings = 0;
    struct scene_path *paths = flights_of(50, crossing_share, 3600, 1, &count);

    for (double t_s = 0.0; t_s < 3600.0; t_s += STEP_S) {
        for (size_t i = 0; i < count; i++) {
            struct motion at = path_motion_at(&paths[i], t_s);

            for (size_t j = 0; j < i && t_s >= paths[i].from_s && t_s < paths[i].until_s; j++) {
                struct motion other = path_motion_at(&paths[j], t_s);

                meetings += t_s >= paths[j].from_s && t_s < paths[j].until_s &&
                            hypot(at.x_m - other.x_m, at.y_m - other.y_m) < 1000.0;
            }
        }
    }
    free_flights(paths, count);
    return meetings;
}

static void crossing_share_sets_how_many_flights_meet(void **state)
{
    (void)state;
    size_t some = count_pairs_within_1_km(0.5), none = count_pairs_within_1_km(0.0);

    print_message("%zu scans of pairs within 1 km, %zu where nobody is sent to meet\n", some, none);
    assert_true(some >= 40 && none <= some / 3);
}

static void the_same_seed_gives_the_same_flights(void **state)
{
    (void)state;
    size_t one_count, again_count, other_count;
    struct scene_path *one = flights_of(20, 0.2, 600, 1, &one_count);
    struct scene_path *again = flights_of(20, 0.2, 600, 1, &again_count);
    struct scene_path *other = flights_of(20, 0.2, 600, 2, &other_count);
    struct motion first = path_motion_at(&one[0], 100.0), second = path_motion_at(&again[0], 100.0);
    struct motion third = path_motion_at(&other[0], 100.0);

    assert_int_equal(one_count, again_count);
    assert_memory_equal(&first, &second, sizeof first);
    assert_true(fabs(first.x_m - third.x_m) > 1.0);
    free_flights(one, one_count);
    free_flights(again, again_count);
    free_flights(other, other_count);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_number_of_flights_in_the_air_is_constant),
        cmocka_unit_test(flights_begin_and_end_evenly_over_time),
        cmocka_unit_test(flights_stay_within_box_speed_and_turn_limits),
        cmocka_unit_test(flights_begin_at_the_border_or_on_the_ground),
        cmocka_unit_test(crossing_share_sets_how_many_flights_meet),
        cmocka_unit_test(the_same_seed_gives_the_same_flights),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
