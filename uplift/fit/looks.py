"""Looks: colours whose appearance under further lights is chosen, as entries of a cube (docs/look-cubes.md).

A reflectance is designed first: of all within [0, 1] that have the colour of the build exactly, the one nearest to the
wished colours, and among these the one that differs least from the expected spectrum. The problem is convex, so a wish
that it misses is one that no reflectance meets. The entry fit then brings the reflectance into the spectrum model, like
a measured one, with its colours weighted more.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, delta_e_2000_weights, lab, lab_jacobian, rgb_to_lab
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array
from uplift.fit.bounded_least_squares import BoundedProblem, solve_bounded
from uplift.fit.entries import MAX_STEPS, FittedEntries, fit_entries
from uplift.fit.kriging import krige
from uplift.fit.learn_kernel import DEFAULT
from uplift.fit.least_change import nearest_of_colour
from uplift.fit.objective import Weights
from uplift.fit.prior import Prior
from uplift.models import Model, evaluate
from uplift.models.minimum_norm import ForwardMap, forward_map

MET = 0.1
"""ΔE00 within which a wish is met."""
COLOURS = Weights(lights=1.0)
"""Weights of the entry fit: the wished colours count as much as the spectrum allows."""
SHAPES = (0.3, 0.03)
"""ΔE00 that a root-mean-square change of the reflectance by 1 weighs. The second is used where the first misses."""
ENOUGH = 0.02
"""ΔE00 of a design that is not repeated with a smaller weight of the shape."""
SMOOTH = 50.0
"""nm: a change of the reflectance weighs as much as SMOOTH times its slope."""
EXACT = 1e4
"""Weight of the colour of the build: ΔE00 per unit of linear RGB."""
MAX_TURNS = 3
"""Linearisations of CIE L*a*b* at the colours found."""


@dataclass(frozen=True, eq=False)
class LookGoal:
    """A colour, and its wished colours under L lights.

    Parameters
    ----------
    rgb : ndarray, shape (3,)
        Linear RGB under the build illuminant.
    lights : tuple of Light
        The lights, at the wavelengths of the sensor.
    xyz : ndarray, shape (L, 3)
        Wished XYZ; the perfect reflector has that of `Light.white`.
    """

    rgb: Array
    lights: tuple[Light, ...]
    xyz: Array

    def colours(self, reflectance: Array) -> Array:
        """Compute the colours of a reflectance.

        Parameters
        ----------
        reflectance : ndarray, shape (N,)
            Reflectance at the wavelengths of the lights.

        Returns
        -------
        ndarray, shape (L, 3)
            XYZ under the lights.
        """
        return np.stack([light.xyz @ reflectance for light in self.lights])

    def delta_e(self, reflectance: Array) -> Array:
        """Compute how far a reflectance is from the goal.

        Parameters
        ----------
        reflectance : ndarray, shape (N,)
            Reflectance at the wavelengths of the lights.

        Returns
        -------
        ndarray, shape (L,)
            ΔE00 between its colours and the wished ones.
        """
        found = zip(self.lights, self.colours(reflectance), self.xyz, strict=True)
        return np.array([delta_e_2000(lab(xyz, light.white), lab(wish, light.white)) for light, xyz, wish in found])

    def softened(self, expected: Array, weight: float) -> LookGoal:
        """Move the wish towards the colours of an expected reflectance.

        Parameters
        ----------
        expected : ndarray, shape (N,)
            Reflectance at the wavelengths of the lights.
        weight : float
            Share of the wish, 0 to 1.

        Returns
        -------
        LookGoal
            The goal between both, on a straight line in XYZ.
        """
        return replace(self, xyz=weight * self.xyz + (1 - weight) * self.colours(expected))


def expected_reflectances(prior: Prior, forward: ForwardMap, rgb: Array, tolerance: float) -> Array:
    """Compute the reflectances that a prior expects of colours.

    Parameters
    ----------
    prior : Prior
        The prior.
    forward : ForwardMap
        Map from its multipliers to RGB.
    rgb : ndarray, shape (n, 3)
        Linear RGB.
    tolerance : float
        Largest residual in linear RGB.

    Returns
    -------
    ndarray, shape (n, N)
        Reflectances of these colours.
    """
    multipliers = nearest_of_colour(prior.model, forward, prior(rgb), rgb, tolerance, MAX_STEPS)
    return evaluate(prior.model, multipliers, prior.sensor.wavelengths)


def design_reflectance(sensor: Sensor, goal: LookGoal, expected: Array) -> Array:
    """Design a reflectance of a colour with wished colours under lights.

    Parameters
    ----------
    sensor : Sensor
        Sensor of the RGB.
    goal : LookGoal
        The colours. A reflectance with the RGB must exist.
    expected : ndarray, shape (N,)
        Reflectance from which the result differs least, with the RGB of the goal.

    Returns
    -------
    ndarray, shape (N,)
        Reflectance in [0, 1]; that of the least sum of squares of (nearly) ΔE00 where no reflectance meets the goal.
    """
    found = expected
    for weight in SHAPES:
        shape = weight * _shape(sensor.wavelengths)
        for _ in range(MAX_TURNS):
            before, found = found, _linear_design(sensor, goal, expected, found, shape)
            if goal.delta_e(found).max() <= ENOUGH:
                return found
            if np.abs(found - before).max() <= ENOUGH / EXACT:
                break
    return found


def _shape(wavelengths: Array) -> Array:
    """Rows (2 N − 1, N) whose squares sum to the mean square of a change and of `SMOOTH` times its slope."""
    count, slope = len(wavelengths), np.diff(np.eye(len(wavelengths)), axis=0)
    slope *= SMOOTH / np.diff(wavelengths)[:, None]
    return np.concatenate([np.eye(count), slope]) / np.sqrt(count)


def _linear_design(sensor: Sensor, goal: LookGoal, expected: Array, near: Array, shape: Array) -> Array:
    """Reflectance (N,) of least squares, with L*a*b* linearised at the colours of the reflectance ``near``."""
    rows, values = [EXACT * sensor.matrix], [EXACT * (goal.rgb - sensor.matrix @ expected)]
    for light, wish, xyz in zip(goal.lights, goal.xyz, goal.colours(near), strict=True):
        wished, found = lab(wish, light.white), lab(xyz, light.white)
        weights = delta_e_2000_weights(wished)
        slope = weights @ lab_jacobian(xyz, light.white) @ light.xyz
        rows.append(slope)
        values.append(weights @ (wished - found) + slope @ (near - expected))
    matrix = np.concatenate([*rows, shape])
    problem = BoundedProblem(
        matrix,
        np.concatenate([*values, np.zeros(len(shape))]),
        -expected,
        1 - expected,
    )
    return np.clip(expected + solve_bounded(problem), 0, 1)


def fit_designs(
    model: Model,
    sensor: Sensor,
    goals: Sequence[LookGoal],
    designs: Array,
    error_light: Light,
    tolerance: float,
) -> FittedEntries:
    """Fit designed reflectances by the spectrum model, each with the lights of its goal.

    Parameters
    ----------
    model : Model
        Spectrum model.
    sensor : Sensor
        Sensor of the RGB.
    goals : sequence of LookGoal
        The k goals.
    designs : ndarray, shape (k, N)
        Their reflectances by `design_reflectance`.
    error_light : Light
        Light of `FittedEntries.error`.
    tolerance : float
        Largest residual in linear RGB.

    Returns
    -------
    FittedEntries
        The designs as entries.
    """
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    if not goals:
        return FittedEntries(np.zeros((0, 3)), designs, np.zeros((0, model.count)), np.zeros(0))
    fitted = (
        fit_entries(
            model,
            forward,
            design[None],
            goal.rgb[None],
            (sensor.light, *goal.lights),
            error_light,
            tolerance,
            COLOURS,
        )
        for goal, design in zip(goals, designs, strict=True)
    )
    return join_entries(*fitted)


def join_entries(*parts: FittedEntries) -> FittedEntries:
    """Put entries after one another.

    Parameters
    ----------
    *parts : FittedEntries
        At least one.

    Returns
    -------
    FittedEntries
        All entries in order.
    """
    return FittedEntries(
        *(np.concatenate([getattr(part, key.name) for part in parts]) for key in fields(FittedEntries))
    )


def prior_with_looks(prior: Prior, entries: FittedEntries, looks: FittedEntries) -> Prior:
    """Let the prior know looks: the spectra of colours near a look deviate as that of the look.

    Kernel and standard errors stay, as looks are not measurements.

    Parameters
    ----------
    prior : Prior
        Prior of the atlas entries.
    entries, looks : FittedEntries
        Atlas entries and looks, in the model of the prior.

    Returns
    -------
    Prior
        The prior of both. The order of the entries does not change the rounding of sums.
    """
    if not len(looks):
        return prior
    both = join_entries(entries, looks)
    order = np.lexsort(both.rgb.T)
    rgb, multipliers = both.rgb[order], both.multipliers[order]
    deviations = prior.model.to_storage(multipliers) - prior.base.coefficients(rgb)
    kernel = DEFAULT if prior.kriging is None else prior.kriging.kernel
    kriging, _ = krige(rgb_to_lab(prior.sensor, rgb), deviations, kernel)
    return replace(prior, kriging=kriging)
