"""Where what takes long is worked out: in this process, or in ones beside it, so that answers are given meanwhile."""

from app.processes.place import Here, Place, Stopped
from app.processes.worker_processes import WorkerProcesses

__all__ = ["Here", "Place", "Stopped", "WorkerProcesses"]
