"""Python says what the command line says, to the bit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT, file

import linkwear as lw

SHIPPED = ["pendulum", "four_bar", "rssr_rigid", "rssr_flexible", "four_bar_wear", "slider_crank_clearance"]


def of_numbers(answer: Any) -> dict[str, Any]:
    """Without what depends on the clock, on the file that was written, or on the program."""
    return {key: value for key, value in dict(answer).items() if key not in {"wall_seconds", "out", "backend"}}


@pytest.mark.parametrize("name", SHIPPED)
def test_a_run(name: str, command_line: Any, tmp_path: Path) -> None:
    table = tmp_path / "run.npy"
    time = ["--time", "0.2"] if name == "pendulum" else ["--turns", "0.5"]
    theirs = command_line("simulate", file(name), *time, "--samples", "50", "--out", table)
    options: dict[str, float] = {"time": 0.2} if name == "pendulum" else {"turns": 0.5}
    ours = lw.compile(file(name)).simulate(samples=50, **options)  # type: ignore[arg-type]
    assert of_numbers(ours.to_dict()) == of_numbers(theirs)
    rows = np.load(table)
    assert list(rows.dtype.names) == ours.columns
    for column in ours.columns:
        assert rows[column].tobytes() == ours[column].tobytes(), column


def test_a_life(command_line: Any, tmp_path: Path) -> None:
    folder = tmp_path / "life"
    theirs = command_line("life", file("rssr"), "--trajectories", "300", "--seed", "7", "--out", folder)
    ours = lw.compile(file("rssr")).life(trajectories=300, seed=7)
    assert of_numbers(ours.to_dict()) == of_numbers(theirs)
    import pandas

    lives = pandas.read_csv(folder / "lives.csv")
    assert list(lives.columns) == list(ours.to_pandas().columns)
    assert np.array_equal(lives["life [cycles]"], ours.lives)
    assert np.array_equal(lives["failed joint"], ours.to_pandas()["failed joint"])


def test_a_life_of_a_mission(command_line: Any) -> None:
    duty = ROOT / "examples" / "data" / "four_bar_duty.toml"
    theirs = command_line("life", duty, "--mission", "week", "--mean")
    ours = lw.compile(duty).life(mission="week", mean=True)
    assert of_numbers(ours.to_dict()) == of_numbers(theirs)
    assert ours.mission.segments[3].name == "heavy"


def test_parameters_and_checks(command_line: Any) -> None:
    theirs = command_line("check", file("rssr"), "--set", "speed=10 Hz")
    ours = lw.compile(file("rssr"), speed="10 Hz")
    assert ours.check().to_dict() == theirs
    assert ours.with_parameters(speed="120 rpm").parameters["speed"] == lw.compile(file("rssr"), speed="2 Hz").parameters["speed"]


DATA = ROOT / "examples" / "data" / "sliding_wear_100g.csv"


def test_fits_and_predictions(command_line: Any, tmp_path: Path) -> None:
    words = ["--unit", "unit", "--wear", "wear_um", "--exposure", "cycles", "--from-zero", "--power-law"]
    fit = tmp_path / "fit.json"
    theirs = command_line("fit", DATA, *words, "--bootstrap", "100", "--out", fit)
    named: dict[str, Any] = {"unit": "unit", "wear": "wear_um", "exposure": "cycles", "from_zero": True, "power_law": True}
    ours = lw.fit(DATA, **named, bootstrap=100)
    assert ours.to_dict() == theirs
    question = ["--threshold", "100", "--current", "40", "--at", "1000"]
    expected = command_line("predict", fit, *question)
    assert of_numbers(ours.predict(threshold=100, current=40, at=1000).to_dict()) == of_numbers(expected)
    more = ["--quantile", "0.01", "--quantile", "0.05", "--mission", "0..500", "--from", "2026-11-23", "--per-day", "200"]
    told = ours.predict(
        threshold=100, current=40, at=1000, quantile=[0.01, 0.05], mission="0..500", from_="2026-11-23", per_day=200
    )
    assert of_numbers(told.to_dict()) == of_numbers(command_line("predict", fit, *question, *more))
    assert told.dates.quantiles.p10 == command_line("predict", fit, *question, *more)["dates"]["quantiles"]["p10"]
    costs = ["--threshold", "50", "--preventive", "200", "--failure", "1500", "--parts", "12", "--horizon", "20000"]
    planned = ours.plan(threshold=50, preventive=200, failure=1500, parts=12, horizon=20000)
    assert of_numbers(planned.to_dict()) == of_numbers(command_line("plan", fit, *costs))
    assert planned.by_age.age_band.lower < planned.by_age.age < planned.by_age.age_band.upper
    # Arrays and frames are the same readings, and a saved fit is the same fit.
    import pandas

    frame = pandas.read_csv(DATA, comment="#")
    arrays = {str(name): frame[name].to_numpy() for name in frame}
    for data in (frame, arrays):
        assert lw.fit(data, **named, bootstrap=100).alpha == ours.alpha
    ours.save(tmp_path / "saved.json")
    saved = lw.load_fit(tmp_path / "saved.json")
    assert saved.predict(threshold=100, current=40, at=1000).to_dict() == ours.predict(threshold=100, current=40, at=1000).to_dict()
    assert (tmp_path / "saved.json").read_bytes() == fit.read_bytes()
