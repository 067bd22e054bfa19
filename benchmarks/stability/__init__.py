"""``make stability``: where the project fails, and how it fails → docs/stability.md.

`measure` runs what takes minutes and leaves its figures in docs/stability/; `write` makes the page of them, and of
what other commands leave beside it, in this order, where the files are there:

    docs/stability-storage.json       how exactly coefficients must be stored
    docs/stability-hostile.json       fuzzed, killed, full disks
    docs/stability-determinism.json   the same bytes

Each of them is an object, or a list of objects, of one table each: ``title``, ``command`` that made it, ``columns``
(names), ``rows`` (lists as long as these, of text or numbers), ``notes`` (sentences). ``python -m
benchmarks.stability.write`` makes the page again without measuring.
"""
