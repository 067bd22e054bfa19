"""``uplift build``: a cube from an atlas."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..output.build_summary import tell, tell_improvements
from ..params.image_paths import expanded
from ..params.options import (
    encoding_option,
    force_option,
    out_of_gamut_option,
    sensor_options,
    verbosity_options,
)

if TYPE_CHECKING:
    from uplift.lookup import Cube

BESIDE_A_PLAN = ("plan_path", "output", "debug", "force", "quiet", "verbose")
"""Parameters that go with --plan."""


class Dim(click.ParamType):  # type: ignore[type-arg]
    """A number or 'auto'."""

    name = "dim"

    def convert(
        self, value: str | int, param: click.Parameter | None, ctx: click.Context | None
    ) -> int | str:
        if value == "auto" or isinstance(value, int):
            return value
        try:
            return int(value)
        except ValueError:
            self.fail(f"'{value}' is neither a number nor 'auto'", param, ctx)


@click.command("build")
@click.option(
    "--atlas", "atlases", multiple=True, metavar="FILE", help="Measured spectra; may be given several times."
)
@click.option(
    "-o", "--output", metavar="FILE", help="Cube to write. [default: named after atlas and dim, here]"
)
@click.option(
    "--dim",
    default="32",
    type=Dim(),
    show_default=True,
    help="Lattice points along each axis, or 'auto': the smallest, and its axis, with room for every entry.",
)
@click.option(
    "--within",
    default=0.5,
    show_default=True,
    help="With --dim auto: ΔE00 that the lattice may miss entries by.",
)
@click.option("--model", default="moments", show_default=True, help="Spectrum model: moments or sigmoid.")
@click.option(
    "--moments", default=8, show_default=True, help="Moments per spectrum, 2 to 16; one coefficient more."
)
@click.option("--warp", default="none", show_default=True, help="Phase of the moments: none, or vision.")
@click.option("--axis", default="srgb", show_default=True, help="Spacing of the lattice: srgb or linear.")
@sensor_options
@click.option(
    "--light",
    "lights",
    multiple=True,
    help="Lights entries must hold under. [default: D65 A FL2 FL11 LED-B3]",
)
@click.option(
    "--threshold", default=1e-4, show_default=True, help="Largest miss of a lattice point, |linear RGB|."
)
@click.option(
    "--scene",
    "images",
    multiple=True,
    metavar="IMAGE",
    help="Build only what the colours of this image, or quoted pattern, need; may be given several times.",
)
@encoding_option("--scene images are")
@click.option("--plan", "plan_path", metavar="PLAN", help="Build what 'uplift plan' planned.")
@out_of_gamut_option("clip", "linear RGB of --scene images")
@click.option("--debug", is_flag=True, help="Keep the round of every point, for the slices.")
@force_option()
@verbosity_options
def command(
    plan_path: str | None,
    atlases: tuple[str, ...],
    output: str | None,
    images: tuple[str, ...],
    encoding: str,
    way: str,
    force: bool,
    quiet: bool,
    verbose: bool,
    moments: int,
    **chosen: Any,
) -> None:
    """Build an uplifting cube, constrained by measured spectra.

    \b
    Examples:
      uplift build --atlas atlases/macbeth.txt --dim 32
      uplift build --atlas paints.csv --atlas macbeth.txt --moments 16 -o book.uplift
      uplift build --atlas paints.csv --dim auto --within 1
      uplift build --atlas paints.csv --dim 64 --scene wood.png --scene 'shot.*.exr'
      uplift build --model sigmoid --space 'ITU-R BT.2020' -o wide.uplift
      uplift build --plan kitchen.plan.json

    Warnings name entries that were left out, clipped or crowded. Without --atlas the spectra of the cube are
    smooth, and dark where the colour is dark. With --scene the cube is sparse, smaller and sooner built: it answers
    the colours of the images as the whole cube would, and refuses others ('query' and 'texture' have --fill).
    """
    from ..startup import keep_compiled

    keep_compiled()
    from uplift.common.files import check_output
    from uplift.io.scene_colours import Images
    from uplift.pipeline import build

    from ..output.progress import build_progress

    if encoding != "auto" and not images and plan_path is None:
        raise click.UsageError("--encoding is of --scene images, and there are none.")
    if way != "clip" and not images and plan_path is None:
        raise click.UsageError("--out-of-gamut is of --scene images, and there are none.")
    if plan_path is None:
        scene = Images(tuple(map(Path, expanded(images))), encoding, way) if images else None
        given = {name: value for name, value in chosen.items() if value not in (None, ())}
        make: Callable[..., Cube] = partial(
            build, atlases or None, scene=scene, coefficients=moments + 1, **given
        )
        name = _default_name(atlases, images, chosen)
    else:
        make, name = _planned(plan_path, click.get_current_context())
    path = check_output(name if output is None else output, force=force)
    begin = time.perf_counter()
    with build_progress(quiet=quiet, verbose=verbose) as progress:
        cube = make(progress=progress)
    cube.save(path, force=force)
    if verbose:
        tell_improvements(cube)
    if not quiet:
        tell(cube, path, time.perf_counter() - begin)


def _planned(path: str, context: click.Context) -> tuple[Callable[..., Cube], str]:
    """What builds the cube of a plan, and its name. Raises click's error for options that would change it."""
    from uplift.scene.plan import read_plan
    from uplift.scene.plan.commands import cube_name

    said = click.core.ParameterSource.COMMANDLINE
    given = [each for each in context.command.params if context.get_parameter_source(each.name or "") == said]
    if other := [each.opts[-1] for each in given if each.name not in BESIDE_A_PLAN]:
        raise click.UsageError(f"the plan says all of that already: leave out {', '.join(other)}.")
    return partial(read_plan(path).build, debug=context.params["debug"]), cube_name(path)


def _default_name(atlases: tuple[str, ...], images: tuple[str, ...], chosen: dict[str, Any]) -> str:
    stem = "+".join(Path(atlas).stem for atlas in atlases) or re.sub("[ /]", "-", chosen["space"]).lower()
    return f"{stem}-{chosen['dim']}{'-scene' if images else ''}.uplift"
