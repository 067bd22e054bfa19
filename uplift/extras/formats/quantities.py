"""Table of the quantities of spectra, by which all readers accept, convert, leave out
or refuse them, and the quantity that a text, names or values state.
"""

import re
import unicodedata
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

READ = "read"
REFUSED = "refused"
LEFT_OUT = "left out"
DIVIDED = "read, divided by the wavelength"
ASSUMED_POWER = "read as power, with a warning"
USED = (READ, DIVIDED, ASSUMED_POWER)


class Kind(NamedTuple):
    """A row of the table: a quantity, what becomes of it in an atlas and as a lamp, how
    files write it, what it is called in any text and what only in labels, and a hint.

    Patterns are of texts as `plain_text` has them.
    """

    name: str
    in_atlas: str
    as_lamp: str
    examples: str
    words: re.Pattern[str]
    labels: re.Pattern[str]
    hint: str = "measure the reflectance, or correct the statement if it is wrong"

    def is_used(self, *, lamps: bool) -> bool:
        """Whether lamps, or the entries of an atlas, have it."""
        return (self.as_lamp if lamps else self.in_atlas) in USED


def _any(*patterns: str) -> re.Pattern[str]:
    return re.compile("|".join(patterns))


_NOTHING = _any("(?!)")
_OF_LIGHT = "it is read by read_lamps(): an atlas holds reflectances"
_POWER_OF_TEN = (
    "the reflectance is 10 to the power of −D: convert, if D is of reflection"
)
_METER_KEYS = (
    "lux|lx|fc|foot-?candles?|cct|tcp|duv|cri|ra|ppfd|pfd(?:-[a-z]+)?|ppf|tlci|lumens?"
    "|lm|colou?r temperature"
)
REFLECTANCE = Kind(
    "reflectance", READ, REFUSED, "Reflectance, R [%], Remission, Reflexionsgrad",
    _any(
        "refl", "remission", "remittance", "albedo", "radiance factor", r"\br-factor",
        r"\brfl\b", r"%r\b", r"\br ?[\[(]?%",
    ),
    _NOTHING,
)  # fmt: skip
DEVIATION = Kind(
    "standard deviation", LEFT_OUT, LEFT_OUT, "Std Dev, SD, ochre std, uncertainty, σ",
    _NOTHING,
    _any(
        r"\bst(?:d|andard)?[ .]*(?:dev|err)", r"refl.*\b(?:std|sd)\b", "uncertaint",
        r"\bvariance\b", r"\A\W*σ\W*\Z",
    ),
)  # fmt: skip
K_OVER_S = Kind(
    "K/S", REFUSED, REFUSED, "K/S, KS, F(R), Kubelka-Munk",
    _any(r"\bk ?/ ?s\b", "kubelka", r"\bf ?\(r"), _any(r"\bks\b", r"\A\W*k[ -]s\W*\Z"),
    "an opaque layer has the reflectance 1 + K/S − √((K/S)² + 2 K/S): convert",
)  # fmt: skip
COEFFICIENT = Kind(
    "absorption or scattering", REFUSED, REFUSED,
    "the columns K and S, K_ochre and S_ochre, absorption, scattering coefficient, µa",
    _any(
        "absor(?:ption|ptivity)", "scattering coeff", "extinction", r"\battenuation",
        r"\b(?:mu ?|μ)[as]'?(?!\w)",
    ),
    _any(r"\bscatter"),
    "an opaque layer has the reflectance 1 + K/S − √((K/S)² + 2 K/S): convert",
)  # fmt: skip
REFRACTION = Kind(
    "refractive index", REFUSED, REFUSED, "the columns n and k, refractive index",
    _NOTHING, _any("refracti(?:ve|on)", "permittivity", "dielectric"),
)  # fmt: skip
SENSITIVITY = Kind(
    "sensitivity of an observer or a camera", REFUSED, REFUSED,
    "x_bar, x̄(λ), the columns X, Y and Z, cmf, V(λ), responsivity",
    _any("colou?r[ -]matching func"),
    _any(
        r"\b[xyzlms][ -]?bar\b", r"colou?r[ -]matching", r"\bcmfs?\b", "photopic",
        "scotopic", "luminous efficiency", r"\bv ?\(?(?:lambda|λ)", "sensitivit",
        "responsivit", "quantum efficiency", r"\bcie (?:xyz|lms|sle|cc)\b",
    ),
    "an observer is a name, as those that tables.names('observer') lists",
)  # fmt: skip
PHOTONS = Kind(
    "photon flux", REFUSED, DIVIDED, "Photon flux (µmol m-2 s-1 nm-1), quanta, PPFD",
    _any(
        "photon", r"\bquanta\b", "quantum (?:flux|irradiance)", r"\b[μunm]mol\b",
        "micromol", r"\bμe\b",
    ),
    _any(r"\bp?pfd\b", r"\bppf\b"),
    _OF_LIGHT,
)  # fmt: skip
LIGHT = Kind(
    "measurement of a light", REFUSED, ASSUMED_POWER, "keys: LUX 250, CCT: 3050, CRI",
    _any(
        rf"\A\W*(?:{_METER_KEYS}) ?(?:[([][^)\]]*[)\]])? ?[:=,;]? ?"
        r"(?:[+-]?[\d.,]+ ?\S*)?\W*\Z",
        "illuminance", "luminance(?! factor)", "luminous (?:flux|intensity)",
        r"\bcd/m",
    ),
    _NOTHING, _OF_LIGHT,
)  # fmt: skip
POWER = Kind(
    "spectral power", REFUSED, READ,
    "Irradiance, Radiance, W/m²/nm, SPD, power, illuminant, the columns A and D65",
    _any(
        "irradiance", "radiance(?! factor)", "radiant", r"\brad\b", "exitance",
        "emissi(?:on|ve)", "emittance", r"\bspd\b", "(?:spectral|relative) power",
        "spectral flux", r"\b[μmnku]?w(?:atts?)?[ /·*(]*(?:sr|nm|c?m ?\^?[−-]?[23])",
        r"\Accss\b", r"\Adevice class\W+display",
    ),
    _any(r"\billum(?:inants?)?\b", r"\A\W*power(?:\W*\Z|\W*[(\[/,])"), _OF_LIGHT,
)  # fmt: skip
OTHER = Kind(
    "another quantity", REFUSED, REFUSED, "other YUNITS of JCAMP-DX", _NOTHING, _NOTHING
)

