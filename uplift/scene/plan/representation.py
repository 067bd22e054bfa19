"""Choice of a representation of spectra for renderers that do not use the plan's wavelengths."""

from __future__ import annotations

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
from uplift.scene.plan.arguments import compare_command
from uplift.scene.plan.context import PlanContext
from uplift.scene.plan.decision import Decision, Trial, decide
from uplift.scene.plan.evaluation import WORST_DELTA_E, EvaluationSet
from uplift.scene.representations import all_representations
from uplift.scene.representations.samples import STEP, Representation, wavelengths, xyz_weights

COLOURS = 200
"""Colours of each group that representations are evaluated on."""


@dataclass(frozen=True, eq=False)
class _DenseTests:
    """Test colours on the 1 nm grid of representations.

    ``powers`` (L, 401) of the lights, ``surfaces`` (n, 401) of the cube.
    """

    tests: EvaluationSet
    powers: Array
    surfaces: Array

    def trial(self, representation: Representation, cli_args: str) -> Trial:
        """Error of the products of every light with every surface."""
        surfaces = representation.encode_surface(self.surfaces)
        floats = float(representation.storage(surfaces).mean())
        light_floats = float(representation.storage(representation.encode_light(self.powers)).mean())
        error = self.tests.error_of_xyz([self._xyz(representation, power, surfaces) for power in self.powers])
        cost = f"{floats:.4g} floats per surface, {light_floats:.4g} per light"
        choice = {"representation": representation.name, "family": representation.family}
        return Trial(representation.name, floats + light_floats / 1000, cost, cli_args, choice, error)

    def _xyz(self, representation: Representation, power: Array, surfaces: Any) -> Array:
        light = representation.encode_light(np.broadcast_to(power, (len(self.surfaces), len(power))))
        try:
            return representation.xyz(representation.multiply(light, surfaces))
        except UpliftError:
            return np.full((len(self.surfaces), 3), WORST_DELTA_E)


def choose_representation(context: PlanContext, tests: EvaluationSet, limit: float, cube: Cube) -> Decision:
    """Choose by the floats per surface, then by those per light."""
    dense = _dense_tests(context, tests, cube)
    cli_args = compare_command(context.scene, limit)

    def trials() -> Iterator[Trial]:
        representations = all_representations(dense.powers, dense.surfaces)
        measured = []
        for done, each in enumerate(representations):
            context.progress(Progress(f"representation {each.name}", done, len(representations)))
            measured.append(dense.trial(each, cli_args))
        yield from sorted(measured, key=lambda trial: trial.cost)

    return decide("representation", "Alternative representation", "floats per surface", limit, trials())


def _dense_tests(context: PlanContext, tests: EvaluationSet, cube: Cube) -> _DenseTests:
    few, nm = tests.subsample(COLOURS), wavelengths()
    powers = np.stack([observer.illuminant_spd(light.name, step=STEP) for light in few.lights])
    powers = powers / (powers @ xyz_weights()[:, 1:2])
    groups = tuple(
        replace(group, reflectances=_interpolate(nm, context.sensor.wavelengths, group.reflectances))
        for group in few.groups
    )
    lights = tuple(
        Light(light.name, (power[:, None] * xyz_weights()).T) for light, power in zip(few.lights, powers, strict=True)
    )
    return _DenseTests(EvaluationSet(groups, lights, few.quantile), powers, cube.reflectance(few.rgb, nm))


def _interpolate(nm: Array, wavelengths: Array, spectra: Array) -> Array:
    return np.stack([np.interp(nm, wavelengths, spectrum) for spectrum in spectra])
