/* SPDX-License-Identifier: MIT */
/* Pictures of windows of a parameter plane: each pixel has the most votes of its block of cells. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/detail/votes_picture.h"

#define THETA_CELLS 37u
#define RHO_CELLS 101u

static uint32_t picture[THETA_CELLS * RHO_CELLS];

static uint32_t votes_at(unsigned theta, unsigned rho)
{
    return theta * 1000u + rho * 7u % 11u;
}

static void note_all_cells(struct rho_votes_picture *plane)
{
    for (unsigned theta = 0; theta < THETA_CELLS; theta++) {
        for (unsigned rho = 0; rho < RHO_CELLS; rho++) {
            rho_votes_picture_enter_cell(plane, theta, rho, votes_at(theta, rho));
        }
    }
}

/* Expected picture from all cells; only the pixel of a cell is computed as in the library. */
static void expect_picture(const struct rho_votes_picture *plane)
{
    static uint32_t expected[THETA_CELLS * RHO_CELLS];
    memset(expected, 0, sizeof expected);
    for (unsigned i = 0; i < plane->theta_cells; i++) {
        for (unsigned j = 0; j < plane->rho_cells; j++) {
            uint32_t *most = &expected[i * plane->height / plane->theta_cells * plane->width +
                                       j * plane->width / plane->rho_cells];
            const uint32_t votes = votes_at(plane->first_theta + i, plane->first_rho + j);
            *most = votes > *most ? votes : *most;
        }
    }
    assert_memory_equal(picture, expected,
                        (size_t)plane->height * plane->width * sizeof picture[0]);
}

static void a_picture_as_large_as_its_window_shows_every_cell(void **state)
{
    (void)state;
    struct rho_votes_picture plane = {.height = THETA_CELLS, .width = RHO_CELLS, .votes = picture};
    memset(picture, 0x5a, sizeof picture);
    assert_int_equal(rho_votes_picture_init(&plane, THETA_CELLS, RHO_CELLS), RHO_OK);
    assert_int_equal(plane.theta_cells, THETA_CELLS);
    assert_int_equal(plane.rho_cells, RHO_CELLS);
    for (unsigned i = 0; i < THETA_CELLS * RHO_CELLS; i++) {
        assert_int_equal(picture[i], 0);
    }
    note_all_cells(&plane);
    for (unsigned theta = 0; theta < THETA_CELLS; theta++) {
        for (unsigned rho = 0; rho < RHO_CELLS; rho++) {
            assert_int_equal(picture[theta * RHO_CELLS + rho], votes_at(theta, rho));
        }
    }
}

static void a_smaller_picture_shows_the_most_votes_of_each_block(void **state)
{
    (void)state;
    struct rho_votes_picture plane = {.height = 5, .width = 8, .votes = picture};
    assert_int_equal(rho_votes_picture_init(&plane, THETA_CELLS, RHO_CELLS), RHO_OK);
    note_all_cells(&plane);
    expect_picture(&plane);
    plane.first_theta = 3;
    plane.theta_cells = 30;
    plane.first_rho = 90;
    plane.rho_cells = 11;
    assert_int_equal(rho_votes_picture_init(&plane, THETA_CELLS, RHO_CELLS), RHO_OK);
    note_all_cells(&plane);
    expect_picture(&plane);
    assert_int_equal(picture[5 * 8 - 1] / 1000u, 32); /* cells outside the window do not count */
}

static void windows_beyond_the_plane_are_refused(void **state)
{
    (void)state;
    const struct rho_votes_picture whole = {.height = 5, .width = 8, .votes = picture};
    struct rho_votes_picture plane = whole;
    assert_int_equal(rho_votes_picture_init(NULL, THETA_CELLS, RHO_CELLS), RHO_ERROR_NULL);
    plane.votes = NULL;
    assert_int_equal(rho_votes_picture_init(&plane, THETA_CELLS, RHO_CELLS), RHO_ERROR_NULL);
    plane = whole;
    plane.height = THETA_CELLS + 1u;
    assert_int_equal(rho_votes_picture_init(&plane, THETA_CELLS, RHO_CELLS), RHO_ERROR_VALUE);
    plane = whole;
    plane.width = 0;
    assert_int_equal(rho_votes_picture_init(&plane, THETA_CELLS, RHO_CELLS), RHO_ERROR_VALUE);
    plane = whole;
    plane.first_theta = 30;
    plane.theta_cells = THETA_CELLS - 29u;
    assert_int_equal(rho_votes_picture_init(&plane, THETA_CELLS, RHO_CELLS), RHO_ERROR_VALUE);
    plane.theta_cells--;
    assert_int_equal(rho_votes_picture_init(&plane, THETA_CELLS, RHO_CELLS), RHO_OK);
    plane.first_rho = 2;
    plane.rho_cells = RHO_CELLS - 1u;
    assert_int_equal(rho_votes_picture_init(&plane, THETA_CELLS, RHO_CELLS), RHO_ERROR_VALUE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_as_large_as_its_window_shows_every_cell),
        cmocka_unit_test(a_smaller_picture_shows_the_most_votes_of_each_block),
        cmocka_unit_test(windows_beyond_the_plane_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
