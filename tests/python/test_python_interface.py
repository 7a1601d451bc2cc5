# SPDX-License-Identifier: MIT
"""The package by itself: arrays and frames in, errors that name what is wrong, files, parts."""
import math
import multiprocessing
import os
import struct
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

import rhotrack

PROGRAM = os.environ.get("RHOTRACK")
SETTINGS = {"sigma_m": 20, "v_max_mps": 300}


def scan(time_s, *places, **fields):
    rows = np.zeros(len(places), [("t_s", "f8"), ("sensor_id", "i4"), ("x_m", "f4"), ("y_m", "f4"),
                                  *[(name, "f4") for name in fields]])
    rows["t_s"], rows["sensor_id"] = time_s, 1
    rows["x_m"], rows["y_m"] = np.transpose(places)
    for name, values in fields.items():
        rows[name] = values
    return rows


COLUMNS = {"t_s": [0.0, 0.0], "sensor_id": [1, 1], "x_m": [1.0, 2.0], "y_m": [3.0, 4.0]}


def one_target(count=20):
    clutter = np.random.default_rng(1).uniform(-2e4, 2e4, (count, 2))
    return [scan(4 * i, (1000 + 400 * i, 2000), clutter[i]) for i in range(count)]


@pytest.fixture
def scene(tmp_path):
    if not PROGRAM:
        pytest.skip("RHOTRACK names no program")

    def make(name, *options):
        subprocess.run([PROGRAM, "simulate", name, "--seed", "3", *options, "-o", tmp_path / "in"],
                       check=True, capture_output=True)
        return tmp_path / "in"
    return make


# ---- Settings ----

def test_settings_have_the_programs_names_and_ranges():
    settings = rhotrack.Settings(sigma_m=5, gate="nearest", planes="xy+yz")
    assert settings.sigma_m == 5 and settings["gate"] == "nearest" and settings.pd == 0.9
    assert settings.area_x_min_m is None
    assert repr(settings) == "Settings(sigma_m=5.0, gate='nearest', planes='xy+yz')"
    assert rhotrack.parameters()["pd"]["max"] == 0.999
    assert "sigma_m" in dir(settings)
    other = settings.copy(sigma_m=6)
    assert (settings.sigma_m, other.sigma_m) == (5, 6)


@pytest.mark.parametrize("given, told", [
    ({"sigma_m": -1}, "sigma_m"), ({"sigma": 1}, "sigma"), ({"gate": "best "}, "gate"),
    ({"v_max_mps": math.nan}, "v_max_mps"), ({"v_min_mps": 400, "v_max_mps": 300}, "v_min_mps"),
    ({"sensor.1.pd": 2}, "pd")])
def test_a_wrong_parameter_is_named(given, told):
    with pytest.raises(rhotrack.Error, match=told):
        rhotrack.Settings(**given)


def test_an_ini_file_is_read_and_its_line_named(tmp_path):
    path = tmp_path / "radar.ini"
    path.write_text("sigma_m = 7\n[sensor 2]\npd = 0.5\n")
    assert rhotrack.Settings(path).sigma_m == 7
    assert rhotrack.Settings(path, sigma_m=8).sigma_m == 8
    path.write_text("sigma_m = 7\nnonsense = 1\n")
    with pytest.raises(rhotrack.Error, match=r"radar.ini:2: .*nonsense"):
        rhotrack.Settings(path)
    with pytest.raises(rhotrack.Error, match="no such|No such"):
        rhotrack.Settings(tmp_path / "none.ini")


# ---- The tracker ----

def test_step_and_run_are_the_same():
    tracker, scans = rhotrack.Tracker(**SETTINGS), one_target()
    stepped = np.concatenate([tracker.step(one) for one in scans])
    run = rhotrack.Tracker(**SETTINGS).run(scans)
    np.testing.assert_array_equal(stepped, run)
    last = run[(run["t_s"] == 76) & (run["status"] == "confirmed")]
    assert len(last) == 1 and abs(last["x_m"][0] - 8600) < 30 and abs(last["vx_mps"][0] - 100) < 5
    assert tracker.fates[0] == "claimed" and tracker.counters["tracks_confirmed"] == 1
    assert tracker.counters["fates"]["claimed"] > 10 and tracker.work["work"] > 0
    assert rhotrack.Tracker(covariance=True, **SETTINGS).run(scans)["cov_x_x"].min() > 0


def test_rates_of_lives_are_learned():
    tracker = rhotrack.Tracker(**SETTINGS)
    at_first = tracker.life
    assert at_first == {"death_rate": pytest.approx(0.005), "hide_rate": pytest.approx(0.005),
                        "appear_rate": pytest.approx(1 / 3.5), "lived_scans": 0}
    tracker.run(one_target(100))
    learned = tracker.life
    assert learned["lived_scans"] > 50 and learned["death_rate"] < at_first["death_rate"]
    assert learned["appear_rate"] == at_first["appear_rate"]


def test_hits_that_start_a_track():
    tracker, strict = rhotrack.Tracker(**SETTINGS), rhotrack.Tracker(min_scans=5, **SETTINGS)
    assert tracker.min_scans == 0
    tracker.run(one_target())
    strict.run(one_target())
    assert (tracker.min_scans, strict.min_scans) == (3, 5)


def test_a_scan_that_saw_nothing_counts_as_a_miss():
    run = rhotrack.Tracker(**SETTINGS).run([*one_target(), scan(80, (np.nan, np.nan))])
    last = run[run["t_s"] == 80]
    assert last["status"].tolist() == ["coasting"] and last["misses"].tolist() == [1]


def polar_targets():
    """A target as sensor 7 sees it from x 500 m."""
    fields = [("t_s", "f8"), ("sensor_id", "i4"), ("sensor_x_m", "f4"), ("sensor_y_m", "f4"),
              ("sensor_z_m", "f4"), ("range_m", "f4"), ("azimuth_rad", "f4")]
    places = [(500 + 400 * i, 2000) for i in range(20)]
    return [
        np.array([(4.0 * i, 7, 500, 0, 0, math.hypot(*place), math.atan2(*place[::-1]))], fields)
        for i, place in enumerate(places)]


