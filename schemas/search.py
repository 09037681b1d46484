"""What a search found."""

from pydantic import BaseModel, Field


class FoundActuator(BaseModel):
    """An actuator whose serial number, name or batch holds the text."""

    serial: str
    name: str
    batch: str


class FoundDataSet(BaseModel):
    """A data set whose id begins with the text."""

    matrix: str
    serial: str
    created_at: str


class FoundFit(BaseModel):
    """A fit whose id begins with the text, or whose name, tags or note hold it."""

    fit: str
    serial: str
    model: str
    created_at: str
    name: str
    tags: list[str]


class SearchView(BaseModel):
    """What holds the text; of each kind at most as many as were asked for."""

    text: str
    actuators: list[FoundActuator] = Field(default_factory=list)
    data_sets: list[FoundDataSet] = Field(default_factory=list)
    fits: list[FoundFit] = Field(default_factory=list)
