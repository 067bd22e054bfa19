"""Options and inputs are validated, and packages are found, before a command computes or writes anything."""

import itertools
import shutil
import sys

import numpy as np
import pytest
from uplift_cli.commands.slices import SHEET
from uplift_cli.main import main
from uplift_cli.options import FIGURE_PAGE, PLOT

from tests.io.texture.conftest import planes, write_exr

from .conftest import commands

CUBE = "cube.uplift"
COMPUTES = {
    "advise": "uplift.scene.advice.uncertainty",
    "build": "uplift.pipeline.entries.fit_constraints",
    "chart": "uplift.lab.chart.measure.measure_methods",
    "check": "uplift.pipeline.rebuild.rebuild",
    "compare": "uplift.lab.comparison.compare.make_scene",
    "diff": "uplift.report.diff.diff_cubes",
    "lights build": "uplift.lights.build.EmissionTable",
    "mix": "uplift.design.mixing.mix",
    "palette": "uplift.design.palette.design",
    "plan": "uplift.scene.plan.space.sample_colours",
    "relight": "uplift.pipeline.entries.fit_constraints",
    "report": "uplift.report.assessment.assess",
    "study held-out": "uplift.pipeline.entries.fit_constraints",
    "study moments": "uplift.lab.study.moments.Technique.moments",
    "study sensitivity": "uplift.lab.study.sensitivity.study_sensitivity",
    "study stability": "uplift.lab.study.stability.study_stability",
    "texture": "uplift.io.texture.sequence.convert",
    "wavelengths": "uplift.scene.wavelengths.sampling.evaluate",
}
"""Functions that do the long work of commands, and must not be called."""
INVALID = """
advise wood.png none.png --cube {}
advise wood.png --cube {} --light none
advise wood.png --cube {} --count 0
advise wood.png --cube {} --input-space none --plot x.png
atlas macbeth none.csv -o x.csv
atlas macbeth -o x.csv --space none
atlas macbeth --illuminant none
bounds #888 --html x.html --plot x.png --light none
bounds --input none.csv --plot x.png
build --atlas macbeth --atlas none.csv
build --light none
build --exclude-family none
build --solver none
build --library none.csv
build --look none.toml
build --scene wood.png --scene none.png
build --scene wood.png --input-space none
build --step 7
build --observer none
build --plan none.json
chart --atlas macbeth --atlas none.csv
chart --method none
chart --from none.csv
chart --recommend --light none
compare -o out --atlas macbeth --atlas none.csv
compare -o out --light none
compare -o out --tolerance 0
compare -o out --write none
compare -o out --write PF16 --atlas none.csv
diff {} none.uplift
diff {} {} wood.png none.png -o x.html
diff {} {} -o x.html --light none
diff {} {} wood.png --input-space none -o x.html
info none.uplift
lights build --atlas macbeth --atlas none.csv
lights build --space none
lights build --observer none
lights info none.uplift --plot x.png --html x.html
lights query 1 1 1 --lights none.uplift --plot x.png
lights query 1 1 1 --input-space none --plot x.png
lights query 1 1 1 --wavelengths 1:2:1 --plot x.png
lights query --input none.csv --plot x.png
lights texture wood.png none.png -o out
lights texture wood.png fire.exr -o out --input-space none
lights texture wood.png fire.exr -o out --wavelengths 1:2:1
mix #888 none --plot x.png
mix #888 --over none.png -o x.exr
mix #888 --over wood.png -o x.exr --input-space none
mix #888 --wavelengths 1:2:1 --plot x.png
mix #888 --atlas none.csv --plot x.png
palette palette.toml --image none.png --html x.html --plot x.png
palette none.toml -o x.csv
palette palette.toml --label none=#888 --image wood.png --html x.html
plan none.toml
plan scene.toml
query #888 --plot x.png --light none
query #888 --plot x.png --wavelengths 1:2:1
query --input none.csv --plot x.png
query --check none.csv
relight wood.png none.png --atlas macbeth
relight wood.png --atlas macbeth --light none
relight wood.png --atlas macbeth --input-space none
relight wood.png --atlas macbeth --atlas none.csv
relight wood.png broken.png --atlas macbeth
relight wood.png --atlas macbeth -o x.exr --light none
report {} --atlas none.csv
report {} --light none
report none.uplift
slices {} --plot x.jpg
slices none.uplift --plot x.png
slices {} -o none/x.exr --plot x.png
study held-out --atlas macbeth --atlas none.csv
study held-out --atlas macbeth --coefficients 99
study held-out --atlas macbeth --dim 1
study moments --atlas macbeth --max-moments 99 -o out
study moments --atlas none.csv -o out
study sensitivity {} -o out --method none
study sensitivity none.uplift -o out
study stability --atlas none.csv -o out
texture wood.png none.png -o out
texture wood.png fire.exr -o out --errors A
texture wood.png fire.exr -o out --errors none
texture wood.png fire.exr -o out --input-space none
texture wood.png fire.exr -o out --cube none.uplift
texture wood.png fire.exr -o out --wavelengths 1:2:1
texture wood.png -o x.exr --cube {} --cube {} --mask none.png
texture wood.png wood.png -o out
texture wood.png fire.exr -o out --depth half --representation multipliers
wavelengths --count 4 --illuminant none --plot x.png
wavelengths --count 4 --atlas macbeth --atlas none.csv --plot x.png
wavelengths --count 99 --plot x.png
wavelengths --count 4 --light none --plot x.png
wavelengths --wavelengths 1:2:1 --plot x.png
wavelengths --tolerance 0 --plot x.png
"""
"""Commands of which the last input is missing or a late option is invalid; {} is a cube."""
UNPLOTTED = """
advise wood.png --cube {} --plot x.png
bounds #888 --plot x.svg
chart --atlas macbeth --quick
compare --atlas macbeth --quick -o out
diff {} {} -o x.html
lights info --plot x.png
lights info --html x.html
lights query 1 1 1 --plot x.png
mix #888 --plot x.png
palette palette.toml --plot x.png
palette palette.toml --plot-spectra x.pdf
query #888 --plot x.png
relight wood.png --atlas macbeth
report {}
slices {} --plot x.png
study moments --atlas macbeth -o out
study sensitivity {} -o out
study stability --atlas macbeth -o out
wavelengths --count 4 --plot x.png
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
compare --atlas macbeth --atlas paints.xlsx -o out
lights build --atlas paints.xlsx
mix #888 --atlas paints.xlsx --plot x.png
palette spreadsheet.toml -o x.csv
plan spreadsheet-scene.toml
relight wood.png --atlas macbeth --atlas paints.xlsx
report {} --atlas paints.xlsx
study moments --atlas macbeth --atlas paints.xlsx -o out
wavelengths --count 4 --atlas paints.xlsx --plot x.png
""",
}
"""Commands by the optional package that they need."""
GROUPS = ("lights", "study")
WITHOUT_ROWS = {
    "check": "checks all cubes that it can read",
    "export": "writes one file as its last act",
    "lights export": "writes one file as its last act",
    "samples": "reads no file of the user",
    "help": "reads no file",
}
PALETTE = '[materials]\ncard = {rgb = [0.5, 0.5, 0.5]}\n[lights]\nday = {illuminant = "D65"}\n'


