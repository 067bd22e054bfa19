"""Options and inputs are validated, and packages are found, before a command computes
or writes anything.

``invalid.txt`` has the codes of errors and command lines of which the last input is
missing or a late option is invalid, ``misused.txt`` words of messages and command lines
whose options do not fit together.
"""

import itertools
import os
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from uplift_cli.commands.slices import SHEET
from uplift_cli.main import main
from uplift_cli.option_types import FIGURE_PAGE, PLOT

from tests.extras.paint.invented import invented
from tests.extras.texture.conftest import planes, write_exr
from tests.helpers import without_evidence
from uplift.extras.paint.paints_file import to_toml

from .conftest import commands

COMPUTES = {
    "advise": "uplift.extras.scene.advice.posterior",
    "build": "uplift.pipeline.entries.fit_constraints",
    "chart": "uplift.lab.chart.measure.measure_methods",
    "check": "uplift.extras.report.rebuild.rebuild",
    "lab compare": "uplift.extras.papers.representations.compare.error_statistics",
    "lab diff": "uplift.extras.report.diff.diff_cubes",
    "lights build": "uplift.extras.emission.build.EmissionTable",
    "paints fit": "uplift.extras.paint.fit_paints",
    "paints match": "uplift.extras.paint.match",
    "lab palette": "uplift.extras.papers.palette.design",
    "passes choose": "uplift.extras.scene.passes.choice.draw_paths",
    "plan": "uplift.extras.scene.plan.trial.sample_colours",
    "relight": "uplift.pipeline.entries.fit_constraints",
    "report": "uplift.extras.report.assessment.assess",
    "lab study held-out": "uplift.pipeline.entries.fit_constraints",
    "lab study moments": "uplift.lab.study.moments.Technique.moments",
    "lab study sensitivity": "uplift.lab.study.sensitivity.perturb_answers",
    "lab study stability": "uplift.lab.study.stability.study_stability",
    "texture": "uplift.extras.texture.sequence.convert",
    "lab wavelengths": "uplift.extras.papers.wavelengths.sampling.evaluate",
}
"""Functions that do the long work of commands, and must not be called."""
INVALID = Path(__file__).with_name("invalid.txt").read_text("utf-8").splitlines()
MISUSED = Path(__file__).with_name("misused.txt").read_text("utf-8").splitlines()
UNPLOTTED = """
advise wood.png --cube cube.uplift --plot x.png
lab bounds #888 --plot x.svg
check --renderer colours.csv --plot x.png
chart --atlas macbeth --quick
lab compare --atlas macbeth --quick -o out
lab diff cube.uplift cube.uplift -o x.html
lights info --plot x.png
lights query 1 1 1 --plot x.png
paints mix #888 --plot x.png
paints match #888 --paints paints.toml --plot x.png
lab palette palette.toml --plot x.png
lab palette palette.toml --plot-spectra x.pdf
query #888 --plot x.png
relight wood.png --atlas macbeth
report cube.uplift
slices cube.uplift --plot x.png
lab study moments --atlas macbeth -o out
lab study sensitivity cube.uplift -o out
lab study stability --atlas macbeth -o out
lab wavelengths --count 4 --plot x.png
"""
"""Commands that need matplotlib."""
PACKAGES = {
    "matplotlib": UNPLOTTED,
    "distributed": """
texture wood.png fire.exr -o out --scheduler tcp://127.0.0.1:1
lights texture wood.png fire.exr -o out --scheduler tcp://127.0.0.1:1
""",
    "python_calamine": """
atlas macbeth paints.xlsx -o x.csv
build --atlas macbeth --library paints.xlsx
chart --atlas macbeth --atlas paints.xlsx
lab compare --atlas macbeth --atlas paints.xlsx -o out
lights build --atlas paints.xlsx
paints mix #888 --atlas paints.xlsx --plot x.png
lab palette spreadsheet.toml -o x.csv
plan spreadsheet-scene.toml
relight wood.png --atlas macbeth --atlas paints.xlsx
report cube.uplift --atlas paints.xlsx
lab study moments --atlas macbeth --atlas paints.xlsx -o out
lab wavelengths --count 4 --atlas paints.xlsx --plot x.png
""",
}
"""Commands by the optional package that they need."""
GROUPS = ("lab", "lab study", "lights", "paints", "passes")
WITHOUT_ROWS = {
    "check": "checks all cubes that it can read",
    "lights export": "writes one file as its last act",
    "samples": "reads no file of the user",
    "help": "reads no file",
}
PALETTE = (
    "[materials]\ncard = {rgb = [0.5, 0.5, 0.5]}\n[lights]\nday = {illuminant = "
    '"D65"}\n'
)


