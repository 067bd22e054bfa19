"""Order of a plan's decisions: coefficients, lattice, wavelengths, storage; then the build and its verification."""

import tempfile
import time
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uplift.common.errors import PlanFileError, UpliftWarning
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.io.scene_colours import Images
from uplift.lookup import Cube
from uplift.pipeline.build import build
from uplift.scene.plan import decisions
from uplift.scene.plan.context import PlanContext, SearchGrid, prepare_context
from uplift.scene.plan.decisions import Storage
from uplift.scene.plan.evaluation import Decision, ErrorSummary, Trial, decide
from uplift.scene.plan.scene_file import SceneFile
from uplift.scene.wavelengths import Sampling
from uplift.viz.format import format_error

DECISIONS = {
    "coefficients": ("Coefficients per spectrum", "coefficients", 0.4),
    "lattice": ("Lattice", "lattice points that the textures need", 0.55),
    "wavelengths": ("Wavelengths", "wavelengths", 0.9),
    "storage": ("Texture pixel", "bytes per pixel", 1.0),
}
"""Title, unit of the cost, and share of the tolerance that the chain may use up to each decision.

Errors of independent origin add up like their squares. That leaves 0.4, 0.38, 0.71 and 0.44 of the tolerance to each
decision alone: most to the wavelengths, as every ray pays for them.
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

    def decided(key: str, trials: Iterable[Trial]) -> Decision:
        title, unit, share = DECISIONS[key]
        return decide(key, title, unit, share * scene.tolerance, trials)

    coefficients = decided("coefficients", decisions.coefficient_trials(context, tests))
    count = int(coefficients.trial.choice["coefficients"])
    lattice = decided("lattice", decisions.lattice_trials(context, tests, count))
    options = {**context.options, **coefficients.trial.choice, **lattice.trial.choice}
    cube = context.cube(tests.rgb, **options)
    wavelengths = decided("wavelengths", decisions.wavelength_trials(context, tests, cube))
    sampling: Sampling = wavelengths.trial.result
    pixel = decided("storage", decisions.storage_trials(context, tests, cube, sampling))
    storage: Storage = pixel.trial.result

    progress(Progress("final build", 0, 1))
    final_build = build_final(context, options)
    progress(Progress("verification", 0, 1))
    # The chain on the second sample of pixels.
    confirming, _ = context.evaluation_set(context.colours.confirming)
    nm, planned = sampling.wavelengths, final_build.cube
    spectra = [storage.decoded_reflectance(planned, confirming.groups[0].rgb, nm)]
    if len(context.materials):  # a sparse cube need not have points for the colours of materials
        of_materials = context.cube(context.materials, **options)
        spectra.append(storage.decoded_reflectance(of_materials, context.materials, nm))
    xyz = sampling.xyz(np.concatenate(spectra))
    textures = tests.groups[0]
    expected_error = planned.standard_error(textures.rgb)
    return Plan(
        scene=scene,
        decisions=(coefficients, lattice, wavelengths, pixel),
        options=options,
        sampling=sampling,
        storage=storage,
        final_build=final_build,
        predicted=pixel.trial.error,
        confirmed=confirming.error_of_xyz(xyz),
        expected_error=None if expected_error is None else float(expected_error @ textures.weights),
    )


def build_final(context: PlanContext, options: Mapping[str, Any]) -> FinalBuild:
    """Build the cube for the textures, or with all cells unless that saves enough, with the warnings of `build`."""
    scene = context.scene
    cube, seconds, sparse_size = _build(context, options, Images(scene.textures, scene.encoding))
    full_size = sparse_size * cube.data.lattice.size / int(cube.data.points.present.sum())
    if full_size - sparse_size >= MIN_SAVING:
        return FinalBuild(cube, sparse_size, seconds, full_size, sparse_size)
    with warnings.catch_warnings(action="ignore", category=UpliftWarning):  # the sparse build has issued all of them
        cube, seconds, size = _build(context, options)
    return FinalBuild(cube, size, seconds, size, sparse_size)


def _build(context: PlanContext, options: Mapping[str, Any], scene: Images | None = None) -> tuple[Cube, float, int]:
    """Build a cube; also return the CPU time in seconds, and the bytes of its file."""
    begin = time.process_time()
    cube = build(context.atlas, scene=scene, **options)
    seconds = time.process_time() - begin
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.uplift"
        cube.save(path)
        return cube, seconds, path.stat().st_size
