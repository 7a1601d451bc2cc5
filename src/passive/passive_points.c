/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "passive_search.h"
#include "rhotrack/approx.h"
#include "rhotrack/types.h"

#define THIRD_SIGMAS 3.0f
#define SPREAD_SIGMAS 2.0f
#define SPREAD_CELLS_MAX 8
#define NEAR_CELLS 2     /* that a line's neighbours are */
#define LINE_CELLS 1.5f  /* from a line to its crossings, at least */
#define PAIR_SCANS_MIN 3 /* apart: nearer ones say little of the velocity */
#define SPEED_SLACK_MPS 150.0f
#define LINE_POINTS_MAX 160u
#define FITS_PER_LINE 20u

/* ---- crossings -------------------------------------------------------------------------------- */

/* Two sensors' bearings of one scan that are there, and which they are. */
struct looks {
    unsigned scan, a, b;
    unsigned num_a, num_b;
    float bearings_a_rad[RHO_MAX_BEARINGS], bearings_b_rad[RHO_MAX_BEARINGS];
    uint8_t which_a[RHO_MAX_BEARINGS], which_b[RHO_MAX_BEARINGS];
};

static unsigned gather(const struct rho_passive_search *search, unsigned scan, unsigned sensor,
                       float *bearings_rad, uint8_t *which)
{
    const struct rho_passive *passive = search->passive;
    unsigned count = 0;
    for (unsigned i = 0; i < passive->batch.num_bearings[scan][sensor]; i++) {
        if (!search->is_second || !passive->is_claimed[scan][sensor][i]) {
            which[count] = (uint8_t)i;
            bearings_rad[count++] = passive->batch.bearings[scan][sensor][i].bearing_rad;
        }
    }
    return count;
}

/* Whether a sensor has a bearing where it would see the crossing, within both their errors. */
static int is_seen_by(const struct rho_passive_search *search, unsigned sensor,
                      const struct rho_passive_point *point)
{
    const struct rho_passive *passive = search->passive;
    float dx_m = point->x_m - search->x_m[sensor], dy_m = point->y_m - search->y_m[sensor];
    float range2 = dx_m * dx_m + dy_m * dy_m;
    if (!(range2 > 1.0f)) {
        return 0;
    }
    /* of the place across the line of sight, times range^2 */
    float across =
        point->xx_m2 * dy_m * dy_m - 2.0f * point->xy_m2 * dx_m * dy_m + point->yy_m2 * dx_m * dx_m;
    for (unsigned i = 0; i < passive->batch.num_bearings[point->scan][sensor]; i++) {
        const struct rho_batch_bearing *seen = &passive->batch.bearings[point->scan][sensor][i];
        float off_m = seen->cosine * dy_m - seen->sine * dx_m;
        float variance_m2 = across / range2 + seen->sigma_rad * seen->sigma_rad * range2;
        if (seen->cosine * dx_m + seen->sine * dy_m > 0.0f &&
            off_m * off_m < THIRD_SIGMAS * THIRD_SIGMAS * variance_m2) {
            return 1;
        }
    }
    return 0;
}

/* With three sensors one more must see it, with four one, and so on: one of them may miss. */
static int is_supported(const struct rho_passive_search *search, const struct looks *looks,
                        const struct rho_passive_point *point)
{
    unsigned num_sensors = search->passive->batch.num_sensors, support = 0;
    if (num_sensors < 3 || search->is_second) {
        return 1;
    }
    for (unsigned s = 0; s < num_sensors; s++) {
        support += s != looks->a && s != looks->b && is_seen_by(search, s, point);
    }
    return support >= (num_sensors > 4 ? num_sensors - 3u : 1u);
}

static float uncertainty_m2(const struct rho_passive_point *point)
{
    return point->xx_m2 + point->yy_m2;
}

static uint32_t least_certain(const struct rho_passive *passive)
{
    uint32_t worst = 0;
    for (uint32_t i = 1; i < passive->num_points; i++) {
        if (uncertainty_m2(&passive->points[i]) > uncertainty_m2(&passive->points[worst])) {
            worst = i;
        }
    }
    return worst;
}

/* Where there is no room the least certain one gives way; it is only looked for when it has changed. */
static void add_point(struct rho_passive_search *search, const struct rho_passive_point *point)
{
    struct rho_passive *passive = search->passive;
    if (passive->num_points < RHO_MAX_PASSIVE_POINTS) {
        passive->points[passive->num_points++] = *point;
        search->worst_point = passive->num_points;
        return;
    }
    if (search->worst_point == passive->num_points) {
        search->worst_point = least_certain(passive);
    }
    passive->work.points_dropped = rho_count(passive->work.points_dropped, 1);
    if (uncertainty_m2(point) < uncertainty_m2(&passive->points[search->worst_point])) {
        passive->points[search->worst_point] = *point;
        search->worst_point = passive->num_points;
    }
}

