"""Order of a plan's decisions: coefficients, lattice, wavelengths, storage; then the build and its verification."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.observer import DEFAULT_OBSERVER
from uplift.common.errors import PlanFileError
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.io.scene_colours import Images
from uplift.lookup import Cube
from uplift.pipeline.build import build
from uplift.scene.plan.context import PlanContext, SearchGrid, prepare_context, quiet_warnings
from uplift.scene.plan.decisions import (
    Storage,
    choose_coefficients,
    choose_lattice,
    choose_representation,
    choose_storage,
    choose_wavelengths,
)
from uplift.scene.plan.evaluation import Decision, ErrorSummary, EvaluationSet, Preview, make_previews
from uplift.scene.plan.scene_file import SceneFile
from uplift.scene.wavelengths import Sampling
from uplift.viz.format import format_error

BUDGET = {"coefficients": 0.4, "lattice": 0.55, "wavelengths": 0.9, "storage": 1.0, "representation": 0.9}
"""Share of the tolerance that the chain may use up to each decision. What one does not use, the next may.

Errors of independent origin add up like their squares. That leaves 0.4, 0.38, 0.71 and 0.44 of the tolerance to each
decision alone: most to the wavelengths, as every ray pays for them. A representation takes their place.
"""


MIN_SAVING = 1e6
"""Bytes that a sparse cube must save, as it cannot answer other colours."""


@dataclass(frozen=True, eq=False)
class FinalBuild:
    """The planned cube, the bytes of its file, and the CPU time of the build.

    ``full_size`` and ``sparse_size`` are the bytes with all cells, and with those of the textures alone.
    """

    cube: Cube
    size: int
    seconds: float
    full_size: float
    sparse_size: float

    @property
    def is_sparse(self) -> bool:
        """Whether the cube has only the cells of the textures."""
        return self.cube.data.complete_cells is not None

    @property
    def points(self) -> int:
        """Number of lattice points."""
        return int(self.cube.data.points.present.sum())


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
    worst = reference_error.worst
    if worst.quantile > scene.tolerance:
        raise PlanFileError(
            f"tolerance must be at least the error of the reference cube, ΔE00 {format_error(worst.quantile)} of "
            f"{worst.group} under {worst.light}, got {scene.tolerance:g}",
            path=scene.path,
            hint=f"set tolerance = {np.ceil(worst.quantile * 110) / 100:g} or more",
        )
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


def build_final(context: PlanContext, options: Mapping[str, Any]) -> FinalBuild:
    """Build the cube for the textures, or with all cells unless that saves enough, with the warnings of `build`."""
    scene = context.scene
    cube, seconds = _timed_build(context, options, Images(scene.textures, scene.encoding))
    sparse_size = _file_size(cube)
    full_size = sparse_size * cube.data.lattice.size / int(cube.data.points.present.sum())
    if full_size - sparse_size >= MIN_SAVING:
        return FinalBuild(cube, sparse_size, seconds, full_size, sparse_size)
    with quiet_warnings():  # the sparse build has issued all of them
        cube, seconds = _timed_build(context, options)
    size = _file_size(cube)
    return FinalBuild(cube, size, seconds, size, sparse_size)


def _timed_build(context: PlanContext, options: Mapping[str, Any], scene: Images | None = None) -> tuple[Cube, float]:
    begin = time.process_time()
    cube = build(context.atlas, scene=scene, **options)
    return cube, time.process_time() - begin


def _file_size(cube: Cube) -> int:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.uplift"
        cube.save(path)
        return path.stat().st_size


def _confirm(
    context: PlanContext, final_build: FinalBuild, options: Mapping[str, Any], sampling: Sampling, storage: Storage
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
