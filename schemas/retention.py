"""What need not be kept: shown first, then removed."""

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field


class RawView(BaseModel):
    """A matrix whose raw runs may go: no set of it is in force, and nobody has needed it for that many days.

    `bytes` are those that go with it; what other matrices share stays with them.
    """

    matrix: str
    serial: str
    created_at: str
    why: Literal["superseded", "never approved"]
    bytes: int


class RetentionView(BaseModel):
    """What the rule would remove: `days` is null where there is none. Whoever confirms sends `digest`."""

    days: int | None
    items: list[RawView]
    bytes: int
    digest: str


class RetentionRequest(BaseModel):
    """To be removed is what was shown with this digest, and nothing else."""

    model_config = ConfigDict(extra="forbid")
    digest: str = Field(max_length=64)
