/* SPDX-License-Identifier: MIT */
/* Cells and peaks from the votes of hough_reference.h, and their comparison with the library's. */
#ifndef RHOTRACK_TESTS_EXPECT_HOUGH_CELLS_AND_PEAKS_H
#define RHOTRACK_TESTS_EXPECT_HOUGH_CELLS_AND_PEAKS_H

#include "hough_reference.h"

#define CELLS_MAX 800000

static struct rho_hough hough;
static struct rho_hough_result result;
static struct rho_accumulator_peak peaks[CELLS_MAX];

static inline void prepare_hough(void)
{
    assert_int_equal(rho_hough_init(&hough, sizeof hough, &config), RHO_OK);
}

static inline void find_limited_peaks(uint32_t max_peaks)
{
    prepare_hough();
    memset(&result, 0x5a, sizeof result);
    assert_int_equal(rho_hough_find(&hough, &points, peaks, max_peaks, &result), RHO_OK);
}

static inline void find_peaks(void)
{
    find_limited_peaks(CELLS_MAX);
    assert_int_equal(result.cells_dropped, 0);
    assert_int_equal(result.votes_dropped, 0);
    assert_int_equal(result.kernels_dropped, 0);
}

/* Sets the paper's values for its first scene: 2000 x 3142 cells. */
static inline void use_paper_values(enum rho_hough_method method)
{
    rho_hough_config_default(&config, method);
    config.rho_max_m = 5000.0f;
}

/* Sets the paper's values, and lists every cell that has votes. */
static inline void use_paper_values_all_cells(enum rho_hough_method method)
{
    use_paper_values(method);
    config.tau = 0.0f;
    config.keeps_all_cells = 1;
}

static inline int by_rank(const void *a, const void *b)
{
    const struct rho_accumulator_peak *p = a, *q = b;
    if (p->votes != q->votes) {
        return p->votes < q->votes ? 1 : -1;
    }
    if (p->theta_cell != q->theta_cell) {
        return p->theta_cell < q->theta_cell ? -1 : 1;
    }
    return (p->rho_cell > q->rho_cell) - (p->rho_cell < q->rho_cell);
}

/* A vote for a cell. Of one source, a pair, plot or scan, a cell counts the largest vote only. */
struct vote {
    uint32_t key, source;
    struct vote_bounds bounds;
};

struct cell {
    uint32_t key, sources;
    struct vote_bounds bounds;
    double shown; /* the library's votes */
};

static struct vote *votes;
static size_t num_votes, votes_room;
static struct cell cells[CELLS_MAX];
static size_t num_cells;

static inline void vote(struct place place, uint32_t source, struct vote_bounds bounds)
{
    if (!is_in_plane(place) || bounds.most <= 0.0) {
        return;
    }
    if (num_votes == votes_room) {
        votes_room = votes_room ? 2 * votes_room : 1 << 16;
        votes = realloc(votes, votes_room * sizeof *votes);
    }
    votes[num_votes++] = (struct vote){sort_key_of_place(place), source, bounds};
}

static inline struct vote_bounds scaled_bounds(struct vote_bounds bounds, double by)
{
    return (struct vote_bounds){bounds.value * by, bounds.least * by, bounds.most * by};
}

/* Weight of a cell this many rows and columns from the pair's own, in reading C of the paper. */
static inline double weight_of_neighbour(long theta, long rho)
{
    struct line away = {(double)rho * (double)config.rho_cell_m,
                        (double)theta * (double)config.theta_cell_rad};
    return gaussian_of_offset(away);
}

/* Number of whole cells within 2 eps; a hundredth of a cell may be missing. */
static inline long neighbourhood_rows(void)
{
    return (long)(2.0 * (double)config.eps_theta_rad / (double)config.theta_cell_rad + 0.01);
}

static inline long neighbourhood_columns(void)
{
    return (long)(2.0 * (double)config.eps_rho_m / (double)config.rho_cell_m + 0.01);
}

