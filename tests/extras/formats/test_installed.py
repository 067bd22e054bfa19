"""A package of another author adds a format of atlas files by an entry point."""

import os

from tests.helpers import run_python

READER = """
from uplift.atlas import Format
from uplift.extras.formats.measurements import Measurements
from uplift.extras.formats.samples import Spectrum
from uplift.extras.formats.statements import PERCENT, Scale

FORMATS = (Format("toy", (".toy",), r"\\ATOY ", "toy_format"),)

def read(document):
    title, *rows = document.lines
    pairs = [row.split() for row in rows if row]
    wavelengths = [float(wavelength) for wavelength, _ in pairs]
    values = [float(value) for _, value in pairs]
    spectrum = Spectrum(title.removeprefix("TOY "), wavelengths, values, line=1)
    return Measurements((spectrum,), scales=(Scale(PERCENT, "the format"),))
"""
PROGRAM = """
import uplift
atlas = uplift.read_atlas("card.toy")
print(atlas.sources[0].format, atlas[0].name, atlas[0].values.tolist())
"""


def test_a_format_of_another_package_is_read(tmp_path):
    (tmp_path / "toy_format.py").write_text(READER)
    metadata = tmp_path / "toy_format-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Name: toy-format\nVersion: 1.0\n")
    entry_point = "[uplift.formats]\ntoy = toy_format:FORMATS\n"
    (metadata / "entry_points.txt").write_text(entry_point)
    (tmp_path / "card.toy").write_text("TOY grey card\n380 20\n780 25\n")
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    printed = run_python(PROGRAM, cwd=tmp_path, env=environment)
    assert printed.split() == ["toy", "grey", "card", "[0.2,", "0.25]"]
