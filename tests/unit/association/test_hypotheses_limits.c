/* SPDX-License-Identifier: MIT */
/*
 * Hypotheses at their limits: a full pool, plots claimed by other tracks, plots known to be the
 * target's, refused calls.
 */
#include <string.h>

#include "dense_filter.h"

#include "rhotrack/detail/hypotheses.h"

#include "one_bearing.h"

#define NUM(array) (sizeof(array) / sizeof((array)[0]))

static struct rho_hypotheses pool, copy;

static const struct rho_hypotheses_clutter thin = {-11.0f, -6.0f, -6.0f, -6.0f};

static struct rho_imm_model test_model(void)
{
    struct rho_imm_model model;

    rho_imm_model_default(&model, 60.0f, 600.0f);
    return model;
}

static void init_pool(void)
{
    const struct rho_imm_model model = test_model();

    assert_int_equal(rho_hypotheses_init(&pool, sizeof pool, &model), RHO_OK);
}

static struct rho_kalman estimate_at(float x_m, float y_m, float vx_mps)
{
    struct rho_kalman first;

    rho_kalman_init(&first);
    assert_int_equal(rho_kalman_open_axis(&first, 0, x_m, 100.0f, 100.0f), RHO_OK);
    assert_int_equal(rho_kalman_open_axis(&first, 1, y_m, 100.0f, 100.0f), RHO_OK);
    first.state[3] = vx_mps;
    return first;
}

static uint16_t open_track_at(struct rho_hypotheses *of, float x_m, float y_m, float vx_mps)
{
    const struct rho_kalman first = estimate_at(x_m, y_m, vx_mps);
    uint16_t slot = RHO_HYPOTHESES_SLOTS;

    assert_int_equal(rho_hypotheses_open(of, &first, 0, &slot), RHO_OK);
    assert_true(slot < RHO_HYPOTHESES_SLOTS);
    return slot;
}

static struct rho_plot plot_at(float x_m, float y_m)
{
    return (struct rho_plot){.x_m = x_m,
                             .y_m = y_m,
                             .sigma_range_m = 10.0f,
                             .sigma_cross_m = 10.0f,
                             .sigma_up_m = 10.0f,
                             .sigma_mps = 5.0f,
                             .sigma_range_rate_mps = 2.0f};
}

static void predict_track(struct rho_hypotheses *of, uint16_t slot, double time_s)
{
    assert_int_equal(rho_hypotheses_predict(of, slot, (int64_t)(1e6 * time_s)), RHO_OK);
}

static int score_plots(struct rho_hypotheses *of, uint16_t slot, double time_s,
                       const struct rho_plot *plots, int num, float *gain_nat)
{
    int num_near = 0;

    rho_hypotheses_gate_box(of, slot, NULL);
    for (int row = 0; row < num; ++row) {
        struct rho_imm_plot seen;

        rho_imm_prepare_plot(&seen, &plots[row], 0, NULL);
        num_near += rho_hypotheses_score_plot(of, slot, &seen,
                                              (int64_t)(1e6 * time_s) + plots[row].offset_us,
                                              (int16_t)row, -0.105f, &thin, gain_nat);
    }
    return num_near;
}

static struct rho_hypotheses_outcome commit_scan(struct rho_hypotheses *of, uint16_t slot,
                                                 double time_s, const struct rho_plot *plots,
                                                 const int16_t *claims, int16_t own_track)
{
    const struct rho_hypotheses_scan scan = {.time_us = (int64_t)(1e6 * time_s),
                                             .plots = plots,
                                             .log_miss = -2.3f,
                                             .claims = claims,
                                             .own = own_track};
    struct rho_hypotheses_outcome outcome = {.row = 77};

    assert_int_equal(rho_hypotheses_commit(of, slot, &scan, &outcome), RHO_OK);
    return outcome;
}

static struct rho_hypotheses_outcome run_scan(struct rho_hypotheses *of, uint16_t slot,
                                              double time_s, const struct rho_plot *plots, int num)
{
    float gain_nat = 0.0f;

    predict_track(of, slot, time_s);
    (void)score_plots(of, slot, time_s, plots, num, &gain_nat);
    return commit_scan(of, slot, time_s, plots, NULL, 0);
}

/* Each node of the pool belongs to one track's list or to the free list, and to one only. */
static void assert_each_node_is_used_once(const struct rho_hypotheses *of)
{
    static uint8_t uses[RHO_MAX_HYPOTHESES];

    memset(uses, 0, sizeof uses);
    for (unsigned i = 0; i < of->num_free; ++i) {
        uses[of->spare[i]]++;
    }
    for (uint16_t slot = 0; slot < RHO_HYPOTHESES_SLOTS; ++slot) {
        for (unsigned i = 0; i < rho_hypotheses_count(of, slot); ++i) {
            uses[rho_hypotheses_at(of, slot, i) - of->nodes]++;
        }
    }
    for (unsigned i = 0; i < RHO_MAX_HYPOTHESES; ++i) {
        assert_int_equal(uses[i], 1);
    }
}

static void assert_weights_fall_from_zero(const struct rho_hypotheses *of, uint16_t slot)
{
    const unsigned num = rho_hypotheses_count(of, slot);

    assert_in_range(num, 1, RHO_HYPOTHESES_OF_TRACK);
    assert_true(rho_hypotheses_at(of, slot, 0)->weight_nat == 0.0f);
    for (unsigned i = 1; i < num; ++i) {
        assert_true(rho_hypotheses_at(of, slot, i)->weight_nat <=
                    rho_hypotheses_at(of, slot, i - 1)->weight_nat);
    }
}

