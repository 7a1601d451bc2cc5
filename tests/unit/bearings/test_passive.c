/* SPDX-License-Identifier: MIT */
/*
 * Tracks from bearings: shares found, ghosts and errors over many scenes; single scenes; the batch.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "true_association.h"

static struct rho_passive other;

/*
 * Once in some hundred scenes the ghosts of two targets fly straight, too, and fit the noisy
 * bearings better: the bounds hold for many scenes, not for each.
 */
static void two_sensors_find_all_targets_of_scenes_without_clutter(void **state)
{
    (void)state;
    static const double sigmas_deg[3] = {0.05, 0.1, 0.2};
    struct figures sum = {0};
    random_state = 77;
    for (int i = 0; i < 3; i++) {
        struct scene from = scene_of(2, 2, sigmas_deg[i], 1.0, 0.0);
        struct figures figures = figures_of_scenes(&from, 300);
        print_figures("2 sensors, 2 targets, clean", &figures);
        assert_true(found_share(&figures) >= 0.99);
        assert_true(ghosts_a_run(&figures) <= 0.02);
        assert_true(error_ratio(&figures) <= 1.08);
        sum_figures(&sum, &figures);
    }
    assert_true(sum.found >= 1780);
    assert_in_range((int)(100.0 * sum.nees / sum.found), 350, 470);
}

static void two_sensors_find_most_targets_among_misses_and_false_bearings(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 4, 0.1, 0.9, 1.0);
    random_state = 2;
    struct figures figures = figures_of_scenes(&from, 60);
    print_figures("2 sensors, 4 targets, P_D 0.9, 1 false", &figures);
    assert_true(found_share(&figures) >= 0.94);
    assert_true(ghosts_a_run(&figures) <= 0.12);
    assert_true(error_ratio(&figures) <= 1.08);
    assert_in_range((int)(100.0 * figures.nees / figures.found), 350, 470);
}

static void three_sensors_find_all_targets_among_misses_and_false_bearings(void **state)
{
    (void)state;
    struct scene from = scene_of(3, 4, 0.1, 0.9, 1.0);
    random_state = 3;
    struct figures figures = figures_of_scenes(&from, 60);
    print_figures("3 sensors, 4 targets, P_D 0.9, 1 false", &figures);
    assert_true(found_share(&figures) >= 0.99);
    assert_true(ghosts_a_run(&figures) <= 0.02);
    assert_true(error_ratio(&figures) <= 1.08);
    assert_in_range((int)(100.0 * figures.nees / figures.found), 350, 470);
}

static void false_bearings_alone_make_no_track(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 0, 0.1, 0.9, 4.0);
    random_state = 4;
    struct figures figures = figures_of_scenes(&from, 60);
    assert_int_equal(figures.ghosts, 0);
}

static void targets_are_found_from_scans_at_unequal_intervals(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 2, 0.1, 1.0, 0.0);
    from.jitter_s = 7.0;
    random_state = 5;
    struct figures figures = figures_of_scenes(&from, 300);
    print_figures("unequal intervals", &figures);
    assert_true(found_share(&figures) >= 0.98 && ghosts_a_run(&figures) <= 0.04);
    assert_true(error_ratio(&figures) <= 1.08);
    assert_in_range((int)(100.0 * figures.nees / figures.found), 300, 500);
}

static void bearings_are_weighted_by_their_own_sigmas(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 2, 0.1, 1.0, 0.0);
    from.sigma_from_rad = 0.02 * DEG_RAD;
    from.sigma_to_rad = 0.3 * DEG_RAD;
    random_state = 6;
    struct figures figures = figures_of_scenes(&from, 40);
    print_figures("own sigmas", &figures);
    assert_true(found_share(&figures) >= 0.98 && ghosts_a_run(&figures) <= 0.04);
    assert_true(error_ratio(&figures) <= 1.08);
    assert_in_range((int)(100.0 * figures.nees / figures.found), 320, 500);
}

