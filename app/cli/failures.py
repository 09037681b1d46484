"""Whatever goes wrong, as one line for the user and an exit status."""

from __future__ import annotations

import errno
import logging
import os
import re
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from typer import TyperException

from ident.errors import Cancelled, Unusable
from ident.words.nearest import did_you_mean

UNUSABLE = 2
INTERRUPTED = 130
UNREAD = 141  # as the system ends a program whose reader has gone (128 + SIGPIPE)
_HELP = "`{} --help` shows what there is"
DEFECT = 70  # EX_SOFTWARE of sysexits.h: neither the input nor the user is to blame


def report(error: BaseException) -> int:
    """Print `error` as one line on standard error; returns the exit status that belongs to it."""
    if isinstance(error, OSError) and error.filename is None:
        silence()
    if isinstance(error, BrokenPipeError):
        return UNREAD
    status, text = explain(error)
    print(f"servoident: {' '.join(text.split())}", file=sys.stderr)
    return status


def silence() -> None:
    """Send what is left of standard output nowhere: it could not be written, and would fail again at the end."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def explain(error: BaseException) -> tuple[int, str]:
    """The exit status of `error` and its line: what, where, and the remedy."""
    match error:
        case Cancelled() if error.args:
            return INTERRUPTED, f"interrupted; {error}"
        case KeyboardInterrupt() | Cancelled():
            return INTERRUPTED, "interrupted; nothing was written"
        case Unusable():
            return UNUSABLE, str(error)
        case TyperException():
            return UNUSABLE, _of_arguments(error)
        case OSError() if error.filename is not None:
            return UNUSABLE, f"{error.filename}: {_of_file(error)}"
        case OSError() if error.errno in (errno.ENOSPC, errno.EDQUOT):
            return UNUSABLE, f"output: {error.strerror}; check the free space of the target"
        case MemoryError():
            return UNUSABLE, "the machine has too little memory for this matrix; use fewer or shorter runs"
        case _:
            return DEFECT, f"unexpected error ({type(error).__name__}); a defect of the program, {kept(error)}"


def _of_file(error: OSError) -> str:
    if isinstance(error, FileNotFoundError):
        return "there is no such file or folder; correct the name"
    return f"{error.strerror}; check the name, the permissions and the free space"


def _of_arguments(error: TyperException) -> str:
    """What is said of arguments that cannot be read: what is wrong, and the nearest that there is or how to call it."""
    option, context = getattr(error, "option_name", None), getattr(error, "ctx", None)
    said = error.format_message().rstrip(".")
    said = re.sub(r": Input should be a valid (\w+).*", r": not of type \1", f"{said[:1].lower()}{said[1:]}")
    if context is None:
        bare = re.match(r"option '(-\S+)' requires", said)
        return f"{said}; type {bare[1]} VALUE" if bare else f"{said}; {_HELP.format('servoident')}"
    command, known = context.command_path, {name: one for one in context.command.params for name in one.opts}
    where, usual = f"{command.partition(' ')[2]}: ".removeprefix(": "), _HELP.format(command)
    if option is not None and option not in known:
        return f"{where}there is no option {option}; {did_you_mean(option, known, usual)}"
    if found := re.match(r"no such command '(.*?)'", said):
        return f"{where}there is no command {found[1]!r}; {did_you_mean(found[1], context.command.commands, usual)}"
    if said.startswith("missing"):
        needed = [_written(one) for one in context.command.params if one.required]
        return f"{where}{said}; type {' '.join((command, *needed))}"
    parameter = known.get(option) or getattr(error, "param", None)
    return f"{where}{said}; type {_written(parameter)}" if parameter else f"{where}{said}; {usual}"


def _written(parameter: Any) -> str:
    """How an argument or an option is written: ``MATRIX``, ``--seed INTEGER``."""
    form = parameter.metavar or parameter.name.upper()
    return form if parameter.param_type_name == "argument" else f"{parameter.opts[-1]} {form}"


def kept(error: BaseException) -> str:
    """Append the traceback to the error log; returns where it is, in words."""
    log = error_log()
    try:
        log.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        with log.open("a", encoding="utf-8", errors="backslashreplace") as file:
            print(datetime.now(UTC).isoformat(timespec="seconds"), *sys.argv, file=file)
            traceback.print_exception(error, file=file)
    except OSError as failure:
        return f"and its log cannot be written to {log} ({failure.strerror})"
    return f"details are in {log}"


class ToErrorLog(logging.Handler):
    """Keeps the tracebacks of what failed beside a result that stands: its note tells the user."""

    def emit(self, record: logging.LogRecord) -> None:
        """Append it to the error log."""
        if record.exc_info and record.exc_info[1] is not None:
            kept(record.exc_info[1])


@contextmanager
def logged() -> Iterator[None]:
    """Until the block ends, what fails beside a diagnosis that stands goes to the error log."""
    log, handler = logging.getLogger("servoident.diagnosis"), ToErrorLog()
    log.addHandler(handler)
    try:
        yield
    finally:
        log.removeHandler(handler)


def error_log() -> Path:
    """The file that keeps tracebacks, in the user's state folder."""
    state = os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state"
    return Path(state) / "servoident" / "errors.log"
