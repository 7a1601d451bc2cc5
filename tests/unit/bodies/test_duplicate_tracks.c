/* SPDX-License-Identifier: MIT */
/*
 * Of two tracks of one target one is left; two targets beside each other stay two. Tracks and their
 * plots are made by hand, with the private header; people and a truck drive in scenes.
 */
#include "../../src/bodies/bodies.h"
#include "../../src/tracker/clutter.h"
#include "../../src/tracker/plots.h"
#include "../../src/tracker/sensors.h"
#include "../../src/tracker/step.h"
#include "hand_made_look.h"

#if RHO_BODIES

#define LONGEST_M 10.0f
#define PLOTS_OF_TRACK 4u

/* A track that drives east at 10 m/s, with a body 4 m long and 2 m wide. */
static void make_track_with_body(unsigned row, float x_m, float y_m, unsigned hits)
{
    struct rho_track *track = &tracker.tracks[row];
    *track = (struct rho_track){
        .track_id = row + 1u, .status = RHO_TRACK_CONFIRMED, .hits = (uint16_t)hits, .plot = -1};
    track->kalman.state[RHO_X] = x_m;
    track->kalman.state[RHO_Y] = y_m;
    track->kalman.state[RHO_VX] = 10.0f;
    for (int i = 0; i < 2; i++) {
        track->kalman.covariance[RHO_AT(i, i)] = 0.01f;
        track->kalman.covariance[RHO_AT(3 + i, 3 + i)] = 0.01f;
    }
    tracker.bodies.of[row] = (struct rho_body_filter){.track_id = row + 1u,
                                                      .along_m2 = 16.0f / 12.0f,
                                                      .across_m2 = 4.0f / 12.0f,
                                                      .cos_heading = 1.0f,
                                                      .has_heading = 1,
                                                      .plots_a_look = (float)PLOTS_OF_TRACK,
                                                      .plots = 100.0f};
}

/* Two tracks, the second as far from the first. Both have given no evidence yet. */
static void make_two_tracks(float x_m, float y_m, unsigned hits)
{
    use_usual_configs(1);
    begin_tracker();
    assert_int_equal(rho_tracker_set_body_max(&tracker, LONGEST_M), RHO_OK);
    make_track_with_body(0, 100.0f, 0.0f, hits);
    make_track_with_body(1, 100.0f + x_m, y_m, hits);
    tracker.num_tracks = tracker.bodies.count = 2;
    memset(&report, 0, sizeof report);
}

/* A look with plots on the bodies of some tracks; the other plots are of no track. */
static void see_bodies(unsigned look, const float offsets_m[2], const float rates_mps[2])
{
    num_plots = 0;
    for (unsigned i = 0; i < 2u * PLOTS_OF_TRACK; i++) {
        const unsigned row = i / PLOTS_OF_TRACK;
        const float *state = tracker.tracks[row].kalman.state;
        const double along_m = uniform(-2.0, 2.0), across_m = uniform(-1.0, 1.0);
        struct rho_plot *plot = add_plot((double)(state[RHO_X] + offsets_m[row]) + along_m,
                                         (double)state[RHO_Y] + across_m, 0.2);
        plot->range_rate_mps = rates_mps[row];
        plot->sigma_range_rate_mps = 0.1f;
    }
    begin_look(50000 * (int64_t)look, 0.2f);
    for (unsigned i = 0; i < num_plots; i++) {
        tracker.bodies.groups.owner[i] = (uint16_t)(i / PLOTS_OF_TRACK);
    }
}

/* Looks until a track ends, with the same plots for both; 0: none ends within a thousand. */
static unsigned looks_until_one_ends(const float rates_mps[2])
{
    for (unsigned look = 1; look <= 1000; look++) {
        see_bodies(look, (const float[2]){0.0f, 0.0f}, rates_mps);
        rho_bodies_end_duplicates(&at);
        for (unsigned row = 0; row < 2; row++) {
            if (tracker.tracks[row].status == RHO_TRACK_FREE) {
                return look;
            }
        }
    }
    return 0;
}

static const float alike_mps[2] = {10.0f, 10.0f};

static void the_younger_of_two_tracks_of_one_car_ends(void **state)
{
    (void)state;
    make_two_tracks(0.5f, 0.0f, 1000);
    assert_in_range(looks_until_one_ends(alike_mps), 1, 5);
    assert_int_equal(tracker.tracks[0].status, RHO_TRACK_CONFIRMED);
    assert_int_equal(report.num_ended, 0); /* it was never confirmed */
    for (unsigned i = 0; i < 2u * PLOTS_OF_TRACK; i++) {
        assert_int_equal(tracker.bodies.groups.owner[i], 0); /* the older has all plots */
    }
    make_two_tracks(0.5f, 0.0f, 100); /* the one that was confirmed goes on */
    tracker.tracks[1].was_confirmed = 1;
    assert_in_range(looks_until_one_ends(alike_mps), 1, 5);
    assert_int_equal(tracker.tracks[0].status, RHO_TRACK_FREE);
}

