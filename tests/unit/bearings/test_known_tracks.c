/* SPDX-License-Identifier: MIT */
/*
 * Bearings of owners: searches leave them out, and known tracks are candidates beside new ones when
 * they are challenged. Owners are given by the truth, or by a swap of it.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "true_association.h"

#define NOBODY 0u
#define SWAPPED_FROM 4u /* row from which owners are swapped */

/* The track that took a target's bearing of scan k; NOBODY: none. */
typedef uint32_t owner_of(int target, unsigned k);

static uint32_t nobody_owns(int target, unsigned k)
{
    (void)target;
    (void)k;
    return NOBODY;
}

/* Track 1 has target 0, track 2 target 1, and so on. */
static uint32_t right_track_owns(int target, unsigned k)
{
    (void)k;
    return (uint32_t)(target + 1);
}

static uint32_t first_track_owns(int target, unsigned k)
{
    return target == 0 ? right_track_owns(target, k) : NOBODY;
}

static uint32_t first_two_own(int target, unsigned k)
{
    return target < 2 ? right_track_owns(target, k) : NOBODY;
}

static uint32_t swapped_tracks_own(int target, unsigned k)
{
    return right_track_owns(k < SWAPPED_FROM ? target : 1 - target, k);
}

static uint32_t two_that_are_not_known_own(int target, unsigned k)
{
    return 10u + right_track_owns(target, k);
}

/* Squared distance of a target's bearing from the truth, in sigmas. */
static double true_nis(unsigned k, unsigned s, const struct rho_bearing *bearing, int target)
{
    const struct target *truth = &scene.target[target];
    const double time_s = look_time_s(&scene, k, s);
    double dx_m = target_x_m(truth, time_s) - look_x_m(&scene, k, s);
    double dy_m = target_y_m(truth, time_s) - look_y_m(&scene, k, s);
    double off_rad = remainder((double)bearing->bearing_rad - atan2(dy_m, dx_m), 2.0 * PI);
    return pow(off_rad / (double)bearing->sigma_rad, 2.0);
}

/*
 * The owner of a bearing, with its density where it was expected: of a track that is right by its
 * distance from the truth, of one that has been swapped at the edge of the gate, 3.5 sigmas.
 */
static struct rho_batch_owner owner_with_density(unsigned k, unsigned s, unsigned i, owner_of owner)
{
    const struct look *look = &scene.look[k][s];
    const int target = look->target[i];
    struct rho_batch_owner of = {.track_id = target < 0 ? NOBODY : owner(target, k)};
    if (of.track_id != NOBODY) {
        const int is_right = of.track_id % 10u == right_track_owns(target, k);
        double nis = is_right ? true_nis(k, s, &look->bearings[i], target) : 3.5 * 3.5;
        of.density_nat =
            (float)(-log(sqrt(2.0 * PI) * (double)look->bearings[i].sigma_rad) - 0.5 * nis);
    }
    return of;
}

/* Pushes all frames of the scene, with the owners of their bearings. */
static void push_owned(owner_of owner)
{
    assert_int_equal(start_passive(&passive), RHO_OK);
    for (unsigned k = 0; k < scene.scans; k++) {
        struct full_frame full;
        struct rho_batch_owner owners[SCENE_SENSORS * LOOK_MAX] = {{.track_id = NOBODY}};
        unsigned place = 0;
        fill_frame(&scene, k, &full);
        for (unsigned s = 0; s < scene.sensors; s++) {
            for (unsigned i = 0; i < scene.look[k][s].count; i++, place++) {
                owners[place] = owner_with_density(k, s, i, owner);
                full.fates[place] =
                    owners[place].track_id == NOBODY ? RHO_FATE_HELD : RHO_FATE_CLAIMED;
            }
        }
        assert_int_equal(rho_batch_push(&passive.batch, &full.frame, full.fates, owners), RHO_OK);
    }
}

/* Targets 10 km apart, or more, that three sensors see without misses. */
static void draw_targets_apart(unsigned targets, uint64_t seed)
{
    random_state = seed;
    scene = scene_of(3, targets, 0.1, 1.0, 0.0);
    set_scan_times(&scene);
    for (unsigned i = 0; i < targets; i++) {
        scene.target[i] = (struct target){uniform(40e3, 60e3), 12e3 * i - 12e3 + uniform(-1e3, 1e3),
                                          uniform(-250.0, -150.0), uniform(-40.0, 40.0)};
    }
    see_all_looks(&scene);
}

