"""The same POST with the same Idempotency-Key is done once, and answered each time as the first time."""

from app.idempotency.answers import Answer, Key, fingerprint, once
from app.idempotency.queueing import queued_once

__all__ = ["Answer", "Key", "fingerprint", "once", "queued_once"]
