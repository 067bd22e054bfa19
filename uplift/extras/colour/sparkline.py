"""Spectra as lines of block characters."""

import numpy as np

from uplift.common.arrays import Array

BLOCKS = "▁▂▃▄▅▆▇█"


def sparklines(values: Array, width: int = 40) -> list[str]:
    """Draw spectra (n, N) from 0 to 1 in eighths."""
    width = min(width, values.shape[1])
    last = values.shape[1] - 1
    cells = np.rint(np.arange(width) * last / max(width - 1, 1)).astype(int)
    levels = np.rint(values[:, cells] * (len(BLOCKS) - 1)).astype(int)
    return ["".join(row) for row in np.array(list(BLOCKS))[levels].tolist()]
