"""Textures from photographs of one thing under several lights."""

import contextlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from uplift import models
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import lights as find_lights
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, Floats, Mask
from uplift.common.errors import OptionError
from uplift.common.machine import single_threaded_blas
from uplift.extras.images.converter import (
    Band,
    Converted,
    Converter,
    ImageConverter,
)
from uplift.extras.images.counts import Counts
from uplift.extras.images.image import Image, errors_at
from uplift.extras.images.reader import SurfaceReader
from uplift.extras.photographs.answers import Photographs
from uplift.extras.photographs.answers import prepare as prepare_photographs
from uplift.extras.photographs.errors import light_errors
from uplift.extras.photographs.photograph import Noise, photograph
from uplift.extras.texture.encodings import (
    Multipliers,
    PixelEncoding,
    Pixels,
    Sampler,
    Spectrum,
)
from uplift.extras.texture.mask import ReadWeights, open_mask
from uplift.extras.texture.photographs import (
    FurtherPictures,
    fit,
    open_further,
    picture_of,
)
from uplift.extras.texture.uplifter import Uplifter
from uplift.lookup.blocks import blockwise
from uplift.lookup.refine import refine_to_rgb
from uplift.models.moments import moment_matrix

NO_NOISE = (0.0, 0.0)
CONTRADICTION = "contradiction"
"""Channel that is 1 where the photographs contradict each other."""
CONTRADICTING = "photographs-contradict"
BY_FIRST = "whose photographs contradict each other: answered by the first alone"


@dataclass(frozen=True, eq=False)
class CubeAnswers:
    """Numbers of the pixels of photographs by one cube.

    ``sample`` answers at the wavelengths of the sensor, and after them at
    ``wavelengths``, those of the pixels, if they are others.
    """

    photographs: Photographs
    kind: PixelEncoding
    pixels: Pixels
    sample: Sampler
    wavelengths: Array | None
    threads: int

    def with_noise(self, noise: Noise) -> "CubeAnswers":
        """Return the same for photographs of another noise."""
        return replace(self, photographs=replace(self.photographs, noise=noise))

    def __call__(self, rgb: Array, others: Array) -> tuple[Floats, Mask]:
        """Numbers (n, N) at linear RGB (n, 3) and those of the further photographs (n,
        3 L), and which of these contradict each other.
        """
        expected = self.sample(rgb.astype(np.float32))
        contradicts = np.empty(len(rgb), dtype=bool)

        def answer(rows: Array) -> Array:
            block = rows[:, 0].astype(int)
            answers = self.photographs.answer(
                rgb[block], others[block], expected[block], self.wavelengths
            )
            contradicts[block] = answers.contradicts
            return self._numbers(rgb[block], answers.spectra)

        numbers = np.arange(len(rgb), dtype=float)[:, None]
        width = len(self.pixels.channels)
        result = blockwise(answer, numbers, width, np.float32, self.threads)
        return result, contradicts

    def _numbers(self, rgb: Array, spectra: Array) -> Array:
        """Numbers of pixels: spectra, or moments or multipliers of nearly these, with
        exactly the colours (n, 3).
        """
        if isinstance(self.kind, Spectrum):
            return spectra
        data = self.photographs.cube.data
        model = data.model
        assert isinstance(model, models.Moments)
        moments = spectra @ moment_matrix(model, data.sensor.wavelengths)
        exact = refine_to_rgb(data, model, model.from_storage(moments), rgb)
        return exact if isinstance(self.kind, Multipliers) else model.to_storage(exact)


@dataclass(frozen=True, eq=False, kw_only=True)
class SeveralLights(Converter):
    """A converter of photographs under several lights, made by
    `prepare_several_lights`. It answers with one cube, or mixes those of a ``mask``.
    """

    reader: SurfaceReader
    cubes: tuple[CubeAnswers, ...]
    further: FurtherPictures
    error_lights: tuple[Light, ...]
    mask: Path | None

    @contextlib.contextmanager
    def open(self, image: Image, also: Sequence[Path] = ()) -> Iterator[ImageConverter]:
        """Open the further photographs of an image, and fit them."""
        first = picture_of(image, self.reader)
        prepared = self.cubes[0].photographs
        with contextlib.ExitStack() as stack:
            pictures = stack.enter_context(
                open_further(also, self.further.pictures, first, self.reader)
            )
            fitted = fit(prepared, self.cubes[0].sample, self.further, first, pictures)
            weights: ReadWeights | None = None
            if self.mask is not None:
                masks = open_mask(self.mask, len(self.cubes), first.size)
                weights = stack.enter_context(masks)
            cubes = [cube.with_noise(fitted.noise) for cube in self.cubes]
            estimates = [
                light_errors(cubes[0].photographs, light) for light in self.error_lights
            ]
            stack.enter_context(errors_at(image.path))
            stack.enter_context(single_threaded_blas())

            def rows(band: Band) -> Converted:
                count = len(band.rgb)
                others = [
                    picture.rows(band.first, count) / factor
                    for picture, factor in zip(pictures, fitted.exposures, strict=True)
                ]
                mixture = None if weights is None else weights(band.first, count)
                numbers, flags = _answer(
                    cubes, band.rgb, np.concatenate(others, axis=-1), mixture
                )
                numbers = cubes[0].pixels.weighted(numbers, band)
                errors = [
                    blockwise(estimate, band.rgb.astype(float), 2, np.float32)[..., :1]
                    for estimate in estimates
                ]
                counts = Counts.of(CONTRADICTING, flags.sum(), BY_FIRST)
                return (band.weighted(band.rgb), numbers, *errors, flags), counts

            yield ImageConverter(rows, facts=fitted.facts)


