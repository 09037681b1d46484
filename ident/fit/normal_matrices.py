"""A run against a model in the time domain, exactly: residual and sensitivities of the whole record.

For systems that run side by side, the first the model itself, the others each with one parameter moved by a step,
the record yields the sums of products of [J, N, r]: J = ∂y/∂θ, r = x_m − y, N what is free in every record (its mean
and, where it starts moving, the decay of its unknown first state).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.products import add_products, completed, removal, shares_of, without
from ident.linear import LinearModel
from ident.rounding import TINY
from ident.run import Run
from ident.simulation.intersample_command import at_nodes
from ident.simulation.recursion import Recursion, discretise, respond, responses

Array = NDArray[np.float64]
_OF, _OFFSETS = FIT_CRITERIA.first_states, FIT_CRITERIA.offsets


@dataclass(frozen=True)
class NormalMatrices:
    """Σ of products of [J, r] with the nuisances projected out, (p+1, p+1), and the score JᵀR of each block, (b, p).

    `total` is Σ (x_m − mean)²; `offset` the difference of means over the standard deviation; `release` how much of
    each nuisance but the mean the record holds; `means` the means of [J, r], `length` the number of samples; `blocks`
    the sums of products of [J, N, 1, r] of each block, before anything is projected out, (b, q, q), and `remove` what
    does so, (q, p+1), see :func:`ident.fit.products.removal`; `share` is what the run counts in a mean over runs.
    `transducer` is the channel whose offset the run shares with others, "" where its zero is its own; where the mean is
    `counted`, it counts in what is fitted, and `mean_power` is its part of the residual's power: see
    :mod:`ident.fit.transducer`. `rest` is what is known of the offset where the run begins: a value, and its standard
    error.
    """

    gram: Array
    scores: Array
    total: float
    offset: float
    release: Array = field(default_factory=lambda: np.empty(0))
    means: Array = field(default_factory=lambda: np.empty(0))
    length: int = 0
    blocks: Array = field(default_factory=lambda: np.empty((0, 0, 0)), repr=False)
    remove: Array = field(default_factory=lambda: np.empty((0, 0)), repr=False)
    share: float = 1.0
    transducer: str = ""
    counted: bool = False
    mean_power: float = 0.0
    rest: tuple[float, float] | None = None

    @cached_property
    def error(self) -> float:
        """Eq. (17) of the run."""
        return _root(self.centred, self.total)

    @cached_property
    def loss(self) -> float:
        """What is fitted: eq. (17), or with the mean where it counts."""
        return _root(float(self.gram[-1, -1]), self.total)

    @property
    def centred(self) -> float:
        """Σ r² about the mean."""
        return float(self.gram[-1, -1] - self.mean_power)

    @property
    def settled(self) -> bool:
        """Whether better first states, if any are free, would explain next to nothing more of the residual."""
        if not len(self.release):
            return True
        return bool(self.centred > (1.0 - _OF.settled) * self.power)

    @property
    def promises(self) -> bool:
        """Whether better first states would explain much of the residual, were the model straight up to them."""
        return bool(len(self.release)) and bool(self.centred < (1.0 - _OF.much) * self.power)

    @property
    def power(self) -> float:
        """Σ r², less the mean, from the first states as they are: infinite of a model that ran away."""
        if not len(self.remove):
            return np.inf
        total = self.blocks.sum(axis=0)
        constant, shared, power = total[-2, -2], total[-2, -1], total[-1, -1]
        return float(power - shared**2 / constant if constant > 0 else power)

    def step(self, damping: float) -> Array:
        """How far to go on with each first state that is free: damped along those that hardly change the shape.

        One that moves the whole record, as a position does in saturation, is seen by its mean alone, which is free.
        """
        total, p = self.blocks.sum(axis=0), self.remove.shape[1] - 1
        gram, shared, constant = total[p:-2, p:-2], total[p:-2, [-2]], total[-2, -2]
        free = shared / constant if constant > 0 else np.zeros(shared.shape)
        shape, towards = gram - free @ shared.T, total[p:-2, -1] - free[:, 0] * total[-2, -1]
        size = np.sqrt(np.maximum(np.diag(gram), TINY))
        ridge = damping * np.eye(len(size))
        return np.asarray(np.linalg.solve(shape / size / size[:, None] + ridge, towards / size) / size)

    def as_begun(self) -> NormalMatrices:
        """The same with the error of the first states as they are, where better ones only promise a smaller one."""
        if not self.promises:
            return self
        gram = self.gram.copy()
        gram[-1, -1] = self.power
        return replace(self, gram=gram)

    @cached_property
    def _level(self) -> Array:
        """The constant with the other nuisances taken off, in [J, N, 1, r], (q,)."""
        total, p = self.blocks.sum(axis=0), self.remove.shape[1] - 1
        free = slice(p, len(total) - 2)
        level = np.zeros(len(total))
        level[-2] = 1.0
        if len(self.release):
            shares = shares_of(total[None, free, free], total[None, free, -2, None], np.array([self.total]))
            level[free] = -shares[0, :, 0]
        return level

    @cached_property
    def informing(self) -> float:
        """How many samples tell the mean: all of them where no first state does the same."""
        return float(self._level @ self.blocks.sum(axis=0) @ self._level)

    @property
    def _offset_determined(self) -> bool:
        """Whether the offset is beyond chance, by its standard error from the sums over blocks."""
        offset = self.offset * np.sqrt(self.total / self.length)
        scatter = float(np.linalg.norm(self.sums_about(self.means[-1])))
        return bool(abs(offset) * self.informing > _OFFSETS.recognised * scatter)

    def tells_offset(self, least: float) -> bool:
        """Whether the record tells an offset from all that its first states may do.

        Of fewer than a share `least` of the samples it does not, of more than the share `alike` it does. Between them
        it does where the offset is determined.
        """
        share = self.informing / max(self.length, 1)
        return share > _OFFSETS.alike or (share > least and self._offset_determined)

    def begun_at_zero(self) -> Array | None:
        """The sums of the blocks, (b, q, q), without the first state that does nearly the same as an offset.

        None where no first state does anything of an offset.

        A speed lasts by a first state alone where a force lasts: that of a spring so weak that the record shows nothing
        of it, stretched without end. Its first position is zero, and what lasts is the offset.
        """
        total, p = self.blocks.sum(axis=0), self.remove.shape[1] - 1
        alike = total[p:-2, -2] ** 2 / np.maximum(np.diag(total)[p:-2], TINY)
        if not np.max(alike, initial=0.0) > 0:
            return None
        blocks, most = self.blocks.copy(), p + int(np.argmax(alike))
        blocks[:, most, :] = blocks[:, :, most] = 0.0
        return blocks

    def begun_without_offset(self) -> NormalMatrices:
        """The same with what the first states do as well as an offset left to them: then they tell the mean alone.

        The first position of a machine that integrates moves its whole record, as an offset does. Of both together
        only the sum is known, and the least squares of least norm would share it between them by chance. One with a
        weak spring forgets it so slowly that the difference of both is hardly known: it would be any number.
        """
        p = self.remove.shape[1] - 1
        alike = -self._level[p:-2]  # what of each first state does the same as an offset of 1
        size = np.sqrt(self.total / self.length)
        release = self.release + self.offset * size * alike
        if self.informing <= _OFFSETS.told * self.length:
            return replace(self, release=release, offset=0.0, means=np.zeros_like(self.means))
        return replace(self.about(self.means)._centred(), release=release)

    def _centred(self) -> NormalMatrices:
        """The same about the means of [J, r], with what else is projected out as it is."""
        total, p = self.blocks.sum(axis=0), self.remove.shape[1] - 1
        means = total[-2] @ self.remove / self.length
        remove = self.remove.copy()
        remove[-2] -= means
        gram = self.gram - self.length * np.outer(means, means)
        scores = (self.blocks @ remove[:, -1]) @ remove[:, :p]
        offset = float(means[-1] / np.sqrt(self.total / self.length))
        return replace(self, gram=gram, remove=remove, scores=scores, means=means, offset=offset, mean_power=0.0)

    def about(self, means: Array) -> NormalMatrices:
        """The same with the mean counted: [J, r] have these means, (p+1,)."""
        p, remove = len(means) - 1, self.remove + np.outer(self._level, means)
        scores = (self.blocks @ remove[:, -1]) @ remove[:, :p]
        gram = self.gram + self.informing * np.outer(means, means)
        return replace(self, gram=gram, remove=remove, scores=scores, mean_power=self.informing * float(means[-1]) ** 2)

    def sums_about(self, offset: float) -> Array:
        """Σ of the residual less an offset over each block, the other nuisances taken off, (b,)."""
        own = 0.0 if self.mean_power else 1.0  # the residual is about its mean, or about the offset, already
        return np.asarray(
            (self.blocks @ (self.remove[:, -1] + own * self._level * (self.means[-1] - offset))) @ self._level
        )

    def errors_beside(self, steps: Array) -> Array:
        """Eq. (17) at steps (v, p) from the point where the model is as straight as here, |r − J s|/|x_m|, (v,)."""
        both = np.column_stack([-steps, np.ones(len(steps))])
        squares = np.einsum("vi,ij,vj->v", both, self.gram, both)
        return np.asarray(np.sqrt(np.maximum(squares, 0.0) / self.total))


def block_length(run: Run) -> int:
    """Samples of each block of a record, of which there are so many, or fewer of a short one."""
    return max(_OF.shortest_block, -(-run.length // _OF.blocks))


def normal_matrices(run: Run, model: LinearModel, strides: Array) -> NormalMatrices:
    """The moments of a run for a batch of models (1 + p,): the model, and p neighbours, each a stride (p,) away."""
    systems = _begun(run, model)
    return normal_matrices_of([run], _products(run, systems, strides)[None], len(strides))[0]


def errors_of(run: Run, model: LinearModel) -> Array:
    """Eq. (17) of each model of a batch, (v,), infinite where it ran away: many at once, without sensitivities."""
    if run.begins == "moving":
        return _errors_moving(run, discretise(model, run.sample_rate, run.hold))
    measured, sums = run.centred, np.zeros((2, len(model.B)))
    for rows, first, last in responses(_begun(run, model), at_nodes(run)):
        residual = measured[first:last, None] - rows[: last - first, : len(model.B)]
        sums += residual.sum(axis=0), np.einsum("nv,nv->v", residual, residual)
    found = np.sqrt(np.maximum(sums[1] - sums[0] ** 2 / run.length, 0.0) / run.power)
    return np.where(np.isfinite(found), found, np.inf)


def _errors_moving(run: Run, systems: Recursion) -> Array:
    """The same of a record that starts moving: each model has decays of its own first state, which fit best."""
    n, count = systems.C.shape[1], len(systems.D)
    places = np.concatenate([np.arange(count)[:, None], count + np.arange(count * n).reshape(count, n)], axis=1)
    both = systems.beside(_releases(systems)).at(places.ravel())  # each model, then its decays
    sums = np.zeros((count, n + 2, n + 2))
    for rows, first, last in responses(both, at_nodes(run)):
        outputs = rows[: last - first, : both.D.size].reshape(-1, count, n + 1)
        add_products(outputs, np.repeat(run.centred[first:last, None], count, axis=1), 0, sums)
    found = normal_matrices_of([run] * count, completed(sums, np.empty(0))[:, None], 0)
    return np.array([one.error for one in found])


def normal_matrices_of(runs: Sequence[Run], blocks: Array, p: int) -> list[NormalMatrices]:
    """The moments of runs from sums of products of [J, N, 1, r] of each block, (runs, b, q, q), of mean-free runs."""
    means, totals = np.array([(run.mean, run.power) for run in runs]).T
    gram = blocks.sum(axis=1)
    sound = np.all(np.isfinite(gram), axis=(1, 2)) & ~(gram[:, -1, -1] > _OF.escaped * totals)
    remove = removal(np.where(sound[:, None, None], gram, 0.0), p, totals)
    with np.errstate(invalid="ignore", over="ignore"):
        projected = without(remove, gram)
        scores = (blocks @ remove[:, None, :, -1:])[..., 0] @ remove[:, :, :p]
    release = -remove[:, p:-1]  # of each nuisance in each of [J, r], the constant last
    release[:, -1, -1] += means
    found = [
        escaped(p, blocks.shape[1])
        if not sound[i]
        else NormalMatrices(
            projected[i],
            scores[i],
            float(totals[i]),
            float(release[i, -1, -1] / np.sqrt(totals[i] / run.length)),
            release[i, :-1, -1],
            release[i, -1],
            run.length,
            blocks[i],
            remove[i],
            run.share,
            "" if run.zeroed.get(run.output) else run.output,
            run.mean_counts,
            rest=run.zero_at_rest if run.mean_counts else None,
        )
        for i, run in enumerate(runs)
    ]
    return [_separated(run, one) for run, one in zip(runs, found, strict=True)]


def at_point(run: Run, found: NormalMatrices) -> NormalMatrices:
    """The moments of a run without those of sensitivities: as a simulation of the point alone has them, to the bit."""
    if not len(found.blocks):  # it ran away
        return found
    first = found.remove.shape[1] - 1
    return normal_matrices_of((run,), found.blocks[None, :, first:, first:].copy(), 0)[0]


def _separated(run: Run, found: NormalMatrices) -> NormalMatrices:
    """The moments of a run whose offset and first states differ in their effect, or without one of them."""
    of_speed = run.output == "velocity"
    if not len(found.release) or found.tells_offset(_OFFSETS.lets_go if of_speed else _OFFSETS.told):
        return found
    if not of_speed:
        return found.begun_without_offset()
    blocks = found.begun_at_zero()
    return found if blocks is None else normal_matrices_of([run], blocks[None], found.remove.shape[1] - 1)[0]


def escaped(p: int, blocks: int = 0) -> NormalMatrices:
    """Of a model that ran away, or that nothing can follow."""
    return NormalMatrices(np.full((p + 1, p + 1), np.inf), np.zeros((blocks, p)), 1.0, np.inf)


def _root(power: float, total: float) -> float:
    """√(power/total), infinite where it is no number."""
    value = float(np.sqrt(max(power, 0.0) / total))
    return value if np.isfinite(value) else np.inf


def first_state(run: Run, model: LinearModel) -> Array:
    """The state in which the record begins, (n,): at rest, in equilibrium, or where it starts moving what fits best."""
    systems = _begun(run, model)
    if run.begins != "moving":
        return np.asarray(systems.start[0])
    released = _released(run, systems)
    return np.asarray(np.diag(systems.start[1:]) * released) if len(released) else np.zeros(len(model.B[0]))


def output(run: Run, model: LinearModel) -> Array:
    """The model's output over the record, (n,), with the best first state where the record starts moving.

    The offset between model and record is left in: it is a result of its own.
    """
    systems = _begun(run, model)
    y = respond(systems, at_nodes(run))
    released = _released(run, systems) if len(y) > 1 else np.empty(0)
    return np.asarray(y[0] + released @ y[1:] if len(released) else y[0])


def _released(run: Run, systems: Recursion) -> Array:
    """How much of each first state the record holds, (n,); none of an unstable model, which no state fits."""
    return normal_matrices_of([run], _products(run, systems, np.empty(0))[None], 0)[0].release


def _begun(run: Run, model: LinearModel) -> Recursion:
    """The batch as a run begins: at rest, in equilibrium with its first command, or with what is free behind it."""
    systems = discretise(model, run.sample_rate, run.hold)
    if run.begins == "moving":
        return _with_releases(systems)
    if run.begins == "at rest":
        return systems
    return replace(systems, start=model.standing(run.command[0], run.measured[0]))


def _with_releases(systems: Recursion) -> Recursion:
    """The batch and, behind it, the first system without input, released from each unit state."""
    return systems.beside(_releases(systems.part(0, 1)))


def _releases(systems: Recursion) -> Recursion:
    """Each system of a batch without input, released from each unit state: those of the first one first."""
    count, n = systems.C.shape
    scale = np.abs(systems.gamma).sum(axis=1)
    scale = np.where(scale > 0, scale, scale.max(axis=1, keepdims=True))
    of_each = systems.at(np.repeat(np.arange(count), n))
    start = (scale[:, :, None] * np.eye(n)).reshape(count * n, n)
    return Recursion(of_each.phi, np.zeros_like(of_each.gamma), of_each.C, np.zeros(count * n), start)


def _products(run: Run, systems: Recursion, strides: Array) -> Array:
    """Sums of products of [J, releases, 1, r] for each block of the record, (blocks, q, q)."""
    length, q = block_length(run), len(systems.D) + 1
    sums = np.zeros((-(-run.length // length), q, q))
    measured = run.centred[:, None]
    for rows, first, last in responses(systems, at_nodes(run)):
        for block in range(first // length, -(-last // length)):
            begin, end = max(first, block * length), min(last, (block + 1) * length)
            part = rows[begin - first : end - first, None]
            add_products(part, measured[begin:end], len(strides), sums[block : block + 1])
    return completed(sums, strides)
