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
from uplift.colorimetry.object_colours import solid
from uplift.lattice.point_table import Status
from uplift.models.model import reflectance

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
        ("ITU-R BT.2020", "moments", 9),
        ("ACEScg", "moments", 17),
        ("ProPhoto RGB", "sigmoid", 3),
    ],
)
def test_every_realisable_colour_is_fitted(space, model, count):
    data = uplift.build(dim=7, space=space, model=model, coefficients=count).data
    possible = solid(data.sensor.matrix).contains(data.lattice.points)
    assert Status.UNFITTED not in data.points.status
    rgb = data.sensor.rgb(
        reflectance(data.model, data.points.coefficients, data.sensor.wavelengths)
    )
    distance = np.abs(rgb - data.lattice.points).max(axis=1)
    assert (~possible).sum() > 10
    assert distance[possible].max() <= data.threshold
    named = data.points.status == Status.UNREALISABLE
    assert_array_equal(named, ~possible & (distance > data.threshold))


def store_spectra(path):
    """Store the spectra of nodes in wide gamuts, and near a look that nine coefficients
    do not reach.
    """
    skin = uplift.Look("#c08a6e", {"FL11": "#bc8c78", "A": "#c48e70"})
    spectra = []
    for options in ({"space": "ACEScg"}, {"looks": skin}):
        data = uplift.build(dim=6, **options).data
        coefficients = data.points.coefficients
        spectra.append(reflectance(data.model, coefficients, data.sensor.wavelengths))
    np.save(path, spectra)


@pytest.mark.skipif(
    platform.machine() not in ("x86_64", "AMD64"), reason="sets of x86-64"
)
def test_spectra_do_not_depend_on_the_instruction_set(tmp_path):
    here = tmp_path / "here.npy"
    there = tmp_path / "there.npy"
    store_spectra(here)
    code = "import sys; from tests.fit import test_problem"
    code += "; test_problem.store_spectra(sys.argv[1])"
    run_python(code, there, cwd=ROOT, env=os.environ | ONLY_AVX)
    assert_allclose(np.load(there), np.load(here), rtol=0, atol=1e-5)
