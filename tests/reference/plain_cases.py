"""The case at which each effect is judged, by the effect's name: that of the class which has its name."""

from __future__ import annotations

import re

from tests.reference import plain_effects, plain_loads
from tests.reference.plain_machine import Case

CASES: dict[str, Case] = {
    re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower(): machine.case
    for name, machine in (vars(plain_effects) | vars(plain_loads)).items()
    if isinstance(machine, type) and "case" in vars(machine)
}
