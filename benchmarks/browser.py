"""Headless Chromium, controlled through two pipes by the DevTools protocol: input,
screenshots and console errors.

https://chromedevtools.github.io/devtools-protocol/
"""

import base64
import contextlib
import itertools
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
OPTIONS = (
    "--headless",
    "--no-sandbox",
    "--enable-unsafe-webgpu",
    "--use-webgpu-adapter=swiftshader",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-dev-shm-usage",
    "--hide-scrollbars",
    "--remote-debugging-pipe",
)
HANDS_OVER = """import os, sys
reads, writes, *command = sys.argv[1:]
os.dup2(int(reads), 3)
os.dup2(int(writes), 4)
os.execv(command[0], command)"""
"""Chromium reads from descriptor 3 and writes to 4."""
SETTLE = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
"""To evaluate: waits for the frame that is due."""
ADVICE = "(OpenGL, Performance"
"""In messages of drivers on their speed: nothing that a page has done wrong."""
READY = (
    "location.protocol === 'file:' && document.readyState === 'complete'"
    " && document.querySelector('main')?.getAttribute('aria-busy') !== 'true'"
)
CANVAS = """(async () => {
  await SETTLE;
  const canvas = document.getElementById("NAME");
  const read = { willReadFrequently: true };
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", read);
  copy.drawImage(canvas, 0, 0);
  const codes = copy.getImageData(0, 0, canvas.width, canvas.height).data;
  let text = "";
  for (let at = 0; at < codes.length; at += 8192)
    text += String.fromCharCode(...codes.subarray(at, at + 8192));
  return [canvas.width, canvas.height, btoa(text)];
})()""".replace("SETTLE", SETTLE)
"""Read from a copy: the page's own canvas is drawn to and never read."""
SHIFT = 8
"""Modifier of keys."""
COMPLAINTS = ("error", "warning", "assert")
PATIENCE = 60.0
"""Seconds that an answer may take."""

Answer = dict[str, Any]


class Browser:
    """One tab. ``errors`` are what its console complained of, and uncaught
    exceptions.
    """

    def __init__(self, write: int, read: int) -> None:
        self._write = write
        self._read = read
        self._rest = b""
        self._numbers = itertools.count(1)
        self._session = {}
        self.errors: list[str] = []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        attached = self.call("Target.attachToTarget", targetId=target, flatten=True)
        self._session = {"sessionId": attached["sessionId"]}
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **params: Any) -> Answer:
        """Call a method of the tab and wait for its answer. Raises `RuntimeError`,
        `TimeoutError`.
        """
        number = next(self._numbers)
        message = {"id": number, "method": method, "params": params} | self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        while (answer := self._next()).get("id") != number:
            if ADVICE not in str(answer):
                self._note(answer)
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']['message']}")
        return dict(answer["result"])

    def evaluate(self, code: str) -> Any:
        """The value of an expression in the page, waited for if it is a promise. Raises
        `RuntimeError`.
        """
        answer = self.call(
            "Runtime.evaluate", expression=code, awaitPromise=True, returnByValue=True
        )
        if "exceptionDetails" in answer:
            raise RuntimeError(
                answer["exceptionDetails"]["exception"].get("description", "uncaught")
            )
        return answer["result"].get("value")

    def open(self, path: Path) -> None:
        """Show a page and wait until its ``main`` is busy no more. Raises
        `TimeoutError`.
        """
        self.errors.clear()
        self.call("Page.navigate", url=path.resolve().as_uri())
        end = time.monotonic() + PATIENCE
        while not self.evaluate(READY):
            if time.monotonic() > end:
                raise TimeoutError(f"{path} stays busy: {self.errors}")
            time.sleep(0.02)

    def canvas(self, name: str) -> NDArray[np.uint8]:
        """(H, W, 4) red, green, blue and alpha of the canvas with this id, after the
        frame that is due.
        """
        width, height, text = self.evaluate(CANVAS.replace("NAME", name))
        return np.frombuffer(base64.b64decode(text), np.uint8).reshape(height, width, 4)

    def window(self, width: int, height: int, scheme: str = "light") -> None:
        """The page's size in pixels, and light or dark."""
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )
        feature = {"name": "prefers-color-scheme", "value": scheme}
        self.call("Emulation.setEmulatedMedia", features=[feature])

    def mouse(self, kind: str, x: float, y: float) -> None:
        """``kind`` is mousePressed, mouseMoved or mouseReleased; the left button."""
        self.call(
            "Input.dispatchMouseEvent",
            type=kind,
            x=x,
            y=y,
            button="left",
            buttons=1,
            clickCount=1,
        )

    def key(self, name: str, modifiers: int = 0) -> None:
        for kind in ("keyDown", "keyUp"):
            text = name if kind == "keyDown" and len(name) == 1 else ""
            self.call(
                "Input.dispatchKeyEvent",
                type=kind,
                key=name,
                modifiers=modifiers,
                text=text,
            )

    def screenshot(self, selector: str = "body", scale: float = 1.0) -> bytes:
        """An element, as far as the window shows it, as JPEG."""
        box = self.evaluate(
            f"document.querySelector('{selector}').getBoundingClientRect().toJSON()"
        )
        answer = self.call(
            "Page.captureScreenshot",
            format="jpeg",
            quality=88,
            clip=box | {"scale": scale},
        )
        return base64.b64decode(answer["data"])

    def _next(self) -> Answer:
        while b"\0" not in self._rest:
            if not select.select([self._read], [], [], PATIENCE)[0]:
                raise TimeoutError("the browser does not answer")
            chunk = os.read(self._read, 1 << 20)
            if not chunk:
                raise RuntimeError("the browser is gone")
            self._rest += chunk
        message, _, self._rest = self._rest.partition(b"\0")
        return dict(json.loads(message))

    def _note(self, message: Answer) -> None:
        """Keep complaints of the console and the log, and exceptions."""
        params = message.get("params", {})
        level = params.get("entry", params).get("level") or params.get("type")
        if level in COMPLAINTS or "exceptionDetails" in params:
            self.errors.append(json.dumps(params))


@contextlib.contextmanager
def browser() -> Iterator[Browser]:
    """A browser, which is ended with the block. Raises `RuntimeError` where there is
    none.
    """
    path = next(filter(None, map(shutil.which, NAMES)), None)
    if path is None:
        raise RuntimeError(f"none of {', '.join(NAMES)} is installed")
    reads, write = os.pipe()
    read, writes = os.pipe()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        command = [sys.executable, "-c", HANDS_OVER, str(reads), str(writes), path]
        child = subprocess.Popen(
            [*command, *OPTIONS, f"--user-data-dir={profile}"],
            pass_fds=(reads, writes),
            stderr=subprocess.DEVNULL,
        )
        for end in (reads, writes):
            os.close(end)
        try:
            yield Browser(write, read)
        finally:
            for end in (write, read):
                os.close(end)  # it ends when its pipe does
            try:
                child.wait(10)
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()
