"""``uplift passes``: spectral pictures from an RGB renderer."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.extras.images.sequences import expand_patterns

from .. import options
from ..inputs import read_atlases
from ..output.console import paragraph, say
from ..output.diagnostics import warn
from ..output.passes import passes_count, passes_fields, passes_tables
from ..output.progress import progress_bar
from ..output.table import print_result
from ..outputs import check_outputs
from ..startup import enable_jit_cache
from .passes_decoding import decode, passes_argument, recipe

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.extras.scene.passes.materials import Materials
    from uplift.extras.scene.passes.passes import Passes

DEFAULT_FILE = "passes.toml"


@click.group(
    "passes",
    cls=options.Group,
    help="""Render spectra with an RGB renderer, in one to four passes of three bands of
    wavelengths.

    An RGB renderer multiplies three numbers and does not know what they mean. Give it
    the numbers of three bands in each pass, and a matrix turns the pictures of all
    passes into one with the colours of spectra.

    \b
    Examples:
      uplift passes choose --count 2 --light D65 --light HP1 -o p.toml
      uplift texture wood.png --passes p.toml -o w
      uplift query '#da7b2a' --passes p.toml
      uplift passes decode w.1.exr w.2.exr --passes p.toml -o lit.exr
      uplift passes recipe p.toml --for nuke
    """,
)
def command() -> None:
    """Hold the subcommands."""


command.add_command(decode)
command.add_command(recipe)


@command.command(
    "choose",
    help="""Choose the bands of passes for materials and lights, and write them with the
    numbers of the lights and the matrices of the pictures.

    Materials are the colours of images, looked up in a cube, and the entries of
    --atlas; without either, measured materials of the library. Half of them judge the
    choice: the table lists the mean ΔE00 of light after one to four reflections.

    \b
    Examples:
      uplift passes choose --count 3 --light D65 --light HP1 -o three.toml
      uplift passes choose wood.png --cube macbeth-32.uplift -o wood.toml
      uplift passes choose --atlas macbeth --count 1 --format json -o one.toml
    """,
)
@click.argument("images", metavar="[IMAGE]...", nargs=-1)
@click.option(
    "--count",
    type=options.Whole(1, 4),
    default=2,
    metavar="N",
    help="Number of passes, 1 to 4.",
)
@options.light("Light of the scene", "D65 A FL2 FL11 LED-B3")
@options.atlas("Materials of the scene", "the library of measured materials")
@options.cube(
    options.OF_PACKAGE.format(", which the colours of images are looked up in")
)
@click.option(
    "--width",
    type=options.Whole(0, 60),
    metavar="NM",
    help="Standard deviation of the bands in nm; 0 for single wavelengths. "
    "[default: searched]",
)
@click.option(
    "--camera",
    metavar="NAME|FILE",
    help="Camera to whose raw values pictures are decoded as well, by --space camera.",
)
@options.pixels()
@options.output(help="File to write.", default=DEFAULT_FILE)
@options.table_or_json
@options.force
def choose(
    images: Sequence[str],
    count: int,
    lights: Sequence[Illuminant],
    files: Sequence[str],
    cube_path: str | None,
    width: int | None,
    camera: str | None,
    output: str,
    style: str,
    force: bool,
    **pixels: Any,
) -> None:
    from uplift.colorimetry.illuminants import SCENE_LIGHTS
    from uplift.extras.scene import passes as library

    paths = expand_patterns(images)
    check_outputs(output, inputs=paths)
    materials = _materials(paths, files, cube_path, pixels)
    lights = lights or SCENE_LIGHTS
    with progress_bar("choosing bands") as progress:
        chosen = library.choose(
            materials, lights, count, width=width, progress=progress
        )
    if camera is not None:
        chosen = library.with_camera(chosen, materials, lights, camera)
    plain = library.rgb_errors(materials, lights)
    library.write_passes(chosen, output, force=force)
    rgb = [[*row.tolist(), float(row.mean())] for row in plain]
    data = {"output": output, **passes_fields(chosen), "rgb": rgb}
    print_result(style, data, *passes_tables(chosen, {}))
    if style == "json":
        return
    named = passes_count(chosen)
    say()
    paragraph(
        f"Plain RGB rendering is off by a mean ΔE00 of {plain.mean():.2f} on the same "
        f"paths, {named} by {chosen.error:.2f}."
    )
    if chosen.camera is not None:
        name = chosen.camera.name
        paragraph(f"Raw values of {name} are off by {chosen.camera.error:.1%}.")
    say(f"{output}: {named}", err=True)


def _materials(
    paths: Sequence[str],
    files: Sequence[str],
    cube_path: str | None,
    pixels: dict[str, Any],
) -> Materials:
    from uplift.extras.scene.passes.materials import library_materials, scene_materials
    from uplift.extras.texture.scene_colours import Images
    from uplift.lookup.cube import load

    if not paths and not files:
        if cube_path is not None:
            raise click.UsageError(
                "--cube requires IMAGE, whose colours are looked up in it."
            )
        return library_materials()
    enable_jit_cache()
    images = Images(tuple(map(Path, paths)), **pixels) if paths else None
    atlases = read_atlases(files) if files else {}
    return scene_materials(atlases, images, load(cube_path))


@command.command(
    "info",
    help="""Show the bands, the errors and the numbers of lights of passes.

    Numbers of lights that the passes were not chosen for come from their spectra.

    \b
    Examples:
      uplift passes info p.toml
      uplift passes info p.toml --light LED-B3 --light 3200K --format json
    """,
)
@passes_argument
@options.light("Further light", "none")
@options.table_or_json
def info(passes_path: str, lights: Sequence[Illuminant], style: str) -> None:
    from uplift.extras.scene.passes.file import read_passes

    passes = read_passes(passes_path)
    others = {str(light): _light_numbers(passes, light) for light in lights}
    data = {**passes_fields(passes), "other_lights": others}
    print_result(style, data, *passes_tables(passes, others))


def _light_numbers(passes: Passes, light: Illuminant) -> list[float]:
    """Return the numbers of a light, those of the passes if it is one of theirs."""
    import numpy as np

    from uplift.colorimetry.tables import stated_name
    from uplift.common.errors import UnknownNameError, UpliftWarning
    from uplift.extras.scene.passes.passes import scaled_power

    name = stated_name("illuminant", light)
    with contextlib.suppress(UnknownNameError):
        return passes.light(name if isinstance(light, str) else light).numbers.tolist()
    if name in [known.name for known in passes.lights]:
        problem = f"{name} has another spectrum than {name} of the passes"
        hint = "its numbers come from its spectrum; choose the passes with this light"
        warn([UpliftWarning(problem, code="light-changed", hint=hint)])
    numbers = passes.light_numbers(scaled_power(light))
    if (numbers < 0).any():
        problem = f"{name} has negative numbers: they are shown as 0"
        hint = "choose the passes with this light"
        warn([UpliftWarning(problem, code="numbers-negative", hint=hint)])
    return np.maximum(numbers, 0).tolist()
