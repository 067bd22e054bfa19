"""Standard errors of answers under any light, learnt from atlas entries that were left
out (docs/mathematics.md, 7).

RGB does not identify a material: the errors are those of materials like the entries of
the atlas. `Cube.unlike_atlas` finds colours that no entry is near to; of a material of
another family with the colour of an entry nothing is known.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry import Light, delta_e_spectra, rgb_to_lab
from uplift.colorimetry.likely_errors import ExpectedError, expected_error
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.cube import CubeData
from uplift.lookup.interpolate import around
from uplift.models import reflectance


@dataclass(frozen=True, eq=False, repr=False)
class LightErrors:
    """Standard errors and error bounds under a light."""

    data: CubeData
    expected: ExpectedError
    """Squares of ΔE00, without entry boxes."""
    entries: Array
    """(E, 2) ΔE00 between the measured and the stored spectrum of each entry; of looks,
    what remains on average.
    """

    def __call__(self, rgb: Array) -> Array:
        """ΔE00 (n, 2) that 68 % and 95 % of measurements stay within, at linear RGB (n,
        3) in [0, 1].

        In an entry box, the error that remains at entries is mixed with that of the
        entry, as spectra are.
        """
        nodes = around(self.data, rgb)
        radii = np.array(self.expected.radii)
        squares = self.expected(rgb_to_lab(self.data.sensor, rgb))
        # e² = radius² E[e²] + e₀², with the error e₀ that remains at the entries
        # themselves
        remaining = np.tile(radii * np.sqrt(self.expected.floor), (len(rgb), 1))
        remaining = nodes.hits.mix(remaining, self.entries[nodes.hits.entry])
        return np.asarray(np.sqrt(radii**2 * squares + remaining**2))


def light_errors(data: CubeData, light: Light) -> LightErrors:
    """Learn the standard errors under a light; `OptionError` without
    left-out entries.
    """
    measured, left_out = evidence(data)
    at = data.sensor.wavelengths
    rows = np.arange(len(measured))
    missed = delta_e_spectra(light, left_out, measured)
    plain = delta_e_spectra(
        light, reflectance(data.model, data.atlas.coefficients[rows], at), measured
    )
    stored = delta_e_spectra(light, data.atlas.spectra.reflectance(rows, at), measured)
    expected = expected_error(data.entry_lab, missed, plain)
    entries = np.tile(
        np.array(expected.radii) * np.sqrt(expected.floor), (len(data.atlas.names), 1)
    )
    entries[rows] = stored[:, None]
    return LightErrors(data, expected, entries)


def outside_errors(data: CubeData, light: Light | None) -> Array:
    """ΔE00 (O,) between stored and measured spectrum of the entries outside the RGB
    space, NaN if it is not known.
    """
    table = data.atlas.outside
    if table is None:
        return np.zeros(0)
    if light is None or light.name == data.error_illuminant:
        return table.error
    if table.measured is None:
        return np.full(len(table.names), np.nan)
    stored = table.spectra.reflectance(
        np.arange(len(table.names)), data.sensor.wavelengths
    )
    return delta_e_spectra(light, stored, table.measured)


def evidence(data: CubeData) -> tuple[NDArray[Any], NDArray[Any]]:
    """Reflectances (M, N) of the entries as measured, and as answered without each of
    them.
    """
    if data.atlas.measured is None or data.atlas.left_out is None:
        raise OptionError(
            (
                "standard errors under a light need a cube with the left-out entries "
                "of "
                "its atlas"
            ),
            code="too-few-entries",
            hint="build the cube again, with an atlas of at least 8 entries",
        )
    return data.atlas.measured, data.atlas.left_out
