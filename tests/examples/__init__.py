"""Every ``uplift`` line of the README, the documentation and the help texts, run where a reader would run it.

``python -m tests.examples`` (``make examples``) runs all of them; ``tests/test_examples.py`` runs a few.
"""
