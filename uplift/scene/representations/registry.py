"""Registry of the representations that are compared, with their sizes."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from uplift.common.arrays import Array
from uplift.scene.representations.enhanced_riemann import enhanced_riemann
from uplift.scene.representations.filtered_point_sampling import mitchell_point_samples
from uplift.scene.representations.gauss_quadrature import gauss_samples
from uplift.scene.representations.hero_wavelengths import HeroWavelengths
from uplift.scene.representations.linear_model import linear_model
from uplift.scene.representations.point_sampling import point_samples
from uplift.scene.representations.representation import Representation
from uplift.scene.representations.riemann_sums import riemann_sums
from uplift.scene.representations.sigmoid import SigmoidCoefficients
from uplift.scene.representations.sun_composite import sun_composite
from uplift.scene.representations.trigonometric_moments import trigonometric_moments

SIZES = (4, 8, 16, 32)
"""Numbers of samples."""
COEFFICIENTS = (5, 7, 11, 15)
"""Numbers of Fourier coefficients of Sun's composite model in the thesis."""
MOMENTS = (5, 9, 13, 17)
"""Numbers of moments that cubes may store."""
COMPONENTS = (4, 8, 16)
"""Numbers of components of the linear model."""
PATHS = (1, 4, 16, 64)
"""Numbers of paths per pixel of hero wavelengths."""

Factory = Callable[[int], Representation]

FACTORIES: Mapping[str, tuple[Factory, tuple[int, ...]]] = {
    "PS": (point_samples, SIZES),
    "PF": (mitchell_point_samples, SIZES),
    "RS": (riemann_sums, SIZES),
    "RE": (enhanced_riemann, SIZES),
    "CS": (sun_composite, COEFFICIENTS),
    "GQ": (gauss_samples, SIZES),
    "TM": (trigonometric_moments, MOMENTS),
    "SG": (lambda count: SigmoidCoefficients(), (3,)),
    "HW": (HeroWavelengths, PATHS),
}
"""Factory and sizes by abbreviation. The linear model (LM) is not included, as it depends on the scene."""


def all_representations(lights: Array, surfaces: Array) -> tuple[Representation, ...]:
    """Make every registered representation, and the linear models of a scene.

    Parameters
    ----------
    lights : ndarray, shape (L, 401)
        Spectral powers of the lights.
    surfaces : ndarray, shape (E, 401)
        Reflectances.

    Returns
    -------
    tuple of Representation
        All sizes of all representations.
    """
    registered = (make(size) for make, sizes in FACTORIES.values() for size in sizes)
    return (*registered, *(linear_model(count, lights, surfaces) for count in COMPONENTS))
