"""Spectra of colours that are known under several lights: the answer of a cube, moved
as little as the other photographs require (docs/mathematics.md, 10).

The answer p has the colour x under the light of the cube. Materials of this colour
differ from it by metameric blacks with the covariance C(x) of `Metamers`. With colours
t under other lights, sensors M and noise R, the posterior mean is

q = p + C Mᵀ (M C Mᵀ + R)⁻¹ (t − M p)

(Rasmussen & Williams 2006, "Gaussian processes for machine learning", eq. 2.25). It
keeps the colour x. Where it would leave [0, 1], it is moved less far, clipped, moved
back to x, and once more towards t.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from uplift.common.arrays import Array, Mask, as_array
from uplift.common.errors import OptionError
from uplift.extras.photographs.changes import changed_spectra
from uplift.extras.photographs.metamers import Metamers, learn_metamers
from uplift.extras.photographs.photograph import Noise, Photograph, check_different
from uplift.lattice.lattice import Lattice, weighted_sum
from uplift.lookup.blocks import as_colours, as_wavelengths
from uplift.lookup.cube import Cube
from uplift.models.brightness import brightness

TABLE = Lattice(np.linspace(0, 1, 17) ** 2)
"""Nodes between which covariances are interpolated."""
LEAST_NOISE = 1e-4
"""Standard deviation of linear RGB that is always assumed: what the principal
components leave out.
"""
UNKNOWN = 1e6
"""Variance of a component that is not known."""
ROUNDS = 2
"""Moves, of which the further ones are for spectra that were clipped."""
CONTRADICTION = 0.01
"""Linear RGB that remains between a photograph and the answer where they contradict
each other; `CONTRADICTION_SIGMAS` of its noise, if they are more.
"""
CONTRADICTION_SIGMAS = 4.0


class Directions(NamedTuple):
    """Where photographs move answers."""

    scores: Array
    """S Aᵀ (n, R, 3 L), with A = M Eᵀ."""
    gram: Array
    """A S Aᵀ (n, 3 L, 3 L)."""


class Answers(NamedTuple):
    """Spectra (n, N), and which colours (n,) contradict each other: their spectra are
    those of the cube.
    """

    spectra: Array
    contradicts: Mask


@dataclass(frozen=True, eq=False, repr=False)
class Photographs:
    """A cube, and L further photographs of what it answers, made by `prepare`.

    Parameters
    ----------
    cube : Cube
        The cube.
    metamers : Metamers
        How materials of one colour differ.
    further : tuple of Photograph
        The further photographs.
    noise : Noise
        Noise of all photographs.
    """

    cube: Cube
    metamers: Metamers
    further: tuple[Photograph, ...]
    noise: Noise

    @cached_property
    def matrix(self) -> Array:
        """M (3 L, N), from spectra to the linear RGB of the further photographs."""
        return np.concatenate([photograph.matrix for photograph in self.further])

    @cached_property
    def _tables(self) -> Directions:
        """Directions at the nodes of `TABLE`."""
        return self.directions(self.metamers.covariance(TABLE.points))

    def directions(self, covariance: Array) -> Directions:
        """Return where the photographs move answers.

        Parameters
        ----------
        covariance : ndarray, shape (n, R, R)
            Covariances of scores, as of `Metamers.covariance`.

        Returns
        -------
        Directions
            The directions of each.
        """
        to_rgb = self.matrix @ self.metamers.components.T
        scores = covariance @ to_rgb.T
        return Directions(scores, to_rgb @ scores)

    def reflectance(
        self, rgb: ArrayLike, others: ArrayLike, wavelengths: ArrayLike | None = None
    ) -> NDArray[Any]:
        """Compute the spectra of colours that are known under several lights.

        Parameters
        ----------
        rgb : array_like, shape (..., 3)
            Linear RGB in [0, 1] of the cube, which the spectra have exactly.
        others : array_like, shape (..., 3 L)
            Linear RGB of the further photographs, in their order; NaN where unknown.
        wavelengths : array_like, shape (N,), optional
            Wavelengths in nm, by default those of the sensor.

        Returns
        -------
        ndarray, shape (..., N)
            Reflectances in [0, 1].

        Raises
        ------
        ColourError
            ``rgb`` are outside [0, 1].
        OptionError
            ``others`` have another shape.
        """
        colours = as_colours(rgb, self.cube.data.sensor)
        shape = (*colours.shape[:-1], len(self.matrix))
        values = as_array(others)
        if values.shape != shape:
            raise OptionError(
                f"others must have the shape {shape}, got {values.shape}",
                hint="give three numbers for each further photograph",
            )
        at = None
        if wavelengths is not None:
            at = as_wavelengths(wavelengths, self.cube.wavelengths)
        answers = self.answer(
            colours.reshape(-1, 3), values.reshape(-1, len(self.matrix)), None, at
        )
        return answers.spectra.reshape(*shape[:-1], -1)

    def answer(
        self,
        rgb: Array,
        others: Array,
        expected: Array | None = None,
        wavelengths: Array | None = None,
        directions: Directions | None = None,
    ) -> Answers:
        """Answer colours that are known under several lights, and find those that
        contradict each other.

        Parameters
        ----------
        rgb : ndarray, shape (n, 3)
            Linear RGB in [0, 1] of the cube.
        others : ndarray, shape (n, 3 L)
            Linear RGB of the further photographs, NaN where unknown.
        expected : ndarray, shape (n, N + M), optional
            Answers of the cube at the N wavelengths of its sensor and then at the M
            ``wavelengths``; computed by default.
        wavelengths : ndarray, shape (M,), optional
            Wavelengths of the result in nm, by default those of the sensor.
        directions : Directions, optional
            Where the photographs move the answers, by default those of the place.

        Returns
        -------
        Answers
            Spectra, and which colours contradict each other.
        """
        at = self.cube.wavelengths
        grid = at if wavelengths is None else np.append(at, wavelengths)
        components = self.metamers.components
        if wavelengths is not None:
            components = self.metamers.components_at(grid)
        if expected is None:
            expected = self.cube.reflectance(rgb, grid)
        ways = self._interpolated(rgb) if directions is None else directions
        at_sensor = slice(len(at))
        spectra = np.array(expected)
        rows = np.arange(len(rgb))
        for _ in range(ROUNDS):
            known = rgb[rows], others[rows], Directions(*(way[rows] for way in ways))
            scores = self._scores(spectra[rows][:, at_sensor], *known)
            change = (scores @ components).astype(spectra.dtype)
            spectra[rows], clipped = changed_spectra(
                self.cube.data, spectra[rows], change, rgb[rows], grid
            )
            rows = rows[clipped]
        contradicts = self._contradicts(rgb, others, spectra[:, at_sensor])
        spectra[contradicts] = expected[contradicts]
        kept = slice(None) if wavelengths is None else slice(len(at), None)
        return Answers(spectra[:, kept], contradicts)

    def _interpolated(self, rgb: Array) -> Directions:
        corners = TABLE.corners(rgb)
        return Directions(
            *(
                weighted_sum(table.reshape(TABLE.size, -1), *corners).reshape(
                    len(rgb), *table.shape[1:]
                )
                for table in self._tables
            )
        )

    def _scores(
        self, expected: Array, rgb: Array, others: Array, directions: Directions
    ) -> Array:
        """Scores (n, R) of the posterior mean of the difference from expected spectra
        (n, N).
        """
        known = np.isfinite(others)
        residual = np.where(known, others - expected @ self.matrix.T, 0)
        variance = np.where(known, self._variance(rgb, others), UNKNOWN)
        level = brightness(rgb)[..., None] ** 2
        # y = (M C Mᵀ + R)⁻¹ (t − M p), and z = k² S Aᵀ y
        gram = level * directions.gram
        diagonal = np.arange(len(self.matrix))
        gram[:, diagonal, diagonal] += variance
        weights = np.linalg.solve(gram, residual[..., None])
        return np.asarray((level * directions.scores @ weights)[..., 0])

    def _variance(self, rgb: Array, others: Array) -> Array:
        """R (n, 3 L): the noise of the photographs, and that of the first one in what
        is expected of them.
        """
        first = np.tile(self.noise.variance(rgb), len(self.further))
        return self.noise.variance(np.nan_to_num(others)) + first + LEAST_NOISE**2

    def _contradicts(self, rgb: Array, others: Array, spectra: Array) -> Mask:
        """Which colours (n,) the answers miss by more than noise explains."""
        off = np.abs(np.nan_to_num(others - spectra @ self.matrix.T))
        limit = CONTRADICTION_SIGMAS * np.sqrt(self._variance(rgb, others))
        return np.asarray((off > np.maximum(limit, CONTRADICTION)).any(axis=1))


def prepare(
    cube: Cube, further: Sequence[Photograph], noise: tuple[float, float] = (0.0, 0.0)
) -> Photographs:
    """Prepare a cube for colours that are known under several lights.

    Parameters
    ----------
    cube : Cube
        A cube with left-out materials.
    further : sequence of Photograph
        The photographs apart from that under the light of the cube, by `photograph`.
    noise : tuple of float
        Standard deviation of linear RGB in all photographs: a share of each value, and
        a floor.

    Returns
    -------
    Photographs

    Raises
    ------
    OptionError
        No further photograph, or two that are of one light; a cube without left-out
        materials; noise that is negative.
    """
    if not further:
        raise OptionError(
            "one photograph is what the cube answers", hint="give a further one"
        )
    check_different(further)
    if not all(0 <= value < 1 for value in noise):
        raise OptionError(f"noise must be two numbers in [0, 1), got {noise}")
    return Photographs(cube, learn_metamers(cube), tuple(further), Noise(*noise))
