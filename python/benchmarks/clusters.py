"""Lives per core and hour on one worker and two, and what a task costs beside its lives: the figures of docs/clusters.md."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from distributed import Client, LocalCluster

import linkwear as lw
import linkwear.dask

MECHANISM = Path(__file__).parents[2] / "mechanisms" / "rssr.toml"

#: Coupling, lives, tasks.
QUESTIONS: list[tuple[str, int, list[int]]] = [("table", 10_000_000, [2, 4]), ("full", 64, [2, 4])]


def seconds(work: Callable[[], Any]) -> float:
    """What it takes."""
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def main() -> None:
    """Prints one row for each way to ask."""
    rssr = lw.compile(MECHANISM)
    print("coupling   lives  tasks  workers  seconds  lives/core/h  to one process")
    for coupling, lives, counts in QUESTIONS:
        asked: dict[str, Any] = {"trajectories": lives, "coupling": coupling}
        alone = seconds(lambda: rssr.life(threads=1, **asked))
        print(f"{coupling:8} {lives:7} {'':>6} {'':>8} {alone:8.1f} {3600 * lives / alone:13.0f}")
        for workers in (1, 2):
            cluster = LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None)
            with cluster, Client(cluster) as client, tempfile.TemporaryDirectory() as folder:
                for tasks in counts:
                    out = Path(folder, str(tasks))
                    took = seconds(lambda: linkwear.dask.life(rssr, tasks=tasks, out=out, client=client, **asked))
                    rate = 3600 * lives / (took * workers)
                    print(
                        f"{coupling:8} {lives:7} {tasks:6} {workers:8} {took:8.1f} {rate:13.0f} {took * workers / alone:15.2f}",
                        flush=True,
                    )


if __name__ == "__main__":
    main()
