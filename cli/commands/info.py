"""``uplift info``: contents of a cube file."""

import re
from typing import Any

import click

from .. import options
from ..output.console import print_fields, print_json, say

DIGEST = re.compile(r"([0-9a-f]{16})[0-9a-f]{48}")
"""A SHA-256, whose first digits are shown; JSON has them all."""


@click.command(
    "info",
    help="""Show the contents and provenance of a cube file. CUBE defaults to the packaged cube.

    \b
    Examples:
      uplift info macbeth-32.uplift
      uplift info macbeth-32.uplift --format json | jq .status
    """,
)
@click.argument("cube", metavar="[CUBE]", required=False, shell_complete=options.complete_cube)
@options.output_format("table", "json")
def command(cube: str | None, style: str) -> None:
    from uplift.cube import summarise
    from uplift.lookup import load

    print_facts(cube or "packaged cube", summarise(load(cube).data), style)


def print_facts(name: str, fields: dict[str, Any], style: str) -> None:
    """Print what a file contains as JSON, or as a table below its name."""
    if style == "json":
        print_json(fields)
        return
    provenance = fields.pop("provenance")
    if fields.get("outside"):  # the same names
        provenance = {key: value for key, value in provenance.items() if key != "left_out"}
    settings = {f"option {key}": value for key, value in provenance.pop("options", {}).items()}
    looks = {f"look {each['name'].removeprefix('look ')}": _look(each) for each in provenance.pop("looks", ())}
    say(name)
    print_fields(
        {key.replace("_", " "): _text(value) for key, value in (fields | looks | provenance | settings).items()}
    )


def _look(record: dict[str, Any]) -> str:
    """Format a look: wish and distance of the answer by light."""
    import numpy as np

    from uplift.colorimetry.srgb import hex_codes

    wishes = (
        f"{each['light']} {hex_codes(np.array([each['wish']]))[0]} (ΔE00 {each['delta_e']:.2f})"
        for each in record["lights"]
    )
    weight = "" if record["weight"] == 1 else f"weight {record['weight']:g}, "
    return weight + ", ".join(wishes)


def _text(value: Any) -> str:
    """Format a value, nested or not, on one line with three significant digits."""
    if value is None or value in ([], {}):
        return "none"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, dict):
        return ", ".join(f"{key} {_text(inner)}" for key, inner in value.items())
    if isinstance(value, list):
        return "; ".join(_text(inner) for inner in value)
    if isinstance(value, float):
        return f"{value:.3g}"
    return DIGEST.sub(r"\1…", str(value))
