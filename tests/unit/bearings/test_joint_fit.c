/* SPDX-License-Identifier: MIT */
/*
 * Assignment of bearings to several tracks at once. Targets fly side by side a few standard
 * deviations apart, so that several tracks could claim a bearing; the claims are compared with
 * exchanged ones.
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

/* Targets in line abreast, `apart_m` from each other, whose velocities differ by up to `mps`. */
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

/* Squared distance of a bearing from a track in sigmas. */
static double bearing_nis(const struct rho_passive_track *track, unsigned k, unsigned s,
                          unsigned claim)
{
    double t_s = (double)(passive.batch.time_us[k] - passive.batch.time_us[scene.scans - 1]) * 1e-6;
    double dx_m = (double)track->x_m + t_s * (double)track->vx_mps - scene.sensor_x_m[s];
    double dy_m = (double)track->y_m + t_s * (double)track->vy_mps - scene.sensor_y_m[s];
    const struct rho_batch_bearing *bearing = &passive.batch.bearings[k][s][claim - 1];
    double n = remainder((double)bearing->bearing_rad - atan2(dy_m, dx_m), 2.0 * PI) /
               (double)bearing->sigma_rad;
    return n * n;
}

/*
 * True if two tracks fit a scan's bearings better by more than `least` with their claims exchanged.
 */
static int is_exchange_better(const struct rho_passive_track *a, const struct rho_passive_track *b,
                              unsigned k, unsigned s, double least)
{
    unsigned of_a = a->claim[k][s], of_b = b->claim[k][s];
    if (of_a == 0 || of_b == 0 || bearing_nis(a, k, s, of_b) > GATE * GATE ||
        bearing_nis(b, k, s, of_a) > GATE * GATE) {
        return 0;
    }
    double as_is = bearing_nis(a, k, s, of_a) + bearing_nis(b, k, s, of_b);
    return bearing_nis(a, k, s, of_b) + bearing_nis(b, k, s, of_a) < as_is - least;
}

/* True if a track has no bearing of the scan though an unclaimed one is within three sigmas. */
static int has_unclaimed_bearing_in_gate(unsigned k, unsigned s)
{
    for (unsigned claim = 1; claim <= passive.batch.num_bearings[k][s]; claim++) {
        int is_taken = 0;
        for (unsigned i = 0; i < passive.num_tracks; i++) {
            is_taken |= passive.tracks[i].claim[k][s] == claim;
        }
        for (unsigned i = 0; i < passive.num_tracks && !is_taken; i++) {
            if (passive.tracks[i].claim[k][s] == 0 &&
                bearing_nis(&passive.tracks[i], k, s, claim) < 9.0) {
                return 1;
            }
        }
    }
    return 0;
}

/*
 * Numbers of scans searched, of pairs of tracks with claims better exchanged, and of scans with an
 * unclaimed bearing.
 */
struct count {
    unsigned looks, exchanges, left;
    unsigned targets, tracks;
    double score_nat; /* sum over all tracks */
};

static void count_claim_errors(struct count *count)
{
    for (unsigned k = 0; k < scene.scans; k++) {
        for (unsigned s = 0; s < scene.sensors; s++) {
            count->looks++;
            count->left += (unsigned)has_unclaimed_bearing_in_gate(k, s);
            for (unsigned i = 0; i < passive.num_tracks; i++) {
                for (unsigned j = 0; j < i; j++) {
                    count->exchanges += (unsigned)is_exchange_better(&passive.tracks[i],
                                                                     &passive.tracks[j], k, s, 1.0);
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
            assert_true(are_tracks_finite_with_right_claims(&passive));
            count_claim_errors(count);
            for (unsigned i = 0; i < passive.num_tracks; i++) {
                count->score_nat += 1e-3 * passive.tracks[i].score_mnat;
            }
            count->targets += targets;
            count->tracks += passive.num_tracks;
        }
    }
}

/*
 * The pair that gains most goes first, which is not always the best assignment: one claim in two
 * hundred may be exchanged for a better one.
 */
static void test_bearings_of_each_scan_are_assigned_to_tracks_well(void **state)
{
    (void)state;
    struct count count = {0};
    random_state = 51;
    search_formations(&count, 300.0, 3.0, 1.0);
    search_formations(&count, 300.0, 3.0, 0.9);
    search_formations(&count, 600.0, 10.0, 0.9);
    search_formations(&count, 1000.0, 30.0, 0.9);
    assert_in_range(count.exchanges, 0, 80);
    assert_in_range(count.left, 0, 6);
    assert_in_range(count.tracks, count.targets * 97 / 100, count.targets);
    /* the evidence of all tracks: 109510.5 nat; with the best exchanges 110096.7 */
    assert_true(count.score_nat > 109500.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bearings_of_each_scan_are_assigned_to_tracks_well),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
