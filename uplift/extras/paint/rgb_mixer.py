"""A mixer of RGB colours as paints, by a table over RGB that programs can hold.

Every colour has a *latent* vector: K and S in eight bands (`bands`), the reflectances R
that they give, and its linear RGB. Latents mix as numbers do. The colour of a latent is

    RGB + W (R∞(K, S) − R),    R∞ = S / (K + S + √(K (K + 2S))),

clipped to [0, 1]. Of one colour alone both reflectances are equal, so that a mixture
begins and ends exactly at its colours for any table.

The table has √R and √S at nodes that are even in √RGB, linear between them: the darker
half of a paint's range matters most where it mixes. K follows from R and S.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import as_rgb, in_unit_cube, raise_out_of_gamut
from uplift.common.arrays import Array, Values, as_array
from uplift.common.errors import OptionError
from uplift.extras.export.program_table import check_complete
from uplift.extras.paint.bands import BANDS, choose_bands, opaque
from uplift.extras.paint.optics import as_shares, weighted_sum
from uplift.extras.paint.pigments import DARKEST, Pigment, dispersive
from uplift.lookup.cube import Cube

DIM = 17
MIN_DIM = 2
MAX_DIM = 65
LEVELS = 65535
"""Numbers of the table are whole, from 0 to this."""
SIZE = 3 * BANDS + 3
"""Length of a latent vector: K, S and R of the bands, and RGB."""


@dataclass(frozen=True, eq=False)
class RgbMixer:
    """A mixer of linear RGB.

    Parameters
    ----------
    table : ndarray of shape (dim, dim, dim, 2 * BANDS) of uint16
        √R and √S by red, green and blue, in units of ``units``.
    units : ndarray of shape (2 * BANDS,)
        Units of the numbers of a node.
    to_rgb : ndarray of shape (3, BANDS)
        W, from reflectances in bands to linear RGB; rows sum to 1.
    """

    table: Values
    units: Array
    to_rgb: Array

    def latent(self, rgb: ArrayLike) -> Array:
        """Return the latent vectors of colours.

        Parameters
        ----------
        rgb : array_like of shape (..., 3)
            Linear RGB in [0, 1].

        Returns
        -------
        ndarray of shape (..., SIZE)
            Sums of them, with shares of sum 1, are those of mixtures.

        Raises
        ------
        ColourError
            A colour is not three numbers in [0, 1].
        """
        colours = as_rgb(rgb)
        inside = in_unit_cube(colours)
        if not inside.all():
            raise_out_of_gamut(colours[~inside])
        clipped = np.clip(colours, 0, 1)
        roots = interpolate(self.table, np.sqrt(clipped)) * self.units
        reflectance = np.maximum(roots[..., :BANDS] ** 2, DARKEST)
        paint = opaque(reflectance, roots[..., BANDS:] ** 2)
        return np.concatenate(
            [paint.absorption, paint.scattering, reflectance, clipped], axis=-1
        )

    def colour(self, latent: ArrayLike) -> Array:
        """Return the colours of latent vectors.

        Parameters
        ----------
        latent : array_like of shape (..., SIZE)
            Latent vectors, or sums of them.

        Returns
        -------
        ndarray of shape (..., 3)
            Linear RGB, clipped to [0, 1].
        """
        K, S, R, rgb = np.split(
            as_array(latent), (BANDS, 2 * BANDS, 3 * BANDS), axis=-1
        )
        change = Pigment(K, S).opaque_reflectance() - R
        return np.clip(rgb + change @ self.to_rgb.T, 0, 1)

    def mix(self, first: ArrayLike, second: ArrayLike, share: ArrayLike) -> Array:
        """Mix two colours.

        Parameters
        ----------
        first, second : array_like of shape (..., 3)
            Linear RGB in [0, 1].
        share : array_like of shape (...)
            Share of the second colour, in [0, 1].

        Returns
        -------
        ndarray of shape (..., 3)
            Linear RGB in [0, 1]; the first colour at 0, the second at 1.

        Raises
        ------
        ColourError
            A colour is not three numbers in [0, 1].
        OptionError
            A share is outside [0, 1].
        """
        t = as_array(share)
        inside = (t >= 0) & (t <= 1)
        if not inside.all():
            raise OptionError(
                f"share must be in [0, 1], got {t[~inside][0]:g}",
                hint="0 is the first colour, 1 the second",
            )
        t = t[..., None]
        return self.colour((1 - t) * self.latent(first) + t * self.latent(second))

    def mix_all(self, rgb: ArrayLike, parts: ArrayLike) -> Array:
        """Mix any number of colours.

        Parameters
        ----------
        rgb : array_like of shape (..., n, 3)
            Linear RGB in [0, 1].
        parts : array_like of shape (..., n)
            Parts of the colours, at least 0.

        Returns
        -------
        ndarray of shape (..., 3)
            Linear RGB in [0, 1].

        Raises
        ------
        ColourError
            A colour is not three numbers in [0, 1].
        OptionError
            A part is negative or not finite, or all are 0.
        """
        return self.colour(weighted_sum(self.latent(rgb), as_shares(parts)))


def make_mixer(cube: Cube, dim: int = DIM) -> RgbMixer:
    """Make the mixer of the colours of a cube.

    Parameters
    ----------
    cube : Cube
        The cube, with all nodes.
    dim : int
        Nodes of the table along each axis, 2 to 65.

    Returns
    -------
    RgbMixer
        The mixer, in the linear RGB of the cube.

    Raises
    ------
    OptionError
        ``dim`` is out of range, or the cube was built for a scene (``sparse-cube``).
    """
    if not MIN_DIM <= dim <= MAX_DIM:
        raise OptionError(
            f"dim must be from {MIN_DIM} to {MAX_DIM}, got {dim}",
            hint=f"{DIM} is usual",
        )
    check_complete(cube.data, "a mixer")
    bands = choose_bands(cube)
    scattering = dispersive(cube.data.sensor)
    axis = np.linspace(0, 1, dim) ** 2
    roots = np.empty((dim, dim, dim, 2 * BANDS))
    rgb = np.empty((dim, dim, 3))
    rgb[..., 1], rgb[..., 2] = np.meshgrid(axis, axis, indexing="ij")
    for red, plane in zip(axis, roots, strict=True):
        rgb[..., 0] = red
        spectra = np.clip(cube.reflectance(rgb), DARKEST, 1)
        plane[..., :BANDS] = np.sqrt(spectra @ bands.means.T)
        plane[..., BANDS:] = np.sqrt(scattering(spectra) @ bands.means.T)
    units = np.ones(2 * BANDS) / LEVELS
    units[BANDS:] *= roots[..., BANDS:].max()
    # Rounded up, black stays at `DARKEST`.
    table = np.minimum(np.ceil(roots / units), LEVELS).astype(np.uint16)
    return RgbMixer(table, units, bands.to_rgb)


def interpolate(table: Values, places: Array) -> Array:
    """Interpolate along each axis of a table (dim, dim, dim, n) at places (..., 3) in
    [0, 1].
    """
    last = len(table) - 1
    position = places * last
    cell = np.minimum(position.astype(int), last - 1)
    offset = position - cell
    total = np.zeros((*places.shape[:-1], table.shape[-1]))
    for corner in np.ndindex(2, 2, 2):
        weights = np.where(corner, offset, 1 - offset).prod(axis=-1)
        red, green, blue = np.moveaxis(cell + corner, -1, 0)
        total += weights[..., None] * table[red, green, blue]
    return total
