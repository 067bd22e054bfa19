"""``uplift info``: contents of a cube file."""

import re
import shlex
from typing import Any

import click

from .. import options
from ..output.console import print_fields, print_json, say

DIGEST = re.compile(r"([0-9a-f]{16})[0-9a-f]{48}")
"""A SHA-256, whose first digits are shown; JSON has them all."""


EMPTY: tuple[Any, ...] = (None, [], {})
INTERNAL = (
    "format",
    "lattice_nodes",
    "entry_coefficients",
    "threshold",
    "debug",
    "rounds",
    "prior",
)
"""Facts that are in JSON only: options, too, and what a developer looks for."""
OPTIONS = {
    "auto_tolerance": "tolerance",
    "leave_out": "exclude-family",
    "lights": "light",
}
"""Options of `uplift build` that have another name in Python."""


@click.command(
    "info",
    help="""Show the contents and provenance of a cube file. CUBE defaults to the
    packaged cube.

    \b
    Examples:
      uplift info macbeth-32.uplift
      uplift info macbeth-32.uplift --format json | jq .status
    """,
)
@click.argument("cube", metavar="[CUBE]", required=False, type=options.CUBE)
@options.table_or_json
def command(cube: str | None, style: str) -> None:
    from uplift.cube.file import summarise
    from uplift.lookup.cube import load

    print_facts(cube or "packaged cube", summarise(load(cube).data), style)


def print_facts(name: str, fields: dict[str, Any], style: str) -> None:
    """Print what a file contains as JSON, or as a table below its name."""
    if style == "json":
        print_json(fields)
        return
    provenance = fields.pop("provenance")
    if fields.get("outside"):  # the same names
        del provenance["left_out"]
    settings = provenance.pop("options", {})
    looks = {
        f"look {look['name'].removeprefix('look ')}": _look(look)
        for look in provenance.pop("looks", ())
    }
    facts = fields | looks | provenance
    if "status" in facts:  # of a cube
        facts["model"] = facts["model"]["name"]
        facts["status"] = {
            status: count for status, count in facts["status"].items() if count
        }
        facts["options"] = _as_options(settings)
    say(name)
    print_fields(
        {
            key.replace("_", " "): _text(value)
            for key, value in facts.items()
            if key not in INTERNAL and value not in EMPTY
        }
    )


def _as_options(settings: dict[str, Any]) -> str:
    """Return recorded parameters of `uplift.build` as options of `uplift build`."""
    settings.pop("start", None)  # of earlier versions
    first = settings.pop("shortest", 380)
    last = settings.pop("longest", 780)
    words = []
    for key, value in (settings | {"range": f"{first:g}:{last:g}"}).items():
        option = shlex.quote("--" + OPTIONS.get(key, key).replace("_", "-"))
        if isinstance(value, bool):
            words += [option] * value
        else:
            for item in value if isinstance(value, list) else [value]:
                name = item["name"] if isinstance(item, dict) else item
                text = f"{name:g}" if isinstance(name, float) else str(name)
                words.append(f"{option} {shlex.quote(text)}")
    return " ".join(words)


def _look(record: dict[str, Any]) -> str:
    """Format a look: wish and distance of the answer by light."""
    import numpy as np

    from uplift.extras.colour.srgb import hex_codes

    facts = [] if record["weight"] == 1 else [f"weight {record['weight']:g}"]
    for light in record["lights"]:
        [code] = hex_codes(np.array([light["wish"]]))
        facts.append(f"{light['light']} {code} (ΔE00 {light['delta_e']:.2f})")
    return ", ".join(facts)


def _text(value: Any) -> str:
    """Format a value, nested or not, on one line with three significant digits."""
    if isinstance(value, int):
        return f"{value:,}"
    if isinstance(value, dict):
        return ", ".join(f"{key} {_text(inner)}" for key, inner in value.items())
    if isinstance(value, list):
        return "; ".join(_text(inner) for inner in value)
    if isinstance(value, float):
        return f"{value:.3g}"
    return DIGEST.sub(r"\1…", str(value))
