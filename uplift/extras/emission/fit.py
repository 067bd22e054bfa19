"""Fit the nodes of an emission table: the locus of single wavelengths, and expected
lights moved to chromaticities.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array, Indices
from uplift.extras.colour.dominant import crossing
from uplift.extras.emission.lattice import (
    DENOMINATOR,
    LOCUS_TOLERANCE,
    ChromaticityLattice,
    chromaticity,
    cross,
    unit_power,
    unit_xyz,
)
from uplift.fit.solver import solve
from uplift.models.minimum_norm import forward_map
from uplift.models.model import Model

TOLERANCE = 1e-9
"""Distance in XYZ, of unit X + 15 Y + 3 Z, at which a node is solved."""
MAX_PASSES = 60
FAINTEST = 1e-6
"""Smallest power of a prior as a share of its mean: the model has positive powers only.
"""
MIN_ANGLE = 1e-3
"""Smallest angle in radians between a wavelength inside the convex polygon and its
neighbours on the polygon.
"""


@dataclass(frozen=True)
class Exponential(Model):
    """Positive spectra g(t) = exp(Σ p_j cos(j π t)) without an upper bound, t from 0 to
    1 over the range.

    With as many multipliers as there are evenly spaced wavelengths, every positive
    spectrum is one of the model.
    """

    count: int = 81
    name = "exponential"

    def basis(self, wavelengths: ArrayLike) -> Array:
        return np.cos(
            np.pi * np.arange(self.count) * np.asarray(wavelengths)[..., None]
        )

    def to_reflectance(self, x: Any) -> Any:
        return x.__array_namespace__().exp(x)

    def derivative(self, x: Any) -> Any:
        return self.to_reflectance(x)

    def from_reflectance(self, reflectance: Array) -> Array:
        return np.log(reflectance)

    def constant(self) -> Array:
        return np.eye(self.count)[0]

    def metric_diagonal(self) -> Array:
        return np.asarray(1.0 + np.arange(self.count) ** 2)


def locus_lattice(
    radiometry: Array, white: Array, knots: int, rings: Array
) -> tuple[ChromaticityLattice, Array]:
    """Create a lattice that ends at the spectral locus, the polygon of the
    chromaticities of single wavelengths.

    Every corner of the polygon is a knot; the others divide its longest edges, as white
    views them, until there are `knots`. Returns also the power (K, N) of unit X + 15 Y
    + 3 Z at the knots. `radiometry` (N, 3) leads from power to XYZ, `white` (2,) is
    u′v′ of the centre.
    """
    # The locus is not quite convex: from 575 to 700 nm, mixtures of wavelengths lie
    # outside it, by LOCUS_TOLERANCE at most. They have a place on the polygon
    # nevertheless, next to the wavelengths between them. On the convex polygon, pure
    # orange would be a mixture of yellow and red.
    size = radiometry @ DENOMINATOR
    visible = np.flatnonzero(size > 0)
    uv = chromaticity(radiometry[visible])
    corners = _corners(uv, white)
    locus = np.zeros((len(corners), len(radiometry)))
    locus[np.arange(len(corners)), visible[corners]] = 1 / size[visible[corners]]
    places = uv[corners]
    while len(places) < knots:
        edge = int(
            np.argmax(_angles(places - white, np.roll(places, -1, axis=0) - white))
        )
        places, locus = (
            np.insert(
                array,
                edge + 1,
                (array[edge] + array[(edge + 1) % len(array)]) / 2,
                axis=0,
            )
            for array in (places, locus)
        )
    return ChromaticityLattice(white, places, rings), locus


def _corners(uv: Array, white: Array) -> Indices:
    """Corners of the convex polygon of chromaticities (n, 2), and others within
    `LOCUS_TOLERANCE` of it, in order.
    """
    from scipy.spatial import ConvexHull

    hull = ConvexHull(uv).vertices
    length = ChromaticityLattice(white, uv[hull], np.array([0.0, 1.0])).polar(
        uv - white
    )[2]
    corners = list(hull)
    for row in np.flatnonzero(length >= 1 - LOCUS_TOLERANCE):
        apart = np.abs(_angles(uv[corners] - white, uv[row] - white))
        if apart.min() >= MIN_ANGLE:
            corners.append(row)
    turn = _angles(uv[hull[0]] - white, uv[corners] - white) % (2 * np.pi)
    return np.array(corners)[np.argsort(turn)]


def _angles(first: Array, second: Array) -> Array:
    """Angles (n,) in radians from vectors (n, 2) to others, counterclockwise."""
    return np.arctan2(cross(first, second), (first * second).sum(axis=-1))


def nearest_lights(prior: Array, uv: Array, radiometry: Array) -> Array:
    """Move spectra (n, N), of any scale, to chromaticities (n, 2), each by the
    smoothest and smallest factor.

    `radiometry` (N, 3) leads from power, at evenly spaced wavelengths, to XYZ. Returns
    power (n, N) of unit X + 15 Y + 3 Z. Chromaticities near the spectral locus may be
    missed; see `mix_with_locus`.
    """
    model = Exponential(len(radiometry))
    wavelengths = np.linspace(0.0, 1.0, len(radiometry))
    basis = model.basis(wavelengths)
    positive = np.maximum(prior, FAINTEST * prior.mean(axis=1, keepdims=True))
    logarithm = model.from_reflectance(unit_power(positive, radiometry))
    multipliers = np.asarray(np.linalg.solve(basis, logarithm.T).T, dtype=float)
    solution = solve(
        forward_map(model, wavelengths, radiometry.T),
        multipliers,
        unit_xyz(uv),
        tolerance=TOLERANCE,
        max_passes=MAX_PASSES,
        prior=multipliers,
    )
    return unit_power(np.exp(solution.multipliers @ basis.T), radiometry)


def mix_with_locus(
    power: Array,
    uv: Array,
    lattice: ChromaticityLattice,
    locus: Array,
    radiometry: Array,
) -> Array:
    """Remove the last differences of power (n, N) from chromaticities (n, 2) by adding
    a little light of the locus.

    `locus` (K, N) is the power at the knots; it, `power` and the result have unit X +
    15 Y + 3 Z.
    """
    outline = np.concatenate([lattice.knots, lattice.knots[:1]])
    reached = chromaticity(power @ radiometry)
    # where rays from the chromaticity that was reached through the wanted one leave the
    # polygon
    sector, position, length = crossing(outline - reached[:, None], uv - reached)
    share = (1 / np.maximum(length, 1.0))[:, None]
    along = position[:, None]
    edge = (1 - along) * locus[sector] + along * locus[(sector + 1) % len(locus)]
    return (1 - share) * power + share * edge
