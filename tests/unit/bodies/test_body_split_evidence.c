/* SPDX-License-Identifier: MIT */
/*
 * The plots of a body split it into two targets just beyond each limit of the evidence, and not
 * within it. Lengths are tested through the public interface. For range rates, tracks and bodies
 * are made by hand, with the private header, as those of a scene never stand exactly at a limit.
 * Sums fade by 1 / 80 a look: n looks in a row count as S(n) = 80 (1 - (79 / 80)^n) looks.
 */
#include "../../src/bodies/bodies.h"
#include "../../src/tracker/clutter.h"
#include "../../src/tracker/plots.h"
#include "../../src/tracker/sensors.h"
#include "../../src/tracker/step.h"
#include "rhotrack/body.h"
#include "tracker_setup.h"

#if RHO_BODIES

#define LONGEST_M 10.0

static void start_tracker_with_bodies(void)
{
    use_usual_configs(1);
    config.v_max_mps = initiation.v_max_mps = 60.0f;
    begin_tracker();
    assert_int_equal(rho_tracker_set_body_max(&tracker, (float)LONGEST_M), RHO_OK);
}

/* ---- evidence from lengths ------------------------------------------------------------------- */

#define STEP_S 0.1
#define SPEED_MPS 15.0
#define PLAIN_M 9.0 /* a length within the longest */
#define LONG_M 13.0 /* a length beyond the longest and the noise */

static int num_looks;

/* A scan of a truck driving away from the radar: plots of its rear and front with 0.5 m noise. */
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

/* After ten looks a truck of usual length has a track with a heading. */
static void begin_truck(void)
{
    struct rho_body body;
    start_tracker_with_bodies();
    num_looks = 0;
    see_truck_for(10, PLAIN_M);
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(rho_tracker_body_of(&tracker, 0, &body), 1);
    assert_true(body.sigma_heading_rad < 0.3f);
}

static int is_split_after(int looks, double length_m)
{
    begin_truck();
    see_truck_for(looks, length_m);
    return report.num_tracks == 2;
}

/* Too long is more than four sigmas of a plot beyond the longest body: 10 + 4 0.5 = 12 m. */
static void a_body_is_too_long_four_sigmas_beyond_the_longest(void **state)
{
    (void)state;
    assert_false(is_split_after(40, 11.9));
    assert_true(is_split_after(40, 12.1));
}

/* More than 4 too long looks are needed: S(4) = 3.93, S(5) = 4.88. */
static void five_looks_at_a_too_long_body_split_it(void **state)
{
    (void)state;
    assert_false(is_split_after(4, LONG_M));
    assert_true(is_split_after(5, LONG_M));
}

static int is_split_by_long_look_every(int period)
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
 * More than 0.1 of the looks must be too long. If every p-th look is, they count as up to 1 / (1 -
 * (79 / 80)^p) of 80 looks: a share of 0.106 for p = 10, of 0.097 for p = 11.
 */
static void more_than_a_tenth_of_looks_must_be_too_long(void **state)
{
    (void)state;
    assert_true(is_split_by_long_look_every(10));
    assert_false(is_split_by_long_look_every(11));
}

static int is_split_after_pause_of(int looks)
{
    begin_truck();
    see_truck_for(3, LONG_M);
    see_truck_for(looks, PLAIN_M);
    see_truck_for(2, LONG_M);
    return report.num_tracks == 2;
}

/*
 * Three too long looks, and two more after n others, count as (79 / 80)^(n + 2) S(3) + S(2): 4.04
 * for n = 27, 3.97 for n = 30.
 */
static void too_long_looks_are_forgotten_within_eighty(void **state)
{
    (void)state;
    assert_true(is_split_after_pause_of(27));
    assert_false(is_split_after_pause_of(30));
}

/* ---- evidence from range rates --------------------------------------------------------------- */

#define RANGE_M 199.0f /* + 1 m, which the rule adds before dividing, is 200 m */

