"""Tables of spectra per chromaticity, as film simulations read them."""

import tomllib

import numpy as np
from numpy.testing import assert_allclose
from scipy.ndimage import map_coordinates

from uplift.colorimetry.observer import (
    DEFAULT_OBSERVER,
    grid,
    illuminant_spd,
    matching_functions,
)
from uplift.extras.export.film import CAT16, SHARE, write_film

WEIGHTS = (
    matching_functions(DEFAULT_OBSERVER)
    / matching_functions(DEFAULT_OBSERVER)[:, 1].sum()
)


def power(name):
    """The illuminant with Y = 1."""
    return illuminant_spd(name) / (illuminant_spd(name) @ WEIGHTS[:, 1])


def read(path, xyz):
    """Spectra of XYZ (n, 3), by the layout that readers document: bilinear here, cubic
    there.
    """
    table = np.load(path).astype(float)
    total = xyz.sum(axis=1)
    x, y = (xyz[:, :2] / total[:, None]).T
    places = np.array([(1 - x) ** 2, y / (1 - x)]) * (len(table) - 1)
    bands = [
        map_coordinates(table[..., band], places, order=1)
        for band in range(table.shape[-1])
    ]
    return np.array(bands).T * total[:, None]


def test_a_table_of_reflectances_has_the_spectra_of_the_cube(small_cube, tmp_path):
    """At the stored luminance they are those of a query, and at every luminance the
    colour is right.
    """
    path = tmp_path / "paint.npy"
    write_film(small_cube, path, res=96)
    assert np.load(path).dtype == np.float16
    described = tomllib.loads(path.with_suffix(".toml").read_text())
    assert described["kind"] == "reflectance"
    assert described["array"]["lut_size"] == 96
    assert described["array"]["spectral_shape"] == [380.0, 780.0, 5.0]
    assert described["reflectance"] == {
        "scene_illuminant": "D65",
        "midgray": 0.184,
        "bounded": False,
    }
    rgb = np.random.default_rng(3).uniform(0.1, 0.3, (200, 3))
    xyz = rgb @ small_cube.data.sensor.rgb_to_xyz.T
    reflectance = read(path, xyz)
    assert_allclose(reflectance * power("D65") @ WEIGHTS, xyz, atol=2e-3)
    greys = np.array([[SHARE] * 3])
    found = read(path, greys @ small_cube.data.sensor.rgb_to_xyz.T)
    assert_allclose(
        found, small_cube.reflectance(greys, grid()), atol=0.02
    )  # of a neighbouring luminance


def test_a_table_of_lights_has_the_lit_reflectances_of_the_cube(small_cube, tmp_path):
    """Their luminance is that of lit reflectances, not of colours adapted by CAT16."""
    path = tmp_path / "lit.npy"
    table = write_film(small_cube, path, light="D55", res=48)
    assert 0.2 < table.inside < 0.6
    assert 0 < table.stops < 0.2
    assert 'kind = "irradiance"' in path.with_suffix(".toml").read_text()
    sensor = small_cube.data.sensor
    rgb = np.random.default_rng(3).uniform(0.05, 0.5, (200, 3))
    cones = CAT16 @ np.stack([power("D55") @ WEIGHTS, sensor.light.white], axis=1)
    gain = cones[:, 0] / cones[:, 1]
    xyz = np.linalg.solve(CAT16, gain[:, None] * (CAT16 @ sensor.xyz(rgb).T)).T
    lit = small_cube.reflectance(rgb, grid()) * power("D55") @ WEIGHTS
    stored = read(path, xyz) @ WEIGHTS
    assert np.abs(stored - lit).mean() < 0.5 * np.abs(xyz - lit).mean()
    assert_allclose(stored, lit, atol=0.02)
    lights = np.load(path).astype(float)
    assert lights.min() >= 0
    assert_allclose((lights @ WEIGHTS).sum(axis=-1), 1, atol=0.2)
    # Neighbours resemble each other, also across the edge of the gamut: the XYZ of
    # steps, where light exists.
    steps = np.abs(np.diff(lights @ WEIGHTS, axis=1)).max(axis=-1)
    assert steps[5:].max() < 0.08
