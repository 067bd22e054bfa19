"""Trial cubes for the colours of a scene, and the errors of candidates on test
colours.
"""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

import numpy as np

from uplift.atlas.atlas import Atlas
from uplift.atlas.sources import read_atlas
from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning
from uplift.common.progress import ProgressCallback
from uplift.extras.papers.wavelengths.sampling import make_setup
from uplift.extras.scene.plan.candidates import Candidate
from uplift.extras.scene.plan.evaluation import EvaluationSet
from uplift.extras.scene.plan.files import SceneFile
from uplift.extras.texture.scene_colours import (
    ColourSet,
    Images,
    PixelSample,
    SampledColours,
    sample_colours,
)
from uplift.fit.problem import Problem
from uplift.lookup.cube import Cube
from uplift.models.model import Model
from uplift.pipeline.entries import MeasuredEntries, split_by_gamut
from uplift.pipeline.options import Options
from uplift.pipeline.stages import Learnt, build_stages, learn, problem_of


@dataclass(frozen=True, eq=False)
class SceneContents:
    """What the files of a scene hold: pixels of its textures, its atlas, and the
    entries of the atlas within the RGB space.
    """

    scene: SceneFile
    colours: SampledColours
    atlas: Atlas | None
    materials: MeasuredEntries

    @classmethod
    def read(
        cls, scene: SceneFile, sizes: tuple[int, int], progress: ProgressCallback
    ) -> "SceneContents":
        """Read textures, of which samples have these sizes, and atlases. Raises
        `AtlasError` and `TextureError`.
        """
        sensor = scene.sensor()
        atlas = read_atlas(*scene.atlases) if scene.atlases else None
        # `uplift build --plan` repeats the warnings, also those of trial builds.
        with warnings.catch_warnings(action="ignore", category=UpliftWarning):
            materials, _ = split_by_gamut(atlas or Atlas(), sensor)
        images = Images(scene.textures, scene.encoding)
        colours = sample_colours(images, sensor, sizes, progress)
        return cls(scene, colours, atlas, materials)


@dataclass(frozen=True, eq=False)
class Builder:
    """Builds sparse cubes, which share what they learn from an atlas."""

    atlas: Atlas | None
    learnt: dict[tuple[Model, Model], Learnt] = field(default_factory=dict)

    def cube(self, rgb: Array, options: Options) -> Cube:
        """Build a cube for linear RGB (n, 3)."""
        with warnings.catch_warnings(action="ignore", category=UpliftWarning):
            options, problem = problem_of(options)
            scene = ColourSet(rgb)
            return build_stages(
                self.atlas, options, problem, scene=scene, learn=self._learn
            )

    def _learn(self, problem: Problem, entry_model: Model, *rest: Any) -> Learnt:
        models = problem.model, entry_model
        if models not in self.learnt:
            self.learnt[models] = learn(problem, entry_model, *rest)
        return self.learnt[models]


@dataclass(frozen=True, eq=False)
class Trial:
    """Test colours: pixels with the spectra of a reference cube, and materials as
    measured. Cubes are built for them once.
    """

    builder: Builder
    tests: EvaluationSet
    cubes: dict[Options, Cube] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        contents: SceneContents,
        sample: PixelSample,
        builder: Builder,
        reference: Options,
    ) -> "Trial":
        """Build the reference cube for pixels and for the materials of a scene."""
        scene = contents.scene
        sensor = scene.sensor()
        materials = contents.materials
        rgb = np.concatenate([sample.rgb, materials.rgb])
        cube = builder.cube(rgb, reference)
        setup = make_setup(
            np.concatenate([cube.reflectance(sample.rgb), materials.reflectances]),
            scene.lights,
            wavelengths=sensor.wavelengths,
            observer_name=sensor.observer,
        )
        pixels, count = len(sample.rgb), len(materials.rgb)
        weights = [sample.share]
        groups = {"textures": slice(0, pixels)}
        if count:
            weights.append(np.full(count, 1 / count))
            groups["materials"] = slice(pixels, pixels + count)
        tests = EvaluationSet(
            cube, setup, rgb, np.concatenate(weights), groups, scene.quantile
        )
        return cls(builder, tests, {reference: cube})

    def cube(self, options: Options) -> Cube:
        """Return a cube for the test colours."""
        if options not in self.cubes:
            self.cubes[options] = self.builder.cube(self.tests.rgb, options)
        return self.cubes[options]

    def xyz(self, options: Options) -> Array:
        """XYZ (K, n, 3) of the spectra of a cube."""
        return self.tests.xyz(self.cube(options).reflectance(self.tests.rgb))

    def measure(
        self, options: Options | None, candidates: Sequence[Candidate], matrices: Array
    ) -> list[Candidate]:
        """Measure the errors of candidates that share a cube, or need none; without
        spectra XYZ are those of ``matrices`` (K, 3, 3).
        """
        tests = self.tests
        cube = tests.reference if options is None else self.cube(options)
        needed = {
            candidate.rendering: candidate.rendering.sampling.wavelengths
            for candidate in candidates
            if candidate.rendering is not None
        }
        nm = np.concatenate([[], *needed.values()])
        ends = np.cumsum([0, *map(len, needed.values())])
        columns = dict(zip(needed, map(slice, ends, ends[1:]), strict=False))
        spectra = cache(lambda pixel: pixel.decoded(cube, tests.rgb, nm))

        def measured(candidate: Candidate) -> Candidate:
            rendering = candidate.rendering
            if rendering is None:
                xyz = tests.rgb @ matrices.mT
            else:
                reflectances = spectra(candidate.pixel)[:, columns[rendering]]
                xyz = rendering.sampling.xyz(reflectances)
            return replace(candidate, error=tests.error(xyz))

        return list(map(measured, candidates))
