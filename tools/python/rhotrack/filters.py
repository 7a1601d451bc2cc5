# SPDX-License-Identifier: MIT
"""Parts of the tracker by themselves: Kalman filter, IMM, input estimation, Hough gate, ghosts.

States are [x y z vx vy vz], float32, metres and m/s; an axis that was never measured is closed, its
state and variances 0. Plots are one-row arrays, as Scans has them.
"""
from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ._core import (NULL, Error, Shared, array_of, ffi, in_turn, lib, must_succeed, names_of,
                    pointer_to)
from .scans import Scans
from .settings import Settings

REASONS = names_of(lib.rho_ghost_reason_name, lib.RHO_NUM_GHOST_REASONS)
LOWER = np.tril_indices(6)  # the packed triangle, row by row


def _matrix(triangle: Any) -> np.ndarray:
    matrix = np.zeros((6, 6), "f4")
    matrix[LOWER] = array_of(triangle, len(LOWER[0]), "f4")
    return matrix + np.tril(matrix, -1).T


class _Plot:
    """A plot of the library from a one-row array, with what keeps it alive."""

    def __init__(self, plot: np.ndarray, settings: Settings | None) -> None:
        self.scans = Scans([np.atleast_1d(plot)], settings)
        made = self.scans.handle.list[0]
        if made.is_frame or made.scan.num_plots != 1:
            raise Error("x_m, y_m: one plot is wanted")
        self.measures, self.plot = made.scan.measures, made.scan.plots
        self.sensor = ffi.addressof(made.sensor) if made.has_sensor else NULL


class Kalman(Shared):
    """Nearly constant velocity, updated by one scalar at a time (rhotrack/detail/kalman.h)."""

    def __init__(self) -> None:
        self.struct = ffi.new("struct rho_kalman *")

    @property
    @in_turn
    def state(self) -> np.ndarray:
        """(6,): x, y, z in m, vx, vy, vz in m/s."""
        return array_of(self.struct.state, 6, "f4")

    @property
    @in_turn
    def covariance(self) -> np.ndarray:
        """(6, 6), symmetric; m^2, m^2/s, m^2/s^2."""
        return _matrix(self.struct.covariance)

    @in_turn
    def open_axis(self, axis: int, position_m: float, position_variance: float,
                  velocity_variance: float) -> None:
        """Opens axis 0 (x), 1 or 2 with a first position (m, m^2) and velocity 0 (m^2/s^2)."""
        must_succeed(lib.rho_kalman_open_axis(self.struct, axis, position_m, position_variance,
                                              velocity_variance), "axis, position or variance")

    @in_turn
    def predict(self, dt_s: float, noise_density: float = 0.0) -> None:
        """Moves on by dt_s with white acceleration of noise_density, m^2/s^3."""
        must_succeed(lib.rho_kalman_predict(self.struct, dt_s, noise_density),
                     "dt_s or noise_density")

    @in_turn
    def update(self, element: int, value: float, variance: float) -> float:
        """Element 0 .. 5 of the state was measured; returns the NIS."""
        nis = ffi.new("float *")
        must_succeed(lib.rho_kalman_update(self.struct, element, value, variance, nis),
                     "element, value or variance")
        return nis[0]

    @in_turn
    def update_plot(self, plot: np.ndarray, velocity_variance: float,
                    settings: Settings | None = None) -> None:
        """Takes a plot's place, and its range rate if it has one; axes open with
        velocity_variance, m^2/s^2."""
        seen, measurement = _Plot(plot, settings), ffi.new("struct rho_measurement *")
        lib.rho_measurement_from_plot(seen.plot, seen.measures, seen.sensor, measurement)
        must_succeed(lib.rho_kalman_update_position(self.struct, measurement, velocity_variance),
                     "x_m, y_m, z_m or a sigma")
        if seen.measures & lib.RHO_MEASURES_RANGE_RATE:
            must_succeed(lib.rho_kalman_update_range_rate(
                self.struct, seen.sensor, seen.plot.range_rate_mps,
                seen.plot.sigma_range_rate_mps**2), "range_rate_mps or sigma_range_rate_mps")

    @in_turn
    def update_bearing(self, x_m: float, y_m: float, bearing_rad: float, sigma_rad: float) -> None:
        """Takes a bearing from a place (m, rad)."""
        must_succeed(lib.rho_kalman_update_bearing(self.struct, x_m, y_m, bearing_rad, sigma_rad),
                     "x_m, y_m, bearing_rad or sigma_rad")


