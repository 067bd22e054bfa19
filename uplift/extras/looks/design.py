"""Looks: colours whose appearance under further lights is chosen, as entries of a cube
(docs/looks.md).

A reflectance is designed first: of all within [0, 1] that have the colour of the build
exactly, the one nearest to the target colours, and among these the one that differs
least from the expected spectrum. The problem is convex, so no reflectance meets a
target that it misses. The entry fit then brings the reflectance into the spectrum
model, like a measured one, with its colours weighted more.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from uplift.colorimetry.delta_e import (
    delta_e_2000,
    delta_e_2000_weights,
    lab,
    lab_jacobian,
)
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array
from uplift.extras.looks.bounded_least_squares import solve_bounded
from uplift.fit.entries import FittedEntries, fit_entries
from uplift.fit.problem import Problem
from uplift.fit.solver import LeastChange
from uplift.models.model import evaluate

MET = 0.1
"""ΔE00 within which a target is met."""
FIT_WEIGHTS = ({"weight": 1.0}, {"weight": 0.3, "smoothness": 3e-3})
"""Weights of the fit of a design: the lights count as much as the spectrum allows, or
less where that misses the colours of the design, as then the spectrum would be bent
towards them without end.
"""
REACHED = 0.5
"""ΔE00 from the colours of the design above which a fit misses them."""
SHAPES = (0.3, 0.03)
"""ΔE00 that a root-mean-square change of the reflectance by 1 weighs. The second is
used where the first misses.
"""
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
    """Linear RGB (3,) under the build illuminant, and target XYZ (L, 3) under L lights,
    of reflectances (N,).

    The perfect reflector has the XYZ of `Light.white`.
    """

    rgb: Array
    lights: tuple[Light, ...]
    xyz: Array

    def colours(self, reflectance: Array) -> Array:
        """XYZ (L, 3) of a reflectance (N,) under the lights."""
        return np.stack([light.xyz @ reflectance for light in self.lights])

    def delta_e(self, reflectance: Array) -> Array:
        """ΔE00 (L,) between the colours of a reflectance (N,) and the targets."""
        pairs = zip(self.lights, self.colours(reflectance), self.xyz, strict=True)
        return np.array(
            [
                delta_e_2000(lab(xyz, light.white), lab(target, light.white))
                for light, xyz, target in pairs
            ]
        )

    def softened(self, expected: Array, weight: float) -> "LookGoal":
        """Move the targets towards the colours of an expected reflectance (N,), on a
        straight line in XYZ.
        """
        return replace(
            self, xyz=weight * self.xyz + (1 - weight) * self.colours(expected)
        )


def design_reflectance(sensor: Sensor, goal: LookGoal, expected: Array) -> Array:
    """Design a reflectance (N,) in [0, 1] of a goal that differs least from
    ``expected`` (N,), which has its RGB.

    Where no reflectance meets the goal, the sum of squares of (nearly) ΔE00 is least.
    """
    design = expected
    for weight in SHAPES:
        shape = weight * _shape(sensor.wavelengths)
        for _ in range(MAX_TURNS):
            before = design
            design = _linear_design(sensor, goal, expected, design, shape)
            if goal.delta_e(design).max() <= ENOUGH:
                return design
            if np.abs(design - before).max() <= ENOUGH / EXACT:
                break
    return design


def _shape(wavelengths: Array) -> Array:
    """Rows (2 N − 1, N) whose squares sum to the mean square of a change and of
    `SMOOTH` times its slope.
    """
    count = len(wavelengths)
    slope = np.diff(np.eye(count), axis=0)
    slope *= SMOOTH / np.diff(wavelengths)[:, None]
    return np.concatenate([np.eye(count), slope]) / np.sqrt(count)


def _linear_design(
    sensor: Sensor, goal: LookGoal, expected: Array, near: Array, shape: Array
) -> Array:
    """Reflectance (N,) of least squares, with L*a*b* linearised at the colours of the
    reflectance ``near``.
    """
    # |E (W g − rgb)|² + Σ_lights |ΔE00|² + |shape (g − expected)|² in the change of the
    # reflectance g, 0 ≤ g ≤ 1
    rows = [EXACT * sensor.matrix]
    values = [EXACT * (goal.rgb - sensor.matrix @ expected)]
    for light, target, xyz in zip(
        goal.lights, goal.xyz, goal.colours(near), strict=True
    ):
        requested = lab(target, light.white)
        current = lab(xyz, light.white)
        weights = delta_e_2000_weights(requested)
        derivative = weights @ lab_jacobian(xyz, light.white) @ light.xyz
        rows.append(derivative)
        values.append(weights @ (requested - current) + derivative @ (near - expected))
    matrix = np.concatenate([*rows, shape])
    goals = np.concatenate([*values, np.zeros(len(shape))])
    change = solve_bounded(matrix, goals, -expected, 1 - expected)
    return np.clip(expected + change, 0, 1)


def fit_designs(
    problem: Problem, goals: Sequence[LookGoal], designs: Array
) -> FittedEntries:
    """Fit designed reflectances (k, N) by the spectrum model, each with the lights of
    its goal.
    """
    return join_entries(
        *(_fit_design(problem, *pair) for pair in zip(goals, designs, strict=True))
    )


def _fit_design(problem: Problem, goal: LookGoal, design: Array) -> FittedEntries:
    """Fit a reflectance (N,) with the first weights that reach its colours, or the
    last.
    """
    weighted = replace(
        problem, lights=(problem.sensor.light, *goal.lights), method=LeastChange
    )
    for weights in FIT_WEIGHTS:
        fitted = fit_entries(weighted, design[None], goal.rgb[None], **weights)
        answer = evaluate(
            problem.model, fitted.multipliers, problem.sensor.wavelengths
        )[0]
        if (goal.delta_e(answer) <= goal.delta_e(design) + REACHED).all():
            break
    return fitted


def join_entries(*parts: FittedEntries) -> FittedEntries:
    """Put entries after one another."""
    return FittedEntries(
        *(np.concatenate(columns) for columns in zip(*parts, strict=True))
    )
