/* SPDX-License-Identifier: MIT */
/*
 * coarse_votes: votes of points in coarse bins of rho, by which pruning drops points. A template as
 * row_votes.h. The bins are a ring: rho values that differ by its whole length share a bin.
 */

static void NAME(vote_in_bins)(const struct rho_accumulator_pass *pass, CELL *restrict votes,
                               const int32_t *restrict bins, const uint16_t *restrict bits,
                               unsigned n)
{
    if (pass->counts_points) {
        for (unsigned i = 0; i < n; i++) {
            votes[bins[i]]++;
        }
        return;
    }
    for (unsigned i = 0; i < n; i++) {
        votes[bins[i]] |= (CELL)bits[i];
    }
}

/* Sets are_enough[b] where bins b .. b + 2 have min_votes points. Returns whether any is set. */
static int NAME(mark_triples_by_points)(const CELL *restrict votes, CELL *restrict are_enough,
                                        unsigned num_bins, CELL min_votes)
{
    CELL any = 0;
    for (unsigned i = 0; i < num_bins; i++) {
        are_enough[i] = (CELL)(votes[i] + votes[i + 1u] + votes[i + 2u]) >= min_votes;
        any |= are_enough[i];
    }
    return any;
}

/* Sets are_enough[b] if bins b .. b + 2 hold min_votes scans. Returns whether any bin is set. */
static int NAME(mark_triples_by_scans)(const CELL *restrict votes, CELL *restrict are_enough,
                                       unsigned num_bins, CELL min_votes)
{
    CELL any = 0, add = (CELL)(0x80u - min_votes);
    for (unsigned i = 0; i < num_bins; i++) {
        CELL v = (CELL)(votes[i] | votes[i + 1u] | votes[i + 2u]);
        v = (CELL)(v - ((v >> 1) & (CELL)0x5555u));
        v = (CELL)((v & (CELL)0x3333u) + ((v >> 2) & (CELL)0x3333u));
        v = (CELL)((v + (v >> 4)) & (CELL)0x0f0fu);
        v = (CELL)(sizeof(CELL) > 1 ? (v + (v >> 8)) & (CELL)0x1fu : v);
        are_enough[i] = (CELL)((CELL)(v + add) & 0x80u);
        any |= are_enough[i];
    }
    return any;
}

/* Lists in bins[] the points that may reach min_votes, by their bins. Returns their number. */
static unsigned NAME(list_kept_points)(struct rho_accumulator_pass *pass, unsigned n,
                                       unsigned num_bins)
{
    struct rho_accumulator *accumulator = pass->accumulator;
    CELL *votes = (CELL *)accumulator->few.votes;
    CELL *are_enough = (CELL *)accumulator->few.are_enough;
    int32_t *bins = accumulator->few.bins;
    CELL least = (CELL)pass->list.min_votes;
    memset(votes, 0, num_bins * sizeof *votes);
    NAME(vote_in_bins)(pass, votes, bins, accumulator->few.bits, n);
    votes[num_bins] = votes[0];
    votes[num_bins + 1u] = votes[1];
    if (!(pass->counts_points
              ? NAME(mark_triples_by_points)(votes, are_enough + 2, num_bins, least)
              : NAME(mark_triples_by_scans)(votes, are_enough + 2, num_bins, least))) {
        return 0;
    }
    are_enough[0] = are_enough[num_bins];
    are_enough[1] = are_enough[num_bins + 1u];
    /* a point is kept where one of its three bins is marked */
    unsigned num_kept = 0;
    for (unsigned i = 0; i < n; i++) {
        const CELL *at = are_enough + bins[i];
        bins[num_kept] = (int32_t)i;
        num_kept += (at[0] | at[1] | at[2]) != 0;
    }
    return num_kept;
}
