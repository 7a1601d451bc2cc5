#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Publishes a simulated scene for the viewer, tracked with the passive paper's method: three bearing
# sensors see aircraft that come three at a time, and a radar sees some of them in clutter; the
# tracker publishes ghosts, votes and hypotheses, sixteen times as fast as real time. Usage:
# RHOTRACK=program publish_paper_method_scene.sh [SECONDS], on the LCM network of LCM_DEFAULT_URL.
# Publisher and tracker end with the script.
# shellcheck source=tools/spy/scene_scripts_common.bash
. "$(dirname "$0")/scene_scripts_common.bash"
python3 - <<'PYTHON'
import math
import random
random.seed(7)
SCAN_S, SCANS, SIGMA = 10.0, 60, 0.0009
SENSORS = {1: (-12000.0, -6000.0), 2: (13000.0, -4000.0), 3: (0.0, 12000.0)}
aircraft = []
for i in range(18):
    heading = random.uniform(-math.pi, math.pi)
    reach, aside = random.uniform(38e3, 60e3), random.uniform(-15e3, 15e3)
    aircraft.append({"x": -reach * math.cos(heading) - aside * math.sin(heading),
                     "y": -reach * math.sin(heading) + aside * math.cos(heading),
                     "heading": heading, "speed": random.uniform(120, 260),
                     "start": 120.0 * (i // 3)})

with open("bearings.csv", "w") as bearings, open("plots.csv", "w") as plots:
    print("t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad", file=bearings)
    print("t_s,sensor_id,x_m,y_m", file=plots)
    for scan in range(SCANS):
        t = scan * SCAN_S
        there = [(a["x"] + (t - a["start"]) * a["speed"] * math.cos(a["heading"]),
                  a["y"] + (t - a["start"]) * a["speed"] * math.sin(a["heading"]))
                 for a in aircraft if a["start"] <= t < a["start"] + 300]
        for sensor, (sx, sy) in SENSORS.items():
            for x, y in there:
                bearing = math.atan2(y - sy, x - sx) + random.gauss(0, SIGMA)
                print(f"{t:.6f},{sensor},{sx},{sy},{math.remainder(bearing, 2 * math.pi):.6f}",
                      file=bearings)
        for x, y in there[:3]:
            print(f"{t + 5:.6f},9,{x + random.gauss(0, 60):.1f},{y + random.gauss(0, 60):.1f}",
                  file=plots)
        for _ in range(25):
            print(f"{t + 5:.6f},9,{random.uniform(-60e3, 60e3):.1f},"
                  f"{random.uniform(-60e3, 60e3):.1f}", file=plots)
PYTHON
sleep 4 # until the viewer has started
timeout "$seconds" "$program" node --method passive-paper --show ghosts,votes,hypotheses \
    --set sigma_m=60 --set sigma_rad=0.0009 --set v_max_mps=400 &
sleep 0.5
timeout "$seconds" "$program" publish bearings.csv plots.csv --speed 16 --loop \
    --set sigma_rad=0.0009 &
wait
