/* SPDX-License-Identifier: MIT */
/*
 * The plots of a body show two targets beyond each limit of the evidence, and one target within it.
 * Lengths are tested from outside. For range rates, tracks and their bodies are made by hand, which
 * takes the private header: those of a scene never stand at a limit.
 *
 * Sums fade by 1 / 80 a look: n looks in a row count S(n) = 80 (1 - (79 / 80)^n) looks.
 */
#include "../../src/tracker/step.h"
#include "rhotrack/body.h"
#include "tracker_setup.h"

#if RHO_BODIES

#define LONGEST_M 10.0

static void prepare(void)
{
    use_usual_configs(1);
    config.v_max_mps = initiation.v_max_mps = 60.0f;
    begin_tracker();
    assert_int_equal(rho_tracker_set_body_max(&tracker, (float)LONGEST_M), RHO_OK);
}

/* ---- length ---------------------------------------------------------------------------------- */

#define STEP_S 0.1
#define SPEED_MPS 15.0
#define PLAIN_M 9.0 /* a length that one body may have */
#define LONG_M 13.0 /* a length that no body has */

static int num_looks;

/* A scan of a truck that drives away from the radar: plots of rear and front with 0.5 m noise. */
static void see_truck(double length_m)
{
    const double x_m = 100.0 + SPEED_MPS * STEP_S * num_looks;
    for (int end = -1; end <= 1; end += 2) {
        struct rho_plot *plot = add_plot(x_m + 0.5 * length_m * end, 0.0, 0.5);
        plot->vx_mps = (float)SPEED_MPS;
        plot->sigma_mps = 1.0f;
    }
    step_scan((struct rho_scan){.time_us = llround(1e6 * STEP_S * num_looks++),
                                .measures = RHO_MEASURES_VELOCITY});
}

static void see_truck_for(int looks, double length_m)
{
    for (int k = 0; k < looks; k++) {
        see_truck(length_m);
    }
}

/* Within ten looks a truck of a usual length has a track with a heading. */
static void begin_truck(void)
{
    struct rho_body body;
    prepare();
    num_looks = 0;
    see_truck_for(10, PLAIN_M);
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(rho_tracker_body_of(&tracker, 0, &body), 1);
    assert_true(body.sigma_heading_rad < 0.3f);
}

static int is_two_after(int looks, double length_m)
{
    begin_truck();
    see_truck_for(looks, length_m);
    return report.num_tracks == 2;
}

/* The limit is four sigmas of a plot beyond the longest body: 10 + 4 0.5 = 12 m. */
static void a_body_is_too_long_beyond_the_noise_of_its_plots(void **state)
{
    (void)state;
    assert_false(is_two_after(40, 11.9));
    assert_true(is_two_after(40, 12.1));
}

/* More than 4 long looks are needed: S(4) = 3.93, S(5) = 4.88. */
static void five_looks_at_a_long_body_show_two_targets(void **state)
{
    (void)state;
    assert_false(is_two_after(4, LONG_M));
    assert_true(is_two_after(5, LONG_M));
}

static int is_two_after_long_look_every(int period)
{
    begin_truck();
    for (int k = 1; k <= 400; k++) {
        see_truck(k % period ? PLAIN_M : LONG_M);
        if (report.num_tracks == 2) {
            return 1;
        }
    }
    return 0;
}

/*
 * A share of more than 0.1 is needed. Where each p-th look is long, long looks count up to
 * 1 / (1 - (79 / 80)^p) of 80 looks: a share of 0.106 for p = 10, of 0.097 for p = 11.
 */
static void long_looks_are_more_than_a_tenth_of_all(void **state)
{
    (void)state;
    assert_true(is_two_after_long_look_every(10));
    assert_false(is_two_after_long_look_every(11));
}

static int is_two_after_pause_of(int looks)
{
    begin_truck();
    see_truck_for(3, LONG_M);
    see_truck_for(looks, PLAIN_M);
    see_truck_for(2, LONG_M);
    return report.num_tracks == 2;
}

/*
 * Three long looks, and two more after a pause of n looks, count (79 / 80)^(n + 2) S(3) + S(2):
 * 4.04 for n = 27, 3.97 for n = 30.
 */
static void long_looks_are_forgotten_over_eighty(void **state)
{
    (void)state;
    assert_true(is_two_after_pause_of(27));
    assert_false(is_two_after_pause_of(30));
}

/* ---- range rates ----------------------------------------------------------------------------- */

#define RANGE_M 199.0f /* the rule divides by a metre more: 200 m */

/* The four plots of each look, by their places and range rates about those of the body. */
struct look {
    float far_m, side_m; /* half sides of the rectangle, along the line of sight and across it */
    float oblique_m; /* shift across the line of sight: the far side's; opposite at the near side */
    float rate_mps;  /* half the difference of range rates across the line of sight */
    float twist_mps; /* added to range rates at two opposite corners, subtracted at the others */
    float sigma_cross_m, sigma_rate_mps;
};

