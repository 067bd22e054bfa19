"""Small tasks and charts."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.atlas import read_atlas
from uplift.colorimetry.lights import CHART_LIGHTS
from uplift.lab.chart.method import Effort, Family, Method, PreparedMethod, make_task
from uplift.lab.chart.table import TEXTS, Chart, MethodResult, State

FACTS = dict.fromkeys(("machine", "versions", "commit", "colours", "spectra", "effort"), "stated")
BATCHES = (1, 64)
HASTE = Effort(seconds_per_error=0.05, runs=3, lap=0.001, batches=BATCHES, longest=0.05, builds=1)
ERRORS = (
    "round_trip",
    "coarse_round_trip",
    *CHART_LIGHTS,
    "lights",
    "rms",
    *(f"own_{light}" for light in CHART_LIGHTS),
    "own_lights",
    "own_rms",
)


@pytest.fixture(scope="session")
def small_task(repository):
    """Sixteen colours, the edges, and the ColorChecker, with short timings."""
    return make_task({"macbeth": read_atlas(repository / "atlases" / "macbeth.txt")}, 16, HASTE)


@pytest.fixture(scope="session")
def greys():
    """Family of the test methods."""
    return Family("Greys", "a test", "#123456", ())


@pytest.fixture
def method_of():
    """Make a method from a function of RGB and wavelengths."""

    def method_of(uplift, **fields):
        return Method("test", "Test", lambda task: PreparedMethod(uplift, 8), **fields)

    return method_of


@pytest.fixture
def row_of():
    """Make a result in which all errors are equal."""

    def row_of(name, time, error, **fields):
        numbers = {f"{key}_{kind}": error for key in ERRORS for kind in ("mean", "p99", "max")}
        numbers |= {"time_ns": time, "bytes": 1e4, "build_s": 1.0, "load_s": 0.5, "setup_s": 1.5}
        numbers |= {"round_trip_colours": 16, "unseen_spectra": 12, "own_spectra": 12}
        for batch, each in zip(BATCHES, (10 * time, time), strict=True):
            key = f"ns_{batch}"
            numbers |= {key: each, f"{key}_least": each, f"{key}_most": 2 * each, f"{key}_colours": batch}
        texts = dict.fromkeys(TEXTS, "") | dict.fromkeys(("label", "title"), name)
        plain = {
            "dtype": "float64",
            "family": "Mallett 2019",
            "source": "a test",
            "state": State.MEASURED,
            "numbers": numbers,
        }
        return MethodResult(**(texts | {"method": name} | plain | fields))

    return row_of


@pytest.fixture
def chart_of():
    """Make a chart from results."""
    return lambda *rows: Chart(FACTS, rows)


@pytest.fixture(scope="session")
def rng():
    return np.random.default_rng(0)
