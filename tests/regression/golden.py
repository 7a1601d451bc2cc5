#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Golden files of the whole chain: every output of the program, case by case, as it was.

Usage: golden.py [--update] [CASE...]

A case is a list of commands, run in a folder of its own. golden/CASE.json holds for each command
the sha256 of every file that it writes and of its standard output, what it says on standard error,
and the figures of its JSON reports. Times, memory and what else differs from run to run is taken
out before. Without --update a difference is a failure, which names case, command, output and the
figures that moved (old -> new). --update writes the files anew, and prints the same differences:
they belong into the message of the commit.

gnuplot is replaced by a script that copies its input: a hash of a picture is one of what is drawn,
whichever gnuplot there is, or none.
"""
import csv
import hashlib
import json
import math
import os
import random
import re
import shlex
import struct
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
GOLDEN = HERE / "golden"
PROGRAM = str(Path(os.environ.get("RHOTRACK", ROOT / "build/rhotrack")).resolve())

# ---- cases ----

# Scenes that cost more than a second are cut short.
SHORTER = {
    "births-and-deaths": 1200, "rain": 160, "range-24ghz": 30, "traffic": 240,
    "turning-start": 80, "two-radars": 240,
}
JUDGED = {"range-24ghz": "--set gospa_cutoff_m=5", "ships": "--set gospa_cutoff_m=500"}


def scene_case(name):
    """What ships: simulated, tracked from all its files, and judged."""
    scene = json.loads(next((ROOT / "tools/scenes").glob(f"*/{name}.json")).read_text())
    inputs = " ".join(f"in/{file}.csv" for key, file in
                      (("radars", "plots"), ("passive", "bearings")) if key in scene)
    length = f" --set duration_s={SHORTER[name]}" if name in SHORTER else ""
    case = f"""
        simulate {name} --seed 3{length} -o in
        track {inputs} --config in/scenario.ini --covariance --json -o tracks.csv"""
    if scene.get("targets"):
        case += f"""
        evaluate in/truth.csv tracks.csv --json {JUDGED.get(name, "")}"""
    return case


def harbour_case(number):
    """A recording of a real radar."""
    folder = f"scenes/harbour/{number}"
    settings = "--set sigma_m=5 --set v_max_mps=12 --set accel_max_mps2=0.5"
    return f"""
        track {folder}/plots.csv {settings} --covariance --json -o tracks.csv
        evaluate {folder}/truth.csv tracks.csv --set gospa_cutoff_m=40 --json
        plot tracks {folder}/truth.csv tracks.csv -o tracks.svg
        calibrate {folder}/plots.csv {settings} --json -o learned.ini
        track {folder}/plots.csv {settings} --gate nearest --json -o nearest.csv
        track {folder}/plots.csv {settings} --config learned.ini --json -o told.csv
        evaluate {folder}/truth.csv told.csv --set gospa_cutoff_m=40 --json
        """


CASES = {
    "initiate": """
        simulate crossing --seed 3 -o in
        initiate in/plots.csv --config in/scenario.ini --json -o kernel.csv
        initiate in/plots.csv --method ht --json -o ht.csv
        initiate in/plots.csv --method ht --set vote=counts --set tau=0.8 --json -o counts.csv
        initiate in/plots.csv --method mht --json -o mht.csv
        initiate in/plots.csv --method iht --json -o iht.csv
        initiate in/plots.csv --method nht --json -o nht.csv
        initiate in/plots.csv --method nht --set nht_reading=a --json -o reading_a.csv
        initiate in/plots.csv --method nht --set nht_indeterminacy=1 --json -o indeterminate.csv
        initiate in/plots.csv --set work_max=2000 --json -o cut.csv
        initiate in/plots.csv --set scans=5 --set process_noise_mps2=3 --set turn_mps2=4 \
            --json -o bent.csv
        initiate in/plots.csv -o found.lcm
        plot parameter-space in/plots.csv -o space.svg
        simulate doppler --seed 3 -o doppler
        initiate doppler/plots.csv --config doppler/scenario.ini --json -o rates.csv
        """,
    "initiate-table3": """
        initiate vectors/radar-table3.csv --json -o kernel.csv
        initiate vectors/radar-table3.csv --method ht --json -o ht.csv
        initiate vectors/radar-table3.csv --method mht --json -o mht.csv
        initiate vectors/radar-table3.csv --method iht --json -o iht.csv
        initiate vectors/radar-table3.csv --method nht --set nht_reading=a --json -o nht.csv
        """,
    "initiate-passive": """
        simulate passive-three --seed 3 -o three
        initiate three/bearings.csv --config three/scenario.ini --json -o passive.csv
        initiate three/bearings.csv --config three/scenario.ini --method passive-paper \
            --json -o paper.csv
        simulate passive-clutter --seed 3 -o in
        initiate in/bearings.csv --config in/scenario.ini --json -o passive_clutter.csv
        initiate in/bearings.csv --config in/scenario.ini --method passive-paper \
            --json -o paper_clutter.csv
        initiate in/bearings.csv --config in/scenario.ini --set prune=literal --json -o literal.csv
        initiate in/bearings.csv --config in/scenario.ini --set prune=none --json -o none.csv
        track in/bearings.csv --config in/scenario.ini --set prune=literal --covariance \
            --json -o tracks.csv
        plot scans in/bearings.csv -o scans.svg
        """,
    "passive-full": """
        simulate passive-clutter --seed 5 --set targets.0.count=20 \
            --set passive.0.false_bearings=6 --set passive.1.false_bearings=6 -o two
        initiate two/bearings.csv --config two/scenario.ini --json -o two.csv
        simulate passive-three --seed 5 --set targets.0.count=16 \
            --set passive.0.false_bearings=4 --set passive.1.false_bearings=4 \
            --set passive.2.false_bearings=4 -o three
        initiate three/bearings.csv --config three/scenario.ini --json -o three.csv
        initiate three/bearings.csv --config three/scenario.ini --method passive-paper \
            --json -o paper.csv
        simulate passive-three --seed 6 --set targets.0.count=10 --set passive.0.sigma_rad=0.01 \
            --set passive.1.pd=0.7 --set passive.2.false_bearings=5 \
            --set passive.2.at_m.0=-40000 -o far
        initiate far/bearings.csv --config far/scenario.ini --json -o far.csv
        track far/bearings.csv --config far/scenario.ini --covariance --json -o tracks.csv
        """,
    "maintain": """
        simulate popup --seed 4 --set radars.0.sigma_mps=1 -o in
        maintain in/plots.csv --config in/scenario.ini --covariance --json -o best.csv
        evaluate in/truth.csv best.csv --json
        maintain in/plots.csv --config in/scenario.ini --gate hough --covariance --json -o hough.csv
        evaluate in/truth.csv hough.csv --json
        maintain in/plots.csv --config in/scenario.ini --gate hough --set planes=xz \
            --json -o plane.csv
        maintain in/plots.csv --config in/scenario.ini --gate nearest --covariance \
            --json -o nearest.csv
        evaluate in/truth.csv nearest.csv --json
        maintain in/plots.csv --config in/scenario.ini --gate nearest --no-input-estimation \
            --json -o plain.csv
        maintain in/plots.csv --config in/scenario.ini --gate nearest \
            --set input_model=physical --set gamma=0.9 --json -o physical.csv
        maintain in/plots.csv --config in/scenario.ini --gate none --seed 5 --json -o none.csv
        maintain in/plots.csv --config in/scenario.ini -o best.lcm
        maintain in/plots.csv --config in/scenario.ini --set origin_lat_deg=50 \
            --set origin_lon_deg=10 -o best.ast
        simulate weave --seed 4 -o weave
        maintain weave/plots.csv --config weave/scenario.ini --covariance --json -o weave.csv
        """,
    "track-gates": """
        simulate weave --seed 3 --set radars.0.sigma_mps=1 -o in
        track in/plots.csv --config in/scenario.ini --gate hough --covariance --json -o hough.csv
        track in/plots.csv --config in/scenario.ini --gate hough --set input_estimation=1 \
            --json -o estimated.csv
        track in/plots.csv --config in/scenario.ini --gate nearest --covariance \
            --json -o nearest.csv
        track in/plots.csv --config in/scenario.ini --gate nearest --set input_estimation=1 \
            --json -o input.csv
        track in/plots.csv --config in/scenario.ini --gate best --json -o best.csv
        evaluate in/truth.csv hough.csv --json
        evaluate in/truth.csv nearest.csv --json
        evaluate in/truth.csv best.csv --json
        simulate crossing-angle --seed 3 -o polar
        track polar/plots.csv --config polar/scenario.ini --gate nearest --json -o polar.csv
        """,
    "track-papers": """
        simulate crossing --seed 4 --set radars.0.sigma_m=0.3 --set duration_s=60 -o in
        track in/plots.csv --config in/scenario.ini --method ht --json -o ht.csv
        track in/plots.csv --config in/scenario.ini --method mht --json -o mht.csv
        track in/plots.csv --config in/scenario.ini --method iht --gate hough --json -o iht.csv
        track in/plots.csv --config in/scenario.ini --method nht --covariance --json -o nht.csv
        track in/plots.csv --config in/scenario.ini --pipeline paper --json -o paper.csv
        simulate passive-two --seed 2 --set duration_s=200 -o bearings
        track bearings/bearings.csv --config bearings/scenario.ini --pipeline paper --json \
            -o bearings.csv
        track bearings/bearings.csv --config bearings/scenario.ini --method passive-paper --json \
            -o best.csv
        """,
    "track-settings": """
        simulate towers --seed 5 --set duration_s=240 -o in
        track in/plots.csv --config in/scenario.ini --set work_max=300000 --json -o cut.csv
        track in/plots.csv --config in/scenario.ini --set false_tracks_per_hour=100 \
            --set scans=9 --json -o more.csv
        track in/plots.csv --config in/scenario.ini --set min_scans=5 --set scans=5 \
            --json -o of_five.csv
        track in/plots.csv --config in/scenario.ini --set score_min_nat=8 \
            --set coast_scans_max=2 --json -o score.csv
        track in/plots.csv --config in/scenario.ini --set steady_s=60 \
            --set process_noise_mps2=2 --json -o steady.csv
        track in/plots.csv --config in/scenario.ini --set learn_noise_max=1 \
            --set learn_noise_min=1 --set learn_pd_min=1 --json -o stated.csv
        track in/plots.csv --config in/scenario.ini --set turn_mps2=0 --set sensor.1.pd=0.6 \
            --json -o sensor.csv
        """,
    "work-limits": """
        simulate guard-rail --seed 3 --set duration_s=40 -o rail
        track rail/plots.csv --config rail/scenario.ini --set work_max=1200 --json -o rail.csv
        simulate split-plots --seed 3 --set duration_s=60 -o split
        track split/plots.csv --config split/scenario.ini --set work_max=6000 --json -o few.csv
        track split/plots.csv --config split/scenario.ini --set work_max=12000 --json -o more.csv
        track split/plots.csv --config split/scenario.ini --set work_max=30000 --json -o most.csv
        track split/plots.csv --config split/scenario.ini --set work_max=1000 --gate nearest \
            --json -o nearest.csv
        simulate rain --seed 3 --set duration_s=40 -o rain
        track rain/plots.csv --config rain/scenario.ini --set work_max=5000 --json -o rain.csv
        """,
    # What the shipped scenes do not reach: coarse bearings, plots that gates choose among, and
    # learning where little is seen.
    "seldom": """
        simulate passive-three --seed 7 --set targets.0.count=12 --set passive.0.pd=0.7 \
            --set passive.1.sigma_rad=0.02 --set passive.2.false_bearings=6 \
            --set duration_s=200 -o three
        track three/bearings.csv --config three/scenario.ini --covariance --json -o three.csv
        simulate passive-two --seed 7 --set targets.0.count=8 --set passive.0.false_bearings=6 \
            --set passive.1.sigma_rad=0.02 -o two
        initiate two/bearings.csv --config two/scenario.ini --json -o two.csv
        simulate sea-spikes --seed 5 --set duration_s=100 -o spikes
        track spikes/plots.csv --config spikes/scenario.ini --covariance --json -o spikes.csv
        simulate masked --seed 3 --set duration_s=200 -o masked
        track masked/plots.csv --config masked/scenario.ini --covariance --json -o masked.csv
        simulate birds --seed 5 --set duration_s=60 -o birds
        track birds/plots.csv --config birds/scenario.ini --covariance --json -o birds.csv
        simulate formation --seed 3 --set duration_s=160 -o formation
        track formation/plots.csv --config formation/scenario.ini --gate hough --json \
            -o formation.csv
        simulate parallel --seed 3 --set clutter=[] --set radars.0.sigma_mps=2 -o pair
        track pair/plots.csv --config pair/scenario.ini --gate hough --covariance --json \
            -o pair.csv
        simulate popup --seed 3 --set radars.0.sigma_mps=3 -o popup
        track popup/plots.csv --config popup/scenario.ini --gate hough --json -o popup.csv
        simulate weave --seed 5 --set radars.0.sigma_mps=10 --set radars.0.pd=0.7 -o weave
        track weave/plots.csv --config weave/scenario.ini --gate hough --json -o weave.csv
        """,
    "doppler-ambiguous": """
        simulate doppler --seed 3 --set radars.0.range_rate_span_mps=100 --set duration_s=120 -o in
        track in/plots.csv --config in/scenario.ini --covariance --json -o tracks.csv
        evaluate in/truth.csv tracks.csv --json
        simulate doppler --seed 4 --set clutter.1.plots=50 -o standing
        track standing/plots.csv --config standing/scenario.ini --covariance --json -o standing.csv
        evaluate standing/truth.csv standing.csv --json
        """,
    "formation-merged": """
        simulate formation --seed 3 --set radars.0.resolution_m=500 -o in
        track in/plots.csv --config in/scenario.ini --covariance --json -o tracks.csv
        evaluate in/truth.csv tracks.csv --json --by-target
        """,
    "long-memory": """
        simulate split-plots --seed 5 --set duration_s=1800 --set targets.0.count=8 \
            --set targets.0.speed_mps=[30,40] --set targets.0.range_m=[35000,45000] \
            --set clutter.0.plots=10 -o in
        track in/plots.csv --config in/scenario.ini --covariance --json -o tracks.csv
        evaluate in/truth.csv tracks.csv --json
        """,
    "input-estimation": """
        simulate doppler --seed 3 --set duration_s=120 -o in
        track in/plots.csv --config in/scenario.ini --gate nearest --set input_estimation=1 \
            --covariance --json -o nearest.csv
        track in/plots.csv --config in/scenario.ini --gate nearest --json -o plain.csv
        track in/plots.csv --config in/scenario.ini --gate hough --set input_estimation=1 \
            --json -o hough.csv
        evaluate in/truth.csv nearest.csv --json
        simulate doppler --seed 3 --set clutter=[] --set radars.0.range_rate_span_mps=100 \
            --set duration_s=200 -o alone
        track alone/plots.csv --config alone/scenario.ini --gate nearest \
            --set input_estimation=1 --json -o alone.csv
        maintain alone/plots.csv --config alone/scenario.ini --gate nearest --covariance \
            --json -o one.csv
        maintain alone/plots.csv --config alone/scenario.ini --covariance --json -o best.csv
        simulate passive-three --seed 3 -o three
        track three/bearings.csv --config three/scenario.ini --gate nearest \
            --set input_estimation=1 --json -o bearings.csv
        """,
    "dense": """
        simulate polar --seed 3 --set clutter.0.plots=10500 --set duration_s=28 -o many
        track many/plots.csv --config many/scenario.ini --set work_max=200000 --json -o many.csv
        simulate popup --seed 3 --set clutter.0.count=60 --set clutter.0.width_rad=0.002 \
            --set duration_s=6 -o near
        track near/plots.csv --config near/scenario.ini --json -o near.csv
        track near/plots.csv --config near/scenario.ini --gate nearest --json -o nearest.csv
        """,
    "elevation": """
        @heights in.csv
        track in.csv --set sigma_elevation_rad=0.001 --covariance --json -o tracks.csv
        track in.csv --gate nearest --covariance --json -o nearest.csv
        track in.csv --gate nearest --set input_estimation=1 --covariance --json -o input.csv
        convert in.csv in.lcm --set sigma_elevation_rad=0.001
        convert in.lcm back.csv
        track in.lcm --covariance --json -o same.csv
        track in.csv --set sensor.1.z_m=700 --json -o raised.csv
        initiate in.csv --json -o found.csv
        maintain in.csv --json -o one.csv
        """,
    "velocities": """
        @velocities in.csv
        track in.csv --set sigma_mps=5 --covariance --json -o tracks.csv
        track in.csv --set sigma_mps=5 --gate nearest --covariance --json -o nearest.csv
        track in.csv --set sigma_mps=5 --set range_rate_span_mps=120 --json -o ambiguous.csv
        maintain in.csv --set sigma_mps=5 --json -o one.csv
        """,
    "unnumbered": """
        simulate rotating --seed 3 --set duration_s=120 -o in
        @unnumbered in/plots.csv plain.csv
        track plain.csv --config in/scenario.ini --set scan_interval_s=4 --covariance \
            --json -o tracks.csv
        @unnumbered in/plots.csv received.csv received
        track received.csv --config in/scenario.ini --set scan_interval_s=4 --set hold_ms=1000 \
            --json -o held.csv
        track received.csv --config in/scenario.ini --set scan_interval_s=4 --set hold_ms=0 \
            --json -o late.csv
        calibrate plain.csv --config in/scenario.ini --set scan_interval_s=4 --json
        """,
    "suspect-radar": """
        @three-radars scene.json
        simulate scene.json --seed 3 -o in
        track in/plots.csv --config in/scenario.ini --covariance --json -o tracks.csv
        evaluate in/truth.csv tracks.csv --set time_tolerance_s=0.1 --json
        convert in/plots.csv in.lcm --config in/scenario.ini
        node --lcm file://in.lcm?speed=0 --config in/scenario.ini --print --log node.lcm
        register in/plots.csv --config in/scenario.ini --json -o biases.ini
        """,
    "places-on-the-earth": """
        @earth in.csv
        track in.csv --set origin_lat_deg=50 --set origin_lon_deg=10 --covariance \
            --json -o tracks.csv
        track in.csv --set origin_lat_deg=50 --set origin_lon_deg=10 -o tracks.geojson
        track in.csv --set origin_lat_deg=50 --set origin_lon_deg=10 \
            --set asterix_sac=3 -o tracks.ast
        convert in.csv in.lcm --set origin_lat_deg=50 --set origin_lon_deg=10
        convert in.lcm back.csv
        convert tracks.csv map.geojson --set origin_lat_deg=50 --set origin_lon_deg=10
        """,
    "radars-on-the-earth": """
        @geodetic
        track polar.csv --config radars.ini --covariance --json -o polar.tracks.csv
        track heights.csv --config radars.ini --covariance --json -o heights.tracks.csv
        track plots.csv --config origin.ini --json -o plots.tracks.csv
        track polar.csv --config radars.ini -o polar.geojson
        convert polar.csv polar.lcm --config radars.ini
        convert heights.csv heights.lcm --config radars.ini
        track heights.lcm --config radars.ini --json -o same.csv
        node --lcm file://heights.lcm?speed=0 --config radars.ini --set range_max_m=120000 \
            --print --log node.lcm
        evaluate truth.csv heights.tracks.csv --config origin.ini --json
        register polar.csv --config radars.ini --json
        """,
    "late": """
        simulate two-radars --seed 5 --set duration_s=120 --set radars.0.late_s=3 \
            --set radars.1.late_s=8 -o in
        track in/plots.csv --config in/scenario.ini --set hold_ms=100 --covariance \
            --json -o tracks.csv
        track in/plots.csv --config in/scenario.ini --set hold_ms=100 --gate nearest \
            --json -o nearest.csv
        track in/plots.csv --config in/scenario.ini --set hold_ms=100 --set late_max_s=0 \
            --json -o stale.csv
        track in/plots.csv --config in/scenario.ini --set hold_ms=8000 --json -o held.csv
        track in/plots.csv --config in/scenario.ini --set sensor.2.time_bias_s=0.5 \
            --json -o biased.csv
        convert in/plots.csv in.lcm --config in/scenario.ini
        track in.lcm --config in/scenario.ini --set hold_ms=100 --covariance --json -o same.csv
        node --lcm file://in.lcm?speed=0 --config in/scenario.ini --set hold_ms=3000 --print \
            --log node.lcm
        evaluate in/truth.csv tracks.csv --set time_tolerance_s=0.1 --json
        """,
    "several-radars": """
        simulate overlapping-radars --seed 3 --set duration_s=300 -o in
        track in/plots.csv --config in/scenario.ini --set initiators=sensor --json -o own.csv
        track in/plots.csv --config in/scenario.ini --set initiators=one --json -o one.csv
        track in/plots.csv --config in/scenario.ini --gate nearest --json -o nearest.csv
        simulate overlapping-radars --seed 3 --set duration_s=300 \
            --set radars.1.range_bias_m=900 -o lies
        track lies/plots.csv --config lies/scenario.ini --json -o lies.csv
        evaluate lies/truth.csv lies.csv --set time_tolerance_s=0.1 --json
        """,
    "register": """
        simulate two-radars --seed 3 --set duration_s=600 --set radars.0.sectors=1 \
            --set radars.1.sectors=1 -o in
        register in/plots.csv --config in/scenario.ini --json -o biases.ini
        register in/plots.csv --config in/scenario.ini --set reference_sensor=2
        track in/plots.csv --config in/scenario.ini --config biases.ini --json -o tracks.csv
        evaluate in/truth.csv tracks.csv --set time_tolerance_s=0.1 --json
        """,
    "calibrate": """
        simulate noise-doubled --seed 3 -o in
        calibrate in/plots.csv --config in/scenario.ini --json -o found.ini
        calibrate in/plots.csv --config in/scenario.ini
        simulate rotating --seed 3 --set duration_s=120 -o turns
        calibrate turns/plots.csv --config turns/scenario.ini --json -o turns.ini
        """,
    "clutter-map": """
        simulate helicopters-towers --seed 3 --set duration_s=300 -o first
        simulate helicopters-towers --seed 4 --set duration_s=300 -o second
        track first/plots.csv --config first/scenario.ini --clutter-map map --json -o first.csv
        track second/plots.csv --config second/scenario.ini --clutter-map map --json -o second.csv
        evaluate second/truth.csv second.csv --json
        plot clutter-map map first/plots.csv -o map.svg
        convert first/plots.csv first.lcm --config first/scenario.ini
        node --lcm file://first.lcm?speed=0 --config first/scenario.ini --clutter-map node --print
        """,
    "convert": """
        simulate radar-and-bearings --seed 3 --set duration_s=60 -o in
        convert in/plots.csv plots.lcm --config in/scenario.ini
        convert plots.lcm plots.csv
        convert in/bearings.csv bearings.lcm --config in/scenario.ini
        convert bearings.lcm bearings.csv
        convert in/truth.csv truth.lcm
        convert truth.lcm truth.csv
        track plots.lcm bearings.lcm --config in/scenario.ini --json -o tracks.lcm
        convert tracks.lcm tracks.csv --covariance
        convert tracks.csv again.lcm
        track in/plots.csv in/bearings.csv --config in/scenario.ini --gate nearest -o nearest.csv
        track in/plots.csv in/bearings.csv --config in/scenario.ini --gate nearest \
            --set input_estimation=1 -o input.csv
        convert nearest.csv nearest.lcm
        evaluate truth.lcm tracks.lcm --json
        simulate popup --seed 3 --set duration_s=10 -o high
        convert high/plots.csv high.lcm
        convert high.lcm high.csv --kind plots
        """,
    "node": """
        simulate traffic --seed 3 --set targets.0.count=6 --set duration_s=300 \
            --set clutter.0.plots=60 -o in
        @halves in/plots.csv first.csv second.csv 150
        convert in/plots.csv all.lcm --config in/scenario.ini
        convert first.csv first.lcm --config in/scenario.ini
        convert second.csv second.lcm --config in/scenario.ini
        node --lcm file://all.lcm?speed=0 --config in/scenario.ini --print --log node.lcm
        node --lcm file://all.lcm?speed=0 --config in/scenario.ini --gate nearest --print
        node --lcm file://first.lcm?speed=0 --config in/scenario.ini --print --snapshot state
        node --lcm file://second.lcm?speed=0 --config in/scenario.ini --print --snapshot state
        @timeless node.lcm
        convert node.lcm tracks.csv --kind tracks --covariance
        evaluate in/truth.csv tracks.csv --json
        """,
    "node-polar": """
        simulate rotating --seed 3 --set duration_s=120 -o in
        convert in/plots.csv in.lcm --config in/scenario.ini
        node --lcm file://in.lcm?speed=0 --config in/scenario.ini --print --log node.lcm
        simulate overlapping-radars --seed 3 --set duration_s=120 -o two
        convert two/plots.csv two.lcm --config two/scenario.ini
        node --lcm file://two.lcm?speed=0 --config two/scenario.ini --set sensors_allowed=1 \
            --print --log one.lcm
        """,
    "node-bearings": """
        simulate passive-clutter --seed 3 -o in
        convert in/bearings.csv in.lcm --config in/scenario.ini
        node --lcm file://in.lcm?speed=0 --config in/scenario.ini --print --log node.lcm
        """,
    "restarts": """
        simulate traffic --seed 3 --set targets.0.count=6 --set duration_s=700 \
            --set clutter.0.plots=60 -o in
        @restarts in/plots.csv in.csv
        convert in.csv in.lcm --config in/scenario.ini
        track in.csv --config in/scenario.ini --json -o tracks.csv
        track in.lcm --config in/scenario.ini --json -o same.csv
        node --lcm file://in.lcm?speed=0 --config in/scenario.ini --print --log node.lcm
        """,
    "publish": """
        simulate crossing --seed 3 -o in
        @epoch in/plots.csv numbered.csv
        publish numbered.csv --config in/scenario.ini --lcm file://published.lcm?mode=w --speed 0
        """,
    "pipe": """
        simulate polar --seed 3 -o in
        track - --config in/scenario.ini < in/plots.csv
        track - --config in/scenario.ini --gate nearest --covariance < in/plots.csv
        """,
    "asterix": """
        simulate polar --seed 2 --set settings.scan_interval_s=4 --set targets.0.count=8 \
            --set clutter.0.plots=40 --set radars.0.sigma_range_rate_mps=1 -o in
        @asterix in/plots.csv turns.ast
        convert turns.ast sectors.csv
        convert turns.ast turns.csv --set asterix_scans=turn
        convert turns.ast turns.lcm
        track turns.ast --config in/scenario.ini --covariance --json -o tracks.csv
        track turns.ast --config in/scenario.ini --set asterix_scans=turn --json -o turns_tracks.csv
        track turns.ast --config in/scenario.ini --set origin_lat_deg=50 \
            --set origin_lon_deg=10 -o tracks.ast
        convert tracks.csv converted.ast
        calibrate turns.ast --config in/scenario.ini --json
        @asterix in/plots.csv placed.ast --sectors 1 --sac 7 --place 47.5,8.5,430
        convert placed.ast placed.csv
        track placed.ast --config in/scenario.ini --json -o placed.tracks.ast
        @damage turns.ast damaged.ast
        ! convert damaged.ast damaged.csv
        convert damaged.ast damaged.csv --keep-going
        """,
    "pictures": """
        simulate polar --seed 3 -o in
        track in/plots.csv --config in/scenario.ini --covariance -o tracks.csv
        plot scans in/plots.csv -o scans.svg
        plot tracks in/truth.csv tracks.csv -o tracks.svg
        plot errors in/truth.csv tracks.csv -o errors.svg
        evaluate in/truth.csv tracks.csv -o judged.svg
        evaluate in/truth.csv tracks.csv -o judged.csv --by-target
        """,
    "config": """
        config
        config --json
        config --json --method ht
        config --json --method nht
        config --json --method passive
        config --json --method passive-paper
        config --set sigma_m=7 --set sensor.2.pd=0.5 --set gate=nearest
        """,
    "simulate-runs": """
        simulate crossing --seed 3 --runs 2 -o runs
        simulate scenes/skies/birds.json --seed 3 --set duration_s=40 -o birds
        """,
    "wrong-input": """
        @wrong in.csv
        track in.csv --keep-going --json -o tracks.csv
        ! track in.csv
        ! track in.csv --set sigma=3
        ! track none.csv
        ! evaluate in.csv in.csv
        ! initiate in.csv --method houg
        ! simulate crossing --set targets.7.count=2 -o none
        """,
}
CASES |= {f"harbour-{number}": harbour_case(number) for number in (2, 16)}
CASES |= {f"scene-{path.stem}": scene_case(path.stem)
          for path in sorted((ROOT / "tools/scenes").glob("*/*.json"))}


# ---- inputs that no scene makes ----

def write_rows(path, header, rows):
    with open(path, "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([header.split(","), *rows])


def noise(draw, sigma):
    """Sums of even numbers, as every machine has them."""
    return sigma * (draw.random() + draw.random() + draw.random() - 1.5) * 2


def make_heights(folder, path):
    """Two targets whose elevations are measured from t_s 70 on, and range rates from 160 on."""
    draw, rows = random.Random(7), []
    for k in range(24):
        for x, y, z, vx, vy in ((-40e3, -5e3, 6e3, -50, 200), (30e3, -9e3, 9e3, -100, 250)):
            x, y = x + 10 * k * vx, y + 10 * k * vy
            ground, space = math.hypot(x, y), math.hypot(x, y, z)
            rows.append((10 * k, 1, f"{space + noise(draw, 20):.2f}",
                         f"{math.atan2(y, x) + noise(draw, .002):.6f}",
                         f"{math.atan2(z, ground) + noise(draw, .001):.6f}" if k > 6 else "",
                         f"{(x * vx + y * vy) / space + noise(draw, 1):.2f}" if k > 15 else ""))
    write_rows(folder / path,
               "t_s,sensor_id,range_m,azimuth_rad,elevation_rad,range_rate_mps", rows)


def make_velocities(folder, path):
    """Places, velocities and range rates together."""
    draw, rows = random.Random(6), []
    for k in range(24):
        for x, y, vx, vy in ((-40e3, -5e3, -50, 200), (30e3, -9e3, -100, 250)):
            x, y = x + 5 * k * vx, y + 5 * k * vy
            rate = (x * vx + y * vy) / math.hypot(x, y)
            rows.append((5 * k, 1, *(f"{value + noise(draw, sigma):.2f}" for value, sigma in (
                (x, 20), (y, 20), (vx, 5), (vy, 5), (rate, 1)))))
    write_rows(folder / path, "t_s,sensor_id,x_m,y_m,vx_mps,vy_mps,range_rate_mps", rows)


def make_unnumbered(folder, path, output, received=""):
    """Plots of a turning radar without numbers of scans, in the order of time or of reception."""
    with open(folder / path) as file:
        rows = [row for row in csv.DictReader(file) if row["range_m"]]
    rows.sort(key=lambda row: float(row["t_s"]))
    header, late = ["t_s", "sensor_id", "range_m", "azimuth_rad"], []
    for i, row in enumerate(rows):
        came = float(row["t_s"]) + (0.6 if i % 5 == 2 else 0.1)
        late.append((came, [row[name] for name in header] + [f"{came:.6f}"] * bool(received)))
    if received:
        late.sort(key=lambda row: row[0])
        header.append("received_s")
    write_rows(folder / output, ",".join(header), [row for _, row in late])


def make_three_radars(folder, path):
    """A scene: three radars that see the same twelve targets, the third of which errs."""
    radars = [{"at_m": [30000 * i, 0], "turn_s": 4, "start_s": i, "range_m": [1000, 150000],
               "sigma_range_m": 30, "sigma_azimuth_rad": 0.003} for i in range(3)]
    radars[2] |= {"azimuth_bias_rad": 0.03}
    (folder / path).write_text(json.dumps({
        "version": 1, "duration_s": 200, "radars": radars,
        "settings": {"v_min_mps": 30, "v_max_mps": 350, "accel_max_mps2": 20},
        "targets": [{"count": 12, "range_m": [20000, 70000], "speed_mps": [100, 250],
                     "keep_range_m": [5000, 90000]}],
        "clutter": [{"kind": "uniform", "plots": 20}],
        "events": [{"kind": "mask", "sensors": [1], "range_m": [40000, 60000],
                    "sector_rad": [0, 1], "from_s": 50, "until_s": 150}]}))


def make_earth(folder, path):
    draw, rows = random.Random(8), []
    for k in range(25):
        for lat, lon, alt, north, east in ((50.2, 9.8, 4000, 150, 90),
                                           (49.7, 10.3, 9000, 60, -200)):
            rows.append((4 * k, 1, f"{lat + (4 * k * north + noise(draw, 10)) / 111200:.7f}",
                         f"{lon + (4 * k * east + noise(draw, 10)) / 71500:.7f}",
                         f"{alt + noise(draw, 10):.1f}"))
    write_rows(folder / path, "t_s,sensor_id,lat_deg,lon_deg,alt_m", rows)


def make_wrong(folder, path):
    draw, rows = random.Random(9), []
    for k in range(30):
        x = f"{1000 + 400 * k + noise(draw, 10):.1f}"
        rows.append((4 * k, 1, "none" if k % 7 == 5 else x, "nan" if k % 11 == 9 else 5 * k))
    write_rows(folder / path, "t_s,sensor_id,x_m,y_m", rows)


def make_halves(folder, path, first, second, time):
    with open(folder / path) as file:
        header, *rows = file
    for name, is_in in ((first, lambda t: t < float(time)), (second, lambda t: t >= float(time))):
        kept = (row for row in rows if is_in(float(row.split(",")[0])))
        (folder / name).write_text(header + "".join(kept))


def make_epoch(folder, path, output):
    """The epoch of a file without this column is the time of day."""
    lines = (folder / path).read_text().splitlines()
    (folder / output).write_text(f"{lines[0]},epoch\n" + "".join(f"{x},5\n" for x in lines[1:]))


def make_restarts(folder, path, output):
    """A radar that loses scans, is started anew, and gets another time of day."""
    with open(folder / path) as file:
        rows = list(csv.DictReader(file))
    last = 0
    for row in rows:
        scan = int(row["scan"])
        last = max(last, scan)
        row["epoch"] = 1 if scan <= 30 else 2
        if scan > 30:
            row["scan"] = scan - 30
        if scan > 50:
            row["t_s"] = f"{float(row['t_s']) + 500:.6f}"
    rows = [row for row in rows if row["scan"] not in ("11", "12", "19")]
    write_rows(folder / output, ",".join(rows[0]), [row.values() for row in rows])


def make_geodetic(folder):
    script = ROOT / "tests/integration/geodetic.py"
    subprocess.run([sys.executable, script], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    common = ("origin_lat_deg = 50\norigin_lon_deg = 10\norigin_alt_m = 100\nv_max_mps = 400\n"
              "accel_max_mps2 = 5\nrange_max_m = 400000\nsigma_azimuth_rad = 0.0005\n"
              "sigma_elevation_rad = 0.0005\n")
    (folder / "origin.ini").write_text(common)
    (folder / "radars.ini").write_text(
        common + "[sensor 1]\nlat_deg = 50.5\nlon_deg = 11\nalt_m = 400\n"
        "[sensor 2]\nlat_deg = 49\nlon_deg = 8\nalt_m = 250\n")


def make_asterix(folder, path, output, *options):
    subprocess.run([sys.executable, ROOT / "tests/integration/write_asterix.py", path, output,
                    *options], cwd=folder, check=True)


def make_damage(folder, path, output):
    """Bytes that are no block between two blocks, and a category that is not read."""
    data, blocks, at = (folder / path).read_bytes(), [], 0
    while at < len(data):
        size = int.from_bytes(data[at + 1:at + 3], "big")
        blocks.append(data[at:at + size])
        at += size
    middle = len(blocks) // 2
    (folder / output).write_bytes(b"".join(
        [*blocks[:middle], b"\x01\x00\x05ab", b"\x30\x00\x02", *blocks[middle:]]))


def make_timeless(folder, path):
    """A node's log without the time of day, so that files made of it are the same in each run."""
    (folder / path).write_bytes(without_run((folder / path).read_bytes()))


