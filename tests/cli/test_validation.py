"""Options and inputs are validated, and packages are found, before a command computes
or writes anything.
"""

import itertools
import os
import shutil
import sys

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

CUBE = "cube.uplift"
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
INVALID = """
too-few-entries advise wood.png --cube old.uplift
file-not-found advise wood.png none.png --cube {}
unknown-name advise wood.png --cube {} --light none
unknown-name advise wood.png --second-light --candidate none
unknown-name advise wood.png --cube {} --input-space none --plot x.png
file-not-found atlas macbeth none.csv -o x.csv
unknown-name atlas macbeth -o x.csv --space none
unknown-name atlas macbeth --illuminant none
atlas atlas macbeth --illuminant mine
unknown-name atlas macbeth --observer mine
file-not-found atlas macbeth --space camera --observer none.json
unknown-name lab bounds #888 --html x.html --plot x.png --light none
colour lab bounds --input none.csv --plot x.png
output build --dim 2 -o none/cube
output build --dim 2 -o .
file-exists build --dim 2 -o mine
option build --dim 1
out-of-memory build --dim 1000000000000
unknown-name build --illuminant D66
atlas build --light mine
unknown-name build --space no/where
unknown-name build --observer CIE
unknown-name build --model moment
unknown-name build --axis log
option build --range 360
option build --range 361:830
option build --entry-coefficients 18
atlas build --atlas mine
output-is-input build --look mine -o mine --force
file-not-found build --atlas macbeth --atlas none.csv
unknown-name build --light none
unknown-name build --exclude-family none
unknown-name build --solver none
file-not-found build --library none.csv
file-not-found build --look none.toml
file-not-found build --scene wood.png --scene none.png
unknown-name build --scene wood.png --input-space none
option build --step 7
unknown-name build --observer none
file-not-found build --plan none.json
option chart --atlas macbeth --method x
option chart --recommend --light D65
unknown-name chart --recommend --tolerance 1 --light FL12
output chart --atlas macbeth -o mine
file-not-found chart --atlas macbeth --atlas none.csv
option chart --method none
file-not-found chart --from none.csv
option chart --recommend --light none
unknown-name lab compare --atlas macbeth --light F2
option lab compare --atlas macbeth --write GQ16 -o new
output lab compare --atlas macbeth --write PS16 -o mine
output lab compare --atlas macbeth -o mine
file-exists lab compare --atlas macbeth -o taken
file-not-found lab compare -o out --atlas macbeth --atlas none.csv
unknown-name lab compare -o out --light none
option lab compare -o out --tolerance 0
option lab compare -o out --write none
file-not-found lab compare -o out --write PF16 --atlas none.csv
file-not-found lab diff {} none.uplift
file-not-found lab diff {} {} wood.png none.png -o x.html
unknown-name lab diff {} {} -o x.html --light none
unknown-name lab diff {} {} wood.png --input-space none -o x.html
file-not-found info none.uplift
file-not-found lights build --atlas none.csv
unknown-name lights build --space none
unknown-name lights build --observer none
option lights build --observer none.csv
file-not-found lights info none.uplift --plot x.png
file-not-found lights query 1 1 1 --lights none.uplift --plot x.png
unknown-name lights query 1 1 1 --input-space none --plot x.png
option lights query 1 1 1 --wavelengths 1:2:1 --plot x.png
colour lights query --input none.csv --plot x.png
file-not-found lights texture wood.png none.png -o out
unknown-name lights texture wood.png fire.exr -o out --input-space none
option lights texture wood.png fire.exr -o out --wavelengths 1:2:1
colour paints mix teal
colour paints mix '1: '
ambiguous-numbers paints mix 0,2,0,3,0,4
rgb-out-of-gamut paints mix #888 1.5,0,0
option paints mix -1:#ffffff
rgb-out-of-gamut paints mix 1:1.5,0,0
colour paints mix #802020/#c03030
option paints mix #802020 --internal-reflectance 1
file-not-found paints mix --duntley none.csv
colour paints mix #888 none --plot x.png
file-not-found paints mix #888 --over none.png -o x.exr
unknown-name paints mix #888 --over wood.png -o x.exr --input-space none
option paints mix #888 --wavelengths 1:2:1 --plot x.png
file-not-found paints mix #888 --atlas none.csv --plot x.png
file-not-found paints mix white --paints none.toml --plot x.png
unknown-name paints mix white green --paints paints.toml --plot x.png
file-not-found paints fit two.csv --recipes none.csv -o x.toml
option paints fit two.csv --refractive-index 0.5 -o x.toml
file-exists paints fit two.csv -o mine
no-paints paints fit two.csv -o x.toml
file-not-found paints info none.toml
unknown-name paints match #888 --paints paints.toml --paint green --plot x.png
unknown-name paints match #888 --paints paints.toml --light none --plot x.png
colour paints match #888 --paints paints.toml --ground none --plot x.png
file-not-found paints match #888 --paints paints.toml --atlas none.csv --plot x.png
file-not-found lab palette palette.toml --image none.png --html x.html --plot x.png
file-not-found lab palette none.toml -o x.csv
unknown-name lab palette palette.toml --label none=#888 --image wood.png --html x.html
file-not-found plan none.toml
file-not-found plan scene.toml
colour query #cc331
colour query c31
colour query red
colour query 0.1 0.2
colour query 0.1 0.2 0.3 0.4
colour query #cc3319 0.5
rgb-out-of-gamut query 0.1 1.2 0.3
rgb-out-of-gamut query 0.3 -.1 0.3
colour query nan 0.2 0.3
rgb-like-codes query 204 51 25
invalid-codes query --encoded 256 0 0
invalid-codes query --encoded -1 0 0
invalid-codes query --encoded nan 0 0 --out-of-gamut clip
colour query nan 0 0 --out-of-gamut scale
unknown-name query 0.5 0.6 0.3 --input-space P9
option query 0.5 0.6 0.3 --input-space 1,2
colour query --xy 0.3 0 --luminance 0.2
colour-unrealisable query --xyz 0.05 0.9 0.1
unknown-name query #fff --light FL99
unknown-name query #fff --light none.spd
atlas query #fff --light mine
ambiguous-numbers query 0,2,0,3,0,4
file-not-found query #fff --cube none.uplift
file-not-found export none.toml -o x.h
file-not-found passes choose none.png -o x.toml
file-not-found passes choose --atlas none.csv -o x.toml
unknown-name passes choose --light none
file-exists passes choose -o mine
file-not-found passes decode fire.exr fire.exr --passes none.toml -o x.exr
invalid-file passes decode fire.exr fire.exr --passes palette.toml -o x.exr
file-not-found passes info none.toml
file-not-found passes recipe none.toml
invalid-file passes recipe palette.toml --for nuke
file-not-found texture wood.png -o x --passes none.toml
file-not-found query #888 --passes none.toml
file-not-found lights query 1 1 1 --passes none.toml
file-not-found lights texture fire.exr -o x --passes none.toml
option query #fff --wavelengths red
option query #fff --wavelengths 400:700
option query #fff --wavelengths 400:700:0
option query #fff --wavelengths 700:400:5
option query #fff --wavelengths 4,,5
option query #fff --wavelengths 400:inf:5
option query #fff --wavelengths 400:700:1e-9
option query #fff --wavelengths 0.4:0.7:0.1
output query #fff --plot red.gif
output query #fff --plot red.png.txt
output query #fff --plot none/red.png
unknown-name query #888 --plot x.png --light none
option query #888 --plot x.png --wavelengths 1:2:1
colour query --input none.csv --plot x.png
file-not-found query --check none.csv
output relight -o relit.gif
output-is-input relight wood.png -o wood.png --force
file-not-found relight wood.png none.png --atlas macbeth
unknown-name relight wood.png --atlas macbeth --light none
unknown-name relight wood.png --atlas macbeth --input-space none
file-not-found relight wood.png --atlas macbeth --atlas none.csv
texture relight wood.png broken.png --atlas macbeth
unknown-name relight wood.png --atlas macbeth -o x.exr --light none
file-exists report {} -o taken/compare.html
output report {} -o report.pdf
output report {} -o nowhere/page.html
not-a-cube report mine
file-not-found report {} --atlas none.csv
unknown-name report {} --light none
file-not-found report none.uplift
output slices {} --plot x.jpg
file-not-found slices none.uplift --plot x.png
output slices {} -o none/x.exr --plot x.png
too-few-entries lab study held-out --atlas two.csv --dim 4
file-not-found lab study held-out --atlas macbeth --atlas none.csv
option lab study held-out --atlas macbeth --coefficients 99
option lab study held-out --atlas macbeth --dim 1
atlas lab study moments --atlas macbeth.txt --atlas copy/macbeth.txt
output lab study moments --atlas macbeth -o mine
file-not-found lab study moments --atlas none.csv -o out
option lab study sensitivity {} -o out --method none
file-not-found lab study sensitivity none.uplift -o out
file-not-found lab study stability --atlas none.csv -o out
texture texture none*.png -o out
output texture wood.png -o out.png
output texture wood.png fire.exr -o out.exr
output texture wood.png fire.exr -o mine/out
file-not-found texture wood.png none.png -o out
too-few-entries texture wood.png fire.exr -o out --errors A --cube old.uplift
unknown-name texture wood.png fire.exr -o out --errors none
unknown-name texture wood.png fire.exr -o out --input-space none
file-not-found texture wood.png fire.exr -o out --cube none.uplift
option texture wood.png fire.exr -o out --wavelengths 1:2:1
file-not-found texture wood.png -o x.exr --cube {} --cube {} --mask none.png
output texture wood.png wood.png -o out
option texture wood.png fire.exr -o out --depth half --representation multipliers
option lab wavelengths --count 0 --atlas macbeth
undefined-rule lab wavelengths --count 3 --method meyer --atlas macbeth
option lab wavelengths --wavelengths 0.4:0.7:0.1 --atlas macbeth
unknown-name lab wavelengths --count 4 --illuminant none --plot x.png
file-not-found lab wavelengths --count 4 --atlas macbeth --atlas none.csv --plot x.png
option lab wavelengths --count 99 --plot x.png
option lab wavelengths --count 4 --space camera --observer none.json --plot x.png
unknown-name lab wavelengths --count 4 --light none --plot x.png
option lab wavelengths --wavelengths 1:2:1 --plot x.png
option lab wavelengths --tolerance 0 --plot x.png
"""
"""Codes of errors, and commands of which the last input is missing or a late option is
invalid; {} is a cube.
"""
UNPLOTTED = """
advise wood.png --cube {} --plot x.png
lab bounds #888 --plot x.svg
check --renderer colours.csv --plot x.png
chart --atlas macbeth --quick
lab compare --atlas macbeth --quick -o out
lab diff {} {} -o x.html
lights info --plot x.png
lights query 1 1 1 --plot x.png
paints mix #888 --plot x.png
paints match #888 --paints paints.toml --plot x.png
lab palette palette.toml --plot x.png
lab palette palette.toml --plot-spectra x.pdf
query #888 --plot x.png
relight wood.png --atlas macbeth
report {}
slices {} --plot x.png
lab study moments --atlas macbeth -o out
lab study sensitivity {} -o out
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
report {} --atlas paints.xlsx
lab study moments --atlas macbeth --atlas paints.xlsx -o out
lab wavelengths --count 4 --atlas paints.xlsx --plot x.png
""",
}
"""Commands by the optional package that they need."""
GROUPS = ("lab", "lab study", "lights", "paints", "passes")
WITHOUT_ROWS = {
    "check": "checks all cubes that it can read",
    "export": "writes one file as its last act",
    "lights export": "writes one file as its last act",
    "samples": "reads no file of the user",
    "help": "reads no file",
}
PALETTE = (
    "[materials]\ncard = {rgb = [0.5, 0.5, 0.5]}\n[lights]\nday = {illuminant = "
    '"D65"}\n'
)