QUANTITIES = (
    DEVIATION,
    K_OVER_S,
    PHOTONS,
    Kind(
        "correction matrix of a colorimeter", REFUSED, REFUSED, "CCMX",
        _any(r"\Accmx\b"), _NOTHING,
    ),
    Kind(
        "optical density", REFUSED, REFUSED, "Density, OD, optical density",
        _any("(?:optical|reflection|reflective|visual) density"),
        _any(
            r"(?<!flux )(?<!power )(?<!spectral )(?<!low )(?<!high )(?<!medium )"
            r"\bdensit(?:y|ies)\b",
            r"\A\W*o\.?d\W*\d*\W*\Z",
        ),
        _POWER_OF_TEN,
    ),
    Kind(
        "absorbance", REFUSED, REFUSED, "Absorbance, Abs 400, absorptance, log(1/R)",
        _any("absor(?:bance|ptance)", "log ?(?:10)? ?[({]? ?1 ?/ ?r"),
        _any(r"\A\W*abs\W*\d*\W*\Z"), _POWER_OF_TEN,
    ),
    COEFFICIENT,
    REFRACTION,
    SENSITIVITY,
    Kind(
        "transmittance", REFUSED, REFUSED, "Transmittance, %T, T400, t-factor, τ",
        _any("transmi(?:ttance|ssion|ssive|ssivity)", "t-factor"),
        _any(
            r"\A\W*(?:%?\W*t\W*%\W*|%\W*t|t ?\d{3,4}(?:\D.*)?|trans|t ?nm.*|τ.*)\W*\Z"
        ),
    ),
    Kind(
        "emissivity", REFUSED, REFUSED, "Emissivity", _any("emissivity"), _NOTHING
    ),
    Kind(
        "fluorescence", REFUSED, REFUSED, "Fluorescence", _any("fluorescence"),
        _NOTHING,
    ),
    Kind("BRDF", REFUSED, REFUSED, "BRDF [1/sr]", _any(r"\bbrdf\b"), _NOTHING),
    REFLECTANCE,
    Kind(
        "counts", REFUSED, ASSUMED_POWER, "Counts, raw counts, DN, digital numbers",
        _any(r"\bcounts?\b(?!\W*\d)", "digital numbers?"),
        _any(r"\A\W*(?:dns?|adu|raw)\W*\Z"), _OF_LIGHT,
    ),
    POWER,
    LIGHT,
    OTHER,
)  # fmt: skip
"""All quantities. Of several that a label names the first counts."""


