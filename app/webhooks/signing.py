"""What is sent to a webhook: a body, signed together with the moment at which it is sent."""

from __future__ import annotations

import hashlib
import hmac

ID, EVENT = "X-Servoident-Delivery", "X-Servoident-Event"
TIMESTAMP, SIGNATURE = "X-Servoident-Timestamp", "X-Servoident-Signature"


def signature(secret: str, timestamp: int, body: bytes) -> str:
    """HMAC-SHA256 of `TIMESTAMP.BODY` under the secret, in hexadecimal digits (RFC 2104)."""
    return "sha256=" + hmac.new(secret.encode(), b"%d." % timestamp + body, hashlib.sha256).hexdigest()


def headers(secret: str, delivery: str, event: str, timestamp: int, body: bytes) -> dict[str, str]:
    """Of one try: the delivery's id, which stays the same at each, the time in s since 1970, and the signature."""
    return {
        "Content-Type": "application/json",
        "User-Agent": "servoident",
        ID: delivery,
        EVENT: event,
        TIMESTAMP: str(timestamp),
        SIGNATURE: signature(secret, timestamp, body),
    }