class Imm(Shared):
    """Two models, steady and manoeuvring (rhotrack/detail/imm.h); starts from a Kalman."""

    def __init__(self, start: Kalman, accel_max_mps2: float = 30.0,
                 v_max_mps: float = 700.0) -> None:
        self.model, self.struct = ffi.new("struct rho_imm_model *"), ffi.new("struct rho_imm *")
        lib.rho_imm_model_default(self.model, accel_max_mps2, v_max_mps)
        if not lib.rho_imm_model_is_usable(self.model):
            raise Error("accel_max_mps2 or v_max_mps is out of range")
        with start._turn:
            lib.rho_imm_start(self.struct, self.model, start.struct)

    @in_turn
    def predict(self, dt_s: float) -> None:
        """Mixes the models, and moves both on."""
        step = ffi.new("struct rho_imm_step *")
        lib.rho_imm_prepare_step(step, self.model, dt_s)
        must_succeed(lib.rho_imm_predict(self.struct, step), "dt_s")

    @in_turn
    def update(self, plot: np.ndarray, settings: Settings | None = None) -> float | None:
        """Takes a plot; returns ln of its density, or None where it is outside of the gate."""
        seen, match = _Plot(plot, settings), ffi.new("struct rho_imm_match *")
        opened = ffi.new("struct rho_imm_plot *")
        lib.rho_imm_prepare_plot(opened, seen.plot, seen.measures, seen.sensor)
        if not lib.rho_imm_score_plot(self.struct, opened, match):
            return None
        must_succeed(lib.rho_imm_update(self.struct, self.model, opened, match), "plot")
        return match.log_likelihood

    @property
    @in_turn
    def maneuver_probability(self) -> float:
        """Of the manoeuvring model."""
        return self.struct.probability

    @property
    @in_turn
    def estimate(self) -> Kalman:
        """The mean over both models, and its covariance."""
        estimate = Kalman()
        lib.rho_imm_estimate(self.struct, estimate.struct, NULL)
        return estimate

    @property
    @in_turn
    def accel_mps2(self) -> np.ndarray:
        """(3,), m/s^2."""
        accel = ffi.new("float[3]")
        lib.rho_imm_estimate(self.struct, Kalman().struct, accel)
        return array_of(accel, 3, "f4")


class InputEstimation(Shared):
    """A Kalman filter that estimates the target's acceleration
    (rhotrack/detail/input_estimation.h).

    Fields of struct rho_input_config set by name, as gamma=0.9; model: "literal" or "physical".
    """

    def __init__(self, start: Kalman, model: str = "literal", onset_confidence: float = 0.95,
                 **config: float) -> None:
        models = {"literal": lib.RHO_INPUT_LITERAL, "physical": lib.RHO_INPUT_PHYSICAL}
        if model not in models:
            raise Error(f"model {model!r} is neither literal nor physical")
        self.config = ffi.new("struct rho_input_config *")
        self.struct = ffi.new("struct rho_input *")
        lib.rho_input_config_default(self.config)
        self.config.model = models[model]
        self.config.threshold = lib.rho_input_threshold_sigmas(onset_confidence)
        for name, value in config.items():
            if not hasattr(self.config, name):
                raise Error(f"there is no {name} of struct rho_input_config")
            setattr(self.config, name, value)
        with start._turn:
            must_succeed(lib.rho_input_start(self.struct, self.config, start.struct),
                         ", ".join(config) or "onset_confidence or start")

    @in_turn
    def predict(self, dt_s: float) -> None:
        """Moves on by dt_s."""
        must_succeed(lib.rho_input_predict(self.struct, self.config, dt_s), "dt_s")

    @in_turn
    def update(self, element: int, value: float, variance: float) -> None:
        """Element 0 .. 5 of the state was measured."""
        must_succeed(
            lib.rho_input_update_element(self.struct, self.config, element, value,
                                                   variance),
            "element, value or variance")

    @in_turn
    def update_plot(self, plot: np.ndarray, settings: Settings | None = None) -> None:
        """Takes a plot's place."""
        seen, measurement = _Plot(plot, settings), ffi.new("struct rho_measurement *")
        lib.rho_measurement_from_plot(seen.plot, seen.measures, seen.sensor, measurement)
        must_succeed(lib.rho_input_update_position(self.struct, self.config, measurement),
                     "x_m, y_m, z_m or a sigma")

    @in_turn
    def decide(self) -> None:
        """Tests each axis for an input; once a scan, after its updates."""
        lib.rho_input_decide(self.struct, self.config)

    @property
    @in_turn
    def estimate(self) -> Kalman:
        """The corrected estimate."""
        estimate = Kalman()
        lib.rho_input_estimate(self.struct, estimate.struct)
        return estimate

    @property
    @in_turn
    def input_mps2(self) -> np.ndarray:
        """(3,), m/s^2; is_present says which count."""
        return array_of(self.struct.input_mps2, 3, "f4")

    @property
    @in_turn
    def is_present(self) -> np.ndarray:
        """(3,), bool."""
        return (self.struct.present >> np.arange(3) & 1).astype(bool)


