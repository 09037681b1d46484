"""Secrets of webhooks: made of one key and the id of the webhook, so that none of them is in the database.

A signature needs the secret itself, so that a hash would not do. The key is a file of the data folder, which nobody
else can read, or SERVOIDENT_WEBHOOK_KEY where several machines send; it is in no dump and in no backup.
"""

from __future__ import annotations

import base64
import hashlib
import hmac
import os
import secrets
from contextlib import suppress
from dataclasses import dataclass, field

from app.settings import Settings
from ident.errors import Unusable

NAME = "webhook.key"
_SHORTEST = 32  # characters of a key that is given


@dataclass(frozen=True)
class Key:
    """What secrets are made of."""

    bits: bytes = field(repr=False)

    @property
    def print(self) -> str:
        """What tells it from others without saying it."""
        return hmac.new(self.bits, b"print", hashlib.sha256).hexdigest()[:32]

    def secret(self, webhook: str) -> str:
        """The secret of a webhook."""
        made = hmac.new(self.bits, f"webhook {webhook}".encode(), hashlib.sha256).digest()
        return base64.urlsafe_b64encode(made).decode().rstrip("=")


def key_of(settings: Settings) -> Key:
    """The key of a service, drawn where there is none yet. Raises Unusable where one that is given is short."""
    given = settings.webhook_key
    if given and len(given) < _SHORTEST:
        raise Unusable(
            "short-key",
            f"it has {len(given)} characters where {_SHORTEST} are needed",
            "SERVOIDENT_WEBHOOK_KEY",
            "draw one with `servoident token`",
        )
    if given:
        return Key(given.encode())
    file = settings.data / NAME
    if not file.exists():
        drawn = file.with_suffix(f".{secrets.token_hex(8)}")
        drawn.touch(mode=0o600)
        drawn.write_bytes(secrets.token_bytes(32))
        with suppress(FileExistsError):  # of two that draw one at the same moment the first has it
            os.link(drawn, file)
        drawn.unlink()
    return Key(file.read_bytes())
