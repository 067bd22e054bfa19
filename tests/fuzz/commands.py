"""Fuzz targets of the command line: names that terminals, pages or figures may obey, and outputs that are inputs."""

from __future__ import annotations

import contextlib
import csv
import io
import json
import os
import re
import shutil
import tempfile
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any
from unittest import mock

from click.testing import CliRunner, Result
from uplift_cli.main import main

from tests.cube.cube_files import forge
from tests.fuzz.campaign import ROOT, Target
from tests.fuzz.cubes import SEEDS
from tests.fuzz.mutate import Random, choose
from tests.fuzz.texts import ART_ENTRY, REGULAR, SAMPLES
from uplift.common.errors import UpliftError
from uplift.common.text import printable

TOKENS = (
    "\x1b]0;title\x07", "\x1b]52;c;cm0gLXJm\x07", "\x1b[2J", "\x1b[31m", "\x9b2J", "\r", "\n", "\0", "\t", "\x7f",
    "\b", "\x85", "\u202e", "\u2066", "\u200f", "\u2028", "\ufeff", "\ud800", "\udcff", "\U000e0041", "\uffff", "[/]",
    "[bold]", "[red]x[/red]", "[link=x]", ":smile:", r"$\frac{A$", "$", "$x^2$", r"\$", "_x", "%s", "%", "{0}", "{",
    "{{ 1 }}", "{% raw %}", "</script>", "<b>", "&amp;", '"', "'", "=1+2", "+1", "-x", "@x", "|", ",", ";", "\\",
    "\\n", "*/", "??/", "//", "#", "Entry ID:", "../..", "~", "青", "é", "e\u0301", "👩\u200d🔬", "العربية", "a" * 300,
    " ", "a", "grey", "", "nan", "--force", "-",
)  # fmt: skip
"""Parts of names that terminals, spreadsheets, templates, browsers or parsers may obey."""
CUBE, ATLAS, TABLE, CHART, SPEC, COLOURS = "c.uplift", "a.txt", "a.csv", "chart.csv", "p.toml", "colours.csv"
CHART_TEXT = (ROOT / "uplift" / "lab" / "chart" / "measured.csv").read_text(encoding="utf-8")
PALETTE = """[[lights]]
name = {name}
illuminant = "D65"
[[materials]]
name = {name}
rgb = [0.2, 0.3, 0.4]
"""
COMMANDS = (
    "info c.uplift", "info c.uplift --format json", "query --cube c.uplift 0.2 0.3 0.4",
    "query --cube c.uplift --input colours.csv", "query --cube c.uplift --input colours.csv --format json",
    "query --cube c.uplift --input colours.csv --format csv", "query --cube c.uplift --input colours.csv --plot x.png",
    "query {}", "query --cube {} 0 0 0", "query --input {}", "{}", "--{}", "query --{}", "query 0 0 0 --wavelengths {}",
    "query 0 0 0 --input-space {}", "query 0 0 0 --format {}", "query 0 0 0 --plot {}/x.png", "atlas a.txt",
    "atlas a.txt --format json", "atlas a.txt --format csv", "atlas a.csv", "atlas a.csv --format csv",
    "atlas a.csv -o b.csv", "atlas a.csv a.txt", "atlas {}", "atlas a.txt --space {}", "atlas a.txt --observer {}",
    "mix 1:{} --cube c.uplift", "mix 1:{} 1:#ff0000 --atlas a.csv", "mix {}:#ff0000 --ground {}",
    "wavelengths --count 3 --atlas a.csv", "wavelengths --count 3 --light {}", "palette p.toml",
    "palette p.toml --format json", "palette p.toml --plot m.png --plot-spectra s.png", "palette p.toml --html p.html",
    "palette p.toml --html p.html --label {}", "chart --recommend --tolerance 1 --from chart.csv",
    "chart --recommend --light {}", "export c.uplift -o x.csv", "export c.uplift -o x.h", "export c.uplift -o x.npz",
    "report c.uplift --format json", "check c.uplift{}", "plan {}", "plan p.toml", "build --plan p.toml",
    "build --model {} --dim 4", "build --space {} --dim 4", "build --atlas {} --dim 4", "texture {} -o x.exr",
)  # fmt: skip
"""Commands, in which ``{}`` is a hostile text."""


