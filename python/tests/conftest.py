"""What tests share: the project's files, and the command line whose numbers must come again."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import matplotlib
import pytest

matplotlib.use("Agg")

ROOT = Path(__file__).parents[2]
MECHANISMS = ROOT / "mechanisms"


def file(name: str) -> Path:
    """A shipped mechanism."""
    return MECHANISMS / f"{name}.toml"


@pytest.fixture(scope="session")
def command_line() -> Any:
    """Runs `linkwear` and returns its JSON."""
    program = os.environ.get("LINKWEAR", str(ROOT / "target" / "release" / "linkwear"))
    if not Path(program).exists():
        pytest.skip("there is no program: cargo build --release, or name one in LINKWEAR")

    def run(*words: str | Path) -> Any:
        said = [program, *map(str, words), "--format", "json"]
        done = subprocess.run(said, capture_output=True, text=True, cwd=ROOT, check=False)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return run
