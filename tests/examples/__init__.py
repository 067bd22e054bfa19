"""Every ``uplift`` line of the README, the documentation and the help texts, run where a reader would run it.

``python -m tests.examples`` (``make examples``) runs all of them in full; ``tests/test_examples.py`` runs the long ones
reduced.
"""
