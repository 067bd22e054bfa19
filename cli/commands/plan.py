"""``uplift plan``: choose cube, wavelengths and texture format for a scene."""

from pathlib import Path

import click

from .. import options
from ..output.console import json_text, make_table, paragraph, print_json, say, show
from ..output.progress import progress_bar
from ..startup import enable_jit_cache


@click.command("plan")
@click.argument("scene", metavar="SCENE.toml", type=click.Path())
@options.output("Plan to write, with an HTML page of the same name. [default: SCENE.plan.json in the current folder]")
@options.output_format("table", "json")
@options.force
def command(scene: str, output: str | None, style: str, force: bool) -> None:
    """Choose the smallest cube, texture format and wavelengths that keep a scene's colours within a tolerance.

    SCENE.toml lists textures and, optionally, atlases, lights, the tolerated ΔE00 and the fraction of pixels that must
    stay within it:

    \b
      textures = ["wood.png", "shot.*.exr"]
      atlases = ["macbeth.txt"]
      lights = ["D65", "FL11"]
      tolerance = 1.0
      quantile = 0.975

    \b
    Examples:
      uplift plan kitchen.toml
      uplift plan kitchen.toml --format json --force
      uplift plan kitchen.toml -o other.plan.json

    Candidates are measured on pixels of the textures and on the entries of the atlases, in order of cost, up to the
    first sufficient one. The result is then verified on other pixels. 'uplift build --plan' builds the planned cube. An
    HTML page lists all measurements.
    """
    enable_jit_cache()
    from uplift.common.files import check_outputs, write_text
    from uplift.scene.plan import plan, read_scene_file
    from uplift.scene.plan.page import describe_error, describe_metamerism, page, summary_rows, verdict
    from uplift.scene.plan.plan_file import to_json

    path = Path(f"{Path(scene).stem}.plan.json" if output is None else output)
    html = path.with_suffix(".html")
    scene_file = read_scene_file(scene)
    inputs = (scene_file.path, *scene_file.textures, *scene_file.atlases)
    check_outputs((path, html), inputs=inputs, force=force)
    with progress_bar() as progress:
        result = plan(scene_file, progress=progress)
    fields = to_json(result, path)
    write_text(json_text(fields) + "\n", path, force=force)
    write_text(page(result, path), html, force=force)
    if style == "json":
        print_json(fields)
    else:
        worst = result.confirmed.worst
        paragraph(f"{result.scene.path.name}: {verdict(result)} ({worst.group} under {worst.light})")
        say()
        table = make_table()
        for heading in ("smallest sufficient", "", "cumulative ΔE00", "cost", "options"):
            table.add_column(heading, justify="right" if heading == "cumulative ΔE00" else "left")
        for row in summary_rows(result):
            table.add_row(row.title, row.chosen, row.error, row.cost, row.cli_args)
        show(table)
        say()
        for line in fields["lines"]:
            say(f"  {line}")
        say()
        paragraph(f"{describe_error(result)}. {describe_metamerism(result)}")
    say(f"{path}, {html}", err=True)
