# SPDX-License-Identifier: MIT
"""What papers_initiation.py is compared with: the figures of an independent implementation, the
paper's words, and what was found about them."""
import math

RUNS = 200  # of the reference
TARGETS = 3
WORK_IV = {"HT": 2.26e6, "MHT": 63e3, "IHT": 9.4e3, "NHT C": 535e3}  # votes of a run
FIGURES = ["detected", "met", "false peaks", "discrimination", "top 3", "error of rho",
           "error of theta", "votes"]
METHODS = ["HT", "MHT", "IHT", "NHT A", "NHT C"]

# In double precision on a plane that is wholly there; the last digit is rounded. "9..12": anything
# between, "-": none.
REFERENCE = {
    "I": """1.00 1.00 0 2.0  1.00 1.5 .79 65k
            1.00 1.00 0 2.0  1.00 1.4 .21 53
            1.00 1.00 0 2.0  1.00 1.4 .21 22
            .98  .98  0 1.95 .98  1.4 .21 15
            .98  .98  0 1.95 .98  1.4 .21 4.2k""",
    "II": """.98 1.00 115 1.30   .48 7.7 3.5 65k
             .71 .99  38  .79    .02 10  3.9 53
             .70 .99  9   .78    .02 9   3.9 22
             .14 .35  0   .3...4 .14 8   3.9 2
             .14 .35  0   .3...4 .14 8   3.9 484""",
    "III": """1.00 1.00 2362 .87  .20  1.6 .78 2.26M
              .99  .99  114  1.03 .51  1.4 .22 63k
              1.00 1.00 1.1  1.92 1.00 1.4 .21 9.4k
              .99  .99  0.0  1.93 .99  1.4 .2  1.9k
              .98  .99  2.9  1.50 .97  1.4 .2  535k""",
    "IV": """.86 .96 2729 .63 .01 11    3.7      2.26M
             .16 .37 262  .34 .00 14    4.0      63k
             .34 .47 1335 .40 .00 12    3.7      9.4k
             .09 .23 80   .24 .00 9..12 3.5..4.3 1.9k
             .07 .22 36   .25 .01 9..12 3.5..4.3 535k""",
    "IV thin": """.96 1.0 968 .84 .14 - - 286k
                  -   -   -   -   -   - - -
                  .69 1.0 152 .73 .02 - - 171
                  -   -   -   -   -   - - -
                  .14 .35 1.0 .32 .13 - - 1150""",
    "real 10": """.97  1.0 2156 .65 .00 - - -
                  .62  .96 896  .36 .00 - - -
                  .65  .99 112  .65 .00 - - -
                  .003 .02 1    .01 0   - - -
                  .003 .02 1    .01 0   - - -""",
    "real 100": """.22 .61 4054 .48 .00 - - 2.26M
                   .07 .28 744  .25 .00 - - 63k
                   .62 .91 3883 .37 .00 - - 6.4k
                   .03 .12 74   .04 .00 - - 238
                   .01 .05 34   .04 .00 - - 69k""",
}

# Table 2, by Situation and HT, MHT, IHT, NHT: discrimination, divergence, decline.
WORDS = {
    "I": ["high slight none", "high none slight", "high none slight", "high slight slight"],
    "II": ["high slight slight", "low medium serious", "low medium serious", "high slight slight"],
    "III": ["low slight slight", "high slight slight", "high slight slight", "high slight slight"],
    "IV": ["low medium medium", "low serious serious", "low serious serious", "high slight slight"],
}


def words(situation, method):
    return WORDS[situation][min(METHODS.index(method), 3)].split()


def text_of(situation, method, figure):
    """The reference's figure as it is printed; empty: it has none."""
    if method not in METHODS or figure not in FIGURES:
        return ""
    line = REFERENCE[situation].splitlines()[METHODS.index(method)]
    text = line.split()[FIGURES.index(figure)]
    return "" if text == "-" else text


def expected(situation, method, figure):
    """(value, half of what rounding may hide) of the reference, or None. ".3...4" is .3 to .4."""
    text = text_of(situation, method, figure)
    if not text:
        return None
    ends = [_number(end) for end in (text.split("..", 1) if ".." in text else [text])]
    low, high = ends[0], ends[-1]
    return (low[0] + high[0]) / 2, (high[0] - low[0]) / 2 + high[1]


def _number(text):
    """2.26M: 2.26e6, and half a unit of its last digit."""
    factor = {"M": 1e6, "k": 1e3}.get(text[-1], 1.0)
    digits = text.rstrip("Mk")
    return float(digits) * factor, 0.5 * factor / 10**len(digits.partition(".")[2])


def tolerance(figure, mean, error, runs, reference):
    """Four standard errors of the difference, and the rounding. The reference is taken to vary as
    these runs do. Few runs can all come out the same: counts vary at least as usual, with other
    figures a usual run more is reckoned with."""
    value, rounding = reference
    pooled = (runs * mean + RUNS * value) / (runs + RUNS)
    own = 0.0 if math.isnan(error) else runs * error**2
    is_share = figure in ("detected", "met", "top 3")
    usual = (pooled * (1 - pooled) / TARGETS if is_share else pooled if figure == "false peaks"
             else pooled * max(2 - pooled, 0) / TARGETS if figure == "discrimination"
             else pooled**2)
    is_count = is_share or figure == "false peaks"
    variance = max(own, usual, 0) if is_count else (runs * own + usual) / (runs + 1)
    return 4 * math.sqrt(variance * (1 / runs + 1 / RUNS)) + rounding


