/* SPDX-License-Identifier: MIT */
/*
 * Initiation of turning targets: found if tracks may have an acceleration, with and without range
 * rates, in any direction and turn, at the plots' own times. Straight targets are found as before.
 */
#include "initiator_setup.h"

#define TURN_S 4.0
#define RANGE_M 55000.0
#define SPEED_MPS 277.0
#define CLUTTER 20
#define SCANS 6

static const struct rho_extent around = {-80000.0f, 80000.0f, -80000.0f, 80000.0f};

/* A target on a circle, or on a straight line if turn_radps is 0. */
struct flight {
    double heading_rad; /* from the x axis, the line of sight */
    double turn_radps;
    double own_s; /* time of its plots after the scan's */
};

struct state {
    double x_m, y_m, vx_mps, vy_mps;
};

/* State at a time; at time 0 the target is on the x axis. */
static struct state flight_at(const struct flight *flight, double t_s)
{
    const double w = flight->turn_radps, h = flight->heading_rad, now = h + w * t_s;
    const int is_straight = fabs(w) < 1e-9;
    const double along_s = is_straight ? t_s * cos(h) : (sin(now) - sin(h)) / w;
    const double up_s = is_straight ? t_s * sin(h) : (cos(h) - cos(now)) / w;
    return (struct state){RANGE_M + SPEED_MPS * along_s, SPEED_MPS * up_s, SPEED_MPS * cos(now),
                          SPEED_MPS * sin(now)};
}

static double range_rate_of(const struct state *state)
{
    const double range_m = hypot(state->x_m, state->y_m);
    return (state->x_m * state->vx_mps + state->y_m * state->vy_mps) / range_m;
}

/* Adds the target's plot as the first one, with sigmas of 15 m, 3 mrad and 1 m/s, and clutter. */
static void add_scan_plots(const struct flight *flight, double t_s)
{
    const struct state state = flight_at(flight, t_s + flight->own_s);
    const double range_m = hypot(state.x_m, state.y_m) + 15.0 * normal();
    const double azimuth_rad = atan2(state.y_m, state.x_m) + 0.003 * normal();
    struct rho_plot *plot =
        add_plot(range_m * cos(azimuth_rad), range_m * sin(azimuth_rad), 15.0, 0.003 * range_m);
    plot->offset_us = (int32_t)lround(1e6 * flight->own_s);
    plot->range_rate_mps = (float)(range_rate_of(&state) + normal());
    plot->sigma_range_rate_mps = 1.0f;
    for (int i = 0; i < CLUTTER; i++) {
        const double r_m = uniform(1000.0, 80000.0), angle_rad = uniform(-PI, PI);
        plot = add_plot(r_m * cos(angle_rad), r_m * sin(angle_rad), 15.0, 0.003 * r_m);
        plot->range_rate_mps = (float)uniform(-350.0, 350.0);
        plot->sigma_range_rate_mps = 1.0f;
    }
}

/*
 * Number of hits when a search first finds a track of four or more of the target's plots and no
 * other; 0: never.
 */
static unsigned hits_when_found(const struct flight *flight, uint32_t measures, float turn_mps2)
{
    struct rho_initiator_config config;
    const struct rho_sensor sensor = sensor_at(0.0, 0.0);
    rho_initiator_config_default(&config);
    config.v_max_mps = 350.0f;
    config.turn_mps2 = turn_mps2;
    config.area_is_fixed = 1;
    config.area = around;
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        add_scan_plots(flight, TURN_S * k);
        push_scan((struct rho_scan){.measures = measures}, TURN_S * k, &sensor);
        search_window(RHO_SEARCH_NEWEST);
        for (unsigned i = 0; i < initiator.num_candidates; i++) {
            const struct rho_candidate *found = &initiator.candidates[i];
            unsigned own = 0;
            for (unsigned m = 0; m < RHO_MAX_SCANS; m++) {
                own += (found->mask >> m & 1u) &&
                       (rho_window_scan_at(&initiator.window, m)->marks[found->plot[m]] &
                        RHO_WINDOW_ROW) == 0;
            }
            if (own >= 4 && own == found->hits) {
                return own;
            }
        }
    }
    return 0;
}

