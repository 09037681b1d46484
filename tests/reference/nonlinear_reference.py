"""The whole actuator with every effect of the catalogue in one flat file: an independent judge of the compiled kernel.

Kutta's third-order rule with many sub-steps a sample, one run at a time; dry friction is a state machine that sticks
and slips, its events located inside the sub-step. Nothing here comes from the program's library: neither equations,
nor integrator. All quantities are SI; a machine starts at rest at zero, its command is zero before the record.

    eps = u(t - T) - y(t - T)                          command_delay, loop_delay: exact
    e = clip(Kp eps, 1/a) + Kp Ki ∫eps + Kp Td eps' - kd P - f q |P|
    tau q' = e - q;  rate limit, stiction of the spool, two more poles behind it
    w: play, bias, dead zone, underlap, asymmetry, saturation, in this order
    Q = Z0/A w sqrt(1 - sgn(w) P/Ps) (1 - d z),  T z' + z = |Q|;  times (1 + g |P|) and (1 + r sin(2 pi f t + phi))
    Ke P' = Q - Cl P - c |P| - C P/(P² + P0²)^¼ - A' v,  A' = A (1 + a sgn v)
    Ke = Ka (1 + alpha/(1 + (P/Pr)²)) (1 - kappa x²)
    (m0 + mL) v' = A' P - c0 v - c2 v|v| - Fd z + F0 - S - ks (|x| - 1/g)+ sgn x - friction
    friction ≤ Fc + dF exp(-(v/vs)²) + Fx x², it sticks
    S = k (x - clip(x, -g, g)) + cL v + k3 x³ + fy z;  behind a joint of compliance 1/kj: of the specimen's own motion
    reading X = x + F/kf;  T y' + y = X;  reading y (1 + s y²);  recorded: T yr' + yr = y, times 1 + g
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from tests.reference import qian_reference as linear

Samples = NDArray[np.float64]
STROKE = 0.1524  # m
SUBSTEPS = 16  # a sample; for data with noise half of them


class Effects(NamedTuple):
    """Strengths and shapes, all off by default; the name is effect_parameter with the letters of the catalogue."""

    command_delay_T: float = 0.0
    command_limit_a: float = 0.0
    integral_action_Ki: float = 0.0
    lead_Td: float = 0.0
    pressure_feedback_kd: float = 0.0
    loop_delay_T: float = 0.0
    valve_second_order_Tn: float = 0.0
    valve_second_order_zeta: float = 0.7
    valve_rate_limit_a: float = 0.0
    spool_stiction_s: float = 0.0
    backlash_b: float = 0.0
    null_bias_b: float = 0.0
    dead_zone_h: float = 0.0
    dead_zone_a: float = 0.0
    underlap_h: float = 0.0
    gain_asymmetry_a: float = 0.0
    flow_saturation_a: float = 0.0
    pressure_flow_r: float = 0.0
    supply_droop_d: float = 0.0
    supply_droop_T: float = 0.1
    orifice_leakage_C: float = 0.0
    orifice_leakage_P0: float = 5e4
    entrained_air_alpha: float = 0.0
    entrained_air_Pr: float = 2e6
    stroke_dependent_volume_kappa: float = 0.0
    coulomb_friction_Fc: float = 0.0
    stribeck_friction_dF: float = 0.0
    stribeck_friction_vs: float = 5e-3
    presliding_friction_Fd: float = 0.0
    presliding_friction_xs: float = 1e-5
    quadratic_damping_c2: float = 0.0
    cubic_stiffness_k3: float = 0.0
    specimen_hysteresis_fy: float = 0.0
    specimen_hysteresis_xy: float = 5e-4
    specimen_hysteresis_n: float = 1.0
    specimen_hysteresis_gamma: float = 0.5
    specimen_free_play_g: float = 0.0
    specimen_joint_s: float = 0.0
    frame_compliance_s: float = 0.0
    static_load_F0: float = 0.0
    sensor_lag_T: float = 0.0
    acquisition_lag_T: float = 0.0
    sensor_gain_g: float = 0.0
    flow_force_f: float = 0.0
    pressure_dependent_gain_g: float = 0.0
    supply_ripple_r: float = 0.0
    supply_ripple_f: float = 25.0
    supply_ripple_phi: float = 0.0
    one_way_leakage_c: float = 0.0
    unequal_areas_a: float = 0.0
    position_friction_Fx: float = 0.0
    end_stop_g: float = 0.0
    end_stop_ks: float = 1e7
    end_stop_xm: float = 0.0
    sensor_nonlinearity_s: float = 0.0


def effects(**values: float) -> Effects:
    """Effects by name, such as ``effects(dead_zone_h=1e-4)``."""
    return Effects(**values)


_RECORD = np.dtype([(name, np.float64) for name in Effects._fields])
"""Effects as the compiled functions take them: by their address, not fifty values in each call."""


# ------------------------------------------------------------------------------------------------ the equations

Q, P, V, X, EPS, ZD, ZF, ZH, Y, YR, Q2, DQ2, X2, V2 = range(14)
STATES = 14


@njit(inline="always")
def clipped(value, low, high):
    return low if value < low else (high if value > high else value)


@njit(inline="always")
def sign(value):
    return 1.0 if value > 0 else (-1.0 if value < 0 else 0.0)


@njit(cache=True, no_cfunc_wrapper=True)
def specimen_reaction(f, cell, x, v, z):
    stretch = x - clipped(x, -f.specimen_free_play_g, f.specimen_free_play_g)
    return cell.stiffness * stretch + cell.damping * v + f.cubic_stiffness_k3 * x**3 + f.specimen_hysteresis_fy * z


@njit(cache=True, no_cfunc_wrapper=True)
def force_on_specimen(f, s):
    """The force in the joint (N); only with a joint."""
    return (s[X] - s[X2]) / f.specimen_joint_s


@njit(cache=True, no_cfunc_wrapper=True)
def follow(f, cell, s):
    """Motion of a specimen without mass: of its damper, or at the position where the joint's force is its reaction."""
    if cell.damping > 0:
        s[V2] = (force_on_specimen(f, s) - specimen_reaction(f, cell, s[X2], 0.0, s[ZH])) / cell.damping
        return
    s[V2] = s[V]
    for _ in range(8):  # Newton's method
        step = 1e-9
        miss = specimen_reaction(f, cell, s[X2], 0.0, s[ZH]) - force_on_specimen(f, s)
        moved = (
            specimen_reaction(f, cell, s[X2] + step, 0.0, s[ZH]) - force_on_specimen(f, s) + step / f.specimen_joint_s
        )
        s[X2] -= miss * step / (moved - miss)