/* A track after the scene was rotated and shifted. */
static struct rho_passive_track moved_track(const struct rho_passive_track *from, double turn_rad,
                                            double x_m, double y_m)
{
    double c = cos(turn_rad), s = sin(turn_rad);
    struct rho_passive_track to = *from;
    to.x_m = (float)(c * from->x_m - s * from->y_m + x_m);
    to.y_m = (float)(s * from->x_m + c * from->y_m + y_m);
    to.vx_mps = (float)(c * from->vx_mps - s * from->vy_mps);
    to.vy_mps = (float)(s * from->vx_mps + c * from->vy_mps);
    return to;
}

static int has_track(const struct rho_passive *tracks, const struct rho_passive_track *sought)
{
    for (unsigned i = 0; i < tracks->num_tracks; i++) {
        const struct rho_passive_track *track = &tracks->tracks[i];
        if (fabsf(track->x_m - sought->x_m) < 5.0f && fabsf(track->y_m - sought->y_m) < 5.0f &&
            fabsf(track->vx_mps - sought->vx_mps) < 0.2f &&
            fabsf(track->vy_mps - sought->vy_mps) < 0.2f && track->hits == sought->hits) {
            return 1;
        }
    }
    return 0;
}

static void expect_tracks_move_with_scene(double turn_rad, double x_m, double y_m)
{
    move_scene(&scene, turn_rad, x_m, y_m);
    search_into(&other);
    assert_int_equal(other.num_tracks, passive.num_tracks);
    for (unsigned i = 0; i < passive.num_tracks; i++) {
        struct rho_passive_track sought = moved_track(&passive.tracks[i], turn_rad, x_m, y_m);
        assert_true(has_track(&other, &sought));
    }
}

static void tracks_move_and_rotate_with_the_scene(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 2, 0.1, 1.0, 0.0);
    for (unsigned i = 0; i < 16; i++) {
        draw_seeded_scene(&from, 100 + i);
        search_into(&passive);
        assert_int_equal(passive.num_tracks, 2);
        expect_tracks_move_with_scene(i * 2.0 * PI / 16.0 + 0.01, 300e3, -200e3);
    }
}

static int are_tracks_and_work_equal(void)
{
    return passive.num_tracks == other.num_tracks &&
           memcmp(passive.tracks, other.tracks, passive.num_tracks * sizeof passive.tracks[0]) ==
               0 &&
           memcmp(&passive.work, &other.work, sizeof passive.work) == 0;
}

static void the_same_input_gives_the_same_bytes(void **state)
{
    (void)state;
    struct scene from = scene_of(3, 4, 0.1, 0.9, 1.0);
    draw_seeded_scene(&from, 8);
    memset(&other, 0xa5, sizeof other);
    search_into(&passive);
    search_into(&other);
    assert_true(passive.num_tracks >= 3);
    assert_true(are_tracks_and_work_equal());
    assert_int_equal(rho_passive_search(&other), RHO_OK);
    assert_true(are_tracks_and_work_equal());
}

static void the_order_of_bearings_does_not_matter(void **state)
{
    (void)state;
    struct scene from = scene_of(3, 3, 0.1, 0.9, 1.0);
    draw_seeded_scene(&from, 9);
    search_into(&passive);
    for (unsigned k = 0; k < scene.scans; k++) {
        for (unsigned s = 0; s < scene.sensors; s++) {
            shuffle(&scene.look[k][s]);
        }
    }
    assert_true(passive.num_tracks >= 2);
    expect_tracks_move_with_scene(0.0, 0.0, 0.0);
}

static void a_ninth_frame_replaces_the_oldest(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 2, 0.1, 1.0, 0.0);
    from.scans = 9;
    draw_seeded_scene(&from, 10);
    search_into(&passive);
    assert_int_equal(passive.batch.num_scans, 8);
    assert_true(passive.batch.time_us[0] == 10000000 && passive.batch.time_us[7] == 80000000);
    assert_int_equal(start_passive(&other), RHO_OK);
    assert_int_equal(push_scans_from(&other, &scene, 1), RHO_OK);
    assert_int_equal(rho_passive_search(&other), RHO_OK);
    assert_int_equal(passive.num_tracks, 2);
    assert_true(are_tracks_and_work_equal());
}

