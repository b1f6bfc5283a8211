"""Lives, studies and replicates of the bootstrap as tasks of Dask, on whatever cluster there is.

    from dask.distributed import Client
    import linkwear as lw, linkwear.dask

    client = Client("tcp://scheduler:8786")       # or of dask-jobqueue, Kubernetes, LocalCluster
    life = linkwear.dask.life(lw.compile("rssr.toml"), trajectories=1_000_000, tasks=200, out="lives", client=client)

A worker needs this package and nothing else: the mechanism travels as its text and is compiled there in milliseconds. Each task is a
shard, as of ``linkwear life --shard I/N``; the whole has the bits of the same question asked on one machine, whatever became of workers
on the way. In the folder ``out`` every task that is done is kept, and its rows are in a Parquet file that other programs can read while
the rest runs; the same call goes on from there. Tasks use one thread each: start workers with as many threads as they have cores.
"""

from __future__ import annotations

import functools
import hashlib
import json
import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import __version__, _linkwear
from ._fit import Fit
from ._fit import question as fit_question
from ._mechanism import Mechanism
from ._results import Life, Study
from ._study import question as study_question
from ._words import words

if TYPE_CHECKING:
    import pyarrow
    from distributed import Client

#: What a task gives back: the file of its shard, and its rows by the names of their columns.
_Done = tuple[bytes, dict[str, Any]]

#: Times that a task is tried again after its worker broke it off.
_RETRIES = 3


def life(
    mechanism: Mechanism,
    *,
    trajectories: int,
    tasks: int,
    out: str | os.PathLike[str],
    client: Client | None = None,
    progress: bool = False,
    **options: Any,
) -> Life:
    """:meth:`linkwear.Mechanism.life` in so many tasks; its options. Random lives are in ``out/rows/*.parquet`` as they come."""
    said = words({"trajectories": trajectories, "threads": 1, **options})
    shards = _shards(client, _life_shard, (mechanism._source, said), tasks, Path(out), progress)
    with tempfile.TemporaryDirectory() as folder:
        # Shards of lives are folders.
        places = []
        for shard in shards:
            place = Path(folder, shard.stem)
            place.mkdir()
            (place / "life.shard").symlink_to(shard.resolve())
            places.append(os.fspath(place))
        answer, lives = _linkwear.merge(places)
    return Life(json.loads(answer), lives)


def study(
    mechanism: Mechanism,
    vary: Mapping[str, Any],
    of: str | Sequence[str],
    *,
    tasks: int,
    out: str | os.PathLike[str],
    client: Client | None = None,
    progress: bool = False,
    **options: Any,
) -> Study:
    """:meth:`linkwear.Mechanism.study` in so many tasks; its options. Points are in ``out/rows/*.parquet`` as they come."""
    said = study_question(vary, of, {"threads": 1, **options})
    shards = _shards(client, _study_shard, (mechanism._source, said), tasks, Path(out), progress)
    return Study(json.loads(_linkwear.merge_study([os.fspath(shard) for shard in shards])))


def fit(
    data: Any,
    *,
    bootstrap: int,
    tasks: int,
    out: str | os.PathLike[str],
    client: Client | None = None,
    progress: bool = False,
    **options: Any,
) -> Fit:
    """:func:`linkwear.fit` with the replicates of its bootstrap in so many tasks; its options. Estimates are in ``out/rows/*.parquet``
    as they come."""
    said, name, table = fit_question(data, {"bootstrap": bootstrap, **options})
    shards = _shards(client, _replicates, (said, name, table, bootstrap), tasks, Path(out), progress)
    return Fit(*_linkwear.fit(said, name, table, [shard.read_text() for shard in shards]))


