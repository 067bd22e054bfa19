"""``uplift build``: build a cube from atlases."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..output.build_summary import print_improvements, print_summary
from ..params.image_paths import expand_patterns
from ..params.number_types import NUMBER, Whole
from ..params.options import (
    LatticeDim,
    atlas_option,
    coefficients_option,
    encoding_option,
    force_option,
    input_space_option,
    light_option,
    out_of_gamut_option,
    quiet_option,
    scale_option,
    sensor_options,
    verbose_option,
)
from ..params.wavelengths import parse_range
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.io.scene_colours import Images
    from uplift.lookup import Cube

ALLOWED_WITH_PLAN = ("plan_path", "output", "debug", "force", "quiet", "verbose")
"""Parameters that may accompany --plan."""


@click.command("build")
@atlas_option("Measured spectra")
@scale_option()
@click.option(
    "-o",
    "--output",
    metavar="FILE",
    help="Cube to write. [default: named after atlas and dim, in the current folder]",
)
@click.option(
    "--dim",
    default="32",
    type=LatticeDim(),
    show_default=True,
    help="Lattice nodes along each axis. 'auto' chooses the smallest dim, and its axis, that resolves every entry.",
)
@click.option(
    "--tolerance",
    "auto_tolerance",
    type=NUMBER,
    default=0.5,
    show_default=True,
    help="ΔE00 within which the lattice of --dim auto must reproduce the entries.",
)
@click.option("--model", default="moments", show_default=True, help="Spectrum model: moments or sigmoid.")
@coefficients_option()
@click.option(
    "--entry-coefficients",
    type=Whole(),
    default=17,
    show_default=True,
    metavar="N",
    help="Coefficients per spectrum of an atlas entry, from --coefficients to 17.",
)
@click.option("--warp", default="none", show_default=True, help="Phase warp of the moments: none or vision.")
@click.option("--axis", default="srgb", show_default=True, help="Spacing of the nodes: srgb or linear.")
@sensor_options
@click.option(
    "--range",
    "limits",
    default="380:780",
    show_default=True,
    help="First and last wavelength of the spectra in nm, from 300 to 1000.",
)
@click.option("--step", type=NUMBER, default=5, show_default=True, help="Distance of wavelengths in nm: 1, 5 or 10.")
@light_option("Illuminant under which entries must keep their colour", "D65 A FL2 FL11 LED-B3")
@click.option(
    "--prior",
    default="learnt",
    show_default=True,
    help="Spectra of colours without measurements: learnt (from real materials) or smooth.",
)
@click.option(
    "--library",
    multiple=True,
    metavar="FILE",
    help="Measured spectra that shape the learnt prior without being constraints; repeatable.",
)
@click.option(
    "--look",
    "looks",
    metavar="LOOKS.toml",
    help="File of looks: colours, and what they are to be under other lights.",
)
@click.option(
    "--exclude-family",
    "leave_out",
    multiple=True,
    metavar="FAMILY",
    help="Family of the shipped library that the learnt prior must not know, for tests on it; repeatable.",
)
@click.option(
    "--threshold",
    type=NUMBER,
    default=1e-4,
    show_default=True,
    help="Largest residual of a node, |linear RGB|.",
)
@click.option(
    "--scene",
    "images",
    multiple=True,
    metavar="IMAGE",
    help="Build only the cells that the colours of this image, or quoted pattern, need; repeatable.",
)
@click.option(
    "--start",
    default="prior",
    show_default=True,
    help="What nodes start from: prior, or neighbours, outward from the seeds.",
)
@click.option(
    "--solver",
    default="least-change",
    show_default=True,
    help="Solver: least-change, dogleg, levenberg-marquardt or gauss-newton. Only nearly box-shaped spectra differ.",
)
@encoding_option("--scene images")
@input_space_option("--scene images")
@click.option("--plan", "plan_path", metavar="PLAN", help="Build the cube of a plan by 'uplift plan'.")
@out_of_gamut_option("clip", "linear RGB of --scene images")
@click.option(
    "--seed-corners",
    is_flag=True,
    help="Start all eight nodes around an entry from it: closer near entries, less so for other materials.",
)
@click.option("--debug", is_flag=True, help="Store the round of every node, for 'uplift slices'.")
@force_option()
@quiet_option()
@verbose_option()
def command(
    plan_path: str | None,
    files: tuple[str, ...],
    scale: str,
    output: str | None,
    images: tuple[str, ...],
    encoding: str,
    input_space: str | None,
    method: str,
    force: bool,
    quiet: bool,
    verbose: bool,
    limits: str,
    **options: Any,
) -> None:
    """Build an uplifting cube constrained by measured spectra.

    \b
    Examples:
      uplift build --atlas macbeth --dim 32
      uplift build --atlas paints.csv --atlas fabrics.csv --coefficients 17 -o book.uplift
      uplift build --atlas paints.csv --dim auto --tolerance 1
      uplift build --atlas paints.csv --dim 64 --scene wood.png --scene 'shot.*.exr'
      uplift build --atlas macbeth --library fabrics.csv -o fabrics.uplift
      uplift build --atlas macbeth --look looks.toml -o looks.uplift
      uplift build --atlas paints.csv --range 360:830 --step 1 -o range.uplift
      uplift build --model sigmoid --space 'ITU-R BT.2020' -o wide.uplift
      uplift build --atlas macbeth --observer 'Nikon 5100 (NPL)' --space camera --dim 16
      uplift build --plan kitchen.plan.json

    Warnings name the entries that were left out, clipped or crowded. Colours without measurements get the
    spectra that real materials of such colours are expected to have.

    Looks state colours under other lights, such as rgb = "#8a2a20" and HP1 = "#70392a" (docs/look-cubes.md). They
    become entries. A look that no reflectance meets gets the nearest colour, and a warning.

    Entries have their own values in the --range as far as they were measured, and continue as constants. So does the
    learnt prior, from 380 and 780 nm.

    With --scene the cube is sparse: it is smaller and faster to build, and gives the same spectra for colours of the
    images. Other colours are errors, unless 'query' and 'texture' are given --fill-missing.
    """
    enable_jit_cache()
    from uplift.common.files import check_output

    from ..output.progress import build_progress

    build: Callable[..., Cube]
    inputs: tuple[str | Path | None, ...]
    if plan_path is None:
        scene = _scene(images, encoding, method, input_space)
        inputs = (
            *files,
            *options["library"],
            options["looks"],
            options["observer"],
            *(scene.paths if scene else ()),
        )
        given = {name: value for name, value in options.items() if value not in (None, ())}
        given["shortest"], given["longest"] = parse_range(limits)
        build = partial(_build, files, scale, scene=scene, **given)
        name = _default_name(files, images, options)
    else:
        build, name, inputs = _planned_build(plan_path, click.get_current_context())
    path = check_output(name if output is None else output, inputs=inputs, force=force)
    begin = time.perf_counter()
    with build_progress(quiet=quiet, verbose=verbose) as progress:
        cube = build(progress=progress)
    cube.save(path, force=force)
    if verbose:
        print_improvements(cube)
    if not quiet:
        print_summary(cube, path, time.perf_counter() - begin)


def _build(files: tuple[str, ...], scale: Any, **options: Any) -> Cube:
    from uplift.atlas import read_atlas
    from uplift.pipeline.build import build

    return build(read_atlas(*files, measured=scale) if files else None, **options)


def _scene(images: tuple[str, ...], encoding: str, method: str, space: str | None) -> Images | None:
    """Return the images of the scene. Raises click's error for their options without images."""
    if images:
        from uplift.io.scene_colours import Images

        return Images(tuple(map(Path, expand_patterns(images))), encoding, method, space)
    options = (
        ("--encoding", encoding, "auto"),
        ("--out-of-gamut", method, "clip"),
        ("--input-space", space, None),
    )
    for option, value, default in options:
        if value != default:
            raise click.UsageError(f"{option} applies to --scene images, and no image is given.")
    return None


