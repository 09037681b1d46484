from typing import Any

class Generator(Any): ...  # type: ignore[misc]

def __getattr__(name: str) -> Any: ...
