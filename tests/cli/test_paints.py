"""``uplift paints``, and measured paints in mixtures and exports."""

from dataclasses import replace
from itertools import chain

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.extras.paint.invented import NAMES, invented, measured, plan
from uplift.extras.paint.paints_file import read_paints, write_paints

GRID = (400, 700, 20)


@pytest.fixture
def paints(home):
    """Four paints with prices in paints.toml."""
    priced = replace(invented(), prices=(1.0, 2.0, 3.0, 5.0))
    write_paints(priced, home / "paints.toml")
    return read_paints(home / "paints.toml")


@pytest.fixture
def samples(home):
    """Samples of three paints in samples.csv, one of which has a wrong recipe."""
    paints = invented(names=NAMES[:3])
    taken = measured(paints, plan(paints), 1.0)
    shares = taken.shares.copy()
    shares[6] = shares[6, [0, 2, 1]]
    columns = np.hstack([shares, taken.measured.values])
    names = [*paints.names, *map(str, paints.wavelengths)]
    rows = [",".join(["name", *names])]
    for name, numbers in zip(taken.names, columns, strict=True):
        rows.append(",".join([name, *map(str, numbers)]))
    (home / "samples.csv").write_text("\n".join(rows))
    return taken


def test_fit_writes_paints_and_reports_them(run, ask, samples, home):
    answer = ask("paints fit samples.csv -o mine.toml")
    stored = read_paints(home / "mine.toml")
    assert stored.names == NAMES[:3]
    for row, paint in enumerate(answer["paints"]):
        assert paint["name"] == stored.names[row]
        assert_allclose(paint["absorption"], stored.pigments.absorption[row], rtol=1e-8)
        assert_allclose(paint["scattering_errors"], stored.errors.scattering[row])
    assert answer["surface"]["inside"] == pytest.approx(stored.surface.inside)
    errors = {sample["name"]: sample["delta_e"] for sample in answer["samples"]}
    assert max(errors, key=errors.__getitem__) == "sample 6"
    expected = [answer["mixtures_error"]]
    expected += [advised["mixtures_error"] for advised in answer["next"]]
    assert (np.diff(expected) < 0).all()
    table = run("paints fit samples.csv -o mine.toml --force").stdout
    assert "sample 6" in table
    assert "1 white : 1 red" in table


@pytest.mark.parametrize(
    ("options", "surface"),
    [
        ("--refractive-index 1.5 --surface-reflectance 0.01", (0.01, 0.596)),
        ("--surface-reflectance 0.02 --internal-reflectance 0.5", (0.02, 0.5)),
    ],
)
def test_a_stated_surface_is_kept(run, samples, home, options, surface):
    run(f"paints fit samples.csv -o mine.toml {options}")
    stored = read_paints(home / "mine.toml").surface
    assert (stored.outside, stored.inside) == pytest.approx(surface, abs=1e-3)


def test_recipes_match_those_of_the_library(run, ask, paints):
    words = "paints match #3e7d4b --paints paints.toml --light D65 --light A"
    answer = ask(words)
    assert answer["colour"] in ("#3e7d4b", "#3f7d4b")  # at 20 nm
    best = answer["recipes"][0]
    named = {paint["name"]: paint["parts"] for paint in best["paints"]}
    parts = [named.get(name, 0) for name in paints.names]
    assert best["cost"] == pytest.approx(paints.cost(parts))
    assert set(best["delta_e"]) == {"D65", "A"}
    assert not set(best["elsewhere"]) & {"D65", "A"}
    recipe = " + ".join(f"{count} {name}" for name, count in named.items())
    assert recipe in run(words).stdout


def test_a_measured_spectrum_is_matched(ask, paints, home):
    values = np.stack([paints.wavelengths, paints.reflectance([3, 0, 0, 1])], axis=1)
    np.savetxt(
        home / "card.csv", values, "%.9f", ",", header="wavelength,card", comments=""
    )
    for words in ("--spectrum card.csv", "card --atlas card.csv"):
        answer = ask(f"paints match {words} --paints paints.toml")
        best = answer["recipes"][0]
        parts = {paint["name"]: paint["parts"] for paint in best["paints"]}
        assert parts["white"] == 3 * parts["blue"]
        assert max(best["delta_e"]["D65"], *best["elsewhere"].values()) < 0.01


def test_options_limit_the_recipes(ask, paints):
    words = "paints match #405060 --paints paints.toml"
    for recipe in ask(f"{words} --count 2 --parts 9")["recipes"]:
        assert len(recipe["paints"]) <= 2
        assert sum(paint["parts"] for paint in recipe["paints"]) <= 9
    few = ask(f"{words} --paint white --paint blue --plot recipes.png")
    used = chain(*(row["paints"] for row in few["recipes"]))
    assert {paint["name"] for paint in used} == {"white", "blue"}
    thin = ask(f"{words} --thickness 0 --ground #405060")
    assert thin["recipes"][0]["delta_e"]["D65"] < 0.1


def test_colours_out_of_reach_are_stated(run, paints):
    text = run("paints match #00ff00 --paints paints.toml --count 2").stdout
    assert "No mixture of 2 paints reaches the colour" in " ".join(text.split())


def test_info_shows_what_the_file_has(run, ask, paints):
    answer = ask("paints info paints.toml")
    assert answer["wavelengths"] == paints.wavelengths.tolist()
    text = run("paints info paints.toml").stdout
    for row, paint in enumerate(answer["paints"]):
        name = paints.names[row]
        assert paint["name"] == name
        assert paint["colour"] == ask(f"paints mix {name} --paints paints.toml")["hex"]
        assert paint["price"] == paints.prices[row]
        assert paint["absorption"] == paints.pigments.absorption[row].tolist()
        assert f"{name} " in text


def test_mix_has_the_spectra_of_the_library(ask, paints):
    finer = paints.at(np.arange(400.0, 701, 20))
    words = "paints mix 3:white 1:blue --paints paints.toml --wavelengths 400:700:20"
    film = ask(f"{words} --thickness 0.5 --ground black")["spectrum"]
    expected = finer.reflectance([3, 0, 0, 1], 0.5, 0.0)
    assert_allclose(film, expected, atol=1e-5)
    bare = ask(f"{words} --refractive-index 1")["spectrum"]
    internal = replace(finer, surface=type(finer.surface)())
    assert_allclose(bare, internal.reflectance([3, 0, 0, 1]), atol=1e-5)


@pytest.mark.parametrize("suffix", [".h", ".glsl", ".hlsl", ".html"])
def test_exports_have_all_paints_or_those_selected(run, paints, home, suffix):
    path = home / f"tubes{suffix}"
    run("export paints.toml -o", path)
    assert "yellow" in path.read_text("utf-8")
    run("export paints.toml --paint red --force -o", path)
    assert "yellow" not in path.read_text("utf-8")


def test_a_table_of_two(run, paints, home):
    run("export paints.toml -o a.cube --paint red --paint blue")
    assert "red: share of blue in red" in (home / "a.cube").read_text()
