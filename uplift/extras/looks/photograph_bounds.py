"""Bounds of answers to several photographs: how the colours under further lights cut
the colours that reflectances of one RGB can have.
"""

from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.extras.looks import mismatch
from uplift.extras.looks.lab_errors import lab_errors_from
from uplift.extras.looks.metamer_bounds import Bounds, bounds_around
from uplift.extras.photographs.answers import Photographs
from uplift.extras.photographs.errors import photographed


def bounds_of_photographs(
    photographs: Photographs,
    rgb: Array,
    others: Array,
    light: Light,
    divisions: int = mismatch.DIVISIONS,
) -> Bounds:
    """Compute bounds of the answers to colours that are known under several lights.

    Parameters
    ----------
    photographs : Photographs
        Made by `uplift.extras.photographs.prepare`.
    rgb : ndarray, shape (n, 3)
        Linear RGB in [0, 1] of the cube.
    others : ndarray, shape (n, 3 L)
        Linear RGB of the further photographs.
    light : Light
        Light under which the bounds are.
    divisions : int
        Density of the boundary points, 0 to 4: see
        `uplift.extras.looks.mismatch.COUNTS`.

    Returns
    -------
    Bounds
        Those of reflectances in [0, 1] that have the colours exactly.

    Raises
    ------
    ColourError
        No reflectance has the colours of a row (``colour-unrealisable``), or ``rgb``
        are outside [0, 1].
    OptionError
        ``others`` have another shape.
    """
    data = photographs.cube.data
    spectra = photographs.reflectance(rgb, others)
    further = mismatch.KnownColours(photographs.matrix, others)
    volumes = mismatch.mismatch_volumes(data.sensor, light, rgb, divisions, further)
    errors = None
    if data.atlas.left_out is not None:
        errors = lab_errors_from(data, light, photographed(photographs))
    return bounds_around(light, spectra, volumes, rgb, errors)
