/* SPDX-License-Identifier: MIT */
/*
 * The work limit of a search: piles, lines, clusters and huge noise cost no more than work_max and
 * the constant that the header states; targets beside them are found, and plots that were not tried
 * are counted.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "random_draws.h"
#include "rhotrack/initiator.h"
#include "rhotrack/snapshot.h"

#define SCAN_S 4.0
#define WINDOW 7
#define TARGETS 20
#define NUM(array) (sizeof(array) / sizeof((array)[0]))

/*
 * As many plots as the embedded profile holds; in the workstation profile a number whose search
 * without a limit did not end.
 */
#define MANY (RHO_MAX_PLOTS < 2000 + TARGETS ? RHO_MAX_PLOTS - TARGETS : 2000)

static struct rho_initiator initiator, other;
static struct rho_plot plots[RHO_MAX_PLOTS];
static uint32_t num_plots;

static void add_plot(double x_m, double y_m, double sigma_m)
{
    if (num_plots < RHO_MAX_PLOTS) {
        plots[num_plots++] = (struct rho_plot){.x_m = (float)x_m,
                                               .y_m = (float)y_m,
                                               .sigma_range_m = (float)sigma_m,
                                               .sigma_cross_m = (float)sigma_m};
    }
}

static void add_pile_of_plots(int count)
{
    for (int i = 0; i < count; i++) {
        double x_m = uniform(-25020.0, -24980.0);
        add_plot(x_m, uniform(9980.0, 10020.0), 30.0);
    }
}

static void add_line_of_plots(int count)
{
    for (int i = 0; i < count; i++) {
        add_plot(-25000.0 + 20.0 * i, 10000.0 + uniform(-30.0, 30.0), 30.0);
    }
}

static void add_clusters_of_plots(int count)
{
    for (int i = 0; i < count; i++) {
        double x_m = -30000.0 + 600.0 * (i % 10) + uniform(-60.0, 60.0);
        add_plot(x_m, 10000.0 + uniform(-60.0, 60.0), 30.0);
    }
}

static void add_plots_of_huge_noise(int count)
{
    for (int i = 0; i < count; i++) {
        double x_m = uniform(-50000.0, 50000.0);
        add_plot(x_m, uniform(-50000.0, 50000.0), 50000.0);
    }
}

static void add_uniform_clutter(int count)
{
    for (int i = 0; i < count; i++) {
        double x_m = uniform(-80000.0, 80000.0);
        add_plot(x_m, uniform(-80000.0, 80000.0), 30.0);
    }
}

static double target_x_m(int target, int k)
{
    return 10000.0 + 3000.0 * target + 200.0 * SCAN_S * k;
}

static double target_y_m(int target)
{
    return -40000.0 + 4000.0 * target;
}

static void add_target_plots(int k)
{
    for (int i = 0; i < TARGETS; i++) {
        double x_m = target_x_m(i, k) + uniform(-30.0, 30.0);
        add_plot(x_m, target_y_m(i) + uniform(-30.0, 30.0), 30.0);
    }
}

static void init_with_limit(uint32_t work_max)
{
    struct rho_initiator_config config;
    rho_initiator_config_default(&config);
    config.v_max_mps = 350.0f;
    config.work_max = work_max;
    config.area_is_fixed = 1;
    config.area = (struct rho_extent){-100000.0f, 100000.0f, -100000.0f, 100000.0f};
    random_state = 11;
    num_plots = 0;
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &config), RHO_OK);
}

/*
 * Pushes the plots as a scan of two sensors in turn, for which M counts for every span, so that the
 * limit alone skips kernels.
 */
static void push_scan(int k)
{
    static uint8_t fates[RHO_MAX_PLOTS];
    uint32_t unused = 0;
    memset(fates, RHO_FATE_HELD, sizeof fates);
    struct rho_scan scan = {.time_us = (int64_t)(SCAN_S * 1e6) * k,
                            .sensor_id = k % 2,
                            .num_plots = num_plots,
                            .plots = plots};
    assert_int_equal(rho_initiator_push(&initiator, &scan, NULL, fates, &unused), RHO_OK);
    num_plots = 0;
}

static void search_newest(void)
{
    assert_int_equal(rho_initiator_search(&initiator, RHO_SEARCH_NEWEST), RHO_OK);
}

