"""Evaluation of mixing models: ``make mixing`` writes docs/data/mixing.json and the pictures of docs/mixing."""

from __future__ import annotations

from uplift_cli.startup import enable_jit_cache, use_one_blas_thread


def main() -> None:
    """Measure, draw and store."""
    enable_jit_cache()
    use_one_blas_thread()
    import uplift
    from benchmarks.mixing import assumptions, models, pictures, times
    from benchmarks.record import ROOT, write

    cube = uplift.load(ROOT / "cubes" / "moments-16-macbeth.uplift")
    smooth = uplift.load()
    pictures.draw(cube, smooth, ROOT / "docs" / "mixing")
    write(
        "mixing",
        "make mixing",
        **models.criteria(cube),
        **assumptions.compare(smooth, cube),
        **models.surfaces(),
        **times.measure(cube),
    )


if __name__ == "__main__":
    main()