def _shards(
    client: Client | None,
    task: Callable[..., _Done],
    question: tuple[Any, ...],
    tasks: int,
    out: Path,
    progress: bool,
) -> list[Path]:
    """The files of all shards; those that are in the folder are taken over, the others are asked for."""
    import pyarrow.parquet
    from distributed import as_completed, get_client

    if tasks < 1:
        raise ValueError("at least one task is needed")
    _same_question(out, task, question, tasks)
    files = {number: out / "shards" / f"{number:06}.shard" for number in range(1, tasks + 1)}
    missing = [number for number, file in files.items() if not file.exists()]
    if missing:
        client = client or get_client()
        # The question goes with every task, a few kilobytes: what is scattered is gone with the last worker that held it.
        futures = {
            client.submit(task, question, number, tasks, pure=False, retries=_RETRIES): number for number in missing
        }
        bar = _bar(progress, tasks, tasks - len(missing))
        try:
            for future, (shard, rows) in as_completed(futures, with_results=True):
                number = futures[future]
                # First the rows: what has a shard is never asked for again.
                _written(out / "rows" / f"{number:06}.parquet", lambda file: pyarrow.parquet.write_table(_table(rows), file))
                _written(files[number], lambda file: Path(file).write_bytes(shard))
                future.release()
                bar()
        except BaseException:
            client.cancel(list(futures))
            raise
    return list(files.values())


def _same_question(out: Path, task: Callable[..., _Done], question: tuple[Any, ...], tasks: int) -> None:
    """Refuses a folder of another question."""
    told = json.dumps([__version__, task.__name__, question, tasks], default=str)
    mark = out / "question.sha256"
    told = hashlib.sha256(told.encode()).hexdigest() + "\n"
    if mark.exists():
        if mark.read_text() != told:
            raise ValueError(f"`{out}` holds another study, or the same in another number of tasks: give a new folder")
        return
    if out.exists() and any(out.iterdir()):
        raise ValueError(f"`{out}` is not empty, and was not begun here: give a new folder")
    for folder in ("shards", "rows"):
        (out / folder).mkdir(parents=True, exist_ok=True)
    _written(mark, lambda file: Path(file).write_text(told))


def _written(file: Path, write: Callable[[str], Any]) -> None:
    """There whole, or not at all."""
    partial = file.with_name(file.name + ".partial")
    write(os.fspath(partial))
    os.replace(partial, file)


def _table(rows: dict[str, Any]) -> pyarrow.Table:
    import pyarrow

    return pyarrow.table(rows)


def _bar(wanted: bool, tasks: int, done: int) -> Callable[[], Any]:
    if not wanted:
        return lambda: None
    from tqdm.auto import tqdm

    bar = tqdm(total=tasks, initial=done, unit="task")
    return lambda: bar.update()


# On a worker


@functools.lru_cache(maxsize=4)
def _compiled(text: str, name: str, said: tuple[str, ...]) -> Mechanism:
    return Mechanism(text, name, list(said))


def _of(source: tuple[str, str, list[str]]) -> Mechanism:
    text, name, said = source
    return _compiled(text, name, tuple(said))


def _life_shard(question: tuple[Any, ...], number: int, tasks: int) -> _Done:
    source, said = question
    with tempfile.TemporaryDirectory() as folder:
        first, lives = _of(source)._compiled.live_shard(said, f"{number}/{tasks}", folder)
        shard = Path(folder, "life.shard").read_bytes()
    rows = {
        "trajectory": np.arange(first, first + len(lives.cycles), dtype=np.uint64),
        "life [cycles]": lives.cycles,
        "whole cycles": lives.whole_cycles,
        "failed joint": [lives.joints[int(at)] for at in lives.failed],
    }
    return shard, rows


def _study_shard(question: tuple[Any, ...], number: int, tasks: int) -> _Done:
    source, said = question
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "study.part")
        answer = _of(source)._compiled.study_shard(said, f"{number}/{tasks}", os.fspath(file))
        shard = file.read_bytes()
    rows = Study(json.loads(answer))
    columns: dict[str, Any] = {f"{name} [{rows.units[name]}]": rows[name] for name in rows.names}
    return shard, {**columns, "error": [code or "" for code in rows.errors]}


def _replicates(question: tuple[Any, ...], number: int, tasks: int) -> _Done:
    said, name, table, count = question
    first, last = (count * (number - 1) // tasks, count * number // tasks)
    drawn = _linkwear.replicates(said, name, table, first, last)
    groups, estimates = [], []
    for group, replicates in json.loads(drawn).items():
        groups += [group] * len(replicates["estimates"])
        estimates += replicates["estimates"]
    return drawn.encode(), {"group": groups, "estimates": estimates}
