"""Small tasks and charts."""

import pytest

from uplift.atlas.sources import read_atlas
from uplift.lab.chart.results import FACTS, REQUIRED, TEXTS, Chart, MethodResult, State
from uplift.lab.chart.task import Effort, make_task
from uplift.lab.method import Method, PreparedMethod

BATCHES = (1, 64)
HASTE = Effort(16, 0.05, runs=3, lap=0.001, batches=BATCHES, longest=0.05, builds=1)


@pytest.fixture(scope="session")
def small_task():
    """Sixteen colours, the edges, and the ColorChecker, with short timings."""
    return make_task({"macbeth": read_atlas("macbeth")}, HASTE)


def method_of(uplift, prepare=None, **fields):
    """Make a method from a function of RGB and wavelengths."""
    texts = dict.fromkeys(("method", "title", "source"), "test")
    prepare = prepare or (lambda task: PreparedMethod(uplift, 8))
    return Method(**texts, prepare=prepare, **fields)


def row_of(name, time, error, memory=1e4, **fields):
    """Make a result in which all errors are equal."""
    numbers = dict.fromkeys(REQUIRED, error)
    numbers |= {"time_ns": time, "bytes": memory, "build_s": 1.0, "setup_s": 1.5}
    for batch, each in zip(BATCHES, (10 * time, time), strict=True):
        key = f"ns_{batch}"
        numbers |= {key: each, f"{key}_least": each, f"{key}_most": 2 * each}
        numbers[f"{key}_colours"] = batch
    texts = dict.fromkeys(TEXTS, "") | dict.fromkeys(("method", "label", "title"), name)
    plain = {"family": "Mallett 2019", "state": State.MEASURED, "numbers": numbers}
    return MethodResult(**(texts | plain | fields))


def chart_of(*rows):
    return Chart(dict.fromkeys(FACTS, "stated"), rows)
