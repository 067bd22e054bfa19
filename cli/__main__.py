"""``python -m uplift_cli``."""

from .main import main

main(prog_name="uplift")
