"""Limits of XML files."""

from typing import Any
from xml.parsers import expat

from uplift.atlas.document import EXPORT, Document
from uplift.common.errors import AtlasError

MAX_DEPTH = 64
"""Nested elements of a file."""
MAX_ELEMENTS = 2_000_000
"""Elements of a file."""


def check_xml(document: Document) -> None:
    """Raise `AtlasError` for XML with a document type, too many or too deep
    elements, or errors of syntax.
    """
    depth = count = 0

    def start(name: str, attributes: Any) -> None:
        nonlocal depth, count
        depth += 1
        count += 1
        if depth > MAX_DEPTH or count > MAX_ELEMENTS:
            problem = (
                f"an XML file must have at most {MAX_ELEMENTS:,} elements, and "
                f"{MAX_DEPTH} nested ones"
            )
            raise document.location.error(problem, EXPORT)

    def end(name: str) -> None:
        nonlocal depth
        depth -= 1

    def doctype(*_: Any) -> None:
        raise document.location.error(
            "an XML file must not have a document type, which may define entities",
            EXPORT,
        )

    parser = expat.ParserCreate()
    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.StartDoctypeDeclHandler = doctype
    try:
        parser.Parse(document.data, True)
    except AtlasError:
        raise
    except (expat.ExpatError, ValueError, LookupError) as error:
        location = document.location.at(getattr(error, "lineno", 1))
        raise location.error(f"not a valid XML file: {error}", EXPORT) from None
