"""Statistics of errors, as columns of rows."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

Row = dict[str, Any]
"""Row of a table of results: texts and numbers by column."""
STATISTICS: Mapping[str, Callable[..., Any]] = {
    "mean": np.mean,
    "deviation": np.std,
    "median": np.median,
    "max": np.max,
    "most": np.max,
    "q2_5": partial(np.quantile, q=0.025),
    "q25": partial(np.quantile, q=0.25),
    "q75": partial(np.quantile, q=0.75),
    "q97_5": partial(np.quantile, q=0.975),
}
"""Statistics by the column that they have in tables; ``most`` is the maximum."""


def statistics(errors: ArrayLike, *names: str, prefix: str = "") -> dict[str, float]:
    """Compute statistics of errors as columns, whose names begin with ``prefix``."""
    return {prefix + name: float(STATISTICS[name](errors)) for name in names}
