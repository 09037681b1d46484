"""Write the reference pages from the program itself: `python docs/generate.py`. A test fails where they are stale."""

from __future__ import annotations

import ast
import inspect
import json
import math
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields
from functools import cache
from itertools import pairwise, product
from pathlib import Path
from typing import Any

import typer

from app.cli.program import program
from app.main import routed
from ident.bench.criteria import BENCH_CRITERIA
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.evidence import rule
from ident.effects import CATALOGUE
from ident.equations.equation import Equation
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.levenberg_marquardt import Way
from ident.noise.criteria import NOISE_CRITERIA
from ident.parameter import Parameter
from ident.presets import PRESETS, Preset
from ident.presets.signal_table import signal_table

DOCS = Path(__file__).resolve().parent
SOURCES = ("ident", "app", "schemas")
REFUSES = re.compile(r"\b(Unusable|Removed|Failure|problem)\(")
PASSED_ON = {("`…`", "422", "…", "…")}  # what a client says in the words of the service
NOTE = "<!-- written by docs/generate.py -->"


def pages() -> dict[str, str]:
    """Every generated page by file name."""
    return {
        "cli.md": command_line(), "models.md": models(), "errors.md": errors(), "http.md": over_http(),
        "openapi.json": document(), "criteria.md": criteria(), "diagnosis.md": diagnosis(),
    }  # fmt: skip


@cache
def openapi() -> dict[str, Any]:
    """The OpenAPI document of the service, of which two pages are written."""
    return routed().openapi()


def document() -> str:
    """The OpenAPI document of the service as text."""
    return json.dumps(openapi(), indent=1, ensure_ascii=False) + "\n"


HTTP_HEAD = (
    "Every request has the header `Authorization: Bearer TOKEN`, but those for health and the forms of sign-in. The",
    "service sends its own description as `/api/v1/openapi.json`; the same is [openapi.json](openapi.json), from which",
    "clients can be generated. [The service by example](service.md) shows requests and answers; a refusal is",
    "problem+json with one of [these codes](errors.md).",
)


def over_http() -> str:
    """Every operation of the service, with what it takes beside its path."""
    found = openapi()
    lines = ["# The service over HTTP", NOTE, "", *HTTP_HEAD, ""]
    rows: dict[str, list[tuple[str, str, str]]] = {}
    for path, operations in found["paths"].items():
        for method, operation in operations.items():
            said = operation.get("description") or operation.get("summary", "")
            taken = [f"`{one['name']}`" for one in operation.get("parameters", ()) if one["in"] == "query"]
            body = "".join(part.rpartition("/")[2] for part in bodies(operation))
            entry = (f"`{method.upper()} {path}`", said, ", ".join([*taken, *([f"body {body}"] if body else [])]))
            rows.setdefault(operation.get("tags", ["others"])[0], []).append(entry)
    for tag, entries in rows.items():
        lines += [f"## {tag.capitalize()}", "", *table(("operation", "what it does", "takes"), entries), ""]
    return "\n".join(lines)


def bodies(operation: dict[str, Any]) -> Iterator[str]:
    """The name of the model that a request has as its body, or its media type."""
    for media, content in operation.get("requestBody", {}).get("content", {}).items():
        named = content.get("schema", {})
        yield named.get("$ref") or next((one["$ref"] for one in named.get("anyOf", ()) if "$ref" in one), media)


def command_line() -> str:
    """The commands with their arguments and options."""
    lines = ["# The command line", NOTE, "", str(program.info.help), "", str(program.info.epilog), ""]
    for name, command in commands(typer.main.get_command(program)):
        arguments = " ".join(str(p.metavar) for p in command.params if is_argument(p))
        lines += [f"## servoident {name} {arguments}".rstrip(), "", inspect.cleandoc(command.help or ""), ""]
        rows = [row(option) for option in command.params if not is_argument(option) and option.name != "help"]
        if rows:
            lines += [*table(("option", "default", "meaning"), rows), ""]
    return "\n".join(lines)


def commands(group: Any, before: str = "") -> Iterator[tuple[str, Any]]:
    """Every command with its name, those of a command behind it."""
    for name, command in group.commands.items():
        yield before + name, command
        if hasattr(command, "commands"):
            yield from commands(command, f"{before}{name} ")


def is_argument(parameter: object) -> bool:
    """True for a positional argument."""
    return getattr(parameter, "param_type_name", "") == "argument"


