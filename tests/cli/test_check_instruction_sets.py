"""Cubes written with and without AVX-512: equal nodes, spectra within the limits of ``uplift check``."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
import warnings

import numpy as np
import pytest

import uplift
from benchmarks.determinism import WITHOUT_AVX512
from tests.conftest import ATLASES, MACBETH
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
RUN = """
import json, sys
from uplift_cli.main import main
for line in json.loads(sys.argv[1]):
    main(line, standalone_mode=False)
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
def cubes(tmp_path_factory, repository):
    """Cubes of the ColorChecker at dim 8, one built by this CPU as it is and one built without AVX-512.

    Also what ``uplift check`` prints of the first one without AVX-512, from the process that builds the second one.
    """
    folder = tmp_path_factory.mktemp("cubes")
    as_is, without = folder / "as-is.uplift", folder / "without-avx512.uplift"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        uplift.build(MACBETH, dim=8).save(as_is)
    lines = (
        ["build", "-q", "--atlas", str(MACBETH), "--dim", "8", "-o", str(without)],
        ["check", str(as_is), "--atlas-dir", str(ATLASES)],
    )
    return as_is, without, python(WITHOUT_AVX512, "-c", RUN, json.dumps(lines))


def test_nodes_do_not_depend_on_avx512():
    dims = range(2, 65)
    found = json.loads(python(WITHOUT_AVX512, "-c", NODES, *dims))
    assert not found["avx512"]
    assert found["nodes"] == [axis_nodes("srgb", dim).tolist() for dim in dims]


def test_cubes_have_equal_nodes_and_spectra_within_the_limits(cubes):
    first, second = (uplift.load(path).data for path in cubes[:2])
    np.testing.assert_array_equal(first.lattice.nodes, second.lattice.nodes)
    for path, stored, rebuilt in ((cubes[0], first, second), (cubes[1], second, first)):
        assert compare_rebuilt(path, stored, rebuilt).failures == ()


def test_cube_of_either_passes_on_the_other(cubes, run):
    _, without, printed = cubes
    assert "passed" in printed
    assert "passed" in run("check", without, "--atlas-dir", ATLASES).stdout
