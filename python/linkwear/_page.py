"""Pages and pictures, for files, browsers and notebooks."""

from __future__ import annotations

import html
import os
import tempfile
import webbrowser
from pathlib import Path
from urllib.parse import quote

#: Height of a page in a notebook, in pixels of its style.
_HEIGHT = 720


class _Document:
    """A text that a browser shows without a network: saved, or shown."""

    #: How the names of its files end.
    _ending = ""

    def __init__(self, text: str) -> None:
        self._text = text

    def __repr__(self) -> str:
        return f"<linkwear.{type(self).__name__} of {len(self._text) // 1000} kB>"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes it."""
        Path(path).write_text(self._text, encoding="utf-8")

    def show(self) -> None:
        """Opens it in the browser."""
        with tempfile.NamedTemporaryFile("w", suffix=self._ending, encoding="utf-8", delete=False) as file:
            file.write(self._text)
        webbrowser.open(Path(file.name).as_uri())


class Page(_Document):
    """A page: in a notebook it is shown where it is the value of a cell."""

    _ending = ".html"

    @property
    def html(self) -> str:
        """The whole page."""
        return self._text

    def _repr_html_(self) -> str:
        # A document of its own: its style and its keys are not the notebook's.
        inside = html.escape(self._text, quote=True)
        return f'<iframe srcdoc="{inside}" style="width:100%;height:{_HEIGHT}px;border:0"></iframe>'


class Picture(_Document):
    """A picture (SVG): in a notebook it is shown where it is the value of a cell."""

    _ending = ".svg"

    @property
    def svg(self) -> str:
        """Its source."""
        return self._text

    def _repr_svg_(self) -> str:
        return self._text

    def _repr_html_(self) -> str:
        # As an image: the classes of its style are not the notebook's.
        inside = html.escape("data:image/svg+xml;charset=utf-8," + quote(self._text), quote=True)
        return f'<img src="{inside}" style="max-width:100%">'
