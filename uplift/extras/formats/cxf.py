"""Reader of CxF3 (ISO 17972-1), the colour exchange format of X-Rite programs, by the
package colour-cxf.
"""

import re
from itertools import compress
from typing import Any

import numpy as np

from uplift.atlas.atlas import Header, SkippedEntry
from uplift.atlas.document import Document, one_line
from uplift.atlas.measurements import Measurements, not_used_note, parsed_by
from uplift.atlas.samples import Spectrum
from uplift.atlas.statements import Quantity, Scale
from uplift.common.text import listed

START = 380.0
"""Start in nm of spectra whose colour specification states none."""
STEP = 10.0
"""Step in nm of such spectra."""
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
    document.check_xml()
    with parsed_by("colour-cxf", "CxF files", document):
        from colour_cxf import cxf3
        from xsdata.formats.dataclass.parsers import XmlParser
        from xsdata.formats.dataclass.parsers.config import ParserConfig

        # elements and attributes that the schema does not have are ignored
        lenient = ParserConfig(
            fail_on_unknown_properties=False, fail_on_unknown_attributes=False
        )
        content = XmlParser(config=lenient).from_bytes(document.data, cxf3.CxF)
        measurements = _content(content, document.path)
    if not measurements.spectra and not measurements.skipped:
        problem = "has no object with a spectrum"
        hint = "export the spectra with the colours"
        raise document.location.error(problem, hint, code="not-an-atlas")
    return measurements


def _content(cxf: Any, path: str) -> Measurements:
    specifications = _measurements(cxf.resources)
    spectra = list[Spectrum]()
    skipped = list[SkippedEntry]()
    colours = set[str]()
    conditions = set[str]()
    collection = getattr(cxf.resources, "object_collection", None)
    for item in getattr(collection, "object_value", []):
        name = (item.name or item.id or "").strip()
        choices = getattr(item.color_values, "choice", [])
        types = [type(choice).__name__ for choice in choices]
        colours.update(kind for kind in types if kind.startswith("Color"))
        reflectances = list(compress(choices, map(REFLECTANCE.__eq__, types)))
        stated = [_condition(choice, specifications) for choice in reflectances]
        conditions.update(filter(None, stated))
        labels = _labels(name, reflectances, stated)
        for label, choice in zip(labels, reflectances, strict=True):
            spectra.append(_spectrum(label, choice, specifications))
        others = list(filter(OTHER_SPECTRA.get, types))
        if others and not reflectances:
            reason = f"it is {OTHER_SPECTRA[others[0]]}, not reflectance"
            skipped.append(SkippedEntry(name, reason, path))
    notes = (
        "layout: an object per spectrum",
        *_conditions_note(sorted(conditions)),
        *not_used_note(sorted(colours)),
    )
    return Measurements(
        tuple(spectra),
        skipped=tuple(skipped),
        scales=_scales(spectra),
        header=Header(one_line(getattr(cxf.file_information, "description", None))),
        notes=notes,
    )


def _labels(name: str, reflectances: list[Any], conditions: list[str]) -> list[str]:
    """Return the name of an object; of several spectra each has in addition its
    condition, name or number.
    """
    if len(reflectances) == 1:
        return [name]
    kinds = [
        condition or choice.color_specification
        for condition, choice in zip(conditions, reflectances, strict=True)
    ]
    if len(set(kinds)) < len(kinds):
        kinds = [
            choice.name or str(number) for number, choice in enumerate(reflectances, 1)
        ]
    return [f"{name} {kind}" for kind in kinds]


def _scales(spectra: list[Spectrum]) -> tuple[Scale, ...]:
    """Return scale 1 if all values are in (−0.1, 3) as in the schema; some programs
    write percent.
    """
    values = np.concatenate([[0.0], *(spectrum.values for spectrum in spectra)])
    is_of_schema = np.all((values > -0.1) & (values < 3))
    return (Scale(1.0, "the schema of CxF3"),) if is_of_schema else ()


def _conditions_note(conditions: list[str]) -> list[str]:
    if not conditions:
        return []
    alike = "; the entries of an object are nearly the same"
    ending = alike if len(conditions) > 1 else ""
    return [f"measurement conditions: {listed(conditions)}{ending}"]


def _measurements(resources: Any) -> dict[str, Any]:
    """Return how spectra were measured by the identifier of the colour
    specification.
    """
    collection = getattr(resources, "color_specification_collection", None)
    specifications = getattr(collection, "color_specification", [])
    return {
        specification.id: specification.measurement_spec
        for specification in specifications
    }


def _condition(choice: Any, specifications: dict[str, Any]) -> str:
    """Return the measurement condition of ISO 13655, such as M1; empty if none is
    stated.
    """
    measured = specifications.get(choice.color_specification)
    device = getattr(measured, "device", None)
    light = getattr(device, "device_illumination", None)
    illumination = getattr(getattr(light, "value", None), "value", "")
    match = CONDITION.search(f"{illumination} {choice.color_specification or ''}")
    return match[0] if match else ""


def _spectrum(name: str, choice: Any, specifications: dict[str, Any]) -> Spectrum:
    measured = specifications.get(choice.color_specification)
    span = getattr(measured, "wavelength_range", None)
    first = choice.start_wl
    if first is None:
        first = getattr(span, "start_wl", None) or START
    step = getattr(span, "increment", None) or STEP
    return Spectrum(
        name,
        [float(first + step * index) for index in range(len(choice.value))],
        list(map(float, choice.value)),
        date=one_line(choice.measure_date),
        quantity=Quantity("reflectance", REFLECTANCE),
    )
