"""Compile the texture for scalar variants: ``python -m uplift.io.mitsuba``."""

from __future__ import annotations

import sys

from uplift.common.errors import UpliftError
from uplift.io.mitsuba import compile_plugin


def main() -> None:
    """Compile, and print the folder."""
    try:
        print(compile_plugin())
    except UpliftError as error:
        sys.exit(f"error: {error}")


if __name__ == "__main__":
    main()
