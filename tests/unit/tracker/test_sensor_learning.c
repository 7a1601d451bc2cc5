/* SPDX-License-Identifier: MIT */
/*
 * Sensors that are not as stated: noise and pd are learned from what tracks show, within their
 * bounds, and used; where all is as stated, or targets turn, nothing is.
 */
#include "tracker_setup.h"

#define TARGETS 12
#define SENSOR 3
#define RANGE_MAX_M 60e3f
#define TURN_US 4000000

struct radar {
    double sigma_range_m, sigma_azimuth_rad; /* true ones */
    double claim;                            /* what its plots claim of these */
    double claim_across;                     /* times that, of the second; 0: 1 */
    double pd, pd_far, pd_stated;            /* to half its range, and beyond */
    double weave_mps2;                       /* accelerations of its targets, across, in turns */
    int is_round;                            /* plots have sigma_range_m on both axes */
    int gone_at; /* targets are there for so many scans, then others; 0: always */
};

static const struct radar as_stated = {.sigma_range_m = 30.0,
                                       .sigma_azimuth_rad = 0.003,
                                       .claim = 1.0,
                                       .pd = 0.9,
                                       .pd_far = 0.9,
                                       .pd_stated = 0.9};

static void describe(const struct radar *radar)
{
    const struct rho_sensor sensor = {
        .sensor_id = SENSOR, .pd = (float)radar->pd_stated, .range_max_m = RANGE_MAX_M};
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
}

/* Half of them near, half far, on straight lines, or weaving about them. */
static void place_of(const struct radar *radar, int target, int k, double place_m[2])
{
    const int life = radar->gone_at ? k / radar->gone_at : 0;
    const double t_s = 4.0 * k, heading = 1.1 * target + 2.3 * life;
    const double azimuth = 6.2832 * target / TARGETS + 0.3 * life;
    const double range_m = target % 2 ? 18e3 : 48e3;
    const double along_m = 20.0 * (t_s - 300.0);
    const double off_m = radar->weave_mps2 / (0.15 * 0.15) * sin(0.15 * t_s);

    place_m[0] = range_m * cos(azimuth) + along_m * cos(heading) - off_m * sin(heading);
    place_m[1] = range_m * sin(azimuth) + along_m * sin(heading) + off_m * cos(heading);
}

static unsigned doubts; /* reports of established tracks that are in doubt */

static void look(const struct radar *radar, int k)
{
    struct rho_scan scan = {.time_us = (int64_t)TURN_US * k, .sensor_id = SENSOR, .plots = plots};

    num_plots = 0;
    for (int i = 0; i < TARGETS; i++) {
        double place_m[2], range_noise = normal(), azimuth_noise = normal();
        place_of(radar, i, k, place_m);
        const double range_m = hypot(place_m[0], place_m[1]);
        const double across_m =
            radar->is_round ? radar->sigma_range_m : range_m * radar->sigma_azimuth_rad;
        const double x = place_m[0] / range_m, y = place_m[1] / range_m;
        const double along_m = radar->sigma_range_m * range_noise,
                     side_m = across_m * azimuth_noise;
        const double pd = range_m < 0.5 * (double)RANGE_MAX_M ? radar->pd : radar->pd_far;

        if (uniform(0.0, 1.0) < pd) {
            struct rho_plot *plot = add_plot(place_m[0] + along_m * x - side_m * y,
                                             place_m[1] + along_m * y + side_m * x, 1.0);
            plot->sigma_range_m = (float)(radar->claim * radar->sigma_range_m);
            plot->sigma_cross_m = (float)(radar->claim * across_m *
                                          (radar->claim_across > 0.0 ? radar->claim_across : 1.0));
        }
    }
    scan.num_plots = num_plots;
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
    for (unsigned i = 0; i < report.num_tracks; i++) {
        doubts += report.tracks[i].hits > 16 && report.tracks[i].status == RHO_TRACK_TENTATIVE;
    }
}

static struct rho_tracker_known known_after(const struct radar *radar, int scans)
{
    struct rho_tracker_known known;

    describe(radar);
    for (int k = 0; k < scans; k++) {
        describe(radar); /* as the program does before each scan: what is learned stays */
        look(radar, k);
    }
    assert_int_equal(rho_tracker_known_of(&tracker, SENSOR, &known), RHO_OK);
    assert_true(rho_tracker_is_sound(&tracker));
    return known;
}

