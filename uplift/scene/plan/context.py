"""Inputs that all candidates of a plan share: the scene's colours and materials, and cubes to evaluate."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from uplift.atlas import Atlas, read_atlas, resample
from uplift.colorimetry import Sensor
from uplift.colorimetry.observer import AXES
from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning
from uplift.common.progress import ProgressCallback
from uplift.fit.problem import Problem
from uplift.io.scene_colours import ColourSet, Images, PixelSample, SampledColours, sample_colours
from uplift.lookup import Cube
from uplift.models import Moments
from uplift.models.model import Model
from uplift.pipeline.build import Learnt, build_stages, learn, problem_of
from uplift.pipeline.options import Options
from uplift.scene.plan.candidates import CubeChoice
from uplift.scene.plan.evaluation import MATERIALS, TEXTURES, EvaluationSet
from uplift.scene.plan.scene_file import SceneFile

MODELS: Mapping[str, tuple[int, ...]] = {
    "none": (3, 5, 7, 9, 11, 13, 15, 17),
    "vision": (5, 7, 9, 11),
    "colour": (3, 5, 7, 9),
}
"""Numbers of coefficients by warp: warps are for few."""


@dataclass(frozen=True)
class SearchGrid:
    """Candidates, in ascending order, and sizes of the pixel samples.

    ``models`` are numbers of coefficients of moments by warp. ``samples`` are numbers of wavelengths, which other
    representations are compared with if ``others``. The reference has the last number of coefficients without a warp,
    and ``reference`` nodes along each axis. Candidates are chosen by ``predicting`` pixels and verified on
    ``confirming`` ones.
    """

    models: Mapping[str, tuple[int, ...]] = field(default_factory=lambda: MODELS)
    dims: tuple[int, ...] = (8, 12, 16, 24, 32, 48, 64, 96)
    axes: tuple[str, ...] = AXES
    samples: tuple[int, ...] = (3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20)
    others: bool = True
    reference: int = 96
    predicting: int = 1500
    confirming: int = 4000

    @classmethod
    def quick(cls) -> "SearchGrid":
        """Fewer candidates and pixels: seconds."""
        models, dims, samples = {"none": (5, 9, 13, 17)}, (8, 16, 32, 48), (3, 5, 6, 7, 8, 10)
        return cls(models, dims, AXES[:1], samples, others=False, reference=64, predicting=400, confirming=1000)


@dataclass(frozen=True, eq=False)
class PlanContext:
    """A scene with its files read: pixels of the textures, and the atlas entries within the RGB space of the sensor.

    ``reflectances`` (E, N) are those of the entries, ``materials`` (E, 3) their linear RGB.
    """

    scene: SceneFile
    grid: SearchGrid
    sensor: Sensor
    atlas: Atlas | None
    reflectances: Array
    materials: Array
    colours: SampledColours
    progress: ProgressCallback
    learnt: dict[tuple[Model, Model], Learnt] = field(default_factory=dict)
    """What cubes of the same models share: entries and prior."""

    @property
    def options(self) -> dict[str, Any]:
        """Options that all cubes of the scene have in common.

        Entries hold under the scene's lights, and under the illuminant of the RGB space.
        """
        scene = self.scene
        return {
            "space": scene.space,
            "illuminant": scene.illuminant,
            "observer": scene.observer,
            "lights": tuple(dict.fromkeys((self.sensor.illuminant, *scene.lights))),
        }

    @property
    def reference(self) -> CubeChoice:
        """Options of the reference cube."""
        return CubeChoice(Moments.name, self.grid.models["none"][-1], "none", self.grid.reference, "srgb")

    def cube(self, rgb: Array, choice: CubeChoice) -> Cube:
        """Build a sparse cube for linear RGB (n, 3)."""

        def shared(problem: Problem, entry_model: Model, *rest: Any) -> Learnt:
            models = problem.model, entry_model
            if models not in self.learnt:
                self.learnt[models] = learn(problem, entry_model, *rest)
            return self.learnt[models]

        # The final build repeats the warnings of trial builds.
        with warnings.catch_warnings(action="ignore", category=UpliftWarning):
            options = Options(**self.options, **choice.options)
            options, problem = problem_of(options, options.observer, options.solver)
            return build_stages(self.atlas, options, problem, scene=ColourSet(rgb), learn=shared)

    def evaluation_set(self, sample: PixelSample) -> tuple[EvaluationSet, Cube]:
        """Test colours, with the spectra of the reference cube or of the measurement, and this cube."""
        rgb = np.concatenate([sample.rgb, self.materials])
        reference = self.cube(rgb, self.reference)
        spectra = np.concatenate([reference.reflectance(sample.rgb), self.reflectances])
        pixels, count = len(sample.rgb), len(self.materials)
        weights = np.concatenate([sample.share, np.full(count, 1 / max(count, 1))])
        groups = {TEXTURES: slice(0, pixels)} | ({MATERIALS: slice(pixels, pixels + count)} if count else {})
        lights = self.scene.light_sources()
        return EvaluationSet(rgb, spectra, weights, groups, lights, self.scene.quantile), reference


def prepare_context(scene: SceneFile, grid: SearchGrid, progress: ProgressCallback) -> PlanContext:
    """Read atlases and textures. Raises `AtlasError`, `TextureError`, `PlanFileError`."""
    sensor = scene.sensor()
    atlas = read_atlas(*scene.atlases) if scene.atlases else None
    reflectances = resample(atlas or Atlas(), sensor.wavelengths).values
    rgb = sensor.rgb(reflectances)
    inside = sensor.contains(rgb)
    images = Images(scene.textures, scene.encoding)
    colours = sample_colours(images, sensor, (grid.predicting, grid.confirming), progress)
    materials = np.clip(rgb[inside], 0, 1)
    return PlanContext(scene, grid, sensor, atlas, reflectances[inside], materials, colours, progress)