static void cars_apart_stay_two(void **state)
{
    (void)state;
    make_two_tracks(0.0f, 3.5f, 1000); /* in the next lane */
    assert_int_equal(looks_until_one_ends(alike_mps), 0);
    make_two_tracks(7.0f, 0.0f, 1000); /* in the same lane: together longer than any body */
    assert_int_equal(looks_until_one_ends(alike_mps), 0);
    make_two_tracks(0.0f, 2.0f, 1000); /* one passes the other: their range rates differ */
    tracker.tracks[1].kalman.state[RHO_VX] = 13.0f;
    assert_int_equal(looks_until_one_ends((const float[2]){10.0f, 13.0f}), 0);
}

/*
 * A person's limbs have range rates of their own, and each of two tracks of him takes those that
 * suit it: as far apart as twice the noise explains they are one, farther apart they are two.
 */
static void tracks_of_one_body_may_share_its_range_rates(void **state)
{
    (void)state;
    for (int is_faster = 0; is_faster <= 1; is_faster++) {
        const float apart_mps = is_faster ? 1.5f : 0.4f;
        unsigned ended = 0;
        make_two_tracks(0.2f, 0.0f, 1000);
        for (unsigned row = 0; row < 2; row++) {
            float *velocity_mps = &tracker.tracks[row].kalman.state[RHO_VX];
            *velocity_mps = 10.0f + ((float)row - 0.5f) * apart_mps;
            tracker.tracks[row].kalman.covariance[RHO_AT(RHO_VX, RHO_VX)] = 1e-4f;
        }
        for (unsigned look = 1; look <= 200 && !ended; look++) {
            see_bodies(look, (const float[2]){0.0f, 0.0f}, alike_mps);
            for (unsigned i = 0; i < num_plots; i++) {
                const float mean_mps = tracker.tracks[i / PLOTS_OF_TRACK].kalman.state[RHO_VX];
                plots[i].range_rate_mps = mean_mps + (float)uniform(-0.15, 0.15);
            }
            rho_bodies_end_duplicates(&at);
            ended = tracker.tracks[1].status == RHO_TRACK_FREE;
        }
        assert_int_equal(ended, !is_faster);
    }
}

/* Long apart, and no plot is contended for: the pair is not asked; else it is. */
static void who_was_long_apart_is_asked_where_plots_are_contested(void **state)
{
    (void)state;
    for (int is_contested = 0; is_contested < 2; is_contested++) {
        uint32_t spent = 0;
        make_two_tracks(0.5f, 0.0f, 1000);
        tracker.bodies.of[1].two_nat = 60.0f;
        for (unsigned look = 1; look <= 200 && tracker.tracks[1].status; look++) {
            see_bodies(look, (const float[2]){0.0f, 0.0f}, alike_mps);
            tracker.bodies.groups.contender[5] = is_contested ? 0 : UINT16_MAX;
            rho_bodies_end_duplicates(&at);
            spent += at.work.spent;
        }
        assert_int_equal(tracker.tracks[1].status == RHO_TRACK_FREE, is_contested);
        assert_int_equal(spent > 2000, is_contested);
    }
}

/* Bumper to bumper two cars are as long as a lorry: known as two they stay, else they do not. */
static void what_is_known_to_be_two_stays_two(void **state)
{
    (void)state;
    for (int is_known = 0; is_known < 2; is_known++) {
        unsigned ended = 0;
        make_two_tracks(4.3f, 0.0f, 1000);
        tracker.bodies.of[1].two_nat = is_known ? 60.0f : 0.0f;
        for (unsigned look = 1; look <= 1000 && !ended; look++) {
            see_bodies(look, (const float[2]){0.0f, 0.0f}, alike_mps);
            scan.measures = 0; /* range rates would tell them: a lorry turns now and then */
            rho_bodies_end_duplicates(&at);
            ended = tracker.tracks[1].status == RHO_TRACK_FREE;
        }
        assert_int_equal(ended, !is_known);
    }
}

/* Apart from all others a track becomes known in thirty looks, and no better known than that. */
static void a_track_apart_becomes_known(void **state)
{
    (void)state;
    make_two_tracks(100.0f, 0.0f, 1000);
    for (unsigned look = 1; look <= 40; look++) {
        see_bodies(look, (const float[2]){0.0f, 0.0f}, alike_mps);
        rho_bodies_end_duplicates(&at);
        assert_float_equal(tracker.bodies.of[1].two_nat, look < 30 ? 2.0f * (float)look : 60.0f,
                           1e-3);
    }
}

