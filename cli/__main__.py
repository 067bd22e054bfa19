"""``python -m uplift_cli``, and the entry point of ``uplift``."""

import gc
import sys

COLLECT_AFTER = 1_000_000
"""New objects between searches for garbage: imports create a million, which all stay.
"""
INTERRUPTED = 130
"""Exit code after Ctrl-C, as shells report it."""


def run() -> None:
    """Run the command line as a process."""
    gc.set_threshold(COLLECT_AFTER)
    try:
        from .main import main
        from .startup import prepare_process

        prepare_process()
        main(prog_name="uplift")
    except KeyboardInterrupt:
        sys.exit(INTERRUPTED)
    finally:
        # OpenImageIO lists all that is left on the standard error stream
        if "OpenImageIO" not in sys.modules:
            gc.freeze()  # Python would search them again as it ends


if __name__ == "__main__":
    if not sys.flags.safe_path:
        del sys.path[0]  # the working folder, whose modules may be a stranger's
    run()