@dataclass(frozen=True)
class Quantity:
    """A quantity that a file states, in the words of ``text``."""

    kind: Kind
    text: str


def _without_accents(text: str) -> str:
    """Return a text with blanks for underscores, and plain digits and letters.

    >>> _without_accents("x̄_10 [µW/cm²]")
    'x 10 [μW/cm2]'
    """
    decomposed = unicodedata.normalize("NFKD", text.replace("_", " "))
    return "".join(
        character for character in decomposed if not unicodedata.combining(character)
    )


def plain_text(text: str) -> str:
    """Return a text as the patterns of the table have it."""
    return _without_accents(text).casefold()


def label_quantity(text: str) -> Quantity | None:
    """Return the quantity that the label of values states, None if it states none.

    >>> quantities = map(label_quantity, ("%T", "R [%]", "SPD", "ochre"))
    >>> [quantity and quantity.kind.name for quantity in quantities]
    ['transmittance', 'reflectance', 'spectral power', None]
    """
    plain = plain_text(text)
    for kind in QUANTITIES:
        if kind.words.search(plain) or kind.labels.search(plain):
            return Quantity(kind, text)
    return None


def remark_quantity(texts: Iterable[str]) -> Quantity | None:
    """Return reflectance if a line of text states it, else the first other quantity
    that one states. A line about K/S may name the reflectance that it comes from.
    """
    others = list[Quantity]()
    for text in texts:
        plain = plain_text(text)
        if LIGHT.words.match(plain):
            others.append(Quantity(LIGHT, text))
            continue
        found = [kind for kind in QUANTITIES if kind.words.search(plain)]
        if REFLECTANCE in found and K_OVER_S not in found:
            return Quantity(REFLECTANCE, text)
        others += [Quantity(kind, text) for kind in found[:1]]
    return others[0] if others else None


def is_photometric(text: str) -> bool:
    """Whether a label is a key of light meters, such as 'CCT (K)'."""
    return bool(LIGHT.words.match(plain_text(text)))


