/* SPDX-License-Identifier: MIT */
/* Lines of crossings by the paper's method, cell by cell as in dense planes in double precision; its figures. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "paper_scene.h"
#include "rhotrack/crossing.h"

static struct rho_passive_paper paper;
static struct scene scene;

/* ---- the reference: crossings ----------------------------------------------------------------- */

#define CROSSINGS_MAX (SCENE_SCANS * LOOK_MAX * LOOK_MAX)
#define PAIRS_MAX 6
#define ROWS_MAX 90
#define COLUMNS 256

/* A place, and how far float32 may have it from there. */
struct crossing {
    double x_m, y_m, slack_m;
    unsigned scan;
};

static struct crossing crossings[CROSSINGS_MAX];
static unsigned num_crossings;
static int is_doubtful; /* something is at its limit, and float32 may see it on the other side */

/* Ray from a along bearing a meets the ray from b: the two linear equations solved. */
static int meet(unsigned a, unsigned b, double bearing_a_rad, double bearing_b_rad,
                double range_max_m, struct crossing *at)
{
    double ax = (float)scene.sensor_x_m[a], ay = (float)scene.sensor_y_m[a];
    double bx = (float)scene.sensor_x_m[b], by = (float)scene.sensor_y_m[b];
    double ca = cos(bearing_a_rad), sa = sin(bearing_a_rad);
    double cb = cos(bearing_b_rad), sb = sin(bearing_b_rad);
    double determinant = ca * sb - sa * cb; /* sine of the angle between them */
    double range_a_m = ((bx - ax) * sb - (by - ay) * cb) / determinant;
    double range_b_m = ((bx - ax) * sa - (by - ay) * ca) / determinant;
    double least_m = fmin(range_a_m, range_b_m), most_m = fmax(range_a_m, range_b_m);
    double unsure = 4e-7 / (determinant * determinant); /* of 1 m: the angle's last digits */
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

static unsigned count_row(const struct kept *kept, unsigned row, unsigned *only)
{
    unsigned count = 0;
    for (unsigned j = 0; j < kept->columns; j++) {
        count += (unsigned)kept->is_left[row][j];
        *only = kept->is_left[row][j] ? j : *only;
    }
    return count;
}

static struct kept turned(const struct kept *kept)
{
    struct kept other = {.rows = kept->columns, .columns = kept->rows};
    for (unsigned i = 0; i < kept->rows; i++) {
        for (unsigned j = 0; j < kept->columns; j++) {
            other.is_left[j][i] = kept->is_left[i][j];
        }
    }
    return other;
}

/* Steps 2 to 2.4 of the paper, and 2.5 with the matrix turned. A row's only crossing stays its only one, so that there
 * is no need to remember which rows are done. */
static void prune_rows(struct kept *kept)
{
    for (int is_changed = 1; is_changed;) {
        is_changed = 0;
        for (unsigned row = 0, only = 0; row < kept->rows; row++) {
            if (count_row(kept, row, &only) != 1) {
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

static void prune(struct kept *kept)
{
    prune_rows(kept);
    struct kept other = turned(kept);
    prune_rows(&other);
    *kept = turned(&other);
}

static void cross_scan(unsigned a, unsigned b, unsigned k,
                       const struct rho_passive_paper_config *config)
{
    static struct crossing found[LOOK_MAX][LOOK_MAX];
    const struct look *look_a = &scene.look[k][a], *look_b = &scene.look[k][b];
    struct kept kept = {.rows = look_a->count, .columns = look_b->count};
    for (unsigned i = 0; i < kept.rows; i++) {
        for (unsigned j = 0; j < kept.columns; j++) {
            kept.is_left[i][j] = meet(a, b, (double)look_a->bearings[i].bearing_rad,
                                      (double)look_b->bearings[j].bearing_rad,
                                      (double)config->range_max_m, &found[i][j]);
        }
    }
    if (config->rule == RHO_GHOST_LITERAL) {
        prune(&kept);
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

/* ---- the reference: planes -------------------------------------------------------------------- */

/* Votes of a pair, without crossings that are near a cell's border, and with them on both sides. */
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

static double theta_of(int row)
{
    return (row + 0.5) * PI / rows;
}

/* Columns of the cells where a crossing may be. */
static void columns_of(const struct crossing *crossing, int row, double cell_m, int *first,
                       int *last)
{
    double rho_m = (crossing->x_m - middle_x_m) * cos(theta_of(row)) +
                   (crossing->y_m - middle_y_m) * sin(theta_of(row));
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
            columns_of(&crossings[i], row, cell_m, &first, &last);
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

static unsigned count_of(const struct votes *votes, enum rho_accumulator_votes what)
{
    unsigned count = 0;
    for (uint32_t mask = votes->mask; mask; mask &= mask - 1) {
        count++;
    }
    return what == RHO_VOTES_POINTS ? votes->points : count;
}

/* (rho, theta) and (-rho, theta +- pi) are one line. */
static const struct votes *cell_of(const struct plane *plane, int is_sure, int row, int column)
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

static unsigned most_around(const struct plane *plane, int is_sure, int row, int column,
                            enum rho_accumulator_votes what)
{
    unsigned most = 0;
    int near = num_pairs > 1;
    for (int i = -near; i <= near; i++) {
        for (int j = -near; j <= near; j++) {
            unsigned votes = count_of(cell_of(plane, is_sure, row + i, column + j), what);
            most = votes > most ? votes : most;
        }
    }
    return most;
}

/* 0 where not every pair confirms the place, else 1 and the votes of all pairs in it. */
static int height_of(int is_sure, int row, int column, unsigned votes_min,
                     enum rho_accumulator_votes what)
{
    unsigned sum = 1;
    for (unsigned i = 0; i < num_pairs; i++) {
        if (most_around(&planes[i], is_sure, row, column, what) < votes_min) {
            return 0;
        }
        sum += count_of(cell_of(&planes[i], is_sure, row, column), what);
    }
    return (int)sum;
}

static int heights[ROWS_MAX][COLUMNS];
static unsigned num_confirmed;

/* False where float32 may see other heights. */
static int fill_heights(const struct rho_passive_paper_config *config, unsigned votes_min)
{
    int is_sure = 1;
    num_confirmed = 0;
    for (int row = 0; row < rows; row++) {
        for (int column = 0; column < COLUMNS; column++) {
            int most = height_of(0, row, column, votes_min, config->votes);
            heights[row][column] =
                most > 0 ? height_of(1, row, column, votes_min, config->votes) : 0;
            is_sure = is_sure && heights[row][column] == most;
            num_confirmed += heights[row][column] > 0;
        }
    }
    return is_sure && !is_doubtful;
}

/* ---- the reference: lines --------------------------------------------------------------------- */

struct place {
    int row, column;
};

/* The cell that far from another, also round the ends of theta; NULL beyond the ends of rho. */
static int *height_near(struct place from, int i, int j, struct place *at)
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

static struct place highest(void)
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
            const int *near = height_near(from, i, j, &at);
            int is_part = near && *near == height;
            sum_i += is_part * i;
            sum_j += is_part * j;
            count += is_part;
        }
    }
    for (int i = -8; i <= 8; i++) {
        for (int j = -6; j <= 6; j++) {
            const int *near = height_near(from, i, j, &at);
            double off = pow(i - sum_i / count, 2.0) + pow(j - sum_j / count, 2.0);
            if (near && *near == height && off < least - 1e-9) {
                least = off;
                best = at;
            }
        }
    }
    return best;
}

/* The next line; its height in *height, 0 where there is none. Its neighbours are gone. */
static struct place next_line(int *height)
{
    struct place at, line = highest();
    *height = heights[line.row][line.column];
    if (*height == 0) {
        return line;
    }
    line = middle_of_plateau(line);
    for (int i = -4; i <= 4; i++) {
        for (int j = -3; j <= 3; j++) {
            int *near = height_near(line, i, j, &at);
            if (near) {
                *near = 0;
            }
        }
    }
    return line;
}

static void expect_line(const struct rho_passive_paper_line *line, struct place at, int height,
                        const struct rho_passive_paper_config *config)
{
    double theta_rad = theta_of(at.row);
    double rho_m = (at.column + 0.5 - COLUMNS / 2) * (double)config->rho_cell_m +
                   middle_x_m * cos(theta_rad) + middle_y_m * sin(theta_rad);
    unsigned least = UINT32_MAX;
    for (unsigned i = 0; i < num_pairs; i++) {
        unsigned votes = most_around(&planes[i], 1, at.row, at.column, config->votes);
        least = votes < least ? votes : least;
    }
    assert_float_equal(line->theta_rad, theta_rad, 1e-5);
    assert_float_equal(line->rho_m, rho_m, 1.0);
    assert_int_equal(line->votes_sum, height - 1);
    assert_int_equal(line->votes, least);
}

/* ---- the reference: states -------------------------------------------------------------------- */

/* Of the crossings that voted for a line; times from the newest scan. */
struct sums {
    uint32_t mask;
    double count, t, tt, x, y, tx, ty;
};

/* The pair's cell with the most votes there, the line's own before those beside it. False where float32 may see others. */
static int find_voted(const struct plane *plane, struct place at, enum rho_accumulator_votes what,
                      struct place *best)
{
    int near = num_pairs > 1, is_sure = 1;
    unsigned most = count_of(cell_of(plane, 1, at.row, at.column), what);
    *best = at;
    for (int row = at.row - near; row <= at.row + near; row++) {
        for (int column = at.column - near; column <= at.column + near; column++) {
            const struct votes *votes = cell_of(plane, 1, row, column);
            is_sure = is_sure && votes->points == cell_of(plane, 0, row, column)->points;
            if (count_of(votes, what) > most) {
                most = count_of(votes, what);
                *best = (struct place){row, column};
            }
        }
    }
    return is_sure;
}

static void add_crossings(struct sums *sums, struct place at, double cell_m)
{
    for (unsigned i = 0; i < num_crossings; i++) {
        int first, last;
        double t_s = scene.time_s[crossings[i].scan] - scene.time_s[scene.scans - 1];
        columns_of(&crossings[i], at.row, cell_m, &first, &last);
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

static int gather(struct place at, const struct rho_passive_paper_config *config, struct sums *sums)
{
    int is_sure = 1;
    unsigned pair = 0;
    for (unsigned a = 0; a + 1 < scene.sensors; a++) {
        for (unsigned b = a + 1; b < scene.sensors; b++) {
            struct place best;
            is_sure = find_voted(&planes[pair++], at, config->votes, &best) && is_sure;
            cross_pair(a, b, config);
            add_crossings(sums, best, (double)config->rho_cell_m);
        }
    }
    return is_sure;
}

static void expect_state(const struct rho_passive_paper_line *line, struct place at,
                         const struct rho_passive_paper_config *config)
{
    struct sums sums = {0};
    if (!gather(at, config, &sums)) {
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

/* ---- the same lines --------------------------------------------------------------------------- */

struct agreement {
    unsigned scenes, sure, lines;
};

static void expect_lines(const struct rho_passive_paper_config *config, struct agreement *agreement)
{
    assert_int_equal(search_by_paper(&paper, config, &scene), RHO_OK);
    assert_true(are_lines_sound(&paper));
    fill_planes(config);
    agreement->scenes++;
    if (!fill_heights(config, paper.votes_min)) {
        return;
    }
    agreement->sure++;
    assert_int_equal(paper.work.cells, num_confirmed);
    unsigned count = 0;
    int height;
    for (struct place at = next_line(&height); height > 0; at = next_line(&height)) {
        if (count < RHO_MAX_PASSIVE_LINES) {
            assert_true(count < paper.num_lines);
            expect_line(&paper.lines[count], at, height, config);
            expect_state(&paper.lines[count], at, config);
        }
        count++;
    }
    assert_int_equal(paper.num_lines + paper.work.lines_dropped, count);
    agreement->lines += paper.num_lines;
}

/* Scenes turned and shifted anyhow: lines in every direction, and cells in every row. */
static struct agreement agreement_of(const struct scene *from,
                                     const struct rho_passive_paper_config *config, unsigned runs)
{
    struct agreement agreement = {0};
    for (unsigned run = 0; run < runs; run++) {
        scene = *from;
        draw_scene(&scene);
        double turn_rad = uniform(-PI, PI), x_m = uniform(-3e5, 3e5), y_m = uniform(-3e5, 3e5);
        move_scene(&scene, turn_rad, x_m, y_m);
        expect_lines(config, &agreement);
    }
    print_message("%u sensors: %u lines in %u scenes of %u\n", from->sensors, agreement.lines,
                  agreement.sure, agreement.scenes);
    assert_true(5 * agreement.sure >= 2 * agreement.scenes);
    assert_true(agreement.lines >= agreement.sure / 2);
    return agreement;
}

static void two_sensors_lines_are_those_of_a_dense_plane(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 2, 0.1, 0.9, 0.5);
    struct rho_passive_paper_config config = paper_config();
    random_state = 1;
    config.votes_min = 5;
    agreement_of(&from, &config, 40);
    config.rule = RHO_GHOST_NO_RULE;
    agreement_of(&from, &config, 40);
    from.targets = 3;
    from.pd = 1.0;
    config.votes_min = 0;
    agreement_of(&from, &config, 40);
}

static void three_sensors_lines_are_those_of_three_dense_planes(void **state)
{
    (void)state;
    struct scene from = scene_of(3, 3, 0.1, 0.9, 0.5);
    struct rho_passive_paper_config config = paper_config();
    random_state = 2;
    config.votes_min = 5;
    agreement_of(&from, &config, 50);
    config.rule = RHO_GHOST_NO_RULE;
    agreement_of(&from, &config, 50);
    from.jitter_s = 7.0;
    config.votes_min = 4;
    agreement_of(&from, &config, 30);
}

static void other_cells_and_ranges_have_their_own_planes(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 2, 0.1, 1.0, 0.0);
    struct rho_passive_paper_config config = paper_config();
    random_state = 3;
    config.rho_cell_m = 1500.0f;
    config.theta_cell_rad = (float)(PI / 40.0);
    config.range_max_m = 60000.0f;
    agreement_of(&from, &config, 40);
    config.theta_cell_rad = 0.3f; /* 10 rows: fewer than a plateau's reach to both sides */
    agreement_of(&from, &config, 10);
}

static void crossings_can_count_instead_of_scans(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 3, 0.1, 0.9, 0.5);
    struct rho_passive_paper_config config = paper_config();
    random_state = 4;
    config.votes_min = 6;
    config.votes = RHO_VOTES_POINTS;
    config.rule = RHO_GHOST_NO_RULE;
    agreement_of(&from, &config, 40);
}

/* ---- eq. (3) ---------------------------------------------------------------------------------- */

/* Two of the sensors of scene_of see a place within 80 km; true where float32 can tell its range. */
static int draw_crossing(struct rho_crossing_base *base, float bearing_rad[2],
                         struct rho_crossing *crossing)
{
    double x_m = uniform(-80e3, 80e3), y_m = uniform(-80e3, 80e3);
    unsigned a = (unsigned)uniform(0.0, 3.0), b = (unsigned)uniform(a + 1.0, 4.0);
    assert_int_equal(rho_crossing_set_base(base, (float)scene.sensor_x_m[a],
                                           (float)scene.sensor_y_m[a], (float)scene.sensor_x_m[b],
                                           (float)scene.sensor_y_m[b]),
                     RHO_OK);
    bearing_rad[0] = (float)atan2(y_m - (double)base->y_a_m, x_m - (double)base->x_a_m);
    bearing_rad[1] = (float)atan2(y_m - (double)base->y_b_m, x_m - (double)base->x_b_m);
    return hypot(x_m, y_m) <= 80e3 &&
           rho_crossing_find(base, bearing_rad[0], bearing_rad[1], 100e3f, crossing) ==
               RHO_CROSSING_MEETS &&
           crossing->delta_rad >= 0.02f;
}

/* Where the float32 bearings meet, in double precision. */
static void place_of(const struct rho_crossing_base *base, const float bearing_rad[2], double *x_m,
                     double *y_m)
{
    double ca = cos((double)bearing_rad[0]), sa = sin((double)bearing_rad[0]);
    double cb = cos((double)bearing_rad[1]), sb = sin((double)bearing_rad[1]);
    double dx_m = (double)base->x_b_m - (double)base->x_a_m;
    double dy_m = (double)base->y_b_m - (double)base->y_a_m;
    double range_m = (dx_m * sb - dy_m * cb) / (ca * sb - sa * cb);
    *x_m = (double)base->x_a_m + range_m * ca;
    *y_m = (double)base->y_a_m + range_m * sa;
}

static void rho_is_the_same_from_either_sensor(void **state)
{
    (void)state;
    unsigned count = 0;
    double worst_m = 0.0, worst_true_m = 0.0;
    random_state = 5;
    scene = scene_of(4, 0, 0.1, 1.0, 0.0);
    while (count < 100000) {
        struct rho_crossing_base base;
        struct rho_crossing crossing;
        float bearing_rad[2];
        double x_m, y_m;
        if (!draw_crossing(&base, bearing_rad, &crossing)) {
            continue;
        }
        float theta_rad = (float)uniform(0.0, PI);
        float from_a_m = rho_passive_paper_rho_m(crossing.range_a_m, bearing_rad[0], base.x_a_m,
                                                 base.y_a_m, theta_rad);
        float from_b_m = rho_passive_paper_rho_m(crossing.range_b_m, bearing_rad[1], base.x_b_m,
                                                 base.y_b_m, theta_rad);
        place_of(&base, bearing_rad, &x_m, &y_m);
        double rho_m = x_m * cos((double)theta_rad) + y_m * sin((double)theta_rad);
        worst_m = fmax(worst_m, fabs((double)from_a_m - (double)from_b_m));
        worst_true_m = fmax(worst_true_m,
                            fmax(fabs((double)from_a_m - rho_m), fabs((double)from_b_m - rho_m)));
        count++;
    }
    print_message("rho from two sensors differs by %.3f m at most, from the truth by %.3f m\n",
                  worst_m, worst_true_m);
    assert_true(worst_m < 1.0 && worst_true_m < 1.0);
}

static void rho_of_known_places(void **state)
{
    (void)state;
    const float pi = (float)PI;
    assert_float_equal(rho_passive_paper_rho_m(5000.0f, 0.5f, 0.0f, 0.0f, 0.5f), 5000.0, 1e-2);
    assert_float_equal(rho_passive_paper_rho_m(5000.0f, -0.5f * pi, 0.0f, 10e3f, 0.5f * pi), 5000.0,
                       1e-2);
    assert_float_equal(rho_passive_paper_rho_m(5000.0f, pi, 10e3f, 7.0f, 0.0f), 5000.0, 1e-2);
    assert_float_equal(rho_passive_paper_rho_m(5000.0f, 0.0f, 10e3f, 20e3f, 0.25f * pi),
                       35000.0 / sqrt(2.0), 2e-2);
}

/* ---- scenes by hand --------------------------------------------------------------------------- */

/* Seen without noise by all sensors. */
static void set_scene(unsigned sensors, unsigned targets, const struct target *target)
{
    scene = scene_of(sensors, targets, 1e-6, 1.0, 0.0);
    scene.sigma_from_rad = scene.sigma_to_rad = RHO_LIMIT_SIGMA_RAD_MIN;
    set_scan_times(&scene);
    memcpy(scene.target, target, targets * sizeof *target);
    see_all(&scene);
}

static void search_with(enum rho_ghost_rule rule, unsigned votes_min)
{
    struct rho_passive_paper_config config = paper_config();
    config.rule = rule;
    config.votes_min = (uint16_t)votes_min;
    assert_int_equal(search_by_paper(&paper, &config, &scene), RHO_OK);
    assert_true(are_lines_sound(&paper));
}

static unsigned count_near(const struct target *target)
{
    unsigned count = 0;
    for (unsigned i = 0; i < paper.num_lines; i++) {
        count += (unsigned)is_near_path(&paper.lines[i], target);
    }
    return count;
}

/* Seen by so many sensors on its way along the middle of a cell: all its crossings vote there. */
static struct target set_scene_of_cell(unsigned sensors, double theta_deg, double rho_m)
{
    double c = cos(theta_deg * DEG_RAD), s = sin(theta_deg * DEG_RAD);
    double x_m = sensors == 3 ? 10e3 / 3.0 : 0.0; /* the sensors' middle */
    const struct target target = {x_m + rho_m * c + 40e3 * s, rho_m * s - 40e3 * c, -300.0 * s,
                                  300.0 * c};
    set_scene(sensors, 1, &target);
    return target;
}

static void a_target_is_one_line_and_its_crossings_give_its_state(void **state)
{
    (void)state;
    for (unsigned sensors = 2; sensors <= 3; sensors++) {
        struct target target = set_scene_of_cell(sensors, 67.0, 14.5e3);
        search_with(RHO_GHOST_LITERAL, 0);
        const struct rho_passive_paper_line *line = &paper.lines[0];
        assert_int_equal(paper.num_lines, 1);
        assert_float_equal(line->theta_rad, 67.0 * DEG_RAD, 1e-6);
        assert_float_equal(line->rho_m,
                           14.5e3 + (sensors == 3 ? 10e3 / 3.0 * cos(67.0 * DEG_RAD) : 0.0), 0.1);
        assert_int_equal(line->votes, 8);
        assert_int_equal(line->votes_sum, sensors == 2 ? 8 : 24);
        assert_int_equal(line->scans, 0xff);
        assert_int_equal(line->crossings, sensors == 2 ? 8 : 24);
        assert_true(line->has_state);
        assert_float_equal(line->x_m, target_x_m(&target, 70.0), 2.0);
        assert_float_equal(line->y_m, target_y_m(&target, 70.0), 2.0);
        assert_float_equal(line->vx_mps, target.vx_mps, 0.1);
        assert_float_equal(line->vy_mps, target.vy_mps, 0.1);
    }
}

/* Flown along y: theta is 0, or pi; the cells at both ends are one line's. */
static void a_line_at_the_end_of_theta_is_found_once(void **state)
{
    (void)state;
    for (int i = 0; i < 40; i++) {
        const struct target target = {37.1e3 + 113.0 * i, 9e3, 20.0 - i, 250.0};
        set_scene(2, 1, &target);
        search_with(RHO_GHOST_LITERAL, 6);
        assert_int_equal(paper.num_lines, 1);
        assert_int_equal(count_near(&target), 1);
        assert_in_range(paper.lines[0].votes, 7, 8);
    }
}

/* Targets in each other's mirror image: the sensors at (0, +-10 km), mirrored too, see a ghost on the x axis, straight
 * all the way. A third sensor there, with each of them, sees other ghosts. */
static void a_ghost_that_one_pair_confirms_is_not_a_line_of_three_sensors(void **state)
{
    (void)state;
    const struct target targets[2] = {{52e3, 6e3, -280.0, -20.0}, {52e3, -6e3, -280.0, 20.0}};
    const struct target ghost = {40e3, 0.0, -1.0, 0.0};
    for (unsigned sensors = 2; sensors <= 3; sensors++) {
        set_scene(sensors, 2, targets);
        search_with(RHO_GHOST_NO_RULE, 7);
        assert_true(count_near(&targets[0]) > 0);
        assert_true(count_near(&targets[1]) > 0);
        assert_int_equal(count_near(&ghost) > 0, sensors == 2);
    }
}

static void a_line_needs_the_votes_of_every_pair(void **state)
{
    (void)state;
    set_scene_of_cell(3, 67.0, 14.5e3);
    scene.look[2][1].count = scene.look[5][1].count = 0; /* pairs of sensor 1: 6 scans */
    search_with(RHO_GHOST_LITERAL, 6);
    assert_int_equal(paper.num_lines, 1);
    assert_int_equal(paper.lines[0].votes, 6);
    assert_int_equal(paper.lines[0].votes_sum, 6 + 6 + 8);
    assert_int_equal(paper.lines[0].crossings, 6 + 6 + 8);
    search_with(RHO_GHOST_LITERAL, 7);
    assert_int_equal(paper.num_lines, 0);
    assert_int_equal(paper.work.cells, 0);
}

static void four_fifths_of_the_scans_are_enough_unless_told_otherwise(void **state)
{
    (void)state;
    const unsigned votes_min[5] = {4, 4, 5, 6, 7};
    for (unsigned scans = 4; scans <= 8; scans++) {
        set_scene_of_cell(2, 67.0, 14.5e3);
        scene.scans = scans;
        search_with(RHO_GHOST_LITERAL, 0);
        assert_int_equal(paper.votes_min, votes_min[scans - 4]);
        assert_int_equal(paper.num_lines, 1);
        for (unsigned k = 0; k < scans - votes_min[scans - 4]; k++) {
            scene.look[k][0].count = 0;
        }
        search_with(RHO_GHOST_LITERAL, 0);
        assert_int_equal(paper.num_lines, 1);
        assert_int_equal(paper.lines[0].votes, votes_min[scans - 4]);
        scene.look[scans - 1][1].count = 0;
        search_with(RHO_GHOST_LITERAL, 0);
        assert_int_equal(paper.num_lines, 0);
    }
}

static void the_rule_decides_which_crossings_vote(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 2, 0.1, 1.0, 0.0);
    unsigned ghosts[3];
    random_state = 6;
    scene = from;
    draw_scene(&scene);
    for (int rule = RHO_GHOST_NO_RULE; rule <= RHO_GHOST_SAFE; rule++) {
        search_with((enum rho_ghost_rule)rule, 0);
        ghosts[rule] = paper.work.ghosts;
        assert_int_equal(paper.work.crossings, 32);
        assert_int_equal(paper.work.votes, 90 * (32 - paper.work.ghosts));
    }
    assert_true(ghosts[RHO_GHOST_NO_RULE] < ghosts[RHO_GHOST_LITERAL]);
    assert_int_equal(ghosts[RHO_GHOST_LITERAL], 16);
    assert_int_equal(ghosts[RHO_GHOST_SAFE], 16);
}

/* ---- figures ---------------------------------------------------------------------------------- */

/* What many runs gave: share of targets with a line near their path, and other lines a run. */
struct figures {
    unsigned sensors, targets;
    double sigma_deg, pd, false_bearings;
    unsigned votes_min;
    enum rho_ghost_rule rule;
    double found, ghosts;
};

static void expect_figures(const struct figures *expected, unsigned runs)
{
    struct scene from = scene_of(expected->sensors, expected->targets, expected->sigma_deg,
                                 expected->pd, expected->false_bearings);
    double found = 0.0, ghosts = 0.0, ghosts2 = 0.0;
    for (unsigned run = 0; run < runs; run++) {
        scene = from;
        draw_scene(&scene);
        search_with(expected->rule, expected->votes_min);
        unsigned others = paper.num_lines;
        for (unsigned i = 0; i < paper.num_lines; i++) {
            int is_any = 0;
            for (unsigned target = 0; target < scene.targets; target++) {
                is_any |= is_near_path(&paper.lines[i], &scene.target[target]);
            }
            others -= (unsigned)is_any;
        }
        for (unsigned target = 0; target < scene.targets; target++) {
            found += count_near(&scene.target[target]) > 0;
        }
        ghosts += others;
        ghosts2 += others * (double)others;
    }
    double n = (double)runs * expected->targets;
    double mean = ghosts / runs, deviation = sqrt(ghosts2 / runs - mean * mean);
    print_message("%u sensors, %u targets, %.2f deg, T %u, rule %d: found %.3f (%.3f), ghosts a "
                  "run %.2f (%.2f)\n",
                  expected->sensors, expected->targets, expected->sigma_deg, expected->votes_min,
                  expected->rule, found / n, expected->found, mean, expected->ghosts);
    assert_true(fabs(found / n - expected->found) <=
                4.0 * sqrt(expected->found * (1.0 - expected->found) / n));
    assert_true(fabs(mean - expected->ghosts) <= 4.0 * deviation / sqrt(runs));
}

/* Expected: 4000 runs. */
static void figures_are_those_of_many_runs(void **state)
{
    (void)state;
    static const struct figures figures[] = {
        {2, 2, 0.05, 1.0, 0.0, 7, RHO_GHOST_NO_RULE, 0.932, 2.46},
        {2, 2, 0.05, 1.0, 0.0, 7, RHO_GHOST_LITERAL, 0.940, 0.38},
        {2, 2, 0.1, 1.0, 0.0, 7, RHO_GHOST_NO_RULE, 0.844, 2.45},
        {2, 2, 0.1, 1.0, 0.0, 7, RHO_GHOST_LITERAL, 0.851, 0.37},
        {2, 2, 0.2, 1.0, 0.0, 6, RHO_GHOST_LITERAL, 0.798, 0.83},
        {2, 2, 0.5, 1.0, 0.0, 5, RHO_GHOST_LITERAL, 0.645, 1.86},
        {2, 2, 0.1, 0.9, 1.0, 5, RHO_GHOST_NO_RULE, 0.896, 5.90},
        {2, 2, 0.1, 0.9, 1.0, 5, RHO_GHOST_LITERAL, 0.717, 1.17},
        {2, 2, 0.1, 0.9, 1.0, 5, RHO_GHOST_SAFE, 0.897, 4.87},
        {3, 2, 0.1, 1.0, 0.0, 7, RHO_GHOST_NO_RULE, 0.355, 0.24},
        {3, 2, 0.1, 1.0, 0.0, 7, RHO_GHOST_LITERAL, 0.346, 0.06},
        {3, 4, 0.1, 0.9, 1.0, 5, RHO_GHOST_LITERAL, 0.407, 1.10},
    };
    random_state = 7;
    for (unsigned i = 0; i < sizeof figures / sizeof figures[0]; i++) {
        expect_figures(&figures[i], 200);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_sensors_lines_are_those_of_a_dense_plane),
        cmocka_unit_test(three_sensors_lines_are_those_of_three_dense_planes),
        cmocka_unit_test(other_cells_and_ranges_have_their_own_planes),
        cmocka_unit_test(crossings_can_count_instead_of_scans),
        cmocka_unit_test(rho_is_the_same_from_either_sensor),
        cmocka_unit_test(rho_of_known_places),
        cmocka_unit_test(a_target_is_one_line_and_its_crossings_give_its_state),
        cmocka_unit_test(a_line_at_the_end_of_theta_is_found_once),
        cmocka_unit_test(a_ghost_that_one_pair_confirms_is_not_a_line_of_three_sensors),
        cmocka_unit_test(a_line_needs_the_votes_of_every_pair),
        cmocka_unit_test(four_fifths_of_the_scans_are_enough_unless_told_otherwise),
        cmocka_unit_test(the_rule_decides_which_crossings_vote),
        cmocka_unit_test(figures_are_those_of_many_runs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
