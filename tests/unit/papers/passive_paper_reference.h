/* SPDX-License-Identifier: MIT */
/*
 * Reference of the paper's passive method in double precision: rays are intersected by two linear
 * equations, and every crossing votes in a dense plane of its pair. The library shares its inputs
 * only. A scene with a crossing near a limit, where float may differ, is doubtful; near a border of
 * cells a crossing counts on both sides, and the scene is not compared if that matters.
 */
#ifndef PASSIVE_PAPER_REFERENCE_H
#define PASSIVE_PAPER_REFERENCE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "search_by_passive_paper.h"

static struct scene scene; /* the scene that is searched */

#define CROSSINGS_MAX (SCENE_SCANS * LOOK_MAX * LOOK_MAX)
#define PAIRS_MAX 6
#define ROWS_MAX 90
#define COLUMNS 256

/* A crossing's place, and by how much float may be off. */
struct crossing {
    double x_m, y_m, slack_m;
    unsigned scan;
};

static struct crossing crossings[CROSSINGS_MAX];
static unsigned num_crossings;
static int is_doubtful; /* a crossing is so near a limit that float may decide differently */

/*
 * True if the rays from sensors a and b meet within the range, by two linear equations; the place
 * is written to `at`.
 */
static int intersect_rays(unsigned a, unsigned b, double bearing_a_rad, double bearing_b_rad,
                          double range_max_m, struct crossing *at)
{
    double ax = (float)scene.sensor_x_m[a], ay = (float)scene.sensor_y_m[a];
    double bx = (float)scene.sensor_x_m[b], by = (float)scene.sensor_y_m[b];
    double ca = cos(bearing_a_rad), sa = sin(bearing_a_rad);
    double cb = cos(bearing_b_rad), sb = sin(bearing_b_rad);
    double determinant = ca * sb - sa * cb; /* sine of the angle between the rays */
    double range_a_m = ((bx - ax) * sb - (by - ay) * cb) / determinant;
    double range_b_m = ((bx - ax) * sa - (by - ay) * ca) / determinant;
    double least_m = fmin(range_a_m, range_b_m), most_m = fmax(range_a_m, range_b_m);
    /* relative error from the last digits of the angle */
    double unsure = 4e-7 / (determinant * determinant);
    at->x_m = ax + range_a_m * ca;
    at->y_m = ay + range_a_m * sa;
    at->slack_m = 0.2 + 1000.0 * unsure;
    is_doubtful |= fabs(determinant) < 2e-4 || (fabs(least_m) < 5.0 && most_m > 0.0) ||
                   (least_m > 0.0 && fabs(most_m - range_max_m) < 5.0 + range_max_m * unsure);
    return least_m > 0.0 && most_m <= range_max_m;
}

struct kept {
    unsigned rows, columns;
    int is_left[LOOK_MAX][LOOK_MAX];
};

static unsigned count_left_in_row(const struct kept *kept, unsigned row, unsigned *only)
{
    unsigned count = 0;
    for (unsigned j = 0; j < kept->columns; j++) {
        count += (unsigned)kept->is_left[row][j];
        *only = kept->is_left[row][j] ? j : *only;
    }
    return count;
}

static struct kept transposed(const struct kept *kept)
{
    struct kept other = {.rows = kept->columns, .columns = kept->rows};
    for (unsigned i = 0; i < kept->rows; i++) {
        for (unsigned j = 0; j < kept->columns; j++) {
            other.is_left[j][i] = kept->is_left[i][j];
        }
    }
    return other;
}

/*
 * Steps 2 to 2.4 of the paper; step 2.5 is the same on the transposed matrix. A row's single
 * crossing stays single, so that finished rows need no mark.
 */
