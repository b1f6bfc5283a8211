"""Progress bars, by tqdm where it is installed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def told(wanted: bool, what: str) -> Iterator[Callable[[float], None] | None]:
    """What hears the part that is done, from 0 to 1; None where nobody wants to know."""
    if not wanted:
        yield None
        return
    from tqdm.auto import tqdm

    with tqdm(total=100, desc=what, unit="%", bar_format="{l_bar}{bar}| {elapsed}<{remaining}") as bar:

        def hears(part: float) -> None:
            # Work in several stages begins anew at each.
            bar.n = 100 * part
            bar.refresh()

        yield hears
        bar.n = 100
        bar.refresh()
