"""Every format with every quantity, in units of 1 and in percent, with decimal points
and commas, and with marks of missing values: all as the table of quantities has it.
"""

import itertools
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.helpers import raises
from uplift.atlas.sources import read_atlas
from uplift.common.errors import AtlasError, UpliftWarning
from uplift.extras.emission.lamps import read_lamps
from uplift.extras.formats.quantities import QUANTITIES

NM = np.arange(370, 791, 10)
VALUES = np.round(0.08 + 0.47 / (1 + np.exp((600 - NM) / 20)), 4)
LABELS = {
    "measurement of a light": "Illuminance", "standard deviation": "Std. Dev.",
    "K/S": "K/S", "photon flux": "photons m-2 s-1",
    "optical density": "optical density",
    "correction matrix of a colorimeter": "CCMX", "absorbance": "Absorbance",
    "absorption or scattering": "absorption", "refractive index": "refractive index",
    "sensitivity": "colour matching function", "transmittance": "Transmittance",
    "emissivity": "emissivity", "fluorescence": "fluorescence", "BRDF": "BRDF",
    "reflectance": "Reflectance", "counts": "Counts", "spectral power": "Radiance",
}  # fmt: skip
CXF = {
    "reflectance": "Reflectance", "transmittance": "Transmittance",
    "spectral power": "Emissive", "another quantity": "Custom",
}  # fmt: skip


def columns(label, cells):
    rows = [f"{nm};{cell}" for nm, cell in zip(NM, cells, strict=True)]
    return "\n".join([f"nm;{label}", *rows])


def rows(label, cells):
    return f"# {label}\nname;{';'.join(map(str, NM))}\na;{';'.join(cells)}"


def cgats(label, cells):
    fields = "\t".join(f"nm{nm}" for nm in NM)
    data = "\t".join(cells)
    return (
        f"{label}\nBEGIN_DATA_FORMAT\nID\t{fields}\nEND_DATA_FORMAT\nBEGIN_DATA\n"
        f"a\t{data}\nEND_DATA"
    )


def jcamp(label, cells):
    mark = ";" if "," in cells[-1] else ","
    pairs = "".join(f"{nm}{mark} {cell}\n" for nm, cell in zip(NM, cells, strict=True))
    head = f"##TITLE=a\n##XUNITS=NANOMETERS\n##YUNITS={label}\n##XYPOINTS=(XY..XY)\n"
    return f"{head}{pairs}##END=\n"


def tm27(label, cells):
    values = "".join(
        f'<SpectralData wavelength="{nm}">{cell}</SpectralData>'
        for nm, cell in zip(NM, cells, strict=True)
    )
    quantity = f"<SpectralQuantity>{label}</SpectralQuantity>"
    part = f"<SpectralDistribution>{quantity}{values}</SpectralDistribution>"
    return f'<IESTM2714 xmlns="iestm2714">{part}</IESTM2714>'


def cxf(kind, cells):
    value = (
        f'<cc:{kind}Spectrum ColorSpecification="a" StartWL="{NM[0]}">'
        f"{' '.join(cells)}</cc:{kind}Spectrum>"
    )
    return (
        '<cc:CxF xmlns:cc="http://colorexchangeformat.com/CxF3-core"><cc:Resources>'
        '<cc:ObjectCollection><cc:Object ObjectType="a" Name="a" Id="a">'
        f"<cc:ColorValues>{value}</cc:ColorValues>"
        "</cc:Object></cc:ObjectCollection></cc:Resources></cc:CxF>"
    )


def envi(folder, label, cells):
    np.array(cells, dtype="<f8").tofile(folder / "a.sli")
    return (
        f"ENVI\nsamples = {len(NM)}\nlines = 1\nbands = 1\ndata type = 5\n"
        "byte order = 0\nheader offset = 0\nfile type = ENVI Spectral Library\n"
        f"interleave = bsq\ndata ignore value = -9999\ndata units = {label}\n"
        f"wavelength units = nm\nspectra names = {{a}}\n"
        f"wavelength = {{{', '.join(map(str, NM))}}}\n"
    )


MARKS = ("", "NaN", "-9999")
FORMATS = {
    "columns": (columns, ".,", MARKS, LABELS),
    "rows": (rows, ".,", MARKS, LABELS),
    "cgats": (cgats, ".,", ("-9999",), LABELS),
    "jcamp": (jcamp, ".,", (), LABELS),
    "tm27": (tm27, ".", ("-9999",), LABELS),
    "envi": (envi, ".", ("-9999",), LABELS),
    "cxf": (cxf, ".", (), CXF),
}
IN_REMARKS = ("rows", "cgats", "envi")


def write(folder, form, label, cells):
    writer = FORMATS[form][0]
    content = writer(*[folder] * (form == "envi"), label, cells)
    path = folder / ("a.hdr" if form == "envi" else "a.txt")
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def check(path, kind):
    """Compare what is read with the values, as the row of the table has it."""
    power = VALUES / NM if "wavelength" in kind.lamp else VALUES
    for read, treatment, code, expected in (
        (read_atlas, kind.atlas, "not-reflectance", VALUES),
        (read_lamps, kind.lamp, "not-a-lamp", power / power.max()),
    ):
        if not treatment.startswith("read"):
            with raises(AtlasError, code):
                read(path)
            continue
        (entry,) = read(path)
        inside = np.isin(NM, entry.wavelengths)
        assert inside[1:].all()
        assert_allclose(entry.values, expected[inside])


def writings(form):
    """Decimal point, factor and mark of the first value, which may be missing."""
    _, decimals, marks, _ = FORMATS[form]
    yield from itertools.product(decimals, (1, 100), (None,))
    yield from ((decimals[-1], 1, mark) for mark in marks)


@pytest.mark.parametrize("form", FORMATS)
def test_all_formats_read_by_one_table(form, tmp_path):
    for name, label in FORMATS[form][3].items():
        kind = QUANTITIES[name]
        if not kind.words and form in IN_REMARKS:
            continue
        is_read = "read" in (kind.atlas + kind.lamp)
        for decimal, factor, mark in itertools.islice(
            writings(form), None if is_read else 1
        ):
            cells = [f"{value * factor:.6g}".replace(".", decimal) for value in VALUES]
            cells[0] = cells[0] if mark is None else mark
            stated = label if factor == 1 or form == "cxf" else f"{label} in percent"
            path = write(tmp_path, form, stated, cells)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", UpliftWarning)
                check(path, kind)
