"""``uplift texture``: convert images to spectral textures."""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Sequence
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.errors import OptionError, UpliftError
from uplift.common.progress import Progress
from uplift.common.text import pluralise
from uplift.extras.images.sequences import (
    expand_patterns,
    is_folder,
    pair_frames,
    texture_paths,
)

from .. import also as further
from .. import options
from ..inputs import check_range
from ..option_types import INPUTS
from ..output.console import say
from ..output.diagnostics import CommandFailure, warn
from ..output.progress import progress_bar
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.extras.texture.conversion import Conversion
    from uplift.extras.texture.encodings import PixelEncoding
    from uplift.extras.texture.sequence import Job, Outcome


def _check_scheduler(address: str) -> None:
    from uplift.extras.texture.sequence import import_distributed

    import_distributed()


LARGE = 100.0
"""Megabytes of textures from which the smaller kind is named."""
image_options = options.stacked(
    click.argument("sources", metavar="IN...", nargs=-1, required=True),
    click.option(
        "-o",
        "--output",
        "target",
        metavar="FILE",
        required=True,
        help="Texture to write, or folder of textures.",
    ),
    click.option(
        "--processes",
        type=options.Whole(1, 1024),
        help="Number of processes for several images. [default: one per core]",
    ),
    click.option(
        "--scheduler",
        metavar="ADDRESS",
        type=options.Checked(_check_scheduler),
        help="Dask cluster that converts the images; requires the package distributed.",
    ),
    options.flag("--resume", help="Skip images whose textures are complete."),
    options.force,
    options.quiet,
)
"""Images, their target, and how they are converted; for `convert`."""
passes_option = click.option(
    "--passes",
    metavar="FILE",
    type=click.Path(),
    help="Passes by 'uplift passes choose': write an image for each of them.",
)


