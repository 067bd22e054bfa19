"""How a renderer may hold spectra that does not take the plan's wavelengths: the cheapest representation."""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.common.errors import UpliftError
from uplift.common.progress import Progress
from uplift.lookup import Cube
from uplift.scene.plan.context import PlanContext
from uplift.scene.plan.decision import Decision, Trial, decide
from uplift.scene.plan.evaluation import WORST_DELTA_E, EvaluationSet
from uplift.scene.representations.dense import STEP, wavelengths, xyz_weights
from uplift.scene.representations.registry import all_representations
from uplift.scene.representations.representation import Representation

COLOURS = 200
"""Of the textures, and as many materials, that representations are judged by."""


@dataclass(frozen=True, eq=False)
class Dense:
    """A question on the dense grid that representations are made from.

    ``powers`` (L, 401) of the lights, ``surfaces`` (n, 401) that the cube answers with.
    """

    question: EvaluationSet
    powers: Array
    surfaces: Array

    def trial(self, representation: Representation, typed: str) -> Trial:
        """What products of every light with every surface look like."""
        held = representation.encode_surface(self.surfaces)
        floats = float(representation.storage(held).mean())
        of_light = float(representation.storage(representation.encode_light(self.powers)).mean())
        error = self.question.seen([self._seen(representation, power, held) for power in self.powers])
        told = f"{floats:.4g} floats a surface, {of_light:.4g} a light"
        choice = {"representation": representation.name, "family": representation.family}
        return Trial(representation.name, floats + of_light / 1000, told, typed, choice, error)

    def _seen(self, representation: Representation, power: Array, held: Any) -> Array:
        light = representation.encode_light(np.broadcast_to(power, (len(self.surfaces), len(power))))
        try:
            return representation.xyz(representation.multiply(light, held))
        except UpliftError:
            return np.full((len(self.surfaces), 3), WORST_DELTA_E)


def choose_representation(
    context: PlanContext, question: EvaluationSet, limit: float, cube: Cube
) -> Decision:
    """By the numbers that a surface takes, then by those of a light; of the sizes that 'uplift compare' compares."""
    dense = _dense(context, question, cube)
    scene = context.scene
    words = [word for atlas in scene.atlases for word in ("--atlas", str(atlas))]
    words += [word for light in scene.lights for word in ("--light", light)]
    typed = shlex.join(["uplift", "compare", *words, "--target", f"{limit:.3g}"])

    def trials() -> Iterator[Trial]:
        every = all_representations(dense.powers, dense.surfaces)
        made = []
        for done, each in enumerate(every):
            context.progress(Progress(f"representation {each.name}", done, len(every)))
            made.append(dense.trial(each, typed))
        yield from sorted(made, key=lambda trial: trial.cost)

    return decide("representation", "A representation instead", "floats a surface", limit, trials())


def _dense(context: PlanContext, question: EvaluationSet, cube: Cube) -> Dense:
    few, nm = question.thinned(COLOURS), wavelengths()
    powers = np.stack([observer.illuminant_spd(light.name, step=STEP) for light in few.lights])
    powers = powers / (powers @ xyz_weights()[:, 1:2])
    finer = [
        np.stack([np.interp(nm, context.sensor.wavelengths, row) for row in each.wanted])
        for each in few.groups
    ]
    groups = tuple(replace(each, wanted=wanted) for each, wanted in zip(few.groups, finer, strict=True))
    named = zip(few.lights, powers, strict=True)
    lights = tuple(Light(light.name, (power[:, None] * xyz_weights()).T) for light, power in named)
    return Dense(EvaluationSet(groups, lights, few.share), powers, cube.reflectance(few.rgb, nm))
