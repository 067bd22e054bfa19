"""Failures that fuzzing found, and the behaviour since they were fixed. Maintained by hand."""

from __future__ import annotations

KNOWN_FINDINGS = (
    {
        "target": "atlas table",
        "input": "a wavelength of 1e308 nm",
        "was": "ValueError of the interpolation",
        "now": "rejected: no wavelength exceeds a millimetre",
    },
    {
        "target": "atlas table",
        "input": "a file with only a byte-order mark or other Unicode blanks",
        "was": "RuntimeError",
        "now": "rejected as empty",
    },
    {
        "target": "cube, valid digest",
        "input": "arrays of the sensor or of the entries in half precision, or complex",
        "was": "TypeError in queries",
        "now": "rejected: every array has its type",
    },
    {
        "target": "cube, valid digest",
        "input": "a sensor without light, without white, or with primaries in one plane",
        "was": "LinAlgError, or NaN in answers",
        "now": "rejected: the perfect reflector is white, and the space has three primaries",
    },
    {
        "target": "cube, valid digest",
        "input": "coefficients of 1e300",
        "was": "overflow, and grey in place of a white sigmoid",
        "now": "rejected: no number of a cube exceeds 1e30",
    },
    {
        "target": "cube, valid digest",
        "input": "an infinite node; integers of 400 digits; NaN in the JSON text",
        "was": "a warning of numpy; OverflowError; NaN in the output of 'uplift info --format json'",
        "now": "rejected",
    },
    {
        "target": "cube, valid digest",
        "input": "multipliers of a sigmoid of 1e12, queried in mode refined",
        "was": "overflow in an accepted step",
        "now": "steps to multipliers above 1e9 are rejected, as in the fit",
    },
    {
        "target": "atlas text",
        "input": "an increment of inf",
        "was": "a warning of numpy before the error",
        "now": "rejected without a warning",
    },
    {
        "target": "SIGKILL while saving",
        "input": "a writer killed while it writes",
        "was": "its incomplete temporary file remained",
        "now": "the next writer to that path removes it; the temporary file of a running writer is locked and stays",
    },
    {
        "target": "SIGKILL while saving",
        "input": "a writer killed while safetensors writes to a second temporary file",
        "was": "that file remained",
        "now": "safetensors serialises to memory",
    },
    {
        "target": "standard output",
        "input": "uplift query > /dev/full",
        "was": "a traceback",
        "now": "an error of one line, exit code 2",
    },
    {
        "target": "odd paths",
        "input": "uplift build -o -",
        "was": "a file named '-'",
        "now": "rejected: standard output cannot hold a file",
    },
    {
        "target": "scene file, plan, palette",
        "input": "TOML or JSON with thousands of nested brackets",
        "was": "RecursionError",
        "now": "rejected",
    },
    {
        "target": "scene file",
        "input": "file names that are too long, patterns with NUL, patterns of 100,000 letters",
        "was": "OSError, ValueError, minutes of waiting",
        "now": "rejected",
    },
    {
        "target": "build options",
        "input": "auto_tolerance of NaN, infinity or −1",
        "was": "a cube that no command could read, in place of a good one",
        "now": "rejected; a new cube is read back before it replaces an old one",
    },
    {
        "target": "cube, metadata",
        "input": "JSON nested 983 levels deep; lone surrogates; 100,000 recorded lights",
        "was": "RecursionError, UnicodeEncodeError, a hang of 'uplift check'",
        "now": "rejected by the schema of the metadata, before the digest",
    },
    {
        "target": "cube, metadata",
        "input": "a recorded atlas named /etc/shadow or /proc/kmsg",
        "was": "the file was opened",
        "now": "files are opened in the folder of the cube and in --atlas-dir only",
    },
    {
        "target": "cube, valid digest",
        "input": "negative standard errors; a threshold of 5e-324; sparse arrays of another type",
        "was": "accepted; a gigabyte was allocated before the check",
        "now": "rejected before arrays are expanded",
    },
    {
        "target": "chart table",
        "input": "blank, missing or infinite cells of a measured method",
        "was": "KeyError in pictures and pages",
        "now": "rejected: the numbers of an error come together",
    },
    {
        "target": "kinds of input files",
        "input": "pipes and devices in place of files",
        "was": "reading never ended",
        "now": "rejected: an input must be a file",
    },
    {
        "target": "numbers of options",
        "input": "digits of other scripts, numbers of 5,000 digits, 10²⁰ processes",
        "was": "accepted, or messages of thousands of characters",
        "now": "rejected on one line",
    },
    {
        "target": "colour table",
        "input": "1e308 in one channel, mapped with 'clip'",
        "was": "the other channels became 0",
        "now": "the other channels are kept",
    },
    {
        "target": "builds in threads",
        "input": "several builds in threads of one process",
        "was": "other bytes once in 960 builds, and one thread for BLAS afterwards",
        "now": "the limit holds until the last build is done, and is removed then",
    },
)