/*
 * ---- decisions that are corrected later --------------------------------------------------------
 */

/*
 * A target at 100 m/s is missed at the third scan, and a clutter plot lies 60 m beside its path.
 * The track takes that plot; after the seventh scan its state is that of a filter that missed it.
 */
static void a_clutter_plot_taken_by_mistake_is_undone_later(void **state)
{
    (void)state;
    init_pool();
    const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, 100.0f);
    struct rho_imm clean = rho_hypotheses_at(&pool, slot, 0)->imm;
    const struct rho_imm_model model = test_model();
    struct rho_imm_step step;

    rho_imm_prepare_step(&step, &model, 1.0f);
    for (int k = 1; k <= 7; ++k) {
        const struct rho_plot plot = plot_at(100.0f * (float)k, k == 3 ? 60.0f : 0.0f);
        const struct rho_hypotheses_outcome outcome = run_scan(&pool, slot, k, &plot, 1);

        assert_int_equal(outcome.row, 0);
        assert_weights_fall_from_zero(&pool, slot);
        assert_int_equal(rho_imm_predict(&clean, &step), RHO_OK);
        if (k != 3) {
            struct rho_imm_plot seen;
            struct rho_imm_match match;

            rho_imm_prepare_plot(&seen, &plot, 0, NULL);
            assert_true(rho_imm_score_plot(&clean, &seen, &match));
            assert_int_equal(rho_imm_update(&clean, &model, &seen, &match), RHO_OK);
        }
    }
    const struct rho_hypothesis *best = rho_hypotheses_at(&pool, slot, 0);
    for (int i = 0; i < RHO_IMM_STATES; ++i) {
        assert_float_equal(best->imm.state[i], clean.state[i],
                           1e-3 * sqrt(1e-6 + clean.covariance[RHO_AT(i, i)]));
    }
}

/*
 * Of hypotheses with the same latest plots only the best goes on, so that clutter taken long ago
 * does not fill the list.
 */
static void hypotheses_with_wrong_plots_do_not_survive(void **state)
{
    (void)state;
    init_pool();
    const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, 100.0f);

    for (int k = 1; k <= 3; ++k) { /* clutter on both sides of the target */
        const struct rho_plot plots[3] = {plot_at(100.0f * (float)k, 0.0f),
                                          plot_at(100.0f * (float)k, 30.0f),
                                          plot_at(100.0f * (float)k, -30.0f)};

        (void)run_scan(&pool, slot, k, plots, 3);
        for (unsigned i = 0; i < rho_hypotheses_count(&pool, slot); ++i) {
            for (unsigned j = 0; j < i; ++j) {
                assert_memory_not_equal(rho_hypotheses_at(&pool, slot, i)->picks,
                                        rho_hypotheses_at(&pool, slot, j)->picks,
                                        sizeof pool.nodes[0].picks);
            }
        }
    }
    assert_true(rho_hypotheses_count(&pool, slot) > 3);
    for (int k = 4; k <= 12; ++k) {
        const struct rho_plot plot = plot_at(100.0f * (float)k, 0.0f);

        assert_int_equal(run_scan(&pool, slot, k, &plot, 1).row, 0);
    }
    for (unsigned i = 0; i < rho_hypotheses_count(&pool, slot); ++i) {
        assert_float_equal(rho_hypotheses_at(&pool, slot, i)->imm.steady.state[1], 0.0, 1.0);
    }
}

static void plots_claimed_by_other_tracks_are_not_taken(void **state)
{
    const struct rho_plot plots[2] = {plot_at(100.0f, 1.0f), plot_at(100.0f, 12.0f)};
    static const struct {
        int16_t claims[2];
        int16_t row;
    } cases[] = {{{-1, -1}, 0}, {{5, -1}, 0}, {{3, -1}, 1},
                 {{-1, 3}, 0},  {{3, 3}, -1}, {{0, 5}, 1}};
    float gain_nat;

    (void)state;
    for (size_t k = 0; k < NUM(cases); ++k) {
        init_pool();
        const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, 100.0f);

        predict_track(&pool, slot, 1.0);
        assert_int_equal(score_plots(&pool, slot, 1.0, plots, 2, &gain_nat), 2);
        assert_int_equal(commit_scan(&pool, slot, 1.0, plots, cases[k].claims, 5).row,
                         cases[k].row);
    }
}

/*
 * The plot belongs to another track: the only hypothesis left is the miss, however likely the plot.
 */
static void a_good_plot_of_another_track_leaves_the_miss_hypothesis(void **state)
{
    static const int16_t claims[1] = {3};
    static const struct rho_hypotheses_clutter none = {-70.0f, 0.0f, 0.0f, 0.0f};
    const struct rho_plot plot = plot_at(100.0f, 0.0f);
    struct rho_imm_plot seen;
    float gain_nat = 0.0f;

    (void)state;
    init_pool();
    const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, 100.0f);
    predict_track(&pool, slot, 1.0);
    rho_hypotheses_gate_box(&pool, slot, NULL);
    rho_imm_prepare_plot(&seen, &plot, 0, NULL);
    assert_true(rho_hypotheses_score_plot(&pool, slot, &seen, 1000000, 0, -0.1f, &none, &gain_nat));
    assert_true(gain_nat > 40.0f);
    const struct rho_hypotheses_outcome outcome = commit_scan(&pool, slot, 1.0, &plot, claims, 5);
    assert_int_equal(outcome.row, RHO_HYPOTHESES_MISS);
    assert_float_equal(outcome.gain_nat, -2.3, 1e-5);
    assert_weights_fall_from_zero(&pool, slot);
}