static void tracks_are_reported_at_the_newest_scans_time(void **state)
{
    (void)state;
    struct scene from = scene_of(3, 1, 0.05, 1.0, 0.0);
    draw_seeded_scene(&from, 11);
    search_into(&passive);
    const struct target *truth = &scene.target[0];
    assert_int_equal(passive.num_tracks, 1);
    assert_int_equal(passive.tracks[0].hits, 24);
    assert_int_equal(passive.tracks[0].scans, 0xff);
    assert_true(fabs(passive.tracks[0].x_m - target_x_m(truth, 70.0)) <
                4.0 * sqrt(passive.tracks[0].covariance[0]));
    assert_true(fabs(passive.tracks[0].y_m - target_y_m(truth, 70.0)) <
                4.0 * sqrt(passive.tracks[0].covariance[2]));
}

static void a_push_discards_the_tracks_of_the_last_search(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 2, 0.1, 1.0, 0.0);
    from.scans = 9;
    draw_seeded_scene(&from, 12);
    assert_int_equal(start_passive(&passive), RHO_OK);
    scene.scans = 8;
    assert_int_equal(push_scans_from(&passive, &scene, 0), RHO_OK);
    assert_int_equal(passive.num_tracks, 0);
    assert_int_equal(rho_passive_search(&passive), RHO_OK);
    assert_int_equal(passive.num_tracks, 2);
    assert_int_equal(push_scan(&passive, &scene, 8), RHO_OK);
    assert_int_equal(passive.num_tracks, 0);
}

static void a_track_needs_at_least_three_scans(void **state)
{
    (void)state;
    struct scene from = scene_of(3, 1, 0.05, 1.0, 0.0);
    for (from.scans = 2; from.scans <= 4; from.scans++) {
        draw_seeded_scene(&from, 13);
        search_into(&passive);
        assert_int_equal(passive.num_tracks, from.scans >= RHO_BATCH_SCANS_MIN);
    }
}

enum third { SAW_NOTHING, WAS_ABSENT, LOOKED_AWAY, LOOKED_THERE };

/*
 * Searches a scene in which the third sensor sees the target at the first scan only: two thirds of
 * the bearings are left.
 */
static void search_without_third_sensor(enum third third)
{
    struct rho_passive_config config;
    struct scene from = scene_of(3, 1, 0.05, 1.0, 0.0);
    draw_seeded_scene(&from, 14);
    for (unsigned k = 1; k < scene.scans; k++) {
        scene.look[k][2].count = 0;
        scene.look[k][2].is_absent = third == WAS_ABSENT;
        scene.look[k][2].sector_from_rad = third == LOOKED_AWAY ? 2.0 : -0.5 * PI;
        scene.look[k][2].sector_to_rad = third == LOOKED_AWAY    ? 4.0
                                         : third == LOOKED_THERE ? 0.5 * PI
                                                                 : -0.5 * PI;
    }
    rho_passive_config_default(&config);
    /* the lower limit of the false bearings' density, whatever `third` is */
    config.field_of_view_rad = (float)(2.0 * PI);
    assert_int_equal(rho_passive_init(&passive, sizeof passive, &config), RHO_OK);
    assert_int_equal(push_scans_from(&passive, &scene, 0), RHO_OK);
    assert_int_equal(rho_passive_search(&passive), RHO_OK);
    assert_true(are_tracks_finite_with_right_claims(&passive));
}

