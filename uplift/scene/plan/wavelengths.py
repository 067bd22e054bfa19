"""Choice of the wavelengths to render at."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from uplift.common.progress import Progress
from uplift.lookup import Cube
from uplift.scene.plan.arguments import wavelength_args
from uplift.scene.plan.context import PlanContext
from uplift.scene.plan.decision import Decision, Trial, decide
from uplift.scene.plan.evaluation import EvaluationSet
from uplift.scene.wavelengths import RenderSetup, Sampling, choose, make_setup

COUNTS = (3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20, 24, 32, 40)
"""Numbers of wavelengths to try before the whole grid."""
FITTED_COLOURS = 200
"""Colours of each group that wavelengths are fitted to; all are evaluated."""
DIGITS = 2
"""Decimals of a wavelength in nm, so that the measured wavelengths are those of the command line."""


def choose_wavelengths(
    context: PlanContext, tests: EvaluationSet, limit: float, cube: Cube
) -> tuple[Decision, Sampling]:
    """Choose wavelengths, and weights that serve all lights, for the spectra of the cube."""
    setup = _render_setup(context, tests, cube)
    samplings: list[Sampling] = []

    def trials() -> Iterator[Trial]:
        for count in COUNTS:
            context.progress(Progress(f"{count} wavelengths", len(samplings), len(COUNTS) + 1))
            samplings.append(_fit_sampling(setup, count))
            yield _trial(tests, cube, samplings[-1])
        samplings.append(Sampling(setup.wavelengths, setup.cmfs, setup.lights, setup.powers))
        yield _trial(tests, cube, samplings[-1])

    decision = decide("wavelengths", "Wavelengths", "wavelengths", limit, trials())
    return decision, samplings[decision.selected]


def _render_setup(context: PlanContext, tests: EvaluationSet, cube: Cube) -> RenderSetup:
    """Spectra of a subsample of the pixels and materials, under the lights of the scene."""
    return make_setup(
        cube.reflectance(tests.subsample(FITTED_COLOURS).rgb),
        [light.name for light in tests.lights],
        wavelengths=context.sensor.wavelengths,
        observer_name=context.sensor.observer,
    )


def _fit_sampling(setup: RenderSetup, count: int) -> Sampling:
    """Wavelengths rounded to `DIGITS`, all distinct."""
    sampling = choose(setup, count=count).sampling
    steps = np.arange(count) / 10**DIGITS
    distinct = np.maximum.accumulate(np.round(sampling.wavelengths, DIGITS) - steps) + steps
    return replace(sampling, wavelengths=np.round(distinct, DIGITS))


def _trial(tests: EvaluationSet, cube: Cube, sampling: Sampling) -> Trial:
    wavelengths, count = sampling.wavelengths, len(sampling)
    error = tests.error_of_xyz(sampling.xyz(cube.reflectance(tests.rgb, wavelengths)))
    cost = f"{count} samples per ray"
    return Trial(str(count), count, cost, wavelength_args(wavelengths), {"count": count}, error)
