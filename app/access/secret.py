"""Secrets that are given out once: an id to find them by, 256 random bits, and only a hash of these is kept."""

from __future__ import annotations

import hashlib
import hmac
import secrets
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Secret:
    """A token, or what a browser's cookie holds."""

    id: str
    bits: str = field(repr=False)

    @classmethod
    def draw(cls, of: str = "") -> Secret:
        """A new one, of this id where it has one already."""
        return cls(of or secrets.token_hex(8), secrets.token_urlsafe(32))

    @classmethod
    def read(cls, text: str) -> Secret | None:
        """The one that a text is, if it can be one."""
        of, dot, bits = text.partition(".")
        return cls(of, bits) if dot and of.isalnum() and text.isascii() and len(text) < 200 else None

    def __str__(self) -> str:
        return f"{self.id}.{self.bits}"

    def hashed(self, key: str = "") -> str:
        """What is kept: nobody can say the secret from it, nor, without the key, whether a secret belongs to it."""
        return hmac.new(key.encode(), self.bits.encode(), hashlib.sha256).hexdigest()

    def is_of(self, kept: str, key: str = "") -> bool:
        """Whether it is the one that this was kept of, in a time that does not depend on how near it is."""
        return same(self.hashed(key), kept)


def same(one: str, other: str) -> bool:
    """Whether two texts are equal, in a time that does not say where they differ."""
    return hmac.compare_digest(one.encode(), other.encode())