/*
 * ---- the bounding box of gates ------------------------------------------------------------------
 */

/*
 * Any plot in a gate is in the box: with own times before and after, heights, thin ellipses, large
 * noise.
 */
static void plots_in_a_gate_are_inside_the_bounding_box(void **state)
{
    unsigned num_near = 0, num_late = 0, num_outside = 0;

    (void)state;
    for (int n = 0; n < 3000; ++n) {
        struct rho_imm_model model;
        struct rho_hypotheses_box reach;
        const float accel_mps2 = (float)pow(10.0, uniform(0.0, 2.5));
        const uint32_t z = n % 5 ? 0u : RHO_MEASURES_Z;

        rho_imm_model_default(&model, accel_mps2, 600.0f);
        assert_int_equal(rho_hypotheses_init(&pool, sizeof pool, &model), RHO_OK);
        const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, (float)uniform(-300.0, 300.0));
        const double time_s = pow(10.0, uniform(-1.0, 1.0)), lag_s = n % 3 ? time_s : 0.0;

        for (int k = 1; k <= n % 8; ++k) { /* the filter learns an acceleration */
            const double t = 0.25 * k;
            const struct rho_plot plot = plot_at((float)(0.4 * accel_mps2 * t * t), 0.0f);
            struct rho_imm_plot seen;

            predict_track(&pool, slot, t);
            rho_imm_prepare_plot(&seen, &plot, z, NULL);
            assert_int_equal(rho_hypotheses_update(&pool, slot, &seen, (int64_t)(1e6 * t)), RHO_OK);
        }
        predict_track(&pool, slot, 2.0 + time_s);
        rho_hypotheses_gate_box(&pool, slot, &reach);
        const struct rho_imm *imm = &rho_hypotheses_at(&pool, slot, 0)->imm;
        for (int k = 0; k < 40; ++k) {
            const double offset_s = uniform(-lag_s, lag_s), far = uniform(0.5, 5.0);
            const double noise = pow(10.0, uniform(0.0, 2.0));
            struct rho_plot plot = plot_at(0.0f, 0.0f);
            struct rho_imm_plot seen;
            struct rho_imm_step step;
            struct rho_imm moved = *imm;
            float gain_nat;

            rho_imm_prepare_step(&step, &model, (float)offset_s);
            if (rho_imm_predict_unmixed(&moved, &step) != RHO_OK) {
                continue;
            }
            const double spread = sqrt(moved.covariance[0] + noise * noise);
            plot.x_m = moved.state[0] + (float)(far * spread * (k % 2 ? 1.0 : -1.0));
            plot.y_m = moved.state[1] + (float)(0.3 * far * spread * normal());
            plot.z_m = moved.state[2] +
                       (float)(0.3 * far * sqrt(moved.covariance[5] + noise * noise) * normal());
            /* without a height in the track, the plot's may be anything */
            plot.z_m += moved.covariance[5] > 0.0f ? 0.0f : 3000.0f;
            plot.offset_us = (int32_t)(1e6 * offset_s);
            plot.sigma_range_m = (float)noise;
            plot.sigma_cross_m = (float)(n % 2 ? noise : pow(10.0, uniform(0.0, 2.0)));
            plot.sigma_up_m = plot.sigma_cross_m;
            rho_imm_prepare_plot(&seen, &plot, z, NULL);
            if (rho_hypotheses_score_plot(&pool, slot, &seen,
                                          (int64_t)(1e6 * (2.0 + time_s)) + plot.offset_us, 0,
                                          -0.1f, &thin, &gain_nat)) {
                num_near++;
                num_late += lag_s > 0.0;
                num_outside += !rho_hypotheses_is_in_box(&pool, slot, &reach, &plot, z);
            }
        }
    }
    assert_true(num_near > 10000 && num_late > 10000);
    assert_int_equal(num_outside, 0);
}

/* ---- the pool -------------------------------------------------------------------------------- */

/* Plots around a track that give it its largest number of hypotheses, eight. */
static void scan_with_plots_for_eight_hypotheses(struct rho_hypotheses *of, uint16_t slot,
                                                 double time_s, float x_m, float y_m)
{
    struct rho_plot plots[5];

    for (int i = 0; i < 5; ++i) {
        plots[i] = plot_at(x_m + 14.0f * (float)(i - 2), y_m + 9.0f * (float)(i % 2));
    }
    (void)run_scan(of, slot, time_s, plots, 5);
}

