"""What becomes of runs and lives."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _linkwear

if TYPE_CHECKING:
    import pandas
    import pyarrow
    from matplotlib.axes import Axes


class Record(Mapping[str, Any]):
    """An object of the JSON that the command line prints: its keys are keys, and attributes too."""

    def __init__(self, keys: dict[str, Any]) -> None:
        self._keys = keys

    def __getitem__(self, key: str) -> Any:
        return _told(self._keys[key])

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_"):
            raise AttributeError(key)
        try:
            return self[key]
        except KeyError:
            raise AttributeError(f"there is no `{key}`; there are: {', '.join(self._keys)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._keys)

    def __len__(self) -> int:
        return len(self._keys)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._keys]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(self._keys)})"

    def to_dict(self) -> dict[str, Any]:
        """All of it as plain dictionaries and lists."""
        copy: dict[str, Any] = json.loads(json.dumps(self._keys))
        return copy


def _told(value: Any) -> Any:
    if isinstance(value, dict):
        return Record(value)
    if isinstance(value, list):
        return [_told(one) for one in value]
    return value


class Motion(Record):
    """A run: its columns by name, ``motion["R4.q [rad]"]``, as NumPy arrays; what ``linkwear simulate --format json`` prints as
    attributes, ``motion.steps``."""

    def __init__(self, columns: list[str], numbers: NDArray[np.float64], keys: dict[str, Any]) -> None:
        super().__init__(keys)
        #: Names with units, the time first.
        self.columns = columns
        #: All numbers, (column, row).
        self.numbers = numbers
        self._at = {name: at for at, name in enumerate(columns)}
        # Names without units are names, too.
        self._at.update({name.rsplit(" [", 1)[0]: at for at, name in reversed(list(enumerate(columns)))})

    def __getitem__(self, key: str) -> Any:
        at = self._at.get(key)
        if at is not None:
            return self.numbers[at]
        if key in self._keys:
            return super().__getitem__(key)
        import difflib

        near = difflib.get_close_matches(key, self.columns, n=1)
        raise KeyError(f"there is no column `{key}`" + (f"; did you mean `{near[0]}`?" if near else ""))

    @property
    def t(self) -> NDArray[np.float64]:
        """Times of the rows [s]."""
        times: NDArray[np.float64] = self.numbers[0]
        return times

    def to_pandas(self) -> pandas.DataFrame:
        """A data frame with the columns of the command line's CSV, on the same numbers."""
        import pandas

        return pandas.DataFrame(self.numbers.T, columns=self.columns, copy=False)

    def to_arrow(self) -> pyarrow.Table:
        """An Arrow table on the same numbers, without copies; what the run is of stands in its metadata."""
        import pyarrow

        arrays = [pyarrow.array(column) for column in self.numbers]
        provenance = json.dumps(self._keys.get("provenance"))
        return pyarrow.table(arrays, names=self.columns, metadata={"linkwear": provenance})

    def plot(self, *columns: str, ax: Axes | None = None) -> Axes:
        """Curves over time; without names the angles and positions of joints."""
        from ._plot import motion

        return motion(self, columns, ax)


