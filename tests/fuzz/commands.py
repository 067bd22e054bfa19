"""Fuzz target of the command line: names that terminals, spreadsheets, pages or figures
may obey.
"""

import contextlib
import csv
import io
import json
import os
import re
import tempfile
import warnings
from collections import Counter
from pathlib import Path
from typing import Any
from unittest import mock

from click.testing import CliRunner, Result
from uplift_cli.main import main

from tests.atlas.atlas_texts import PLAIN
from tests.cube.cube_files import forge
from tests.fuzz.fuzzing import ROOT, Random, Target, choose, fuzz
from tests.fuzz.readers import CHART, CUBES, READERS
from uplift.common.errors import UpliftError
from uplift.common.text import printable

TOKENS = (
    "\x1b]52;c;cm0gLXJm\x07", "\x1b[31m", "\x9b2J", "\r", "\n", "\0", "\t", "\b",
    "\x85", "\u202e", "\u2066", "\u200f", "\u2028", "\ufeff", "\ud800", "\udcff",
    "\U000e0041",
    "[/]", "[red]x[/red]", ":smile:", r"$\frac{A$", "$", r"\$", "_x", "%s", "{0}", "{",
    "{{ 1 }}", "{% raw %}", "</script>", "&amp;", '"', "'", "=1+2", "+1", "-x", "@x",
    "|", ",", ";", "\\", "\\n", "*/", "??/", "#", "Entry ID:", "../..", "~", "青",
    "e\u0301", "👩\u200d🔬", "العربية", "a" * 300, " ", "a", "grey", "", "nan",
    "--force", "-",
)  # fmt: skip
"""Parts of names that terminals, spreadsheets, templates, browsers or parsers may obey.
"""
CUBE_NAME = "c.uplift"
PALETTE = """[[lights]]
name = {name}
illuminant = "D65"
[[materials]]
name = {name}
rgb = [0.2, 0.3, 0.4]
"""
LINES = """\
info c.uplift
info c.uplift --format json
query --cube c.uplift 0.2 0.3 0.4
query --cube c.uplift --input colours.csv
query --cube c.uplift --input colours.csv --format json
query --cube c.uplift --input colours.csv --format csv
query --cube c.uplift --input colours.csv --plot x.png
query {}
query --cube {} 0 0 0
query --input {}
{}
--{}
query --{}
query 0 0 0 --wavelengths {}
query 0 0 0 --input-space {}
query 0 0 0 --plot {}/x.png
atlas a.txt
atlas a.txt --format json
atlas a.txt --format csv
atlas a.csv -o b.csv
atlas a.csv a.txt
atlas {}
atlas a.txt --observer {}
paints mix 1:{} 1:#ff0000 --atlas a.csv
paints mix {}:#ff0000 --ground {}
lab wavelengths --count 3 --atlas a.csv
lab wavelengths --count 3 --light {}
lab palette p.toml
lab palette p.toml --format json
lab palette p.toml --plot m.png --plot-spectra s.png
lab palette p.toml --html p.html --label {}
chart --recommend --tolerance 1 --from chart.csv
chart --recommend --light {}
export c.uplift -o x.csv
export c.uplift -o x.h
report c.uplift --format json
check c.uplift{}
plan {}
plan p.toml
build --plan p.toml
build --space {} --dim 4
build --atlas {} --dim 4
texture {} -o x.exr
""".splitlines()
"""Commands, in which ``{}`` is a hostile text."""


def check_csv(text: str) -> None:
    """Check that no cell is a formula. Raises ValueError."""
    for row in csv.reader(io.StringIO(text, newline="")):
        for cell in row:
            if cell.startswith(tuple("=+-@\t\r")) and not re.fullmatch(
                r"[+-]?[\d.]+(e[+-]?\d+)?", cell
            ):
                raise ValueError("a cell that is a formula")


