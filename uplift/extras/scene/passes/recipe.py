"""Recipes that decode passes in compositors: matrices, nodes of Nuke, and a script of
Blender.
"""

from collections.abc import Callable, Mapping
from importlib.resources import files

import numpy as np

from uplift.common.arrays import Array
from uplift.extras.scene.passes.decoder import Decoder

DIGITS = 7


def pass_matrices(decoder: Decoder) -> list[Array]:
    """Return the matrix (3, 3) of each pass; their results are added."""
    return np.split(decoder.matrix, decoder.passes.count, axis=1)


def plain_recipe(decoder: Decoder) -> str:
    """Write the matrices as text.

    Parameters
    ----------
    decoder : Decoder
        Made by `uplift.extras.scene.passes.decoder`.

    Returns
    -------
    str
        A matrix for each pass. The sum of the results is the picture.
    """
    lines = []
    for number, matrix in enumerate(pass_matrices(decoder), 1):
        lines.append(f"pass {number}: matrix from (R, G, B) of the picture")
        for channel, row in zip(decoder.channels, matrix, strict=True):
            lines.append(f"  {channel} = {_sum(row)}")
    lines.append("The decoded picture is the sum of the results of all passes.")
    return "\n".join(lines) + "\n"


def _sum(row: Array) -> str:
    terms = [
        f"{value:+.{DIGITS}f} {letter}"
        for value, letter in zip(row, "RGB", strict=True)
    ]
    return " ".join(terms)


def nuke_recipe(decoder: Decoder) -> str:
    """Write nodes for Nuke, to paste into its node graph.

    Parameters
    ----------
    decoder : Decoder
        Made by `uplift.extras.scene.passes.decoder`.

    Returns
    -------
    str
        A ColorMatrix for each pass and Merge2 nodes that add their results.
    """
    lines = []
    count = decoder.passes.count
    for number, matrix in enumerate(pass_matrices(decoder), 1):
        rows = " ".join(f"{{{_numbers(row)}}}" for row in matrix)
        lines += [
            "Dot {",
            " inputs 0",
            f" name pass_{number}",
            "}",
            "ColorMatrix {",
            f" matrix {{{rows}}}",
            f" name decode_{number}",
            "}",
        ]
        # Nuke keeps a stack of nodes: a Merge2 takes the last two.
        if number > 1:
            lines += [
                "Merge2 {",
                " inputs 2",
                " operation plus",
                " output rgb",
                f" name sum_{number}" if number < count else " name decoded",
                "}",
            ]
    return "\n".join(lines) + "\n"


def _numbers(row: Array) -> str:
    return " ".join(f"{value:.{DIGITS}f}" for value in row)


BLENDER = "templates/blender.j2"
"""Script for Blender 4 and 5."""
MATRICES = "MATRICES_OF_PASSES"
"""Placeholder in the script."""


def blender_recipe(decoder: Decoder) -> str:
    """Write a script for Blender, which makes a group of compositor nodes.

    Parameters
    ----------
    decoder : Decoder
        Made by `uplift.extras.scene.passes.decoder`.

    Returns
    -------
    str
        The script: a group ``uplift passes`` with an input for each pass.
    """
    blocks = []
    for matrix in pass_matrices(decoder):
        rows = [f"        [{', '.join(map(_float, row))}]," for row in matrix]
        blocks.append("\n".join(["    [", *rows, "    ],"]))
    matrices = "\n".join(["[", *blocks, "]"])
    script = files(__package__).joinpath(BLENDER).read_text(encoding="utf-8")
    return script.replace(MATRICES, matrices)


def _float(value: float) -> str:
    return f"{value:.{DIGITS}f}"


RECIPES: Mapping[str, Callable[[Decoder], str]] = {
    "text": plain_recipe,
    "nuke": nuke_recipe,
    "blender": blender_recipe,
}
"""Recipes by the tool they are for."""
