"""The reader of workflow commands finds what a runner finds, because other tests rely on it."""

import pytest

from tests.report.workflow_commands import Command, commands


@pytest.mark.parametrize(
    ("line", "command"),
    [
        ("::error::x", Command("error", (), "x")),
        (" \t\u3000::error::x", Command("error", (), "x")),
        ("::ERROR::x", Command("error", (), "x")),
        ("::error ::x", Command("error", (), "x")),
        ("::warning file=a,line=1::x::y", Command("warning", (("file", "a"), ("line", "1")), "x::y")),
        ("::notice file=a%2Cb%3A%25,title=::x", Command("notice", (("file", "a,b:%"),), "x")),
        ("::error file=a=b,line::x", Command("error", (("file", "a=b"),), "x")),
        ("::debug::a%0Ab%250A%3A", Command("debug", (), "a\nb%0A%3A")),
        ("::stop-commands::token", Command("stop-commands", (), "token")),
        ("anything ##[error]x", Command("error", (), "x")),
        ("##[add-mask]x%5D%3B", Command("add-mask", (), "x];")),
        ("##[set-env name=a;b=c]x", Command("set-env", (("name", "a"), ("b", "c")), "x")),
        ("::x:: ##[error]y", Command("error", (), "y")),
        ("\u2060::error::x", Command("error", (), "x")),
    ],
)
def test_a_command_is_found(line: str, command: Command) -> None:
    """In both forms, with leading space, in any case, and unescaped as by the runner."""
    for end in ("\n", "\r", "\r\n"):
        assert commands(f"before{end}{line}{end}after{end}") == [command]


@pytest.mark.parametrize(
    "line",
    [
        "x ::error::y",
        ": :error::x",
        "::error",
        "::nothing::x",
        "::error:x",
        "## [error]x",
        "##[errors]x",
        "##[error",
        "::",
    ],
)
def test_other_lines_are_no_command(line: str) -> None:
    """Neither text in the middle of a line nor an unknown name is a command."""
    assert commands(line) == []