def _check(result: Result) -> None:
    """Check what a run printed. Raises `UpliftError` for rejected input, ValueError for
    what it must not print.
    """
    lines = (result.stdout + "\n" + result.stderr).split("\n")
    if any(printable(line) != line for line in lines):
        raise ValueError("a control character")
    errors = [
        line for line in result.stderr.splitlines() if not line.startswith("warning: ")
    ]
    if result.exit_code not in (0, 1, 2):
        raise ValueError(f"exit code {result.exit_code}")
    if len(errors) > 1 or (result.exit_code == 2 and not errors):
        raise ValueError(f"{len(errors)} lines of an error")
    if result.exit_code == 2:
        if not errors[0].startswith("error: ") and "error" not in json.loads(errors[0]):
            raise ValueError("no error")
        raise UpliftError("rejected")


def _hostile_text(random: Random) -> str:
    return "".join(choose(random, TOKENS) for _ in range(random.integers(1, 5)))


def _generate(random: Random, path: Path) -> None:
    name = _hostile_text(random)
    other = _hostile_text(random)
    cells = ['"' + text.replace('"', '""') + '"' for text in (name, other)]
    files = {
        CUBE_NAME: "\0\0".join((name, other, choose(random, ("D65", name)))),
        "a.txt": "".join(PLAIN.replace("grey", text, 1) for text in (name, other)),
        "a.csv": (
            "name,400,500,600,700\n"
            f"{cells[0]},0.1,0.2,0.3,0.4\n{cells[1]},0.2,0.3,0.4,0.5\n"
        ),
        "chart.csv": CHART.decode().replace("Mallett", name).replace("uplift", other),
        "p.toml": PALETTE.format(name=json.dumps(name)),
        "colours.csv": choose(
            random,
            ("0.2,0.3,0.4\n", f"{name}\n", f"0.1,0.2,0.3,{name}\n#fff {other}\n"),
        ),
    }
    # As the system passes arguments.
    argument = name.replace("\0", "").replace("\ud800", "\udcff")
    args = [word.replace("{}", argument) for word in choose(random, LINES).split()]
    case = {
        "args": args,
        "files": {file: text for file, text in files.items() if file in args},
    }
    path.write_text(json.dumps(case), encoding="ascii")


def _forge_cube(text: str) -> None:
    """Write a cube whose metadata has hostile names."""
    name, other, light = text.encode(errors="replace").decode().split("\0\0")

    def change(tensors: dict[str, Any], metadata: dict[str, Any]) -> None:
        metadata["entries"][:2] = [name, other]
        metadata["provenance"]["left_out"] = [name, other]
        metadata["illuminant"] = light
        for atlas in metadata["provenance"]["atlases"]:
            atlas["name"] = name

    forge(CUBES[0], Path(CUBE_NAME), change)


def _use(path: Path) -> None:
    case = json.loads(path.read_text(encoding="ascii"))
    with (
        tempfile.TemporaryDirectory(dir=path.parent) as folder,
        contextlib.chdir(folder),
    ):
        for name, text in case["files"].items():
            if name == CUBE_NAME:
                _forge_cube(text)
            else:
                errors = "surrogatepass" if "\ud800" in text else "surrogateescape"
                Path(name).write_text(text, "utf-8", errors, newline="")
        with (
            mock.patch.dict(os.environ, {"UPLIFT_TRACEBACK": "1"}),
            warnings.catch_warnings(action="ignore"),
        ):
            result = CliRunner().invoke(main, case["args"], catch_exceptions=False)
    if case["args"][-2:] == ["--format", "csv"]:
        check_csv(result.stdout)
    if case["args"][-2:] == ["--format", "json"] and result.exit_code == 0:
        json.loads(result.stdout)
    _check(result)


COMMANDS = {"hostile text": Target("hostile text", _generate, _use)}
KEPT = ROOT / "out" / "fuzz"
"""Folder of inputs that failed."""


def run_target(name: str, inputs: range) -> Counter[str]:
    """Run a target of readers or commands with numbered inputs."""
    with tempfile.TemporaryDirectory() as folder:
        return fuzz((READERS | COMMANDS)[name], 0, inputs, Path(folder), KEPT)
