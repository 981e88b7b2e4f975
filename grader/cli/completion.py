"""Completion in bash, zsh and fish: typer answers the shell, and here is what is said around it."""

import io
import os
from collections.abc import Callable, Sequence
from contextlib import redirect_stderr, redirect_stdout, suppress
from importlib import import_module
from pathlib import Path
from typing import Any

import typer
from typer.main import get_command

from grader.cli.output import emit
from grader.cli.suggestions import SHELLS
from grader.errors import GraderError, InputError
from grader.text import printable_path
from grader.usecases.writing import save

_VARIABLE = "_GRADER_COMPLETE"
# Of typer's own script for bash two things would be seen: an error of the program, and a space behind `--save json=`.
_BASH = """\
_grader_completion() {
    local IFS=$'\\n'
    COMPREPLY=( $( env COMP_WORDS="${COMP_WORDS[*]}" COMP_CWORD=$COMP_CWORD \\
                   _GRADER_COMPLETE=complete_bash "${1/#\\~/$HOME}" 2> /dev/null ) )
    [[ ${COMPREPLY-} == *= ]] && compopt -o nospace 2> /dev/null
    return 0
}

complete -o default -F _grader_completion grader
"""
_typer: Any = import_module("typer.completion")  # which says of its functions that they are not exported


def complete(make_app: Callable[[Sequence[str]], typer.Typer], commands: Sequence[str]) -> int:
    """Print what the word that is being typed may become: nothing where that cannot be told, and never an error."""
    answer, code = io.StringIO(), 0
    with redirect_stdout(answer), redirect_stderr(io.StringIO()), suppress(Exception):
        _typer.completion_init()
        _join_equals()
        typed = os.environ.get("COMP_WORDS") or os.environ.get("_TYPER_COMPLETE_ARGS", "")
        named = [each for each in typed.split()[1:2] if each in commands]  # no other command has to be loaded
        try:
            command: Any = get_command(make_app(named or commands))
            _tell_in_full(command)
            _typer.shell_complete(command, {}, "grader", _VARIABLE, os.environ[_VARIABLE])
        except SystemExit as end:  # by which fish is told whether there is anything
            code = end.code if isinstance(end.code, int) else 0
    with suppress(GraderError):
        emit(answer.getvalue())
    return code


def _tell_in_full(group: Any) -> None:
    """Have each command described by the whole first line of its help, which is cut otherwise."""
    for command in getattr(group, "commands", {}).values():
        command.short_help = (command.help or "").partition("\n")[0]
        _tell_in_full(command)


def _join_equals() -> None:
    """Make one of what bash takes for three words: `--rubric=lab` is an option and its value."""
    words = os.environ.get("COMP_WORDS", "").split("\n")
    cursor = int(os.environ.get("COMP_CWORD", "0"))
    signs = [  # not the one that the cursor is at: typer knows what that is
        index for index, word in enumerate(words[:cursor]) if word == "=" and words[index - 1].startswith("--")
    ]
    os.environ["COMP_WORDS"] = "\n".join(word for index, word in enumerate(words) if index not in signs)
    os.environ["COMP_CWORD"] = str(cursor - len(signs))


def set_up(arguments: Sequence[str]) -> int:
    """Print the script that makes a shell complete our commands, or put it where the shell reads it. Raises GraderError."""
    option, _, value = arguments[0].partition("=")
    named = [each for each in (value, *arguments[1:]) if each]
    if len(named) > 1 or not set(named) <= set(SHELLS):
        raise GraderError(f"{option} takes one of {', '.join(SHELLS)}, not {' '.join(named)!r}")
    shell = named[0] if named else _detected(option)
    if option == "--show-completion":
        emit(_script(shell))
    else:
        emit(
            f"completion for {shell} is in {printable_path(_install(shell))}: it works in the next shell that is started\n"
        )
    return 0


def _script(shell: str) -> str:
    if shell == "bash":
        return _BASH
    script: str = _typer.get_completion_script(prog_name="grader", complete_var=_VARIABLE, shell=shell)
    return script + "\n"


def _install(shell: str) -> Path:
    try:
        path: Path = _typer.install(shell, "grader", _VARIABLE)[1]
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(
            f"completion cannot be installed: {reason}; grader --show-completion {shell} prints what to add"
        ) from None
    if shell == "bash":
        save(path, _BASH)
    return path


def _detected(option: str) -> str:
    """The shell that has started us, or else the user's own; raises GraderError where neither is known."""
    try:
        name = str(import_module("shellingham").detect_shell()[0])  # which typer comes with
    except Exception:  # noqa: BLE001  it has many ways to fail, and there is another to ask
        name = Path(os.environ.get("SHELL", "")).name
    if name not in SHELLS:
        raise GraderError(
            f"which shell this is for has to be said: grader {option} bash (or {' or '.join(SHELLS[1:])})"
        )
    return name