/* Places and range rates of the four plots of each look, relative to the body's. */
struct look {
    float far_m, side_m; /* half sides of the rectangle, along and across the line of sight */
    /* shift of the far side across the line of sight; the near side's is opposite */
    float oblique_m;
    float rate_mps;  /* half the difference of range rates across the line of sight */
    float twist_mps; /* added to range rates at two opposite corners, subtracted at the other two */
    float sigma_cross_m, sigma_rate_mps;
};

/* A body whose parts move apart far faster than noise and an unseen turn explain. */
static const struct look usual = {
    .far_m = 1.0f, .side_m = 4.0f, .rate_mps = 1.0f, .sigma_cross_m = 0.1f, .sigma_rate_mps = 0.1f};

static struct rho_scan scan;
static struct step at;

/* A track 200 m east of the radar, with a well-known body that heads away from the radar. */
static void make_track_with_body(void)
{
    start_tracker_with_bodies();
    struct rho_track *track = &tracker.tracks[0];
    *track = (struct rho_track){.track_id = 1, .status = RHO_TRACK_CONFIRMED, .plot = 0};
    track->kalman.state[RHO_X] = RANGE_M;
    tracker.bodies.of[0] = (struct rho_body_filter){
        .track_id = 1, .cos_heading = 1.0f, .has_heading = 1, .plots = 100.0f};
    tracker.num_tracks = tracker.bodies.count = 1;
    at = (struct step){
        .tracker = &tracker,
        .look = {.tracker = &tracker, .fates = report.fates, .teaches = 1, .scan = &scan}};
    scan = (struct rho_scan){.measures = RHO_MEASURES_RANGE_RATE, .plots = plots};
}

static void set_track_velocity_sigma(float sigma_mps)
{
    float *covariance = tracker.tracks[0].kalman.covariance;
    for (int axis = 0; axis < 2; axis++) {
        covariance[RHO_AT(axis, axis)] = 1.0f;
        covariance[RHO_AT(3 + axis, 3 + axis)] = sigma_mps * sigma_mps;
    }
}

/* Adds the plot at a corner of the rectangle to the track's group; far, side: -1 or 1. */
static void add_corner_plot(const struct look *look, float far, float side)
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

static void add_looks(int looks, float each_s, const struct look *look)
{
    for (int k = 0; k < looks; k++) {
        num_plots = 0;
        for (int corner = 0; corner < 4; corner++) {
            add_corner_plot(look, corner & 1 ? 1.0f : -1.0f, corner & 2 ? 1.0f : -1.0f);
        }
        scan.num_plots = num_plots;
        at.look.time_us += llround(1e6 * (double)each_s);
        tracker.tracks[0].time_us = at.look.time_us;
        const struct body_outline outline = rho_bodies_outline_track(&at.look, 0);
        struct body_sums sums = {0};
        for (unsigned i = 0; i < num_plots; i++) {
            struct outline_fit fit;
            rho_bodies_see_plot(&at.look, &outline, &plots[i], &fit);
            rho_bodies_sum_plot(&sums, &plots[i], &fit);
        }
        rho_bodies_add_doubt(&tracker, &at.look, &sums, 0);
    }
}

static int do_parts_move_apart(void)
{
    return rho_bodies_split_reason(&tracker, 0) == RHO_BODY_MOVES_APART;
}

/* 1: sixty such looks, S(60) = 42.4, split the body. sigma_mps: of the track's velocity */
static int do_parts_move_apart_after_sixty(float each_s, float sigma_mps, const struct look *look)
{
    make_track_with_body();
    set_track_velocity_sigma(sigma_mps);
    add_looks(60, each_s, look);
    return do_parts_move_apart();
}

/* More than 30 looks are needed: S(37) = 29.8, S(38) = 30.4. */
static void range_rates_split_a_body_after_thirty_looks(void **state)
{
    (void)state;
    make_track_with_body();
    add_looks(37, 0.05f, &usual);
    assert_false(do_parts_move_apart());
    add_looks(1, 0.05f, &usual);
    assert_true(do_parts_move_apart());
}

