"""``uplift texture``: every pixel of an image uplifted."""

from __future__ import annotations

import os
import time
import warnings
from collections.abc import Iterable
from typing import TYPE_CHECKING

import click

from uplift.common.progress import Progress

from ..output.progress import progress_bar
from ..params.image_paths import frames
from ..params.options import (
    cube_option,
    encoding_option,
    fill_option,
    force_option,
    out_of_gamut_option,
    wavelengths_option,
)
from ..params.wavelengths import parse_wavelengths

if TYPE_CHECKING:
    from uplift.common.arrays import Array
    from uplift.io.texture import Conversion, Failure, Job, PixelEncoding


@click.command("texture")
@click.argument("sources", metavar="IN...", nargs=-1, required=True)
@click.argument("target", metavar="OUT")
@cube_option()
@click.option(
    "--as",
    "kind",
    type=click.Choice(("spectrum", "moments", "multipliers")),
    default="spectrum",
    show_default=True,
    help="What a pixel holds.",
)
@wavelengths_option()
@click.option(
    "--depth",
    type=click.Choice(("half", "float")),
    help="16 or 32 bits a number. [default: half for spectra, else float]",
)
@encoding_option()
@out_of_gamut_option("clip")
@fill_option()
@click.option("--processes", type=click.IntRange(min=1), help="For several images. [default: one a core]")
@click.option("--scheduler", metavar="ADDRESS", help="Dask cluster to work on; it needs uplift[cluster].")
@click.option("--resume", is_flag=True, help="Leave out images whose textures are there, newer and whole.")
@force_option()
@click.option("-q", "--quiet", is_flag=True, help="Say nothing but warnings and errors.")
def command(
    sources: tuple[str, ...],
    target: str,
    cube_path: str | None,
    kind: str,
    wavelengths: str | None,
    depth: str | None,
    encoding: str,
    way: str,
    fill: bool,
    processes: int | None,
    scheduler: str | None,
    resume: bool,
    force: bool,
    quiet: bool,
) -> None:
    """Uplift every pixel of an image (EXR, PNG, JPEG, TIFF) and write the texture as OpenEXR.

    \b
    Examples:
      uplift texture wood.png wood.exr
      uplift texture wood.png wood.exr --cube macbeth-32.uplift --as moments
      uplift texture 'shot.*.exr' uplifted --wavelengths 400:700:10 --resume
      uplift texture fire.exr bright.exr --out-of-gamut scale
      uplift texture shot.*.exr uplifted --scheduler tcp://10.0.0.5:8786

    'spectrum' is a spectral EXR as Fichet et al. 2021 have it, at --wavelengths. 'moments' can be filtered and
    mip-mapped, 'multipliers' evaluated at once; the header tells how. Alpha and other channels pass through.
    Colours outside [0, 1] are clipped, or as --out-of-gamut says, NaN is taken for 0; both are counted. Several
    images, or a quoted pattern, go into the folder OUT.
    """
    from ..startup import keep_compiled

    keep_compiled()
    from uplift.common.errors import UpliftWarning
    from uplift.io import texture

    pairs = frames(sources, target)
    cores = os.cpu_count() or 1
    count = processes or min(cores, len(pairs))
    form = _form(kind, parse_wavelengths(wavelengths))
    cube = None if cube_path is None else os.path.abspath(cube_path)
    recipe = texture.TextureSettings(cube, form, depth, encoding, max(cores // count, 1), fill, way)
    jobs = [texture.Job(recipe, source.absolute(), made.absolute(), force) for source, made in pairs]
    todo = texture.pending(jobs, resume=resume)
    texture.uplifter_for(recipe)  # what is wrong with the options is said once
    begin = time.perf_counter()
    if scheduler is None and len(jobs) == 1:
        found: list[Conversion | Failure] = [_alone(job) for job in todo]
    else:
        with texture.processes(count) if scheduler is None else texture.cluster(scheduler) as executor:
            found = _several(texture.convert_all(todo, executor), len(todo))
    made = [one for one in found if isinstance(one, texture.Conversion)]
    for conversion in made:
        for remark in conversion.remarks:
            warnings.warn(f"{conversion.source}: {remark}", UpliftWarning, stacklevel=1)
    if not quiet:
        _tell(target, made, len(jobs) - len(todo), time.perf_counter() - begin)
    failures = [one for one in found if isinstance(one, texture.Failure)]
    for failure in failures[1:]:
        click.echo(f"error: {failure.error}", err=True)
    if failures:
        raise failures[0].error


def _form(kind: str, wavelengths: Array | None) -> PixelEncoding:
    from uplift.common.errors import OptionError
    from uplift.io import texture

    if kind == texture.Spectrum.name:
        return texture.Spectrum(None if wavelengths is None else tuple(wavelengths.tolist()))
    if wavelengths is not None:
        raise OptionError(f"{kind} have no wavelengths", hint="leave out --wavelengths, or --as")
    return texture.FORMS[kind]()


def _alone(job: Job) -> Conversion:
    """One image, here, with a bar over its rows."""
    from uplift.io import texture

    with progress_bar("rows") as progress:
        return texture.convert(
            texture.uplifter_for(job.recipe), job.source, job.target, force=job.force, progress=progress
        )


def _several(results: Iterable[Conversion | Failure], total: int) -> list[Conversion | Failure]:
    """Images as they are finished, with a bar over them."""
    found = []
    with progress_bar("images") as progress:
        for result in results:
            found.append(result)
            progress(Progress("images", len(found), total))
    return found


def _tell(target: str, made: list[Conversion], skipped: int, seconds: float) -> None:
    pixels = sum(conversion.counts.pixels for conversion in made)
    size = sum(conversion.target.stat().st_size for conversion in made)
    there = f", {skipped} there already" if skipped else ""
    many = f"{len(made)} texture{'s' * (len(made) != 1)}{there}"
    click.echo(f"{target}: {many}, {pixels:,} pixels, {size / 1e6:.1f} MB, {seconds:.1f} s")