def test_polar_rows_are_the_same_track():
    polar = [np.array([(one["t_s"][0], 1, math.hypot(*place), math.atan2(place[1], place[0]), 10)],
                      [("t_s", "f8"), ("sensor_id", "i4"), ("range_m", "f4"),
                       ("azimuth_rad", "f4"), ("sigma_range_m", "f4")])
             for one in one_target() for place in [(one["x_m"][0], one["y_m"][0])]]
    run = rhotrack.Tracker(**SETTINGS).run(polar)
    assert run["status"][-1] == "confirmed" and abs(run["x_m"][-1] - 8600) < 40
    compass = [np.array([(*one.item()[:3], 90 - math.degrees(one["azimuth_rad"][0]))],
                        [("t_s", "f8"), ("sensor_id", "i4"), ("range_m", "f4"),
                         ("azimuth_deg", "f8")]) for one in polar]
    again = rhotrack.Tracker(**SETTINGS).run(compass)
    np.testing.assert_allclose(again["x_m"], run["x_m"], atol=5)


def test_rows_that_go_back_in_time_are_named_and_scans_are_late():
    scans = one_target()
    with pytest.raises(rhotrack.Error, match="row 2: t_s 0.0 is before 4.0: sort the rows"):
        rhotrack.Tracker().run(np.concatenate([scans[1], scans[0]]))
    tracker = rhotrack.Tracker()
    tracker.run([scans[1], scans[0]])
    assert tracker.counters["scans_retrodicted"] == 1


def test_dictionaries_of_columns_and_rows_are_the_same():
    rows = [dict(zip(COLUMNS, row)) for row in zip(*COLUMNS.values())]
    for data in (COLUMNS, rows):
        found = rhotrack.Scans(data)
        assert len(found) == 1 and found[0]["y_m"].tolist() == [3, 4]


@pytest.mark.parametrize("given", ["radar.ini", {"sigma_m": 5}])
def test_settings_of_another_type_are_named(given):
    with pytest.raises(rhotrack.Error, match="settings: .* not (str|dict)"):
        rhotrack.Tracker(given)


def test_presets_are_those_of_the_header():
    marine = rhotrack.Settings.preset("marine", pd=0.7)
    assert (marine.sigma_azimuth_rad, marine.v_max_mps, marine.pd) == (0.009, 50, 0.7)
    assert rhotrack.Settings.preset("approach").v_min_mps == 20
    with pytest.raises(rhotrack.Error, match="preset 'ship' is none of en_route"):
        rhotrack.Settings.preset("ship")


@pytest.mark.parametrize("make, told", [
    (lambda: scan(0, (1, 2))[["t_s", "x_m", "y_m"]], "sensor_id"),
    (lambda: scan(0, (1, 2))[["t_s", "sensor_id", "y_m"]], "x_m"),
    (lambda: scan(np.nan, (1, 2)), "t_s"),
    (lambda: scan(0, (1, 2), sigma_m=-1.0), "scan 0, row 0: .*sigma"),
    (lambda: scan(0, (1, 2), (3, 4), z_m=[5, np.nan]), "row 1: z_m"),
    (lambda: scan(0, (1, 2))[:0], "no row"),
    (lambda: scan(0, (1, np.nan)), "scan 0, row 0: y_m is missing"),
    (lambda: scan(0, (1, 3e6)), r"row 0: y_m 3e\+06 is outside"),
    (lambda: scan(0, (1, 2), range_m=[np.nan], sigma_m=[-3]), "sigma_m -3 is outside"),
    (lambda: scan(0, (1, 2)).astype([("t_s", "U9"), *scan(0, (1, 2)).dtype.descr[1:]]),
     "t_s: numbers are wanted, not <U9"),
    (lambda: {**COLUMNS, "sensor_id": [1.0, np.nan]}, "row 1: sensor_id nan"),
    (lambda: {**COLUMNS, "y_m": [1.0]}, "other lengths"),
    (lambda: rhotrack.Tracker(**SETTINGS).run(one_target()), "track_id"),
    (lambda: np.zeros(3), "named fields"),
    (lambda: 7, "int")])
def test_a_wrong_scan_is_named(make, told):
    with pytest.raises(rhotrack.Error, match=told):
        rhotrack.Tracker().step(make())


def test_frames_of_pandas_and_polars_go_both_ways():
    pandas, polars = pytest.importorskip("pandas"), pytest.importorskip("polars")
    scans = one_target()
    run = rhotrack.Tracker(**SETTINGS).run(scans)
    flat = np.concatenate(scans)
    for frame in (rhotrack.to_pandas(flat), rhotrack.to_polars(flat)):
        np.testing.assert_array_equal(rhotrack.Tracker(**SETTINGS).run(frame), run)
    assert isinstance(rhotrack.to_pandas(run), pandas.DataFrame)
    assert rhotrack.to_polars(run).filter(polars.col("status") == "confirmed").height > 10


# ---- A track alone ----

def test_tracks_alone_step_side_by_side_as_each_by_itself():
    clutter = np.random.default_rng(2).uniform(-60, 60, (2, 15, 2))
    runs = [[scan(i, (100.0 * i, 50.0 * run), (100 * i, 0) + clutter[run, i], z_m=[7, 7])
             for i in range(15)] for run in range(2)]
    both = rhotrack.Maintainer(tracks=2, covariance=True, **SETTINGS)
    rows = both.run([one for pair in zip(*runs) for one in pair], np.full(30, -18.0))
    for run in range(2):
        alone = rhotrack.Maintainer(covariance=True, **SETTINGS)
        stepped = []
        for i, one in enumerate(runs[run]):
            places, predicted = alone.predict(float(i))
            assert np.isnan(places).all() == (i == 0) and len(predicted) == (i > 0)
            stepped.append(alone.run([one], [-18.0]))
        for name in rows.dtype.names:
            if name != "track_id":
                np.testing.assert_array_equal(rows[run::2][name], np.concatenate(stepped)[name])
        assert both.hypotheses[run] == alone.hypotheses[0] >= 1
    assert rows["track_id"].tolist() == [1, 2] * 15 and both.refused.tolist() == [0, 0]
    places, predicted = both.predict(15.0)
    assert abs(places[0, 0] - 1500) < 60 and abs(predicted["x_m"][0] - 1500) < 60
    assert (predicted["cov_x_x"] > rows["cov_x_x"][-2:]).all()


