"""Materials under lights, measured by one observer on one wavelength grid."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import lab
from uplift.colorimetry.observer import DEFAULT_OBSERVER
from uplift.common.arrays import Array
from uplift.common.errors import OptionError

START, END, STEP = 380.0, 770.0, 1.0
"""Visible range of Meyer 1988 in nm, with a step that resolves the lines of fluorescent lamps."""
MIN_SAMPLES = 16
"""Fewest samples of a wavelength grid."""


@dataclass(frozen=True, eq=False)
class RenderSetup:
    """Materials under lights; `make_setup` makes one from names.

    Parameters
    ----------
    wavelengths : ndarray, shape (N,)
        Wavelengths in nm, ascending and evenly spaced.
    reflectances : ndarray, shape (M, N)
        Reflectances of the M materials.
    lights : tuple of str
        Names of the K lights.
    powers : ndarray, shape (K, N)
        Spectral powers of the lights, scaled so that the perfect reflector has Y = 1 under each.
    cmfs : ndarray, shape (N, 3)
        Colour-matching functions of the observer.
    """

    wavelengths: Array
    reflectances: Array
    lights: tuple[str, ...]
    powers: Array
    cmfs: Array

    @cached_property
    def xyz(self) -> Array:
        """XYZ (K, M, 3) of the materials, summed over the full grid."""
        return np.asarray(self.reflectances @ (self.powers[:, :, None] * self.cmfs))

    @cached_property
    def whites(self) -> Array:
        """XYZ (K, 3) of the perfect reflector under each light."""
        return self.powers @ self.cmfs

    @cached_property
    def lab(self) -> Array:
        """CIE L*a*b* (K, M, 3) of the materials, relative to the white of each light."""
        return self.to_lab(self.xyz)

    @cached_property
    def curves(self) -> CubicSpline:
        """Interpolant of the reflectances: ``curves(wavelengths)`` has shape (M, …)."""
        return CubicSpline(self.wavelengths, self.reflectances, axis=1)

    def to_lab(self, xyz: Array) -> Array:
        """Convert XYZ to CIE L*a*b* relative to the white of each light.

        Parameters
        ----------
        xyz : ndarray, shape (K, M, 3)
            Colours of M materials under the K lights.

        Returns
        -------
        ndarray, shape (K, M, 3)
            L*a*b*.
        """
        return np.stack([lab(colours, white) for colours, white in zip(xyz, self.whites, strict=True)])

    def sampled_powers(self, wavelengths: Array) -> Array:
        """Interpolate the lights at single wavelengths, as a renderer without prefiltering does.

        Parameters
        ----------
        wavelengths : ndarray, shape (n,)
            Wavelengths in nm.

        Returns
        -------
        ndarray, shape (K, n)
            Powers of each light.
        """
        return interp_curves(wavelengths, self.wavelengths, self.powers)

    def only(self, materials: ArrayLike) -> RenderSetup:
        """Select some of the materials, under the same lights.

        Parameters
        ----------
        materials : array_like
            Indices of the materials, or a mask of shape (M,).

        Returns
        -------
        RenderSetup
            The selection.
        """
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
    lights: Sequence[str],
    *,
    wavelengths: ArrayLike | None = None,
    observer_name: str = DEFAULT_OBSERVER,
) -> RenderSetup:
    """Combine materials with illuminants and an observer from the tables of colour-science.

    Parameters
    ----------
    reflectances : array_like, shape (M, N)
        Reflectances of M materials, finite and at least 0.
    lights : sequence of str
        Names of illuminants, such as ``"FL11"``. Repeated names count once.
    wavelengths : array_like, shape (N,), optional
        Wavelengths of the samples in nm, ascending and evenly spaced, at least 16. By default `grid`.
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
        No lights, an uneven grid, reflectances of another shape, or values that are not reflectances.
    """
    nm = grid() if wavelengths is None else np.asarray(wavelengths, dtype=float)
    materials = np.asarray(reflectances, dtype=float)
    _check(nm, materials)
    lights = tuple(dict.fromkeys(lights))
    if not lights:
        raise OptionError("lights must not be empty", code="no-lights", hint="name at least one, such as D65")
    # The tables have steps of whole nanometres; the grid may have any step.
    shape = np.floor(nm[0]), np.ceil(nm[-1]), 1.0
    table = np.arange(shape[0], shape[1] + 0.5)
    cmfs = interp_curves(nm, table, observer.matching_functions(observer_name, *shape).T).T
    powers = interp_curves(nm, table, np.stack([observer.illuminant_spd(name, *shape) for name in lights]))
    return RenderSetup(nm, materials, lights, powers / (powers @ cmfs[:, 1])[:, None], cmfs)


def interp_curves(wavelengths: Array, known: Array, curves: Array) -> Array:
    """Interpolate curves (C, N), sampled at ``known`` (N,) nm, linearly at wavelengths (n,) nm to (C, n)."""
    return np.stack([np.interp(wavelengths, known, curve) for curve in curves])


def _check(nm: Array, materials: Array) -> None:
    steps = np.diff(nm)
    if nm.ndim != 1 or len(nm) < MIN_SAMPLES or not np.allclose(steps, steps[0], rtol=1e-6) or steps[0] <= 0:
        raise OptionError(
            f"wavelengths must be at least {MIN_SAMPLES}, ascending and evenly spaced",
            code="uneven-wavelengths",
            hint="give a grid such as 380, 381, …, 770 nm",
        )
    if materials.ndim != 2 or not len(materials) or materials.shape[1] != len(nm):
        raise OptionError(
            f"reflectances must have shape (M, {len(nm)}) with M > 0, got {materials.shape}",
            code="shape-mismatch",
            hint="give one row per material",
        )
    if not np.isfinite(materials).all() or materials.min() < 0:
        raise OptionError(
            "reflectances must be finite and at least 0",
            code="invalid-reflectance",
            hint="give values from 0 to 1",
        )
