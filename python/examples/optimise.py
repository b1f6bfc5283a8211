"""The speed at which the bearing of a crank reaches the moment it may carry, by scipy.optimize."""

from __future__ import annotations

from pathlib import Path

from scipy.optimize import minimize_scalar

import linkwear as lw

mechanism = lw.compile(Path(__file__).parents[2] / "mechanisms" / "rssr_rigid.toml")


def peak_moment(speed: float) -> float:
    """The largest moment that the bearing of the crank carries in a turn [N m]."""
    motion = mechanism.with_parameters(speed=f"{speed} Hz").simulate(turns=1, samples=3)
    peak: float = next(peak.moment_N_m for peak in motion.peaks if peak.joint == "R1")
    return peak


LIMIT = 10.0
found = minimize_scalar(lambda speed: (peak_moment(speed) - LIMIT) ** 2, bounds=(5, 15), method="bounded")
print(f"the bearing of the crank carries {LIMIT:g} N m at {found.x:.4f} Hz: {peak_moment(found.x):.6f} N m")
assert abs(peak_moment(found.x) - LIMIT) < 1e-3
