"""What to type in place of a command line that is refused. It is loaded only then."""

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from grader.base.errors import NotThereError
from grader.base.names import closest
from grader.base.text import enumerated, printable, shell_quoted
from grader.files.limits import ROBOT_ENDINGS
from grader.lab.rubric.rubric import shipped_rubrics

# What a command is called elsewhere.
_COMMANDS = {
    "check": "grade",
    "test": "grade",
    "run": "grade",
    "score": "grade",
    "watch": "grade --watch",
    "fix": "grade --fix fixed.urdf",
    "lint": "inspect",
    "validate": "inspect",
    "display": "view",
    "rviz": "view",
    "class": "batch",
    "help": "--help",
    "version": "--version",
}
_SUBMISSIONS = (*ROBOT_ENDINGS, ".zip", ".tar.gz", ".tgz")
# Of options that are given without their value.
_EXAMPLES = {
    "--fix": "my_robot.urdf --fix fixed.urdf",
    "--format": "my_robot.urdf --format markdown",
    "--part": "my_robot.urdf --part task1",
    "--rubric": "my_robot.urdf --rubric lab6",
    "--save": "my_robot.urdf --save html=report.html",
}
_DASHES = "\u2010\u2011\u2012\u2013\u2014\u2212-"  # in place of hyphens, as word processors write
_QUOTES = "\u2018\u2019\u201c\u201d'\""
_MAX_COMMANDS = 3  # that are named


_IN_GRADEBOOK = {
    "grader stats": "the grades and the mistakes of the class",
    "grader review": "what needs manual grading, in the browser",
    "grader export csv": "the grades for a spreadsheet",
}
_IN_WORKSPACE = {
    "grader inspect": "what is wrong in its robots and other files",
    "grader grade --rubric lab6": "the points of a lab, and what to fix first",
    "grader view": "the robot in the browser, again after each change",
    "grader graph": "the nodes and topics of its launch files",
}


def commands_here(folder: Path) -> str:
    """Return what can be done in a folder with a package, a robot or a gradebook, in lines.

    It is empty for another folder.
    """
    try:
        names = [entry.name for entry in sorted(folder.iterdir(), key=lambda entry: entry.name)]
    except OSError:
        return ""
    robots = [name for name in names if name.endswith(ROBOT_ENDINGS)]
    commands = _IN_WORKSPACE
    if {"class.toml", "results.jsonl"} <= {*names}:
        what = "a gradebook"
        commands = _IN_GRADEBOOK
    elif {"package.xml", "src"} & {*names}:
        what = "a package" if "package.xml" in names else "a workspace"
    elif robots:
        what = robots[0]
    else:
        return ""
    width = max(map(len, commands)) + 2
    rows = [f"  {command.ljust(width)}{about}" for command, about in commands.items()]
    return "\n".join(["", f"In this folder ({printable(what)}):", *rows, ""])


class _CommandLine(NamedTuple):
    """A command line that is refused."""

    words: list[str]
    root: Any  # the command line of typer with all commands
    command: Any  # of typer: the one that refuses the words
    start: int  # the number of words that name the command

    @property
    def options(self) -> Mapping[str, Any]:
        """The options that the command has, by their names."""
        return {name: param for param in self.command.params for name in param.opts}

    @property
    def loose(self) -> list[int]:
        """The indices of the words that are neither options nor their values."""
        positions = []
        is_value = False
        for index, word in enumerate(self.words[self.start :], self.start):
            if is_value:
                is_value = False
            elif word.startswith("-") and word != "-":
                option = self.options.get(word)
                is_value = option is not None and not option.is_flag
            else:
                positions.append(index)
        return positions

    def replaced(self, start: int, end: int, *words: str) -> list[str]:
        """Return the words with others in place of some of them."""
        return [*self.words[:start], *words, *self.words[end:]]


class _Correction(NamedTuple):
    """What to type in place of a command line, and why."""

    why: str
    words: list[str]