def test_a_track_that_starts_again_leaves_its_neighbour_alone():
    """After a gap too long for any prediction."""
    gone = [scan(t_s, (100.0 * i, 0)) for i, t_s in enumerate((0, 1, 2, 1e6, 1e6 + 1, 1e6 + 2))]
    stays = [scan(i, (50.0 * i, 900), (50.0 * i, 960)) for i in range(6)]
    both = rhotrack.Maintainer(tracks=2, **SETTINGS)
    rows = both.run([one for pair in zip(gone, stays) for one in pair])
    for i, scans in enumerate((gone, stays)):
        alone = rhotrack.Maintainer(**SETTINGS)
        np.testing.assert_array_equal(rows[i::2]["x_m"], alone.run(scans)["x_m"])
        assert both.refused[i] == alone.refused[0] == (1 - i)


def test_a_density_of_clutter_that_is_told_decides():
    scans = [scan(i, (100 * i, 0)) for i in range(10)] + [scan(10, (1060, 60))]
    taken = [rhotrack.Maintainer(**SETTINGS).run(scans, density)["plot"][-1]
             for density in (-30.0, 10.0)]
    assert taken == [0, -1]


def test_a_gate_of_none_draws_from_its_seed():
    scans = [scan(0, (0, 0)), *(scan(i, *[(100 * i, y) for y in range(9)]) for i in range(1, 30))]
    a, b, other = (rhotrack.Maintainer(gate="none", seed=seed, **SETTINGS).run(scans)["plot"]
                   for seed in (3, 3, 4))
    assert (a == b).all() and (a != other).any() and set(a) > {0, 5, 8}


@pytest.mark.parametrize("make, told", [
    (lambda: rhotrack.Maintainer(tracks=0), "tracks"),
    (lambda: rhotrack.Maintainer().predict(math.nan), "t_s"),
    (lambda: rhotrack.Maintainer(gate="hough").step(scan(0, (1, 2))), "vx_mps"),
    (lambda: rhotrack.Maintainer(gate="hough", planes="xz").step(
        scan(0, (1, 2), vx_mps=1, vy_mps=1)), "planes"),
    (lambda: rhotrack.Scans(scan(0, (1, 2), (3, 4)), counts=[1]), "counts")])
def test_what_a_track_alone_cannot_take_is_named(make, told):
    with pytest.raises(rhotrack.Error, match=told):
        make()


def test_rows_are_divided_by_counts():
    rows = np.concatenate(one_target(5))
    scans = rhotrack.Scans(rows, counts=[2, 2, 4, 2])
    assert [len(one) for one in scans] == [2, 2, 4, 2]
    np.testing.assert_array_equal(scans.rows["x_m"], rows["x_m"])


@pytest.mark.parametrize("counts", [
    np.array([2, 9, 2, 9, 4, 9, 2, 9])[::2], np.array([2, 4, 2, 2], "i1")[::-1],
    np.array([2, 2, 4, 2], ">u4"), np.array([[2, 0], [2, 0], [4, 0], [2, 0]], "u4")[:, 0],
    np.array([2, 9, 2, 9, 4, 9, 2, 9], "u4")[::2], (2, 2, 4, 2)])
def test_counts_of_any_strides_and_type_are_their_numbers(counts):
    rows = np.concatenate(one_target(5))
    assert [len(one) for one in rhotrack.Scans(rows, counts=counts)] == [2, 2, 4, 2]


@pytest.mark.parametrize("counts, told", [
    ([2**32 + 4, 6], "scan 0 .* 4294967300 rows"), ([4, -2, 8], "scan 1 .* -2 rows"),
    (np.array([-4, 14], "i8"), "scan 0 .* -4 rows"), ([[4], [6]], r"shape \(2, 1\)"), (10, "shape"),
    ([4.5, 5.5], "float64"), ([4, np.nan], "float64"), ([4, None], "object"), (["10"], "<U2"),
    ([2**70, 6], "object"), ([True] * 10, "bool"), ([10, 1], "11 rows, and there are 10"),
    ([4, 4], "8 rows, and there are 10"), ([], "0 rows, and there are 10"),
    ([10, 0], "scan 1 has no row"), ([2**31, 2**31, 10], "scan 0")])
def test_wrong_counts_are_named(counts, told):
    with pytest.raises(rhotrack.Error, match=told):
        rhotrack.Scans(np.concatenate(one_target(5)), counts=counts)


def test_rows_in_the_layout_of_c_may_have_strides():
    bearings = two_sensors().rows
    rows = np.zeros(40, rhotrack.scans.ROW)
    for name in rows.dtype.names:
        rows[name] = 0 if name == "sensor_id" else np.nan
    for name in bearings.dtype.names:
        rows[name][::2] = bearings[name]
    expected = [len(one) for one in two_sensors()]
    for strided in (rows[::2], rows[::-1][1::2][::-1]):
        made = rhotrack.Scans(strided, counts=expected)
        np.testing.assert_array_equal(made.rows, bearings)
    np.testing.assert_array_equal(rhotrack.Scans([rows[:8:2]]).rows, bearings[:4])
    for make in (lambda: rhotrack.Scans(rows.reshape(10, 4), counts=[10]),
                 lambda: rhotrack.Scans(rows.reshape(10, 4)),
                 lambda: rhotrack.Tracker().step(rows.reshape(2, 20))):
        with pytest.raises(rhotrack.Error, match="one dimension"):
            make()


@pytest.mark.parametrize("wrong", [
    np.array([2**31], "u4"), np.array([-2**63], "i8"), np.array([1.5]), np.array([np.inf], "f4"),
    np.array([2**63], "u8")])
