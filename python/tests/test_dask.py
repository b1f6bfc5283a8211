"""Tasks of Dask: on two workers, one of which is killed in mid-run, the result of one process."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT, file

import linkwear as lw

distributed = pytest.importorskip("distributed")
pandas = pytest.importorskip("pandas")


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


def test_lives_survive_a_killed_worker_and_go_on_from_a_folder(client: Any, tmp_path: Path) -> None:
    import linkwear.dask

    rssr = lw.compile(file("rssr"))
    question: dict[str, Any] = {"trajectories": 2000, "seed": 5}
    undisturbed = rssr.life(**question)
    out = tmp_path / "lives"
    victims = list(client.run(os.getpid).values())
    killed = threading.Event()

    def kill() -> None:
        # When the first task is done others are on their way.
        deadline = time.monotonic() + 120
        while not list(out.glob("shards/*.shard")) and time.monotonic() < deadline:
            time.sleep(0.01)
        os.kill(victims[0], signal.SIGKILL)
        killed.set()

    killer = threading.Thread(target=kill)
    killer.start()
    spread = linkwear.dask.life(rssr, tasks=8, out=out, client=client, **question)
    killer.join()
    assert killed.is_set() and len(list(out.glob("shards/*.shard"))) == 8
    assert spread.to_dict() == undisturbed.to_dict()
    assert np.array_equal(spread.lives, undisturbed.lives)
    # Rows that came in the meantime are those of the lives.
    rows = pandas.read_parquet(out / "rows").sort_values("trajectory")
    assert np.array_equal(rows["life [cycles]"], undisturbed.lives)
    assert list(rows.columns) == list(undisturbed.to_pandas().columns)

    # What is lost is asked for again, and only that.
    kept = out / "shards" / "000002.shard"
    before = kept.stat().st_mtime_ns
    (out / "shards" / "000001.shard").unlink()
    again = linkwear.dask.life(rssr, tasks=8, out=out, client=client, **question)
    assert again.to_dict() == undisturbed.to_dict() and kept.stat().st_mtime_ns == before
    with pytest.raises(ValueError, match="another study"):
        linkwear.dask.life(rssr, tasks=8, out=out, client=client, **{**question, "seed": 6})


def test_studies(client: Any, tmp_path: Path) -> None:
    import linkwear.dask

    mechanism = lw.compile(file("rssr_rigid"))
    vary = {"L1": ("100 mm", "400 mm", 7)}
    alone = mechanism.study(vary, ["peak.R1.F", "steps"])
    spread = linkwear.dask.study(mechanism, vary, ["peak.R1.F", "steps"], tasks=3, out=tmp_path / "s", client=client)
    assert spread.to_dict() == alone.to_dict()
    rows = pandas.read_parquet(tmp_path / "s" / "rows")
    assert list(rows.columns) == list(alone.to_pandas().columns) and len(rows) == 7


def test_replicates_of_the_bootstrap(client: Any, tmp_path: Path) -> None:
    import linkwear.dask

    data = ROOT / "examples" / "data" / "sliding_wear_100g.csv"
    named: dict[str, Any] = {
        "unit": "unit",
        "wear": "wear_um",
        "exposure": "cycles",
        "from_zero": True,
        "power_law": True,
        "bootstrap": 101,
    }
    alone = lw.fit(data, **named)
    spread = linkwear.dask.fit(data, tasks=4, out=tmp_path / "b", client=client, **named)
    assert spread.to_dict() == alone.to_dict()


def test_a_fault_on_a_worker_is_the_caller_s(client: Any, tmp_path: Path) -> None:
    import linkwear.dask

    with pytest.raises(lw.LinkwearError, match=r"alpha") as caught:
        linkwear.dask.life(
            lw.compile(file("four_bar_wear")), trajectories=8, tasks=2, out=tmp_path / "f", client=client
        )
    assert caught.value.code
