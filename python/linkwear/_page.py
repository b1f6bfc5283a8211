"""Pages and pictures, for files, browsers and notebooks."""

from __future__ import annotations

import html
import os
import tempfile
import webbrowser
from pathlib import Path

#: Height of a page in a notebook, in pixels of its style.
_HEIGHT = 720


class Page:
    """A page that needs no network: saved, shown in a browser, or in a notebook where it is the value of a cell."""

    def __init__(self, text: str) -> None:
        #: The whole page.
        self.html = text

    def __repr__(self) -> str:
        return f"<linkwear.Page of {len(self.html) // 1000} kB>"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes it."""
        Path(path).write_text(self.html, encoding="utf-8")

    def show(self) -> None:
        """Opens it in the browser."""
        with tempfile.NamedTemporaryFile("w", suffix=".html", encoding="utf-8", delete=False) as file:
            file.write(self.html)
        webbrowser.open(Path(file.name).as_uri())

    def _repr_html_(self) -> str:
        # A document of its own: its style and its keys are not the notebook's.
        inside = html.escape(self.html, quote=True)
        return f'<iframe srcdoc="{inside}" style="width:100%;height:{_HEIGHT}px;border:0"></iframe>'


class Picture:
    """A picture (SVG): saved, or in a notebook where it is the value of a cell."""

    def __init__(self, text: str) -> None:
        #: Its source.
        self.svg = text

    def __repr__(self) -> str:
        return f"<linkwear.Picture of {len(self.svg) // 1000} kB>"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes it."""
        Path(path).write_text(self.svg, encoding="utf-8")

    def _repr_svg_(self) -> str:
        return self.svg