MAKERS = {
    "asterix": make_asterix, "damage": make_damage, "earth": make_earth, "epoch": make_epoch,
    "geodetic": make_geodetic, "halves": make_halves, "heights": make_heights,
    "restarts": make_restarts, "three-radars": make_three_radars, "timeless": make_timeless,
    "unnumbered": make_unnumbered, "velocities": make_velocities, "wrong": make_wrong,
}

# ---- one run ----

# Keys of reports that differ from run to run, or from build to build.
LEFT_OUT = re.compile(r"(time|wall|mean|max|step|frame|scan)_us$|search_ms$|latency_max_ms$"
                      r"|^state_bytes$|^bars_(held|missed)$")


def is_bar_of_time(value):
    """A bar of an experiment: {what: "... ms ...", value, ...}."""
    return isinstance(value, dict) and re.search(r"\bms\b|\bus\b|time", str(value.get("what")))


def cleaned(value):
    """A report without times and memory, its numbers to ten digits: sums may differ in the last."""
    if isinstance(value, dict):
        return {k: cleaned(v) for k, v in value.items() if not LEFT_OUT.search(k)}
    if isinstance(value, list):
        return [cleaned(v) for v in value if not is_bar_of_time(v)]
    if isinstance(value, float):
        value = float(f"{value:.10g}")
        return int(value) if value == int(value) else value
    return value


