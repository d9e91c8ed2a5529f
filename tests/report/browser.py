"""A page in a real browser: Chromium without a window, told what to do through a pipe."""

import base64
import json
import os
import select
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

NAMES = ("chromium", "chromium-browser", "google-chrome")
CHROMIUM = next((found for found in map(shutil.which, NAMES) if found), None)
OPTIONS = (
    "--headless",
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--window-size=800,700",
    "--remote-debugging-pipe",
)
PATIENCE = 30.0  # s, until a browser that says nothing has failed
# Chromium reads from 3 and writes to 4; whatever was there goes
AS_CHILD = """
import fcntl, os, sys
ends = [fcntl.fcntl(int(fd), fcntl.F_DUPFD, 10) for fd in sys.argv[1:3]]
os.dup2(ends[0], 3), os.dup2(ends[1], 4)
os.execv(sys.argv[3], sys.argv[3:])
"""


class Page:
    """The one page of a browser: what it asked for, and what it says."""

    def __init__(self, to: Any, of: int) -> None:
        self.to, self.of, self.count, self.session = to, of, 0, None
        self.requests: list[str] = []
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        attached = self.ask("Target.attachToTarget", targetId=target, flatten=True)
        self.session = attached["sessionId"]
        for domain in ("Page", "Network", "Runtime"):
            self.ask(f"{domain}.enable")

    def ask(self, method: str, **parameters: Any) -> dict[str, Any]:
        """The answer to a command of the DevTools protocol."""
        self.count += 1
        command = {"id": self.count, "method": method, "params": parameters}
        if self.session:
            command["sessionId"] = self.session
        self.to.write(json.dumps(command).encode() + b"\0")
        self.to.flush()
        while True:
            said = self.heard()
            if said.get("method") == "Network.requestWillBeSent":
                self.requests.append(said["params"]["request"]["url"])
            if said.get("id") == self.count:
                assert "error" not in said, said
                return said["result"]

    def heard(self) -> dict[str, Any]:
        text = bytearray()
        while not text.endswith(b"\0"):
            assert select.select([self.of], [], [], PATIENCE)[0], "the browser says nothing"
            byte = os.read(self.of, 1)
            assert byte, "the browser ended"
            text += byte
        return json.loads(text[:-1])

    def open(self, file: Path, at: str = "") -> None:
        self.ask("Page.navigate", url="about:blank")
        self.until("location.href == 'about:blank'", "0")
        self.requests.clear()
        self.ask("Page.navigate", url=f"{file.as_uri()}{at}")
        self.until("location.protocol == 'file:' && document.readyState == 'complete'", "0")

    def until(self, condition: str, value: str) -> Any:
        """The value of an expression once a condition is true."""
        end = time.monotonic() + PATIENCE
        while not self.value(f"Boolean({condition})"):
            assert time.monotonic() < end, f"never: {condition}"
            time.sleep(0.05)
        return self.value(value)

    def value(self, expression: str) -> Any:
        found = self.ask("Runtime.evaluate", expression=expression, returnByValue=True)
        return found["result"].get("value")

    def picture(self, file: Path) -> None:
        shot = self.ask("Page.captureScreenshot", format="png")
        file.write_bytes(base64.b64decode(shot["data"]))


@contextmanager
def browser(folder: Path, *options: str) -> Iterator[Page]:
    """A browser with an empty profile in a folder; it ends with the context."""
    to_child, of_parent = os.pipe()
    to_parent, of_child = os.pipe()
    command = [sys.executable, "-c", AS_CHILD, str(to_child), str(of_child), str(CHROMIUM)]
    command += [*OPTIONS, f"--user-data-dir={folder / 'profile'}", *options]
    child = subprocess.Popen(command, pass_fds=(to_child, of_child),  # noqa: S603
                             stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)  # fmt: skip
    os.close(to_child)
    os.close(of_child)
    try:
        with os.fdopen(of_parent, "wb") as to:
            yield Page(to, to_parent)
    finally:
        os.close(to_parent)
        child.terminate()
        try:
            child.wait(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()
