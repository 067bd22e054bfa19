"""``uplift lab study``."""

import csv
import io
import os
import shutil
from functools import partial

import pytest

from tools.render_docs import pick
from uplift.lab.methods.colour_maps import MAPS
from uplift.lab.runner import divided
from uplift.lab.study import held_out, stability
from uplift.lab.study import moments as study_moments

CUBES = ["half the atlas", "without an atlas", "sigmoid", "local-linear regression"]


@pytest.fixture
def tcs(repository):
    """The smallest atlas."""
    return repository / "atlases" / "tcs.txt"


@pytest.fixture
def rows(run):
    """Rows of the CSV on standard output."""
    return lambda *args: list(
        csv.DictReader(io.StringIO(run("lab study", *args, "--format", "csv").stdout))
    )


def compute_once(monkeypatch, module, name):
    """Give every command of a test the first result of a study."""
    compute = getattr(module, name)
    results = []

    def repeat(*args, **options):
        results.append(results[0] if results else compute(*args, **options))
        return results[0]

    monkeypatch.setattr(module, name, repeat)


def test_moments(run, ask, home, macbeth, tcs, monkeypatch):
    compute_once(monkeypatch, study_moments, "study_moments")
    words = ("lab study moments --atlas", macbeth, "--atlas", tcs)
    assert "ΔE76 under D65" in run(*words, "-o", "out").stdout
    assert len(os.listdir(home / "out")) == 3
    key = {"atlas": "macbeth", "mirrored": True, "warped": False, "moments": 8}
    expected = {"entries": 24, "floats": 9, "worst": "blue flower"}
    assert pick(ask(*words), **key).items() >= expected.items()


def test_default_atlases_are_those_of_the_working_folder_or_the_shipped_ones(
    rows, home, tcs
):
    assert "babelcolor" in {row["atlas"] for row in rows("moments")}
    (home / "atlases").mkdir()
    shutil.copy(tcs, home / "atlases")
    assert {row["atlas"] for row in rows("moments")} == {"tcs", "all"}


def test_held_out_has_the_same_numbers_in_all_formats(
    run, ask, rows, macbeth, monkeypatch
):
    compute_once(monkeypatch, held_out, "holdout")
    monkeypatch.setattr(held_out, "divided", partial(divided, seeds=1))
    args = ("held-out", "--atlas", macbeth, "--dim", 4)
    objects = ask("lab study", *args)
    assert [one["cube"] for one in objects] == [*CUBES, *held_out.LIBRARY_METHODS]
    for one, row in zip(objects, rows(*args), strict=True):
        assert one["rms"] is None if one["cube"] in MAPS else 0 < one["rms"] < 0.5
        assert float(row["FL11"]) == pytest.approx(one["FL11"])
    table = run("lab study", *args).stdout
    assert f"{objects[0]['A']:.3g}" in table
    assert f"ΔE00 {objects[0]['standard_error']['stated']:.2f}, actual" in table


def test_stability(run, rows, home, monkeypatch, tcs):
    axes = {"dim": (4,), "space": ("sRGB",), "threshold": (1e-3, 1e-4)}
    design = stability.DesignSpace((), axes, samples=1, usual_dim=4, small_dim=4)
    monkeypatch.setattr(stability, "QUICK_DESIGN", design)
    monkeypatch.setattr(stability, "synthetic_atlases", dict)
    compute_once(monkeypatch, stability, "study_stability")
    words = ("stability", "--quick", "--atlas", tcs)
    assert ": 0 unfitted in 0 builds" in run("lab study", *words, "-o", "out").stdout
    assert os.listdir(home / "out") == ["stability.png"]
    for row in rows(*words):
        assert float(row["success"]) == 1
        assert float(row["worst"]) <= float(row["threshold"])


def test_sensitivity_of_a_stored_cube(ask, home, cubes):
    args = f"lab study sensitivity {cubes}/moments-8-macbeth.uplift --entries 1"
    changes = [one["change"] for one in ask(f"{args} -o out")["changes"]]
    assert os.listdir(home / "out") == ["sensitivity-locality.png"]
    assert len(changes) == 5
    assert all("dark skin" in change for change in changes[3:])


def test_sensitivity_of_cubes_without_an_atlas(run):
    assert "left out" not in run("lab study sensitivity").stdout
    assert "Smits" in run("lab study sensitivity --method smits1999").stdout
