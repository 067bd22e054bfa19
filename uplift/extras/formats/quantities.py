"""Table of the quantities of spectra, ``quantities.toml``, by which all readers accept,
convert, leave out or refuse them, and the quantity that a text, names or values state.
"""

import functools
import re
import tomllib
import unicodedata
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uplift.common.arrays import Array

TABLE = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
"""The table, with scales, units, and words of labels."""


@dataclass(frozen=True, eq=False)
class Kind:
    """A row of the table: a quantity, what becomes of it in an atlas and as a lamp, how
    files write it, and patterns of any text, and of labels.
    """

    name: str
    atlas: str
    lamp: str
    examples: str
    words: Sequence[str] = ()
    labels: Sequence[str] = ()
    hint: str = "measure the reflectance, or correct the statement if it is wrong"

    def is_used(self, *, lamps: bool) -> bool:
        """Whether lamps, or the entries of an atlas, have it."""
        return (self.lamp if lamps else self.atlas).startswith("read")


@dataclass(frozen=True)
class Quantity:
    """A quantity that a file states, in the words of ``text``."""

    kind: Kind
    text: str


def any_of(patterns: Iterable[str]) -> re.Pattern[str]:
    """Compile a pattern that finds any of several ones in any case."""
    return re.compile("|".join(patterns) or "(?!)", re.IGNORECASE)


def _any_word(words: Iterable[str]) -> re.Pattern[str]:
    return any_of([rf"(?<![^\W\d])(?:{'|'.join(words)})(?![^\W\d])"])


QUANTITIES = {row["name"]: Kind(**row) for row in TABLE["quantity"]}
DEVIATION = QUANTITIES["standard deviation"]
PHOTONS = QUANTITIES["photon flux"]
REFLECTANCE = QUANTITIES["reflectance"]
POWER = QUANTITIES["spectral power"]
OF_LIGHT = QUANTITIES["measurement of a light"]
OTHER = QUANTITIES["another quantity"]
K_OVER_S = QUANTITIES["K/S"]
_OF_REFLECTANCE = (K_OVER_S, QUANTITIES["optical density"])
"""What lines with the word reflectance may be about."""
_IN_TEXTS = {kind: any_of(kind.words) for kind in QUANTITIES.values()}
_IN_LABELS = {kind: any_of([*kind.words, *kind.labels]) for kind in QUANTITIES.values()}
_LETTERS = {letters: QUANTITIES[name] for letters, name in TABLE["letters"].items()}
_LETTER = re.compile(r"(?<![^\W\d])[^\W\d](?![^\W\d])")
_SPREADS = _any_word(TABLE["words"]["spreads"])
_MEANS = _any_word(TABLE["words"]["means"])
_BATCHES = _any_word(TABLE["words"]["batches"])
_LIGHTS = re.compile(TABLE["words"]["lights"])


def plain_text(text: str) -> str:
    """Return a text with blanks for underscores, plain digits and no accents.

    >>> plain_text("x̄_10 [µW/cm²]")
    'x 10 [μW/cm2]'
    """
    decomposed = unicodedata.normalize("NFKD", text.replace("_", " "))
    return re.sub("[\u0300-\u036f]", "", decomposed)


@functools.lru_cache
def label_quantity(text: str) -> Quantity | None:
    """Return the quantity that the label of values states, None if it states none.

    >>> quantities = map(label_quantity, ("%T", "R [%]", "SPD", "ochre"))
    >>> [quantity and quantity.kind.name for quantity in quantities]
    ['transmittance', 'reflectance', 'spectral power', None]
    """
    plain = re.sub(r"(?<=[^\W\d])(?=\d)", " ", plain_text(text))
    found = (kind for kind, pattern in _IN_LABELS.items() if pattern.search(plain))
    kind = next(found, None)
    return Quantity(kind, text) if kind else None


def is_photometric(text: str) -> bool:
    """Whether a label is a key of light meters, such as 'CCT (K)'."""
    return bool(_IN_TEXTS[OF_LIGHT].match(plain_text(text)))


def remark_quantity(texts: Iterable[str]) -> Quantity | None:
    """Return reflectance if a line of text states it, else the first other quantity
    that one states. A line about K/S or density may name what it comes from.
    """
    others = list[Quantity]()
    for text in texts:
        plain = plain_text(text)
        kinds = [kind for kind, pattern in _IN_TEXTS.items() if pattern.search(plain)]
        if REFLECTANCE in kinds and kinds[0] not in _OF_REFLECTANCE:
            return Quantity(REFLECTANCE, text)
        others += [Quantity(kind, text) for kind in kinds[:1]]
    return others[0] if others else None


def name_quantities(names: Sequence[str]) -> list[Quantity | None]:
    """Return the quantities that the names of a file state as a set: K and S, n and k,
    A and D65, a name and its deviation, or all names the quantities of labels.

    >>> quantities = name_quantities(["ochre", "ochre std", "umber", "K"])
    >>> [quantity and quantity.kind.name for quantity in quantities]
    [None, 'standard deviation', None, None]
    """
    if all(map(label_quantity, names)):
        return list(map(label_quantity, names))
    texts = list(map(plain_text, names))
    kinds = _by_letters(texts)
    if _LIGHTS.fullmatch("".join(f"{text} " for text in texts)):
        kinds = [POWER] * len(texts)
    for index in _deviations(texts):
        kinds[index] = DEVIATION
    for index, text in enumerate(texts):
        if _IN_TEXTS[K_OVER_S].search(text):
            kinds[index] = K_OVER_S
    return [
        Quantity(kind, name) if kind else None
        for name, kind in zip(names, kinds, strict=True)
    ]


def _by_letters(texts: Sequence[str]) -> list[Kind | None]:
    """Return the quantities that single letters state with those that stand in their
    place in other names. C, M, Y and K are inks, and S alone is a sample.
    """
    letters = ["".join(_LETTER.findall(text)[:1]) for text in texts]
    places = [_LETTER.sub("", text, count=1) for text in texts]
    together = defaultdict[str, set[str]](set)
    for place, letter in zip(places, letters, strict=True):
        together[place].add(letter)
    return [
        None
        if letter in "Rr" or (len(together[place]) == 1 and texts != [letter])
        else _LETTERS.get("".join(sorted(together[place])))
        for place, letter in zip(places, letters, strict=True)
    ]


def _deviations(texts: Sequence[str]) -> Iterator[int]:
    """Yield the indices of names of deviations: 'std' next to a mean, but not next to a
    batch, and 'ochre std' next to 'ochre'.
    """
    spreads = [bool(_SPREADS.search(text)) for text in texts]
    if not any(spreads):
        return
    rests = list(map(_rest, texts))
    others = {rest for rest, spread in zip(rests, spreads, strict=True) if not spread}
    if others and not _BATCHES.search(" ".join(texts)):
        others.add("")
    for index, rest in enumerate(rests):
        if spreads[index] and rest in others:
            yield index


def _rest(text: str) -> str:
    """Return a name without words of means and deviations."""
    rest = _SPREADS.sub("", _MEANS.sub("", text))
    return re.sub(r"\W+", " ", rest).strip().casefold()


def value_quantity(
    nm: Iterable[float], values: Sequence[float] | Array
) -> Quantity | None:
    """Return the power of an illuminant if values (N,) at wavelengths (N,) in nm are
    100 at 560 nm, as those of the CIE, and exceed it elsewhere.
    """
    is_normalised = dict(zip(nm, values, strict=False)).get(560) == 100
    if is_normalised and np.nanmax(values) > 101:
        return Quantity(POWER, "100 at 560 nm")
    return None
