/* SPDX-License-Identifier: MIT */
/* policy: constants that no physics or parameter sets; tools/gates/mutate.py varies numbers. */
#ifndef RHOTRACK_PAPERS_POLICY_H
#define RHOTRACK_PAPERS_POLICY_H

/* accumulator.c */

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

/* Pruning; all change the time of a search, none its peaks */

/*
 * Parts of an interval of rows of theta that keeps points; the longest interval has PARTS^5 rows.
 * Half: many intervals keep all points. Twice: many bins are marked for nothing.
 */
#define PARTS 4u
/*
 * Rows of the shortest interval that is pruned. Half: single rows are pruned, which costs more than
 * their votes. Twice: pairs of rows vote that could be skipped.
 */
#define ROWS_LEAST 2u
/* Fewest bins of rho. Half: more points share one by chance. Twice: more bins to clear. */
#define BINS_MIN 64u

/* passive_paper_lines.c */

/*
 * Cells of theta on either side of a chosen line, and of rho on either side of its ridge there, in
 * which no other line is chosen: the votes of one target spread. Half: a target gives several
 * lines. Twice: targets that cross at one place hide each other.
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
