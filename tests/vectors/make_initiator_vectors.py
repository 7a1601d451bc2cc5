#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Scores and fits of plot sets in double precision: the reference of
tests/unit/initiation/test_initiator.c.

Usage: make_initiator_vectors.py > initiator_vectors.h   (in tests/vectors)

The score is derived independently of the library: generalised least squares with the full
covariance matrix V = diag(sigma^2) + K and dense elimination, ln of the ratio of the plots' density
as one straight target's, position and velocity integrated out, to their density as clutter.
"""
import math
import random

AREA = (-20000.0, 20000.0, -20000.0, 20000.0)
PD, V_MIN, V_MAX = 0.9, 0.0, 700.0


def solve(matrix, columns):
    """Gauss elimination with pivoting; returns the solutions and ln |det|."""
    n = len(matrix)
    rows = [list(matrix[i]) + [column[i] for column in columns] for i in range(n)]
    log_det = 0.0
    for i in range(n):
        pivot = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        log_det += math.log(abs(rows[i][i]))
        for r in range(n):
            if r != i:
                factor = rows[r][i] / rows[i][i]
                rows[r] = [a - factor * b for a, b in zip(rows[r], rows[i])]
    return [[rows[i][n + c] / rows[i][i] for i in range(n)] for c in range(len(columns))], log_det


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def displacement(times, l, m):
    """Integral response at scan m to a unit acceleration from scan l to l + 1."""
    if m <= l:
        return 0.0
    d = times[l + 1] - times[l]
    return d * d / 2 + d * (times[m] - times[l + 1])


def covariance(times, hits, sigmas, q):
    def k(m, n):
        return q * q * sum(
            displacement(times, l, m) * displacement(times, l, n) for l in range(len(times) - 1))
    return [[k(m, n) + (sigmas[m] ** 2 if m == n else 0.0) for n in hits] for m in hits]


def score(times, hits, sigmas, xs, ys, q):
    """The plots seen are all there are, so the density is their number over area and scans, at
    least one a scan."""
    n, h = len(times), len(hits)
    area = (AREA[1] - AREA[0]) * (AREA[3] - AREA[2])
    density = max(h / (n * area), 1 / area)
    v = covariance(times, hits, sigmas, q)
    one, t = [1.0] * h, [times[m] for m in hits]
    x, y = [xs[m] for m in hits], [ys[m] for m in hits]
    (vi_one, vi_t, vi_x, vi_y), log_det_v = solve(v, [one, t, x, y])
    f = [[dot(one, vi_one), dot(one, vi_t)], [dot(one, vi_t), dot(t, vi_t)]]
    chi2 = 0.0
    for z, vi_z in ((x, vi_x), (y, vi_y)):
        b = [dot(one, vi_z), dot(t, vi_z)]
        (solution,), log_det_f = solve(f, [b])
        chi2 += dot(z, vi_z) - dot(b, solution)
    result = h * math.log(PD / density) + (n - h) * math.log(1 - PD)
    result += math.log(0.5 / (area * math.pi * (V_MAX ** 2 - V_MIN ** 2)))
    return result - (h - 2) * math.log(2 * math.pi) - log_det_v - log_det_f - chi2 / 2


def fit(times, hits, sigmas, zs):
    """Weighted straight line: value and slope at the last scan."""
    w = [1 / sigmas[m] ** 2 for m in hits]
    t = [times[m] - times[-1] for m in hits]
    z = [zs[m] for m in hits]
    s, st, stt = sum(w), dot(w, t), sum(a * b * b for a, b in zip(w, t))
    sz, stz = dot(w, z), sum(a * b * c for a, b, c in zip(w, t, z))
    det = s * stt - st * st
    return (stt * sz - st * stz) / det, (s * stz - st * sz) / det


def make_case(rng, number):
    n = 5 + number % 3
    q = (0.0, 0.0, 2.0)[number % 3]
    times = [0.0]
    while len(times) < n:
        times.append(times[-1] + rng.choice((1.0, 2.0, 2.5, 4.0)))
    sigmas = [rng.choice((8.0, 10.0, 20.0)) for _ in range(n)]
    x0, y0 = rng.uniform(-5000, 5000), rng.uniform(-5000, 5000)
    heading, speed = rng.uniform(0, 2 * math.pi), rng.uniform(100, 400)
    xs = [
        round(x0 + speed * math.cos(heading) * t + rng.gauss(0, 0.7 * s)) + 0.0
        for t, s in zip(times, sigmas)
    ]
    ys = [
        round(y0 + speed * math.sin(heading) * t + rng.gauss(0, 0.7 * s)) + 0.0
        for t, s in zip(times, sigmas)
    ]
    hits = [m for m in range(n) if m in (0, n - 1) or rng.random() < 0.8]
    while len(hits) < 4:
        hits = sorted(set(hits) | {rng.randrange(n)})
    return times, hits, sigmas, xs, ys, q


def padded(values, size, form):
    values = list(values) + [0] * (size - len(values))
    return "{" + ", ".join(form % v for v in values) + "}"


def main():
    rng = random.Random(20)
    print("/* Made by tests/vectors/make_initiator_vectors.py: do not edit. clang-format off */")
    print("#define VECTOR_PD %.1ff\n#define VECTOR_V_MAX_MPS %.1ff\n#define VECTOR_SIDE_M %.1ff" %
          (PD, V_MAX, AREA[1]))
    print(
        "static const struct {\n    int num_scans;\n    unsigned mask;\n"
        "    double process_noise_mps2;"
    )
    print(
        "    double t_s[7], sigma_m[7], x_m[7], y_m[7];\n"
        "    double score_nat, x_last_m, y_last_m, vx_mps, vy_mps;"
    )
    print("} initiator_vectors[] = {")
    for number in range(30):
        times, hits, sigmas, xs, ys, q = make_case(rng, number)
        x, vx = fit(times, hits, sigmas, xs)
        y, vy = fit(times, hits, sigmas, ys)
        print("    {%d, 0x%xu, %.1f," % (len(times), sum(1 << m for m in hits), q))
        print("     %s, %s," % (padded(times, 7, "%.1f"), padded(sigmas, 7, "%.1f")))
        print("     %s, %s," % (padded(xs, 7, "%.1f"), padded(ys, 7, "%.1f")))
        print("     %.9f, %.6f, %.6f, %.7f, %.7f}," %
              (score(times, hits, sigmas, xs, ys, q), x, y, vx, vy))
    print("};")


if __name__ == "__main__":
    main()
