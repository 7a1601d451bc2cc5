/* SPDX-License-Identifier: MIT */
/*
 * Tracks from bearings with elevations: heights and their errors, sensors at heights of their own,
 * sensors without elevations among others, targets one above the other, and ghosts.
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

/* Order of a track's covariance. */
enum { X, Y, VX, VY, Z, VZ, NUM_ELEMENTS };

static void measure_elevations(struct scene *from, double sigma_deg)
{
    for (unsigned s = 0; s < from->sensors; s++) {
        from->sigma_elevation_rad[s] = sigma_deg * DEG_RAD;
    }
}

static void draw_scene_with_heights(const struct scene *from)
{
    scene = *from;
    set_scan_times(&scene);
    for (unsigned i = 0; i < scene.targets; i++) {
        scene.target[i] = random_target(scene_span_s(&scene));
        scene.height[i] = random_height();
    }
    see_all_looks(&scene);
}

/* Truth minus a track's state. */
static void errors_of(const struct rho_passive_track *track, unsigned target,
                      double off[NUM_ELEMENTS])
{
    const struct target *truth = &scene.target[target];
    const struct height *height = &scene.height[target];
    const double last_s = last_time_s();
    off[X] = (double)track->x_m - target_x_m(truth, last_s);
    off[Y] = (double)track->y_m - target_y_m(truth, last_s);
    off[VX] = (double)track->vx_mps - truth->vx_mps;
    off[VY] = (double)track->vy_mps - truth->vy_mps;
    off[Z] = (double)track->z_m - height_z_m(height, last_s);
    off[VZ] = (double)track->vz_mps - height->vz_mps;
}

