"""The file of passes: round trip, and values that it must not have."""

import re

import pytest
from numpy.testing import assert_allclose

from tests.helpers import raises
from uplift.common.errors import PassesError
from uplift.extras.scene.passes.file import (
    passes_digest,
    read_passes,
    to_toml,
    write_passes,
)


def test_round_trip(two_passes, tmp_path):
    path = tmp_path / "passes.toml"
    write_passes(two_passes, path)
    again = read_passes(path)
    assert to_toml(again) == to_toml(two_passes)
    assert passes_digest(again) == passes_digest(two_passes)
    assert again.bands == two_passes.bands
    assert_allclose(again.to_xyz, two_passes.to_xyz, rtol=1e-8)
    assert_allclose(again.light_projection, two_passes.light_projection, rtol=1e-8)
    first, read = two_passes.lights[1], again.lights[1]
    assert read.name == first.name
    assert_allclose(read.numbers, first.numbers, rtol=1e-8)
    assert_allclose(read.own_errors, first.own_errors, rtol=1e-8)


@pytest.mark.parametrize(
    ("pattern", "replacement"),
    [
        (r"^format = .*$", 'format = "uplift passes 2"'),
        (r"^centres = \[448.0, ", "centres = ["),
        (r"^centres = \[448.0, 498.0", "centres = [498.0, 448.0"),
        (r"^width = .*$", "width = nan"),
        (r"^width = .*$", "width = 61"),
        (r"^width = .*$", 'width = "wide"'),
        (r"^numbers = \[", "numbers = [-1.0, "),
        (r"^to-xyz = \[\n  \[", "to-xyz = [\n  [1.0, "),
        (r"^projection = \[\n.*\n", "projection = [\n"),
        (r"^wavelengths = .*$", "wavelengths = [400.0, 700.0]"),
        (r'^name = "A"$', 'name = "D65"'),
        (r'^source = "library"$', 'source = "elsewhere"'),
        (r"^errors = .*$", "errors = [1.0]"),
        (r"\Z", "unknown = 1"),
        (r"\A", "= 1"),
    ],
)
def test_bad_values_are_refused(two_passes, tmp_path, pattern, replacement):
    text = to_toml(two_passes)
    changed = re.sub(pattern, replacement, text, count=1, flags=re.MULTILINE)
    assert changed != text
    path = tmp_path / "passes.toml"
    path.write_text(changed, encoding="utf-8")
    with raises(PassesError, "invalid-file") as caught:
        read_passes(path)
    assert caught.value.path == path
