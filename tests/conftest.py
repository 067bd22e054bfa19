"""Fixtures of many tests. Builds are slow, so cubes are built once per run or read from ``cubes/``."""

from __future__ import annotations

import atexit
import os
import tempfile
import warnings
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

import uplift
from tests.process_state import kept_process_state
from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Sensor
from uplift.lookup import Cube

ROOT = Path(__file__).parents[1]
# Times on shared machines are unreliable.
settings.register_profile("uplift", deadline=None, print_blob=True)
settings.load_profile("uplift")

# The command line must not hide internal errors.
os.environ["UPLIFT_TRACEBACK"] = "1"

# Compiled JAX code, shared by this process and by all that tests start: compilation takes most of the time.
_compiled = tempfile.TemporaryDirectory(prefix="uplift-compiled-", ignore_cleanup_errors=True)
atexit.register(_compiled.cleanup)
os.environ |= {
    "JAX_COMPILATION_CACHE_DIR": _compiled.name,
    "JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0",
    "JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES": "-1",
}

ATLASES = ROOT / "atlases"
MACBETH = ATLASES / "macbeth.txt"


@pytest.fixture(scope="module", autouse=True)
def _process_state() -> Iterator[None]:
    """Commands set variables for their process: later modules start without them."""
    with kept_process_state():
        yield


@pytest.fixture(scope="session")
def sensor() -> Sensor:
    """sRGB under D65."""
    return observer.sensor()


@pytest.fixture(scope="session")
def macbeth_cube() -> Cube:
    """The ColorChecker at dim 32 with debug information, built once per run."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        return uplift.build(MACBETH, dim=32, debug=True)


@pytest.fixture(scope="session")
def small_cube() -> Cube:
    """The ColorChecker at dim 8 with 9 moment coefficients, as stored."""
    return uplift.load(ROOT / "cubes" / "moments-8-macbeth.uplift")


@pytest.fixture(scope="session")
def plain_cube() -> Cube:
    """Dim 8 with 9 moment coefficients, without an atlas, as stored."""
    return uplift.load(ROOT / "cubes" / "moments-8.uplift")


@pytest.fixture(scope="session")
def small_sigmoid_cube() -> Cube:
    """The sigmoid at dim 8, without an atlas, as stored."""
    return uplift.load(ROOT / "cubes" / "sigmoid-8.uplift")


@pytest.fixture(scope="session")
def repository() -> Path:
    """The root of the working tree."""
    return ROOT
