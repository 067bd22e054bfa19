"""Statistics of errors, as columns of rows."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

Row = dict[str, Any]
"""Row of a table of results: text and numbers by column."""
STATISTICS: Mapping[str, Callable[..., Any]] = {
    "mean": np.mean,
    "deviation": np.std,
    "median": np.median,
    "max": np.max,
    "most": np.max,
    "q2_5": partial(np.quantile, q=0.025),
    "q25": partial(np.quantile, q=0.25),
    "q75": partial(np.quantile, q=0.75),
    "p95": partial(np.quantile, q=0.95),
    "q97_5": partial(np.quantile, q=0.975),
}
"""Statistics by the column that they have in tables; ``most`` is the maximum."""


def statistics(errors: ArrayLike, *names: str, prefix: str = "") -> dict[str, float]:
    """Compute statistics of errors, by default mean, 95th percentile and maximum."""
    return {
        f"{prefix}{name}": float(STATISTICS[name](errors))
        for name in names or ("mean", "p95", "max")
    }
