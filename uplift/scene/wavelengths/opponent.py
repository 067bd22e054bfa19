"""The opponent space AC1C2: cone fundamentals from confusion points, turned to their principal axes.

Meyer 1988, "Wavelength selection for synthetic image generation", sections 2.1, 2.2 and appendix A.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array

CONFUSION = np.array([[0.171, -0.003], [1.14, -0.14], [0.735, 0.265]])
"""Chromaticities xy that a tritanope, a deuteranope, a protanope cannot tell from others: those of the S, M and L
cones alone (eq. 20; Estévez 1979)."""
BALANCED_BLUE, BALANCED_YELLOW = 475.5, 570.0
"""Wavelengths (nm) of which the hue keeps still when they grow brighter, where the cones stand in these ratios:"""
S_TO_M_AND_L, L_TO_M = 1 / 16, 2.0
"""s / (m + l) at the first, l / m at the second (eq. 21; Walraven 1974)."""


@dataclass(frozen=True, eq=False)
class ChannelSpace:
    """Three channels, linear in XYZ.

    Parameters
    ----------
    name : of the space.
    channels : names of the three.
    matrix : (3, 3) from XYZ to the channels.
    """

    name: str
    channels: tuple[str, str, str]
    matrix: Array


@dataclass(frozen=True, eq=False)
class OpponentSpace:
    """The opponent space, and the share (3,) of the squared error that leaving out each channel brings."""

    space: ChannelSpace
    eigenvalues: Array


def xyz_space() -> ChannelSpace:
    """CIE XYZ itself."""
    return ChannelSpace("XYZ", ("X", "Y", "Z"), np.eye(3))


def cone_space(wavelengths: Array, cmfs: Array) -> ChannelSpace:
    """Cone fundamentals of an observer (N, 3) at wavelengths (N,) nm, the peak of l at 1.

    The confusion points are the chromaticities of the cones' own primaries, so the fundamentals are XYZ taken
    apart into these; two ratios and the peak say how long each is (eq. 1).
    """
    primaries = np.column_stack([CONFUSION, 1 - CONFUSION.sum(axis=1)])
    apart = np.linalg.inv(primaries.T)

    def at(nm: float) -> Array:
        return apart @ [np.interp(nm, wavelengths, cmf) for cmf in cmfs.T]

    long = 1 / (cmfs @ apart[2]).max()
    medium = long * at(BALANCED_YELLOW)[2] / at(BALANCED_YELLOW)[1] / L_TO_M
    blue = at(BALANCED_BLUE)
    short = S_TO_M_AND_L * (medium * blue[1] + long * blue[2]) / blue[0]
    return ChannelSpace("SML", ("S", "M", "L"), np.array([short, medium, long])[:, None] * apart)


def opponent_space(wavelengths: Array, cmfs: Array) -> OpponentSpace:
    """Karhunen–Loève of the cones under spectra of which no two wavelengths are correlated (eq. 3–10).

    Channels by falling eigenvalue; each peaks at 1 or −1, with signs that let A and C1 grow with Y, and C2 with Z.
    """
    fundamentals = cone_space(wavelengths, cmfs).matrix
    seen = cmfs @ fundamentals.T
    step = wavelengths[1] - wavelengths[0]
    values, vectors = np.linalg.eigh(seen.T @ seen * step)
    matrix = vectors[:, ::-1].T @ fundamentals
    matrix /= np.abs(cmfs @ matrix.T).max(axis=0)[:, None]
    matrix *= np.sign(matrix[[0, 1, 2], [1, 1, 2]])[:, None]
    return OpponentSpace(ChannelSpace("AC1C2", ("A", "C1", "C2"), matrix), values[::-1])
