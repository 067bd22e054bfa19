"""What a representation of spectra is: lights and surfaces are encoded, a surface turns light into light."""

from __future__ import annotations

from typing import Any, Protocol

from uplift.common.arrays import Array


class Representation(Protocol):
    """A way to hold spectra, after Kment 2011, 5.4.

    A code holds many spectra, a row each; what is light stays light through a ``product``, so that it can meet the
    next surface. Row r of a light meets row r of the surfaces.
    """

    @property
    def name(self) -> str:
        """Short, as the thesis abbreviates it: PS16."""
        ...

    @property
    def family(self) -> str:
        """What it is called whatever its size."""
        ...

    def encode_light(self, power: Array) -> Any:
        """The code of relative powers (n, 401), as `dense.wavelengths` has them."""
        ...

    def encode_surface(self, reflectance: Array) -> Any:
        """The code of reflectances (n, 401)."""
        ...

    def multiply(self, light: Any, surface: Any) -> Any:
        """The code of the light that the surfaces send back."""
        ...

    def xyz(self, light: Any) -> Array:
        """XYZ (n, 3) of a light, as `dense.observed` weighs it."""
        ...

    def storage(self, code: Any) -> Array:
        """(n,) numbers stored for each spectrum of a light or of surfaces."""
        ...
