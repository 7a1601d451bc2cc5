#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The scene of geodetic.sh: four aircraft and two radars, by formulas of its own. Writes to the
current folder.

Usage: geodetic.py            plots, polar plots and truth, each on the earth and in metres
       geodetic.py map FILE   the worst distance (m) of a map's lines to the truth: prints ground,
                              height
       geodetic.py plots FILE the worst distance (m), each axis, of plots in metres to those of the
                              scene
"""
import csv
import json
import math
import sys

A, F = 6378137.0, 1 / 298.257223563
E2 = F * (2 - F)
ORIGIN = (50.0, 10.0, 100.0)
RADARS = {1: (50.5, 11.0, 400.0), 2: (49.0, 8.0, 250.0)}
AIRCRAFT = [(49.8, 9.6, 9e-4, 12e-4, 4000, 0), (49.95, 9.8, 18e-4, -12e-4, 6000, 3),
            (50.1, 10.0, 9e-4, 12e-4, 8000, 6), (50.25, 10.2, 18e-4, -12e-4, 10000, 9)]


def ecef(lat, lon, alt):
    lat, lon = math.radians(lat), math.radians(lon)
    normal = A / math.sqrt(1 - E2 * math.sin(lat) ** 2)
    return ((normal + alt) * math.cos(lat) * math.cos(lon),
            (normal + alt) * math.cos(lat) * math.sin(lon),
            (normal * (1 - E2) + alt) * math.sin(lat))


def local(origin, place):
    """x east, y north, z up at the origin."""
    lat, lon = math.radians(origin[0]), math.radians(origin[1])
    dx, dy, dz = (b - a for a, b in zip(ecef(*origin), ecef(*place)))
    outward = math.cos(lon) * dx + math.sin(lon) * dy
    return (math.cos(lon) * dy - math.sin(lon) * dx, math.cos(lat) * dz - math.sin(lat) * outward,
            math.sin(lat) * dz + math.cos(lat) * outward)


def turn_deg(stands):
    """Where a radar's own north is in the local frame, clockwise from the frame's."""
    here, north = local(ORIGIN, stands), local(ORIGIN, (stands[0] + 1e-3, *stands[1:]))
    return math.degrees(math.atan2(north[0] - here[0], north[1] - here[1]))


def places(t_s):
    for number, (lat, lon, lat_s, lon_s, alt, climb) in enumerate(AIRCRAFT, 1):
        yield number, (lat + lat_s * t_s, lon + lon_s * t_s, alt + climb * t_s)


def write(name, header, rows):
    with open(name, "w", encoding="utf-8") as file:
        file.write(header + "\n")
        for row in rows:
            file.write(",".join(f"{cell:.9f}" if isinstance(cell, float) else str(cell)
                                for cell in row) + "\n")


def scene():
    times = [4.0 * scan for scan in range(30)]
    seen = [(t, number, place) for t in times for number, place in places(t)]
    write("truth.csv", "t_s,target_id,lat_deg,lon_deg,alt_m", [(t, n, *p) for t, n, p in seen])
    write("truth_m.csv", "t_s,target_id,x_m,y_m,z_m",
          [(t, n, *local(ORIGIN, p)) for t, n, p in seen])
    write("plots.csv", "t_s,sensor_id,lat_deg,lon_deg,alt_m", [(t, 7, *p) for t, _, p in seen])
    write("plots_m.csv", "t_s,sensor_id,x_m,y_m,z_m",
          [(t, 7, *local(ORIGIN, p)) for t, _, p in seen])
    write("level.csv", "t_s,sensor_id,lon_deg,lat_deg", [(t, 7, p[1], p[0]) for t, _, p in seen])
    write("level_truth.csv", "t_s,target_id,lat_deg,lon_deg",
          [(t, n, p[0], p[1]) for t, n, p in seen])
    polar, cells = [], []
    for t in times:
        for radar, stands in RADARS.items():
            for _, place in places(t):
                x, y, z = local(stands, place)
                distance = math.sqrt(x * x + y * y + z * z)
                azimuth = math.degrees(math.atan2(x, y)) % 360
                polar.append((t, radar, distance, azimuth, math.degrees(math.asin(z / distance))))
                cells.append((place[2], *stands))
    head = "t_s,sensor_id,range_m,azimuth_deg"
    write("polar.csv", head + ",elevation_deg", polar)
    write("placed.csv", head + ",elevation_deg,sensor_lat_deg,sensor_lon_deg,sensor_alt_m",
          [row + cell[1:] for row, cell in zip(polar, cells)])
    write("heights.csv", head + ",alt_m", [row[:4] + cell[:1] for row, cell in zip(polar, cells)])
    write("ground.csv", head, [row[:4] for row in polar])
    write("turned.csv", head + ",alt_m",
          [(row[0], row[1], row[2], (row[3] + turn_deg(RADARS[row[1]])) % 360, cell[0])
           for row, cell in zip(polar, cells)])
    for radar, stands in RADARS.items():
        x, y, z = local(ORIGIN, stands)
        print(f"[sensor {radar}]\nx_m = {x:.6f}\ny_m = {y:.6f}\nz_m = {z:.6f}")


def worst(name):
    """Of each position of a line, from the aircraft that is nearest at its time."""
    ground, height = 0.0, 0.0
    with open(name, encoding="utf-8") as file:
        features = json.load(file)["features"]
    for feature in features:
        if feature["geometry"]["type"] != "LineString":
            continue
        line, times = feature["geometry"]["coordinates"], feature["properties"]["t_s"]
        assert len(line) == len(times)
        for position, t in zip(line, times):
            # at the aircraft's own height: on the ground alone
            off = [(math.hypot(*local(p, (position[1], position[0], p[2]))[:2]), p)
                   for _, p in places(t)]
            near, place = min(off)
            ground = max(ground, near)
            height = max(height, abs(position[2] - place[2]) if len(position) > 2 else 0.0)
    print(f"{ground:.3f} {height:.3f}")


def convert(name):
    """Rows of a CSV file of plots in metres: the worst difference of each place to those of
    plots_m.csv."""
    with open(name, encoding="utf-8") as file, open("plots_m.csv", encoding="utf-8") as reference:
        pairs = list(zip(csv.DictReader(file), csv.DictReader(reference), strict=True))
    worst_m = max(abs(float(a[key]) - float(b[key])) for a, b in pairs
                  for key in ("x_m", "y_m", "z_m"))
    print(f"{worst_m:.4f}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["map"]:
        worst(sys.argv[2])
    elif sys.argv[1:2] == ["plots"]:
        convert(sys.argv[2])
    else:
        scene()
