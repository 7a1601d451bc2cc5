#!/usr/bin/python3
# SPDX-License-Identifier: MIT
# Debian's interpreter: numpy, scipy and matplotlib are its packages (tools/setup.sh lab).
"""Experiment polar: a turning radar's plots with the covariance of each.

Of each run of scene polar the first seven turns go through a batch search, and all fifteen through
the tracker, in four cases: the library knows each plot's ellipse, or it is told the larger of its
sigmas in all directions; with range rates, or without. Beside the search stands a fit that is told
the target's plots, and the clutter's density; beside each track an extended Kalman filter in double
precision that takes the same plots (polar_references.py). Errors are those of confirmed tracks,
at the time when a turn begins.
"""
import dataclasses
import math
import time

import numpy as np

import lab
import polar_references
import rhotrack
import scene_runs

RUNS = 200
CLUTTER = (100, 1000)  # plots a turn
TURN_S, SIGMA_RANGE_RATE_MPS = 4.0, 1.0
WINDOW, MIN_SCANS, PD = 7, 5, 0.99  # turns of a search, hits in them, and what is assumed, and true
PROMPT = 5  # turns in which a track is wanted where it matters
TOLERANCE_M = 500.0  # a candidate within is the target's: a plot's error is up to 180 m across


@dataclasses.dataclass
class Case:
    name: str
    is_isotropic: bool = False  # the larger sigma of each plot, along and across
    has_range_rate: bool = False
    span_mps: float = 0.0  # range rates are known up to multiples of it; 0: all


CASES = (Case("own covariance"), Case("one isotropic sigma", is_isotropic=True),
         Case("own covariance, range rate", has_range_rate=True),
         Case("one isotropic sigma, range rate", is_isotropic=True, has_range_rate=True))


class Sky:
    """A run of a scene with one turning radar in the origin and straight targets. Turns are scans
    at the time when they begin."""

    def __init__(self, run, clutter):
        self.settings, self.sensor = run.settings, run.sensors[1]
        self.is_plot = scene_runs.has_plot(run.plots)
        self.rows = run.plots.copy()
        self.rows["t_s"][~self.is_plot] -= TURN_S
        self.plots = self.rows[self.is_plot]
        self.turns = [self.plots[self.plots["scan"] == k + 1]
                      for k in range(int(self.rows["scan"].max()))]
        first_s = run.truth.times_us[0] / 1e6
        self.start_m = run.truth.place_m[0] - first_s * run.truth.velocity_mps[0]
        self.velocity_mps = run.truth.velocity_mps[0]
        self.targets = range(len(self.start_m))
        told = {name: run.settings[name] for name in ("v_min_mps", "v_max_mps")}
        sides = [run.settings[f"area_{side}_m"] for side in ("x_min", "x_max", "y_min", "y_max")]
        self.area_m2 = (sides[1] - sides[0]) * (sides[3] - sides[2])
        self.reckoned = polar_references.Sky(WINDOW, PD, self.area_m2, clutter=clutter, **told)

    def radar(self, case):
        told = {name: getattr(self.sensor, name) for name in (
            "sigma_range_m", "sigma_azimuth_rad", "range_min_m", "range_max_m")}
        return polar_references.Radar(**told, sigma_range_rate_mps=SIGMA_RANGE_RATE_MPS
                                      if case.has_range_rate else math.nan)

    def place_m(self, target, t_s):
        return self.start_m[target] + t_s * self.velocity_mps[target]

    def told(self, case):
        """Rows of plots as a case tells them to the library."""
        more = {}
        if case.is_isotropic:
            radar = self.radar(case)
            outwards = math.exp(radar.sigma_azimuth_rad**2 / 2)  # the mean of cos(azimuth)
            more["x_m"] = outwards * self.rows["range_m"] * np.cos(self.rows["azimuth_rad"])
            more["y_m"] = outwards * self.rows["range_m"] * np.sin(self.rows["azimuth_rad"])
            more["sigma_m"] = np.maximum(radar.sigma_range_m,
                                         self.rows["range_m"] * radar.sigma_azimuth_rad)
        if case.has_range_rate:
            rate_mps = self.rows["range_rate_mps"]
            more["range_rate_mps"] = rate_mps - case.span_mps * np.round(
                rate_mps / case.span_mps) if case.span_mps else rate_mps
        polar = () if case.is_isotropic else ("range_m", "azimuth_rad")
        return scene_runs.with_fields(self.rows, ("t_s", "sensor_id", "scan", *polar), **more)


