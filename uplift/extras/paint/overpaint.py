"""Coats of paint or dye over the pixels of images."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import map_to_gamut
from uplift.common.arrays import Array
from uplift.extras.images import exr
from uplift.extras.images.converter import (
    Band,
    Converted,
    ImageConverter,
    RowConverter,
)
from uplift.extras.images.counts import Counts
from uplift.extras.images.reader import PAST_TENSE, SurfaceReader
from uplift.extras.paint.optics import Coat
from uplift.lookup.blocks import blockwise
from uplift.lookup.cube import Cube

PAINTED_OUTSIDE = "painted-pixels-out-of-gamut"


def overpainter(
    cube: Cube,
    coat: Coat,
    recipe: Mapping[str, Any] | None = None,
    *,
    encoding: str = "auto",
    out_of_gamut: str = "scale",
    threads: int = 2,
    space: str | None = None,
) -> RowConverter:
    """Prepare to paint over images.

    Parameters
    ----------
    cube : Cube
        The cube that uplifts.
    coat : Coat
        The coat, at the wavelengths of the cube's sensor.
    recipe : mapping, optional
        Description of the coat in JSON values, written to the header.
    encoding : {"auto", "linear", "encoded"}
        Interpretation of the numbers in images; ``auto`` takes integers as encoded,
        floats as linear.
    out_of_gamut : str
        Gamut mapping for pixels outside [0, 1], one of
        `uplift.colorimetry.gamut.METHODS`.
    threads : int
        Threads that share a band.
    space : str, optional
        RGB space of images, as for `uplift.extras.colour.spaces.find_space`, by default
        the one that each file states.

    Returns
    -------
    RowConverter
        The converter to pass to `uplift.extras.texture.convert`.
    """
    from uplift.lookup import bulk

    sensor = cube.data.sensor
    reader = SurfaceReader(
        sensor=sensor, encoding=encoding, space=space, out_of_gamut=out_of_gamut
    )
    reflectance = bulk.spectra(cube, threads=1)
    text = f"outside [0, 1] after painting: {PAST_TENSE[out_of_gamut]}"

    def paint(rgb: Array) -> Array:
        return sensor.rgb(coat.over(reflectance(rgb.astype(np.float32))))

    def rows(band: Band) -> Converted:
        # The gamut is mapped before painting, by the reader, and after.
        painted = blockwise(paint, band.rgb.astype(float), 3, np.float32, threads)
        mapped = map_to_gamut(painted, sensor, out_of_gamut)
        counts = Counts.of(PAINTED_OUTSIDE, mapped.count, text)
        return (band.weighted(mapped.rgb),), counts

    return RowConverter(
        reader=reader,
        depth="float",
        header={
            "chromaticities": exr.chromaticities(sensor),
            "uplift.mix": json.dumps(dict(recipe or {}), allow_nan=False),
        },
        to_rows=ImageConverter(rows),
    )
