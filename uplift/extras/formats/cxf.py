"""Reader of CxF3 (ISO 17972-1), the colour exchange format of X-Rite programs, by the
package colour-cxf.
"""

import re
from collections import defaultdict
from collections.abc import Sequence, Set
from dataclasses import replace
from typing import Any

import numpy as np

from uplift.atlas.atlas import Header
from uplift.atlas.document import Document, one_line
from uplift.common.text import listed
from uplift.extras.formats.measurements import Measurements, not_used_note, parsed_by
from uplift.extras.formats.quantities import (
    OTHER,
    Quantity,
    label_quantity,
)
from uplift.extras.formats.samples import Spectrum
from uplift.extras.formats.statements import Scale
from uplift.extras.formats.xml import check_xml

START = 380.0
STEP = 10.0
"""Start and step in nm of spectra whose colour specification states none."""
CONDITION = re.compile(r"(?<![A-Za-z])M[0-3](?![0-9A-Za-z])")
"""Measurement conditions of ISO 13655: with incandescent light, daylight, without UV,
with a polariser.
"""
SPECTRA = ("ReflectanceSpectrum", "TransmittanceSpectrum", "EmissiveSpectrum")
"""Types of values of an object."""
CUSTOM = "CustomSpectrum"
"""Type of values of any quantity."""


def read(document: Document) -> Measurements:
    """Read the spectra of the objects of a CxF3 file."""
    check_xml(document)
    with parsed_by("colour-cxf", "CxF files", document):
        from colour_cxf import cxf3
        from xsdata.formats.dataclass.parsers import XmlParser
        from xsdata.formats.dataclass.parsers.config import ParserConfig

        # elements and attributes that the schema does not have are ignored
        lenient = ParserConfig(
            fail_on_unknown_properties=False, fail_on_unknown_attributes=False
        )
        found = _content(XmlParser(config=lenient).from_bytes(document.data, cxf3.CxF))
    if not found.spectra:
        problem = "has no object with a spectrum"
        hint = "export the spectra with the colours"
        raise document.location.error(problem, hint, code="not-an-atlas")
    return found


def _content(cxf: Any) -> Measurements:
    resources = cxf.resources
    stated = _part(resources, "color_specification_collection", "color_specification")
    specifications = {row.id: row.measurement_spec for row in stated or ()}
    spectra = list[Spectrum]()
    colours = set[str]()
    conditions = set[str]()
    difference = 0.0
    for sample in _part(resources, "object_collection", "object_value") or ():
        name = (sample.name or sample.id or "").strip()
        by_type = _by_type(sample)
        for kind in SPECTRA:
            quantity = label_quantity(kind)
            labels = _labels(name, by_type[kind], specifications)
            for label, choice in zip(labels, by_type[kind], strict=True):
                spectrum = _spectrum(label, choice, specifications)
                spectra.append(replace(spectrum, quantity=quantity))
                conditions.add(_condition(choice, specifications))
        if by_type[CUSTOM]:
            custom = Quantity(OTHER, CUSTOM)
            spectra.append(Spectrum(name, (), (), quantity=custom))
        difference = max(difference, _difference(by_type[SPECTRA[0]]))
        colours.update(kind for kind in by_type if kind.startswith("Color"))
    description = _part(cxf, "file_information", "description")
    return Measurements(
        tuple(spectra),
        scales=_scales(spectra),
        header=Header(one_line(description)),
        notes=(
            "layout: an object per spectrum",
            *_condition_note(conditions - {""}, difference),
            *not_used_note(sorted(colours)),
        ),
    )


def _by_type(sample: Any) -> dict[str, list[Any]]:
    """Return the values of an object by the names of their types."""
    by_type = defaultdict[str, list[Any]](list)
    for choice in _part(sample, "color_values", "choice") or ():
        by_type[type(choice).__name__].append(choice)
    return by_type


def _labels(
    name: str, reflectances: Sequence[Any], specifications: dict[str, Any]
) -> list[str]:
    """Return the names of the spectra of an object: with their condition or
    specification if there are several, or else their own names or numbers.
    """
    if len(reflectances) == 1:
        return [name]
    kinds = [
        _condition(choice, specifications) or choice.color_specification
        for choice in reflectances
    ]
    if len(set(kinds)) < len(kinds):
        numbered = enumerate(reflectances, 1)
        kinds = [choice.name or str(number) for number, choice in numbered]
    return [f"{name} {kind}" for kind in kinds]


def _scales(spectra: Sequence[Spectrum]) -> tuple[Scale, ...]:
    """Return the scale of the schema, whose values are in (−0.1, 3); none if they are
    not: some programs write percent.
    """
    values = np.concatenate([np.zeros(0), *(spectrum.values for spectrum in spectra)])
    is_of_schema = ((values > -0.1) & (values < 3)).all()
    return (Scale(1.0, "the schema of CxF3"),) if is_of_schema else ()


def _difference(choices: Sequence[Any]) -> float:
    """Return the largest difference of the spectra of an object."""
    samples = zip(*(choice.value for choice in choices), strict=False)
    return max((float(max(values) - min(values)) for values in samples), default=0.0)


def _condition_note(conditions: Set[str], difference: float) -> tuple[str, ...]:
    if not conditions:
        return ()
    note = f"measurement conditions: {listed(sorted(conditions))}"
    if len(conditions) > 1:
        note += f"; values of one object differ by up to {difference:.2g}"
    return (note,)


def _condition(choice: Any, specifications: dict[str, Any]) -> str:
    """Return the measurement condition of ISO 13655, such as M1; empty if none is
    stated.
    """
    measured = specifications.get(choice.color_specification)
    light = _part(measured, "device", "device_illumination", "value", "value")
    found = CONDITION.search(f"{light or ''} {choice.color_specification or ''}")
    return found[0] if found else ""


def _spectrum(name: str, choice: Any, specifications: dict[str, Any]) -> Spectrum:
    measured = specifications.get(choice.color_specification)
    start = _part(measured, "wavelength_range", "start_wl") or START
    step = _part(measured, "wavelength_range", "increment") or STEP
    first = start if choice.start_wl is None else choice.start_wl
    values = [float(value) for value in choice.value]
    nm = [float(first + step * index) for index in range(len(values))]
    return Spectrum(name, nm, values, date=one_line(choice.measure_date))


def _part(element: Any, *names: str) -> Any:
    """Return an element within others; None if one of them is missing."""
    for name in names:
        element = getattr(element, name, None)
    return element