@click.command(
    "texture",
    cls=options.Command,
    everyday=("target", "cube_paths", "also", "mask", "kind", "depth", "force"),
    help="""Convert every pixel of an image (EXR, HDR, PNG, JPEG, TIFF) to a spectrum
    and write an OpenEXR texture.

    \b
    Examples:
      uplift texture wood.png -o wood.exr
      uplift texture wood.png -o moments.exr --representation moments
      uplift texture 'shot.*.exr' -o uplifted-31 --wavelengths 400:700:10 --resume
      uplift texture fire.exr -o bright.exr --out-of-gamut scale
      uplift texture painting.exr -o ap1.exr --input-space ACEScg
      uplift texture shot.*.exr -o uplifted --scheduler tcp://10.0.0.5:8786
      uplift texture wood.png -o errors.exr --cube macbeth-32.uplift --errors FL11
      uplift relight wood.png -o tungsten.exr --light A
      uplift texture wood.png --also A:tungsten.exr -o two-lights.exr
      uplift passes choose
      uplift texture wood.png -o wood --passes passes.toml

    'spectrum' stores a spectral EXR in the layout of Fichet et al. 2021, at
    --wavelengths. 'moments' can be filtered and mip-mapped. 'multipliers' can be
    evaluated directly, by the formula in the header. Alpha and other channels are
    copied; colours multiplied by alpha, as in OpenEXR, are divided by it first and
    multiplied after. Several images, or a quoted pattern, go into the folder of
    --output.

    \f Colours of an image in another RGB space than the cube's are converted. Its space
    is that of --input-space, or the one that the file states, for example by
    chromaticities, an ICC profile or gAMA. Channels X, Y and Z are CIE XYZ.

    Colours outside [0, 1] are treated by --out-of-gamut, and NaN becomes 0. A warning
    counts both.

    With --mask, pixels have the spectra of several cubes. A grey mask holds the numbers
    of the cubes, from 0 in the order of --cube; or, for two cubes, weights: black is
    the first, white the second, and grey mixes both. A coloured mask holds the weights
    of three cubes in R, G and B. Mixed spectra keep the colour of the pixel.

    With --also, a picture of the same thing under another light, or several of them,
    show which of the materials of one colour a pixel is. Their exposures and noise are
    estimated and printed. They must be aligned, and of one size. Pixels whose pictures
    contradict each other are answered by the first alone, and are 1 in the channel
    'contradiction'. A ColorChecker in all of them, see --chart, states more, and its
    patches are compared with their measurements.

    With --passes, an RGB renderer takes the place of a spectral one: each pass has a
    texture, such as wood.1.exr and wood.2.exr, with the numbers of three bands as R, G
    and B ('uplift passes').

    Pixels that are light, such as those of an environment map, need 'uplift lights
    texture'.
    """,
)
@image_options
@options.cube(
    options.OF_PACKAGE.format("; repeatable with --mask"),
    name="cube_paths",
    multiple=True,
)
@click.option(
    "--mask",
    metavar="FILE",
    help="Image of which cube a pixel belongs to: 0 for the first, 1 for the second …, "
    "or from black to white.",
)
@options.choice(
    "--representation",
    "spectrum",
    "moments",
    "multipliers",
    name="kind",
    help="Contents of a pixel.",
)
@options.output_wavelengths
@options.depth
@options.pixels()
@options.fill
@further.also("FILE", further.is_file, "Photograph of the same thing under a light")
@options.repeatable(
    "--exposure",
    "exposures",
    "How much brighter it is than the first",
    metavar="FACTOR",
    default="estimated",
    type=options.NUMBER,
)
@further.noise
@further.balance
@click.option(
    "--chart",
    "corners",
    metavar="X,Y,X,Y,X,Y,X,Y",
    type=options.Parsed(further.parse_corners),
    help="Corners of a ColorChecker in all photographs, in pixels, clockwise from dark "
    "skin; exposure, balance and noise are taken from it.",
)
@click.option(
    "--chart-atlas",
    metavar="FILE",
    default="macbeth",
    help="Measured reflectances of its 24 patches, in their order.",
)
@options.repeatable(
    "--also-space",
    "spaces",
    "RGB space of --also, as --input-space",
    metavar="NAME",
    type=options.INPUT_SPACE,
)
@options.repeatable(
    "--also-camera",
    "cameras",
    "Camera whose raw values --also has",
    metavar="NAME|FILE",
)
@options.repeatable(
    "--errors",
    "errors",
    "Add a channel with the standard error, ΔE00, under an illuminant, such as error.A",
    metavar="NAME|FILE",
    type=options.LIGHT,
)
@passes_option
def command(
    cube_paths: Sequence[str],
    mask: str | None,
    kind: str,
    wavelengths: Array | None,
    also: Sequence[further.Further],
    passes: str | None,
    exposures: Sequence[float],
    spaces: Sequence[str],
    cameras: Sequence[str],
    noise: tuple[float, float] | None,
    balance: str,
    corners: tuple[float, ...] | None,
    chart_atlas: str,
    **settings: Any,
) -> None:
    from uplift.extras.texture.encodings import PIXEL_ENCODINGS, Spectrum
    from uplift.extras.texture.photographs import (
        ChartInPicture,
        FurtherPicture,
        FurtherPictures,
    )
    from uplift.extras.texture.sequence import load_cube
    from uplift.lookup.cube import find_file

    if passes is not None:
        options.exclude("--passes", "kind", "mask", "errors", "wavelengths", "also")
    if len(cube_paths) > 1 and mask is None:
        raise click.UsageError(
            "Several cubes need --mask, an image of which cube a pixel belongs to."
        )
    cubes = tuple(os.path.abspath(find_file(path)) for path in cube_paths) or (None,)
    encoding = PIXEL_ENCODINGS[kind]()
    if wavelengths is not None:
        if not isinstance(encoding, Spectrum):
            hint = "leave out --wavelengths, or use --representation spectrum"
            raise OptionError(f"{kind} have no wavelengths", hint=hint)
        for path in cubes:
            check_range(wavelengths, load_cube(path).wavelengths)
        encoding = Spectrum(as_tuple(wavelengths))
    count = len(also)
    columns = (
        [photograph.light for photograph in also],
        further.for_each(spaces, count, "--also-space"),
        further.for_each(cameras, count, "--also-camera"),
        further.for_each(exposures, count, "--exposure"),
    )
    pictures = tuple(FurtherPicture(*row) for row in zip(*columns, strict=True))
    chart = None if corners is None else ChartInPicture(corners, chart_atlas)
    convert(
        cubes,
        encoding,
        mask=None if mask is None else os.path.abspath(mask),
        also=FurtherPictures(pictures, balance, noise, chart) if pictures else None,
        further=[photograph.text for photograph in also],
        passes=passes,
        **settings,
    )