def findings(report, of, times, alone_votes):
    """What the paper claims, and what was found. of: summaries by Situation; times by density."""
    def mean(figure, situation, *methods):
        digits = {"false peaks": 0, "votes": 0}.get(figure, 2)
        texts = [f"{of[situation][method][figure][0]:.{digits}f}" for method in methods]
        return " and ".join([", ".join(texts[:-1])] * (len(texts) > 1) + texts[-1:])

    dense, densest = 10.0, max(times)
    ms = {method: f"{value[0]:.3g}" for method, value in times[dense].items()}
    slow = times[densest]["NHT C"][0] / times[densest]["whole plane"][0]
    nht = ("NHT A", "NHT C")
    report.heading("What the paper claims, and what was found")
    report.text(
        f"Situation I, Fig. 7: all methods do well. This holds: HT, MHT and IHT detect all "
        f"targets, NHT {mean('detected', 'I', 'NHT C')} of them (a missed plot takes two pairs "
        f"from it, and a third one's kernel), and the targets' peaks are twice as high as what tau "
        f"leaves out.")
    report.text(
        f"Situation II, Fig. 8: noise harms MHT and IHT, not HT and NHT. For HT this holds "
        f"({mean('detected', 'II', 'HT')} detected, discrimination "
        f"{mean('discrimination', 'II', 'HT')}, though with {mean('false peaks', 'II', 'HT')} "
        f"false peaks), and for MHT and IHT (discrimination "
        f"{mean('discrimination', 'II', 'MHT', 'IHT')}). For NHT it does not: "
        f"{mean('detected', 'II', *nht)} (A and C) are detected. The lines of one pair of plots "
        f"and the next differ by sigma sqrt(6) / (v T): 43 to 61 mrad at 10 m, but kernels are "
        f"sought within 8 mrad. Six of seven pairs find none, and do not vote.")
    report.text(
        f"Situation III, Fig. 9: clutter harms HT, not the others. This holds: HT's highest false "
        f"peak is above the targets' (discrimination {mean('discrimination', 'III', 'HT')}, "
        f"{mean('false peaks', 'III', 'HT')} false peaks); MHT is at the edge "
        f"({mean('discrimination', 'III', 'MHT')}, {mean('false peaks', 'III', 'MHT')}); IHT and "
        f"NHT ({mean('discrimination', 'III', 'IHT', *nht)}) tell them apart. IHT needs "
        f"{mean('votes', 'III', 'IHT')} votes for it; MHT, NHT C and HT cast "
        f"{mean('votes', 'III', 'MHT', 'NHT C', 'HT')}.")
    report.text(
        f"Situation IV, Fig. 10: only NHT still tells targets from clutter. This does not hold: no "
        f"method does (discrimination {mean('discrimination', 'IV', *METHODS)}). HT's "
        f"{mean('detected', 'IV', 'HT')} detected are chance: its "
        f"{mean('false peaks', 'IV', 'HT')} false peaks cover the plane. NHT has the fewest false "
        f"peaks ({mean('false peaks', 'IV', *nht)}), and detects {mean('detected', 'IV', *nht)}.")
    report.text(
        f"Run time, Fig. 11: HT takes most, then NHT, MHT, IHT. At {dense:g} clutter plots a "
        f"square kilometre: HT on a whole plane {ms['whole plane']} ms, streamed {ms['HT']} ms, "
        f"MHT {ms['MHT']} ms, NHT C {ms['NHT C']} ms, NHT A {ms['NHT A']} ms, IHT {ms['IHT']} ms. "
        f"The paper's order does not hold: MHT lets every pair vote, NHT asks for a target's speed "
        f"first. It changes with the clutter: HT's work grows like the number of plots, MHT's and "
        f"IHT's like its square, NHT's faster, as each pair meets those before. At {densest:g} a "
        f"square kilometre NHT C takes {slow:.2f} times as long as HT on a whole plane.")
    report.text(
        f"Real data, Fig. 15: only NHT identifies the three targets. This does not hold. Of Table "
        f"3's plots alone, without clutter or misses, {alone_votes} pair votes in reading A: the "
        f"aircraft turn slightly, and at 25 km from the origin that moves the lines of two plots "
        f"by up to 850 m and 40 mrad. With 10 clutter plots a scan NHT detects "
        f"{mean('detected', 'real 10', *nht)}; HT detects {mean('detected', 'real 10', 'HT')} "
        f"among {mean('false peaks', 'real 10', 'HT')} false peaks. The paper's density of 10 a "
        f"square kilometre would be 3840 plots a scan; its run times (HT 63 times MHT) fit 58.")
    report.text(
        f"The default meets {mean('met', 'IV', 'default')} of the targets in Situation IV with "
        f"{of['IV']['default']['false peaks'][0]:.3f} false peaks a run, on the real data with 100 "
        f"clutter plots a scan {mean('met', 'real 100', 'default')} with "
        f"{of['real 100']['default']['false peaks'][0]:.3f}. Its share detected "
        f"({mean('detected', 'IV', 'default')} in Situation IV) is what the window allows: the "
        f"angle of the best line through seven plots scatters by 3.3 to 4.7 mrad, and the window "
        f"ends at 8 mrad.")