IN_HASH_ALONE = {"by_motion", "by_target", "over_time"}


def figures(report, prefix=""):
    """Numbers of a report and of what is in it, short lists, too; zeros are left out."""
    found = {}
    items = report.items() if isinstance(report, dict) else enumerate(report)
    for key, value in items:
        if isinstance(value, dict) and key not in IN_HASH_ALONE:
            found |= figures(value, f"{prefix}{key}.")
        elif isinstance(value, list) and key not in IN_HASH_ALONE and len(value) <= 6:
            found |= figures(value, f"{prefix}{key}.")
        elif value and isinstance(value, (int, float, str)):
            found[f"{prefix}{key}"] = value
    return found


def events(log):
    """(start of the event, start of the payload, its end, channel) of an LCM log."""
    at = 0
    while at < len(log):
        _, _, _, channel_size, size = struct.unpack_from(">IQQII", log, at)
        start = at + 28 + channel_size
        yield at, start, start + size, bytes(log[at + 28:start]).decode()
        at = start + size


PERIODIC = {"RHO_STATUS", "RHO_WORK", "RHO_SENSORS", "RHO_LEARNED", "RHO_LIFE", "RHO_CLUTTER"}


def without_run(log, is_live=False):
    """A log without what a run puts into it: the node's boot number, which is the time of day, and
    of a log that is written live the times of events."""
    log = bytearray(log)
    for at, start, _, channel in events(log):
        if is_live:
            log[at + 12:at + 20] = bytes(8)
        if channel == "RHO_TRACKS":  # after fingerprint, utime and scan
            log[start + 20:start + 24] = bytes(4)
    return without_periodic(bytes(log))


