"""CIE L*a*b*, ΔE76 and ΔE00 with numpy alone.

Modules that must not import colour-science use this implementation too. The tests
compare it with colour-science and the published pairs.
"""

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, as_array, as_floats

OPPONENTS = np.array([[0.0, 116, 0], [500, -500, 0], [0, 200, -200]])
"""Compressed X, Y, Z to L*a*b*, without the −16 of L*."""
HUE_TERMS = ((-0.17, 1, -30), (0.24, 2, 0), (0.32, 3, 6), (-0.20, 4, -63))
"""Weights, multiples and phases in degrees of the cosines of the hue in T (Sharma et
al. 2005, eq. 15).
"""
STEP = 1e-3
"""Length of finite differences, in units of L*a*b*."""


def lab(xyz: ArrayLike, white: ArrayLike) -> Array:
    """Convert XYZ to CIE 1976 L*a*b*.

    Parameters
    ----------
    xyz : array_like, shape (..., 3)
        XYZ, in the units of ``white``. An array of JAX is returned as one.
    white : array_like, shape (3,)
        XYZ of the white.

    Returns
    -------
    ndarray, shape (..., 3)

    References
    ----------
    CIE 15:2004, 8.2.1.

    Examples
    --------
    >>> lab([0.95, 1.0, 1.09], [0.95, 1.0, 1.09]).tolist()
    [100.0, 0.0, 0.0]
    """
    floats = as_floats(xyz)
    xp = floats.__array_namespace__()
    t = floats / as_array(white)
    threshold = (6 / 29) ** 3
    root = xp.cbrt(xp.maximum(t, threshold))  # whose slope is finite
    line = xp.minimum(t, 1.0) * (29 / 6) ** 2 / 3 + 4 / 29
    compressed = xp.where(t > threshold, root, line)
    return compressed @ OPPONENTS.T - np.array([16.0, 0.0, 0.0])


def lab_to_xyz(lab: ArrayLike, white: ArrayLike) -> Array:
    """Convert CIE 1976 L*a*b* to XYZ, the inverse of `lab`. Shapes: ``lab`` (…, 3),
    ``white`` (3,) → (…, 3).
    """
    compressed = (as_array(lab) + np.array([16.0, 0, 0])) @ np.linalg.inv(OPPONENTS.T)
    linear = (compressed - 4 / 29) * 3 * (6 / 29) ** 2
    return np.asarray(
        np.where(compressed > 6 / 29, compressed**3, linear) * as_array(white)
    )


def lab_jacobian(xyz: ArrayLike, white: ArrayLike) -> Array:
    """Compute the derivative of L*a*b* with respect to XYZ. Shapes: ``xyz`` (…, 3),
    ``white`` (3,) → (…, 3, 3).
    """
    white = as_array(white)
    t = as_array(xyz) / white
    root = np.cbrt(
        np.maximum(t, (6 / 29) ** 3)
    )  # the linear part has the slope of its upper end
    return OPPONENTS * (1 / (3 * root**2 * white))[..., None, :]


def rgb_to_lab(sensor: Sensor, rgb: ArrayLike) -> Array:
    """Convert linear RGB to CIE L*a*b* under the build illuminant. Shapes: ``rgb`` (…,
    3) → (…, 3).
    """
    return lab(sensor.xyz(rgb), sensor.light.white)


def delta_e_1976(lab_1: ArrayLike, lab_2: ArrayLike) -> Array:
    """Compute the CIE 1976 colour difference: the distance in L*a*b*.

    Parameters
    ----------
    lab_1, lab_2 : array_like, shape (..., 3)
        CIE L*a*b*.

    Returns
    -------
    ndarray, shape (...)

    References
    ----------
    CIE 15:2004, 8.2.1.3.
    """
    return np.asarray(np.linalg.norm(np.subtract(lab_1, lab_2), axis=-1))


def delta_e_2000(lab_1: ArrayLike, lab_2: ArrayLike) -> Array:
    """Compute the CIEDE2000 colour difference with k_L = k_C = k_H = 1.

    Parameters
    ----------
    lab_1, lab_2 : array_like, shape (..., 3)
        CIE L*a*b*.

    Returns
    -------
    ndarray, shape (...)

    References
    ----------
    Sharma, Wu & Dalal 2005, "The CIEDE2000 color-difference formula", eq. 2–22.

    Examples
    --------
    >>> round(float(delta_e_2000([50, 2.6772, -79.7751], [50, 0, -82.7485])), 4)
    2.0425
    """
    delta_l, delta_c, delta_h, rotation = _differences(lab_1, lab_2)
    square = delta_l**2 + delta_c**2 + delta_h**2 + rotation * delta_c * delta_h
    return np.sqrt(np.maximum(square, 0))


def delta_e_2000_terms(lab_1: ArrayLike, lab_2: ArrayLike) -> Array:
    """Compute three numbers whose norm is CIEDE2000, for least squares. Shapes:
    ``lab_1``, ``lab_2`` (…, 3) → (…, 3).
    """
    delta_l, delta_c, delta_h, rotation = _differences(lab_1, lab_2)
    # C² + H² + R C H = (C + R H / 2)² + (1 − R² / 4) H²
    turned = delta_c + rotation / 2 * delta_h
    other = np.sqrt(np.maximum(1 - rotation**2 / 4, 0)) * delta_h
    return np.stack([delta_l, turned, other], axis=-1)


