/* SPDX-License-Identifier: MIT */
/*
 * The long-term memory of clutter (RHO_MAX_CLUTTER_CELLS): hot spots smaller than a cell of the
 * window's map are learned, used and forgotten. Limits are tested on a memory set by hand through
 * the private header.
 */
#include "../../src/initiation/clutter_density.h"
#include "initiator_setup.h"

#if RHO_MAX_CLUTTER_CELLS > 0

#define SCANS 6
#define SCAN_S 2.0
#define HOT_PLOTS 3
#define COLD_PLOTS 20
/* Smaller than a cell of the embedded profile: 20 km and a quarter on each side, divided by 16. */
#define HOT_SIDE_M 600.0

static const struct rho_extent around = {-10000.0f, 10000.0f, -10000.0f, 10000.0f};
static const double around_m2 = 20000.0 * 20000.0;
static const double cell_m = 30000.0 / RHO_MAX_CLUTTER_CELLS;
/*
 * True if a hundred scans put some plots into each cell, hot or not; small cells only show that
 * there is more clutter.
 */
static const int cells_are_large = RHO_MAX_CLUTTER_CELLS <= 32;

static struct rho_initiator_config test_config(int area_is_fixed)
{
    struct rho_initiator_config config;
    rho_initiator_config_default(&config);
    config.scans = SCANS;
    config.min_scans = SCANS;
    config.v_max_mps = 400.0f;
    config.area_is_fixed = area_is_fixed;
    config.area = area_is_fixed ? around : (struct rho_extent){0};
    return config;
}

/* The middle of the memory's cell at this coordinate. */
static double clutter_memory_cell_middle_m(double near_m)
{
    return -15000.0 + cell_m * (floor((near_m + 15000.0) / cell_m) + 0.5);
}

static void add_spot(double x_m, double y_m, int count)
{
    const double half_m = 0.5 * fmin(HOT_SIDE_M, 0.9 * cell_m);
    for (int i = 0; i < count; i++) {
        const double at_m = x_m + uniform(-half_m, half_m);
        add_plot(at_m, y_m + uniform(-half_m, half_m), 10.0, 10.0);
    }
}

static double time_s;

static void push_next_scan(void)
{
    push_plots(time_s);
    time_s += SCAN_S;
}

/* Pushes scans with clutter everywhere and `hot` more plots in a spot at (5, 5) km. */
static void push_scans_with_hot_spot(int scans, int hot)
{
    for (int k = 0; k < scans; k++) {
        add_clutter_plots(&around, COLD_PLOTS);
        add_spot(clutter_memory_cell_middle_m(5000.0), clutter_memory_cell_middle_m(5000.0), hot);
        push_next_scan();
    }
    search_window(RHO_SEARCH_NEWEST);
}

static double density_at(double x_m, double y_m)
{
    const double density = rho_initiator_density(&initiator, 0, (float)x_m, (float)y_m);
    assert_true(isfinite(density));
    assert_true(density > 0.0);
    return density;
}

static double hot_density(void)
{
    return density_at(clutter_memory_cell_middle_m(5000.0), clutter_memory_cell_middle_m(5000.0));
}

static void init_with_fixed_area(void)
{
    const struct rho_initiator_config config = test_config(1);
    random_state = 1;
    time_s = 0.0;
    start_initiator(&config);
}

