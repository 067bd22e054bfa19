"""Textures from photographs of one thing under several lights."""

import contextlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, fields, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from uplift import models
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import lights as find_lights
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, Floats, Mask
from uplift.common.errors import OptionError
from uplift.common.machine import single_threaded_blas
from uplift.extras.photographs.answers import Photographs
from uplift.extras.photographs.answers import prepare as prepare_photographs
from uplift.extras.photographs.errors import light_errors
from uplift.extras.photographs.photograph import Noise, photograph
from uplift.extras.texture.channels import coloured_parts
from uplift.extras.texture.colours import Counts, make_decoder
from uplift.extras.texture.image import Image, Part, open_image
from uplift.extras.texture.mask import ReadWeights, open_mask
from uplift.extras.texture.photographs import (
    Fitted,
    FurtherPictures,
    Picture,
    fit,
    open_further,
)
from uplift.extras.texture.uplifter import (
    Converted,
    Converter,
    ConvertRows,
    Multipliers,
    PixelEncoding,
    Sampler,
    Spectrum,
    Uplifter,
)
from uplift.lookup.blocks import blockwise
from uplift.lookup.errors_under_lights import LightErrors
from uplift.lookup.refine import refine_to_rgb
from uplift.models.moments import moment_matrix

NO_NOISE = (0.0, 0.0)
CONTRADICTION = "contradiction"
"""Channel that is 1 where the photographs contradict each other."""


@dataclass(frozen=True, eq=False)
class CubeAnswers:
    """Numbers of the pixels of photographs by one cube.

    ``sample`` answers at the wavelengths of the sensor, and after them at those of the
    pixels, if they are others.
    """

    photographs: Photographs
    sample: Sampler
    kind: PixelEncoding
    width: int
    threads: int

    def with_noise(self, noise: Noise) -> "CubeAnswers":
        """Return the same for photographs of another noise."""
        return replace(self, photographs=replace(self.photographs, noise=noise))

    def __call__(self, rgb: Array, others: Array) -> tuple[Floats, Mask]:
        """Numbers (n, N) at linear RGB (n, 3) and those of the further photographs (n,
        3 L), and which of these contradict each other.
        """
        expected = self.sample(rgb.astype(np.float32))
        stated = getattr(self.kind, "wavelengths", None)
        at = None if stated is None else np.array(stated)

        contradicts = np.empty(len(rgb), dtype=bool)

        def answer(rows: Array) -> Array:
            block = rows[:, 0].astype(int)
            answers = self.photographs.answer(
                rgb[block], others[block], expected[block], at
            )
            contradicts[block] = answers.contradicts
            return self._numbers(rgb[block], answers.spectra)

        numbers = np.arange(len(rgb), dtype=float)[:, None]
        result = blockwise(answer, numbers, self.width, np.float32, self.threads)
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


@dataclass(frozen=True, eq=False)
class SeveralLights(Converter):
    """A converter of photographs under several lights, made by
    `prepare_several_lights`.

    It answers with one cube, or mixes those of a ``mask``. ``paths`` are the further
    photographs of the image that is converted.
    """

    cubes: tuple[CubeAnswers, ...]
    further: FurtherPictures
    error_lights: tuple[Light, ...] = ()
    mask: Path | None = None

    @contextlib.contextmanager
    def opened(self, image: Image) -> Iterator[ConvertRows]:
        fitted = _fit(self, image.path)
        cubes = [cube.with_noise(fitted.noise) for cube in self.cubes]
        estimates = [
            light_errors(cubes[0].photographs, light) for light in self.error_lights
        ]
        size = _size(image)
        further = open_further(
            self.further, self.paths, size, self.sensor, self.encoding
        )
        with contextlib.ExitStack() as stack:
            stack.enter_context(single_threaded_blas())
            pictures = stack.enter_context(further)
            weights: ReadWeights | None = None
            if self.mask is not None:
                masks = open_mask(self.mask, len(self.cubes), size)
                weights = stack.enter_context(masks)

            def convert_rows(part: Part, first: int, rgb: Floats) -> Converted:
                row = first - part.window.y
                others = [
                    picture.rows(row, len(rgb)) / factor
                    for picture, factor in zip(pictures, fitted.exposures, strict=True)
                ]
                mixture = None if weights is None else weights(row, len(rgb))
                values, counts = _answer(
                    cubes, rgb, np.concatenate(others, axis=-1), mixture
                )
                errors = [_standard_errors(estimate, rgb) for estimate in estimates]
                numbers, contradicts = values
                return (rgb, numbers, *errors, contradicts), counts

            yield convert_rows

    def facts(self, image: Image) -> tuple[str, ...]:
        return _fit(self, image.path).facts

    def convert(self, rgb: Floats) -> Converted:
        raise NotImplementedError("photographs are converted by rows")

    def multiply(
        self, values: tuple[Floats, ...], opacity: Floats
    ) -> tuple[Floats, ...]:
        rgb, numbers, *more = values
        if not isinstance(self.cubes[0].kind, Multipliers):
            numbers = numbers * opacity
        return rgb * opacity, numbers, *more


