"""``python -m uplift``: the command line, which is found by its name as it lies above
this package.
"""

import runpy

if __name__ == "__main__":
    runpy.run_module("uplift_cli", run_name="__main__", alter_sys=True)
