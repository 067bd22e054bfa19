"""How many pixels of an image were changed, by the code of the warning about them."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from uplift.common.arrays import StrPath
from uplift.common.errors import UpliftWarning
from uplift.common.text import pluralise

BRIGHT = 10.0
"""Change of a component that makes lights of an image likely."""
LIGHTS = "if they are lights, convert them with an emission table"


@dataclass(frozen=True)
class Change:
    """Pixels that were changed.

    Parameters
    ----------
    pixels : int
        Their number.
    text : str
        What follows their number in a warning.
    largest : float
        Largest change of a component, if it is known.
    """

    pixels: int
    text: str
    largest: float = 0.0


@dataclass(frozen=True)
class Counts:
    """Numbers of pixels of an image; ``counts[code]`` is that of a warning.

    Parameters
    ----------
    pixels : int
        All pixels.
    changes : mapping of str to Change
        Changed pixels by the code of the warning about them.

    Examples
    --------
    >>> counts = Counts.of("pixels-not-finite", 2, "not finite") + Counts(5)
    >>> counts["pixels-not-finite"], counts["pixels-too-bright"]
    (2, 0)
    >>> print(counts.warnings()[0].problem)
    2 of 5 pixels not finite
    """

    pixels: int = 0
    changes: Mapping[str, Change] = field(default_factory=dict)

    @staticmethod
    def of(code: str, pixels: int, text: str, largest: float = 0.0) -> "Counts":
        """Count one kind of changed pixels; none if their number is 0."""
        if not pixels:
            return Counts()
        return Counts(changes={code: Change(int(pixels), text, largest)})

    def __getitem__(self, code: str) -> int:
        return self.changes[code].pixels if code in self.changes else 0

    def __add__(self, other: "Counts") -> "Counts":
        changes = dict(self.changes)
        for code, change in other.changes.items():
            before = changes.get(code, replace(change, pixels=0))
            changes[code] = replace(
                change,
                pixels=before.pixels + change.pixels,
                largest=max(before.largest, change.largest),
            )
        return Counts(self.pixels + other.pixels, changes)

    def warnings(self, path: StrPath | None = None) -> tuple[UpliftWarning, ...]:
        """Return a warning for every kind of changed pixels, which is not emitted.

        Parameters
        ----------
        path : path-like, optional
            The image, for the location of the warnings.

        Returns
        -------
        tuple of UpliftWarning
        """
        return tuple(
            UpliftWarning(
                f"{change.pixels:,} of {pluralise(self.pixels, 'pixel')} {change.text}"
                + (f" by up to {change.largest:.3g}" if change.largest else ""),
                code=code,
                path=path,
                hint=LIGHTS if change.largest > BRIGHT else "",
            )
            for code, change in self.changes.items()
        )
