#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy, scipy and matplotlib are its packages (tools/setup.sh lab).
"""Experiment doppler: what range rates are worth, known in full or up to multiples of a span.

The clutter at which scene doppler without range rates just meets its bars is looked for; then ten
times as much, with range rates, ambiguous ones, and none. Search, tracker and scores are those of
experiment polar.
"""
from common import experiment
from parts import polar_runs as polar
from common import simulate_scene

RUNS = 60
CLUTTER = (50, 75, 100, 150, 200, 300, 400)  # where the limit without range rates is looked for
TIMES = 10  # as much clutter
PD_MIN, FALSE_MAX = 0.95, 0.1
CASES = (polar.Case("no range rate"), polar.Case("range rate", has_range_rate=True),
         polar.Case("range rate, span 100 m/s", has_range_rate=True, span_mps=100),
         polar.Case("range rate, span 30 m/s", has_range_rate=True, span_mps=30))
JUDGED = (1, 2)  # beyond the limit the others take most of the time, and a quarter of the runs do


def run(job):
    """job: cases, seed, clutter that moves, clutter that stands."""
    cases, seed, moving, still = job
    sky = polar.Sky(simulate_scene.simulate("doppler", seed, f"clutter.0.plots={moving}",
                                        f"clutter.1.plots={still}"), moving)
    return [polar.measure(case, sky) for case in cases]


def measure(report, cases, num_runs, moving, still=0):
    """Figures of each case."""
    done = report.map(run, [(cases, report.options.seed + number, moving, still)
                            for number in range(num_runs)])
    return [polar.figures_of([one[k] for one in done]) for k in range(len(cases))]


def meets_bars(of):
    """By batch and tracker."""
    return (of["pd"] >= PD_MIN and of["tracked_after_5"] >= PD_MIN
            and of["false_candidates_per_run"][0] <= FALSE_MAX
            and of["false_tracks_per_run"][0] <= FALSE_MAX)


def find_limit(report):
    """Rows without range rates up to the first level that misses; the last level that does not."""
    rows, limit = [], 0
    for clutter in CLUTTER:
        of, = measure(report, CASES[:1], report.options.runs, clutter)
        rows.append((CASES[0].name, clutter, of))
        if not meets_bars(of):
            break
        limit = clutter
    return rows, limit


def measure_all(report):
    """Rows of the table; those at the limit and beyond by case; the limit."""
    levels, limit = find_limit(report)
    clutter = limit or CLUTTER[0]
    num_runs, few = report.options.runs, (report.options.runs + 3) // 4
    at_limit = [(case.name, clutter, of)
                for case, of in zip(CASES, measure(report, CASES, num_runs, clutter))]
    beyond = [None] * len(CASES)
    for numbers, count in ((JUDGED, num_runs), ((0, 3), few)):
        found = measure(report, [CASES[k] for k in numbers], count, TIMES * clutter)
        for k, of in zip(numbers, found):
            beyond[k] = (CASES[k].name, TIMES * clutter, of)
    still, = measure(report, CASES[1:2], few, TIMES * clutter / 2, TIMES * clutter / 2)
    still = (CASES[1].name + ", half the clutter stands", TIMES * clutter, still)
    return levels + at_limit[1:] + beyond + [still], at_limit, beyond, limit


def table_row(name, clutter, of):
    return [name, clutter, f"{of['pd']:.3f}", f"{of['false_candidates_per_run'][0]:.3f}",
            f"{of['search_ms']:.1f}", f"{of['tracked_after_5']:.3f}",
            f"{of['tracked_at_end']:.3f}", f"{of['false_tracks_per_run'][0]:.3f}",
            f"{of['confirmed_at_turn']:.2f}", f"{of['rmse_m'][0]:.1f}", f"{of['rmse_mps'][0]:.2f}"]


def judge(report, at_limit, beyond, limit):
    report.at_least("clutter a turn that is borne without range rates", limit, CLUTTER[0])
    for name, clutter, of in (beyond[k] for k in JUDGED):
        name = f"{name}, {clutter} a turn"
        report.at_least(f"{name}: Pd of a batch", of["pd"], PD_MIN, trials=of["targets"])
        report.at_most(f"{name}: false candidates a run", of["false_candidates_per_run"][0],
                       FALSE_MAX, of["false_candidates_per_run"][1])
        report.at_least(f"{name}: tracked after 5 turns", of["tracked_after_5"], PD_MIN,
                        trials=of["targets"])
        report.at_most(f"{name}: false tracks a run", of["false_tracks_per_run"][0], FALSE_MAX,
                       of["false_tracks_per_run"][1])
    (_, clutter, without), (name, _, with_rates) = at_limit[:2]
    ratio, error = experiment.quotient_of(with_rates["rmse_m"], without["rmse_m"])
    report.at_most(f"{name}, {clutter} a turn: rmse over that without", ratio, 1.0, error)


def draw(report, levels, at_limit, beyond):
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(figsize=(9, 4.5))
    for number, case in enumerate(CASES):
        points = [one for one in levels if one[0] == case.name] if number == 0 else [
            at_limit[number], beyond[number]]
        axes.semilogx([one[1] for one in points], [one[2]["tracked_after_5"] for one in points],
                      "o-", label=case.name)
    axes.set(xlabel="clutter plots a turn", ylabel="targets tracked after 5 turns", ylim=(0, 1.02))
    axes.legend(loc="lower left")
    report.figure("tracked", figure, "Targets with a confirmed track after five turns.")


def main():
    options = experiment.options_of(__doc__, RUNS)
    report = experiment.Report("A radar that measures range rates, 40 m, 7 mrad, 1 m/s, 4 s a turn",
                        options)
    rows, at_limit, beyond, limit = measure_all(report)
    report.text(f"Three targets at 20 to 60 km. Without range rates Pd .95, by a batch of seven "
                f"turns and by the tracker after five, and .1 false ones a run are met up to "
                f"{limit} clutter plots a turn; with them at ten times as many? Rows there without "
                f"bars have a quarter of the runs. A range rate within 800 m/s tells "
                f"ln(800 / 4.13) = 5.3 nat a plot (4.13: e to the entropy of 1 m/s of normal "
                f"noise), with a span of 100 m/s 3.2, of 30 m/s 2.0; ten times the clutter takes "
                f"2.3.")
    report.table(["case", "clutter a turn", "Pd, batch of 7", "false a run", "ms",
                  "tracked after 5", "at the end", "false a run", "confirmed at turn", "rmse m",
                  "rmse m/s"], [table_row(*one) for one in rows])
    draw(report, rows, at_limit, beyond)
    report.fact("limit_clutter_per_scan", limit)
    report.fact("cases", [{"case": name, "clutter_per_scan": clutter, **polar.facts(of)}
                          for name, clutter, of in rows])
    judge(report, at_limit, beyond, limit)
    report.close()


if __name__ == "__main__":
    main()