static void prepare(uint64_t seed)
{
    use_usual_configs(seed);
    config.accel_max_mps2 = 20.0f;
    begin_tracker();
}

static void assert_between(double value, double least, double most)
{
    if (!(value >= least && value <= most)) {
        fail_msg("%g is not within %g .. %g", value, least, most);
    }
}

static void what_is_as_stated_stays(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        struct radar radar = as_stated;
        radar.is_round = seed % 2 == 0;
        prepare(seed);
        const struct rho_tracker_known known = known_after(&radar, 150);
        assert_float_equal(known.range_factor, 1.0f, 0.0f);
        assert_float_equal(known.cross_factor, 1.0f, 0.0f);
        for (int ring = 0; ring < RHO_LEARN_RINGS; ring++) {
            assert_float_equal(known.pd[ring], 0.9f, 0.03f);
        }
        assert_true(known.innovations >= 300 && known.looks >= 1000);
        assert_int_equal(tracker.sensors[0].sigma_range_percent, 100);
    }
}

static void noise_is_found_on_each_axis(void **state)
{
    static const double claims[] = {0.45, 0.6, 2.5, 0.5};
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct radar radar = as_stated;
        radar.claim = claims[i];
        radar.is_round = i == 3;
        prepare(10u + (uint64_t)i);
        config.learn_noise_min = 0.2f;
        begin_tracker();
        const struct rho_tracker_known known = known_after(&radar, 150);
        assert_between((double)known.range_factor * claims[i], 0.82, 1.18);
        assert_between((double)known.cross_factor * claims[i], 0.82, 1.18);
        assert_between(tracker.sensors[0].sigma_cross_percent * 0.01 * claims[i], 0.82, 1.18);
    }
}

/* Of one that claims too little noise along the line of sight alone. */
static void axes_are_told_apart(void **state)
{
    struct radar radar = as_stated;

    (void)state;
    radar.claim_across = 2.0;
    radar.claim = 0.5;
    prepare(20);
    const struct rho_tracker_known known = known_after(&radar, 150);
    assert_between((double)known.range_factor, 1.64, 2.36);
    assert_float_equal(known.cross_factor, 1.0f, 0.0f);
}

static void bounds_hold_and_one_is_off(void **state)
{
    struct radar radar = as_stated;
    struct rho_tracker_known known;

    (void)state;
    radar.claim = 0.5;
    radar.pd = radar.pd_far = 0.7;
    radar.pd_stated = 0.95;
    prepare(30);
    config.learn_noise_max = 1.5f;
    config.learn_pd_min = 0.8f;
    begin_tracker();
    known = known_after(&radar, 120);
    assert_float_equal(known.range_factor, 1.5f, 0.0f);
    assert_float_equal(known.pd[1], 0.76f, 1e-6f);
    prepare(30);
    config.learn_noise_min = config.learn_noise_max = config.learn_pd_min = 1.0f;
    begin_tracker();
    known = known_after(&radar, 120);
    assert_float_equal(known.range_factor, 1.0f, 0.0f);
    assert_float_equal(known.pd[1], 0.95f, 0.0f);
    radar.claim = 3.0;
    radar.pd = radar.pd_far = 0.9;
    prepare(31);
    known = known_after(&radar, 120);
    assert_float_equal(known.range_factor, 0.7f, 0.0f);
}

/* Looks were counted with learn_pd_min 1, too, though the pd is not learned then. */
static void nothing_is_counted_where_learning_is_off(void **state)
{
    (void)state;
    prepare(32);
    config.learn_noise_min = config.learn_noise_max = config.learn_pd_min = 1.0f;
    begin_tracker();
    const struct rho_tracker_known known = known_after(&as_stated, 60);
    assert_int_equal(known.looks, 0);
    assert_int_equal(known.innovations, 0);
}

/* Targets that turn leave plots beside their predictions, too: that is no noise. */
static void manoeuvres_are_no_noise(void **state)
{
    static const double accels_mps2[] = {3.0, 10.0, 30.0};
    (void)state;
    for (int i = 0; i < 3; i++) {
        struct radar radar = as_stated;
        radar.weave_mps2 = accels_mps2[i];
        prepare(40u + (uint64_t)i);
        const struct rho_tracker_known known = known_after(&radar, 150);
        assert_between((double)known.range_factor, 0.99, 1.01);
        assert_between((double)known.cross_factor, 0.99, 1.01);
    }
}

