"""Models and effects: equations, units, bounds, meaning."""

from pydantic import BaseModel


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


class ModelView(BaseModel):
    """A model that can be fitted."""

    name: str
    title: str
    citation: str
    parameters: list[ParameterView]
    equations: list[EquationView]
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


class Health(BaseModel):
    """The service answers."""

    status: str
    version: str
