"""The tables of docs/stability.md, from the figures in docs/stability/."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from benchmarks.page import table
from uplift.colorimetry.lights import NARROW_BAND_LIGHT
from uplift.lab.study.locality import MOVED_DELTA_E, NOISE
from uplift.lab.study.pointwise import EVALUATIONS, IN_MOMENTS, IN_MULTIPLIERS
from uplift.lab.study.stability import NO_ATLAS, UPLIFT
from uplift.lab.study.stability_design import COMPARED, SPACES

Row = Mapping[str, Any]
DIM, THRESHOLD = 17, 1e-4
SAID = {IN_MOMENTS: "scipy, in c, as the thesis", IN_MULTIPLIERS: "scipy, in p", UPLIFT: "ours"}


def summary(rows: Sequence[Row], cubes: Mapping[str, Any], constrained: str) -> str:
    """Inputs tried, failures found, what happens now."""
    ours = [row for row in rows if row["solver"] == UPLIFT]
    five = five_spaces_of(ours)
    loose = [row for row in ours if row["threshold"] >= THRESHOLD]
    strict = [row for row in ours if row["threshold"] < THRESHOLD]
    peers = [row for row in rows if row["solver"] == IN_MOMENTS]
    lines = [
        ["five RGB spaces, 17³, both models, threshold 1e-4", *_tried(five), "every one is fitted"],
        ["failure map, thresholds 1e-2 to 1e-4", *_tried(loose), _now(loose, "unfitted")],
        ["failure map, thresholds 1e-5 and 1e-6", *_tried(strict), _now(strict, "unfitted")],
        ["stand-ins of unrealisable points, the same", *_stand_ins(strict), _now(strict, "stand_ins")],
        ["the thesis's solver, sRGB", *_tried(peers), "not used: for comparison alone"],
        *_sensitive(cubes, constrained),
    ]
    return table(
        "What was tried, what failed, what happens now",
        "Points are lattice points of a colour that some reflectance has (`uplift.colorimetry.solid`); one fails whose stored "
        "spectrum misses its colour by more than the threshold.",
        ["inputs", "tried", "failures", "what happens now"],
        lines,
    )


def _tried(rows: Sequence[Row]) -> list[str]:
    failed = sum(row["unfitted"] > 0 for row in rows)
    points = f"{len(rows)} builds, {sum(row['realisable'] for row in rows):,} points"
    found = sum(row["unfitted"] for row in rows)
    return [points, f"{found} points in {failed} builds" if found else "none"]


def _now(rows: Sequence[Row], what: str) -> str:
    if not any(row[what] for row in rows):
        return "every one is fitted"
    return "they keep the nearest spectrum found, the cube calls them *unfitted*, `uplift build` counts them"


def _stand_ins(rows: Sequence[Row]) -> list[str]:
    failed = [row for row in rows if row["stand_ins"]]
    points = sum(row["points"] - row["realisable"] for row in rows)
    found = f"{sum(row['stand_ins'] for row in failed)} points in {len(failed)} builds" if failed else "none"
    return [f"{len(rows)} builds, {points:,} points", found]


def _sensitive(cubes: Mapping[str, Any], constrained: str) -> list[list[str]]:
    count = len(cubes) * 3
    most = max(
        move["light_most"] for cube in cubes.values() for move in cube["moves"] if move["step"] == "1e-7"
    )
    changes = cubes[constrained]["changes"]
    alone = [one for one in changes if one["rgb_radius"] is not None]
    far = max(one["lab_radius"] for one in alone)
    return [
        [
            "queries moved by 1e-7, all modes",
            f"{count} × 4,096 colours",
            "none",
            f"no answer moves by more than ΔE00 {most:.1g} under {NARROW_BAND_LIGHT}",
        ],
        [
            "one entry left out or wrong",
            f"{len(alone)} builds",
            "none",
            f"at most {max(one['moved'] for one in alone):.2%} of the lattice points move by ΔE00 {MOVED_DELTA_E:g}, "
            f"none of them farther than ΔE\\*ab {far:.0f} from the entry",
        ],
    ]


def five_spaces_of(rows: Iterable[Row]) -> list[Row]:
    """No atlas, 17³, threshold 1e-4, in every space."""
    return [
        row
        for row in rows
        if (row["dim"], row["threshold"], row["atlas"], row["solver"]) == (DIM, THRESHOLD, NO_ATLAS, UPLIFT)
    ]


def five_spaces(rows: Sequence[Row]) -> str:
    found = {(row["space"], technique(row)): row for row in five_spaces_of(rows)}
    techniques = list(dict.fromkeys(name for _, name in found))
    lines = []
    for space in SPACES:
        held = [found[space, name] for name in techniques]
        cells = [f"{row['unfitted']} / {row['worst']:.0e}" for row in held]
        lines.append([space, f"{held[0]['realisable']:,} of {held[0]['points']:,}", *cells])
    return table(
        "Five spaces at dim 17",
        f"Realisable points over the threshold of {THRESHOLD:g} / the largest distance of one, max |linear RGB|, by "
        "model and coefficients.",
        ["space", "realisable", *techniques],
        lines,
    )


def peers(rows: Sequence[Row]) -> str:
    dims = {row["dim"] for row in rows if row["solver"] != UPLIFT}
    chosen = [row for row in rows if row["dim"] in dims and row["coefficients"] in COMPARED]
    lines = []
    for dim in sorted(dims):
        for solver in SAID:
            for count in COMPARED:
                for row in chosen:
                    key = (row["dim"], row["solver"], row["coefficients"], row["model"], row["space"])
                    plain = (row["threshold"], row["atlas"]) == (THRESHOLD, NO_ATLAS)
                    if plain and key == (dim, solver, count, "moments", SPACES[0]):
                        lines.append(_peer(row))
    return table(
        "What the multipliers buy",
        "The same lattice, sRGB without an atlas, by scipy's trust-region least squares on three residuals with "
        "central differences, growing from the middle, each point from fitted neighbours, as the thesis (3.1.3) does "
        f"with Ceres, at most {EVALUATIONS} evaluations from a start; its nudges are left out. *calls* are starts "
        "beyond the first of a point; ours has none.",
        ["dim", "solver", "coefficients", "fitted", "worst", "at (RGB)", "calls", "ms a point"],
        lines,
    )


def _peer(row: Row) -> list[str]:
    return [
        f"{row['dim']}³",
        SAID[row["solver"]],
        str(row["coefficients"]),
        f"{row['success']:.1%}",
        f"{row['worst']:.0e}",
        _where(row),
        str(row["calls"]),
        f"{1e3 * row['seconds'] / row['points']:.1f}",
    ]


def failures(rows: Sequence[Row]) -> str:
    """Every build of ours that left a point."""
    failed = sorted(
        (row for row in rows if (row["unfitted"] or row["stand_ins"]) and row["solver"] == UPLIFT),
        key=lambda row: (-row["threshold"], row["space"], row["dim"], row["coefficients"]),
    )
    lines = [
        [
            row["space"],
            f"{row['threshold']:.0e}",
            technique(row),
            f"{row['dim']}³",
            row["atlas"],
            f"{row['unfitted']} of {row['realisable']}",
            f"{row['worst']:.0e}",
            _where(row),
            str(row["stand_ins"]),
        ]
        for row in failed
    ]
    return table(
        "Builds that left points or stand-ins unfitted",
        f"All {len(failed)} of {sum(row['solver'] == UPLIFT for row in rows)}. *stand-ins* are unrealisable "
        "points whose nearest realisable colour, half the threshold within the boundary, was missed as well.",
        ["space", "threshold", "model", "dim", "atlas", "unfitted", "worst", "at (RGB)", "stand-ins"],
        lines or [["none", *[""] * 8]],
    )


def moves(cubes: Mapping[str, Any], shown: Sequence[str]) -> str:
    lines = []
    for name in shown:
        for move in cubes[name]["moves"]:
            rest = [
                f"{move[f'{what}_mean']:.1e} / {move[f'{what}_most']:.1e}" for what in ("rms", "light", "own")
            ]
            lines.append([name, move["mode"], move["step"], *rest])
    return table(
        "Queries moved",
        "4,096 colours, even over 8-bit codes, every channel moved up or down by a code of 8 bits, of 10 bits, or by "
        f"float rounding: mean / most of the rms change of the answer, of its ΔE00 under {NARROW_BAND_LIGHT}, and under the build "
        "light, of which the question is the cause.",
        ["cube", "mode", "moved by", "rms", f"ΔE00, {NARROW_BAND_LIGHT}", "ΔE00, D65"],
        lines,
    )


def lipschitz(cubes: Mapping[str, Any]) -> str:
    lines = []
    for name, record in cubes.items():
        steep = record["lipschitz"]
        box = steep["largest_box"]
        where = ", ".join(f"{value:.3f}" for value in steep["steepest_cell"])
        lines.append(
            [
                name,
                f"{steep['largest']:.3g}",
                f"{steep['median_cell']:.2f}",
                "" if box is None else f"{box:.3g}",
                f"({where})",
                f"{steep['steepest_wavelength']:g} nm",
                f"{steep['largest_per_code']:.3f}",
                f"{steep['median_per_code']:.4f}",
            ]
        )
    return table(
        "How steep a cube is",
        "The Lipschitz constant of mode `spectra`: rms change of reflectance per unit of linear RGB (Euclidean), of "
        "the whole cube, of the middle cell, of the steepest box of an entry; the lowest corner of the steepest "
        "cell, the wavelength that changes fastest anywhere; and per 8-bit code, most and middle of the cells.",
        [
            "cube",
            "Lipschitz",
            "median cell",
            "box",
            "steepest cell",
            "wavelength",
            "per code",
            "median",
        ],
        lines,
    )


def changes(record: Mapping[str, Any], name: str) -> str:
    groups: dict[str, Callable[[str], bool]] = {
        f"noise of {NOISE:g} on all entries": lambda what: what.startswith("noise"),
        "one entry read from the wrong end": lambda what: what.endswith("wrong"),
        "one entry left out": lambda what: what.endswith("left out"),
    }
    lines = []
    for title, belongs in groups.items():
        held = [one for one in record["changes"] if belongs(one["change"])]
        worst = max(held, key=lambda one: one["moved"])
        radii = [
            "" if worst[key] is None else f"{max(one[key] for one in held):.{digits}f}"
            for key, digits in (("rgb_radius", 2), ("lab_radius", 0))
        ]
        lines.append(
            [
                title,
                str(len(held)),
                f"{sum(one['moved'] for one in held) / len(held):.2%}",
                f"{worst['moved']:.2%} ({worst['change']})",
                *radii,
                f"{max(one['delta_e_most'] for one in held):.1f}",
                f"{max(one['rms_mean'] for one in held):.1e}",
            ]
        )
    return table(
        "An atlas a little different",
        f"{name} built anew, lattice points before and after: the share that moves by more than "
        f"ΔE00 {MOVED_DELTA_E:g} under {NARROW_BAND_LIGHT}, mean and most over the builds; how far from the entry the farthest of them lies; "
        "the largest move; the largest mean rms change.",
        [
            "change",
            "builds",
            "moved",
            "most moved",
            "RGB radius",
            "ΔE\\*ab radius",
            "largest ΔE00",
            "mean rms",
        ],
        lines,
    )


def technique(row: Row) -> str:
    return row["model"] if row["model"] == "sigmoid" else f"{row['model']} {row['coefficients']}"


def _where(row: Row) -> str:
    return f"({row['r']:.3f}, {row['g']:.3f}, {row['b']:.3f})"
