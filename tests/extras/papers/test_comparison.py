"""Comparison of representations: errors are those of single products, the best filter
is found, pictures have all.
"""

import itertools
from collections import Counter

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.browsing import check_page
from tests.conftest import MACBETH
from tests.helpers import raises
from tests.pages import markers, tooltips
from tools.render_docs import pick
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.errors import OptionError, UpliftError
from uplift.extras.papers.representations.compare import (
    Scene,
    cheapest,
    compare,
    error_statistics,
    make_scene,
    represent,
)
from uplift.extras.papers.representations.filters import filtered_point_samples
from uplift.extras.papers.representations.fitted import scene_representations
from uplift.extras.papers.representations.pictures import (
    cost_panels,
    names,
    render_comparison,
)
from uplift.extras.papers.representations.registry import find_representation
from uplift.extras.papers.representations.samples import (
    linear,
    wavelengths,
    xyz_weights,
)
from uplift.extras.papers.representations.tuning import (
    COARSE_STRIDE,
    NONE,
    candidates,
    tune_filters,
)


@pytest.fixture(scope="module")
def checker():
    return make_scene({"macbeth": read_atlas(MACBETH)})


@pytest.fixture(scope="module")
def found(checker):
    compared = ["CS15", "TM9", "PS16", "PS32", "RS16", "RS32", "RE16", "RE32"]
    return compare(checker, list(map(find_representation, compared)), quick=True)


def test_errors_match_explicit_loops(checker):
    part = checker.sets[1]
    samples = find_representation("PS16")
    surfaces = samples.encode_surface(checker.surfaces)
    apart = []
    for power in part.powers:
        white = power @ xyz_weights()
        products = samples.multiply(samples.encode_light(power[None]), surfaces)
        dense = (power * checker.surfaces) @ xyz_weights()
        apart += [delta_e_2000(lab(samples.xyz(products), white), lab(dense, white))]
    quantiles = np.quantile(apart, (0.5, 0.025, 0.25, 0.75, 0.975))
    expected = [np.mean(apart), np.std(apart), *quantiles]
    actual = list(error_statistics(samples, part).values())
    assert_allclose(actual, expected, rtol=1e-9)


def test_results_that_are_not_finite_are_refused(checker):
    broken = linear("broken", "broken", np.full((401, 3), np.nan), np.eye(3))
    with raises(UpliftError, "error"):
        compare(checker, [broken], quick=True)


def test_findings_of_the_thesis_hold_for_the_colorchecker(found):
    means = []
    for lights in found.sets:
        rows = found.of(lights)
        means.append({row["representation"]: row["mean"] for row in rows})
        assert list(means[-1].values()) == sorted(means[-1].values())
        row = pick(rows, representation="TM9")
        assert (row["floats"], row["light_floats"]) == (9, 81)
        assert 0 < row["ns_least"] <= row["ns"] <= row["ns_most"]
    smooth, spiky = means
    assert max(smooth[name] for name in ("PS32", "RS32", "RE32")) < 1
    assert spiky["PS16"] > 10 * smooth["PS16"]
    assert spiky["RS16"] < spiky["PS32"] < spiky["PS16"]
    assert max(spiky["CS15"], spiky["RE16"]) < spiky["RS16"]


@pytest.mark.parametrize("name", ["PF32", "PS16:gaussian:7:0.5", "TM9", "SG3"])
def test_spectra_have_the_colours_of_the_representation(checker, name):
    made = find_representation(name)
    smooth = checker.sets[0]
    atlases = represent(made, Scene((smooth,)), read_atlas(MACBETH).names)
    surfaces, powers = (
        on_grid(atlas, wavelengths()) @ xyz_weights() for atlas in atlases
    )
    code = made.encode_surface(smooth.reflectances)
    if name in ("TM9", "SG3"):
        # A linear code of samples is that of a light too.
        code = made.multiply(made.encode_light(np.ones_like(smooth.reflectances)), code)
    assert_allclose(surfaces, made.xyz(code), atol=1e-12)
    light_xyz = made.xyz(made.encode_light(smooth.powers))
    assert_allclose(powers / powers[:, 1:2], light_xyz / light_xyz[:, 1:2], atol=1e-12)


def test_surfaces_count_first_then_lights_then_errors():
    keys = ("q97_5", "floats", "light_floats")
    numbers = ((0.2, 32, 8), (0.8, 9, 12), (0.9, 9, 12), (0.7, 9, 81))
    rows = [dict(zip(keys, row, strict=True)) for row in numbers]
    chosen = [cheapest(rows, target) for target in (1.0, 0.75, 0.5, 0.1)]
    assert chosen == [rows[1], rows[3], rows[0], None]
    for target in (0, float("nan")):
        with raises(OptionError, "option"):
            cheapest(rows, target)


def test_the_best_filter_is_found_and_improves_point_sampling(checker):
    tuned = tune_filters(checker, COARSE_STRIDE, ("tent", "lanczos"), (16,))
    for part, kind in itertools.product(checker.sets, ("tent", "lanczos")):
        means = []
        for tried in candidates(kind, COARSE_STRIDE):
            errors = error_statistics(filtered_point_samples(16, tried), part)
            means.append(errors["mean"])
        assert pick(tuned, lights=part.name, filter=kind)["mean"] == min(means)
    best, plain = (
        pick(tuned, lights="spiky", filter=kind)["mean"] for kind in ("lanczos", NONE)
    )
    assert best < 0.3 * plain


def test_page_has_every_representation_fits_and_is_accessible(found, tmp_path):
    html = render_comparison(found)
    shown = [row["title"] for row in tooltips(html)]
    assert shown == names(found)
    panels = range(len(cost_panels(found)))
    assert markers(html) == Counter(itertools.product(panels, range(len(shown))))
    check_page(html, tmp_path)


def test_representations_fitted_to_a_scene_follow_its_products():
    scene = make_scene({"macbeth": read_atlas(MACBETH)}, ("A", "FL11", "A")).thinned(8)
    named = {each.name: each for each in scene_representations(scene)}
    (lights,) = scene.sets
    assert lights.title == "given lights (A, FL11)"
    errors = {
        name: error_statistics(named[name], lights)["mean"]
        for name in ("FW5", "FW12", "BF5", "CM9", "CM17")
    }
    assert errors["FW12"] < 0.1 < errors["FW5"] < 2
    assert errors["CM17"] < errors["CM9"] < 0.5
    assert errors["BF5"] < 6
    encode = named["FW5"].encode_light
    assert_array_equal(encode(lights.powers[::-1]), encode(lights.powers)[::-1])
