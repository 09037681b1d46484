"""Models and effects: equations, units, bounds, meaning."""

from typing import Any

from pydantic import BaseModel, ConfigDict, Field


class ParameterView(BaseModel):
    """A parameter and its bounds, SI."""

    name: str
    symbol: str
    unit: str
    lower: float
    upper: float
    value: float
    meaning: str
    source: str


class EquationView(BaseModel):
    """One equation as text and as MathML."""

    place: str
    text: str
    mathml: str
    meaning: str


class ChainSignalView(BaseModel):
    """A signal that an equation of one's own may read: unit (SI), where it arises, what it is without effects.

    Effects at the places `changed_at` may redefine it; those of the library in `changed_by` do.
    """

    name: str
    symbol: str
    unit: str
    meaning: str
    place: str
    equation: str
    changed_at: list[str]
    changed_by: list[str]


class ModelView(BaseModel):
    """A model that can be fitted."""

    name: str
    title: str
    citation: str
    parameters: list[ParameterView]
    equations: list[EquationView]
    signals: list[ChainSignalView]
    notes: list[str]


class EffectView(BaseModel):
    """An effect of the catalogue: the first parameter is its strength, 0 = off; `looks`: what it looks like in data."""

    name: str
    place: str
    meaning: str
    looks: str
    source: str
    parameters: list[ParameterView]
    equations: list[EquationView]


class OwnEffectRequest(BaseModel):
    """An effect to keep under a `name`: a `definition`, made for a `model` or for any, or a term of a `diagnosis`.

    A definition is as `POST /custom-effects` takes it; `proposal` counts the diagnosis's terms from 0. `meaning` takes
    the place of that which it has.
    """

    model_config = ConfigDict(extra="forbid")
    name: str
    definition: dict[str, Any] | str | None = None
    model: str | None = None
    diagnosis: str | None = None
    proposal: int = Field(default=0, ge=0)
    meaning: str = ""


class OwnEffectView(EffectView):
    """An effect of the lab's own. `model` is the one that it was made for, null for any that has what it names.

    `origin` is "written" or "proposed by search"; then there are the `diagnosis`, the hash of its data, the `nats` by
    which other runs confirmed it, the `bar` that they had to exceed, and the forms that the data could not tell from it
    (`class`). `refused` says why this version cannot read the definition, where it cannot.
    """

    model_config = ConfigDict(populate_by_name=True)

    model: str | None
    origin: str
    definition: dict[str, Any]
    diagnosis: str | None
    data_hash: str | None
    nats: float | None
    bar: float | None
    alike: list[str] = Field(alias="class")
    version: str
    created_at: str
    refused: str


class OwnEffectPage(BaseModel):
    """A page of own effects by name."""

    items: list[OwnEffectView]
    next: str | None = None


class Health(BaseModel):
    """The service answers."""

    status: str
    version: str
