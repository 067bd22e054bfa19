"""Methods of spectral upsampling, a file for each family.

The ``METHODS`` of every file in this folder are those of `uplift chart`.
"""

from importlib import import_module
from pkgutil import iter_modules

from uplift.lab.method import Method


def find_methods() -> list[Method]:
    """Return the methods of all files."""
    methods: list[Method] = []
    for file in iter_modules(__path__):
        module = import_module(f"{__name__}.{file.name}")
        methods += getattr(module, "METHODS", ())
    return methods
