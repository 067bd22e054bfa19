"""Mixtures by kind of component, coats on grounds, and painting over images."""

from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.extras.texture.conftest import planes, read_channels, write_exr
from tests.helpers import raises, warns
from uplift.common.errors import OptionError
from uplift.extras.paint.coats import DARKEST, Dyes, Pigments, Plates, dye_absorption
from uplift.extras.paint.duntley import DuntleyPaints
from uplift.extras.paint.optics import (
    NO_SURFACE,
    Layer,
    Surface,
    plate,
    stack_filters,
)
from uplift.extras.paint.overpaint import overpainter
from uplift.extras.paint.pigments import SQUARE_ROOT, Pigment, from_opaque
from uplift.extras.texture.conversion import convert

WHITE = np.ones(5)
OIL = Surface.of_index(1.5)
SURFACES = [NO_SURFACE, OIL]
T = np.array([0.0, 0.05, 0.5, 0.9, 1.0])


@pytest.fixture
def two(rng):
    """Two spectra, not darker than the surface of oil."""
    return rng.uniform(0.1, 0.9, (2, 5))


@pytest.mark.parametrize("surface", SURFACES)
@pytest.mark.parametrize(
    "components", [Dyes, partial(Pigments, scattering=SQUARE_ROOT)]
)
def test_a_single_colour_is_unchanged_and_thickness_0_leaves_the_ground(
    two, rng, components, surface
):
    mixed = components(two)
    found = mixed.coat([0, 3], surface=surface).over(WHITE)
    assert_allclose(found, two[1], rtol=1e-9)
    ground = rng.uniform(0.1, 1, 5)
    assert_allclose(mixed.coat([1, 1], 0.0, surface).over(ground), ground)


def test_paint_measured_on_white_and_black_round_trip(rng):
    layer = from_opaque(rng.uniform(0.2, 0.8, 5), SQUARE_ROOT).layer(1.0)
    white = OIL.apply(layer.over(1.0))
    black = OIL.apply(layer.over(0.0))
    coat = Pigments(white[None], on_black=(black,)).coat([2], 1.0, OIL)
    for ground, expected in ((1.0, white), (0.04, black)):
        assert_allclose(coat.over(ground), expected, rtol=1e-6)


def test_filters_are_multiplied():
    """9.2.1.2 of the thesis: cyan light through an orange and a grey filter."""
    filters = np.array([[0, 1, 1], [1, 0.5, 0], [0.5, 0.5, 0.5]])
    assert_allclose(stack_filters(filters, [1, 1, 1]), [0, 0.25, 0])


@pytest.mark.parametrize(
    ("components", "parts", "thickness"),
    [
        (Dyes, [1, 1], -1.0),
        (DuntleyPaints, [1, 1], -1.0),
        (Pigments, [1, 1], None),
        (Dyes, [1, np.nan], None),
        (Dyes, 3.0, None),
        (Dyes, [0, 0], None),
    ],
)
def test_invalid_parts_and_thicknesses_raise(two, components, parts, thickness):
    with raises(OptionError, "option"):
        components(two).coat(parts, thickness)


def test_colours_darker_than_the_surface_trigger_a_warning(two):
    dark = Pigments(np.stack([two[0], np.full(5, 0.03)]), SQUARE_ROOT)
    with warns("warning"):
        coat = dark.coat([0, 1], surface=OIL)
    assert_allclose(coat.over(WHITE), 0.04, atol=1e-4)


@pytest.mark.parametrize("ground", [0.3, 1.0])
@pytest.mark.parametrize("surface", [OIL, Surface(0.04, 0.04)])
def test_a_dye_on_a_ground_is_the_sum_over_passes(surface, ground):
    """The light that leaves at each pass (9.6)."""
    light = (1 - surface.outside) * np.ones_like(T)
    expected = surface.outside
    for _ in range(500):
        light = light * T * ground * T
        expected = expected + (1 - surface.inside) * light
        light = surface.inside * light
    found = surface.apply(Layer(np.zeros_like(T), T).over(ground))
    assert_allclose(found, expected, atol=1e-12)


@pytest.mark.parametrize("rho", [0.0, 0.3])
def test_a_plate_is_the_sum_over_passes_and_keeps_the_energy_of_clear_light(rho):
    """Eq. 9.4: what leaves above and below at each pass."""
    found = plate(T, rho)
    light = (1 - rho) * T
    above = np.full_like(T, rho)
    below = np.zeros_like(T)
    for number in range(200):
        (above if number % 2 else below)[:] += (1 - rho) * light
        light = rho * light * T
    assert_allclose(found.reflectance, above, atol=1e-12)
    assert_allclose(found.transmittance, below, atol=1e-12)
    assert found.reflectance[-1] + found.transmittance[-1] == pytest.approx(1)


@pytest.mark.parametrize("surface", SURFACES)
def test_duntley_s_paint_becomes_kubelka_and_munk_s(rng, surface):
    """In the limit of strong forward scattering; constants mix as Duncan's."""
    K, B = rng.uniform(0.1, 2, (2, 2, 5))
    constants = np.stack([K, B, np.full_like(K, 1e8), K, B, B], axis=1)
    for ground in (surface.outside, 0.5, 1.0):
        found = DuntleyPaints(constants).coat([2, 1], 0.7, surface).over(ground)
        layer = Pigment(K, B).mix([2, 1]).layer(0.7)
        assert_allclose(
            found, surface.apply(layer.over(surface.remove(ground))), atol=1e-6
        )


@pytest.mark.parametrize("components", [Dyes, Plates])
def test_thicknesses_of_dyes_compose(two, components):
    """A plate of index 1 is the layer alone."""
    thin = components(two).coat([1, 2], 2).over(1.0)
    thick = components(two).coat([1, 2], 3).over(1.0)
    both = components(two).coat([1, 2], 5).over(1.0)
    assert_allclose(both, thin * thick)


def test_black_dyes_are_finite():
    assert_allclose(np.exp(-dye_absorption(T**2)), np.maximum(T, DARKEST))


@pytest.fixture
def painted(small_cube, rng, tmp_path):
    """A function that paints over a random image and returns it, the new one and the
    result of the conversion.
    """

    def painted(coat, brighter=0.0):
        image = brighter + rng.random((6, 5, 3)).astype(np.float32)
        write_exr(tmp_path / "in.exr", planes(image))
        painter = overpainter(small_cube, coat, threads=1)
        result = convert(painter, tmp_path / "in.exr", tmp_path / "out.exr")
        return image, read_channels(tmp_path / "out.exr", "RGB"), result

    return painted


def test_painted_colours_are_those_of_the_coated_spectra(small_cube, painted):
    """Half a unit of the ColorChecker's red in oil."""
    atlas = small_cube.data.atlas
    red = small_cube.reflectance(atlas.rgb[atlas.names.index("red")])
    glaze = Pigments(red[None], SQUARE_ROOT).coat([1], 0.5, OIL)
    image, found, result = painted(glaze)
    assert not result.warnings
    expected = small_cube.data.sensor.rgb(glaze.over(small_cube.reflectance(image)))
    assert_allclose(found, expected, atol=2e-6)


def test_pixels_outside_are_mapped_before_and_after_with_warnings(small_cube, painted):
    """A thick dye is saturated enough to leave the gamut."""
    dye = Dyes(small_cube.reflectance([[0.9, 0.1, 0.02]])).coat([1], 3.0)
    _, found, result = painted(dye, brighter=0.5)
    codes = [warning.code for warning in result.warnings]
    assert codes == ["pixels-out-of-gamut", "painted-pixels-out-of-gamut"]
    assert ((found >= 0) & (found <= 1)).all()