static double seen_x_m(unsigned target)
{
    return target_x_m(&scene.target[target], last_time_s());
}

static double seen_y_m(unsigned target)
{
    return target_y_m(&scene.target[target], last_time_s());
}

/* A known track at a target. */
static struct rho_passive_known known_at_target(uint32_t track_id, unsigned target)
{
    return (struct rho_passive_known){.track_id = track_id,
                                      .x_m = (float)seen_x_m(target),
                                      .y_m = (float)seen_y_m(target),
                                      .vx_mps = (float)scene.target[target].vx_mps,
                                      .vy_mps = (float)scene.target[target].vy_mps};
}

/* A known track that went from one target's first place to the other's last, straight. */
static struct rho_passive_known known_from_to(uint32_t track_id, unsigned from, unsigned to)
{
    struct rho_passive_known known = known_at_target(track_id, to);
    known.vx_mps = (float)((seen_x_m(to) - scene.target[from].x_m) / last_time_s());
    known.vy_mps = (float)((seen_y_m(to) - scene.target[from].y_m) / last_time_s());
    return known;
}

static void challenge(struct rho_passive_known *known, uint32_t num)
{
    assert_int_equal(rho_passive_challenge(&passive, known, num), RHO_OK);
    assert_true(are_tracks_finite_with_right_claims(&passive));
    assert_true(rho_passive_is_sound(&passive));
}

/* Number of found tracks within four sigmas of the target. */
static unsigned count_tracks_at(unsigned target)
{
    unsigned count = 0;
    for (unsigned i = 0; i < passive.num_tracks; i++) {
        const struct rho_passive_track *track = &passive.tracks[i];
        count +=
            fabs((double)track->x_m - seen_x_m(target)) <
                4.0 * sqrt((double)track->covariance[0]) &&
            fabs((double)track->y_m - seen_y_m(target)) < 4.0 * sqrt((double)track->covariance[2]);
    }
    return count;
}

/*
 * One found track is at the target, and claims its bearings and no others; one of them may be
 * beyond the gate.
 */
static void expect_track_of_target(int target)
{
    unsigned num = 0;
    for (unsigned i = 0; i < passive.num_tracks; i++) {
        unsigned of_target = 0;
        for (unsigned k = 0; k < scene.scans; k++) {
            for (unsigned s = 0; s < scene.sensors; s++) {
                const unsigned claim = passive.tracks[i].claim[k][s];
                of_target += claim > 0 && scene.look[k][s].target[claim - 1] == target;
            }
        }
        num += of_target == passive.tracks[i].hits && of_target >= 23;
    }
    assert_int_equal(num, 1);
    assert_int_equal(count_tracks_at((unsigned)target), 1);
}

/* Number of bearings of found tracks that have this owner. */
static unsigned count_claims_of_owner(uint32_t track_id)
{
    unsigned count = 0;
    for (unsigned i = 0; i < passive.num_tracks; i++) {
        for (unsigned k = 0; k < passive.batch.num_scans; k++) {
            for (unsigned s = 0; s < passive.batch.num_sensors; s++) {
                const unsigned claim = passive.tracks[i].claim[k][s];
                count +=
                    claim > 0 && passive.batch.bearings[k][s][claim - 1].owner.track_id == track_id;
            }
        }
    }
    return count;
}

static unsigned count_bearings_of_owner(uint32_t track_id)
{
    unsigned count = 0;
    for (unsigned k = 0; k < passive.batch.num_scans; k++) {
        for (unsigned s = 0; s < passive.batch.num_sensors; s++) {
            for (unsigned i = 0; i < passive.batch.num_bearings[k][s]; i++) {
                count += passive.batch.bearings[k][s][i].owner.track_id == track_id;
            }
        }
    }
    return count;
}

/* ---- searches and given bearings ------------------------------------------------------------- */

static void a_search_leaves_out_bearings_of_owners(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        draw_targets_apart(2, seed);
        push_owned(nobody_owns);
        assert_int_equal(rho_passive_search(&passive), RHO_OK);
        assert_int_equal(passive.num_tracks, 2);
        push_owned(first_track_owns);
        assert_int_equal(rho_passive_search(&passive), RHO_OK);
        assert_int_equal(passive.num_tracks, 1);
        expect_track_of_target(1);
        assert_int_equal(count_claims_of_owner(NOBODY), passive.tracks[0].hits);
        push_owned(right_track_owns);
        assert_int_equal(rho_passive_search(&passive), RHO_OK);
        assert_int_equal(passive.num_tracks, 0);
    }
}