def _planned_build(path: str, context: click.Context) -> tuple[Callable[..., Cube], str, tuple[str | Path, ...]]:
    """Return the build of a plan, the cube's name and the files to read.

    Raises click's error for options that contradict the plan.
    """
    from uplift.scene.plan import read_plan
    from uplift.scene.plan.commands import cube_name

    source = click.core.ParameterSource.COMMANDLINE
    given = [each for each in context.command.params if context.get_parameter_source(each.name or "") == source]
    if others := [each.opts[-1] for each in given if each.name not in ALLOWED_WITH_PLAN]:
        raise click.UsageError(f"The plan already sets these options: leave out {', '.join(others)}.")
    plan = read_plan(path)
    build = partial(plan.build, debug=context.params["debug"])
    return build, cube_name(path), (path, *plan.textures, *plan.atlases)


def _default_name(atlases: tuple[str, ...], images: tuple[str, ...], options: dict[str, Any]) -> str:
    space = re.sub("[ /]", "-", _space_name(options["space"])).lower()
    stem = "+".join(Path(atlas).stem for atlas in atlases) or space
    suffix = f"-{space}" if atlases and space != "srgb" else ""
    return f"{stem}-{options['dim']}{suffix}{'-scene' if images else ''}.uplift"


def _space_name(name: str) -> str:
    """Return the name of a space by one of its names."""
    from uplift.colorimetry.camera import CAMERA

    if name in ("sRGB", CAMERA):
        return name
    from uplift.colorimetry.spaces import look_up_space

    return str(look_up_space(name).name)
