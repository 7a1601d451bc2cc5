/* SPDX-License-Identifier: MIT */
/* passive_paper_votes: sensor pairs, their crossings and votes, cells that all pairs confirm. */
#include <string.h>

#include "passive_paper_search.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"

void rho_passive_paper_list_sensors(const struct rho_batch *batch,
                                    struct rho_passive_paper_search *search)
{
    for (unsigned s = 0; s < batch->num_sensors; s++) {
        unsigned looks = 0;
        for (unsigned k = 0; k < batch->num_scans; k++) {
            looks += batch->was_seen[k][s];
        }
        if (looks > 0) {
            search->sensors[search->num_sensors++] = (uint8_t)s;
        }
    }
    for (unsigned i = 0; i < search->num_sensors; i++) {
        const struct rho_batch_sensor *sensor = &batch->sensors[search->sensors[i]];
        search->middle_x_m += sensor->x_m / (float)search->num_sensors;
        search->middle_y_m += sensor->y_m / (float)search->num_sensors;
    }
    search->near = search->num_sensors > 2 ? 1 : 0;
}

int rho_passive_paper_pair(const struct rho_passive_paper *paper, unsigned number,
                           struct rho_passive_paper_pair *pair)
{
    struct rho_passive_paper_search search = {.num_sensors = 0};
    if (!paper || !pair || paper->magic != RHO_PASSIVE_PAPER_MAGIC) {
        return 0;
    }
    rho_passive_paper_list_sensors(&paper->batch, &search);
    for (unsigned i = 0; i + 1u < search.num_sensors; i++) {
        const unsigned behind = search.num_sensors - 1u - i;
        if (number < behind) {
            *pair =
                (struct rho_passive_paper_pair){search.sensors[i], search.sensors[i + 1u + number]};
            return 1;
        }
        number -= behind;
    }
    return 0;
}

static unsigned collect_bearings(const struct rho_batch *batch, unsigned scan, unsigned sensor,
                                 float *bearings_rad)
{
    for (unsigned i = 0; i < batch->num_bearings[scan][sensor]; i++) {
        bearings_rad[i] = batch->bearings[scan][sensor][i].bearing_rad;
    }
    return batch->num_bearings[scan][sensor];
}

int rho_passive_paper_fill_ghosts(const struct rho_passive_paper *paper,
                                  const struct rho_passive_paper_search *search,
                                  struct rho_passive_paper_pair pair, unsigned scan,
                                  struct rho_crossing_base *base, struct rho_ghost_matrix *matrix)
{
    const struct rho_batch *batch = &paper->batch;
    const struct rho_batch_look *a = &batch->looks[scan][pair.a], *b = &batch->looks[scan][pair.b];
    float a_rad[RHO_MAX_BEARINGS], b_rad[RHO_MAX_BEARINGS];
    unsigned num_a = collect_bearings(batch, scan, pair.a, a_rad);
    unsigned num_b = collect_bearings(batch, scan, pair.b, b_rad);
    if (rho_crossing_set_base(base, a->x_m - search->middle_x_m, a->y_m - search->middle_y_m,
                              b->x_m - search->middle_x_m, b->y_m - search->middle_y_m) != RHO_OK ||
        rho_ghost_fill(matrix, base, a_rad, num_a, b_rad, num_b, paper->config.range_max_m) !=
            RHO_OK) {
        return 0; /* the sensors are at one place */
    }
    rho_ghost_prune(matrix, paper->config.rule);
    return 1;
}

void rho_passive_paper_cross(struct rho_passive_paper_search *search,
                             struct rho_passive_paper_pair pair)
{
    struct rho_passive_paper *paper = search->paper;
    struct rho_passive_paper_work *work = &search->per_pair;
    memset(work, 0, sizeof *work);
    for (unsigned scan = 0; scan < paper->batch.num_scans; scan++) {
        const struct rho_batch_bearing *a = paper->batch.bearings[scan][pair.a];
        const struct rho_batch_bearing *b = paper->batch.bearings[scan][pair.b];
        struct rho_crossing_base base;
        struct rho_ghost_matrix matrix;
        paper->scan_end[scan] = scan > 0 ? paper->scan_end[scan - 1u] : 0;
        if (!rho_passive_paper_fill_ghosts(paper, search, pair, scan, &base, &matrix)) {
            continue;
        }
        for (unsigned i = 0; i < matrix.rows; i++) {
            for (unsigned j = 0; j < matrix.columns; j++) {
                struct rho_crossing crossing;
                work->crossings++;
                if (matrix.reason[i][j] != RHO_GHOST_KEPT ||
                    rho_crossing_find(&base, a[i].bearing_rad, b[j].bearing_rad,
                                      paper->config.range_max_m, &crossing) != RHO_CROSSING_MEETS) {
                    work->ghosts++;
                } else if (paper->scan_end[scan] == RHO_MAX_PAPER_CROSSINGS) {
                    work->points_dropped = rho_count(work->points_dropped, 1);
                } else {
                    paper->points[paper->scan_end[scan]++] =
                        (struct rho_passive_paper_point){.x_m = crossing.x_m, .y_m = crossing.y_m};
                }
            }
        }
    }
}