def usage_message(error: Any, arguments: Sequence[str], root: Any) -> str:
    """Return one line on an error of usage: what is wrong, and what to type.

    `root` is the command line of typer with all commands.
    """
    line = _command_line(arguments, root)
    correction = _correct_hyphens(line) or _correct_command(line)
    correction = correction or _correct_option(line, error) or _correct_choice(line, error)
    if correction:
        return f"{correction.why}: `grader {_shown(correction.words)}`"
    if hasattr(error, "possibilities"):
        error.possibilities = None  # guesses by letters alone
    extra = _extra_words(line, error)
    if extra:
        return extra
    what = " ".join(error.format_message().split())
    return f"{what} ({_usage(line, error)})"


def _extra_words(line: _CommandLine, error: Any) -> str:
    """Return that a command with one argument gets several words; empty otherwise."""
    arguments = [param for param in line.command.params if param.param_type_name == "argument"]
    words = [printable(line.words[index]) for index in line.loose]
    if hasattr(error, "option_name") or len(words) <= len(arguments) or len(arguments) != 1:
        return ""
    name = f"{line.command.name} takes only one {arguments[0].metavar.strip('[]')}"
    batch = " (grader batch grades a class)" if line.command.name == "grade" else ""
    return f"{name}, not {enumerated(words)}: quote a path that has spaces{batch}"


def _command_line(arguments: Sequence[str], root: Any) -> _CommandLine:
    """Return a command line with the command that it names."""
    command = root
    start = 0
    for word in arguments:
        inner = getattr(command, "commands", {}).get(word)
        if inner is None:
            break
        command = inner
        start = start + 1
    return _CommandLine(list(arguments), root, command, start)


def message_on_path(error: NotThereError, arguments: Sequence[str]) -> str:
    """Return one line on a path that does not exist, with what to type if that is known."""
    command, *words = arguments
    bare = [os.path.expanduser(word.strip(_QUOTES + ",;")) for word in words]  # noqa: PTH111
    is_bare = bare != words and any(map(os.path.lexists, bare))
    meant = None
    if "help" in words:
        meant = [command, "--help"]
    elif error.path in shipped_rubrics() and command in ("grade", "view", "batch"):
        others = [word for word in words if word != error.path]
        meant = [command, *others, "--rubric", error.path]
    elif is_bare:
        meant = [command, *bare]
    if meant is not None:
        return f"{error.path} does not exist; did you mean `grader {_shown(meant)}`?"
    return _message_without_guess(error)


def _message_without_guess(error: NotThereError) -> str:
    """Return one line on a path that does not exist: an address, a pattern or another one."""
    start = f"{error.path} does not exist"
    if re.match(r"\w+:/", error.path):
        return f"{start}: download it, and grade the copy"
    if re.search(r"[*?]", error.path):
        return f"{start}: no file matches this pattern"
    return str(error)


def _shown(words: Sequence[str]) -> str:
    return " ".join(map(shell_quoted, words))


def _usage(line: _CommandLine, error: Any) -> str:
    """Return what an incomplete command line lacks, or how its usage is shown."""
    name = " ".join(["grader", *line.words[: line.start]])
    example = re.search(r"^\s*(grader .*)$", line.command.help or "", re.MULTILINE)
    is_incomplete = hasattr(error, "param_type")  # an argument is missing
    if example and is_incomplete:
        return f"for example `{example[1]}`"
    option = getattr(error, "option_name", "")
    if option in _EXAMPLES and option in line.options:
        return f"for example `grader grade {_EXAMPLES[option]}`"
    others = _commands_with(option, line.root) if hasattr(error, "possibilities") else []
    if others:
        return f"an option of {enumerated(others, _MAX_COMMANDS)}"
    return f"`{name} --help` shows the usage"


def _correct_hyphens(line: _CommandLine) -> _Correction | None:
    """Write two hyphens where there are dashes, or one hyphen before a long option."""
    words = []
    before = ""
    for word in line.words:
        whole = before + word
        before = word if word.strip(_DASHES) == "" and word not in ("-", "--") else ""
        if before:
            continue
        name, equals, value = whole.lstrip(_DASHES).partition("=")
        is_option = whole[:1] in _DASHES and f"--{name}" in line.options and len(name) > 1
        words.append(f"--{name}{equals}{value}" if is_option else whole)
    if words == line.words:
        return None
    return _Correction("options begin with two hyphens", words)


