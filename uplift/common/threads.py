"""Threads of linear algebra."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def single_threaded_blas() -> Iterator[None]:
    """Limit BLAS to one thread.

    The matrices of this package are small, so threads would wait for each other. Results then also do not depend on the
    number of threads, which changes the rounding of sums. The threads of XLA are not affected: they distribute rows.
    """
    import scipy.linalg  # noqa: F401  loads its own BLAS, and only loaded libraries can be limited
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, user_api="blas"):
        yield
