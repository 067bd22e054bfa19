"""Amounts of components, lights and filters, layers on a ground, and the surface
between air and a vehicle of paint.

Incident light is a perpendicular beam (Fresnel; Fishkin 1983, eq. 9.3), light within
is diffuse (Duntley 1942, eq. 10.9; D. B. Judd, J. Res. NBS 29, 1942). Saunderson's
correction (J. Opt. Soc. Am. 32, 1942, eq. 10.10) converts between the internal
reflectance, as in Kubelka and Munk's theory, and the measured one.
"""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array, as_array
from uplift.common.errors import OptionError

TINY = np.finfo(float).tiny
MAX_THICKNESS = 1e9  # as it is multiplied with other numbers


def as_amounts(parts: ArrayLike) -> Array:
    """Return parts (…, n) as floats. Raises `OptionError` unless they are finite and
    not negative.
    """
    array = as_array(parts)
    if array.ndim == 0 or not (np.isfinite(array) & (array >= 0)).all():
        raise OptionError(
            "parts of a mixture must be a sequence of finite numbers of at least 0, "
            f"got {array.tolist()}",
            hint="pass one for each component",
        )
    return array


def as_shares(parts: ArrayLike) -> Array:
    """Return parts (…, n) scaled to sum 1. Raises `OptionError`, also if all are 0."""
    array = as_amounts(parts)
    largest = array.max(axis=-1, keepdims=True)
    if not (largest > 0).all():
        raise OptionError(
            "some part of a mixture must be greater than 0", hint="raise one of them"
        )
    relative = array / largest  # a sum of huge parts would overflow
    return relative / relative.sum(axis=-1, keepdims=True)


def ramp(parts: ArrayLike, steps: int) -> Array:
    """Return proportions (steps, n) from the first component alone, through the others,
    to the last alone.

    ``parts`` (n,) are the amounts at which each component stands alone. The shape is
    (0, 1) for a single component.

    >>> ramp([2, 1], 3).tolist()
    [[2.0, 0.0], [1.0, 0.5], [0.0, 1.0]]
    """
    ends = np.diag(as_amounts(parts))
    if len(ends) < 2:
        return np.empty((0, len(ends)))
    positions = np.linspace(0, len(ends) - 1, steps)
    stops = np.arange(len(ends))
    return np.stack([np.interp(positions, stops, column) for column in ends.T], axis=-1)


def check_thickness(thickness: float | None) -> None:
    """Raise `OptionError` for an impossible thickness; None is opaque."""
    if thickness is not None and not 0 <= thickness <= MAX_THICKNESS:
        problem = f"thickness must be in [0, {MAX_THICKNESS:g}], got {thickness}"
        raise OptionError(problem, hint="1 is the unit")


def weighted_sum(spectra: ArrayLike, weights: Array) -> Array:
    """Return the sum (…, N) of spectra (…, n, N) with weights (…, n)."""
    return (weights[..., None, :] @ np.asarray(spectra, dtype=float))[..., 0, :]


def add_lights(spectra: ArrayLike, strengths: ArrayLike) -> Array:
    """Superpose lights (eq. 8.1, 8.2): linear in spectra, XYZ and linear RGB.

    Parameters
    ----------
    spectra : array_like of shape (..., n, N)
        Power of the lights.
    strengths : array_like of shape (..., n)
        Amounts of the lights.

    Returns
    -------
    ndarray of shape (..., N)
        Power of their sum.
    """
    return weighted_sum(spectra, as_amounts(strengths))


def average_areas(spectra: ArrayLike, parts: ArrayLike) -> Array:
    """Average the reflectances (…, n, N) of dots too small to resolve by the areas (…,
    n) that they cover (eq. 8.3).
    """
    return weighted_sum(spectra, as_shares(parts))


def stack_filters(transmittance: ArrayLike, thickness: ArrayLike) -> Array:
    """Multiply transmittances, each to the power of its thickness, without reflections
    (eq. 9.1).

    Parameters
    ----------
    transmittance : array_like of shape (..., n, N)
        Transmittance of the filters, one unit thick.
    thickness : array_like of shape (..., n)
        Thickness of each.

    Returns
    -------
    ndarray of shape (..., N)
        Transmittance of all.
    """
    powers = as_amounts(thickness)[..., None]
    return np.prod(np.asarray(transmittance, dtype=float) ** powers, axis=-2)


@dataclass(frozen=True, eq=False)
class Layer:
    """A layer with the same properties from both sides."""

    reflectance: Array  # (..., N) on a black ground
    transmittance: Array  # (..., N); the sum of both is at most 1

    @property
    def diffuse(self) -> "Layer":
        """The layer for diffuse light, the same for all kinds of light."""
        return self

    def over(self, ground: ArrayLike) -> Array:
        """Return the reflectance (..., N) on a ground (..., N)."""
        xp = self.reflectance.__array_namespace__()
        below = xp.asarray(ground, dtype=float)
        # Light travels back and forth between both: R + T² g Σ (R g)^i. The sum
        # diverges only where no light gets.
        escaping = xp.maximum(1 - self.reflectance * below, TINY)
        return self.reflectance + self.transmittance**2 * below / escaping


@dataclass(frozen=True, eq=False)
class DirectedLayer(Layer):
    """A layer in a beam of light. Light that comes back from the ground is diffuse."""

    inner: Layer  # for diffuse light

    @property
    def diffuse(self) -> Layer:
        """The layer for diffuse light."""
        return self.inner

    def over(self, ground: ArrayLike) -> Array:
        """Return the reflectance (..., N) of a beam on a ground (..., N): R + T g τ Σ
        (r g)^i.
        """
        ground = np.asarray(ground, dtype=float)
        escaping = np.maximum(1 - self.inner.reflectance * ground, TINY)
        return (
            self.reflectance
            + self.transmittance * ground * self.inner.transmittance / escaping
        )


