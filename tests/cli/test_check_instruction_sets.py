"""Cubes written with and without AVX-512: equal nodes, spectra within the limits of ``uplift check``."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys

import numpy as np
import pytest

import uplift
from benchmarks.determinism import WITHOUT_AVX512
from uplift.colorimetry.observer import axis_nodes
from uplift.report.regression import compare_rebuilt

pytestmark = pytest.mark.skipif(
    platform.machine() not in ("x86_64", "AMD64"), reason="the instruction sets are those of x86-64"
)
NODES = """
import json, sys
from numpy._core._multiarray_umath import __cpu_features__ as features
from uplift.colorimetry.observer import axis_nodes
nodes = [axis_nodes("srgb", dim).tolist() for dim in map(int, sys.argv[1:])]
print(json.dumps({"avx512": features.get("X86_V4", False), "nodes": nodes}))
"""


def python(environment, *args):
    """Run Python in a process with an environment, without code compiled in another one."""
    compiled = {"JAX_ENABLE_COMPILATION_CACHE": "false"}
    command = [sys.executable, *map(str, args)]
    result = subprocess.run(
        command, env=os.environ | compiled | environment, capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


@pytest.fixture(scope="module")
def written(tmp_path_factory, repository):
    """Cubes of the ColorChecker at dim 8, one built by this CPU as it is and one built without AVX-512."""
    folder = tmp_path_factory.mktemp("cubes")
    paths = folder / "as-is.uplift", folder / "without-avx512.uplift"
    for path, environment in zip(paths, ({}, WITHOUT_AVX512), strict=True):
        atlas = repository / "atlases" / "macbeth.txt"
        python(environment, "-m", "uplift_cli", "build", "-q", "--atlas", atlas, "--dim", 8, "-o", path)
    return paths


def test_nodes_do_not_depend_on_avx512():
    dims = range(2, 65)
    found = json.loads(python(WITHOUT_AVX512, "-c", NODES, *dims))
    assert not found["avx512"]
    assert found["nodes"] == [axis_nodes("srgb", dim).tolist() for dim in dims]


def test_cubes_have_equal_nodes_and_spectra_within_the_limits(written):
    first, second = (uplift.load(path).data for path in written)
    np.testing.assert_array_equal(first.lattice.nodes, second.lattice.nodes)
    for path, stored, rebuilt in ((written[0], first, second), (written[1], second, first)):
        assert compare_rebuilt(path, stored, rebuilt).failures == ()


def test_cube_of_either_passes_on_the_other(written, repository):
    as_is, without_avx512 = written
    atlases = repository / "atlases"
    for environment, cube in ((WITHOUT_AVX512, as_is), ({}, without_avx512)):
        assert "passed" in python(environment, "-m", "uplift_cli", "check", cube, "--atlas-dir", atlases)