# --- a search of seven turns


def search(case, sky):
    """Targets found, and by the oracle; candidates that are none; errors of those found; time."""
    settings = sky.settings.copy(scans=WINDOW, min_scans=MIN_SCANS, score_min_nat=0, pd=PD)
    settings.sensor(1, pd=PD, **({"range_rate_span_mps": case.span_mps} if case.span_mps else {}))
    rows = sky.told(case)
    scans = rhotrack.Scans(rows[rows["scan"] <= WINDOW], settings)
    initiator = rhotrack.Initiator(settings)
    start = time.thread_time()
    found = initiator.find(scans)
    search_ms = 1e3 * (time.thread_time() - start)
    errors_m = []
    for target in sky.targets:
        # the mean distance over the window; targets are tens of kilometres apart
        off_m = np.mean([np.hypot(
            found["x_m"] + found["vx_mps"] * (t_s - found["t_s"]) - x_m,
            found["y_m"] + found["vy_mps"] * (t_s - found["t_s"]) - y_m)
            for t_s in TURN_S * np.arange(WINDOW) for x_m, y_m in [sky.place_m(target, t_s)]],
            axis=0)
        if len(off_m) and off_m.min() <= TOLERANCE_M:
            errors_m.append(off_m.min())
    return {"found": len(errors_m), "oracle": sum(oracle_finds(case, sky, target)
                                                  for target in sky.targets),
            "false_candidates": len(found) - len(errors_m), "found_m": sum(errors_m),
            "search_ms": search_ms}


def oracle_finds(case, sky, target):
    """A plot of each turn: a target at the turn's border may be seen twice."""
    own = [turn[turn["target_id"] == target][:1] for turn in sky.turns[:WINDOW]]
    own = np.concatenate(own)
    if len(own) < MIN_SCANS:
        return False
    fit = polar_references.fit(own, sky.radar(case), sky.reckoned)
    speed_mps = math.hypot(*fit.state[2:])
    return fit.score_nat >= 0 and sky.reckoned.v_min_mps <= speed_mps <= sky.reckoned.v_max_mps


# --- tracks over all turns


class Shadow:
    """A track's plots, whose they are, and the reference filter through them."""

    def __init__(self, case, sky):
        self.case, self.sky = case, sky
        self.targets = []  # of the plots since the start
        self.filter, self.is_confirmed = None, False
        accel_mps2 = 0.5 * sky.settings["accel_max_mps2"]  # src/DESIGN.md: kept up for a second
        self.noise_density = accel_mps2**2

    def take(self, turn, plot, hits):
        """plot: row of the turn, -1: none. hits: plots of the start, its newest one included; those
        before are taken to be the same target's."""
        if plot >= 0:
            row = self.sky.turns[turn][plot]
            self.targets.append(int(row["target_id"]))
            rows = [row]
            if self.filter is None and row["target_id"] >= 0:
                earlier = [of[of["target_id"] == row["target_id"]][:1]
                           for of in self.sky.turns[max(0, turn - WINDOW + 1):turn]]
                earlier = [one[0] for one in earlier if len(one)]
                rows = earlier[len(earlier) - hits + 1:] + rows if hits > 1 else rows
            for one in rows:
                self._filter(one)
        elif self.filter:
            self.filter.predict(TURN_S * turn, self.noise_density)

    def _filter(self, row):
        if self.filter is None:
            self.filter = polar_references.Filter(row, self.sky.radar(self.case),
                                                  self.sky.settings["v_max_mps"])
        else:
            self.filter.predict(float(row["t_s"]), self.noise_density)
            self.filter.update(row)

    @property
    def target(self):
        """Of more than half of the plots; -1: none."""
        ids, counts = np.unique(self.targets, return_counts=True)
        return int(ids[counts.argmax()]) if len(ids) and 2 * counts.max() > counts.sum() else -1


