/* SPDX-License-Identifier: MIT */
/*
 * passive_paper_lines: chooses lines from the cells with the most votes, and fits a
 * position and velocity through the crossings that voted for each line.
 */

#include "passive_paper_search.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

struct cell {
    int row, column;
};

/* Maps a cell of a row beyond the ends of theta to the other end, where rho is reversed. */
static struct cell wrapped_cell(const struct rho_passive_paper_search *search, int row, int column)
{
    struct cell cell = {row, column};
    while (cell.row < 0 || cell.row >= search->rows) {
        cell.row += cell.row < 0 ? search->rows : -search->rows;
        cell.column = RHO_PAPER_RHO_CELLS - 1 - cell.column;
    }
    return cell;
}

/* Sum of votes of a cell, also beyond the ends of theta; 0 beyond the ends of rho. */
static unsigned votes_at(const struct rho_passive_paper_search *search, int row, int column)
{
    struct cell cell = wrapped_cell(search, row, column);
    return column >= 0 && column < RHO_PAPER_RHO_CELLS ? search->paper->cells[cell.row][cell.column]
                                                       : 0u;
}

/* The middle of a plateau: of the cells with the same votes, the one nearest to their mean. */
static struct cell find_plateau_middle(const struct rho_passive_paper_search *search,
                                       struct cell from, unsigned height)
{
    int sum_row = 0, sum_column = 0, count = 0, least = INT32_MAX;
    struct cell best = from;
    for (int i = -2 * LINE_NEAR_ROWS; i <= 2 * LINE_NEAR_ROWS; i++) {
        for (int j = -2 * LINE_NEAR_COLUMNS; j <= 2 * LINE_NEAR_COLUMNS; j++) {
            if (votes_at(search, from.row + i, from.column + j) == height) {
                sum_row += i;
                sum_column += j;
                count++;
            }
        }
    }
    for (int i = -2 * LINE_NEAR_ROWS; i <= 2 * LINE_NEAR_ROWS; i++) {
        for (int j = -2 * LINE_NEAR_COLUMNS; j <= 2 * LINE_NEAR_COLUMNS; j++) {
            int off_row = i * count - sum_row, off_column = j * count - sum_column;
            int off = off_row * off_row + off_column * off_column;
            if (votes_at(search, from.row + i, from.column + j) == height && off < least) {
                least = off;
                best = wrapped_cell(search, from.row + i, from.column + j);
            }
        }
    }
    return best;
}

/*
 * Among a cell and the neighbours that may confirm it, finds the cell with the most
 * votes of the current pair of sensors. Returns its votes.
 */
static unsigned find_most_voted_cell(const struct rho_passive_paper_search *search, struct cell at,
                                     struct cell *best)
{
    uint8_t *counts = search->paper->rows[0];
    *best = at;
    rho_passive_paper_count_row(search, at.row, counts);
    unsigned most = counts[at.column];
    for (int row = at.row - search->near; row <= at.row + search->near; row++) {
        rho_passive_paper_count_row(search, row, counts);
        for (int column = at.column - search->near; column <= at.column + search->near; column++) {
            if (column >= 0 && column < RHO_PAPER_RHO_CELLS && counts[column] > most) {
                most = counts[column];
                *best = (struct cell){row, column};
            }
        }
    }
    return most;
}

/*
 * Clears the cells near a peak. A target's votes fill a ridge, the curve rho(theta) of the mean
 * place of its crossings, of which those of the pair crossed last are at hand; notes their scans.
 */
