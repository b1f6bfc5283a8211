"""Faults as exceptions."""

from __future__ import annotations

import json
from typing import Any


class LinkwearError(Exception):
    """What is wrong, where, and what to do about it.

    ``code``, ``file``, ``line``, ``column``, ``message`` and ``help`` are those of the first fault, ``errors`` has all of them, as
    ``--format json`` prints them. Lines and columns count from 1.
    """

    def __init__(self, text: str, errors: list[dict[str, Any]]) -> None:
        super().__init__(text)
        self.errors = errors
        first = errors[0] if errors else {}
        self.code: str | None = first.get("code")
        self.file: str | None = first.get("file")
        self.line: int | None = first.get("line")
        self.column: int | None = first.get("column")
        self.message: str = first.get("message", text)
        self.help: str = first.get("help", "")

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self), self.errors))


class FileError(LinkwearError):
    """The mechanism's file, the data or a fit is wrong."""


class RunError(LinkwearError):
    """A run or a life could not go on."""


class UsageError(LinkwearError, ValueError):
    """The options do not fit the mechanism or each other."""


def error(text: str, errors: str, is_usage: bool) -> LinkwearError:
    """The exception of a fault, as the library tells it."""
    known: list[dict[str, Any]] = json.loads(errors)
    code = known[0]["code"] if known else ""
    kind = UsageError if is_usage else RunError if code in {"C0008", "C0009", "C0010"} else FileError
    return kind(text, known)
