"""Command line of uplift: parse arguments, call the library, print results. Installed
as ``uplift_cli``.
"""

if __name__ != "uplift_cli":
    raise ImportError(
        "the command line is installed as 'uplift_cli'; run 'pip install -e .' and "
        "import that"
    )
