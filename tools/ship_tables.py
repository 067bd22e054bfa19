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

SPACE_FIELDS = {
    "primaries": "primaries",
    "whitepoint": "whitepoint",
    "matrix": "matrix_XYZ_to_RGB",
}
"""Attributes of RGB spaces by their names in the file."""


def tables() -> dict[str, np.ndarray]:
    """Return the arrays of the file by name."""
    arrays = {
        "version": np.array(colour.__version__),
        "bradford": colour.adaptation.CHROMATIC_ADAPTATION_TRANSFORMS["Bradford"],
    }
    for kind, table in TABLES.items():
        entries: Mapping[str, Any] = attrgetter(table)(colour)
        arrays[f"{kind}: names"] = np.array(list(entries))
        arrays[f"{kind}: stated"] = np.array([item.name for item in entries.values()])
        if kind in SPECTRA:
            samples = [
                aligned(kind, spectrum, *WAVELENGTHS).values
                for spectrum in entries.values()
            ]
            arrays[f"{kind}: samples"] = np.array(samples)
    spaces = colour.RGB_COLOURSPACES.values()
    for field, attribute in SPACE_FIELDS.items():
        values = [getattr(space, attribute) for space in spaces]
        arrays[f"RGB space: {field}"] = np.array(values, dtype=float)
    codes = np.arange(256) / 255
    decoded = [space.cctf_decoding(codes) for space in spaces]
    arrays["RGB space: decoding"] = np.array(decoded, dtype=float)
    return arrays


if __name__ == "__main__":
    np.savez_compressed(PATH, **tables())