/* Range rates count once more than 30 plots have shaped the body. */
static void range_rates_of_a_body_of_few_plots_are_ignored(void **state)
{
    (void)state;
    for (int is_known = 0; is_known < 2; is_known++) {
        make_track_with_body();
        tracker.bodies.of[0].plots = is_known ? 31.0f : 29.0f;
        add_looks(60, 0.05f, &usual);
        assert_int_equal(do_parts_move_apart(), is_known);
    }
}

static int do_parts_move_apart_after_turn(float turn_rad, float heading_sigma_rad)
{
    make_track_with_body();
    tracker.bodies.of[0].heading_sigma_rad = heading_sigma_rad;
    add_looks(60, 0.05f, &usual);
    tracker.bodies.of[0].cos_heading = cosf(turn_rad);
    tracker.bodies.of[0].sin_heading = sinf(turn_rad);
    add_looks(1, 0.05f, &usual);
    return do_parts_move_apart();
}

/* A heading counts as steady within 0.1 rad and one sigma of the heading. */
static void a_turn_of_the_body_resets_sums_of_range_rates(void **state)
{
    (void)state;
    assert_true(do_parts_move_apart_after_turn(0.09f, 0.0f));
    assert_true(do_parts_move_apart_after_turn(-0.09f, 0.0f));
    assert_false(do_parts_move_apart_after_turn(0.11f, 0.0f));
    assert_false(do_parts_move_apart_after_turn(-0.11f, 0.0f));
    assert_true(do_parts_move_apart_after_turn(0.14f, 0.05f));
    assert_false(do_parts_move_apart_after_turn(0.16f, 0.05f));
}

/*
 * Four corners at 0.3 m/s, with signs that no plane has: 4 x 0.09 less the noise of three plots,
 * 3 x 0.01, over the three beyond one of a look. A plane of range rates, as of a turn, is no limbs.
 */
static void limbs_are_what_no_plane_explains(void **state)
{
    struct look look = usual;
    (void)state;
    for (int is_of_limbs = 0; is_of_limbs <= 1; is_of_limbs++) {
        look.rate_mps = is_of_limbs ? 0.0f : 0.3f;
        look.twist_mps = is_of_limbs ? 0.3f : 0.0f;
        make_track_with_body();
        add_looks(60, 0.05f, &look);
        const float limbs_m2ps2 = rho_bodies_limbs_m2ps2(&tracker.bodies.of[0]);
        assert_float_equal(limbs_m2ps2, is_of_limbs ? 0.11f : 0.0f, 0.002f);
        const struct body_outline outline = rho_bodies_outline_track(&at.look, 0);
        assert_float_equal(outline.rates_m2ps2, limbs_m2ps2, 0.0f);
    }
    make_track_with_body(); /* nothing is known yet */
    assert_float_equal(rho_bodies_limbs_m2ps2(&tracker.bodies.of[0]), 0.0f, 0.0f);
}

/*
 * Sixty looks, one each 50 ms, last 0.05 S(59) = 2.10 s. A turn by 2 x 0.1 rad in that time moves
 * parts 4 m off the middle at 0.38 m/s.
 */
static void range_rates_that_an_unseen_turn_explains_do_not_split(void **state)
{
    struct look look = usual;
    (void)state;
    look.rate_mps = 0.37f;
    assert_false(do_parts_move_apart_after_sixty(0.05f, 0.0f, &look));
    look.rate_mps = 0.39f;
    assert_true(do_parts_move_apart_after_sixty(0.05f, 0.0f, &look));
}

/*
 * At 200 m, a velocity error of 2 m/s across the line of sight adds 0.04 m/s to range rates of
 * parts 4 m off the middle; two sigmas add 0.08 m/s. An unseen turn by 0.2 rad in the S(59) = 41.9
 * s of sixty looks, one each second, adds 0.019 m/s: together 0.082 m/s.
 */
static void range_rates_that_a_velocity_error_explains_do_not_split(void **state)
{
    struct look look = usual;
    (void)state;
    look.sigma_rate_mps = 0.01f;
    look.rate_mps = 0.08f;
    assert_false(do_parts_move_apart_after_sixty(1.0f, 2.0f, &look));
    look.rate_mps = 0.085f;
    assert_true(do_parts_move_apart_after_sixty(1.0f, 2.0f, &look));
}

