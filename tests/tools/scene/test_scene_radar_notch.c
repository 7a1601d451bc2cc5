/* SPDX-License-Identifier: MIT */
/*
 * Radars of scenes that are blind at some range rates, whether they measure range rates or not; and
 * what a tracker is told of it.
 */
#include "scene_text.h"

#include "scene/scene_radar_notch.h"

#define FLYERS                                                                                     \
    ", \"targets\": [{\"count\": 40, \"range_m\": [5000, 60000], \"speed_mps\": [50, 200], "       \
    "\"keep_range_m\": [2000, 79000]}]"

/* Plots and looks at range rates within the blind zones, and outside them. */
struct seen {
    double blind, blind_looks, open, open_looks;
};

static struct seen count_seen_by_range_rate(const char *radar, double notch_mps, double blind_mps)
{
    char text[1024];
    struct seen seen = {0, 0, 0, 0};

    snprintf(text, sizeof text, SCENE("400", "%s", FLYERS), radar);
    struct scene *scene = scene_of_text(text);
    struct scene_run *run = scene_observe(scene, 1, 0);

    for (size_t i = 0; i < run->num_scans; i++) {
        for (size_t k = 0; k < run->num_paths; k++) {
            struct motion at = path_motion_at(&run->paths[k], run->scans[i].end_s);
            double rate = (at.x_m * at.vx_mps + at.y_m * at.vy_mps) / hypot(at.x_m, at.y_m);
            double off = fabs(blind_mps > 0 ? remainder(rate, blind_mps) : rate);
            bool is_plot = false;

            for (size_t n = 0; n < run->scans[i].num_plots; n++) {
                is_plot = is_plot || run->scans[i].plots[n].target_id == (int)k;
            }
            /* + 6: the range rate changes between the look and the end of the scan */
            if (off < notch_mps - 6) {
                seen.blind += is_plot;
                seen.blind_looks += 1;
            } else if (off > notch_mps + 6) {
                seen.open += is_plot;
                seen.open_looks += 1;
            }
        }
    }
    scene_run_free(run);
    scene_free(scene);
    return seen;
}

static void targets_in_the_notch_are_seen_with_notch_pd(void **state)
{
    static const char *const more[] = {"", ", \"sigma_range_rate_mps\": 1"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        char radar[256];

        snprintf(radar, sizeof radar,
                 RADAR(", \"pd\": 0.8, \"notch_mps\": 20, \"notch_pd\": 0.1%s"), more[i]);
        const struct seen seen = count_seen_by_range_rate(radar, 20, 0);
        assert_true(seen.blind_looks > 100);
        assert_share(seen.blind, seen.blind_looks, 0.1);
        assert_share(seen.open, seen.open_looks, 0.8);
    }
}

static void no_plots_have_range_rates_near_blind_speeds(void **state)
{
    (void)state;
    const struct seen seen = count_seen_by_range_rate(
        RADAR(", \"pd\": 0.8, \"notch_mps\": 12, \"blind_speed_mps\": 70"), 12, 70);
    assert_true(seen.blind_looks > 300);
    assert_share(seen.blind, seen.blind_looks, 0.0);
    assert_share(seen.open, seen.open_looks, 0.8);
}

static void without_a_notch_every_range_rate_is_seen(void **state)
{
    (void)state;
    const struct seen seen = count_seen_by_range_rate(RADAR(", \"pd\": 0.8"), 20, 0);
    assert_share(seen.blind, seen.blind_looks, 0.8);
}

static void pd_in_the_notch_is_the_lesser_of_notch_pd_and_pd(void **state)
{
    const struct scene_notch notch = {.mps = 5, .pd = 0.5, .blind_mps = 30};
    (void)state;
    assert_near(scene_notch_pd(&notch, 4.9, 0.9), 0.5, 0);
    assert_near(scene_notch_pd(&notch, -4.9, 0.3), 0.3, 0);
    assert_near(scene_notch_pd(&notch, 5.1, 0.9), 0.9, 0);
    assert_near(scene_notch_pd(&notch, -64.9, 0.9), 0.5, 0);
    assert_near(scene_notch_pd(&notch, 54.9, 0.9), 0.9, 0);
}

static void the_tracker_may_be_told_another_notch(void **state)
{
    char text[128] = "";
    struct scene *scene = scene_of_text(SCENE(
        "8", RADAR(", \"notch_mps\": 5, \"blind_speed_mps\": 30, \"told\": {\"notch_mps\": 4}"),
        ""));
    FILE *file = fmemopen(text, sizeof text, "w");
    (void)state;
    scene_notch_write_settings(&scene->sensors[0].told.notch, file);
    fclose(file);
    assert_string_equal(text, "notch_mps = 4\nblind_speed_mps = 30\n");
    assert_near(scene->sensors[0].notch.mps, 5, 0);
    scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(targets_in_the_notch_are_seen_with_notch_pd),
        cmocka_unit_test(no_plots_have_range_rates_near_blind_speeds),
        cmocka_unit_test(without_a_notch_every_range_rate_is_seen),
        cmocka_unit_test(pd_in_the_notch_is_the_lesser_of_notch_pd_and_pd),
        cmocka_unit_test(the_tracker_may_be_told_another_notch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