static void a_hot_spot_raises_the_density_of_its_cell(void **state)
{
    const double cold = COLD_PLOTS / around_m2, cell_m2 = cell_m * cell_m;
    double mean = 0.0;
    (void)state;
    init_with_fixed_area();
    push_scans_with_hot_spot(SCANS, HOT_PLOTS);
    const double at_first = hot_density();
    push_scans_with_hot_spot(20, HOT_PLOTS);
    const double soon = hot_density();
    push_scans_with_hot_spot(100, HOT_PLOTS);
    const double later = hot_density(), is = cold + HOT_PLOTS / cell_m2;
    assert_true(soon > 1.2 * at_first);
    assert_true(later > soon);
    assert_true(later > (cells_are_large ? 0.6 * is : 20.0 * cold));
    assert_true(later < 1.6 * is);
    /* the density far away and two cells beside the spot stays low */
    for (int i = 0; i < 10; i++) {
        mean += density_at(uniform(-9000.0, -5000.0), uniform(-9000.0, -5000.0)) / 10.0;
    }
    assert_float_equal(mean, cold, 0.6 * cold);
    assert_true(density_at(clutter_memory_cell_middle_m(5000.0) + 2.0 * cell_m,
                           clutter_memory_cell_middle_m(5000.0)) < 0.5 * later);
    assert_true(density_at(clutter_memory_cell_middle_m(5000.0),
                           clutter_memory_cell_middle_m(5000.0) - 2.0 * cell_m) < 0.5 * later);
}

/* Cells below the window's density, and places beyond the memory, have the window's density. */
static void the_memory_never_lowers_a_density(void **state)
{
    static struct rho_initiator plain;
    (void)state;
    init_with_fixed_area();
    push_scans_with_hot_spot(60, HOT_PLOTS);
    plain = initiator;
    memset(&plain.memory, 0, sizeof plain.memory);
    for (double x_m = -30000.0; x_m < 30000.0; x_m += 1100.0) {
        for (double y_m = -30000.0; y_m < 30000.0; y_m += 1300.0) {
            const double without = rho_initiator_density(&plain, 0, (float)x_m, (float)y_m);
            assert_true(density_at(x_m, y_m) >= without);
            if (fabs(x_m) > 15000.0 || fabs(y_m) > 15000.0) {
                assert_float_equal(density_at(x_m, y_m), without, 0.0);
            }
        }
    }
}

/* The same tracks, with and without a hot spot learned before: in it the score is lower. */
static void candidates_in_a_hot_spot_have_lower_scores(void **state)
{
    int32_t score_mnat[2];
    (void)state;
    for (int is_hot = 0; is_hot < 2; is_hot++) {
        init_with_fixed_area();
        for (int k = 0; k < 100; k++) {
            add_spot(clutter_memory_cell_middle_m(5000.0), clutter_memory_cell_middle_m(5000.0),
                     is_hot ? HOT_PLOTS : 0);
            add_plot(-9990.0, -9990.0, 10.0, 10.0);
            add_plot(9990.0, 9990.0, 10.0, 10.0);
            push_next_scan();
        }
        /* with windows of equal plots */
        for (int k = 0; k < SCANS; k++) {
            add_plot(clutter_memory_cell_middle_m(5000.0) - 100.0 + 40.0 * k,
                     clutter_memory_cell_middle_m(5000.0), 10.0, 10.0);
            add_plot(-9990.0, -9990.0, 10.0, 10.0);
            add_plot(9990.0, 9990.0 - 1500.0 * k, 10.0, 10.0);
            push_next_scan();
        }
        search_window(RHO_SEARCH_NEWEST);
        score_mnat[is_hot] = 0;
        for (unsigned i = 0; i < initiator.num_candidates; i++) {
            if (fabs((double)initiator.candidates[i].x_m - 5000.0) < 2000.0) {
                score_mnat[is_hot] = initiator.candidates[i].score_mnat;
            }
        }
        assert_int_not_equal(score_mnat[is_hot], 0);
    }
    assert_true(score_mnat[1] < score_mnat[0] - 3000);
}

static void a_hot_spot_is_forgotten(void **state)
{
    (void)state;
    init_with_fixed_area();
    push_scans_with_hot_spot(130, HOT_PLOTS);
    const double hot = hot_density();
    push_scans_with_hot_spot(130, 0);
    const double later = hot_density();
    push_scans_with_hot_spot(270, 0);
    const double last = hot_density();
    assert_true(later < 0.8 * hot);
    assert_true(last < 0.35 * hot);
    assert_true(last < 5.0 * COLD_PLOTS / around_m2);
}

