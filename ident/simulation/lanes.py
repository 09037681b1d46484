"""The lanes of a simulation: those that have come to the same state are simulated once for all of them.

A fit simulates a record from its first state and, for the sensitivities, from others near it. Once what was different
at first has died out, the numbers are the same to the last bit, and stay so: the same code reads the same inputs. Of a
record of a minute that takes about a second.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.simulation.kernel import LANES, WIDE

Array = NDArray[np.float64]
Places = NDArray[np.int64]
_MANY = 500_000
"""Steps of all lanes of a simulation from which a kernel of sixteen lanes is worth its compilation. Why: such a
simulation takes a millisecond less, and the compilation twenty, which a refit or two make good.

Test: tests/simulation/test_lanes.py::test_a_kernel_of_sixteen_lanes_is_compiled_for_what_takes_many_steps"""


@dataclass(frozen=True)
class Lanes:
    """Lanes that are simulated side by side: the first `used` of them, the others are spare.

    `buffers` are the kernel's buffers, those of sixteen lanes one after the other, flat; `command_at` and `force_at`
    (lanes,) are where each lane begins in its inputs, `steps` those that each takes in all. `of` (shown,) is the lane
    that each output is read from, None where that is the lane of its own number.
    """

    buffers: Array
    command_at: Places
    force_at: Places
    used: int
    steps: int
    of: NDArray[np.intp] | None = None

    @property
    def count(self) -> int:
        """The number of lanes, spare ones among them."""
        return len(self.command_at)

    @property
    def wide(self) -> int:
        """The lanes of one group, those of a kernel: sixteen cost little more than eight, where there are as many."""
        return LANES if self.used > WIDE and self.used * self.steps >= _MANY else WIDE

    @property
    def groups(self) -> int:
        """The number of groups that are simulated."""
        return -(-self.used // self.wide)

    def shown(self, rows: Array, count: int) -> Array:
        """The outputs (samples, count) of what was asked for, from those of the lanes, (samples, lanes)."""
        return rows[:, :count] if self.of is None else rows.take(self.of, axis=1)

    def joined(self) -> Lanes:
        """The same with one lane for all that go on alike, where that leaves fewer operations on eight lanes.

        They hold the same numbers, and begin at the same place of the same inputs.
        """
        by_sixteen = self.buffers.reshape(-1, len(self.buffers) // self.count, LANES)
        columns = by_sixteen.transpose(0, 2, 1).reshape(self.count, -1)
        first: dict[tuple[bytes, int, int], int] = {}
        of = [
            first.setdefault((columns[i].tobytes(), int(self.command_at[i]), int(self.force_at[i])), len(first))
            for i in range(self.used)
        ]
        if -(-len(first) // WIDE) >= -(-self.used // WIDE):
            return self
        kept = np.unique(of, return_index=True)[1]
        kept = np.pad(kept, (0, -len(kept) % LANES), mode="edge")
        buffers = columns[kept].reshape(-1, LANES, columns.shape[1]).transpose(0, 2, 1).ravel()
        read = np.array(of)[np.arange(self.used) if self.of is None else self.of]
        return Lanes(buffers, self.command_at[kept], self.force_at[kept], len(first), self.steps, read)
