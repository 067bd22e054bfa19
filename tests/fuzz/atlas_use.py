"""What becomes of an atlas that was read: it is sampled as a build does, written, and read again."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from uplift.atlas import read_atlas, resample, write_atlas
from uplift.common.errors import UpliftError

GRID = np.arange(380.0, 781.0, 5.0)


def use(path: Path) -> None:
    """Raises `UpliftError` where ``path`` cannot be read, ValueError where what was read is no atlas."""
    spectra = read_atlas(path)
    values = resample(spectra, GRID).values
    if not ((values >= 0) & (values <= 1)).all():
        raise ValueError("reflectances outside [0, 1]")
    if not spectra.entries:
        return
    again = path.with_suffix(".again")
    try:
        write_atlas(spectra, again)
        if read_atlas(again).names != spectra.names:
            raise ValueError("written and read again, it is another atlas")
    except UpliftError as error:
        raise ValueError("written, it cannot be read again") from error
    finally:
        again.unlink(missing_ok=True)
