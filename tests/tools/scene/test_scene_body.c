/* SPDX-License-Identifier: MIT */
/*
 * Extended targets (bodies) of scenes: where their scatterers are, how often each is seen, and
 * which descriptions are refused.
 */
#include "scene_text.h"

#include "scene/scene_body.h"

#define TARGET                                                                                     \
    "{\"at_m\": [%g, 20000], \"velocity_mps\": [0, 15], \"body\": {\"length_m\": 400, "            \
    "\"width_m\": 60, \"scatterers\": 5, \"seen\": 0.6%s}}"
#define SHARP                                                                                      \
    "{\"interval_s\": 1, \"range_m\": [0, 80000], \"sigma_range_m\": 0.001, "                      \
    "\"sigma_azimuth_rad\": 0.000001, \"sigma_range_rate_mps\": 0.001, \"pd\": 0.9}"

static void scatterers_fill_length_and_width(void **state)
{
    const struct scene_body body = {.length_m = 10, .width_m = 4, .scatterers = 5};
    (void)state;
    for (uint64_t seed = 0; seed < 50; seed++) {
        struct random random = random_start(seed, 0, 0);
        double places_m[SCENE_SCATTERERS_MAX][2];
        int along[5] = {0}, across[5] = {0};

        scene_body_draw_scatterers(&body, &random, places_m);
        for (int i = 0; i < 5; i++) {
            const int part = (int)floor((places_m[i][0] + 5.0) / 2.0),
                      side = (int)floor((places_m[i][1] + 2.0) / 0.8);

            assert_in_range(part, 0, 4);
            assert_in_range(side, 0, 4);
            along[part]++;
            across[side]++;
        }
        for (int i = 0; i < 5; i++) {
            assert_int_equal(along[i], 1);
            assert_int_equal(across[i], 1);
        }
    }
}

/* Counts plots of a run and the different places on the body that they come from. */
static size_t count_places_seen_on_body(const char *more, double x_m, double *plots_a_scan)
{
    char target[512], text[1024];
    double first_m[64] = {0};
    size_t count = 0, places = 0;

    snprintf(target, sizeof target, TARGET, x_m, more);
    snprintf(text, sizeof text, SCENE("200", SHARP, ", \"targets\": [%s]"), target);
    struct scene *scene = scene_of_text(text);
    struct scene_run *run = scene_observe(scene, 3, 0);

    for (size_t i = 0; i < run->num_scans; i++) {
        const struct motion at = path_motion_at(&run->paths[0], run->scans[i].end_s);

        for (size_t k = 0; k < run->scans[i].num_plots; k++) {
            const struct scene_plot *plot = &run->scans[i].plots[k];
            const double across_m = plot->range_m * cos(plot->azimuth_rad) - at.x_m,
                         along_m = plot->range_m * sin(plot->azimuth_rad) - at.y_m;
            size_t n = 0;

            assert_int_equal(plot->target_id, 0);
            assert_true(fabs(along_m) < 200.5 && fabs(across_m) < 30.5);
            while (n < places && fabs(first_m[n] - along_m) > 0.5) {
                n++;
            }
            if (n == places && places < 64) {
                first_m[places++] = along_m;
            }
            count++;
        }
    }
    *plots_a_scan = (double)count / (double)run->num_scans;
    scene_run_free(run);
    scene_free(scene);
    return places;
}

static void scatterers_are_fixed_or_drawn_anew_each_scan(void **state)
{
    double plots;
    (void)state;
    assert_int_equal(count_places_seen_on_body("", 1000, &plots), 5);
    assert_true(fabs(plots - 3.0) < 0.3); /* 4 sigmas are 0.31 */
    assert_int_equal(count_places_seen_on_body(", \"is_anew\": true", 1000, &plots), 64);
    assert_true(fabs(plots - 3.0) < 0.3);
}

/* The ends of a turning body move at different speeds: their range rates differ. */
static void a_turning_body_has_range_rates_of_its_ends(void **state)
{
    const char *text =
        SCENE("20", SHARP,
              ", \"targets\": [{\"at_m\": [20000, 0], \"velocity_mps\": [0, 10], \"legs\": "
              "[{\"turn_degps\": 3, \"for_s\": 100}], \"body\": {\"length_m\": 200, \"width_m\": "
              "1, \"scatterers\": 2, \"seen\": 1}}]");
    (void)state;
    struct scene *scene = scene_of_text(text);
    struct scene_run *run = scene_observe(scene, 1, 0);
    const struct scene_scan *first = &run->scans[0];
    assert_int_equal(first->num_plots, 2);
    const double apart_m = (first->plots[1].azimuth_rad - first->plots[0].azimuth_rad) * 20000.0;
    const double rates_mps = first->plots[1].range_rate_mps - first->plots[0].range_rate_mps;
    /*
     * A point d ahead on a body that turns left at w moves towards the sensor at w d; seen d / r to
     * the side, the speed of 10 m/s has a component along its line of sight.
     */
    const double expected_mps = apart_m * (10.0 / 20000.0 - 3.0 * PORTABLE_PI / 180.0);
    assert_true(fabs(rates_mps - expected_mps) < 0.05);
    scene_run_free(run);
    scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scatterers_fill_length_and_width),
        cmocka_unit_test(scatterers_are_fixed_or_drawn_anew_each_scan),
        cmocka_unit_test(a_turning_body_has_range_rates_of_its_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