/* Two targets seen by two sensors, searched for. */
static void search_two_target_scene(unsigned seed)
{
    struct scene from = scene_of(2, 2, 0.1, 1.0, 0.5);
    draw_seeded_scene(&from, seed);
    search_into(&passive);
}

static int are_track_states_near(const struct rho_passive_track *a,
                                 const struct rho_passive_track *b)
{
    return hypot((double)(a->x_m - b->x_m), (double)(a->y_m - b->y_m)) < 100.0 &&
           hypot((double)(a->vx_mps - b->vx_mps), (double)(a->vy_mps - b->vy_mps)) < 5.0;
}

/* Once a track has been given its bearings, the search finds the other track and nothing else. */
static void a_track_that_was_started_is_not_found_again(void **state)
{
    (void)state;
    unsigned runs = 0;
    for (unsigned seed = 1; seed <= 20; seed++) {
        search_two_target_scene(seed);
        if (passive.num_tracks != 2) {
            continue;
        }
        for (unsigned first = 0; first < 2; first++) {
            search_two_target_scene(seed);
            const struct rho_passive_track gone = passive.tracks[first];
            const struct rho_passive_track kept = passive.tracks[1 - first];
            unsigned held = count_bearings_of_owner(NOBODY);
            assert_int_equal(rho_passive_give(&passive, &gone, 5), gone.hits);
            assert_int_equal(rho_passive_search(&passive), RHO_OK);
            assert_int_equal(count_bearings_of_owner(NOBODY), held - gone.hits);
            assert_int_equal(count_bearings_of_owner(5), gone.hits);
            assert_true(are_tracks_finite_with_right_claims(&passive));
            assert_int_equal(passive.num_tracks, 1);
            assert_true(are_track_states_near(&passive.tracks[0], &kept));
            assert_int_equal(passive.tracks[0].hits, kept.hits);
            runs++;
        }
    }
    print_message("searched again after a start: %u runs\n", runs);
    assert_true(runs >= 32);
}

/* Both claims are of the same search; the densities have the fits' mean chi-square and prior. */
static void tracks_of_one_search_are_given_their_bearings(void **state)
{
    (void)state;
    search_two_target_scene(1);
    assert_int_equal(passive.num_tracks, 2);
    for (unsigned t = 0; t < 2; t++) {
        const struct rho_passive_track *track = &passive.tracks[t];
        assert_int_equal(rho_passive_give(&passive, track, 5 + t), track->hits);
        for (unsigned k = 0; k < 8; k++) {
            for (unsigned s = 0; s < 2; s++) {
                if (track->claim[k][s] == 0) {
                    continue;
                }
                const struct rho_batch_bearing *bearing =
                    &passive.batch.bearings[k][s][track->claim[k][s] - 1];
                assert_int_equal(bearing->owner.track_id, 5 + t);
                assert_float_equal(bearing->owner.density_nat,
                                   -log(sqrt(2.0 * PI) * (double)bearing->sigma_rad) -
                                       (0.5 * (double)track->chi2 - (double)track->prior_nat) /
                                           track->hits,
                                   1e-4);
            }
        }
    }
    assert_int_equal(rho_passive_search(&passive), RHO_OK);
    assert_int_equal(passive.num_tracks, 0);
}

static void giving_an_empty_or_invalid_track_changes_nothing(void **state)
{
    (void)state;
    search_two_target_scene(1);
    struct rho_passive_track nothing = {.hits = 9};
    static struct rho_passive copy;
    copy = passive;
    assert_int_equal(rho_passive_give(NULL, &nothing, 5), 0);
    assert_int_equal(rho_passive_give(&passive, NULL, 5), 0);
    assert_int_equal(rho_passive_give(&passive, &nothing, 5), 0);
    assert_memory_equal(&passive, &copy, sizeof passive);
    memset(nothing.claim, 255, sizeof nothing.claim); /* claims of bearings beyond the capacity */
    assert_int_equal(rho_passive_give(&passive, &nothing, 5), 0);
    assert_memory_equal(&passive, &copy, sizeof passive);
    passive.magic = copy.magic = 0;
    assert_int_equal(rho_passive_give(&passive, &copy.tracks[0], 5), 0);
    assert_memory_equal(&passive, &copy, sizeof passive);
}