static void pd_is_learned_by_range(void **state)
{
    struct radar radar = as_stated;

    (void)state;
    radar.pd_stated = 0.95;
    radar.pd = 0.95;
    radar.pd_far = 0.6;
    prepare(50);
    const struct rho_tracker_known known = known_after(&radar, 150);
    assert_float_equal(known.pd[1], 0.95f, 0.03f);
    assert_between((double)known.pd[4], 0.57, 0.7);
}

/*
 * Times that established tracks are in doubt of targets that are seen in half of the scans, in five
 * runs.
 */
static unsigned doubts_with(float learn_pd_min)
{
    doubts = 0;
    for (uint64_t seed = 51; seed <= 55; seed++) {
        struct radar radar = as_stated;
        radar.pd_stated = 0.95;
        radar.pd_far = 0.5;
        prepare(seed);
        config.learn_pd_min = learn_pd_min;
        begin_tracker();
        (void)known_after(&radar, 150);
    }
    return doubts;
}

/* Two misses in a row are a doubt where pd is as stated; where it is known to be less, more. */
static void tracks_that_are_seen_seldom_are_believed(void **state)
{
    (void)state;
    const unsigned learned = doubts_with(0.5f), as_ever = doubts_with(1.0f);
    print_message("%u doubts, %u where pd is as stated\n", learned, as_ever);
    assert_true(as_ever >= 200);
    assert_true(2 * learned < as_ever);
}

/* A build without hypotheses does the same. */
static void the_gate_nearest_learns_nothing(void **state)
{
    struct radar radar = as_stated;

    (void)state;
    radar.claim = 0.5;
    radar.pd_far = 0.5;
    radar.pd_stated = 0.95;
    use_usual_configs(52);
    config.accel_max_mps2 = 20.0f;
    config.gate = RHO_TRACKER_NEAREST;
    begin_tracker();
    const struct rho_tracker_known known = known_after(&radar, 150);
    assert_int_equal(known.innovations, 0);
    assert_int_equal(known.looks, 0);
    assert_float_equal(known.pd[4], 0.95f, 0.0f);
    assert_int_equal(tracker.sensors[0].sigma_range_percent, 100);
}

/* Targets that are gone are no misses of those that are there; more than was stated is not
 * believed. */
static void pd_is_not_lowered_by_what_is_gone_nor_raised(void **state)
{
    struct radar radar = as_stated;

    (void)state;
    radar.gone_at = 30;
    prepare(60);
    assert_float_equal(known_after(&radar, 150).pd[4], 0.9f, 0.03f);
    radar.gone_at = 0;
    radar.pd = radar.pd_far = 0.99;
    radar.pd_stated = 0.6;
    prepare(61);
    assert_float_equal(known_after(&radar, 100).pd[1], 0.6f, 0.0f);
}

static void sensors_are_told_apart_and_forgotten(void **state)
{
    struct radar radar = as_stated;
    struct rho_tracker_known known;
    const struct rho_sensor other = {.sensor_id = 9, .pd = 0.5f, .range_max_m = 1e4f};

    (void)state;
    radar.claim = 0.5;
    prepare(70);
    assert_int_equal(rho_tracker_known_of(&tracker, SENSOR, &known), RHO_ERROR_STATE);
    assert_int_equal(rho_tracker_known_of(NULL, SENSOR, &known), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_known_of(&tracker, SENSOR, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &other), RHO_OK);
    assert_true(known_after(&radar, 120).range_factor > 1.6f);
    assert_int_equal(rho_tracker_known_of(&tracker, 9, &known), RHO_OK);
    assert_float_equal(known.range_factor, 1.0f, 0.0f);
    assert_int_equal(known.looks, 0);
    assert_int_equal(rho_tracker_forget_sensor(&tracker, 9), RHO_OK);
    assert_int_equal(rho_tracker_known_of(&tracker, SENSOR, &known), RHO_OK);
    assert_true(known.range_factor > 1.6f);
    assert_int_equal(rho_tracker_forget_sensor(&tracker, SENSOR), RHO_OK);
    describe(&radar);
    assert_int_equal(rho_tracker_known_of(&tracker, SENSOR, &known), RHO_OK);
    assert_int_equal(known.innovations, 0);
}

/* ---- what counts so far mean ----------------------------------------------------------------- */

static struct rho_tracker_known known_now(void)
{
    struct rho_tracker_known known;
    assert_int_equal(rho_tracker_known_of(&tracker, SENSOR, &known), RHO_OK);
    return known;
}

