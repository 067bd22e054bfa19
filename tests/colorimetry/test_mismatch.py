"""Mismatch volumes: laws, measured metamers and the convex hull of an independent solver."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.spatial import ConvexHull

from tests.helpers import raises
from uplift.atlas import read_atlas, resample
from uplift.atlas.sources import shipped_atlases
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import lab, lab_to_xyz
from uplift.colorimetry.mismatch import mismatch_volumes
from uplift.common.errors import ColourError

LIGHTS = ("A", "FL11", "HP1", "LED-B3")
ROUNDING = 1e-9


def measured(sensor, count):
    """Up to ``count`` reflectances in (0, 1) of each shipped atlas."""
    for shipped in shipped_atlases():
        values = resample(read_atlas(shipped.path), sensor.wavelengths).values
        inside = values[((values >= 0) & (values <= 1)).all(axis=1)]
        yield inside[:: max(len(inside) // count, 1)]


@pytest.mark.parametrize("name", LIGHTS)
def test_measured_metamers_lie_inside(sensor, name):
    """Every measured reflectance is a metamer of the colour that it has."""
    light = observer.light(name)
    spectra = np.concatenate(list(measured(sensor, 25)))
    assert len(spectra) > 80
    volumes = mismatch_volumes(sensor, light, sensor.rgb(spectra), divisions=1)
    assert volumes.excess(spectra @ light.xyz.T).max() <= ROUNDING


def test_other_colours_lie_outside(sensor):
    """The test above can fail: white and grey are not metamers."""
    light = observer.light("A")
    volumes = mismatch_volumes(sensor, light, np.full((1, 3), 0.5), divisions=1)
    assert volumes.excess(light.white[None])[0] > 0.1


def test_the_volume_under_the_build_light_is_a_point(sensor):
    rgb = np.random.default_rng(2).uniform(size=(20, 3))
    volumes = mismatch_volumes(sensor, sensor.light, rgb, divisions=1)
    np.testing.assert_allclose(volumes.xyz, np.repeat(sensor.xyz(rgb)[:, None], 42, axis=1), atol=1e-9)
    assert np.abs(volumes.volume).max() < 1e-20


def test_black_and_white_have_one_reflectance(sensor):
    light = observer.light("FL11")
    volumes = mismatch_volumes(sensor, light, np.array([[0.0, 0, 0], [1, 1, 1]]), divisions=1)
    np.testing.assert_allclose(volumes.xyz[0], 0, atol=1e-7)
    np.testing.assert_allclose(volumes.xyz[1], np.tile(light.white, (42, 1)), atol=1e-7)


def test_the_volume_of_grey_is_symmetric(sensor):
    """1 − g is a metamer of grey ½ if g is one."""
    light = observer.light("HP1")
    volumes = mismatch_volumes(sensor, light, np.full((1, 3), 0.5), divisions=2)
    opposite = [
        np.abs(volumes.directions.directions + each).sum(axis=1).argmin() for each in volumes.directions.directions
    ]
    np.testing.assert_allclose(volumes.xyz[0, opposite], light.white - volumes.xyz[0], atol=1e-8)


def test_the_volume_is_that_of_the_hull_of_linear_programs(sensor):
    """Directions, solver and volume are independent of the module."""
    light = observer.light("FL11")
    rgb = np.array([0.2, 0.4, 0.1])
    directions = np.random.default_rng(3).normal(size=(250, 3))
    found = [
        linprog(-each @ light.xyz, A_eq=sensor.matrix, b_eq=rgb, bounds=(0, 1), method="highs").x for each in directions
    ]
    hull = ConvexHull(np.array(found) @ light.xyz.T)
    volumes = mismatch_volumes(sensor, light, rgb[None], divisions=3)
    assert volumes.volume[0] == pytest.approx(hull.volume, rel=0.06)
    slack = hull.equations[:, :3] @ volumes.xyz[0].T + hull.equations[:, 3:]
    assert slack.max() < 0.1 * np.cbrt(hull.volume)
    # The planes of the boundary points bound the points of the other solver, and so do the corners.
    outer = ConvexHull(volumes.corners[0])
    assert (outer.equations[:, :3] @ hull.points.T + outer.equations[:, 3:]).max() < ROUNDING
    assert volumes.volume[0] < outer.volume < 2 * hull.volume


def test_more_directions_give_more_volume(sensor):
    light, rgb = observer.light("FL11"), np.array([[0.7, 0.5, 0.3]])
    found = [mismatch_volumes(sensor, light, rgb, divisions).volume[0] for divisions in range(4)]
    assert found == sorted(found)
    assert found[3] < 1.03 * found[2]


@pytest.mark.parametrize("rgb", [(1.5, 0.0, 0.0), (-0.5, 0.5, 0.5), (0.2, 0.2, np.nan)])
def test_colours_without_reflectance_are_refused(sensor, rgb):
    with raises(ColourError, "colour-unrealisable"):
        mismatch_volumes(sensor, observer.light("A"), np.array([[0.5, 0.5, 0.5], rgb]))


def test_lab_to_xyz_inverts_lab():
    white = np.array([1.1, 1, 0.4])
    xyz = np.random.default_rng(4).uniform(size=(50, 3)) ** 6 * white
    np.testing.assert_allclose(lab_to_xyz(lab(xyz, white), white), xyz, atol=1e-14)
