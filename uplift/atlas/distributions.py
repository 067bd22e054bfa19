"""Conversion of spectral distributions of other libraries to an `Atlas`."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from uplift.atlas.atlas import Atlas, Entry, Header, Source
from uplift.atlas.document import SourceLocation
from uplift.atlas.formats import art_write

FORMS = (
    "pass a mapping of names to distributions with .wavelengths and .values, "
    "one distribution with .name, or several with .labels"
)


def from_distributions(distributions: Any) -> Atlas:
    """Create an atlas from distributions of colour-science, or from objects with the same attributes.

    Parameters
    ----------
    distributions : mapping or object
        A mapping of names to objects with ``wavelengths`` (N,) in nm and ``values`` (N,) in units of 1; one object with
        ``labels`` (E,), ``wavelengths`` (N,) and ``values`` (N, E); or one distribution with ``name``,
        ``wavelengths`` and ``values``.

    Returns
    -------
    Atlas

    Raises
    ------
    AtlasError
        An object lacks these attributes, or is not a reflectance in units of 1.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> grey = SimpleNamespace(wavelengths=[380, 780], values=[0.5, 0.5])
    >>> from_distributions({"grey": grey}).names
    ('grey',)
    """
    entries = tuple(Entry(name, wavelengths, values) for name, wavelengths, values in _named(distributions))
    digest = hashlib.sha256(art_write.text(Atlas(entries), Header()).encode()).hexdigest()
    return Atlas(entries, sources=(Source("distributions", digest),))


def _named(distributions: Any) -> Iterator[tuple[str, Any, Any]]:
    """Yield names with wavelengths and values."""
    if isinstance(distributions, Mapping):
        for name, distribution in distributions.items():
            yield str(name), *_samples(distribution, str(name))
    elif hasattr(distributions, "labels"):
        yield from _columns(distributions)
    else:
        name = str(getattr(distributions, "name", type(distributions).__name__))
        yield name, *_samples(distributions, name)


def _samples(distribution: Any, name: str) -> tuple[Any, Any]:
    try:
        return distribution.wavelengths, distribution.values
    except AttributeError:
        problem = f"'{type(distribution).__name__}' is not a spectral distribution"
        raise SourceLocation(entry=name).error(problem, FORMS) from None


def _columns(distributions: Any) -> Iterator[tuple[str, Any, Any]]:
    wavelengths, values = _samples(distributions, "labels")
    names = [str(label) for label in distributions.labels]
    if np.ndim(values) != 2 or np.shape(values)[1] != len(names):
        problem = f"values must have shape (N, {len(names)}) for {len(names)} labels, got {np.shape(values)}"
        raise SourceLocation().error(problem, "give one column of values per label")
    for name, column in zip(names, np.transpose(values), strict=True):
        yield name, wavelengths, column
