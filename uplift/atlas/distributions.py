"""Spectral distributions that a Python program already has → `Atlas`, whatever their class."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from uplift.atlas import art_write
from uplift.atlas.atlas import Atlas, Entry, Header, Source
from uplift.atlas.document import SourceLocation

FORMS = (
    "pass a mapping of names to distributions with .wavelengths and .values, "
    "one distribution with .name, or several with .labels"
)


def from_distributions(distributions: Any) -> Atlas:
    """An atlas from colour-science's distributions, or from anything of the same shape.

    Parameters
    ----------
    distributions : a mapping of names to objects with ``wavelengths`` (N,) nm and ``values`` (N,) in units
        of 1; one object with ``labels`` (E,), ``wavelengths`` (N,) and ``values`` (N, E); or one distribution
        with ``name``, ``wavelengths`` and ``values``.

    Raises
    ------
    AtlasError : no such object, or no reflectance in units of 1.
    """
    entries = tuple(Entry(name, wavelengths, values) for name, wavelengths, values in _named(distributions))
    digest = hashlib.sha256(art_write.text(Atlas(entries), Header()).encode()).hexdigest()
    return Atlas(entries, sources=(Source("distributions", digest),))


def _named(distributions: Any) -> Iterator[tuple[str, Any, Any]]:
    """Names with wavelengths and values."""
    if isinstance(distributions, Mapping):
        for name, distribution in distributions.items():
            yield str(name), *_sampled(distribution, str(name))
    elif hasattr(distributions, "labels"):
        yield from _columns(distributions)
    else:
        name = str(getattr(distributions, "name", type(distributions).__name__))
        yield name, *_sampled(distributions, name)


def _sampled(distribution: Any, name: str) -> tuple[Any, Any]:
    try:
        return distribution.wavelengths, distribution.values
    except AttributeError:
        problem = f"'{type(distribution).__name__}' is no spectral distribution"
        raise SourceLocation(entry=name).error(problem, FORMS) from None


def _columns(distributions: Any) -> Iterator[tuple[str, Any, Any]]:
    wavelengths, values = _sampled(distributions, "labels")
    names = [str(label) for label in distributions.labels]
    if np.ndim(values) != 2 or np.shape(values)[1] != len(names):
        problem = f"values of shape {np.shape(values)} for {len(names)} labels"
        raise SourceLocation().error(problem, "give values (N, E), a column per label")
    for name, column in zip(names, np.transpose(values), strict=True):
        yield name, wavelengths, column
