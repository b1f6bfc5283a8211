"""Options as words of the command line, which reads them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any


def words(options: Mapping[str, Any]) -> list[str]:
    """``trajectories=10`` is ``--trajectories=10``; True is the option alone, None and False are no option; a list repeats it."""
    said: list[str] = []
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        for one in value if isinstance(value, (list, tuple)) else [value]:
            if one is None or one is False:
                continue
            said.append(option if one is True else f"{option}={text(one)}")
    return said


def settings(parameters: Mapping[str, Any]) -> list[str]:
    """Values of parameters: numbers in SI, texts with their units."""
    return [f"--set={name}={text(value)}" for name, value in parameters.items()]


def text(value: Any) -> str:
    if isinstance(value, os.PathLike):
        return str(os.fspath(value))
    if isinstance(value, (str, int)):
        return str(value)
    # The shortest text that reads back as the same number, NumPy's numbers too.
    return repr(float(value))