def row(option: Any) -> tuple[str, str, str]:
    """An option as a row of the table."""
    metavar = f" {option.metavar}" if option.metavar else ""
    default = (
        "required"
        if option.required
        else ""
        if option.default is None or option.default is False
        else str(option.default)
    )
    return f"`{', '.join([*option.opts, *option.secondary_opts])}{metavar}`", default, str(option.help)


EFFECTS_HEAD = (
    "Each has one strength, its first parameter, with which it is off at 0; the others are shapes, held at their",
    "default unless a fit is given bounds for them; the stiffness of `end_stop` and those of `supply_ripple` are",
    "searched wherever the effect is. The middle of a stroke is that of the way which the fitted runs of a machine in",
    "open loop cover, where the zero of its transducer lies outside or they were driven against both ends. Within a",
    "place effects act in the order of this list. An equation",
    "reads a signal that its effect redefines as it was before; `:=` is a memory, on the right as it was at the start",
    "of the step; `lag(x, T)` is x/(T s + 1), `lag2(x, a1, a2)` is x/(a2 s² + a1 s + 1), `delay(x, T)` is x(t − T),",
    "`t` the time since the start of the record. A model takes an effect where it has the signals that it redefines,",
    "in their units. How to write one of your own: [own-effects.md](own-effects.md).",
)


SIGNALS_HEAD = (
    "An effect at a place may change the signals that arise there and at the places before it. It reads every signal.",
    "The last column of a table of signals has the effects of the library that change one.",
)


def models() -> str:
    """The models and the effects, with equations, units and bounds."""
    lines = ["# Models and effects", NOTE, "", "All quantities are SI.", *SIGNALS_HEAD, ""]
    for preset in PRESETS.values():
        lines += model(preset)
    lines += ["# Effects", "", *EFFECTS_HEAD, ""]
    for effect in CATALOGUE:
        on = ", ".join(f"`{signal}` ({unit})" for signal, unit in effect.units.items())
        lines += [f"## {effect.name}", "", f"At the place *{effect.place}*, on {on}: {effect.meaning}.", ""]
        lines += [*(f"    {text}" for text in effect.texts), ""]
        lines += [f"It shows as: {effect.looks}. Source: {effect.source}.", ""]
        lines += parameters(effect.parameters)
    return "\n".join(lines)


def model(preset: Preset) -> list[str]:
    """One model: citation, equations, parameters, notes."""
    lines = [f"## {preset.name}: {preset.title}", "", preset.citation, "", *equations(preset.equations)]
    return [*lines, *signals(preset), *parameters(preset.parameters), *(f"{note}\n" for note in preset.notes)]


def equations(of: Iterable[Equation]) -> list[str]:
    """Equations as a table."""
    rows = [(e.place, f"`{e.text}`", e.meaning) for e in of]
    return [*table(("place", "equation", "what it says"), rows), ""]


def signals(of: Preset) -> list[str]:
    """What an equation of an effect may read, where it arises, and which effects change it."""
    rows = [
        (
            f"`{one.name}`",
            one.symbol,
            one.unit,
            one.place,
            one.meaning,
            ", ".join(f"`{name}`" for name in one.changed_by),
        )
        for one in signal_table(of)
    ]
    return [*table(("signal", "symbol", "unit", "arises at", "meaning", "changed by"), rows), ""]


def parameters(of: Iterable[Parameter]) -> list[str]:
    """Parameters as a table."""
    rows = [(f"`{p.name}`", p.symbol, p.unit, f"{p.lower:g} … {p.upper:g}", f"{p.value:g}", p.meaning) for p in of]
    return [*table(("name", "symbol", "unit", "bounds", "default", "meaning"), rows), ""]


CRITERIA_HEAD = (
    "Every number that decides in a [diagnosis](diagnosis.md), in a fit, on a bench or about noise, by the stage",
    "or step that it decides in, as the `criteria.py` of each folder has it. Read a row as: value, unit, what it is.",
)
CRITERIA_OF: dict[str, Any] = {
    "Diagnosis": CRITERIA,
    "Fit": FIT_CRITERIA,
    "Noise": NOISE_CRITERIA,
    "Bench": BENCH_CRITERIA,
}


def criteria() -> str:
    """Every number that decides, by room and section, with its unit, its meaning and its reason."""
    lines = ["# The numbers that decide", NOTE, "", *CRITERIA_HEAD, ""]
    for room, criteria_of_room in CRITERIA_OF.items():
        lines += [f"## {room}", ""]
        for section in fields(criteria_of_room):
            lines += criteria_of_section(section.name, getattr(criteria_of_room, section.name))
    return "\n".join(lines).rstrip() + "\n"


