"""Coats of paint or dye over the pixels of images."""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import check_method, map_to_gamut
from uplift.common.arrays import Array, Floats
from uplift.extras.colour.spaces import ImageSpace
from uplift.extras.images import exr
from uplift.extras.paint.coats import Coat
from uplift.extras.texture.colours import Counts, check_encoding
from uplift.extras.texture.uplifter import Converter
from uplift.lookup.blocks import blockwise
from uplift.lookup.cube import Cube


@dataclass(frozen=True, eq=False)
class Overpainter(Converter):
    """Converter that lays a coat over images, made by `overpainter`. The gamut is
    mapped before and after painting.
    """

    coat: Coat  # at the wavelengths of the sensor
    # from linear RGB (..., 3) to reflectances (..., N)
    reflectance: Callable[[Floats], Floats]
    threads: int  # that share a band

    def paint(self, rgb: Floats) -> Floats:
        """Lay the coat over linear RGB (..., 3) in [0, 1]; the result may
        be outside.
        """
        return blockwise(
            self._paint_block, rgb.astype(float), 3, np.float32, self.threads
        )

    def convert(self, rgb: Floats) -> tuple[tuple[Floats, ...], Counts]:
        """Lay the coat over a block of colours (..., 3) and map the result to the
        gamut, counting pixels outside.
        """
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
        Interpretation of the numbers in images; ``auto`` takes integers as encoded,
        floats as linear.
    out_of_gamut : str
        Gamut mapping for pixels outside [0, 1], one of
        `uplift.colorimetry.gamut.METHODS`.
    threads : int
        Threads that share a band.
    space : ImageSpace, optional
        RGB space of images, by default the one that each file states.

    Returns
    -------
    Overpainter
        The converter to pass to `uplift.extras.texture.convert`.
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
