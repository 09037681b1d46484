"""The courier: a thread that brings what waits to the webhooks, one process at a time to each.

A delivery that fails is tried again after a growing wait, for a day; where nobody answers at all, what else waits for
the same webhook waits as long.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from datetime import UTC, datetime, timedelta

import httpx
from sqlalchemy.orm import Session, sessionmaker

from app.settings import Settings
from app.tables import DeliveryRow, WebhookRow
from app.webhooks import repository
from app.webhooks.hosts import origins
from app.webhooks.key import Key, key_of
from app.webhooks.sending import Outcome, client, send
from app.webhooks.signing import headers

LOOK = 1.0  # s between two looks at what waits
LEASE = timedelta(seconds=60)  # for which a webhook is one process's own, from each try on
FIRST, GROWS, LONGEST = 5, 4, 3600  # s between tries
KEPT = timedelta(hours=24)  # for which a delivery is tried
SHOWN = timedelta(days=7)  # for which one that has ended is still shown
_A_TURN = 50  # deliveries to one webhook before the others' turn
_TIDIED = timedelta(minutes=1)  # between two looks at what is too old
_log = logging.getLogger("servoident")


def wait_after(tries: int) -> timedelta:
    """How long to wait after so many tries: 5 s, 20 s, 80 s, 5 min 20 s, 21 min 20 s, then an hour."""
    return timedelta(seconds=min(FIRST * GROWS ** min(tries - 1, 10), LONGEST))


class Courier:
    """Brings what waits, where the operator named any host at all. `clock` and `http` are exchanged by tests."""

    def __init__(
        self,
        sessions: sessionmaker[Session],
        settings: Settings,
        clock: Callable[[], datetime] | None = None,
        http: httpx.Client | None = None,
    ) -> None:
        self.sessions, self.settings, self.http = sessions, settings, http
        self.clock = clock or (lambda: datetime.now(UTC))
        self.origins = origins(settings.webhook_hosts)
        self._tidied: datetime | None = None
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="courier", daemon=True)

    def start(self) -> None:
        """Begin, where there is any host to go to."""
        if self.origins:
            self._thread.start()

    def stop(self) -> None:
        """End after the try that is under way; what is not noted by then is tried again."""
        self._ended.set()
        if self._thread.is_alive():
            self._thread.join(1.0)

    def _run(self) -> None:
        self.http = self.http or client()
        key = key_of(self.settings)
        while not self._ended.wait(LOOK):
            try:
                self.round(key)
            except Exception as error:
                _log.warning("webhooks cannot be delivered now: %s", str(error).partition("\n")[0])

    def round(self, key: Key) -> None:
        """Bring all that is due."""
        self._tidy()
        with self.sessions() as session:
            due = repository.is_due(session, self.origins, key.print, _text(self.clock()))
        while due and not self._ended.is_set():
            moment = self.clock()
            with self.sessions.begin() as session:
                claimed = repository.claim(session, self.origins, key.print, _text(moment), _text(moment + LEASE))
            if claimed is None:
                return
            self._bring(*claimed, key)

    def _bring(self, webhook: WebhookRow, lease: int, key: Key) -> None:
        """What is due to one webhook, the oldest first."""
        secret, goes_on, brought = key.secret(webhook.id), True, 0
        while goes_on and brought < _A_TURN and not self._ended.is_set():
            moment = self.clock()
            with self.sessions.begin() as session:
                delivery = repository.next_of(session, webhook.id, _text(moment))
                if delivery is None or not repository.hold(session, webhook.id, lease, _text(moment + LEASE)):
                    break
            goes_on, brought = self._try(webhook, delivery, secret), brought + 1
        with self.sessions.begin() as session:
            repository.hold(session, webhook.id, lease, _text(self.clock()))

    def _try(self, webhook: WebhookRow, delivery: DeliveryRow, secret: str) -> bool:
        """One try; False where nobody answers there."""
        assert self.http is not None
        body, timestamp = delivery.body.encode(), int(self.clock().timestamp())
        outcome = send(self.http, webhook.url, body, headers(secret, delivery.id, delivery.event, timestamp, body))
        self._note(delivery, outcome)
        return outcome.status is not None

    def _note(self, delivery: DeliveryRow, outcome: Outcome) -> None:
        moment = self.clock()
        again = _text(moment + wait_after(delivery.tries + 1))
        found: dict[str, object] = {"status": outcome.status, "problem": outcome.problem}
        ended = {"state": "delivered", "ended_at": _text(moment)} if outcome.well else {"next_at": again}
        with self.sessions.begin() as session:
            repository.note(session, delivery.id, **found, **ended)
            if outcome.status is None:
                repository.put_off(session, delivery.webhook, again)
        if not outcome.well:
            _log.warning("webhook %s: %s", delivery.webhook, outcome.problem)

    def _tidy(self) -> None:
        moment = self.clock()
        if self._tidied is not None and moment - self._tidied < _TIDIED:
            return
        self._tidied = moment
        with self.sessions.begin() as session:
            repository.give_up(session, _text(moment - KEPT), _text(moment))
            repository.forget(session, _text(moment - SHOWN))


def _text(moment: datetime) -> str:
    """As the tables have it."""
    return moment.isoformat(timespec="microseconds")
