"""A signed-in window of Chromium with one page for all tests; where it hangs it is ended, and another begun."""

from __future__ import annotations

import secrets
import subprocess
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, cast

from playwright.sync_api import Browser, BrowserContext, Error, Page, ViewportSize

from tests.running import Service

SIZE: ViewportSize = {"width": 1280, "height": 720}
CLIPBOARD = ["clipboard-read", "clipboard-write"]  # which a browser with a window lets a person's click write
USUAL = 30_000.0  # ms, for what a page is to show
LOADED = 5000.0  # ms for a page: one that an earlier click keeps from loading is asked for again, with twice as much
TRIES = 5
SETTLED = 40.0  # ms in which an answer to an action may come
LONGEST = 8.0  # s for what takes milliseconds, on a machine whose cores all have other work


class Window:
    """A context in which someone has signed in, and its page; another of both where the browser hung."""

    def __init__(self, launch: Callable[..., Browser], args: list[str], entrance: str) -> None:
        self._mark = f"--servoident-{secrets.token_hex(8)}"  # by which its process is found
        self._launch, self._args, self._entrance = launch, [*args, self._mark], entrance
        self._browser: Browser | None = None
        self._page: Page | None = None

    @property
    def page(self) -> Page:
        """The page of every test, one after the other: making one takes most of a short test."""
        if self._browser is None or self._page is None or not self._browser.is_connected():
            self._browser = self._launch(args=self._args)
            self._page = self._browser.new_context(permissions=CLIPBOARD).new_page()
            self._page.goto(self._entrance)
        return self._page

    @contextmanager
    def stranger(self) -> Iterator[BrowserContext]:
        """A context of the same browser in which nobody has signed in."""
        browser = self.page.context.browser
        assert browser is not None
        with browser.new_context() as made:
            yield made

    def close(self, other: Page) -> None:
        """Close a page that another opened."""
        with self.in_time():
            other.close()

    def clear(self) -> None:
        """Leave nothing of a test for the next: its other pages, its routes, what it stored, how it was shown."""
        with self.in_time():
            page = self.page
            for other in page.context.pages[1:]:
                other.close()
            page.unroute_all(behavior="ignoreErrors")
            page.set_default_timeout(USUAL)
            visit(page, "about:blank")
            stored = {"origin": self._entrance.partition("/?")[0], "storageTypes": "local_storage"}
            page.context.new_cdp_session(page).send("Storage.clearDataForOrigin", stored)
            page.emulate_media(color_scheme="null")
            page.set_viewport_size(SIZE)

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


@contextmanager
def hearing(page: Page, heard: Mapping[str, Callable[[Any], None]]) -> Iterator[None]:
    """Tells what a page says, by the names of its events, and no longer: the page is that of the next test, too."""
    for event, told in heard.items():
        page.on(event, told)  # type: ignore[call-overload]  its names are literals there
    yield
    for event, told in heard.items():
        page.remove_listener(event, told)


def visit(page: Page, address: str) -> None:
    """Open a page; once more where an earlier click was on its way to another.

    One that was asked for before and is slow to come may get in the way of itself: then it is waited for.
    """
    coming = False
    for tried in range(TRIES):
        until = {"wait_until": "domcontentloaded", "timeout": LOADED * 2**tried}
        try:
            if coming:
                page.wait_for_url(lambda url: url == address, **until)  # type: ignore[arg-type]
            else:
                page.goto(address, **until)  # type: ignore[arg-type]
        except Error as error:
            coming = f'by another navigation to "{address}"' in str(error)
            page.wait_for_timeout(SETTLED)
        else:
            return
    page.goto(address, wait_until="domcontentloaded")


def signed_in(launch: Callable[..., Browser], launch_args: dict[str, object], site: Service) -> Iterator[Window]:
    """A window of a service for as long as its fixture lasts."""
    made = Window(launch, cast("list[str]", launch_args["args"]), f"{site.address}/?token={site.token}")
    yield made
    made.end()
