#!/bin/bash
# SPDX-License-Identifier: MIT
#
# Publishes a simulated scene and its tracks for the viewer: a rotating radar in clutter, two
# bearing sensors, and aircraft that appear one after the other and fly straight or turn, ten times
# as fast as real time. Usage: RHOTRACK=program publish_demo_scene.sh [SECONDS], on the LCM network
# of LCM_DEFAULT_URL. Publisher and tracker end with the script.
# shellcheck source=tools/spy/scene_scripts_common.bash
. "$(dirname "$0")/scene_scripts_common.bash"
python3 - <<'PYTHON'
import math
import random
random.seed(4)
TURN_S, TURNS = 4.0, 90
SENSORS = {2: (-14000.0, -20000.0), 3: (20000.0, -18000.0)}
aircraft = []
for i in range(16):
    heading = random.uniform(-math.pi, math.pi)
    reach = random.uniform(12e3, 42e3)
    aircraft.append({"x": -reach * math.cos(heading + random.uniform(-.5, .5)),
                     "y": -reach * math.sin(heading + random.uniform(-.5, .5)), "heading": heading,
                     "start": 0 if i < 5 else 16.0 * (i - 4), "speed": random.uniform(90, 290),
                     "turn": random.choice([0, 0, 0, .006, -.008])})

def position_at(a, t):
    t -= a["start"]
    if a["turn"] == 0:
        return (a["x"] + a["speed"] * t * math.cos(a["heading"]),
                a["y"] + a["speed"] * t * math.sin(a["heading"]))
    radius, end = a["speed"] / a["turn"], a["heading"] + a["turn"] * t
    return (a["x"] + radius * (math.sin(end) - math.sin(a["heading"])),
            a["y"] - radius * (math.cos(end) - math.cos(a["heading"])))

with open("polar.csv", "w") as polar, open("bearings.csv", "w") as bearings, \
        open("truth.csv", "w") as truth:
    print("t_s,sensor_id,range_m,azimuth_rad,scan", file=polar)
    print("t_s,sensor_id,sensor_x_m,sensor_y_m,bearing_rad", file=bearings)
    print("t_s,target_id,x_m,y_m", file=truth)
    for turn in range(TURNS):
        rows = []
        there = [a for a in aircraft if a["start"] <= turn * TURN_S]
        for a in there:
            x, y = position_at(a, turn * TURN_S)
            offset = (math.atan2(y, x) % (2 * math.pi)) / (2 * math.pi) * TURN_S
            x, y = position_at(a, turn * TURN_S + offset)
            if random.random() < .93 and math.hypot(x, y) < 48e3:
                rows.append((offset, math.hypot(x, y) + random.gauss(0, 20),
                             math.atan2(y, x) + random.gauss(0, .0025)))
        for _ in range(60):
            azimuth = random.uniform(0, 2 * math.pi)
            rows.append((azimuth / (2 * math.pi) * TURN_S, 48e3 * math.sqrt(random.random()) + 50,
                         azimuth))
        print(f"{turn * TURN_S:.6f},1,,,{turn}", file=polar)
        for offset, reach, azimuth in sorted(rows):
            azimuth = math.remainder(azimuth, 6.28318)
            print(f"{turn * TURN_S + offset:.6f},1,{reach:.2f},{azimuth:.6f},{turn}", file=polar)
        for sensor, (sx, sy) in SENSORS.items():
            for a in there:
                x, y = position_at(a, turn * TURN_S + 2)
                if random.random() < .05:
                    continue
                bearing = math.atan2(y - sy, x - sx) + random.gauss(0, .00175)
                print(f"{turn * TURN_S + 2:.6f},{sensor},{sx},{sy},"
                      f"{math.remainder(bearing, 6.28318):.6f}", file=bearings)
        for i, a in enumerate(there):
            x, y = position_at(a, turn * TURN_S)
            print(f"{turn * TURN_S:.6f},{i},{x:.1f},{y:.1f}", file=truth)
PYTHON
sleep 4 # until the viewer has started
timeout "$seconds" "$program" node --set sigma_range_m=20 --set sigma_azimuth_rad=0.0025 \
    --set v_max_mps=400 &
sleep 0.5
timeout "$seconds" "$program" publish polar.csv bearings.csv truth.csv --speed 10 --loop &
wait
