"""`python3 -m docs` says where the site is, and serves it where that is asked."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from docs import build

ROOT = Path(__file__).resolve().parents[1]


def test_the_address_of_the_site_is_said(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """As a whole path, and how to see it; where Sphinx fails its status is the command's."""
    made: list[Path] = []
    monkeypatch.setattr(build, "built", lambda folder: made.append(folder) or 0)
    assert build.main([]) == 0
    said = capsys.readouterr().out
    assert f"the site is at {ROOT / 'docs' / '_site' / 'index.html'}" in said
    assert "--serve" in said
    assert made == [ROOT / "docs" / "_site"]
    monkeypatch.setattr(build, "built", lambda _: 2)
    assert build.main([]) == 2
    assert capsys.readouterr().out == ""


def test_the_site_is_served_until_it_is_interrupted(tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text("<h1>the site</h1>")
    code = (
        "import signal, sys; from pathlib import Path; from docs.build import serve; "
        "signal.signal(signal.SIGINT, signal.default_int_handler); "  # which tests in the background have not
        "serve(Path(sys.argv[1]), 0)"
    )
    serving = subprocess.Popen(
        [sys.executable, "-u", "-c", code, str(tmp_path)], cwd=ROOT, stdout=subprocess.PIPE, text=True
    )
    try:
        assert serving.stdout is not None
        address = re.search(r"http://\S+", serving.stdout.readline())
        assert address is not None
        assert "the site" in httpx.get(f"{address[0]}/").text
        serving.send_signal(signal.SIGINT)
        assert serving.wait(20) == 0
        assert serving.stdout.read() == "stopped\n"
    finally:
        serving.kill()
