#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the reference vectors of the unit tests: tests/vectors/make_linalg_angle_kalman_vectors.py

Double precision, standard library only. Inputs are rounded to float32 first, so that library and
reference start from the same numbers. The filter is the textbook one: matrices, the vector update
with an inverse, Joseph's form; nothing of it is shared with the library.
"""

import math
import pathlib
import random
import struct

FOLDER = pathlib.Path(__file__).resolve().parent
HEADER = """/* SPDX-License-Identifier: MIT */
/* Made by tests/vectors/make_linalg_angle_kalman_vectors.py; do not edit. */
/* clang-format off */
#ifndef RHOTRACK_TESTS_{0}_VECTORS_H
#define RHOTRACK_TESTS_{0}_VECTORS_H

{1}
#endif
"""


def single(value):
    """The float32 nearest to value."""
    return struct.unpack("<f", struct.pack("<f", value))[0]


def singles(values):
    return [single(v) for v in values]


def as_float(value):
    text = f"{value:.9g}"
    return (text if "." in text or "e" in text else text + ".0") + "f"


def as_double(value):
    text = f"{value:.13g}"
    return text if "." in text or "e" in text else text + ".0"


def in_braces(values, form):
    return "{" + ", ".join(form(v) for v in values) + "}"


def write(name, parts):
    text = HEADER.format(name.upper(), "\n".join(parts))
    (FOLDER / f"{name}_vectors.h").write_text(text, encoding="ascii")


# --- matrices: lists of rows -------------------------------------------------------------------


def product(a, b):
    columns = list(zip(*b))
    return [[math.fsum(x * y for x, y in zip(row, column)) for column in columns] for row in a]


def transposed(a):
    return [list(column) for column in zip(*a)]


def combined(a, b, factor):
    return [[x + factor * y for x, y in zip(p, q)] for p, q in zip(a, b)]


def identity(n):
    return [[float(i == j) for j in range(n)] for i in range(n)]


def inverse(a):
    """Gauss and Jordan with pivoting."""
    n = len(a)
    rows = [list(row) + unit for row, unit in zip(a, identity(n))]
    for i in range(n):
        best = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[best] = rows[best], rows[i]
        rows[i] = [v / rows[i][i] for v in rows[i]]
        for k in range(n):
            if k != i:
                rows[k] = [v - rows[k][i] * w for v, w in zip(rows[k], rows[i])]
    return [row[n:] for row in rows]


def cholesky(a):
    n = len(a)
    factor = [[0.0] * n for _ in range(n)]
    for i in range(n):
        for j in range(i + 1):
            rest = a[i][j] - math.fsum(factor[i][k] * factor[j][k] for k in range(j))
            factor[i][j] = math.sqrt(rest) if i == j else rest / factor[j][j]
    return factor


def triangle(a):
    return [a[i][j] for i in range(len(a)) for j in range(i + 1)]


def square(packed, n):
    return [[packed[max(i, j) * (max(i, j) + 1) // 2 + min(i, j)] for j in range(n)]
            for i in range(n)]


def random_covariance(rng, n, sigmas, correlation):
    """Positive definite, float32; correlation 0 .. 1 sets how nearly singular."""
    a = [[rng.uniform(-1.0, 1.0) for _ in range(n)] for _ in range(n)]
    gram = combined(product(a, transposed(a)), identity(n), (1.0 - correlation) * n)
    scale = [s / math.sqrt(gram[i][i]) for i, s in enumerate(sigmas)]
    full = [[gram[i][j] * scale[i] * scale[j] for j in range(n)] for i in range(n)]
    return square(singles(triangle(full)), n)


# --- linalg ------------------------------------------------------------------------------------


def cholesky_vectors(rng):
    lines = ["struct cholesky_vector {\n    int n;\n    float a[78], b[12];\n"
             "    double factor[78], forward[12], log_determinant;\n};\n",
             "static const struct cholesky_vector cholesky_vectors[] = {"]
    for n in range(1, 13):
        for correlation in (0.2, 0.9):
            sigmas = [10.0 ** rng.uniform(-1.0, 2.0) for _ in range(n)]
            a = random_covariance(rng, n, sigmas, correlation)
            b = singles(rng.uniform(-3.0, 3.0) * s for s in sigmas)
            factor = cholesky(a)
            forward = [row[0] for row in product(inverse(factor), [[v] for v in b])]
            log_determinant = 2.0 * math.fsum(math.log(factor[i][i]) for i in range(n))
            lines.append(f"    {{{n},\n     {in_braces(triangle(a), as_float)},\n"
                         f"     {in_braces(b, as_float)},\n"
                         f"     {in_braces(triangle(factor), as_double)},\n"
                         f"     {in_braces(forward, as_double)},\n"
                         f"     {as_double(log_determinant)}}},")
    return lines + ["};\n"]


def gate_vectors(rng, n):
    size = n * (n + 1) // 2
    lines = [f"struct gate{n}_vector {{\n    float s[{size}], d[{n}];\n"
             "    double distance2, log_det;\n};\n",
             f"static const struct gate{n}_vector gate{n}_vectors[] = {{"]
    for i in range(60):
        sigmas = [10.0 ** rng.uniform(-1.0, 3.0) for _ in range(n)]
        s = random_covariance(rng, n, sigmas, rng.choice((0.0, 0.5, 0.99)))
        d = singles(rng.gauss(0.0, 1.0 + i % 4) * sigma for sigma in sigmas)
        column = [[v] for v in d]
        distance2 = product(transposed(column), product(inverse(s), column))[0][0]
        log_det = 2.0 * math.fsum(math.log(cholesky(s)[i][i]) for i in range(n))
        lines.append(f"    {{{in_braces(triangle(s), as_float)}, {in_braces(d, as_float)},\n"
                     f"     {as_double(distance2)}, {as_double(log_det)}}},")
    return lines + ["};\n"]


def make_linalg():
    rng = random.Random(20240611)
    write("linalg", cholesky_vectors(rng) + gate_vectors(rng, 2) + gate_vectors(rng, 3))


# --- angle -------------------------------------------------------------------------------------


def wrapped(angle):
    return angle - 2.0 * math.pi * math.floor(angle / (2.0 * math.pi) + 0.5)


def make_angle():
    rng = random.Random(7)
    turns = [(k + e) * math.pi / 2.0 for k in range(-60, 61, 3) for e in (-1e-5, 0.0, 1e-5)]
    angles = singles(turns + [rng.uniform(-100.0, 100.0) for _ in range(120)])
    lines = ["struct angle_vector {\n    float a_rad, b_rad;\n    double wrap, difference;\n};\n",
             "static const struct angle_vector angle_vectors[] = {"]
    for a in angles:
        b = rng.choice(angles)
        lines.append(f"    {{{as_float(a)}, {as_float(b)}, {as_double(wrapped(a))}, "
                     f"{as_double(wrapped(a - b))}}},")
    lines += ["};\n", "struct line_vector {\n    float x_m, y_m, dx, dy;\n"
              "    double rho_m, theta_rad;\n};\n",
              "static const struct line_vector line_vectors[] = {"]
    for i in range(200):
        reach = (1.0, 1.0e3, 1.0e5, 2.0e6)[i % 4]
        x, y = singles((rng.uniform(-reach, reach), rng.uniform(-reach, reach)))
        heading = rng.uniform(-math.pi, math.pi) if i % 5 else rng.randrange(-4, 5) * math.pi / 4.0
        size = 10.0 ** rng.uniform(-30.0, 30.0)
        dx, dy = singles((size * math.cos(heading), size * math.sin(heading)))
        theta = math.atan2(dx, -dy)
        if theta < 0.0:
            theta += math.pi
        if theta >= math.pi:
            theta -= math.pi
        rho = x * math.cos(theta) + y * math.sin(theta)
        lines.append(f"    {{{in_braces((x, y, dx, dy), as_float)[1:-1]}, {as_double(rho)}, "
                     f"{as_double(theta)}}},")
    write("angle", lines + ["};\n"])


# --- kalman ------------------------------------------------------------------------------------


def predict(x, p, dt, density, axes):
    f, q = identity(6), [[0.0] * 6 for _ in range(6)]
    for a in range(3):
        f[a][a + 3] = dt
        if a in axes and dt > 0.0:
            q[a][a] = density * dt ** 3 / 3.0
            q[a][a + 3] = q[a + 3][a] = density * dt ** 2 / 2.0
            q[a + 3][a + 3] = density * dt
    return product(f, x), combined(product(product(f, p), transposed(f)), q, 1.0)


def update(x, p, elements, values, variances):
    """The vector update of several elements at once; returns their joint NIS."""
    h = [[float(j == e) for j in range(6)] for e in elements]
    r = [[v if i == j else 0.0 for j in range(len(elements))] for i, v in enumerate(variances)]
    s = combined(product(product(h, p), transposed(h)), r, 1.0)
    s_inverse = inverse(s)
    gain = product(product(p, transposed(h)), s_inverse)
    innovation = combined([[v] for v in values], product(h, x), -1.0)
    rest = combined(identity(6), product(gain, h), -1.0)
    p = combined(product(product(rest, p), transposed(rest)),
                 product(product(gain, r), transposed(gain)), 1.0)
    nis = product(transposed(innovation), product(s_inverse, innovation))[0][0]
    return combined(x, product(gain, innovation), 1.0), p, nis


# name, open axes, measured elements, coupled start, noise density, longest dt, sigmas, going back
SEQUENCES = (
    ("plane", (0, 1), (0, 1), False, 1.0, 8.0, 50.0, False),
    ("space", (0, 1, 2), (0, 1, 2), False, 4.0, 5.0, 20.0, False),
    ("all six elements", (0, 1, 2), (0, 1, 2, 3, 4, 5), False, 0.5, 2.0, 10.0, False),
    ("coupled axes", (0, 1, 2), (0, 1, 2), True, 2.0, 4.0, 30.0, False),
    ("coupled, six elements, back", (0, 1, 2), (0, 1, 2, 3, 4, 5), True, 10.0, 2.0, 5.0, True),
    ("no noise", (0, 1), (0, 1), False, 0.0, 3.0, 15.0, True),
)
STEPS = 50


def start_of(rng, axes, coupled, sigma):
    """A start as float32: state, covariance."""
    sigmas = [sigma] * 3 + [sigma * 2.0] * 3
    p = [[sigmas[i] ** 2 * (i == j) for j in range(6)] for i in range(6)]
    if coupled:
        p = random_covariance(rng, 6, sigmas, 0.7)
    is_open = [i % 3 in axes for i in range(6)]
    p = [[p[i][j] if is_open[i] and is_open[j] else 0.0 for j in range(6)] for i in range(6)]
    x = [rng.uniform(-5.0e3, 5.0e3) for _ in range(3)] + [rng.uniform(-200.0, 200.0)
                                                          for _ in range(3)]
    return singles(v if o else 0.0 for v, o in zip(x, is_open)), square(singles(triangle(p)), 6)


def sequence_steps(rng, sequence, x, p):
    """Simulated and filtered: one line a step, and the last covariance."""
    _, axes, elements, _, density, dt_max, sigma, goes_back = sequence
    truth = [v[0] + rng.gauss(0.0, math.sqrt(p[i][i])) for i, v in enumerate(x)]
    lines = []
    for k in range(STEPS):
        dt = single(rng.uniform(0.05, dt_max) * (-0.5 if goes_back and k % 7 == 6 else 1.0))
        truth = [truth[a] + dt * truth[a + 3] for a in range(3)] + [
            v + rng.gauss(0.0, math.sqrt(density * abs(dt))) if v else 0.0 for v in truth[3:]]
        scale = [rng.uniform(0.5, 2.0) for _ in elements]
        sigmas = [sigma * s * (1.0 if e < 3 else 0.1) for e, s in zip(elements, scale)]
        values = singles(truth[e] + rng.gauss(0.0, s) for e, s in zip(elements, sigmas))
        variances = singles(s * s for s in sigmas)
        x, p = predict(x, p, dt, density, axes)
        x, p, nis = update(x, p, elements, values, variances)
        pad = [0.0] * (6 - len(elements))
        lines.append(f"      {{{as_float(dt)}, {in_braces(values + pad, as_float)},\n"
                     f"       {in_braces(variances + pad, as_float)},\n"
                     f"       {in_braces([v[0] for v in x], as_double)},\n"
                     f"       {in_braces([p[i][i] for i in range(6)], as_double)}, "
                     f"{as_double(nis)}}},")
    return lines, p


def make_kalman():
    rng = random.Random(1960)
    lines = [f"#define KALMAN_STEPS {STEPS}\n",
             "/* Elements 0 .. num_elements - 1 are measured at every step. */",
             "struct kalman_step {\n    float dt_s, values[6], variances[6];\n"
             "    double state[6], diagonal[6], nis;\n};\n",
             "struct kalman_sequence {\n    const char *name;\n    int num_elements;\n"
             "    float noise_density, state[6], covariance[21];\n"
             "    struct kalman_step steps[KALMAN_STEPS];\n    double last_covariance[21];\n};\n",
             "static const struct kalman_sequence kalman_sequences[] = {"]
    for sequence in SEQUENCES:
        name, axes, elements, coupled, density, _, sigma, _ = sequence
        state, p = start_of(rng, axes, coupled, sigma)
        steps, last = sequence_steps(rng, sequence, [[v] for v in state], p)
        lines.append(f'    {{"{name}", {len(elements)}, {as_float(density)},\n'
                     f"     {in_braces(state, as_float)},\n"
                     f"     {in_braces(triangle(p), as_float)},\n     {{")
        lines += steps + ["     },", f"     {in_braces(triangle(last), as_double)}}},"]
    write("kalman", lines + ["};\n"])


if __name__ == "__main__":
    make_linalg()
    make_angle()
    make_kalman()