def _answer(
    cubes: Sequence[CubeAnswers], rgb: Floats, others: Array, mixture: Floats | None
) -> tuple[Floats, Floats]:
    """Answer rows (k, width, 3) and those of the other photographs (k, width, 3 L), by
    one cube, or by several with weights (k, width, n): numbers, and 1 where the
    photographs contradict each other.
    """
    colours = rgb.reshape(-1, 3).astype(float)
    values = others.reshape(len(colours), -1)
    shares = np.ones((len(colours), 1), dtype=np.float32)
    if mixture is not None:
        shares = mixture.reshape(len(colours), -1)
    width = len(cubes[0].pixels.channels)
    numbers = np.zeros((len(colours), width), dtype=np.float32)
    flags = np.zeros((len(colours), 1), dtype=np.float32)
    for cube, share in zip(cubes, shares.T, strict=True):
        rows = np.flatnonzero(share)
        answered, contradicts = cube(colours[rows], values[rows])
        numbers[rows] += share[rows, None] * answered
        flags[rows[contradicts]] = 1
    shape = rgb.shape[:-1]
    return numbers.reshape(*shape, -1), flags.reshape(*shape, 1)


def prepare_several_lights(
    uplifters: Sequence[Uplifter],
    kind: PixelEncoding,
    further: FurtherPictures,
    *,
    errors: Sequence[Illuminant] = (),
    mask: Path | None = None,
    threads: int = 2,
) -> SeveralLights:
    """Prepare cubes for photographs under several lights.

    Parameters
    ----------
    uplifters : sequence of Uplifter
        Uplifters of a cube, or of those of a mask, with the encoding ``kind``.
    kind : PixelEncoding
        Numbers of a pixel.
    further : FurtherPictures
        The photographs apart from that under the light of the cube.
    errors : sequence of str or Lamp
        Lights whose standard errors have a channel.
    mask : Path, optional
        Image of which cube a pixel belongs to.
    threads : int
        Threads that share a band.

    Returns
    -------
    SeveralLights
        The converter; `convert` takes the further photographs of an image as
        ``also``.

    Raises
    ------
    OptionError
        Two photographs under one light, or one under that of the cube; a cube without
        left-out materials; multipliers of a model with three coefficients, or of
        several cubes.
    UnknownNameError
        A light, a camera or the balance is unknown.
    """
    first = uplifters[0]
    is_multiplier = isinstance(kind, Multipliers)
    if is_multiplier and (mask is not None or first.cube.data.model.is_determined):
        raise OptionError(
            "multipliers of several cubes, or of a model with three coefficients, hold "
            "no second colour",
            hint="write spectra",
        )
    cubes = [_cube_answers(uplifter, kind, further, threads) for uplifter in uplifters]
    sensor = first.reader.sensor
    description = json.loads(first.header["uplift.texture"])
    description["also"] = asdict(further)
    return SeveralLights(
        reader=first.reader,
        depth=first.depth,
        channels=(*first.channels, CONTRADICTION),
        header={**first.header, "uplift.texture": json.dumps(description)},
        cubes=tuple(cubes),
        further=further,
        error_lights=tuple(find_lights(errors, sensor.observer, sensor.range)),
        mask=mask,
    )


def _cube_answers(
    uplifter: Uplifter, kind: PixelEncoding, further: FurtherPictures, threads: int
) -> CubeAnswers:
    from uplift.lookup import bulk

    cube = uplifter.cube
    photographs = [
        photograph(cube.data.sensor, picture.light, picture.camera, further.balance)
        for picture in further.pictures
    ]
    stated = getattr(kind, "wavelengths", None)
    at = cube.wavelengths if stated is None else np.append(cube.wavelengths, stated)
    return CubeAnswers(
        photographs=prepare_photographs(cube, photographs, further.noise or NO_NOISE),
        kind=kind,
        pixels=uplifter.pixels,
        sample=bulk.spectra(cube, at, threads=threads),
        wavelengths=None if stated is None else np.array(stated),
        threads=threads,
    )
