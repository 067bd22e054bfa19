"""Fuzz target: outputs that are inputs, by name, by links, or through folders. No input may change."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path

from tests.fuzz.command_line import check_outcome, choose, run
from tests.fuzz.mutate import Random
from tests.fuzz.target import ROOT, Target

INPUTS = {
    "c.uplift": ROOT / "cubes" / "moments-8.uplift",
    "a.txt": ROOT / "atlases" / "macbeth.txt",
    "b.txt": ROOT / "atlases" / "rawtoaces.txt",
    "p.toml": ROOT / "uplift" / "samples" / "files" / "metamers.toml",
    "chart.csv": ROOT / "uplift" / "lab" / "chart" / "measured.csv",
}
COLOURS, IMAGE, SCENE = "colours.csv", "i.png", "s.toml"
COMMANDS: tuple[tuple[str, ...], ...] = (
    ("query", "--cube", "c.uplift", "0", "0", "0", "--plot", "{}"), ("query", "--input", COLOURS, "--plot", "{}"),
    ("export", "c.uplift", "-o", "{}", "--format", "csv"), ("export", "c.uplift", "-o", "{}", "--format", "npz"),
    ("export", "c.uplift", "-o", "{}", "--format", "c"), ("atlas", "a.txt", "b.txt", "-o", "{}"),
    ("palette", "p.toml", "-o", "{}"), ("palette", "p.toml", "--plot", "{}"),
    ("palette", "p.toml", "--html", "{}"), ("palette", "p.toml", "--plot", "x.png", "--plot-spectra", "{}"),
    ("report", "c.uplift", "--atlas", "a.txt", "-o", "{}"), ("report", "c.uplift", "--format", "json", "-o", "{}"),
    ("slices", "c.uplift", "-o", "{}"), ("slices", "c.uplift", "--plot", "{}"),
    ("wavelengths", "--count", "3", "--atlas", "a.txt", "--atlas", "b.txt", "--plot", "{}"),
    ("mix", "1:#ff0000", "--cube", "c.uplift", "--atlas", "a.txt", "--plot", "{}"),
    ("mix", "1:#ff0000", "--over", IMAGE, "-o", "{}"), ("texture", IMAGE, "-o", "{}"), ("plan", SCENE, "-o", "{}"),
    ("build", "--atlas", "a.txt", "--dim", "4", "-o", "{}"), ("build", "--scene", IMAGE, "--dim", "4", "-o", "{}"),
    ("chart", "--from", "chart.csv", "-o", "{}"),
)  # fmt: skip
QUICK = COMMANDS[:6]
"""Commands that may also have an output of another name."""


def _copy(source: str, name: str) -> None:
    shutil.copy(source, name)


WAYS: dict[str, Callable[[str, str], None]] = {"link": os.symlink, "hard link": os.link, "copy": _copy}
"""How another name comes to an input; a copy is another file, which may be replaced."""


def _generate(random: Random, path: Path) -> None:
    command = choose(random, COMMANDS)
    inputs = [word for word in command if word in (*INPUTS, COLOURS, IMAGE, SCENE)]
    target = choose(random, inputs)
    way = choose(random, ("name", "path", "folder", "link", "hard link", *(["copy"] if command in QUICK else [])))
    args = [word.replace("{}", _spelling(random, target, way)) for word in command]
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


def _use(path: Path) -> None:
    case = json.loads(path.read_text(encoding="ascii"))
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        before = os.getcwd()
        os.chdir(folder)
        try:
            _make_inputs(case)
            contents = {name: Path(name).read_bytes() for name in os.listdir() if Path(name).is_file()}
            outcome = run(case["args"])
            names = [case["target"]] if case["way"] == "copy" else list(contents)
            if any(Path(name).read_bytes() != contents[name] for name in names):
                raise ValueError("an input was replaced")
            if outcome.code == 0 and case["way"] != "copy" and case["args"][0] != "chart":
                raise ValueError("an input was accepted as an output")
        finally:
            os.chdir(before)
    check_outcome(outcome)


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


TARGET = Target("outputs that are inputs", _generate, _use)
