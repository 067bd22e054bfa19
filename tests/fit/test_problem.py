"""Realisable colours are fitted; all others are reported and replaced by the nearest realisable colour."""

import numpy as np
import pytest

import uplift
from uplift.colorimetry import observer
from uplift.colorimetry.solid import solid
from uplift.fit.problem import nodes_of
from uplift.lattice import Lattice, Status
from uplift.models import reflectance

SPACES = ("P3-D65", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB")
DIM = 11


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize(("model", "count"), [("moments", 9), ("moments", 17), ("sigmoid", 3)])
def test_every_realisable_colour_is_fitted(space, model, count):
    data = uplift.build(dim=DIM, space=space, model=model, coefficients=count).data
    possible = solid(data.sensor.matrix).contains(data.lattice.points)
    assert Status.UNFITTED not in data.points.status
    rgb = data.sensor.rgb(reflectance(data.model, data.points.coefficients, data.sensor.wavelengths))
    distance = np.abs(rgb - data.lattice.points).max(axis=1)
    assert (~possible).sum() > 50
    assert distance[possible].max() <= data.threshold
    named = data.points.status == Status.UNREALISABLE
    np.testing.assert_array_equal(named, ~possible & (distance > data.threshold))


def test_the_nearest_colour_has_the_same_hue_and_luminance(sensor):
    wide = observer.sensor("ITU-R BT.2020")
    lattice = Lattice(observer.axis_nodes("srgb", 9))
    beyond = nodes_of(lattice, wide, 1e-4)
    target, nearest = lattice.target(beyond.unrealisable), beyond.nearest
    luminance = wide.xyz(target)[:, 1:2]
    np.testing.assert_allclose(wide.xyz(nearest)[:, 1:2], luminance, atol=1e-12)
    share = (nearest - luminance) / (target - luminance)
    np.testing.assert_allclose(share, share[:, :1].repeat(3, axis=1), rtol=1e-6)
    outside = solid(wide.matrix).signed_distance(nearest)
    assert outside.max() < 0
    assert outside.min() > -1e-3
    assert nodes_of(lattice, sensor, 1e-4).unrealisable.size == 0  # all of sRGB is realisable