static void prune_rows(struct kept *kept)
{
    for (int is_changed = 1; is_changed;) {
        is_changed = 0;
        for (unsigned row = 0, only = 0; row < kept->rows; row++) {
            if (count_left_in_row(kept, row, &only) != 1) {
                continue;
            }
            for (unsigned i = 0; i < kept->rows; i++) {
                is_changed |= i != row && kept->is_left[i][only];
                kept->is_left[i][only] = i == row;
            }
            if (is_changed) {
                break;
            }
        }
    }
}

static void prune_ghosts(struct kept *kept)
{
    prune_rows(kept);
    struct kept other = transposed(kept);
    prune_rows(&other);
    *kept = transposed(&other);
}

static void cross_scan(unsigned a, unsigned b, unsigned k,
                       const struct rho_passive_paper_config *config)
{
    static struct crossing found[LOOK_MAX][LOOK_MAX];
    const struct look *look_a = &scene.look[k][a], *look_b = &scene.look[k][b];
    struct kept kept = {.rows = look_a->count, .columns = look_b->count};
    for (unsigned i = 0; i < kept.rows; i++) {
        for (unsigned j = 0; j < kept.columns; j++) {
            kept.is_left[i][j] = intersect_rays(a, b, (double)look_a->bearings[i].bearing_rad,
                                                (double)look_b->bearings[j].bearing_rad,
                                                (double)config->range_max_m, &found[i][j]);
        }
    }
    if (config->rule == RHO_GHOST_LITERAL) {
        prune_ghosts(&kept);
    }
    for (unsigned i = 0; i < kept.rows; i++) {
        for (unsigned j = 0; j < kept.columns; j++) {
            if (kept.is_left[i][j]) {
                found[i][j].scan = k;
                crossings[num_crossings++] = found[i][j];
            }
        }
    }
}

static void cross_pair(unsigned a, unsigned b, const struct rho_passive_paper_config *config)
{
    num_crossings = 0;
    for (unsigned k = 0; k < scene.scans; k++) {
        cross_scan(a, b, k, config);
    }
}

/*
 * Votes of a pair: `sure` without crossings near a border of cells, `most` with them on both sides.
 */
struct votes {
    uint32_t mask;
    unsigned points;
};
struct plane {
    struct votes sure[ROWS_MAX][COLUMNS], most[ROWS_MAX][COLUMNS];
};

static struct plane planes[PAIRS_MAX];
static unsigned num_pairs;
static int rows;
static double middle_x_m, middle_y_m;

static double theta_of_row(int row)
{
    return (row + 0.5) * PI / rows;
}

/* First and last column of the cells where a crossing may be in this row. */
static void columns_of_crossing_in_row(const struct crossing *crossing, int row, double cell_m,
                                       int *first, int *last)
{
    double rho_m = (crossing->x_m - middle_x_m) * cos(theta_of_row(row)) +
                   (crossing->y_m - middle_y_m) * sin(theta_of_row(row));
    *first = (int)floor((rho_m - crossing->slack_m) / cell_m) + COLUMNS / 2;
    *last = (int)floor((rho_m + crossing->slack_m) / cell_m) + COLUMNS / 2;
}

static void add_vote(struct votes *votes, const struct crossing *crossing)
{
    votes->mask |= 1u << crossing->scan;
    votes->points++;
}

static void fill_plane(struct plane *plane, double cell_m)
{
    memset(plane, 0, sizeof *plane);
    for (unsigned i = 0; i < num_crossings; i++) {
        for (int row = 0; row < rows; row++) {
            int first, last;
            columns_of_crossing_in_row(&crossings[i], row, cell_m, &first, &last);
            for (int column = first; column <= last; column++) {
                if (column >= 0 && column < COLUMNS) {
                    add_vote(&plane->most[row][column], &crossings[i]);
                }
            }
            if (first == last && first >= 0 && first < COLUMNS) {
                add_vote(&plane->sure[row][first], &crossings[i]);
            }
        }
    }
}

