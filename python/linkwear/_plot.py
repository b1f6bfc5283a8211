"""Pictures, by matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._fit import Fit, Prediction
    from ._results import Life, Motion

#: Curves of a motion unless others are named.
_CURVES = 6


def motion(motion: Motion, columns: Sequence[str], ax: Axes | None) -> Axes:
    """Curves over time."""
    if not columns:
        angles = [name for name in motion.columns if name.split(" ")[0].endswith(".q")]
        columns = (angles or motion.columns[1:])[:_CURVES]
    if ax is None:
        _, ax = plt.subplots(layout="constrained")
    for name in columns:
        ax.plot(motion.t, motion[name], label=name)
    units = {name.rpartition("[")[2].rstrip("]") for name in columns if "[" in name}
    if len(units) == 1:
        ax.set_ylabel(f"[{units.pop()}]")
    ax.set_xlabel("t [s]")
    ax.set_title(motion.name)
    ax.legend()
    return ax


def life(life: Life, ax: Any | None) -> Any:
    """Wear of the mean path over cycles; the part of the lives that is longer."""
    has_lives = "reliability" in life
    if ax is None:
        _, ax = plt.subplots(1, 2 if has_lives else 1, layout="constrained", figsize=(9 if has_lives else 5, 3.8))
    axes = np.atleast_1d(ax)
    cycles = life.cycles_to_pandas()
    for joint, rows in cycles.groupby("joint"):
        axes[0].plot(rows["cycle"], 1e6 * rows["wear_m"], label=f"{joint}, mean path")
    axes[0].set_xlabel("cycles")
    axes[0].set_ylabel("wear [um]")
    axes[0].set_title(life.name)
    axes[0].legend()
    if has_lives and len(axes) > 1:
        points = life["reliability"]
        axes[1].step([point.cycles for point in points], [point.reliability for point in points], where="post")
        axes[1].axvline(life.quantiles.p10, linestyle=":", color="grey", label=f"B10: {life.quantiles.p10:.4g}")
        axes[1].set_xlabel("cycles")
        axes[1].set_ylabel("part of the lives that is longer")
        axes[1].set_ylim(0, 1.02)
        axes[1].legend()
    return ax


def fit(fit: Fit, ax: Axes | None) -> Axes:
    """Quantiles of what was measured against those of the process; on the line where it is right."""
    if ax is None:
        _, ax = plt.subplots(layout="constrained")
    expected, measured = np.asarray(fit.goodness["quantiles"], dtype=float).T
    ends = [min(expected.min(), measured.min()), max(expected.max(), measured.max())]
    ax.plot(ends, ends, color="grey", label=f"the {fit.process} process")
    ax.plot(expected, measured, ".", label=f"{len(measured)} increments of {fit.units} units")
    ax.set_xlabel(f"{fit.wear_unit}, by the process")
    ax.set_ylabel(f"{fit.wear_unit}, measured")
    ax.legend()
    return ax


def prediction(prediction: Prediction, ax: Axes | None) -> Axes:
    """Reliability over time, with its band."""
    if ax is None:
        _, ax = plt.subplots(layout="constrained")
    points = prediction.reliability
    times = [point.time for point in points]
    ax.fill_between(times, [point.lower for point in points], [point.upper for point in points], alpha=0.2, label="95 %")
    ax.plot(times, [point.reliability for point in points], label="reliability")
    ax.set_xlabel("time")
    ax.set_ylim(0, 1.02)
    ax.legend()
    return ax
