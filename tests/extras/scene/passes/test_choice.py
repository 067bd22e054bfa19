"""Bands, decoding and the choice of passes: laws, a plain oracle, published aims."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from tests.extras.scene.passes.conftest import LIGHTS, SIX
from tests.helpers import raises
from uplift.atlas.atlas import Atlas
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.errors import OptionError
from uplift.extras.scene.passes.bands import PRESETS, Bands
from uplift.extras.scene.passes.choice import choose, fit_bands
from uplift.extras.scene.passes.decoding import Grams
from uplift.extras.scene.passes.light_paths import draw_paths
from uplift.extras.scene.passes.materials import Materials, scene_materials
from uplift.extras.scene.passes.passes import scaled_power
from uplift.extras.scene.passes.search import Search
from uplift.lookup.cube import load

AIMS = {2: 0.6, 3: 0.25, 4: 0.12}
"""Mean ΔE00 by passes, with one decoding for six lights."""
ALL_LIGHTS = ("D65", "A", "FL2", "FL11", "LED-B3", "HP1")


def power_sum(powers):
    return np.stack([scaled_power(name) for name in powers])


@given(
    first=st.floats(380, 760),
    gaps=st.lists(st.floats(0.5, 5), min_size=2, max_size=2),
    width=st.sampled_from((0.0, 1.0, 5.0, 20.0, 60.0)),
)
@settings(max_examples=20)
def test_weights_average(first, gaps, width):
    bands = Bands(tuple(first + np.cumsum([0.0, *gaps])), width)
    assert bands.weights.min() >= 0
    assert_allclose(bands.weights.sum(axis=1), 1)


def test_points_interpolate():
    spectrum = np.random.default_rng(0).random(81)
    bands = Bands((400.0, 502.5, 700.0), 0.0)
    between = (spectrum[24] + spectrum[25]) / 2
    assert_allclose(bands.weights @ spectrum, [spectrum[4], between, spectrum[64]])


def test_paths_multiply_reflectances(library):
    paths = draw_paths(library.training, power_sum(LIGHTS), 5, 3, direct=2)
    assert paths.bounces.tolist() == [0, 0, *np.repeat([1, 2, 3, 4], 5)]
    for row, bounces in enumerate(paths.bounces):
        factors = library.training[paths.index[row][:bounces]]
        assert_allclose(paths.reflected[row], factors.prod(axis=0))
    assert_allclose(paths.xyz[1, 0], observer.light("A").white)
    assert_allclose(paths.xyz[..., :2, 1], 1)


def test_decoding_is_that_of_plain_least_squares(library):
    """The slow way: one row of the system for each path, light and axis."""
    paths = draw_paths(library.training, power_sum(LIGHTS[:2]), 20, 4)
    numbers = paths.numbers(SIX.weights)
    lights = np.random.default_rng(1).uniform(0.5, 1.5, (2, 6))
    rows = []
    targets = []
    for light, path in np.ndindex(2, len(numbers)):
        root = np.linalg.cholesky(paths.metric[light, path]).T
        rows.append(root @ np.kron(np.eye(3), lights[light] * numbers[path]))
        targets.append(root @ paths.xyz[light, path])
    plain = np.linalg.lstsq(np.concatenate(rows), np.concatenate(targets), rcond=None)
    fitted = Grams.of(paths, numbers).decoding(lights)
    assert_allclose(fitted, plain[0].reshape(3, 6), atol=1e-3)


@pytest.mark.parametrize(
    ("count", "lights"),
    [
        (2, ALL_LIGHTS),
        (3, ALL_LIGHTS),
        (4, ALL_LIGHTS),
        (4, ("D65", "FL11")),  # twelve bands, where a number at 0 could not return
    ],
)
def test_passes_meet_the_aims(library, count, lights):
    passes = fit_bands(PRESETS[count], library, lights)
    assert passes.error < AIMS[count]
    assert passes.count == count
    assert passes.origin["training"] + passes.origin["held-out"] == 716
    for light in passes.lights:
        assert (light.numbers > 0).all()
        white = observer.light(light.name).white
        decoded = passes.to_xyz @ light.numbers
        assert delta_e_2000(lab(decoded, white), lab(white, white)) < 0.5


def test_equal_energy_has_ones(two_passes):
    luminance = observer.matching_functions()[:, 1]
    flat = np.full(81, 1 / luminance.sum())
    assert_allclose(two_passes.light_numbers(flat), 1)


def test_search_ends_where_no_step_helps(library):
    paths = draw_paths(library.training, power_sum(["D65"]), 40, 1)
    search = Search(paths)
    found = search.descend(search.fit(Bands((450.0, 545.0, 610.0), 12.0)))
    for step in np.concatenate([np.eye(3), -np.eye(3)]):
        centres = tuple(found.bands.centres + step)
        trial = search.fit(Bands(centres, found.bands.width))
        assert trial.error > found.error * (1 - 1e-3)


def test_choice_is_near_the_preset(library):
    few = Materials(library.training[::8], library.held_out[::8])
    chosen = choose(few, ["D65"], 1, width=20)
    assert chosen.bands.width == 20
    assert chosen.error < 1.1 * fit_bands(PRESETS[1], few, ["D65"]).error
    assert all(centre == round(centre) for centre in chosen.bands.centres)


@pytest.mark.parametrize(
    ("lights", "options"),
    [
        ([], {}),
        (["D65"], {"count": 0}),
        (["D65"], {"width": 61}),
    ],
)
def test_choice_is_checked(library, lights, options):
    with raises(OptionError):
        choose(library, lights, **options)


def test_halves_share_no_material(library):
    training = {row.tobytes() for row in library.training}
    assert not training & {row.tobytes() for row in library.held_out}


def test_few_materials_are_refused():
    few = Atlas(read_atlas("tcs").entries[:3])
    with raises(OptionError):
        scene_materials({"small": few}, None, load())
