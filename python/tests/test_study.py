"""Studies: the same rows as the command line."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from conftest import file

import linkwear as lw


def test_a_grid(command_line: Any) -> None:
    vary = ["--vary", "speed=1 Hz..4 Hz:3", "--vary", "L1=100 mm,400 mm"]
    theirs = command_line("study", file("rssr_rigid"), *vary, "--of", "peak.R1.F,peak.R1.drive")
    grid = {"speed": ("1 Hz", "4 Hz", 3), "L1": ["100 mm", "400 mm"]}
    ours = lw.study(lw.compile(file("rssr_rigid")), grid, ["peak.R1.F", "peak.R1.drive"])
    assert {**ours.to_dict(), "provenance": None} == {**theirs, "provenance": None}
    assert ours.names == ["speed", "L1", "peak.R1.F", "peak.R1.drive"]
    # A crank of 400 mm does not turn: its rows are empty, with a code.
    failed = np.isnan(ours["peak.R1.F"])
    assert failed.tolist() == [error is not None for error in ours.errors] == [False, True] * 3
    frame = ours.to_pandas()
    assert list(frame.columns) == ["speed [1/s]", "L1 [m]", "peak.R1.F [N]", "peak.R1.drive [N m]", "error"]
    assert ours.to_arrow().column(2).null_count == 3
    assert pickle.loads(pickle.dumps(ours)).to_dict() == ours.to_dict()


def test_a_sample_is_that_of_its_seed() -> None:
    mechanism = lw.compile(file("rssr_rigid"))
    of: dict[str, Any] = {"of": "peak.R1.F", "sample": "sobol:8"}
    first = mechanism.study({"speed": ("1 Hz", "4 Hz")}, seed=1, **of)
    assert np.array_equal(first.numbers, mechanism.study({"speed": "1Hz..4Hz"}, seed=1, **of).numbers)
    assert not np.array_equal(first.numbers, mechanism.study({"speed": "1Hz..4Hz"}, seed=2, **of).numbers)


def test_wrong_names_are_answered() -> None:
    with pytest.raises(lw.LinkwearError, match=r"peak\.R1\.F"):
        lw.compile(file("rssr_rigid")).study({"speed": ["1 Hz"]}, "peak.R1.Force")
