"""Where what takes long is worked out: in this process, or in ones beside it, so that answers are given meanwhile."""

from app.processes.apart import Apart
from app.processes.place import Here, Place, Stopped

__all__ = ["Apart", "Here", "Place", "Stopped"]
