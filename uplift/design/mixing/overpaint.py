"""Painting over images: every pixel is uplifted, coated in the spectral domain, and converted back to RGB."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import check_method, map_to_gamut
from uplift.colorimetry.spaces import ImageSpace
from uplift.common.arrays import Array
from uplift.design.mixing.coats import Coat
from uplift.io import exr
from uplift.io.texture.colours import Counts, Floats, check_encoding
from uplift.io.texture.uplifter import Converter
from uplift.lookup import Cube
from uplift.lookup.blocks import blockwise


@dataclass(frozen=True, eq=False)
class Overpainter(Converter):
    """Converter that lays a coat over images, made by `overpainter`. The gamut is mapped before and after painting."""

    coat: Coat  # at the wavelengths of the sensor
    reflectance: Callable[[Floats], Floats]  # from linear RGB (..., 3) to reflectances (..., N)
    threads: int  # that share a band

    def paint(self, rgb: Floats) -> Floats:
        """Lay the coat over linear RGB (..., 3) in [0, 1]; the result may be outside."""
        return blockwise(self._paint_block, rgb.astype(float), 3, np.float32, self.threads)

    def convert(self, rgb: Floats) -> tuple[tuple[Floats, ...], Counts]:
        """Lay the coat over a block of colours (..., 3) and map the result to the gamut, counting pixels outside."""
        mapped = map_to_gamut(self.paint(rgb), self.sensor, self.out_of_gamut)
        return (mapped.rgb,), Counts(painted_outside=mapped.count)

    def _paint_block(self, rgb: Array) -> Array:
        return self.sensor.rgb(self.coat.over(self.reflectance(rgb.astype(np.float32))))


def overpainter(
    cube: Cube,
    coat: Coat,
    recipe: Mapping[str, Any] | None = None,
    *,
    encoding: str = "auto",
    out_of_gamut: str = "scale",
    threads: int = 2,
    space: ImageSpace | None = None,
) -> Overpainter:
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
        Interpretation of the numbers in images; ``auto`` takes integers as encoded, floats as linear.
    out_of_gamut : str
        Gamut mapping for pixels outside [0, 1], one of `uplift.colorimetry.gamut.METHODS`.
    threads : int
        Threads that share a band.
    space : ImageSpace, optional
        RGB space of images, by default the one that each file states.

    Returns
    -------
    Overpainter
        The converter to pass to `uplift.io.texture.convert`.
    """
    from uplift.lookup import bulk

    check_encoding(encoding)
    check_method(out_of_gamut)
    sensor = cube.data.sensor
    header = {
        "chromaticities": exr.chromaticities(sensor),
        "uplift.mix": json.dumps(dict(recipe or {}), allow_nan=False),
    }
    sampler = bulk.spectra(cube, threads=1)
    settings = (sensor, "float", encoding, out_of_gamut, (), header)
    return Overpainter(*settings, coat, sampler, threads, space=space)