float rho_passive_paper_rho_m(float range_m, float bearing_rad, float x_m, float y_m,
                              float theta_rad)
{
    float rho_local_m = range_m * rho_cos(rho_angle_difference(bearing_rad, theta_rad));
    return rho_local_m + x_m * rho_cos(theta_rad) + y_m * rho_sin(theta_rad);
}

struct rho_passive_paper_direction
rho_passive_paper_direction(const struct rho_passive_paper_search *search, int row)
{
    float theta_rad = ((float)row + 0.5f) * RHO_PI / (float)search->rows;
    return (struct rho_passive_paper_direction){rho_cos(theta_rad), rho_sin(theta_rad)};
}

/* Eq. (3) for a crossing at a known place: rho = x cos(theta) + y sin(theta). */
int rho_passive_paper_column(const struct rho_passive_paper_search *search,
                             struct rho_passive_paper_direction direction,
                             const struct rho_passive_paper_point *point)
{
    float rho_m = point->x_m * direction.cosine + point->y_m * direction.sine;
    float cell = rho_m / search->paper->config.rho_cell_m + 0.5f * (float)RHO_PAPER_RHO_CELLS;
    return cell >= 0.0f && cell < (float)RHO_PAPER_RHO_CELLS ? (int)cell : -1;
}

void rho_passive_paper_count_row(const struct rho_passive_paper_search *search, int row,
                                 uint8_t counts[RHO_PAPER_RHO_CELLS])
{
    const struct rho_passive_paper *paper = search->paper;
    struct rho_passive_paper_direction direction = rho_passive_paper_direction(search, row);
    uint8_t voted[RHO_PAPER_RHO_CELLS] = {0}; /* last scan that voted for each cell, from 1 */
    memset(counts, 0, RHO_PAPER_RHO_CELLS);
    for (unsigned scan = 0, i = 0; scan < paper->batch.num_scans; scan++) {
        for (; i < paper->scan_end[scan]; i++) {
            int column = rho_passive_paper_column(search, direction, &paper->points[i]);
            if (column >= 0 && counts[column] < UINT8_MAX &&
                (paper->config.votes == RHO_VOTES_POINTS || voted[column] != scan + 1u)) {
                counts[column]++;
                voted[column] = (uint8_t)(scan + 1u);
            }
        }
    }
}

/* Most votes of a cell and its eight neighbours, in three rows of theta. */
static unsigned max_votes_near(const uint8_t *const rows[3], int column)
{
    unsigned most = 0;
    for (int i = 0; i < 3; i++) {
        for (int j = column - 1; j <= column + 1; j++) {
            if (j >= 0 && j < RHO_PAPER_RHO_CELLS && rows[i][j] > most) {
                most = rows[i][j];
            }
        }
    }
    return most;
}

/*
 * Adds the votes of a pair of sensors to each cell of a row, plus 1 with the first pair; cells that
 * the pair does not confirm become 0, and stay 0.
 */
static void confirm_cells(struct rho_passive_paper_search *search, int row,
                          const uint8_t *const rows[3], int is_first)
{
    uint8_t *cells = search->paper->cells[row];
    for (int column = 0; column < RHO_PAPER_RHO_CELLS; column++) {
        unsigned most = search->near > 0 ? max_votes_near(rows, column) : rows[1][column];
        unsigned so_far = is_first ? 1u : cells[column];
        unsigned sum = so_far + rows[1][column];
        int is_confirmed = so_far > 0 && most >= search->paper->votes_min;
        cells[column] = is_confirmed ? (uint8_t)(sum < UINT8_MAX ? sum : UINT8_MAX) : 0;
    }
}

/* Adds the votes of the pair crossed last to the cells that it confirms, and clears the others. */
static void add_pair_votes(struct rho_passive_paper_search *search, int is_first)
{
    uint8_t(*kept)[RHO_PAPER_RHO_CELLS] = search->paper->rows;
    rho_passive_paper_count_row(search, -1, kept[0]);
    rho_passive_paper_count_row(search, 0, kept[1]);
    for (int row = 0; row < search->rows; row++) {
        const uint8_t *const rows[3] = {kept[row % 3], kept[(row + 1) % 3], kept[(row + 2) % 3]};
        rho_passive_paper_count_row(search, row + 1, kept[(row + 2) % 3]);
        confirm_cells(search, row, rows, is_first);
    }
}

void rho_passive_paper_vote_pairs(struct rho_passive_paper_search *search)
{
    struct rho_passive_paper_work *work = &search->paper->work;
    const struct rho_passive_paper_work *more = &search->per_pair;
    struct rho_passive_paper_pair pair;
    for (unsigned number = 0; rho_passive_paper_pair(search->paper, number, &pair); number++) {
        rho_passive_paper_cross(search, pair);
        work->crossings = rho_count(work->crossings, more->crossings);
        work->ghosts = rho_count(work->ghosts, more->ghosts);
        work->points_dropped = rho_count(work->points_dropped, more->points_dropped);
        unsigned voters = more->crossings - more->ghosts - more->points_dropped;
        work->votes = rho_count(work->votes, voters * (unsigned)search->rows);
        add_pair_votes(search, number == 0);
    }
}
