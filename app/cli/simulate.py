"""`servoident simulate`: write a simulated matrix."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from app.cli.arguments import effect_values, split
from app.cli.arguments import values as read_values
from app.cli.progress import shown
from ident.errors import Unusable

if TYPE_CHECKING:
    from ident.presets import Preset
    from ident.presets.rig_test import RigTest


def simulate(
    out: Annotated[Path, typer.Argument(metavar="OUT", help="Folder to write, with matrix.yaml and runs/.")],
    preset: Annotated[
        str, typer.Option(metavar="NAME|FILE.yaml", help="Model to simulate, or a machine put together from stages.")
    ] = "qian2014",
    seconds: Annotated[float, typer.Option(help="Length of each run in s.")] = 30.0,
    seed: Annotated[int, typer.Option(min=0, max=2**31 - 1, help="Random seed of command and noise.")] = 0,
    noise: Annotated[
        float, typer.Option(help="Standard deviation of the white noise, relative to that of the output.")
    ] = 0.005,
    effect: Annotated[
        list[str] | None, typer.Option(metavar="NAME[.PARAM=VALUE]", help="Effect to add; may be repeated.")
    ] = None,
    serial: Annotated[str, typer.Option(help="Serial number of the simulated actuator.")] = "SIM-0001",
    small: Annotated[bool, typer.Option("--small", help="18 estimation and 9 validation runs.")] = False,
    set_: Annotated[
        list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Value of a parameter; may be repeated.")
    ] = None,
    test: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=VALUE",
            help="Setting of an unpublished test: amplitude, gain (both may be repeated), band, rate, area, supply.",
        ),
    ] = None,
) -> None:
    """Write a simulated data set.

    The data set of qian2014 has 63 estimation runs, and 21 validation runs at Kp = 6. That of strano, first_order and a
    machine in a file has runs of noise at each amplitude and gain, and a validation run between them.
    """
    from ident.presets.rig_test import TESTS
    from ident.synthesis.matrix import simulate_matrix

    if preset in TESTS or preset.endswith((".yaml", ".yml")):
        if small:
            raise Unusable("bad-option", "this test has one size", "--small", "leave it out")
        _of_rig(out, preset, seconds, seed, noise, effect or [], serial, set_ or [], test or [])
    else:
        if set_ or test:
            where = "--set" if set_ else "--test"
            raise Unusable("bad-option", f"the test matrix of {preset} is its paper's", where, "leave it out")
        effects = effect_values(effect or [], preset)
        with shown() as report:
            simulate_matrix(out, preset, seconds, seed, noise, effects, report, serial, small)
    print(f"wrote {out / 'matrix.yaml'}, a simulated matrix; next: servoident check {out}")


def _of_rig(
    out: Path,
    given: str,
    seconds: float,
    seed: int,
    noise: float,
    effect: list[str],
    serial: str,
    set_: list[str],
    test: list[str],
) -> None:
    from ident.presets import preset as preset_called
    from ident.presets.description import described
    from ident.presets.rig_test import TESTS
    from ident.readers.source import read_regular
    from ident.readers.strict_yaml import read_yaml
    from ident.synthesis.rig_matrix import write_rig_matrix

    machine, name = None, given
    if given not in TESTS:
        data = read_yaml(read_regular(Path(given), given, _LARGEST), given)
        machine = data.get("machine", data) if isinstance(data, dict) else data
        name = described(machine, given).name
    effects = effect_values(effect, name)
    model = preset_called(name, tuple(one.partition(".")[0] for one in effects))
    values = {**effects, **read_values(set_, model)}
    with shown() as report:
        write_rig_matrix(
            out, model, values, _test_of(given, model, test), seconds, seed, noise, serial, machine, report
        )


_LARGEST = 1_000_000  # bytes of a description
_STATED = {"amplitude": "", "gain": "", "band": "frequency", "rate": "frequency", "area": "area", "supply": "pressure"}


_COMMANDS = ("m", "V", "A", "1")
"""Units of a command."""


def _amplitude(text: str, units: tuple[str, ...]) -> tuple[float, str]:
    """An amplitude in the first of these units that it has. Raises Unusable where it has none."""
    from ident.units.quantity import quantity

    for unit in units[:-1]:
        try:
            return quantity(text, unit, "--test amplitude"), unit
        except Unusable:
            continue
    return quantity(text, units[-1], "--test amplitude"), units[-1]


def _test_of(given: str, model: Preset, texts: list[str]) -> RigTest:
    """The test of a preset, or of a machine whose command has the unit of its amplitudes. Raises Unusable."""
    from dataclasses import replace

    from ident.matrix import Actuator
    from ident.presets.rig_test import TESTS, RigTest
    from ident.readers.loop_settings import loop_gain
    from ident.readers.typed_fields import Fields
    from ident.synthesis.rig_matrix import with_stated
    from ident.units.quantity import quantity
    from ident.words.nearest import did_you_mean

    found: dict[str, Any] = {}
    for text in texts:
        key, value = split(text, "--test", "KEY=VALUE")
        if key not in _STATED:
            raise Unusable("bad-option", f"a test has no {key!r}", "--test", did_you_mean(key, _STATED))
        found.setdefault(key, []).append(value)
    base = TESTS.get(given)
    if base is None:
        if "amplitude" not in found:
            raise Unusable(
                "not-stated", "no amplitude of the command", "--test", 'state it, as --test "amplitude=5 mm"'
            )
        base = RigTest(1000.0, 20.0, (), "", (), tuple(model.chain.outputs), Actuator(""))
    amplitudes, unit = [], base.unit
    for value in found.get("amplitude", ()):
        size, unit = _amplitude(value, (unit,) if unit else _COMMANDS)
        amplitudes.append(size)
    gains = [loop_gain(Fields({"gain": value}, "--test", ("gain",))) for value in found.get("gain", ())]
    single = {key: quantity(values[-1], _STATED[key], f"--test {key}") for key, values in found.items() if _STATED[key]}
    actuator = replace(
        base.actuator,
        piston_area=single.get("area", base.actuator.piston_area),
        supply_pressure=single.get("supply", base.actuator.supply_pressure),
    )
    return with_stated(
        base,
        amplitudes=tuple(amplitudes),
        unit=unit,
        gains=tuple(gains),
        band=single.get("band"),
        sample_rate=single.get("rate"),
        actuator=actuator,
    )