def run(args: Sequence[str]) -> Result:
    """Run ``uplift`` in this process; an internal error is raised."""
    with mock.patch.dict(os.environ, {"UPLIFT_TRACEBACK": "1"}), warnings.catch_warnings(action="ignore"):
        return CliRunner().invoke(main, list(args), catch_exceptions=False)


def check(result: Result) -> None:
    """Check what a run printed. Raises `UpliftError` for rejected input, ValueError for what it must not print."""
    if any(printable(line) != line for line in (result.stdout + "\n" + result.stderr).split("\n")):
        raise ValueError("a control character")
    errors = [line for line in result.stderr.splitlines() if not line.startswith("warning: ")]
    if result.exit_code not in (0, 1, 2):
        raise ValueError(f"exit code {result.exit_code}")
    if len(errors) > 1 or (result.exit_code == 2 and not (errors and _is_error(errors[0]))):
        raise ValueError(f"{len(errors)} lines of an error")
    if result.exit_code == 2:
        raise UpliftError("rejected")


def _is_error(line: str) -> bool:
    return line.startswith("error: ") or "error" in json.loads(line)


def check_csv(text: str) -> None:
    """Check that no cell is a formula. Raises ValueError."""
    for row in csv.reader(io.StringIO(text, newline="")):
        for cell in row:
            if cell[:1] in tuple("=+-@\t\r") and cell and not re.fullmatch(r"[+-]?[\d.]+(e[+-]?\d+)?", cell):
                raise ValueError("a cell that is a formula")


def _hostile(random: Random) -> str:
    return "".join(choose(random, TOKENS) for _ in range(int(random.integers(1, 5))))


def _generate_names(random: Random, path: Path) -> None:
    command = choose(random, COMMANDS)
    name, other = _hostile(random), _hostile(random)
    argument = name.replace("\0", "").replace("\ud800", "\udcff")  # as the system passes arguments
    files = {
        CUBE: json.dumps([name, other, int(random.integers(4))]),
        ATLAS: "".join(ART_ENTRY % (each, *REGULAR) for each in (name, other)),
        TABLE: f"name,400,500,600,700\n{_cell(name)},0.1,0.2,0.3,0.4\n{_cell(other)},0.2,0.3,0.4,0.5\n",
        CHART: CHART_TEXT.replace("Mallett", name).replace("uplift", other),
        SPEC: PALETTE.format(name=json.dumps(name)),
        COLOURS: choose(random, ("0.2,0.3,0.4\n0.1,0.1,0.1\n", f"{name}\n", f"0.1,0.2,0.3,{name}\n#ffffff {other}\n")),
    }
    args = [word.replace("{}", argument) for word in command.split()]
    case = {"args": args, "files": {file: text for file, text in files.items() if file in args}}
    path.write_text(json.dumps(case), encoding="ascii")


def _cell(text: str) -> str:
    return '"' + text.replace('"', '""') + '"'


def _make_file(text: str, path: Path) -> None:
    """Write a file of a case: a cube whose metadata has its names in some places, any other one as it is."""
    if path.name != CUBE:
        path.write_bytes(text.encode("utf-8", "surrogatepass" if "\ud800" in text else "surrogateescape"))
        return
    name, other, place = json.loads(text.replace("\\ud800", "?").replace("\\udcff", "?"))

    def change(tensors: dict[str, Any], metadata: dict[str, Any]) -> None:
        metadata["entries"][:2] = [name, other]
        if place == 1:
            for atlas in metadata["provenance"]["atlases"]:
                atlas["name"] = name
        elif place == 2:
            metadata["provenance"]["left_out"] = [name, other]
        elif place == 3:
            metadata["illuminant"] = name

    forge(SEEDS[0], path, change)


def _use_names(path: Path) -> None:
    case = json.loads(path.read_text(encoding="ascii"))
    with tempfile.TemporaryDirectory(dir=path.parent) as folder, contextlib.chdir(folder):
        for name, text in case["files"].items():
            _make_file(text, Path(name))
        result = run(case["args"])
    if case["args"][-2:] == ["--format", "csv"]:
        check_csv(result.stdout)
    if case["args"][-2:] == ["--format", "json"] and result.exit_code == 0:
        json.loads(result.stdout)
    check(result)


