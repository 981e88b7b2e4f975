"""The `grader` command and its subcommands."""

import os
import re
import sys
from collections.abc import Sequence
from importlib import import_module

import typer

from grader.cli.output import complain
from grader.errors import GraderError, RubricError
from grader.text import printable

FAULT_OF_USE, FAULT_OF_OURS, INTERRUPTED = 2, 3, 130

# In the order of the help. Each is the function of its name, or the group of commands, in the module of that name.
COMMANDS = (
    "grade",
    "inspect",
    "batch",
    "mark",
    "review",
    "export",
    "diff",
    "stats",
    "bundle",
    "explain",
    "schema",
    "rubric",
)

COMPLETE = "_GRADER_COMPLETE"  # set by the shell when it asks for completions
COMPLETION_OPTIONS = ("--show-completion", "--install-completion")
_BELOW_ZERO = re.compile(r"-[.,]?[0-9]")
_AWAITS_VALUE = re.compile(r"--[^=]+")  # --comment, behind which -1 is the comment


def _app(names: Sequence[str]) -> typer.Typer:
    """The command line with some of its commands: all of them take longer to make than many a grading."""
    app = typer.Typer(
        name="grader",
        no_args_is_help=True,
        add_completion=False,
        rich_markup_mode=None,  # plain help: it is read in a third of the time
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    if len(names) > 1:
        from grader.cli.root import root

        app.callback()(root)
    else:  # options of the grader itself stand before the command
        app.callback()(_nothing)
    for name in names:
        command = getattr(import_module(f"grader.cli.{name}"), name)
        if isinstance(command, typer.Typer):
            app.add_typer(command, name=name)
        else:
            app.command()(command)
    return app


def _nothing() -> None:
    """There is nothing to do before a command."""


def run(arguments: Sequence[str]) -> int:
    """Run one command; the exit code. Whatever goes wrong is one clear line on standard error."""
    try:
        if os.environ.get(COMPLETE):  # the shell asks, and would show every error in the middle of what is typed
            from grader.cli.completion import complete

            return complete(_app, COMMANDS)
        if arguments and arguments[0].partition("=")[0] in COMPLETION_OPTIONS:
            from grader.cli.completion import set_up

            return set_up(arguments)
        result = _app(_named(arguments) or COMMANDS)(
            _numbers_last(arguments), standalone_mode=False, prog_name="grader"
        )
    except RubricError as error:
        for line in error.complaints:
            complain(line)
        return FAULT_OF_USE
    except GraderError as error:
        complain(str(error))
        return FAULT_OF_USE
    except KeyboardInterrupt:
        return INTERRUPTED
    except OSError as error:
        complain(f"cannot write: {error.strerror or error}")
        return FAULT_OF_USE
    except Exception as error:  # noqa: BLE001  no traceback ever reaches a user
        return _other(error)
    return result if isinstance(result, int) else 0


def _named(arguments: Sequence[str]) -> list[str]:
    """The command that is typed, if it is one; raises GraderError where the name of a file stands in its place."""
    first = arguments[0] if arguments else "-"
    if first in COMMANDS:
        return [first]
    if not first.startswith("-") and os.path.lexists(first):
        raise GraderError(f"there is no command {first!r}: grader grade {printable(first)} grades it")
    return []


def _other(error: Exception) -> int:
    if type(error).__name__ == "Abort":  # typer's word for Ctrl-C
        return INTERRUPTED
    usage = getattr(error, "format_message", None)
    if usage is not None:  # wrong usage, as typer says it
        command = getattr(getattr(error, "ctx", None), "command_path", "grader")
        if type(error).__name__ == "NoArgsIsHelpError":
            print(usage(), file=sys.stderr)
        else:
            complain(_one_line(f"{usage()} ({command} --help shows the usage)"))
        return FAULT_OF_USE
    complain(_one_line(f"a fault of the grader itself, please report it: {type(error).__name__}: {error}"))
    return FAULT_OF_OURS


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _numbers_last(arguments: Sequence[str]) -> list[str]:
    """What is typed, but for `mark a b -1`, which is `mark a b -- -1`: points below 0 are refused as points, not as an option."""
    typed = list(arguments)
    if typed[:1] == ["mark"] and "--" not in typed:
        for index in reversed(range(1, len(typed))):
            if _BELOW_ZERO.match(typed[index]) and not _AWAITS_VALUE.fullmatch(typed[index - 1]):
                return [*typed[:index], *typed[index + 1 :], "--", typed[index]]
    return typed
