"""What an identified actuator is good for, in time: one section a table; another is one more function in `SECTIONS`."""

from __future__ import annotations

import json
import tempfile
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from websockets.sync.client import connect

from benchmarks.table import Table, seconds_of
from ident.effects import EFFECTS
from ident.hybrid.case import qian
from ident.hybrid.ground_motion import GroundMotion
from ident.hybrid.hybrid_simulation import simulate_hybrid
from ident.hybrid.share_map import SHARES, share_map
from ident.hybrid.tracking import Tracker
from tests.hybrid.cases import fitted
from tests.reference import first_order_reference as reference
from tests.reference import hybrid_reference as loop_reference
from tests.running import TOKEN, process

SAMPLES, PLAIN = 400_000, 20_000
BLOCK_GOAL, SINGLE_GOAL = 2e6, 2e5  # samples a second
STREAMS, BATCH, STREAMED = 4, 64, 60.0  # at once, samples a message, s
RUN, FLAT = 30.0, 2.0  # s of a hybrid simulation, and of the flat one


def tracking() -> Table:
    """The compiled filter in blocks and a sample at a time, against the same filter in plain NumPy matrices."""
    drawn = reference.trial(0, SAMPLES / reference.SAMPLE_RATE)
    r, y = drawn.r.tolist(), drawn.y.tolist()

    def in_blocks() -> object:
        return Tracker(reference.SAMPLE_RATE, "linear", drawn.tau0, drawn.gain0).block(drawn.r, drawn.y)

    def one_at_a_time() -> object:
        step = Tracker(reference.SAMPLE_RATE, "linear", drawn.tau0, drawn.gain0).step
        return [step(a, b) for a, b in zip(r, y, strict=True)]

    def plain() -> object:
        return plain_filter(drawn.r[:PLAIN], drawn.y[:PLAIN], drawn.tau0, drawn.gain0)

    blocks, single, slow = seconds_of(in_blocks, one_at_a_time, plain, repeats=3)
    rates = SAMPLES / blocks, SAMPLES / single, PLAIN / slow
    rows = zip(("blocks", "one at a time, from Python", "plain NumPy matrices"), rates, strict=True)
    return Table(
        "Hybrid: tracking",
        f"{SAMPLES:,} samples of a first-order loop in one thread; the plain filter, the same model in matrices, has "
        f"{PLAIN:,} of them.",
        ("way", "samples a second", "times the plain filter's"),
        [(name, f"{rate:,.0f}", f"{rate / rates[-1]:.3g}") for name, rate in rows],
        f"{BLOCK_GOAL:,.0f} samples a second in blocks, {SINGLE_GOAL:,.0f} one at a time",
        rates[0] >= BLOCK_GOAL and rates[1] >= SINGLE_GOAL,
    )


def plain_filter(r: np.ndarray, y: np.ndarray, tau0: float, gain0: float) -> tuple[float, float]:
    """The same states and noises with 3 × 3 matrices and the forward difference; τ and k at the end."""
    dt, variance = 1 / reference.SAMPLE_RATE, reference.SENSOR**2
    p0 = 1 / tau0
    x, covariance = np.array([y[0], p0, gain0 * p0]), np.diag([variance, (5 * p0) ** 2, (25 * gain0 * p0) ** 2])
    reads = np.array([[1.0, 0.0, 0.0]])
    for k in range(1, len(r)):
        step = np.array([[1 - dt * x[1], -dt * x[0], dt * r[k - 1]], [0, 1, 0], [0, 0, 1]])
        x = np.array([x[0] + dt * (x[2] * r[k - 1] - x[1] * x[0]), x[1], x[2]])
        walk = np.array([[0.0, 0.0], [x[1] ** 2 * 5e-5, 0.0], [x[1] * x[2] * 5e-5, x[1] * 3e-4]])
        known = np.all(np.diag(covariance)[1:] < 0.01 * x[1:] ** 2)
        covariance = step @ covariance @ step.T + (dt * walk @ walk.T if known else 0.0)
        gain = covariance @ reads.T / (covariance[0, 0] + variance)
        x = x + gain[:, 0] * (y[k] - x[0])
        left = np.eye(3) - gain @ reads
        covariance = left @ covariance @ left.T + gain @ gain.T * variance
    return float(1 / x[1]), float(x[2] / x[1])