def criteria_of_section(name: str, of: Any) -> list[str]:
    """The table of the numbers of one section."""
    below, rows = documented(Path(inspect.getfile(type(of))), type(of).__name__), []
    for one in fields(of):
        unit, meaning, reason = below[one.name]
        value = getattr(of, one.name)
        shown = f"{value.most} steps, to {value.converged:g}" if isinstance(value, Way) else str(value)
        rows.append((one.name.replace("_", " "), shown, unit, meaning, reason))
    columns = ("number", "value", "unit", "what it is", "why")
    title = name.replace("_", " ").capitalize()
    return [f"### {title}", "", inspect.getdoc(type(of)) or "", "", *table(columns, rows), ""]


def documented(file: Path, section: str) -> dict[str, tuple[str, str, str]]:
    """What is written below each number of a section: its unit, its meaning and its reason."""
    found = {}
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ClassDef) and node.name == section:
            for one, below in pairwise(node.body):
                if isinstance(one, ast.AnnAssign) and isinstance(below, ast.Expr):
                    text = " ".join(str(ast.literal_eval(below.value)).split())
                    parts = re.fullmatch(r"\[([^]]+)\] (.+?)\. Why: (.+?)\.(?: Test: .*)?", text)
                    assert parts, f"{file}: {text}"
                    found[str(ast.unparse(one.target))] = (parts[1], parts[2], parts[3])
    return found


def diagnosis() -> str:
    """The page on the diagnosis: the section on the verdict has its numbers from the criteria, the rule by which an
    effect is added its questions from the text of the rule."""
    text = (DOCS / "diagnosis.md").read_text(encoding="utf-8")
    text = written_between(text, f"## Why this verdict\n\n{NOTE}\n", "\n## ", "\n".join(why_this_verdict()))
    _, _, questions = (rule.__doc__ or "").partition("\n\n* ")
    return written_between(
        text, f"these questions are asked.\n\n{NOTE}\n", "\nOn validation data", f"* {questions.rstrip()}"
    )


def written_between(text: str, begin: str, end: str, written: str) -> str:
    """The text with what stands between two marks written anew."""
    before, mark, after = text.partition(begin)
    _, heading, others = after.partition(end)
    return "".join([before, mark, "\n", written, "\n", heading, others])