_WORD = re.compile(r"[^\W\d]+|\d+")
_SPREADS = frozenset(("std", "sd", "se", "sem", "sigma", "σ", "err", "error"))
"""Words of deviations next to what they are of. 'Std' is a standard, too."""
_MEANS = frozenset(("mean", "avg", "average", "r", "refl", "reflectance", "value"))
_BATCHES = frozenset(("batch", "bat", "trial", "smp", "lot"))
"""What is compared with a standard."""
_SETS = (
    ("KS", "", COEFFICIENT),
    ("ks", "", COEFFICIENT),
    ("n", "k", REFRACTION),
    ("xyz", "", SENSITIVITY),
    ("XYZ", "", SENSITIVITY),
)
"""Letters that state a quantity as a set: those that it has, and another that it may
have. C, M, Y and K are inks, and S alone is a sample.
"""
_BESIDE = frozenset("RTrt")
"""Letters of reflectance and transmittance."""
_ILLUMINANTS = re.compile(
    r"[ABCE]|D(50|55|60|65|75|93)|FL?\d{1,2}(\.\d+)?|HP\d|ID\d\d|LED-?\w+"
)
_SURE = re.compile(r"D(50|55|65|75)|FL.*|HP.*|ID.*|LED.*")
_WATTS = re.compile(r"[mµμ]?W(atts?)?")


def name_quantities(names: Sequence[str]) -> list[Quantity | None]:
    """Return the quantities that the names of a file state as a set.

    >>> quantities = name_quantities(["ochre", "ochre std", "umber", "K"])
    >>> [quantity and quantity.kind.name for quantity in quantities]
    [None, 'standard deviation', None, None]
    """
    words = [_WORD.findall(_without_accents(name)) for name in names]
    kinds: dict[int, Kind] = dict(_letters(words))
    kinds |= dict.fromkeys(_deviations(names, words), DEVIATION)
    named = [name for index, name in enumerate(names) if index not in kinds]
    are_lights = all(map(_ILLUMINANTS.fullmatch, named)) and any(
        map(_SURE.fullmatch, named)
    )
    if named and (are_lights or all(map(_WATTS.fullmatch, named))):
        kinds = dict.fromkeys(range(len(names)), POWER) | kinds
    return [
        Quantity(kinds[index], name) if index in kinds else None
        for index, name in enumerate(names)
    ]


def _deviations(names: Sequence[str], words: Sequence[Sequence[str]]) -> Iterator[int]:
    """Yield the indices of names of deviations: 'std' next to a mean, 'ochre std' next
    to 'ochre'.
    """
    lower = [frozenset(map(str.casefold, parts)) for parts in words]
    rests = [parts - _SPREADS - _MEANS for parts in lower]
    others = [
        rest for parts, rest in zip(lower, rests, strict=True) if not parts & _SPREADS
    ]
    has_standard = any(parts & _BATCHES for parts in lower)
    for index, (parts, rest) in enumerate(zip(lower, rests, strict=True)):
        is_beside = rest in others if rest else bool(others) and not has_standard
        if DEVIATION.labels.search(plain_text(names[index])) or (
            parts & _SPREADS and is_beside
        ):
            yield index


def _letters(words: Sequence[Sequence[str]]) -> Iterator[tuple[int, Kind]]:
    """Yield the indices of names that begin or end with a letter of a set, and its
    quantity; the rests of the names are equal.
    """
    groups = defaultdict[tuple[str, ...], dict[int, str]](dict)
    for index, parts in enumerate(words):
        for letter, rest in ((parts[:1], parts[1:]), (parts[-1:], parts[:-1])):
            if len("".join(letter)) == 1 and not _MEANS & set(map(str.casefold, rest)):
                groups[tuple(rest)][index] = letter[0]
    for rest, letters in groups.items():
        found = set(letters.values()) - _BESIDE
        for needed, other, kind in _SETS:
            if set(needed) <= found <= {*needed, *other} and (
                not rest or len(found) > 1
            ):
                for index, letter in letters.items():
                    if letter in found:
                        yield index, kind


def value_quantity(nm: ArrayLike, values: ArrayLike) -> Quantity | None:
    """Return the power of an illuminant if values (N,) at wavelengths (N,) in nm are
    100 at 560 nm, as those of the CIE, and exceed it elsewhere.
    """
    values = np.asarray(values, dtype=float)
    normalised = values[np.asarray(nm) == 560]
    if (normalised == 100).any() and (values > 101).any():
        return Quantity(POWER, "100 at 560 nm")
    return None
