"""SciPy integrates the pendulum, and meets linkwear's own run."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

import linkwear as lw

mechanism = lw.compile(Path(__file__).parents[2] / "mechanisms" / "pendulum.toml")
state = mechanism.state_space()
times = np.linspace(0, 2, 201)
solution = solve_ivp(state.derivative, (0, 2), state.start, method="DOP853", t_eval=times, rtol=1e-10, atol=1e-12)
motion = mechanism.simulate(time=2, samples=201)
apart = np.abs(solution.y[0] - motion["hinge.q"]).max()
print(f"the angles of SciPy and linkwear are {apart:.1e} rad apart")
assert apart < 1e-7
