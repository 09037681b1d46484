"""Whatever goes wrong, as one line for the user and an exit status."""

from __future__ import annotations

import errno
import logging
import os
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path

from typer import TyperException

from ident.errors import Cancelled, Unusable
from ident.words.nearest import did_you_mean

UNUSABLE = 2
INTERRUPTED = 130
UNREAD = 141  # as the system ends a program whose reader has gone (128 + SIGPIPE)
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
            return UNUSABLE, f"{error.filename}: {error.strerror}; check the name, the permissions and the free space"
        case OSError() if error.errno in (errno.ENOSPC, errno.EDQUOT):
            return UNUSABLE, f"output: {error.strerror}; check the free space of the target"
        case MemoryError():
            return UNUSABLE, "the machine has too little memory for this matrix; use fewer or shorter runs"
        case _:
            return DEFECT, f"unexpected error ({type(error).__name__}); a defect of the program, {kept(error)}"


def _of_arguments(error: TyperException) -> str:
    """What is said of arguments that cannot be read; of an option that a command has not, the nearest that it has."""
    given, context = getattr(error, "option_name", None), getattr(error, "ctx", None)
    usual = "`servoident --help` shows what there is"
    if given is None or context is None or given in (known := [o for p in context.command.params for o in p.opts]):
        return f"{error.format_message().rstrip('.')}; {usual}"
    return f"{error.format_message().partition(' (')[0]}; {did_you_mean(given, known, usual)}"


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
