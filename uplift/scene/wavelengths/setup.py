"""What is rendered: materials under lights, seen by an observer, all on one grid of wavelengths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
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
"""The visible range of Meyer 1988, finely enough for the lines of lamps (nm)."""


@dataclass(frozen=True, eq=False)
class RenderSetup:
    """Materials under lights.

    Parameters
    ----------
    wavelengths : (N,) nm, evenly spaced, ascending.
    reflectances : (M, N) of the materials, units of 1.
    lights : names of the lights.
    powers : (K, N) their spectra, scaled so that the perfect reflector has Y = 1 under each.
    cmfs : (N, 3) the observer's colour-matching functions.
    """

    wavelengths: Array
    reflectances: Array
    lights: tuple[str, ...]
    powers: Array
    cmfs: Array

    @cached_property
    def xyz(self) -> Array:
        """(K, M, 3) XYZ of the materials, by all wavelengths of the grid."""
        return np.asarray(self.reflectances @ (self.powers[:, :, None] * self.cmfs))

    @cached_property
    def whites(self) -> Array:
        """(K, 3) XYZ of the perfect reflector."""
        return self.powers @ self.cmfs

    @cached_property
    def lab(self) -> Array:
        """(K, M, 3) CIE L*a*b* of the materials, each light's own white."""
        return self.to_lab(self.xyz)

    @cached_property
    def curves(self) -> CubicSpline:
        """The reflectances between the wavelengths of the grid: ``curves(λ)`` is (M, …)."""
        return CubicSpline(self.wavelengths, self.reflectances, axis=1)

    def to_lab(self, xyz: Array) -> Array:
        """CIE L*a*b* (K, M, 3) of XYZ (K, M, 3) under the lights."""
        return np.stack([lab(seen, white) for seen, white in zip(xyz, self.whites, strict=True)])

    def sampled_powers(self, wavelengths: Array) -> Array:
        """(K, n) the lights read off at wavelengths (n,) nm: what a renderer does that knows no better."""
        return interp_curves(wavelengths, self.wavelengths, self.powers)

    def only(self, materials: ArrayLike) -> RenderSetup:
        """The same lights on some of the materials: indices or a mask."""
        return RenderSetup(
            self.wavelengths, self.reflectances[np.asarray(materials)], self.lights, self.powers, self.cmfs
        )


def grid() -> Array:
    """(391,) 380–770 nm at 1 nm."""
    return np.arange(START, END + STEP / 2, STEP)


def make_setup(
    reflectances: ArrayLike,
    lights: Sequence[str],
    *,
    wavelengths: ArrayLike | None = None,
    observer_name: str = DEFAULT_OBSERVER,
) -> RenderSetup:
    """Materials (M, N) at ``wavelengths`` (N,) nm, by default `grid`, under illuminants of colour-science.

    Raises
    ------
    UnknownNameError : a light or observer that does not exist.
    OptionError : nothing to see, a grid that is not even, or values that are no reflectances.
    """
    nm = grid() if wavelengths is None else np.asarray(wavelengths, dtype=float)
    materials = np.asarray(reflectances, dtype=float)
    _check(nm, materials)
    lights = tuple(dict.fromkeys(lights))
    if not lights:
        raise OptionError("there is no light", hint="name at least one: D65")
    # Tables have steps of whole nanometres; a grid may have any.
    shape = np.floor(nm[0]), np.ceil(nm[-1]), 1.0
    whole = np.arange(shape[0], shape[1] + 0.5)
    cmfs = interp_curves(nm, whole, observer.matching_functions(observer_name, *shape).T).T
    powers = interp_curves(nm, whole, np.stack([observer.illuminant_spd(name, *shape) for name in lights]))
    return RenderSetup(nm, materials, lights, powers / (powers @ cmfs[:, 1])[:, None], cmfs)


def interp_curves(wavelengths: Array, known: Array, curves: Array) -> Array:
    """Curves (C, …) at ``known`` (…,) nm → (C, n) at ``wavelengths`` (n,)."""
    return np.stack([np.interp(wavelengths, known, curve) for curve in curves])


def _check(nm: Array, materials: Array) -> None:
    steps = np.diff(nm)
    if nm.ndim != 1 or len(nm) < 16 or not np.allclose(steps, steps[0], rtol=1e-6) or steps[0] <= 0:
        raise OptionError("the wavelengths are not evenly spaced", hint="give a grid such as 380:770:1")
    if materials.ndim != 2 or not len(materials) or materials.shape[1] != len(nm):
        raise OptionError(
            f"reflectances of shape {materials.shape} do not fit {len(nm)} wavelengths",
            hint="give one row a material, at least one",
        )
    if not np.isfinite(materials).all() or materials.min() < 0:
        raise OptionError("a reflectance is negative or no number", hint="give values from 0 to 1")
