"""Evidence for the errors of a cube whose atlas teaches none: the materials of each
known family, predicted by a base without the family (docs/mathematics.md, 7).
"""

from collections.abc import Sequence
from functools import partial

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra, rgb_to_lab
from uplift.colorimetry.likely_errors import ExpectedError, LeftOut, expected_error
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.arrays import Array
from uplift.fit.base import (
    family_samples,
    learnt_coefficients,
    smooth_base,
)
from uplift.fit.families import STAND_IN, Family, krige_families
from uplift.fit.problem import Problem
from uplift.models.brightness import brightness
from uplift.models.model import evaluate
from uplift.models.moments import Moments

MIN_FAMILIES = 3
"""Families without which nothing is known of the next one."""
MAX_FAMILIES = 250
"""Families whose numbers a file holds."""
MAX_MATERIALS = 1000
"""Materials of all families, at most; more are thinned evenly."""
MAX_PASSES = 32


def leave_out_families(
    problem: Problem, families: Sequence[Family], relevance: Sequence[float]
) -> LeftOut | None:
    """Predict the materials inside the RGB space without their families; None for too
    few families.

    ``relevance`` (F,) is that of the families that the base has learnt from; empty if
    it has learnt from none.
    """
    numbers = [
        number for number, family in enumerate(families) if family.name != STAND_IN
    ]
    if not MIN_FAMILIES <= len(numbers) <= MAX_FAMILIES:
        return None
    sensor = problem.sensor
    inside = [_inside(problem, families[number]) for number in numbers]
    step = max(-(-sum(map(len, inside)) // MAX_MATERIALS), 1)
    measured = [spectra[::step] for spectra in inside]
    colours = [np.clip(sensor.rgb(spectra), 0, 1) for spectra in measured]
    if relevance:
        learnt = list(zip(families, relevance, strict=True))
        starts = _without_own(problem, learnt, numbers, colours)
    else:
        plain, _ = smooth_base(problem)
        starts = [plain.coefficients(rgb) for rgb in colours]
    target = np.concatenate(colours)
    start = problem.model.from_storage(np.concatenate(starts))
    solution = problem.solve(target, start, MAX_PASSES)
    predicted = evaluate(problem.model, solution.multipliers, sensor.wavelengths)
    family = np.repeat(np.arange(len(colours)), [len(rgb) for rgb in colours])
    return LeftOut(
        target,
        family.astype(np.uint8),
        np.concatenate(measured).astype(np.float32),
        predicted.astype(np.float32),
        tuple(families[number].name for number in numbers),
    )


def _inside(problem: Problem, family: Family) -> Array:
    """Return the reflectances (n, N) of a family that are inside the RGB space."""
    rgb = problem.sensor.rgb(family.measured)
    return family.measured[in_unit_cube(rgb)]


def _without_own(
    problem: Problem,
    learnt: Sequence[tuple[Family, float]],
    numbers: Sequence[int],
    colours: Sequence[Array],
) -> list[Array]:
    """Coefficients (n, C) of ``colours`` (n, 3) of some of the ``learnt`` families, as
    the base of all others expects them.
    """
    model = problem.model
    plain, _ = smooth_base(problem)
    if not isinstance(model, Moments):
        raise TypeError("only moments are learnt")
    samples = [
        family_samples(plain, problem, family.measured, None) for family, _ in learnt
    ]
    expected = []
    for number, rgb in zip(numbers, colours, strict=True):
        others = [other for other in range(len(learnt)) if other != number]
        kriging = krige_families(
            [learnt[other][0] for other in others],
            [samples[other] for other in others],
        )
        weights = np.array([learnt[other][1] for other in others])
        deviation = partial(kriging, relevance=weights)
        factor = brightness(rgb)
        bright = np.minimum(rgb / factor, 1)
        smooth = plain.coefficients(rgb) / factor
        coefficients = learnt_coefficients(problem, model, smooth, deviation, bright)
        expected.append(factor * coefficients)
    return expected


def family_errors(problem: Problem, left_out: LeftOut) -> ExpectedError:
    """Learn the expected squares of ΔE00 under the light of the errors."""
    missed = delta_e_spectra(
        problem.light_of_errors, left_out.predicted, left_out.measured
    )
    locations = rgb_to_lab(problem.sensor, left_out.rgb)
    # No colour is answered with a material of another family: with it, nothing remains.
    remaining = np.zeros_like(missed)
    return expected_error(locations, missed, remaining, family=left_out.family)