def convert(
    cubes: tuple[str | None, ...],
    pixel_encoding: PixelEncoding,
    *,
    sources: Sequence[str],
    target: str,
    processes: int | None,
    scheduler: str | None,
    resume: bool,
    force: bool,
    quiet: bool,
    further: Sequence[str] = (),
    passes: str | None = None,
    **given: Any,
) -> None:
    """Convert images, on as many threads as the processes leave; see `TextureSettings`
    and `image_options`.
    """
    enable_jit_cache()
    from uplift.extras import texture
    from uplift.extras.scene.passes.settings import jobs_of_passes
    from uplift.extras.texture.sequence import converter_for

    begin = time.perf_counter()
    frames = pair_frames([sources, *([text] for text in further)])
    images = [image for image, *_ in frames]
    named = target if passes is None else _with_suffix(sources, target)
    cores = os.cpu_count() or 1
    count = processes or min(cores, len(frames))
    settings = texture.TextureSettings(
        cubes, pixel_encoding, threads=max(cores // count, 1), **given
    )
    jobs = []
    for pictures, path in zip(
        frames, texture_paths(sources, images, named), strict=True
    ):
        source, *more = map(Path.absolute, map(Path, pictures))
        job = texture.Job(settings, source, path.absolute(), force, resume, tuple(more))
        jobs.append(job)
    inputs = [*click.get_current_context().meta.get(INPUTS, ())]
    if passes is not None:
        inputs.append(passes)
        jobs = jobs_of_passes(jobs, os.path.abspath(passes))
    pending = texture.pending(jobs, inputs=inputs)
    # reports invalid options once, not once per image
    converter_for(jobs[0].settings)
    if scheduler is None and len(jobs) == 1:
        outcomes = _run_single(pending, quiet)
    else:
        outcomes = _run_all(pending, quiet, processes=count, scheduler=scheduler)
    converted = [item for item in outcomes if isinstance(item, texture.Conversion)]
    failures = [item.error for item in outcomes if isinstance(item, texture.Failure)]
    for conversion in converted:
        warn(conversion.warnings)
    if not quiet and len(failures) < len(jobs):
        skipped = len(jobs) - len(converted) - len(failures)
        seconds = time.perf_counter() - begin
        size = _print_summary(target, converted, skipped, seconds)
        is_spectrum = isinstance(pixel_encoding, texture.Spectrum)
        if size > LARGE and passes is None and is_spectrum:
            hint = "--representation moments --depth half takes a fraction of the size"
            say(f"hint: {hint}", err=True)
    _raise_first(failures)


def _with_suffix(sources: Sequence[str], target: str) -> str:
    """Return the name ``wood.exr`` for ``wood`` of a single image, unless it is a
    folder.
    """
    is_single = len(sources) == 1 and expand_patterns(sources) == [sources[0]]
    if not is_single or is_folder(target) or Path(target).suffix.lower() == ".exr":
        return target
    return f"{target}.exr"


def as_tuple(wavelengths: Array | None) -> tuple[float, ...] | None:
    return None if wavelengths is None else tuple(wavelengths.tolist())


def _run_single(jobs: Sequence[Job], quiet: bool) -> list[Outcome]:
    from uplift.extras.texture.sequence import run

    with progress_bar("rows", quiet=quiet) as progress:
        return [run(job, progress) for job in jobs]


def _run_all(jobs: Sequence[Job], quiet: bool, **workers: Any) -> list[Outcome]:
    from uplift.extras.texture.sequence import convert_all

    outcomes = []
    try:
        with (
            contextlib.closing(convert_all(jobs, **workers)) as results,
            progress_bar("images", quiet=quiet) as progress,
        ):
            for outcome in results:
                outcomes.append(outcome)
                progress(Progress("images", len(outcomes), len(jobs)))
    except KeyboardInterrupt as interrupt:
        interrupt.add_note(
            f"{len(outcomes)} of {pluralise(len(jobs), 'image')} finished, continue "
            "with --resume"
        )
        raise
    return outcomes


def _print_summary(
    target: str, converted: Sequence[Conversion], skipped: int, seconds: float
) -> float:
    """Print what was converted, and return its size in megabytes."""
    pixels = sum(conversion.counts.pixels for conversion in converted)
    size = sum(conversion.target.stat().st_size for conversion in converted) / 1e6
    spaces = chain.from_iterable(conversion.spaces for conversion in converted)
    read_as = ", ".join(dict.fromkeys(spaces))
    facts = [
        pluralise(len(converted), "texture"),
        f"{skipped} skipped" if skipped else "",
        pluralise(pixels, "pixel"),
        f"{size:.1f} MB",
        f"{seconds:.1f} s",
        f"read as {read_as}" if read_as else "",
    ]
    say(f"{target}: {', '.join(filter(None, facts))}")
    for conversion in converted:
        name = f"{conversion.source.name}: " if len(converted) > 1 else ""
        for fact in conversion.facts:
            say(f"{name}{fact}")
    return size


def _raise_first(errors: Sequence[UpliftError]) -> None:
    """Raise the first of the errors of images, after the others are printed."""
    for error in errors[1:]:
        CommandFailure(error).show()
    if errors:
        raise errors[0]
