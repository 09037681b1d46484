"""The limits of a rig as they are written: in matrix.yaml, in a profile of the laboratory, in a file of their own.

rig:
  stroke: 152.4 mm            # from one end to the other
  speed: 0.5 m/s
  acceleration: 30 m/s^2      # g and G are 9.80665 m/s² here
  force: 9.8 kN
  flow: 38 l/min              # of the valve
  supply_pressure: 207 bar
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ident.errors import Unusable
from ident.readers.strict_yaml import read_yaml
from ident.readers.typed_fields import Fields
from ident.rig.limits import DIMENSIONS, RigLimits

KEY = "rig"
_LARGEST = 1_000_000  # bytes


def rig_of(data: Any, where: str = KEY) -> RigLimits:
    """The limits of a mapping. Raises Unusable with the field at fault, and where no limit is stated."""
    limits = Fields(data, where, tuple(DIMENSIONS))
    found = RigLimits(**{name: limits.positive(name, dimension) for name, dimension in DIMENSIONS.items()})
    if not found:
        raise Unusable("no-limits", "no limit is stated", where, f"state one of {', '.join(DIMENSIONS)}")
    return found


def rig_in(text: bytes, where: str) -> RigLimits:
    """The limits in the text of a file: under `rig:`, as in a matrix.yaml or a profile, or by themselves.

    Raises Unusable with the field at fault.
    """
    data = read_yaml(text, where)
    if isinstance(data, Mapping) and KEY in data:
        return rig_of(data[KEY], f"{where} {KEY}")
    return rig_of(data, where)


def read_rig(path: Path | str) -> RigLimits:
    """The limits in a YAML file, see :func:`rig_in`. Raises Unusable."""
    path = Path(path)
    if not path.is_file():
        raise Unusable("no-such-file", "the file does not exist", str(path), "give a YAML file with the rig's limits")
    if path.stat().st_size > _LARGEST:
        raise Unusable("too-large", "too long to be a description", str(path), "give a YAML file")
    return rig_in(path.read_bytes(), str(path))
