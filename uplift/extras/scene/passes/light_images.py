"""Images of lights of one pass, such as environment maps: numbers of lights as R, G and
B of OpenEXR.
"""

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array, Floats
from uplift.extras.emission.lookup import EmissionTable
from uplift.extras.scene.passes.passes import Passes
from uplift.extras.scene.passes.textures import band_rows, check_number, pass_header
from uplift.extras.texture.channels import ColourChannels
from uplift.extras.texture.colours import Counts
from uplift.extras.texture.emission import LightUplifter, prepare_lights
from uplift.extras.texture.image import Part
from uplift.extras.texture.uplifter import Converted, Converter, ReadColours


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
        negative = (numbers < 0).any(axis=-1)
        counts += Counts(negative=int(negative.sum()))
        return (np.maximum(numbers, 0).astype(np.float32),), counts


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
    check_number(passes, number)
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
        header | pass_header(passes, number, settings),
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
