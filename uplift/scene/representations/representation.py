"""Protocol of spectral representations."""

from __future__ import annotations

from typing import Any, Protocol

from uplift.common.arrays import Array


class Representation(Protocol):
    """Encoding of spectra that a renderer can multiply (Kment 2011, section 5.4).

    A code holds n spectra. The product of a light and surfaces is again a light, which may meet the next surface.
    Row r of a light meets row r of the surfaces.
    """

    @property
    def name(self) -> str:
        """Abbreviation of the thesis with the number of coefficients, such as ``PS16``."""
        ...

    @property
    def family(self) -> str:
        """Name of the method without its size."""
        ...

    def encode_light(self, power: Array) -> Any:
        """Encode spectral powers.

        Parameters
        ----------
        power : ndarray, shape (n, 401)
            Relative powers at the wavelengths of `dense.wavelengths`.

        Returns
        -------
        object
            The code, of a type that belongs to the representation.
        """
        ...

    def encode_surface(self, reflectance: Array) -> Any:
        """Encode reflectances.

        Parameters
        ----------
        reflectance : ndarray, shape (n, 401)
            Reflectances at the wavelengths of `dense.wavelengths`.

        Returns
        -------
        object
            The code, of a type that belongs to the representation.
        """
        ...

    def multiply(self, light: Any, surface: Any) -> Any:
        """Compute the light that surfaces reflect.

        Parameters
        ----------
        light, surface : object
            Codes of `encode_light` or `multiply`, and of `encode_surface`, with as many rows.

        Returns
        -------
        object
            Code of a light.
        """
        ...

    def xyz(self, light: Any) -> Array:
        """Compute the colours of lights.

        Parameters
        ----------
        light : object
            Code of a light.

        Returns
        -------
        ndarray, shape (n, 3)
            XYZ in the units of `dense.xyz_weights`.
        """
        ...

    def storage(self, code: Any) -> Array:
        """Count the numbers stored per spectrum.

        Parameters
        ----------
        code : object
            Code of a light or of surfaces.

        Returns
        -------
        ndarray, shape (n,)
            Number of coefficients in each row.
        """
        ...