def without_periodic(log):
    """Without what a node publishes once a second of the day: how often, and what of it is of the
    last second, depends on the machine. Events have no numbers then."""
    kept = [(at, end) for at, _, end, channel in events(log) if channel not in PERIODIC]
    if len(kept) == len(list(events(log))):
        return log
    return b"".join(log[at:at + 4] + bytes(8) + log[at + 12:end] for at, end in kept)


def digest(name, data):
    size = f"{data.count(10)} lines"
    if name.endswith(".lcm"):
        data = without_run(data, name == "published.lcm")
        channels = [channel for _, _, _, channel in events(data)]
        size = ", ".join(f"{channels.count(name)} {name}" for name in sorted(set(channels)))
    return f"{size}, sha256 {hashlib.sha256(data).hexdigest()}"


# `749 us a scan, 2587 at most` and the like
TIMES = re.compile(r"[0-9.]+ (us|ms) a (scan|step), [0-9.]+ at most|in [0-9.]+ s, .*")
# A node warns of losses at most once a second of the clock on the wall: how often depends on load.
WARNING = re.compile(r".*rhotrack: .*: \d+ so far(, .*)?$")


def files_of(folder):
    return {str(path.relative_to(folder)): path for path in folder.rglob("*") if path.is_file()}


# A snapshot, which is an image of memory; pages and pictures of experiments with times in them.
NOT_COMPARED = {"state", "index.html", "times.svg", "load.svg"}


