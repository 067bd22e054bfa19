"""Spectra of one colour, drawn as materials of this colour differ: training data, and
what a picture may look like under another light.

The answer p of a cube to the colour x is the mean. A sample is

q = p + s C(x)^½ w,

with the covariance C of `Metamers`, its symmetric root, white noise w, and s² = ν / χ²,
χ² of ν degrees of freedom: Student's t, as a few materials differ much more than
most. It has the colour x, and is kept in [0, 1] as answers to photographs are.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from uplift.common.arrays import Array, blocks
from uplift.extras.photographs.changes import changed_spectra
from uplift.extras.photographs.metamers import Metamers, learn_metamers
from uplift.lookup.blocks import as_colours, as_wavelengths, as_whole_number
from uplift.lookup.cube import Cube
from uplift.models.brightness import brightness

TAIL = 8.0
"""Degrees of freedom ν, with which samples spread as left-out materials do."""
BLOCK_SPECTRA = 1 << 13
"""Spectra drawn at a time."""


@dataclass(frozen=True, eq=False, repr=False)
class SpectrumSampler:
    """Spectra of one colour, made by `prepare_samples`.

    Parameters
    ----------
    cube : Cube
        The cube, whose answers are the means.
    metamers : Metamers
        How materials of one colour differ.
    """

    cube: Cube
    metamers: Metamers

    def __call__(
        self,
        rgb: ArrayLike,
        count: int,
        seed: int | np.random.Generator,
        wavelengths: ArrayLike | None = None,
    ) -> NDArray[Any]:
        """Draw spectra of colours.

        Parameters
        ----------
        rgb : array_like, shape (..., 3)
            Linear RGB in [0, 1] of the cube. All spectra of a colour have it, or the
            nearest realisable one of less chroma.
        count : int
            Spectra of each colour, from 1.
        seed : int or numpy.random.Generator
            Of the random numbers. One seed gives the same spectra again.
        wavelengths : array_like, shape (N,), optional
            Wavelengths in nm, by default those of the sensor.

        Returns
        -------
        ndarray, shape (..., count, N)
            Reflectances in [0, 1].

        Raises
        ------
        ColourError
            ``rgb`` are outside [0, 1].
        OptionError
            ``count``, ``seed`` or ``wavelengths`` is invalid.
        """
        colours = as_colours(rgb, self.cube.data.sensor)
        random = _as_generator(seed)
        per_colour = as_whole_number(count, "count")
        at_sensor = self.cube.wavelengths
        grid = at_sensor
        if wavelengths is not None:
            grid = np.append(at_sensor, as_wavelengths(wavelengths, at_sensor))
        flat = colours.reshape(-1, 3)
        around = self.cube.reflectance(flat, grid)
        covariance = self.metamers.covariance(flat)
        drawn = self.draw(around, flat, covariance, per_colour, random, grid)
        kept = slice(None) if wavelengths is None else slice(len(at_sensor), None)
        spectra = drawn[..., kept]
        return spectra.reshape(*colours.shape[:-1], per_colour, spectra.shape[-1])

    def draw(
        self,
        around: Array,
        rgb: Array,
        covariance: Array,
        count: int,
        random: np.random.Generator,
        wavelengths: Array,
    ) -> Array:
        """Draw spectra around given ones.

        Parameters
        ----------
        around : ndarray, shape (n, N)
            Means, of the colours.
        rgb : ndarray, shape (n, 3)
            Linear RGB in [0, 1].
        covariance : ndarray, shape (n, R, R)
            Covariances of scores, as of `Metamers.covariance`.
        count : int
            Spectra of each colour.
        random : numpy.random.Generator
            Source of random numbers.
        wavelengths : ndarray, shape (N,)
            Wavelengths in nm, which begin with those of the sensor.

        Returns
        -------
        ndarray, shape (n, count, N)
            Reflectances in [0, 1].
        """
        components = self.metamers.components
        components_at = self.metamers.components_at(wavelengths)
        shape = (len(rgb), count, 1)
        scale = np.sqrt(TAIL / random.chisquare(TAIL, shape))
        scale *= brightness(rgb)[..., None]
        roots = _symmetric_root(covariance)
        result = np.empty((len(rgb), count, len(wavelengths)))
        for block in blocks(len(rgb), max(BLOCK_SPECTRA // count, 1)):
            means = np.repeat(around[block], count, axis=0)
            # Noise of all wavelengths: signs of components, which are arbitrary, do
            # not change the samples.
            width = components.shape[1]
            white = random.standard_normal((len(roots[block]), count, width))
            scores = scale[block] * (white @ components.T @ roots[block])
            change = (scores @ components_at).reshape(means.shape)
            colours = np.repeat(rgb[block], count, axis=0)
            spectra, _ = changed_spectra(
                self.cube.data, means, change, colours, wavelengths
            )
            result[block] = spectra.reshape(-1, count, len(wavelengths))
        return result


def _symmetric_root(covariance: Array) -> Array:
    """The symmetric roots (n, R, R) of covariances, which may be singular."""
    variances, axes = np.linalg.eigh(covariance)
    deviations = np.sqrt(np.maximum(variances, 0))
    return (axes * deviations[:, None, :]) @ axes.transpose(0, 2, 1)


def _as_generator(seed: int | np.random.Generator) -> np.random.Generator:
    """Make a generator of a seed; `OptionError` for anything else."""
    if isinstance(seed, np.random.Generator):
        return seed
    return np.random.default_rng(as_whole_number(seed, "seed", least=0))


def prepare_samples(cube: Cube) -> SpectrumSampler:
    """Prepare a cube for samples of spectra of one colour.

    Parameters
    ----------
    cube : Cube
        A cube with left-out materials, such as the packaged ones.

    Returns
    -------
    SpectrumSampler
        From linear RGB (..., 3) to reflectances (..., count, N).

    Raises
    ------
    OptionError
        The cube has no left-out materials.
    """
    return SpectrumSampler(cube, learn_metamers(cube))
