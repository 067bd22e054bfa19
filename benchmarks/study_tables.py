"""The tables of docs/moments.md: what was found, beside appendix B.1 of Tódová 2020."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Mapping

from benchmarks.page import table
from benchmarks.timing import ROOT
from uplift.colorimetry.lights import REPORT_LIGHTS
from uplift.lab.study.moments import MEASURES, MomentsResult, MomentsStudy
from uplift.lab.study.technique import TECHNIQUES, Technique

THESIS = ROOT / "tests" / "reference" / "moments_todova2020.csv"
STORED = (3, 5, 9, 13, 16)
Pair = tuple[float, float]
Thesis = Mapping[tuple[Technique, int], Pair]
"""Mean and largest ΔE by technique and moments."""


def read_thesis() -> Thesis:
    """Mean and largest ΔE of appendix B.1."""
    by_short = {technique.short: technique for technique in TECHNIQUES}
    with THESIS.open(encoding="utf-8") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return {
            (by_short[row["method"]], int(row["moments"])): (float(row["mean"]), float(row["max"]))
            for row in rows
        }


def within(technique: Technique, floats: int) -> int:
    """The most moments that fit into so many floats."""
    return floats - 1 if technique.mirrored else (floats - 1) // 2


def winners(found: MomentsStudy, thesis: Thesis) -> str:
    def ours(technique: Technique, count: int) -> Pair:
        result = found.of(technique, count)
        return float(result.mean[0]), float(result.most[0])

    rows = []
    for floats in STORED:
        cells = [str(floats)]
        for source in (ours, lambda technique, count: thesis[technique, count]):
            for side in (0, 1):
                cells.append(_best(source, floats, side))
        rows.append(cells)
    return table(
        "Which technique is best",
        "For so many floats stored per spectrum; M is mirrored, W warped, n not. Unmirrored moments are complex, "
        "so that an even number of floats leaves one unused.",
        ["floats", "mean", "largest", "thesis: mean", "thesis: largest"],
        rows,
    )


def _best(source: Callable[[Technique, int], Pair], floats: int, side: int) -> str:
    values = {technique: source(technique, within(technique, floats))[side] for technique in TECHNIQUES}
    best = min(values, key=values.__getitem__)
    return f"{best.short} {values[best]:.2f}"


def by_moments(found: MomentsStudy, thesis: Thesis) -> str:
    def row(count: int) -> Iterable[str]:
        yield str(count)
        for technique in TECHNIQUES:
            result = found.of(technique, count)
            yield f"{result.mean[0]:.2f} / {result.most[0]:.2f}"
            yield "{:.2f} / {:.2f}".format(*thesis[technique, count])

    head = [title for technique in TECHNIQUES for title in (technique.short, "thesis")]
    return table(
        "Appendix B.1, ours and the thesis's",
        "Mean / largest ΔE76 under D65. n moments take n + 1 floats mirrored (M), 2n + 1 unmirrored (nM).",
        ["moments", *head],
        [list(row(count)) for count in range(found.most + 1)],
    )


def by_warp(found: Mapping[str, MomentsStudy], thesis: Thesis) -> str:
    """Studies that differ in what the warp is, by its name."""
    counts, technique = range(1, 9), TECHNIQUES[0]
    rows = []
    for name, one in found.items():
        results = [one.of(technique, count) for count in counts]
        rows.append([name, *(f"{result.mean[0]:.2f} / {result.most[0]:.2f}" for result in results)])
    rows.append(["thesis", *("{:.2f} / {:.2f}".format(*thesis[technique, count]) for count in counts)])
    return table(
        "How much the warp decides",
        "Mirrored and warped, all entries, mean / largest ΔE76 under D65, by the floats stored: with our warp, with "
        "warps made for this table, given by their density over wavelength, and in the thesis. The fitted one has "
        "the least mean at 3 floats that Powell's method finds; it was fitted to the entries it is judged by.",
        ["warp", *(str(count + 1) for count in counts)],
        rows,
    )


def lights(found: MomentsStudy) -> str:
    rows = []
    for floats in STORED:
        for technique in TECHNIQUES:
            result = found.of(technique, within(technique, floats))
            pairs = list(zip(result.mean, result.most, strict=True))[1:]
            cells = [f"{mean:.2f} / {most:.2f}" for mean, most in pairs[:-1]]
            rows.append([str(floats), technique.short, *cells, "{:.4f} / {:.4f}".format(*pairs[-1])])
    return table(
        "Other lights",
        "Mean / largest ΔE00 under each light, and rms difference of the spectra at 5 nm.",
        ["floats", "", *REPORT_LIGHTS, MEASURES[-1]],
        rows,
    )


def by_atlas(found: MomentsStudy) -> str:
    rows = []
    for group in found.groups:
        cells = [group, str(len(found.rows(group)))]
        for technique in TECHNIQUES:
            result = found.of(technique, within(technique, 9), group)
            cells.append(f"{result.mean[0]:.2f} / {result.most[0]:.2f}")
        rows.append(cells)
    head = ["atlas", "entries", *(technique.short for technique in TECHNIQUES)]
    return table("Every atlas, 9 floats", "Mean / largest ΔE76 under D65.", head, rows)


def worst(found: MomentsStudy) -> str:
    def cell(result: MomentsResult) -> str:
        return f"{found.names[result.worst]} ({found.atlases[result.worst]}) {result.most[0]:.2f}"

    rows = []
    for floats in STORED:
        results = [found.of(technique, within(technique, floats)) for technique in TECHNIQUES]
        rows.append([str(floats), *map(cell, results)])
    head = ["floats", *(technique.short for technique in TECHNIQUES)]
    return table("The worst entries", "By ΔE76 under D65.", head, rows)
