"""``uplift passes decode`` and ``recipe``: one picture from those of all passes."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from uplift.common.errors import OptionError
from uplift.common.text import pluralise
from uplift.extras.images.sequences import pair_frames

from .. import options
from ..output.console import emit, paragraph, print_json
from ..output.diagnostics import warn
from ..output.progress import progress_bar
from ..outputs import check_outputs

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.extras.scene.passes.decoder import Decoder

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
        type=options.SPACE,
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
        help="Light whose white becomes (1, 1, 1). [default: D65, so that lights keep "
        "their colours]",
    ),
)
"""Options of `_decoder`."""


@click.command(
    "decode",
    help="""Decode the pictures of all passes to one scene-linear picture.

    Pictures are OpenEXR of R, G and B, rendered without a display transform, in the
    order of the passes. A quoted pattern for each pass decodes a sequence into the
    folder of --output, frame by frame. Alpha and other channels of the first picture
    are copied. Negative numbers, which denoisers leave, become 0, and are counted.

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
    from uplift.extras.scene.passes.decode import decode_pictures

    decoder = _decoder(passes_path, **decoding)
    jobs = _jobs(sources, output)
    targets = [target for _, target in jobs]
    if len(jobs) > 1 or targets[0] != Path(output):
        make_folder(output)
    inputs = chain.from_iterable(pictures for pictures, _ in jobs)
    check_outputs(*targets, inputs=list(inputs))
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
    from uplift.extras.scene.passes.decoder import decoder
    from uplift.extras.scene.passes.file import read_passes

    return decoder(read_passes(passes_path), space=space, light=light, white=white)


def _jobs(sources: Sequence[str], output: str) -> list[tuple[tuple[str, ...], Path]]:
    """Return the pictures of all passes of each frame, and the file they become."""
    rows = pair_frames([[source] for source in sources])
    is_sequence = rows != [tuple(sources)]
    target = Path(output)
    if not is_sequence and target.suffix and not target.is_dir():
        if target.suffix.lower() != ".exr":
            raise OptionError(
                f"the name of a decoded picture must end in .exr, got '{output}'",
                hint="give a file name ending in .exr, or a folder",
            )
        return [(rows[0], target)]
    return [(row, target / _frame_name(row[0])) for row in rows]


def _frame_name(path: str) -> str:
    """Return the name of a picture without the number of its pass.

    >>> _frame_name("a.0001.1.exr")
    'a.0001.exr'
    """
    stem = Path(path).stem
    return f"{stem.removesuffix('.1')}.exr"


@click.command(
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
    from uplift.extras.scene.passes.recipe import RECIPES

    emit(RECIPES[tool](_decoder(passes_path, **decoding)), nl=False)