class Wrong(Exception):
    """A command that did not end as it should."""


def execute(folder, line, environment):
    """One command: what it wrote, said and reported."""
    words = shlex.split(line)
    if words[0].startswith("@"):
        MAKERS[words[0][1:]](folder, *words[1:])
        return None
    fails = words[0] == "!"
    words = words[fails:]
    given = subprocess.DEVNULL
    if "<" in words:
        given = open(folder / words[-1])
        words = words[:-2]
    before = {name: (path.stat().st_mtime_ns, path.stat().st_ino)
              for name, path in files_of(folder).items()}
    ended = subprocess.run([PROGRAM, *words], cwd=folder, stdin=given, capture_output=True,
                           env=environment, timeout=300)
    said = [line for line in TIMES.sub("TIMES", ended.stderr.decode()).splitlines()
            if not WARNING.match(line)]
    if (ended.returncode != 0) != fails:
        raise Wrong(f"{line}: exit {ended.returncode}: {' '.join(said)}")
    outcome = {}
    for name, path in sorted(files_of(folder).items()):
        is_new = before.get(name) != (path.stat().st_mtime_ns, path.stat().st_ino)
        if is_new and path.name not in NOT_COMPARED:
            outcome[name] = digest(name, path.read_bytes())
    if "--json" in words:
        report = cleaned(json.loads(ended.stdout))
        outcome["report"] = "sha256 " + hashlib.sha256(json.dumps(report).encode()).hexdigest()
        outcome["figures"] = figures(report) if words[0] != "config" else {}
    elif ended.stdout:
        outcome["standard output"] = digest("", ended.stdout)
    if said:
        outcome["standard error"] = said
    return outcome


