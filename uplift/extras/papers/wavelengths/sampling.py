"""Materials under lights on a full grid, and a few wavelengths in its place, with the
colour errors they cause.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import DEFAULT_OBSERVER
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, as_array, as_nm
from uplift.common.errors import OptionError

START = 380.0
"""Start of the visible range of Meyer 1988 in nm."""
END = 770.0
"""Its end in nm."""
STEP = 1.0
"""Step in nm that resolves the lines of fluorescent lamps."""
MIN_SAMPLES = 16
"""Fewest samples of a wavelength grid."""
UNIFORM_START = 400.0
"""Start in nm of the range for which even spacing of few wavelengths errs least."""
UNIFORM_END = 700.0
"""Its end in nm."""


@dataclass(frozen=True, eq=False)
class RenderSetup:
    """Materials under lights; `make_setup` makes one from names.

    Wavelengths (N,) in nm ascend evenly; reflectances are (M, N), the ``powers`` of the
    K ``lights`` (K, N), scaled so that the perfect reflector has Y = 1 under each, and
    the colour-matching functions ``cmfs`` (N, 3). ``lights`` are the names of the K
    ``illuminants``.
    """

    wavelengths: Array
    reflectances: Array
    lights: tuple[str, ...]
    powers: Array
    cmfs: Array
    illuminants: tuple[Illuminant, ...]

    @cached_property
    def xyz(self) -> Array:
        """XYZ (K, M, 3) of the materials, summed over the full grid."""
        return self.reflectances @ (self.powers[:, :, None] * self.cmfs)

    @cached_property
    def whites(self) -> Array:
        """XYZ (K, 3) of the perfect reflector under each light."""
        return self.powers @ self.cmfs

    @cached_property
    def lab(self) -> Array:
        """CIE L*a*b* (K, M, 3) of the materials, relative to the white of
        each light.
        """
        return self.to_lab(self.xyz)

    @cached_property
    def curves(self) -> CubicSpline:
        """Interpolant of the reflectances: ``curves(wavelengths)`` has shape (M, …)."""
        return CubicSpline(self.wavelengths, self.reflectances, axis=1)

    def to_lab(self, xyz: Array) -> Array:
        """Convert XYZ (K, M, 3) to CIE L*a*b* relative to the white of each light."""
        return lab(xyz, self.whites[:, None])

    def only(self, materials: ArrayLike) -> "RenderSetup":
        """Some of the materials, by indices or a mask (M,), under the same lights."""
        return replace(self, reflectances=self.reflectances[np.asarray(materials)])


def grid() -> Array:
    """Make the default wavelength grid.

    Returns
    -------
    ndarray, shape (391,)
        380, 381, …, 770 nm.
    """
    return np.arange(START, END + STEP / 2, STEP)


def make_setup(
    reflectances: ArrayLike,
    lights: Sequence[Illuminant],
    *,
    wavelengths: ArrayLike | None = None,
    observer_name: str = DEFAULT_OBSERVER,
) -> RenderSetup:
    """Combine materials with illuminants and an observer from the tables of
    colour-science.

    Parameters
    ----------
    reflectances : array_like, shape (M, N)
        Reflectances of M materials, finite and at least 0.
    lights : sequence of str or Lamp
        Names of illuminants, such as ``"FL11"``. Repeated names count once.
    wavelengths : array_like, shape (N,), optional
        Wavelengths of the samples in nm, ascending and evenly spaced, at least 16. By
        default `grid`.
    observer_name : str, optional
        Name of the observer.

    Returns
    -------
    RenderSetup
        Materials and lights on the common grid.

    Raises
    ------
    UnknownNameError
        The light or the observer does not exist.
    OptionError
        No lights, an uneven grid, reflectances of another shape, or values that are not
        reflectances.
    """
    nm = grid() if wavelengths is None else as_nm(wavelengths)
    materials = as_array(reflectances)
    _check_grid(nm)
    _check_materials(materials, len(nm))
    lights = tuple(dict.fromkeys(lights))
    if not lights:
        raise OptionError(
            "lights must not be empty", hint="name at least one, such as D65"
        )
    observer.check_distinct(lights)
    # The tables have steps of whole nanometres; the grid may have any step.
    step = nm[1] - nm[0] if (nm % 1 == 0).all() else 1.0
    shape = np.floor(nm[0]), np.ceil(nm[-1]), step
    table = np.arange(shape[0], shape[1] + step / 2, step)
    cmfs = interp_curves(
        nm, table, observer.matching_functions(observer_name, *shape).T
    ).T
    spectra = [observer.illuminant_spd(light, *shape) for light in lights]
    powers = interp_curves(nm, table, np.stack(spectra))
    return RenderSetup(
        nm,
        materials,
        tuple(map(str, lights)),
        powers / (powers @ cmfs[:, 1])[:, None],
        cmfs,
        lights,
    )


def _check_grid(nm: Array) -> None:
    steps = np.diff(nm)
    if (
        len(nm) < MIN_SAMPLES
        or not np.allclose(steps, steps[0], rtol=1e-6)
        or steps[0] <= 0
    ):
        problem = (
            f"wavelengths must be at least {MIN_SAMPLES}, ascending and evenly spaced"
        )
        raise OptionError(problem, hint="give a grid such as 380, 381, …, 770 nm")


def _check_materials(materials: Array, samples: int) -> None:
    if materials.ndim != 2 or not len(materials) or materials.shape[1] != samples:
        problem = (
            f"reflectances must have shape (M, {samples}) with M > 0, got "
            f"{materials.shape}"
        )
        raise OptionError(problem, hint="give one row per material")
    if not np.isfinite(materials).all() or materials.min() < 0:
        raise OptionError(
            "reflectances must be finite and at least 0", hint="give values from 0 to 1"
        )


def interp_curves(wavelengths: Array, known: Array, curves: Array) -> Array:
    """Interpolate curves (C, N), sampled at ``known`` (N,) nm, linearly at wavelengths
    (n,) nm to (C, n).
    """
    return np.stack([np.interp(wavelengths, known, curve) for curve in curves])


@dataclass(frozen=True, eq=False)
class Sampling:
    """Wavelengths to trace, powers of the lights there, and weights of the sum.

    A renderer traces ``powers[k] * reflectance(wavelengths)`` for light k; ``radiance @
    to_xyz`` is its XYZ. One set of weights serves all lights, so radiances of several
    lights may be added first.

    Parameters
    ----------
    wavelengths : ndarray, shape (n,)
        Wavelengths in nm.
    to_xyz : ndarray, shape (n, 3)
        Weights.
    lights : tuple of str
        Names of the K lights.
    powers : ndarray, shape (K, n)
        Power of each light at each wavelength; the perfect reflector has Y near 1.
    """

    wavelengths: Array
    to_xyz: Array
    lights: tuple[str, ...]
    powers: Array

    def __len__(self) -> int:
        return len(self.wavelengths)

    def to_rgb(self, sensor: Sensor) -> Array:
        """Convert the weights to the RGB space of a sensor.

        Parameters
        ----------
        sensor : Sensor
            RGB space and illuminant; white under the illuminant is (1, 1, 1).

        Returns
        -------
        ndarray, shape (n, 3)
            Weights to linear RGB.
        """
        return self.to_xyz @ sensor.xyz_to_rgb.T

    def xyz(self, reflectances: Array) -> Array:
        """Compute the colours of materials under every light.

        Parameters
        ----------
        reflectances : ndarray, shape (M, n)
            Reflectances at the wavelengths.

        Returns
        -------
        ndarray, shape (K, M, 3)
            XYZ.
        """
        return reflectances @ (self.powers[:, :, None] * self.to_xyz)


def balanced(sampling: Sampling) -> Sampling:
    """Scale every light so that the perfect reflector has Y = 1."""
    return replace(
        sampling,
        powers=sampling.powers / (sampling.powers @ sampling.to_xyz[:, 1])[:, None],
    )


def ordered(sampling: Sampling) -> Sampling:
    """Sort the wavelengths and scale the weights so that equal energy has Y = 1;
    colours stay.
    """
    order = np.argsort(sampling.wavelengths)
    scale = sampling.to_xyz[:, 1].sum()
    weights = sampling.to_xyz[order] / scale
    powers = sampling.powers[:, order] * scale
    return replace(
        sampling, wavelengths=sampling.wavelengths[order], to_xyz=weights, powers=powers
    )


def evaluate(setup: RenderSetup, sampling: Sampling) -> Array:
    """ΔE00 (K, M) of a sampling for the lights of the setup, in place of
    the full grid.
    """
    xyz = sampling.xyz(setup.curves(sampling.wavelengths))
    return delta_e_2000(setup.lab, setup.to_lab(xyz))


def midpoints(
    count: int, start: float = UNIFORM_START, end: float = UNIFORM_END
) -> Array:
    """Midpoints (count,) of equal parts of ``start`` to ``end`` nm."""
    return start + (np.arange(count) + 0.5) * (end - start) / count


def uniform(setup: RenderSetup, count: int) -> Sampling:
    """Point sample the lights and the colour-matching functions at even spacing; whites
    balanced.
    """
    nm = midpoints(count)
    weights = interp_curves(nm, setup.wavelengths, setup.cmfs.T).T
    return balanced(
        Sampling(
            nm,
            weights,
            setup.lights,
            interp_curves(nm, setup.wavelengths, setup.powers),
        )
    )


def prefiltered(setup: RenderSetup, wavelengths: Array) -> Sampling:
    """Distribute lights and colour-matching functions over wavelengths (n,) nm by the
    weights of linear interpolation.

    Power outside the first and the last wavelength counts for these. The Y of white is
    exact.
    """
    hats = interp_curves(setup.wavelengths, wavelengths, np.eye(len(wavelengths)))
    powers = setup.powers @ hats.T / hats.sum(axis=1)
    lit = hats @ (setup.powers.sum(axis=0)[:, None] * setup.cmfs)
    weights = lit / np.maximum(powers.sum(axis=0), np.finfo(float).tiny)[:, None]
    return balanced(Sampling(wavelengths, weights, setup.lights, powers))
