"""Answers by XYZ, inside and outside the RGB space of the cube."""

from __future__ import annotations

import numpy as np

import uplift
from tests.helpers import raises
from uplift.colorimetry.solid import solid
from uplift.common.errors import ColourError
from uplift.lookup import query, query_xyz


def colours_outside(cube, count=200):
    """Return XYZ of smooth band-pass and band-stop reflectances that lie outside the space of a cube."""
    sensor, rng = cube.data.sensor, np.random.default_rng(0)
    nm = sensor.wavelengths
    edges, width = np.sort(rng.uniform(380, 780, (count, 2, 1)), axis=1), rng.uniform(5, 40, (count, 1))
    band = 1 / (1 + np.exp(-(nm - edges[:, 0]) / width)) / (1 + np.exp((nm - edges[:, 1]) / width))
    spectra = 0.02 + 0.96 * np.where(rng.random((count, 1)) < 0.5, band, 1 - band)
    rgb = sensor.rgb(spectra)
    return sensor.xyz(rgb[~sensor.contains(rgb)])


def test_realisable_colours_outside_have_their_colour():
    cube = uplift.load()
    xyz = colours_outside(cube)
    assert len(xyz) > 20
    results = list(query_xyz(cube, xyz))
    spectra = np.array([result.reflectance for result in results])
    np.testing.assert_allclose(spectra @ cube.data.sensor.light.xyz.T, xyz, rtol=0, atol=1e-6)
    assert ((spectra >= 0) & (spectra <= 1)).all()
    assert all(result.delta_e_2000 < 1e-3 and result.standard_error is None for result in results)


def test_colours_in_the_space_are_those_of_the_cube():
    cube = uplift.load()
    rgb = np.array([[0.2, 0.4, 0.6], [1, 1, 1]])
    by_xyz = list(query_xyz(cube, cube.data.sensor.xyz(rgb), [450, 650]))
    for one, other in zip(by_xyz, query(cube, rgb, [450, 650]), strict=True):
        np.testing.assert_allclose(one.reflectance, other.reflectance, rtol=0, atol=1e-9)


def test_other_colours_raise():
    cube = uplift.load()
    rgb = cube.data.sensor.xyz_to_rgb @ [0.05, 0.9, 0.1]
    assert not solid(cube.data.sensor.matrix).contains(rgb[None]).any()
    with raises(ColourError, "colour-unrealisable"):
        list(query_xyz(cube, [[0.05, 0.9, 0.1]]))
    with raises(ColourError, "rgb-not-finite"):
        list(query_xyz(cube, [[0.05, np.nan, 0.1]]))


def test_the_packaged_acescg_cube_holds_more(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    wide = uplift.load("ACEScg")
    assert (wide.space, wide.illuminant) == ("ACEScg", "D65")
    xyz = colours_outside(uplift.load())
    assert wide.data.sensor.contains(xyz @ wide.data.sensor.xyz_to_rgb.T).mean() > 0.5
