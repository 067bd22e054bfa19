"""Command line of uplift, installed as ``uplift_cli``: arguments, calls and output."""

if __name__ != "uplift_cli":
    raise ImportError(
        "the command line is installed as 'uplift_cli'; run 'pip install -e .' and "
        "import that"
    )