/* A body whose parts move apart far faster than noise and an unseen turn explain. */
static const struct look usual = {
    .far_m = 1.0f, .side_m = 4.0f, .rate_mps = 1.0f, .sigma_cross_m = 0.1f, .sigma_rate_mps = 0.1f};

static struct rho_scan scan;
static struct step at;

/* A track 200 m east of the radar, with a body that heads away from it and is known well. */
static void have_body(void)
{
    prepare();
    struct rho_track *track = &tracker.tracks[0];
    *track = (struct rho_track){.track_id = 1, .status = RHO_TRACK_CONFIRMED, .plot = 0};
    track->kalman.state[RHO_X] = RANGE_M;
    tracker.bodies.of[0] = (struct rho_body_filter){
        .track_id = 1, .cos_heading = 1.0f, .has_heading = 1, .plots = 100.0f};
    tracker.num_tracks = tracker.bodies.count = 1;
    at = (struct step){.tracker = &tracker, .scan = &scan};
    scan = (struct rho_scan){.measures = RHO_MEASURES_RANGE_RATE, .plots = plots};
}

static void set_velocity_sigma(float sigma_mps)
{
    float *covariance = tracker.tracks[0].kalman.covariance;
    for (int axis = 0; axis < 2; axis++) {
        covariance[RHO_AT(axis, axis)] = 1.0f;
        covariance[RHO_AT(3 + axis, 3 + axis)] = sigma_mps * sigma_mps;
    }
}

/* Adds the plot of a corner of the rectangle to the track's group; far, side: -1 or 1. */
static void see_corner(const struct look *look, float far, float side)
{
    struct rho_groups *groups = &tracker.bodies.groups;
    const uint32_t i = num_plots;
    const float far_m = far * look->far_m, side_m = side * look->side_m + far * look->oblique_m;
    struct rho_plot *plot = add_plot((double)(RANGE_M + far_m), (double)side_m, 0.1);
    plot->sigma_cross_m = look->sigma_cross_m;
    plot->range_rate_mps = side * look->rate_mps + far * side * look->twist_mps;
    plot->sigma_range_rate_mps = look->sigma_rate_mps;
    groups->contender[i] = groups->next[i] = RHO_NO_ROW;
    if (i > 0) {
        groups->next[i - 1] = (uint16_t)i;
    }
}

static void look_for(int looks, float each_s, const struct look *look)
{
    for (int k = 0; k < looks; k++) {
        num_plots = 0;
        for (int corner = 0; corner < 4; corner++) {
            see_corner(look, corner & 1 ? 1.0f : -1.0f, corner & 2 ? 1.0f : -1.0f);
        }
        scan.num_plots = num_plots;
        at.time_us += llround(1e6 * (double)each_s);
        tracker.tracks[0].time_us = at.time_us;
        rho_tracker_add_body_split_evidence(&at, &scan, 0);
    }
}

static int moves_apart(void)
{
    return rho_tracker_find_body_split_reason(&at, 0) == RHO_BODY_MOVES_APART;
}

/* 1: sixty such looks, S(60) = 42.4, show two targets. sigma_mps: of the track's velocity */
static int moves_apart_by(float each_s, float sigma_mps, const struct look *look)
{
    have_body();
    set_velocity_sigma(sigma_mps);
    look_for(60, each_s, look);
    return moves_apart();
}

/* 30 looks are needed: S(37) = 29.8, S(38) = 30.4. */
static void range_rates_are_judged_after_thirty_looks(void **state)
{
    (void)state;
    have_body();
    look_for(37, 0.05f, &usual);
    assert_false(moves_apart());
    look_for(1, 0.05f, &usual);
    assert_true(moves_apart());
}

/* Range rates count once the body is known from 30 plots. */
static void range_rates_of_a_new_body_are_no_evidence(void **state)
{
    (void)state;
    for (int is_known = 0; is_known < 2; is_known++) {
        have_body();
        tracker.bodies.of[0].plots = is_known ? 31.0f : 29.0f;
        look_for(60, 0.05f, &usual);
        assert_int_equal(moves_apart(), is_known);
    }
}

static int moves_apart_after_turn(float turn_rad, float heading_sigma_rad)
{
    have_body();
    tracker.bodies.of[0].heading_sigma_rad = heading_sigma_rad;
    look_for(60, 0.05f, &usual);
    tracker.bodies.of[0].cos_heading = cosf(turn_rad);
    tracker.bodies.of[0].sin_heading = sinf(turn_rad);
    look_for(1, 0.05f, &usual);
    return moves_apart();
}

/* A heading is steady within 0.1 rad and one sigma of the heading. */
static void sums_of_range_rates_begin_anew_where_the_body_has_turned(void **state)
{
    (void)state;
    assert_true(moves_apart_after_turn(0.09f, 0.0f));
    assert_true(moves_apart_after_turn(-0.09f, 0.0f));
    assert_false(moves_apart_after_turn(0.11f, 0.0f));
    assert_false(moves_apart_after_turn(-0.11f, 0.0f));
    assert_true(moves_apart_after_turn(0.14f, 0.05f));
    assert_false(moves_apart_after_turn(0.16f, 0.05f));
}