static void fill_planes(const struct rho_passive_paper_config *config)
{
    rows = (int)lround(PI / (double)config->theta_cell_rad);
    num_pairs = 0;
    middle_x_m = middle_y_m = 0.0;
    for (unsigned s = 0; s < scene.sensors; s++) {
        middle_x_m += (double)(float)scene.sensor_x_m[s] / scene.sensors;
        middle_y_m += (double)(float)scene.sensor_y_m[s] / scene.sensors;
    }
    is_doubtful = 0;
    for (unsigned a = 0; a + 1 < scene.sensors; a++) {
        for (unsigned b = a + 1; b < scene.sensors; b++) {
            cross_pair(a, b, config);
            fill_plane(&planes[num_pairs++], (double)config->rho_cell_m);
        }
    }
}

static unsigned count_votes(const struct votes *votes, enum rho_accumulator_votes what)
{
    unsigned count = 0;
    for (uint32_t mask = votes->mask; mask; mask &= mask - 1) {
        count++;
    }
    return what == RHO_VOTES_POINTS ? votes->points : count;
}

/* The cell of a row and column; beyond the ends of theta a line is (-rho, theta +- pi). */
static const struct votes *votes_in_cell(const struct plane *plane, int is_sure, int row,
                                         int column)
{
    static const struct votes none;
    int is_turned = row < 0 || row >= rows;
    row = row < 0 ? row + rows : is_turned ? row - rows : row;
    column = is_turned ? COLUMNS - 1 - column : column;
    if (column < 0 || column >= COLUMNS) {
        return &none;
    }
    return is_sure ? &plane->sure[row][column] : &plane->most[row][column];
}

static unsigned most_votes_around_cell(const struct plane *plane, int is_sure, int row, int column,
                                       enum rho_accumulator_votes what)
{
    unsigned most = 0;
    int near = num_pairs > 1;
    for (int i = -near; i <= near; i++) {
        for (int j = -near; j <= near; j++) {
            unsigned votes = count_votes(votes_in_cell(plane, is_sure, row + i, column + j), what);
            most = votes > most ? votes : most;
        }
    }
    return most;
}

/* 0 if some pair does not confirm the cell, else 1 and the votes of all pairs in it. */
static int votes_plus_one_of_confirmed_cell(int is_sure, int row, int column, unsigned votes_min,
                                            enum rho_accumulator_votes what)
{
    unsigned sum = 1;
    for (unsigned i = 0; i < num_pairs; i++) {
        if (most_votes_around_cell(&planes[i], is_sure, row, column, what) < votes_min) {
            return 0;
        }
        sum += count_votes(votes_in_cell(&planes[i], is_sure, row, column), what);
    }
    return (int)sum;
}

static int heights[ROWS_MAX][COLUMNS];
static unsigned num_confirmed;

/* Fills the heights of all cells; false if float may get other ones. */
static inline int fill_heights(const struct rho_passive_paper_config *config, unsigned votes_min)
{
    int is_sure = 1;
    num_confirmed = 0;
    for (int row = 0; row < rows; row++) {
        for (int column = 0; column < COLUMNS; column++) {
            int most = votes_plus_one_of_confirmed_cell(0, row, column, votes_min, config->votes);
            heights[row][column] =
                most > 0
                    ? votes_plus_one_of_confirmed_cell(1, row, column, votes_min, config->votes)
                    : 0;
            is_sure = is_sure && heights[row][column] == most;
            num_confirmed += heights[row][column] > 0;
        }
    }
    return is_sure && !is_doubtful;
}

struct place {
    int row, column;
};

/*
 * Height of the cell i rows and j columns away, also across the ends of theta; NULL beyond the ends
 * of rho.
 */
static int *height_at_offset(struct place from, int i, int j, struct place *at)
{
    int row = from.row + i, column = from.column + j;
    if (column < 0 || column >= COLUMNS) {
        return NULL;
    }
    *at = row < 0       ? (struct place){row + rows, COLUMNS - 1 - column}
          : row >= rows ? (struct place){row - rows, COLUMNS - 1 - column}
                        : (struct place){row, column};
    return &heights[at->row][at->column];
}