/* Neither counts of plots nor the number of scans may overflow. */
static void counts_do_not_overflow_in_long_runs(void **state)
{
    (void)state;
    init_with_fixed_area();
    for (int round = 0; round < 20; round++) {
        push_scans_with_hot_spot(100, 30);
        assert_in_range(initiator.memory.num_scans, 1, 128);
    }
    const double is = 30.0 / (cell_m * cell_m);
    assert_true(hot_density() < 1.5 * is);
    assert_true(hot_density() > (cells_are_large ? 0.5 * is : 200.0 * COLD_PLOTS / around_m2));
}

static uint32_t count_remembered_plots(void)
{
    uint32_t sum = 0;
    for (unsigned c = 0; c < NUM(initiator.memory.count); c++) {
        sum += initiator.memory.count[c];
    }
    return sum;
}

static void plots_are_remembered_once_when_they_leave_the_window(void **state)
{
    (void)state;
    init_with_fixed_area();
    for (int k = 0; k < 40; k++) {
        for (int i = 0; i < 1 + k % 3; i++) {
            add_plot(300.0 * i, 0.0, 10.0, 10.0);
        }
        push_next_scan();
        uint32_t gone = 0;
        for (int m = 0; m <= k - SCANS; m++) {
            gone += 1u + (uint32_t)m % 3u;
        }
        assert_int_equal(count_remembered_plots(), gone);
        assert_int_equal(initiator.memory.num_scans, k < SCANS ? 0 : k - SCANS + 1);
    }
}

static void plots_that_started_tracks_are_not_remembered(void **state)
{
    (void)state;
    init_with_fixed_area();
    for (int k = 0; k < SCANS; k++) {
        add_plot(300.0 * k, 0.0, 10.0, 10.0);
        add_plot(-9990.0, uniform(-9990.0, 9990.0), 10.0, 10.0);
        push_next_scan();
    }
    search_window(RHO_SEARCH_NEWEST);
    assert_int_equal(initiator.num_candidates, 1);
    assert_int_equal(rho_initiator_consume(&initiator, &initiator.candidates[0]), SCANS);
    for (int k = 0; k < SCANS; k++) {
        push_next_scan();
    }
    assert_int_equal(count_remembered_plots(), SCANS); /* the plots of clutter */
}

static void refused_scans_are_not_remembered(void **state)
{
    static struct rho_initiator then;
    static uint8_t fates[4] = {RHO_FATE_HELD};
    const struct rho_plot plot = {.sigma_range_m = 1.0f, .sigma_cross_m = 1.0f};
    struct rho_scan old = {.num_plots = 1, .plots = &plot};
    uint32_t unused = 0;
    (void)state;
    init_with_fixed_area();
    push_scans_with_hot_spot(20, HOT_PLOTS);
    then = initiator;
    old.time_us = llround((time_s - 1.5 * SCAN_S) * 1e6);
    assert_int_equal(rho_initiator_push(&initiator, &old, NULL, fates, &unused), RHO_ERROR_STATE);
    assert_memory_equal(&initiator, &then, sizeof initiator);
    old.time_us = llround(time_s * 1e6);
    assert_int_equal(rho_initiator_push(&initiator, &old, NULL, NULL, &unused), RHO_ERROR_NULL);
    assert_int_equal(rho_initiator_push(&initiator, &old, NULL, fates, NULL), RHO_ERROR_NULL);
    old.plots = NULL;
    assert_int_equal(rho_initiator_push(&initiator, &old, NULL, fates, &unused), RHO_ERROR_NULL);
    assert_int_equal(rho_initiator_push(&initiator, NULL, NULL, fates, &unused), RHO_ERROR_NULL);
    assert_memory_equal(&initiator, &then, sizeof initiator);
}

