"""What an editor gets while a file is typed and cannot be read: completion, signatures, and what is in a file."""

import asyncio
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from lsprotocol import types as lsp

from tests.command_line import ROOT
from tests.editor.client import Act, Editor, shared_editor

pytestmark = pytest.mark.slow
Run = Callable[[Act], None]
_LAB6 = "my_robot/urdf/my_robot.urdf"
_XACRO = "diffdrive_robot/urdf/diffdrive.urdf.xacro"
_LAUNCH = "diffdrive_robot/launch/diffdrive.launch.py"
_HERE = "|"  # where the cursor is
_SPAWNER = 'executable="spawner", arguments=['
_JOIN = 'PathJoinSubstitution([share, "config", "'


@pytest.fixture(scope="module")
def labs(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Run]]:
    """Return what runs in an editor of each of two labs."""
    top = tmp_path_factory.mktemp("labs")
    lab6 = shutil.copytree(ROOT / "rubrics/lab6", top / "lab")
    diffdrive = shutil.copytree(ROOT / "rubrics/diffdrive", top / "ws")
    with shared_editor(lab6) as in_lab6, shared_editor(diffdrive) as in_diffdrive:
        yield {_LAB6: in_lab6, _XACRO: in_diffdrive, _LAUNCH: in_diffdrive}


@pytest.mark.parametrize(
    ("path", "old", "typed", "offered"),
    [
        (_LAB6, '<child link="lidar"/>', '<child link="|', {"lidar", "base_link"}),
        (_LAB6, "</robot>", '<joint name="arm" type="fixed">\n<parent link="|', {"lidar"}),
        (_LAB6, "</robot>", "<|", {"link", "joint", "material"}),
        (_LAB6, "</robot>", '<link name="arm">\n  <vis|', {"visual", "inertial"}),
        (_LAB6, "</robot>", '<joint name="arm" |', {"type"}),
        (_XACRO, '<xacro:macro name="wheel" params="side y">', "{}<|", {"link", "joint"}),
        (_LAUNCH, f'{_SPAWNER}"joint_state_broadcaster"', f'{_SPAWNER}"|', {"diff_drive_controller"}),
        (_LAUNCH, f'{_JOIN}controllers.yaml"])', f"{_JOIN}|", {"controllers.yaml"}),
    ],
)  # fmt: skip
def test_completes_while_a_tag_or_call_is_typed(
    labs: dict[str, Run], path: str, old: str, typed: str, offered: set[str]
) -> None:
    """The rest of the file stays as it is, so that it can no longer be read."""

    async def act(one: Editor) -> None:
        await one.open(path)
        text = one.text(path)
        assert text.count(old) >= 1
        before, _, after = text.partition(old)
        start, _, end = typed.format(old).partition(_HERE)
        await one.type(path, f"{before}{start}{end}\n{after}")
        rows = f"{before}{start}".split("\n")
        asked = lsp.CompletionParams(one.document(path), lsp.Position(len(rows) - 1, len(rows[-1])))
        items = await one.client.text_document_completion_async(asked)
        assert isinstance(items, lsp.CompletionList)
        assert offered <= {item.label for item in items.items}

    labs[path](act)


def test_shows_the_parameters_of_a_macro(labs: dict[str, Run]) -> None:
    """The one whose value is typed is marked; other tags have none."""

    async def act(one: Editor) -> None:
        await one.open(_XACRO)
        text = one.text(_XACRO)
        for typed, active in (('<xacro:wheel side="left" y=', 1), ("<xacro:wheel ", None)):
            await one.type(_XACRO, text.replace("</robot>", typed))
            row = text.split("\n").index("</robot>")
            at = lsp.Position(row, len(typed))
            asked = lsp.SignatureHelpParams(one.document(_XACRO), at)
            help_of = await one.client.text_document_signature_help_async(asked)
            assert help_of is not None
            [signature] = help_of.signatures
            assert (signature.label, signature.documentation) == ("xacro:wheel side y", _XACRO)
            assert signature.active_parameter == active
        nowhere = lsp.SignatureHelpParams(one.document(_XACRO), lsp.Position(0, 0))
        assert await one.client.text_document_signature_help_async(nowhere) is None

    labs[_XACRO](act)


def test_lists_a_robot_as_a_tree(labs: dict[str, Run]) -> None:
    """Below a link are its joints, below a joint its child."""

    async def act(one: Editor) -> None:
        asked = lsp.DocumentSymbolParams(one.document(_LAB6))
        symbols = await one.client.text_document_document_symbol_async(asked)
        assert symbols is not None
        [root] = [symbol for symbol in symbols if symbol.name == "base_footprint"]
        assert isinstance(root, lsp.DocumentSymbol)
        [joint] = root.children or ()
        [base] = joint.children or ()
        assert (joint.detail, base.name) == ("fixed joint", "base_link")
        below = {
            each.name: [child.name for child in each.children or ()] for each in base.children or ()
        }
        assert below["base_lidar_joint"] == ["lidar"]
        assert {symbol.name for symbol in symbols}.isdisjoint({"lidar", "base_link"})

    labs[_LAB6](act)