/* Of a radar with the stated pd 0.9, in ring 2 of these looks; all others are seen as stated. */
static float pd_after(unsigned looks, unsigned hits)
{
    tracker.learned[0].looks[2] = (uint16_t)looks;
    tracker.learned[0].hits[2] = (uint16_t)hits;
    return known_now().pd[2];
}

/* (hits + prior pd) / (looks + prior), with 30 prior looks at all rings and 20 at one. */
static double seen_pd(double looks, double hits, double *sigma)
{
    const double all = (hits + 30.0 * 0.9) / (looks + 30.0);
    const double pd = (hits + 20.0 * all) / (looks + 20.0);
    *sigma = sqrt(pd * (1.0 - pd) / (looks + 20.0));
    return pd;
}

/* One sigma above what was seen, where that is 2.5 sigmas below what is stated. */
static void learned_pd_has_priors_and_caution(void **state)
{
    (void)state;
    prepare(90);
    describe(&as_stated);
    tracker.learned[0].is_lowered = 1u << 2;
    for (unsigned hits = 20; hits <= 54; hits++) {
        double sigma, pd = seen_pd(60.0, hits, &sigma);
        const double expected = pd + 2.5 * sigma < 0.9 ? pd + sigma : 0.9;
        assert_float_equal(pd_after(60, hits), expected > 0.45 ? expected : 0.45, 1e-5);
    }
}

static float factor_after(unsigned innovations, double log_noise)
{
    tracker.learned[0].innovations = (uint16_t)innovations;
    tracker.learned[0].log_noise[0] = tracker.learned[0].log_noise[1] = (float)log_noise;
    return known_now().range_factor;
}

/* From 100 innovations, and beyond 0.25 + 4 / root of them: 0.65 of 100, 0.376 of 1000. */
static void learned_noise_counts_beyond_chance(void **state)
{
    (void)state;
    prepare(91);
    describe(&as_stated);
    assert_float_equal(factor_after(99, 0.8), 1.0, 0.0);
    assert_float_equal(factor_after(100, 0.8), exp(0.4), 1e-5);
    assert_float_equal(factor_after(100, 0.64), 1.0, 0.0);
    assert_float_equal(factor_after(100, 0.66), exp(0.33), 1e-5);
    assert_float_equal(factor_after(1000, 0.37), 1.0, 0.0);
    assert_float_equal(factor_after(1000, 0.39), exp(0.195), 1e-5);
}

/* Up to 4.6, 1000 innovations and 1000 looks; what is beyond is no image of a tracker. */
static void what_is_learned_has_limits(void **state)
{
    (void)state;
    prepare(92);
    describe(&as_stated);
    const struct rho_tracker_learned none = tracker.learned[0];
    (void)factor_after(1000, 4.6);
    (void)pd_after(1000, 1000);
    assert_true(rho_tracker_is_sound(&tracker));
    for (int i = 0; i < 3; i++) {
        tracker.learned[0] = none;
        tracker.learned[0].log_noise[1] = i == 0 ? 4.7f : 0.0f;
        tracker.learned[0].innovations = i == 1 ? 1001 : 0;
        tracker.learned[0].looks[2] = i == 2 ? 1001 : 0;
        assert_false(rho_tracker_is_sound(&tracker));
    }
}

static void bounds_are_checked(void **state)
{
    static const float bad[][3] = {{0.09f, 4.0f, 0.5f}, {1.01f, 4.0f, 0.5f}, {0.7f, 0.99f, 0.5f},
                                   {0.7f, 10.1f, 0.5f}, {0.7f, 4.0f, 0.09f}, {0.7f, 4.0f, NAN}};
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        use_usual_configs(80);
        config.learn_noise_min = bad[i][0];
        config.learn_noise_max = bad[i][1];
        config.learn_pd_min = bad[i][2];
        assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_ERROR_CONFIG);
    }
}

/*
 * Aircraft of 75 m/s pass tangentially at 10 to 21 km, 20 minutes each, one after the other; a
 * radar that is blind within 12 m/s of zero Doppler sees them not.
 */
