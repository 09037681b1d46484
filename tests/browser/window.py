"""A signed-in window of Chromium, which now and then does not close a page: then it is ended, and another begun."""

from __future__ import annotations

import secrets
import subprocess
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import cast

from playwright.sync_api import Browser, BrowserContext, Error, Page

from tests.running import Service

LONGEST = 8.0  # s for what takes milliseconds, on a machine whose cores all have other work


class Window:
    """A context in which someone has signed in; a new one after each `renew`, and where the browser hung."""

    def __init__(self, launch: Callable[..., Browser], args: list[str], entrance: str) -> None:
        self._mark = f"--servoident-{secrets.token_hex(8)}"  # by which its process is found
        self._launch, self._args, self._entrance = launch, [*args, self._mark], entrance
        self._browser: Browser | None = None
        self._made: BrowserContext | None = None
        self._kept: Page | None = None  # stays open, on an answer that does nothing: making a page takes most of a test

    @property
    def context(self) -> BrowserContext:
        """Where pages are opened."""
        if self._browser is None or not self._browser.is_connected():
            self._browser, self._made = self._launch(args=self._args), None
        if self._made is None:
            self._made = self._browser.new_context()
            self._kept = self._made.new_page()
            self._kept.goto(self._entrance)
            self._kept.goto(f"{self._entrance.partition('?')[0]}api/v1/ready")
        return self._made

    def close(self, page: Page) -> None:
        """Close a page; nothing that it left in the browser is there for the next."""
        with self.in_time():
            page.close()
            context = self.context  # a new one where the browser was ended
            assert self._kept is not None
            self._kept.evaluate(
                "localStorage.clear()"
            )  # of the closed one, which may go on by itself, nothing is asked
            context.clear_permissions()

    def renew(self) -> None:
        """Have the next page opened in a context of its own."""
        with self.in_time():
            if self._made is not None:
                self._made.close()
        self._made = None

    def end(self) -> None:
        """Close the browser."""
        with self.in_time():
            if self._browser is not None:
                self._browser.close()

    @contextmanager
    def in_time(self) -> Iterator[None]:
        """Ends the browser where what is done does not return."""
        hung = threading.Timer(LONGEST, subprocess.run, [["pkill", "-KILL", "-f", "--", self._mark]])
        hung.start()
        try:
            yield
        except Error:
            if self._browser is None or self._browser.is_connected():
                raise
        finally:
            hung.cancel()


def signed_in(launch: Callable[..., Browser], launch_args: dict[str, object], site: Service) -> Iterator[Window]:
    """A window of a service for as long as its fixture lasts."""
    made = Window(launch, cast("list[str]", launch_args["args"]), f"{site.address}/?token={site.token}")
    yield made
    made.end()