def _differences(lab_1: ArrayLike, lab_2: ArrayLike) -> tuple[Array, ...]:
    """Return the weighted differences of lightness, chroma and hue, and R_T."""
    (l1, a1, b1), (l2, a2, b2) = (
        np.moveaxis(as_array(x), -1, 0) for x in (lab_1, lab_2)
    )
    # a′ = (1 + G) a, and from it C′ and h′ (eq. 2–7).
    g = 1.5 - 0.5 * _weight_7((np.hypot(a1, b1) + np.hypot(a2, b2)) / 2)
    a1 = g * a1
    a2 = g * a2
    c1 = np.hypot(a1, b1)
    c2 = np.hypot(a2, b2)
    h1 = np.degrees(np.arctan2(b1, a1)) % 360
    h2 = np.degrees(np.arctan2(b2, a2)) % 360
    coloured = c1 * c2 > 0
    turn = np.where(coloured, (h2 - h1 + 180) % 360 - 180, 0)
    # The paper defines a difference of exactly half a turn as +180 if h2 is larger.
    turn = np.where((turn == -180) & (h2 > h1), 180, turn)
    # Means of L′, C′ and h′ (eq. 12–14).
    light = (l1 + l2) / 2
    chroma = (c1 + c2) / 2
    total = h1 + h2
    across = np.where(
        total < 360, total + 360, total - 360
    )  # the mean hue lies on the shorter arc
    hue = np.where(coloured, np.where(np.abs(h1 - h2) <= 180, total, across) / 2, total)
    terms = (
        weight * np.cos(np.radians(k * hue + phase)) for weight, k, phase in HUE_TERMS
    )
    tone = sum(terms, start=np.ones_like(hue))
    # Differences over S_L, S_C and S_H, and the rotation R_T for blues (eq. 8–11 and
    # 15–22).
    delta_l = (l2 - l1) / _lightness_scale(light)
    delta_c = (c2 - c1) / (1 + 0.045 * chroma)
    chord = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(turn / 2))
    delta_h = chord / (1 + 0.015 * chroma * tone)
    turned = np.radians(60 * np.exp(-(((hue - 275) / 25) ** 2)))
    rotation = -2 * _weight_7(chroma) * np.sin(turned)
    return delta_l, delta_c, delta_h, rotation


def delta_e_2000_weights(lab: ArrayLike) -> Array:
    """Compute the linear map from small changes of L*a*b* to weighted differences of
    lightness, chroma and hue.

    The norm of the differences is CIEDE2000, but for its corrections of neutral and of
    blue colours (Sharma, Wu & Dalal 2005, eq. 15–17, 19 and 20, with G and T of a
    neutral colour). Shapes: ``lab`` (…, 3) → (…, 3, 3).
    """
    light, a, b = np.moveaxis(as_array(lab), -1, 0)
    chroma = np.hypot(a, b)
    hue = np.arctan2(b, a)
    chroma_weight = 1 / (1 + 0.045 * chroma)
    hue_weight = 1 / (1 + 0.015 * chroma)
    weights = np.zeros((*light.shape, 3, 3))
    weights[..., 0, 0] = 1 / _lightness_scale(light)
    weights[..., 1, 1] = chroma_weight * np.cos(hue)
    weights[..., 1, 2] = chroma_weight * np.sin(hue)
    weights[..., 2, 1] = -hue_weight * np.sin(hue)
    weights[..., 2, 2] = hue_weight * np.cos(hue)
    return weights


def delta_e_2000_form(lab: Array) -> Array:
    """Forms G (…, 3, 3) around L*a*b* (…, 3): dᵀ G d ≈ ΔE00² for small differences."""
    base = lab[..., None, :]
    steps = np.eye(3) * STEP

    def squared(difference: Array) -> Array:
        return (delta_e_2000(base, base + difference) / STEP) ** 2

    diagonal = squared(steps)
    i, j = np.tril_indices(3, -1)
    mixed = squared(steps[i] + steps[j]) - diagonal[..., i] - diagonal[..., j]
    form = diagonal[..., None] * np.eye(3)
    form[..., i, j] = mixed / 2
    form[..., j, i] = mixed / 2
    return form


def delta_e_spectra(light: Light, first: ArrayLike, second: ArrayLike) -> Array:
    """Compute ΔE00 between reflectances under a light.

    Parameters
    ----------
    light : Light
        The light, on N wavelengths.
    first, second : array_like, shape (..., N)
        Reflectances in units of 1.

    Returns
    -------
    ndarray, shape (...)
    """
    xyz = (as_array(spectra) @ light.xyz.T for spectra in (first, second))
    return delta_e_2000(*(lab(colours, light.white) for colours in xyz))


def delta_e_rgb(sensor: Sensor, first: ArrayLike, second: ArrayLike) -> Array:
    """Compute ΔE00 between linear RGB of a sensor, under its illuminant.

    Parameters
    ----------
    sensor : Sensor
        Sensor of the RGB.
    first, second : array_like, shape (..., 3)
        Linear RGB.

    Returns
    -------
    ndarray, shape (...)
    """
    return delta_e_2000(rgb_to_lab(sensor, first), rgb_to_lab(sensor, second))


def _lightness_scale(light: Array) -> Array:
    """S_L (Sharma et al. 2005, eq. 15)."""
    return 1 + 0.015 * (light - 50) ** 2 / np.sqrt(20 + (light - 50) ** 2)


def _weight_7(chroma: Array) -> Array:
    """√(C⁷ / (C⁷ + 25⁷))."""
    return np.sqrt(chroma**7 / (chroma**7 + 25.0**7))
