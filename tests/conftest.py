"""Fixtures of many tests. Builds are slow, so cubes are built once per run or read from
``cubes/``.
"""

import os
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings
from threadpoolctl import threadpool_limits

import uplift
from tests.helpers import quiet_build
from tests.process_state import kept_process_state
from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Sensor
from uplift.lookup.cube import Cube

ROOT = Path(__file__).parents[1]
# Times on shared machines are unreliable.
settings.register_profile("uplift", deadline=None, print_blob=True)
settings.load_profile("uplift")

# The command line must not hide internal errors.
os.environ["UPLIFT_TRACEBACK"] = "1"
os.environ.pop(
    "PYTHONUNBUFFERED", None
)  # with it, commands hold nothing back that could be lost at their end

# Like commands, tests compute with one thread of BLAS: more of them wait for work by
# spinning. pytest has loaded numpy by now; processes that tests start have not.
threadpool_limits(1, user_api="blas")
os.environ["OPENBLAS_NUM_THREADS"] = "1"

# Compiled JAX code of this worker and the processes that it starts, kept between runs.
# JAX does not write entries at once, so workers that share a folder may read half of
# one.
CACHE = ROOT / "out" / "cache"
COMPILED = CACHE / "compiled" / os.environ.get("PYTEST_XDIST_WORKER", "main")
COMPILED.mkdir(parents=True, exist_ok=True)
os.environ |= {
    "DASK_TEMPORARY_DIRECTORY": str(CACHE / "dask"),
    "DRJIT_CACHE_DIR": str(CACHE / "drjit"),
    "HYPOTHESIS_STORAGE_DIRECTORY": str(CACHE / "hypothesis"),
    "JAX_COMPILATION_CACHE_DIR": str(COMPILED),
    "JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0",
    "JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES": "-1",
}

ATLASES = ROOT / "atlases"
MACBETH = ATLASES / "macbeth.txt"


def pytest_terminal_summary(terminalreporter) -> None:
    """List why tests were skipped, one line for each reason, before the failures."""
    reports = terminalreporter.stats.get("skipped", ())
    skipped = Counter(report.longrepr[2] for report in reports)
    for reason, count in skipped.most_common():
        line = f"{count} skipped: {reason.removeprefix('Skipped: ')}"
        terminalreporter.line(line[: terminalreporter._tw.fullwidth])
    os.environ.pop("CI", None)  # with it, failures below have lines without end


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
    return quiet_build(MACBETH, dim=32, debug=True)


@pytest.fixture(scope="session")
def cyan_cube() -> Cube:
    """The ColorChecker at dim 8, built once per run: cyan lies outside its space."""
    return quiet_build(MACBETH, dim=8)


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
