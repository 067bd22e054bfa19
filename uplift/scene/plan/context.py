"""Inputs that all decisions of a plan share: the scene's colours and materials, and cubes to evaluate."""

import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uplift.atlas import Atlas, read_atlas, resample
from uplift.colorimetry import Sensor
from uplift.common.arrays import Array, Mask
from uplift.common.errors import PlanFileError, UpliftWarning
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.io.scene_colours import Images, cells_touched
from uplift.io.texture.colours import coloured_parts
from uplift.io.texture.image import open_image
from uplift.lattice import EntryBoxes
from uplift.lookup import Cube
from uplift.pipeline.build import build
from uplift.scene.plan.evaluation import MATERIALS, TEXTURES, ColourGroup, ErrorSummary, EvaluationSet
from uplift.scene.plan.scene_file import SceneFile

BINS = 64
"""Bins along each channel of encoded RGB: four 8-bit codes wide."""


@dataclass(frozen=True, eq=False)
class PixelSample:
    """Distinct linear RGB (n, 3), and the share (n,) of the sampled pixels that have each; shares sum to 1."""

    rgb: Array
    share: Array


@dataclass(frozen=True, eq=False)
class SampledColours:
    """Disjoint samples of the textures' pixels, to choose candidates by and to verify the result.

    Textures with fewer pixels than both need together have all pixels in both. ``colour_bins`` (n, 3) has a colour of
    every bin that has any pixel, in linear RGB.
    """

    predicting: PixelSample
    confirming: PixelSample
    colour_bins: Array


def sample_colours(
    textures: tuple[Path, ...],
    sensor: Sensor,
    encoding: str,
    sizes: tuple[int, int],
    progress: ProgressCallback = ignore_progress,
) -> SampledColours:
    """Sample about ``sizes`` pixels to predict and to confirm, all pixels with equal probability.

    The sample is the same every time. Raises `TextureError`, and `PlanFileError` for textures without pixels.
    """
    total, scene = sum(map(_pixel_count, textures)), Images(textures, encoding)
    if not total:
        raise PlanFileError("textures must have pixels, got none", hint="name an image with pixels")
    first = sizes[0] / total
    last = first + sizes[1] / total
    rng, bins = np.random.default_rng(0), np.full((BINS**3, 3), np.nan)
    samples: tuple[list[Array], list[Array]] = [], []
    for done, path in enumerate(textures):
        progress(Progress("textures", done, len(textures)))
        for rgb in scene.colours(path, sensor):
            bins[_bin_index(sensor, rgb)] = rgb
            lot = rng.random(len(rgb))
            samples[0].append(rgb[(lot < first) | (last > 1)])
            samples[1].append(rgb[(lot >= first) & (lot < last) | (last > 1)])
    occupied = bins[~np.isnan(bins[:, 0])]
    predicting, confirming = (_distinct(np.concatenate(each), occupied) for each in samples)
    return SampledColours(predicting, confirming, occupied)


def _pixel_count(path: Path) -> int:
    """Pixels of the parts of an image that have colour channels."""
    with open_image(path) as image:
        return sum(part.window.width * part.window.height for part, _ in coloured_parts(image))


def _bin_index(sensor: Sensor, rgb: Array) -> Any:
    codes = np.interp(rgb, sensor.decoding, np.linspace(0, BINS, 256))
    red, green, blue = np.minimum(codes, BINS - 1).astype(int).T
    return (red * BINS + green) * BINS + blue


def _distinct(sample: Array, occupied: Array) -> PixelSample:
    """Each sampled colour once; the colours of the bins for an empty sample."""
    rgb, counts = np.unique(sample if len(sample) else occupied, axis=0, return_counts=True)
    return PixelSample(rgb, counts / counts.sum())


@dataclass(frozen=True, eq=False)
class ColourSet:
    """Scene of linear RGB (n, 3) for `uplift.build`: the cube gets the lattice points that the colours need."""

    rgb: Array

    def required_points(self, boxes: EntryBoxes, sensor: Sensor, progress: ProgressCallback) -> Mask:
        """Lattice points (dim³,) that the colours need."""
        return boxes.required_points(boxes.lattice.mask(cells_touched(boxes.lattice, self.rgb)))

    def describe(self) -> list[dict[str, Any]]:
        """An empty list: colours have no source files."""
        return []


@dataclass(frozen=True)
class SearchGrid:
    """Candidates of the cube, in ascending order, and sizes of the pixel samples.

    The ``reference`` is the dim of the reference cube, which has the last of the ``coefficients``. Candidates are
    chosen by ``predicting`` pixels and verified on ``confirming`` ones.
    """

    coefficients: tuple[int, ...] = (3, 5, 7, 9, 11, 13, 15, 17)
    dims: tuple[int, ...] = (8, 12, 16, 24, 32, 48, 64, 96)
    reference: int = 128
    predicting: int = 3000
    confirming: int = 8000


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
        # The final build repeats the warnings of trial builds.
        with warnings.catch_warnings(action="ignore", category=UpliftWarning):
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
    with warnings.catch_warnings(action="ignore", category=UpliftWarning):
        sizes = grid.predicting, grid.confirming
        colours = sample_colours(scene.textures, sensor, scene.encoding, sizes, progress)
    materials = np.clip(rgb[inside], 0, 1)
    return PlanContext(scene, grid, sensor, atlas, reflectances[inside], materials, colours, progress)