@njit(cache=True, no_cfunc_wrapper=True)
def rod_force(plant, f, cell, s):
    """All forces on the rod but those with the sign of its speed (N), and the mass that they move (kg)."""
    own = plant.A * s[P] - plant.c0 * s[V] - f.quadratic_damping_c2 * s[V] * abs(s[V]) + f.static_load_F0
    own -= f.presliding_friction_Fd * s[ZF]
    if f.end_stop_g > 0 and abs(s[X] - f.end_stop_xm) > 1 / f.end_stop_g:
        own -= f.end_stop_ks * (s[X] - f.end_stop_xm - sign(s[X] - f.end_stop_xm) / f.end_stop_g)
    if f.specimen_joint_s > 0:
        return own - force_on_specimen(f, s), plant.m0
    return own - specimen_reaction(f, cell, s[X], s[V], s[ZH]), plant.m0 + cell.mass


@njit(cache=True, no_cfunc_wrapper=True)
def friction_limit(plant, f, s):
    """What opposes the motion whichever way it goes (N): dry friction, less what unequal areas help."""
    dry = f.coulomb_friction_Fc + f.position_friction_Fx * s[X] ** 2
    if f.stribeck_friction_dF != 0:
        dry += f.stribeck_friction_dF * np.exp(-((s[V] / f.stribeck_friction_vs) ** 2))
    return dry - f.unequal_areas_a * plant.A * s[P]


