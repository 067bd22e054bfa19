"""``uplift build``."""

import pytest

import uplift

from .conftest import warning_lines

SMALL = ("--dim", "4", "--coefficients", "4")
LOOK = (
    '[[look]]\nrgb = "#4060a0"\nA = "#5060a0"\n[[look]]\nrgb = "#8a2a20"\nHP1 = '
    '"#70392a"\nname = "brick"\n'
)


def test_unrealisable_colours_are_counted(run, home):
    result = run("build --dim 3 --space 'ITU-R BT.2020' -o wide.uplift")
    count = uplift.load(home / "wide.uplift").data.points.counts()["unrealisable"]
    assert count > 0
    assert f"{count} nodes whose colour no reflectance has" in result.stdout
    query = "query --cube wide.uplift"
    assert "\nrealisable " in run(f"{query} 0 1 0").stdout
    assert "\nrealisable" not in run(f"{query} 0.5 0.5 0.5").stdout


@pytest.mark.parametrize(
    ("args", "name"),
    [
        ("--space Pal/Secam", "pal-secam-2.uplift"),
        ("--atlas a.csv --atlas far/b.csv", "a+b-2.uplift"),
    ],
)
def test_default_name_has_atlas_or_space_and_dim(run, home, args, name):
    (home / "far").mkdir()
    (home / "a.csv").write_text("name,380,780\ngrey,0.5,0.5\n")
    (home / "far" / "b.csv").write_text("name,380,780\nblack,0.01,0.01\n")
    run(f"build --dim 2 --coefficients 4 {args}")
    assert (home / name).is_file()


def test_all_options_are_passed_to_the_build(run, home, monkeypatch, plain_cube):
    given = {
        "dim": 3,
        "step": 10.0,
        "space": "Display P3",
        "observer": "CIE 1964 10 Degree Standard Observer",
        "growth": "neighbours",
        "lights": ("A", "FL2"),
        "library": ("b.csv",),
        "looks": "l.toml",
        "leave_out": ("wood",),
        "auto_tolerance": 0.7,
        "trust_atlas": True,
    }
    names = {
        "lights": "light",
        "looks": "look",
        "leave_out": "exclude-family",
        "auto_tolerance": "tolerance",
    }
    words = ["--range", "360:830"]
    for name, value in given.items():
        option = "--" + names.get(name, name).replace("_", "-")
        if value is True:
            words.append(option)
            continue
        for each in value if isinstance(value, tuple) else (value,):
            words += [option, each]
    passed = {}
    monkeypatch.setattr(
        "uplift.pipeline.build.build",
        lambda atlas, **options: passed.update(options) or plain_cube,
    )
    run("build", *words, "-o", "cube")
    assert callable(passed.pop("progress"))
    assert passed == passed | given | {"shortest": 360, "longest": 830}


def test_the_same_input_gives_the_same_bytes(run, home, macbeth):
    build = ("build", "--atlas", macbeth, *SMALL, "--entry-coefficients", 12, "-o")
    loud = run(*build, "a")
    quiet = run(*build, "b", "-q")
    assert (home / "a").read_bytes() == (home / "b").read_bytes()
    assert uplift.load(home / "a").entry_coefficient_count == 12
    assert "23 atlas entries" in loud.stdout
    assert quiet.stdout == ""
    assert "1 of 24 entries lies outside sRGB" in loud.stdout


def test_a_shipped_atlas_by_the_name_of_its_file_is_a_warning(run):
    result = run("build --atlas macbeth.txt", *SMALL, "-o", "cube.uplift")
    (line,) = warning_lines(result)
    assert "the shipped atlas 'macbeth' is used" in line


def test_looks_are_built_summarised_and_shown(run, home):
    (home / "looks.toml").write_text(LOOK)
    words = "--prior smooth --look looks.toml -o looks.uplift"
    result = run("build", *SMALL, *words.split())
    assert ", 2 looks, " in result.stdout
    (impossible,) = warning_lines(result)
    assert "looks.toml" in impossible
    assert "#5060a0" in impossible
    shown = " ".join(run("info looks.uplift").stdout.split())
    assert "look brick HP1 #70392a (ΔE00 0.00)" in shown
    run("check looks.uplift")
