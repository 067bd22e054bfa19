"""Our own lookups run the conformance kit and pass: headers in C, and the plug-in of
Mitsuba.
"""

import pytest

import uplift
from benchmarks import conformance
from tests.parts import CC, MITSUBA, need
from uplift.extras.processes import call_in_child
from uplift.extras.report.conformance import check_renderer

PATIENCE = 300
"""Seconds that Mitsuba may take."""
SPP = 64


@pytest.fixture(scope="module")
def cube():
    """The cube of the kit."""
    return uplift.load(conformance.CUBE)


@pytest.mark.parametrize("mode", ["spectra", "moments"])
def test_exported_headers(cube, tmp_path, mode):
    need(CC)
    found = check_renderer(conformance.by_header(tmp_path, mode), cube)
    assert (found.passed, found.mode) == (True, mode)


def test_the_header_that_reads_cube_files(cube, tmp_path):
    need(CC)
    found = check_renderer(conformance.by_runtime(tmp_path), cube)
    assert (found.passed, found.mode) == (True, "spectra")


@pytest.mark.parametrize(("texture", "passes"), [("uplift", True), ("bitmap", False)])
def test_mitsuba_passes_with_the_plug_in_only(cube, tmp_path, texture, passes):
    need(MITSUBA)
    path = call_in_child(
        conformance.render, tmp_path, "A", texture, SPP, seconds=PATIENCE
    )
    assert check_renderer(path, cube).passed == passes