@njit(cache=True, no_cfunc_wrapper=True)
def holding_limit(plant, f, s):
    """The same at standstill, where nothing helps yet."""
    dry = f.coulomb_friction_Fc + f.position_friction_Fx * s[X] ** 2 + f.stribeck_friction_dF
    return dry + max(-f.unequal_areas_a * plant.A * s[P], 0.0)


@njit(cache=True, no_cfunc_wrapper=True)
def reading(f, cell, s, acceleration):
    """What the transducer is fixed to (m)."""
    if f.frame_compliance_s == 0:
        return s[X]
    if f.specimen_joint_s > 0:
        force = force_on_specimen(f, s)
    else:
        force = specimen_reaction(f, cell, s[X], s[V], s[ZH]) + cell.mass * acceleration
    return s[X] + f.frame_compliance_s * force


@njit(cache=True, no_cfunc_wrapper=True)
def opening(f, q, play):
    w = clipped(play, q - f.backlash_b, q + f.backlash_b) + f.null_bias_b
    h, a = f.dead_zone_h, f.dead_zone_a
    w -= clipped(w, -h * (1 - a), h * (1 + a))
    w += clipped(w, -f.underlap_h, f.underlap_h)
    w *= 1 + f.gain_asymmetry_a * sign(w)
    return w / np.sqrt(1 + (f.flow_saturation_a * w) ** 2) if f.flow_saturation_a != 0 else w


@njit(cache=True, no_cfunc_wrapper=True)
def pressure_rate(plant, f, flow, t, s):
    flow *= 1 + f.pressure_dependent_gain_g * abs(s[P])
    if f.supply_ripple_r != 0:
        flow *= 1 + f.supply_ripple_r * np.sin(2 * np.pi * f.supply_ripple_f * t + f.supply_ripple_phi)
    soft = plant.Ka * (1 + f.entrained_air_alpha / (1 + (s[P] / f.entrained_air_Pr) ** 2))
    soft *= 1 - f.stroke_dependent_volume_kappa * s[X] ** 2
    leak = plant.Cl * s[P]
    if f.orifice_leakage_C != 0:
        leak += f.orifice_leakage_C * s[P] / (s[P] ** 2 + f.orifice_leakage_P0**2) ** 0.25
    leak += f.one_way_leakage_c * abs(s[P])
    area = plant.A * (1 + f.unequal_areas_a * sign(s[V]))
    return (flow - leak - area * s[V]) / soft