/* ---- challenges ------------------------------------------------------------------------------ */

static void a_right_track_is_not_beaten(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        draw_targets_apart(2, seed);
        push_owned(right_track_owns);
        struct rho_passive_known known[2] = {known_at_target(1, 0), known_at_target(2, 1)};
        known[0].is_beaten = known[1].is_beaten = 9;
        challenge(known, 2);
        assert_int_equal(known[0].is_beaten, 0);
        assert_int_equal(known[1].is_beaten, 0);
        assert_int_equal(passive.num_tracks, 0);
        assert_int_equal(count_bearings_of_owner(1), 24);
        assert_int_equal(count_bearings_of_owner(2), 24);
    }
}

/* Tracks that a search found, and that were given their bearings, stand the next challenge. */
static void tracks_that_were_found_are_not_beaten(void **state)
{
    (void)state;
    for (unsigned seed = 1; seed <= 10; seed++) {
        struct rho_passive_known known[2];
        draw_targets_apart(2, seed);
        search_into(&passive);
        assert_int_equal(passive.num_tracks, 2);
        for (unsigned t = 0; t < 2; t++) {
            const struct rho_passive_track *track = &passive.tracks[t];
            known[t] = (struct rho_passive_known){.track_id = 5 + t,
                                                  .x_m = track->x_m,
                                                  .y_m = track->y_m,
                                                  .vx_mps = track->vx_mps,
                                                  .vy_mps = track->vy_mps,
                                                  .is_level = 1};
            assert_int_equal(rho_passive_give(&passive, track, 5 + t), track->hits);
        }
        challenge(known, 2);
        assert_int_equal(known[0].is_beaten + known[1].is_beaten, 0);
        assert_int_equal(passive.num_tracks, 0);
    }
}

static void tracks_of_swapped_bearings_are_beaten_by_the_true_ones(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        draw_targets_apart(2, seed);
        push_owned(swapped_tracks_own);
        struct rho_passive_known known[2] = {known_from_to(1, 0, 1), known_from_to(2, 1, 0)};
        challenge(known, 2);
        assert_int_equal(known[0].is_beaten, 1);
        assert_int_equal(known[1].is_beaten, 1);
        assert_int_equal(passive.num_tracks, 2);
        expect_track_of_target(0);
        expect_track_of_target(1);
    }
}

/* A track with bearings of two targets, but at one of them, is a fit to that one's bearings. */
static void a_track_that_is_where_a_target_is_is_not_beaten(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        draw_targets_apart(2, seed);
        push_owned(swapped_tracks_own);
        struct rho_passive_known known[2] = {known_at_target(1, 1), known_at_target(2, 0)};
        challenge(known, 2);
        assert_int_equal(known[0].is_beaten + known[1].is_beaten, 0);
        assert_int_equal(passive.num_tracks, 0);
    }
}

static void a_track_without_bearings_is_beaten(void **state)
{
    (void)state;
    draw_targets_apart(2, 1);
    push_owned(right_track_owns);
    struct rho_passive_known known[3] = {known_at_target(1, 0), known_at_target(2, 1)};
    known[2] = (struct rho_passive_known){.track_id = 3, .x_m = 50e3f, .y_m = -40e3f};
    challenge(known, 3);
    assert_int_equal(known[0].is_beaten + known[1].is_beaten, 0);
    assert_int_equal(known[2].is_beaten, 1);
    assert_int_equal(passive.num_tracks, 0);
}

static void a_new_target_is_found_beside_known_tracks(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        draw_targets_apart(3, seed);
        push_owned(first_two_own);
        struct rho_passive_known known[2] = {known_at_target(1, 0), known_at_target(2, 1)};
        challenge(known, 2);
        assert_int_equal(known[0].is_beaten + known[1].is_beaten, 0);
        assert_int_equal(passive.num_tracks, 1);
        expect_track_of_target(2);
        assert_int_equal(count_claims_of_owner(NOBODY), passive.tracks[0].hits);
    }
}

