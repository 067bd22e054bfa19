"""Reader of IES TM-27-14 (``.spdx``), by colour-science."""

from __future__ import annotations

from uplift.atlas.document import Document, SourceLocation, truncate
from uplift.atlas.formats.xml import check_xml, root_name
from uplift.atlas.measurements import Measurements, Spectrum, parsed_by, refuse_as_lamp, refuse_quantity
from uplift.common.colour_science import colour_science

ROOT = "IESTM2714"
REFLECTANCES = ("reflectance", "r-factor")
"""Spectral quantities of the standard that a cube can hold."""
MATERIALS = (*REFLECTANCES, "transmittance", "t-factor", "absorptance")
"""Spectral quantities of the standard that no lamp has."""


def is_tm27(document: Document) -> bool:
    """Whether the first element is that of IES TM-27-14."""
    return root_name(document).rpartition(" ")[2] == ROOT


def read(document: Document) -> Measurements:
    """Read the spectrum of a file."""
    check_xml(document)
    colour = colour_science()
    with parsed_by("colour-science", "IES TM-27", document.path):
        found = colour.SpectralDistribution_IESTM2714(document.path).read()
        quantity = (found.spectral_quantity or "").strip().lower()
        header = found.header
        nm, values = found.wavelengths.tolist(), found.values.tolist()
    if quantity in MATERIALS:
        refuse_as_lamp(quantity, SourceLocation(document.path))
    if quantity not in REFLECTANCES:
        refuse_quantity(f"the file states '{truncate(quantity)}', not reflectance", SourceLocation(document.path))
    described = " ".join((header.description or "").split())
    date = " ".join((header.report_date or "").split())
    spectrum = Spectrum(described or document.stem, nm, values, description=described, date=date)
    return Measurements((spectrum,), notes=(f"layout: one spectrum, quantity '{quantity}'",))