@njit(cache=True, no_cfunc_wrapper=True)
def derivative(plant, f, cell, t, u, du, y_late, v_late, mode, play, s, out):
    """Rates of all states; `mode` is the sign of the sliding speed, 0 while the rod sticks. Returns the reading."""
    if f.specimen_joint_s > 0 and cell.mass == 0:
        follow(f, cell, s)
    force, mass = rod_force(plant, f, cell, s)
    acceleration = 0.0 if mode == 0 else (force - mode * friction_limit(plant, f, s)) / mass
    if mode == 2:  # no dry friction at all
        acceleration = force / mass
    position = reading(f, cell, s, acceleration)
    y = s[Y] if f.sensor_lag_T > 0 else position
    v = (position - s[Y]) / f.sensor_lag_T if f.sensor_lag_T > 0 else s[V]
    v *= 1 + 3 * f.sensor_nonlinearity_s * y**2
    seen = y = y * (1 + f.sensor_nonlinearity_s * y**2)
    if f.loop_delay_T > 0:
        y, v = y_late, v_late
    eps = u - y
    e = cell.gain * eps
    if f.command_limit_a > 0:
        e = clipped(e, -1 / f.command_limit_a, 1 / f.command_limit_a)
    e += cell.gain * (f.integral_action_Ki * s[EPS] + f.lead_Td * (du - v))
    e -= f.pressure_feedback_kd * s[P] + f.flow_force_f * s[Q] * abs(s[P])
    rate = (e - s[Q]) / plant.tau
    rate /= np.sqrt(1 + (f.valve_rate_limit_a * rate) ** 2)
    if abs(e - s[Q]) < f.spool_stiction_s:
        rate = 0.0
    out[Q] = rate
    q, Tn = s[Q], f.valve_second_order_Tn
    if Tn > 0:
        out[Q2] = s[DQ2]
        out[DQ2] = (s[Q] - s[Q2] - 2 * f.valve_second_order_zeta * Tn * s[DQ2]) / Tn**2
        q = s[Q2]
    w = opening(f, q, play)
    flow = plant.Z0 / plant.A * w * np.sqrt(max(0.0, 1 - sign(w) * s[P] * f.pressure_flow_r))
    flow *= 1 - f.supply_droop_d * s[ZD]
    out[ZD] = (abs(flow) - s[ZD]) / f.supply_droop_T
    out[P] = pressure_rate(plant, f, flow, t, s)
    out[V] = acceleration
    out[X] = s[V]
    out[EPS] = eps
    out[ZF] = (s[V] - abs(s[V]) * s[ZF]) / f.presliding_friction_xs
    own_v = s[V2] if f.specimen_joint_s > 0 else s[V]
    if f.specimen_hysteresis_fy != 0:
        bent = f.specimen_hysteresis_gamma + 0.5 * sign(own_v * s[ZH])
        out[ZH] = own_v / f.specimen_hysteresis_xy * (1 - abs(s[ZH]) ** f.specimen_hysteresis_n * bent)
    out[Y] = (position - s[Y]) / f.sensor_lag_T if f.sensor_lag_T > 0 else 0.0
    out[YR] = (seen - s[YR]) / f.acquisition_lag_T if f.acquisition_lag_T > 0 else 0.0
    if f.specimen_joint_s > 0 and cell.mass + cell.damping > 0:
        out[X2] = s[V2]
    if f.specimen_joint_s > 0 and cell.mass > 0:
        reaction = specimen_reaction(f, cell, s[X2], s[V2], s[ZH])
        out[V2] = (force_on_specimen(f, s) - reaction) / cell.mass
    return seen


# ------------------------------------------------------------------------------------------------ the integrator


@njit(cache=True, no_cfunc_wrapper=True)
def kutta(plant, f, cell, t, h, u0, slope, history, mode, play, s, k, trial, known):
    """One step of Kutta's third-order rule from s, in place; `known` where k[0] has the rates at s already."""
    for stage in range(1 if known else 0, 3):
        c = (0.0, 0.5, 1.0)[stage]
        for i in range(STATES):
            if stage == 0:
                trial[i] = s[i]
            elif stage == 1:
                trial[i] = s[i] + 0.5 * h * k[0, i]
            else:
                trial[i] = s[i] + h * (2 * k[1, i] - k[0, i])
        y, v = late(history, t + c * h - f.loop_delay_T) if f.loop_delay_T > 0 else (0.0, 0.0)
        derivative(plant, f, cell, t + c * h, u0 + slope * c * h, slope, y, v, mode, play, trial, k[stage])
    for i in range(STATES):
        s[i] += h / 6 * (k[0, i] + 4 * k[1, i] + k[2, i])


@njit(cache=True, no_cfunc_wrapper=True)
def late(history, t):
    """Reading and its rate at an earlier time, from rows (reading, rate) a sub-step; `history[-1, 0]` is the step."""
    if t <= 0:
        return 0.0, 0.0
    h = history[-1, 0]
    n = int(t / h)
    c = t / h - n
    a, b = history[n], history[n + 1]
    y = (1 + 2 * c) * (1 - c) ** 2 * a[0] + c * (1 - c) ** 2 * h * a[1]
    y += c * c * (3 - 2 * c) * b[0] + c * c * (c - 1) * h * b[1]
    return y, (1 - c) * a[1] + c * b[1]


@njit(cache=True, no_cfunc_wrapper=True)
def held_mean(command, t, h, rate):
    """Mean of a held command over a sub-step: a delayed command may jump inside it."""
    edge = np.ceil(t * rate - 1e-9) / rate
    share = min(max((edge - t) / h, 0.0), 1.0)
    late_side = command_at(command, t + h * (1 - 1e-6), rate, False)
    return share * command_at(command, t, rate, False) + (1 - share) * late_side


