"""Mixtures on paper: a sheet for eyes, or JSON."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

import click

from uplift.common.errors import UpliftWarning

from ..params.ingredients import given
from .console import json_text
from .query_output import columns, hex_code, shown_codes, sparkline, triple

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.design.mixing.recipes import Medium
    from uplift.lookup import Cube

    from ..params.ingredients import Ingredient, Shelf


@dataclass(frozen=True, eq=False)
class Mixture:
    """The first of ``parts`` (1 + k, n) is what was asked for, the others lead from the first to the last ingredient.

    ``rgb`` (1 + k, 3) are linear, in [0, 1]; ``spectrum`` (N,) at ``wavelengths`` (N,) nm is that of the first.
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
    def told(self) -> str:
        """'2 of blue, 1 of yellow'."""
        return ", ".join(f"{one.parts:g} of {one.name}" for one in self.ingredients)


def mixed_on(
    shelf: Shelf,
    kind: str,
    ingredients: list[Ingredient],
    medium: Medium,
    ground: str | None,
    steps: int,
    way: str,
) -> Mixture:
    """The mixture, and ``steps`` on the way through its ingredients; a mixture that was moved inside is said."""
    import numpy as np

    from uplift.colorimetry.gamut import map_to_gamut
    from uplift.design.mixing.recipes import mixed, ramp

    sensor = shelf.cube.data.sensor
    parts = np.array([one.parts for one in ingredients])
    amounts = np.concatenate([parts[None], ramp(parts, steps)])
    spectra = mixed(kind, given(ingredients), amounts, medium, shelf.spectrum(ground or "white"))
    count = len(sensor.wavelengths)
    moved = map_to_gamut(sensor.rgb(spectra[:, :count]), sensor, way)
    if moved.outside[0]:
        warnings.warn(f"the mixture lies outside [0, 1]: moved inside ({way})", UpliftWarning, stacklevel=1)
    return Mixture(
        kind, tuple(ingredients), amounts, shelf.wavelengths[count:], spectra[0, count:], moved.rgb
    )


def as_json(cube: Cube, mixture: Mixture) -> None:
    """One object."""
    steps = [
        {"parts": parts.tolist(), "rgb": rgb.tolist(), "hex": hex_code(cube, rgb)}
        for parts, rgb in zip(mixture.parts, mixture.rgb, strict=True)
    ]
    found = {
        "kind": mixture.kind,
        "names": mixture.names,
        **steps[0],
        "wavelengths": mixture.wavelengths.tolist(),
        "spectrum": mixture.spectrum.tolist(),
        "ramp": steps[1:],
    }
    click.echo(json_text(found, indent=None))


def as_table(cube: Cube, mixture: Mixture) -> None:
    """A sheet, and the spectrum in columns."""
    rgb, spectrum = mixture.rgb[0], mixture.spectrum
    facts = {
        mixture.kind: mixture.told,
        "linear RGB": f"{triple(rgb)}  {hex_code(cube, rgb)}  {click.style(' ' * 8, bg=shown_codes(cube, rgb))}",
        **_ramp(cube, mixture),
        "spectrum": f"{sparkline(spectrum / max(1, spectrum.max()))}  "
        f"{mixture.wavelengths[0]:g}–{mixture.wavelengths[-1]:g} nm",
    }
    for name, text in facts.items():
        click.echo(f"{name:<12}{text}")
    click.echo()
    columns(mixture.wavelengths, spectrum)


def _ramp(cube: Cube, mixture: Mixture) -> dict[str, str]:
    """Patches and codes; of one ingredient there is none."""
    if len(mixture.names) < 2:
        return {}
    patches = "".join(click.style("    ", bg=shown_codes(cube, step)) for step in mixture.rgb[1:])
    return {"ramp": patches + "  " + " ".join(hex_code(cube, step) for step in mixture.rgb[1:])}


def draw(cube: Cube, mixture: Mixture, path: str, *, force: bool) -> None:
    """The mixture, and below it the way from the first to the last, as a PNG. Raises `OutputError`."""
    from uplift.colorimetry.srgb import to_display_codes
    from uplift.viz.swatches import Strip, plot_strips

    codes = to_display_codes(mixture.rgb, cube.data.sensor) / 255
    strips = [Strip(f"{mixture.kind}: {mixture.told}", codes[:1])]
    if len(mixture.names) > 1:
        strips.append(Strip(f"from {mixture.names[0]} to {mixture.names[-1]}", codes[1:]))
    plot_strips(strips, path, force=force)
