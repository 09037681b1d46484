"""`servoident simulate`: write a simulated matrix."""

from pathlib import Path
from typing import Annotated

import typer

from app.cli.arguments import effect_values
from app.cli.progress import shown


def simulate(
    out: Annotated[Path, typer.Argument(metavar="OUT", help="Folder to write, with matrix.yaml and runs/.")],
    preset: Annotated[str, typer.Option(help="Model that is simulated.")] = "qian2014",
    seconds: Annotated[float, typer.Option(help="Length of each run in s.")] = 30.0,
    seed: Annotated[int, typer.Option(min=0, max=2**31 - 1, help="Seed of the command and of the noise.")] = 0,
    noise: Annotated[
        float, typer.Option(help="White noise: its standard deviation relative to each run's output.")
    ] = 0.005,
    effect: Annotated[
        list[str] | None, typer.Option(metavar="NAME[.PARAM=VALUE]", help="Effect to switch on; may be repeated.")
    ] = None,
    serial: Annotated[str, typer.Option(help="Serial number of the simulated actuator.")] = "SIM-0001",
    small: Annotated[bool, typer.Option("--small", help="18 runs to fit and 9 to verify.")] = False,
) -> None:
    """Write a simulated test matrix. It holds 63 runs to fit and 21 at Kp = 6 to verify."""
    from ident.synthesis.matrix import simulate_matrix

    effects = effect_values(effect or [], preset)
    with shown() as report:
        simulate_matrix(out, preset, seconds, seed, noise, effects, report, serial, small)
    print(f"wrote {out / 'matrix.yaml'}, a simulated matrix; next: servoident check {out}")
