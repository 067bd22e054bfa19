"""Mixing colours in the spectrum: lights, filters, dyes, paints; and the RGB heuristics they are compared with.

A theory a file, after K. Fishkin, *Applying Color Science to Computer Graphics*, Berkeley 1983, chapters 5 and 7–10,
whose equations the docstrings number; docs/mixing.md shows what comes of each. Spectra are arrays (…, N), amounts
(…, n), the n spectra of a mixture (…, n, N): leading axes are vectorised over and broadcast.

    from uplift.design.mixing import kubelka_munk, pigments

    paints = pigments.of_hiding(cube.reflectance([blue, yellow]))
    kubelka_munk.hiding(paints.mixed([2, 1]))  # reflectance of two parts of blue and one of yellow
"""