@pytest.fixture
def files(home, repository):
    """Valid inputs in the working folder."""
    samples = repository / "uplift" / "samples" / "files"
    for name in ("wood.png", "paints.xlsx"):
        shutil.copy(samples / name, home)
    shutil.copy(repository / "cubes" / "moments-8-macbeth.uplift", home / CUBE)
    shutil.copy(repository / "atlases" / "macbeth.txt", home)
    write_exr(home / "fire.exr", planes(np.full((2, 2, 3), 0.5, np.float32)))
    (home / "broken.png").write_text("no image")
    (home / "palette.toml").write_text(PALETTE)
    (home / "scene.toml").write_text('textures = ["wood.png", "none.png"]\n')
    measured = 'atlas = "paints.xlsx", entry = "x"'
    (home / "spreadsheet.toml").write_text(PALETTE.replace("rgb = [0.5, 0.5, 0.5]", measured))
    (home / "spreadsheet-scene.toml").write_text('textures = ["wood.png"]\natlases = ["paints.xlsx"]\n')
    return {path.name for path in home.iterdir()}


def lines(text):
    return text.strip().splitlines()


def command_of(line):
    """The words of the command of a line."""
    return max((path for path in commands(main) if f"{line} ".startswith(f"{path} ")), key=len)


@pytest.fixture
def refused_at_once(refuse, run, home, files, monkeypatch):
    """Check that a command is refused before it computes, writes or prints anything."""

    def begin(*args, **options):
        pytest.fail("began to compute")

    def check(line):
        command = command_of(line)
        if command in COMPUTES:
            monkeypatch.setattr(COMPUTES[command], begin)
        result = run(*line.replace("{}", CUBE).split(), code=2)
        assert result.stdout == ""
        assert {path.name for path in home.iterdir()} == files

    return check


@pytest.mark.parametrize("line", lines(INVALID))
def test_all_is_validated_before_anything_is_computed_or_written(refused_at_once, line):
    refused_at_once(line)


def test_every_command_has_a_line():
    tested = {command_of(line) for line in lines(INVALID)}
    assert {*tested, *WITHOUT_ROWS, *GROUPS} == set(commands(main))


@pytest.mark.parametrize(("package", "line"), [(name, line) for name, text in PACKAGES.items() for line in lines(text)])
def test_missing_packages_are_named_before_anything_is_computed_or_written(
    refused_at_once, shown, monkeypatch, package, line
):
    monkeypatch.setitem(sys.modules, package, None)
    refused_at_once(line)
    error = shown.pop().error
    assert error.code == "extra-not-installed"
    assert error.hint.endswith(f"pip install {package.replace('_', '-')}")


def test_every_figure_has_a_line():
    options = {words for line in lines(UNPLOTTED) for words in itertools.product([command_of(line)], line.split())}
    for path, command in commands(main).items():
        for param in command.params:
            if param.type in (PLOT, FIGURE_PAGE, SHEET):
                assert any((path, option) in options for option in param.opts), (path, param.opts)
