"""The search finds the best filter; the stored tables of Kment 2011 are consistent."""

from __future__ import annotations

import csv

import pytest

from tests.conftest import ROOT
from uplift.lab.comparison.compare import error_statistics
from uplift.lab.comparison.filters import NONE, tune_filters
from uplift.scene.representations.filters import COARSE_STRIDE, candidates, filtered_point_samples
from uplift.scene.representations.samples import point_samples


@pytest.fixture(scope="module")
def tuned(checker):
    return {
        (one.lights, one.kind): one
        for one in tune_filters(checker, COARSE_STRIDE, ("tent", "lanczos", "mitchell"), (16,))
    }


@pytest.mark.parametrize("lights", ["smooth", "spiky"])
@pytest.mark.parametrize("kind", ["tent", "lanczos"])
def test_no_candidate_is_better(checker, tuned, lights, kind):
    (part,) = [part for part in checker.sets if part.name == lights]
    means = {
        one: error_statistics(filtered_point_samples(16, one), checker, part).mean
        for one in candidates(kind, COARSE_STRIDE)
    }
    best = tuned[lights, kind]
    assert best.low_pass == min(means, key=means.__getitem__)
    assert best.statistics.mean == pytest.approx(min(means.values()), rel=1e-9)


def test_without_a_filter_results_are_those_of_point_sampling(checker, tuned):
    for part in checker.sets:
        assert tuned[part.name, NONE].statistics == error_statistics(point_samples(16), checker, part)
        assert tuned[part.name, NONE].parameters == ""


def test_filters_improve_point_sampling_under_spiky_lights(tuned):
    for kind in ("mitchell", "lanczos"):
        assert tuned["spiky", kind].statistics.mean < 0.3 * tuned["spiky", NONE].statistics.mean


def rows(name):
    with (ROOT / "tests" / "reference" / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def test_filters_start_from_point_sampling_of_the_other_tables():
    tables = {(row["lights"], row["representation"]): row for row in rows("representations_kment2011.csv")}
    bare = [row for row in rows("filters_kment2011.csv") if row["filter"] == "none" and row["samples"] != "4"]
    assert len(bare) == 4
    for row in bare:
        other = tables[row["lights"], f"PS{row['samples']}"]
        assert (row["mean"], row["deviation"]) == (other["mean"], other["deviation"])


@pytest.mark.parametrize(("kind", "change"), [("mitchell", -85.32), ("lanczos", -83.89), ("tent", -76.80)])
def test_table_7_1_follows_from_table_a_2(kind, change):
    means = {
        row["filter"]: float(row["mean"])
        for row in rows("filters_kment2011.csv")
        if (row["lights"], row["samples"]) == ("spiky", "16")
    }
    assert 100 * (means[kind] / means["none"] - 1) == pytest.approx(change, abs=0.005)