static const struct {
    const char *name;
    void (*add)(int count);
} skies[] = {{"pile", add_pile_of_plots},
             {"line", add_line_of_plots},
             {"clusters", add_clusters_of_plots},
             {"huge noise", add_plots_of_huge_noise}};

static void no_arrangement_of_plots_exceeds_the_work_limit(void **state)
{
    static const uint32_t limits[] = {1000, RHO_WORK_MAX / 4u, RHO_WORK_MAX};
    (void)state;
    for (size_t s = 0; s < NUM(skies); s++) {
        for (size_t l = 0; l < NUM(limits); l++) {
            init_with_limit(limits[l]);
            for (int k = 0; k < WINDOW + 2; k++) {
                skies[s].add(MANY);
                push_scan(k);
                search_newest();
                assert_true(initiator.budget.work <= limits[l] + RHO_INITIATOR_WORK_BEYOND);
            }
            print_message("%s of %d, limit %u: worst %u\n", skies[s].name, MANY,
                          (unsigned)limits[l], (unsigned)initiator.budget.work_worst);
            assert_true(initiator.budget.partial_steps > 0);
            assert_true(initiator.budget.plots_not_tried >= initiator.budget.partial_steps);
        }
    }
}

/* In a batch each scan in which a track may end has the limit for itself. */
static void a_batch_search_is_limited_by_scan(void **state)
{
    (void)state;
    init_with_limit(RHO_WORK_MAX / 4u);
    for (int k = 0; k < WINDOW; k++) {
        add_pile_of_plots(MANY);
        push_scan(k);
    }
    assert_int_equal(rho_initiator_search(&initiator, RHO_SEARCH_BATCH), RHO_OK);
    assert_true(initiator.budget.work <=
                (WINDOW - 2) * (RHO_WORK_MAX / 4u) + RHO_INITIATOR_WORK_BEYOND);
    assert_int_equal(initiator.budget.partial_steps, 1);
}

static int count_targets_found(int k)
{
    int found = 0;
    for (int t = 0; t < TARGETS; t++) {
        for (unsigned i = 0; i < initiator.num_candidates; i++) {
            const struct rho_candidate *candidate = &initiator.candidates[i];
            if (fabs((double)candidate->x_m - target_x_m(t, k)) < 200.0 &&
                fabs((double)candidate->y_m - target_y_m(t)) < 200.0) {
                found++;
                break;
            }
        }
    }
    return found;
}

static void targets_beside_a_pile_are_found(void **state)
{
    (void)state;
    init_with_limit(RHO_WORK_MAX);
    for (int k = 0; k < WINDOW; k++) {
        add_target_plots(k);
        add_pile_of_plots(MANY);
        push_scan(k);
        search_newest();
    }
    print_message("%d of %d found, %u plots not tried\n", count_targets_found(WINDOW - 1), TARGETS,
                  (unsigned)initiator.budget.plots_not_tried);
    assert_true(initiator.budget.partial_steps > 0);
    assert_true(count_targets_found(WINDOW - 1) == TARGETS);
}

static void uniform_clutter_stays_below_the_work_limit(void **state)
{
    (void)state;
    init_with_limit(RHO_WORK_MAX);
    for (int k = 0; k < WINDOW + 3; k++) {
        add_target_plots(k);
        add_uniform_clutter(RHO_MAX_PLOTS < 5000 ? RHO_MAX_PLOTS - TARGETS : 4980);
        push_scan(k);
        search_newest();
    }
    print_message("uniform clutter: worst %u of %u\n", (unsigned)initiator.budget.work_worst,
                  (unsigned)RHO_WORK_MAX);
    assert_int_equal(initiator.budget.partial_steps, 0);
    assert_int_equal(initiator.budget.plots_not_tried, 0);
    assert_true(initiator.budget.resume.cost_class == 0 && initiator.budget.resume.plot == 0);
}

