"""Build the documentation as a site, say where it is, and show it where that is asked; `python3 -m docs` calls this."""

from __future__ import annotations

import argparse
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from app.cli.serving import LOOPBACK, free_port

HERE = Path(__file__).resolve().parent
PORT = 8080
"""Where the site is served; another port where it is taken."""


def main(arguments: list[str] | None = None) -> int:
    """Build, and say where the first page is. Returns the exit status: that of Sphinx."""
    parser = argparse.ArgumentParser(prog="python3 -m docs", description="Build the documentation as a site.")
    parser.add_argument("folder", nargs="?", type=Path, default=HERE / "_site", help="folder of the site (docs/_site)")
    parser.add_argument("--serve", nargs="?", type=int, const=PORT, metavar="PORT", help="then serve it, until Ctrl-C")
    given = parser.parse_args(arguments)
    folder = given.folder.resolve()
    if status := built(folder):
        return status
    print(f"the site is at {folder / 'index.html'}", flush=True)
    if given.serve is None:
        print("python3 -m docs --serve shows it in a browser")
    else:
        serve(folder, free_port(LOOPBACK, given.serve))
    return 0


def built(folder: Path) -> int:
    """Sphinx's exit status: 0 where every page was made without a warning."""
    from sphinx.cmd.build import main as build  # noqa: PLC0415 - takes a second

    return int(build(["-q", "-W", "--keep-going", "-b", "html", str(HERE), str(folder)]))


def serve(folder: Path, port: int) -> None:
    """Serve the folder to this machine until interrupted."""
    handler = partial(_Quiet, directory=str(folder))
    with ThreadingHTTPServer((LOOPBACK, port), handler) as server:
        print(f"open http://{LOOPBACK}:{server.server_port}  (Ctrl-C stops it)", flush=True)
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            print("stopped")


class _Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        """Say nothing of each request."""


if __name__ == "__main__":
    raise SystemExit(main())
