"""What people write on a fit."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Tag = Annotated[str, Field(max_length=40)]


class AnnotationRequest(BaseModel):
    """A name, tags and a note; empty ones take what was there away."""

    model_config = ConfigDict(extra="forbid")
    name: str = Field(default="", max_length=100)
    tags: list[Tag] = Field(default_factory=list, max_length=20)
    note: str = Field(default="", max_length=5000)


class AnnotationView(BaseModel):
    """What is written on a fit, by whom and since when; empty where nothing is."""

    name: str = ""
    tags: list[str] = Field(default_factory=list)
    note: str = ""
    who: str = ""
    changed_at: str | None = None
