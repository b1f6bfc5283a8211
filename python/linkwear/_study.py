"""The words of a study."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ._words import text, words


def question(vary: Mapping[str, Any], of: str | Sequence[str], options: Mapping[str, Any]) -> list[str]:
    """What varies, what is asked, and how."""
    axes = [f"--vary={name}={_values(values)}" for name, values in vary.items()]
    asked = of if isinstance(of, str) else ",".join(of)
    return [*axes, f"--of={asked}", *words(options)]


def _values(values: Any) -> str:
    """A tuple is a range with its number of values, if it has one; any other sequence is a list."""
    if isinstance(values, str):
        return values
    if isinstance(values, tuple):
        first, last, *count = values
        return f"{text(first)}..{text(last)}" + "".join(f":{int(one)}" for one in count)
    return ",".join(text(value) for value in values)