/*
 * Sixty looks, one each 50 ms, last 0.05 S(59) = 2.10 s. A turn by 2 0.1 rad in that time moves
 * parts 4 m off the middle at 0.38 m/s.
 */
static void an_unseen_turn_explains_range_rates_up_to_two_tolerances(void **state)
{
    struct look look = usual;
    (void)state;
    look.rate_mps = 0.37f;
    assert_false(moves_apart_by(0.05f, 0.0f, &look));
    look.rate_mps = 0.39f;
    assert_true(moves_apart_by(0.05f, 0.0f, &look));
}

/*
 * At 200 m, a velocity that is 2 m/s off across the line of sight adds 0.04 m/s to the range rates
 * of parts 4 m off the middle, and two sigmas add 0.08 m/s. An unseen turn by 0.2 rad in the
 * S(59) = 41.9 s that sixty looks last, one each second, adds 0.019 m/s: 0.082 m/s with both.
 */
static void an_error_of_the_velocity_explains_two_sigmas_of_it(void **state)
{
    struct look look = usual;
    (void)state;
    look.sigma_rate_mps = 0.01f;
    look.rate_mps = 0.08f;
    assert_false(moves_apart_by(1.0f, 2.0f, &look));
    look.rate_mps = 0.085f;
    assert_true(moves_apart_by(1.0f, 2.0f, &look));
}

/*
 * A noise of 5 m alone has a variance of 3 / 4 5^2 m^2 about the mean of four plots, which explains
 * plots 4 m off the middle. The parts themselves then count as root(0.2 3 / 4) 5 = 1.94 m off the
 * middle, and an unseen turn moves them at 0.185 m/s.
 */
static void places_across_the_line_of_sight_have_a_least_variance(void **state)
{
    struct look look = usual;
    (void)state;
    look.sigma_cross_m = 5.0f;
    look.rate_mps = 0.18f;
    assert_false(moves_apart_by(0.05f, 0.0f, &look));
    look.rate_mps = 0.19f;
    assert_true(moves_apart_by(0.05f, 0.0f, &look));
}

/*
 * A thin body is oblique to the line of sight: its far end, 1.5 m behind the middle, is 1.5 m to
 * the side. With half a thickness of d, 1 - correlation^2 of the places is d^2 / (1.5^2 + d^2),
 * which is 0.1 for d = 0.5 m.
 */
static void no_plane_is_fitted_to_range_rates_along_a_line(void **state)
{
    struct look look = usual;
    (void)state;
    look.far_m = look.oblique_m = 1.5f;
    look.side_m = 0.48f;
    assert_false(moves_apart_by(0.05f, 0.0f, &look));
    look.side_m = 0.52f;
    assert_true(moves_apart_by(0.05f, 0.0f, &look));
}

/*
 * Range rates of r at four plots have the sum of squares 4 r^2, and noise alone has 3 sigma^2: the
 * limit is r = 0.866 sigma. In a minute an unseen turn explains next to nothing.
 */
static void range_rates_differ_by_more_than_their_noise(void **state)
{
    struct look look = usual;
    (void)state;
    look.sigma_rate_mps = 1.0f;
    look.rate_mps = 0.85f;
    assert_false(moves_apart_by(1.0f, 0.0f, &look));
    look.rate_mps = 0.88f;
    assert_true(moves_apart_by(1.0f, 0.0f, &look));
}

/*
 * Range rates of 1 m/s that no plane explains, as those of wheels, are noise. Chi-square of range
 * rates of r that a plane explains is then 3 S(60) r^2, which is 40 for r = 0.561 m/s.
 */
static void a_plane_explains_surely_more_than_wheels_do(void **state)
{
    struct look look = usual;
    (void)state;
    look.twist_mps = 1.0f;
    look.rate_mps = 0.55f;
    assert_false(moves_apart_by(1.0f, 0.0f, &look));
    look.rate_mps = 0.57f;
    assert_true(moves_apart_by(1.0f, 0.0f, &look));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_body_is_too_long_beyond_the_noise_of_its_plots),
        cmocka_unit_test(five_looks_at_a_long_body_show_two_targets),
        cmocka_unit_test(long_looks_are_more_than_a_tenth_of_all),
        cmocka_unit_test(long_looks_are_forgotten_over_eighty),
        cmocka_unit_test(range_rates_are_judged_after_thirty_looks),
        cmocka_unit_test(range_rates_of_a_new_body_are_no_evidence),
        cmocka_unit_test(sums_of_range_rates_begin_anew_where_the_body_has_turned),
        cmocka_unit_test(an_unseen_turn_explains_range_rates_up_to_two_tolerances),
        cmocka_unit_test(an_error_of_the_velocity_explains_two_sigmas_of_it),
        cmocka_unit_test(places_across_the_line_of_sight_have_a_least_variance),
        cmocka_unit_test(no_plane_is_fitted_to_range_rates_along_a_line),
        cmocka_unit_test(range_rates_differ_by_more_than_their_noise),
        cmocka_unit_test(a_plane_explains_surely_more_than_wheels_do),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
