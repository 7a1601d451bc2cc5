/* SPDX-License-Identifier: MIT */
/*
 * Walls in scenes: where mirror images of targets are, how many, and what a tracker is told of
 * walls.
 */
#include "scene_text.h"

#include "scene/scene_reflectors.h"

static void images_mirror_place_and_velocity_at_the_wall(void **state)
{
    const struct scene_reflector wall = {.from_m = {0, 100}, .to_m = {300, 400}, .probability = 1};
    struct motion image;
    (void)state;
    /* mirrored at the wall y = x + 100, (x, y) becomes (y - 100, x + 100) */
    assert_true(scene_reflector_image(
        &wall, 0, 0, &(struct motion){.x_m = 120, .y_m = 180, .vx_mps = 7, .vy_mps = -2}, &image));
    assert_near(image.x_m, 80, 1e-9);
    assert_near(image.y_m, 220, 1e-9);
    assert_near(image.vx_mps, -2, 1e-9);
    assert_near(image.vy_mps, 7, 1e-9);
    /* no image: target behind the wall; line past its end; sensor behind the wall */
    assert_false(
        scene_reflector_image(&wall, 0, 0, &(struct motion){.x_m = 80, .y_m = 220}, &image));
    assert_false(
        scene_reflector_image(&wall, 0, 0, &(struct motion){.x_m = -90, .y_m = -10}, &image));
    assert_false(
        scene_reflector_image(&wall, 0, 300, &(struct motion){.x_m = 120, .y_m = 180}, &image));
}

static void reflections_have_the_configured_probability(void **state)
{
    struct scene *scene = scene_of_text(
        SCENE("400",
              "{\"interval_s\": 0.5, \"range_m\": [1, 5000], \"sigma_range_m\": 1, "
              "\"sigma_azimuth_rad\": 0.001, \"sigma_range_rate_mps\": 0.1, \"pd\": 0.8}",
              ", \"targets\": [{\"at_m\": [-1000, 200], \"velocity_mps\": [5, 0]}], "
              "\"reflectors\": [{\"from_m\": [-2000, 300], \"to_m\": [2000, 300], "
              "\"probability\": 0.4}]"));
    struct scene_run *run = scene_observe(scene, 2, 0);
    size_t seen = 0, images = 0;
    (void)state;
    for (size_t i = 0; i < run->num_scans; i++) {
        for (size_t k = 0; k < run->scans[i].num_plots; k++) {
            const struct scene_plot *plot = &run->scans[i].plots[k];
            const double x_m = -1000 + 5 * plot->t_s, range_m = hypot(x_m, 400);

            if (plot->target_id >= 0) {
                seen++;
                continue;
            }
            images++;
            assert_near(plot->range_m, range_m, 5);
            assert_near(plot->azimuth_rad, atan2(400, x_m), 0.005);
            assert_near(plot->range_rate_mps, x_m * 5 / range_m, 0.5);
        }
    }
    assert_share(seen, run->num_scans, 0.8);
    assert_share(images, seen, 0.4);
    scene_run_free(run);
    scene_free(scene);
}

static void the_tracker_is_told_of_marked_walls_only(void **state)
{
    char text[128] = "";
    struct scene *scene =
        scene_of_text(SCENE("8", RADAR(""),
                            ", \"reflectors\": [{\"from_m\": [1, 2], \"to_m\": [3, 4.5]}, "
                            "{\"from_m\": [9, 2], \"to_m\": [3, 9], \"is_told\": false}, "
                            "{\"from_m\": [5, 2], \"to_m\": [3, 4]}]"));
    FILE *file = fmemopen(text, sizeof text, "w");
    (void)state;
    scene_reflectors_write_told(&scene->reflectors, file);
    fclose(file);
    assert_string_equal(text, "reflectors = 1 2 3 4.5, 5 2 3 4\n");
    scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_mirror_place_and_velocity_at_the_wall),
        cmocka_unit_test(reflections_have_the_configured_probability),
        cmocka_unit_test(the_tracker_is_told_of_marked_walls_only),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
