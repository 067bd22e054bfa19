"""Conformance of another lookup of a cube: its picture of the chart, or its spectra,
compared with those of this package.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import light
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, StrPath
from uplift.cube.data import CubeData
from uplift.extras.colour.light_sets import REGRESSION_LIGHTS
from uplift.extras.report.comparison import (
    Comparison,
    compare_colours,
    mean_p95_max,
)
from uplift.extras.report.conformance_chart import (
    COLUMNS,
    COUNT,
    ROWS,
    Chart,
    make_chart,
)
from uplift.extras.report.conformance_results import (
    SPECTRA,
    read_patches,
    read_spectra,
    spectra_wavelengths,
)
from uplift.lookup.cube import Cube

LIGHT = "A"
"""Light of the scene: smooth, which keeps noise low, and far from that of the cube."""
MODES = ("spectra", "refined", "moments")
"""Modes of lookup that conform."""
PICTURES = ".exr"


class Differences(NamedTuple):
    """Mean, 95 % quantile and largest ΔE00 of patches."""

    mean: float
    p95: float
    largest: float

    def within(self, limits: "Differences") -> bool:
        """Whether all are at most as large as limits."""
        return all(figure <= limit for figure, limit in zip(self, limits, strict=True))


PICTURE_LIMITS = Differences(0.2, 0.5, 1.0)
"""Sampled wavelengths, and the renderer's own table of the observer, differ by less
(docs/guides/conformance.md).
"""
SPECTRA_LIMITS = Differences(0.02, 0.05, 0.2)
"""Half floats differ by less."""


@dataclass(frozen=True, eq=False)
class Reference:
    """What a lookup of a cube should return for the chart, as XYZ under a light."""

    cube: Cube
    chart: Chart
    light: Light
    wavelengths: Array

    def xyz(self, mode: str) -> Array:
        """Return XYZ (1000, 3) of the spectra in a mode of lookup."""
        spectra = self.cube.reflectance(self.chart.rgb, self.wavelengths, mode)
        return np.asarray(spectra @ self.light.xyz.T)

    def product(self) -> Array:
        """Return XYZ (1000, 3) of products of RGB with the RGB of the light."""
        to_rgb = self.cube.data.sensor.xyz_to_rgb
        light_rgb = to_rgb @ self.light.white
        return np.asarray((self.chart.rgb * light_rgb) @ np.linalg.inv(to_rgb).T)


@dataclass(frozen=True, eq=False)
class Conformance:
    """Patches compared with the mode of lookup that is nearest: the XYZ (1000, 3) that
    were found and those expected.

    ``explanation`` names a mistake that gives these colours, and is empty if none is
    known.
    """

    mode: str
    chart: Chart
    found: Array
    expected: Array
    comparison: Comparison
    limits: Differences
    explanation: str = ""

    @property
    def light(self) -> str:
        """Light of the picture."""
        return self.comparison.lights[0]

    @property
    def brightness(self) -> float:
        """Sum of Y relative to the expected one."""
        return float(self.found[:, 1].sum() / self.expected[:, 1].sum())

    @property
    def differences(self) -> Differences:
        """The figures that have limits."""
        return summarise(self.comparison)

    @property
    def passed(self) -> bool:
        """Whether all figures are within the limits."""
        return self.differences.within(self.limits)

    def to_json(self, worst: int) -> dict[str, Any]:
        """Return the figures, and the patches of the largest ΔE00."""
        rows = []
        for patch in self.comparison.worst_rows(worst).tolist():
            colour = {
                "patch": patch,
                "name": self.chart.names[patch],
                "rgb": self.chart.rgb[patch].tolist(),
                "delta_e": float(self.comparison.worst[patch]),
            }
            rows.append(colour)
        return {
            "passed": self.passed,
            "light": self.light,
            "mode": self.mode,
            "delta_e": self.differences._asdict(),
            "limits": self.limits._asdict(),
            "brightness": self.brightness,
            "explanation": self.explanation,
            "worst": rows,
        }


def summarise(comparison: Comparison) -> Differences:
    """Return the figures of patches."""
    return Differences(*mean_p95_max(comparison.delta_e).values())


def check_renderer(
    path: StrPath, cube: Cube, illuminant: Illuminant = LIGHT
) -> Conformance:
    """Compare what another program makes of the chart of a cube with its own answers.

    Parameters
    ----------
    path : path-like
        A picture of the chart under a light, if it ends in ``.exr``: linear sRGB, or
        the RGB space that it states, or XYZ. None is adapted to the light, and Y of a
        white diffuser is 1. Or else
        reflectances as CSV: the colours of the chart in ``r``, ``g``, ``b``, and a
        column for each of 400, 410, …, 700 nm.
    cube : Cube
        The cube that the program used.
    illuminant : str or Lamp, default "A"
        Light of the picture, or under which reflectances are compared.

    Returns
    -------
    Conformance

    Raises
    ------
    TextureError
        The picture cannot be read, is of another size, or has codes or values that are
        not finite.
    ColourError
        The table cannot be read, or has other colours or wavelengths; or the cube has
        no XYZ (``camera-without-xyz``).
    """
    cube.data.sensor.require_xyz()
    chart = make_chart(cube.data)
    if Path(path).suffix.lower() == PICTURES:
        reference = picture_reference(cube, chart, illuminant)
        return compare(read_patches(path), reference, PICTURE_LIMITS)
    shown = light(illuminant, cube.observer, *SPECTRA)
    reference = Reference(cube, chart, shown, spectra_wavelengths())
    xyz = read_spectra(path, chart) @ shown.xyz.T
    return compare(xyz, reference, SPECTRA_LIMITS)


def picture_reference(cube: Cube, chart: Chart, illuminant: Illuminant) -> Reference:
    """Return the reference of pictures, on the wavelengths of the cube."""
    shown = light(illuminant, cube.observer, *cube.data.sensor.range)
    return Reference(cube, chart, shown, cube.wavelengths)


def compare(xyz: Array, reference: Reference, limits: Differences) -> Conformance:
    """Compare XYZ (1000, 3) with all modes, and explain a failure."""

    def conformance(mode: str) -> Conformance:
        expected = reference.xyz(mode)
        compared = compare_colours(expected, xyz, reference.light)
        return Conformance(mode, reference.chart, xyz, expected, compared, limits)

    nearest = min(map(conformance, MODES), key=lambda found: found.differences.mean)
    if nearest.passed:
        return nearest
    for mode in MODES:
        for explanation, mistaken in _mistakes(reference, mode, nearest.brightness):
            compared = compare_colours(mistaken, xyz, reference.light)
            if summarise(compared).within(limits):
                return replace(nearest, explanation=explanation)
    return nearest


def _mistakes(
    reference: Reference, mode: str, brightness: float
) -> Iterator[tuple[str, Array]]:
    """Yield mistakes and the XYZ (1000, 3) that they give in a mode of lookup."""
    right = reference.xyz(mode)
    rows = right.reshape(ROWS, COLUMNS, 3)
    yield f"all is {brightness:.4g} times as bright", brightness * right
    yield "the picture is upside down", rows[::-1].reshape(COUNT, 3)
    yield "the picture is mirrored", rows[:, ::-1].reshape(COUNT, 3)
    yield "the picture is turned by 180°", right[::-1]
    if reference.wavelengths is reference.cube.wavelengths:
        for name in REGRESSION_LIGHTS:
            other = picture_reference(reference.cube, reference.chart, name)
            yield f"the light is {name}", other.xyz(mode)
    yield "RGB is multiplied by the RGB of the light", reference.product()
    yield "nodes are not interpolated", reference.xyz("nearest")
    bare = replace(reference, cube=Cube(_without_boxes(reference.cube.data)))
    yield "the boxes of entries are ignored", bare.xyz(mode)


def _without_boxes(data: CubeData) -> CubeData:
    """Return a cube whose entries have no boxes."""
    atlas = replace(data.atlas, half_width=np.zeros_like(data.atlas.half_width))
    return replace(data, atlas=atlas)
