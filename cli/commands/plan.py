"""``uplift plan``: choose cube, wavelengths and texture format for a scene."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..options import force_option, format_option
from ..output.console import json_text, make_table, paragraph, print_json, say, show
from ..output.progress import stage_spinner
from ..startup import enable_jit_cache

if TYPE_CHECKING:
    from uplift.scene.plan import Plan


@click.command("plan")
@click.argument("scene", metavar="SCENE.toml", type=click.Path())
@click.option(
    "-o",
    "--output",
    metavar="PLAN",
    help="Plan to write, with an HTML page of the same name. [default: SCENE.plan.json in the current folder]",
)
@format_option("table", "json")
@force_option
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
    from uplift.scene.plan.page import page
    from uplift.scene.plan.plan_file import to_json

    path = Path(f"{Path(scene).stem}.plan.json" if output is None else output)
    html = path.with_suffix(".html")
    scene_file = read_scene_file(scene)
    inputs = (scene_file.path, *scene_file.textures, *scene_file.atlases)
    check_outputs((path, html), inputs=inputs, force=force)
    with stage_spinner() as progress:
        result = plan(scene_file, progress=progress)
    fields = to_json(result, path)
    write_text(json_text(fields) + "\n", path, force=force)
    write_text(page(result, path), html, force=force)
    if style == "json":
        print_json(fields)
    else:
        _print_summary(result, fields["lines"])
    say(f"{path}, {html}", err=True)


def _print_summary(plan: Plan, lines: list[str]) -> None:
    from uplift.scene.plan.page import describe_error, describe_metamerism, summary_rows, verdict

    worst = plan.confirmed.worst
    table = make_table()
    table.add_column("smallest sufficient")
    table.add_column("")
    table.add_column("cumulative ΔE00", justify="right")
    table.add_column("cost")
    table.add_column("options")
    for row in summary_rows(plan):
        table.add_row(row.title, row.chosen, row.error, row.cost, row.cli_args)
    paragraph(f"{plan.scene.path.name}: {verdict(plan)} ({worst.group} under {worst.light})")
    say()
    show(table)
    say()
    for line in lines:
        say(f"  {line}")
    say()
    paragraph(f"{describe_error(plan)}. {describe_metamerism(plan)}")
