#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy, scipy and matplotlib are its packages (tools/setup.sh lab).
"""Experiment polar: a turning radar's plots with the covariance of each.

Of each run of scene polar the first seven turns go through a batch search, and all fifteen through
the tracker, in four cases: the library knows each plot's ellipse, or it is told the larger of its
sigmas in all directions; with range rates, or without (polar_runs.py).
"""
import numpy as np

from common import experiment
import rhotrack
from common import simulate_scene
from parts.polar_runs import (MIN_SCANS, PD, SIGMA_RANGE_RATE_MPS, TURN_S, WINDOW, Case, Sky, facts,
                        figures_of, measure)

RUNS = 200
CLUTTER = (100, 1000)  # plots a turn
CASES = (Case("own covariance"), Case("one isotropic sigma", is_isotropic=True),
         Case("own covariance, range rate", has_range_rate=True),
         Case("one isotropic sigma, range rate", is_isotropic=True, has_range_rate=True))


def run(job):
    seed, clutter = job
    sky = Sky(simulate_scene.simulate("polar", seed, f"clutter.0.plots={clutter}",
                                  f"radars.0.sigma_range_rate_mps={SIGMA_RANGE_RATE_MPS}"), clutter)
    return [measure(case, sky) for case in CASES]


# --- what is told


def initiation_row(case, clutter, of):
    return [case.name, clutter, f"{of['pd']:.3f}", f"{of['oracle_pd']:.3f}",
            f"{of['false_candidates_per_run'][0]:.3f}", f"{of['candidate_error_m']:.0f}",
            f"{of['search_ms']:.2f}"]


def tracks_row(case, clutter, of):
    return [case.name, clutter, f"{of['tracked_at_end']:.3f}", f"{of['confirmed_at_turn']:.2f}",
            f"{of['false_tracks_per_run'][0]:.3f}", f"{of['along_rmse_m'][0]:.1f}",
            f"{of['rmse_m'][0]:.1f}", f"{of['double_filter_rmse_m'][0]:.1f}",
            f"{of['over_double_filter'][0]:.3f}"]


def judge(report, case, clutter, of):
    name = f"{case.name}, {clutter} a turn"
    report.at_most(f"{name}: rmse over the double filter's", of["over_double_filter"][0], 1.03,
                   of["over_double_filter"][1])
    if clutter < 500:
        report.at_most(f"{name}: Pd behind the clairvoyant fit", of["pd_behind_oracle"][0], 0.02,
                       of["pd_behind_oracle"][1])
    elif not case.has_range_rate:
        return
    else:
        report.at_least(f"{name}: Pd", of["pd"], 0.95, trials=of["targets"])
        report.at_least(f"{name}: tracked at the end", of["tracked_at_end"], 0.95,
                        trials=of["targets"])
    most = 0.05 if clutter < 500 else 0.1
    report.at_most(f"{name}: false candidates a run", of["false_candidates_per_run"][0], most,
                   of["false_candidates_per_run"][1])
    report.at_most(f"{name}: false tracks a run", of["false_tracks_per_run"][0], most,
                   of["false_tracks_per_run"][1])


def draw_run(report):
    """A run without misses: the map, and the gates of one target's kernel."""
    import matplotlib.pyplot as plt
    clutter = CLUTTER[-1]
    sky = Sky(simulate_scene.simulate("polar", report.options.seed, "radars.0.pd=1",
                                  f"clutter.0.plots={clutter}",
                                  f"radars.0.sigma_range_rate_mps={SIGMA_RANGE_RATE_MPS}"), clutter)
    plots = np.concatenate(sky.turns[:WINDOW])
    x_km, y_km = (plots["range_m"] / 1e3 * of(plots["azimuth_rad"]) for of in (np.cos, np.sin))
    own = plots["target_id"] >= 0
    settings = sky.settings.copy(scans=WINDOW, min_scans=MIN_SCANS, score_min_nat=0, pd=PD)
    rows = sky.told(CASES[0])
    found = rhotrack.Initiator(settings).find(rhotrack.Scans(rows[rows["scan"] <= WINDOW],
                                                             settings))
    figure, axes = plt.subplots(figsize=(9, 9))
    axes.plot(x_km, y_km, ".", color="#b0b0b0", markersize=1, label="clutter plots")
    axes.plot(x_km[own], y_km[own], "o", color="black", fillstyle="none", markersize=5,
              label="target plots")
    span_s = TURN_S * (WINDOW - 1)
    for number, one in enumerate(found):
        axes.plot([(one["x_m"] - span_s * one["vx_mps"]) / 1e3, one["x_m"] / 1e3],
                  [(one["y_m"] - span_s * one["vy_mps"]) / 1e3, one["y_m"] / 1e3], color="#0072b2",
                  linewidth=2, label="" if number else "tracks found")
    axes.set(xlabel="x east (km)", ylabel="y north (km)", aspect="equal")
    axes.legend(loc="upper right")
    report.figure("map", figure,
                  "A run without misses: seven turns of 1000 clutter plots, and the tracks found.")
    draw_gates(report, sky, x_km, y_km, own)


