"""``uplift lab study``."""

import csv
import io
import json
import os
import re
import shutil

import matplotlib.image
import pytest

from tools.render_docs import pick
from uplift.lab.methods.colour_maps import MAPS
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


def check_plots(folder, names, stderr):
    """Every picture shows something, and no other file is there."""
    assert stderr == f"{folder.name}: {', '.join(names)}\n"
    assert sorted(os.listdir(folder)) == sorted(names)
    for name in names:
        assert matplotlib.image.imread(folder / name).std() > 0.05


def as_text(fields):
    texts = {True: "true", False: "false"}
    return {
        key: texts[value] if isinstance(value, bool) else str(value)
        for key, value in fields.items()
    }


def test_moments(run, ask, rows, home, macbeth, tcs, monkeypatch):
    """The same rows in all formats, and figures."""
    compute_once(monkeypatch, study_moments, "study_moments")
    words = ("moments", "--atlas", macbeth, "--atlas", tcs)
    table = run("lab study", *words, "-o", "out")
    check_plots(
        home / "out",
        ["moments.png", "moments-patches.png", "moments-worst.png"],
        table.stderr,
    )
    found = rows(*words)
    assert len(found) == 3 * 4 * 16
    key = {"atlas": "macbeth", "mirrored": "true", "warped": "false", "moments": "8"}
    expected = {"entries": "24", "floats": "9", "worst": "blue flower"}
    assert pick(found, **key).items() >= expected.items()
    assert list(map(as_text, ask("lab study", *words))) == found
    words = [line.split()[0] for line in table.stdout.splitlines() if line]
    assert set("0123456789") <= set(words)


def test_default_atlases_are_those_of_the_working_folder_or_the_shipped_ones(
    rows, home, tcs
):
    def studied():
        return {row["atlas"] for row in rows("moments")} - {"all"}

    assert studied() == {path.stem for path in tcs.parent.glob("*.txt")}
    (home / "atlases").mkdir()
    shutil.copy(tcs, home / "atlases")
    assert studied() == {"tcs"}


def test_held_out_has_the_same_numbers_in_all_formats(
    run, ask, rows, macbeth, monkeypatch
):
    compute_once(monkeypatch, held_out, "holdout")
    args = ("held-out", "--atlas", macbeth, "--dim", 4)
    objects = ask("lab study", *args)
    assert [one["cube"] for one in objects] == [*CUBES, *held_out.LIBRARY_METHODS]
    assert {one["atlas"] for one in objects} == {"macbeth"}
    for one in objects:
        assert one["rms"] is None if one["cube"] in MAPS else 0 < one["rms"] < 0.5
    assert [float(row["FL11"]) for row in rows(*args)] == pytest.approx(
        [one["FL11"] for one in objects]
    )
    table = run("lab study", *args)
    assert table.stderr == ""
    assert f"{objects[0]['A']:.3g}" in table.stdout
    assert f"ΔE00 {objects[0]['standard_error']['stated']:.2f}, actual" in table.stdout


def test_stability(run, rows, home, monkeypatch, tcs):
    axes = {"dim": (4,), "space": ("sRGB",), "threshold": (1e-3, 1e-4)}
    design = stability.DesignSpace((), axes, samples=1, usual_dim=4, small_dim=4)
    monkeypatch.setattr(stability, "QUICK_DESIGN", design)
    monkeypatch.setattr(stability, "synthetic_atlases", dict)
    compute_once(monkeypatch, stability, "study_stability")
    words = ("stability", "--quick", "--atlas", tcs)
    result = run("lab study", *words, "-o", "out")
    check_plots(home / "out", ["stability.png"], result.stderr)
    assert re.fullmatch(
        r"\d builds, \d+ realisable nodes: 0 unfitted in 0 builds",
        result.stdout.splitlines()[-1],
    )
    found = rows(*words)
    assert {row["atlas"] for row in found} == {"none", "tcs"}
    assert all(
        float(row["success"]) == 1 and float(row["worst"]) <= float(row["threshold"])
        for row in found
    )


def test_sensitivity_of_a_stored_cube(run, home, cubes):
    args = f"lab study sensitivity {cubes}/moments-8-macbeth.uplift --entries 1"
    result = run(f"{args} -o out --format json")
    check_plots(home / "out", ["sensitivity-locality.png"], result.stderr)
    changes = [one["change"] for one in json.loads(result.stdout)["changes"]]
    assert len(changes) == 5
    assert all("dark skin" in change for change in changes[3:])


def test_sensitivity_of_cubes_without_an_atlas(run, misuse):
    assert "left out" not in run("lab study sensitivity").stdout
    assert "Smits" in run("lab study sensitivity --method smits1999").stdout
    assert "needs a CUBE with an atlas" in misuse("lab study sensitivity -o out")
