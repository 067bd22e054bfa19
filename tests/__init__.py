"""Tests of uplift. Like commands, they compute with one thread of BLAS: more of them
wait for work by spinning.
"""

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # read when numpy is imported