/* Squared residual of a target's bearing with a sigma of one metre added, and its equation. */
static double add_evidence_of_bearing(double information[4][4], const double state[4], unsigned k,
                                      unsigned s, const struct rho_bearing *seen)
{
    double t_s = look_time_s(&scene, k, s) - mid_batch_time_s(), step = t_s / half_batch_s();
    double dx_m = state[0] + t_s * state[2] - look_x_m(&scene, k, s);
    double dy_m = state[1] + t_s * state[3] - look_y_m(&scene, k, s);
    double range2 = dx_m * dx_m + dy_m * dy_m, sigma_rad = (double)seen->sigma_rad;
    double row[4] = {-dy_m / range2, dx_m / range2, -step * dy_m / range2, step * dx_m / range2};
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            information[i][j] += row[i] * row[j] / (sigma_rad * sigma_rad + 1.0 / range2);
        }
    }
    return pow(remainder((double)seen->bearing_rad - atan2(dy_m, dx_m), 2.0 * PI) / sigma_rad, 2.0);
}

static double log_determinant(double a[4][4])
{
    double sum = 0.0;
    for (int k = 0; k < 4; k++) {
        sum += log(a[k][k]);
        for (int i = k + 1; i < 4; i++) {
            double factor = a[i][k] / a[k][k];
            for (int j = k; j < 4; j++) {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    return sum;
}

/* Centroid of the places of all looks. */
static void find_middle_of_looks(double middle_m[2])
{
    double looks = 0.0;
    middle_m[0] = middle_m[1] = 0.0;
    for (unsigned k = 0; k < scene.scans; k++) {
        for (unsigned s = 0; s < scene.sensors; s++) {
            if (!scene.look[k][s].is_absent) {
                middle_m[0] += look_x_m(&scene, k, s);
                middle_m[1] += look_y_m(&scene, k, s);
                looks += 1.0;
            }
        }
    }
    middle_m[0] /= looks;
    middle_m[1] /= looks;
}

/*
 * Evidence of target 0 anywhere, in double precision with the true association: the likelihood
 * ratio of its bearings at the best state, and the share of places (half the largest range) and
 * velocities (half the largest speed), both as sigmas of normal densities, that they leave.
 *   false_a_look  mean number of false bearings in a look
 *   misses        looks that had the target in view, but no bearing of it
 */
static double evidence_nat(const struct rho_passive_config *config, double false_a_look,
                           unsigned misses)
{
    struct fit fit = fit_with_true_association(0);
    double half_s = half_batch_s(), information[4][4] = {{0}}, middle_m[2];
    double sum_nat = misses * log(1.0 - (double)config->pd);
    const double sigma_m[4] = {0.5 * (double)config->range_max_m, 0.5 * (double)config->range_max_m,
                               0.5 * (double)config->v_max_mps * half_s,
                               0.5 * (double)config->v_max_mps * half_s};
    find_middle_of_looks(middle_m);
    const double state_m[4] = {fit.state[0] - middle_m[0], fit.state[1] - middle_m[1],
                               half_s * fit.state[2], half_s * fit.state[3]};
    for (int i = 0; i < 4; i++) {
        information[i][i] = 1.0 / pow(i < 2 ? (double)config->range_max_m : 500.0 * half_s, 2.0);
        sum_nat -= log(sigma_m[i]) + 0.5 * pow(state_m[i] / sigma_m[i], 2.0);
    }
    for (unsigned k = 0; k < scene.scans; k++) {
        for (unsigned s = 0; s < scene.sensors; s++) {
            const struct look *look = &scene.look[k][s];
            for (unsigned i = 0; i < look->count && !look->is_absent; i++) {
                if (look->target[i] == 0) {
                    double chi2 =
                        add_evidence_of_bearing(information, fit.state, k, s, &look->bearings[i]);
                    double density = false_a_look / (double)config->field_of_view_rad;
                    sum_nat += log((double)config->pd / density) - 0.5 * chi2 -
                               log(sqrt(2.0 * PI) * (double)look->bearings[i].sigma_rad);
                }
            }
        }
    }
    return sum_nat - 0.5 * log_determinant(information);
}

static void expect_score_is_evidence(double false_a_look, unsigned misses)
{
    assert_int_equal(passive.num_tracks, 1);
    assert_float_equal(1e-3 * passive.tracks[0].score_mnat,
                       evidence_nat(&passive.config, false_a_look, misses), 0.03);
}

/*
 * Without the third sensor the first pass claims no bearing, so that all 17 count as false in the
 * density, of 24 looks, or of the 17 looks that there are.
 */
static void targets_outside_a_sensors_sector_do_not_count_as_missed(void **state)
{
    (void)state;
    search_without_third_sensor(WAS_ABSENT);
    expect_score_is_evidence(17.0 / 17.0, 0);
    assert_int_equal(passive.tracks[0].hits, 17);
    search_without_third_sensor(LOOKED_AWAY);
    expect_score_is_evidence(17.0 / 24.0, 0);
    assert_int_equal(passive.tracks[0].hits, 17);
    search_without_third_sensor(LOOKED_THERE);
    expect_score_is_evidence(17.0 / 24.0, 7);
}

static void a_miss_costs_the_logarithm_of_its_probability(void **state)
{
    (void)state;
    search_without_third_sensor(LOOKED_AWAY);
    expect_score_is_evidence(17.0 / 24.0, 0);
    int32_t score_mnat = passive.tracks[0].score_mnat;
    search_without_third_sensor(SAW_NOTHING);
    expect_score_is_evidence(17.0 / 24.0, 7);
    assert_in_range(score_mnat - passive.tracks[0].score_mnat, 16118 - 20, 16118 + 20);
}

/* Bearings that the first pass claims are not false: the floor of 0.3 a look is left. */
static void the_score_is_the_evidence_of_a_target_anywhere(void **state)
{
    (void)state;
    for (unsigned seed = 0; seed < 20; seed++) {
        struct scene from = scene_of(3, 1, 0.02 + 0.01 * seed, 1.0, 0.0);
        draw_seeded_scene(&from, 400 + seed);
        search_into(&passive);
        expect_score_is_evidence(0.3, 0);
        assert_int_equal(passive.tracks[0].hits, 24);
    }
}

/* Of false bearings, the evidence reaches e^s in one of e^s intervals at most. */
static void the_start_score_follows_from_the_allowed_false_tracks(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 1, 0.1, 1.0, 0.0);
    const double rates[3] = {0.01, 1.0, 60.0};
    draw_seeded_scene(&from, 17);
    for (unsigned i = 0; i < 3; i++) {
        struct rho_passive_config config;
        rho_passive_config_default(&config);
        config.false_tracks_per_hour = (float)rates[i];
        assert_int_equal(rho_passive_init(&passive, sizeof passive, &config), RHO_OK);
        assert_int_equal(push_scans_from(&passive, &scene, 0), RHO_OK);
        assert_int_equal(rho_passive_search(&passive), RHO_OK);
        assert_float_equal(1e-3 * passive.start_mnat, log(3600.0 / (10.0 * rates[i])), 0.005);
    }
}

static void one_sensor_alone_makes_no_track(void **state)
{
    (void)state;
    struct scene from = scene_of(1, 2, 0.1, 1.0, 1.0);
    draw_seeded_scene(&from, 15);
    search_into(&passive);
    assert_int_equal(passive.batch.num_sensors, 1);
    assert_int_equal(passive.num_tracks, 0);
}

static void a_search_counts_its_work(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 2, 0.1, 1.0, 0.0);
    draw_seeded_scene(&from, 16);
    search_into(&passive);
    assert_int_equal(passive.work.crossings, 32);
    assert_in_range(passive.work.ghosts, 1, 16);
    assert_int_equal(passive.work.points_dropped, 0);
    assert_true(passive.work.hypotheses > 0 && passive.work.fits > 0);
}

static void tracks_are_sorted_by_falling_score(void **state)
{
    (void)state;
    struct scene from = scene_of(3, 4, 0.1, 0.9, 1.0);
    for (unsigned run = 0; run < 60; run++) {
        draw_seeded_scene(&from, 1 + run);
        search_into(&passive);
        for (unsigned i = 1; i < passive.num_tracks; i++) {
            assert_true(passive.tracks[i - 1].score_mnat >= passive.tracks[i].score_mnat);
        }
    }
}

/* Returns in how many runs two sensors with these sigmas found a single target. */
static unsigned count_found_with_sigmas(double sigma_a_rad, double sigma_b_rad, unsigned runs)
{
    unsigned found = 0;
    random_state = 5;
    for (unsigned run = 0; run < runs; run++) {
        scene = scene_of(2, 1, 0.1, 1.0, 0.0);
        set_scan_times(&scene);
        scene.target[0] = random_target(scene_span_s(&scene));
        for (unsigned k = 0; k < scene.scans; k++) {
            for (unsigned s = 0; s < 2; s++) {
                scene.sigma_from_rad = scene.sigma_to_rad = s ? sigma_b_rad : sigma_a_rad;
                see_look(&scene, k, s);
            }
        }
        search_into(&passive); /* checks that the track's covariance is positive */
        found += passive.num_tracks == 1;
    }
    return found;
}

static void a_coarse_and_a_precise_sensor_find_the_target(void **state)
{
    (void)state;
    assert_true(count_found_with_sigmas(1e-4, 0.01, 30) >= 29);
    assert_true(count_found_with_sigmas(1e-5, 0.01, 30) >= 29);
}

static void targets_beyond_200_km_are_found(void **state)
{
    (void)state;
    unsigned found = 0;
    struct rho_passive_config config;
    rho_passive_config_default(&config);
    config.range_max_m = 400e3f;
    for (unsigned run = 0; run < 10; run++) {
        random_state = 300 + run;
        scene = scene_of(2, 1, 0.05, 1.0, 0.0);
        scene.sensor_y_m[0] = -40e3;
        scene.sensor_y_m[1] = 40e3;
        set_scan_times(&scene);
        scene.target[0] =
            (struct target){.x_m = 250e3, .y_m = 5e3, .vx_mps = -250.0, .vy_mps = 40.0};
        see_all_looks(&scene);
        assert_int_equal(rho_passive_init(&passive, sizeof passive, &config), RHO_OK);
        assert_int_equal(push_scans_from(&passive, &scene, 0), RHO_OK);
        assert_int_equal(rho_passive_search(&passive), RHO_OK);
        found += passive.num_tracks == 1 &&
                 mid_batch_error_m(&passive.tracks[0], &scene.target[0]) < 15e3;
    }
    assert_int_equal(found, 10);
}

/* Bearings of one sensor leave range and speed unknown, even if 40 % of all bearings would do. */
static void every_track_has_bearings_of_two_sensors(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 2, 0.1, 0.9, 1.0);
    struct rho_passive_config config;
    rho_passive_config_default(&config);
    for (unsigned run = 0; run < 60; run++) {
        draw_seeded_scene(&from, 200 + run);
        assert_int_equal(rho_passive_init(&passive, sizeof passive, &config), RHO_OK);
        assert_int_equal(push_scans_from(&passive, &scene, 0), RHO_OK);
        assert_int_equal(rho_passive_search(&passive), RHO_OK);
        for (unsigned i = 0; i < passive.num_tracks; i++) {
            unsigned hits[2] = {0, 0};
            for (unsigned k = 0; k < scene.scans; k++) {
                hits[0] += passive.tracks[i].claim[k][0] > 0;
                hits[1] += passive.tracks[i].claim[k][1] > 0;
            }
            assert_true(hits[0] >= 2 && hits[1] >= 2);
        }
    }
}

