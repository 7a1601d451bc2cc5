#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""GOSPA and OSPA of sets of points, straight from their definitions: the reference of
tests/tools/evaluation/test_gospa.c.

Usage: make_gospa_vectors.py > gospa_vectors.h
       make_gospa_vectors.py --compare
In tests/vectors; needs NumPy and SciPy. --compare puts the same cases through Stone Soup's metrics,
which it needs, too.

For |X| <= |Y|, d_c = min(d, c), over all ways to give each x a y of its own:
  GOSPA (p 2, alpha 2)^2 = min sum d_c(x, y)^2 + c^2 / 2 (|Y| - |X|)
  OSPA (p 2)^2           = (min sum d_c(x, y)^2 + c^2 (|Y| - |X|)) / |Y|
(Rahmathullah et al., Definition 1; Schuhmacher et al., eq. 3).
The minimum comes from SciPy's linear_sum_assignment over all of X and Y at once; the program pairs
clusters apart, by a method of its own. Parts of GOSPA are given where one pairing alone is best (no
ties): pairs are those with d < c.
"""
import math
import random
import sys

import numpy
from scipy.optimize import linear_sum_assignment

HEADER = """/* SPDX-License-Identifier: MIT */
/*
 * Made by tests/vectors/make_gospa_vectors.py; do not edit.
 *
 * GOSPA (p 2, alpha 2) and OSPA (p 2) by SciPy's linear_sum_assignment over whole sets.
 * `make_gospa_vectors.py --compare` ran once with Stone Soup 1.9.1
 * (stonesoup.metricgenerator.ospametric):
@OUTCOME@
 */
