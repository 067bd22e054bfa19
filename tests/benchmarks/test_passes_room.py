"""The room in Mitsuba, small and noisy: passes are nearer to spectra than RGB."""

# ruff: noqa: E402  (what follows imports Mitsuba)
import pytest

from tests.parts import MITSUBA, need

need(MITSUBA)

from benchmarks.passes_room import RGB, SPECTRAL, errors, render_all


@pytest.fixture(scope="module")
def rows():
    """Errors of a picture of 16 × 16 pixels, by method."""
    rendered = render_all(16, {"scalar_rgb": 8, SPECTRAL: 512}, (1, 2))
    return {row["method"]: row for row in errors(rendered)}


def test_more_passes_are_nearer_to_spectra(rows):
    assert rows["2"]["mean"] < 0.5
    assert rows["2"]["mean"] < rows["1"]["mean"] < rows[RGB]["mean"]


def test_spectral_variant_confirms_the_reference(rows):
    """The noise of few samples remains."""
    assert rows["2"]["to_spectral"] < rows[RGB]["to_spectral"]
