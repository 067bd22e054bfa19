"""JSON texts of answers."""

from collections.abc import Iterator
from typing import Any

from .console import json_output
from .query import answer_rows


def json_objects(answers: Any, block: Any) -> Iterator[str]:
    """Return the answers of a block as JSON objects."""
    return map(json_output, answer_rows(answers, block))