/* The observed area grows tenfold and shrinks again; the density must stay that of the clutter. */
static void the_memory_is_laid_out_anew_when_the_area_changes(void **state)
{
    static const double sides_m[] = {10000.0, 100000.0, 3000.0, 1.0, 1.9e6, 0.0};
    const struct rho_initiator_config config = test_config(0);
    (void)state;
    random_state = 1;
    time_s = 0.0;
    start_initiator(&config);
    for (size_t i = 0; i < NUM(sides_m); i++) {
        const double side_m = sides_m[i];
        for (int k = 0; k < 150; k++) {
            for (int n = 0; n < 20; n++) {
                const double x_m = uniform(-side_m, side_m);
                add_plot(x_m, uniform(-side_m, side_m), 10.0, 10.0);
            }
            push_next_scan();
            if (k % 10 == 9) {
                search_window(RHO_SEARCH_NEWEST);
                density_at(0.0, 0.0);
                density_at(side_m, -side_m);
                density_at(2e6, 2e6);
            }
        }
        const double is = 20.0 / pow(2.0 * side_m, 2);
        if (side_m >= 3000.0 && side_m <= 1e5) {
            assert_float_equal(density_at(0.3 * side_m, 0.3 * side_m), is, 0.8 * is);
        }
    }
}

static void push_scans_over_area_with_hot_spot(double half_side_m, int scans)
{
    for (int k = 0; k < scans; k++) {
        for (int n = 0; n < COLD_PLOTS; n++) {
            const double x_m = uniform(-half_side_m, half_side_m);
            add_plot(x_m, uniform(-half_side_m, half_side_m), 10.0, 10.0);
        }
        for (int n = 0; n < 4; n++) {
            add_plot(0.5 * half_side_m, 0.5 * half_side_m, 10.0, 10.0);
        }
        push_next_scan();
    }
    search_window(RHO_SEARCH_NEWEST);
}

/*
 * A hot spot in the small area must not appear in the same cell of the large one; a new one there
 * is learned.
 */
static void hot_spots_are_learned_anew_after_the_area_has_grown(void **state)
{
    const struct rho_initiator_config config = test_config(0);
    const double wide_m = 1e5, cold = COLD_PLOTS / pow(2.0 * wide_m, 2);
    double hot_there = 0.0;
    (void)state;
    random_state = 1;
    time_s = 0.0;
    start_initiator(&config);
    push_scans_over_area_with_hot_spot(1e4, 100);
    assert_true(density_at(5e3, 5e3) > 10.0 * density_at(-5e3, -5e3));
    for (int k = 0; k < 40; k++) {
        add_clutter_plots(&(struct rho_extent){-1e5f, 1e5f, -1e5f, 1e5f}, COLD_PLOTS);
        push_next_scan();
    }
    search_window(RHO_SEARCH_NEWEST);
    for (double x_m = 3e4; x_m <= 7e4; x_m += 1e3) {
        hot_there = fmax(hot_there, density_at(x_m, x_m));
    }
    assert_true(hot_there < 6.0 * cold);
    push_scans_over_area_with_hot_spot(wide_m, 40);
    assert_true(density_at(0.5 * wide_m, 0.5 * wide_m) > 8.0 * cold);
}

static void scans_without_plots_do_no_harm(void **state)
{
    const struct rho_initiator_config config = test_config(0);
    (void)state;
    start_initiator(&config);
    time_s = 0.0;
    for (int k = 0; k < 300; k++) {
        push_next_scan();
    }
    search_window(RHO_SEARCH_NEWEST);
    add_plot(5.0, 5.0, 10.0, 10.0);
    push_next_scan();
    search_window(RHO_SEARCH_NEWEST);
    density_at(5.0, 5.0);
    assert_int_equal(count_remembered_plots(), 0);
}

static void sizes_of_the_memory_follow_its_capacity(void **state)
{
    (void)state;
    assert_int_equal(NUM(initiator.memory.count), RHO_MAX_CLUTTER_CELLS * RHO_MAX_CLUTTER_CELLS);
    assert_true(sizeof initiator.memory <= 2 * RHO_MAX_CLUTTER_CELLS * RHO_MAX_CLUTTER_CELLS + 24);
    assert_true(sizeof initiator <= RHO_RAM_INITIATOR_BYTES);
}