/*
 * Noise of 5 m alone has a variance of 3 / 4 5^2 m^2 about the mean of four plots, which explains
 * plots 4 m off the middle. The parts then count as root(0.2 3 / 4) 5 = 1.94 m off the middle,
 * where an unseen turn moves them at 0.185 m/s.
 */
static void cross_range_places_count_as_at_least_a_fifth_of_their_variance(void **state)
{
    struct look look = usual;
    (void)state;
    look.sigma_cross_m = 5.0f;
    look.rate_mps = 0.18f;
    assert_false(do_parts_move_apart_after_sixty(0.05f, 0.0f, &look));
    look.rate_mps = 0.19f;
    assert_true(do_parts_move_apart_after_sixty(0.05f, 0.0f, &look));
}

/*
 * A thin body oblique to the line of sight: its far end, 1.5 m behind the middle, is 1.5 m to the
 * side. With half a thickness of d, 1 - correlation^2 of the places is d^2 / (1.5^2 + d^2), which
 * is the limit of 0.1 for d = 0.5 m.
 */
static void plots_nearly_on_a_line_give_no_range_rate_evidence(void **state)
{
    struct look look = usual;
    (void)state;
    look.far_m = look.oblique_m = 1.5f;
    look.side_m = 0.48f;
    assert_false(do_parts_move_apart_after_sixty(0.05f, 0.0f, &look));
    look.side_m = 0.52f;
    assert_true(do_parts_move_apart_after_sixty(0.05f, 0.0f, &look));
}

/*
 * Range rates of +-r at four plots have the sum of squares 4 r^2, noise alone has 3 sigma^2: the
 * limit is r = 0.866 sigma. In a minute an unseen turn explains next to nothing.
 */
static void range_rates_within_their_noise_do_not_split(void **state)
{
    struct look look = usual;
    (void)state;
    look.sigma_rate_mps = 1.0f;
    look.rate_mps = 0.85f;
    assert_false(do_parts_move_apart_after_sixty(1.0f, 0.0f, &look));
    look.rate_mps = 0.88f;
    assert_true(do_parts_move_apart_after_sixty(1.0f, 0.0f, &look));
}

/*
 * Range rates of 1 m/s that no plane fits, like those of wheels, count as noise. Chi-square of
 * range rates +-r that a plane fits is then 3 S(60) r^2: the limit of 40 is reached at r = 0.561
 * m/s.
 */
static void range_rates_of_turning_wheels_do_not_split(void **state)
{
    struct look look = usual;
    (void)state;
    look.twist_mps = 1.0f;
    look.rate_mps = 0.55f;
    assert_false(do_parts_move_apart_after_sixty(1.0f, 0.0f, &look));
    look.rate_mps = 0.57f;
    assert_true(do_parts_move_apart_after_sixty(1.0f, 0.0f, &look));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_body_is_too_long_four_sigmas_beyond_the_longest),
        cmocka_unit_test(five_looks_at_a_too_long_body_split_it),
        cmocka_unit_test(more_than_a_tenth_of_looks_must_be_too_long),
        cmocka_unit_test(too_long_looks_are_forgotten_within_eighty),
        cmocka_unit_test(range_rates_split_a_body_after_thirty_looks),
        cmocka_unit_test(range_rates_of_a_body_of_few_plots_are_ignored),
        cmocka_unit_test(limbs_are_what_no_plane_explains),
        cmocka_unit_test(a_turn_of_the_body_resets_sums_of_range_rates),
        cmocka_unit_test(range_rates_that_an_unseen_turn_explains_do_not_split),
        cmocka_unit_test(range_rates_that_a_velocity_error_explains_do_not_split),
        cmocka_unit_test(cross_range_places_count_as_at_least_a_fifth_of_their_variance),
        cmocka_unit_test(plots_nearly_on_a_line_give_no_range_rate_evidence),
        cmocka_unit_test(range_rates_within_their_noise_do_not_split),
        cmocka_unit_test(range_rates_of_turning_wheels_do_not_split),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
