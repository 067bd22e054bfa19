"""Functions that JAX compiles."""

from collections.abc import Callable
from functools import wraps
from typing import Any

import jax


def compiled(function: Callable[..., Any], **options: Any) -> Any:
    """Compile a function by ``jax.jit``, with matrix products in full precision.

    JAX multiplies matrices of float32 in TF32 on accelerators, with 10 bits.
    """

    @wraps(function)
    def traced(*arguments: Any) -> Any:
        with jax.default_matmul_precision("highest"):
            return function(*arguments)

    return jax.jit(traced, **options)