static void a_full_pool_is_shared_equally_among_tracks(void **state)
{
    const unsigned num_tracks = RHO_MAX_TRACKS;
    unsigned least = 99, most = 0;
    uint16_t slots[RHO_MAX_TRACKS];

    (void)state;
    init_pool();
    for (unsigned i = 0; i < num_tracks; ++i) {
        slots[i] = open_track_at(&pool, 0.0f, 1000.0f * (float)i, 0.0f);
    }
    for (int k = 1; k <= 3; ++k) {
        for (unsigned i = 0; i < num_tracks; ++i) {
            const struct rho_hypothesis *best = rho_hypotheses_at(&pool, slots[i], 0);
            const float weight = best->weight_nat;

            assert_true(weight == 0.0f);
            scan_with_plots_for_eight_hypotheses(&pool, slots[i], k, 0.0f, 1000.0f * (float)i);
            assert_weights_fall_from_zero(&pool, slots[i]);
        }
        assert_each_node_is_used_once(&pool);
    }
    for (unsigned i = 0; i < num_tracks; ++i) {
        const unsigned num = rho_hypotheses_count(&pool, slots[i]);

        assert_weights_fall_from_zero(&pool, slots[i]);
        least = num < least ? num : least;
        most = num > most ? num : most;
    }
    /* all nodes are used, and the numbers of hypotheses of any two tracks differ by one at most */
    assert_int_equal(pool.num_free, 0);
    assert_true(pool.hypotheses_cut > 0);
    assert_true(most <= least + 1);
}

/* An added hypothesis is listed by its weight; of a full slot it replaces the lightest. */
static void an_added_hypothesis_is_listed_by_its_weight(void **state)
{
    struct rho_kalman estimate;

    (void)state;
    init_pool();
    const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, 0.0f);
    estimate = rho_hypotheses_at(&pool, slot, 0)->imm.steady;
    for (int i = 0; i < RHO_HYPOTHESES_OF_TRACK + 1; ++i) {
        estimate.state[0] = (float)i;
        rho_hypotheses_add(&pool, slot, &estimate, 0, i % 2 ? -2.0f - (float)i : -1.0f);
        assert_weights_fall_from_zero(&pool, slot);
        assert_each_node_is_used_once(&pool);
    }
    assert_int_equal(rho_hypotheses_count(&pool, slot), RHO_HYPOTHESES_OF_TRACK);
    assert_true(rho_hypotheses_at(&pool, slot, 1)->imm.steady.state[0] == 0.0f);
    assert_true(rho_hypotheses_at(&pool, slot, 5)->imm.steady.state[0] == 8.0f);
}

/* A new track gets one node as long as another track has two. */
static void a_new_track_in_a_full_pool_gets_a_node_of_another_track(void **state)
{
    unsigned num = 0, num_given = 0;

    (void)state;
    init_pool();
    while (num < RHO_HYPOTHESES_SLOTS && num < RHO_MAX_HYPOTHESES) {
        struct rho_kalman first = estimate_at(0.0f, 1000.0f * (float)num, 0.0f);
        const uint32_t cut = pool.hypotheses_cut + (pool.num_free == 0);
        uint16_t slot;

        if (rho_hypotheses_open(&pool, &first, 0, &slot) != RHO_OK) {
            break;
        }
        assert_int_equal(slot, num++);
        assert_int_equal(pool.hypotheses_cut, cut);
        num_given += pool.num_free == 0;
        if (num <= RHO_MAX_HYPOTHESES / RHO_HYPOTHESES_OF_TRACK) {
            for (int k = 1; k <= 3; ++k) {
                scan_with_plots_for_eight_hypotheses(&pool, slot, k, 0.0f, 1000.0f * (float)slot);
            }
        }
        assert_int_equal(rho_hypotheses_count(&pool, slot) > 0, 1);
    }
    assert_int_equal(num, RHO_HYPOTHESES_SLOTS);
    assert_true(num_given > 0);
    assert_each_node_is_used_once(&pool);
    for (uint16_t slot = 0; slot < RHO_HYPOTHESES_SLOTS; ++slot) {
        assert_true(rho_hypotheses_count(&pool, slot) >= 1);
    }
    const struct rho_kalman one_more = estimate_at(0.0f, 0.0f, 0.0f);
    uint16_t slot = 12345;
    memcpy(&copy, &pool, sizeof pool);
    assert_int_equal(rho_hypotheses_open(&pool, &one_more, 0, &slot), RHO_ERROR_CAPACITY);
    assert_int_equal(slot, 12345);
    assert_memory_equal(&copy, &pool, sizeof pool);
    rho_hypotheses_close(&pool, 3);
    assert_int_equal(rho_hypotheses_open(&pool, &one_more, 0, &slot), RHO_OK);
    assert_int_equal(slot, 3);
}

/*
 * Tracks are opened, closed, and get random plots. A copy of the pool, given the same calls, must
 * have the same bytes.
 */
static void make_random_calls(struct rho_hypotheses *of, int num_calls, int32_t *now_s)
{
    for (int n = 0; n < num_calls; ++n) {
        const uint16_t slot =
            (uint16_t)uniform(0.0, RHO_HYPOTHESES_SLOTS < 40.0 ? RHO_HYPOTHESES_SLOTS : 40.0);
        const double choice = uniform(0.0, 1.0);

        if (rho_hypotheses_count(of, slot) == 0) {
            const struct rho_kalman first = estimate_at(0.0f, (float)(int)uniform(-9.0, 9.0), 1.0f);
            uint16_t opened;

            assert_int_equal(rho_hypotheses_open(of, &first, INT64_C(1000000) * *now_s, &opened),
                             RHO_OK);
        } else if (choice < 0.03) {
            rho_hypotheses_close(of, slot);
            assert_int_equal(rho_hypotheses_count(of, slot), 0);
        } else {
            struct rho_plot plots[5];
            const int num = choice < 0.5 ? 5 : (int)uniform(0.0, 3.0);
            const struct rho_imm *imm = &rho_hypotheses_at(of, slot, 0)->imm;

            for (int i = 0; i < num; ++i) {
                const float x_m = imm->state[0] + (float)(30.0 * normal());

                plots[i] = plot_at(x_m, imm->state[1] + (float)(30.0 * normal()));
                plots[i].offset_us = choice < 0.2 ? (int32_t)uniform(-3e5, 3e5) : 0;
            }
            (void)run_scan(of, slot, *now_s, plots, num);
            assert_weights_fall_from_zero(of, slot);
        }
        *now_s += n % 40 == 39;
    }
}

