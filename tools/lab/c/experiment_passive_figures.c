/* SPDX-License-Identifier: MIT */
/* What the paper's figures show, in numbers. */
#include <stdlib.h>

#include "base/common.h"
#include "experiment_passive_report.h"

#define STREAM 8000
#define SENSORS_MAX 3

/* 0.05 degrees: what is on a line fills few cells. */
static const struct passive_setting settings[] = {
    {2, 2, 0.05, 1.0, 0.0, PASSIVE_AHEAD, false},
    {SENSORS_MAX, 2, 0.05, 1.0, 0.0, PASSIVE_AHEAD, false},
};

static const struct passive_figure rows[PASSIVE_FIGURES] = {
    {.figures = "2, 6, 7", .sensors = "1 and 2", .mask = 3, RHO_GHOST_NO_RULE, .votes_min = 7},
    {.figures = "3, 8, 9", .sensors = "1 and 2", .mask = 3, RHO_GHOST_LITERAL, .votes_min = 7},
    {.figures = "4, 5", .sensors = "1 and 2", .mask = 3, RHO_GHOST_LITERAL, .votes_min = 6},
    {.figures = "4, 5", .sensors = "1 and 3", .mask = 5, RHO_GHOST_LITERAL, .votes_min = 6},
    {.figures = "4, 5", .sensors = "2 and 3", .mask = 6, RHO_GHOST_LITERAL, .votes_min = 6},
    {.figures = "4, 5", .sensors = "all three", .mask = 7, RHO_GHOST_LITERAL, .votes_min = 6},
};

struct passive_scene passive_figures_scene(size_t sensors)
{
    struct random random =
        random_start(PASSIVE_FIGURES_SEED, STREAM,
                     sensors == SENSORS_MAX ? PASSIVE_FIGURES_THREE_RUN : PASSIVE_FIGURES_TWO_RUN);
    return passive_scene_draw(&settings[sensors - 2], &random);
}

static void count_crossings(struct passive_figure *figure, const struct passive_scene *scene,
                            size_t scan, size_t a, size_t b)
{
    struct rho_ghost_matrix matrix = passive_matrix(scene, scan, a, b, figure->rule);
    for (size_t i = 0; i < matrix.rows; i++) {
        for (size_t j = 0; j < matrix.columns; j++) {
            bool is_left = matrix.reason[i][j] == RHO_GHOST_KEPT;
            bool is_target = passive_is_target(scene, scan, a, i, b, j);
            figure->crossings += is_left && is_target;
            figure->ghosts += is_left && !is_target;
        }
    }
}

static void make(struct passive_figure *figure, const struct passive_scene *scene,
                 struct rho_passive_paper *paper)
{
    for (size_t b = 1; b < SENSORS_MAX; b++) {
        for (size_t a = 0; a < b; a++) {
            bool is_in = (figure->mask >> a & figure->mask >> b & 1u) != 0;
            for (size_t scan = 0; scan < PASSIVE_SCANS && is_in; scan++) {
                count_crossings(figure, scene, scan, a, b);
            }
        }
    }
    passive_paper_search(paper, scene, figure->mask, figure->votes_min, figure->rule);
    figure->lines = passive_lines_match(paper, scene);
}

void passive_figures_make(struct passive_figure figures[PASSIVE_FIGURES])
{
    struct passive_scene two = passive_figures_scene(2), three = passive_figures_scene(SENSORS_MAX);
    struct rho_passive_paper *paper = must_alloc(sizeof *paper);
    for (size_t i = 0; i < PASSIVE_FIGURES; i++) {
        figures[i] = rows[i];
        make(&figures[i], i < 2 ? &two : &three, paper);
    }
    free(paper);
    passive_scene_free(&two);
    passive_scene_free(&three);
}
