"""``uplift chart``."""

from __future__ import annotations

import csv

import matplotlib.image
import pytest
from click.testing import CliRunner
from uplift_cli.main import main

from uplift.lab.chart.recommend import MEASURED, shipped
from uplift.lab.chart.table import csv_text, read_chart
from uplift.lab.timing import ONE_THREAD

FILES = ["chart.csv", "chart.html", "chart.png", "chart.svg"]


@pytest.fixture(scope="module")
def quick(repository, tmp_path_factory):
    """A quick chart of the ColorChecker: the folder, and what was said."""
    folder = tmp_path_factory.mktemp("quick")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for name, value in ONE_THREAD.items():
            patch.setenv(name, value)  # to be taken back
        patch.setenv("JAX_COMPILATION_CACHE_DIR", str(folder / "compiled"))
        atlas = str(repository / "atlases" / "macbeth.txt")
        words = ["chart", "--quick", "--atlas", atlas, "--colours", "300", "-o", "out"]
        result = CliRunner().invoke(main, words, catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return folder / "out", result


@pytest.fixture(scope="module")
def numbers(quick):
    """The numbers of each method."""
    return {row.method: row.numbers for row in read_chart(quick[0] / "chart.csv").rows}


def test_everything_is_written_and_told(quick, numbers):
    folder, result = quick
    assert sorted(path.name for path in folder.iterdir()) == FILES
    assert matplotlib.image.imread(folder / "chart.png").std() > 0.05
    assert (folder / "chart.svg").read_text(encoding="utf-8").startswith("<svg")
    text = (folder / "chart.html").read_text(encoding="utf-8")
    assert "marker-0-0" in text
    assert "Round trip under D65" in result.stdout
    assert "Building: " in result.stdout
    assert sum(name in result.stdout for name in numbers) >= 2
    assert result.stderr == "out: chart.csv, chart.png, chart.svg, chart.html\n"


def test_the_table_tells_where_and_how_it_was_measured(quick):
    with (quick[0] / "chart.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["state"] for row in rows} == {"measured"}
    for fact in ("machine", "versions", "commit"):
        assert len({row[fact] for row in rows}) == 1
        assert rows[0][fact]
    assert all(float(row["time_ns"]) > 0 and float(row["bytes"]) > 0 for row in rows)


def test_mallett_s_round_trip_is_exact_in_srgb(numbers):
    # Exact but for the rounding of its table.
    assert numbers["mallett2019"]["round_trip_max"] < 0.02
    assert numbers["mallett2019"]["round_trip_mean"] < 0.01 * numbers["smits1999"]["round_trip_mean"]


def test_a_fine_lattice_is_nearer_than_a_coarse_one(numbers):
    for kind in ("mean", "p99", "max"):
        fine, coarse = (numbers[f"moments9-{dim}-moments"][f"round_trip_{kind}"] for dim in (64, 16))
        assert fine < coarse / 2


def test_spectra_are_at_least_as_near_as_moments(numbers):
    for cube in ("moments9-16", "moments9-64", "moments9-16-atlas"):
        for kind in ("mean", "p99", "max"):
            spectra, moments = (
                numbers[f"{cube}-{mode}"][f"round_trip_{kind}"] for mode in ("spectra", "moments")
            )
            assert spectra <= moments


def test_an_atlas_is_nearer_at_its_own_materials(numbers):
    own = {name: numbers[f"moments9-16{name}-spectra"]["own_lights_mean"] for name in ("", "-atlas")}
    assert own["-atlas"] < own[""] / 2


def test_boxes_are_worse_than_smooth_spectra_under_other_lights(numbers):
    for name, found in numbers.items():
        if name != "macadam1935":
            assert found["FL11_mean"] < numbers["macadam1935"]["FL11_mean"]


def test_a_chart_is_drawn_anew_from_its_table(quick, run, refuse):
    table = quick[0] / "chart.csv"
    result = run("chart", "--from", table, "-o", "again")
    assert result.stdout == quick[1].stdout
    message = refuse("chart", "--from", table, "-o", "again")
    assert "chart.csv: exists already; use --force" in message


def test_what_to_build_is_recommended_from_a_table(quick, run, refuse):
    table = quick[0] / "chart.csv"
    result = run("chart", "--recommend", "--from", table, "--delta-e", 0.05, "--light", "D65")
    assert "under D65" not in result.stdout
    assert "of the round trip" in result.stdout
    assert (
        "\n  uplift build --dim " in result.stdout or "\n  uplift build --atlas FILE --dim " in result.stdout
    )
    assert "no cube answers in 0.5 ns per RGB" in refuse(
        "chart", "--recommend", "--from", table, "--time-ns", 0.5
    )


def test_by_default_from_the_chart_of_the_documentation(run, refuse, repository):
    result = run("chart", "--recommend", "--delta-e", 1, "--light", "FL11", "--atlas-materials")
    assert "--atlas FILE" in result.stdout
    assert "materials of the atlas" in result.stdout
    stored = (repository / "uplift" / "chart" / MEASURED).read_text(encoding="utf-8")
    assert csv_text(shipped()) == stored


def test_bad_input_is_refused(run, refuse, home, macbeth):
    assert refuse("chart").startswith("there are no atlases/*.txt here")
    assert "no method is called 'x'" in refuse("chart", "--atlas", macbeth, "--methods", "x")
    assert "3 colours say nothing" in refuse("chart", "--atlas", macbeth, "--colours", 3)
    assert "nothing is wished for" in refuse("chart", "--recommend")
    assert "did you mean 'FL2'" in refuse("chart", "--recommend", "--delta-e", 1, "--light", "FL12")
    assert "none.csv: cannot be read" in refuse("chart", "--from", "none.csv")
    (home / "file").write_text("mine")
    assert "cannot be created" in refuse("chart", "--atlas", macbeth, "-o", "file")
    assert "go with --recommend" in run("chart", "--time-ns", 100, code=2).stderr
