"""A rename changes each place of a name, and nothing becomes wrong."""

from pathlib import Path

import pytest
from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace
from grader.app.editor.renaming import CannotRenameError, renamed
from grader.app.editor.session import EditorSession
from grader.app.editor.text_ranges import TextRanges
from grader.ros.workspace.index.written_names import WrittenName
from tests.command_line import ROOT

# With how many names are renamed, and how many are refused.
_WORKSPACES = {
    "rubrics/diffdrive": (23, 6),
    "rubrics/lab6": (15, 0),
    "tests/labs/beacon": (8, 8),
    "tests/labs/gripper": (7, 0),
    "tests/labs/laundry": (6, 10),
    "tests/labs/twolink": (29, 11),
}
_REFUSALS = ("from parts: change it there", "would cause a problem at", "not all places that use")


def _place(look: Look, root: Path, name: WrittenName) -> TextPlace:
    at = name.location
    return TextPlace(root, at.path, TextRanges(look, root).lines(at.path), at.line, at.column)


def _texts(root: Path, look: Look, edit: lsp.WorkspaceEdit) -> dict[str, str]:
    """Return the files that an edit changes, after it."""
    texts = {}
    for uri, changes in (edit.changes or {}).items():
        path = uri.removeprefix(root.as_uri() + "/")
        source = look.opened.source(path)
        assert source is not None
        lines = source.text.split("\n")
        for change in sorted(changes, key=lambda it: it.range.start, reverse=True):
            row, start, end = (
                change.range.start.line,
                change.range.start.character,
                change.range.end.character,
            )
            lines[row] = lines[row][:start] + change.new_text + lines[row][end:]
        texts[path] = "\n".join(lines)
    return texts


def _rename_all(root: Path) -> tuple[int, list[str]]:
    """Rename names of a workspace, each in files as they are; return how many, and the refusals."""
    look = EditorSession(root).look()
    problems = [(it.rule.id, it.location.path, it.location.line) for it in look.findings]
    done, refused = 0, []
    for name in look.names.holding("", 1_000):
        try:
            edit = renamed(look, _place(look, root, name), f"{name.name}_new")
        except CannotRenameError as error:
            refused.append(f"{name.kind} {name.name}: {error}")
            continue
        assert edit is not None
        session = EditorSession(root)
        for path, text in _texts(root, look, edit).items():
            session.files.type(path, text)
        after = session.look()
        found = [(it.rule.id, it.location.path, it.location.line) for it in after.findings]
        assert sorted(found) == sorted(problems), name
        done += 1
    return done, refused


def test_renames_a_link_everywhere() -> None:
    root = ROOT / "rubrics/lab6"
    look = EditorSession(root).look()
    [link] = [it for it in look.names.holding("base_link", 10) if it.name == "base_link"]
    edit = renamed(look, _place(look, root, link), "chassis")
    assert edit is not None
    [(path, text)] = _texts(root, look, edit).items()
    assert path == "my_robot/urdf/my_robot.urdf"
    assert text.count('"chassis"') == 6
    assert '"base_link"' not in text


@pytest.mark.slow
@pytest.mark.parametrize(("folder", "expected"), _WORKSPACES.items())
def test_renames_are_proven(folder: str, expected: tuple[int, int]) -> None:
    done, refused = _rename_all(ROOT / folder)
    assert [it for it in refused if not any(why in it for why in _REFUSALS)] == []
    assert (done, len(refused)) == expected


def test_refuses_a_name_that_is_there() -> None:
    root = ROOT / "rubrics/lab6"
    look = EditorSession(root).look()
    [link] = [it for it in look.names.holding("base_link", 10) if it.name == "base_link"]
    with pytest.raises(CannotRenameError, match="there is a link 'lidar' already"):
        renamed(look, _place(look, root, link), "lidar")
    for wrong in ("", "two words", "a<b", "$(x)"):
        with pytest.raises(CannotRenameError, match="is no name"):
            renamed(look, _place(look, root, link), wrong)


def test_refuses_what_is_made_of_parts() -> None:
    root = ROOT / "rubrics/diffdrive"
    look = EditorSession(root).look()
    name = look.names.at("diffdrive_robot/config/controllers.yaml", 13, 30)
    assert name is not None
    with pytest.raises(CannotRenameError, match="builds the name 'left_wheel_joint' from parts"):
        renamed(look, _place(look, root, name), "other_joint")