static void random_calls_lose_no_node_and_a_copy_stays_identical(void **state)
{
    int32_t now_s = 1;

    (void)state;
    init_pool();
    for (int k = 0; k < 20; ++k) {
        make_random_calls(&pool, 200, &now_s);
        assert_each_node_is_used_once(&pool);
    }
    memcpy(&copy, &pool, sizeof pool);
    const uint64_t seed = dense_seed;
    int32_t later_s = now_s;
    make_random_calls(&pool, 500, &now_s);
    dense_seed = seed;
    make_random_calls(&copy, 500, &later_s);
    assert_memory_equal(&copy, &pool, sizeof pool);
    for (uint16_t slot = 0; slot < RHO_HYPOTHESES_SLOTS; ++slot) {
        rho_hypotheses_close(&pool, slot);
    }
    assert_int_equal(pool.num_free, RHO_MAX_HYPOTHESES);
    assert_each_node_is_used_once(&pool);
}

/*
 * ---- refused updates and predictions ------------------------------------------------------------
 */

/*
 * The plots are NAN and infinite when their hypotheses are updated: these keep the predicted state
 * and count as misses.
 */
static void a_refused_update_becomes_a_miss_and_is_counted(void **state)
{
    (void)state;
    for (int has_own_time = 0; has_own_time < 2; ++has_own_time) {
        float gain_nat;

        init_pool();
        const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, 100.0f);
        struct rho_plot plots[2] = {plot_at(100.0f, 3.0f), plot_at(100.0f, 5.0f)};

        predict_track(&pool, slot, 1.0);
        const struct rho_imm predicted = rho_hypotheses_at(&pool, slot, 0)->imm;
        plots[0].offset_us = plots[1].offset_us = has_own_time ? 100000 : 0;
        assert_int_equal(score_plots(&pool, slot, 1.0, plots, 2, &gain_nat), 2);
        plots[0].x_m = NAN;
        plots[1].y_m = INFINITY;
        assert_int_equal(commit_scan(&pool, slot, 1.0, plots, NULL, 0).row, RHO_HYPOTHESES_MISS);
        assert_int_equal(pool.updates_refused, 2);
        for (unsigned i = 0; i < rho_hypotheses_count(&pool, slot); ++i) {
            const struct rho_hypothesis *at = rho_hypotheses_at(&pool, slot, i);

            assert_memory_equal(&at->imm, &predicted, sizeof predicted);
            assert_true(at->time_us == 1000000);
            assert_int_equal(at->picks[RHO_HYPOTHESES_MEMORY - 1], RHO_HYPOTHESES_MISS);
        }
        pool.updates_refused = UINT32_MAX - 1;
        plots[0] = plots[1] = plot_at(200.0f, 0.0f);
        predict_track(&pool, slot, 2.0);
        assert_true(score_plots(&pool, slot, 2.0, plots, 2, &gain_nat) > 0);
        plots[0].x_m = plots[1].x_m = NAN;
        (void)commit_scan(&pool, slot, 2.0, plots, NULL, 0);
        assert_true(pool.updates_refused == UINT32_MAX);
    }
}

static void hypotheses_that_cannot_be_predicted_are_dropped(void **state)
{
    (void)state;
    init_pool();
    const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, 100.0f);

    scan_with_plots_for_eight_hypotheses(&pool, slot, 1.0, 100.0f, 0.0f);
    const unsigned num = rho_hypotheses_count(&pool, slot);
    assert_true(num > 2);
    pool.nodes[rho_hypotheses_at(&pool, slot, 0) - pool.nodes].imm.state[0] = NAN;
    predict_track(&pool, slot, 2.0);
    assert_int_equal(rho_hypotheses_count(&pool, slot), num - 1);
    assert_weights_fall_from_zero(&pool, slot);
    assert_each_node_is_used_once(&pool);
    assert_int_equal(rho_hypotheses_predict(&pool, slot, INT64_C(90000000000)), RHO_ERROR_VALUE);
    assert_int_equal(rho_hypotheses_count(&pool, slot), 0);
    assert_each_node_is_used_once(&pool);
    assert_int_equal(pool.num_free, RHO_MAX_HYPOTHESES);
}

/*
 * ---- plots and bearings known to be the target's ------------------------------------------------
 */