def why_this_verdict() -> list[str]:
    """Which numbers decide a standing and a group, and which field of the answer has them."""
    noise, limits, deviations = CRITERIA.noise, CRITERIA.evidence, CRITERIA.verification.deviations
    gain, chance = math.log(1.0 / limits.chance - 1.0) / limits.learning_rate, f"{100 * limits.chance:g} %"
    reasons = (
        ("`unexplained`", f"""a floor is known: `error` is not below `limit` = ({limits.floor_margin:g} +
          {noise.floor_deviations:g} × relative deviation) × `floor`, the deviation √(½/n + ½/d) of n independent
          samples of the residual and d degrees of freedom of the floor; of a bench
          {1 + noise.bench_excess:g} is in the place of {limits.floor_margin:g}. Where no command was repeated and the
          error is at most {noise.colour:g} times the floor, `predicted` has to be above `predicted_limit`, too""",
         "`noise_test`", "look at `proposals` and at the figure `residual-curve`"),
        ("`unexplained`", f"""no floor is known: the `correlation` of neighbouring residuals is above
          `limit` = {noise.noise_correlation:g}""", "`noise_test`", "record one run twice: that gives a floor"),
        ("`untested`", "there was no time to test the residual", "`complete`, `not_looked_at`", "give more time"),
        ("`at_bound`", "no floor is known, and the strength of a named effect ended at the bound of its search",
         "`at_bound`", "search within wider bounds, or record one run twice"),
        ("`dispensable_contradicted`", f"""the error on validation data rises by more than {deviations:g} standard
          errors with an effect that proposed terms made dispensable""",
         "`stood_in`, `ladder[].error.verify`", "look at `proposals`"),
    )  # fmt: skip
    numbers = (
        ("`gain`", f"`gain_limit`, {gain:.3g} nats either way",
         f"beyond it one of the two is less probable than {chance}"),
        ("`apart`", f"""`apart_limit`: {100 * limits.separation:g} % of the power that the better one leaves above the
          noise, or `hidden` where that is more""",
         "power of the difference of the outputs; the noise hides it up to `hidden`"),
        ("`means_apart`", f"`means_limit`, {limits.level:g}",
         "difference of the means of the runs, over the output's deviation"),
        ("`difference`", f"`difference_limit`, which chance passes in {chance} of cases on each side",
         "of the powers of the two errors; it does not count where `apart` is below `hidden`"),
    )  # fmt: skip
    return [
        "The fields are those of `verdict` in the JSON, over HTTP and in Python; `ladder`, `candidates`, `complete`,",
        "`not_looked_at`, `proposals`, `effect_sets` and `next_experiment` are fields of the diagnosis itself.",
        "",
        "**Why `stand_in`?** `because` has the reasons. It is empty in every other standing. Without such a reason,",
        "and without a contradicted effect, the standing is *found*.",
        "",
        *table(("reason", "what it means", "fields", "remedy"), reasons),
        "",
        "`probability` and `probabilities` are computed apart from this: a stand-in may be probable. No sentence has",
        "the word. What remains is called something unlisted where `probabilities` has at least a half for `unlisted`,",
        "otherwise noise or a drift. The first of the three lines says *Missing: …*; it says *The error falls with …*",
        "of an effect below a half, where `unlisted` has at least a half or `nothing` has more than the effect.",
        "",
        "**Why contradicted?** With each effect of `contradicted_by` the error on validation data rises by more than",
        f"{deviations:g} of its standard errors, from the stable rung of `ladder` before to its own, or the model is",
        "unstable there. `contradictions` has the numbers of each: the errors `before` and `after`, the rise in",
        "standard errors (`deviations`), and the runs on which the model is `unstable`. Where the mean counts the",
        "errors `with_mean` are those that rise. Over windows the error of the `free_run` may rise in place of the",
        "error over windows, where these do not confirm the effect. One such effect makes the whole standing",
        "*contradicted*, and `because` is empty then. It would be *found* if no error rose so and no reason of a",
        "`stand_in` held (see `noise_test`, `at_bound`, `stood_in`). A last effect of which validation data then show",
        "nothing is not named (`unconfirmed`).",
        "",
        "**Why one group?** `alternatives` has a row for each other effect of a group in the place of the named one.",
        "All four numbers of its `separation` are within their limits:",
        "",
        *table(("number", "limit", "meaning"), numbers),
        "",
        "An effect that is indistinguishable from the best of the group belongs to it, too, also where a number",
        "against the named one is beyond its limit. An effect that another dominates is left out: it leaves more",
        f"beyond its error, by {100 * limits.share:g} % of its residual above the noise. Groups follow from these",
        "data, never from a list. Coulomb and Stribeck friction, for example, are one constant force at speeds far",
        "below the speed at which the second falls. The more is unexplained, the wider is a group, by the limit of",
        "`apart`.",
        "",
        "**Why no group?** An effect may be nearly as probable and yet in no group: a probability follows from gains,",
        "the first of the four numbers, alone. Another number is beyond its limit: `competing` has the four numbers",
        "of each effect that is as probable by its gain, in the place of a named one. Where all four are within their",
        "limits another effect dominates it.",
        "And `probabilities` sum all sets with an effect: it may act together with the named one, not in its place",
        "(`effect_sets` has each set with its gain). An effect that was not refitted there is in no group, either.",
        "A group around an effect of `stood_in`, `unconfirmed` or `by_chance` is not said.",
        "`group_probabilities` has the probability of a group. `next_experiment` of the diagnosis is the run that",
        "separates it best.",
        "",
        "**Why was an effect not added?** `candidates[].why` says it in words, `candidates[].evidence` in numbers;",
        "[the evidence](#evidence) has the rule.",
    ]


def errors() -> str:
    """Every error code, with what it says and its remedy; a name in braces stands for what is filled in."""
    rows = sorted({found for folder in SOURCES for file in source_files(folder) for found in codes(file)} - PASSED_ON)
    head = [
        "# Errors",
        NOTE,
        "",
        "What cannot be used or done is refused with a code, with what is wrong, where, and the remedy. The command",
        "line prints it in one line and exits with 2; the service answers with problem+json whose `code` is this one,",
        "and the HTTP status below. A name in braces, such as {name}, is a value; … is a whole text.",
        "",
    ]
    return "\n".join([*head, *table(("code", "HTTP", "what", "remedy"), rows), ""])


def source_files(folder: str) -> Iterator[Path]:
    """The Python files of a package."""
    return (DOCS.parent / folder).rglob("*.py")


