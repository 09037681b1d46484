"""`servoident delete`: a stored fit, and all that was made of it."""

from __future__ import annotations

from typing import Annotated

import typer

from app.cli.remote import DEFAULT, Server, Token, request, segment


def delete(
    fit: Annotated[str, typer.Argument(metavar="FIT", help="Id of a finished fit.")],
    yes: Annotated[bool, typer.Option("--yes", help="Delete. Without it the command shows what would go.")] = False,
    server: Server = DEFAULT,
    token: Token = "",
) -> None:
    """Delete a stored fit and all that was made of it.

    Diagnoses, controllers, hybrid simulations, profiles and test plans of the fit go with it. The data set stays. A fit
    that was approved, or that something else uses, is refused.
    """
    at = f"/fits/{segment(fit)}"
    found = request(server, token, "DELETE", at) if yes else request(server, token, "GET", f"{at}/deletion")
    answer = found.json()
    made = ", ".join(f"{name}: {count}" for name, count in answer["made_of"].items()) or "nothing was made of it"
    if yes:
        print(f"fit {fit} of {answer['serial']} is deleted ({made})")
    elif answer["kept_by"]:
        print(f"fit {fit} of {answer['serial']} cannot be deleted: {'; '.join(answer['kept_by'])}")
    else:
        print(f"fit {fit} of {answer['serial']} would be deleted ({made}); to delete it: --yes")
