"""``uplift plan``: the least that will do for a scene, measured on its own colours."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..output.console import console, json_text
from ..output.progress import stage_spinner
from ..params.options import force_option, format_option

if TYPE_CHECKING:
    from uplift.scene.plan import Plan


@click.command("plan")
@click.argument("scene", metavar="SCENE.toml", type=click.Path())
@click.option(
    "-o", "--output", metavar="PLAN", help="Plan to write. [default: SCENE.plan.json, here; a page beside it]"
)
@format_option("text", "json")
@force_option()
def command(scene: str, output: str | None, style: str, force: bool) -> None:
    """Plan a scene: the least cube, pixel and wavelengths that keep its colours within a tolerance.

    SCENE.toml names textures and, unless the defaults will do, atlases, lights, the tolerated ΔE00 and the share of
    pixels that must stay within it:

    \b
      textures = ["wood.png", "shot.*.exr"]
      atlases = ["macbeth.txt"]
      lights = ["D65", "FL11"]
      tolerance = 1.0
      quantile = 0.975

    \b
    Examples:
      uplift plan kitchen.toml
      uplift plan kitchen.toml --format json
      uplift plan kitchen.toml -o plans/kitchen.plan.json --force

    Everything is measured on pixels of the textures and on the atlas's materials, from the least candidate to the
    first that will do, and the whole chain once more on other pixels. 'uplift build --plan' builds what the plan
    says; a page with all measurements, .html, lies beside it.
    """
    from ..startup import keep_compiled

    keep_compiled()
    from uplift.common.files import check_output, write_text
    from uplift.scene.plan import plan, read_scene_file, to_json
    from uplift.scene.plan.page import page

    path = Path(f"{Path(scene).stem}.plan.json" if output is None else output)
    html = path.with_suffix(".html")
    for each in (path, html):
        check_output(each, force=force)
    scene_file = read_scene_file(scene)
    with stage_spinner() as progress:
        found = plan(scene_file, progress=progress)
    told = to_json(found, path)
    write_text(json_text(told) + "\n", path, force=force)
    write_text(page(found, path), html, force=force)
    if style == "json":
        click.echo(json_text(told))
    else:
        _tell(found, told["lines"])
    click.echo(f"{path}, {html}", err=True)


def _tell(found: Plan, lines: list[str]) -> None:
    from rich import box
    from rich.table import Table

    from uplift.scene.plan.summary import (
        describe_error,
        describe_metamerism,
        summary_rows,
        verdict,
        worst_case,
    )

    table = Table(box=box.SIMPLE_HEAD)
    table.add_column("the least that will do")
    table.add_column("")
    table.add_column("ΔE00 so far", justify="right", no_wrap=True)
    table.add_column("cost")
    table.add_column("say")
    for row in summary_rows(found):
        table.add_row(row.title, row.chosen, row.error, row.cost, row.cli_args)
    click.echo(f"{found.scene.path.name}: {verdict(found)} ({worst_case(found.confirmed)})")
    console().print(table)
    for line in lines:
        click.echo(f"  {line}")
    click.echo(f"\n{describe_error(found)}. {describe_metamerism(found)}")