class Study(Record):
    """A study: its columns by name, ``study["peak.R1.F"]``, as NumPy arrays with a row for each point, NaN where there is nothing; what
    ``linkwear study --format json`` prints as attributes, ``study.failures``."""

    def __init__(self, keys: dict[str, Any]) -> None:
        super().__init__(keys)
        columns = keys["columns"]
        numeric = [at for at, column in enumerate(columns) if column["kind"] != "error"]
        #: Names of the columns of numbers.
        self.names: list[str] = [columns[at]["name"] for at in numeric]
        #: Their units, SI.
        self.units: dict[str, str] = {columns[at]["name"]: columns[at]["unit"] for at in numeric}
        #: All numbers, (column, point).
        self.numbers: NDArray[np.float64] = np.array(
            [[row[at] for row in keys["rows"]] for at in numeric], dtype=np.float64
        )
        errors = [at for at, column in enumerate(columns) if column["kind"] == "error"]
        #: Codes of the points that failed, None where nothing did.
        self.errors: list[str | None] = [row[errors[0]] if errors else None for row in keys["rows"]]
        self._at = {name: at for at, name in enumerate(self.names)}

    def __getitem__(self, key: str) -> Any:
        at = self._at.get(key)
        return super().__getitem__(key) if at is None else self.numbers[at]

    def to_pandas(self) -> pandas.DataFrame:
        """A data frame with the columns of the command line's table."""
        import pandas

        frame = pandas.DataFrame(self.numbers.T, columns=[_titled(name, self.units[name]) for name in self.names])
        frame["error"] = self.errors
        return frame

    def to_arrow(self) -> pyarrow.Table:
        """An Arrow table; what the study is of stands in its metadata."""
        import pyarrow

        arrays = [pyarrow.array(column, from_pandas=True) for column in self.numbers]
        arrays.append(pyarrow.array(self.errors, type=pyarrow.string()))
        names = [_titled(name, self.units[name]) for name in self.names] + ["error"]
        return pyarrow.table(arrays, names=names, metadata={"linkwear": json.dumps(self._keys.get("provenance"))})


def _titled(name: str, unit: str) -> str:
    return f"{name} [{unit}]"


class Life(Record):
    """A life: what ``linkwear life --format json`` prints as attributes, ``life.mean``, ``life.quantiles.p10``; random lives as arrays."""

    def __init__(self, keys: dict[str, Any], lives: _linkwear.Lives | dict[str, Any]) -> None:
        super().__init__(keys)
        if not isinstance(lives, dict):
            lives = {
                "lives": lives.cycles,
                "whole_cycles": lives.whole_cycles,
                "failed": lives.failed,
                "joints": lives.joints,
            }
        #: Random lives [cycles], by their numbers; none where they are too many to list.
        self.lives: NDArray[np.float64] = lives["lives"]
        #: The same as inspections after whole cycles see them.
        self.lives_whole_cycles: NDArray[np.uint64] = lives["whole_cycles"]
        #: Places in :attr:`joints` of the joints that failed.
        self.failed: NDArray[np.uint64] = lives["failed"]
        #: Joints that wear.
        self.joints: list[str] = lives["joints"]

    def __reduce__(self) -> tuple[Any, ...]:
        arrays = {
            "lives": self.lives,
            "whole_cycles": self.lives_whole_cycles,
            "failed": self.failed,
            "joints": self.joints,
        }
        return (Life, (self._keys, arrays))

    def to_pandas(self) -> pandas.DataFrame:
        """The random lives with the columns of ``lives.csv``."""
        import pandas

        return pandas.DataFrame(
            {
                "trajectory": np.arange(len(self.lives), dtype=np.uint64),
                "life [cycles]": self.lives,
                "whole cycles": self.lives_whole_cycles,
                "failed joint": [self.joints[int(at)] for at in self.failed],
            }
        )

    def cycles_to_pandas(self) -> pandas.DataFrame:
        """The cycles of the mean path, a row for each joint of each, with the keys of the JSON."""
        import pandas

        rows = [
            {"cycle": cycle["cycle"], "used": cycle["used"], **joint}
            for cycle in self._keys["cycles"]
            for joint in cycle["joints"]
        ]
        return pandas.DataFrame(rows)

    def plot(self, ax: Any | None = None) -> Any:
        """Wear over cycles, and the part of the lives that is longer."""
        from ._plot import life

        return life(self, ax)


def merge(shards: list[str | os.PathLike[str]]) -> Life:
    """The life of all shards, from the folders of ``life --shard I/N --out DIR`` or of :mod:`linkwear.dask`."""
    answer, lives = _linkwear.merge([os.fspath(shard) for shard in shards])
    return Life(json.loads(answer), lives)
