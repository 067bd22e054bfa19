"""Reader of CxF3 (ISO 17972-1), the colour exchange format of X-Rite programs, by the
package colour-cxf.
"""

import re
from typing import Any

from uplift.atlas import Document, Header, SkippedEntry, one_line
from uplift.common.text import listed
from uplift.extras.formats.measurements import Measurements, not_used_note, parsed_by
from uplift.extras.formats.samples import Spectrum
from uplift.extras.formats.statements import Quantity, Scale
from uplift.extras.formats.xml import check_xml

START, STEP = 380.0, 10.0
"""Start and step in nm of spectra whose colour specification states none."""
CONDITION = re.compile(r"(?<![A-Za-z])M[0-3](?![0-9A-Za-z])")
"""Measurement conditions of ISO 13655: with incandescent light, daylight, without UV,
with a polariser.
"""
REFLECTANCE = "ReflectanceSpectrum"
OTHER_SPECTRA = {
    "TransmittanceSpectrum": "transmittance",
    "EmissiveSpectrum": "emission",
    "CustomSpectrum": "a custom quantity",
}


def read(document: Document) -> Measurements:
    """Read the reflectance spectra of the objects of a CxF3 file; objects with other
    spectra only are skipped.
    """
    check_xml(document)
    with parsed_by("colour-cxf", "CxF files", document):
        from colour_cxf import cxf3
        from xsdata.formats.dataclass.parsers import XmlParser
        from xsdata.formats.dataclass.parsers.config import ParserConfig

        # elements and attributes that the schema does not have are ignored
        lenient = ParserConfig(
            fail_on_unknown_properties=False, fail_on_unknown_attributes=False
        )
        found = _content(
            XmlParser(config=lenient).from_bytes(document.data, cxf3.CxF), document.path
        )
    if not found.spectra and not found.skipped:
        problem = "has no object with a spectrum"
        hint = "export the spectra with the colours"
        raise document.location.error(problem, hint, code="not-an-atlas")
    return found


def _content(cxf: Any, path: str) -> Measurements:
    resources = cxf.resources
    information = cxf.file_information
    objects = (
        resources.object_collection.object_value
        if resources and resources.object_collection
        else []
    )
    specifications = _measurements(resources)
    spectra = list[Spectrum]()
    skipped = list[SkippedEntry]()
    colours = set[str]()
    conditions = set[str]()
    for each in objects:
        name = (each.name or each.id or "").strip()
        choices = each.color_values.choice if each.color_values else []
        types = [type(choice).__name__ for choice in choices]
        reflectances = [
            choice
            for choice, kind in zip(choices, types, strict=True)
            if kind == REFLECTANCE
        ]
        stated = [_condition(choice, specifications) for choice in reflectances]
        conditions.update(filter(None, stated))
        kinds = [
            condition or choice.color_specification
            for condition, choice in zip(stated, reflectances, strict=True)
        ]
        if len(set(kinds)) < len(kinds):
            kinds = [
                choice.name or str(number)
                for number, choice in enumerate(reflectances, 1)
            ]
        for kind, choice in zip(kinds, reflectances, strict=True):
            label = name if len(reflectances) == 1 else f"{name} {kind}"
            spectra.append(_spectrum(label, choice, specifications))
        others = [OTHER_SPECTRA[kind] for kind in types if kind in OTHER_SPECTRA]
        if others and not reflectances:
            skipped.append(
                SkippedEntry(name, f"it is {others[0]}, not reflectance", path)
            )
        colours.update(kind for kind in types if kind.startswith("Color"))
    header = Header(one_line(information.description) if information else "")
    # the schema has values in (−0.1, 3); some programs write percent
    is_of_schema = all(
        -0.1 < value < 3 for spectrum in spectra for value in spectrum.values
    )
    scales = (Scale(1.0, "the schema of CxF3"),) if is_of_schema else ()
    measured_as = tuple[str, ...]()
    if conditions:
        alike = (
            "; the entries of an object are nearly the same"
            if len(conditions) > 1
            else ""
        )
        measured_as = (f"measurement conditions: {listed(sorted(conditions))}{alike}",)
    notes = (
        "layout: an object per spectrum",
        *measured_as,
        *not_used_note(sorted(colours)),
    )
    return Measurements(
        tuple(spectra),
        skipped=tuple(skipped),
        scales=scales,
        header=header,
        notes=notes,
    )


def _measurements(resources: Any) -> dict[str, Any]:
    """Return how spectra were measured by the identifier of the colour
    specification.
    """
    collection = resources.color_specification_collection if resources else None
    specifications = collection.color_specification if collection else []
    return {
        each.id: each.measurement_spec
        for each in specifications
        if each.measurement_spec
    }


def _condition(choice: Any, specifications: dict[str, Any]) -> str:
    """Return the measurement condition of ISO 13655, such as M1; empty if none is
    stated.
    """
    measured = specifications.get(choice.color_specification)
    light = (
        measured.device.device_illumination if measured and measured.device else None
    )
    stated = (
        f"{light.value.value if light and light.value else ''} "
        f"{choice.color_specification or ''}"
    )
    found = CONDITION.search(stated)
    return found[0] if found else ""


def _spectrum(name: str, choice: Any, specifications: dict[str, Any]) -> Spectrum:
    measured = specifications.get(choice.color_specification)
    span = measured.wavelength_range if measured else None
    start = (span and span.start_wl) or START
    step = (span and span.increment) or STEP
    first = start if choice.start_wl is None else choice.start_wl
    values = [float(value) for value in choice.value]
    nm = [float(first + step * index) for index in range(len(values))]
    return Spectrum(
        name,
        nm,
        values,
        date=one_line(choice.measure_date),
        quantity=Quantity("reflectance", REFLECTANCE),
    )
