"""Machines under a periodic motion or command, with one effect of the catalogue each: a reference of its own.

Nothing here comes from the program: neither equations nor integrator. All quantities are SI.

A specimen that is moved, whose motion x(t) is known between the samples too:

    F = cS v + kS x + mS a + effect

where z of Dahl's friction and of Bouc-Wen's hysteresis is advanced exactly over the way between two turning points.

A mass that is driven, in open loop (e = u), or under a position loop (e = Kp (u - y)):

    w = spool(e)        m v' = Kt w - c v - k x - effect        x' = v

by Kutta's third-order rule with many steps a sample. Dry friction sticks and slips; where the speed changes its sign
the step ends, found by a false position, so that a standstill or a turning point lies where it is, not at a sample.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Law(NamedTuple):
    """Parameters of a driven mass and of every effect, all of these off by default."""

    m: float = 1.0
    c: float = 0.0
    k: float = 0.0
    Kt: float = 1.0
    Kp: float = 0.0  # 0: open loop
    command_delay_T: float = 0.0
    command_limit_a: float = 0.0
    integral_action_Ki: float = 0.0
    lead_Td: float = 0.0
    loop_delay_T: float = 0.0
    valve_second_order_Tn: float = 0.0
    valve_second_order_zeta: float = 0.7
    backlash_b: float = 0.0
    dead_zone_h: float = 0.0
    dead_zone_a: float = 0.0
    underlap_h: float = 0.0
    gain_asymmetry_a: float = 0.0
    flow_saturation_a: float = 0.0
    coulomb_friction_Fc: float = 0.0
    stribeck_friction_dF: float = 0.0
    stribeck_friction_vs: float = 1.0
    presliding_friction_Fd: float = 0.0
    presliding_friction_xs: float = 1.0
    quadratic_damping_c2: float = 0.0
    cubic_stiffness_k3: float = 0.0
    specimen_hysteresis_fy: float = 0.0
    specimen_hysteresis_xy: float = 1.0
    specimen_hysteresis_n: float = 1.0
    position_friction_Fx: float = 0.0
    end_stop_way: float = 0.0  # 1/g of the catalogue; 0: no stop
    end_stop_ks: float = 0.0
    end_stop_xm: float = 0.0
    sensor_lag_T: float = 0.0
    acquisition_lag_T: float = 0.0
    sensor_gain_g: float = 0.0
    sensor_nonlinearity_s: float = 0.0


_RECORD = np.dtype([(name, np.float64) for name in Law._fields])
"""A law as the compiled functions take it: by its address."""

# ------------------------------------------------------------------------------------- what depends on the way alone


@njit(cache=True, inline="always")
def clipped(value, low, high):
    return low if value < low else (high if value > high else value)


@njit(cache=True, inline="always")
def sign(value):
    return 1.0 if value > 0 else (-1.0 if value < 0 else 0.0)


@njit(cache=True, no_cfunc_wrapper=True)
def dahl(z, way, xs):
    """z' = (v - |v| z)/xs over a way without a turning point: exact."""
    if way == 0.0:
        return z
    s = 1.0 if way > 0 else -1.0
    return s + (z - s) * np.exp(-abs(way) / xs)


@njit(cache=True, no_cfunc_wrapper=True)
def bouc_wen(z, way, xy, n):
    """z' = (v/xy)(1 - |z|^n (1/2 + sgn(v z)/2)) over a way without a turning point: exact for n = 1."""
    if way == 0.0:
        return z
    s = 1.0 if way > 0 else -1.0
    left, grown = abs(way) / xy, s * z  # in the direction of motion
    if grown < 0:  # unloading: a straight line as far as zero
        if left <= -grown:
            return s * (grown + left)
        left += grown
        grown = 0.0
    if n == 1.0:
        return s * (1.0 - (1.0 - grown) * np.exp(-left))
    left = min(left, 40.0)
    steps = int(left / 0.1) + 1
    h = left / steps
    for _ in range(steps):  # the classical rule of fourth order
        k1 = 1.0 - max(grown, 0.0) ** n
        k2 = 1.0 - max(grown + 0.5 * h * k1, 0.0) ** n
        k3 = 1.0 - max(grown + 0.5 * h * k2, 0.0) ** n
        k4 = 1.0 - max(grown + h * k3, 0.0) ** n
        grown += h / 6.0 * (k1 + 2 * k2 + 2 * k3 + k4)
    return s * min(grown, 1.0)


