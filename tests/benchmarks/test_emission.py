"""Evidence on emission tables: what predictions must not know, other methods, exactness, cost, on small tables."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

import uplift
from benchmarks import emission
from benchmarks.emission import (
    FAMILIES,
    drop_discs,
    exactness,
    lamp_family,
    mixtures,
    nearest,
    planck,
    predict,
    round_trips,
    sigmoid_times_d65,
    spokes,
    unknown_lamps,
    white_lights,
)
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import observer
from uplift.lights.lattice import chromaticity
from uplift.lights.lookup import EmissionTable

SMALL = {"knots": 64, "rings": 4}
LAMPS = observer.lamps()
CHECKER = on_grid(read_atlas("macbeth"), observer.grid())
CMFS = observer.matching_functions()
RADIOMETRY = CMFS / CMFS[:, 1].sum()
UV = chromaticity(LAMPS.power @ RADIOMETRY)


@pytest.fixture(scope="module")
def unknown():
    return unknown_lamps(LAMPS, CHECKER, RADIOMETRY)


def row(name):
    return LAMPS.names.index(name)


def test_every_lamp_has_one_family_and_every_family_lamps():
    assert set(Counter(map(lamp_family, LAMPS.names))) == set(FAMILIES)
    assert lamp_family("FL11") == lamp_family("F32T8/TL830 (Triphosphor)") != lamp_family("FL1")
    with pytest.raises(LookupError):
        lamp_family("candle")


def test_predictions_of_a_lamp_never_know_it(unknown):
    for known in unknown.values():
        assert known.diagonal().all()
        assert (known == known.T).all()
    assert unknown["lamp"].sum() == len(LAMPS)
    assert unknown["near-duplicates"][row("D65"), row("ID65")]
    assert not unknown["near-duplicates"][row("D65"), row("A")]


def test_a_table_without_a_lamp_has_its_colour_and_not_its_spectrum():
    lamp = LAMPS.power[[row("FL11")]]
    unknown = np.arange(len(LAMPS))[None] == row("FL11")
    found = predict(LAMPS.names, unknown, lamp, **SMALL)
    for power in (found.table, found.without_discs):
        np.testing.assert_allclose(chromaticity(power @ RADIOMETRY), chromaticity(lamp @ RADIOMETRY), atol=1e-7)
        assert np.abs(power - lamp).max() > 0.1
    assert found.expected[0] > 0


def test_sigmoids_times_d65_have_the_rgb():
    matrix = np.linalg.inv(observer.primaries("sRGB").rgb_to_xyz)
    some = LAMPS.power[[row("D65"), row("FL11"), row("LED-B3")]]
    d65 = LAMPS.power[row("D65")]
    found = sigmoid_times_d65(some, RADIOMETRY, matrix, d65)
    assert found.missed.max() < 1e-6
    np.testing.assert_allclose(chromaticity(found.power @ RADIOMETRY), chromaticity(some @ RADIOMETRY), atol=1e-5)
    np.testing.assert_allclose(np.ptp(found.power[0] / d65), 0, atol=1e-3)


def test_tungsten_is_planckian():
    lamp = LAMPS.power[[row("A")]]
    found = planck(lamp, RADIOMETRY, observer.grid())[0]
    np.testing.assert_allclose(found / found.sum(), lamp[0] / lamp[0].sum(), rtol=5e-3)


def test_the_nearest_lamp_is_a_known_one(unknown):
    found = nearest(LAMPS, unknown["lamp"], RADIOMETRY, 1)
    apart = np.linalg.norm(UV - UV[row("D65")], axis=1)
    apart[row("D65")] = np.inf
    np.testing.assert_array_equal(found[row("D65")], LAMPS.power[apart.argmin()])
    apart = nearest(LAMPS, unknown["family"], RADIOMETRY, 1)[row("D65")]
    assert lamp_family(LAMPS.names[int(np.abs(LAMPS.power - apart).max(axis=1).argmin())]) != "daylight"


def test_exactness_is_measured_from_white_to_the_locus():
    table = uplift.load_emission()
    uv = spokes(table, 12, 5)
    share = table.data.lattice.polar(uv - table.data.lattice.white)[2]
    assert share.min() == pytest.approx(0, abs=1e-12)
    assert share.max() == pytest.approx(1, abs=1e-12)
    double, single = exactness(table, uv)
    assert double["uv_error"] < 1e-6
    assert single["uv_error"] < 1e-5
    assert min(double["min_power"], single["min_power"]) >= 0
    mixed = mixtures(table)
    assert mixed["colours"] > 3000
    assert 1e-6 < mixed["uv_error"] < 1e-4
    assert mixed["delta_e"] < 0.1
    trips = list(round_trips(table, (1.0, 1e5), 100))
    assert all(0 < each["float64"] <= each["float32"] < 0.05 for each in trips)


def test_inexact_tables_are_noticed():
    data = uplift.load_emission().data
    wrong = EmissionTable(replace(data, spectra=data.spectra * np.linspace(0.9, 1.1, 81, dtype=np.float32)))
    assert next(exactness(wrong, spokes(wrong, 12, 5)))["uv_error"] > 1e-3
    assert next(round_trips(wrong, (1.0,), 100))["float64"] > 0.05


def test_white_lights_of_the_table_are_the_illuminants():
    table = uplift.load_emission()
    *lamps, white = white_lights(table, LAMPS, ("D65", "A"), CHECKER)
    assert [each["lamp"] for each in lamps] == ["D65", "A"]
    for each in lamps:
        assert each["spectrum"] < 1e-3
        assert each["grey"] < 1e-3
    assert white["grey"] < 1e-6


def test_the_map_ends_at_the_locus(tmp_path):
    table = drop_discs(uplift.load_emission())
    errors = emission.expected_errors(table, 40)
    assert np.isnan(errors[0, 0])
    assert 0.2 < np.isfinite(errors).mean() < 0.7
    emission.draw_error_map(table, LAMPS.names, LAMPS.power, np.ones(len(LAMPS)), tmp_path / "map.png")
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
