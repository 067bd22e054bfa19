"""RGB spaces that images and cubes usually have, from the smallest gamut to the largest."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.lights import DEFAULT_ILLUMINANT
from uplift.colorimetry.observer import DEFAULT_OBSERVER, sensor

COMMON_SPACES = ("sRGB", "Display P3", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB")
"""Names of colour-science, by the area of the gamut in CIE 1976 u′, v′."""


def smallest_space(
    reflectances: ArrayLike, illuminant: str = DEFAULT_ILLUMINANT, observer: str = DEFAULT_OBSERVER
) -> str | None:
    """Find the smallest of the common RGB spaces that holds all colours of reflectances.

    Parameters
    ----------
    reflectances : array_like, shape (..., N)
        Reflectances in units of 1 on the wavelengths of `uplift.colorimetry.observer.grid`.
    illuminant : str
        Illuminant that the RGB refer to.
    observer : str
        Colour-matching functions.

    Returns
    -------
    str or None
        One of `COMMON_SPACES`; None if none of them holds all colours.

    Raises
    ------
    UnknownNameError
        The illuminant or the observer is unknown.

    Examples
    --------
    >>> import numpy as np
    >>> smallest_space(np.full(81, 0.5))
    'sRGB'
    """
    for space in COMMON_SPACES:
        candidate = sensor(space, illuminant, observer)
        if candidate.contains(candidate.rgb(reflectances)).all():
            return space
    return None


def holding_note(
    reflectances: ArrayLike, illuminant: str = DEFAULT_ILLUMINANT, observer: str = DEFAULT_OBSERVER
) -> str:
    """Describe the smallest of the common RGB spaces that holds all colours of reflectances.

    Parameters
    ----------
    reflectances : array_like, shape (E, N)
        Reflectances, as for `smallest_space`.
    illuminant : str
        Illuminant that the RGB refer to.
    observer : str
        Colour-matching functions.

    Returns
    -------
    str
        Such as "Display P3 holds all 24".

    Raises
    ------
    UnknownNameError
        The illuminant or the observer is unknown.
    """
    space = smallest_space(reflectances, illuminant, observer)
    if space is None:
        return f"none of {', '.join(COMMON_SPACES)} holds all"
    return f"{space} holds all {len(np.asarray(reflectances))}"
