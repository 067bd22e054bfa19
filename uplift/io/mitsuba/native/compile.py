"""Compilation of the texture in C++ against the headers that Mitsuba's package contains."""

from __future__ import annotations

import hashlib
import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path

from uplift.common.errors import OptionError
from uplift.common.files import atomic_write

SOURCE = Path(__file__).parent / "uplift_texels.cpp"
NAME = "uplift_texels"
CHECK = "uplift.io.mitsuba.native.check"
"""Module that compares the plugin with numpy, run in its own process because an incompatible one can crash."""


def find_plugin() -> Path | None:
    """Find the plugin that was compiled for the installed Mitsuba.

    Returns
    -------
    Path or None
        A folder for Mitsuba's file resolver, None if nothing was compiled or other users can write to the folder.
    """
    folder = _folder()
    return folder if _library(folder).is_file() and _is_private(folder) else None


def compile_plugin() -> Path:
    """Compile the texture for scalar variants of Mitsuba, and keep it in the user's cache folder.

    `register` uses it from then on. It is compiled for one version of Mitsuba.

    Returns
    -------
    Path
        A folder for Mitsuba's file resolver.

    Raises
    ------
    OptionError
        A C++ compiler is missing (code ``compiler-not-found``), the headers are not installed
        (``headers-not-installed``), the compiler fails (``plugin-not-compiled``), the result disagrees with numpy
        (``plugin-incompatible``), or other users can write to the folder (``shared-plugin-folder``).
    """
    compiler = os.environ.get("CXX") or shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")
    if compiler is None:
        raise OptionError(
            "a C++ compiler must be installed",
            code="compiler-not-found",
            hint="install g++ or clang++, or name a compiler by the environment variable CXX",
        )
    folder = _folder()
    library = _library(folder)
    library.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    if not _is_private(folder):
        raise OptionError(
            f"other users can write to {folder}",
            code="shared-plugin-folder",
            hint="remove the folder, or change its permissions",
        )
    with atomic_write(library, force=True) as temporary:
        _run([compiler, str(SOURCE), "-o", str(temporary), *_flags()], "plugin-not-compiled")
    try:
        _run([sys.executable, "-m", CHECK, str(folder)], "plugin-incompatible")
    except OptionError:
        library.unlink()
        raise
    return folder


def _run(command: list[str], code: str) -> None:
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        lines = [line for line in done.stderr.splitlines() if "error" in line.lower()] or [str(done.returncode)]
        raise OptionError(
            f"the texture for scalar variants cannot be compiled: {lines[0]}",
            code=code,
            hint="use llvm_ad_spectral, or another compiler by the environment variable CXX",
        )


def _flags() -> list[str]:
    """Return compiler flags. Dr.Jit's types depend on the instruction set: those of the package need AVX on x86."""
    x86 = ["-march=x86-64-v3"] if platform.machine() in ("x86_64", "AMD64") else []
    optimised = ["-std=c++17", "-O2", "-DNDEBUG", "-fno-math-errno", "-fno-strict-aliasing", *x86]
    headers = (f"-I{folder}" for folder in _headers())
    return [*optimised, "-fPIC", "-shared", *headers, f"-L{_mitsuba()}", "-lmitsuba"]


def _headers() -> tuple[Path, ...]:
    """Return the folders of headers. Those of Mitsuba include headers of nanobind, which its package lacks."""
    import drjit

    try:
        import nanobind
    except ImportError as error:
        raise OptionError(
            "the headers of nanobind are not installed",
            code="headers-not-installed",
            hint="install them: pip install 'spectral-uplift[mitsuba]'",
        ) from error
    intrusive = Path(nanobind.include_dir())
    robin_map = intrusive.parent / "ext" / "robin_map" / "include"
    return _mitsuba() / "include", Path(str(drjit.__file__)).parent / "include", intrusive, robin_map


def _mitsuba() -> Path:
    """Return the folder of Mitsuba's package, with headers, libraries and plugins."""
    import mitsuba

    return Path(str(mitsuba.__file__)).parent


def _folder() -> Path:
    """Return the folder for the installed version of Mitsuba and this version of the source."""
    import mitsuba
    from platformdirs import user_cache_dir

    digest = hashlib.sha256(SOURCE.read_bytes()).hexdigest()[:12]
    return Path(user_cache_dir("uplift")) / "mitsuba" / f"{mitsuba.__version__}-{digest}"


def _library(folder: Path) -> Path:
    suffix = next((_mitsuba() / "plugins").glob("bitmap.*")).suffix
    return folder / "plugins" / f"{NAME}{suffix}"


def _is_private(folder: Path) -> bool:
    """Return whether no other user can replace the plugin."""
    if not hasattr(os, "getuid"):
        return True
    status = [each.stat() for each in (folder, folder / "plugins")]
    return all(each.st_uid == os.getuid() and not each.st_mode & 0o022 for each in status)
