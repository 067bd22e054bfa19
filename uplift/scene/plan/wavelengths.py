"""The fewest wavelengths that show the scene's spectra under its lights, chosen for these."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from uplift.common.progress import Progress
from uplift.lookup import Cube
from uplift.scene.plan.context import PlanContext
from uplift.scene.plan.decision import Decision, Trial, decide
from uplift.scene.plan.evaluation import EvaluationSet
from uplift.scene.wavelengths import RenderSetup, Sampling, choose, make_setup

COUNTS = (3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20, 24, 32, 40)
"""After the last, all that there are."""
FITTED = 200
"""Colours of the textures, and as many materials, that wavelengths are chosen for; all are judged."""
DIGITS = 2
"""Of a wavelength in nm: what can be typed is what is measured."""


def choose_wavelengths(
    context: PlanContext, question: EvaluationSet, limit: float, cube: Cube
) -> tuple[Decision, Sampling]:
    """What the cube answers, seen at few wavelengths; one set of weights serves all lights."""
    setting = _setting(context, question, cube)
    tried: list[Sampling] = []

    def trials() -> Iterator[Trial]:
        for count in COUNTS:
            context.progress(Progress(f"{count} wavelengths", len(tried), len(COUNTS) + 1))
            tried.append(_chosen(setting, count))
            yield _trial(question, cube, tried[-1])
        tried.append(Sampling(setting.wavelengths, setting.cmfs, setting.lights, setting.powers))
        yield _trial(question, cube, tried[-1])

    found = decide("wavelengths", "Wavelengths", "wavelengths", limit, trials())
    return found, tried[found.taken]


def format_wavelengths(sampling: Sampling) -> str:
    """412.5,455,… nm."""
    return ",".join(f"{wavelength:g}" for wavelength in sampling.wavelengths)


def _setting(context: PlanContext, question: EvaluationSet, cube: Cube) -> RenderSetup:
    """Answers for pixels that stand for as many others each, and for the materials."""
    return make_setup(
        cube.reflectance(question.thinned(FITTED).rgb),
        [light.name for light in question.lights],
        wavelengths=context.sensor.wavelengths,
        observer_name=context.sensor.observer,
    )


def _chosen(setting: RenderSetup, count: int) -> Sampling:
    """Wavelengths to a few digits, no two the same."""
    found = choose(setting, count=count).sampling
    least = np.arange(count) / 10**DIGITS
    apart = np.maximum.accumulate(np.round(found.wavelengths, DIGITS) - least) + least
    return replace(found, wavelengths=np.round(apart, DIGITS))


def _trial(question: EvaluationSet, cube: Cube, sampling: Sampling) -> Trial:
    at, count = sampling.wavelengths, len(sampling)
    error = question.seen(sampling.xyz(cube.reflectance(question.rgb, at)))
    told = f"{count} samples a ray"
    return Trial(
        str(count), count, told, f"--wavelengths {format_wavelengths(sampling)}", {"count": count}, error
    )
