"""Linkages from TOML to motion, clearance, wear and the distribution of remaining life.

    import linkwear as lw

    rssr = lw.compile("rssr.toml")
    motion = rssr.simulate(turns=2)
    life = rssr.life(trajectories=1000, seed=7)
    print(life.mean, life.quantiles.p10)

Numbers are those of the command line, to the bit; options have its names, with ``_`` for ``-``. Units are SI where a name has none.
"""

from ._errors import FileError, LinkwearError, RunError, UsageError
from ._fit import Fit, Prediction, fit, load_fit
from ._function import Function
from ._linkwear import __version__
from ._mechanism import Mechanism, StateSpace, compile, study
from ._page import Page, Picture
from ._results import Life, Motion, Record, Study, merge

__all__ = [
    "FileError",
    "Fit",
    "Function",
    "Life",
    "LinkwearError",
    "Mechanism",
    "Motion",
    "Page",
    "Picture",
    "Prediction",
    "Record",
    "RunError",
    "StateSpace",
    "Study",
    "UsageError",
    "__version__",
    "compile",
    "fit",
    "load_fit",
    "merge",
    "study",
]