static void pass(int k, double notch_mps)
{
    struct rho_scan scan = {.time_us = (int64_t)TURN_US * k, .sensor_id = SENSOR, .plots = plots};

    num_plots = 0;
    for (int i = 0; i < TARGETS; i++) {
        const int phase = k + 25 * i, life = phase / 300;
        const double along_m = 75.0 * (4.0 * (phase % 300) - 600.0), aside_m = 10e3 + 1e3 * i;
        const double heading = 0.52 * i + 1.3 * life, range_m = hypot(along_m, aside_m);
        const double x_noise = normal(), y_noise = normal();
        const double seen = fabs(75.0 * along_m / range_m) < notch_mps ? 0.03 : 0.9;
        if (uniform(0.0, 1.0) < seen) {
            (void)add_plot(along_m * cos(heading) - aside_m * sin(heading) + 30.0 * x_noise,
                           along_m * sin(heading) + aside_m * cos(heading) + 30.0 * y_noise, 30.0);
        }
    }
    scan.num_plots = num_plots;
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
}

static float learned_notch(void)
{
    struct rho_tracker_known known;

    assert_int_equal(rho_tracker_known_of(&tracker, SENSOR, &known), RHO_OK);
    for (int ring = 0; ring < RHO_LEARN_RINGS; ring++) {
        assert_true(known.pd[ring] > 0.85f); /* of what is not in the notch, as stated */
    }
    return known.notch_mps;
}

static void begin_flights(void)
{
    use_usual_configs(17);
    config.v_max_mps = initiation.v_max_mps = 200.0f;
    begin_tracker();
    describe(&as_stated);
}

static void a_notch_that_nobody_told_is_learned(void **state)
{
    uint32_t before, after;
    (void)state;
    if (!RHO_DOPPLER_NOTCH) {
        skip();
    }
    begin_flights();
    for (int k = 0; k < 1500; k++) {
        pass(k, 12.0);
    }
    assert_true(learned_notch() > 9.0f && learned_notch() < 13.0f);
    assert_true(rho_tracker_is_sound(&tracker));
    before = tracker.counters.tracks_started;
    for (int k = 1500; k < 2100; k++) {
        pass(k, 12.0);
    }
    after = tracker.counters.tracks_started;
    print_message("%u tracks of 24 aircraft once it is learned\n", (unsigned)(after - before));
    assert_true(after - before <= 32);
    /* one that is stated goes before it */
    const struct rho_sensor told = {
        .sensor_id = SENSOR, .pd = 0.9f, .range_max_m = RANGE_MAX_M, .notch_mps = 5.0f};
    assert_int_equal(rho_tracker_set_sensor(&tracker, &told), RHO_OK);
    pass(2100, 12.0);
    assert_true(tracker.sensors[0].notch_mps == 5.0f && learned_notch() == 0.0f);
}

static void a_notch_that_is_none_is_not_learned_and_forgotten(void **state)
{
    (void)state;
    if (!RHO_DOPPLER_NOTCH) {
        skip();
    }
    begin_flights();
    for (int k = 0; k < 1500; k++) {
        pass(k, 0.0);
        assert_true(learned_notch() == 0.0f);
    }
    begin_flights();
    for (int k = 0; k < 1500; k++) {
        pass(k, 12.0);
    }
    assert_true(learned_notch() > 9.0f);
    for (int k = 1500; k < 4500; k++) {
        pass(k, 0.0);
    }
    assert_true(learned_notch() == 0.0f);
    assert_true(tracker.sensors[0].notch_mps == 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_as_stated_stays),
        cmocka_unit_test(noise_is_found_on_each_axis),
        cmocka_unit_test(axes_are_told_apart),
        cmocka_unit_test(bounds_hold_and_one_is_off),
        cmocka_unit_test(nothing_is_counted_where_learning_is_off),
        cmocka_unit_test(manoeuvres_are_no_noise),
        cmocka_unit_test(pd_is_learned_by_range),
        cmocka_unit_test(tracks_that_are_seen_seldom_are_believed),
        cmocka_unit_test(the_gate_nearest_learns_nothing),
        cmocka_unit_test(pd_is_not_lowered_by_what_is_gone_nor_raised),
        cmocka_unit_test(sensors_are_told_apart_and_forgotten),
        cmocka_unit_test(learned_pd_has_priors_and_caution),
        cmocka_unit_test(learned_noise_counts_beyond_chance),
        cmocka_unit_test(what_is_learned_has_limits),
        cmocka_unit_test(bounds_are_checked),
        cmocka_unit_test(a_notch_that_nobody_told_is_learned),
        cmocka_unit_test(a_notch_that_is_none_is_not_learned_and_forgotten),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
