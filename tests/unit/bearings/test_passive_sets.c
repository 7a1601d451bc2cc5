/* SPDX-License-Identifier: MIT */
/*
 * Bearings that are given out to tracks together. Targets that fly side by side are a few standard
 * deviations apart, so that each look has bearings that several tracks could have; who gets which
 * is compared with other ways to give them out.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "passive_scene.h"
#include "rhotrack/passive.h"

#define RUNS 40
#define GATE 3.5

static struct rho_passive passive;
static struct scene scene;

/* ---- scenes ---------------------------------------------------------------------------------- */

/*
 * Targets side by side across the line of sight, `apart_m` from one to the next, that fly as fast
 * but for `mps`.
 */
static void draw_formation(unsigned targets, double apart_m, double mps, double pd)
{
    scene = scene_of(2, targets, 0.1, pd, 0.0);
    set_scan_times(&scene);
    double y_m = uniform(-8e3, 8e3), vy_mps = uniform(-60.0, 60.0);
    for (unsigned i = 0; i < targets; i++) {
        scene.target[i] = (struct target){40e3 + uniform(-200.0, 200.0), y_m + apart_m * i,
                                          -200.0 + uniform(-mps, mps), vy_mps + uniform(-mps, mps)};
    }
    see_all_looks(&scene);
}

/* ---- what could have been given -------------------------------------------------------------- */

/* A bearing's square of sigmas off a track; beyond the gate: as bad as none. */
static double off2(const struct rho_passive_track *track, unsigned k, unsigned s, unsigned claim)
{
    double t_s = (double)(passive.batch.time_us[k] - passive.batch.time_us[scene.scans - 1]) * 1e-6;
    double dx_m = (double)track->x_m + t_s * (double)track->vx_mps - scene.sensor_x_m[s];
    double dy_m = (double)track->y_m + t_s * (double)track->vy_mps - scene.sensor_y_m[s];
    const struct rho_batch_bearing *bearing = &passive.batch.bearings[k][s][claim - 1];
    double n = remainder((double)bearing->bearing_rad - atan2(dy_m, dx_m), 2.0 * PI) /
               (double)bearing->sigma_rad;
    return n * n;
}

/* What two tracks have of a look, and what they would have the other way round. */
static int is_better_exchanged(const struct rho_passive_track *a, const struct rho_passive_track *b,
                               unsigned k, unsigned s, double least)
{
    unsigned of_a = a->claim[k][s], of_b = b->claim[k][s];
    if (of_a == 0 || of_b == 0 || off2(a, k, s, of_b) > GATE * GATE ||
        off2(b, k, s, of_a) > GATE * GATE) {
        return 0;
    }
    double as_is = off2(a, k, s, of_a) + off2(b, k, s, of_b);
    return off2(a, k, s, of_b) + off2(b, k, s, of_a) < as_is - least;
}

/*
 * A track without a bearing that another one has, while there is one in the gate that nobody has.
 */
static int has_left(unsigned k, unsigned s)
{
    for (unsigned claim = 1; claim <= passive.batch.num_bearings[k][s]; claim++) {
        int is_taken = 0;
        for (unsigned i = 0; i < passive.num_tracks; i++) {
            is_taken |= passive.tracks[i].claim[k][s] == claim;
        }
        for (unsigned i = 0; i < passive.num_tracks && !is_taken; i++) {
            if (passive.tracks[i].claim[k][s] == 0 && off2(&passive.tracks[i], k, s, claim) < 9.0) {
                return 1;
            }
        }
    }
    return 0;
}

/*
 * Of all looks: those in which two tracks had better exchange their bearings, and in which one was
 * left.
 */
struct count {
    unsigned looks, exchanges, left;
    unsigned targets, tracks;
    double score_nat; /* of all tracks */
};

static void count_looks(struct count *count)
{
    for (unsigned k = 0; k < scene.scans; k++) {
        for (unsigned s = 0; s < scene.sensors; s++) {
            count->looks++;
            count->left += (unsigned)has_left(k, s);
            for (unsigned i = 0; i < passive.num_tracks; i++) {
                for (unsigned j = 0; j < i; j++) {
                    count->exchanges += (unsigned)is_better_exchanged(
                        &passive.tracks[i], &passive.tracks[j], k, s, 1.0);
                }
            }
        }
    }
}

static void search_formations(struct count *count, double apart_m, double mps, double pd)
{
    for (unsigned targets = 2; targets <= SCENE_TARGETS; targets++) {
        for (int run = 0; run < RUNS; run++) {
            draw_formation(targets, apart_m, mps, pd);
            assert_int_equal(search_scene(&passive, &scene), RHO_OK);
            assert_true(are_tracks_sound(&passive));
            count_looks(count);
            for (unsigned i = 0; i < passive.num_tracks; i++) {
                count->score_nat += 1e-3 * passive.tracks[i].score_mnat;
            }
            count->targets += targets;
            count->tracks += passive.num_tracks;
        }
    }
}

/* ---- what must hold -------------------------------------------------------------------------- */

/* The fit that comes last moves what was nearest by a little; it is a look in a thousand. */
static void test_each_look_is_given_out_as_well_as_can_be(void **state)
{
    (void)state;
    struct count count = {0};
    random_state = 51;
    search_formations(&count, 300.0, 3.0, 1.0);
    search_formations(&count, 300.0, 3.0, 0.9);
    search_formations(&count, 600.0, 10.0, 0.9);
    search_formations(&count, 1000.0, 30.0, 0.9);
    assert_in_range(count.exchanges, 0, 4);
    assert_in_range(count.left, 0, 6);
    assert_in_range(count.tracks, count.targets * 97 / 100, count.targets);
    /*
     * Sets that turn out to be better than the best one take its place, in 13 of these searches
     * more than twice: 101454.6 nat, and 13 less where two sets may.
     */
    assert_true(count.score_nat > 101448.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_look_is_given_out_as_well_as_can_be),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
