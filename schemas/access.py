"""Tokens, display units and the audit."""

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field


class TokenRequest(BaseModel):
    """A token to make: who bears it, for what, and for how long (`90d`, `12h`, `2w`; null: until it is revoked)."""

    model_config = ConfigDict(extra="forbid")
    name: str = Field(max_length=100, pattern=r"^\S(.*\S)?$")
    role: Literal["lab", "line", "ci", "admin"]
    expires: str | None = Field(default=None, max_length=20)


class TokenView(BaseModel):
    """A token without its secret. `state` is valid, expired or revoked; `last_used_at` is exact to a minute."""

    id: str
    name: str
    role: Literal["lab", "line", "ci", "admin"]
    state: Literal["valid", "expired", "revoked"]
    created_at: str
    expires_at: str | None
    revoked_at: str | None
    last_used_at: str | None


class NewToken(TokenView):
    """A token that was just made. `token` is what its bearer shows; it is said once, and null to a repeated request."""

    token: str | None


class TokenPage(BaseModel):
    """A page of tokens, oldest first."""

    items: list[TokenView]
    next: str | None = None


class DisplayUnits(BaseModel):
    """The display units of an account, one a quantity at most; the others are shown in SI units."""

    model_config = ConfigDict(extra="forbid")
    units: list[str] = Field(max_length=50, examples=[["bar", "l/min"]])


class AuditView(BaseModel):
    """A change: when, by which token (its id and name), the operation, what it was done to, and in which request."""

    id: int
    at: str
    token: str
    name: str
    action: str
    object: str
    request: str


class AuditPage(BaseModel):
    """A page of the audit, newest first."""

    items: list[AuditView]
    next: str | None = None
