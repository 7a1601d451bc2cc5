# SPDX-License-Identifier: MIT
"""References in double precision for targets that manoeuvre, from the textbook and with full
matrices, sharing nothing with the library: a Kalman filter that can be told the input, and an
interacting multiple model estimator (Blom and Bar-Shalom). Many runs are filtered side by side.

States are place, velocity and acceleration of three axes, (runs, 9); the first m elements are
measured. A model is (F, Q) of one interval.
"""
import numpy as np


def _of_axes(transition, noise):
    return np.kron(transition, np.eye(3)), np.kron(noise, np.eye(3))


def steady(dt_s, effect, accel_mps2):
    """Constant velocity without acceleration; in an interval an axis takes a random step, `effect`
    (place, velocity) times a normal number of standard deviation accel_mps2."""
    step = accel_mps2 * np.array([*effect, 0])
    return _of_axes([[1, dt_s, 0], [0, 1, 0], [0, 0, 0]], np.outer(step, step))


def noisy(dt_s, variance):
    """The same with noise of its own, of this variance, in place and velocity."""
    return _of_axes([[1, dt_s, 0], [0, 1, 0], [0, 0, 0]], np.diag([variance, variance, 0]))


def singer(dt_s, keep, step_mps2):
    """The acceleration decays by `keep` and takes steps of standard deviation step_mps2."""
    step = step_mps2 * np.array([dt_s**2 / 2, dt_s, 1])
    return _of_axes([[1, dt_s, dt_s**2 / 2], [0, 1, dt_s], [0, 0, keep]], np.outer(step, step))


def predict(mean, covariance, model, shift=0.0):
    """shift: what a known input adds to the state."""
    transition, noise = model
    return mean @ transition.T + shift, transition @ covariance @ transition.T + noise


def update(mean, covariance, measured, noise):
    """Returns mean and covariance, the NIS and ln of the density, less a constant."""
    m = measured.shape[-1]
    off, spread = measured - mean[..., :m], covariance[..., :m, :m] + noise
    gain = np.swapaxes(np.linalg.solve(spread, covariance[..., :m, :]), -1, -2)
    nis = (off * np.linalg.solve(spread, off[..., None])[..., 0]).sum(-1)
    covariance = covariance - gain @ covariance[..., :m, :]
    return (mean + (gain @ off[..., None])[..., 0],
            (covariance + np.swapaxes(covariance, -1, -2)) / 2,
            nis, -(nis + np.linalg.slogdet(spread)[1]) / 2)


def mixture(weights, means, covariances):
    """Mean and covariance over the first axis; weights (models, runs)."""
    mean = np.einsum("mr,mri->ri", weights, means)
    off = means - mean
    return mean, np.einsum("mr,mrij->rij", weights,
                           covariances + off[..., :, None] * off[..., None, :])


class Imm:
    """Models that last an interval with probability `stay`."""

    def __init__(self, models, stay, mean, covariance):
        count = len(models)
        self.models = models
        self.passage = np.full((count, count), (1 - stay) / max(count - 1, 1))
        np.fill_diagonal(self.passage, stay if count > 1 else 1.0)
        self.probability = np.full((count, len(mean)), 1 / count)
        self.mean = np.repeat(mean[None], count, axis=0)
        self.covariance = np.repeat(covariance[None], count, axis=0)
        for i, (transition, _) in enumerate(models):
            if not transition[6:, 6:].any():  # no acceleration
                self.mean[i, :, 6:] = 0
                self.covariance[i, :, 6:] = self.covariance[i, ..., 6:] = 0

    def predict(self):
        weights = self.passage[:, :, None] * self.probability[:, None]  # from, to, run
        self.probability = weights.sum(0)
        mixed = [mixture(weights[:, to] / self.probability[to], self.mean, self.covariance)
                 for to in range(len(self.models))]
        for i, model in enumerate(self.models):
            self.mean[i], self.covariance[i] = predict(*mixed[i], model)

    def update(self, measured, noise, is_fed):
        """Of the runs that are fed."""
        mean, covariance, _, log_likelihood = update(self.mean[:, is_fed],
                                                     self.covariance[:, is_fed],
                                                     measured[is_fed], noise[is_fed])
        self.mean[:, is_fed], self.covariance[:, is_fed] = mean, covariance
        weight = self.probability[:, is_fed] * np.exp(log_likelihood - log_likelihood.max(0))
        self.probability[:, is_fed] = weight / weight.sum(0)

    def estimate(self):
        return mixture(self.probability, self.mean, self.covariance)
