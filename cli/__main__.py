"""``python -m uplift_cli``, and the entry point of ``uplift``."""

from __future__ import annotations

import gc
import signal

COLLECT_AFTER = 100_000
"""New objects between searches for garbage: imports create a million, which all stay."""


def run() -> None:
    """Run the command line. A Ctrl-C while it is imported ends the process without a traceback."""
    gc.set_threshold(COLLECT_AFTER)
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from .main import main

    main(prog_name="uplift")


if __name__ == "__main__":
    run()
