"""Write the tables of colour-science that most commands need: ``python -m
tools.ship_tables``.

`uplift.colorimetry.tables` reads them; tests/colorimetry/test_tables.py compares them
with colour-science.
"""

from collections.abc import Mapping
from operator import attrgetter
from typing import Any

import colour
import numpy as np

from uplift.colorimetry.tables import PATH, SPECTRA, TABLES, WAVELENGTHS, aligned


def tables() -> dict[str, np.ndarray]:
    """Return the arrays of the file by name."""
    arrays = {
        "version": np.array(colour.__version__),
        "bradford": colour.adaptation.CHROMATIC_ADAPTATION_TRANSFORMS["Bradford"],
    }
    for kind, table in TABLES.items():
        found: Mapping[str, Any] = attrgetter(table)(colour)
        arrays[f"{kind}: names"] = np.array(list(found))
        arrays[f"{kind}: stated"] = np.array([each.name for each in found.values()])
        if kind in SPECTRA:
            arrays[f"{kind}: samples"] = np.array(
                [aligned(kind, each, *WAVELENGTHS).values for each in found.values()]
            )
    spaces = colour.RGB_COLOURSPACES
    arrays["RGB space: primaries"] = np.array(
        [each.primaries for each in spaces.values()], dtype=float
    )
    arrays["RGB space: whitepoint"] = np.array(
        [each.whitepoint for each in spaces.values()], dtype=float
    )
    arrays["RGB space: matrix"] = np.array(
        [each.matrix_XYZ_to_RGB for each in spaces.values()], dtype=float
    )
    codes = np.arange(256) / 255
    arrays["RGB space: decoding"] = np.array(
        [each.cctf_decoding(codes) for each in spaces.values()], dtype=float
    )
    return arrays


if __name__ == "__main__":
    arrays: dict[str, Any] = tables()
    np.savez_compressed(PATH, **arrays)
