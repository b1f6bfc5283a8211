"""An unscented Kalman filter follows a pendulum by its noisy angle: all sigma points in one call."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import linkwear as lw

mechanism = lw.compile(Path(__file__).parents[2] / "mechanisms" / "pendulum.toml")
accelerations = mechanism.function("accelerations")

STEP = 0.01  # [s]
NOISE = 0.02  # standard deviation of an angle that is read [rad]
PROCESS = np.diag([1e-10, 1e-8])


def derivative(states: NDArray[np.float64]) -> NDArray[np.float64]:
    """(q', v') of states (quantity, lane)."""
    answers = accelerations.split(accelerations(states[:1], states[1:]))
    return np.vstack([states[1:], answers["accelerations"]])


def advanced(states: NDArray[np.float64]) -> NDArray[np.float64]:
    """A step of the fourth-order Runge-Kutta method, all lanes at once."""
    k1 = derivative(states)
    k2 = derivative(states + 0.5 * STEP * k1)
    k3 = derivative(states + 0.5 * STEP * k2)
    k4 = derivative(states + STEP * k3)
    return states + STEP / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def sigma_points(mean: NDArray[np.float64], covariance: NDArray[np.float64]) -> NDArray[np.float64]:
    """2 n + 1 states, (quantity, lane)."""
    root = np.linalg.cholesky(3 * covariance)
    return np.column_stack([mean, mean[:, None] + root, mean[:, None] - root])


WEIGHTS = np.array([1 / 3] + 4 * [1 / 6])

random = np.random.default_rng(1)
truth = mechanism.simulate(time=4, samples=401)
angles, speeds = truth["hinge.q"], truth["hinge.v"]
readings = angles + NOISE * random.standard_normal(len(angles))

mean, covariance = np.array([readings[0], 0.0]), np.diag([NOISE**2, 4.0])
errors = []
for reading, angle, speed in zip(readings[1:], angles[1:], speeds[1:]):
    states = advanced(sigma_points(mean, covariance))
    mean = states @ WEIGHTS
    apart = states - mean[:, None]
    covariance = (WEIGHTS * apart) @ apart.T + PROCESS
    gain = covariance[:, 0] / (covariance[0, 0] + NOISE**2)
    mean = mean + gain * (reading - mean[0])
    covariance = covariance - np.outer(gain, covariance[0])
    errors.append((mean[0] - angle, mean[1] - speed))
settled = np.sqrt(np.mean(np.square(errors[200:]), axis=0))
print(f"angle to {settled[0]:.1e} rad (readings: {NOISE:g}), speed to {settled[1]:.1e} rad/s")
assert settled[0] < NOISE / 3