/* Of the swapped tracks one is safe: it keeps its bearings, and the other one's are too few. */
static void a_safe_track_is_never_beaten_and_keeps_its_bearings(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        draw_targets_apart(2, seed);
        push_owned(swapped_tracks_own);
        struct rho_passive_known known[2] = {known_from_to(1, 0, 1), known_from_to(2, 1, 0)};
        known[0].is_safe = 1;
        challenge(known, 2);
        assert_int_equal(known[0].is_beaten, 0);
        assert_int_equal(count_claims_of_owner(1), 0);
        known[1].is_safe = 1;
        challenge(known, 2);
        assert_int_equal(known[0].is_beaten + known[1].is_beaten, 0);
        assert_int_equal(passive.num_tracks, 0);
        push_owned(first_track_owns);
        known[0] = known_at_target(1, 0);
        known[0].is_safe = 1;
        challenge(known, 1);
        assert_int_equal(known[0].is_beaten, 0);
        assert_int_equal(passive.num_tracks, 1);
        expect_track_of_target(1);
        assert_int_equal(count_claims_of_owner(1), 0);
    }
}

/* Two targets at one place of the plane and at different heights, seen with elevations. */
static void draw_targets_one_above_the_other(uint64_t seed)
{
    random_state = seed;
    scene = scene_of(3, 2, 0.1, 1.0, 0.0);
    for (unsigned s = 0; s < scene.sensors; s++) {
        scene.sigma_elevation_rad[s] = 0.1 * DEG_RAD;
    }
    set_scan_times(&scene);
    scene.target[0] = (struct target){uniform(40e3, 60e3), uniform(-12e3, 12e3),
                                      uniform(-250.0, -150.0), uniform(-40.0, 40.0)};
    scene.target[1] = scene.target[0];
    scene.height[0] = (struct height){8000.0, -12.0};
    scene.height[1] = (struct height){2000.0, 6.0};
    see_all_looks(&scene);
}

/* A known track at a target and its height, off_m higher. */
static struct rho_passive_known known_with_height(uint32_t track_id, unsigned target, double off_m)
{
    struct rho_passive_known known = known_at_target(track_id, target);
    known.z_m = (float)(height_z_m(&scene.height[target], last_time_s()) + off_m);
    known.vz_mps = (float)scene.height[target].vz_mps;
    return known;
}

/* A safe track takes the bearings of its height, and leaves those of the target below it. */
static void a_safe_track_keeps_the_bearings_of_its_height(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        draw_targets_one_above_the_other(seed);
        for (unsigned owned = 0; owned < 2; owned++) {
            struct rho_passive_known known = known_with_height(1, owned, 0.0);
            known.is_safe = 1;
            push_owned(nobody_owns);
            challenge(&known, 1);
            assert_int_equal(known.is_beaten, 0);
            assert_int_equal(passive.num_tracks, 1);
            expect_track_of_target(1 - (int)owned);
            assert_float_equal(passive.tracks[0].z_m,
                               height_z_m(&scene.height[1 - owned], last_time_s()), 500.0);
        }
    }
}

static void bearings_of_owners_that_are_not_known_are_left_out(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        draw_targets_apart(2, seed);
        push_owned(two_that_are_not_known_own);
        struct rho_passive_known known[1] = {known_at_target(11, 0)};
        challenge(known, 1);
        assert_int_equal(known[0].is_beaten, 0);
        assert_int_equal(passive.num_tracks, 0);
    }
}

static void where_no_track_is_known_bearings_of_owners_are_left_out(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        draw_targets_apart(2, seed);
        push_owned(two_that_are_not_known_own);
        challenge(NULL, 0);
        assert_int_equal(passive.num_tracks, 0);
    }
}

/* Sensors look in turn: the known tracks are at the time of the newest look. */
static void known_tracks_are_at_the_time_of_the_newest_frame(void **state)
{
    (void)state;
    draw_targets_apart(2, 3);
    scene.has_single_scans = 1;
    scene.offset_s[1] = 3.0;
    scene.offset_s[2] = 6.0;
    see_all_looks(&scene);
    search_into(&passive);
    assert_int_equal(passive.num_tracks, 2);
    struct rho_passive_known known[2] = {known_at_target(1, 0), known_at_target(2, 1)};
    challenge(known, 2); /* they have no bearings but those of their fits */
    assert_int_equal(known[0].is_beaten + known[1].is_beaten, 0);
    assert_int_equal(passive.num_tracks, 0);
}

static void too_few_rows_beat_no_track(void **state)
{
    (void)state;
    draw_targets_apart(2, 4);
    scene.scans = RHO_BATCH_SCANS_MIN - 1;
    push_owned(swapped_tracks_own);
    struct rho_passive_known known[2] = {known_from_to(1, 0, 1), {.track_id = 9, .is_beaten = 1}};
    challenge(known, 2);
    assert_int_equal(known[0].is_beaten + known[1].is_beaten, 0);
    assert_int_equal(passive.num_tracks, 0);
}

