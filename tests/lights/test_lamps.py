"""Files of lamps: powers of any scale, and files that are not of lamps."""

from __future__ import annotations

import pytest

from tests.helpers import raises
from uplift.atlas import read_atlas
from uplift.common.errors import AtlasError
from uplift.lights.lamps import read_lamps


def write(path, values, comment="# spectral irradiance"):
    path.write_text(f"{comment}\nname,400,500,600,700\nbulb,{','.join(map(str, values))}\n")
    return path


@pytest.mark.parametrize("scale", [1e-6, 1, 1e6])
def test_powers_have_no_scale(tmp_path, scale):
    atlas = read_lamps(write(tmp_path / "lamps.csv", [scale * value for value in (1, 2, 3, 4)]))
    assert atlas.names == ("bulb",)
    assert atlas[0].values == pytest.approx([0.25, 0.5, 0.75, 1])


def test_a_file_of_power_is_still_not_an_atlas_of_reflectances(tmp_path):
    path = write(tmp_path / "lamps.csv", [0.1, 0.2, 0.3, 0.4])
    read_lamps(path)
    with raises(AtlasError, "wrong-quantity"):
        read_atlas(path)


def test_a_lamp_without_power_is_refused(tmp_path):
    with raises(AtlasError, "lamp-without-power"):
        read_lamps(write(tmp_path / "lamps.csv", [0, 0, 0, 0]))


TM27 = (
    '<IESTM2714 xmlns="iestm2714"><SpectralDistribution><SpectralQuantity>{}</SpectralQuantity>'
    '<SpectralData wavelength="400">0.1</SpectralData><SpectralData wavelength="700">0.4</SpectralData>'
    "</SpectralDistribution></IESTM2714>"
)
JCAMP = "##TITLE=a\n##XUNITS=NANOMETERS\n##YUNITS={}\n##XYPOINTS=(XY..XY)\n400, 0.1\n700, 0.4\n##END=\n"


@pytest.mark.parametrize("quantity", ["flux", "irradiance", "Relative"])
def test_lamps_of_the_lighting_standard_state_power(tmp_path, quantity):
    path = tmp_path / "lamp.spdx"
    path.write_text(TM27.format(quantity))
    assert read_lamps(path)[0].values == pytest.approx([0.25, 1])


@pytest.mark.parametrize(
    ("layout", "quantity"),
    [(TM27, "reflectance"), (TM27, "R-Factor"), (TM27, "transmittance"), (JCAMP, "REFLECTANCE")],
)
def test_stated_quantities_of_materials_are_refused(tmp_path, layout, quantity):
    path = tmp_path / "material.txt"
    path.write_text(layout.format(quantity))
    with raises(AtlasError, "wrong-quantity"):
        read_lamps(path)


def test_an_archive_of_reflectances_is_refused(repository):
    with raises(AtlasError, "wrong-quantity"):
        read_lamps(repository / "atlases" / "macbeth.txt")