TEXTS = {
    "broken.png": "",
    "mine": "",
    "taken/compare.html": "",
    "two.csv": "name,400,550,700\none,0.5,0.5,0.5\nother,0.4,0.4,0.4\n",
    "negative.csv": "name,red,400,550,700\na,-1,0.5,0.5,0.5\n",
    "nothing.csv": "name,red,400,550,700\na,0,0.5,0.5,0.5\n",
    "palette.toml": PALETTE,
    "paints.toml": to_toml(invented()),
    "scene.toml": 'textures = ["wood.png", "none.png"]\n',
    "spreadsheet.toml": PALETTE.replace(
        "rgb = [0.5, 0.5, 0.5]", 'atlas = "paints.xlsx", entry = "x"'
    ),
    "spreadsheet-scene.toml": 'textures = ["wood.png"]\natlases = ["paints.xlsx"]\n',
}


@pytest.fixture
def files(home, repository, plain_cube, passes_text):
    """Valid inputs in the working folder."""
    samples = repository / "uplift" / "samples" / "files"
    for name in ("wood.png", "paints.xlsx"):
        shutil.copy(samples / name, home)
    shutil.copy(repository / "cubes" / "moments-8-macbeth.uplift", home / "cube.uplift")
    without_evidence(plain_cube).save(home / "old.uplift")
    write_exr(home / "fire.exr", planes(np.full((2, 2, 3), 0.5, np.float32)))
    (home / "taken").mkdir()
    (home / "copy").mkdir()
    for folder in (home, home / "copy"):
        shutil.copy(repository / "atlases" / "macbeth.txt", folder)
    for name, text in TEXTS.items():
        (home / name).write_text(text)
    (home / "passes.toml").write_text(passes_text)
    return set(os.listdir(home))


def command_of(line):
    """The words of the command of a line."""
    return max(
        (path for path in commands(main) if f"{line} ".startswith(f"{path} ")), key=len
    )


@pytest.fixture
def refuse_at_once(refuse, home, files, monkeypatch):
    """Run an invalid command, which must not compute, write or print anything, and
    return the error.
    """

    def begin(*args, **options):
        pytest.fail("began to compute")

    def refuse_at_once(line):
        if begins := COMPUTES.get(command_of(line)):
            monkeypatch.setattr(begins, begin)
        error = refuse(line)
        assert set(os.listdir(home)) == files
        return error

    return refuse_at_once


@pytest.mark.parametrize("line", INVALID)
def test_all_is_validated_before_anything_is_computed_or_written(refuse_at_once, line):
    code, command = line.split(maxsplit=1)
    assert refuse_at_once(command).code == code


@pytest.mark.parametrize("line", MISUSED)
def test_options_that_do_not_fit_together_are_refused(misuse, home, files, line):
    words, command = line.split(" | ")
    assert words in misuse(command)
    assert set(os.listdir(home)) == files


def test_every_command_has_a_line():
    tested = {command_of(line.split(maxsplit=1)[1]) for line in INVALID}
    assert {*tested, *WITHOUT_ROWS, *GROUPS} == set(commands(main))


PACKAGE_LINES = []
for package, text in PACKAGES.items():
    PACKAGE_LINES += [(package, line) for line in text.strip().splitlines()]


@pytest.mark.parametrize(("package", "line"), PACKAGE_LINES)
def test_missing_packages_are_named_before_anything_is_computed_or_written(
    refuse_at_once, monkeypatch, package, line
):
    monkeypatch.setitem(sys.modules, package, None)
    error = refuse_at_once(line)
    assert error.code == "extra-not-installed"
    assert error.hint.endswith(f"pip install {package.replace('_', '-')}")


def test_every_figure_has_a_line():
    lines = UNPLOTTED.strip().splitlines()
    options = set()
    for line in lines:
        options.update(itertools.product([command_of(line)], line.split()))
    for path, command in commands(main).items():
        for param in command.params:
            if param.type in (PLOT, FIGURE_PAGE, SHEET):
                named = itertools.product([path], param.opts)
                assert options.intersection(named), (path, param.opts)