def codes(file: Path) -> Iterator[tuple[str, str, str, str]]:
    """Code, HTTP status, what and remedy of every refusal in a file."""
    source = file.read_text(encoding="utf-8")
    if not REFUSES.search(source):
        return
    tree = ast.parse(source)
    for node, assigned in calls(tree, {}):
        match node:
            case ast.Call(ast.Name("Unusable"), [code, what, _, remedy]):
                given, status = (code, what, remedy), "422"
            case ast.Call(ast.Name("Removed"), [code, what, _, remedy]):
                given, status = (code, what, remedy), "410"
            case ast.Call(ast.Name("Failure" | "problem"), [ast.Constant(number), code, what, _, remedy]):
                given, status = (code, what, remedy), str(number)
            case _:
                continue
        names, whats, remedies = (alternatives(one, assigned) for one in given)
        paired = len(whats) == len(remedies)  # each was assigned where the other was
        for name, (said, cure) in product(
            names, zip(whats, remedies, strict=True) if paired else product(whats, remedies)
        ):
            yield f"`{name}`", status, said, cure


Assigned = Mapping[str, list[ast.expr]]
"""What the names of a function are assigned, in the order of the source."""


def calls(node: ast.AST, assigned: Assigned) -> Iterator[tuple[ast.Call, Assigned]]:
    """Every call below a node, with what the names of its function are assigned."""
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
        assigned = assignments(node)
    if isinstance(node, ast.Call):
        yield node, assigned
    for child in ast.iter_child_nodes(node):
        yield from calls(child, assigned)


def assignments(function: ast.AST) -> Assigned:
    """By name, also where several are assigned at once."""
    found: dict[str, list[ast.expr]] = {}
    for node in ast.walk(function):
        match node:
            case ast.Assign([ast.Name(name)], value):
                found.setdefault(name, []).append(value)
            case ast.Assign([ast.Tuple(names)], ast.Tuple(values)) if len(names) == len(values):
                for target, value in zip(names, values, strict=True):
                    found.setdefault(ast.unparse(target), []).append(value)
    return found


def alternatives(node: ast.expr, assigned: Assigned) -> list[str]:
    """The texts that an expression may be: those of a choice, or those that its name is assigned."""
    match node:
        case ast.IfExp():
            return [*alternatives(node.body, assigned), *alternatives(node.orelse, assigned)]
        case ast.Name(name) if name in assigned:
            rest = {other: values for other, values in assigned.items() if other != name}
            return [text for value in assigned[name] for text in alternatives(value, rest)]
        case _:
            return [words(node)]


def words(node: ast.expr) -> str:
    """The text of a string in the source, with the name of each value that is filled in; … where it has none."""
    match node:
        case ast.Constant():
            return str(node.value)
        case ast.JoinedStr():
            return "".join(words(part) for part in node.values)
        case ast.FormattedValue(value):
            return f"{{{named(value)}}}"
        case ast.Call(ast.Name("did_you_mean"), [_, _, ast.Constant(otherwise)]):
            return f"did you mean {{name}}?, or: {otherwise!s}"
        case ast.Call(ast.Name("did_you_mean")):
            return "did you mean {name}?, or the names to choose from"
        case _:
            return "…"


def named(value: ast.expr) -> str:
    """The name of a value in a text: of what is counted, joined or looked up in it."""
    match value:
        case ast.Name(name) | ast.Attribute(attr=name):
            return name.strip("_").lower()
        case ast.Subscript(inner) | ast.Call(args=[inner, *_]) | ast.Call(ast.Attribute(inner)):
            return named(inner)
        case _:
            return "…"


def table(header: Iterable[str], rows: Iterable[Iterable[str]]) -> list[str]:
    """A Markdown table."""
    header = tuple(header)
    escaped = ([" ".join(cell.replace("|", "\\|").split()) for cell in cells] for cells in rows)
    return [line(header), line("---" for _ in header), *map(line, escaped)]


def line(cells: Iterable[str]) -> str:
    """A row of a Markdown table."""
    return f"| {' | '.join(cells)} |"


def broken(text: str) -> list[str]:
    """What in a document would break a client of the one that is kept."""
    sys.path.insert(0, str(DOCS.parent))
    from tests.contract.breaking import breaks  # noqa: PLC0415  the tests are no part of what is installed

    kept = DOCS / "openapi.json"
    return list(breaks(json.loads(kept.read_text(encoding="utf-8")), json.loads(text))) if kept.exists() else []


if __name__ == "__main__":
    if "--break" not in sys.argv and (lines := broken(document())):
        sys.exit("\n".join(["this would break clients of the API; --break writes it nevertheless:", *lines]))
    for name, text in pages().items():
        (DOCS / name).write_text(text, encoding="utf-8")
