"""Opponent space AC1C2: cone fundamentals from confusion points, rotated to their principal axes.

Reference: Meyer 1988, "Wavelength selection for synthetic image generation", Computer Vision, Graphics, and Image
Processing 41(1), sections 2.1 and 2.2 and appendix A.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array

CONFUSION_POINTS = np.array([[0.171, -0.003], [1.14, -0.14], [0.735, 0.265]])
"""Chromaticities xy at which the confusion lines of tritanopes, deuteranopes and protanopes meet. They belong to the
S, M and L cones alone (eq. 20; Estévez 1979)."""
UNIQUE_BLUE, UNIQUE_YELLOW = 475.5, 570.0
"""Wavelengths in nm whose hue does not depend on luminance."""
S_TO_ML_AT_BLUE, L_TO_M_AT_YELLOW = 1 / 16, 2.0
"""Cone ratios s / (m + l) at the first and l / m at the second of these wavelengths (eq. 21; Walraven 1974)."""


@dataclass(frozen=True, eq=False)
class ChannelSpace:
    """Three channels that are linear in XYZ: a ``name``, the names of the channels, the matrix (3, 3) from XYZ."""

    name: str
    channels: tuple[str, str, str]
    matrix: Array


@dataclass(frozen=True, eq=False)
class OpponentSpace:
    """The opponent space, and the eigenvalue (3,) of each channel: the squared error of omitting it."""

    space: ChannelSpace
    eigenvalues: Array


def xyz_space() -> ChannelSpace:
    """CIE XYZ."""
    return ChannelSpace("XYZ", ("X", "Y", "Z"), np.eye(3))


def cone_space(wavelengths: Array, cmfs: Array) -> ChannelSpace:
    """Cone fundamentals for colour-matching functions (N, 3) at wavelengths (N,) nm, the peak of l at 1.

    The confusion points are the chromaticities of the cone primaries, which determine the fundamentals up to a
    factor each. Two cone ratios and the peak determine the factors (eq. 1).
    """
    primaries = np.column_stack([CONFUSION_POINTS, 1 - CONFUSION_POINTS.sum(axis=1)])
    unscaled = np.linalg.inv(primaries.T)

    def response(nm: float) -> Array:
        return unscaled @ [np.interp(nm, wavelengths, cmf) for cmf in cmfs.T]

    yellow, blue = response(UNIQUE_YELLOW), response(UNIQUE_BLUE)
    long = 1 / (cmfs @ unscaled[2]).max()
    medium = long * yellow[2] / yellow[1] / L_TO_M_AT_YELLOW
    short = S_TO_ML_AT_BLUE * (medium * blue[1] + long * blue[2]) / blue[0]
    return ChannelSpace("SML", ("S", "M", "L"), np.array([short, medium, long])[:, None] * unscaled)


def opponent_space(wavelengths: Array, cmfs: Array) -> OpponentSpace:
    """Karhunen–Loève transform of the cones for spectra with uncorrelated wavelengths (eq. 3–10).

    Channels are ordered by descending eigenvalue. Each peaks at 1 or −1, with signs such that A and C1 increase with
    Y, and C2 with Z.
    """
    fundamentals = cone_space(wavelengths, cmfs).matrix
    responses = cmfs @ fundamentals.T
    step = wavelengths[1] - wavelengths[0]
    values, vectors = np.linalg.eigh(responses.T @ responses * step)
    matrix = vectors[:, ::-1].T @ fundamentals
    matrix /= np.abs(cmfs @ matrix.T).max(axis=0)[:, None]
    matrix *= np.sign(matrix[[0, 1, 2], [1, 1, 2]])[:, None]
    return OpponentSpace(ChannelSpace("AC1C2", ("A", "C1", "C2"), matrix), values[::-1])


CHANNELS: dict[str, Callable[[Array, Array], ChannelSpace]] = {
    "opponent": lambda wavelengths, cmfs: opponent_space(wavelengths, cmfs).space,
    "cones": cone_space,
    "xyz": lambda wavelengths, cmfs: xyz_space(),
}
"""Channel spaces of the paper by name: functions of wavelengths (N,) in nm and colour-matching functions (N, 3)."""