def _answer(
    cubes: Sequence[CubeAnswers], rgb: Floats, others: Array, mixture: Floats | None
) -> tuple[tuple[Floats, Floats], Counts]:
    """Answer rows (k, width, 3) and those of the other photographs (k, width, 3 L),
    by one cube, or by several with weights (k, width, n).
    """
    colours = rgb.reshape(-1, 3).astype(float)
    values = others.reshape(len(colours), -1)
    shares = np.ones((len(colours), 1), dtype=np.float32)
    if mixture is not None:
        shares = mixture.reshape(len(colours), -1)
    numbers = np.zeros((len(colours), cubes[0].width), dtype=np.float32)
    contradicts = np.zeros(len(colours), dtype=bool)
    for cube, share in zip(cubes, shares.T, strict=True):
        rows = np.flatnonzero(share)
        answered, unlike = cube(colours[rows], values[rows])
        numbers[rows] += share[rows, None] * answered
        contradicts[rows] |= unlike
    shape = rgb.shape[:-1]
    flags = contradicts.reshape(*shape, 1).astype(np.float32)
    counts = Counts(contradicting=int(contradicts.sum()))
    return (numbers.reshape(*shape, -1), flags), counts


def _standard_errors(estimate: LightErrors, rgb: Floats) -> Floats:
    """ΔE00 (…, 1) of linear RGB (…, 3)."""
    errors = blockwise(estimate, rgb.astype(float), 2, np.float32)
    return errors[..., :1]


def _size(image: Image) -> tuple[int, int]:
    """Width and height of the first part of an image that has colours."""
    window = coloured_parts(image)[0][0].window
    return window.width, window.height


@lru_cache(maxsize=4)
def _fit(converter: SeveralLights, path: Path) -> Fitted:
    """Estimate how the further photographs fit the image of this path."""
    with open_image(path) as image:
        part, channels = coloured_parts(image)[0]
        decode = make_decoder(
            converter.sensor, part, converter.encoding, "clip", converter.space
        )
        first = Picture(image, part, channels, decode)
        further = open_further(
            converter.further,
            converter.paths,
            _size(image),
            converter.sensor,
            converter.encoding,
        )
        cube = converter.cubes[0]
        with further as pictures:
            return fit(
                cube.photographs, cube.sample, converter.further, first, pictures
            )


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
        The converter; its ``paths`` are the further photographs of an image.

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
    cubes = []
    for uplifter in uplifters:
        photographs = [
            photograph(uplifter.sensor, picture.light, picture.camera, further.balance)
            for picture in further.pictures
        ]
        prepared = prepare_photographs(
            uplifter.cube, photographs, further.noise or NO_NOISE
        )
        cubes.append(_cube_answers(prepared, kind, threads))
    lights = find_lights(errors, first.sensor.observer, first.sensor.range)
    settings = {each.name: getattr(first, each.name) for each in fields(Converter)}
    description = json.loads(first.header["uplift.texture"])
    description["also"] = asdict(further)
    header = {**first.header, "uplift.texture": json.dumps(description)}
    channels = (*first.channels, CONTRADICTION)
    return SeveralLights(
        **settings | {"header": header, "channels": channels},
        cubes=tuple(cubes),
        further=further,
        error_lights=tuple(lights),
        mask=mask,
    )


def _cube_answers(
    prepared: Photographs, kind: PixelEncoding, threads: int
) -> CubeAnswers:
    from uplift.lookup import bulk

    cube = prepared.cube
    at = cube.wavelengths
    width = cube.data.model.count
    if isinstance(kind, Spectrum):
        stated = () if kind.wavelengths is None else kind.wavelengths
        width = len(stated) or len(at)
        at = np.append(at, stated)
    return CubeAnswers(
        prepared, bulk.spectra(cube, at, threads=threads), kind, width, threads
    )
