"""Faults, pickles, threads, interrupts, pictures."""

from __future__ import annotations

import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, file

import linkwear as lw


def test_faults_say_code_place_and_cure(tmp_path: Path) -> None:
    text = file("four_bar").read_text().replace("[parameters]", "[parametres]", 1) + "\nnonsense = 1\n"
    with pytest.raises(lw.FileError) as caught:
        lw.compile(text)
    fault = caught.value
    assert fault.code and fault.code.startswith("E")
    assert fault.line and fault.column and fault.message and fault.help
    assert len(fault.errors) >= 1 and fault.code in str(fault)
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(text)
    with pytest.raises(lw.FileError) as caught:
        lw.compile(wrong)
    assert caught.value.file == str(wrong)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (again.code, again.line, str(again)) == (caught.value.code, caught.value.line, str(caught.value))
    with pytest.raises(FileNotFoundError):
        lw.compile(tmp_path / "none.toml")


def test_options_that_do_not_fit_are_usage_errors() -> None:
    four_bar = lw.compile(file("four_bar"))
    with pytest.raises(lw.UsageError, match="turns"):
        four_bar.simulate(turns=-1)
    with pytest.raises(lw.UsageError):
        four_bar.simulate(turns=1, time=1)
    with pytest.raises(lw.LinkwearError):
        four_bar.life()
    with pytest.raises(lw.LinkwearError, match="nothing_such"):
        lw.compile(file("four_bar"), nothing_such=1.0)


def test_mechanisms_and_results_travel() -> None:
    mechanism = lw.compile(file("rssr"), speed="3 Hz")
    there = pickle.loads(pickle.dumps(mechanism))
    assert there.parameters == mechanism.parameters and there.text == mechanism.text
    life = there.life(trajectories=50)
    copy = pickle.loads(pickle.dumps(life))
    assert copy.to_dict() == life.to_dict() and np.array_equal(copy.lives, life.lives)
    motion = there.simulate(turns=0.2)
    copied = pickle.loads(pickle.dumps(motion))
    assert copied.columns == motion.columns and np.array_equal(copied.numbers, motion.numbers)


def test_other_threads_run_beside_a_life() -> None:
    mechanism = lw.compile(file("rssr"))
    counted, done = 0, threading.Event()

    def count() -> None:
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    beside = threading.Thread(target=count)
    beside.start()
    mechanism.life(trajectories=100000, threads=1)
    done.set()
    beside.join()
    # With the lock held nothing would be counted but before and after.
    assert counted > 20


def test_an_interrupt_ends_a_life(tmp_path: Path) -> None:
    # A shell that starts tests in the background has them ignore interrupts, and Python takes that over.
    code = f"""
import signal
import linkwear as lw
signal.signal(signal.SIGINT, signal.default_int_handler)
mechanism = lw.compile({str(file("rssr"))!r})
print("begin", flush=True)
try:
    mechanism.life(trajectories=100000, coupling="full")
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, cwd=tmp_path)
    assert process.stdout is not None
    assert process.stdout.readline() == "begin\n"
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    try:
        rest, _ = process.communicate(timeout=60)
    finally:
        # One that did not hear would go on for hours.
        process.kill()
    assert rest == "interrupted\n"


def test_progress_is_told_and_may_stop_the_work() -> None:
    mechanism = lw.compile(file("rssr"))
    parts: list[float] = []
    mechanism._compiled.life(["--trajectories=100000"], parts.append)
    # Stages, the mean path and the lives, begin anew.
    assert len(parts) > 3 and all(0 <= part <= 1 for part in parts) and max(parts) > 0.5

    def enough(part: float) -> None:
        raise ValueError("enough")

    with pytest.raises(ValueError, match="enough"):
        mechanism._compiled.life(["--trajectories=100000", "--coupling=full"], enough)


def test_frames_and_arrow_tables_lie_on_the_same_numbers() -> None:
    pyarrow = pytest.importorskip("pyarrow")
    motion = lw.compile(file("four_bar")).simulate(samples=11)
    frame, table = motion.to_pandas(), motion.to_arrow()
    assert list(frame.columns) == motion.columns == table.column_names
    assert np.shares_memory(frame[motion.columns[1]].to_numpy(), motion.numbers)
    assert np.array_equal(table.column(2).to_numpy(), motion.numbers[2])
    chunk = table.column(1).chunk(0)
    assert isinstance(chunk, pyarrow.Array) and chunk.buffers()[1].address == motion.numbers[1].ctypes.data
    assert b"file_sha256" in table.schema.metadata[b"linkwear"]
    with pytest.raises(KeyError, match="did you mean"):
        motion["R1.qq [rad]"]


def test_pictures_are_drawn(tmp_path: Path) -> None:
    import matplotlib.pyplot as plt

    rssr = lw.compile(file("rssr"))
    fit = lw.fit(
        ROOT / "examples" / "data" / "sliding_wear_100g.csv",
        unit="unit",
        wear="wear_um",
        exposure="cycles",
        from_zero=True,
        power_law=True,
    )
    prediction = fit.predict(threshold=100, current=40, at=1000)
    life = rssr.life(trajectories=100)
    for name, drawn in {
        "motion": rssr.simulate(samples=50),
        "life": life,
        "fit": fit,
        "prediction": prediction,
    }.items():
        ax = drawn.plot()
        figure = np.atleast_1d(ax)[0].figure
        figure.savefig(tmp_path / f"{name}.png")
        figure.canvas.draw()
        pixels = np.asarray(figure.canvas.buffer_rgba())
        assert len(np.unique(pixels.reshape(-1, 4), axis=0)) > 20, name
        plt.close(figure)


def test_importing_brings_in_numpy_alone(tmp_path: Path) -> None:
    code = """
import sys, numpy, time
begin = time.perf_counter()
import linkwear
heavy = {"pandas", "matplotlib", "pyarrow", "distributed", "dask", "scipy", "tqdm"} & set(sys.modules)
print(time.perf_counter() - begin, sorted(heavy))
"""
    # Not from here: beside the tests lies the source of the package, without its library.
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=tmp_path).stdout
    assert said.strip().endswith("[]"), said
