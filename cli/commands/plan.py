"""``uplift plan``: choose cube, wavelengths and texture format for a scene."""

from pathlib import Path

import click

from .. import options
from ..output.console import json_text, paragraph, print_json, say
from ..output.progress import progress_bar
from ..output.table import Format, Table
from ..outputs import check_outputs
from ..startup import enable_jit_cache

FRONT = {
    "chosen": "",
    "error": "ΔE00",
    "memory": "memory",
    "time": "time",
    "samples": "samples",
    "name": "choice",
}


@click.command(
    "plan",
    help="""Search the cheapest cube, texture format and wavelengths that keep a scene's
    colours within a tolerance.

    SCENE.toml lists textures and, optionally, atlases, lights, the tolerated ΔE00, the
    fraction of pixels that must stay within it, what to minimise (balance, memory, time
    or samples), and limits:

    \b
      textures = ["wood.png", "shot.*.exr"]
      atlases = ["macbeth.txt"]
      lights = ["D65", "FL11"]
      tolerance = 1.0
      quantile = 0.975
      minimise = "memory"
      limits = {samples = 8}

    \b
    Examples:
      uplift plan kitchen.toml
      uplift plan kitchen.toml --quick --force
      uplift plan kitchen.toml --format json --force
      uplift plan kitchen.toml -o other.plan.json

    Candidates that may be on the Pareto front of memory, time, samples and error are
    measured on pixels of the textures and on the entries of the atlases. The cheapest
    sufficient one is confirmed on other pixels: RGB without spectra, a list of spectra,
    or a cube, which 'uplift build --plan' builds.
    """,
)
@click.argument("scene", metavar="SCENE.toml", type=click.Path())
@options.output(
    help="Plan to write. [default: SCENE.plan.json in the folder of the scene]"
)
@options.flag("--quick", help="Fewer candidates, and fewer pixels.")
@options.table_or_json
@options.force
def command(
    scene: str, output: str | None, quick: bool, style: str, force: bool
) -> None:
    enable_jit_cache()
    from uplift.common.files import write_text
    from uplift.extras.pages.format import format_error, format_size
    from uplift.extras.scene.plan import summary
    from uplift.extras.scene.plan.candidates import QUICK, SearchGrid
    from uplift.extras.scene.plan.files import SUFFIX, read_scene_file
    from uplift.extras.scene.plan.planning import plan

    scene_file = read_scene_file(scene)
    path = scene_file.path.with_suffix(SUFFIX) if output is None else Path(output)
    check_outputs(
        path, inputs=(*scene_file.textures, *scene_file.atlases, *scene_file.lamp_files)
    )
    summary.check_path(scene_file, path)
    with progress_bar() as progress:
        result = plan(scene_file, QUICK if quick else SearchGrid(), progress)
    fields = summary.to_json(result, path)
    write_text(json_text(fields) + "\n", path, force=force)
    if style == "json":
        print_json(fields)
    else:
        for line in fields["lines"]:
            say(f"  {line}")
        say()
        paragraph(f"{result.scene.path.name}: {result.chosen.name}")
        paragraph(f"{summary.verdict(result)}. {' '.join(summary.notes(result))}")
        say()
        formats: dict[str, Format] = {
            "error": lambda error: format_error(error["quantile"]),
            "memory": format_size,
            "time": ",.0f",
        }
        Table(summary.front_rows(result), FRONT, formats=formats).print_text()
    say(str(path), err=True)