static void clear_ridge(const struct rho_passive_paper_search *search,
                        struct rho_accumulator_peak *peak)
{
    struct rho_passive_paper *paper = search->paper;
    struct rho_passive_paper_point middle = {0.0f, 0.0f};
    struct cell from, at = {peak->theta_cell, peak->rho_cell};
    (void)find_most_voted_cell(search, at, &from);
    struct rho_passive_paper_direction direction = rho_passive_paper_direction(search, from.row);
    float count = 0.0f;
    for (unsigned scan = 0, i = 0; scan < paper->batch.num_scans; scan++) {
        for (; i < paper->scan_end[scan]; i++) {
            const struct rho_passive_paper_point *point = &paper->points[i];
            if (rho_passive_paper_column(search, direction, point) == from.column) {
                count += 1.0f; /* a cell without votes is no peak */
                middle.x_m += (point->x_m - middle.x_m) / count;
                middle.y_m += (point->y_m - middle.y_m) / count;
                peak->mask |= 1u << scan;
            }
        }
    }
    for (int row = at.row - LINE_NEAR_ROWS; row <= at.row + LINE_NEAR_ROWS; row++) {
        direction = rho_passive_paper_direction(search, row);
        int column = rho_passive_paper_column(search, direction, &middle);
        for (int i = column - LINE_NEAR_COLUMNS; i <= column + LINE_NEAR_COLUMNS; i++) {
            struct cell cell = wrapped_cell(search, row, i);
            if (i >= 0 && i < RHO_PAPER_RHO_CELLS) {
                paper->cells[cell.row][cell.column] = 0;
            }
        }
    }
    paper->cells[at.row][at.column] = 0;
}

unsigned rho_passive_paper_take_peak(const struct rho_passive_paper_search *search,
                                     struct rho_accumulator_peak *peak)
{
    unsigned height = 0;
    struct cell at = {0, 0};
    for (int row = 0; row < search->rows; row++) {
        for (int column = 0; column < RHO_PAPER_RHO_CELLS; column++) {
            if (search->paper->cells[row][column] > height) {
                height = search->paper->cells[row][column];
                at = (struct cell){row, column};
            }
        }
    }
    if (height > 0) {
        at = find_plateau_middle(search, at, height);
        *peak = (struct rho_accumulator_peak){
            .votes = height, .theta_cell = (uint16_t)at.row, .rho_cell = (uint16_t)at.column};
        clear_ridge(search, peak);
    }
    return height;
}

void rho_passive_paper_pick_lines(struct rho_passive_paper_search *search)
{
    struct rho_passive_paper *paper = search->paper;
    struct rho_accumulator_peak peak;
    for (int row = 0; row < search->rows; row++) {
        for (int column = 0; column < RHO_PAPER_RHO_CELLS; column++) {
            paper->work.cells += paper->cells[row][column] > 0;
        }
    }
    while (rho_passive_paper_take_peak(search, &peak) > 0) {
        if (paper->num_lines == RHO_MAX_PASSIVE_LINES) {
            paper->work.lines_dropped = rho_count(paper->work.lines_dropped, 1);
            continue;
        }
        struct rho_passive_paper_direction direction =
            rho_passive_paper_direction(search, peak.theta_cell);
        float column = (float)peak.rho_cell + 0.5f - 0.5f * (float)RHO_PAPER_RHO_CELLS;
        paper->fits[paper->num_lines] = (struct rho_passive_paper_fit){
            .row = (int16_t)peak.theta_cell, .column = (int16_t)peak.rho_cell};
        paper->lines[paper->num_lines++] = (struct rho_passive_paper_line){
            .rho_m = column * paper->config.rho_cell_m + search->middle_x_m * direction.cosine +
                     search->middle_y_m * direction.sine,
            .theta_rad = ((float)peak.theta_cell + 0.5f) * RHO_PI / (float)search->rows,
            .votes = UINT8_MAX,
            .votes_sum = (uint16_t)(peak.votes - 1u)}; /* cells hold 1 and the votes */
    }
}

