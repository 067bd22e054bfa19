"""Assertions on the errors and warnings of uplift by their stable codes."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest

from uplift.common.errors import UpliftError, UpliftWarning
from uplift.cube import CubeData


@contextlib.contextmanager
def raises(kind: type[UpliftError], code: str = "") -> Iterator[Any]:
    """Expect an error of ``kind``, with ``code`` if it is given; yields pytest's ``ExceptionInfo``."""
    with pytest.raises(kind) as caught:
        yield caught
    assert not code or caught.value.code == code, f"{caught.value.code}: {caught.value}"


@contextlib.contextmanager
def warns(*codes: str) -> Iterator[list[UpliftWarning]]:
    """Expect exactly the `UpliftWarning` codes given, in any order; yields the list that the block fills."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found: list[UpliftWarning] = []
        yield found
    found += [each.message for each in caught if isinstance(each.message, UpliftWarning)]
    assert sorted(each.code for each in found) == sorted(codes)


def with_points(data: CubeData, **arrays: Any) -> CubeData:
    """Return ``data`` with some arrays of its point table replaced."""
    return replace(data, points=replace(data.points, **arrays))
