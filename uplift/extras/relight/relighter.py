"""Images of full size under other lights, as OpenEXR in the RGB space of the image
(docs/textures.md).
"""

import json
from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import conversion
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import display_sensors
from uplift.common.arrays import Floats
from uplift.extras.images import exr
from uplift.extras.images.channels import channel_names
from uplift.extras.images.converter import (
    Band,
    Converted,
    ImageConverter,
    RowConverter,
)
from uplift.extras.images.counts import Counts
from uplift.extras.images.image import Part
from uplift.extras.images.reader import SurfaceReader
from uplift.lookup.cube import Cube
from uplift.lookup.node_table import prepare_products


def prepare_relighter(
    cube: Cube,
    lights: Sequence[Illuminant],
    *,
    adapt: bool = True,
    encoding: str = "auto",
    out_of_gamut: str = "clip",
    space: str | None = None,
    threads: int = 2,
) -> RowConverter:
    """Prepare a cube for images under other lights.

    R, G and B of the result are colours under the first light. Each further light is a
    layer of its name, such as ``FL11.R``, ``FL11.G`` and ``FL11.B``.

    Parameters
    ----------
    cube : Cube
        The cube.
    lights : sequence of str or Lamp
        At least one light, as for `uplift.colorimetry.observer.light`.
    adapt : bool, default True
        Whether the white of each light is the white of the RGB space (Bradford).
        Otherwise colours have its tint.
    encoding, out_of_gamut, space, threads
        As for `uplift.extras.texture.prepare`.

    Returns
    -------
    RowConverter
        The converter to pass to `convert`.

    Raises
    ------
    OptionError
        The encoding or gamut mapping is unknown.
    UnknownNameError
        A light or the RGB space is unknown.
    """
    sensor = cube.data.sensor
    reader = SurfaceReader(
        sensor=sensor, encoding=encoding, space=space, out_of_gamut=out_of_gamut
    )
    screens = display_sensors(
        lights, sensor.observer, *sensor.range, space=sensor.space
    )
    names = [screen.illuminant for screen in screens]
    if not adapt:
        screens = tuple(
            replace(screen, xyz_to_rgb=sensor.xyz_to_rgb) for screen in screens
        )
    layers = channel_names(names[1:])
    settings: dict[str, object] = {
        "as": "relit",
        "lights": names,
        "encoding": encoding,
        "out_of_gamut": out_of_gamut,
    }
    settings |= {} if adapt else {"adapt": False}
    matrix = np.concatenate([screen.matrix for screen in screens])
    sample = prepare_products(cube.data, cube.wavelengths, matrix, threads)

    def rows(band: Band) -> Converted:
        lit = _to_space(reader, band.part, sample(band.rgb))
        return (band.weighted(lit),), Counts()

    def part_header(part: Part) -> dict[str, Any]:
        space = reader.source_space(part)
        gamut = sensor if space is None else space.gamut
        return {"chromaticities": exr.chromaticities(gamut)}

    return RowConverter(
        reader=reader,
        depth="half",
        channels=tuple(map(".".join, product(layers, "RGB"))),
        header={
            **exr.attributes(cube.data),
            "uplift.texture": json.dumps(settings),
            "uplift.lights": ", ".join(names),
        },
        to_rows=ImageConverter(rows, part_header),
    )


def _to_space(reader: SurfaceReader, part: Part, lit: Floats) -> Floats:
    """Convert linear RGB (…, 3 L) of the sensor to the space of a part."""
    space = reader.source_space(part)
    if space is None or space.matrix_to(reader.sensor) is None:
        return lit
    to_space = np.linalg.inv(conversion(space.gamut, reader.sensor))
    colours = lit.reshape(-1, 3) @ to_space.T.astype(lit.dtype)
    return colours.reshape(lit.shape)
