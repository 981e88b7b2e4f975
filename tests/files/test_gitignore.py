"""What git ignores in a folder, compared with git itself."""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from grader.files.folder import read_folder
from grader.files.gitignore import without_git_ignored
from tests.examples import examples
from tests.work import limited_work

pytestmark = pytest.mark.slow

FILES = (
    "a",
    "b.c",
    "d/a",
    "d/b.c",
    "d/e/a",
    "d/e/b.c",
    "d/e/f/a",
    "b/d/e/a",
    "ab",
    "d/ab",
    "b/ab/c",
    "[a]",
    "d/a b",
)
PIECES = (
    "a",
    "b",
    "c",
    "d",
    "e",
    "*",
    "**",
    "?",
    "/",
    "/",
    "!",
    "[ab]",
    "[!a]",
    "[^b]",
    "[a-c]",
    ".c",
    "\\",
    " ",
    "#",
)
LINES = st.lists(st.lists(st.sampled_from(PIECES), max_size=6).map("".join), max_size=5).map(
    "\n".join
)
PLACES = st.dictionaries(st.sampled_from(("", "d", "d/e", "b")), LINES, min_size=1)


def ignored_by_git(root: Path) -> set[str]:
    """Return the files that git ignores."""
    own = {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1", "PATH": os.environ["PATH"]}
    done = subprocess.run(
        ["git", "check-ignore", "--no-index", "--stdin", "-z"],
        input="\0".join(FILES).encode(), cwd=root, env=own, capture_output=True, check=False,
    )  # fmt: skip
    assert done.stderr == b""
    return {name for name in done.stdout.decode().split("\0") if name}


def make_files(root: Path, places: Mapping[str, str]) -> None:
    """Write the files and the patterns of a repository."""
    (root / ".git").mkdir(parents=True)
    for name in ("objects", "refs"):
        (root / ".git" / name).mkdir()
    (root / ".git" / "HEAD").write_text("ref: refs/heads/main\n")
    for name in FILES:
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text("x")
    for folder, text in places.items():
        (root / folder / ".gitignore").write_text(text, encoding="utf-8", newline="")


@pytest.mark.skipif(shutil.which("git") is None, reason="needs git")
@given(PLACES)
@example({"": "*.c\n!b.c\nd/\n"})
@example({"": "/a\nd/e/**\n!d/e/f/a", "d": "!e/"})
@example({"": "**/e\r\na/**/c \n\\!a\n# a\n", "b": "ab/\n"})
@example({"": "*\n!*/\n!a\n"})
@example({"": "d/*\n!d/e\n\ufeffa"})
@example({"": "a\\ b\na/\n\\[a]\n[[]a]\n"})
@examples(30)
def test_git_agrees(places: Mapping[str, str]) -> None:
    """Whatever the patterns, those of deeper folders, and those that take others back."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder, "root")
        make_files(root, places)
        kept = without_git_ignored(read_folder(root), root)
        assert set(FILES) - kept.files.keys() == ignored_by_git(root)
        for start in ("d", "d/e"):  # a folder inside knows the patterns above
            below = without_git_ignored(read_folder(root / start), root / start)
            inside = {name for name in kept.files if name.startswith(f"{start}/")}
            if f"{start}/a" in kept.files:
                assert {f"{start}/{name}" for name in below.files} == inside


def test_what_is_ignored_is_there(tmp_path: Path) -> None:
    """An ignored file or folder is known and not seen; a folder that is ignored itself is read as if it were not."""
    make_files(tmp_path, {"": "d/e\nb.c\nb/\n"})
    tree = without_git_ignored(read_folder(tmp_path), tmp_path)
    assert {"d/e", "b", "b.c", "d/b.c"} <= tree.unseen
    assert [*tree.files] == ["[a]", "a", "ab", "d/a", "d/a b", "d/ab"]
    below = without_git_ignored(read_folder(tmp_path / "d/e"), tmp_path / "d/e")
    assert [*below.files] == ["a", "b.c", "f/a"]


def test_files_that_are_no_patterns_are_not_read(tmp_path: Path) -> None:
    """A symlink, a folder and a file that is too large."""
    make_files(tmp_path, {"d": "a\n" * 40_000})
    (tmp_path / "all").write_text("*\n")
    (tmp_path / ".gitignore").symlink_to("all")
    (tmp_path / "b" / ".gitignore").mkdir()
    tree = without_git_ignored(read_folder(tmp_path), tmp_path)
    assert {*FILES} <= tree.files.keys()


def test_no_pattern_takes_long(tmp_path: Path) -> None:
    """The work grows with the length of a path and of a pattern, not with a power of them."""
    name = "a" * 200
    patterns = [
        "*a" * 60 + "b",
        "**/a/" * 60 + "b",
        "/".join(["**"] * 60 + ["b"]),
        "[a]*" * 60 + "b",
    ]
    (tmp_path / Path(*"a" * 60)).mkdir(parents=True)
    (tmp_path / Path(*"a" * 60) / name).write_text("")
    (tmp_path / ".gitignore").write_text("\n".join(patterns))
    tree = read_folder(tmp_path)
    with limited_work(200_000):
        assert without_git_ignored(tree, tmp_path) is tree
