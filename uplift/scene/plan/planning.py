"""Order of a plan's decisions: coefficients, lattice, wavelengths, storage; then the build and its verification."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.observer import DEFAULT_OBSERVER
from uplift.common.errors import PlanFileError
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.scene.plan.context import PlanContext, SearchGrid, prepare_context
from uplift.scene.plan.decision import Decision
from uplift.scene.plan.evaluation import ErrorSummary, EvaluationSet
from uplift.scene.plan.final_build import FinalBuild, build_final
from uplift.scene.plan.lattice_choice import choose_coefficients, choose_lattice
from uplift.scene.plan.previews import Preview, make_previews
from uplift.scene.plan.representation import choose_representation
from uplift.scene.plan.scene_file import SceneFile
from uplift.scene.plan.storage import Storage, choose_storage
from uplift.scene.plan.wavelengths import choose_wavelengths
from uplift.scene.wavelengths import Sampling
from uplift.viz.format import format_error

BUDGET = {"coefficients": 0.4, "lattice": 0.55, "wavelengths": 0.9, "storage": 1.0, "representation": 0.9}
"""Share of the tolerance that the chain may use up to each decision. What one does not use, the next may.

Errors of independent origin add up like their squares. That leaves 0.4, 0.38, 0.71 and 0.44 of the tolerance to each
decision alone: most to the wavelengths, as every ray pays for them. A representation takes their place.
"""


@dataclass(frozen=True, eq=False)
class Plan:
    """Cube, wavelengths and texture format for a scene, with all measurements.

    Parameters
    ----------
    scene : SceneFile
        The scene file.
    decisions : tuple of Decision
        Decisions in the order in which they were made.
    options : mapping
        Options of `uplift.build`.
    sampling : Sampling
        Wavelengths to render at, the lights there, and the weights of their sum.
    storage : Storage
        Contents of a texture's pixel.
    final_build : FinalBuild
        The cube.
    predicted : ErrorSummary
        Error on the pixels that the decisions were made by.
    confirmed : ErrorSummary
        Error of the cube on other pixels.
    expected_error : float or None
        Mean standard error of the textures' colours, ΔE00 under A: the difference to expect between a measurement of
        such a colour and any answer. None if the cube does not store standard errors.
    previews : tuple of Preview
        Colours of the textures by the plan and by the reference cube.
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
        """Decisions that build upon one another; a representation is an alternative to the wavelengths."""
        return tuple(each for each in self.decisions if each.key != "representation")

    @property
    def within_tolerance(self) -> bool:
        """Whether the confirmed error is within the tolerance."""
        return self.confirmed.quantile <= self.scene.tolerance


def plan(scene: SceneFile, grid: SearchGrid | None = None, progress: ProgressCallback = ignore_progress) -> Plan:
    """Find the smallest sufficient cube, wavelengths and texture format for a scene.

    Parameters
    ----------
    scene : SceneFile
        The scene.
    grid : SearchGrid, optional
        Candidates to try.
    progress : ProgressCallback, optional
        Called with each step.

    Returns
    -------
    Plan
        The decisions and the cube that they lead to.

    Raises
    ------
    PlanFileError
        If even the reference cube misses the tolerance. The hint gives a feasible one.
    AtlasError, TextureError
        If a file cannot be read.
    """
    context = prepare_context(scene, grid or SearchGrid(), progress)
    progress(Progress("reference cube", 0, 1))
    tests, reference_error = context.evaluation_set(context.colours.predicting)
    _check_feasible(scene, reference_error)
    limits = {key: share * scene.tolerance for key, share in BUDGET.items()}

    coefficients = choose_coefficients(context, tests, limits["coefficients"])
    count = int(coefficients.trial.choice["coefficients"])
    lattice = choose_lattice(context, tests, limits["lattice"], count)
    options = {**context.options, **coefficients.trial.choice, **lattice.trial.choice}
    cube = context.cube(tests.rgb, **options)
    wavelengths, sampling = choose_wavelengths(context, tests, limits["wavelengths"], cube)
    pixel = choose_storage(context, tests, limits["storage"], cube, sampling)
    storage = Storage(pixel.trial.choice["as"], pixel.trial.choice["depth"])

    decisions = [coefficients, lattice, wavelengths, pixel]
    if scene.observer == DEFAULT_OBSERVER:  # the only one that representations support
        decisions.append(choose_representation(context, tests, limits["representation"], cube))

    progress(Progress("final build", 0, 1))
    final_build = build_final(context, options)
    progress(Progress("verification", 0, 1))
    confirmed, previews = _confirm(context, final_build, options, sampling, storage)
    return Plan(
        scene=scene,
        decisions=tuple(decisions),
        options=options,
        sampling=sampling,
        storage=storage,
        final_build=final_build,
        predicted=pixel.trial.error,
        confirmed=confirmed,
        expected_error=_expected_error(final_build, tests),
        previews=previews,
    )


def _check_feasible(scene: SceneFile, reference_error: ErrorSummary) -> None:
    worst = reference_error.worst
    if worst.quantile > scene.tolerance:
        raise PlanFileError(
            f"tolerance must be at least the error of the reference cube, ΔE00 {format_error(worst.quantile)} of "
            f"{worst.group} under {worst.light}, got {scene.tolerance:g}",
            code="tolerance-unreachable",
            path=scene.path,
            hint=f"set tolerance = {np.ceil(worst.quantile * 110) / 100:g} or more",
        )


def _confirm(
    context: PlanContext,
    final_build: FinalBuild,
    options: Mapping[str, Any],
    sampling: Sampling,
    storage: Storage,
) -> tuple[ErrorSummary, tuple[Preview, ...]]:
    """Error and previews of the final cube on the second sample of pixels."""
    tests, _ = context.evaluation_set(context.colours.confirming)
    wavelengths = sampling.wavelengths
    spectra = [storage.decoded_reflectance(final_build.cube, tests.groups[0].rgb, wavelengths)]
    if len(context.materials):  # a sparse cube need not have points for the colours of materials
        cube = context.cube(context.materials, **options)
        spectra.append(storage.decoded_reflectance(cube, context.materials, wavelengths))
    xyz = sampling.xyz(np.concatenate(spectra))
    return tests.error_of_xyz(xyz), make_previews(tests, xyz, context.scene.observer)


def _expected_error(final_build: FinalBuild, tests: EvaluationSet) -> float | None:
    textures = tests.groups[0]
    errors = final_build.cube.standard_error(textures.rgb)
    return None if errors is None else float(errors @ textures.weights)