static void all_hypotheses_are_updated_with_a_plot_known_to_be_the_targets(void **state)
{
    (void)state;
    for (int n = 0; n < 4; ++n) {
        const double offset_s = n % 2 ? -0.2 : 0.0;
        struct rho_imm expected[RHO_HYPOTHESES_OF_TRACK];
        struct rho_hypothesis before[RHO_HYPOTHESES_OF_TRACK];
        const struct rho_imm_model model = test_model();
        /* a plot far outside all gates is taken, too */
        const struct rho_plot plot = plot_at(n < 2 ? 200.0f : 2000.0f, 10.0f);
        struct rho_imm_plot seen;
        struct rho_imm_step step;

        init_pool();
        const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, 100.0f);
        scan_with_plots_for_eight_hypotheses(&pool, slot, 1.0, 100.0f, 0.0f);
        predict_track(&pool, slot, 2.0);
        rho_imm_prepare_plot(&seen, &plot, 0, NULL);
        rho_imm_prepare_step(&step, &model, (float)offset_s);
        const unsigned num = rho_hypotheses_count(&pool, slot);
        for (unsigned i = 0; i < num; ++i) {
            struct rho_imm_match match;

            before[i] = *rho_hypotheses_at(&pool, slot, i);
            expected[i] = before[i].imm;
            if (offset_s < 0.0) {
                assert_int_equal(rho_imm_predict_unmixed(&expected[i], &step), RHO_OK);
            }
            if (!rho_imm_score_plot(&expected[i], &seen, &match)) {
                match.probability = expected[i].probability;
            }
            assert_int_equal(rho_imm_update(&expected[i], &model, &seen, &match), RHO_OK);
        }
        const int64_t time_us = 2000000 + (offset_s < 0.0 ? -200000 : 0);
        assert_int_equal(rho_hypotheses_update(&pool, slot, &seen, time_us), RHO_OK);
        assert_int_equal(rho_hypotheses_count(&pool, slot), num);
        for (unsigned i = 0; i < num; ++i) {
            const struct rho_hypothesis *at = rho_hypotheses_at(&pool, slot, i);

            assert_memory_equal(&at->imm, &expected[i], sizeof expected[i]);
            assert_true(at->time_us == time_us && at->weight_nat == before[i].weight_nat);
        }
    }
}

/*
 * A prediction back by 300 s, many times the memory of an acceleration, has no estimate: the update
 * is refused and the hypotheses stay.
 */
static void a_plot_or_bearing_that_is_too_old_changes_nothing(void **state)
{
    const struct rho_plot plot = plot_at(100.0f, 0.0f);
    struct rho_imm_plot seen;

    (void)state;
    rho_imm_prepare_plot(&seen, &plot, 0, NULL);
    for (int is_bearing = 0; is_bearing < 2; ++is_bearing) {
        init_pool();
        const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, 100.0f);

        scan_with_plots_for_eight_hypotheses(&pool, slot, 1.0, 100.0f, 0.0f);
        const unsigned num = rho_hypotheses_count(&pool, slot);
        memcpy(&copy, &pool, sizeof pool);
        struct one_bearing at;
        const enum rho_status status =
            is_bearing ? rho_hypotheses_update_bearings(
                             &pool, slot, INT64_C(-300000000),
                             one_bearing(&at, INT64_C(-300000000), 0.0f, -5000.0f, 1.57f, 0.01f))
                       : rho_hypotheses_update(&pool, slot, &seen, INT64_C(-300000000));
        assert_int_equal(status, RHO_ERROR_VALUE);
        assert_int_equal(pool.updates_refused, num);
        for (unsigned i = 0; i < num; ++i) {
            assert_memory_equal(rho_hypotheses_at(&pool, slot, i),
                                rho_hypotheses_at(&copy, slot, i), sizeof(struct rho_hypothesis));
        }
        predict_track(&pool, slot, 2.0);
        assert_int_equal(rho_hypotheses_count(&pool, slot), num);
    }
}

/*
 * A hypothesis whose bearing is predicted badly loses weight: here the second one becomes the best.
 */
static void a_bearing_reorders_the_hypotheses_by_likelihood(void **state)
{
    (void)state;
    init_pool();
    const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, 0.0f);
    const struct rho_plot plots[2] = {plot_at(20.0f, 0.0f), plot_at(-21.0f, 0.0f)};
    double expected[RHO_HYPOTHESES_OF_TRACK], best = -1e9;

    (void)run_scan(&pool, slot, 1.0, plots, 2);
    predict_track(&pool, slot, 2.0);
    const unsigned num = rho_hypotheses_count(&pool, slot);
    assert_true(num >= 2 && rho_hypotheses_at(&pool, slot, 0)->picks[2] == 0);
    for (unsigned i = 0; i < num; ++i) {
        struct rho_imm imm = rho_hypotheses_at(&pool, slot, i)->imm;
        float gain_nat;

        assert_int_equal(
            update_imm_by_bearing(&imm, -21.0f, -9000.0f, 1.5707963f, 1e-4f, &gain_nat), RHO_OK);
        expected[i] = (double)rho_hypotheses_at(&pool, slot, i)->weight_nat + gain_nat;
        best = fmax(best, expected[i]);
    }
    memcpy(&copy, &pool, sizeof pool);
    struct one_bearing from;
    assert_int_equal(
        rho_hypotheses_update_bearings(
            &pool, slot, 2000000, one_bearing(&from, 2000000, -21.0f, -9000.0f, 1.5707963f, 1e-4f)),
        RHO_OK);
    assert_int_equal(rho_hypotheses_at(&pool, slot, 0)->picks[2], 1);
    assert_weights_fall_from_zero(&pool, slot);
    for (unsigned i = 0; i < num; ++i) {
        const struct rho_hypothesis *was = rho_hypotheses_at(&copy, slot, i);

        for (unsigned k = 0; k < num; ++k) {
            const struct rho_hypothesis *at = rho_hypotheses_at(&pool, slot, k);

            if (at->picks[2] == was->picks[2]) {
                assert_float_equal(at->weight_nat, expected[i] - best, 1e-4);
            }
        }
    }
    assert_each_node_is_used_once(&pool);
}

