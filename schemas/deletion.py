"""The deletion of a fit."""

from pydantic import BaseModel, Field


class DeletionView(BaseModel):
    """What goes with a fit that is deleted, or what forbids its deletion."""

    fit: str
    serial: str
    kept_by: list[str] = Field(
        default_factory=list, description="Why the fit cannot be deleted; empty where nothing forbids it"
    )
    made_of: dict[str, int] = Field(
        default_factory=dict, description="How many diagnoses, controllers and so on are deleted with it, by kind"
    )
