"""Images of one pass: textures as numbers of surfaces, environment maps as numbers of
lights, both as R, G and B of OpenEXR.
"""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from uplift.colorimetry import observer
from uplift.common.errors import OptionError, PassesError
from uplift.cube.file import digest
from uplift.extras.images import exr
from uplift.extras.images.converter import (
    Band,
    Converted,
    ImageConverter,
    RowConverter,
    resolve_depth,
)
from uplift.extras.images.counts import Counts
from uplift.extras.images.reader import SurfaceReader
from uplift.extras.scene.passes.bands import CHANNELS
from uplift.extras.scene.passes.file import passes_digest
from uplift.extras.scene.passes.passes import Passes
from uplift.lookup.cube import Cube
from uplift.lookup.node_table import prepare_products

ATTRIBUTE = "uplift.passes"
"""Attribute of an image: the digest of the passes, and the number of the pass."""


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
) -> RowConverter:
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
    RowConverter
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
    check_number(passes, number)
    data = cube.data
    reader = SurfaceReader(
        sensor=data.sensor, encoding=encoding, space=space, out_of_gamut=out_of_gamut
    )
    depth = resolve_depth(depth, ("half", "float"), "passes")
    weights = passes.bands.weights[band_rows(number)]
    sample = prepare_products(data, observer.grid(), weights, threads)

    def rows(band: Band) -> Converted:
        return (band.weighted(np.clip(sample(band.rgb), 0, 1)),), Counts()

    settings = {"as": "pass", "depth": depth, **reader.settings}
    header = exr.attributes(data) | pass_header(passes, number, settings)
    # Numbers of bands are not colours of an RGB space.
    del header["chromaticities"]
    return RowConverter(
        reader=reader, depth=depth, header=header, to_rows=ImageConverter(rows)
    )


def check_number(passes: Passes, number: int) -> None:
    """Raise `OptionError` unless passes have one of this number, from 1."""
    if not 1 <= number <= passes.count:
        raise OptionError(
            f"number of the pass must be in [1, {passes.count}], got {number}"
        )


def pass_header(
    passes: Passes, number: int, settings: Mapping[str, Any]
) -> dict[str, Any]:
    """Attributes of an image of a pass, with its settings."""
    centres = passes.bands.centres[band_rows(number)]
    described = {**settings, "passes": pass_mark(passes, number)}
    return {
        ATTRIBUTE: pass_mark(passes, number),
        "uplift.bands": ", ".join(f"{centre:g} nm" for centre in centres),
        "uplift.texture": json.dumps(described),
    }
