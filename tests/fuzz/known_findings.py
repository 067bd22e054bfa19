"""What the attacks found, and what happens now: kept by hand, as runs show nothing of what is mended."""

from __future__ import annotations

FOUND = (
    {
        "target": "atlas table",
        "input": "a wavelength of 1e308 nm",
        "was": "ValueError of the interpolation",
        "now": "refused: no wavelength is longer than a millimetre",
    },
    {
        "target": "atlas table",
        "input": "a file of nothing but a byte-order mark or other blanks of Unicode",
        "was": "RuntimeError",
        "now": "refused as empty",
    },
    {
        "target": "cube, right digest",
        "input": "arrays of the sensor or of the entries in half precision, or complex",
        "was": "TypeError when asked",
        "now": "refused: every array has its type",
    },
    {
        "target": "cube, right digest",
        "input": "a sensor without light, without white, or with primaries in one plane",
        "was": "LinAlgError, or NaN in answers",
        "now": "refused: the perfect reflector is white, and the space has three primaries",
    },
    {
        "target": "cube, right digest",
        "input": "coefficients of 1e300",
        "was": "overflow, and a grey for a sigmoid that should be white",
        "now": "refused: no number of a cube exceeds 1e30",
    },
    {
        "target": "cube, right digest",
        "input": "an infinite node; whole numbers of 400 digits; NaN in the JSON text",
        "was": "a warning of numpy; OverflowError; NaN passed on by 'uplift info --format json'",
        "now": "refused",
    },
    {
        "target": "cube, right digest",
        "input": "multipliers of a sigmoid of 1e12, asked in mode refined",
        "was": "overflow in a step that was taken",
        "now": "steps beyond multipliers of 1e9 are turned down, as in the fit",
    },
    {
        "target": "atlas text",
        "input": "an increment of inf",
        "was": "a warning of numpy before the error",
        "now": "refused, and nothing else said",
    },
    {
        "target": "SIGKILL while saving",
        "input": "a writer killed while it writes",
        "was": "its half-written hidden file stayed for ever",
        "now": "the next writer to that path removes it; one that is still being written is locked, and stays",
    },
    {
        "target": "SIGKILL while saving",
        "input": "a writer killed while safetensors writes by a temporary file of its own",
        "was": "that file stayed for ever",
        "now": "it writes to ours, by bytes",
    },
    {
        "target": "standard output",
        "input": "uplift query > /dev/full",
        "was": "a traceback",
        "now": "an error in a line, exit code 2",
    },
    {
        "target": "odd paths",
        "input": "uplift build -o -",
        "was": "a file called '-'",
        "now": "refused: standard output takes no files",
    },
    {
        "target": "scene to plan, plan, palette",
        "input": "TOML or JSON of many thousand brackets",
        "was": "RecursionError",
        "now": "refused",
    },
    {
        "target": "scene to plan",
        "input": "names longer than a system takes, with NUL in a pattern, patterns of 100,000 letters",
        "was": "OSError, ValueError, minutes of waiting",
        "now": "refused",
    },
)
