/* SPDX-License-Identifier: MIT */
/*
 * crossing_votes: phase 2 of the search, a Hough transform. The crossings of bearings vote for
 * lines (rho, theta), and the lines with the most votes are taken one after the other.
 */
#include <string.h>

#include "passive_search.h"
#include "policy.h"
#include "rhotrack/types.h"

static unsigned max_votes_of_row(const struct rho_passive_search *search, unsigned row)
{
    unsigned most = 0;
    for (unsigned column = 0; column < RHO_PASSIVE_RHO_CELLS; column++) {
        unsigned votes = rho_count_bits(search->passive->cells[row][column]);
        most = votes > most ? votes : most;
    }
    return most;
}

void rho_passive_vote_lines(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    float cell_m = passive->config.rho_cell_m;
    memset(passive->cells, 0, sizeof passive->cells);
    for (unsigned row = 0; row < search->theta_cells; row++) {
        float cosine = search->cosine[row], sine = search->sine[row];
        for (uint32_t n = 0; n < passive->num_points; n++) {
            /* the scan's bit in the cells that the crossing's errors reach */
            const struct rho_passive_point *point = &passive->points[n];
            float rho_m = point->x_m * cosine + point->y_m * sine;
            float middle = rho_m / cell_m + 0.5f * (float)RHO_PASSIVE_RHO_CELLS;
            float reach = SPREAD_SIGMAS * rho_passive_rho_sigma_m(point, cosine, sine) / cell_m;
            reach = reach < (float)SPREAD_CELLS_MAX ? reach : (float)SPREAD_CELLS_MAX;
            int to = rho_cell_at(middle + reach, RHO_PASSIVE_RHO_CELLS);
            for (int i = rho_cell_at(middle - reach, RHO_PASSIVE_RHO_CELLS); i <= to; i++) {
                passive->cells[row][i] = (uint16_t)(passive->cells[row][i] | 1u << point->scan);
            }
        }
        search->most_votes[row] = (uint8_t)max_votes_of_row(search, row);
    }
}

struct cell {
    int row, column;
};

static int has_exactly_votes(const struct rho_passive_search *search, int row, int column,
                             unsigned votes)
{
    return row >= 0 && row < search->theta_cells && column >= 0 && column < RHO_PASSIVE_RHO_CELLS &&
           rho_count_bits(search->passive->cells[row][column]) == votes;
}

/*
 * Votes spread over several cells, so that cells of equal votes form plateaus. The line is taken
 * from the cell in the middle of its plateau.
 */
static struct cell find_plateau_middle(const struct rho_passive_search *search, struct cell from,
                                       unsigned votes)
{
    int reach = 2 * NEIGHBOUR_CELLS, sum_row = 0, sum_column = 0, count = 0;
    for (int row = from.row - reach; row <= from.row + reach; row++) {
        for (int column = from.column - reach; column <= from.column + reach; column++) {
            if (has_exactly_votes(search, row, column, votes)) {
                sum_row += row;
                sum_column += column;
                count++;
            }
        }
    }
    struct cell best = from;
    int least = INT32_MAX;
    for (int row = from.row - reach; row <= from.row + reach; row++) {
        for (int column = from.column - reach; column <= from.column + reach; column++) {
            int off_row = row * count - sum_row, off_column = column * count - sum_column;
            int off = off_row * off_row + off_column * off_column;
            if (has_exactly_votes(search, row, column, votes) && off < least) {
                least = off;
                best = (struct cell){row, column};
            }
        }
    }
    return best;
}

int rho_passive_take_best_line(struct rho_passive_search *search, unsigned votes_min,
                               struct rho_passive_line *line)
{
    struct cell at = {0, 0};
    unsigned votes = 0;
    for (int row = 0; row < search->theta_cells; row++) {
        if (search->most_votes[row] > votes) {
            votes = search->most_votes[row];
            at.row = row;
        }
    }
    if (votes < votes_min || votes == 0) {
        return 0;
    }
    while (rho_count_bits(search->passive->cells[at.row][at.column]) != votes) {
        at.column++;
    }
    at = find_plateau_middle(search, at, votes);
    /* clears the neighbours too, also across the ends of theta, where rho changes its sign */
    for (int i = at.row - NEIGHBOUR_CELLS; i <= at.row + NEIGHBOUR_CELLS; i++) {
        int is_turned = i < 0 || i >= search->theta_cells;
        int row = i < 0 ? i + search->theta_cells : is_turned ? i - search->theta_cells : i;
        int middle = is_turned ? RHO_PASSIVE_RHO_CELLS - 1 - at.column : at.column;
        for (int column = middle - NEIGHBOUR_CELLS; column <= middle + NEIGHBOUR_CELLS; column++) {
            if (column >= 0 && column < RHO_PASSIVE_RHO_CELLS) {
                search->passive->cells[row][column] = 0;
            }
        }
        search->most_votes[row] = (uint8_t)max_votes_of_row(search, (unsigned)row);
    }
    *line = (struct rho_passive_line){
        .cosine = search->cosine[at.row],
        .sine = search->sine[at.row],
        .rho_m = ((float)at.column + 0.5f - 0.5f * (float)RHO_PASSIVE_RHO_CELLS) *
                 search->passive->config.rho_cell_m};
    return 1;
}