@pytest.fixture
def files(home, repository, plain_cube):
    """Valid inputs in the working folder."""
    samples = repository / "uplift" / "samples" / "files"
    for name in ("wood.png", "paints.xlsx"):
        shutil.copy(samples / name, home)
    shutil.copy(repository / "cubes" / "moments-8-macbeth.uplift", home / CUBE)
    without_evidence(plain_cube).save(home / "old.uplift")
    shutil.copy(repository / "atlases" / "macbeth.txt", home)
    write_exr(home / "fire.exr", planes(np.full((2, 2, 3), 0.5, np.float32)))
    for folder in ("copy", "taken"):
        (home / folder).mkdir()
    shutil.copy(home / "macbeth.txt", home / "copy")
    for name in ("broken.png", "mine", "taken/compare.html"):
        (home / name).write_text("")
    (home / "two.csv").write_text(
        "name,400,550,700\none,0.5,0.5,0.5\nother,0.4,0.4,0.4\n"
    )
    (home / "palette.toml").write_text(PALETTE)
    (home / "paints.toml").write_text(to_toml(invented()))
    (home / "scene.toml").write_text('textures = ["wood.png", "none.png"]\n')
    measured = 'atlas = "paints.xlsx", entry = "x"'
    (home / "spreadsheet.toml").write_text(
        PALETTE.replace("rgb = [0.5, 0.5, 0.5]", measured)
    )
    (home / "spreadsheet-scene.toml").write_text(
        'textures = ["wood.png"]\natlases = ["paints.xlsx"]\n'
    )
    return set(os.listdir(home))


