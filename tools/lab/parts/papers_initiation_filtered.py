# SPDX-License-Identifier: MIT
"""Figs. 4 to 6 and 12 to 14 of Fan et al.: ideal tracks, plots among clutter, and initialised
tracks after a recursive least squares filter.

The paper filters by its reference [28], a fuzzy recursive least squares filter (RLSF), of which it
states no equation. Here it is the filter that the name says, without the fuzzy weights: constant
velocity, all plots alike, started from two plots. It is the fit of all plots so far, which is what
the initiator ends with; the filter adds the places in between.
"""
import matplotlib.pyplot as plt
import numpy as np

from common import paper_aircraft as paper

NEAR_SIGMAS = 5  # a plot of a track: the nearest to its place, within so many sigma
FIGURES = {"simulated": 4, "simulated, 0.5 m": 4, "real": 12}  # the first of three of the paper
RUNS_MAX = 20
COLOURS = ("#0072b2", "#d55e00", "#009e73")


def filtered(t_s, places_m):
    """Places (plots, 2) and velocity (2,) by recursive least squares, of two plots or more."""
    start = np.array([[1, t_s[0]], [1, t_s[1]]])
    state, spread = np.linalg.solve(start, places_m[:2]), np.linalg.inv(start.T @ start)
    places = [places_m[0], places_m[1]]
    for now_s, place in zip(t_s[2:], places_m[2:]):
        row = np.array([1, now_s])
        gain = spread @ row / (1 + row @ spread @ row)
        state = state + np.outer(gain, place - row @ state)
        spread = spread - np.outer(gain, row @ spread)
        places.append(row @ state)
    return np.array(places), state[1]


def plots_along(track, t_s, plots, near_m):
    """Times and places of the plots nearest to the track in each scan."""
    found = []
    for at_s, (places_m, _) in zip(t_s, plots):
        back_s = at_s - t_s[-1]
        place = np.array([track["x_m"] + back_s * track["vx_mps"],
                          track["y_m"] + back_s * track["vy_mps"]])
        away_m = np.hypot(*(places_m - place).T)
        if len(away_m) and away_m.min() <= near_m:
            found.append((at_s, places_m[away_m.argmin()]))
    return np.array([at_s for at_s, _ in found]), np.array([place for _, place in found])


def initialised(initiator, situation, plots, most):
    """The filtered tracks, best first."""
    scans = paper.scans_of(plots, situation.interval_s, initiator.settings)
    t_s = situation.interval_s * np.arange(len(plots))
    sigma_m = paper.TABLE_3_SIGMA_M if situation.is_real else paper.TABLE_1_SIGMA_M
    found = []
    for track in initiator.find(scans):
        if len(found) < most and np.isfinite([track["x_m"], track["vx_mps"]]).all():
            at_s, places_m = plots_along(track, t_s, plots, NEAR_SIGMAS * sigma_m)
            if len(at_s) >= 3:
                found.append((at_s, *filtered(at_s, places_m)))
    return found


def off_m(track, situation):
    """Of the track's last place from the nearest target then, in m."""
    at_s, places_m, _ = track
    scan = int(round(at_s[-1] / situation.interval_s))
    return float(np.hypot(*(situation.paths_m[scan] - places_m[-1]).T).min())


def tell(report, initiator_of, plots_of, situations):
    """Draws the figures; returns how near to targets the tracks end. situations: {kind of FIGURES:
    situation}."""
    runs = min(report.options.runs, RUNS_MAX)
    report.heading("Figs. 4 to 6 and 12 to 14: ideal tracks, plots, initialised tracks")
    report.text(
        f"Tracks of NHT, reading C, and of the default, filtered by recursive least squares "
        f"(constant velocity, all plots alike; the paper's own RLSF is fuzzy, and its equations "
        f"are in another paper). Mean of {runs} runs; of each at most as many tracks as targets, "
        f"of the highest peaks that have plots of three scans along them. Right: the last filtered "
        f"place is within 3 sigma of a target (10 m, real data 60 m). Off: of these.")
    facts = []
    for number, (kind, situation) in enumerate(situations.items()):
        near_m = 3 * (paper.TABLE_3_SIGMA_M if situation.is_real else paper.TABLE_1_SIGMA_M)
        of_method = {method: [] for method in ("NHT C", "default")}
        for run in range(runs):
            plots = plots_of(situation, np.random.default_rng([report.options.seed, 6000, number,
                                                               run]))
            tracks = {method: initialised(initiator_of(method, situation), situation, plots,
                                          situation.paths_m.shape[1]) for method in of_method}
            for method, found in tracks.items():
                of_method[method].append([off_m(track, situation) for track in found])
            if run == 0:
                draw(report, kind, situation, plots, tracks)
        for method, offs in of_method.items():
            every = np.array(sum(offs, []))
            right = every[every <= near_m]
            facts.append({"case": kind, "method": method, "tracks": len(every) / runs,
                          "right": len(right) / runs,
                          "off_m": float(right.mean()) if len(right) else None})
    report.table(["plots", "method", "tracks a run", "right", "off m"], [
        [one["case"], one["method"], f"{one['tracks']:.2f}", f"{one['right']:.2f}",
         "-" if one["off_m"] is None else f"{one['off_m']:.1f}"] for one in facts])
    return facts


def draw(report, kind, situation, plots, tracks):
    figure, grid = plt.subplots(2, 2, figsize=(12, 9), sharex=True, sharey=True,
                                layout="constrained")
    first = FIGURES[kind]
    paths_km = situation.paths_m / 1e3
    for target in range(paths_km.shape[1]):
        grid[0, 0].plot(*paths_km[:, target].T, "o-", color=COLOURS[target],
                        label=f"target {target + 1}")
    grid[0, 0].set_title(f"Fig. {first}: ideal tracks")
    grid[0, 0].legend()
    for places_m, target in plots:
        grid[0, 1].plot(*(places_m[target < 0] / 1e3).T, ".", color="0.65", ms=4)
        for number, colour in enumerate(COLOURS):
            grid[0, 1].plot(*(places_m[target == number] / 1e3).T, "o", color=colour, ms=6)
    grid[0, 1].set_title(f"Fig. {first + 1}: plots of {len(plots)} scans (grey: clutter)")
    for axes, (method, found) in zip(grid[1], tracks.items()):
        for target in range(paths_km.shape[1]):
            axes.plot(*paths_km[:, target].T, color="0.8", lw=5, solid_capstyle="round")
        for number, (_, places_m, _) in enumerate(found):
            axes.plot(*(places_m / 1e3).T, "s-", ms=4, color=COLOURS[number % 3])
        axes.set_title(f"Fig. {first + 2}: initialised by {method} (grey: true paths)")
    for axes in grid.flat:
        axes.set(xlabel="x (km)", ylabel="y (km)")
    box_km = np.array(situation.box_m) / 1e3
    grid[0, 0].set(xlim=box_km[:2], ylim=box_km[2:])
    report.figure(f"tracks-{kind.replace(',', '').replace(' ', '-')}", figure,
                  f"Figs. {first} to {first + 2}, {kind}: ideal tracks, plots, and the "
                  "initialised tracks after least squares.")
