"""The same POST with the same Idempotency-Key is done once, and answered each time as the first time."""

from app.idempotency.answers import Answer, Key, fingerprint, once

__all__ = ["Answer", "Key", "fingerprint", "once"]