def lines(text):
    return text.strip().splitlines()


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
        error = refuse(line.replace("{}", CUBE))
        assert set(os.listdir(home)) == files
        return error

    return refuse_at_once


@pytest.mark.parametrize("line", lines(INVALID))
def test_all_is_validated_before_anything_is_computed_or_written(refuse_at_once, line):
    code, command = line.split(maxsplit=1)
    assert refuse_at_once(command).code == code


def test_every_command_has_a_line():
    tested = {command_of(line.split(maxsplit=1)[1]) for line in lines(INVALID)}
    assert {*tested, *WITHOUT_ROWS, *GROUPS} == set(commands(main))


PACKAGE_LINES = []
for package, text in PACKAGES.items():
    PACKAGE_LINES += [(package, line) for line in lines(text)]


@pytest.mark.parametrize(("package", "line"), PACKAGE_LINES)
def test_missing_packages_are_named_before_anything_is_computed_or_written(
    refuse_at_once, monkeypatch, package, line
):
    monkeypatch.setitem(sys.modules, package, None)
    error = refuse_at_once(line)
    assert error.code == "extra-not-installed"
    assert error.hint.endswith(f"pip install {package.replace('_', '-')}")


def test_every_figure_has_a_line():
    options = set()
    for line in lines(UNPLOTTED):
        options.update(itertools.product([command_of(line)], line.split()))
    for path, command in commands(main).items():
        for param in command.params:
            if param.type in (PLOT, FIGURE_PAGE, SHEET):
                named = itertools.product([path], param.opts)
                assert options.intersection(named), (path, param.opts)
