"""Fuzz target: hostile text in names of entries, lights, materials, methods, files and options."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from tests.cube.cube_files import forge
from tests.fuzz.command_line import check_csv, check_outcome, choose, run_case, write_case
from tests.fuzz.cube_valid_digest import SEEDS
from tests.fuzz.mutate import Random
from tests.fuzz.target import ROOT, Target

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
COMMANDS: tuple[tuple[str, ...], ...] = (
    ("info", CUBE), ("info", CUBE, "--format", "json"), ("query", "--cube", CUBE, "0.2", "0.3", "0.4"),
    ("query", "--cube", CUBE, "--input", COLOURS), ("query", "--cube", CUBE, "--input", COLOURS, "--format", "json"),
    ("query", "--cube", CUBE, "--input", COLOURS, "--format", "csv"),
    ("query", "--cube", CUBE, "--input", COLOURS, "--plot", "x.png"), ("query", "{}"),
    ("query", "--cube", "{}", "0", "0", "0"), ("query", "--input", "{}"), ("{}",), ("--{}",), ("query", "--{}"),
    ("query", "0", "0", "0", "--wavelengths", "{}"), ("query", "0", "0", "0", "--input-space", "{}"),
    ("query", "0", "0", "0", "--format", "{}"), ("query", "0", "0", "0", "--plot", "{}/x.png"), ("atlas", ATLAS),
    ("atlas", ATLAS, "--format", "json"), ("atlas", ATLAS, "--format", "csv"), ("atlas", TABLE),
    ("atlas", TABLE, "--format", "csv"), ("atlas", TABLE, "-o", "b.csv"), ("atlas", TABLE, ATLAS),
    ("atlas", "{}"), ("atlas", ATLAS, "--space", "{}"), ("atlas", ATLAS, "--observer", "{}"),
    ("mix", "1:{}", "--cube", CUBE), ("mix", "1:{}", "1:#ff0000", "--atlas", TABLE),
    ("mix", "{}:#ff0000", "--ground", "{}"), ("wavelengths", "--count", "3", "--atlas", TABLE),
    ("wavelengths", "--count", "3", "--light", "{}"), ("palette", SPEC), ("palette", SPEC, "--format", "json"),
    ("palette", SPEC, "--plot", "m.png", "--plot-spectra", "s.png"), ("palette", SPEC, "--html", "p.html"),
    ("palette", SPEC, "--html", "p.html", "--label", "{}"),
    ("chart", "--recommend", "--tolerance", "1", "--from", CHART), ("chart", "--recommend", "--light", "{}"),
    ("export", CUBE, "-o", "x.csv"), ("export", CUBE, "-o", "x.h"), ("export", CUBE, "-o", "x.npz"),
    ("report", CUBE, "--format", "json"), ("check", CUBE + "{}"), ("plan", "{}"), ("plan", SPEC),
    ("build", "--plan", SPEC), ("build", "--model", "{}", "--dim", "4"), ("build", "--space", "{}", "--dim", "4"),
    ("build", "--atlas", "{}", "--dim", "4"), ("texture", "{}", "-o", "x.exr"),
)  # fmt: skip
"""Commands, in which ``{}`` is a hostile text."""
SLOW = ("palette", "report")
"""Commands that are run rarely."""


def hostile(random: Random) -> str:
    """Return a text of one to four hostile parts."""
    return "".join(choose(random, TOKENS) for _ in range(int(random.integers(1, 5))))


def _generate(random: Random, path: Path) -> None:
    command = choose(random, COMMANDS)
    if command[0] in SLOW and random.random() < 0.9:
        command = choose(random, COMMANDS)
    name, other = hostile(random), hostile(random)
    argument = name.replace("\0", "").replace("\ud800", "\udcff")  # as the system passes arguments
    args = [word.replace("{}", argument) for word in command]
    quoted = json.dumps(name)
    files = {
        CUBE: json.dumps([name, other, int(random.integers(4))]),
        ATLAS: _art(name) + _art(other),
        TABLE: f"name,400,500,600,700\n{_cell(name)},0.1,0.2,0.3,0.4\n{_cell(other)},0.2,0.3,0.4,0.5\n",
        CHART: CHART_TEXT.replace("Mallett", name).replace("uplift", other),
        SPEC: PALETTE.format(name=quoted),
        COLOURS: choose(random, ("0.2,0.3,0.4\n0.1,0.1,0.1\n", f"{name}\n", f"0.1,0.2,0.3,{name}\n#ffffff {other}\n")),
    }
    write_case(path, args, {file: text for file, text in files.items() if file in args})


def _art(name: str) -> str:
    return (
        f"Entry ID: {name}\nType : reflectance spectrum\nFluorescence data : no\nSampling information\n"
        "Type : regular\nStart : 400 nm\nIncrement : 100 nm\nMaximum sample value : 1.0\n"
        "ASCII sample data\n{0.5, 0.25, 0.125, 0.0625}\n"
    )


def _cell(text: str) -> str:
    return '"' + text.replace('"', '""') + '"'


def make_file(text: str, path: Path) -> None:
    """Write a file of a case: a cube from its names, any other one as it is."""
    if path.name == CUBE:
        name, other, place = json.loads(text.replace("\\ud800", "?").replace("\\udcff", "?"))

        def change(tensors: dict[str, Any], metadata: dict[str, Any]) -> None:
            _rename(metadata, name, other, place)

        forge(SEEDS[0], path, change)
    else:
        path.write_bytes(text.encode("utf-8", "surrogatepass" if "\ud800" in text else "surrogateescape"))


def _rename(metadata: dict[str, Any], name: str, other: str, place: int) -> None:
    """Put names in place of those of entries, of the recorded atlases, and of some other facts."""
    metadata["entries"] = [name, other, *metadata["entries"][2:]]
    if place == 1:
        for atlas in metadata["provenance"]["atlases"]:
            atlas["name"] = name
    elif place == 2:
        metadata["provenance"]["left_out"] = [name, other]
    elif place == 3:
        metadata["illuminant"] = name


def _use(path: Path) -> None:
    outcome = run_case(path, make_file)
    args = json.loads(path.read_text(encoding="ascii"))["args"]
    if args[-2:] == ["--format", "csv"]:
        check_csv(outcome.stdout)
    if args[-2:] == ["--format", "json"] and outcome.code == 0:
        json.loads(outcome.stdout)
    check_outcome(outcome)


TARGET = Target("hostile text", _generate, _use)