def follow(case, sky):
    """Targets tracked after PROMPT turns and at the end, when they were confirmed, false tracks,
    and sums of squared errors by turn: of places, along the line of sight, of the reference's
    places, of velocities."""
    settings = sky.settings.copy()
    if case.span_mps:
        settings.sensor(1, range_rate_span_mps=case.span_mps)
    tracks = rhotrack.Tracker(settings).run(rhotrack.Scans(sky.told(case), settings))
    turn_of = np.rint(tracks["t_s"] / TURN_S).astype(int)
    sums, shadows, confirmed_at = np.zeros((len(sky.turns), 5)), {}, []
    tracked = {}
    for turn in range(len(sky.turns)):
        now = set()
        t_s = TURN_S * turn
        for track in tracks[turn_of == turn]:
            shadow = shadows.setdefault(int(track["track_id"]), Shadow(case, sky))
            shadow.take(turn, int(track["plot"]), int(track["hits"]))
            if track["status"] == "tentative":
                continue
            target = shadow.target
            if not shadow.is_confirmed:
                shadow.is_confirmed = True
                confirmed_at += [turn + 1] if target >= 0 else []
            if target >= 0:
                now.add(target)
                truth_m, sight = sky.place_m(target, t_s), sky.place_m(target, t_s)
                off_m = np.array([track["x_m"], track["y_m"]], float) - truth_m
                off_mps = np.array([track["vx_mps"], track["vy_mps"]],
                                   float) - sky.velocity_mps[target]
                state, _ = shadow.filter.at(t_s, shadow.noise_density)
                sums[turn] += [off_m @ off_m, (off_m @ sight)**2 / (sight @ sight),
                               ((state[:2] - truth_m)**2).sum(), off_mps @ off_mps, 1]
        tracked[turn + 1] = len(now)
    return {"prompt": tracked[PROMPT], "tracked": tracked[len(sky.turns)],
            "false_tracks": sum(one.is_confirmed and one.target < 0 for one in shadows.values()),
            "confirm_at": sum(confirmed_at), "confirmed": len(confirmed_at), "errors": sums}


# --- all runs


def measure(case, sky):
    return {"targets": len(sky.targets), **search(case, sky), **follow(case, sky)}


def figures_of(runs):
    """Over the runs of one case: shares, means, root mean squares; what a bar judges or a run counts
    as (value, standard error)."""
    total = {key: sum(run[key] for run in runs) for key in runs[0]}
    sums = np.array([run["errors"].sum(axis=0) for run in runs]).T
    rms = [lab.root_of(*lab.ratio_of(one, sums[4])) for one in sums[:4]]
    return {
        "targets": total["targets"], "pd": total["found"] / total["targets"],
        "oracle_pd": total["oracle"] / total["targets"],
        "pd_behind_oracle": lab.ratio_of([run["oracle"] - run["found"] for run in runs],
                                         [run["targets"] for run in runs]),
        "false_candidates_per_run": lab.mean_of([run["false_candidates"] for run in runs]),
        "candidate_error_m": total["found_m"] / max(1, total["found"]),
        "search_ms": total["search_ms"] / len(runs),
        "tracked_after_5": total["prompt"] / total["targets"],
        "tracked_at_end": total["tracked"] / total["targets"],
        "confirmed_at_turn": total["confirm_at"] / max(1, total["confirmed"]),
        "false_tracks_per_run": lab.mean_of([run["false_tracks"] for run in runs]),
        "rmse_m": rms[0], "along_rmse_m": rms[1], "double_filter_rmse_m": rms[2],
        "rmse_mps": rms[3], "over_double_filter": lab.root_of(*lab.ratio_of(sums[0], sums[2])),
        "errors": total["errors"]}


def run(job):
    seed, clutter = job
    sky = Sky(scene_runs.simulate("polar", seed, f"radars.0.sigma_range_rate_mps={SIGMA_RANGE_RATE_MPS}",
                                  f"clutter.0.plots={clutter}"), clutter)
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
    sky = Sky(scene_runs.simulate("polar", report.options.seed, "radars.0.pd=1",
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
    options = lab.options_of(__doc__, RUNS)
    report = lab.Report("A turning radar, 15 m and 3 mrad, 4 s a turn", options)
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
    report.text("A batch of seven turns, at least five plots, score at least 0. The clairvoyant fit "
                "knows which plots are the target's, and the clutter's true density.")
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


def facts(figures):
    """For JSON: without the list by turn."""
    return lab.values_of({key: value for key, value in figures.items() if key != "errors"})


if __name__ == "__main__":
    main()