INPUTS = {
    "c.uplift": ROOT / "cubes" / "moments-8.uplift",
    "a.txt": ROOT / "atlases" / "macbeth.txt",
    "b.txt": ROOT / "atlases" / "rawtoaces.txt",
    "p.toml": SAMPLES / "metamers.toml",
    "chart.csv": ROOT / "uplift" / "lab" / "chart" / "measured.csv",
}
IMAGE, SCENE = "i.png", "s.toml"
WRITERS = (
    "query --cube c.uplift 0 0 0 --plot {}", "query --input colours.csv --plot {}",
    "export c.uplift -o {} --format csv", "export c.uplift -o {} --format npz", "export c.uplift -o {} --format c",
    "atlas a.txt b.txt -o {}", "palette p.toml -o {}", "palette p.toml --plot {}", "palette p.toml --html {}",
    "palette p.toml --plot x.png --plot-spectra {}", "report c.uplift --atlas a.txt -o {}",
    "report c.uplift --format json -o {}", "slices c.uplift -o {}", "slices c.uplift --plot {}",
    "wavelengths --count 3 --atlas a.txt --atlas b.txt --plot {}",
    "mix 1:#ff0000 --cube c.uplift --atlas a.txt --plot {}", "mix 1:#ff0000 --over i.png -o {}", "texture i.png -o {}",
    "plan s.toml -o {}", "build --atlas a.txt --dim 4 -o {}", "build --scene i.png --dim 4 -o {}",
    "chart --from chart.csv -o {}",
)  # fmt: skip
QUICK = WRITERS[:6]
"""Commands that may also have an output of another name."""


WAYS: dict[str, Callable[[str, str], object]] = {"link": os.symlink, "hard link": os.link, "copy": shutil.copy}
"""How another name comes to an input; a copy is another file, which may be replaced."""


def _generate_outputs(random: Random, path: Path) -> None:
    command = choose(random, WRITERS)
    target = choose(random, [word for word in command.split() if word in (*INPUTS, COLOURS, IMAGE, SCENE)])
    way = choose(random, ("name", "path", "folder", "link", "hard link", *(["copy"] if command in QUICK else [])))
    args = command.replace("{}", _spelling(random, target, way)).split()
    force = ["--force"] if random.random() < 0.8 else []
    path.write_text(json.dumps({"args": args + force, "target": target, "way": way}), encoding="ascii")


def _spelling(random: Random, target: str, way: str) -> str:
    if way == "name":
        return target
    if way == "path":
        return choose(random, ("./", ".//", "folder/../", "./././")) + target
    if way == "folder":
        return choose(random, ("mirror/", "folder/back/")) + target
    return "other" + Path(target).suffix


def _use_outputs(path: Path) -> None:
    case = json.loads(path.read_text(encoding="ascii"))
    with tempfile.TemporaryDirectory(dir=path.parent) as folder, contextlib.chdir(folder):
        _make_inputs(case)
        contents = {name: Path(name).read_bytes() for name in os.listdir() if Path(name).is_file()}
        result = run(case["args"])
        names = [case["target"]] if case["way"] == "copy" else list(contents)
        if any(Path(name).read_bytes() != contents[name] for name in names):
            raise ValueError("an input was replaced")
        if result.exit_code == 0 and case["way"] != "copy" and case["args"][0] != "chart":
            raise ValueError("an input was accepted as an output")
    check(result)


def _make_inputs(case: dict[str, str]) -> None:
    for name, source in INPUTS.items():
        shutil.copy(source, name)
    Path(COLOURS).write_text("0.1,0.2,0.3\n", encoding="utf-8")
    shutil.copy(ROOT / "docs" / "palette" / "metamers-matrix.png", IMAGE)
    Path(SCENE).write_text(f'textures = ["{IMAGE}"]\n', encoding="utf-8")
    os.symlink(".", "mirror")
    os.mkdir("folder")
    os.symlink("..", "folder/back")
    if case["way"] in WAYS:
        WAYS[case["way"]](case["target"], "other" + Path(case["target"]).suffix)


TARGETS = (
    Target("hostile text", _generate_names, _use_names),
    Target("outputs that are inputs", _generate_outputs, _use_outputs),
)
