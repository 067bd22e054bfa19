"""The whole order of a plan: coefficients, lattice, wavelengths, storage, cells; then the whole chain, judged anew."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.observer import DEFAULT_OBSERVER
from uplift.common.errors import PlanFileError
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.scene.plan import lattice_choice
from uplift.scene.plan.context import PlanContext, SearchGrid, prepare_context
from uplift.scene.plan.decision import Decision
from uplift.scene.plan.evaluation import ErrorSummary, EvaluationSet
from uplift.scene.plan.final_build import FinalBuild, build_final
from uplift.scene.plan.previews import Preview, make_previews
from uplift.scene.plan.representation import choose_representation
from uplift.scene.plan.scene_file import SceneFile
from uplift.scene.plan.storage import Storage, choose_storage
from uplift.scene.plan.wavelengths import choose_wavelengths
from uplift.scene.wavelengths import Sampling
from uplift.viz.format import format_error

SHARES = {"coefficients": 0.4, "lattice": 0.55, "wavelengths": 0.9, "storage": 1.0, "representation": 0.9}
"""Of the tolerance, that the chain may have used up after each decision. What one leaves, the next may use.

Errors of different origin add up about as their squares do, so that these give wavelengths, which each ray pays for,
the most: 0.4, 0.38, 0.71 and 0.44 of the tolerance to each by itself. A representation takes the place of wavelengths.
"""


@dataclass(frozen=True, eq=False)
class Plan:
    """What to build, store and render at, and what that costs.

    Parameters
    ----------
    decisions : in the order they were taken.
    options : of `uplift.build`.
    sampling : wavelengths to render at, the lights there, and weights to sum with.
    built : the cube as it was built in the end.
    predicted : the error by the pixels that chose; ``confirmed`` that of other pixels, by what was built.
    expected : ΔE00 under A that measurements of such colours may differ by from any answer; None where nobody knows.
    sights : colours of the textures as they would be seen, from the plan and from the best cube.
    """

    scene: SceneFile
    decisions: tuple[Decision, ...]
    options: Mapping[str, Any]
    sampling: Sampling
    storage: Storage
    final_build: FinalBuild
    predicted: ErrorSummary
    confirmed: ErrorSummary
    expected_error: float | None
    previews: tuple[Preview, ...]

    @property
    def chain(self) -> tuple[Decision, ...]:
        """Those that build upon one another; a representation stands beside the wavelengths."""
        return tuple(each for each in self.decisions if each.key != "representation")

    @property
    def within_tolerance(self) -> bool:
        """Whether what was confirmed is within the tolerance."""
        return self.confirmed.quantile <= self.scene.tolerance


def plan(
    scene: SceneFile, effort: SearchGrid | None = None, progress: ProgressCallback = ignore_progress
) -> Plan:
    """The least that will do.

    Raises
    ------
    PlanFileError : a tolerance that nothing measured comes within; tells the best.
    AtlasError, TextureError : what cannot be read.
    """
    found = prepare_context(scene, effort or SearchGrid(), progress)
    progress(Progress("the best cube there is", 0, 1))
    question, best = found.question(found.colours.predicting)
    _check_reachable(scene, best)
    limits = {key: share * scene.tolerance for key, share in SHARES.items()}

    coefficients = lattice_choice.choose_coefficients(found, question, limits["coefficients"])
    count = int(coefficients.trial.choice["coefficients"])
    lattice = lattice_choice.choose_lattice(found, question, limits["lattice"], count)
    options = {**found.options, **coefficients.trial.choice, **lattice.trial.choice}
    cube = found.cube(question.rgb, **options)
    fewest, sampling = choose_wavelengths(found, question, limits["wavelengths"], cube)
    pixel = choose_storage(found, question, limits["storage"], cube, sampling)
    held = Storage(pixel.trial.choice["as"], pixel.trial.choice["depth"])

    decisions = [coefficients, lattice, fewest, pixel]
    if scene.observer == DEFAULT_OBSERVER:  # the only one that representations know
        decisions.append(choose_representation(found, question, limits["representation"], cube))

    progress(Progress("building it", 0, 1))
    made = build_final(found, options)
    progress(Progress("confirming", 0, 1))
    confirmed, shown = _confirmed(found, made, options, sampling, held)
    return Plan(
        scene=scene,
        decisions=tuple(decisions),
        options=options,
        sampling=sampling,
        storage=held,
        final_build=made,
        predicted=pixel.trial.error,
        confirmed=confirmed,
        previews=shown,
        expected_error=_expected(made, question),
    )


def _check_reachable(scene: SceneFile, best: ErrorSummary) -> None:
    if best.quantile > scene.tolerance:
        worst = best.worst
        raise PlanFileError(
            f"no cube comes within ΔE00 {scene.tolerance:g}: the best measured has {format_error(best.quantile)}, "
            f"of {worst.group} under {worst.light}",
            path=scene.path,
            hint=f"set tolerance = {np.ceil(best.quantile * 110) / 100:g} or more",
        )


def _confirmed(
    found: PlanContext, made: FinalBuild, options: Mapping[str, Any], sampling: Sampling, held: Storage
) -> tuple[ErrorSummary, tuple[Preview, ...]]:
    """By other pixels, and more of them, asked of the cube that was built."""
    question, _ = found.question(found.colours.confirming)
    answered = [held.read_back(made.cube, question.groups[0].rgb, sampling.wavelengths)]
    if len(found.materials):  # the textures may not have their colours, and the cube no points for them
        cube = found.cube(found.materials, **options)
        answered.append(held.read_back(cube, found.materials, sampling.wavelengths))
    xyz = sampling.xyz(np.concatenate(answered))
    return question.seen(xyz), make_previews(question, xyz, found.scene.observer)


def _expected(made: FinalBuild, question: EvaluationSet) -> float | None:
    textures = question.groups[0]
    errors = made.cube.standard_error(textures.rgb)
    return None if errors is None else float(errors @ textures.weights)