/* Adds the last pair's crossings in the most voted cell at a line to the line's fit. */
static void add_pair_crossings_to_fit(struct rho_passive_paper_search *search, unsigned number)
{
    struct rho_passive_paper *paper = search->paper;
    struct rho_passive_paper_line *line = &paper->lines[number];
    struct rho_passive_paper_fit *fit = &paper->fits[number];
    struct cell cell;
    unsigned votes = find_most_voted_cell(search, (struct cell){fit->row, fit->column}, &cell);
    struct rho_passive_paper_direction direction = rho_passive_paper_direction(search, cell.row);
    line->votes = votes < line->votes ? (uint16_t)votes : line->votes;
    for (unsigned scan = 0, i = 0; scan < paper->batch.num_scans; scan++) {
        for (; i < paper->scan_end[scan]; i++) {
            const struct rho_passive_paper_point *point = &paper->points[i];
            if (rho_passive_paper_column(search, direction, point) != cell.column) {
                continue;
            }
            if (fit->count == 0) {
                fit->first_x_m = point->x_m;
                fit->first_y_m = point->y_m;
            }
            float u = search->step[scan];
            float x_m = point->x_m - fit->first_x_m, y_m = point->y_m - fit->first_y_m;
            fit->count++;
            fit->u += u;
            fit->uu += u * u;
            fit->x_m += x_m;
            fit->y_m += y_m;
            fit->ux_m += u * x_m;
            fit->uy_m += u * y_m;
            fit->rr_m2 += x_m * x_m + y_m * y_m;
            line->scans = (uint16_t)(line->scans | 1u << scan);
        }
    }
}

/*
 * Solves the least-squares fit of position = p + u d, u the time of the scan, and fills the line's
 * position, velocity and covariance at the newest scan.
 */
static void fit_line_motion(const struct rho_passive_paper_search *search,
                            const struct rho_passive_paper_fit *fit,
                            struct rho_passive_paper_line *line)
{
    float n = (float)fit->count, spread = fit->uu - fit->u * fit->u / n;
    line->crossings = (uint16_t)(fit->count < UINT16_MAX ? fit->count : UINT16_MAX);
    /* a smaller spread of the times u is rounding */
    if (!(spread > 1.0e-6f * n) || (line->scans & (line->scans - 1u)) == 0) {
        return;
    }
    float dx_m = (fit->ux_m - fit->u * fit->x_m / n) / spread;
    float dy_m = (fit->uy_m - fit->u * fit->y_m / n) / spread;
    float ahead = 1.0f - fit->u / n; /* time u from the mean of the crossings to the newest scan */
    line->has_state = 1;
    line->x_m = search->middle_x_m + fit->first_x_m + fit->x_m / n + ahead * dx_m;
    line->y_m = search->middle_y_m + fit->first_y_m + fit->y_m / n + ahead * dy_m;
    line->vx_mps = dx_m / search->half_s;
    line->vy_mps = dy_m / search->half_s;
    float left_m2 = fit->rr_m2 - (fit->x_m * fit->x_m + fit->y_m * fit->y_m) / n -
                    spread * (dx_m * dx_m + dy_m * dy_m);
    /* at least the variance of a position that is anywhere within a cell of rho */
    float cell_m2 = search->paper->config.rho_cell_m * search->paper->config.rho_cell_m / 12.0f;
    float axis_m2 = left_m2 / (2.0f * n);
    axis_m2 = axis_m2 > cell_m2 ? axis_m2 : cell_m2;
    line->place_m2 = axis_m2 * (1.0f / n + ahead * ahead / spread);
    line->place_velocity_m2ps = axis_m2 * ahead / (spread * search->half_s);
    line->velocity_m2ps2 = axis_m2 / (spread * search->half_s * search->half_s);
}

void rho_passive_paper_fit_lines(struct rho_passive_paper_search *search)
{
    struct rho_passive_paper *paper = search->paper;
    struct rho_passive_paper_pair pair;
    for (unsigned number = 0; paper->num_lines > 0 && rho_passive_paper_pair(paper, number, &pair);
         number++) {
        rho_passive_paper_cross(search, pair);
        for (unsigned line = 0; line < paper->num_lines; line++) {
            add_pair_crossings_to_fit(search, line);
        }
    }
    for (unsigned line = 0; line < paper->num_lines; line++) {
        fit_line_motion(search, &paper->fits[line], &paper->lines[line]);
    }
}
