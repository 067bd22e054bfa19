"""Images of one pass: textures as numbers of surfaces, environment maps as numbers of
lights, both as R, G and B of OpenEXR.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.gamut import check_method
from uplift.common.arrays import Array, Floats
from uplift.common.errors import OptionError, PassesError
from uplift.cube import digest
from uplift.extras.colour.spaces import find_space
from uplift.extras.emission.lookup import EmissionTable, load_emission
from uplift.extras.images import exr
from uplift.extras.scene.passes.bands import CHANNELS
from uplift.extras.scene.passes.file import passes_digest, read_passes
from uplift.extras.scene.passes.passes import Passes
from uplift.extras.texture.channels import ColourChannels
from uplift.extras.texture.colours import Counts, check_encoding
from uplift.extras.texture.emission import LightUplifter, prepare_lights
from uplift.extras.texture.image import Part
from uplift.extras.texture.sequence import TextureSettings
from uplift.extras.texture.uplifter import (
    Converted,
    Converter,
    ReadColours,
    Sampler,
    resolve_depth,
)
from uplift.lookup import Cube, load
from uplift.lookup.node_table import prepare_products

ATTRIBUTE = "uplift.passes"
"""Attribute of an image: the digest of the passes, and the number of the pass."""
LARGEST_HALF = float(np.finfo(np.float16).max)


def pass_mark(passes: Passes, number: int) -> str:
    """Return the attribute `ATTRIBUTE` of images of a pass, counted from 1."""
    return f"{passes_digest(passes)} {number} of {passes.count}"


def pass_name(stem: str, number: int) -> str:
    """Return the name of the image of a pass.

    Parameters
    ----------
    stem : str
        Name of all images without suffix.
    number : int
        Number of the pass, from 1.

    Returns
    -------
    str

    Examples
    --------
    >>> pass_name("wood", 2)
    'wood.2.exr'
    """
    return f"{stem}.{number}.exr"


def band_rows(number: int) -> slice:
    """Return the bands of a pass, counted from 1."""
    return slice(CHANNELS * (number - 1), CHANNELS * number)


def check_cube(passes: Passes, cube: Cube) -> None:
    """Check that passes were not chosen for the colours of another cube.

    Parameters
    ----------
    passes : Passes
        The passes.
    cube : Cube
        The cube whose spectra are converted.

    Raises
    ------
    PassesError
        They were (``passes-of-another-cube``).
    """
    known = passes.origin.get("cube", "")
    if known and known != digest(cube.data):
        raise PassesError(
            "the passes were chosen for the spectra of another cube",
            code="passes-of-another-cube",
            hint="use that cube, or choose the passes again with this one",
        )


@dataclass(frozen=True, eq=False)
class PassUplifter(Converter):
    """A converter of colours to the three numbers of a pass, made by `prepare_pass`."""

    sample: Sampler

    def convert(self, rgb: Floats) -> Converted:
        return (np.clip(self.sample(rgb), 0, 1),), Counts()


def prepare_pass(
    cube: Cube,
    passes: Passes,
    number: int,
    *,
    depth: str | None = None,
    encoding: str = "auto",
    out_of_gamut: str = "clip",
    space: str | None = None,
    threads: int = 2,
) -> PassUplifter:
    """Prepare a cube for the textures of a pass.

    Parameters
    ----------
    cube : Cube
        The cube.
    passes : Passes
        The passes.
    number : int
        Number of the pass, from 1.
    depth : {"half", "float"}, optional
        Type of the channels, by default ``half``.
    encoding, out_of_gamut, space, threads
        As for `uplift.extras.texture.prepare`.

    Returns
    -------
    PassUplifter
        The converter to pass to `uplift.extras.texture.convert`.

    Raises
    ------
    PassesError
        The passes were chosen for another cube.
    OptionError
        The number, depth, encoding or gamut mapping is unknown.
    UnknownNameError
        The RGB space is unknown.
    """
    check_cube(passes, cube)
    _check_number(passes, number)
    check_encoding(encoding)
    check_method(out_of_gamut)
    depth = resolve_depth(depth, ("half", "float"), "passes")
    settings = {
        "as": "pass",
        "depth": depth,
        "encoding": encoding,
        "out_of_gamut": out_of_gamut,
    }
    settings |= {} if space is None else {"space": space}
    weights = passes.bands.weights[band_rows(number)]
    sample = prepare_products(cube.data, observer.grid(), weights, threads)
    header = exr.attributes(cube.data) | _header(passes, number, settings)
    # Numbers of bands are not colours of an RGB space.
    del header["chromaticities"]
    return PassUplifter(
        cube.data.sensor,
        depth,
        encoding,
        out_of_gamut,
        (),
        header,
        sample=sample,
        space=None if space is None else find_space(space),
    )


def _check_number(passes: Passes, number: int) -> None:
    if not 1 <= number <= passes.count:
        raise OptionError(
            f"number of the pass must be in [1, {passes.count}], got {number}"
        )


def _header(passes: Passes, number: int, settings: Mapping[str, Any]) -> dict[str, Any]:
    centres = passes.bands.centres[band_rows(number)]
    described = {**settings, "passes": pass_mark(passes, number)}
    return {
        ATTRIBUTE: pass_mark(passes, number),
        "uplift.bands": ", ".join(f"{centre:g} nm" for centre in centres),
        "uplift.texture": json.dumps(described),
    }


@dataclass(frozen=True, eq=False)
class PassLightUplifter(Converter):
    """A converter of the colours of lights to the three numbers of a pass, made by
    `prepare_light_pass`.

    ``projection`` (3, 81) leads from power in the units of the table to numbers.
    """

    lights: LightUplifter
    projection: Array

    def colour_channels(self, found: ColourChannels) -> ColourChannels:
        return self.lights.colour_channels(found)

    def decoder(self, part: Part) -> ReadColours:
        return self.lights.decoder(part)

    def convert(self, rgb: Floats) -> Converted:
        power, counts = self.lights.power(rgb)
        numbers = power @ self.projection.T
        limit = LARGEST_HALF if self.depth == "half" else np.finfo(np.float32).max
        negative = (numbers < 0).any(axis=-1)
        bright = (numbers > limit).any(axis=-1)
        counts += Counts(negative=int(negative.sum()), too_bright=int(bright.sum()))
        return (np.clip(numbers, 0, limit).astype(np.float32),), counts


def prepare_light_pass(
    table: EmissionTable,
    passes: Passes,
    number: int,
    *,
    depth: str | None = None,
    encoding: str = "auto",
    space: str | None = None,
    threads: int = 2,
) -> PassLightUplifter:
    """Prepare an emission table for images of lights of a pass.

    Parameters
    ----------
    table : EmissionTable
        The table.
    passes : Passes
        The passes.
    number : int
        Number of the pass, from 1.
    depth, encoding, space, threads
        As for `uplift.extras.texture.prepare_lights`.

    Returns
    -------
    PassLightUplifter
        The converter to pass to `uplift.extras.texture.convert`.

    Raises
    ------
    OptionError
        The number, the depth or the encoding is unknown.
    UnknownNameError
        The RGB space is unknown.
    """
    _check_number(passes, number)
    lights = prepare_lights(
        table,
        observer.grid(),
        depth=depth,
        encoding=encoding,
        space=space,
        threads=threads,
    )
    settings = {"as": "light pass", "depth": lights.depth, "encoding": encoding}
    settings |= {} if space is None else {"space": space}
    header = {"uplift.cube": lights.header["uplift.cube"]}
    return PassLightUplifter(
        lights.sensor,
        lights.depth,
        encoding,
        lights.out_of_gamut,
        (),
        header | _header(passes, number, settings),
        lights=lights,
        projection=table_projection(passes)[band_rows(number)],
        space=lights.space,
    )


def table_projection(passes: Passes) -> Array:
    """Return the matrix from power in the units of emission tables to numbers.

    Parameters
    ----------
    passes : Passes
        The passes.

    Returns
    -------
    ndarray, shape (K, 81)
        Matrix for power at 380, 385, …, 780 nm, of which that of equal energy and
        luminance 1 is 1.
    """
    luminance = observer.matching_functions()[:, 1]
    return passes.light_projection / luminance.sum()


@dataclass(frozen=True)
class PassSettings(TextureSettings):
    """Settings of the textures of one pass.

    Parameters
    ----------
    passes : str
        Path of the passes.
    number : int
        Number of the pass, from 1.
    """

    passes: str = field(default="", kw_only=True)
    number: int = field(default=1, kw_only=True)

    def prepare(self) -> Converter:
        """Prepare the cube or the emission table for a pass.

        Returns
        -------
        Converter
            The converter to pass to `uplift.extras.texture.convert`.
        """
        passes = read_passes(self.passes)
        shared: dict[str, Any] = {
            name: getattr(self, name)
            for name in ("depth", "encoding", "space", "threads")
        }
        if self.emission:
            table = load_emission(self.cubes[0])
            return prepare_light_pass(table, passes, self.number, **shared)
        cube = load(self.cubes[0])
        if self.fill_missing:
            cube = cube.fill_missing(threads=self.threads)
        shared["out_of_gamut"] = self.out_of_gamut
        return prepare_pass(cube, passes, self.number, **shared)
