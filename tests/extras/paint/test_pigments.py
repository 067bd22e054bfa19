"""Kubelka and Munk's and Duntley's theories: equations as printed, integration, limits;
K and S from colours.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.integrate import solve_bvp

from tests.helpers import raises
from uplift.common.errors import AtlasError, ColourError
from uplift.extras.paint import duntley, pigments
from uplift.extras.paint.duntley import (
    Flux,
    beam_to_diffuse,
    diffuse_to_beam,
    duntley_layer,
)
from uplift.extras.paint.optics import Layer
from uplift.extras.paint.pigments import (
    CONSTANT,
    SQUARE_ROOT,
    Pigment,
    dispersive,
    from_black_and_white,
    from_opaque,
)

SEVERAL = Pigment(np.array([0.3, 2.0, 0.01]), np.array([1.5, 0.2, 4.0]))
R = np.linspace(pigments.DARKEST, 1, 200)
RULES = [CONSTANT, SQUARE_ROOT, np.positive]


@pytest.mark.parametrize("X", [0.01, 1.0, 20.0])
def test_reflectance_on_a_ground_follows_kubelka_1948(X):
    """Eq. 10.11 as printed, which is undefined for S = 0 or K = 0."""
    ground = np.array([0.0, 0.5, 1.0])[:, None]
    a = 1 + SEVERAL.absorption / SEVERAL.scattering
    b = np.sqrt(a**2 - 1)
    coth = 1 / np.tanh(b * SEVERAL.scattering * X)
    expected = (1 - ground * (a - b * coth)) / (a - ground + b * coth)
    assert_allclose(SEVERAL.layer(X).over(ground), expected)


def test_the_thesis_s_example():
    """10.2.3: K .1 and .3, S .4 and .2, mixed 2:1: S/K = 2 and R = .38."""
    mixture = Pigment(np.array([[0.1], [0.3]]), np.array([[0.4], [0.2]])).mix([2, 1])
    assert mixture.scattering / mixture.absorption == pytest.approx(2)
    assert mixture.opaque_reflectance()[0] == pytest.approx(0.38, abs=0.005)


def test_two_layers_equal_one_of_their_total_thickness(paint):
    for ground in (0.0, 0.3, 1.0):
        both = paint.layer(0.7).over(paint.layer(1.6).over(ground))
        assert_allclose(both, paint.layer(2.3).over(ground), rtol=1e-10)


@pytest.mark.parametrize("X", [0.0, 1e-9, 1.0, 1e9, 1e300])
def test_energy_is_not_created(paint, X):
    layer = paint.layer(X)
    assert (layer.reflectance >= -1e-12).all()
    assert (layer.transmittance >= -1e-12).all()
    assert (layer.reflectance + layer.transmittance <= 1 + 1e-9).all()


@pytest.mark.parametrize("tiny", [0.0, 1e-12])
def test_limits_without_absorption_and_without_scattering(tiny):
    """K → 0: R = SX / (1 + SX), and T = 1 − R. S → 0: Beer's law."""
    K = np.array([tiny, tiny, 0.5, 3.0])
    layer = Pigment(K, K[::-1]).layer(2.0)
    assert_allclose(layer.reflectance, [6 / 7, 1 / 2, 0, 0], atol=1e-6)
    assert_allclose(layer.transmittance, [1 / 7, 1 / 2, *np.exp([-1, -6])], atol=1e-6)


