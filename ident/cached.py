"""What an instance works out once, when it is first asked for."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

__all__ = ["cached_property"]

if TYPE_CHECKING:  # of the same types
    from functools import cached_property
else:

    class cached_property(functools.cached_property):  # noqa: N801 - named as what it stands in for
        """As `functools.cached_property` from Python 3.12 on, which holds no lock while a value is worked out.

        Python 3.11 holds one for all instances of a class: two refits wait for each other's held-out errors where they
        could be worked out side by side, and never come back where one of them needs the cores that the other waits on.
        Threads that ask at once may each work a value out; all are given the first.
        """

        def __get__(self, instance, owner=None):
            if instance is None:
                return self
            held = instance.__dict__
            if self.attrname not in held:
                held.setdefault(self.attrname, self.func(instance))
            return held[self.attrname]
