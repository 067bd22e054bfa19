"""Measured paints: absorption and scattering of each, at common wavelengths."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry import observer
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, as_array, as_nm
from uplift.common.errors import OptionError, UpliftWarning, unknown_name, warn
from uplift.common.text import listed
from uplift.extras.paint.optics import NO_SURFACE, Surface
from uplift.extras.paint.pigments import Pigment

TINT_PARTS = 4
"""Parts of white to one of paint in a tint."""


@dataclass(frozen=True, eq=False)
class Paints:
    """Paints by name, with what Kubelka and Munk's theory needs to mix them.

    Parameters
    ----------
    names : tuple of str
        Names of the P paints.
    wavelengths : ndarray, shape (N,)
        Wavelengths in nm, ascending.
    pigments : Pigment
        Absorption and scattering, (P, N) each, per unit of thickness.
    surface : Surface
        Surface of the dry paint.
    errors : Pigment, optional
        Relative standard errors of absorption and scattering, (P, N) each.
    prices : tuple of float
        Price of a part of each paint, NaN where it is not known; empty for none.
    is_to_scale : bool
        Whether the unit of thickness is known, from measured films.
    """

    names: tuple[str, ...]
    wavelengths: Array
    pigments: Pigment
    surface: Surface = NO_SURFACE
    errors: Pigment | None = None
    prices: tuple[float, ...] = ()
    is_to_scale: bool = True

    def __len__(self) -> int:
        return len(self.names)

    @property
    def spacing(self) -> tuple[float, float, float]:
        """First and last wavelength and step in nm."""
        nm = self.wavelengths
        return float(nm[0]), float(nm[-1]), float(nm[1] - nm[0])

    @cached_property
    def sensor(self) -> Sensor:
        """Sensor of sRGB under D65 at the wavelengths."""
        return observer.sensor(wavelengths=self.spacing)

    def light(self, illuminant: Illuminant) -> Light:
        """Create a light at the wavelengths.

        Parameters
        ----------
        illuminant : str or Lamp
            Illuminant.

        Returns
        -------
        Light
            The light, for the standard observer.

        Raises
        ------
        UnknownNameError
            The name is unknown.
        """
        return observer.light(illuminant, observer.DEFAULT_OBSERVER, *self.spacing)

    def index(self, name: str) -> int:
        """Find a paint.

        Parameters
        ----------
        name : str
            Name of the paint.

        Returns
        -------
        int
            Its position.

        Raises
        ------
        UnknownNameError
            No paint has the name.
        """
        if name not in self.names:
            raise unknown_name(name, self.names, "paint")
        return self.names.index(name)

    def select(self, names: Sequence[str]) -> "Paints":
        """Select some of the paints.

        Parameters
        ----------
        names : sequence of str
            Names, in the order of the result.

        Returns
        -------
        Paints
            The paints of these names.

        Raises
        ------
        UnknownNameError
            No paint has a name.
        OptionError
            A name is there twice.
        """
        if len(set(names)) < len(names):
            raise OptionError(
                f"each paint must be selected once, got {listed(list(names))}",
                hint="leave out the second one",
            )
        rows = [self.index(name) for name in names]
        return replace(
            self,
            names=tuple(names),
            pigments=self.pigments.select(rows),
            errors=None if self.errors is None else self.errors.select(rows),
            prices=tuple(self.prices[row] for row in rows) if self.prices else (),
        )

    def at(self, wavelengths: ArrayLike) -> "Paints":
        """Interpolate absorption and scattering linearly.

        Parameters
        ----------
        wavelengths : array_like, shape (M,)
            Wavelengths in nm; beyond the range the values are constant.

        Returns
        -------
        Paints
            The paints at these wavelengths.
        """
        nm = as_nm(wavelengths)

        def sample(values: Array) -> Array:
            return np.stack([np.interp(nm, self.wavelengths, row) for row in values])

        def sampled(pigment: Pigment) -> Pigment:
            return Pigment(sample(pigment.absorption), sample(pigment.scattering))

        errors = None if self.errors is None else sampled(self.errors)
        pigments = sampled(self.pigments)
        return replace(self, wavelengths=nm, pigments=pigments, errors=errors)

    def reflectance(
        self,
        parts: ArrayLike,
        thickness: float | None = None,
        ground: ArrayLike = 1.0,
    ) -> Array:
        """Compute the reflectance of mixtures.

        Parameters
        ----------
        parts : array_like, shape (..., P)
            Parts of the paints, of which some are greater than 0.
        thickness : float, optional
            Thickness of the layer in the unit of the paints, by default opaque.
        ground : array_like, shape (N,) or ()
            Reflectance of the ground, by default white.

        Returns
        -------
        ndarray, shape (..., N)
            Reflectance in [0, 1], as it is measured through the surface.

        Raises
        ------
        OptionError
            Parts or thickness are invalid.
        """
        amounts: Array = as_array(parts)
        if amounts.shape[-1:] != (len(self),):
            raise OptionError(
                f"parts must have one number for each of {len(self)} paints, "
                f"got shape {amounts.shape}",
                hint="pass 0 for paints that are not in the mixture",
            )
        backing = np.broadcast_to(ground, self.wavelengths.shape)
        return self.pigments.coat(amounts, thickness, self.surface).over(backing)

    def rows(self) -> list[dict[str, Any]]:
        """Return what is known of each paint by the names of columns."""
        columns = dict(vars(self.pigments))
        if self.errors is not None:
            errors = vars(self.errors).items()
            columns |= {f"{key}_errors": values for key, values in errors}
        rows = []
        for row, name in enumerate(self.names):
            fields: dict[str, Any] = {"name": name}
            if self.prices and np.isfinite(self.prices[row]):
                fields["price"] = self.prices[row]
            rows.append(fields | {key: values[row] for key, values in columns.items()})
        return rows

    @cached_property
    def lightest(self) -> int:
        """Position of the paint that reflects most where it absorbs most, usually
        white.
        """
        return int(self.reflectance(np.eye(len(self))).min(axis=1).argmax())

    def tints(self) -> Array:
        """Compute the reflectances (P, N) of `TINT_PARTS` parts of the lightest paint
        to one of each.
        """
        alone = np.eye(len(self))
        return self.reflectance(alone + TINT_PARTS * alone[self.lightest])

    def cost(self, parts: ArrayLike) -> Array:
        """Compute the price of one part of mixtures.

        Parameters
        ----------
        parts : array_like, shape (..., P)
            Parts of the paints.

        Returns
        -------
        ndarray, shape (...)
            The price, NaN if that of a paint in the mixture is unknown.
        """
        amounts: Array = as_array(parts)
        prices = np.array(self.prices or (np.nan,) * len(self))
        used = np.where(amounts > 0, amounts * prices, 0)
        return np.asarray(used.sum(axis=-1) / amounts.sum(axis=-1))


def strengths(paints: Paints, white: int) -> Array:
    """Compute how strongly each paint tints a white one.

    Parameters
    ----------
    paints : Paints
        The paints.
    white : int
        Position of the white one.

    Returns
    -------
    ndarray, shape (P,)
        Parts of white to one of paint at which the mixture absorbs as much as it
        scatters, at the wavelength where the paint absorbs most. Infinite if white
        itself absorbs more there.
    """
    K = paints.pigments.absorption
    S = paints.pigments.scattering
    strongest = K.argmax(axis=1)
    rows = np.arange(len(paints))
    excess = np.maximum(K[rows, strongest] - S[rows, strongest], 0)
    margin = S[white, strongest] - K[white, strongest]
    never = np.where(excess > 0, np.inf, 0.0)
    return np.divide(excess, margin, out=never, where=margin > 0)


def check_unit(paints: Paints, thickness: float | None) -> None:
    """Warn of a thickness of paints that were fitted to opaque samples only."""
    if thickness is not None and not paints.is_to_scale:
        problem = (
            "the paints were fitted to opaque samples: the unit of thickness is unknown"
        )
        hint = "measure films on a ground as well"
        warn(UpliftWarning(problem, code="thickness-without-unit", hint=hint))