static inline void vote_for_neighbourhood(struct place own, uint32_t source,
                                          struct vote_bounds bounds)
{
    long kt = config.method == RHO_HOUGH_NHT_C ? neighbourhood_rows() : 0;
    long kr = config.method == RHO_HOUGH_NHT_C ? neighbourhood_columns() : 0;
    for (long a = -kt; a <= kt && is_in_plane(own); a++) {
        for (long b = -kr; b <= kr; b++) {
            struct place place = wrapped_place((struct place){own.theta + a, own.rho + b});
            vote(place, source, scaled_bounds(bounds, weight_of_neighbour(a, b)));
        }
    }
}

/* Cells that a line may be in: its own one, and others nearer than CELL_SLACK. */
static inline int possible_places_of_line(struct line line, struct place places[5])
{
    int num = 1;
    places[0] = place_of(line);
    for (int i = 0; i < 4; i++) {
        struct line moved = {
            line.rho + (i & 1 ? CELL_SLACK : -CELL_SLACK) * (double)config.rho_cell_m,
            line.theta + (i & 2 ? CELL_SLACK : -CELL_SLACK) * (double)config.theta_cell_rad};
        struct place place = place_of(wrapped_line(moved));
        int k = 0;
        while (k < num && (places[k].theta != place.theta || places[k].rho != place.rho)) {
            k++;
        }
        places[k] = place;
        num = k == num ? num + 1 : num;
    }
    return num;
}

/* Counts that the result of the library must agree with. */
static struct {
    uint32_t pairs, lines, candidates, candidates_surely, voters, at_limits, votes, votes_surely;
} counted;

static inline void vote_pair(const struct pair *pair, const struct pairs *kernels)
{
    struct vote_bounds bounds = vote_bounds_of_pair(pair, kernels);
    struct place places[5];
    int num = possible_places_of_line(pair->line, places);
    uint32_t source = counted.lines++;
    counted.candidates += pair->gated != NO;
    counted.candidates_surely += pair->gated == YES;
    counted.voters += bounds.most > 0.0;
    counted.at_limits += bounds.most > 0.0 && (num > 1 || bounds.least <= 0.0);
    for (int i = 0; i < num; i++) {
        struct vote_bounds vague = {i == 0 ? bounds.value : 0.0, 0.0, bounds.most};
        vote_for_neighbourhood(places[i], source, num == 1 ? bounds : vague);
    }
}

static inline void vote_pairs(void)
{
    struct pairs before = {NULL, 0};
    for (unsigned scan = 1; scan < points.at.num_scans; scan++) {
        struct pairs pairs = voting_pairs_of_scan(scan);
        unsigned from = scan_end[scan - 1] - scan_start(scan - 1);
        counted.pairs += from * (scan_end[scan] - scan_end[scan - 1]);
        for (size_t i = 0; i < pairs.num; i++) {
            vote_pair(&pairs.list[i], &before);
        }
        free(before.list);
        before = pairs;
    }
    free(before.list);
}

/*
 * Votes of plots. Float rounds x cos + y sin more often than the rho of a pair: four times the
 * slack.
 */
static inline void vote_plots(void)
{
    for (unsigned i = 0; i < num_plots(); i++) {
        uint32_t source = config.votes == RHO_VOTES_SCANS ? scan_of(i) : i;
        for (long row = 0; row < num_theta(); row++) {
            double theta = ((double)row + 0.5) * (double)config.theta_cell_rad;
            double rho = (double)x_m[i] * cos(theta) + (double)y_m[i] * sin(theta);
            double slack = 4.0 * CELL_SLACK * (double)config.rho_cell_m;
            struct place place = {row, place_of((struct line){rho, 0.0}).rho};
            struct place low = {row, place_of((struct line){rho - slack, 0.0}).rho};
            struct place high = {row, place_of((struct line){rho + slack, 0.0}).rho};
            int is_sure = low.rho == high.rho;
            vote(place, source, (struct vote_bounds){1.0, is_sure ? 1.0 : 0.0, 1.0});
            if (!is_sure) {
                vote(low.rho == place.rho ? high : low, source,
                     (struct vote_bounds){0.0, 0.0, 1.0});
            }
        }
    }
}

