"""The example of a proxy, as documented, in front of a service: TLS outside, addresses and sessions as they are."""

from __future__ import annotations

import shutil
import ssl
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from tests.conftest import ROOT
from tests.running import TOKEN, WAIT, free_port

NEEDED = {"nginx": "nginx-light", "openssl": "openssl"}
ABSENT = [package for program, package in NEEDED.items() if shutil.which(program) is None]
pytestmark = pytest.mark.skipif(bool(ABSENT), reason=f"not installed (apt-get install {' '.join(ABSENT)})")
AROUND = "daemon off; pid {folder}/pid; error_log stderr; events {{}} http {{ {temporary} {server} }}"
TEMPORARY = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
SERVE = """
import sys
from pathlib import Path
from app.main import run
from app.settings import Settings
run(Settings(data=Path(sys.argv[1]), port=int(sys.argv[2]), token=sys.argv[3], allowed_hosts=("lab.example",),
             proxies=("127.0.0.1",)))
"""


def configuration(folder: Path, outside: int, inside: int) -> Path:
    """The documented file with ports and certificate of the test, in a file that nginx starts with."""
    server = (ROOT / "docs" / "proxy" / "nginx.conf").read_text(encoding="utf-8")
    changes = {
        "listen 443 ssl": f"listen 127.0.0.1:{outside} ssl",
        "127.0.0.1:8000": f"127.0.0.1:{inside}",
        "/etc/ssl/certs/lab.example.pem": f"{folder}/certificate",
        "/etc/ssl/private/lab.example.key": f"{folder}/key",
    }
    for before, after in changes.items():
        assert server.count(before) == 1
        server = server.replace(before, after)
    temporary = " ".join(f"{name}_temp_path {folder}/{name};" for name in TEMPORARY)
    file = folder / "nginx.conf"
    file.write_text(AROUND.format(folder=folder, temporary=temporary, server=server))
    return file


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With a certificate of its own for the name of the example."""
    made: Path = tmp_path_factory.mktemp("proxy")
    names = ["-subj", "/CN=lab.example", "-addext", "subjectAltName=DNS:lab.example"]
    files = ["-keyout", made / "key", "-out", made / "certificate"]
    command = ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", *names]
    subprocess.run([*command, *files], check=True, capture_output=True)
    return made


@pytest.fixture(scope="module")
def outside(folder: Path) -> Iterator[httpx.Client]:
    """A client that speaks TLS to the proxy by the name of the example."""
    own, behind = free_port(), free_port()
    with (folder / "said").open("w") as said:
        serving = [sys.executable, "-c", SERVE, str(folder / "data"), str(behind), TOKEN]
        started = [
            subprocess.Popen(serving, stdout=said, stderr=said),
            subprocess.Popen(["nginx", "-p", str(folder), "-c", str(configuration(folder, own, behind))], stderr=said),
        ]
        trusted = ssl.create_default_context(cafile=str(folder / "certificate"))
        headers = {"Host": "lab.example"}
        try:
            with httpx.Client(base_url=f"https://127.0.0.1:{own}", headers=headers, verify=trusted) as client:
                _wait(client)
                yield client
        finally:
            for process in started:
                process.terminate()
                process.wait(WAIT)


def _wait(client: httpx.Client) -> None:
    deadline = time.monotonic() + WAIT
    while time.monotonic() < deadline:
        try:
            if asked(client, "GET", "/api/v1/ready").status_code == 200:
                return
        except httpx.TransportError:
            pass
        time.sleep(0.1)
    raise TimeoutError("the service behind the proxy did not start")


def asked(client: httpx.Client, method: str, path: str, **content: object) -> httpx.Response:
    return client.request(method, path, extensions={"sni_hostname": "lab.example"}, **content)  # type: ignore[arg-type]


def test_the_example_serves_over_tls_with_a_session_that_is_sent_over_tls_only(outside: httpx.Client) -> None:
    """The form signs in, the cookie is Secure, pages are shown, and the browser is told to stay with TLS."""
    answer = asked(outside, "POST", "/sign-in", data={"token": TOKEN}, headers={"Origin": "https://lab.example"})
    assert answer.status_code == 303
    assert "; secure" in answer.headers["set-cookie"].lower()
    assert "max-age" in answer.headers["strict-transport-security"]
    shown = asked(outside, "GET", "/", headers={"Accept": "text/html"})
    assert shown.status_code == 200
    assert len(shown.headers["X-Request-ID"]) == 32


def test_what_a_client_says_of_its_address_is_not_believed(outside: httpx.Client) -> None:
    """Wrong tokens are counted for the address that the proxy sees."""
    for number in range(40):
        headers = {"Authorization": "Bearer wrong", "X-Forwarded-For": f"10.0.0.{number}"}
        status = asked(outside, "GET", "/api/v1/models", headers=headers).status_code
        if status == 429:
            break
        assert status == 401
    assert status == 429


def test_nothing_that_was_said_holds_the_token(outside: httpx.Client, folder: Path) -> None:
    """What the service and the proxy wrote while it was shown: in a header, a form and an address."""
    asked(outside, "GET", "/api/v1/models", headers={"Authorization": f"Bearer {TOKEN}"})
    asked(outside, "GET", f"/?token={TOKEN}")
    assert TOKEN not in (folder / "said").read_text()