/* ---- arguments ------------------------------------------------------------------------------- */

static void arguments_are_checked(void **state)
{
    const struct rho_imm_model model = test_model();
    struct rho_imm_model bad = model;
    const struct rho_kalman first = estimate_at(0.0f, 0.0f, 0.0f);
    const struct rho_plot plot = plot_at(0.0f, 0.0f);
    const struct rho_hypotheses_scan scan = {.plots = &plot};
    struct rho_hypotheses_outcome outcome;
    struct rho_hypotheses_estimate estimate;
    struct rho_imm_plot seen;
    struct one_bearing at;
    uint16_t slot = 7;
    float gain_nat = 7.0f;

    (void)state;
    rho_imm_prepare_plot(&seen, &plot, 0, NULL);
    bad.memory_s = 0.0f;
    assert_int_equal(rho_hypotheses_init(&pool, sizeof pool - 1, &model), RHO_ERROR_SIZE);
    assert_int_equal(rho_hypotheses_init(&pool, sizeof pool, &bad), RHO_ERROR_CONFIG);
    init_pool();
    memcpy(&copy, &pool, sizeof pool);
    for (int k = 0; k < 3; ++k) {
        static const uint16_t no_slots[] = {0, RHO_HYPOTHESES_SLOTS, UINT16_MAX};
        const uint16_t none = no_slots[k];

        assert_int_equal(rho_hypotheses_predict(&pool, none, 0), RHO_ERROR_STATE);
        assert_int_equal(rho_hypotheses_commit(&pool, none, &scan, &outcome), RHO_ERROR_STATE);
        assert_int_equal(rho_hypotheses_update(&pool, none, &seen, 0), RHO_ERROR_STATE);
        assert_int_equal(rho_hypotheses_update_bearings(
                             &pool, none, 0, one_bearing(&at, 0, 0.0f, 0.0f, 0.0f, 0.1f)),
                         RHO_ERROR_STATE);
        assert_int_equal(
            rho_hypotheses_score_bearing(&pool, none, &at.look, 0, &gain_nat, &gain_nat), 0);
        assert_int_equal(rho_hypotheses_estimate(&pool, none, 0, &estimate), RHO_ERROR_STATE);
        assert_int_equal(
            rho_hypotheses_score_plot(&pool, none, &seen, 0, 0, 0.0f, &thin, &gain_nat), 0);
        assert_int_equal(rho_hypotheses_count(&pool, none), 0);
        assert_null(rho_hypotheses_at(&pool, none, 0));
        rho_hypotheses_close(&pool, none);
        rho_hypotheses_gate_box(&pool, none, NULL);
    }
    assert_memory_equal(&copy, &pool, sizeof pool);
    assert_int_equal(rho_hypotheses_open(&pool, &first, 0, &slot), RHO_OK);
    assert_true(gain_nat == 7.0f);
    assert_int_equal(rho_hypotheses_count(&pool, slot), 1);
}

/*
 * The margin is at least sqrt(RHO_IMM_GATE) sigmas of the plot, and for a plot at another time as
 * much more as the target may move.
 */
static void the_box_margin_grows_with_noise_and_own_time(void **state)
{
    struct rho_hypotheses_box box;

    (void)state;
    init_pool();
    const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, 100.0f);
    predict_track(&pool, slot, 1.0);
    rho_hypotheses_gate_box(&pool, slot, &box);
    const float margin_m = rho_hypotheses_box_margin_m(&pool, slot, &box, 20.0f, 0.0f);
    assert_true(margin_m >= sqrtf(RHO_IMM_GATE) * 20.0f && margin_m <= 2.0f * 20.0f * 6.0f);
    assert_float_equal(rho_hypotheses_box_margin_m(&pool, slot, &box, 40.0f, 0.0f), 2.0f * margin_m,
                       1e-3);
    assert_true(rho_hypotheses_box_margin_m(&pool, slot, &box, 20.0f, 1.0f) >=
                margin_m + 100.0f); /* a second later at 100 m/s */
}

/* Moved back without noise and forward again, a track has its place, velocity and variance back. */
static void prediction_back_without_noise_is_reversible(void **state)
{
    (void)state;
    init_pool();
    const uint16_t slot = open_track_at(&pool, 500.0f, -200.0f, 100.0f);
    predict_track(&pool, slot, 4.0);
    const struct rho_imm was = rho_hypotheses_at(&pool, slot, 0)->imm;
    assert_int_equal(rho_hypotheses_move(&pool, slot, 1000000), RHO_OK);
    const struct rho_imm *imm = &rho_hypotheses_at(&pool, slot, 0)->imm;
    assert_float_equal(imm->state[0], was.state[0] - 3.0f * was.state[3], 0.1);
    assert_int_equal(rho_hypotheses_move(&pool, slot, 4000000), RHO_OK);
    for (int i = 0; i < RHO_IMM_STATES; ++i) {
        assert_float_equal(imm->state[i], was.state[i], 1e-3 * (1.0 + fabs(was.state[i])));
    }
    assert_float_equal(imm->covariance[0], was.covariance[0], 0.01 * was.covariance[0]);
    assert_int_equal(rho_hypotheses_move(&pool, slot + 1, 0), RHO_ERROR_STATE);
    const float was_m2ps2 =
        pool.nodes[pool.node_of[slot][0]].imm.steady.covariance[RHO_AT(RHO_VY, RHO_VY)];
    rho_hypotheses_loosen(&pool, slot, 100.0f);
    assert_true(pool.nodes[pool.node_of[slot][0]].imm.steady.covariance[RHO_AT(RHO_VY, RHO_VY)] >
                was_m2ps2 + 99.0f);
}