@njit(cache=True, no_cfunc_wrapper=True)
def dahl_along(x, xs):
    """z along the places x, in which every turning point stands; it begins at 0."""
    out = np.zeros(len(x))
    for i in range(1, len(x)):
        out[i] = dahl(out[i - 1], x[i] - x[i - 1], xs)
    return out


@njit(cache=True, no_cfunc_wrapper=True)
def bouc_wen_along(x, xy, n):
    """z along the places x, in which every turning point stands; it begins at 0."""
    out = np.zeros(len(x))
    for i in range(1, len(x)):
        out[i] = bouc_wen(out[i - 1], x[i] - x[i - 1], xy, n)
    return out


# ------------------------------------------------------------------------------------------------- the driven mass

X, V, Q, DQ, YS, YR, EI = range(7)
STATES = 7


@njit(cache=True, no_cfunc_wrapper=True)
def command_at(command, t, linear):
    """The command at a time in samples, zero before the record."""
    if t < 0:
        return 0.0
    n = min(int(t + 1e-9), len(command) - 1)
    if not linear or n == len(command) - 1:
        return command[n]
    return command[n] + (t - n) * (command[n + 1] - command[n])


@njit(cache=True, no_cfunc_wrapper=True)
def slope_at(command, t, linear):
    """Its rate (1/sample)."""
    n = int(np.floor(t + 1e-9))
    if not linear or n < 0 or n >= len(command) - 1:
        return 0.0
    return command[n + 1] - command[n]


@njit(cache=True, no_cfunc_wrapper=True)
def opening(f, e, play):
    """What of the drive signal reaches the motor, and where the play stands."""
    if f.command_limit_a > 0:
        e = clipped(e, -1.0 / f.command_limit_a, 1.0 / f.command_limit_a)
    return e, clipped(play, e - f.backlash_b, e + f.backlash_b)


@njit(cache=True, no_cfunc_wrapper=True)
def spool(f, w):
    """Dead zone, underlap, asymmetry, saturation, in this order."""
    h, a = f.dead_zone_h, f.dead_zone_a
    w -= clipped(w, -h * (1 - a), h * (1 + a))
    w += clipped(w, -f.underlap_h, f.underlap_h)
    w *= 1.0 + f.gain_asymmetry_a * sign(w)
    return w / np.sqrt(1.0 + (f.flow_saturation_a * w) ** 2)


@njit(cache=True, no_cfunc_wrapper=True)
def limit(f, x, v):
    """The largest dry friction (N)."""
    dry = f.coulomb_friction_Fc + f.position_friction_Fx * x * x
    if f.stribeck_friction_dF > 0:
        dry += f.stribeck_friction_dF * np.exp(-((v / f.stribeck_friction_vs) ** 2))
    return dry


@njit(cache=True, no_cfunc_wrapper=True)
def reading(f, s):
    """What the controller sees of the position."""
    y = s[YS] if f.sensor_lag_T > 0 else s[X]
    return y * (1.0 + f.sensor_nonlinearity_s * y * y)


@njit(cache=True, no_cfunc_wrapper=True)
def late_reading(history, t, h):
    """The reading so many steps before, straight between two steps; zero before the record."""
    if t <= 0:
        return 0.0
    n = int(t / h)
    c = t / h - n
    return history[n] * (1 - c) + history[n + 1] * c