/* Unseen is not apart: without plots nothing is learned. */
static void a_look_without_plots_says_nothing(void **state)
{
    (void)state;
    make_two_tracks(0.5f, 0.0f, 1000);
    for (unsigned look = 1; look <= 40; look++) {
        see_bodies(look, (const float[2]){500.0f, 500.0f}, alike_mps);
        memset(tracker.bodies.groups.owner, 0xff, sizeof tracker.bodies.groups.owner);
        rho_bodies_end_duplicates(&at);
    }
    assert_float_equal(tracker.bodies.of[1].two_nat, 0.0f, 0.0f);
    assert_int_equal(tracker.tracks[1].status, RHO_TRACK_CONFIRMED);
}

/* Where the step's work is used up, not all plots are asked, and no track ends. */
static void a_look_beyond_the_work_says_nothing(void **state)
{
    (void)state;
    make_two_tracks(0.5f, 0.0f, 1000);
    for (unsigned look = 1; look <= 40; look++) {
        see_bodies(look, (const float[2]){0.0f, 0.0f}, alike_mps);
        at.work.spent = at.work.share.end = 10;
        rho_bodies_end_duplicates(&at);
    }
    assert_float_equal(tracker.bodies.of[1].two_nat, 0.0f, 0.0f);
}

/* A scan that is out of sequence says nothing. */
static void late_scans_end_no_track(void **state)
{
    (void)state;
    make_two_tracks(0.5f, 0.0f, 1000);
    for (unsigned look = 1; look <= 100; look++) {
        see_bodies(look, (const float[2]){0.0f, 0.0f}, alike_mps);
        at.look.teaches = 0;
        rho_bodies_end_duplicates(&at);
    }
    assert_int_equal(tracker.tracks[1].status, RHO_TRACK_CONFIRMED);
    assert_float_equal(tracker.bodies.of[1].two_nat, 0.0f, 0.0f);
}

/* Makes an older track that misses, and a new one beside it whose velocity differs. */
static void make_lost_and_new_track(unsigned missed, unsigned hits, float dvx_mps)
{
    make_two_tracks(-2.0f, 0.0f, 1000);
    tracker.tracks[0].misses_in_row = (uint8_t)missed;
    tracker.tracks[0].was_confirmed = 1;
    tracker.tracks[0].is_operators = 1;
    tracker.tracks[1].hits = (uint16_t)hits;
    tracker.tracks[1].kalman.state[RHO_VX] += dvx_mps;
    for (unsigned look = 1; look <= 20 && tracker.tracks[1].status != RHO_TRACK_FREE; look++) {
        const float rate_mps = 10.0f + dvx_mps;
        see_bodies(look, (const float[2]){-100.0f, 0.0f}, (const float[2]){rate_mps, rate_mps});
        for (unsigned i = 0; i < PLOTS_OF_TRACK; i++) {
            tracker.bodies.groups.owner[i] = RHO_NO_ROW; /* of the older: none is seen */
        }
        rho_bodies_end_duplicates(&at);
    }
}

/* Its target has turned: 0.35 s of the largest acceleration is a sigma, three of them the most. */
static void a_lost_track_goes_on_with_the_estimate_of_a_new_one(void **state)
{
    (void)state;
    use_usual_configs(1);
    const float most_mps = 3.0f * 0.35f * config.accel_max_mps2;
    make_lost_and_new_track(4, 4, -0.9f * most_mps);
    assert_int_equal(tracker.tracks[1].status, RHO_TRACK_FREE);
    assert_int_equal(tracker.tracks[0].track_id, 1);
    assert_int_equal(tracker.tracks[0].hits, 1000);
    assert_int_equal(tracker.tracks[0].is_operators, 1); /* what is the track's own stays */
    assert_int_equal(tracker.tracks[0].was_confirmed, 1);
    assert_float_equal(tracker.tracks[0].kalman.state[RHO_X], 98.0f, 0.0f);
    assert_float_equal(tracker.tracks[0].kalman.state[RHO_VX], 10.0f - 0.9f * most_mps, 1e-3);
    assert_int_equal(report.num_ended, 0);           /* no number that was shown has ended */
    make_lost_and_new_track(4, 4, -1.1f * most_mps); /* no turn explains it */
    assert_int_equal(tracker.tracks[1].status, RHO_TRACK_CONFIRMED);
    make_lost_and_new_track(4, 6, -0.9f * most_mps); /* both were seen at once */
    assert_int_equal(tracker.tracks[1].status, RHO_TRACK_CONFIRMED);
    make_lost_and_new_track(0, 1, -0.9f * most_mps);
    assert_int_equal(tracker.tracks[1].status, RHO_TRACK_CONFIRMED);
}

