"""Entry points as functions of arrays."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _linkwear

#: Groups that are filled in where they are not given: parameters with their values, the rest with zeros.
_DEFAULTS = ("parameters", "t", "wrenches", "contact_motion", "held")


class Function:
    """An entry point at many states at once.

    Arrays are (quantity, lane): as many rows as a group has quantities, a column for each state; one column, or a vector, is the same for
    all states. Groups are given by their names or in the order of :attr:`inputs`, parameters, time and contact wrenches only by name:

        accelerations = mechanism.function("accelerations")
        answers = accelerations(q, v)            # (quantity, lane)
        accelerations(q, v, out=answers)         # no allocation
        accelerations.split(answers)["accelerations"]

    Arrays of doubles in C order are read where they lie; other ones are copied. SI, without units in names.
    """

    def __init__(self, entries: _linkwear.Entries, name: str) -> None:
        self._entries = entries
        #: Name of the entry.
        self.name = name
        takes, gives = entries.entry(name)
        #: Groups that it takes, with the names of their quantities.
        self.inputs: dict[str, list[str]] = dict(takes)
        #: Groups that it gives, with the names of their quantities.
        self.outputs: dict[str, list[str]] = dict(gives)
        #: Quantities of all answers.
        self.count = sum(len(names) for names in self.outputs.values())
        values = [value for _, _, value in entries.parameters()]
        self._defaults = {
            group: np.zeros((len(names), 1)) for group, names in self.inputs.items() if group in _DEFAULTS
        }
        self._defaults["parameters"] = np.array(values, dtype=np.float64).reshape(-1, 1)

    def __repr__(self) -> str:
        takes = ", ".join(f"{group}: {len(names)}" for group, names in self.inputs.items())
        return f"<linkwear.Function {self.name}({takes}) -> {self.count}>"

    def __call__(
        self,
        *groups: ArrayLike,
        out: NDArray[np.float64] | None = None,
        **named: ArrayLike,
    ) -> NDArray[np.float64]:
        """All answers, (quantity, lane)."""
        given = self._given(groups, named)
        arrays = [self._array(group, given) for group in self.inputs]
        widths = {array.shape[1] for array in arrays} - {1}
        if len(widths) > 1:
            raise ValueError(f"{self.name}: arrays have different numbers of lanes: {sorted(widths)}")
        states = widths.pop() if widths else 1
        if out is None:
            out = np.empty((self.count, states))
        elif out.shape != (self.count, states) or out.dtype != np.float64 or not out.flags.c_contiguous:
            raise ValueError(
                f"{self.name}: `out` must be doubles in C order of shape {(self.count, states)}, not {out.dtype} of {out.shape}"
            )
        self._entries.evaluate(self.name, arrays, out)
        return out

    def split(self, answers: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        """Views of the answers, by group."""
        parts, first = {}, 0
        for group, names in self.outputs.items():
            parts[group] = answers[first : first + len(names)]
            first += len(names)
        return parts

    def jacobian(self, *groups: ArrayLike, by: str | Sequence[str] = ("q", "v"), **named: ArrayLike) -> NDArray[np.float64]:
        """Exact derivatives of all answers at one state, (answer, quantity), by the quantities of some groups, by dual numbers."""
        given = self._given(groups, named)
        arrays = [self._array(group, given) for group in self.inputs]
        if any(array.shape[1] != 1 for array in arrays):
            raise ValueError(f"{self.name}: a Jacobian is of one state: give vectors")
        wanted = [by] if isinstance(by, str) else list(by)
        places: dict[str, range] = {}
        first = 0
        for group, names in self.inputs.items():
            places[group] = range(first, first + len(names))
            first += len(names)
        unknown = [group for group in wanted if group not in places]
        if unknown:
            raise ValueError(f"{self.name} takes no `{unknown[0]}`; it takes {', '.join(self.inputs)}")
        state = np.concatenate([array[:, 0] for array in arrays])
        return self._entries.derivatives(self.name, state, [at for group in wanted for at in places[group]])

    def _given(self, groups: Sequence[ArrayLike], named: dict[str, ArrayLike]) -> dict[str, ArrayLike]:
        places = [group for group in self.inputs if group not in _DEFAULTS]
        if len(groups) > len(places):
            raise TypeError(f"{self.name} takes {', '.join(places) or 'nothing'} in this order, and others by name")
        given = dict(zip(places, groups))
        for group, values in named.items():
            if group not in self.inputs:
                raise TypeError(f"{self.name} takes no `{group}`; it takes {', '.join(self.inputs)}")
            if group in given:
                raise TypeError(f"{self.name}: `{group}` is given twice")
            given[group] = values
        missing = [group for group in places if group not in given and self.inputs[group]]
        if missing:
            raise TypeError(f"{self.name}: `{missing[0]}` is missing: {len(self.inputs[missing[0]])} quantities")
        return given

    def _array(self, group: str, given: dict[str, ArrayLike]) -> NDArray[np.float64]:
        count = len(self.inputs[group])
        if group not in given:
            return self._defaults.get(group, np.zeros((count, 1)))
        array = np.ascontiguousarray(given[group], dtype=np.float64)
        if array.ndim == 1 and count == 1 and array.shape[0] != 1:
            # One quantity, a value for each state.
            array = array.reshape(1, -1)
        elif array.ndim < 2:
            array = array.reshape(-1, 1)
        if array.ndim != 2 or array.shape[0] != count or array.shape[1] == 0:
            names = ", ".join(self.inputs[group][:6])
            raise ValueError(f"{self.name}: `{group}` must have shape ({count}, lanes), not {array.shape}: {names}")
        return array