static struct place highest_cell(void)
{
    struct place best = {0, 0};
    for (int row = 0; row < rows; row++) {
        for (int column = 0; column < COLUMNS; column++) {
            if (heights[row][column] > heights[best.row][best.column]) {
                best = (struct place){row, column};
            }
        }
    }
    return best;
}

static struct place middle_of_plateau(struct place from)
{
    int height = heights[from.row][from.column];
    double sum_i = 0.0, sum_j = 0.0, count = 0.0, least = INFINITY;
    struct place at, best = from;
    for (int i = -8; i <= 8; i++) {
        for (int j = -6; j <= 6; j++) {
            const int *near = height_at_offset(from, i, j, &at);
            int is_part = near && *near == height;
            sum_i += is_part * i;
            sum_j += is_part * j;
            count += is_part;
        }
    }
    for (int i = -8; i <= 8; i++) {
        for (int j = -6; j <= 6; j++) {
            const int *near = height_at_offset(from, i, j, &at);
            double off = pow(i - sum_i / count, 2.0) + pow(j - sum_j / count, 2.0);
            if (near && *near == height && off < least - 1e-9) {
                least = off;
                best = at;
            }
        }
    }
    return best;
}

static inline void expect_line(const struct rho_passive_paper_line *line, struct place at,
                               int height, const struct rho_passive_paper_config *config)
{
    double theta_rad = theta_of_row(at.row);
    double rho_m = (at.column + 0.5 - COLUMNS / 2) * (double)config->rho_cell_m +
                   middle_x_m * cos(theta_rad) + middle_y_m * sin(theta_rad);
    unsigned least = UINT32_MAX;
    for (unsigned i = 0; i < num_pairs; i++) {
        unsigned votes = most_votes_around_cell(&planes[i], 1, at.row, at.column, config->votes);
        least = votes < least ? votes : least;
    }
    assert_float_equal(line->theta_rad, theta_rad, 1e-5);
    assert_float_equal(line->rho_m, rho_m, 1.0);
    assert_int_equal(line->votes_sum, height - 1);
    assert_int_equal(line->votes, least);
}

/* Sums over the crossings that voted for a line; times are relative to the newest scan. */
struct sums {
    uint32_t mask;
    double count, t, tt, x, y, tx, ty;
};

/*
 * The cell with most votes of a pair at a line, the line's own cell before its neighbours. Returns
 * 0 if float may find another one.
 */
static int find_most_voted_cell_and_tell_if_sure(const struct plane *plane, struct place at,
                                                 enum rho_accumulator_votes what,
                                                 struct place *best)
{
    int near = num_pairs > 1, is_sure = 1;
    unsigned most = count_votes(votes_in_cell(plane, 1, at.row, at.column), what);
    *best = at;
    for (int row = at.row - near; row <= at.row + near; row++) {
        for (int column = at.column - near; column <= at.column + near; column++) {
            const struct votes *votes = votes_in_cell(plane, 1, row, column);
            is_sure = is_sure && votes->points == votes_in_cell(plane, 0, row, column)->points;
            if (count_votes(votes, what) > most) {
                most = count_votes(votes, what);
                *best = (struct place){row, column};
            }
        }
    }
    return is_sure;
}

/* Mean place of the last pair's crossings in a cell; is_doubtful is set if float may add others. */
static inline struct crossing middle_of_voters(struct place cell, double cell_m)
{
    struct crossing middle = {0};
    double count = 0.0;
    for (unsigned i = 0; i < num_crossings; i++) {
        int first, last;
        columns_of_crossing_in_row(&crossings[i], cell.row, cell_m, &first, &last);
        is_doubtful |= first != last && (first == cell.column || last == cell.column);
        if (first == cell.column && last == cell.column) {
            count += 1.0;
            middle.x_m += crossings[i].x_m;
            middle.y_m += crossings[i].y_m;
            middle.slack_m = fmax(middle.slack_m, crossings[i].slack_m);
        }
    }
    middle.x_m /= count;
    middle.y_m /= count;
    return middle;
}