/* Sets a memory of 10 by 10 km after this many scans. */
static struct rho_clutter_memory *set_memory(unsigned scans)
{
    init_with_fixed_area();
    add_plot(0.0, 0.0, 10.0, 10.0);
    push_next_scan();
    initiator.memory = (struct rho_clutter_memory){
        .x_min_m = -5000.0f,
        .y_min_m = -5000.0f,
        .columns_per_m = (float)RHO_MAX_CLUTTER_CELLS / 10000.0f,
        .rows_per_m = (float)RHO_MAX_CLUTTER_CELLS / 10000.0f,
        .num_scans = scans,
    };
    return &initiator.memory;
}

/* Four plots are expected, one of them added: more than ten are three sigmas above that. */
static void a_cell_counts_if_three_sigmas_above_the_expected(void **state)
{
    const double side_m = 10000.0 / RHO_MAX_CLUTTER_CELLS;
    const float density = (float)(3.001 / (100.0 * side_m * side_m));
    (void)state;
    struct rho_clutter_memory *memory = set_memory(100);
    memory->count[0] = 9;
    assert_true(rho_clutter_memory_raise(&initiator, -4999.0f, -4999.0f, density) == density);
    memory->count[0] = 10;
    assert_float_equal(rho_clutter_memory_raise(&initiator, -4999.0f, -4999.0f, density) / density,
                       11.0 / 4.0, 1e-2);
}

static void counts_are_halved_after_128_scans(void **state)
{
    (void)state;
    for (unsigned scans = 127; scans < 129; scans++) {
        struct rho_clutter_memory *memory = set_memory(scans);
        initiator.window.extent = (struct rho_extent){-4000.0f, 4000.0f, -4000.0f, 4000.0f};
        memory->count[1] = 10;
        rho_clutter_memory_add(&initiator);
        assert_int_equal(memory->num_scans, scans == 127 ? 128 : 65);
        assert_int_equal(memory->count[1], scans == 127 ? 10 : 5);
    }
}

/* The memory covers the area and a quarter of its width on each side. */
static void a_memory_four_times_wider_than_the_area_is_laid_out_anew(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        const float wide_m = 2500.0f, narrow_m = i % 2 ? 1270.0f : 1230.0f;
        struct rho_clutter_memory *memory = set_memory(50);
        initiator.window.extent = i < 2 ? (struct rho_extent){-narrow_m, narrow_m, -wide_m, wide_m}
                                        : (struct rho_extent){-wide_m, wide_m, -narrow_m, narrow_m};
        rho_clutter_memory_add(&initiator);
        assert_int_equal(memory->num_scans, i % 2 ? 51 : 1);
        if (i == 0) {
            assert_float_equal(memory->x_min_m, -1.5 * (double)narrow_m, 0.1);
            assert_float_equal(memory->columns_per_m * 3.0f * narrow_m, RHO_MAX_CLUTTER_CELLS,
                               0.001);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hot_spot_raises_the_density_of_its_cell),
        cmocka_unit_test(the_memory_never_lowers_a_density),
        cmocka_unit_test(candidates_in_a_hot_spot_have_lower_scores),
        cmocka_unit_test(a_hot_spot_is_forgotten),
        cmocka_unit_test(counts_do_not_overflow_in_long_runs),
        cmocka_unit_test(plots_are_remembered_once_when_they_leave_the_window),
        cmocka_unit_test(plots_that_started_tracks_are_not_remembered),
        cmocka_unit_test(refused_scans_are_not_remembered),
        cmocka_unit_test(the_memory_is_laid_out_anew_when_the_area_changes),
        cmocka_unit_test(hot_spots_are_learned_anew_after_the_area_has_grown),
        cmocka_unit_test(scans_without_plots_do_no_harm),
        cmocka_unit_test(sizes_of_the_memory_follow_its_capacity),
        cmocka_unit_test(a_cell_counts_if_three_sigmas_above_the_expected),
        cmocka_unit_test(counts_are_halved_after_128_scans),
        cmocka_unit_test(a_memory_four_times_wider_than_the_area_is_laid_out_anew),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