class HoughGate:
    """Hough clutter elimination: the plot whose velocity best continues the last two estimates
    (rhotrack/detail/gate.h). Velocities are (3,), m/s; planes as "xy" or "xy+xz+yz"."""

    def __init__(self, before_mps: Any, newest_mps: Any, planes: str = "xy+xz+yz",
                 gate_theta_deg: float = 5.0) -> None:
        bits = {"xy": 1, "xz": 2, "yz": 4}
        if np.shape(before_mps) != (3,) or np.shape(newest_mps) != (3,):
            raise Error("before_mps and newest_mps: three components are wanted")
        if not set(planes.split("+")) <= set(bits):
            raise Error(f"planes {planes!r}: xy, xz and yz, joined by +")
        self.struct = ffi.new("struct rho_gate_hough *")
        must_succeed(lib.rho_gate_hough_init(
            self.struct, sum(bits[one] for one in set(planes.split("+"))),
            np.deg2rad(gate_theta_deg), [float(v) for v in before_mps],
            [float(v) for v in newest_mps]), "before_mps, newest_mps or gate_theta_deg")

    def residuals_mps(self, velocities_mps: Any) -> np.ndarray:
        """(n,), m/s, of (n, 3) velocities: the least is the target's."""
        velocities = np.ascontiguousarray(np.atleast_2d(velocities_mps), "f4")
        if velocities.ndim != 2 or velocities.shape[1] != 3:
            raise Error(f"velocities_mps: (n, 3) is wanted, not {velocities.shape}")
        return np.array([
            lib.rho_gate_hough_distance_mps(self.struct,
                                                                pointer_to(one, "float *"))
            for one in velocities], "f4")


class Ghosts(NamedTuple):
    """Matrices of the shape (bearings of a, bearings of b): delta_rad, the angle between two, 0 for
    ghosts; reason, "kept" or why the crossing is a ghost: "sides", "apart", "range", "row",
    "column", "unmatched"; x_m and y_m, where those that are kept cross, else NaN."""
    delta_rad: np.ndarray
    reason: np.ndarray
    x_m: np.ndarray
    y_m: np.ndarray


def ghosts(bearings_a_rad: Any, bearings_b_rad: Any, place_a_m: tuple[float, float],
           place_b_m: tuple[float, float], range_max_m: float, prune: str = "safe") -> Ghosts:
    """The ghost matrix of two sensors' bearings; prune: "safe", "literal" or "none"."""
    rules = {"safe": lib.RHO_GHOST_SAFE, "literal": lib.RHO_GHOST_LITERAL,
             "none": lib.RHO_GHOST_NO_RULE}
    if prune not in rules:
        raise Error(f"prune {prune!r} is none of {', '.join(rules)}")
    base, matrix = ffi.new("struct rho_crossing_base *"), ffi.new("struct rho_ghost_matrix *")
    must_succeed(lib.rho_crossing_set_base(base, *place_a_m, *place_b_m), "place_a_m or place_b_m")
    a, b = (np.ascontiguousarray(one, "f4") for one in (bearings_a_rad, bearings_b_rad))
    if a.ndim != 1 or b.ndim != 1:
        raise Error(f"bearings_a_rad, bearings_b_rad: lists are wanted, not {a.shape}, {b.shape}")
    must_succeed(lib.rho_ghost_fill(matrix, base, pointer_to(a, "float *"), len(a),
                                    pointer_to(b, "float *"), len(b), range_max_m),
                 "bearings_a_rad, bearings_b_rad or range_max_m")
    lib.rho_ghost_prune(matrix, rules[prune])
    side, shape = lib.RHO_MAX_BEARINGS, np.s_[:len(a), :len(b)]
    delta = array_of(matrix.delta_rad, side * side, "f4").reshape(side, side)[shape]
    reason = REASONS[array_of(matrix.reason, side * side, "u1").reshape(side, side)[shape]]
    x_m, y_m = np.full(reason.shape, np.nan, "f4"), np.full(reason.shape, np.nan, "f4")
    crossing = ffi.new("struct rho_crossing *")
    for i, j in np.argwhere(reason == "kept"):
        if lib.rho_crossing_find(base, a[i], b[j], range_max_m, crossing) == lib.RHO_CROSSING_MEETS:
            x_m[i, j], y_m[i, j] = crossing.x_m, crossing.y_m
    return Ghosts(delta, reason, x_m, y_m)
