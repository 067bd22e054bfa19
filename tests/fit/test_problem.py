"""Realisable colours are fitted; all others are reported and replaced by the nearest
realisable colour.
"""

import os
import platform

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.conftest import ROOT
from tests.helpers import run_python
from uplift.colorimetry import observer
from uplift.colorimetry.object_colours import solid
from uplift.fit.problem import MARGIN, nodes_of
from uplift.lattice.lattice import Lattice, axis_nodes
from uplift.lattice.point_table import Status
from uplift.models.model import reflectance

SPACES = ("P3-D65", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB")
DIM = 11
ONLY_AVX = {
    "JAX_ENABLE_COMPILATION_CACHE": "false",
    "XLA_FLAGS": "--xla_cpu_max_isa=AVX",
    "OPENBLAS_CORETYPE": "Sandybridge",
    "NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR",
}
"""Environment of a process without AVX2 and the products of FMA, which round
differently.
"""


@pytest.mark.parametrize(
    ("space", "model", "count"),
    [
        *((space, "moments", 9) for space in SPACES),
        ("ACEScg", "moments", 17),
        ("ProPhoto RGB", "sigmoid", 3),
    ],
)
def test_every_realisable_colour_is_fitted(space, model, count):
    data = uplift.build(dim=DIM, space=space, model=model, coefficients=count).data
    possible = solid(data.sensor.matrix).contains(data.lattice.points)
    assert Status.UNFITTED not in data.points.status
    rgb = data.sensor.rgb(
        reflectance(data.model, data.points.coefficients, data.sensor.wavelengths)
    )
    distance = np.abs(rgb - data.lattice.points).max(axis=1)
    assert (~possible).sum() > 50
    assert distance[possible].max() <= data.threshold
    named = data.points.status == Status.UNREALISABLE
    assert_array_equal(named, ~possible & (distance > data.threshold))


def test_the_nearest_colour_has_the_same_hue_and_luminance(sensor):
    wide = observer.sensor("ITU-R BT.2020")
    lattice = Lattice(axis_nodes("srgb", 9))
    beyond = nodes_of(lattice, wide)
    target = lattice.target(beyond.unrealisable)
    nearest = beyond.nearest
    luminance = wide.xyz(target)[:, 1:2]
    assert_allclose(wide.xyz(nearest)[:, 1:2], luminance, atol=1e-12)
    share = (nearest - luminance) / (target - luminance)
    assert_allclose(share, share[:, :1].repeat(3, axis=1), rtol=1e-6)
    outside = solid(wide.matrix).signed_distance(nearest)
    assert outside.max() < 0
    assert outside.min() > -2 * MARGIN
    assert nodes_of(lattice, sensor).unrealisable.size == 0  # all of sRGB is realisable


def store_spectra(path):
    """Store the spectra of nodes in wide gamuts, and near a look that nine coefficients
    do not reach.
    """
    skin = uplift.Look("#c08a6e", {"FL11": "#bc8c78", "A": "#c48e70"})
    cubes = (
        uplift.build(dim=6, space="ACEScg").data,
        uplift.build(dim=6, space="P3-D65").data,
        uplift.build(dim=6, looks=skin).data,
    )
    spectra = [
        reflectance(each.model, each.points.coefficients, each.sensor.wavelengths)
        for each in cubes
    ]
    np.save(path, np.stack(spectra))


@pytest.mark.skipif(
    platform.machine() not in ("x86_64", "AMD64"), reason="sets of x86-64"
)
def test_spectra_do_not_depend_on_the_instruction_set(tmp_path):
    here = tmp_path / "here.npy"
    there = tmp_path / "there.npy"
    store_spectra(here)
    code = (
        "from tests.fit.test_problem import store_spectra; "
        f"store_spectra({str(there)!r})"
    )
    run_python(code, cwd=ROOT, env=os.environ | ONLY_AVX)
    assert_allclose(np.load(there), np.load(here), rtol=0, atol=1e-5)