@njit(cache=True, no_cfunc_wrapper=True)
def rates(  # noqa: PLR0912  all equations in one place
    f, command, linear, rate, t, mode, s, play, x0, zd, zh, history, h, out
):
    """Rates of the states at t (s); returns what pushes but dry friction. Modes: ±1 slides, 0 sticks, 2 no friction."""
    late = (t - f.command_delay_T) * rate
    u, du = command_at(command, late, linear), slope_at(command, late, linear) * rate
    y = reading(f, s)
    if f.Kp > 0:
        seen = late_reading(history, t - f.loop_delay_T, h) if f.loop_delay_T > 0 else y
        eps = u - seen
        e = f.Kp * eps
        if f.command_limit_a > 0:
            e = clipped(e, -1.0 / f.command_limit_a, 1.0 / f.command_limit_a)
        e += f.Kp * (f.integral_action_Ki * s[EI] + f.lead_Td * (du - s[V]))
        out[EI] = eps
        p = clipped(play, e - f.backlash_b, e + f.backlash_b) if f.valve_second_order_Tn == 0 else play
    else:
        e, p = opening(f, u, play)
    w = p
    if f.valve_second_order_Tn > 0:
        T = f.valve_second_order_Tn
        out[Q] = s[DQ]
        out[DQ] = (e - s[Q] - 2 * f.valve_second_order_zeta * T * s[DQ]) / T**2
        w = p = clipped(play, s[Q] - f.backlash_b, s[Q] + f.backlash_b)
    x, v = s[X], s[V]
    push = f.Kt * spool(f, w) - f.c * v - f.k * x - f.quadratic_damping_c2 * v * abs(v) - f.cubic_stiffness_k3 * x**3
    if f.presliding_friction_Fd > 0:
        push -= f.presliding_friction_Fd * dahl(zd, x - x0, f.presliding_friction_xs)
    if f.specimen_hysteresis_fy > 0:
        push -= f.specimen_hysteresis_fy * bouc_wen(zh, x - x0, f.specimen_hysteresis_xy, f.specimen_hysteresis_n)
    if f.end_stop_ks > 0:
        beyond = abs(x - f.end_stop_xm) - f.end_stop_way
        if beyond > 0:
            push -= f.end_stop_ks * beyond * sign(x - f.end_stop_xm)
    out[X] = v
    if mode == 0:
        out[V] = 0.0
    elif mode == 2:
        out[V] = push / f.m
    else:
        out[V] = (push - mode * limit(f, x, v)) / f.m
    if f.sensor_lag_T > 0:
        out[YS] = (x - s[YS]) / f.sensor_lag_T
    if f.acquisition_lag_T > 0:
        out[YR] = (y - s[YR]) / f.acquisition_lag_T
    return push, p


@njit(cache=True, no_cfunc_wrapper=True)
def kutta(f, command, linear, rate, t, h, mode, s, play, zd, zh, history, step, k, trial, out):
    """One step of Kutta's third-order rule from s into out."""
    x0 = s[X]
    rates(f, command, linear, rate, t, mode, s, play, x0, zd, zh, history, step, k[0])
    for i in range(STATES):
        trial[i] = s[i] + 0.5 * h * k[0, i]
    rates(f, command, linear, rate, t + 0.5 * h, mode, trial, play, x0, zd, zh, history, step, k[1])
    for i in range(STATES):
        trial[i] = s[i] + h * (2 * k[1, i] - k[0, i])
    # The end of a step belongs to it: a held command jumps only behind it.
    rates(f, command, linear, rate, t + h * (1 - 1e-6), mode, trial, play, x0, zd, zh, history, step, k[2])
    for i in range(STATES):
        out[i] = s[i] + h / 6 * (k[0, i] + 4 * k[1, i] + k[2, i])


