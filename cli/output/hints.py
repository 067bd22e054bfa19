"""Hints in terms of command-line options, by error code.

The library names parameters of Python in its hints. Where an option of the command line does the same, the table below
has the hint to show in place of the library's.
"""

from __future__ import annotations

from uplift.common.errors import Diagnostic

HINTS = {
    "atlas-changed": "name the folder of the recorded file with --atlas-dir, or build the cube again",
    "atlas-not-found": "name its folder with --atlas-dir, or build the cube again",
    "auto-tolerance-out-of-range": "use --tolerance with a ΔE00 of 0 or more",
    "camera-without-space": "add --space camera",
    "chart-without-cubes": "measure one with 'uplift chart'",
    "chart-without-methods": "name the CSV file that 'uplift chart' wrote",
    "coefficients-out-of-range": "use --coefficients 3 to 17",
    "colour-not-in-scene": "use --fill-missing, or build the cube with the image in --scene",
    "colour-not-a-light": "use --out-of-gamut clip for the nearest colour towards white",
    "cube-damaged": "build it again with 'uplift build'",
    "cube-not-found": "build a cube with 'uplift build'",
    "cube-version": "build it again with 'uplift build', or use the version of uplift that wrote it",
    "dim-not-a-number": "use --dim with a number, or --dim auto",
    "dim-too-small": "use --dim 2 or more",
    "encoded-floats-not-mapped": "use --out-of-gamut clip, or --encoding linear",
    "entries-mismatch": "build the cube again, or replace it with --update",
    "entry-coefficients-out-of-range": "use --entry-coefficients from --coefficients to 17",
    "entry-crowded": "use --dim auto for a lattice that is large enough; 'uplift report' shows details",
    "file-exists": "use --force to replace it, or choose another name",
    "invalid-chart": "name the CSV file that 'uplift chart' wrote",
    "invalid-codes": "leave out --encoded for linear floats",
    "invalid-primaries": "give --input-space as x,y of red, green, blue and white, or the name of an RGB space",
    "invalid-thickness": "use --thickness 0 or more",
    "range-not-in-steps": "use --step 1, or another range",
    "unsupported-step": "use --step 5",
    "lattice-mismatch": "build the cube again, or replace it with --update",
    "library-not-used": "use --prior learnt with --model moments and 4 to 17 coefficients, or leave out --library",
    "limit-not-positive": "give --time-ns and --tolerance above 0",
    "look-not-reached": "use --entry-coefficients up to 17",
    "looks-without-freedom": "use --model moments with --entry-coefficients 4 to 17",
    "mixed-scales": "correct the row, or use --scale percent or fraction if it is right",
    "no-left-out-entries": "build it again with 'uplift build', or use 'uplift check --update'",
    "no-moments": "use --representation multipliers, or a cube of moments",
    "no-requirements": "give --time-ns, --tolerance or both",
    "not-a-chart": "name the CSV file that 'uplift chart' wrote",
    "not-a-cube": "name a cube by 'uplift build', or use 'uplift lights' for an emission table",
    "not-an-emission-table": "build one with 'uplift lights build', or use 'uplift query' and the like for a cube",
    "rgb-out-of-gamut": "map it inside with --out-of-gamut, or use --encoded for 8-bit codes",
    "rgb-space-mismatch": "build the cube with the image in --scene, or without --scene",
    "scene-without-colours": "name an image with --scene, or build without --scene",
    "source-changed": "plan again with 'uplift plan SCENE.toml'",
    "sparse-cube": "use --fill-missing where the command has it, or a cube built without --scene",
    "target-not-positive": "give --tolerance above 0",
    "threshold-out-of-range": "use --threshold 1e-6 to 0.1",
    "too-few-colours": "use --colours 16 or more",
    "unknown-gamut-mapping": "use --out-of-gamut with error, clip, scale, desaturate or desaturate-oklab",
    "unknown-method": "give --methods with other names; '*' matches any characters",
    "unknown-warp": "use --warp none or vision",
    "unsupported-depth": "use another --depth",
}
"""Hint by code of an error or a warning."""


def hint_for(diagnostic: Diagnostic) -> str:
    """Return the hint of the command line for an error or warning, or else the library's own."""
    return HINTS.get(diagnostic.code, diagnostic.hint)