static inline int by_cell(const void *a, const void *b)
{
    const struct vote *p = a, *q = b;
    if (p->key != q->key) {
        return p->key < q->key ? -1 : 1;
    }
    return (p->source > q->source) - (p->source < q->source);
}

static inline struct vote_bounds larger_bounds(struct vote_bounds a, struct vote_bounds b)
{
    return (struct vote_bounds){fmax(a.value, b.value), fmax(a.least, b.least),
                                fmax(a.most, b.most)};
}

static inline void sum_votes_by_cell(void)
{
    qsort(votes, num_votes, sizeof *votes, by_cell);
    num_cells = 0;
    for (size_t i = 0; i < num_votes;) {
        struct vote_bounds bounds = votes[i].bounds;
        uint32_t key = votes[i].key, source = votes[i].source;
        while (++i < num_votes && votes[i].key == key && votes[i].source == source) {
            bounds = larger_bounds(bounds, votes[i].bounds);
        }
        if (num_cells == 0 || cells[num_cells - 1].key != key) {
            assert_true(num_cells < CELLS_MAX);
            cells[num_cells++] = (struct cell){.key = key};
        }
        struct cell *cell = &cells[num_cells - 1];
        cell->bounds.value += bounds.value;
        cell->bounds.least += bounds.least;
        cell->bounds.most += bounds.most;
        cell->sources++;
        counted.votes++;
        counted.votes_surely += bounds.least > 0.0;
    }
}

static inline void expect_reference(void)
{
    memset(&counted, 0, sizeof counted);
    num_votes = 0;
    if (config.method == RHO_HOUGH_HT) {
        vote_plots();
    } else {
        vote_pairs();
    }
    sum_votes_by_cell();
}

static struct {
    size_t cells, exact; /* cells compared, and those of them without a value near a limit */
    double worst;        /* largest error, in parts of a vote for each voter */
} seen;

static inline struct cell *find_cell(uint32_t key)
{
    size_t from = 0, to = num_cells;
    while (from < to) {
        size_t middle = (from + to) / 2;
        if (cells[middle].key < key) {
            from = middle + 1;
        } else {
            to = middle;
        }
    }
    return from < num_cells && cells[from].key == key ? &cells[from] : NULL;
}

static inline void expect_cell(const struct cell *cell, double slack)
{
    double by = RHO_HOUGH_VOTE, room = slack * (double)cell->sources;
    double off = fmax(cell->bounds.least * by - cell->shown, cell->shown - cell->bounds.most * by);
    if (off > room) {
        print_error("theta cell %u, rho cell %u: %.0f, not %.2f .. %.2f\n",
                    cell->key / (unsigned)num_rho(), cell->key % (unsigned)num_rho(), cell->shown,
                    cell->bounds.least * by, cell->bounds.most * by);
        fail();
    }
    int is_exact = cell->bounds.most - cell->bounds.least < 1e-12;
    seen.cells++;
    seen.exact += (size_t)is_exact;
    if (is_exact) {
        seen.worst = fmax(seen.worst, off / (double)cell->sources);
    }
}

/*
 * Compares all cells that the library listed with the reference; slack is in parts of a vote for
 * each voter.
 */
static inline void expect_cells(double slack)
{
    for (uint32_t i = 0; i < result.num_peaks; i++) {
        uint32_t key = peaks[i].theta_cell * (uint32_t)num_rho() + peaks[i].rho_cell;
        struct cell *cell = find_cell(key);
        assert_true(i == 0 || by_rank(&peaks[i - 1], &peaks[i]) < 0);
        assert_true(peaks[i].votes > 0);
        if (!cell) {
            print_error("theta cell %u, rho cell %u: %u, not 0\n", peaks[i].theta_cell,
                        peaks[i].rho_cell, peaks[i].votes);
            fail();
            return;
        }
        assert_true(cell->shown == 0.0);
        cell->shown = peaks[i].votes;
    }
    for (size_t i = 0; i < num_cells; i++) {
        expect_cell(&cells[i], slack);
    }
    assert_int_equal(result.cells, config.method == RHO_HOUGH_HT ? 0 : result.num_peaks);
    assert_int_equal(result.votes_max, result.num_peaks ? peaks[0].votes : 0);
}