def plate(transmittance: ArrayLike, rho: float) -> Layer:
    """Return a free plate of an internal transmittance T (..., N), whose two surfaces
    reflect ρ (eq. 9.4).

    Nothing scatters, so that the light within keeps the direction in which both
    surfaces reflect ρ, from either side.
    """
    once = np.asarray(transmittance, dtype=float)
    transmitted = 1 - (rho * once) ** 2
    return Layer(
        rho + rho * ((1 - rho) * once) ** 2 / transmitted,
        (1 - rho) ** 2 * once / transmitted,
    )


def fresnel_reflectance(index: float) -> float:
    """Return the reflectance of a perpendicular beam, from either side (eq. 9.3): 0.04
    for an index of 1.5.
    """
    return ((index - 1) / (index + 1)) ** 2


def diffuse_reflectance(index: float) -> float:
    """Return the reflectance of diffuse light from air: Fresnel's, integrated (eq.
    10.9); 0.092 for an index of 1.5.

    Fishkin 1983 prints 8n + 1² for 6 (n + 1)².
    """
    n = index
    n2 = index**2
    n4 = index**4
    if n == 1:
        return 0.0
    return float(
        0.5
        + (n - 1) * (3 * n + 1) / (6 * (n + 1) ** 2)
        + n2 * (n2 - 1) ** 2 / (n2 + 1) ** 3 * np.log((n - 1) / (n + 1))
        - 2 * n**3 * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1))
        + 8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) ** 2) * np.log(n)
    )


def internal_reflectance(index: float) -> float:
    """Return the reflectance of diffuse light from within, 1 − (1 − ρ) / n², total
    reflection included (Judd 1942).
    """
    return 1 - (1 - diffuse_reflectance(index)) / index**2


def through_surface(internal: Any, again: Any, outside: Any, inside: Any) -> Any:
    """Return the reflectance that is measured through a surface (eq. 10.10).

    ``internal`` is the reflectance beneath it and ``again`` that for light that the
    surface sends back. The arrays may be those of JAX.
    """
    transmitted = (1 - outside) * (1 - inside)
    return outside + transmitted * internal / (1 - inside * again)


def beneath_surface(measured: Any, outside: Any, inside: Any) -> Any:
    """Return the reflectance beneath a surface: the inverse of `through_surface`."""
    inner = measured - outside
    return inner / ((1 - outside) * (1 - inside) + inside * inner)


@dataclass(frozen=True)
class Surface:
    """Reflectances of a surface; the default is a vehicle with the refractive index of
    air.

    Parameters
    ----------
    outside : float
        Reflectance of incident light, in [0, 1).
    inside : float
        Reflectance of diffuse light from within, in [0, 1).
    """

    outside: float = 0.0
    inside: float = 0.0

    def __post_init__(self) -> None:
        for value in (self.outside, self.inside):
            if not 0 <= value < 1:
                problem = f"reflectance of a surface must be in [0, 1), got {value}"
                raise OptionError(problem, hint="use 0 for a vehicle without a surface")

    @classmethod
    def of_index(cls, index: float) -> Self:
        """Compute the reflectances of a surface, of a perpendicular beam and from
        within.

        Parameters
        ----------
        index : float
            Refractive index of the vehicle relative to air, at least 1.

        Returns
        -------
        Surface
            The surface.
        """
        if not (np.isfinite(index) and index >= 1):
            problem = f"refractive index must be finite and at least 1, got {index}"
            raise OptionError(problem, hint="linseed oil has 1.5")
        return cls(fresnel_reflectance(index), internal_reflectance(index))

    def apply(self, internal: ArrayLike, diffuse: ArrayLike | None = None) -> Array:
        """Return the reflectance measured through the surface (Saunderson's correction,
        eq. 10.10).

        Parameters
        ----------
        internal : array_like
            Reflectance beneath the surface.
        diffuse : array_like, optional
            The same for light that the surface sends back, if it differs as that light
            is diffuse.

        Returns
        -------
        ndarray
            Measured reflectance, of the same shape.
        """
        internal = np.asarray(internal, dtype=float)
        again = internal if diffuse is None else np.asarray(diffuse, dtype=float)
        return through_surface(internal, again, self.outside, self.inside)

    def remove(self, measured: ArrayLike) -> Array:
        """Return the reflectance beneath the surface (inverse of eq. 10.10).

        Parameters
        ----------
        measured : array_like
            Measured reflectance.

        Returns
        -------
        ndarray
            Internal reflectance, negative where the measured one is below that of the
            surface alone.
        """
        measured = np.asarray(measured, dtype=float)
        return beneath_surface(measured, self.outside, self.inside)

    def beneath(self, measured: ArrayLike) -> Array:
        """Return the reflectance beneath the surface in [0, 1].

        Parameters
        ----------
        measured : array_like
            Measured reflectance.

        Returns
        -------
        ndarray
            Internal reflectance, 0 where the measured one is below that of the surface
            alone.
        """
        return np.clip(self.remove(measured), 0, 1)


NO_SURFACE = Surface()


@dataclass(frozen=True, eq=False)
class Coat:
    """A layer of paint or dye beneath the surface of its vehicle."""

    layer: Layer
    surface: Surface = NO_SURFACE

    def over(self, ground: ArrayLike) -> Array:
        """Return the reflectance (..., N) on a ground (..., N), both
        surface included.
        """
        below = self.surface.beneath(ground)
        return self.surface.apply(
            self.layer.over(below), self.layer.diffuse.over(below)
        )
