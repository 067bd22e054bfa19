"""The room in Mitsuba, small and noisy: passes are nearer to spectra than RGB."""

# ruff: noqa: E402  (what follows imports Mitsuba)
import pytest

from tests.parts import MITSUBA, need

need(MITSUBA)

from benchmarks.passes_room import RGB, Quality, measure


@pytest.fixture(scope="module")
def figures(tmp_path_factory):
    """Figures of a picture of 16 × 16 pixels."""
    folder = tmp_path_factory.mktemp("room") / "passes"
    found = measure(folder, Quality(16, 8, 512), (1, 2))
    assert (folder / "room.png").stat().st_size > 10_000
    return found


def test_more_passes_are_nearer_to_spectra(figures):
    means = {row["method"]: row["mean"] for row in figures["room"]}
    assert means["2"] < 0.5
    assert means["2"] < means["1"] < means[RGB]


def test_spectral_variant_confirms_the_reference(figures):
    """The noise of few samples remains."""
    errors = {row["method"]: row["spectral_variant"] for row in figures["room"]}
    assert errors["2"] < errors[RGB]