static inline void expect_counts(void)
{
    assert_int_equal(result.pairs, counted.pairs);
    assert_in_range(result.candidates, counted.candidates_surely, counted.candidates);
    assert_true(result.votes >= counted.votes_surely && result.votes <= counted.votes);
}

struct peak {
    double votes;
    struct place at;
};

static struct peak listed[CELLS_MAX];

static inline int peaks_by_rank(const void *a, const void *b)
{
    const struct peak *p = a, *q = b;
    if (p->votes != q->votes) {
        return p->votes < q->votes ? 1 : -1;
    }
    if (p->at.theta != q->at.theta) {
        return p->at.theta < q->at.theta ? -1 : 1;
    }
    return (p->at.rho > q->at.rho) - (p->at.rho < q->at.rho);
}

static inline int is_peak_within_neighbourhood(const struct peak *a, const struct peak *b)
{
    for (long turn = -1; turn <= 1; turn++) {
        long theta = b->at.theta + turn * num_theta();
        long rho = turn ? num_rho() - 1 - b->at.rho : b->at.rho;
        if (labs(a->at.theta - theta) <= neighbourhood_rows() &&
            labs(a->at.rho - rho) <= neighbourhood_columns()) {
            return 1;
        }
    }
    return 0;
}

/*
 * Keeps in `listed` the peaks with enough votes, best first, without suppressed ones; returns their
 * number.
 */
static inline size_t choose_peaks(size_t num)
{
    double most = 0.0;
    size_t above = 0, kept = 0;
    for (size_t i = 0; i < num; i++) {
        most = fmax(most, listed[i].votes);
    }
    double limit = fmax((double)config.tau * most, (double)config.votes_min);
    for (size_t i = 0; i < num; i++) {
        if (listed[i].votes > 0.0 && listed[i].votes >= limit) {
            listed[above++] = listed[i];
        }
    }
    qsort(listed, above, sizeof *listed, peaks_by_rank);
    for (size_t i = 0; i < above; i++) {
        size_t k = config.keeps_all_cells ? kept : 0;
        while (k < kept && !is_peak_within_neighbourhood(&listed[k], &listed[i])) {
            k++;
        }
        if (k == kept) {
            listed[kept++] = listed[i];
        }
    }
    return kept;
}

/*
 * Expected peaks: by the reference's exact votes, or by the votes of the cells that the library
 * listed.
 */
static inline size_t choose_from_cells(void)
{
    for (size_t i = 0; i < num_cells; i++) {
        listed[i] = (struct peak){cells[i].bounds.value,
                                  {cells[i].key / num_rho(), cells[i].key % num_rho()}};
    }
    return choose_peaks(num_cells);
}

static inline size_t choose_from_listed(void)
{
    for (uint32_t i = 0; i < result.num_peaks; i++) {
        listed[i] = (struct peak){(double)peaks[i].votes / RHO_HOUGH_VOTE,
                                  {peaks[i].theta_cell, peaks[i].rho_cell}};
    }
    return choose_peaks(result.num_peaks);
}

static inline void expect_peaks_as_listed(size_t num)
{
    assert_int_equal(result.num_peaks, num);
    for (size_t i = 0; i < num; i++) {
        assert_int_equal(peaks[i].theta_cell, listed[i].at.theta);
        assert_int_equal(peaks[i].rho_cell, listed[i].at.rho);
        assert_int_equal(peaks[i].votes, (long long)(listed[i].votes * RHO_HOUGH_VOTE + 0.5));
    }
}

#endif
