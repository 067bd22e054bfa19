"""Generated pages of docs/: a title, the circumstances, tables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from benchmarks.timing import ROOT
from uplift.lab.timing import environment


def write(
    name: str, introduction: str, sections: Iterable[str], where: Mapping[str, str] | None = None
) -> str:
    """Write docs/``name``.md and return it; ``where`` it was measured is by default here and now."""
    facts = "\n".join(f"- {key}: {value}" for key, value in (where or environment()).items())
    page = "\n".join([introduction, facts, *sections])
    (ROOT / "docs" / f"{name}.md").write_text(page, encoding="utf-8")
    return page


def table(title: str, words: str, head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A section with one Markdown table."""
    lines = [f"\n## {title}\n", words + "\n", _row(head), _row(["---"] * len(head)), *map(_row, rows)]
    return "\n".join(lines) + "\n"


def _row(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cells) + " |"
