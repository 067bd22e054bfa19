"""Topics of the help, suggestions for misspelt names, and completion in shells."""

from __future__ import annotations

import pytest
from uplift_cli.commands.help import TOPICS

from uplift.atlas import shipped_atlases
from uplift.lookup import MODES


def test_topics_are_listed(run):
    listed = run("help").stdout
    for name in TOPICS:
        assert f"{name} " in listed
        assert len(run("help", name).stdout) > 60


def test_topics_have_what_the_code_has(run):
    text = run("help", "modes").stdout
    assert all(f'"{mode}"' in text for mode in MODES)
    assert all(atlas.name in run("help", "atlases").stdout for atlas in shipped_atlases())
    assert "LED-B3" in run("help", "illuminants").stdout
    assert "ITU-R BT.2020" in run("help", "spaces").stdout


def test_help_of_a_command(run):
    assert "--out-of-gamut" in run("help", "query").stdout


@pytest.mark.parametrize(
    ("args", "near"),
    [
        (("txture",), "'texture'"),
        (("help", "mods"), "'modes'"),
        (("study", "hold-out"), "'held-out'"),
        (("build", "--dimm", "8"), "'--dim'"),
    ],
)
def test_misspelt_words_have_a_suggestion(misuse, args, near):
    assert f"Did you mean {near}?" in misuse(*args)


def test_unlike_words_have_none(misuse):
    assert "Did you mean" not in misuse("xyzzy")


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("uplift tex", "texture"),
        ("uplift build --atlas mac", "macbeth"),
        ("uplift atlas bab", "babelcolor"),
        ("uplift build --light led-b3", "LED-B3"),
        ("uplift build --space acesc", "ACEScg"),
        ("uplift report CUBES/moments-8-", "CUBES/moments-8-macbeth.uplift"),
        ("uplift query --mode ref", "refined"),
        ("uplift lights info em", "emission"),
        ("uplift info sr", "srgb"),
    ],
)
@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_shells_complete_names(run, cubes, monkeypatch, shell, words, expected):
    words, expected = (text.replace("CUBES", str(cubes)) for text in (words, expected))
    monkeypatch.setenv("COMP_WORDS", words)
    monkeypatch.setenv("COMP_CWORD", words.rsplit(" ", 1)[-1] if shell == "fish" else str(len(words.split()) - 1))
    result = run(env={"_MAIN_COMPLETE": f"{shell}_complete"}, prog_name="main")
    assert expected in result.stdout.replace(",", "\n").replace("\t", "\n").splitlines()


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_scripts_of_shells(run, shell):
    assert "_MAIN_COMPLETE" in run(env={"_MAIN_COMPLETE": f"{shell}_source"}, prog_name="main").stdout
