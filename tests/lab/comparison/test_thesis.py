"""Consistency of the stored tables of Kment 2011."""

from __future__ import annotations

import csv

import pytest

from tests.conftest import ROOT


def rows(name):
    with (ROOT / "tests" / "reference" / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


@pytest.mark.parametrize("lights", ["smooth", "spiky"])
def test_tables_are_ranked_and_their_quantiles_ascend(lights):
    found = [row for row in rows("representations_kment2011.csv") if row["lights"] == lights]
    means = [float(row["mean"]) for row in found]
    assert means == sorted(means)
    assert len(found) == 13
    for row in found:
        values = [float(row[key]) for key in ("q2_5", "q25", "median", "q75", "q97_5")]
        assert values == sorted(values)


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