def draw_gates(report, sky, x_km, y_km, own):
    """Between the first and the last plot of the target that is farthest out, and one in each turn
    between: places within 99.9 % of a plot that fits the line."""
    import matplotlib.pyplot as plt
    radar = sky.radar(CASES[0])
    ends = [np.concatenate([turn[turn["target_id"] == target][:1] for turn in sky.turns[:WINDOW]])
            for target in sky.targets]
    ends = max((one for one in ends if len(one) == WINDOW), key=lambda one: one["range_m"][-1])

    def noise(plot, is_isotropic):
        cosine, sine = np.cos(plot["azimuth_rad"]), np.sin(plot["azimuth_rad"])
        turn = np.array([[cosine, -sine], [sine, cosine]])
        across_m = plot["range_m"] * radar.sigma_azimuth_rad
        along_m = across_m if is_isotropic else radar.sigma_range_m
        return turn @ np.diag([along_m**2, across_m**2]) @ turn.T

    def place(plot):
        return plot["range_m"] * np.array([np.cos(plot["azimuth_rad"]),
                                           np.sin(plot["azimuth_rad"])])

    circle = np.sqrt(13.8) * np.array([np.cos(np.linspace(0, 2 * np.pi, 73)),
                                       np.sin(np.linspace(0, 2 * np.pi, 73))])
    figure, axes = plt.subplots(figsize=(9, 6))
    axes.plot(x_km[~own], y_km[~own], ".", color="#909090", markersize=4, label="clutter plots")
    for is_isotropic, color, name in ((True, "#d55e00", "gates, one isotropic sigma"),
                                      (False, "#0072b2", "gates, own covariance")):
        for turn in range(1, WINDOW - 1):
            al = turn / (WINDOW - 1)
            spread = ((1 - al)**2 * noise(ends[0], is_isotropic) + al**2 * noise(
                ends[-1], is_isotropic) + noise(ends[turn], is_isotropic))
            border = ((1 - al) * place(ends[0]) + al * place(ends[-1]))[:, None] + \
                np.linalg.cholesky(spread) @ circle
            axes.plot(*border / 1e3, color=color, label=name if turn == 1 else "")
    axes.plot(x_km[own], y_km[own], "o", color="black", fillstyle="none", label="target plots")
    middle, half = (place(ends[0]) + place(ends[-1])) / 2e3, np.linalg.norm(
        place(ends[0]) - place(ends[-1])) / 2e3 + 1
    axes.set(xlabel="x east (km)", ylabel="y north (km)", aspect="equal",
             xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half))
    axes.legend(loc="upper right")
    report.figure("gates", figure, "The same run, one target: gates (99.9 %) of the kernel between "
                  "its first and last plot, with the plots' own covariance, and with one isotropic "
                  "sigma.")


def draw_errors(report, figures):
    import matplotlib.pyplot as plt
    figure, panels = plt.subplots(1, 2, figsize=(12, 4.5))
    for axes, column, title in ((panels[0], 0, "rms position error (m)"),
                                (panels[1], 1, "along the line of sight (m)")):
        for case, of in zip(CASES, figures):
            errors = of["errors"]
            turns = np.flatnonzero(errors[:, 4])
            axes.plot(turns + 1, np.sqrt(errors[turns, column] / errors[turns, 4]), "o-",
                      markersize=3, label=case.name)
        axes.set(xlabel="turn", ylabel=title, ylim=(0, None))
    errors = figures[0]["errors"]
    turns = np.flatnonzero(errors[:, 4])
    panels[0].plot(turns + 1, np.sqrt(errors[turns, 2] / errors[turns, 4]), "k--",
                   label="own covariance, in double precision")
    panels[0].legend()
    report.figure("errors", figure, "Position error of confirmed tracks, 100 clutter plots a turn, "
                  "and its part along the line of sight.")


def main():
    options = experiment.options_of(__doc__, RUNS)
    report = experiment.Report("A turning radar, 15 m and 3 mrad, 4 s a turn", options)
    jobs = [(options.seed + run, clutter) for clutter in CLUTTER for run in range(options.runs)]
    done = report.map(run, jobs)
    levels = [done[i * options.runs:(i + 1) * options.runs] for i in range(len(CLUTTER))]
    rows = [(case, clutter, figures_of([one[number] for one in level]))
            for clutter, level in zip(CLUTTER, levels) for number, case in enumerate(CASES)]
    report.text("Scene polar: three targets at 20 to 60 km, clutter uniform in range and azimuth. "
                "Own covariance: the library knows each plot's ellipse. One isotropic sigma: it is "
                "told the larger of each plot's sigmas, in all directions.")
    draw_run(report)
    report.heading("Initiation")
    report.text("A batch of seven turns, at least five plots, score at least 0. The clairvoyant "
                "fit knows which plots are the target's, and the clutter's true density. "
                "Time is the processor's, with the memory of a new initiator.")
    report.table(["initiation from 7 turns", "clutter a turn", "Pd", "clairvoyant Pd",
                  "false a run", "error m", "ms"], [initiation_row(*row) for row in rows])
    report.heading("Tracks")
    report.text("The tracker with the scene's own parameters and one false track an hour wanted. "
                "The double filter takes the plots that the track took.")
    report.table(["tracks over 15 turns", "clutter a turn", "tracked at the end",
                  "confirmed at turn", "false a run", "along m", "rmse m", "in double m", "ratio"],
                 [tracks_row(*row) for row in rows])
    draw_errors(report, [of for _, clutter, of in rows if clutter == CLUTTER[0]])
    report.fact("cases", [{"case": case.name, "clutter_per_scan": clutter, **facts(of)}
                          for case, clutter, of in rows])
    for case, clutter, of in rows:
        if not case.is_isotropic:
            judge(report, case, clutter, of)
    report.close()


if __name__ == "__main__":
    main()
