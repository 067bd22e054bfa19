"""Guard of XML parsers: no document type, no entities, limited depth and number of elements."""

from __future__ import annotations

import contextlib
from typing import Any
from xml.parsers import expat

from uplift.atlas.document import Document, SourceLocation

START = 4096
"""Bytes in which the first element must begin."""
MAX_DEPTH = 64
MAX_ELEMENTS = 2_000_000


class ForbiddenError(Exception):
    """A feature of XML that measurements do not need."""


def root_name(document: Document) -> str:
    """Return the name of the first element, empty if the file does not begin as XML."""
    if b"<" not in document.data[:START]:
        return ""
    names: list[str] = []
    parser = expat.ParserCreate(namespace_separator=" ")
    parser.StartElementHandler = lambda name, _: names.append(name)
    with contextlib.suppress(expat.ExpatError, ValueError, LookupError):
        parser.Parse(document.data[:START], False)
    return names[0] if names else ""


def check_xml(document: Document) -> None:
    """Raise `AtlasError` for text that is not well-formed, or has a document type or too many or too deep elements."""
    location = SourceLocation(document.path)
    depth = count = 0

    def start(name: str, attributes: Any) -> None:
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if depth > MAX_DEPTH:
            raise ForbiddenError(f"elements nest more than {MAX_DEPTH} deep")
        if count > MAX_ELEMENTS:
            raise ForbiddenError(f"more than {MAX_ELEMENTS:,} elements")

    def end(name: str) -> None:
        nonlocal depth
        depth -= 1

    def doctype(*_: Any) -> None:
        raise ForbiddenError("a document type, which may define entities")

    parser = expat.ParserCreate()
    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.StartDoctypeDeclHandler = doctype
    try:
        parser.Parse(document.data, True)
    except ForbiddenError as problem:
        raise location.error(f"the XML has {problem}", "export the file again, or export a CSV table") from None
    except (expat.ExpatError, ValueError, LookupError) as error:
        line = getattr(error, "lineno", 1)
        raise location.at(line).error(f"not a valid XML file: {error}", "export the file again") from None
