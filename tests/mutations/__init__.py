"""Small defects put into a copy of the source on purpose: the tests have to find every one.

`python -m tests.mutations [NAME …]` runs the list, or the named ones, and ends with 1 where one survives.
"""

from tests.mutations.data import DATA
from tests.mutations.estimation import ESTIMATION
from tests.mutations.machine import MACHINE
from tests.mutations.mutation import Mutation
from tests.mutations.regress import REGRESS
from tests.mutations.service import SERVICE

MUTATIONS: tuple[Mutation, ...] = (*MACHINE, *ESTIMATION, *DATA, *SERVICE, *REGRESS)

__all__ = ["MUTATIONS", "Mutation"]
