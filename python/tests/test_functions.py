"""Entry points as functions of arrays."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import file
from numpy.typing import NDArray

import linkwear as lw

ENTRIES = ["forward_dynamics", "accelerations", "equations_of_motion", "closure", "contacts", "observe", "energy"]


def states(function: lw.Function, count: int) -> dict[str, NDArray[np.float64]]:
    random = np.random.default_rng(1)
    groups = {name: len(rows) for name, rows in function.inputs.items() if name not in {"parameters", "t"}}
    return {name: random.uniform(-1, 1, (rows, count)) for name, rows in groups.items()}


@pytest.mark.parametrize("entry", ENTRIES)
@pytest.mark.parametrize("name", ["rssr", "four_bar"])
def test_lanes_have_the_bits_of_single_states(name: str, entry: str) -> None:
    function = lw.compile(file(name)).function(entry)
    # 300: several stretches and a rest of every number of lanes.
    given = states(function, 300)
    together = function(**given)
    assert together.shape == (function.count, 300)
    for lane in (0, 1, 127, 128, 255, 299):
        alone = function(**{group: values[:, lane] for group, values in given.items()})
        assert alone[:, 0].tobytes() == np.ascontiguousarray(together[:, lane]).tobytes()


def test_any_layout_and_room_for_the_answers() -> None:
    function = lw.compile(file("rssr_flexible")).function("accelerations")
    given = states(function, 40)
    expected = function(given["q"], given["v"])
    out = np.full_like(expected, np.nan)
    assert function(given["q"], given["v"], out=out) is out
    assert out.tobytes() == expected.tobytes()
    other = [np.asfortranarray(given["q"]), given["v"].tolist()]
    assert function(*other).tobytes() == expected.tobytes()
    strided = np.repeat(given["q"], 2, axis=1)[:, ::2]
    assert function(strided, given["v"]).tobytes() == expected.tobytes()
    # One column is the same for all lanes.
    one = function(given["q"][:, 0], given["v"])
    assert one[:, 0].tobytes() == expected[:, 0].tobytes()


def test_wrong_arrays_are_answered() -> None:
    function = lw.compile(file("rssr_flexible")).function("accelerations")
    given = states(function, 8)
    with pytest.raises(ValueError, match=r"`q` must have shape \(11, lanes\)"):
        function(given["q"][:5], given["v"])
    with pytest.raises(ValueError, match="different numbers of lanes"):
        function(given["q"], given["v"][:, :3])
    with pytest.raises(ValueError, match="`out` must be doubles in C order"):
        function(given["q"], given["v"], out=np.zeros((2, 2)))
    with pytest.raises(TypeError, match="`v` is missing"):
        function(given["q"])
    with pytest.raises(TypeError, match="takes no `x`"):
        function(given["q"], given["v"], x=1.0)
    with pytest.raises(KeyError, match="there are: "):
        lw.compile(file("four_bar")).function("nothing")


def test_jacobians_are_those_of_central_differences() -> None:
    function = lw.compile(file("rssr_rigid")).function("forward_dynamics")
    mechanism = lw.compile(file("rssr_rigid"))
    start = mechanism.function("start")
    parts = start.split(start())
    q, v = parts["q"][:, 0], parts["v"][:, 0]
    exact = function.jacobian(q, v, by="v")
    step = 1e-6
    for column in range(len(v)):
        ahead, behind = v.copy(), v.copy()
        ahead[column] += step
        behind[column] -= step
        slope = (function(q, ahead) - function(q, behind))[:, 0] / (2 * step)
        # Answers are quadratic in speeds: what is left is rounding, 1e-16 of the largest answer over the step.
        scale = np.abs(function(q, v)).max() + 1
        assert np.allclose(exact[:, column], slope, atol=1e-8 * scale, rtol=1e-6)


def test_parameters_are_arguments_too() -> None:
    mechanism = lw.compile(file("pendulum"))
    function = mechanism.function("accelerations")
    names = function.inputs["parameters"]
    values = np.array([[mechanism.parameters[name]] for name in names])
    assert function([0.3], [0.0], parameters=values).tobytes() == function([0.3], [0.0]).tobytes()