/* Searches a scene whose bearings are this many sigmas off, to alternating sides. */
static void search_scattered_bearings(double sigmas)
{
    struct scene from = scene_of(2, 1, 0.1, 1.0, 0.0);
    draw_seeded_scene(&from, 21);
    for (unsigned k = 0; k < scene.scans; k++) {
        for (unsigned s = 0; s < scene.sensors; s++) {
            double dx_m = target_x_m(&scene.target[0], scene.time_s[k]) - scene.sensor_x_m[s];
            double dy_m = target_y_m(&scene.target[0], scene.time_s[k]) - scene.sensor_y_m[s];
            double off_rad = (k % 2 ? sigmas : -sigmas) * scene.sigma_from_rad;
            scene.look[k][s].bearings[0].bearing_rad = (float)(atan2(dy_m, dx_m) + off_rad);
        }
    }
    search_into(&passive);
}

/*
 * Chi-square with 12 degrees of freedom, 99.9 % below 33: 16 bearings one sigma off sum up to 16,
 * 2.2 sigmas off to 77, though each is in its gate.
 */
static void bearings_that_scatter_too_much_make_no_track(void **state)
{
    (void)state;
    search_scattered_bearings(1.0);
    assert_int_equal(passive.num_tracks, 1);
    assert_int_equal(passive.tracks[0].hits, 16);
    search_scattered_bearings(2.2);
    assert_int_equal(passive.num_tracks, 0);
}