@njit(cache=True, no_cfunc_wrapper=True)
def drive(  # noqa: PLR0912, PLR0915  the whole story of a step in one place
    f, command, linear, rate, substeps, speed, outputs
):
    """Recorded position, or speed where `speed`, of a driven mass at the samples of the command, from rest."""
    h = 1.0 / (rate * substeps)
    s, after, trial = np.zeros(STATES), np.zeros(STATES), np.zeros(STATES)
    k = np.zeros((3, STATES))
    history = np.zeros(len(command) * substeps + 2 if f.loop_delay_T > 0 else 2)
    dry = f.coulomb_friction_Fc + f.stribeck_friction_dF + f.position_friction_Fx > 0
    turns = dry or f.presliding_friction_Fd > 0 or f.specimen_hysteresis_fy > 0
    play, zd, zh, mode = 0.0, 0.0, 0.0, 2
    for sample in range(len(command)):
        y = reading(f, s)
        if speed:
            outputs[sample] = s[V]
        else:
            outputs[sample] = (s[YR] if f.acquisition_lag_T > 0 else y) * (1.0 + f.sensor_gain_g)
        if not abs(s[V]) < 1e12:
            return False
        for step in range(substeps):
            n = sample * substeps + step
            t, left = n * h, h
            if f.loop_delay_T > 0:
                history[n] = reading(f, s)
                history[n + 1] = history[n] + h * s[V]
            for _ in range(8):  # parts of the step, from turning point to turning point
                if dry:
                    mode = int(sign(s[V]))
                    if mode == 0:
                        push, p = rates(f, command, linear, rate, t, 0, s, play, s[X], zd, zh, history, h, k[0])
                        hold = limit(f, s[X], 0.0)
                        if abs(push) > hold * (1 + 1e-12):
                            mode = int(sign(push))
                    if mode == 0:  # it sticks until the push exceeds what holds
                        kutta(f, command, linear, rate, t, left, 0, s, play, zd, zh, history, h, k, trial, after)
                        end, p_end = rates(
                            f, command, linear, rate, t + left * (1 - 1e-6), 0, after, p, s[X], zd, zh, history, h, k[0]
                        )
                        if abs(end) <= hold:
                            for i in range(STATES):
                                s[i] = after[i]
                            play = p_end
                            break
                        share = clipped((hold - abs(push)) / max(abs(end) - abs(push), 1e-300), 0.0, 1.0)
                        kutta(
                            f, command, linear, rate, t, share * left, 0, s, play, zd, zh, history, h, k, trial, after
                        )
                        for i in range(STATES):
                            s[i] = after[i]
                        t, left = t + share * left, (1 - share) * left
                        _, play = rates(f, command, linear, rate, t, 0, s, play, s[X], zd, zh, history, h, k[0])
                        mode = int(sign(end))
                        if left <= 1e-9 * h:
                            break
                kutta(f, command, linear, rate, t, left, mode, s, play, zd, zh, history, h, k, trial, after)
                took, turned = left, False
                before = float(mode) if mode != 2 else sign(s[V])
                if turns and before != 0.0 and after[V] * before < 0.0 and s[V] != 0.0:
                    low, high = 0.0, left
                    v_low, v_high = s[V], after[V]
                    for _ in range(12):
                        took = low + (high - low) * clipped(v_low / (v_low - v_high), 0.02, 0.98)
                        kutta(f, command, linear, rate, t, took, mode, s, play, zd, zh, history, h, k, trial, after)
                        if abs(after[V]) <= 1e-10 * abs(s[V]):
                            break
                        if after[V] * before > 0:
                            low, v_low = took, after[V]
                        else:
                            high, v_high = took, after[V]
                    after[V] = 0.0
                    turned = True
                elif turns and mode != 2 and s[V] == 0.0 and after[V] * before < 0.0:
                    after[V], after[X] = 0.0, s[X]
                way = after[X] - s[X]
                if f.presliding_friction_Fd > 0:
                    zd = dahl(zd, way, f.presliding_friction_xs)
                if f.specimen_hysteresis_fy > 0:
                    zh = bouc_wen(zh, way, f.specimen_hysteresis_xy, f.specimen_hysteresis_n)
                if f.backlash_b > 0:
                    end_t = t + took * (1 - 1e-6)
                    _, play = rates(
                        f, command, linear, rate, end_t, mode, after, play, after[X], zd, zh, history, h, k[0]
                    )
                for i in range(STATES):
                    s[i] = after[i]
                t, left = t + took, left - took
                if not turned or left <= 1e-9 * h:
                    break
    return True


def driven(law: Law, command: Array, rate: float, hold: str, substeps: int, output: str) -> Array:
    """The recorded output at the samples of a command, from rest; not a number from where it runs away."""
    found = np.full(len(command), np.nan)
    drive(np.array([tuple(law)], _RECORD)[0], command, hold == "linear", rate, substeps, output == "velocity", found)
    return found
