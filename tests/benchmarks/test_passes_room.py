"""The room in Mitsuba, small and noisy: passes are nearer to spectra than RGB."""

# ruff: noqa: E402  (what follows imports Mitsuba)
from tests.parts import MITSUBA, need

need(MITSUBA)

from benchmarks.passes_room import RGB, SPECTRAL, errors, render_all


def test_two_passes_are_nearer_to_both_renderings_of_spectra():
    """The noise of few samples remains between the two."""
    rendered = render_all(16, {"scalar_rgb": 8, SPECTRAL: 512}, (2,))
    rows = {row["method"]: row for row in errors(rendered)}
    assert rows["2"]["mean"] < 0.5
    assert rows["2"]["mean"] < rows[RGB]["mean"]
    assert rows["2"]["to_spectral"] < rows[RGB]["to_spectral"]
