"""Threads of linear algebra: matrices are small here, so that threads would wait for one another."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def single_threaded_blas() -> Iterator[None]:
    """Also the same bytes whatever the threads: sums that BLAS shares out are rounded by how many there are.

    Threads of XLA stay: they share out rows, not sums.
    """
    import scipy.linalg  # noqa: F401  it brings a BLAS of its own, and only what is there can be told
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, user_api="blas"):
        yield
