"""`class.toml`: what is written is read; a mistake in it is one line; only an empty folder becomes a gradebook."""

import errno
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import InputError
from grader.classroom.marks.gradebook_folder import (
    CLASS_FILE,
    ClassSettings,
    batch_lock,
    check_free,
    check_gradebook,
    make_gradebook,
    read_settings,
    settings_text,
    warn_without_locks,
)
from tests.examples import examples

pytestmark = pytest.mark.slow

TEXT = st.text(st.characters(codec="utf-8"), max_size=8)
TEXTS = st.lists(TEXT, max_size=3).map(tuple)
SETTINGS = st.builds(
    ClassSettings,
    submissions=TEXTS,
    layout=TEXT,
    assignment=TEXT,
    due=TEXT,
    parts=TEXTS,
    max_size=st.integers(1, 2**40),
    rubric=TEXT,
    rubric_id=TEXT,
    rubric_hash=TEXT,
    roster_hash=TEXT,
    handed_out=TEXTS,
    arguments=st.dictionaries(TEXT, TEXT, max_size=2),
)


@given(SETTINGS)
@examples(40)
def test_what_is_written_is_read(
    tmp_path_factory: pytest.TempPathFactory, settings: ClassSettings
) -> None:
    """Whatever the texts are."""
    folder = tmp_path_factory.mktemp("book")
    (folder / CLASS_FILE).write_text(settings_text(settings), encoding="utf-8")
    assert read_settings(folder) == settings


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "class.toml is empty"),
        ("# nothing\n", "class.toml is empty"),
        ("due = ", "class.toml is not TOML"),
        ('layuot = "x"', "unknown key 'layuot'; did you mean 'layout'?"),
        ("due = 2026-11-20", "due should be a text"),
        ('submissions = "x"', "submissions should be a list of texts"),
        ("parts = [1]", "parts should be a list of texts"),
        ("max_size = true", "max_size should be a number"),
        ("arguments = { a = 1 }", "arguments should be a table of texts"),
        (b"\xff", "class.toml is not TOML"),
    ],
)
def test_a_mistake_is_one_line(text: str | bytes, why: str, tmp_path: Path) -> None:
    """It names the file and what is expected."""
    (tmp_path / CLASS_FILE).write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(InputError) as raised:
        read_settings(tmp_path)
    assert why in str(raised.value)
    assert "\n" not in str(raised.value)


def test_a_wrong_deadline_names_its_file(tmp_path: Path) -> None:
    """A person may have written it there."""
    with pytest.raises(InputError, match=r"class\.toml: '20\.11\.2026' is not a date or time"):
        ClassSettings(due="20.11.2026").deadline(tmp_path)


def test_only_an_empty_folder_becomes_a_gradebook(tmp_path: Path) -> None:
    """Others and files are refused; a new one is private."""
    with pytest.raises(InputError, match="there is no gradebook"):
        check_gradebook(tmp_path / "book")
    make_gradebook(tmp_path / "book")
    assert (tmp_path / "book").stat().st_mode & 0o777 == 0o700
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "notes.txt").touch()
    with pytest.raises(InputError, match="is not empty and not a gradebook"):
        check_free(tmp_path / "full")
    (tmp_path / "old.db").touch()
    with pytest.raises(InputError, match="is a file: a gradebook is a folder"):
        check_free(tmp_path / "old.db")
    (tmp_path / "text").write_text("x")
    with pytest.raises(InputError, match="a gradebook is a folder"):
        check_gradebook(tmp_path / "text")


def test_one_batch_at_a_time(tmp_path: Path) -> None:
    """A second one is refused while the first runs, and not after it."""
    with (
        batch_lock(tmp_path),
        pytest.raises(InputError, match="another `grader batch`"),
        batch_lock(tmp_path),
    ):
        pass
    with batch_lock(tmp_path):
        pass


@pytest.mark.skipif(sys.platform == "win32", reason="replaces flock")
def test_without_locks_it_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a file system without locks two programs are not kept apart, and the user is told."""
    warnings = list[str]()
    with batch_lock(tmp_path):
        warn_without_locks(tmp_path, warnings.append)
    assert warnings == []

    def refuse(handle: int, how: int) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr("fcntl.flock", refuse)
    with batch_lock(tmp_path), batch_lock(tmp_path):
        warn_without_locks(tmp_path, warnings.append)
    assert len(warnings) == 1 and "is on a file system without locks" in warnings[0]
