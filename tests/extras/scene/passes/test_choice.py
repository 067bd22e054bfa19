"""Bands, decoding and the choice of passes: laws, a plain oracle, published aims."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from tests.extras.scene.passes.conftest import LIGHTS, SIX
from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.errors import OptionError, UnknownNameError
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
@settings(max_examples=30)
def test_weights_average(first, gaps, width):
    bands = Bands(tuple(first + np.cumsum([0.0, *gaps])), width)
    assert bands.weights.min() >= 0
    assert_allclose(bands.weights.sum(axis=1), 1)


def test_points_interpolate():
    spectrum = np.random.default_rng(0).random(81)
    bands = Bands((400.0, 502.5, 700.0), 0.0)
    between = (spectrum[24] + spectrum[25]) / 2
    assert_allclose(bands.weights @ spectrum, [spectrum[4], between, spectrum[64]])


@pytest.mark.parametrize(
    ("centres", "width"),
    [
        ((450.0, 550.0), 5.0),
        ((), 5.0),
        ((450.0, 550.0, 540.0), 5.0),
        ((450.0, 550.0, 790.0), 5.0),
        ((450.0, 550.0, np.nan), 5.0),
        ((450.0, 550.0, 650.0), -1.0),
        ((450.0, 550.0, 650.0), 61.0),
        ((450.0, 550.0, 650.0), np.nan),
    ],
)
def test_bands_are_checked(centres, width):
    with raises(OptionError):
        Bands(centres, width)


def test_paths_multiply_reflectances(library):
    paths = draw_paths(library.training, power_sum(LIGHTS), 5, 3, direct=2)
    assert paths.bounces.tolist() == [0, 0, *np.repeat([1, 2, 3, 4], 5)]
    for row, bounces in enumerate(paths.bounces):
        product = np.ones(81)
        for material in paths.index[row][:bounces]:
            product = product * library.training[material]
        assert_allclose(paths.reflected[row], product)
    assert_allclose(paths.xyz[1, 0], observer.light("A").white)
    assert_allclose(paths.xyz[..., :2, 1], 1)


def test_metric_is_that_of_small_differences(library):
    paths = draw_paths(library.training, power_sum(["A"]), 20, 3)
    change = 1e-4 * paths.xyz * np.random.default_rng(0).normal(size=paths.xyz.shape)
    exact = paths.errors(paths.xyz + change)
    form = np.einsum("lna,lnab,lnb->ln", change, paths.metric, change)
    # L*a*b* of dark paths is linear, and its slope is taken from the cubic part.
    bright = paths.xyz[..., 1] > 0.05
    assert_allclose(np.sqrt(form)[bright], exact[bright], rtol=0.05)


def test_decoding_is_that_of_plain_least_squares(library):
    """The slow way: one row of the system for each path, light and axis."""
    paths = draw_paths(library.training, power_sum(LIGHTS[:2]), 20, 4)
    numbers = paths.numbers(SIX.weights)
    lights = np.random.default_rng(1).uniform(0.5, 1.5, (2, 6))
    rows = []
    targets = []
    for light in range(2):
        for path in range(len(numbers)):
            root = np.linalg.cholesky(paths.metric[light, path]).T
            lit = lights[light] * numbers[path]
            rows.append(root @ np.kron(np.eye(3), lit))
            targets.append(root @ paths.xyz[light, path])
    plain = np.linalg.lstsq(np.concatenate(rows), np.concatenate(targets), rcond=None)
    fitted = Grams.of(paths, numbers).decoding(lights)
    assert_allclose(fitted, plain[0].reshape(3, 6), atol=1e-3)


def test_each_round_lowers_the_error(library):
    paths = draw_paths(library.training, power_sum(LIGHTS), 50, 4)
    grams = Grams.of(paths, paths.numbers(SIX.weights))
    numbers = np.ones((3, 6))
    errors = []
    for _ in range(6):
        decoding, numbers, error = grams.alternate(numbers, np.zeros((3, 6)), 1)
        errors.append(error)
    assert (np.diff(errors) < 1e-9).all()
    lit = paths.numbers(SIX.weights) * numbers[:, None]
    difference = lit @ decoding.T - paths.xyz
    squares = np.einsum("lna,lnab,lnb->ln", difference, paths.metric, difference)
    assert_allclose(np.sqrt(squares.mean()), errors[-1], rtol=1e-6)


def test_no_number_of_a_light_is_lost(library):
    """With two lights and twelve bands a number that reaches 0 cannot return."""
    passes = fit_bands(PRESETS[4], library, ("D65", "FL11"))
    assert passes.error < AIMS[4]
    assert all((light.numbers > 0).all() for light in passes.lights)


def test_white_stays_white(two_passes):
    for light in two_passes.lights:
        white = observer.light(light.name).white
        decoded = two_passes.to_xyz @ light.numbers
        assert delta_e_2000(lab(decoded, white), lab(white, white)) < 0.3
        assert (light.numbers > 0).all()


def test_equal_energy_has_ones(two_passes):
    luminance = observer.matching_functions()[:, 1]
    flat = np.full(81, 1 / luminance.sum())
    assert_allclose(two_passes.light_numbers(flat), 1)


def test_numbers_of_lights_mix(two_passes):
    first, second = power_sum(["FL2", "D50"])
    mixed = two_passes.light_numbers(0.3 * first + 2 * second)
    apart = two_passes.light_numbers(np.stack([first, second]))
    assert_allclose(mixed, 0.3 * apart[0] + 2 * apart[1])


def test_projection_serves_lights_that_were_not_fitted(library, two_passes):
    power = scaled_power("FL7")[None]
    paths = draw_paths(library.held_out, power, 50, 6)
    numbers = two_passes.light_numbers(power)
    lit = paths.numbers(two_passes.bands.weights) * numbers[:, None]
    assert paths.errors(lit @ two_passes.to_xyz.T).mean() < 0.8


def test_two_passes_meet_the_aim_for_all_lights(library):
    passes = choose(library, ALL_LIGHTS, 2)
    assert passes.error < AIMS[2]
    assert passes.bands == PRESETS[2]
    assert passes.count == 2
    assert all(centre == round(centre) for centre in passes.bands.centres)
    assert passes.origin["training"] + passes.origin["held-out"] == 716


@pytest.mark.parametrize("count", [3, 4])
def test_more_passes_meet_the_aims(library, count):
    passes = fit_bands(PRESETS[count], library, ALL_LIGHTS)
    assert passes.error < AIMS[count]


def test_search_ends_where_no_step_helps(library):
    paths = draw_paths(library.training, power_sum(["D65"]), 40, 1)
    search = Search(paths)
    found = search.descend(search.fit(Bands((450.0, 545.0, 610.0), 12.0)))
    for row in range(3):
        for step in (-1, 1):
            centres = list(found.bands.centres)
            centres[row] += step
            trial = search.fit(Bands(tuple(centres), found.bands.width))
            assert trial.error > found.error * (1 - 1e-3)


def test_width_can_be_given(library):
    small = Materials(library.training[::8], library.held_out[::8])
    assert choose(small, ["D65"], 1, width=0).bands.width == 0


@pytest.mark.parametrize(
    ("lights", "options"),
    [
        ([], {}),
        (["D65"], {"count": 0}),
        (["D65"], {"count": 5}),
        (["D65"], {"width": -1}),
        (["D65"], {"width": 61}),
    ],
)
def test_choice_is_checked(library, lights, options):
    with raises(OptionError):
        choose(library, lights, **options)


def test_unknown_lights(library, two_passes):
    with raises(UnknownNameError):
        choose(library, ["D66"])
    with raises(UnknownNameError):
        two_passes.light("FL2")


def test_halves_share_no_material(library):
    training = {row.tobytes() for row in library.training}
    assert not training & {row.tobytes() for row in library.held_out}


def test_few_materials_are_refused():
    from uplift.atlas.atlas import Atlas, Entry

    entries = [
        Entry(str(row), np.array([400.0, 500, 700]), np.array([0.1, 0.2, 0.3]))
        for row in range(3)
    ]
    with raises(OptionError):
        scene_materials({"small": Atlas(tuple(entries))}, None, load())
