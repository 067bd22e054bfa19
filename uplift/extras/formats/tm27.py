"""Reader of IES TM-27-14 (``.spdx``), by colour-science."""

from uplift.atlas.document import Document, one_line
from uplift.common.colour_science import colour_science
from uplift.extras.formats.measurements import Measurements, parsed_by
from uplift.extras.formats.quantities import POWER, Quantity, label_quantity
from uplift.extras.formats.samples import Spectrum
from uplift.extras.formats.xml import check_xml


def read(document: Document) -> Measurements:
    """Read the spectrum of a file."""
    check_xml(document)
    colour = colour_science()
    with parsed_by("colour-science", "IES TM-27 files", document):
        spectrum = colour.SpectralDistribution_IESTM2714(document.path).read()
        quantity = one_line(spectrum.spectral_quantity).lower()
        described = one_line(spectrum.header.description)
        date = one_line(spectrum.header.report_date)
        nm = spectrum.wavelengths.tolist()
        values = spectrum.values.tolist()
    return Measurements(
        (
            Spectrum(
                described or document.stem, nm, values, description=described, date=date
            ),
        ),
        notes=(f"layout: one spectrum, quantity '{quantity}'",),
        quantity=label_quantity(quantity) or Quantity(POWER, quantity)
        if quantity
        else None,
    )
