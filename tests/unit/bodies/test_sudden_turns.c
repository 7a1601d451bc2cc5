/* SPDX-License-Identifier: MIT */
/*
 * A body that turns at once keeps its plots where their range rates say so, all together: just
 * beyond each limit, and not within it. The track is made by hand, with the private header.
 */
#include "../../src/bodies/bodies.h"
#include "../../src/tracker/plots.h"
#include "../../src/tracker/sensors.h"
#include "../../src/tracker/step.h"
#include "hand_made_look.h"

#if RHO_BODIES

/* A person at 4 m who walks away from the radar at 1 m/s, with usually six plots. */
static void make_person(void)
{
    use_usual_configs(1);
    config.v_max_mps = initiation.v_max_mps = 3.0f;
    config.accel_max_mps2 = 3.0f;
    begin_tracker();
    assert_int_equal(rho_tracker_set_body_max(&tracker, 0.8f), RHO_OK);
    tracker.tracks[0] = (struct rho_track){.track_id = 1,
                                           .status = RHO_TRACK_CONFIRMED,
                                           .hits = 100,
                                           .plot = -1,
                                           .updated_us = 900000};
    tracker.tracks[0].kalman.state[RHO_X] = 4.0f;
    tracker.tracks[0].kalman.state[RHO_VX] = 1.0f;
    for (int i = 0; i < 2; i++) {
        tracker.tracks[0].kalman.covariance[RHO_AT(i, i)] = 0.0025f;
        tracker.tracks[0].kalman.covariance[RHO_AT(3 + i, 3 + i)] = 0.01f;
    }
    tracker.bodies.of[0] = (struct rho_body_filter){.track_id = 1,
                                                    .along_m2 = 0.0144f,
                                                    .across_m2 = 0.0144f,
                                                    .cos_heading = 1.0f,
                                                    .has_heading = 1,
                                                    .most_plots = 6,
                                                    .plots_a_look = 6.0f,
                                                    .plots = 100.0f};
    tracker.num_tracks = tracker.bodies.count = 1;
}

/* A look with plots of two range rates about the person's place; returns the track's plots. */
static unsigned plots_after_look(unsigned turned, float turned_mps, unsigned usual)
{
    struct rho_groups *groups = &tracker.bodies.groups;
    unsigned owned = 0;
    num_plots = 0;
    for (unsigned i = 0; i < turned + usual; i++) {
        struct rho_plot *plot = add_plot(4.0 + 0.02 * (double)i, 0.05, 0.05);
        plot->range_rate_mps = i < turned ? turned_mps : 1.0f;
        plot->sigma_range_rate_mps = 0.1f;
    }
    begin_look(1000000, 0.05f);
    for (unsigned i = turned; i < num_plots; i++) {
        groups->owner[i] = 0;
    }
    rho_bodies_follow_turns(&at);
    for (unsigned i = 0; i < num_plots; i++) {
        owned += groups->owner[i] == 0;
    }
    return owned;
}

static float sigma_m2ps2(void)
{
    return tracker.tracks[0].kalman.covariance[RHO_AT(RHO_VX, RHO_VX)];
}

/* 0.35 s of the largest acceleration is one sigma of the change. */
static void all_plots_together_turn_a_body(void **state)
{
    (void)state;
    make_person();
    assert_int_equal(plots_after_look(6, -1.0f, 0), 6);
    assert_float_equal(sigma_m2ps2(), 0.01 + 1.05 * 1.05, 1e-5);
    make_person();
    assert_int_equal(plots_after_look(6, 1.3f, 0), 0); /* as usual, within the noise */
    assert_float_equal(sigma_m2ps2(), 0.01, 1e-6);
}

/* Each plot says 3 nat at most, and 6.5 are needed; of six usual plots a third, two, would do. */
static void three_plots_are_needed(void **state)
{
    (void)state;
    make_person();
    assert_int_equal(plots_after_look(2, -1.0f, 0), 0);
    assert_int_equal(plots_after_look(3, -1.0f, 0), 3);
    make_person();
    tracker.bodies.of[0].plots_a_look = 12.0f; /* a third of its usual plots: four */
    assert_int_equal(plots_after_look(3, -1.0f, 0), 0);
    assert_int_equal(plots_after_look(4, -1.0f, 0), 4);
    make_person();
    tracker.bodies.of[0].most_plots = 2;
    assert_int_equal(plots_after_look(6, -1.0f, 0), 0);
}

/* Another body beside this one turns nothing: this one's own plots are as ever. */
static void plots_as_usual_speak_against_a_turn(void **state)
{
    (void)state;
    make_person();
    assert_int_equal(plots_after_look(6, -1.0f, 4), 4);
    make_person();
    assert_int_equal(plots_after_look(6, -1.0f, 3), 9);
}

/* A track that missed two looks has no place to compare with; one missed look is common. */
static void a_lost_track_turns_no_more(void **state)
{
    (void)state;
    make_person();
    tracker.tracks[0].misses_in_row = 2;
    assert_int_equal(plots_after_look(6, -1.0f, 0), 0);
    tracker.tracks[0].misses_in_row = 1;
    assert_int_equal(plots_after_look(6, -1.0f, 0), 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_plots_together_turn_a_body),
        cmocka_unit_test(three_plots_are_needed),
        cmocka_unit_test(plots_as_usual_speak_against_a_turn),
        cmocka_unit_test(a_lost_track_turns_no_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