static void add_crossing(struct rho_passive_search *search, const struct looks *looks,
                         const struct rho_crossing_base *base, unsigned i, unsigned j)
{
    struct rho_passive *passive = search->passive;
    const struct rho_batch_bearing *a =
        &passive->batch.bearings[looks->scan][looks->a][looks->which_a[i]];
    const struct rho_batch_bearing *b =
        &passive->batch.bearings[looks->scan][looks->b][looks->which_b[j]];
    struct rho_crossing crossing;
    float covariance_m2[3];
    if (rho_crossing_find(base, a->bearing_rad, b->bearing_rad, passive->config.range_max_m,
                          &crossing) != RHO_CROSSING_MEETS) {
        return;
    }
    rho_crossing_covariance(&crossing, a->bearing_rad, b->bearing_rad, a->sigma_rad, b->sigma_rad,
                            covariance_m2);
    struct rho_passive_point point = {.x_m = crossing.x_m,
                                      .y_m = crossing.y_m,
                                      .xx_m2 = covariance_m2[0],
                                      .xy_m2 = covariance_m2[1],
                                      .yy_m2 = covariance_m2[2],
                                      .scan = (uint16_t)looks->scan};
    if (is_supported(search, looks, &point)) {
        add_point(search, &point);
    }
}

static void cross_looks(struct rho_passive_search *search, const struct looks *looks,
                        const struct rho_crossing_base *base)
{
    struct rho_passive *passive = search->passive;
    struct rho_ghost_matrix matrix;
    if (rho_ghost_fill(&matrix, base, looks->bearings_a_rad, looks->num_a, looks->bearings_b_rad,
                       looks->num_b, passive->config.range_max_m) != RHO_OK) {
        return; /* bearings were checked when they came */
    }
    rho_ghost_prune(&matrix, passive->config.rule);
    for (unsigned i = 0; i < looks->num_a; i++) {
        for (unsigned j = 0; j < looks->num_b; j++) {
            int is_ghost = matrix.reason[i][j] != RHO_GHOST_KEPT;
            if (!search->is_second) {
                passive->work.crossings = rho_count(passive->work.crossings, 1);
                passive->work.ghosts = rho_count(passive->work.ghosts, (unsigned)is_ghost);
            }
            if (!is_ghost) {
                add_crossing(search, looks, base, i, j);
            }
        }
    }
}

static void cross_sensors(struct rho_passive_search *search, unsigned a, unsigned b)
{
    struct rho_crossing_base base;
    if (rho_crossing_set_base(&base, search->x_m[a], search->y_m[a], search->x_m[b],
                              search->y_m[b]) != RHO_OK) {
        return; /* places were checked when they came */
    }
    for (unsigned scan = 0; scan < search->passive->batch.num_scans; scan++) {
        struct looks looks = {.scan = scan, .a = a, .b = b};
        looks.num_a = gather(search, scan, a, looks.bearings_a_rad, looks.which_a);
        looks.num_b = gather(search, scan, b, looks.bearings_b_rad, looks.which_b);
        cross_looks(search, &looks, &base);
    }
}

void rho_passive_cross(struct rho_passive_search *search)
{
    search->passive->num_points = 0;
    memset(search->passive->fitted, 0, sizeof search->passive->fitted);
    for (unsigned a = 0; a + 1u < search->passive->batch.num_sensors; a++) {
        for (unsigned b = a + 1u; b < search->passive->batch.num_sensors; b++) {
            cross_sensors(search, a, b);
        }
    }
}

/* ---- votes ------------------------------------------------------------------------------------ */

/* Standard deviation of a crossing's rho in a row of theta. */
static float spread_m(const struct rho_passive_point *point, float cosine, float sine)
{
    return rho_sqrt(point->xx_m2 * cosine * cosine + 2.0f * point->xy_m2 * cosine * sine +
                    point->yy_m2 * sine * sine);
}

static int clip(float cell, int last)
{
    return cell > 0.0f ? (cell < (float)last ? (int)cell : last) : 0;
}

static void vote(struct rho_passive_search *search, const struct rho_passive_point *point,
                 unsigned row)
{
    float cell_m = search->passive->config.rho_cell_m;
    int last = search->rho_cells - 1;
    float rho_m = point->x_m * search->cosine[row] + point->y_m * search->sine[row];
    float middle = rho_m / cell_m + 0.5f * (float)search->rho_cells;
    float reach = SPREAD_SIGMAS * spread_m(point, search->cosine[row], search->sine[row]) / cell_m;
    reach = reach < (float)SPREAD_CELLS_MAX ? reach : (float)SPREAD_CELLS_MAX;
    for (int i = clip(middle - reach, last); i <= clip(middle + reach, last); i++) {
        uint16_t *cell = &search->passive->cells[row][i];
        *cell = (uint16_t)(*cell | 1u << point->scan);
    }
}