def test_a_sensor_id_beyond_32_bits_is_named(wrong):
    with pytest.raises(rhotrack.Error, match="sensor_id .* 32 bits"):
        rhotrack.Scans({"t_s": [0.0], "sensor_id": wrong, "x_m": [1.0], "y_m": [1.0]})


def test_no_array_with_strides_reaches_c():
    for array in (np.zeros(4, "u4")[::2], np.zeros(4, "u8"), np.zeros((2, 3), "u4").T):
        with pytest.raises(rhotrack.Error, match="strides"):
            rhotrack._core.pointer_to(array, "uint32_t *")
    for bearings in ([[0.1, 0.2], [0.3, 0.4]], np.zeros((1, 2))):
        with pytest.raises(rhotrack.Error, match="lists"):
            rhotrack.ghosts(bearings, [0.1], (0, 0), (1000, 0), 1e5)
    even = rhotrack.ghosts(np.array([1.2, 9, 1.0, 9])[::2], [1.8], (0, 0), (1000, 0), 1e5)
    np.testing.assert_array_equal(
        even.delta_rad, rhotrack.ghosts([1.2, 1.0], [1.8], (0, 0), (1000, 0), 1e5).delta_rad)


# ---- Threads ----

def many_plots(count=10):
    clutter = np.random.default_rng(2).uniform(-2e4, 2e4, (count, 40, 2))
    return rhotrack.Scans([scan(4 * i, (1000 + 400 * i, 2000), *clutter[i]) for i in range(count)])


def two_sensors(count=5):
    kind = [("t_s", "f8"), ("sensor_id", "i4"), ("sensor_x_m", "f4"), ("sensor_y_m", "f4"),
            ("bearing_rad", "f4")]
    return rhotrack.Scans([np.array([
        (4 * i, sensor, x, 0, math.atan2(20000, 500 * i + offset - x))
        for sensor, x in ((1, 0), (2, 8000)) for offset in (2000, 5000)], kind)
        for i in range(count)])


def moving():
    kalman = rhotrack.Kalman()
    for axis in (0, 1):
        kalman.open_axis(axis, 1000.0, 100.0, 1e4)
    return kalman


def told_of(one):
    return [one.counters, one.life, one.sensors, one.work, one.fates.tolist()]


USES = {
    "Tracker": (lambda: rhotrack.Tracker(**SETTINGS), lambda one, scans: one.run(scans), told_of),
    "Maintainer": (
        lambda: rhotrack.Maintainer(**SETTINGS), lambda one, scans: one.run(scans),
        lambda one: [one.hypotheses.tolist(), one.refused.tolist()]),
    "Node": (
        lambda: rhotrack.Node(**SETTINGS),
        lambda one, scans: [one.take("RHO_PLOTS", b"nonsense", 1.0), one.flush(), one.status()],
        lambda one: one.tracks.tolist()),
    "Initiator": (
        lambda: rhotrack.Initiator(**SETTINGS), lambda one, scans: one.find(scans),
        lambda one: {**one.work, "search_us": 0}),
    "ht": (
        lambda: rhotrack.Initiator(method="ht", d_rho_m=20000, **SETTINGS),
        lambda one, scans: one.find(scans), lambda one: {**one.work, "search_us": 0}),
    "Passive": (
        lambda: rhotrack.Passive(), lambda one, scans: one.find(two_sensors()),
        lambda one: one.claims.tolist()),
    "Kalman": (
        moving, lambda one, scans: one.update(0, 1000.0, 100.0), lambda one: one.state.tolist()),
    "Imm": (
        lambda: rhotrack.Imm(moving()), lambda one, scans: one.predict(0.01),
        lambda one: one.estimate.covariance.tolist()),
    "InputEstimation": (
        lambda: rhotrack.InputEstimation(moving()), lambda one, scans: one.predict(0.01),
        lambda one: one.estimate.covariance.tolist()),
}


def use_in_threads(make, use, tell, rounds):
    """Of a process of its own, which a fault would end: four threads leave what one would."""
    scans, alone, shared, faults = many_plots(), make(), make(), []

    def repeat(one, times):
        try:
            for _ in range(times):
                use(one, scans)
                tell(one)
        except Exception as error:
            faults.append(error)

    sys.setswitchinterval(1e-6)
    repeat(alone, 4 * rounds)
    threads = [threading.Thread(target=repeat, args=(shared, rounds)) for _ in range(4)]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    os._exit(0 if not faults and tell(alone) == tell(shared) else 3)


@pytest.mark.parametrize("name", USES)
def test_an_object_is_as_right_in_four_threads(name):
    rounds = 3000 if name in ("Kalman", "Imm", "InputEstimation") else 20
    process = multiprocessing.get_context("fork").Process(
        target=use_in_threads, args=(*USES[name], rounds))
    process.start()
    process.join(60)
    assert process.exitcode == 0


# ---- Files ----

def test_files_are_read_as_the_program_reads_them(scene, tmp_path):
    folder = scene("popup")
    settings = rhotrack.Settings(folder / "scenario.ini")
    scans = rhotrack.read(folder / "plots.csv", settings=settings)
    run = rhotrack.Tracker(settings).run(scans)
    subprocess.run([PROGRAM, "track", folder / "plots.csv", "--config", folder / "scenario.ini",
                    "-o", tmp_path / "tracks.csv"], check=True, capture_output=True)
    read = rhotrack.read(tmp_path / "tracks.csv")
    for name in read.dtype.names:
        np.testing.assert_array_equal(read[name], run[name], err_msg=name)
    truth = rhotrack.read(folder / "truth.csv")
    assert {"t_s", "target_id", "x_m", "y_m"} <= set(truth.dtype.names)
    subprocess.run([PROGRAM, "convert", folder / "truth.csv", tmp_path / "truth.lcm"], check=True)
    logged = rhotrack.read(tmp_path / "truth.lcm", kind="truth")
    np.testing.assert_array_equal(logged["x_m"], truth["x_m"])


