"""Inputs that all decisions of a plan share: the scene's colours and materials, and cubes to evaluate."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.atlas import Atlas, read_atlas, resample
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import UpliftWarning
from uplift.common.progress import ProgressCallback
from uplift.lookup import Cube
from uplift.pipeline.build import build
from uplift.scene.plan.colours import ColourSet, PixelSample, SampledColours, sample_colours
from uplift.scene.plan.evaluation import MATERIALS, TEXTURES, ColourGroup, ErrorSummary, EvaluationSet
from uplift.scene.plan.scene_file import SceneFile


@dataclass(frozen=True)
class SearchGrid:
    """Candidates of the cube, and sizes of the pixel samples.

    Parameters
    ----------
    coefficients : tuple of int
        Numbers of coefficients to try, ascending.
    dims : tuple of int
        Dims to try.
    reference : int
        Dim of the reference cube, which has the last of the ``coefficients``.
    predicting, confirming : int
        Pixels to choose candidates by, and to verify the result on.
    """

    coefficients: tuple[int, ...] = (3, 5, 7, 9, 11, 13, 15, 17)
    dims: tuple[int, ...] = (8, 12, 16, 24, 32, 48, 64, 96)
    reference: int = 128
    predicting: int = 3000
    confirming: int = 8000


@contextlib.contextmanager
def quiet_warnings() -> Iterator[None]:
    """Suppress warnings of trial builds; the final build repeats them."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        yield


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

    def cube(self, rgb: Array, **options: Any) -> Cube:
        """Build a sparse cube for linear RGB (n, 3)."""
        with quiet_warnings():
            return build(self.atlas, scene=ColourSet(rgb), **{**self.options, **options})

    def evaluation_set(self, sample: PixelSample) -> tuple[EvaluationSet, ErrorSummary]:
        """Test colours with the reference cube's spectra of pixels and the measured spectra of materials.

        Also the error of the reference cube, which is that of the materials: pixels have none by definition.
        """
        rgb = np.concatenate([sample.rgb, self.materials])
        reference = self.cube(rgb, dim=self.grid.reference, coefficients=self.grid.coefficients[-1])
        spectra = reference.reflectance(rgb)
        groups = [ColourGroup(TEXTURES, sample.rgb, spectra[: len(sample.rgb)], sample.share)]
        if count := len(self.materials):
            weights = np.full(count, 1 / count)
            groups.append(ColourGroup(MATERIALS, self.materials, self.reflectances, weights))
        tests = EvaluationSet(tuple(groups), self.scene.light_sources(), self.scene.quantile)
        return tests, tests.error(spectra)


def prepare_context(scene: SceneFile, grid: SearchGrid, progress: ProgressCallback) -> PlanContext:
    """Read atlases and textures. Raises `AtlasError`, `TextureError`, `PlanFileError`."""
    sensor = scene.sensor()
    atlas = read_atlas(*scene.atlases) if scene.atlases else None
    reflectances = resample(atlas or Atlas(), sensor.wavelengths).values
    rgb = sensor.rgb(reflectances)
    inside = sensor.contains(rgb)
    with quiet_warnings():
        sizes = grid.predicting, grid.confirming
        colours = sample_colours(scene.textures, sensor, scene.encoding, sizes, progress)
    materials = np.clip(rgb[inside], 0, 1)
    return PlanContext(scene, grid, sensor, atlas, reflectances[inside], materials, colours, progress)
