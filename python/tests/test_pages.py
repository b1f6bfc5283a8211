"""Pages and pictures are those of the command line."""

from __future__ import annotations

import json
import pickle
import re
from pathlib import Path
from typing import Any

import pytest
from conftest import file

import linkwear as lw


def numbers(page: str) -> list[Any]:
    """The JSON that a page holds, without the time that the run took."""
    found = re.findall(r'<script type="application/json"[^>]*>(.*?)</script>', page, flags=re.DOTALL)
    return [json.loads(re.sub(r'"wall_seconds":[-+.e0-9]+', '"wall_seconds":0', text)) for text in found]


def test_a_report_has_the_numbers_of_a_life(command_line: Any, tmp_path: Path) -> None:
    rssr = lw.compile(file("rssr"))
    page = rssr.report(trajectories=100, seed=3)
    out = tmp_path / "page.html"
    command_line("report", file("rssr"), "--trajectories", "100", "--seed", "3", "--out", out)
    assert numbers(page.html) and numbers(page.html) == numbers(out.read_text())
    page.save(out)
    assert out.read_text() == page.html
    assert page._repr_html_().startswith("<iframe srcdoc=") and pickle.loads(pickle.dumps(page)).html == page.html


def test_a_view_and_a_picture(command_line: Any, tmp_path: Path) -> None:
    four_bar = lw.compile(file("four_bar"))
    assert "<canvas" in four_bar.view(turns=0.5).html
    out = tmp_path / "x.svg"
    command_line("draw", file("four_bar"), "--out", out)
    assert four_bar.draw().svg == out.read_text() == four_bar._repr_html_()
    with pytest.raises(lw.UsageError):
        four_bar.view(turns=-1)