/* The pool's steps follow the new mean interval; a model without calm targets ignores it. */
static void the_mean_calm_interval_can_be_changed(void **state)
{
    struct rho_imm_model model = test_model();
    struct rho_imm_step expected;

    (void)state;
    assert_true(model.calm_s > 0.0f);
    init_pool();
    const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, 100.0f);
    predict_track(&pool, slot, 2.0);
    rho_hypotheses_set_calm_s(&pool, 90.0f);
    model.calm_s = 90.0f;
    rho_imm_prepare_step(&expected, &model, 2.0f);
    assert_memory_equal(&pool.model, &model, sizeof model);
    assert_memory_equal(&pool.step, &expected, sizeof expected);

    model.calm_s = 0.0f;
    assert_int_equal(rho_hypotheses_init(&pool, sizeof pool, &model), RHO_OK);
    rho_hypotheses_set_calm_s(&pool, 90.0f);
    assert_memory_equal(&pool.model, &model, sizeof model);
}

/* The mean calm interval that was learned stays; an invalid model is refused. */
static void the_motion_model_of_a_pool_can_be_replaced(void **state)
{
    struct rho_imm_model model = test_model();
    struct rho_imm_step expected;
    static struct rho_hypotheses before;

    (void)state;
    init_pool();
    const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, 100.0f);
    predict_track(&pool, slot, 2.0);
    rho_hypotheses_set_calm_s(&pool, 90.0f);
    model.drive_density *= 9.0f;
    assert_int_equal(rho_hypotheses_set_model(&pool, &model), RHO_OK);
    model.calm_s = 90.0f;
    rho_imm_prepare_step(&expected, &model, 2.0f);
    assert_memory_equal(&pool.model, &model, sizeof model);
    assert_memory_equal(&pool.step, &expected, sizeof expected);
    assert_int_equal(rho_hypotheses_count(&pool, slot), 1);

    memcpy(&before, &pool, sizeof pool);
    model.memory_s = NAN;
    assert_int_equal(rho_hypotheses_set_model(&pool, &model), RHO_ERROR_CONFIG);
    assert_memory_equal(&pool, &before, sizeof pool);
}

/* One damage at a time: a node with two owners, a wrong count, NAN, an invalid model, zeros. */
static void a_damaged_pool_is_not_sound(void **state)
{
    (void)state;
    init_pool();
    const uint16_t slot = open_track_at(&pool, 0.0f, 0.0f, 100.0f);
    const uint16_t other = open_track_at(&pool, 900.0f, 0.0f, 100.0f);
    predict_track(&pool, slot, 1.0);
    assert_true(rho_hypotheses_is_sound(&pool));
    copy = pool;
    pool.node_of[slot][0] = pool.node_of[other][0];
    assert_false(rho_hypotheses_is_sound(&pool));
    pool = copy;
    pool.num_free--;
    assert_false(rho_hypotheses_is_sound(&pool));
    pool = copy;
    pool.num_of[slot] = RHO_HYPOTHESES_OF_TRACK + 1;
    assert_false(rho_hypotheses_is_sound(&pool));
    pool = copy;
    pool.nodes[pool.node_of[slot][0]].imm.state[0] = NAN;
    assert_false(rho_hypotheses_is_sound(&pool));
    pool = copy;
    pool.model.memory_s = 0.0f;
    assert_false(rho_hypotheses_is_sound(&pool));
    pool = copy;
    memset(&pool, 0, sizeof pool);
    assert_false(rho_hypotheses_is_sound(&pool));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_clutter_plot_taken_by_mistake_is_undone_later),
        cmocka_unit_test(hypotheses_with_wrong_plots_do_not_survive),
        cmocka_unit_test(plots_claimed_by_other_tracks_are_not_taken),
        cmocka_unit_test(a_good_plot_of_another_track_leaves_the_miss_hypothesis),
        cmocka_unit_test(plots_in_a_gate_are_inside_the_bounding_box),
        cmocka_unit_test(a_full_pool_is_shared_equally_among_tracks),
        cmocka_unit_test(an_added_hypothesis_is_listed_by_its_weight),
        cmocka_unit_test(a_new_track_in_a_full_pool_gets_a_node_of_another_track),
        cmocka_unit_test(random_calls_lose_no_node_and_a_copy_stays_identical),
        cmocka_unit_test(a_refused_update_becomes_a_miss_and_is_counted),
        cmocka_unit_test(hypotheses_that_cannot_be_predicted_are_dropped),
        cmocka_unit_test(all_hypotheses_are_updated_with_a_plot_known_to_be_the_targets),
        cmocka_unit_test(a_plot_or_bearing_that_is_too_old_changes_nothing),
        cmocka_unit_test(a_bearing_reorders_the_hypotheses_by_likelihood),
        cmocka_unit_test(arguments_are_checked),
        cmocka_unit_test(the_box_margin_grows_with_noise_and_own_time),
        cmocka_unit_test(prediction_back_without_noise_is_reversible),
        cmocka_unit_test(the_mean_calm_interval_can_be_changed),
        cmocka_unit_test(the_motion_model_of_a_pool_can_be_replaced),
        cmocka_unit_test(a_damaged_pool_is_not_sound),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
