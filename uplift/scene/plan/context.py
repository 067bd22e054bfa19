"""What candidates are measured on: the scene's own colours and materials, and the best that a cube makes of them."""

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
from uplift.pipeline import build
from uplift.scene.plan.colours import ColourSet, Pixels, SampledColours, sample_colours
from uplift.scene.plan.evaluation import MATERIALS, TEXTURES, ErrorSummary, EvaluationSet, Group
from uplift.scene.plan.scene_file import SceneFile


@dataclass(frozen=True)
class SearchGrid:
    """What is tried, the least first, and how many colours it is tried on.

    ``reference`` is the dim of the cube that is taken for the truth, with the last of the ``coefficients``;
    ``predicting`` and ``confirming`` pixels choose, and judge what was chosen.
    """

    coefficients: tuple[int, ...] = (3, 5, 7, 9, 11, 13, 15, 17)
    dims: tuple[int, ...] = (8, 12, 16, 24, 32, 48, 64, 96)
    reference: int = 128
    predicting: int = 3000
    confirming: int = 8000


@contextlib.contextmanager
def quiet_warnings() -> Iterator[None]:
    """The build that counts says what is to be said of atlas and textures."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        yield


@dataclass(frozen=True, eq=False)
class PlanContext:
    """A scene ready to measure on; ``context`` makes it.

    ``reflectances`` (E, N) and ``materials`` (E, 3) are those of the atlas's entries within the space, and their RGB.
    """

    scene: SceneFile
    effort: SearchGrid
    sensor: Sensor
    atlas: Atlas | None
    reflectances: Array
    materials: Array
    colours: SampledColours
    progress: ProgressCallback

    @property
    def options(self) -> dict[str, Any]:
        """What all cubes of the scene share; entries hold under its lights, and under the one they are built for."""
        scene = self.scene
        return {
            "space": scene.space,
            "illuminant": scene.illuminant,
            "observer": scene.observer,
            "lights": tuple(dict.fromkeys((self.sensor.illuminant, *scene.lights))),
        }

    def cube(self, rgb: Array, **options: Any) -> Cube:
        """A cube for linear RGB (n, 3) alone."""
        with quiet_warnings():
            return build(self.atlas, scene=ColourSet(rgb), **{**self.options, **options})

    def question(self, drawn: Pixels) -> tuple[EvaluationSet, ErrorSummary]:
        """Pixels of the textures, as the best cube has them, and the atlas's materials, as measured.

        And the error of that cube, which only the materials have.
        """
        scene, effort = self.scene, self.effort
        asked = np.concatenate([drawn.rgb, self.materials])
        best = self.cube(asked, dim=effort.reference, coefficients=effort.coefficients[-1])
        answered = best.reflectance(asked)
        groups = [Group(TEXTURES, drawn.rgb, answered[: len(drawn.rgb)], drawn.share)]
        if count := len(self.materials):
            groups.append(Group(MATERIALS, self.materials, self.reflectances, np.full(count, 1 / count)))
        found = EvaluationSet(tuple(groups), scene.light_sources(), scene.quantile)
        return found, found.error(answered)


def prepare_context(scene: SceneFile, effort: SearchGrid, progress: ProgressCallback) -> PlanContext:
    """Reads atlases and textures. Raises `AtlasError`, `TextureError`, `PlanFileError`."""
    sensor = scene.sensor()
    atlas = read_atlas(*scene.atlases) if scene.atlases else None
    measured = resample(atlas or Atlas(), sensor.wavelengths).values
    rgb = sensor.rgb(measured)
    held = sensor.contains(rgb)

    wanted = effort.predicting, effort.confirming
    with quiet_warnings():
        found = sample_colours(scene.textures, sensor, scene.encoding, wanted, progress)
    return PlanContext(
        scene, effort, sensor, atlas, measured[held], np.clip(rgb[held], 0, 1), found, progress
    )
