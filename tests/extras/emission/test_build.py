"""Emission tables of measured lamps: exact lamps, and input that is refused."""

import numpy as np
import pytest

import uplift
from tests.helpers import raises, warns
from uplift.atlas.atlas import Atlas, Entry
from uplift.common.arrays import distances
from uplift.common.errors import OptionError
from uplift.extras.emission.build import build_emission
from uplift.extras.emission.lamps import read_lamps

AT = np.arange(380.0, 781.0, 5.0)
SMALL = {"knots": 64, "rings": 4}
WARM = np.exp((AT - 560) / 90)
BANDS = sum(np.exp(-(((AT - peak) / 12) ** 2)) for peak in (455, 540, 620)) + 0.01


def lamps(*entries):
    return Atlas(tuple(Entry(name, AT, power / power.max()) for name, power in entries))


@pytest.fixture(scope="module")
def table():
    """Table of three lamps, of which one has bands and one is known, and of a fourth
    that has the colour of the first.
    """
    known = uplift.load_emission().data.entries
    tube = known.spectra[known.names.index("FL2")]
    given = (("warm", WARM), ("bands", BANDS), ("tube", tube), ("second", WARM))
    with warns("entry-duplicate"):
        return build_emission(lamps(*given), **SMALL)


def test_lamps_come_first_and_keep_known_ones_away(table):
    entries = table.data.entries
    assert entries.names[:3] == ("warm", "bands", "tube")
    assert "A" in entries.names
    assert not {"FL2", "second"} & set(entries.names)
    assert table.data.provenance["left_out"] == ["second"]
    apart = distances(entries.uv[3:], entries.uv[:3])
    assert apart.min() > 2e-3


def test_every_node_has_its_chromaticity_and_discs_do_not_overlap(table, tmp_path):
    """Which is checked of every file."""
    table.save(tmp_path / "a.uplift")
    assert table.data.spectra.min() >= 0


def test_expected_errors_are_numbers_where_sodium_has_no_z():
    """The 10° observer does not respond to 590 nm by Z, so the white of sodium light
    has none.
    """
    found = build_emission(observer="CIE 1964 10 Degree Standard Observer", **SMALL)
    assert np.isfinite(found.data.error).all()


@pytest.mark.parametrize("entries", [(), (("dark", 0 * AT),)])
def test_atlases_without_light_are_refused(entries):
    atlas = Atlas(tuple(Entry(name, AT, power) for name, power in entries))
    with raises(OptionError, "option"):
        build_emission(atlas, **SMALL)


@pytest.mark.parametrize("options", [{"knots": 2}, {"rings": 4.0}, {"knots": 10**6}])
def test_bad_numbers_of_nodes_are_refused(options):
    with raises(OptionError, "option"):
        build_emission(**options)


TM27 = (
    "<IESTM2714 "
    'xmlns="iestm2714"><SpectralDistribution><SpectralQuantity>{}</SpectralQuantity>'
    '<SpectralData wavelength="400">0.1</SpectralData><SpectralData '
    'wavelength="700">0.4</SpectralData>'
    "</SpectralDistribution></IESTM2714>"
)


@pytest.mark.parametrize("quantity", ["flux", "Relative"])
def test_lamps_of_the_lighting_standard_state_power(tmp_path, quantity):
    path = tmp_path / "lamp.spdx"
    path.write_text(TM27.format(quantity))
    assert read_lamps(path)[0].values == pytest.approx([0.25, 1])
