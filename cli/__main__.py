"""``python -m uplift_cli``, and the entry point of ``uplift``."""

from __future__ import annotations

import signal


def run() -> None:
    """Run the command line. A Ctrl-C while it is imported ends the process without a traceback."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from .main import main

    main(prog_name="uplift")


if __name__ == "__main__":
    run()
