"""`servoident simulate`: write a simulated matrix."""

from pathlib import Path
from typing import Annotated

import typer

from app.cli.arguments import effect_values
from app.cli.progress import shown


def simulate(
    out: Annotated[Path, typer.Argument(metavar="OUT", help="Folder to write, with matrix.yaml and runs/.")],
    preset: Annotated[str, typer.Option(help="Model to simulate.")] = "qian2014",
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
) -> None:
    """Write a simulated data set.

    It holds 63 estimation runs, and 21 validation runs at Kp = 6.
    """
    from ident.synthesis.matrix import simulate_matrix

    effects = effect_values(effect or [], preset)
    with shown() as report:
        simulate_matrix(out, preset, seconds, seed, noise, effects, report, serial, small)
    print(f"wrote {out / 'matrix.yaml'}, a simulated matrix; next: servoident check {out}")
