"""An emission table over the chromaticity diagram: one pixel per u′v′, v′ upwards."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array, Indices, Mask
from uplift.lights.lattice import unit_xyz
from uplift.lights.lookup import EmissionTable


@dataclass(frozen=True)
class Window:
    """A part of the diagram.

    Parameters
    ----------
    u, v : tuple of float
        Lowest and highest u′ and v′.
    """

    u: tuple[float, float]
    v: tuple[float, float]

    def pixels(self, step: float) -> Array:
        """Return the middles of pixels.

        Parameters
        ----------
        step : float
            Size of a pixel in u′v′.

        Returns
        -------
        ndarray, shape (H, W, 2)
            u′v′; the first row has the largest v′.
        """
        u, v = (low + step * (np.arange(round((high - low) / step)) + 0.5) for low, high in (self.u, self.v))
        return np.stack(np.meshgrid(u, v[::-1]), axis=-1)


ALL = Window((-0.04, 0.64), (0.0, 0.62))
"""All chromaticities of lights, with a margin."""


@dataclass(frozen=True, eq=False)
class ChromaticityMap:
    """What a table has at the pixels of a window. Outside the spectral locus, pixels have the values of its edge.

    Parameters
    ----------
    inside : ndarray of bool, shape (H, W)
        Whether a light has the chromaticity.
    xyz : ndarray, shape (H, W, 3)
        XYZ of luminance 1.
    rgb : ndarray, shape (H, W, 3)
        Linear RGB of luminance 1.
    error : ndarray, shape (H, W)
        Expected ΔE00 of surfaces.
    lamp : ndarray of int, shape (H, W)
        Number of the lamp whose disc the pixel is in; −1 for none.
    """

    inside: Mask
    xyz: Array
    rgb: Array
    error: Array
    lamp: Indices


def map_chromaticities(table: EmissionTable, window: Window, step: float) -> ChromaticityMap:
    """Query a table at the pixels of a window.

    Parameters
    ----------
    table : EmissionTable
        The table.
    window : Window
        Part of the diagram.
    step : float
        Size of a pixel in u′v′.

    Returns
    -------
    ChromaticityMap
    """
    lattice, entries = table.data.lattice, table.data.entries
    pixels = window.pixels(step)
    offset = pixels.reshape(-1, 2) - lattice.white
    share = lattice.polar(offset)[2]
    uv = lattice.white + offset / np.maximum(share, 1.0)[:, None]
    xyz = unit_xyz(uv)
    xyz /= xyz[:, 1:2]
    rgb = table.rgb_of_xyz(xyz)
    lamp = np.full(len(uv), -1)
    discs = entries.locate(uv)
    lamp[discs.rows] = discs.entry
    shape = pixels.shape[:2]
    return ChromaticityMap(
        inside=(share <= 1).reshape(shape),
        xyz=xyz.reshape(*shape, 3),
        rgb=rgb.reshape(*shape, 3),
        error=table.expected_error(rgb).reshape(shape),
        lamp=np.where(share <= 1, lamp, -1).reshape(shape),
    )
