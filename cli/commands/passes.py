"""``uplift passes``: spectral pictures from an RGB renderer."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.errors import OptionError
from uplift.common.text import pluralise

from .. import options
from ..inputs import expand_patterns, read_atlases
from ..output.console import emit, make_table, paragraph, print_json, say, show
from ..output.diagnostics import warn
from ..output.progress import progress_bar
from ..outputs import check_outputs
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.common.arrays import Array
    from uplift.extras.scene.passes import Decoder, Materials, Passes

BOUNCES = ("1 bounce", "2", "3", "4", "mean")
DEFAULT_FILE = "passes.toml"

passes_argument = click.argument(
    "passes_path", metavar="PASSES.toml", type=click.Path()
)
passes_option = click.option(
    "--passes",
    "passes_path",
    metavar="FILE",
    required=True,
    type=click.Path(),
    help="Passes by 'uplift passes choose'.",
)
decoding_options = options.stacked(
    click.option(
        "--space",
        default="sRGB",
        shell_complete=options.complete_space,
        help="Linear RGB space of the result, such as ACEScg, or XYZ, or camera for "
        "the raw values of 'choose --camera'.",
    ),
    click.option(
        "--light",
        metavar="NAME",
        help="The only light of the scene, one of those of the passes: its own matrix "
        "is a little more accurate. [default: the matrix of all lights]",
    ),
    click.option(
        "--white",
        metavar="NAME|FILE",
        type=options.LIGHT,
        shell_complete=options.complete_light,
        help="Light whose white becomes (1, 1, 1). [default: D65, so that lights keep "
        "their colours]",
    ),
)
"""Options of `_decoder`."""


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
    if style == "json":
        print_json({"output": output, **_fields(chosen), "rgb": _mean_rows(plain)})
        return
    _print_passes(chosen)
    say()
    paragraph(
        f"Plain RGB rendering is off by a mean ΔE00 of {plain.mean():.2f} on the same "
        f"paths, {_count_text(chosen)} by {chosen.error:.2f}."
    )
    if chosen.camera is not None:
        name = chosen.camera.name
        paragraph(f"Raw values of {name} are off by {chosen.camera.error:.1%}.")
    say(f"{output}: {_count_text(chosen)}", err=True)


def _materials(
    paths: Sequence[str],
    files: Sequence[str],
    cube_path: str | None,
    pixels: dict[str, Any],
) -> Materials:
    from uplift.extras.scene.passes import library_materials, scene_materials
    from uplift.extras.texture.scene_colours import Images
    from uplift.lookup import load

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


def _count_text(passes: Passes) -> str:
    return "1 pass" if passes.count == 1 else f"{passes.count} passes"


def _mean_rows(errors: Array) -> list[list[float]]:
    return [[*row.tolist(), float(row.mean())] for row in errors]


def _fields(passes: Passes) -> dict[str, Any]:
    """Return the contents of passes as JSON values."""
    from uplift.extras.scene.passes import passes_digest

    lights = {}
    for light in passes.lights:
        lights[light.name] = {
            "numbers": light.numbers.tolist(),
            "to_xyz": light.to_xyz.tolist(),
            "errors": light.errors.tolist(),
            "own_errors": light.own_errors.tolist(),
        }
    camera = None
    if passes.camera is not None:
        camera = {
            "name": passes.camera.name,
            "matrix": passes.camera.matrix.tolist(),
            "error": passes.camera.error,
        }
    return {
        "count": passes.count,
        "digest": passes_digest(passes),
        "centres": list(passes.bands.centres),
        "width": passes.bands.width,
        "to_xyz": passes.to_xyz.tolist(),
        "error": passes.error,
        "materials": dict(passes.origin),
        "lights": lights,
        "camera": camera,
    }


def _print_passes(passes: Passes) -> None:
    title = f"centres in nm, width {passes.bands.width:g} nm, and numbers of lights"
    bands = make_table(("",), ("R", "G", "B"), title=title)
    for number in range(passes.count):
        rows = slice(3 * number, 3 * number + 3)
        centres = [f"{centre:g} nm" for centre in passes.bands.centres[rows]]
        bands.add_row(f"pass {number + 1}", *centres)
        for light in passes.lights:
            bands.add_row(light.name, *map("{:.5g}".format, light.numbers[rows]))
    held_out = pluralise(passes.origin.get("held-out", 0), "material")
    title = f"mean ΔE00 on {held_out} that the choice did not use"
    table = make_table(("light",), BOUNCES, title=title)
    table.add_column("alone, mean")
    for light in passes.lights:
        cells = [*light.errors.tolist(), light.errors.mean(), light.own_errors.mean()]
        table.add_row(light.name, *map("{:.2f}".format, cells))
    show(bands, table)


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
    from uplift.extras.scene.passes import read_passes

    passes = read_passes(passes_path)
    others = {str(light): _light_numbers(passes, light) for light in lights}
    if style == "json":
        print_json({**_fields(passes), "other_lights": others})
        return
    _print_passes(passes)
    for name, numbers in others.items():
        _print_numbers(name, numbers)


def _light_numbers(passes: Passes, light: Illuminant) -> list[float]:
    """Return the numbers of a light, those of the passes if it is one of theirs."""
    import numpy as np

    from uplift.colorimetry.tables import stated_name
    from uplift.extras.scene.passes import scaled_power

    name = stated_name("illuminant", light)
    for known in passes.lights:
        if known.name == name:
            return known.numbers.tolist()
    numbers = passes.light_numbers(scaled_power(light))
    if (numbers < 0).any():
        from uplift.common.errors import UpliftWarning

        problem = f"{name} has negative numbers: they are shown as 0"
        hint = "choose the passes with this light"
        warn([UpliftWarning(problem, code="numbers-negative", hint=hint)])
    return np.maximum(numbers, 0).tolist()


def _print_numbers(name: str, numbers: Sequence[float]) -> None:
    for row in range(0, len(numbers), 3):
        values = " ".join(map("{:.6g}".format, numbers[row : row + 3]))
        say(f"{name}, pass {row // 3 + 1}: {values}")


@command.command(
    "decode",
    help="""Decode the pictures of all passes to one scene-linear picture.

    Pictures are OpenEXR of R, G and B, rendered without a display transform, in the
    order of the passes. A quoted pattern for each pass decodes a sequence into the
    folder of --output. Alpha and other channels of the first picture are copied.
    Negative numbers, which denoisers leave, become 0, and are counted.

    \b
    Examples:
      uplift passes decode w.1.exr w.2.exr --passes p.toml --space XYZ -o a.exr
      uplift passes decode w.1.exr w.2.exr --passes p.toml --white A -o b.exr
      uplift texture 'shot.*.exr' --passes p.toml -o shots
      uplift passes decode 'shots/*.1.exr' 'shots/*.2.exr' --passes p.toml -o out
    """,
)
@click.argument("sources", metavar="PICTURE...", nargs=-1, required=True)
@passes_option
@decoding_options
@options.choice("--depth", "float", "half", help="32 or 16 bits per channel.")
@options.output(help="OpenEXR file, or folder of a sequence.", required=True)
@options.table_or_json
@options.force
@options.quiet
def decode(
    sources: Sequence[str],
    passes_path: str,
    depth: str,
    output: str,
    style: str,
    force: bool,
    quiet: bool,
    **decoding: Any,
) -> None:
    from uplift.extras.files.outputs import make_folder
    from uplift.extras.scene.passes import decode_pictures

    decoder = _decoder(passes_path, **decoding)
    jobs = _jobs(sources, output, decoder.passes.count)
    targets = [target for _, target in jobs]
    if len(jobs) > 1 or targets[0] != Path(output):
        make_folder(output)
    every = [path for pictures, _ in jobs for path in pictures]
    check_outputs(*targets, inputs=every)
    pixels = 0
    for pictures, target in jobs:
        with progress_bar("rows", quiet=quiet or style == "json") as progress:
            decoded = decode_pictures(
                decoder, pictures, target, depth=depth, force=force, progress=progress
            )
        warn(decoded.warnings)
        pixels += decoded.counts.pixels
    if style == "json":
        print_json({"output": [str(target) for target in targets], "pixels": pixels})
    elif not quiet:
        counts = f"{pluralise(len(jobs), 'picture')}, {pluralise(pixels, 'pixel')}"
        paragraph(f"{output}: {counts}")


def _decoder(
    passes_path: str, space: str, light: str | None, white: Illuminant | None
) -> Decoder:
    from uplift.extras.scene.passes import decoder, read_passes

    return decoder(read_passes(passes_path), space=space, light=light, white=white)


def _jobs(
    sources: Sequence[str], output: str, count: int
) -> list[tuple[list[str], Path]]:
    """Return the pictures of all passes of each frame, and the file they become."""
    from uplift.common.errors import PassesError

    columns = [expand_patterns([source]) for source in sources]
    frames = {len(column) for column in columns}
    if len(frames) > 1:
        found = ", ".join(str(len(column)) for column in columns)
        raise PassesError(
            f"all passes must have as many pictures, got {found}",
            code="passes-missing",
            hint="render the missing pictures, or name one pattern per pass",
        )
    is_sequence = [[source] for source in sources] != columns
    target = Path(output)
    if not is_sequence and target.suffix and not target.is_dir():
        if target.suffix.lower() != ".exr":
            raise OptionError(
                f"the name of a decoded picture must end in .exr, got '{output}'",
                hint="give a file name ending in .exr, or a folder",
            )
        return [(list(sources), target)]
    rows = [list(row) for row in zip(*columns, strict=True)]
    return [(row, target / _frame_name(row[0])) for row in rows]


def _frame_name(path: str) -> str:
    """Return the name of a picture without the number of its pass.

    >>> _frame_name("a.0001.1.exr")
    'a.0001.exr'
    """
    stem = Path(path).stem
    return f"{stem.removesuffix('.1')}.exr"


@command.command(
    "recipe",
    help="""Print how a compositor decodes passes: matrices whose results are added, as
    text, as nodes of Nuke, or as a script for Blender.

    \b
    Examples:
      uplift passes recipe p.toml
      uplift passes recipe p.toml --for nuke > decode.nk
      uplift passes recipe p.toml --for blender --space ACEScg > decode.py
    """,
)
@passes_argument
@options.choice(
    "--for",
    "text",
    "nuke",
    "blender",
    name="tool",
    help="Tool that reads the recipe.",
)
@decoding_options
def recipe(passes_path: str, tool: str, **decoding: Any) -> None:
    from uplift.extras.scene.passes import RECIPES

    emit(RECIPES[tool](_decoder(passes_path, **decoding)), nl=False)


@command.command(
    "page",
    help="""Write a page that draws a room with WebGL, as RGB and in two passes, with
    sliders for the light.

    The paints of the room are those of a ColorChecker. The passes must be two, with two
    lights or more: the first is mixed with one of the others.

    \b
    Examples:
      uplift passes page p.toml -o room.html
    """,
)
@passes_argument
@options.output(
    help="Page to write.", default="room.html", type=options.PAGE, show_default=True
)
@options.force
def page(passes_path: str, output: str, force: bool) -> None:
    from uplift.atlas import on_grid, read_atlas
    from uplift.colorimetry import observer
    from uplift.common.files import write_text
    from uplift.extras.scene.passes import read_passes
    from uplift.extras.scene.passes.browser_page import page

    check_outputs(output)
    checker = on_grid(read_atlas("macbeth"), observer.grid())
    write_text(page(read_passes(passes_path), checker), output, force=force)
    say(f"{output}: room in two passes", err=True)
