"""A sampled controller around an actuator, in one flat file: an independent judge of a designed loop.

Between two samples the command is held, and it acts a number of samples after the displacement was measured:

    y(k) = x(t_k) + n(k)                                     the sensor, with what disturbs it
    u(k) = C z(k) + D [d(k), y(k)],  z(k+1) = A z(k) + B [d(k), y(k)]
    the plant runs from t_k to t_(k+1) under u(k - delay)

The plant is the closed servo loop of Qian et al. (2014), eqs. (1)-(7) written out in SI,

    tau q' + q = Kp (u - x)          valve behind the position loop
    Ka P' = (Z0 / A) q - Cl P - A v  pressure
    (m0 + mL) v' = A P - (c0 + cL) v - k x,   x' = v

or that of the benchmark problem of 2020, 1.0261 L/(1 + L) with L = a1b0/(s² + b1 s + b2) H and
H = 1/((s + a3)(m s² + c s + k) + a2 s), written as a chain of integrators. Each is stepped by the matrix exponential
of a sub-step. Nothing here comes from the program's library.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

Samples = NDArray[np.float64]
TABLE_4 = {"Z0": 2.592e-6, "tau": 3.6e-3, "Cl": 1e-11, "c0": 3200.0, "m0": 4.25, "Ka": 1.39e-13}
AREA = 4.97e-4  # m²
SUBSTEPS = 2


def servo_loop(mass, stiffness, gain, damping=0.0, values=TABLE_4, area=AREA):
    """(A, B, C) of the states q, P, v, x, scaled to mm and MPa; mass, damping, stiffness are the specimen's."""
    Z0, tau, Cl, c0, m0, Ka = (values[name] for name in ("Z0", "tau", "Cl", "c0", "m0", "Ka"))
    m = m0 + mass
    A = np.array(
        [
            [-1 / tau, 0, 0, -gain / tau],
            [Z0 / area / Ka, -Cl / Ka, -area / Ka, 0],
            [0, area / m, -(c0 + damping) / m, -stiffness / m],
            [0, 0, 1, 0],
        ]
    )
    B, C = np.array([gain / tau, 0, 0, 0]), np.array([0, 0, 0, 1.0])
    unit = np.array([1e-3, 1e6, 1e-3, 1e-3])
    return A * unit / unit[:, None], B / unit, C * unit


def benchmark_2020(a1b0=2.1283e13, a2=4.2297e6, a3=3.3, b1=425.0, b2=9.9976e4, m=29.13, k=1190e3, c=None):
    """(A, B, C) of the benchmark problem's transfer system."""
    c = 2 * 0.0097 * np.sqrt(k * m) if c is None else c
    inner = np.polyadd(np.polymul([1, a3], [m, c, k]), [a2, 0])
    denominator = np.polyadd(np.polymul([1, b1, b2], inner), [a1b0])
    numerator, n, w = 1.0261 * a1b0 / denominator[0], 5, 200.0
    A = np.diag(np.full(n - 1, w), 1)
    A[-1] = -(denominator / denominator[0])[:0:-1] / w ** (n - 1 - np.arange(n))
    return A, np.append(np.zeros(n - 1), numerator / w ** (n - 1)), np.append(1.0, np.zeros(n - 1))


def benchmark_record(seconds, seed, band=80.0, size=2e-3, sample_rate=4096.0):
    """(command, x) of the transfer system under noise from 0 to `band` Hz of RMS `size` m, begun within 0.1 s.

    The command runs straight from sample to sample; the ramp's share is that of the exponential of an added state.
    """
    n, h = int(seconds * sample_rate), 1.0 / sample_rate
    rng, f = np.random.default_rng(seed), np.fft.rfftfreq(n, h)
    lines = np.where((f > 0) & (f <= band), rng.standard_normal(len(f)) + 1j * rng.standard_normal(len(f)), 0.0)
    command = np.fft.irfft(lines, n)
    command *= size / command.std() * np.clip(np.arange(n) * h / 0.1, 0.0, 1.0)
    A, B, C = benchmark_2020()
    m = len(A)
    block = np.zeros((m + 2, m + 2))  # d/dt of the states, the command, its slope
    block[:m, :m], block[:m, m], block[m, m + 1] = A, B, 1.0
    step = expm(block * h)[:m]
    state, x = np.zeros(m), np.zeros(n)
    for k in range(n - 1):
        state = step @ np.append(state, [command[k], (command[k + 1] - command[k]) / h])
        x[k + 1] = C @ state
    return command, x


def run(plant, controller, delay, wanted, disturbance, sample_rate=4096.0):
    """What is measured and what is commanded: (x, u), each (n,), from rest.

    `controller` is (A, B, C, D) with the inputs wanted and measured; `delay` is in whole samples.
    """
    A, B, C = plant
    n = len(A)
    block = np.zeros((n + 1, n + 1))
    block[:n, :n], block[:n, n] = A, B
    step = expm(block / sample_rate / SUBSTEPS)
    forward, drive = step[:n, :n], step[:n, n]
    Ak, Bk, Ck, Dk = (np.asarray(matrix) for matrix in controller)
    state, memory, line = np.zeros(n), np.zeros(len(Ak)), [0.0] * delay
    x, u = np.zeros(len(wanted)), np.zeros(len(wanted))
    for k in range(len(wanted)):
        x[k] = C @ state
        inputs = np.array([wanted[k], x[k] + disturbance[k]])
        u[k] = Ck[0] @ memory + Dk[0] @ inputs
        memory = Ak @ memory + Bk @ inputs
        line.append(u[k])
        acting = line.pop(0)
        for _ in range(SUBSTEPS):
            state = forward @ state + drive * acting
    return x, u


def responses(plant, controller, delay, sample_rate=4096.0, seconds=4):
    """By impulses of what is wanted and of the sensor's disturbance, each 1 mm for one sample.

    (f, T, S, N): frequencies in Hz, wanted → measured, disturbance → what the sensor reads, disturbance → command.
    """
    count = int(seconds * sample_rate)
    impulse, nothing = np.zeros(count), np.zeros(count)
    impulse[0] = 1e-3
    followed, _ = run(plant, controller, delay, impulse, nothing, sample_rate)
    moved, commanded = run(plant, controller, delay, nothing, impulse, sample_rate)
    of = [np.fft.rfft(signal / 1e-3) for signal in (followed, moved + impulse, commanded)]
    return np.fft.rfftfreq(count, 1 / sample_rate), *of