@njit(cache=True, no_cfunc_wrapper=True)
def jump_of(command, t, h, rate, linear_hold, late):
    """By how much a command jumps in a sub-step, and when: as a share of it.

    The lead makes a kick of a jump, which goes to both ends of the sub-step so that its mean time is right. A record
    that is not late does not jump where it begins: what was before it is not known.
    """
    n = max(int(np.ceil(t * rate - 1e-9)), 0)
    share = (n / rate - t) / h
    if share >= 1 - 1e-9 or n >= len(command) or (n > 0 and linear_hold) or (n == 0 and not late):
        return 0.0, 0.0
    if linear_hold:  # with the rise behind it: the sub-step in which a record begins has no slope of its own
        return command_at(command, t + h, rate, True), max(share, 0.0)
    return command[n] - (command[n - 1] if n > 0 else 0.0), max(share, 0.0)


@njit(cache=True, no_cfunc_wrapper=True)
def command_at(command, t, rate, linear_hold):
    if t < 0:
        return 0.0
    n = min(int(t * rate + 1e-9), len(command) - 1)
    if not linear_hold or n == len(command) - 1:
        return command[n]
    return command[n] + (t * rate - n) * (command[n + 1] - command[n])


@njit(cache=True, no_cfunc_wrapper=True)
def mode_of(plant, f, cell, s):
    """The sign of sliding, 0 for sticking, 2 where there is no dry friction."""
    if f.coulomb_friction_Fc + f.position_friction_Fx + f.stribeck_friction_dF + abs(f.unequal_areas_a) == 0:
        return 2
    if s[V] != 0:
        return 1 if s[V] > 0 else -1
    force, _ = rod_force(plant, f, cell, s)
    if abs(force) <= holding_limit(plant, f, s):
        return 0
    return 1 if force > 0 else -1


@njit(cache=True, no_cfunc_wrapper=True)
def copy(source, target):
    """Value by value: what a whole array's assignment could raise would take seconds to compile."""
    for i in range(len(source)):
        target[i] = source[i]


