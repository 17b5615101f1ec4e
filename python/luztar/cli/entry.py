"""The console script: runs the command, and turns whatever happens into an exit code and one clear message."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence

from . import exits
from .output import say, say_error, tell

_FLAGS_END = "--"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code.

    Parameters
    ----------
    arguments : sequence of str, optional
        The words after the program's name; those of the process where not given.
    """
    # The work is shared out by luztar's own threads; a linear-algebra library that starts more for every small product
    # makes it slower. Read when NumPy is loaded, which is after this.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    given = list(sys.argv[1:] if arguments is None else arguments)
    flags = given[: given.index(_FLAGS_END)] if _FLAGS_END in given else given
    as_json, debug = "--json" in flags, "--debug" in flags
    for stream in (sys.stdout, sys.stderr):
        # A console that has no letter for a superscript two shows a question mark; it does not end the program.
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")
    try:
        with warnings.catch_warnings():
            if not debug and not sys.warnoptions:
                # They are written for programmers; what an engineer has to know is a finding of the run.
                warnings.simplefilter("ignore")
            # None lets the parser expand run*.csv where the shell does not.
            return _run(None if arguments is None else given)
    except KeyboardInterrupt:
        return _interrupted()
    except Exception as error:
        return _failed(error, as_json, debug)


def _run(arguments: list[str] | None) -> int:
    from .app import app

    try:
        code = app(args=arguments, prog_name="luztar", standalone_mode=False)
    except SystemExit as leaving:
        # Help into a pipe that was closed early: nobody waits for the code.
        code = 0 if leaving.code == 1 else leaving.code
    if code == exits.INTERRUPTED:
        return _interrupted()
    return int(code or 0)


def _interrupted() -> int:
    tell("stopped")
    return exits.INTERRUPTED


def _failed(error: Exception, as_json: bool, debug: bool) -> int:
    from ..errors import LuztarError

    if type(error).__name__ == "Abort":
        return _interrupted()
    if debug:
        import traceback

        traceback.print_exception(error)
    if isinstance(error, LuztarError):
        code = getattr(error, "exit_code", exits.INPUT)
        parts = {key: str(value) for key, value in error.to_dict().items()}
    elif hasattr(error, "format_message"):
        # A usage error of the parser; its class has moved between packages, its shape has not.
        code, parts = exits.INPUT, _usage(error)
    else:
        code, parts = exits.INTERNAL, _internal(error, debug)
    if as_json:
        say({"schema": 1, "error": parts})
    say_error(**parts)
    return code


def _usage(error: Exception) -> dict[str, str]:
    context = getattr(error, "ctx", None)
    where = context.command_path if context is not None else "luztar"
    kind = " ".join(str(error.format_message()).split())  # type: ignore[attr-defined]
    return {"kind": kind.rstrip("."), "where": where, "remedy": f"See '{where} --help'."}


def _internal(error: Exception, debug: bool) -> dict[str, str]:
    from .. import __version__

    text = " ".join(str(error).split())
    kind = f"internal error: {type(error).__name__}{f': {text}' if text else ''}"
    system = f"luztar {__version__}, Python {sys.version.split()[0]}, {sys.platform}"
    frames = error.__traceback__
    place = "luztar"
    while frames is not None:
        name = frames.tb_frame.f_globals.get("__name__", "")
        if name.startswith("luztar."):
            place = f"{name}, {frames.tb_frame.f_code.co_name}"
        frames = frames.tb_next
    remedy = f"This is a fault of luztar, not yours: please report it with the command and this version ({system})."
    if not debug:
        remedy += " --debug shows where it happened."
    return {"kind": kind, "where": place, "remedy": remedy}
