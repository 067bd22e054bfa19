"""The page of stability: what it says is in its figures, and what others leave beside it is shown."""

from __future__ import annotations

import json

from benchmarks.stability import tables
from benchmarks.stability.measure import CONSTRAINED, FIGURES
from benchmarks.stability.write import others, read_map
from uplift.lab.study.pointwise import IN_MOMENTS, IN_MULTIPLIERS
from uplift.lab.study.stability_design import SPACES


def test_a_file_beside_the_page_is_a_section(tmp_path):
    path = tmp_path / "stability-other.json"
    assert others(path) == []
    part = {
        "title": "Told",
        "command": "make told",
        "columns": ["a", "b"],
        "rows": [["x", 0.12345]],
        "notes": ["So."],
    }
    path.write_text(json.dumps(part))
    (section,) = others(path)
    assert section == "\n## Told\n\nBy `make told`. So.\n\n| a | b |\n| --- | --- |\n| x | 0.123 |\n"
    path.write_text(json.dumps([part, part]))
    assert others(path) == [section, section]


def test_the_page_s_words_on_failures():
    rows = read_map()
    ours = [row for row in rows if row["solver"] == "uplift"]
    assert sum(row["unfitted"] for row in ours) == 0
    assert {row["space"] for row in tables.five_spaces_of(rows)} == set(SPACES)
    assert {row["model"] for row in tables.five_spaces_of(rows)} == {"moments", "sigmoid"}
    assert {row["threshold"] for row in ours if row["stand_ins"]} == {1e-6}
    assert not any(row["stand_ins"] for row in ours if row["space"] == "sRGB")
    left = {row["coefficients"]: row["unfitted"] for row in rows if row["solver"] == IN_MOMENTS}
    assert left[3] < left[5] < left[9]
    assert max(row["unfitted"] for row in rows if row["solver"] == IN_MULTIPLIERS) <= 2


def test_the_page_s_words_on_sensitivity():
    cubes = json.loads(FIGURES.read_text(encoding="utf-8"))["cubes"]
    for cube in cubes.values():
        for move in cube["moves"]:
            if move["mode"] == "spectra":
                assert 0.98 < move["light_mean"] / move["own_mean"] < 1.02
                assert 0.8 < move["light_most"] / move["own_most"] < 1.2
        assert cube["lipschitz"]["largest_per_code"] < 0.06
        assert cube["lipschitz"]["steepest_wavelength"] in (380, 780)
    assert cubes["sigmoid-16"]["lipschitz"]["largest"] > 2 * cubes["sigmoid-8"]["lipschitz"]["largest"]
    noise = [one["rms_mean"] for one in cubes[CONSTRAINED]["changes"] if one["change"].startswith("noise")]
    assert noise[2] > 5 * max(noise[:2])