def run_case(steps):
    """{command: outcome} of a case, in a folder of its own."""
    with tempfile.TemporaryDirectory() as path:
        folder, tools = Path(path, "case"), Path(path, "bin")
        folder.mkdir()
        tools.mkdir()
        (tools / "gnuplot").write_text("#!/bin/sh\ncat \"$1\"\n")
        (tools / "gnuplot").chmod(0o755)
        (folder / "scenes").symlink_to(ROOT / "tools/scenes")
        (folder / "vectors").symlink_to(ROOT / "tests/vectors")
        environment = dict(os.environ, PATH=f"{tools}:{os.environ['PATH']}", LC_ALL="C", TZ="UTC")
        lines = (" ".join(line.split()) for line in steps.splitlines())
        outcomes = {line: execute(folder, line, environment) for line in lines if line}
        return {line: outcome for line, outcome in outcomes.items() if outcome is not None}


# ---- comparison ----

def differences(old, new):
    """Lines that tell what differs between two runs of a case."""
    told = [f"{line}: {'only ' + ('before' if line in old else 'now')}"
            for line in old | new if (line in old) != (line in new)]
    for line in (line for line in old if line in new):
        before, now = old[line], new[line]
        for name in before | now:
            if before.get(name) == now.get(name):
                continue
            told.append(f"{line}")
            if name == "figures":
                a, b = before.get(name, {}), now.get(name, {})
                told += [f"    {key}: {a.get(key, 0)} -> {b.get(key, 0)}"
                         for key in a | b if a.get(key) != b.get(key)]
            elif name == "standard error":
                told += [f"    said before: {x}" for x in before.get(name, [])]
                told += [f"    says now:    {x}" for x in now.get(name, [])]
            else:
                told.append(f"    {name}: {before.get(name, 'not there')}")
                told.append(f"    {' ' * len(name)}  -> {now.get(name, 'not there')}")
    once = []  # the command stands once above all of its differences
    for text in told:
        if text.startswith(" ") or text not in once:
            once.append(text)
    return once