def streams() -> Table:
    """Four streams at once over the WebSocket at the rate of the samples: how late the answers come."""
    late: list[list[float]] = [[] for _ in range(STREAMS)]
    drawn = reference.trial(0, STREAMED)
    rows = np.column_stack([drawn.r, drawn.y]).astype("<f8")
    with tempfile.TemporaryDirectory() as folder, process(Path(folder)) as service:
        address = f"{service.address.replace('http', 'ws', 1)}/api/v1/stream/ekf"

        def one(mine: list[float]) -> None:
            headers = {"Authorization": f"Bearer {TOKEN}"}
            with connect(address, additional_headers=headers) as socket:
                socket.send(json.dumps({"sample_rate": reference.SAMPLE_RATE, "tau0": drawn.tau0}))
                socket.send(rows[:1].tobytes())
                socket.recv()
                start = time.perf_counter()
                for k in range(0, len(rows), BATCH):
                    due = start + (k + BATCH) / reference.SAMPLE_RATE
                    time.sleep(max(0.0, due - time.perf_counter()))
                    socket.send(rows[k : k + BATCH].tobytes())
                    socket.recv()
                    mine.append(time.perf_counter() - due)

        threads = [threading.Thread(target=one, args=(mine,)) for mine in late]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    whole, last = [delay for mine in late for delay in mine], max(mine[-1] for mine in late)
    return Table(
        "Hybrid: streams",
        f"{STREAMS} streams of {reference.SAMPLE_RATE:g} samples a second at once for {STREAMED:g} s, {BATCH} samples "
        "a message: from when the last sample of a message was due until its answer was there.",
        ("median", "99 %", "largest", "at the end"),
        [tuple(f"{1e3 * value:.2f} ms" for value in (*np.percentile(whole, (50, 99, 100)), last))],
        "none falls behind: the last answer comes within 100 ms",
        last < 0.1,
    )


def rig() -> Table:
    """Qian's case without and with every effect, against the flat reference; and a map of shares on every core."""
    fit, case = fitted(), replace(qian(), ground=GroundMotion(duration=RUN))
    on = {effect.name: effect.strength.upper / 10 for effect in EFFECTS}
    ground = case.ground.samples(case.sample_rate)
    part = ground[: round(FLAT * case.sample_rate)]
    simulate_hybrid(fit, case), simulate_hybrid(fit, case, None, on)  # compiles
    bare, full, plain = seconds_of(
        lambda: simulate_hybrid(fit, case),
        lambda: simulate_hybrid(fit, case, None, on),
        lambda: loop_reference.simulate(part, case.sample_rate, case.gain),
        repeats=3,
    )
    begun = time.perf_counter()
    share_map(fit, case)
    mapped, slow = time.perf_counter() - begun, plain * RUN / FLAT
    rows = [
        ("linear chain", bare, slow / bare),
        (f"all {len(on)} effects", full, slow / full),
        ("the linear chain in plain NumPy, scaled up", slow, 1.0),
        (f"map of {SHARES} × {SHARES} shares", mapped, None),
    ]
    return Table(
        "Hybrid: simulation",
        f"{RUN:g} s of Qian's case at 4096 Hz under noise; the map is of as many seconds, on every core.",
        ("what", "seconds", "times plain NumPy"),
        [(name, f"{seconds:.2f}", "" if times is None else f"{times:.3g}") for name, seconds, times in rows],
        "30 s with all effects within 3 s, a map of 20 × 20 within 20 s on two cores",
        full <= 3.0 and mapped <= 20.0,
    )


SECTIONS: tuple[Callable[[], Table], ...] = (tracking, streams, rig)


def measure() -> tuple[Table, ...]:
    """Every section."""
    return tuple(section() for section in SECTIONS)