def test_a_bad_file_is_named_with_its_line_and_left_closed(tmp_path):
    path = tmp_path / "bad.csv"
    path.write_text("t_s,sensor_id,x_m,y_m\n0,1,2,3\n1,1,2,much\n")
    before = len(os.listdir("/proc/self/fd"))
    for _ in range(50):
        with pytest.raises(rhotrack.Error, match=r"bad.csv:3: y_m .*much"):
            rhotrack.read(path)
    assert len(os.listdir("/proc/self/fd")) == before
    assert len(rhotrack.read(path, keep_going=True)) == 1


def test_a_file_of_csv_comes_back(tmp_path):
    rhotrack.write(tmp_path / "plots.csv", one_target())
    for one, again in zip(rhotrack.read(tmp_path / "plots.csv"), one_target()):
        np.testing.assert_array_equal(one["x_m"], again["x_m"])
    polar = polar_targets()
    rhotrack.write(tmp_path / "polar.csv", rhotrack.Scans(polar))
    back = rhotrack.read(tmp_path / "polar.csv")
    for one, made in zip(back, rhotrack.Scans(polar)):
        np.testing.assert_allclose(one["x_m"], made["x_m"], atol=0.1)
        np.testing.assert_allclose(one["sigma_cross_m"], made["sigma_cross_m"], rtol=1e-3)
    with pytest.raises(rhotrack.Error, match="plots.txt: one table"):
        rhotrack.write(tmp_path / "plots.txt", one_target())


def test_matlab_files_hold_plots_and_tracks(tmp_path):
    io, path = pytest.importorskip("scipy.io"), tmp_path / "day.mat"
    run = rhotrack.Tracker(**SETTINGS).run(one_target())
    rhotrack.write(path, one_target(), run)
    raw = io.loadmat(path)  # as MATLAB sees it: columns, and text as cells
    assert raw["plots"]["x_m"][0, 0].shape == (40, 1)
    assert raw["tracks"]["status"][0, 0][0, 0].item() == run["status"][0]
    np.testing.assert_array_equal(
        rhotrack.Tracker(**SETTINGS).run(rhotrack.read(path, **SETTINGS)), run)
    tracks = rhotrack.read(path, kind="tracks")
    for name in run.dtype.names:
        np.testing.assert_array_equal(tracks[name], run[name], err_msg=name)
    with pytest.raises(rhotrack.Error, match="day.mat: no struct .* holds truth"):
        rhotrack.read(path, kind="truth")


def test_matlab_structs_of_other_shapes_are_read(tmp_path):
    io = pytest.importorskip("scipy.io")
    columns = {name: np.array(column, float)[:, None] for name, column in COLUMNS.items()}
    rows = np.array([(0.0, 1.0, 1.0, 3.0), (0.0, 1.0, 2.0, 4.0)],
                    [(name, "O") for name in COLUMNS])
    for number, variables in enumerate([columns, {"detections": columns}, {"s": rows}]):
        io.savemat(tmp_path / f"{number}.mat", variables)
        assert rhotrack.read(tmp_path / f"{number}.mat")[0]["y_m"].tolist() == [3, 4]


def test_mcap_is_read_by_the_public_readers(tmp_path):
    reader = pytest.importorskip("mcap.reader")
    ros = pytest.importorskip("mcap_ros2.decoder").DecoderFactory()
    proto = pytest.importorskip("mcap_protobuf.decoder").DecoderFactory()
    path, scans = tmp_path / "day.mcap", polar_targets()
    run = rhotrack.Tracker(covariance=True, **SETTINGS).run(scans)
    rhotrack.write(path, scans, run)
    found = {}
    with open(path, "rb") as stream:
        for schema, channel, message, decoded in reader.make_reader(
                stream, decoder_factories=[ros, proto]).iter_decoded_messages():
            found.setdefault(schema.name, []).append((channel.topic, message.log_time, decoded))
    topic, time_ns, first = found["radar_msgs/msg/RadarScan"][0]
    assert topic == "/radar_7/scan" and first.header.frame_id == "radar_7" and time_ns == 0
    assert [one[2].returns[0].range for one in found["radar_msgs/msg/RadarScan"]] == [
        one["range_m"][0] for one in scans]
    topic, time_ns, last = found["radar_msgs/msg/RadarTracks"][-1]
    rows = run[run["t_s"] == time_ns / 1e9]
    assert topic == "/tracks" and len(last.tracks) == len(rows)
    assert last.tracks[0].position.x == rows["x_m"][0]
    assert last.tracks[0].position_covariance[:2] == [rows["cov_x_x"][0], rows["cov_y_x"][0]]
    place = found["foxglove.FrameTransform"][0][2]
    assert (place.child_frame_id, place.translation.x) == ("radar_7", 500)
    entities = [one for _, _, update in found["foxglove.SceneUpdate"] for one in update.entities]
    track = [one for one in entities if one.id == f"track {rows['track_id'][0]}"][-1]
    assert track.spheres[0].pose.position.x == track.lines[0].points[-1].x == rows["x_m"][0]
    seen = next(one for one in entities if one.id == "plots of 7")
    assert seen.frame_id == "radar_7" and seen.spheres[0].pose.position.x == pytest.approx(
        scans[0]["range_m"][0] * math.cos(scans[0]["azimuth_rad"][0]))


def test_mcap_comes_back(tmp_path):
    pytest.importorskip("mcap_ros2.decoder"), pytest.importorskip("mcap_protobuf.decoder")
    path, scans = tmp_path / "day.mcap", polar_targets()
    run = rhotrack.Tracker(**SETTINGS).run(scans)
    rhotrack.write(path, scans, run)
    read = rhotrack.read(path, **SETTINGS)
    assert len(read) == len(scans) and read[0]["sensor_id"][0] == 7
    np.testing.assert_array_equal(rhotrack.Tracker(**SETTINGS).run(read)["x_m"], run["x_m"])
    tracks = rhotrack.read(path, kind="tracks")
    for name in tracks.dtype.names:
        kept = np.testing.assert_array_equal if name[:3] != "sig" else np.testing.assert_allclose
        kept(tracks[name], run[name], err_msg=name)
    rhotrack.convert(path, tmp_path / "tracks.csv", kind="tracks")
    assert len(rhotrack.read(tmp_path / "tracks.csv")) == len(run)
    with pytest.raises(rhotrack.Error, match="t_s -1.0: times of MCAP"):
        rhotrack.write(path, [scan(-1, (1, 2))])