/* Results and counts are equal with a limit that is not reached and without one. */
static void a_limit_that_is_not_reached_changes_nothing(void **state)
{
    (void)state;
    for (int run = 0; run < 2; run++) {
        init_with_limit(run ? 0u : RHO_WORK_MAX);
        for (int k = 0; k < WINDOW; k++) {
            add_target_plots(k);
            add_uniform_clutter(150);
            push_scan(k);
            search_newest();
        }
        if (run == 0) {
            other = initiator;
        }
    }
    other.config.work_max = 0;
    assert_memory_equal(&other, &initiator, sizeof other);
}

/* Plots of a pile cost the same: without resuming, each search would try the same ones. */
static void searches_resume_at_the_plot_where_the_last_one_stopped(void **state)
{
    unsigned begins[16];
    (void)state;
    init_with_limit(RHO_WORK_MAX / 8u);
    for (int k = 0; k < WINDOW + (int)NUM(begins); k++) {
        add_pile_of_plots(MANY);
        push_scan(k);
        search_newest();
        if (k >= WINDOW) {
            const struct rho_initiator_resume *turn = &initiator.budget.resume;
            begins[k - WINDOW] = turn->cost_class * (RHO_MAX_PLOTS + 1u) + turn->plot;
        }
    }
    for (size_t i = 1; i < NUM(begins); i++) {
        assert_int_not_equal(begins[i], begins[i - 1]);
    }
    init_with_limit(RHO_WORK_MAX);
    for (int k = 0; k < 3; k++) {
        add_target_plots(k);
        push_scan(k);
    }
    initiator.budget.resume = (struct rho_initiator_resume){3, 2};
    search_newest();
    assert_true(initiator.budget.resume.cost_class == 0 && initiator.budget.resume.plot == 0);
}

/* After a search was cut, a saved and loaded initiator goes on with the same bytes. */
static void a_snapshot_keeps_where_the_search_stopped(void **state)
{
    static uint8_t image[sizeof initiator + 4096];
    const struct rho_snapshot_part part = {RHO_SNAPSHOT_INITIATOR, 1, &initiator, sizeof initiator};
    size_t length = 0;
    (void)state;
    init_with_limit(RHO_WORK_MAX / 8u);
    for (int k = 0; k <= WINDOW; k++) {
        if (k == WINDOW) {
            assert_true(initiator.budget.partial_steps > 0);
            assert_int_equal(rho_snapshot_save(&part, 1, 0, image, sizeof image, &length), RHO_OK);
            assert_int_equal(length, rho_snapshot_size(&part, 1));
            other = initiator;
            memset(&initiator, 0, sizeof initiator);
            assert_int_equal(rho_snapshot_load(&part, 1, image, length), RHO_OK);
            assert_memory_equal(&other, &initiator, sizeof other);
        }
        add_target_plots(k);
        add_pile_of_plots(MANY);
        push_scan(k);
        search_newest();
    }
    assert_true(rho_initiator_is_sound(&initiator));
}

/* A limit passed to the search counts, whatever the configured one; 0 is no limit. */
static void the_callers_work_limit_replaces_the_configured_one(void **state)
{
    static const uint32_t configured[] = {RHO_WORK_MAX, 500, 0};

    (void)state;
    for (size_t i = 0; i < NUM(configured); i++) {
        init_with_limit(configured[i]);
        for (int k = 0; k < WINDOW; k++) {
            add_pile_of_plots(MANY);
            push_scan(k);
        }
        assert_int_equal(rho_initiator_search_within(&initiator, RHO_SEARCH_NEWEST, 2000), RHO_OK);
        assert_true(initiator.budget.work <= 2000 + RHO_INITIATOR_WORK_BEYOND);
        assert_true(initiator.budget.work > 500);
        assert_int_equal(initiator.budget.partial_steps, 1);
        assert_int_equal(initiator.config.work_max, configured[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_arrangement_of_plots_exceeds_the_work_limit),
        cmocka_unit_test(a_batch_search_is_limited_by_scan),
        cmocka_unit_test(targets_beside_a_pile_are_found),
        cmocka_unit_test(uniform_clutter_stays_below_the_work_limit),
        cmocka_unit_test(a_limit_that_is_not_reached_changes_nothing),
        cmocka_unit_test(searches_resume_at_the_plot_where_the_last_one_stopped),
        cmocka_unit_test(a_snapshot_keeps_where_the_search_stopped),
        cmocka_unit_test(the_callers_work_limit_replaces_the_configured_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
