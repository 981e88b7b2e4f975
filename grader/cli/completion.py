"""Shell completion for bash, zsh and fish, on top of typer's."""

import io
import os
from collections.abc import Callable, Sequence
from contextlib import redirect_stderr, redirect_stdout, suppress
from importlib import import_module
from pathlib import Path
from typing import Any

import typer
from typer.main import get_command

from grader.cli.options import SHELLS
from grader.errors import GraderError, InputError
from grader.text import printable_path
from grader.usecases.writing import save, write_stdout

VARIABLE = "_GRADER_COMPLETE"  # the shell sets it to ask for completions
# typer's script for bash shows errors of the program, and adds a space after `--save json=`.
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
_typer: Any = import_module("typer.completion")  # its functions are not declared as exported


def complete(make_app: Callable[[Sequence[str]], typer.Typer], commands: Sequence[str]) -> int:
    """Print the completions of the word at the cursor; nothing if there is an error."""
    answer, code = io.StringIO(), 0
    with redirect_stdout(answer), redirect_stderr(io.StringIO()), suppress(Exception):
        _typer.completion_init()
        _join_equals_signs()
        typed = os.environ.get("COMP_WORDS") or os.environ.get("_TYPER_COMPLETE_ARGS", "")
        named = [word for word in typed.split()[1:2] if word in commands]  # to import no other command
        try:
            command: Any = get_command(make_app(named or commands))
            _describe_fully(command)
            _typer.shell_complete(command, {}, "grader", VARIABLE, os.environ[VARIABLE])
        except SystemExit as end:  # its code tells fish whether there are completions
            code = end.code if isinstance(end.code, int) else 0
    with suppress(GraderError):
        write_stdout(answer.getvalue())
    return code


def _describe_fully(group: Any) -> None:
    """Describe every command with the whole first line of its help, which typer would cut."""
    for command in getattr(group, "commands", {}).values():
        command.short_help = (command.help or "").partition("\n")[0]
        _describe_fully(command)


def _join_equals_signs() -> None:
    """Join `--rubric=lab`, which bash splits into three words, to an option and its value."""
    words = os.environ.get("COMP_WORDS", "").split("\n")
    cursor = int(os.environ.get("COMP_CWORD", "0"))
    signs = [  # not that at the cursor, which typer handles
        index for index, word in enumerate(words[:cursor]) if word == "=" and words[index - 1].startswith("--")
    ]
    os.environ["COMP_WORDS"] = "\n".join(word for index, word in enumerate(words) if index not in signs)
    os.environ["COMP_CWORD"] = str(cursor - len(signs))


def set_up(arguments: Sequence[str]) -> int:
    """Print the completion script of a shell, or install it. Raises GraderError."""
    option, _, value = arguments[0].partition("=")
    named = [word for word in (value, *arguments[1:]) if word]
    if len(named) > 1 or not set(named) <= set(SHELLS):
        raise GraderError(f"{option} takes one of {', '.join(SHELLS)}, not {' '.join(named)!r}")
    shell = named[0] if named else _detected(option)
    if option == "--show-completion":
        script = _typer.get_completion_script(prog_name="grader", complete_var=VARIABLE, shell=shell)
        write_stdout(_BASH if shell == "bash" else script + "\n")
    else:
        path = printable_path(_install(shell))
        write_stdout(f"completion for {shell} is installed in {path}; start a new shell to use it\n")
    return 0


def _install(shell: str) -> Path:
    try:
        path: Path = _typer.install(shell, "grader", VARIABLE)[1]
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(
            f"cannot install completion: {reason}; `grader --show-completion {shell}` prints the lines to add"
        ) from None
    if shell == "bash":
        save(path, _BASH)
    return path


def _detected(option: str) -> str:
    """Return the shell that started this process, or else the user's login shell. Raises GraderError if it is unknown."""
    try:
        name = str(import_module("shellingham").detect_shell()[0])  # a dependency of typer
    except Exception:  # noqa: BLE001  it fails in many ways, and $SHELL is next
        name = Path(os.environ.get("SHELL", "")).name
    if name not in SHELLS:
        raise GraderError(f"cannot detect the shell: use `grader {option} bash` (or {' or '.join(SHELLS[1:])})")
    return name