def test_thick_paint_hides_its_ground_and_thickness_0_shows_it(paint):
    opaque = Pigment(paint.absorption[3:], paint.scattering[3:])
    for ground in (0.0, 1.0):
        assert_allclose(
            opaque.layer(1e7).over(ground), opaque.opaque_reflectance(), rtol=1e-9
        )
    assert_array_equal(SEVERAL.layer(0.0).over([0.1, 0.5, 1]), [0.1, 0.5, 1])
    limits = Pigment(np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    assert_array_equal(limits.opaque_reflectance(), [1, 0, 0])
    # Mirrors face to face give no NaN.
    assert Layer(np.ones(1), np.zeros(1)).over(1.0) == 1


def test_amy_is_exact_for_strong_absorption_and_half_for_white():
    """Eq. 10.4 compared with eq. 10.5, and the example of 10.2.2."""
    found = Pigment(
        np.array([5.0, 1e-9, 1 / 6, 0.0]), np.array([0.05, 1.0, 1 / 3, 0.0])
    )
    dark, *others = found.amy_opaque_reflectance()
    assert dark == pytest.approx(found.opaque_reflectance()[0], rel=1e-3)
    assert others == pytest.approx([0.5, 1 / 3, 0])


@pytest.mark.parametrize("rule", RULES)
def test_opaque_reflectance_round_trip_alone_and_mixed(rule, spectra, parts):
    assert_allclose(from_opaque(R, rule).opaque_reflectance(), R, rtol=1e-9)
    found = from_opaque(spectra, rule).mix(parts).opaque_reflectance()
    assert (found >= spectra.min(axis=1) - 1e-12).all()
    assert (found <= spectra.max(axis=1).clip(pigments.DARKEST) + 1e-12).all()


@pytest.mark.parametrize(("on_black", "on_white"), [(0.3, 0.3), (0.5, 0.2), (0.6, 1.3)])
def test_contradictory_reflectances_raise(on_black, on_white):
    with raises(ColourError):
        from_black_and_white([on_black], [on_white])


def test_h_is_the_mean_on_one_side_less_that_on_the_other(sensor, rng):
    """The matrix against sums written out, also at further wavelengths."""
    reflectance = rng.uniform(pigments.DARKEST_DISPERSED, 1, 81)
    strength = np.sqrt((1 - reflectance) ** 2 / (2 * reflectance))
    sums = []
    for wavelength in sensor.wavelengths:
        weights = np.exp(-np.abs(sensor.wavelengths - wavelength) / pigments.REACH)
        below = sensor.wavelengths <= wavelength
        above = sensor.wavelengths >= wavelength
        sums.append(
            np.average(strength[below], weights=weights[below])
            - np.average(strength[above], weights=weights[above])
        )
    Y = (sensor.cmfs[:, 1] * reflectance).sum() / sensor.cmfs[:, 1].sum()
    expected = Y**0.75 * np.exp(np.array(sums) / 4)
    rows = [*range(81), 14, 34, 0, 80]
    found = dispersive(sensor, [450.0, 550.0, 300.0, 900.0])(reflectance[rows])
    assert_allclose(found, expected[rows], rtol=1e-12)


DIFFUSE = Flux(np.array([0.6]), np.array([1.1]), np.array([0.8]))


@pytest.mark.parametrize("excess", [0.3, 0, 1e-14, 1e-9, 1e-7, 1e-5, 3e-5])
def test_duntley_s_differential_equations_are_satisfied(excess):
    """Also where the beam decays as fast as diffuse light, or nearly."""
    K, B = DIFFUSE.absorption, DIFFUSE.backward
    B1, F1 = np.array([0.1]), np.array([0.3])
    mu = np.sqrt(K * (K + 2 * B)) + excess
    found = duntley_layer(Flux(mu - B1 - F1, B1, F1), DIFFUSE, 1.3)

    def slopes(x, flux):
        t, s = flux
        left = np.exp(-mu * x)
        return np.stack(
            [F1 * left - (K + B) * t + B * s, (K + B) * s - B * t - B1 * left]
        )

    def at_ends(top, bottom):
        return np.array([top[0], bottom[1]])

    x = np.linspace(0, 1.3, 80)
    solved = solve_bvp(slopes, at_ends, x, np.zeros((2, 80)), tol=1e-9)
    transmitted = solved.y[0, -1] + np.exp(-mu * 1.3)
    assert_allclose(found.reflectance, solved.y[1, 0], atol=1e-7)
    assert_allclose(found.transmittance, transmitted, atol=1e-7)


@pytest.mark.parametrize("is_turned", [False, True])
def test_constants_are_read_from_rows_and_columns(tmp_path, is_turned):
    rows = np.arange(24.0).reshape(8, 3)
    rows[6:] = rows[1] + rows[2], rows[4] + rows[5]
    table = np.column_stack([[*duntley.CONSTANTS, "S'", "S"], rows])
    table = np.concatenate([[["name", 400, 500, 700]], table])
    path = tmp_path / "paint.csv"
    lines = map(",".join, table.T if is_turned else table)
    path.write_text("\n".join(lines), encoding="utf-8")
    found = duntley.read_constants(path, np.array([380, 450, 700]))
    means = rows[:6, :2].mean(axis=1)
    assert_allclose(found, np.stack([rows[:6, 0], means, rows[:6, 2]], axis=1))


CONSTANTS = "nm,380,780\n" + "".join(f"{name},1,1\n" for name in duntley.CONSTANTS)


@pytest.mark.parametrize(
    "text",
    [
        CONSTANTS.replace("K',", "K'',"),
        CONSTANTS.replace(",1,", ",-1,", 1),
        CONSTANTS + "S,2,29\n",
    ],
)
def test_invalid_constants_raise(tmp_path, text):
    (tmp_path / "paint.csv").write_text(text, encoding="utf-8")
    with raises(AtlasError):
        duntley.read_constants(tmp_path / "paint.csv", np.array([500.0]))


def test_isotropic_paint_in_a_beam_is_two_r_over_three_minus_r(rng):
    """Eq. 10.8 in the limit of thick layers against the closed form, and
    its inverse.
    """
    K = rng.uniform(0.01, 4, 30)
    S = rng.uniform(0.2, 3, 30)
    r = Pigment(K, S).opaque_reflectance()
    thick = duntley_layer(Flux(K / 2, S / 2, S / 2), Flux(K, S, S), 400.0).reflectance
    assert_allclose(diffuse_to_beam(r), thick, rtol=1e-6)
    assert_allclose(beam_to_diffuse(diffuse_to_beam(r)), r, rtol=1e-12)
