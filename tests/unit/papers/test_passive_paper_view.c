/* SPDX-License-Identifier: MIT */
/*
 * Views of a search by the paper's passive method, computed again from the batch: ghost matrices,
 * planes and cells, compared with dense planes in double precision.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "passive_paper_reference.h"

static struct rho_passive_paper paper, paper_then;
static struct rho_ghost_matrix matrix;
static uint32_t picture[ROWS_MAX * COLUMNS];
static struct rho_passive_paper_config method;

/* Searches a random scene in which float and double agree on all crossings. */
static void search_random_scene(unsigned sensors, enum rho_ghost_rule rule)
{
    method = paper_config();
    method.rule = rule;
    method.votes_min = 5;
    do {
        scene = scene_of(sensors, 3, 0.1, 0.9, 0.5);
        draw_scene(&scene);
        move_scene(&scene, uniform(-PI, PI), uniform(-1e5, 1e5), uniform(-1e5, 1e5));
        assert_int_equal(search_by_paper(&paper, &method, &scene), RHO_OK);
        fill_planes(&method);
    } while (is_doubtful);
}

static struct rho_votes_picture whole_plane(void)
{
    return (struct rho_votes_picture){.height = (uint16_t)rows, .width = COLUMNS, .votes = picture};
}

static void pairs_are_in_the_order_of_the_search(void **state)
{
    (void)state;
    static const uint8_t expected[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    struct rho_passive_paper_pair pair = {9, 9};
    random_state = 41;
    search_random_scene(3, RHO_GHOST_LITERAL);
    for (unsigned i = 0; i < 3; i++) {
        assert_int_equal(rho_passive_paper_pair(&paper, i, &pair), 1);
        assert_int_equal(pair.a, expected[i][0]);
        assert_int_equal(pair.b, expected[i][1]);
    }
    assert_int_equal(rho_passive_paper_pair(&paper, 3, &pair), 0);
    assert_int_equal(pair.a, 1);
    assert_int_equal(rho_passive_paper_pair(NULL, 0, &pair), 0);
    assert_int_equal(rho_passive_paper_pair(&paper, 0, NULL), 0);
}

static void rho_is_measured_from_the_middle_of_the_sensors(void **state)
{
    (void)state;
    struct rho_passive_paper_space space;
    random_state = 42;
    search_random_scene(3, RHO_GHOST_LITERAL);
    assert_int_equal(rho_passive_paper_space(&paper, &space), RHO_OK);
    assert_float_equal(space.origin_x_m, middle_x_m, 0.1);
    assert_float_equal(space.origin_y_m, middle_y_m, 0.1);
    assert_float_equal(space.rho_max_m, 128000.0f, 0.0);
    assert_int_equal(space.theta_cells, 90);
    assert_int_equal(space.rho_cells, COLUMNS);
}

/* Crossings left in all scans are as many as in the reference. */
static void ghost_matrices_agree_with_the_search(void **state)
{
    (void)state;
    unsigned pruned_by_rule = 0;
    random_state = 43;
    for (int run = 0; run < 20; run++) {
        unsigned kept = 0, all = 0;
        struct rho_passive_paper_pair pair;
        search_random_scene(run % 2 ? 3 : 2, run % 4 ? RHO_GHOST_LITERAL : RHO_GHOST_NO_RULE);
        for (unsigned i = 0; rho_passive_paper_pair(&paper, i, &pair); i++) {
            unsigned of_pair = 0;
            for (unsigned k = 0; k < scene.scans; k++) {
                memset(&matrix, 0x5a, sizeof matrix);
                assert_int_equal(rho_passive_paper_ghosts(&paper, &pair, k, &matrix), RHO_OK);
                assert_int_equal(matrix.rows, scene.look[k][pair.a].count);
                assert_int_equal(matrix.columns, scene.look[k][pair.b].count);
                for (unsigned a = 0; a < matrix.rows; a++) {
                    for (unsigned b = 0; b < matrix.columns; b++) {
                        of_pair += matrix.reason[a][b] == RHO_GHOST_KEPT;
                        pruned_by_rule += matrix.reason[a][b] == RHO_GHOST_ROW ||
                                          matrix.reason[a][b] == RHO_GHOST_COLUMN;
                        all++;
                    }
                }
            }
            cross_pair(pair.a, pair.b, &method);
            assert_int_equal(of_pair, num_crossings);
            kept += of_pair;
        }
        assert_int_equal(all, paper.work.crossings);
        assert_int_equal(all - kept, paper.work.ghosts);
    }
    assert_true(pruned_by_rule > 100);
}

/* Votes are between the reference's sure and possible ones. */
static void the_plane_of_a_pair_has_its_votes(void **state)
{
    (void)state;
    unsigned sure = 0, all = 0;
    random_state = 44;
    for (int run = 0; run < 6; run++) {
        struct rho_passive_paper_pair pair;
        search_random_scene(3, RHO_GHOST_LITERAL);
        for (unsigned i = 0; rho_passive_paper_pair(&paper, i, &pair); i++) {
            struct rho_votes_picture plane = whole_plane();
            assert_int_equal(rho_passive_paper_plane(&paper, &pair, &plane), RHO_OK);
            for (int row = 0; row < rows; row++) {
                for (int column = 0; column < COLUMNS; column++) {
                    const unsigned least =
                        count_votes(&planes[i].sure[row][column], RHO_VOTES_SCANS);
                    const unsigned most =
                        count_votes(&planes[i].most[row][column], RHO_VOTES_SCANS);
                    const uint32_t votes = picture[row * COLUMNS + column];
                    assert_true(votes >= least && votes <= most);
                    sure += most > 0 && least == most;
                    all += most > 0;
                }
            }
        }
    }
    assert_true(all > 10000 && sure > all - all / 10);
}

/*
 * The plane has the cells that every pair confirms; the highest one is the first line of the
 * search.
 */
static void the_plane_of_all_pairs_has_the_cells_that_all_confirm(void **state)
{
    (void)state;
    unsigned lines = 0;
    random_state = 45;
    for (int run = 0; run < 12; run++) {
        uint32_t confirmed = 0, most = 0;
        struct rho_votes_picture plane = whole_plane();
        search_random_scene(run % 2 ? 3 : 2, RHO_GHOST_LITERAL);
        memcpy(&paper_then, &paper, sizeof paper);
        plane.height = (uint16_t)rows;
        assert_int_equal(rho_passive_paper_plane(&paper, NULL, &plane), RHO_OK);
        for (int i = 0; i < rows * COLUMNS; i++) {
            confirmed += picture[i] > 0;
            most = picture[i] > most ? picture[i] : most;
        }
        /* a cell confirmed by its neighbours may have no votes itself */
        assert_in_range(confirmed, scene.sensors > 2 ? 1 : paper.work.cells, paper.work.cells);
        assert_int_equal(most, paper.num_lines > 0 ? paper.lines[0].votes_sum : 0);
        assert_memory_equal(paper.lines, paper_then.lines, sizeof paper.lines);
        assert_memory_equal(&paper.work, &paper_then.work, sizeof paper.work);
        assert_memory_equal(&paper.batch, &paper_then.batch, sizeof paper.batch);
        lines += paper.num_lines;
        /* views do not change the result of another search */
        assert_int_equal(rho_passive_paper_search(&paper), RHO_OK);
        assert_int_equal(paper.num_lines, paper_then.num_lines);
        assert_memory_equal(paper.lines, paper_then.lines, sizeof paper.lines);
    }
    assert_true(lines > 12);
}

/* A better cell's voters have their ridge along rho(theta) of their mean place. */
static void expect_no_cell_on_ridge_of_better(const struct rho_accumulator_peak *peaks,
                                              uint32_t num_peaks,
                                              const struct rho_passive_paper_pair *pair)
{
    cross_pair(pair->a, pair->b, &method);
    for (uint32_t better = 0; better < num_peaks; better++) {
        const struct crossing middle =
            middle_of_voters((struct place){peaks[better].theta_cell, peaks[better].rho_cell},
                             (double)method.rho_cell_m);
        for (uint32_t k = better + 1; k < num_peaks; k++) {
            int first, last;
            columns_of_crossing_in_row(&middle, peaks[k].theta_cell, (double)method.rho_cell_m,
                                       &first, &last);
            assert_true(abs(peaks[k].theta_cell - peaks[better].theta_cell) > 4 ||
                        peaks[k].rho_cell < first - 2 || peaks[k].rho_cell > last + 2);
        }
    }
}

static void listed_cells_of_a_pair_have_enough_votes_and_their_scans(void **state)
{
    (void)state;
    struct rho_accumulator_peak peaks[RHO_MAX_PASSIVE_LINES];
    unsigned cells = 0;
    random_state = 46;
    for (int run = 0; run < 6; run++) {
        struct rho_passive_paper_pair pair;
        search_random_scene(3, RHO_GHOST_LITERAL);
        for (unsigned i = 0; rho_passive_paper_pair(&paper, i, &pair); i++) {
            uint32_t num = 99;
            struct rho_votes_picture plane = whole_plane();
            assert_int_equal(
                rho_passive_paper_cells(&paper, &pair, peaks, RHO_MAX_PASSIVE_LINES, &num), RHO_OK);
            assert_int_equal(rho_passive_paper_plane(&paper, &pair, &plane), RHO_OK);
            uint32_t most = 0;
            for (int k = 0; k < rows * COLUMNS; k++) {
                most = picture[k] > most ? picture[k] : most;
            }
            assert_int_equal(num > 0, most >= paper.votes_min);
            for (uint32_t k = 0; k < num; k++) {
                const struct votes *sure =
                    votes_in_cell(&planes[i], 1, peaks[k].theta_cell, peaks[k].rho_cell);
                const struct votes *possible =
                    votes_in_cell(&planes[i], 0, peaks[k].theta_cell, peaks[k].rho_cell);
                assert_int_equal(peaks[k].votes,
                                 picture[peaks[k].theta_cell * COLUMNS + peaks[k].rho_cell]);
                assert_true(peaks[k].votes >= paper.votes_min);
                assert_true(k > 0 || peaks[k].votes == most);
                assert_true(k == 0 || peaks[k].votes <= peaks[k - 1].votes);
                assert_int_equal(peaks[k].mask & sure->mask, sure->mask);
                assert_int_equal(peaks[k].mask & ~possible->mask, 0);
            }
            expect_no_cell_on_ridge_of_better(peaks, num, &pair);
            cells += num;
        }
    }
    assert_true(cells > 18);
}

static void views_without_a_search_or_valid_pair_are_refused(void **state)
{
    (void)state;
    const struct rho_passive_paper_pair good = {0, 1}, turned = {1, 0}, beyond = {0, 3};
    struct rho_accumulator_peak peak;
    struct rho_passive_paper_space space;
    uint32_t num;
    random_state = 47;
    search_random_scene(3, RHO_GHOST_LITERAL);
    struct rho_votes_picture plane = whole_plane();
    assert_int_equal(rho_passive_paper_ghosts(&paper, &good, scene.scans, &matrix),
                     RHO_ERROR_VALUE);
    assert_int_equal(rho_passive_paper_ghosts(&paper, &turned, 0, &matrix), RHO_ERROR_VALUE);
    assert_int_equal(rho_passive_paper_ghosts(&paper, &beyond, 0, &matrix), RHO_ERROR_VALUE);
    assert_int_equal(rho_passive_paper_ghosts(NULL, &good, 0, &matrix), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_ghosts(&paper, NULL, 0, &matrix), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_ghosts(&paper, &good, 0, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_plane(&paper, &turned, &plane), RHO_ERROR_VALUE);
    assert_int_equal(rho_passive_paper_plane(NULL, &good, &plane), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_plane(&paper, &good, NULL), RHO_ERROR_NULL);
    plane.width = COLUMNS + 1;
    assert_int_equal(rho_passive_paper_plane(&paper, &good, &plane), RHO_ERROR_VALUE);
    assert_int_equal(rho_passive_paper_cells(&paper, &beyond, &peak, 1, &num), RHO_ERROR_VALUE);
    assert_int_equal(rho_passive_paper_cells(&paper, NULL, &peak, 1, &num), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_cells(&paper, &good, NULL, 1, &num), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_cells(&paper, &good, &peak, 1, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_space(NULL, &space), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_space(&paper, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_passive_paper_init(&paper, sizeof paper, &method), RHO_OK);
    plane = whole_plane();
    assert_int_equal(rho_passive_paper_plane(&paper, NULL, &plane), RHO_ERROR_STATE);
    assert_int_equal(rho_passive_paper_cells(&paper, &good, &peak, 1, &num), RHO_ERROR_STATE);
    assert_int_equal(rho_passive_paper_space(&paper, &space), RHO_ERROR_STATE);
    assert_int_equal(push_to_paper(&paper, &scene, 0), RHO_OK);
    assert_int_equal(rho_passive_paper_ghosts(&paper, &good, 0, &matrix), RHO_OK);
    assert_int_equal(rho_passive_paper_plane(&paper, NULL, &plane), RHO_ERROR_STATE);
    paper.magic = 0;
    assert_int_equal(rho_passive_paper_ghosts(&paper, &good, 0, &matrix), RHO_ERROR_STATE);
    assert_int_equal(rho_passive_paper_space(&paper, &space), RHO_ERROR_STATE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_are_in_the_order_of_the_search),
        cmocka_unit_test(rho_is_measured_from_the_middle_of_the_sensors),
        cmocka_unit_test(ghost_matrices_agree_with_the_search),
        cmocka_unit_test(the_plane_of_a_pair_has_its_votes),
        cmocka_unit_test(the_plane_of_all_pairs_has_the_cells_that_all_confirm),
        cmocka_unit_test(listed_cells_of_a_pair_have_enough_votes_and_their_scans),
        cmocka_unit_test(views_without_a_search_or_valid_pair_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
