"""Options and inputs are validated, and packages are found, before a command computes or writes anything."""

import shutil

import numpy as np
import pytest
from uplift_cli.main import main

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
    "plan": "uplift.scene.plan.plan",
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
INVALID = {
    "advise": ("wood.png none.png --cube {}", "wood.png --cube {} --light none", "wood.png --cube {} --count 0",
               "wood.png --cube {} --input-space none --plot x.png"),
    "atlas": ("macbeth none.csv -o x.csv", "macbeth -o x.csv --space none", "macbeth --illuminant none"),
    "bounds": ("#888 --html x.html --plot x.png --light none", "--input none.csv --plot x.png"),
    "build": ("--atlas macbeth --atlas none.csv", "--light none", "--exclude-family none", "--solver none",
              "--library none.csv", "--look none.toml", "--scene wood.png --scene none.png",
              "--scene wood.png --input-space none", "--step 7", "--observer none", "--plan none.json"),
    "chart": ("--atlas macbeth --atlas none.csv", "--method none", "--from none.csv", "--recommend --light none"),
    "compare": ("-o out --atlas macbeth --atlas none.csv", "-o out --light none", "-o out --tolerance 0",
                "-o out --write none", "-o out --write PF16 --atlas none.csv"),
    "diff": ("{} none.uplift", "{} {} wood.png none.png -o x.html", "{} {} -o x.html --light none",
             "{} {} wood.png --input-space none -o x.html"),
    "info": ("none.uplift",),
    "lights build": ("--atlas macbeth --atlas none.csv", "--space none", "--observer none"),
    "lights info": ("none.uplift --plot x.png --html x.html",),
    "lights query": ("1 1 1 --lights none.uplift --plot x.png", "1 1 1 --input-space none --plot x.png",
                     "1 1 1 --wavelengths 1:2:1 --plot x.png", "--input none.csv --plot x.png"),
    "lights texture": ("wood.png none.png -o out", "wood.png fire.exr -o out --input-space none",
                       "wood.png fire.exr -o out --wavelengths 1:2:1"),
    "mix": ("#888 none --plot x.png", "#888 --over none.png -o x.exr", "#888 --over wood.png -o x.exr --input-space none",
            "#888 --wavelengths 1:2:1 --plot x.png", "#888 --atlas none.csv --plot x.png"),
    "palette": ("palette.toml --image none.png --html x.html --plot x.png", "none.toml -o x.csv",
                "palette.toml --label none=#888 --image wood.png --html x.html"),
    "plan": ("none.toml", "scene.toml"),
    "query": ("#888 --plot x.png --light none", "#888 --plot x.png --wavelengths 1:2:1", "--input none.csv --plot x.png",
              "--check none.csv"),
    "relight": ("wood.png none.png --atlas macbeth", "wood.png --atlas macbeth --light none",
                "wood.png --atlas macbeth --input-space none", "wood.png --atlas macbeth --atlas none.csv",
                "wood.png broken.png --atlas macbeth", "wood.png --atlas macbeth -o x.exr --light none"),
    "report": ("{} --atlas none.csv", "{} --light none", "none.uplift"),
    "slices": ("{} --plot x.jpg", "none.uplift --plot x.png", "{} -o none/x.exr --plot x.png"),
    "study held-out": ("--atlas macbeth --atlas none.csv", "--atlas macbeth --coefficients 99", "--atlas macbeth --dim 1"),
    "study moments": ("--atlas macbeth --max-moments 99 -o out", "--atlas none.csv -o out"),
    "study sensitivity": ("{} -o out --method none", "none.uplift -o out"),
    "study stability": ("--atlas none.csv -o out",),
    "texture": ("wood.png none.png -o out", "wood.png fire.exr -o out --errors A", "wood.png fire.exr -o out --errors none",
                "wood.png fire.exr -o out --input-space none", "wood.png fire.exr -o out --cube none.uplift",
                "wood.png fire.exr -o out --wavelengths 1:2:1", "wood.png -o x.exr --cube {} --cube {} --mask none.png",
                "wood.png wood.png -o out", "wood.png fire.exr -o out --depth half --representation multipliers"),
    "wavelengths": ("--count 4 --illuminant none --plot x.png", "--count 4 --atlas macbeth --atlas none.csv --plot x.png",
                    "--count 99 --plot x.png", "--count 4 --light none --plot x.png", "--wavelengths 1:2:1 --plot x.png",
                    "--tolerance 0 --plot x.png"),
}  # fmt: skip
"""Arguments of each command of which the last input is missing or a late option is invalid; {} is a cube."""
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
    shutil.copy(samples / "wood.png", home)
    shutil.copy(repository / "cubes" / "moments-8-macbeth.uplift", home / CUBE)
    shutil.copy(repository / "atlases" / "macbeth.txt", home)
    write_exr(home / "fire.exr", planes(np.full((2, 2, 3), 0.5, np.float32)))
    (home / "broken.png").write_text("no image")
    (home / "palette.toml").write_text(PALETTE)
    (home / "scene.toml").write_text('textures = ["wood.png", "none.png"]\n')
    return {path.name for path in home.iterdir()}


@pytest.mark.parametrize("command", INVALID)
def test_all_is_validated_before_anything_is_computed_or_written(run, home, files, monkeypatch, command):
    def begin(*args, **options):
        pytest.fail("began to compute")

    if command in COMPUTES:
        monkeypatch.setattr(COMPUTES[command], begin)
    for arguments in INVALID[command]:
        result = run(*command.split(), *arguments.replace("{}", CUBE).split(), code=2)
        assert result.stdout == "", arguments
        assert {path.name for path in home.iterdir()} == files, arguments


def test_every_command_has_rows():
    groups = {"lights", "study"}
    assert {*INVALID, *WITHOUT_ROWS, *groups} == set(commands(main))
