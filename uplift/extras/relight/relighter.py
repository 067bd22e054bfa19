"""Images of full size under other lights, as OpenEXR in the RGB space of the image
(docs/textures.md).
"""

import contextlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from uplift.colorimetry.gamut import conversion
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import display_sensors
from uplift.common.arrays import Floats
from uplift.extras.colour.spaces import find_space
from uplift.extras.images import exr
from uplift.extras.texture.colours import Counts, source_space
from uplift.extras.texture.image import Image, Part
from uplift.extras.texture.uplifter import (
    Converted,
    Converter,
    ConvertRows,
    Sampler,
    channel_names,
)
from uplift.lookup.cube import Cube
from uplift.lookup.node_table import prepare_products


@dataclass(frozen=True, eq=False)
class Relighter(Converter):
    """A converter to colours under L lights, by ``sample`` from linear RGB (…, 3) to
    (…, 3 L) of the sensor.
    """

    sample: Sampler

    def part_header(self, part: Part) -> dict[str, object]:
        space = source_space(part, self.sensor, self.space)
        gamut = self.sensor if space is None else space.gamut
        return {"chromaticities": exr.chromaticities(gamut)}

    @contextlib.contextmanager
    def opened(self, image: Image) -> Iterator[ConvertRows]:
        yield lambda part, first, rgb: (
            (self._to_space(part, self.sample(rgb)),),
            Counts(),
        )

    def convert(self, rgb: Floats) -> Converted:
        return (self.sample(rgb),), Counts()

    def _to_space(self, part: Part, lit: Floats) -> Floats:
        """Convert linear RGB (…, 3 L) of the sensor to the space of a part."""
        space = source_space(part, self.sensor, self.space)
        if space is None or space.matrix_to(self.sensor) is None:
            return lit
        to_space = np.linalg.inv(conversion(space.gamut, self.sensor))
        colours = lit.reshape(-1, 3) @ to_space.T.astype(lit.dtype)
        return colours.reshape(lit.shape)


def prepare_relighter(
    cube: Cube,
    lights: Sequence[Illuminant],
    *,
    adapt: bool = True,
    encoding: str = "auto",
    out_of_gamut: str = "clip",
    space: str | None = None,
    threads: int = 2,
) -> Relighter:
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
    Relighter
        The converter to pass to `convert`.

    Raises
    ------
    OptionError
        The encoding or gamut mapping is unknown.
    UnknownNameError
        A light or the RGB space is unknown.
    """
    sensor = cube.data.sensor
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
    matrices = [screen.matrix for screen in screens]
    header = {
        **exr.attributes(cube.data),
        "uplift.texture": json.dumps(settings),
        "uplift.lights": ", ".join(names),
    }
    return Relighter(
        sensor,
        "half",
        encoding,
        out_of_gamut,
        tuple(map(".".join, product(layers, "RGB"))),
        header,
        sample=prepare_products(
            cube.data,
            cube.wavelengths,
            np.concatenate(matrices),
            threads,
        ),
        space=None if space is None else find_space(space),
    )
