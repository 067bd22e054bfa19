"""Images of lights of one pass, such as environment maps: numbers of lights as R, G and
B of OpenEXR.
"""

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.extras.emission.file import emission_digest
from uplift.extras.emission.lookup import EmissionTable
from uplift.extras.images.converter import (
    Band,
    Converted,
    ImageConverter,
    RowConverter,
    resolve_depth,
)
from uplift.extras.images.counts import Counts
from uplift.extras.scene.passes.passes import Passes
from uplift.extras.scene.passes.textures import band_rows, check_number, pass_header
from uplift.extras.texture.emission import DEPTHS, light_power, light_reader

NEGATIVE = "pixels-negative"
CLAMPED = "with negative numbers: clamped to 0"


def prepare_light_pass(
    table: EmissionTable,
    passes: Passes,
    number: int,
    *,
    depth: str | None = None,
    encoding: str = "auto",
    space: str | None = None,
    threads: int = 2,
) -> RowConverter:
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
    RowConverter
        The converter to pass to `uplift.extras.texture.convert`.

    Raises
    ------
    OptionError
        The number, the depth or the encoding is unknown.
    UnknownNameError
        The RGB space is unknown.
    """
    check_number(passes, number)
    depth = resolve_depth(depth, DEPTHS, "lights")
    reader = light_reader(table, encoding, space)
    # (3, 81): from power in the units of the table to numbers
    projection = table_projection(passes)[band_rows(number)]
    grid = observer.grid()

    def rows(band: Band) -> Converted:
        _, power, counts = light_power(table, band.rgb, grid, threads)
        numbers = power @ projection.T
        negative = (numbers < 0).any(axis=-1)
        counts += Counts.of(NEGATIVE, negative.sum(), CLAMPED)
        return (np.maximum(numbers, 0).astype(np.float32),), counts

    settings = {"as": "light pass", "depth": depth, **reader.settings}
    return RowConverter(
        reader=reader,
        depth=depth,
        header={
            "uplift.cube": emission_digest(table.data),
            **pass_header(passes, number, settings),
        },
        to_rows=ImageConverter(rows),
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