def _correct_command(line: _CommandLine) -> _Correction | None:
    """Write the command first, by its name."""
    groups = getattr(line.command, "commands", None)
    at = line.start
    if groups is None or at >= len(line.words):
        return None
    word, *rest = line.words[at:]
    words = _with_command(line, word, rest)
    if words is None:
        return None
    if word.startswith("-"):
        return _Correction("options stand behind the command", words)
    return _Correction(f"there is no command {word!r}", words)


def _with_command(line: _CommandLine, word: str, rest: list[str]) -> list[str] | None:
    """Return the words with a command in place of a word that is none."""
    groups = line.command.commands
    above = line.words[: line.start]
    if word == "grader":
        return rest
    later = [other for other in rest if other in groups]
    if later:
        rest.remove(later[0])
        return [*above, later[0], "--help" if word == "help" else word, *rest]
    if _is_submission(word) or (word.startswith("-") and any(map(_is_submission, rest))):
        return ["grade", word, *rest]
    names_rubric = any(other in shipped_rubrics() or other.endswith(".toml") for other in rest)
    is_of_rubric = word not in _COMMANDS or names_rubric
    if word in line.root.commands["rubric"].commands and is_of_rubric:
        return ["rubric", word, *rest]
    lower = word.lower()
    meant = lower if lower in groups else _COMMANDS.get(lower) or closest(lower, groups)
    return [*above, *meant.split(), *rest] if meant else None


def _correct_option(line: _CommandLine, error: Any) -> _Correction | None:
    """Write an option by its name."""
    if not hasattr(error, "possibilities"):
        return None
    wrong = error.option_name
    at = next((n for n, word in enumerate(line.words) if word.partition("=")[0] == wrong), None)
    if at is None:
        return None
    why = f"there is no option {wrong}"
    meant = _find_option(wrong, line)
    if meant is None or not _may_take_value(line, meant, at):
        return None
    return _Correction(why, line.replaced(at, at + 1, meant + line.words[at].removeprefix(wrong)))


def _find_option(wrong: str, line: _CommandLine) -> str | None:
    """Return the option that is meant: the closest one, or the only one with these letters."""
    if wrong.startswith("--"):
        return closest(wrong, [name for name in line.options if name.startswith("--")])
    fitting = [name for name in line.options if name.startswith(f"-{wrong}")]
    return fitting[0] if len(fitting) == 1 else None


def _may_take_value(line: _CommandLine, option: str, at: int) -> bool:
    """Return whether the value of a wrong option may be meant for another one."""
    choices = [str(choice) for choice in getattr(line.options[option].type, "choices", ())]
    _, equals, value = line.words[at].partition("=")
    if not equals:
        value = next(iter(line.words[at + 1 :]), "")
    is_choice = value.lower() in choices or closest(value, choices) is not None
    return not choices or not value or is_choice


def _correct_choice(line: _CommandLine, error: Any) -> _Correction | None:
    """Write the choice that is closest to a wrong one."""
    kind = getattr(getattr(error, "param", None), "type", None)
    choices = [str(choice) for choice in getattr(kind, "choices", ())]
    for index in range(len(line.words) - 1, line.start - 1, -1):
        start, equals, value = line.words[index].rpartition("=")
        meant = value.lower() if value.lower() in choices else closest(value, choices)
        if meant is not None and value not in choices:
            words = line.replaced(index, index + 1, f"{start}{equals}{meant}")
            return _Correction(f"{value!r} is not one of the choices", words)
    return None


def _is_submission(word: str) -> bool:
    return os.path.lexists(word) or word.lower().endswith(_SUBMISSIONS)


def _commands_with(option: str, root: Any) -> list[str]:
    """Return the commands that have an option."""
    return [f"`{name}`" for name, params in _options(root, "grader") if option in params]


def _options(command: Any, name: str) -> Iterator[tuple[str, set[str]]]:
    """Yield each command below another one, and its options."""
    for part, inner in getattr(command, "commands", {}).items():
        yield f"{name} {part}", {option for param in inner.params for option in param.opts}
        yield from _options(inner, f"{name} {part}")
