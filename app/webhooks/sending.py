"""One try to reach a webhook: no redirect is followed, and no answer is read."""

from __future__ import annotations

import ssl
from dataclasses import dataclass

import httpx

PATIENCE = 10.0  # s for a receiver to answer


@dataclass(frozen=True)
class Outcome:
    """What came of a try: the status of the answer, if there was one, and what was wrong."""

    status: int | None
    problem: str

    @property
    def well(self) -> bool:
        """Whether it was received."""
        return not self.problem


def client(patience: float = PATIENCE) -> httpx.Client:
    """Asks nobody but the address itself: no proxy of the environment; certificates are those of the system."""
    return httpx.Client(timeout=patience, follow_redirects=False, trust_env=False, verify=ssl.create_default_context())


def send(http: httpx.Client, url: str, body: bytes, headers: dict[str, str]) -> Outcome:
    """Send it."""
    try:
        with http.stream("POST", url, content=body, headers=headers) as answer:
            status = answer.status_code
    except httpx.TimeoutException:
        return Outcome(None, f"no answer within {http.timeout.read:g} s")
    except (httpx.HTTPError, httpx.InvalidURL, OSError) as error:
        return Outcome(None, f"not reached: {str(error)[:200]}")
    if 200 <= status < 300:
        return Outcome(status, "")
    redirects = ", and no redirect is followed" if 300 <= status < 400 else ""
    return Outcome(status, f"it answered {status}{redirects}")
