/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_PAPERS_POLICY_H
#define RHOTRACK_PAPERS_POLICY_H

/* accumulator_search.c */

/*
 * Rows with at most this many points (rho cells / SPARSE_CELLS + SPARSE_POINTS) are cleared cell by
 * cell, which was measured to be faster. Half or twice: another way for some numbers of points, the
 * same peaks, slower.
 */
#define SPARSE_CELLS 8u
#define SPARSE_POINTS 64u
/*
 * Smallest min_votes with pruning: by chance nearly every row has a cell with two votes. Half:
 * pruning is tried where it saves nothing. Twice: common settings go without it. The same peaks.
 */
#define PRUNED_VOTES 3u

/* accumulator_pruning.c; all change the time of a search, none its peaks */

/* Rows of theta in the first interval. Half or twice: one more interval until the length fits. */
#define ROWS_START 16u
/* First number of rows searched without pruning, when it does not pay; doubled each time. */
#define ROWS_UNPRUNED (ROWS_START * 2u)
/*
 * Halvings of the longest interval down to one row: with very few points an interval of 1024 rows
 * is often empty. Half: 32 rows, many intervals. Twice: no plane is so long.
 */
#define HALVINGS 10
#define INTERVAL_ROWS_MAX (UINT32_C(1) << HALVINGS)
/*
 * Rows of the shortest interval that is pruned or halved. Half: single rows are pruned, which costs
 * more than their votes. Twice: pairs of rows vote that could be skipped.
 */
#define ROWS_LEAST 2u
/*
 * Intervals of at most this many rows are not halved if they keep more than 3/4 of their points.
 * Half or twice: more bins, or more votes.
 */
#define ROWS_BLUNT 16u
/* Fewest bins of rho. Half: more points share one by chance. Twice: more bins to clear. */
#define BINS_MIN 64u
/*
 * Intervals become shorter if they keep more than 1 / SHRINK_KEPT of all points, longer if they
 * keep at most 1 / GROW_KEPT. Half or twice: lengths that cost more than their halves or doubles.
 */
#define SHRINK_KEPT 3u
#define GROW_KEPT 16u
/*
 * Cost model of pruning, in units of about a nanosecond on a workstation: an interval or a row, and
 * a point in either. Half or twice: pruning ends too early or too late.
 */
#define WORK_FIXED 50u
#define WORK_POINT 2u

/* passive_paper_lines.c, passive_paper_view.c */

/*
 * Cells of theta and of rho on either side of a chosen line in which no other line is chosen: the
 * votes of one target spread over neighbouring cells. Half: a target gives several lines. Twice:
 * targets on similar courses hide each other.
 */
#define LINE_NEAR_ROWS 4
#define LINE_NEAR_COLUMNS 3

/* velocity_gate.c */

/*
 * Angles within this of the border of two cells get the lower cell, so that rounding does not
 * choose. Half: about two roundings of float32 at pi, which may choose. Twice: hardly any angle
 * gets another cell.
 */
#define TIE_RAD 1.0e-6f

#endif