# ---- Initiation ----

def test_an_accumulator_holds_the_votes_that_find_returns():
    initiator = rhotrack.Initiator(method="iht", d_rho_m=200, d_theta_rad=0.05, eps_rho_m=400,
                                   eps_theta_rad=0.1, v_min_mps=50, v_max_mps=300)
    scans = one_target(7)
    found, plane = initiator.find(scans), initiator.accumulator(scans)
    assert plane.votes.shape == (len(plane.theta_rad), len(plane.rho_m))
    assert plane.votes.max() == found["score"][0] >= 6
    theta, rho = np.unravel_index(plane.votes.argmax(), plane.votes.shape)
    assert plane.rho_m[rho] == pytest.approx(found["rho_m"][0])
    assert plane.theta_rad[theta] == pytest.approx(found["theta_rad"][0])
    with pytest.raises(rhotrack.Error, match="method"):
        rhotrack.Initiator(method="hough")
    with pytest.raises(rhotrack.Error, match="accumulator"):
        rhotrack.Initiator().accumulator(scans)


@pytest.mark.parametrize("method", ["ht", "mht", "iht", "nht"])
def test_lines_are_those_of_find(method):
    initiator = rhotrack.Initiator(method=method, d_rho_m=200, d_theta_rad=0.05, eps_rho_m=400,
                                   eps_theta_rad=0.1, v_min_mps=50, v_max_mps=300)
    scans = one_target(7)
    found, lines = initiator.find(scans), initiator.lines(scans)
    assert len(lines) == len(found) == initiator.work["num_peaks"] > 0
    for name, other in (("rho_m", "rho_m"), ("theta_rad", "theta_rad"), ("votes", "score")):
        np.testing.assert_allclose(lines[name], found[other], atol=1e-6)
    assert initiator.work["votes"] > 0 and initiator.work["search_us"] > 0


def test_an_initiator_counts_the_work_of_each_search():
    scans = one_target(7)
    initiator = rhotrack.Initiator(min_scans=5, score_min_nat=-3, **SETTINGS)
    assert initiator.work == {}
    found, work = initiator.find(scans), initiator.work
    assert len(found) == 1 and work["seeds"] > 0 and work["window"]["lookups"] > 0
    again = rhotrack.Initiator(min_scans=5, score_min_nat=-3, **SETTINGS)
    again.find(scans[:3])
    assert len(again.find(scans)) == 1 and again.work["seeds"] == work["seeds"]
    with pytest.raises(rhotrack.Error, match="kernel"):
        initiator.lines(scans)


def test_a_tracker_tells_its_thresholds():
    tracker = rhotrack.Tracker(score_min_nat=2.5, min_scans=4, **SETTINGS)
    tracker.run(one_target(8))
    assert (tracker.min_scans, tracker.thresholds_nat) == (4, (2.5, 2.5))


def test_two_sensors_and_two_targets_have_two_ghosts():
    places, targets = [(0.0, 0.0), (20000.0, 0.0)], [(8000, 15000), (12000, 18000)]
    bearings = [[math.atan2(y - b, x - a) for x, y in targets] for a, b in places]
    matrix = rhotrack.ghosts(*bearings, *places, 60000.0, "none")
    assert matrix.delta_rad.shape == (2, 2) and (matrix.delta_rad.diagonal() > 0).all()
    rows = [(0.0, i + 1, *places[i], bearing) for i in range(2) for bearing in bearings[i]]
    frame = np.array(rows, [("t_s", "f8"), ("sensor_id", "i4"), ("sensor_x_m", "f4"),
                            ("sensor_y_m", "f4"), ("bearing_rad", "f4")])
    of_frame = rhotrack.Passive(prune="none").ghosts(frame)[1, 2]
    np.testing.assert_allclose(of_frame.delta_rad, matrix.delta_rad, atol=1e-6)
    assert (of_frame.reason == matrix.reason).all()
    crossings = np.stack([matrix.x_m.diagonal(), matrix.y_m.diagonal()], axis=1)
    np.testing.assert_allclose(crossings, targets, atol=1)


def test_bearings_have_elevations_in_rows_and_in_files(tmp_path):
    text = ("t_s,sensor_id,sensor_x_m,sensor_y_m,sensor_z_m,bearing_rad,elevation_rad\n"
            "0,1,0,0,12,0.5,0.25\n0,1,0,0,12,0.75,\n0,2,9000,0,0,1,-0.5\n")
    (tmp_path / "bearings.csv").write_text(text)
    settings = rhotrack.Settings(sigma_elevation_rad=0.125)
    scans = rhotrack.read(tmp_path / "bearings.csv", settings=settings)
    for frame in (scans[0], rhotrack.Scans(scans[:], settings)[0]):
        np.testing.assert_array_equal(frame["elevation_rad"], np.float32([0.25, np.nan, -0.5]))
        np.testing.assert_array_equal(frame["sigma_elevation_rad"],
                                      np.float32([0.125, np.nan, 0.125]))
        np.testing.assert_array_equal(frame["sensor_z_m"], np.float32([12, 12, np.nan]))
    rows = scans[0].copy()
    rows["sigma_elevation_rad"] = np.nan
    made = rhotrack.Scans([rows], settings)[0]
    np.testing.assert_array_equal(made["sigma_elevation_rad"], scans[0]["sigma_elevation_rad"])
    rows["sensor_z_m"] = 3e6
    with pytest.raises(rhotrack.Error, match="are not a place"):
        rhotrack.Scans([rows], settings)


