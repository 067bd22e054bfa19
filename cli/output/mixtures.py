"""Mixtures as text, JSON or plot."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

from uplift.common.errors import UpliftWarning

from ..params.ingredients import library_ingredients
from .console import emit, print_json
from .coordinates import coordinates, describe
from .query_output import format_rgb, hex_code, patch, print_columns, print_fields, sparkline

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.design.mixing.coats import Medium
    from uplift.lookup import Cube

    from ..params.ingredients import Ingredient, SpectrumResolver


@dataclass(frozen=True, eq=False)
class Mixture:
    """A mixture and the ramp from its first to its last ingredient.

    Row 0 of ``parts`` (1 + k, n) and of ``rgb`` (1 + k, 3), linear in [0, 1], is the mixture. The other rows are the
    ramp. ``spectrum`` (N,) at ``wavelengths`` (N,) nm is that of the mixture.
    """

    kind: str
    ingredients: tuple[Ingredient, ...]
    parts: Array
    wavelengths: Array
    spectrum: Array
    rgb: Array

    @property
    def names(self) -> list[str]:
        return [one.name for one in self.ingredients]

    @property
    def recipe(self) -> str:
        """The ingredients as '2 of blue, 1 of yellow'."""
        return ", ".join(f"{one.parts:g} of {one.name}" for one in self.ingredients)


def make_mixture(
    resolver: SpectrumResolver,
    kind: str,
    ingredients: list[Ingredient],
    medium: Medium,
    ground: str | None,
    steps: int,
    method: str,
) -> Mixture:
    """Mix ingredients, and a ramp of ``steps`` through them. Warns if the mixture lies outside [0, 1]."""
    import numpy as np

    from uplift.colorimetry.gamut import map_to_gamut
    from uplift.design.mixing.coats import mix, ramp

    sensor = resolver.cube.data.sensor
    parts = np.array([one.parts for one in ingredients])
    amounts = np.concatenate([parts[None], ramp(parts, steps)])
    spectra = mix(kind, library_ingredients(ingredients), amounts, medium, resolver.spectrum(ground or "white"))
    count = len(sensor.wavelengths)
    mapped = map_to_gamut(sensor.rgb(spectra[:, :count]), sensor, method)
    if mapped.outside[0]:
        problem = f"the mixture lies outside [0, 1]: mapped into the gamut ({method})"
        warnings.warn(UpliftWarning(problem, code="mixture-mapped"), stacklevel=1)
    return Mixture(kind, tuple(ingredients), amounts, resolver.wavelengths[count:], spectra[0, count:], mapped.rgb)


def as_json(cube: Cube, mixture: Mixture) -> None:
    """Print one JSON object."""
    steps = [
        {
            "parts": parts.tolist(),
            "rgb": rgb.tolist(),
            "hex": hex_code(cube, rgb),
            **coordinates(cube, rgb),
        }
        for parts, rgb in zip(mixture.parts, mixture.rgb, strict=True)
    ]
    fields = {
        "kind": mixture.kind,
        "names": mixture.names,
        **steps[0],
        "wavelengths": mixture.wavelengths.tolist(),
        "spectrum": mixture.spectrum.tolist(),
        "ramp": steps[1:],
    }
    print_json(fields, indent=None)


def as_table(cube: Cube, mixture: Mixture) -> None:
    """Print colour, ramp and spectrum."""
    rgb, spectrum = mixture.rgb[0], mixture.spectrum
    fields = {
        mixture.kind: mixture.recipe,
        "linear RGB": f"{format_rgb(rgb)}  {hex_code(cube, rgb)}",
        **describe(cube, rgb),
        **_ramp(cube, mixture),
        "spectrum": f"{sparkline(spectrum / max(1, spectrum.max()))}  "
        f"{mixture.wavelengths[0]:g}–{mixture.wavelengths[-1]:g} nm",
    }
    patches = {
        "linear RGB": patch(cube, rgb),
        "ramp": "".join(patch(cube, step, 4) for step in mixture.rgb[1:]),
    }
    print_fields(fields, patches)
    emit("")
    print_columns(mixture.wavelengths, spectrum)


def _ramp(cube: Cube, mixture: Mixture) -> dict[str, str]:
    """Return hex codes of the ramp; empty for a single ingredient."""
    if len(mixture.names) < 2:
        return {}
    return {"ramp": " ".join(hex_code(cube, step) for step in mixture.rgb[1:])}


def plot(cube: Cube, mixture: Mixture, path: str, *, force: bool) -> None:
    """Write swatches of the mixture and of the ramp as PNG. Raises `OutputError`."""
    from uplift.colorimetry.srgb import to_display_codes
    from uplift.viz.plots import Strip, plot_strips

    codes = to_display_codes(mixture.rgb, cube.data.sensor) / 255
    strips = [Strip(f"{mixture.kind}: {mixture.recipe}", codes[:1])]
    if len(mixture.names) > 1:
        strips.append(Strip(f"from {mixture.names[0]} to {mixture.names[-1]}", codes[1:]))
    plot_strips(strips, path, force=force)
