"""Random mutation of seeds, and runs of a target with many inputs under limits of time
and memory.
"""

import functools
import re
import resource
import shutil
import signal
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np

from uplift.common.errors import UpliftError, UpliftWarning
from uplift.common.text import printable

ROOT = Path(__file__).parents[2]
SECONDS = 5.0
"""Limit of processor time per input. Valid inputs take milliseconds."""
MEGABYTES = 2048
"""Limit of address space in addition to that of the process at the start; the libraries
of images take half of it.
"""
Random = np.random.Generator
Seeds = tuple[bytes, ...]

NUMBERS = (
    b"nan", b"inf", b"-inf", b"-1", b"0", b"-0.0", b"1e999", b"1_000", b"0x10", b"1,5",
    b"1e308", b"5e-324", b"4294967296", b"18446744073709551616", b"9" * 400,
    b"\xd9\xa3", b"",
)  # fmt: skip
HOSTILE = (
    *NUMBERS, b"\0", b"\0" * 999, b"\xff\xfe", b"\xff" * 4, b"\1\0\0\0",
    b"\xef\xbb\xbf", b"\xe2\x80\xa8", b"\r", b"\n" * 999, b"\t", b"," * 999,
    b'"' * 999, b"[" * 100_000, b'{"a":' * 20_000, b"a." * 2000, b"a" * 200_000,
    b"0" * 70_000, b"\\ud800", b"null", b"true", b"<a>" * 99,
    b"<!DOCTYPE a>", b"<!ENTITY a 'b'>", b"&a;", b"PK\x03\x04", b"\x1b]52;c;\7",
)  # fmt: skip
"""Texts that parsers of any format may mishandle."""
WORD = re.compile(rb"[A-Za-z][\w-]{2,}|[^\w\0-\x08\x0e-\x1f\x7f-\xff]")
"""Words of three letters or more, signs and blanks."""
NUMBER = re.compile(rb"[0-9.+-]+(?:[eE][0-9+-]+)?")


@dataclass(frozen=True)
class Target:
    """A reader under test: ``generate`` writes an input, ``use`` reads it and may raise
    `UpliftError` alone.
    """

    name: str
    generate: Callable[[Random, Path], object]
    use: Callable[[Path], object]


class HangError(BaseException):
    """An input exceeded its time. Not an `Exception`, so that no handler of the target
    catches it.
    """


def choose(random: Random, items: Sequence[Any]) -> Any:
    """Return one of the items."""
    return items[random.integers(len(items))]


@functools.cache
def _words(seeds: Seeds) -> Seeds:
    return tuple(sorted(set(WORD.findall(b"\n".join(seeds)))))


def mutate(content: bytes, random: Random, seeds: Seeds) -> bytes:
    """Replace one to eight parts of ``content``, with words from the ``seeds`` of the
    format, numbers, other parts or random bytes.
    """
    words = _words(seeds)
    for _ in range(int(random.integers(1, 9))):
        first, other = map(int, random.integers(len(content) + 1, size=2))
        length = int(2 ** random.uniform(0, 8))
        number = NUMBER.search(content, first)
        word = WORD.search(content, first)
        spans = [
            (first, first),
            (first, first + 1),
            (first, first + length),
            (first, len(content) if random.random() < 0.2 else first),
            number.span() if number else (0, 0),
            word.span() if word else (0, 0),
        ]
        parts = [
            b"",
            choose(random, words),
            choose(random, HOSTILE),
            choose(random, NUMBERS),
            content[other : other + length],
            random.bytes(1),
        ]
        kind = int(random.integers(len(spans)))
        start, end = spans[kind]
        part = choose(random, NUMBERS if kind == 4 else parts)
        content = content[:start] + part + content[end:]
    return content


def mutated(
    name: str, use: Callable[[Path], object], make_seeds: Callable[[], Seeds]
) -> Target:
    """Make a target of mutated seeds, of which one in twenty stays as it is."""

    def generate(random: Random, path: Path) -> None:
        content = choose(random, make_seeds())
        if random.random() >= 0.05:
            content = mutate(content, random, make_seeds())
        path.write_bytes(content)

    return Target(name, generate, use)


def fuzz(
    target: Target, seed: int, inputs: range, folder: Path, kept: Path
) -> Counter[str]:
    """Run a target with numbered inputs, written to ``folder``; copy the first of each
    kind of failure to ``kept``.

    Returns the numbers of inputs that were ``accepted`` and ``rejected``, and of each
    kind of failure.
    """

    def interrupt(number: int, frame: FrameType | None) -> None:
        raise HangError(f"more than {SECONDS:g} s")

    tally: Counter[str] = Counter()
    path = folder / "input"
    _limit_memory()
    previous = signal.signal(signal.SIGPROF, interrupt)
    try:
        for number in inputs:
            with warnings.catch_warnings(action="ignore"):
                target.generate(np.random.default_rng([seed, number]), path)
            outcome = _outcome(target, path)
            tally[outcome] += 1
            if outcome not in ("accepted", "rejected") and tally[outcome] == 1:
                name = target.name.replace(" ", "-")
                shutil.copy(path, kept / f"{name}-{seed}-{number}")
    finally:
        signal.signal(signal.SIGPROF, previous)
    return tally


def _outcome(target: Target, path: Path) -> str:
    """Use one input; return "accepted", "rejected" or a description of the failure."""
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # warnings of numpy show missing validation
            warnings.simplefilter("ignore", UpliftWarning)
            target.use(path)
    except UpliftError as error:
        if printable(str(error)) != str(error):
            return "a message of several lines, or with control characters"
        return "rejected"
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        frame = traceback.extract_tb(error.__traceback__)[-1]
        return (
            f"{type(error).__name__} in {Path(frame.filename).name}, {frame.name}: "
            f"{str(error)[:80]}"
        )
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    return "accepted"


def _limit_memory() -> None:
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    limit = pages * resource.getpagesize() + (MEGABYTES << 20)
    resource.setrlimit(
        resource.RLIMIT_AS, (limit, resource.getrlimit(resource.RLIMIT_AS)[1])
    )