/*
 * The next line, with its height, 0 if there is none. The cells beside the curve of its voters'
 * mean place become 0; is_doubtful is set if float may clear others.
 */
static inline struct place next_line(const struct rho_passive_paper_config *config, int *height)
{
    struct place at, line = highest_cell();
    *height = heights[line.row][line.column];
    if (*height == 0) {
        return line;
    }
    line = middle_of_plateau(line);
    is_doubtful |=
        !find_most_voted_cell_and_tell_if_sure(&planes[num_pairs - 1], line, config->votes, &at);
    const struct crossing middle = middle_of_voters(at, (double)config->rho_cell_m);
    for (int i = -4; i <= 4; i++) {
        int first, last;
        columns_of_crossing_in_row(&middle, line.row + i, (double)config->rho_cell_m, &first,
                                   &last);
        is_doubtful |= first != last;
        for (int column = first - 3; column <= first + 3; column++) {
            int *near = height_at_offset((struct place){line.row, column}, i, 0, &at);
            if (near) {
                *near = 0;
            }
        }
    }
    heights[line.row][line.column] = 0;
    return line;
}

static void add_crossings(struct sums *sums, struct place at, double cell_m)
{
    for (unsigned i = 0; i < num_crossings; i++) {
        int first, last;
        double t_s = scene.time_s[crossings[i].scan] - scene.time_s[scene.scans - 1];
        columns_of_crossing_in_row(&crossings[i], at.row, cell_m, &first, &last);
        if (first == at.column) {
            sums->mask |= 1u << crossings[i].scan;
            sums->count += 1.0;
            sums->t += t_s;
            sums->tt += t_s * t_s;
            sums->x += crossings[i].x_m;
            sums->y += crossings[i].y_m;
            sums->tx += t_s * crossings[i].x_m;
            sums->ty += t_s * crossings[i].y_m;
        }
    }
}

static int gather_state_sums_and_tell_if_sure(struct place at,
                                              const struct rho_passive_paper_config *config,
                                              struct sums *sums)
{
    int is_sure = 1;
    unsigned pair = 0;
    for (unsigned a = 0; a + 1 < scene.sensors; a++) {
        for (unsigned b = a + 1; b < scene.sensors; b++) {
            struct place best;
            is_sure =
                find_most_voted_cell_and_tell_if_sure(&planes[pair++], at, config->votes, &best) &&
                is_sure;
            cross_pair(a, b, config);
            add_crossings(sums, best, (double)config->rho_cell_m);
        }
    }
    return is_sure;
}

static inline void expect_state(const struct rho_passive_paper_line *line, struct place at,
                                const struct rho_passive_paper_config *config)
{
    struct sums sums = {0};
    if (!gather_state_sums_and_tell_if_sure(at, config, &sums)) {
        return;
    }
    assert_int_equal(line->scans, sums.mask);
    assert_int_equal(line->crossings, (int)sums.count);
    assert_int_equal(line->has_state, (sums.mask & (sums.mask - 1)) != 0);
    if (line->has_state) {
        double determinant = sums.count * sums.tt - sums.t * sums.t;
        double vx_mps = (sums.count * sums.tx - sums.t * sums.x) / determinant;
        double vy_mps = (sums.count * sums.ty - sums.t * sums.y) / determinant;
        assert_float_equal(line->vx_mps, vx_mps, 0.2);
        assert_float_equal(line->vy_mps, vy_mps, 0.2);
        assert_float_equal(line->x_m, (sums.x - vx_mps * sums.t) / sums.count, 4.0);
        assert_float_equal(line->y_m, (sums.y - vy_mps * sums.t) / sums.count, 4.0);
    }
}

#endif