def test_problems_are_shown_while_one_types(tmp_path: Path) -> None:
    """A look that is due ends although keys follow each other faster than a look begins."""
    root = shutil.copytree(ROOT / "rubrics/lab6", tmp_path / "lab")

    async def act(one: Editor) -> None:
        await one.open(_LAB6)
        text = one.text(_LAB6).replace('<child link="lidar"/>', '<child link="lidr"/>')
        for number in range(100):
            one.type_on(_LAB6, f"{text}<!-- {number} -->\n")
            await asyncio.sleep(0.05)
            if one.found():
                break
        assert number < 99
        assert "URDF" in one.found()[0]

    with shared_editor(root) as run:
        run(act)


def test_a_folder_that_is_removed_has_no_problems(tmp_path: Path) -> None:
    """What was shown of it is gone, and it is looked at anew when it is opened again."""
    root = shutil.copytree(ROOT / "submissions/diffdrive/spawner-misspelt", tmp_path / "ws")
    folder = lsp.WorkspaceFolder(root.as_uri(), root.name)

    async def change(one: Editor, *, is_open: bool) -> None:
        added, removed = ([folder], []) if is_open else ([], [folder])
        event = lsp.WorkspaceFoldersChangeEvent(added, removed)
        one.client.workspace_did_change_workspace_folders(
            lsp.DidChangeWorkspaceFoldersParams(event)
        )

    async def act(one: Editor) -> None:
        before = one.found()
        assert before
        await change(one, is_open=False)
        await change(one, is_open=True)
        await one.looked()
        assert one.found() == before
        await change(one, is_open=False)
        for _ in range(100):
            if not one.found():
                break
            await asyncio.sleep(0.1)
        assert one.found() == []

    with shared_editor(root) as run:
        run(act)


def test_hover_has_the_pose_in_the_robots_of_the_file(tmp_path: Path) -> None:
    """Another robot of the folder with the same link is omitted."""
    root = shutil.copytree(ROOT / "rubrics/lab6/my_robot", tmp_path / "my_robot")
    text = (root / "urdf/my_robot.urdf").read_text()
    (root / "urdf/other.urdf").write_text(text.replace('xyz="0.15 0 0.225"', 'xyz="0.15 0 0.5"'))

    async def act(one: Editor) -> None:
        for name in ("my_robot", "other"):
            path = f"urdf/{name}.urdf"
            at = one.position(path, '<link name="lidar">', inside=13)
            asked = lsp.HoverParams(one.document(path), at)
            hover = await one.client.text_document_hover_async(asked)
            assert hover is not None
            assert isinstance(hover.contents, lsp.MarkupContent)
            assert hover.contents.value.count("pose in") == 1
            assert f"{name}.urdf" in hover.contents.value.replace("\\", "")

    with shared_editor(root) as run:
        run(act)


def test_answers_with_an_error_in_another_line(labs: dict[str, Run]) -> None:
    """The error is in another line; what is in its own line is not guessed."""

    async def act(one: Editor) -> None:
        await one.open(_LAUNCH)
        text = one.text(_LAUNCH)
        at = one.position(_LAUNCH, 'LaunchConfiguration("drive")', inside=23)
        document = one.document(_LAUNCH)
        await one.type(_LAUNCH, text.replace('executable="rviz2",', 'executable="rviz2,', 1))
        found = await one.client.text_document_definition_async(lsp.DefinitionParams(document, at))
        assert isinstance(found, list | tuple)
        assert [each.range.start.line for each in found if isinstance(each, lsp.Location)] == [
            one.position(_LAUNCH, 'DeclareLaunchArgument("drive"').line
        ]

    labs[_LAUNCH](act)


def test_marks_a_name_in_its_file(labs: dict[str, Run]) -> None:
    """The definition is marked as written, the uses as read."""

    async def act(one: Editor) -> None:
        at = one.position(_LAB6, '<link name="lidar">', inside=13)
        asked = lsp.DocumentHighlightParams(one.document(_LAB6), at)
        marks = await one.client.text_document_document_highlight_async(asked)
        assert marks is not None
        kinds = [mark.kind for mark in marks]
        assert kinds == [lsp.DocumentHighlightKind.Write, lsp.DocumentHighlightKind.Read]

    labs[_LAB6](act)
