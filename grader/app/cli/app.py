"""The `grader` command: its subcommands and its error messages."""

import os
import sys
from collections.abc import Collection, Sequence
from contextlib import nullcontext, redirect_stderr, suppress
from importlib import import_module
from io import StringIO
from pathlib import Path
from typing import Annotated

import typer
from typer import Option

from grader import __version__
from grader.app.cli.ending import outer_limits, quiet_interrupts
from grader.app.cli.streams import warn
from grader.base.errors import GraderError, NotThereError
from grader.base.processor_time import GRADE_SECONDS, INSPECT_SECONDS
from grader.base.text import printable_path
from grader.report.invocation import ExitCode
from grader.report.writing import write_stdout

# In the order of the help, with the module of each: it holds a function, or a group of commands, of
# this name.
COMMANDS = {
    "grade": "grade",
    "inspect": "inspect",
    "graph": "graph",
    "view": "view",
    "lsp": "lsp",
    "batch": "batch",
    "mark": "review",
    "review": "review",
    "export": "class_grades",
    "diff": "class_grades",
    "stats": "class_grades",
    "bundle": "rubric",
    "explain": "explain",
    "schema": "explain",
    "rubric": "rubric",
}
# The commands that read one submission or workspace, with their limit of processor time in seconds.
_LIMITED = {"grade": GRADE_SECONDS, "inspect": INSPECT_SECONDS, "graph": INSPECT_SECONDS}


def _print_version(is_given: bool) -> None:
    if is_given:
        write_stdout(f"grader {__version__}\n")
        raise typer.Exit


def _root(
    version: Annotated[
        bool,
        Option(
            "--version",
            "-V",
            help="Print the version and exit.",
            callback=_print_version,
            is_eager=True,
        ),
    ] = False,
) -> None:
    """Grade robotics lab submissions: URDF, forward kinematics, ROS 2 package.

    Students start with grade, instructors with rubric show and batch. Each command describes its
    arguments under --help, with examples.

    Examples:

      grader grade my_robot.urdf

      grader rubric show lab6

      grader batch submissions.zip
    """


def make_app(names: Collection[str], *, completes: bool = False) -> typer.Typer:
    """Return the command line with these commands.

    Importing all of them takes longer than to grade a URDF. With `completes` it may answer a
    shell that completes a word.
    """
    app = typer.Typer(
        name="grader",
        no_args_is_help=True,
        add_completion=completes or len(names) > 1,
        rich_markup_mode=None,  # plain help takes a third of the time
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(
        _root if len(names) > 1 else lambda: None
    )  # the options of `grader` itself precede the command
    for name in names:
        command = getattr(import_module(f"grader.app.cli.{COMMANDS[name]}"), name)
        if isinstance(command, typer.Typer):
            app.add_typer(command, name=name)
        else:
            app.command()(command)
    return app


def run(arguments: Sequence[str]) -> int:
    """Run a command, print the text that it returns, and return the exit code.

    Every error is one line on standard error, never a traceback.
    """
    with quiet_interrupts():
        return _run(arguments)


def _run(arguments: Sequence[str]) -> int:
    try:
        if os.environ.get("_GRADER_COMPLETE"):
            return _complete()
        is_command = arguments and arguments[0] in COMMANDS
        app = make_app(arguments[:1] if is_command else COMMANDS)
        seconds = _LIMITED.get(arguments[0]) if arguments else None
        with outer_limits(seconds) if seconds and "--watch" not in arguments else nullcontext():
            result = app(list(arguments), standalone_mode=False, prog_name="grader")
        if isinstance(result, str):
            write_stdout(result)
    except (GraderError, OSError) as error:
        reason = _describe_error(error) if isinstance(error, OSError) else str(error)
        if isinstance(error, NotThereError):
            from grader.app.cli.usage import message_on_path  # late: most paths are correct

            reason = message_on_path(error, arguments)
        for line in reason.split("\n"):
            warn(line)
        return ExitCode.NOT_GRADED
    except (KeyboardInterrupt, typer.Abort):  # typer raises its own for Ctrl-C
        return ExitCode.INTERRUPTED
    except Exception as error:  # noqa: BLE001  no traceback ever reaches a user
        return _other_error(error, arguments)
    if result == 1 and arguments[0] in (
        "--show-completion",
        "--install-completion",
    ):  # typer's code for a shell that it does not know
        return ExitCode.NOT_GRADED
    return result if isinstance(result, int) else ExitCode.PASSED


def _describe_error(error: OSError) -> str:
    what = f"use {printable_path(error.filename)}" if isinstance(error.filename, str) else "write"
    return f"cannot {what}: {error.strerror or error}"


def _complete() -> int:
    """Print the completions of the word at the cursor.

    It prints nothing if there is an error, which the shell would show.
    """
    with redirect_stderr(StringIO()), suppress(Exception):
        try:
            typed = os.environ.get("COMP_WORDS") or os.environ.get("_TYPER_COMPLETE_ARGS", "")
            # Of the words, the one at the cursor may become another command.
            named = [word for word in typed.split(" ")[1:-1] if word in COMMANDS][:1]
            make_app(named or COMMANDS, completes=True)(prog_name="grader")
        except SystemExit as end:  # its code tells fish whether there are completions
            if isinstance(end.code, int):
                return end.code
            return 0
    return 0


def _other_error(error: Exception, arguments: Sequence[str]) -> ExitCode:
    if not hasattr(error, "format_message"):  # which typer's errors of usage have
        warn(_one_line(f"internal error, please report it: {type(error).__name__}: {error}"))
        return ExitCode.FAULT
    message = error.format_message()
    context = getattr(error, "ctx", None)
    if (
        context is not None and message == context.get_help()
    ):  # a group of commands without arguments
        print(message, file=sys.stderr)
        if not arguments:
            from grader.app.cli.usage import commands_here

            print(commands_here(Path.cwd()), end="", file=sys.stderr)
    else:
        from grader.app.cli.usage import usage_message  # late: most command lines are correct

        root = typer.main.get_command(make_app(COMMANDS))
        warn(_one_line(usage_message(error, arguments, root)))
    return ExitCode.NOT_GRADED


def _one_line(text: str) -> str:
    return " ".join(text.split())
