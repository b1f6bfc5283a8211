"""A mechanism from its file."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _linkwear
from ._errors import LinkwearError
from ._function import Function
from ._page import Page, Picture
from ._progress import told
from ._results import Life, Motion, Record, Study
from ._study import question
from ._words import settings, words

#: What a mechanism is called that is given as text.
TEXT = "<text>"


def compile(
    source: str | os.PathLike[str],
    *,
    closure: str | None = None,
    allow_outside_data: bool = False,
    **parameters: Any,
) -> Mechanism:
    """Compiles a mechanism.

    ``source`` is a path, or the TOML itself: a text with a line break. ``closure`` is ``"joint"`` or ``"log"``. Parameters by their names:
    texts with units, ``speed="10 Hz"``; numbers
    where they have none.

    Raises FileError, with all that is wrong with the file.
    """
    said = words({"closure": closure, "allow_outside_data": allow_outside_data}) + settings(parameters)
    if isinstance(source, str) and "\n" in source:
        return Mechanism(source, TEXT, said)
    name = os.fspath(source)
    return Mechanism(_read(name), name, said)


def _read(name: str) -> str:
    return Path(name).read_bytes().decode("utf-8", errors="strict")


def study(mechanism: Mechanism, vary: Mapping[str, Any], of: str | Sequence[str], **options: Any) -> Study:
    """:meth:`Mechanism.study`."""
    return mechanism.study(vary, of, **options)


class Mechanism:
    """A mechanism: what it is, how it moves, how long it lives. It can be pickled, and travels as its text."""

    def __init__(self, text: str, name: str, said: list[str]) -> None:
        self._source = (text, name, said)
        self._compiled = _linkwear.Mechanism(text, name, said)
        self._entries: _linkwear.Entries | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        return (Mechanism, self._source)

    def __repr__(self) -> str:
        return f"<linkwear.Mechanism of {self._source[1]}>"

    @property
    def text(self) -> str:
        """The text of its file."""
        return self._source[0]

    def with_parameters(self, **parameters: Any) -> Mechanism:
        """The same with other values of parameters: texts with units; numbers where they have none."""
        text, name, said = self._source
        changed = {f"--set={parameter}=" for parameter in parameters}
        kept = [word for word in said if not any(word.startswith(one) for one in changed)]
        return Mechanism(text, name, kept + settings(parameters))

    @property
    def parameters(self) -> dict[str, float]:
        """Values of the tunable parameters, then of the inputs, SI."""
        return {name: value for name, _, value in self._all_entries().parameters()}

    def check(self) -> Record:
        """What it is: mobility, redundant rows, idle freedoms, remarks; the keys of ``linkwear check --format json``."""
        return Record(json.loads(self._compiled.check()))

    def simulate(
        self,
        *,
        turns: float | None = None,
        time: float | None = None,
        samples: int | None = None,
        inputs: str | os.PathLike[str] | None = None,
        integrator: str | None = None,
        step: float | None = None,
        tol: float | None = None,
        backend: str | None = None,
        rigid: bool = False,
        progress: bool = False,
    ) -> Motion:
        """Turns it and records what happens.

        ``turns`` of the first driven revolute joint, or ``time`` [s]; ``samples`` rows, evenly spaced. ``integrator`` is ``"rk4"``,
        ``"generalized-alpha"`` (with ``step`` [s]), ``"dopri5"`` or ``"rk43"`` (with ``tol``); without it the one that suits. ``inputs``
        is a CSV file of signals over time.

        Raises RunError, UsageError.
        """
        said = words(
            {
                "turns": turns,
                "time": time,
                "samples": samples,
                "inputs": inputs,
                "integrator": integrator,
                "step": step,
                "tol": tol,
                "backend": backend,
                "rigid": rigid,
            }
        )
        with told(progress, "simulate") as hears:
            columns, numbers, answer = self._compiled.simulate(said, hears)
        return Motion(columns, numbers, json.loads(answer))

    def life(
        self,
        *,
        trajectories: int | None = None,
        seed: int | None = None,
        coupling: str | None = None,
        mean: bool = False,
        fit: str | list[str] | None = None,
        mission: str | None = None,
        no_mission: bool = False,
        shared_factor: float | None = None,
        no_feedback: bool = False,
        tol: float | None = None,
        step: float | None = None,
        settle: int | None = None,
        average: int | None = None,
        threads: int | None = None,
        backend: str | None = None,
        rigid: bool = False,
        progress: bool = False,
    ) -> Life:
        """Wears its joints until the first has failed: the mean path, and random lives by the Gamma process of the file or of a fit.

        ``trajectories`` random lives of ``seed``, the same bits on any number of ``threads``; ``coupling`` is ``"table"`` or ``"full"``;
        ``mean=True`` leaves the random lives out; ``fit`` is the path of a fit, ``"R1=fit.json"`` where several joints wear;
        ``mission`` names one of the mechanism's missions, ``no_mission=True`` lives without.

        Raises RunError, UsageError.
        """
        said = words(
            {
                "trajectories": trajectories,
                "seed": seed,
                "coupling": coupling,
                "mean": mean,
                "fit": fit,
                "mission": mission,
                "no_mission": no_mission,
                "shared_factor": shared_factor,
                "no_feedback": no_feedback,
                "tol": tol,
                "step": step,
                "settle": settle,
                "average": average,
                "threads": threads,
                "backend": backend,
                "rigid": rigid,
            }
        )
        with told(progress, "life") as hears:
            answer, lives = self._compiled.life(said, hears)
        return Life(json.loads(answer), lives)

    def study(
        self,
        vary: Mapping[str, Any],
        of: str | Sequence[str],
        *,
        sample: str | None = None,
        progress: bool = False,
        **options: Any,
    ) -> Study:
        """Runs and lives it at many points, and makes one table of it.

        ``vary`` has the values of parameters: ``("1 Hz", "4 Hz", 4)`` is four from 1 to 4 Hz, ``["1 Hz", "2 Hz"]`` these two. With
        ``sample="sobol:64"`` the points fill ranges ``("1 Hz", "4 Hz")`` evenly. ``of`` names results: ``"peak.R1.F"``, ``"life.mean"``,
        ``"R1.wear_integral_J"``, .. Further options are those of ``linkwear study``: ``seed``, ``threads``, ``turns``, ``trajectories``, ..

        Raises FileError, RunError, UsageError.
        """
        said = question(vary, of, {"sample": sample, **options})
        with told(progress, "study") as hears:
            return Study(json.loads(self._compiled.study(said, hears)))

    def view(self, *, progress: bool = False, **options: Any) -> Page:
        """It moves, in 3-D, on a page for a browser or a notebook. Options are those of :meth:`simulate`."""
        return self._page("view", words(options), progress)

    def report(self, *, progress: bool = False, **options: Any) -> Page:
        """Its motion, its wear and its life on a page for a browser or a notebook. Options are those of :meth:`life`, and ``turns`` that are
        shown."""
        return self._page("report", words(options), progress)

    def draw(self, *, turns: float | None = None) -> Picture:
        """A picture of it, as in a paper, with the paths of its points."""
        return Picture(self._compiled.page("draw", words({"turns": turns})))

    def _page(self, subcommand: str, said: list[str], progress: bool) -> Page:
        with told(progress, subcommand) as hears:
            return Page(self._compiled.page(subcommand, said, hears))

    def _repr_html_(self) -> str | None:
        try:
            return self.draw().svg
        except LinkwearError:
            # What cannot move is shown by its name.
            return None

    def function(self, entry: str) -> Function:
        """An entry point as a function of NumPy arrays: ``"accelerations"``, ``"forward_dynamics"``, ``"equations_of_motion"``,
        ``"closure"``, ``"contacts"``, ``"energy"``, ``"observe"``, .."""
        return Function(self._all_entries(), entry)

    def state_space(self, t: float = 0.0, parameters: ArrayLike | None = None) -> StateSpace:
        """The mechanism as x' = f(t, x) for integrators of others, at a consistent start."""
        return StateSpace(self, t, parameters)

    def _all_entries(self) -> _linkwear.Entries:
        if self._entries is None:
            self._entries = _linkwear.Entries(self._compiled)
        return self._entries


class StateSpace:
    """A mechanism as x' = f(t, x): x are the free coordinates, then the free speeds, SI. Contact laws are in it.

    An object belongs to the thread that made it. Loops stay closed as well as the integrator is accurate.
    """

    def __init__(self, mechanism: Mechanism, t: float, parameters: ArrayLike | None) -> None:
        given = None if parameters is None else np.ascontiguousarray(parameters, dtype=np.float64)
        self._equations = _linkwear.StateSpace(mechanism._compiled, t, given)
        #: The consistent start.
        self.start: NDArray[np.float64] = self._equations.states
        #: Names with units of :meth:`values`.
        self.columns: list[str] = self._equations.columns

    def derivative(self, t: float, x: ArrayLike) -> NDArray[np.float64]:
        """x' at a time [s] and a state: what ``scipy.integrate.solve_ivp`` asks for."""
        return self._equations.derivative(t, np.ascontiguousarray(x, dtype=np.float64))

    __call__ = derivative

    def values(self, t: float, x: ArrayLike) -> NDArray[np.float64]:
        """All columns of ``simulate`` but the time, at a time [s] and a state."""
        return self._equations.values(t, np.ascontiguousarray(x, dtype=np.float64))
