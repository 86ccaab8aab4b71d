"""A browser without a screen, spoken to over its DevTools pipe."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO

from needs import needs

PROGRAMS = ("chromium", "chromium-browser", "google-chrome")
FLAGS = (
    *("--headless", "--no-sandbox", "--disable-gpu"),
    *("--window-size=1400,1000", "--remote-debugging-pipe"),
)
COMPLAINTS = ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded")


def program() -> str:
    """The browser at hand."""
    found = next(filter(None, map(shutil.which, PROGRAMS)), None)
    return needs(found, "chromium (apt-get install chromium)")


class Page:
    """One page; ``complaints`` is all its console said, ``requests`` all it asked for."""

    def __init__(self, to_browser: BinaryIO, from_browser: BinaryIO) -> None:
        self.complaints: list[Any] = []
        self.requests: list[str] = []
        self._to = to_browser
        self._from = from_browser
        self._number = 0
        self._session: str | None = None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)[
            "sessionId"
        ]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Ask the browser something and wait for the answer."""
        self._number += 1
        question = {"id": self._number, "method": method, "params": parameters}
        if self._session is not None:
            question["sessionId"] = self._session
        self._to.write(json.dumps(question).encode() + b"\0")
        while (message := self._next()).get("id") != self._number:
            self._notice(message)
        assert "error" not in message, message["error"]
        result: dict[str, Any] = message["result"]
        return result

    def load(self, path: Path, fragment: str = "") -> None:
        """Go to a file and wait until it is there."""
        self.call("Page.navigate", url=f"{path.absolute().as_uri()}#{fragment}")
        while (message := self._next()).get("method") != "Page.loadEventFired":
            self._notice(message)

    def run(self, script: str) -> Any:
        """The value of a JavaScript expression, awaited if it is a promise."""
        answer = self.call(
            "Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True
        )
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def mouse(self, kind: str, x: float, y: float) -> None:
        """Move, press or release the mouse."""
        held = {"button": "left", "buttons": 1, "clickCount": 1}
        self.call("Input.dispatchMouseEvent", type=f"mouse{kind}", x=x, y=y, **held)

    def _next(self) -> dict[str, Any]:
        message = bytearray()
        while (byte := self._from.read(1)) != b"\0":
            assert byte, "the browser has gone"
            message += byte
        decoded: dict[str, Any] = json.loads(message)
        return decoded

    def _notice(self, message: dict[str, Any]) -> None:
        if message.get("method") in COMPLAINTS:
            self.complaints.append(message["params"])
        if message.get("method") == "Network.requestWillBeSent":
            self.requests.append(message["params"]["request"]["url"])


@contextmanager
def open_page() -> Iterator[Page]:
    """Start a browser with one page; it ends with the context."""
    browser = program()
    browser_in, to_browser = os.pipe()
    from_browser, browser_out = os.pipe()
    command = f'exec "$@" 3<&{browser_in} 4>&{browser_out}'
    with (
        os.fdopen(to_browser, "wb", buffering=0) as questions,
        os.fdopen(from_browser, "rb") as answers,
        subprocess.Popen(
            ["bash", "-c", command, "bash", browser, *FLAGS],
            pass_fds=(browser_in, browser_out),
            stderr=subprocess.DEVNULL,
        ) as process,
    ):
        os.close(browser_in)
        os.close(browser_out)
        try:
            yield Page(questions, answers)
        finally:
            process.kill()