@njit(nogil=True, cache=True, error_model="numpy")
def integrate(  # noqa: PLR0912, PLR0915  the whole story of a step in one place
    plant, f, cell, command, rate, substeps, linear_hold, outputs
):
    """Displacement as recorded (m), force on the specimen (N) and load pressure (Pa) at the samples, into outputs."""
    s, trial, keep = np.zeros(STATES), np.empty(STATES), np.empty(STATES)
    k = np.zeros((3, STATES))
    h = 1 / (rate * substeps)
    history = np.zeros((len(command) * substeps + 3, 2))
    history[-1, 0] = h
    play, kick = 0.0, 0.0
    for sample in range(len(command)):
        for step in range(substeps):
            t = (sample * substeps + step) * h
            here = sample * substeps + step
            start = t - f.command_delay_T
            if f.lead_Td > 0 and f.valve_rate_limit_a == 0:  # a valve of limited rate does not follow a kick
                jump, share = jump_of(command, start, h, rate, linear_hold, f.command_delay_T > 0)
                jump *= cell.gain * f.lead_Td / plant.tau
                s[Q] += kick + (1 - share) * jump
                kick = share * jump
            u0 = command_at(command, start, rate, True) if linear_hold else held_mean(command, start, h, rate)
            slope = 0.0
            if linear_hold:
                end = command_at(command, start + h, rate, True)
                slope = (end - u0) / h
                if start < 0 <= start + h:  # a delayed record begins, with a jump, inside the sub-step: its mean
                    u0, slope = 0.5 * (command[0] + end) * (start + h) / h, 0.0
            mode = mode_of(plant, f, cell, s)
            y, v = late(history, t - f.loop_delay_T) if f.loop_delay_T > 0 else (0.0, 0.0)
            seen = derivative(plant, f, cell, t, u0, slope, y, v, mode, play, s, k[0])
            history[here, 0] = seen
            bent = 1 + 3 * f.sensor_nonlinearity_s * (s[Y] if f.sensor_lag_T > 0 else s[X]) ** 2
            history[here, 1] = bent * (k[0, Y] if f.sensor_lag_T > 0 else s[V])
            copy(history[here], history[here + 1])
            if step == 0:
                recorded = s[YR] if f.acquisition_lag_T > 0 else seen
                outputs[0, sample] = recorded * (1 + f.sensor_gain_g)
                if f.specimen_joint_s > 0:
                    outputs[1, sample] = force_on_specimen(f, s)
                else:
                    reaction = specimen_reaction(f, cell, s[X], s[V], s[ZH])
                    outputs[1, sample] = reaction + cell.mass * k[0, V]
                outputs[2, sample] = s[P]
            left = h
            # The rates at s are those of the reading, unless they hang on t or a massless specimen has followed s.
            known = f.loop_delay_T == 0 and f.supply_ripple_r == 0 and (f.specimen_joint_s == 0 or cell.mass > 0)
            for _ in range(4):
                copy(s, keep)
                begun = t + h - left
                u = u0 + slope * (h - left)
                kutta(plant, f, cell, begun, left, u, slope, history, mode, play, s, k, trial, known)
                known = False
                if abs(mode) != 1 or s[V] * mode > 0:
                    break
                # It stops inside the step: find when, go there, and see what it does next.
                reached = s[V]
                before = keep[V]
                if before * mode <= 0:  # pushed back at once: it sticks
                    copy(keep, s)
                    s[V] = 0.0
                    mode = 0
                    continue
                part = left * before / (before - reached)
                copy(keep, s)
                kutta(plant, f, cell, begun, part, u, slope, history, mode, play, s, k, trial, True)
                s[V] = 0.0
                left -= part
                mode = mode_of(plant, f, cell, s)
                if left < 1e-9 * h:
                    break
            if mode == 0:
                s[V] = 0.0
            q = s[Q2] if f.valve_second_order_Tn > 0 else s[Q]
            play = clipped(play, q - f.backlash_b, q + f.backlash_b)
    return outputs


class Outputs(NamedTuple):
    """What a run shows: recorded displacement (m), force on the specimen (N), load pressure (Pa), each (n,)."""

    displacement: Samples
    force: Samples
    load_pressure: Samples


def respond(
    plant: linear.Plant,
    f: Effects,
    cell: linear.Cell,
    command: Samples,
    hold: str = "linear",
    rate: float = linear.SAMPLE_RATE,
    substeps: int = SUBSTEPS,
) -> Outputs:
    """One run from rest, without noise."""
    given = np.array([tuple(f)], _RECORD)[0]
    found = integrate(plant, given, cell, command, rate, substeps, hold == "linear", np.empty((3, len(command))))
    return Outputs(*found)


def measure_all(
    f: Effects,
    runs: Sequence[linear.Trial],
    *,
    seconds: float,
    noise: float,
    seed: int,
    hold: str = "linear",
    plant: linear.Plant | None = None,
    bits: int | None = 18,
) -> list[linear.Record]:
    """Every run of a matrix, each with its own command and noise, its position in steps of the stroke over 2^bits."""
    machine = plant or linear.Plant()

    def one(numbered: tuple[int, linear.Trial]) -> linear.Record:
        number, trial = numbered
        rng = np.random.default_rng([seed, number])
        command = linear.band_limited_noise(round(seconds * linear.SAMPLE_RATE), trial.amplitude, rng)
        clean = respond(machine, f, trial.cell, command, hold, substeps=SUBSTEPS // 2).displacement
        noisy = clean + noise * clean.std() * rng.standard_normal(len(clean))
        step = STROKE / 2**bits if bits else 0.0
        return linear.Record(trial, command, np.round(noisy / step) * step if step else noisy)

    with ThreadPoolExecutor() as pool:
        return list(pool.map(one, enumerate(runs)))


def named(values: Mapping[str, float]) -> Effects:
    """Effects from names such as ``dead_zone.h``."""
    return Effects(**{name.replace(".", "_"): value for name, value in values.items()})