static unsigned most_of_row(const struct rho_passive_search *search, unsigned row)
{
    unsigned most = 0;
    for (unsigned column = 0; column < search->rho_cells; column++) {
        unsigned votes = rho_count_bits(search->passive->cells[row][column]);
        most = votes > most ? votes : most;
    }
    return most;
}

void rho_passive_vote(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    memset(passive->cells, 0, sizeof passive->cells);
    for (uint32_t i = 0; i < passive->num_points; i++) {
        for (unsigned row = 0; row < search->theta_cells; row++) {
            vote(search, &passive->points[i], row);
        }
    }
    for (unsigned row = 0; row < search->theta_cells; row++) {
        search->row_votes[row] = (uint8_t)most_of_row(search, row);
    }
}

/* ---- lines ------------------------------------------------------------------------------------ */

struct cell {
    int row, column;
};

/* The first cell with the most votes. */
static unsigned find_most(const struct rho_passive_search *search, struct cell *at)
{
    unsigned most = 0;
    int row = 0, column = 0;
    for (int i = 0; i < search->theta_cells; i++) {
        if (search->row_votes[i] > most) {
            most = search->row_votes[i];
            row = i;
        }
    }
    while (rho_count_bits(search->passive->cells[row][column]) != most) {
        column++;
    }
    *at = (struct cell){row, column};
    return most;
}

static int is_as_high(const struct rho_passive_search *search, int row, int column, unsigned votes)
{
    return row >= 0 && row < search->theta_cells && column >= 0 && column < search->rho_cells &&
           rho_count_bits(search->passive->cells[row][column]) == votes;
}

