"""Statements of docs/stability.md hold for the stored figures."""

from __future__ import annotations

import json

import pytest

from tests.conftest import ROOT
from uplift.lab.study.pointwise import IN_MOMENTS, IN_MULTIPLIERS
from uplift.lab.study.stability import NO_ATLAS, UPLIFT
from uplift.lab.study.stability_design import SPACES


@pytest.fixture(scope="module")
def figures():
    return json.loads((ROOT / "docs" / "data" / "stability.json").read_text(encoding="utf-8"))


def test_statements_on_failures(figures):
    rows = figures["map"]
    ours = [row for row in rows if row["solver"] == UPLIFT]
    assert sum(row["unfitted"] for row in ours) == 0
    five = [row for row in ours if (row["dim"], row["threshold"], row["atlas"]) == (17, 1e-4, NO_ATLAS)]
    assert {row["space"] for row in five} == set(SPACES)
    assert {row["model"] for row in five} == {"moments", "sigmoid"}
    assert max(row["threshold"] for row in ours if row["stand_ins"] and row["coefficients"] > 3) < 1e-4
    assert max(row["stand_ins"] for row in ours if row["threshold"] >= 1e-4) <= 1
    assert not any(row["stand_ins"] for row in ours if row["space"] == "sRGB")
    unfitted = {row["coefficients"]: row["unfitted"] for row in rows if row["solver"] == IN_MOMENTS}
    assert unfitted[3] < unfitted[5] < unfitted[9]
    assert max(row["unfitted"] for row in rows if row["solver"] == IN_MULTIPLIERS) <= 2


def test_statements_on_sensitivity(figures):
    cubes = figures["cubes"]
    for cube in cubes.values():
        for move in cube["moves"]:
            if move["mode"] == "spectra":
                assert 0.98 < move["light_mean"] / move["own_mean"] < 1.02
                assert 0.8 < move["light_most"] / move["own_most"] < 1.2
        assert cube["lipschitz"]["largest_per_code"] < 0.06
        wavelength = cube["lipschitz"]["steepest_wavelength"]
        assert min(wavelength - 380, 780 - wavelength) <= 20
    assert cubes["sigmoid-16"]["lipschitz"]["largest"] > 2 * cubes["sigmoid-8"]["lipschitz"]["largest"]
    changes = cubes[figures["constrained"]]["changes"]
    noise = [one["rms_mean"] for one in changes if one["change"].startswith("noise")]
    assert max(noise) < 2 * min(noise)