/* clang-format off */
#ifndef RHOTRACK_TESTS_GOSPA_VECTORS_H
#define RHOTRACK_TESTS_GOSPA_VECTORS_H
"""
OUTCOME = """\
 *   GOSPA and its parts of 27 cases (an empty pair of sets it refuses): the same to 2e-16 of
 *   the value; OSPA: the same or, in 8 cases, larger by up to 2.7 %, as it pairs by the least sum
 *   of d and not of d^2 as the definition has it; paired so (without ties) it is the same to
 *   2e-16."""


def uniform(rng, count, width, height=0.0):
    return [(rng.uniform(-width, width), rng.uniform(-width, width), rng.uniform(-height, height))
            for _ in range(count)]


def near(rng, points, sigma):
    return [tuple(v + rng.gauss(0.0, sigma) for v in point[:2]) + (point[2],) for point in points]


def lattice(rng, count, width):
    return [(float(rng.randrange(width)), float(rng.randrange(width)), 0.0) for _ in range(count)]


def chain(count, step, offset):
    return [(i * step + offset, 0.0, 0.0) for i in range(count)]


def make_cases(rng):
    """(name, cutoff, targets, tracks, whether several pairings may be best)"""
    yield "nothing", 10.0, [], [], False
    yield "targets alone", 10.0, uniform(rng, 7, 50.0), [], False
    yield "tracks alone", 10.0, [], uniform(rng, 5, 50.0), False
    yield "one pair", 10.0, [(1.0, 2.0, 3.0)], [(4.0, 6.0, 3.0)], False
    yield "one pair at the cutoff", 5.0, [(1.0, 2.0, 3.0)], [(4.0, 6.0, 3.0)], False
    yield "one pair beyond it", 4.999, [(1.0, 2.0, 3.0)], [(4.0, 6.0, 3.0)], False
    for targets, tracks, width in ((3, 8, 30.0), (8, 3, 30.0), (20, 20, 60.0), (40, 25, 60.0),
                                   (60, 60, 40.0), (60, 60, 100.0), (60, 45, 400.0)):
        yield (f"{targets} and {tracks} anywhere", 20.0, uniform(rng, targets, width, 5.0),
               uniform(rng, tracks, width, 5.0), False)
    targets = uniform(rng, 60, 250000.0)
    yield "traffic", 1000.0, targets, near(rng, targets[:55], 60.0) + uniform(rng, 5,
                                                                              250000.0), False
    yield "traffic, a small cutoff", 50.0, targets, near(rng, targets[:55], 60.0), False
    yield "traffic, a huge cutoff", 200000.0, targets[:30], near(rng, targets[10:45], 60.0), False
    centres = uniform(rng, 6, 20000.0, 3000.0)
    targets = [point for centre in centres for point in near(rng, [centre] * 8, 150.0)]
    tracks = [point for centre in centres[:5] for point in near(rng, [centre] * 10, 200.0)]
    yield "tight clusters", 500.0, targets, tracks, False
    yield "a chain", 10.0, chain(30, 9.0, 0.0), chain(30, 9.0, 4.0), False
    yield "a chain, one too many", 10.0, chain(30, 9.0, 0.0), chain(31, 9.0, -4.0), False
    yield "a chain across", 10.0, [(0.0, x, 0.0) for x, _, _ in chain(25, 12.0, 0.0)], \
        [(0.0, x, 3.0) for x, _, _ in chain(25, 12.0, 5.0)], False
    yield "far apart", 1000.0, uniform(
        rng, 20, 5000.0), [(x + 1e6, y, z) for x, y, z in uniform(rng, 20, 5000.0)], False
    yield "heights alone differ", 100.0, [(5.0, 5.0, 90.0 * i) for i in range(12)], \
        [(5.0, 5.0, 90.0 * i + 31.0) for i in range(10)], False
    yield "all on one place", 10.0, [(3.0, 3.0, 0.0)] * 9, [(3.0, 3.0, 0.0)] * 6, True
    for targets, tracks, width in ((6, 6, 4), (12, 9, 6), (30, 30, 12), (60, 50, 14), (25, 60, 30)):
        yield (f"{targets} and {tracks} on a lattice", 5.0, lattice(
            rng, targets, width), lattice(rng, tracks, width), True)


def rounded(points):
    """To what the header says."""
    return [tuple(float(f"{v:.3f}") for v in point) for point in points]


def distances(few, many):
    return numpy.array([[math.dist(a, b) for b in many] for a in few]).reshape(len(few), len(many))


def metrics(cutoff, targets, tracks):
    few, many = sorted((targets, tracks), key=len)
    d = distances(few, many)
    cut = numpy.minimum(d, cutoff) ** 2
    rows, columns = linear_sum_assignment(cut)
    least = math.fsum(cut[rows, columns])
    extra = len(many) - len(few)
    gospa = math.sqrt(least + cutoff ** 2 / 2 * extra)
    ospa = math.sqrt((least + cutoff ** 2 * extra) / len(many)) if many else 0.0
    pairs = [(r, c) for r, c in zip(rows, columns) if d[r, c] < cutoff]
    localisation = math.fsum(d[r, c] ** 2 for r, c in pairs)
    return gospa, ospa, localisation, len(pairs)


def write():
    print(HEADER.replace("@OUTCOME@", OUTCOME))
    places, rows = [], []
    for name, cutoff, targets, tracks, has_ties in make_cases(random.Random(20)):
        targets, tracks = rounded(targets), rounded(tracks)
        gospa, ospa, localisation, pairs = metrics(cutoff, targets, tracks)
        parts = "-1.0, -1" if has_ties else f"{localisation:.13g}, {pairs}"
        rows.append(
            f'    {{"{name}", {cutoff}, {len(places)}, {len(targets)}, '
            f"{len(places) + len(targets)}, {len(tracks)}, {gospa:.13g}, {ospa:.13g}, {parts}}},")
        places += targets + tracks
    print("static const struct gospa_place gospa_places[] = {")
    print("\n".join(f"    {{{x:.3f}, {y:.3f}, {z:.3f}}}," for x, y, z in places))
    print(
        "};\n\n"
        "/* Where the points begin in gospa_places, and how many; localisation -1 and pairs -1:\n"
        " * several may be best. */"
    )
    print("static const struct gospa_case {\n    const char *name;\n    double cutoff_m;\n"
          "    size_t targets, num_targets, tracks, num_tracks;\n"
          "    double gospa_m, ospa_m, localisation_m2;\n    int pairs;\n} gospa_cases[] = {")
    print("\n".join(rows))
    print("};\n\n#endif")


def compare():
    """The same cases through Stone Soup: largest difference from metrics(), relative to the
    value."""
    import datetime

    import stonesoup
    from stonesoup.metricgenerator.ospametric import GOSPAMetric, OSPAMetric
    from stonesoup.types.state import State

    def states(points):
        return [
            State(numpy.array(point).reshape(3, 1), timestamp=datetime.datetime(2000, 1, 1))
            for point in points
        ]

    def ospa_paired_by_d():
        few, many = sorted((targets, tracks), key=len)
        cut = numpy.minimum(distances(few, many), cutoff)
        least = math.fsum(cut[linear_sum_assignment(cut)] ** 2)
        return math.sqrt((least + cutoff ** 2 * (len(many) - len(few))) / len(many))

    worst = dict.fromkeys(("gospa", "parts", "ospa above", "ospa below", "ospa paired by d"), 0.0)
    counted = larger = 0
    for name, cutoff, targets, tracks, has_ties in make_cases(random.Random(20)):
        targets, tracks = rounded(targets), rounded(tracks)
        if not targets + tracks:
            continue
        counted += 1
        gospa, ospa, localisation, pairs = metrics(cutoff, targets, tracks)
        value = GOSPAMetric(p=2, c=cutoff).compute_gospa_metric(states(tracks),
                                                                states(targets))[0].value
        missed = cutoff ** 2 / 2 * (len(targets) - pairs)
        false = cutoff ** 2 / 2 * (len(tracks) - pairs)
        theirs_ospa = OSPAMetric(p=2, c=cutoff).compute_OSPA_distance(states(tracks),
                                                                      states(targets)).value
        worst["gospa"] = max(worst["gospa"], abs(value["distance"] / gospa - 1.0))
        if not has_ties:
            ours = (localisation, missed, false)
            theirs = (value["localisation"], value["missed"], value["false"])
            worst["parts"] = max(worst["parts"],
                                 max(abs(a - b) for a, b in zip(ours, theirs)) / gospa**2)
        worst["ospa above"] = max(worst["ospa above"], theirs_ospa / ospa - 1.0)
        worst["ospa below"] = max(worst["ospa below"], 1.0 - theirs_ospa / ospa)
        if not has_ties:
            worst["ospa paired by d"] = max(worst["ospa paired by d"],
                                            abs(theirs_ospa / ospa_paired_by_d() - 1.0))
        larger += theirs_ospa > ospa * (1.0 + 1e-9)
        print(
            f"{name:32} gospa {gospa:14.6f} {value['distance']:14.6f}   "
            f"ospa {ospa:12.6f} {theirs_ospa:12.6f}"
        )
    print(
        f"Stone Soup {stonesoup.__version__}, {counted} cases, OSPA larger in {larger}; "
        "worst, relative:"
    )
    print("\n".join(f"  {name:24} {value:.2g}" for name, value in worst.items()))


if __name__ == "__main__":
    if sys.argv[1:] == ["--compare"]:
        compare()
    else:
        write()
