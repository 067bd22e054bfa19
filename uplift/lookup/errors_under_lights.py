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

from uplift.colorimetry.delta_e import delta_e_spectra, rgb_to_lab
from uplift.colorimetry.gamut import SRGB, conversion
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.likely_errors import ExpectedError, expected_error
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.extensions import extension
from uplift.cube.data import CubeData
from uplift.lookup.interpolate import around
from uplift.models.model import reflectance

END = 1 / 16
"""Distance in linear sRGB from the ends of [0, 1] within which few reflectances may be
possible. Elsewhere the expected errors of no cube are near to the possible ones.
"""


def as_light(data: CubeData, light: Illuminant | Light) -> Light:
    """Return the light of an illuminant, which reads tables, for a cube."""
    if isinstance(light, Light):
        return light
    from uplift.colorimetry.observer import light as make_light

    return make_light(light, data.sensor.observer, *data.sensor.range)


def limited(
    data: CubeData, light: Illuminant | Light, rgb: Array, errors: Array
) -> Array:
    """Limit expected errors (n, 2) of linear RGB (n, 3) by what metamers differ by."""
    srgb = rgb @ conversion(data.sensor, SRGB).T
    near = (np.abs(srgb - 0.5) > 0.5 - END).any(axis=1)
    if near.any():
        limit = extension("errors", "limits")
        errors[near] = limit(data, as_light(data, light), rgb[near], errors[near])
    return errors


@dataclass(frozen=True, eq=False, repr=False)
class LightErrors:
    """Standard errors and error bounds under a light."""

    data: CubeData
    light: Light
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
        errors = np.sqrt(radii**2 * squares + remaining**2)
        return limited(self.data, self.light, rgb, errors)


@dataclass(frozen=True, eq=False, repr=False)
class Evidence:
    """Measured materials, and the answers of a cube that has and that has not learnt
    from them.
    """

    lab: Array
    """(M, 3) CIE L*a*b* under the build illuminant."""
    measured: NDArray[Any]
    """(M, N) reflectances at the wavelengths of the sensor."""
    left_out: NDArray[Any]
    """(M, N) answers without the material, or without its family."""
    kept: NDArray[Any]
    """(M, N) answers with it."""
    family: Array | None
    """(M,) number of the family; None for entries of the atlas."""

    def expected_error(
        self, light: Light, products: tuple[Array, Array] | None = None
    ) -> ExpectedError:
        """Learn the expected squares of ΔE00 under a light, or other ``products``."""
        missed = delta_e_spectra(light, self.left_out, self.measured)
        remaining = delta_e_spectra(light, self.kept, self.measured)
        return expected_error(self.lab, missed, remaining, products, self.family)


def has_evidence(data: CubeData) -> bool:
    """Whether a cube has left-out materials."""
    return data.atlas.left_out is not None or data.families is not None


def evidence(data: CubeData) -> Evidence:
    """Return the left-out entries of the atlas, or families where the atlas is too
    small; `OptionError` without either.
    """
    atlas = data.atlas
    families = data.families
    if atlas.measured is not None and atlas.left_out is not None:
        stored = atlas.coefficients[: len(atlas.measured)]
        kept = reflectance(data.model, stored, data.sensor.wavelengths)
        return Evidence(data.evidence_lab, atlas.measured, atlas.left_out, kept, None)
    if families is not None:
        # No answer knows these materials: with all of them, nothing remains.
        return Evidence(
            data.evidence_lab,
            families.measured,
            families.predicted,
            kept=families.measured,
            family=families.family,
        )
    raise OptionError(
        "standard errors under a light need a cube with left-out materials",
        code="too-few-entries",
        hint="build the cube again, with the library or an atlas of at least 8 entries",
    )


def light_errors(data: CubeData, light: Light) -> LightErrors:
    """Learn the standard errors under a light; `OptionError` without `evidence`."""
    return errors_from(data, light, evidence(data))


def errors_from(data: CubeData, light: Light, known: Evidence) -> LightErrors:
    """Learn the standard errors under a light from evidence."""
    expected = known.expected_error(light)
    remaining = np.array(expected.radii) * np.sqrt(expected.floor)
    entries = np.tile(remaining, (len(data.atlas.names), 1))
    measured = data.atlas.measured
    if measured is not None:
        rows = np.arange(len(measured))
        spectra = data.atlas.spectra.reflectance(rows, data.sensor.wavelengths)
        entries[rows] = delta_e_spectra(light, spectra, measured)[:, None]
    return LightErrors(data, light, expected, entries)
