"""Processes of wear from readings, and predictions by them."""

from __future__ import annotations

import csv
import io
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _linkwear
from ._results import Record
from ._words import words

if TYPE_CHECKING:
    import pandas

#: What data are called that are given as arrays.
DATA = "<data>"


def fit(
    data: str | os.PathLike[str] | Mapping[str, Any] | pandas.DataFrame,
    *,
    unit: str,
    wear: str,
    exposure: str | None = None,
    **options: Any,
) -> Fit:
    """Fits a process of wear by maximum likelihood.

    ``data`` is the path of a CSV file, a data frame, or arrays by name; ``unit``, ``wear`` and ``exposure`` are names of columns. Further
    options are those of ``linkwear fit``: ``lambda_``, ``process``, ``power_law``, ``groups``, ``from_zero``, ``resolution``, ``gauge``,
    ``covariate``, ``covariate_of_size``, ``reset``, ``entered_below``, ``one_unit``, ``random_effects``, ``compare``, ``bootstrap``, ``seed``.
    Units are those of the data.

    Raises FileError with the line, UsageError.
    """
    return Fit(*_linkwear.fit(*question(data, {"unit": unit, "wear": wear, "exposure": exposure, **options})))


def question(data: Any, options: Mapping[str, Any]) -> tuple[list[str], str, str]:
    """Words, name and table of a fit."""
    said = words({name.rstrip("_"): value for name, value in options.items()})
    return said, *_table(data)


def load_fit(path: str | os.PathLike[str]) -> Fit:
    """The fit in a file of ``linkwear fit --out``, or of :meth:`Fit.save`."""
    text = Path(path).read_text()
    return Fit(text, text)


def _asked(options: dict[str, Any]) -> list[str]:
    """Words of a question, covariates by name."""
    covariates = options.get("covariate")
    if isinstance(covariates, Mapping):
        options["covariate"] = [f"{name}={float(value)!r}" for name, value in covariates.items()]
    return words({name.rstrip("_"): value for name, value in options.items()})


def _table(data: Any) -> tuple[str, str]:
    if isinstance(data, (str, os.PathLike)):
        return os.fspath(data), Path(data).read_text()
    columns = {str(name): list(data[name]) for name in data}
    lengths = {len(values) for values in columns.values()}
    if len(lengths) > 1:
        raise ValueError(f"columns have different lengths: {sorted(lengths)}")
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    # Texts of doubles are the shortest that read back as the same numbers.
    writer.writerows(zip(*columns.values()))
    return DATA, text.getvalue()


class Fit(Record):
    """A fit: what ``linkwear fit --format json`` prints as attributes, ``fit.alpha``, ``fit.log_likelihood``."""

    def __init__(self, answer: str, file: str) -> None:
        super().__init__(json.loads(answer))
        self._file = file

    def predict(self, *, threshold: float, current: float | None = None, **options: Any) -> Prediction:
        """The remaining life to a wear ``threshold`` from the wear ``current``, in the units of the data.

        Further options are those of ``linkwear predict``: ``at``, ``covariate``, ``rate``, ``inspections``, ``time``, ``wear``, ``gauge``,
        ``flat_prior``, ``catalogue``, ``unit``, ``particles``, ``draws``, ``seed``; and what can be asked: ``quantile``, ``reliability_at``,
        ``mission`` (``"0..2"``), each one or a list, ``survived``, ``also`` (``"other.json:0.5"``), ``from_`` with ``per_day``,
        ``working_days``, ``pause``.
        """
        said = _asked({"threshold": threshold, "current": current, **options})
        return Prediction(json.loads(_linkwear.predict(said, "fit", self._file)))

    def plan(self, *, threshold: float, preventive: float, failure: float, **options: Any) -> Record:
        """When to replace parts that fail at a wear ``threshold``, by the costs of a replacement in time and of a failure.

        Further options are those of ``linkwear plan``: ``covariate``, ``rate``, ``preventive_time``, ``failure_time``, ``inspection``,
        ``downtime``, ``interval``, ``replace_from``, ``look_at``, ``current``, ``at``, ``parts``, ``horizon``, ``confidence``. The answer
        is what ``linkwear plan --format json`` prints as attributes: ``plan.by_age.age``, ``plan.by_age.age_band.lower``.
        """
        said = _asked({"threshold": threshold, "preventive": preventive, "failure": failure, **options})
        return Record(json.loads(_linkwear.plan(said, "fit", self._file)))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes it for ``linkwear predict`` and :func:`load_fit`."""
        Path(path).write_text(self._file)

    def plot(self, ax: Any | None = None) -> Any:
        """Probability paper: what was measured against what the process says."""
        from ._plot import fit as drawn

        return drawn(self, ax)


class Prediction(Record):
    """A remaining life: what ``linkwear predict --format json`` prints as attributes, ``prediction.mean``, ``prediction.interval95.lower``."""

    def plot(self, ax: Any | None = None) -> Any:
        """Reliability over time, with its band."""
        from ._plot import prediction

        return prediction(self, ax)