/* Votes that spread make plateaus: the line is in the middle of its own. */
static struct cell middle_of(const struct rho_passive_search *search, struct cell from,
                             unsigned votes)
{
    int reach = 2 * NEAR_CELLS, sum_row = 0, sum_column = 0, count = 0;
    for (int row = from.row - reach; row <= from.row + reach; row++) {
        for (int column = from.column - reach; column <= from.column + reach; column++) {
            if (is_as_high(search, row, column, votes)) {
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
            if (is_as_high(search, row, column, votes) && off < least) {
                least = off;
                best = (struct cell){row, column};
            }
        }
    }
    return best;
}

/* Also round the end of theta, where rho changes its sign. */
static void take_off(struct rho_passive_search *search, struct cell at)
{
    for (int i = at.row - NEAR_CELLS; i <= at.row + NEAR_CELLS; i++) {
        int is_turned = i < 0 || i >= search->theta_cells;
        int row = i < 0 ? i + search->theta_cells : is_turned ? i - search->theta_cells : i;
        int middle = is_turned ? search->rho_cells - 1 - at.column : at.column;
        for (int column = middle - NEAR_CELLS; column <= middle + NEAR_CELLS; column++) {
            if (column >= 0 && column < search->rho_cells) {
                search->passive->cells[row][column] = 0;
            }
        }
        search->row_votes[row] = (uint8_t)most_of_row(search, (unsigned)row);
    }
}

int rho_passive_next_line(struct rho_passive_search *search, unsigned votes_min,
                          struct rho_passive_line *line)
{
    struct cell at = {0, 0};
    unsigned votes = find_most(search, &at);
    if (votes < votes_min || votes == 0) {
        return 0;
    }
    at = middle_of(search, at, votes);
    take_off(search, at);
    *line = (struct rho_passive_line){
        .cosine = search->cosine[at.row],
        .sine = search->sine[at.row],
        .rho_m = ((float)at.column + 0.5f - 0.5f * (float)search->rho_cells) *
                 search->passive->config.rho_cell_m};
    return 1;
}

/* ---- hypotheses ------------------------------------------------------------------------------- */

/* Two crossings' places in points, a's scan before b's. */
struct pair {
    uint16_t a, b;
};

/* The best so far, best first. */
struct best {
    unsigned count;
    float agreement[FITS_PER_LINE];
    struct pair pair[FITS_PER_LINE];
};

/* Those that agree no better are not among the best. */
static float least_agreement(const struct best *best)
{
    return best->count < FITS_PER_LINE ? -1.0f : best->agreement[FITS_PER_LINE - 1u];
}

static void keep_best(struct best *best, float agreement, struct pair pair)
{
    if (!(agreement > least_agreement(best))) {
        return;
    }
    unsigned place = best->count < FITS_PER_LINE ? best->count++ : FITS_PER_LINE - 1u;
    for (; place > 0 && agreement > best->agreement[place - 1u]; place--) {
        best->agreement[place] = best->agreement[place - 1u];
        best->pair[place] = best->pair[place - 1u];
    }
    best->agreement[place] = agreement;
    best->pair[place] = pair;
}

static unsigned gather_points(const struct rho_passive_search *search,
                              const struct rho_passive_line *line, uint16_t *which)
{
    const struct rho_passive *passive = search->passive;
    float least_m = LINE_CELLS * passive->config.rho_cell_m;
    unsigned count = 0;
    for (uint32_t i = 0; i < passive->num_points; i++) {
        const struct rho_passive_point *point = &passive->points[i];
        float off_m = point->x_m * line->cosine + point->y_m * line->sine - line->rho_m;
        float reach_m = SPREAD_SIGMAS * spread_m(point, line->cosine, line->sine);
        reach_m = reach_m > least_m ? reach_m : least_m;
        if (!(off_m < reach_m && -off_m < reach_m)) {
            continue;
        }
        if (count < LINE_POINTS_MAX) {
            which[count++] = (uint16_t)i;
        } else {
            search->passive->work.line_points_dropped =
                rho_count(search->passive->work.line_points_dropped, 1);
        }
    }
    return count;
}

/* The constant velocity through two crossings, where a target can have it. */
static int join(const struct rho_passive_search *search, struct pair pair,
                float state_m[RHO_PASSIVE_STATES])
{
    const struct rho_passive_point *a = &search->passive->points[pair.a];
    const struct rho_passive_point *b = &search->passive->points[pair.b];
    float steps = search->step[b->scan] - search->step[a->scan], span_s = steps * search->half_s;
    float dx_m = b->x_m - a->x_m, dy_m = b->y_m - a->y_m;
    float most_m = (search->passive->config.v_max_mps + SPEED_SLACK_MPS) * span_s;
    float way2_m2 = dx_m * dx_m + dy_m * dy_m;
    if (way2_m2 > most_m * most_m) { /* most need no root to be told */
        most_m += rho_sqrt(uncertainty_m2(a) + uncertainty_m2(b));
        if (way2_m2 > most_m * most_m) {
            return 0;
        }
    }
    state_m[2] = dx_m / steps;
    state_m[3] = dy_m / steps;
    state_m[0] = a->x_m - search->step[a->scan] * state_m[2];
    state_m[1] = a->y_m - search->step[a->scan] * state_m[3];
    return 1;
}

static void try_pairs(struct rho_passive_search *search, const uint16_t *which, unsigned count,
                      struct best *best)
{
    struct rho_passive *passive = search->passive;
    for (unsigned i = 0; i < count; i++) {
        unsigned scan_min = passive->points[which[i]].scan + PAIR_SCANS_MIN;
        for (unsigned j = 0; j < count; j++) {
            struct pair pair = {which[i], which[j]};
            float state_m[RHO_PASSIVE_STATES];
            if (passive->points[pair.b].scan >= scan_min && join(search, pair, state_m)) {
                keep_best(best, rho_passive_agreement(search, state_m, least_agreement(best)),
                          pair);
                passive->work.hypotheses = rho_count(passive->work.hypotheses, 1);
            }
        }
    }
}

static struct rho_passive_fitted *fitted_place(struct rho_passive *passive, struct pair pair)
{
    return &passive->fitted[(pair.a * 61u + pair.b) % RHO_PASSIVE_PAIRS];
}

/*
 * Lines side by side share their pairs. What was no track is none again; and what was a track is a candidate's twin
 * again, unless a candidate was taken away since.
 */
static int is_known(const struct rho_passive_search *search, struct pair pair)
{
    const struct rho_passive_fitted *fitted = fitted_place(search->passive, pair);
    return fitted->a == pair.a && fitted->b == pair.b &&
           (fitted->when == UINT16_MAX || fitted->when == search->candidates_taken);
}

static void fit_pair(struct rho_passive_search *search, struct pair pair)
{
    float state_m[RHO_PASSIVE_STATES];
    if (is_known(search, pair) || !join(search, pair, state_m)) {
        return;
    }
    rho_passive_fit(search, state_m, 0);
    int is_track = rho_passive_offer(search, state_m);
    *fitted_place(search->passive, pair) = (struct rho_passive_fitted){
        .a = pair.a, .b = pair.b, .when = is_track ? search->candidates_taken : UINT16_MAX};
}

void rho_passive_propose(struct rho_passive_search *search, const struct rho_passive_line *line)
{
    uint16_t which[LINE_POINTS_MAX];
    struct best best = {.count = 0};
    try_pairs(search, which, gather_points(search, line, which), &best);
    for (unsigned i = 0; i < best.count; i++) {
        fit_pair(search, best.pair[i]);
    }
}