def golden_of(name):
    path = GOLDEN / f"{name}.json"
    return json.loads(path.read_text()) if path.exists() else {}


def check_comparison(result):
    """A comparison that sees nothing proves nothing: seeded faults must be told."""
    steps = CASES["harbour-2"]
    good = run_case(steps)
    noisier = run_case(steps.replace("sigma_m=5", "sigma_m=6"))
    noisier = dict(zip(good, noisier.values()))  # as if the command were the same
    told = "\n".join(differences(good, noisier))
    result("another noise is seen in the tracks, in figures and in what is drawn",
           all(re.search(pattern, told) for pattern in (
               r"tracks\.csv: \d+ lines, sha256 ", r"rmse_m: [0-9.]+ -> [0-9.]+",
               r"work: \d+ -> \d+", r"tracks\.svg: ", r"nearest\.csv: ")), told)
    result("one byte is seen", digest("a.csv", b"1,2\n") != digest("a.csv", b"1,3\n")
           and digest("a.lcm", log_of(b"a")) != digest("a.lcm", log_of(b"b")), "")
    result("the same again is the same", good == run_case(steps), "")


def log_of(payload):
    return struct.pack(">IQQII", 0xEDA1DA01, 0, 0, 1, len(payload)) + b"C" + payload


def main(arguments):
    is_update, is_first = "--update" in arguments, "--first" in arguments
    names = [name for name in arguments if not name.startswith("--")] or list(CASES)
    unknown = [name for name in names if name not in CASES]
    if unknown:
        sys.exit(f"golden.py: no case {unknown[0]}; there are: {', '.join(CASES)}")
    passed = failed = 0

    def result(name, is_good, told):
        nonlocal passed, failed
        passed, failed = passed + bool(is_good), failed + (not is_good)
        print(f"ok   {name}" if is_good else f"FAIL {name}\n{told}", flush=True)

    def attempt(name):
        try:
            return run_case(CASES[name])
        except (Wrong, subprocess.SubprocessError, OSError, ValueError) as error:
            return error

    GOLDEN.mkdir(exist_ok=True)
    with ThreadPoolExecutor(min(2, os.cpu_count() or 1)) as pool:
        for name, new in zip(names, pool.map(attempt, names)):
            if isinstance(new, Exception):
                result(name, False, f"     {error_text(new)}")
                continue
            told = differences(golden_of(name), new)
            told = "\n".join("     " + line for line in told)
            if is_update:
                text = json.dumps(new, indent=1, ensure_ascii=False) + "\n"
                (GOLDEN / f"{name}.json").write_text(text)
                if told:
                    print(f"{name}\n{told}")
            else:
                result(name, not told, told)
                if told and is_first:
                    pool.shutdown(cancel_futures=True)
                    return 1
    if names == list(CASES):
        for path in GOLDEN.glob("*.json"):
            if path.stem not in CASES and is_update:
                path.unlink()
            elif path.stem not in CASES:
                result(path.name, False, "     belongs to no case: --update removes it")
    if not is_update:
        check_comparison(result)
    print(f"{passed} passed, {failed} failed")
    return failed > 0


def error_text(error):
    return str(error) or type(error).__name__


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
