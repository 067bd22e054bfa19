"""Writer of the ART measurement archive. `art` reads the same values, bit for bit."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from uplift.atlas.atlas import Atlas, Entry, Header
from uplift.atlas.formats.art import NOT_STATED
from uplift.common.arrays import Array


def text(atlas: Atlas, header: Header) -> str:
    """Format an archive: version 1.1, or 1.2 if an entry has an additional description."""
    version = "1.2" if any(entry.additional_description for entry in atlas) else "1.1"
    lines = [f"ART measurement archive version {version}", ""]
    for key, value in (("content", header.content), ("copyright", header.copyright), ("license", header.licence)):
        lines.append(f"Archive {key}: {_one_line(value) or NOT_STATED}")
    lines.append("")
    for entry in atlas:
        lines += _entry(entry)
    return "\n".join(lines)


def _entry(entry: Entry) -> Iterator[str]:
    yield f"Entry ID:   {entry.name}"
    yield "-" * 75
    yield _field("Description", _quote(entry.description))
    if entry.additional_description:
        yield _field("Additional description", _quote(entry.additional_description))
    yield _field("Type", "reflectance spectrum")
    yield _field("Fluorescence data", "no")
    yield _field("Measurement device", entry.device)
    yield _field("Measured by", entry.measured_by)
    yield _field("Measurement date", entry.date)
    yield from _samples(entry.wavelengths, entry.values)
    yield ""


def _samples(wavelengths: Array, values: Array) -> Iterator[str]:
    yield from ("Sampling information", "-" * 20)
    step = _exact_step(wavelengths)
    if step is None:
        yield _field("Type", "point sampled")
        samples = (f"{{{x!r}, {y!r}}}" for x, y in zip(wavelengths.tolist(), values.tolist(), strict=True))
    else:
        yield _field("Type", "regular")
        yield _field("Start", f"{float(wavelengths[0])!r} nm")
        yield _field("Increment", f"{step!r} nm")
        samples = (repr(value) for value in values.tolist())
    yield _field("Maximum sample value", "1.0")
    yield from ("ASCII sample data", "-" * 17, f"{{{', '.join(samples)}}}")


def _exact_step(wavelengths: Array) -> float | None:
    """Return the step that gives exactly these wavelengths in the reader, None if there is none."""
    n = len(wavelengths)
    first, last = wavelengths[0], wavelengths[-1]
    for step in (wavelengths[1] - first, (last - first) / (n - 1), round((last - first) / (n - 1), 9)):
        if np.array_equal(first + step * np.arange(n), wavelengths):
            return float(step)
    return None


def _field(key: str, value: str) -> str:
    return f"{key:<22}:  {_one_line(value)}".rstrip()


def _quote(text: str) -> str:
    """Quote text that has quotes at both ends, as the reader removes one pair."""
    text = _one_line(text)
    return f'"{text}"' if len(text) > 1 and text[0] == text[-1] == '"' else text


def _one_line(text: str) -> str:
    return " ".join(text.replace("\0", " ").split())