static void as_many_tracks_as_there_may_be_are_challenged(void **state)
{
    (void)state;
    struct rho_passive_known known[RHO_MAX_PASSIVE_TRACKS + 2];
    draw_targets_apart(2, 5);
    push_owned(right_track_owns);
    for (unsigned i = 0; i < RHO_MAX_PASSIVE_TRACKS + 2; i++) {
        known[i] = known_at_target(1 + i, 0);
        known[i].x_m += 20e3f * (float)i;
    }
    static struct rho_passive before;
    before = passive;
    assert_int_equal(rho_passive_challenge(&passive, known, RHO_MAX_PASSIVE_TRACKS + 1),
                     RHO_ERROR_CAPACITY);
    assert_memory_equal(&passive, &before, sizeof passive);
    known[1].is_safe = known[2].is_safe = 1; /* safe ones do not count */
    challenge(known, RHO_MAX_PASSIVE_TRACKS + 2);
    assert_int_equal(known[0].is_beaten, 0);
    for (unsigned i = 1; i < RHO_MAX_PASSIVE_TRACKS + 2; i++) {
        assert_int_equal(known[i].is_beaten, i > 2);
    }
}

static void challenges_of_no_object_are_refused(void **state)
{
    (void)state;
    draw_targets_apart(2, 6);
    push_owned(right_track_owns);
    struct rho_passive_known known[1] = {known_at_target(1, 0)};
    static struct rho_passive before;
    before = passive;
    assert_int_equal(rho_passive_challenge(NULL, known, 1), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_challenge(&passive, NULL, 1), RHO_ERROR_NULL);
    assert_memory_equal(&passive, &before, sizeof passive);
    passive.magic = 0;
    assert_int_equal(rho_passive_challenge(&passive, known, 1), RHO_ERROR_STATE);
    assert_int_equal(rho_passive_challenge(&passive, NULL, 0), RHO_ERROR_STATE);
    passive.magic = before.magic;
    assert_memory_equal(&passive, &before, sizeof passive);
}

/* Known at its place and height, without bearings in the batch; another target is below it. */
static void a_right_track_above_another_target_is_not_beaten(void **state)
{
    unsigned beaten = 0, started = 0;
    (void)state;
    for (uint64_t seed = 1; seed <= 50; seed++) {
        draw_targets_one_above_the_other(seed);
        struct rho_passive_known known = known_with_height(1, 0, 0.0);
        push_owned(nobody_owns);
        challenge(&known, 1);
        beaten += known.is_beaten;
        started += passive.num_tracks == 1;
    }
    print_message("beaten in %u of 50 runs, the other one started in %u\n", beaten, started);
    assert_int_equal(beaten, 0);
    assert_int_equal(started, 50);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_search_leaves_out_bearings_of_owners),
        cmocka_unit_test(a_track_that_was_started_is_not_found_again),
        cmocka_unit_test(tracks_of_one_search_are_given_their_bearings),
        cmocka_unit_test(giving_an_empty_or_invalid_track_changes_nothing),
        cmocka_unit_test(a_right_track_is_not_beaten),
        cmocka_unit_test(tracks_that_were_found_are_not_beaten),
        cmocka_unit_test(tracks_of_swapped_bearings_are_beaten_by_the_true_ones),
        cmocka_unit_test(a_track_that_is_where_a_target_is_is_not_beaten),
        cmocka_unit_test(a_track_without_bearings_is_beaten),
        cmocka_unit_test(a_new_target_is_found_beside_known_tracks),
        cmocka_unit_test(a_safe_track_is_never_beaten_and_keeps_its_bearings),
        cmocka_unit_test(a_safe_track_keeps_the_bearings_of_its_height),
        cmocka_unit_test(bearings_of_owners_that_are_not_known_are_left_out),
        cmocka_unit_test(where_no_track_is_known_bearings_of_owners_are_left_out),
        cmocka_unit_test(known_tracks_are_at_the_time_of_the_newest_frame),
        cmocka_unit_test(too_few_rows_beat_no_track),
        cmocka_unit_test(as_many_tracks_as_there_may_be_are_challenged),
        cmocka_unit_test(challenges_of_no_object_are_refused),
        cmocka_unit_test(a_right_track_above_another_target_is_not_beaten),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