/* ---- in a scene ------------------------------------------------------------------------------ */

/* Without this rule, a truck that appears suddenly starts two tracks in one of ten runs. */
static void a_suddenly_appearing_truck_has_one_track(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        use_usual_configs(seed);
        config.v_max_mps = initiation.v_max_mps = 50.0f;
        begin_tracker();
        assert_int_equal(rho_tracker_set_body_max(&tracker, 15.0f), RHO_OK);
        for (int k = 0; k < 80; k++) {
            for (int i = 0; i < 8; i++) {
                if (uniform(0.0, 1.0) < 0.6) {
                    add_noisy_plot(40.0 + 0.25 * k + 1.6 * i, i % 2 ? 1.25 : -1.25, 0.3);
                }
            }
            step_at(0.05 * k);
        }
        assert_int_equal(report.num_tracks, 1);
    }
}

/* ---- people before a radar of 10 Hz, 15 plots each ------------------------------------------- */

struct person {
    double x_m, y_m, vx_mps, vy_mps;
};

static void see_person(const struct person *person, unsigned count)
{
    const double range_m = hypot(person->x_m, person->y_m);
    for (unsigned i = 0; i < count; i++) {
        const double sigma_m = 0.13; /* of a place on the body, with noise */
        const double dx_m = sigma_m * normal(), dy_m = sigma_m * normal();
        struct rho_plot *plot = add_plot(person->x_m + dx_m, person->y_m + dy_m, 0.05);
        plot->range_rate_mps =
            (float)((person->x_m * person->vx_mps + person->y_m * person->vy_mps) / range_m +
                    0.3 * normal());
        plot->sigma_range_rate_mps = 0.3f;
    }
}

static void begin_room(uint64_t seed)
{
    use_usual_configs(seed);
    config.v_max_mps = initiation.v_max_mps = 3.0f;
    config.accel_max_mps2 = 3.0f;
    begin_tracker();
    assert_int_equal(rho_tracker_set_body_max(&tracker, 0.8f), RHO_OK);
}

static void step_room(int look)
{
    step_scan(
        (struct rho_scan){.time_us = 100000 * (int64_t)look, .measures = RHO_MEASURES_RANGE_RATE});
}

static void two_people_side_by_side_are_two_tracks(void **state)
{
    (void)state;
    unsigned right = 0;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        begin_room(seed);
        for (int k = 0; k < 100; k++) {
            const struct person one = {4.0, -2.5 + 0.05 * k, 0.0, 0.5},
                                other = {4.6, -2.5 + 0.05 * k, 0.0, 0.5};
            see_person(&one, 15);
            see_person(&other, 15);
            step_room(k);
            right += k >= 20 && report.num_tracks == 2;
        }
    }
    assert_true(right > 360);
}

/* Nine turns back at once, as at a wall: one track, with one number. */
static void a_person_who_turns_back_at_once_keeps_the_track(void **state)
{
    (void)state;
    unsigned right = 0;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        begin_room(seed);
        struct person walker = {2.0, 0.5, 1.2, 0.3};
        for (int k = 0; k < 200; k++) {
            walker.vx_mps *= k % 20 == 19 ? -1.0 : 1.0;
            walker.vy_mps *= k % 40 == 39 ? -1.0 : 1.0;
            walker.x_m += 0.1 * walker.vx_mps;
            walker.y_m += 0.1 * walker.vy_mps;
            see_person(&walker, 15);
            step_room(k);
            right += report.num_tracks == 1 && tracker.tracks[0].track_id == 1;
        }
    }
    assert_true(right > 960);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_younger_of_two_tracks_of_one_car_ends),
        cmocka_unit_test(cars_apart_stay_two),
        cmocka_unit_test(tracks_of_one_body_may_share_its_range_rates),
        cmocka_unit_test(who_was_long_apart_is_asked_where_plots_are_contested),
        cmocka_unit_test(what_is_known_to_be_two_stays_two),
        cmocka_unit_test(a_track_apart_becomes_known),
        cmocka_unit_test(a_look_without_plots_says_nothing),
        cmocka_unit_test(a_look_beyond_the_work_says_nothing),
        cmocka_unit_test(late_scans_end_no_track),
        cmocka_unit_test(a_lost_track_goes_on_with_the_estimate_of_a_new_one),
        cmocka_unit_test(a_suddenly_appearing_truck_has_one_track),
        cmocka_unit_test(two_people_side_by_side_are_two_tracks),
        cmocka_unit_test(a_person_who_turns_back_at_once_keeps_the_track),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