def test_the_papers_lines_are_where_all_pairs_of_sensors_vote(scene):
    folder = scene("passive-three")
    settings = rhotrack.Settings(folder / "scenario.ini")
    frames = rhotrack.read(folder / "bearings.csv", settings=settings)
    paper = rhotrack.Passive(settings, method="passive-paper")
    planes = paper.accumulators(frames[-8:])
    assert len(planes) == 3
    middle = np.mean([[row["sensor_x_m"], row["sensor_y_m"]] for row in np.unique(
        frames[0][["sensor_id", "sensor_x_m", "sensor_y_m"]])], axis=0)
    for line in paper.find(frames):
        votes = []
        for plane in planes.values():
            rho = line["rho_m"] - middle @ [np.cos(line["theta_rad"]), np.sin(line["theta_rad"])]
            i = np.abs(plane.theta_rad - line["theta_rad"]).argmin()
            j = np.abs(plane.rho_m - rho).argmin()
            votes.append(plane.votes[i - 1:i + 2, j - 1:j + 2].max())
        assert min(votes) == line["score"]


def test_a_tracks_covariance_is_that_of_the_bearings_it_claims(scene):
    folder = scene("passive-three")
    settings = rhotrack.Settings(folder / "scenario.ini")
    frames = rhotrack.read(folder / "bearings.csv", settings=settings)[-8:]
    passive = rhotrack.Passive(settings)
    tracks = passive.find(frames)
    assert len(tracks) == 2 and passive.claims.shape == (2, 8, 3)
    for track, claims, covariance in zip(tracks, passive.claims, passive.covariances):
        information = np.zeros((4, 4))
        for k, i in np.argwhere(claims >= 0):
            look = frames[k][frames[k]["sensor_id"] == i + 1]
            row = look[~np.isnan(look["bearing_rad"])][claims[k, i]]
            dt = row["t_s"] - track["t_s"]
            dx = track["x_m"] + dt * track["vx_mps"] - row["sensor_x_m"]
            dy = track["y_m"] + dt * track["vy_mps"] - row["sensor_y_m"]
            assert abs(math.atan2(dy, dx) - row["bearing_rad"]) < 5 * row["sigma_rad"]
            by_state = np.array([-dy, dx, -dt * dy, dt * dx]) / (dx**2 + dy**2)
            information += np.outer(by_state, by_state) / row["sigma_rad"]**2
        np.testing.assert_allclose(covariance, covariance.T)
        np.testing.assert_allclose(covariance @ information, np.eye(4), atol=0.1)
    with pytest.raises(rhotrack.Error, match="passive-paper"):
        rhotrack.Passive(settings, "passive-paper").claims


def test_rows_of_many_frames_are_split_into_frames(scene):
    folder = scene("passive-three")
    settings = rhotrack.Settings(folder / "scenario.ini")
    frames = rhotrack.read(folder / "bearings.csv", settings=settings)
    np.testing.assert_array_equal(rhotrack.Tracker(settings).run(frames.rows),
                                  rhotrack.Tracker(settings).run(frames))


# ---- Filters ----

def reference_filter(places, dt_s, density, variance, speed_variance):
    """A plain Kalman filter of x, y, vx, vy in double precision."""
    f, h = np.eye(4), np.eye(2, 4)
    f[:2, 2:] = dt_s * np.eye(2)
    one = density * np.array([[dt_s**3 / 3, dt_s**2 / 2], [dt_s**2 / 2, dt_s]])
    q = np.kron(one, np.eye(2))
    x, p = np.array([*places[0], 0, 0]), np.diag([variance] * 2 + [speed_variance] * 2)
    for place in places[1:]:
        x, p = f @ x, f @ p @ f.T + q
        gain = p @ h.T @ np.linalg.inv(h @ p @ h.T + variance * np.eye(2))
        x, p = x + gain @ (place - h @ x), p - gain @ h @ p
    return x, p


def test_kalman_is_the_textbooks():
    places = np.array([(100 * i, 50 - 20 * i) for i in range(10)], float)
    kalman = rhotrack.Kalman()
    for axis in (0, 1):
        kalman.open_axis(axis, places[0][axis], 400, 1e4)
    for i, place in enumerate(places[1:], 1):
        kalman.predict(2.0, 4.0)
        kalman.update_plot(scan(2.0 * i, place, sigma_m=20.0), 1e4)
    x, p = reference_filter(places, 2.0, 4.0, 400, 1e4)
    kept = [0, 1, 3, 4]
    np.testing.assert_allclose(kalman.state[kept], x, rtol=1e-4)
    np.testing.assert_allclose(kalman.covariance[np.ix_(kept, kept)], p, rtol=1e-3, atol=1e-2)
    with pytest.raises(rhotrack.Error, match="dt_s"):
        kalman.predict(math.nan)


def started(position=(0.0, 0.0)):
    kalman = rhotrack.Kalman()
    for axis in (0, 1):
        kalman.open_axis(axis, position[axis], 100, 1e4)
    return kalman


def test_imm_sees_a_turn():
    imm, probabilities = rhotrack.Imm(started(), 30, 300), []
    for i in range(1, 25):
        angle = max(0, i - 12) * 0.2
        imm.predict(2.0)
        place = (400 * min(i, 12) + 2000 * math.sin(angle), 2000 * (1 - math.cos(angle)))
        assert imm.update(scan(2.0 * i, place, sigma_m=10.0)) is not None
        probabilities.append(imm.maneuver_probability)
    assert probabilities[11] < 0.3 and probabilities[-1] > 0.6
    assert np.linalg.norm(imm.accel_mps2) > 10 and imm.estimate.state.shape == (6,)
    assert imm.update(scan(48, (1e6, 1e6), sigma_m=10.0)) is None


def test_input_estimation_finds_an_acceleration():
    inputs = rhotrack.InputEstimation(started(), model="physical", noise_m=0.1, noise_mps=0.1)
    for i in range(1, 30):
        acceleration = 10.0 * (i > 10)
        speed = 100 + acceleration * (i - 10)
        inputs.predict(1.0)
        inputs.update(0, 100 * i + acceleration * (i - 10)**2 / 2, 100)
        inputs.update(1, 0.0, 100)
        inputs.update(3, speed, 1)
        inputs.decide()
    assert inputs.is_present.tolist() == [True, False, False]
    assert inputs.input_mps2[0] == pytest.approx(10, abs=1)
    with pytest.raises(rhotrack.Error, match="forgetting"):
        rhotrack.InputEstimation(started(), forgetting=1)