/* n sensors make n (n - 1) / 2 pairs, whichever scans they saw the target in. */
static void sensor_pairs_are_counted_from_the_tracks_claims(void **state)
{
    struct rho_passive_track track = {.hits = 0};

    (void)state;
    assert_int_equal(rho_passive_sensor_pairs(&track), 0);
    for (unsigned num = 1; num <= RHO_MAX_PASSIVE_SENSORS; num++) {
        track.claim[num % RHO_MAX_PASSIVE_SCANS][num - 1] = (uint8_t)num;
        track.claim[0][num - 1] = 9;
        assert_int_equal(rho_passive_sensor_pairs(&track), num * (num - 1) / 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_sensors_find_all_targets_of_scenes_without_clutter),
        cmocka_unit_test(two_sensors_find_most_targets_among_misses_and_false_bearings),
        cmocka_unit_test(three_sensors_find_all_targets_among_misses_and_false_bearings),
        cmocka_unit_test(false_bearings_alone_make_no_track),
        cmocka_unit_test(targets_are_found_from_scans_at_unequal_intervals),
        cmocka_unit_test(bearings_are_weighted_by_their_own_sigmas),
        cmocka_unit_test(tracks_move_and_rotate_with_the_scene),
        cmocka_unit_test(the_same_input_gives_the_same_bytes),
        cmocka_unit_test(the_order_of_bearings_does_not_matter),
        cmocka_unit_test(a_ninth_frame_replaces_the_oldest),
        cmocka_unit_test(tracks_are_reported_at_the_newest_scans_time),
        cmocka_unit_test(a_push_discards_the_tracks_of_the_last_search),
        cmocka_unit_test(a_track_needs_at_least_three_scans),
        cmocka_unit_test(targets_outside_a_sensors_sector_do_not_count_as_missed),
        cmocka_unit_test(a_miss_costs_the_logarithm_of_its_probability),
        cmocka_unit_test(the_score_is_the_evidence_of_a_target_anywhere),
        cmocka_unit_test(the_start_score_follows_from_the_allowed_false_tracks),
        cmocka_unit_test(one_sensor_alone_makes_no_track),
        cmocka_unit_test(a_search_counts_its_work),
        cmocka_unit_test(tracks_are_sorted_by_falling_score),
        cmocka_unit_test(a_coarse_and_a_precise_sensor_find_the_target),
        cmocka_unit_test(targets_beyond_200_km_are_found),
        cmocka_unit_test(every_track_has_bearings_of_two_sensors),
        cmocka_unit_test(bearings_that_scatter_too_much_make_no_track),
        cmocka_unit_test(sensor_pairs_are_counted_from_the_tracks_claims),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
