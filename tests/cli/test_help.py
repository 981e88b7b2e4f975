"""The help: every command has one whole summary line, and every example can be typed."""

import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

from grader.app.cli.app import COMMANDS, make_app
from grader.app.cli.usage import commands_here
from grader.workspace.rules.rule_table import FAMILIES
from tests.command_line import ROOT, run, run_with_input
from tests.corpus.cases import read_corpus

PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md")])


def walk(command: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield every command below this one and itself, with the words to type."""
    yield path, command
    for name, subcommand in getattr(command, "commands", {}).items():
        yield from walk(subcommand, (*path, name))


PATHS = [path for path, _ in walk(get_command(make_app(COMMANDS)))]


def parse(line: str) -> None:
    """Parse a command line without running it; fail if it is wrong usage."""
    words = shlex.split(line, comments=True)
    assert words[0] == "grader"
    for sign in ("<", ">", "|"):
        words = words[: words.index(sign)] if sign in words else words
    grader: Any = get_command(make_app(COMMANDS))
    for _, command in walk(grader):
        if not hasattr(command, "commands"):
            command.callback = lambda **_: None
            for option in [one for one in command.params if one.name == "gradebook"]:
                option.callback = None  # it searches the current folder
    grader.main(words[1:], prog_name="grader", standalone_mode=False)


@pytest.mark.every(kind=tuple)
@pytest.mark.parametrize("path", PATHS, ids=lambda path: " ".join(path) or "grader")
def test_help_at_eighty_columns(path: tuple[str, ...]) -> None:
    """Nothing is cut or too wide, and there are examples, each on a line of its own."""
    done = run((*path, "--help"))
    text = done.stdout.decode()
    assert (done.returncode, done.stderr) == (0, b"")
    assert "..." not in text.replace("[ARGS]...", "").replace("PATH...", "")
    assert max(map(len, text.splitlines())) <= 80
    examples = re.search(r"\n  Examples:\n\n((?:    .*\n|\n)+)", text)
    assert examples is not None
    lines = [line.strip() for line in examples[1].splitlines() if line.strip()]
    assert lines
    for line in lines:
        assert line.startswith(" ".join(("grader", *path))), line
        parse(line)


def test_the_help_of_inspect_names_what_it_compares() -> None:
    """Each family of rules has a word."""
    text = run(("inspect", "--help")).stdout.decode()
    others = ("fit", "MoveIt", "one machine", "words", "messages", "release")
    for word in (*FAMILIES, *others):
        assert word in text, word


@pytest.mark.parametrize("command", ["batch", "stats", "diff", "export"])
def test_recipes(command: str) -> None:
    """Commands for a class have a recipe for each situation, one sentence each."""
    text = run((command, "--help")).stdout.decode()
    recipes = re.search(r"\n  Recipes:\n\n((?:    .*\n|\n)+)", text)
    assert recipes is not None
    paragraphs = [paragraph for paragraph in recipes[1].split("\n\n") if paragraph.strip()]
    assert len(paragraphs) > 1
    assert all(paragraph.rstrip().endswith((".", "?")) for paragraph in paragraphs)


@pytest.mark.parametrize("path", [path for path in PATHS if path], ids=" ".join)
def test_the_summary_is_one_line(path: tuple[str, ...]) -> None:
    """The list of commands shows the whole first sentence beside the name."""
    listed = run((*path[:-1], "--help")).stdout.decode().partition("\nCommands:\n")[2]
    command = dict(walk(get_command(make_app(COMMANDS))))[path]
    summary = command.help.partition("\n")[0]
    assert re.search(rf"^  {path[-1]} +{re.escape(summary)}$", listed, re.MULTILINE)
    assert summary.endswith(".")


@pytest.mark.parametrize("words", [(), ("rubric",)], ids=["grader", "rubric"])
def test_without_a_command_the_help_is_shown(words: tuple[str, ...]) -> None:
    """It is printed to standard error, because nothing was done."""
    done = run(words)
    assert (done.returncode, done.stdout) == (2, b"")
    assert done.stderr.decode().split() == run((*words, "--help")).stdout.decode().split()


@pytest.mark.parametrize(
    "words", [("--version",), ("-V",), ("--version", "grade"), ("-V", "--help")]
)
def test_the_version(words: tuple[str, ...]) -> None:
    """Both spellings work, whatever follows them."""
    from grader import __version__

    done = run(words)
    assert (done.returncode, done.stdout, done.stderr) == (
        0,
        f"grader {__version__}\n".encode(),
        b"",
    )


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_in_the_documentation_are_valid(page: Any) -> None:
    """Every shell line that starts with `grader` can be parsed."""
    for block in re.findall(r"```sh\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        for line in block.replace("\\\n", " ").splitlines():
            if line.startswith("grader "):
                parse(line)


def test_messages_name_commands_that_exist() -> None:
    """Every command in backticks in the corpus's messages is one of the grader, whatever its arguments are."""
    named = {
        name
        for case in read_corpus()
        for name in re.findall(r"`grader ([a-z]+)", case.expected.get("stderr", ""))
    }
    assert {"batch", "grade", "rubric"} <= named <= set(COMMANDS)


@pytest.mark.parametrize(
    ("files", "words", "commands"),
    [
        (["package.xml", "my_robot.urdf"], "a package", "inspect grade view graph"),
        (["src/my_robot/package.xml"], "a workspace", "inspect grade view graph"),
        (["my robot.urdf"], "my robot.urdf", "inspect grade view graph"),
        (["class.toml", "results.jsonl"], "a gradebook", "stats review export"),
        (["notes.txt"], "", ""),
    ],
)
def test_without_arguments_it_says_what_can_be_done_here(
    files: list[str], words: str, commands: str, tmp_path: Path
) -> None:
    """Below the help are the commands for what is in the folder, each of which can be typed."""
    for name in files:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("")
    done = run_with_input((), b"", folder=tmp_path)
    text = done.stderr.decode()
    assert (done.returncode, done.stdout) == (2, b"")
    assert text.startswith("Usage: grader [OPTIONS] COMMAND")
    _, title, rows = text.partition(f"\nIn this folder ({words}):\n")
    assert bool(title) == bool(words)
    lines = [re.split("  +", row.strip())[0] for row in rows.splitlines()]
    assert [line.split()[1] for line in lines] == commands.split()
    for line in lines:
        parse(line)
    assert max(map(len, text.splitlines())) <= 80


def test_a_folder_that_is_gone_has_no_commands(tmp_path: Path) -> None:
    """The help is whole all the same."""
    assert commands_here(tmp_path / "gone") == ""
