"""Headless Chromium, controlled through the pipe of its DevTools protocol: no driver, no network.

https://chromedevtools.github.io/devtools-protocol
"""

from __future__ import annotations

import base64
import fcntl
import json
import os
import shutil
import subprocess
from pathlib import Path
from types import TracebackType
from typing import Any, Self

_PROGRAMS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
_OPTIONS = (
    "--headless",
    "--remote-debugging-pipe",
    "--no-sandbox",  # it refuses to run as root otherwise, as in most containers
    "--disable-gpu",
    "--use-angle=swiftshader",  # WebGL without a graphics card
    "--enable-unsafe-swiftshader",
    "--disable-dev-shm-usage",
    "--hide-scrollbars",
)


def find_browser() -> str | None:
    """Returns the program, if it is installed."""
    return next(filter(None, map(shutil.which, _PROGRAMS)), None)


class Browser:
    """A browser with one page. Records console messages and requests."""

    def __init__(self, program: str, profile: Path) -> None:
        """Starts the browser; `profile` is its own folder."""
        to_browser, self._requests = os.pipe()
        self._replies, from_browser = os.pipe()
        # The browser reads from descriptor 3 and writes to 4; they must be free.
        ends = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (to_browser, from_browser)]
        self._process = subprocess.Popen(
            [program, *_OPTIONS, f"--user-data-dir={profile}"],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            preexec_fn=lambda: [os.dup2(end, 3 + place) for place, end in enumerate(ends)],
            pass_fds=(3, 4),
        )
        for end in (to_browser, from_browser, *ends):
            os.close(end)
        self._pending = b""
        self._count = 0
        self._session: str | None = None
        self.events: list[dict[str, Any]] = []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        attached = self.call("Target.attachToTarget", targetId=target, flatten=True)
        self._session = attached["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        os.write(self._requests, b'{"id": 0, "method": "Browser.close"}\0')
        try:
            self._process.wait(timeout=10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._requests)
        os.close(self._replies)

    def call(self, method: str, **parameters: object) -> dict[str, Any]:
        """Calls a method of the protocol and waits for its result."""
        self._count += 1
        message: dict[str, Any] = {"id": self._count, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._requests, json.dumps(message).encode() + b"\0")
        while True:
            reply = self._receive()
            if reply.get("id") != self._count:
                self.events.append(reply)
                continue
            assert "error" not in reply, (method, reply["error"])
            return reply["result"]

    def open(self, page: Path, *, scheme: str = "light", width: int = 1400) -> None:
        """Opens a file and waits until it was loaded and its scripts have run."""
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        self.call("Emulation.setEmulatedMedia", features=features)
        self.call(
            "Emulation.setDeviceMetricsOverride",
            **{"width": width, "height": 1000, "deviceScaleFactor": 1, "mobile": False},
        )
        self.events.clear()
        self.call("Page.navigate", url=page.resolve().as_uri())
        while not any(event.get("method") == "Page.loadEventFired" for event in self.events):
            self.events.append(self._receive())

    def evaluate(self, expression: str) -> Any:  # noqa: ANN401 (any JSON value)
        """Returns the value of a JavaScript expression."""
        reply = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        assert "exceptionDetails" not in reply, reply["exceptionDetails"]
        return reply["result"].get("value")

    def scroll_to(self, selector: str) -> None:
        """Scrolls to an element: a table can be sorted once it has been visible."""
        self.evaluate(
            f"document.querySelector({selector!r}).scrollIntoView({{behavior: 'instant'}})"
        )
        self.settle()

    def settle(self) -> None:
        """Waits until a frame has been drawn and timers have run: tables depend on both."""
        waiting = "new Promise(done => requestAnimationFrame(() => setTimeout(done, 50)))"
        self.call("Runtime.evaluate", expression=waiting, awaitPromise=True)

    def press(self, key: str, code: int, text: str = "") -> None:
        """Presses a key as a user does."""
        for kind in ("keyDown", "keyUp"):
            self.call(
                "Input.dispatchKeyEvent",
                **{"type": kind, "key": key, "code": key, "windowsVirtualKeyCode": code},
                **({"text": text} if text and kind == "keyDown" else {}),
            )

    def screenshot(self, file: Path) -> None:
        """Writes a screenshot of the whole page, whatever its length."""
        size = self.call("Page.getLayoutMetrics")["cssContentSize"]
        clip = {"x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1}
        shot = self.call("Page.captureScreenshot", clip=clip, captureBeyondViewport=True)
        file.write_bytes(base64.b64decode(shot["data"]))

    def pdf(self, file: Path) -> None:
        """Writes the page as printed."""
        printed = self.call("Page.printToPDF", preferCSSPageSize=True, printBackground=True)
        file.write_bytes(base64.b64decode(printed["data"]))

    @property
    def complaints(self) -> list[str]:
        """The errors and warnings of the page's scripts, and of the browser about the page.

        The driver's hints about speed are left out: drawing without a graphics card is slow.
        """
        found = []
        for event in self.events:
            told = event.get("params", {})
            if event.get("method") == "Runtime.exceptionThrown":
                found.append(json.dumps(told["exceptionDetails"]))
            if event.get("method") == "Runtime.consoleAPICalled":
                found.append(json.dumps(told["args"]))
            if event.get("method") == "Log.entryAdded":
                found.append(told["entry"]["text"])
        return [text for text in found if "GL Driver Message (OpenGL, Performance" not in text]

    @property
    def requests(self) -> list[str]:
        """Returns the requested addresses."""
        sent = (e for e in self.events if e.get("method") == "Network.requestWillBeSent")
        return [event["params"]["request"]["url"] for event in sent]

    def _receive(self) -> dict[str, Any]:
        while b"\0" not in self._pending:
            part = os.read(self._replies, 1 << 20)
            assert part, "the browser has gone"
            self._pending += part
        message, _, self._pending = self._pending.partition(b"\0")
        return json.loads(message)
