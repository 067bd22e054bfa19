"""Errors are those of single products, results are ranked, and the cheapest one is recommended."""

from __future__ import annotations

import numpy as np
import pytest

import uplift
from tests.conftest import MACBETH
from tests.helpers import raises
from tests.lab.comparison.conftest import EFFORT
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.errors import AtlasError, OptionError, UnknownNameError, UpliftError
from uplift.lab.comparison.compare import (
    HEADINGS,
    Comparison,
    RepresentationResult,
    Statistics,
    cheapest,
    compare,
    compute_statistics,
    error_statistics,
    make_scene,
    most_accurate,
)
from uplift.lab.timing import Spread
from uplift.scene.representations.samples import SampleRepresentation, point_samples, xyz_weights


def test_dense_data_have_no_error(checker):
    dense = SampleRepresentation("dense", "dense", np.eye(401), xyz_weights())
    for part in checker.sets:
        assert max(error_statistics(dense, checker, part)) < 1e-9


def test_errors_match_explicit_loops(checker):
    part, samples, apart = checker.sets[1], point_samples(16), []
    for power in part.powers:
        white = power @ xyz_weights()
        for surface in checker.surfaces:
            product = samples.multiply(samples.encode_light(power[None]), samples.encode_surface(surface[None]))
            pair = (lab(samples.xyz(product)[0], white), lab((power * surface) @ xyz_weights(), white))
            apart.append(float(delta_e_2000(*pair)))
    assert tuple(error_statistics(samples, checker, part)) == pytest.approx(tuple(compute_statistics(apart)), rel=1e-9)


def test_result_that_is_not_finite_is_an_error(checker):
    broken = SampleRepresentation("broken", "broken", np.full((401, 3), np.nan), np.eye(3))
    with raises(UpliftError, "result-not-finite"):
        compare(checker, [broken], EFFORT)


def test_results_are_ranked_within_their_sets(checker, found):
    assert list(found.sets) == ["smooth", "spiky"]
    for name in found.sets:
        means = [row.statistics.mean for row in found.of(name)]
        assert means == sorted(means)
        assert len(means) == 8
    assert "24 surfaces" in found.facts["products"]
    assert all(row.ns.median > 0 and row.ns.runs == EFFORT.runs for row in found.results)


def test_lights_have_equal_luminance(checker):
    np.testing.assert_allclose(checker.powers @ xyz_weights()[:, 1], 1)


def test_storage_includes_spikes(found):
    (row,) = [row for row in found.of("spiky") if row.name == "RE16"]
    assert row.floats == 16
    assert 16 + 2 * 2 < row.light_floats < 16 + 2 * 10
    (row,) = [row for row in found.of("spiky") if row.name == "TM9"]
    assert (row.floats, row.light_floats) == (9, 81)


def test_findings_of_the_thesis_hold_for_the_colorchecker(found):
    smooth, spiky = ({row.name: row.statistics.mean for row in found.of(name)} for name in ("smooth", "spiky"))
    assert all(smooth[f"{family}32"] < 1 for family in ("PS", "RS", "RE"))
    assert spiky["PS16"] > 10 * smooth["PS16"]
    assert max(spiky["CS15"], spiky["RE16"]) < spiky["RS16"] < spiky["PS32"] < spiky["PS16"]


def test_statistics_match_numpy():
    errors = np.random.default_rng(9).gamma(2.0, size=(4, 50))
    expected = [errors.mean(), errors.std(), *np.quantile(errors, (0.5, 0.025, 0.25, 0.75, 0.975))]
    np.testing.assert_allclose(tuple(compute_statistics(errors)), expected)
    assert len(HEADINGS) == len(expected)


def test_named_lights_form_one_set():
    atlases = {"macbeth": uplift.read_atlas(MACBETH)}
    (part,) = make_scene(atlases, ["HP1", "LED-B3", "HP1"]).sets
    assert part.title == "given lights (HP1, LED-B3)"
    with raises(UnknownNameError, "unknown-illuminant"):
        make_scene(atlases, ["F2"])
    with raises(AtlasError, "no-entries"):
        make_scene({"none": uplift.Atlas()})


def row(name, high, floats, light_floats=8.0, ns=5.0, lights="smooth"):
    found = Statistics(high / 2, 0.1, high / 2, 0.0, high / 3, high / 1.5, high)
    return RepresentationResult(name, "made up", lights, found, floats, light_floats, Spread(ns, ns, ns, 3))


ROWS = (
    row("near", 0.2, 32.0),
    row("even", 0.8, 9.0, 12.0, 30.0),
    row("rough", 0.9, 9.0, 12.0, 3.0),
    row("tabled", 0.7, 9.0, 81.0, 1.0),
    row("far", 1.1, 3.0),
    row("other", 0.1, 1.0, lights="spiky"),
)
FOUND = Comparison({}, {"smooth": "smooth lights (A)", "spiky": "spiky lights (FL2)"}, ROWS)


@pytest.mark.parametrize(
    ("target", "name"),
    [(2.0, "far"), (1.1, "far"), (1.0, "even"), (0.9, "even"), (0.75, "tabled"), (0.5, "near")],
)
def test_surfaces_count_first_then_lights_then_errors(target, name):
    assert cheapest(FOUND, "smooth", target).name == name


def test_sets_of_lights_are_independent():
    assert cheapest(FOUND, "spiky", 0.5).name == "other"


def test_no_representation_is_accurate_enough():
    assert cheapest(FOUND, "smooth", 0.1) is None
    assert most_accurate(FOUND, "smooth").name == "near"


@pytest.mark.parametrize("target", [0, -1, float("nan"), float("inf")])
def test_target_must_be_positive(target):
    with raises(OptionError, "target-not-positive"):
        cheapest(FOUND, "smooth", target)
