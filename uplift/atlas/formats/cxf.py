"""Reader of CxF3 (ISO 17972-1), the colour exchange format of X-Rite programs, by the package colour-cxf."""

from typing import Any

from uplift.atlas.atlas import Header, SkippedEntry
from uplift.atlas.document import Document, one_line
from uplift.atlas.measurements import Measurements, Spectrum, not_used_note, parsed_by

START, STEP = 380.0, 10.0
"""Start and step in nm of spectra whose colour specification states none."""
REFLECTANCE = "ReflectanceSpectrum"
OTHER_SPECTRA = {
    "TransmittanceSpectrum": "transmittance",
    "EmissiveSpectrum": "emission",
    "CustomSpectrum": "a custom quantity",
}


def read(document: Document) -> Measurements:
    """Read the reflectance spectra of the objects of a CxF3 file; objects with other spectra only are skipped."""
    document.check_xml()
    with parsed_by("colour-cxf", "CxF files", document):
        from colour_cxf import cxf3
        from xsdata.formats.dataclass.parsers import XmlParser
        from xsdata.formats.dataclass.parsers.config import ParserConfig

        # elements and attributes that the schema does not have are ignored
        lenient = ParserConfig(fail_on_unknown_properties=False, fail_on_unknown_attributes=False)
        found = _content(XmlParser(config=lenient).from_bytes(document.data, cxf3.CxF), document.path)
    if not found.spectra and not found.skipped:
        problem, hint = "has no object with a spectrum", "export the spectra with the colours"
        raise document.location.error(problem, hint, code="not-an-atlas")
    return found


def _content(cxf: Any, path: str) -> Measurements:
    resources, information = cxf.resources, cxf.file_information
    objects = resources.object_collection.object_value if resources and resources.object_collection else []
    ranges = _wavelength_ranges(resources)
    spectra, skipped, colours = list[Spectrum](), list[SkippedEntry](), set[str]()
    for each in objects:
        name = (each.name or each.id or "").strip()
        choices = each.color_values.choice if each.color_values else []
        kinds = [type(choice).__name__ for choice in choices]
        reflectances = [choice for choice, kind in zip(choices, kinds, strict=True) if kind == REFLECTANCE]
        for number, choice in enumerate(reflectances, 1):
            label = name if len(reflectances) == 1 else f"{name} {choice.name or number}"
            spectra.append(_spectrum(label, choice, ranges))
        others = [OTHER_SPECTRA[kind] for kind in kinds if kind in OTHER_SPECTRA]
        if others and not reflectances:
            skipped.append(SkippedEntry(name, f"it is {others[0]}, not reflectance", path))
        colours.update(kind for kind in kinds if kind.startswith("Color"))
    header = Header(one_line(information.description) if information else "")
    # the schema has values in (−0.1, 3); some programs write percent
    scale = 1.0 if all(-0.1 < value < 3 for spectrum in spectra for value in spectrum.values) else None
    notes = ("layout: an object per spectrum", *not_used_note(sorted(colours)))
    return Measurements(tuple(spectra), skipped=tuple(skipped), scale=scale, header=header, notes=notes)


def _wavelength_ranges(resources: Any) -> dict[str, tuple[float, float]]:
    """Return start and step in nm by the identifier of the colour specification."""
    collection = resources.color_specification_collection if resources else None
    ranges = {}
    for each in collection.color_specification if collection else []:
        span = each.measurement_spec.wavelength_range if each.measurement_spec else None
        if span is not None:
            ranges[each.id] = (span.start_wl or START, span.increment or STEP)
    return ranges


def _spectrum(name: str, choice: Any, ranges: dict[str, tuple[float, float]]) -> Spectrum:
    start, step = ranges.get(choice.color_specification, (START, STEP))
    first = start if choice.start_wl is None else choice.start_wl
    values = [float(value) for value in choice.value]
    nm = [float(first + step * index) for index in range(len(values))]
    return Spectrum(name, nm, values, date=one_line(choice.measure_date))