def test_the_hough_gate_prefers_the_straight_line():
    gate = rhotrack.HoughGate((100, 50, 0), (110, 60, 0), planes="xy")
    residuals = gate.residuals_mps([(120, 70, 0), (120, 20, 0), (60, 70, 0)])
    assert residuals.argmin() == 0 and residuals.shape == (3,)


# ---- Node and pictures ----

def events(log):
    at = 0
    while at < len(log):
        _, _, time_us, channel, size = struct.unpack_from(">IqqII", log, at)
        start = at + 28 + channel
        yield log[at + 28:start].decode(), log[start:start + size], time_us / 1e6
        at = start + size


def test_a_node_tracks_messages(scene, tmp_path):
    folder = scene("popup")
    subprocess.run([PROGRAM, "convert", folder / "plots.csv", tmp_path / "in.lcm",
                    "--config", folder / "scenario.ini"], check=True, capture_output=True)
    node, sent = rhotrack.Node(rhotrack.Settings(folder / "scenario.ini")), []
    for channel, data, now_s in events((tmp_path / "in.lcm").read_bytes()):
        sent += node.take(channel, data, now_s)
    sent += node.flush()
    assert node.due_s == math.inf and node.tick(1e9) == []
    scans = rhotrack.read(folder / "plots.csv", settings=node.settings)
    assert sum(channel == "RHO_TRACKS" for channel, _ in sent) == len(scans)
    run = rhotrack.Tracker(node.settings).run(scans)
    last = run[run["t_s"] == run["t_s"].max()]
    np.testing.assert_array_equal(node.tracks["x_m"], last["x_m"])
    assert {"RHO_STATUS", "RHO_LIFE"} <= set(dict(node.status()))


def test_bodies_are_columns_and_messages(scene, tmp_path):
    folder = scene("trucks", "--set", "duration_s=5")
    settings = rhotrack.Settings(folder / "scenario.ini")
    scans = rhotrack.read(folder / "plots.csv", settings=settings)
    run = rhotrack.Tracker(settings).run(scans)
    last = run[run["t_s"] == run["t_s"].max()]
    known = last[~np.isnan(last["length_m"])]
    assert len(known) >= 3 and np.all(known["length_m"] < 20)
    subprocess.run([PROGRAM, "convert", folder / "plots.csv", tmp_path / "in.lcm",
                    "--config", folder / "scenario.ini"], check=True, capture_output=True)
    node, sent = rhotrack.Node(settings), []
    for channel, data, now_s in events((tmp_path / "in.lcm").read_bytes()):
        sent += node.take(channel, data, now_s)
    sent += node.flush()
    np.testing.assert_array_equal(node.tracks["length_m"], last["length_m"])
    lists = [data for channel, data in sent if channel == "RHO_BODIES"]
    assert len(lists) >= len(scans)  # in parts where they are many
    utime, _, epoch, part, num_parts, count = struct.unpack_from(">qiihhh", lists[-1], 8)
    assert (round(last["t_s"][0] * 1e6), 1, num_parts - 1) == (utime, epoch, part)
    for row, one in zip(known[-count:], struct.iter_unpack(">i13f", lists[-1][30:])):
        assert one[0] == row["track_id"]
        assert one[1:3] == one[3:5] == (row["x_m"], row["y_m"])
        assert one[5:13] == tuple(row[name] for name in (
            "length_m", "width_m", "heading_rad", "sigma_length_m", "sigma_width_m",
            "sigma_heading_rad", "sigma_along_m", "sigma_across_m"))
    assert "length_m" not in rhotrack.Tracker(settings, body_max_m=0).run(scans).dtype.names


def test_walls_are_learned(scene):
    folder = scene("guard-rail", "--set", "reflectors.0.is_told=false", "--set", "duration_s=25")
    tracker = rhotrack.Tracker(rhotrack.Settings(folder / "scenario.ini"))
    assert tracker.learned_reflectors.shape == (0, 4)
    tracker.run(rhotrack.read(folder / "plots.csv", settings=tracker.settings))
    assert tracker.learned_reflectors.shape == (1, 4)
    np.testing.assert_allclose(tracker.learned_reflectors[0, 1::2], 14, atol=0.5)
    off = rhotrack.Tracker(tracker.settings, learn_reflectors=0)
    off.run(rhotrack.read(folder / "plots.csv", settings=tracker.settings))
    assert off.learned_reflectors.shape == (0, 4)


def test_a_picture_shows_plots_and_confirmed_tracks(scene):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    folder = scene("passive-three")
    settings = rhotrack.Settings(folder / "scenario.ini")
    frames = rhotrack.read(folder / "bearings.csv", settings=settings)
    run = rhotrack.Tracker(settings).run(frames)
    axes = rhotrack.plot(frames, run, rhotrack.read(folder / "truth.csv"))
    _, labels = axes.get_legend_handles_labels()
    assert {"bearings", "sensors", "truth", "track"} <= set(labels)
    matplotlib.pyplot.close()
    axes = rhotrack.plot(one_target(), rhotrack.Tracker(**SETTINGS).run(one_target()))
    assert len(axes.lines) == 2 and len(axes.lines[0].get_xdata()) == 40


def test_a_notebook_shows_scans_and_tracks():
    pytest.importorskip("matplotlib")
    run = rhotrack.Tracker(**SETTINGS).run(one_target())
    shown = run._repr_html_()
    assert "data:image/png" in shown and f"<td>{run['x_m'][-1]:.1f}</td>" in shown
    assert run[:0]._repr_html_() is None and type(run["x_m"]) is np.ndarray
    assert rhotrack.Scans(one_target())._repr_png_().startswith(b"\x89PNG")


def test_the_package_is_typed():
    assert Path(rhotrack.__file__).with_name("py.typed").is_file()
    undocumented = [name for name in rhotrack.__all__ if not getattr(rhotrack, name).__doc__]
    assert not undocumented
