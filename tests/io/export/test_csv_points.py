"""Nodes as CSV."""

from __future__ import annotations

import csv

import numpy as np

from tests.cube.hand_made import hand_made
from uplift.io.export import csv_points, write_csv
from uplift.lattice import Status


def read(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_every_node_has_a_line_in_full_precision(tmp_path, monkeypatch):
    monkeypatch.setattr(csv_points, "BLOCK", 5)
    data = hand_made()
    assert write_csv(data, tmp_path / "points.csv") == data.lattice.size
    rows = read(tmp_path / "points.csv")

    def column(*names):
        return np.array([[float(row[name]) for name in names] for row in rows]).squeeze()

    np.testing.assert_array_equal(column("r", "g", "b"), data.lattice.points)
    np.testing.assert_array_equal(column("lattice_r", "lattice_g", "lattice_b"), data.points.rgb)
    np.testing.assert_array_equal(column("distance"), data.points.distance)
    np.testing.assert_array_equal(column("round"), data.points.round)
    np.testing.assert_array_equal(column("standard_error"), data.points.standard_error)
    np.testing.assert_array_equal(column("c0", "c1", "c2"), data.points.coefficients)
    assert [row["status"] for row in rows] == [Status(status).label for status in data.points.status]
    assert [row["entry"] for row in rows] == [
        "" if entry < 0 else data.atlas.names[entry] for entry in data.points.entry
    ]


def test_missing_quantities_have_no_column(tmp_path):
    write_csv(hand_made(round=None, standard_error=None), tmp_path / "points.csv")
    names = read(tmp_path / "points.csv")[0].keys()
    assert not {"round", "standard_error"} & set(names)
    assert "c2" in names