static const struct flight flights[] = {
    {PI / 2, 0.01, 0.0},   {-PI / 2, 0.01, 0.0},      {0.0, 0.01, 0.0},      {PI, 0.01, 1.5},
    {PI / 4, 0.01, 0.0},   {-3 * PI / 4, 0.01, 0.0},  {PI / 2, -0.01, -1.5}, {PI / 4, -0.01, 1.5},
    {PI / 2, 0.02, -1.5},  {PI / 4, 0.02, 1.5},       {-PI / 2, -0.02, 1.5}, {PI / 2, 0.005, 0.0},
    {-PI / 4, 0.02, -1.5}, {-3 * PI / 4, -0.02, -1.5}};

#define RUNS 10

static int count_found(uint32_t measures, float turn_mps2)
{
    int found = 0;
    for (unsigned i = 0; i < NUM(flights); i++) {
        for (int run = 0; run < RUNS; run++) {
            found += hits_when_found(&flights[i], measures, turn_mps2) > 0;
        }
    }
    return found;
}

static void turning_targets_are_found_if_tracks_may_accelerate(void **state)
{
    (void)state;
    const int all = RUNS * (int)NUM(flights);
    const int by_rates = count_found(RHO_MEASURES_RANGE_RATE, 4.0f);
    const int by_straight_rates = count_found(RHO_MEASURES_RANGE_RATE, 0.0f);
    const int by_places = count_found(0, 4.0f), by_straight_places = count_found(0, 0.0f);
    print_message("of %d: %d with range rates, straight %d; %d without, straight %d\n", all,
                  by_rates, by_straight_rates, by_places, by_straight_places);
    assert_true(by_rates >= all * 97 / 100);
    assert_true(by_straight_rates <= all / 2);
    assert_true(by_places >= all * 90 / 100 && by_places > by_straight_places);
}

/*
 * The fitted velocity at the newest scan agrees with the target's, along the line of sight within
 * what range rates allow.
 */
static void a_turn_is_fitted_at_the_plots_own_times(void **state)
{
    (void)state;
    for (double own_s = -2.0; own_s <= 2.0; own_s += 2.0) {
        const struct flight flight = {PI / 2, 0.015, own_s};
        assert_true(hits_when_found(&flight, RHO_MEASURES_RANGE_RATE, 4.0f) > 0);
        const struct rho_candidate *found = &initiator.candidates[0];
        const double t_s = TURN_S * (initiator.window.num_scans - 1);
        const struct state truth = flight_at(&flight, t_s);
        const struct state fit = {(double)found->x_m, (double)found->y_m, (double)found->vx_mps,
                                  (double)found->vy_mps};
        assert_int_equal(found->is_turning, 1);
        assert_true(fabs(hypot(fit.x_m, fit.y_m) - hypot(truth.x_m, truth.y_m)) < 60.0);
        assert_true(fabs(range_rate_of(&fit) - range_rate_of(&truth)) < 8.0);
    }
}

/* Allowing turns loses no straight target. */
static void straight_targets_are_not_taken_for_turning_ones(void **state)
{
    (void)state;
    int turning = 0;
    for (int run = 0; run < 50; run++) {
        const struct flight flight = {uniform(-PI, PI), 0.0, uniform(-1.5, 1.5)};
        const uint64_t begin = random_state;
        const unsigned without = hits_when_found(&flight, RHO_MEASURES_RANGE_RATE, 0.0f);
        random_state = begin;
        assert_true(hits_when_found(&flight, RHO_MEASURES_RANGE_RATE, 4.0f) >= without);
        for (unsigned i = 0; i < initiator.num_candidates; i++) {
            turning += initiator.candidates[i].is_turning;
        }
    }
    assert_true(turning <= 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turning_targets_are_found_if_tracks_may_accelerate),
        cmocka_unit_test(a_turn_is_fitted_at_the_plots_own_times),
        cmocka_unit_test(straight_targets_are_not_taken_for_turning_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