/* Normalised estimation error squared of elements `from` to NUM_ELEMENTS - 1. */
static double nees_from(const struct rho_passive_track *track, unsigned target, int from)
{
    double off[NUM_ELEMENTS], a[NUM_ELEMENTS][NUM_ELEMENTS + 1], sum = 0.0;
    const int n = NUM_ELEMENTS - from;
    errors_of(track, target, off);
    for (int i = 0; i < n; i++) {
        a[i][n] = off[from + i];
        for (int j = 0; j < n; j++) {
            const int row = from + (i > j ? i : j), column = from + (i > j ? j : i);
            a[i][j] = (double)track->covariance[row * (row + 1) / 2 + column];
        }
    }
    for (int k = 0; k < n; k++) {
        assert_true(a[k][k] > 0.0);
        sum += a[k][n] * a[k][n] / a[k][k];
        for (int i = k + 1; i < n; i++) {
            const double factor = a[i][k] / a[k][k];
            for (int j = k; j <= n; j++) {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    return sum;
}

static double sigma_of(const struct rho_passive_track *track, int element)
{
    return sqrt((double)track->covariance[element * (element + 3) / 2]);
}

/* The track nearest to a target in the plane and in height; NULL: none within 3 km. */
static const struct rho_passive_track *track_near(const struct rho_passive *in, unsigned target)
{
    const struct rho_passive_track *nearest = NULL;
    double least_m = 3000.0;
    for (unsigned i = 0; i < in->num_tracks; i++) {
        double off[NUM_ELEMENTS];
        errors_of(&in->tracks[i], target, off);
        const double off_m = hypot(hypot(off[X], off[Y]), in->tracks[i].is_level ? 0.0 : off[Z]);
        if (off_m < least_m) {
            least_m = off_m;
            nearest = &in->tracks[i];
        }
    }
    return nearest;
}

/* ---- errors ---------------------------------------------------------------------------------- */

struct heights {
    unsigned targets, found, level, ghosts;
    double nees, nees_of_height, sigma_z_m;
};

static struct heights heights_of_scenes(const char *what, const struct scene *from, unsigned runs)
{
    struct heights sum = {0};
    for (unsigned run = 0; run < runs; run++) {
        unsigned found = 0;
        draw_scene_with_heights(from);
        search_into(&passive);
        for (unsigned i = 0; i < scene.targets; i++) {
            const struct rho_passive_track *track = track_near(&passive, i);
            if (track) {
                found++;
                sum.level += track->is_level;
                sum.nees += nees_from(track, i, X);
                sum.nees_of_height += nees_from(track, i, Z);
                sum.sigma_z_m += sigma_of(track, Z);
            }
        }
        sum.targets += scene.targets;
        sum.found += found;
        sum.ghosts += passive.num_tracks > found ? passive.num_tracks - found : 0;
    }
    sum.nees /= sum.found;
    sum.nees_of_height /= sum.found;
    print_message("%s: found %.4f, ghosts a run %.4f, sigma of z %.0f m, NEES of six states %.2f, "
                  "of z and vz %.2f\n",
                  what, (double)sum.found / sum.targets, (double)sum.ghosts / runs,
                  sum.sigma_z_m / sum.found, sum.nees, sum.nees_of_height);
    return sum;
}

static void expect_consistent(const struct heights *seen)
{
    assert_true(seen->found >= 0.98 * seen->targets);
    assert_true(seen->ghosts <= 0.02 * seen->targets);
    assert_int_equal(seen->level, 0);
    /* four standard deviations of the mean of a thousand */
    assert_in_range((int)(100.0 * seen->nees), 556, 644);
    assert_in_range((int)(100.0 * seen->nees_of_height), 175, 225);
}

static void heights_have_the_errors_that_their_covariance_tells(void **state)
{
    (void)state;
    static const double sigmas_deg[3] = {0.02, 0.1, 0.5};
    random_state = 31;
    for (unsigned i = 0; i < 3; i++) {
        struct scene from = scene_of(2, 1, 0.1, 1.0, 0.0);
        measure_elevations(&from, sigmas_deg[i]);
        struct heights seen = heights_of_scenes("2 sensors", &from, 1000);
        expect_consistent(&seen);
    }
    struct scene from = scene_of(3, 3, 0.1, 0.9, 1.0);
    measure_elevations(&from, 0.1);
    struct heights seen = heights_of_scenes("3 sensors, misses and false bearings", &from, 350);
    expect_consistent(&seen);
}

/* Each look is from its sensor's own height: with one of all the heights would not fit. */
static void heights_of_the_sensors_count(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 1, 0.1, 1.0, 0.0);
    measure_elevations(&from, 0.05);
    from.sensor_z_m[0] = 2500.0;
    from.sensor_z_m[1] = -400.0;
    random_state = 32;
    struct heights seen = heights_of_scenes("sensors at 2500 and -400 m", &from, 1000);
    expect_consistent(&seen);
}

/* ---- sensors without elevations -------------------------------------------------------------- */

static void one_sensor_with_elevations_gives_heights(void **state)
{
    (void)state;
    for (unsigned which = 0; which < 2; which++) {
        struct scene from = scene_of(2, 1, 0.1, 1.0, 0.0);
        from.sigma_elevation_rad[which] = 0.1 * DEG_RAD;
        from.sensor_z_m[which] = 300.0;
        random_state = 33;
        struct heights seen = heights_of_scenes("one of 2 with elevations", &from, 1000);
        expect_consistent(&seen);
    }
}

/* Takes the elevations off. */
static void forget_elevations(void)
{
    for (unsigned k = 0; k < scene.scans; k++) {
        for (unsigned s = 0; s < scene.sensors; s++) {
            for (unsigned i = 0; i < scene.look[k][s].count; i++) {
                scene.look[k][s].bearings[i].elevation_rad = 0.3f;
                scene.look[k][s].bearings[i].sigma_elevation_rad = 0.0f;
            }
        }
    }
}

/* Heights of sensors are not read then, and the tracks have none. */
static void without_elevations_tracks_are_level(void **state)
{
    (void)state;
    unsigned found = 0;
    for (unsigned run = 0; run < 40; run++) {
        struct scene from = scene_of(3, 2, 0.1, 0.9, 1.0);
        draw_seeded_scene(&from, 700 + run);
        search_into(&other);
        forget_elevations();
        scene.sensor_z_m[0] = 1000.0;
        scene.sensor_z_m[1] = -50.0;
        search_into(&passive);
        assert_int_equal(passive.num_tracks, other.num_tracks);
        for (unsigned i = 0; i < passive.num_tracks; i++) {
            const struct rho_passive_track *track = &passive.tracks[i];
            assert_int_equal(track->is_level, 1);
            assert_true(track->z_m == 0.0f && track->vz_mps == 0.0f);
            for (int k = 10; k < 21; k++) {
                assert_true(track->covariance[k] == 0.0f);
            }
            assert_memory_equal(track, &other.tracks[i], sizeof *track);
            found++;
        }
    }
    assert_true(found >= 70);
}

/* A sharp plane and heights of no use: place and speed are as without the elevations. */
static void coarse_elevations_leave_the_plane_as_it_is(void **state)
{
    (void)state;
    for (unsigned run = 0; run < 20; run++) {
        struct scene from = scene_of(3, 1, 0.02, 1.0, 0.0);
        measure_elevations(&from, 10.0);
        random_state = 750 + run;
        draw_scene_with_heights(&from);
        search_into(&other);
        assert_int_equal(other.num_tracks, 1);
        forget_elevations();
        search_into(&passive);
        assert_int_equal(passive.num_tracks, 1);
        const struct rho_passive_track *with = &other.tracks[0], *without = &passive.tracks[0];
        assert_int_equal(with->hits, without->hits);
        assert_float_equal(with->x_m, without->x_m, 0.2 * sigma_of(without, X));
        assert_float_equal(with->y_m, without->y_m, 0.2 * sigma_of(without, Y));
        assert_float_equal(with->vx_mps, without->vx_mps, 0.2 * sigma_of(without, VX));
        assert_float_equal(with->vy_mps, without->vy_mps, 0.2 * sigma_of(without, VY));
    }
}

/* ---- targets that elevations tell apart ------------------------------------------------------ */

/* Two targets at the same place of the plane, this far one above the other. */
static void draw_targets_one_above_the_other(unsigned seed, double sigma_elevation_deg,
                                             double apart_m)
{
    struct scene from = scene_of(3, 2, 0.1, 1.0, 0.0);
    measure_elevations(&from, sigma_elevation_deg);
    random_state = seed;
    scene = from;
    set_scan_times(&scene);
    scene.target[0] = random_target(scene_span_s(&scene));
    scene.height[0].z_m = uniform(1e3, 3e3);
    scene.target[1] = scene.target[0];
    scene.height[1].z_m = scene.height[0].z_m + apart_m;
    see_all_looks(&scene);
}

static int both_are_found(void)
{
    const struct rho_passive_track *a = track_near(&passive, 0);
    const struct rho_passive_track *b = track_near(&passive, 1);
    return passive.num_tracks == 2 && a && b && a != b;
}

/* Checks how often both are found, that their claims are right, and their errors. */
static void expect_two_tracks(double sigma_elevation_deg, double apart_m)
{
    unsigned found = 0, right = 0, claims = 0, far = 0;
    for (unsigned run = 0; run < 60; run++) {
        draw_targets_one_above_the_other(800 + run, sigma_elevation_deg, apart_m);
        search_into(&passive);
        if (both_are_found()) {
            found++;
            for (unsigned i = 0; i < 2; i++) {
                const struct rho_passive_track *track = track_near(&passive, i);
                far += nees_from(track, i, X) > 22.5; /* one in a thousand */
                for (unsigned k = 0; k < scene.scans; k++) {
                    for (unsigned s = 0; s < scene.sensors; s++) {
                        if (track->claim[k][s] > 0) {
                            claims++;
                            right += scene.look[k][s].target[track->claim[k][s] - 1u] == (int)i;
                        }
                    }
                }
            }
        }
    }
    print_message("%.0f m apart: both found in %u of 60 runs, %.4f of their claims are right, "
                  "%u are far off\n",
                  apart_m, found, (double)right / claims, far);
    assert_true(found >= 58);
    assert_true(right >= 0.99 * claims);
    assert_true(far <= 3);
}

static void targets_one_above_the_other_are_two_tracks(void **state)
{
    (void)state;
    expect_two_tracks(0.1, 1000.0);
    expect_two_tracks(0.5, 6000.0);
}

/* The sensors that see a ghost of two targets at different heights tell different heights. */
static void ghosts_whose_elevations_disagree_do_not_start(void **state)
{
    (void)state;
    unsigned ghosts_with = 0, ghosts_without = 0, found = 0, without = 0;
    for (unsigned run = 0; run < 200; run++) {
        random_state = 900 + run;
        scene = scene_of(2, 4, 0.3, 0.9, 0.0);
        measure_elevations(&scene, 0.1);
        set_scan_times(&scene);
        for (unsigned i = 0; i < 4; i++) {
            scene.target[i] = random_target(scene_span_s(&scene));
            scene.height[i].z_m = 1000.0 + 2500.0 * i;
        }
        see_all_looks(&scene);
        for (unsigned has = 0; has < 2; has++) {
            if (!has) {
                search_into(&passive);
            } else {
                forget_elevations();
                search_into(&passive);
            }
            unsigned seen = 0;
            for (unsigned i = 0; i < 4; i++) {
                seen += track_near(&passive, i) != NULL;
            }
            *(has ? &without : &found) += seen;
            *(has ? &ghosts_without : &ghosts_with) +=
                passive.num_tracks > seen ? passive.num_tracks - seen : 0;
        }
    }
    print_message("with elevations %u ghosts, %.4f found; without %u, %.4f\n", ghosts_with,
                  found / 800.0, ghosts_without, without / 800.0);
    assert_true(ghosts_without >= 20);
    assert_true(5 * ghosts_with <= ghosts_without);
    assert_true(found >= without);
}

/* Bearings of one target cross; elevations of one sensor are those of another height. */
static void a_crossing_whose_elevations_disagree_does_not_start(void **state)
{
    (void)state;
    for (unsigned run = 0; run < 20; run++) {
        for (int disagrees = 0; disagrees < 2; disagrees++) {
            random_state = 1200 + run;
            scene = scene_of(2, 1, 0.1, 1.0, 0.0);
            measure_elevations(&scene, 0.1);
            set_scan_times(&scene);
            scene.target[0] = random_target(scene_span_s(&scene));
            scene.height[0].z_m = 3000.0;
            scene.sensor_z_m[1] = disagrees ? -3000.0 : 0.0;
            see_all_looks(&scene);
            scene.sensor_z_m[1] = 0.0;
            search_into(&passive);
            assert_int_equal(passive.num_tracks, disagrees ? 0 : 1);
        }
    }
}

/* ---- bytes ----------------------------------------------------------------------------------- */

static void the_same_elevations_give_the_same_bytes(void **state)
{
    (void)state;
    struct scene from = scene_of(3, 3, 0.1, 0.9, 1.0);
    measure_elevations(&from, 0.1);
    random_state = 41;
    draw_scene_with_heights(&from);
    memset(&passive, 0xa5, sizeof passive);
    memset(&other, 0, sizeof other);
    search_into(&passive);
    search_into(&other);
    memcpy(&other.config, &passive.config, sizeof other.config);
    assert_memory_equal(&passive, &other, sizeof passive);
    assert_true(rho_passive_is_sound(&passive));
}

/* Airliners fly at 12 km; at 3 km a drone may be as high as it is far away. */
static void high_targets_are_found(void **state)
{
    (void)state;
    struct rho_passive_config config;
    rho_passive_config_default(&config);
    for (unsigned near = 0; near < 2; near++) {
        unsigned found = 0;
        for (unsigned run = 0; run < 50; run++) {
            random_state = 1400 + run;
            scene = scene_of(2, 1, 0.1, 1.0, 0.0);
            measure_elevations(&scene, 0.1);
            set_scan_times(&scene);
            scene.target[0] = random_target(scene_span_s(&scene));
            scene.height[0] = (struct height){near ? 2500.0 : 12e3, 0.0};
            if (near) { /* the same scene, a tenth as large */
                config.range_max_m = 10e3f;
                scene.sensor_y_m[0] *= 0.1;
                scene.sensor_y_m[1] *= 0.1;
                scene.target[0].x_m *= 0.1;
                scene.target[0].y_m *= 0.1;
                scene.target[0].vx_mps *= 0.1;
                scene.target[0].vy_mps *= 0.1;
            }
            see_all_looks(&scene);
            assert_int_equal(rho_passive_init(&passive, sizeof passive, &config), RHO_OK);
            assert_int_equal(push_scans_from(&passive, &scene, 0), RHO_OK);
            assert_int_equal(rho_passive_search(&passive), RHO_OK);
            found += passive.num_tracks == 1;
        }
        print_message("high targets found in %u of 50 runs\n", found);
        assert_true(found >= 49);
    }
}

/* At 0.1 degrees the heights are far apart: no first guess may be between them. */
static void targets_far_above_one_another_are_two_tracks(void **state)
{
    (void)state;
    expect_two_tracks(0.1, 3000.0);
    expect_two_tracks(0.1, 6000.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heights_have_the_errors_that_their_covariance_tells),
        cmocka_unit_test(heights_of_the_sensors_count),
        cmocka_unit_test(one_sensor_with_elevations_gives_heights),
        cmocka_unit_test(without_elevations_tracks_are_level),
        cmocka_unit_test(coarse_elevations_leave_the_plane_as_it_is),
        cmocka_unit_test(targets_one_above_the_other_are_two_tracks),
        cmocka_unit_test(ghosts_whose_elevations_disagree_do_not_start),
        cmocka_unit_test(a_crossing_whose_elevations_disagree_does_not_start),
        cmocka_unit_test(the_same_elevations_give_the_same_bytes),
        cmocka_unit_test(high_targets_are_found),
        cmocka_unit_test(targets_far_above_one_another_are_two_tracks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
