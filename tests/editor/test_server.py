"""grader lsp answers each request of an editor, and says what `grader inspect` says."""

import asyncio
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest
from lsprotocol import types as lsp

from tests.command_line import ROOT
from tests.editor.client import Act, Editor, editor, shared_editor

_ROBOT = "diffdrive_robot/urdf/diffdrive.urdf.xacro"
_SYSTEM = "diffdrive_robot/urdf/diffdrive.ros2_control.xacro"
_CONTROLLERS = "diffdrive_robot/config/controllers.yaml"
_LAUNCH = "diffdrive_robot/launch/diffdrive.launch.py"
_XACRO = "diffdrive_robot/urdf/diffdrive.urdf.xacro"
_LAB6 = "my_robot/urdf/my_robot.urdf"
_WRONG_JOINT = f"{_CONTROLLERS}:12:23-38: REF002"


Run = Callable[[Act], None]


def corrections(offered: Sequence[lsp.Command | lsp.CodeAction] | None) -> list[lsp.CodeAction]:
    """Return the corrections of one problem that are offered, without comments that ignore it."""
    actions = [each for each in offered or () if isinstance(each, lsp.CodeAction)]
    return [each for each in actions if not each.title.startswith(("Ignore ", "Fix all "))]


@pytest.fixture
def diffdrive(tmp_path: Path) -> Path:
    return Path(shutil.copytree(ROOT / "rubrics/diffdrive", tmp_path / "ws"))


@pytest.fixture
def lab6(tmp_path: Path) -> Path:
    return Path(shutil.copytree(ROOT / "rubrics/lab6", tmp_path / "lab"))


@pytest.fixture(scope="module")
def in_diffdrive(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Run]:
    """Share a server, which takes most of the time of a test."""
    root = shutil.copytree(ROOT / "rubrics/diffdrive", tmp_path_factory.mktemp("shared") / "ws")
    with shared_editor(root) as run:
        yield run


@pytest.fixture(scope="module")
def in_lab6(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Run]:
    root = shutil.copytree(ROOT / "rubrics/lab6", tmp_path_factory.mktemp("shared") / "lab")
    with shared_editor(root) as run:
        yield run


@pytest.fixture(scope="module")
def graded_by_lab6(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Run]:
    root = shutil.copytree(ROOT / "rubrics/lab6", tmp_path_factory.mktemp("shared") / "lab")
    with shared_editor(root, "--rubric", "lab6") as run:
        yield run


def _edit(root: Path, act: Act, *options: str) -> None:
    with shared_editor(root, *options) as run:
        run(act)


def test_lists_problems_of_what_is_typed(in_diffdrive: Run) -> None:
    async def act(one: Editor) -> None:
        assert one.found() == []
        await one.open(_CONTROLLERS)
        text = one.text(_CONTROLLERS)
        await one.type(_CONTROLLERS, text.replace("left_wheel_joint", "left_weel_joint", 1))
        assert one.found() == [_WRONG_JOINT]
        [found] = one.client.diagnostics[one.uri(_CONTROLLERS)]
        assert found.severity == lsp.DiagnosticSeverity.Error
        assert found.code_description is not None
        assert found.code_description.href.endswith("problems.html#ref002")
        assert found.related_information is not None
        assert found.related_information[0].location.uri == one.uri(_ROBOT)
        await one.type(_CONTROLLERS, text)
        assert one.found() == []

    in_diffdrive(act)


@pytest.mark.slow
def test_counts_columns_as_editors_do(in_lab6: Run) -> None:
    """A character of two units of UTF-16 moves what is behind it by two."""

    async def act(one: Editor) -> None:
        await one.open(_LAB6)
        smile = '"\N{SLIGHTLY SMILING FACE}" type="fixd"'
        text = one.text(_LAB6).replace('"base_lidar_joint" type="fixed"', smile)
        await one.type(_LAB6, text)
        line = next(it for it in text.split("\n") if smile in it)
        [found] = [it for it in one.client.diagnostics[one.uri(_LAB6)] if it.code == "URDF061"]
        assert found.range.start.character == line.index("type") + 1

    in_lab6(act)


@pytest.mark.slow
def test_a_closed_file_counts_as_on_the_disk(in_diffdrive: Run) -> None:
    async def act(one: Editor) -> None:
        await one.open(_CONTROLLERS)
        text = one.text(_CONTROLLERS)
        await one.type(_CONTROLLERS, text.replace("left_wheel_joint", "left_weel_joint", 1))
        await one.close(_CONTROLLERS)
        assert one.found() == []

    in_diffdrive(act)


@pytest.mark.slow
def test_what_is_saved_elsewhere_counts(in_diffdrive: Run) -> None:
    async def act(one: Editor) -> None:
        text = one.text(_CONTROLLERS)
        wrong = text.replace("left_wheel_joint", "left_weel_joint", 1)
        for saved, expected in ((wrong, [_WRONG_JOINT]), (text, [])):
            (one.root / _CONTROLLERS).write_text(saved, encoding="utf-8")
            event = lsp.FileEvent(one.uri(_CONTROLLERS), lsp.FileChangeType.Changed)
            params = lsp.DidChangeWatchedFilesParams([event])
            one.client.workspace_did_change_watched_files(params)
            await one.looked()
            assert one.found() == expected

    in_diffdrive(act)


@pytest.mark.slow
def test_what_the_settings_ignore_is_not_shown(diffdrive: Path) -> None:
    (diffdrive / "grader.toml").write_text('ignore = ["REF002"]\n', encoding="utf-8")

    async def act(one: Editor) -> None:
        await one.open(_CONTROLLERS)
        text = one.text(_CONTROLLERS)
        await one.type(_CONTROLLERS, text.replace("left_wheel_joint", "left_weel_joint", 1))
        assert one.found() == []

    _edit(diffdrive, act)


@pytest.mark.slow
def test_says_that_the_settings_are_wrong(diffdrive: Path) -> None:
    (diffdrive / "grader.toml").write_text('ignore = ["REF99"]\n', encoding="utf-8")

    async def act(one: Editor) -> None:
        assert "REF99" in one.client.messages[0].message

    _edit(diffdrive, act)


@pytest.mark.slow
def test_files_outside_of_the_folder_are_left_alone(diffdrive: Path, lab6: Path) -> None:
    async def act(one: Editor) -> None:
        path = f"../other/{_LAB6}"
        item = lsp.TextDocumentItem(one.uri(path), "text", 1, "<robot")
        one.client.text_document_did_open(lsp.DidOpenTextDocumentParams(item))
        await one.open(_CONTROLLERS)
        assert one.found() == []

    lab6.rename(diffdrive.parent / "other")
    _edit(diffdrive, act)


def test_lists_criteria_of_a_rubric(graded_by_lab6: Run) -> None:
    async def act(one: Editor) -> None:
        assert one.found() == []
        await one.open(_LAB6)
        text = one.text(_LAB6)
        await one.type(_LAB6, text.replace('xyz="0.15 0 0.225"', 'xyz="0.25 0 0.225"'))
        assert one.found() == [f"{_LAB6}:38:12-30: lidar-frame"]
        [found] = one.client.diagnostics[one.uri(_LAB6)]
        end = "Check line 39: x of the joint origin of 'lidar'."
        assert found.message.endswith(f"{end} (-8 points: lidar-frame 6, lidar-on-top 2)")
        reach = "lidar-on-top: 'lidar' reaches 50 mm beyond the edge of the top of 'base_link'."
        assert _notes(found) == [reach]

    graded_by_lab6(act)


@pytest.mark.slow
def test_one_mistake_is_one_diagnostic(graded_by_lab6: Run) -> None:
    """What is assumed, what it costs and what it costs besides are said with the problem."""

    async def act(one: Editor) -> None:
        await one.open(_LAB6)
        text = one.text(_LAB6)
        await one.type(_LAB6, text.replace('child link="lidar"', 'child link="lidr"'))
        assert one.found() == [f"{_LAB6}:37:11-22: URDF071"]
        [found] = one.client.diagnostics[one.uri(_LAB6)]
        assert found.message.endswith("did you mean 'lidar'? (-3 points: urdf-loads)")
        assert _notes(found) == [
            "the link 'lidr' is read as 'lidar'",
            'Check line 38: ROS 2 rejects the file for `link="lidr"`.',
        ]
        await one.type(_LAB6, text.replace('rgba="0 0.6 0 1"', 'rgba="0 0.6 0 0"'))
        assert one.found() == [f"{_LAB6}:5:11-27: base-green"]
        floating = text.replace(
            '"base_lidar_joint" type="fixed"', '"base_lidar_joint" type="floating"'
        )
        await one.type(_LAB6, floating)
        assert one.found() == [f"{_LAB6}:35:33-48: lidar-fixed"]
        [found] = one.client.diagnostics[one.uri(_LAB6)]
        assert found.severity == lsp.DiagnosticSeverity.Error
        assert [note[:9] for note in _notes(found)] == ["URDF077: "]

    graded_by_lab6(act)


@pytest.mark.slow
def test_a_criterion_that_reports_a_wrong_name_is_said_with_it(diffdrive: Path) -> None:
    async def act(one: Editor) -> None:
        await one.open(_CONTROLLERS)
        text = one.text(_CONTROLLERS)
        for name in ("left_wheel_joint", "right_wheel_joint"):
            text = text.replace(name, name.replace("wheel", "weel"), 1)
        await one.type(_CONTROLLERS, text)
        first, second = one.client.diagnostics[one.uri(_CONTROLLERS)]
        assert (first.code, second.code) == ("REF002", "REF002")
        assert first.message.endswith("(-3 points: frames-exist) (joint-defined)")
        assert "points" not in second.message

    _edit(diffdrive, act, "--rubric", "diffdrive")


def _notes(found: lsp.Diagnostic) -> list[str]:
    return [one.message for one in found.related_information or ()]


@pytest.mark.slow
def test_says_that_there_is_no_such_rubric(lab6: Path) -> None:
    async def run() -> None:
        async with editor(lab6, "--rubric", "lab66", looks=False) as one:
            await one.client.wait_for_notification("window/showMessage")
            assert "did you mean 'lab6'?" in one.client.messages[0].message

    asyncio.run(run())


def test_says_what_a_name_is(in_diffdrive: Run) -> None:
    async def act(one: Editor) -> None:
        at = one.position(_CONTROLLERS, "left_wheel_joint")
        document = one.document(_CONTROLLERS)
        hover = await one.client.text_document_hover_async(lsp.HoverParams(document, at))
        assert hover is not None
        assert isinstance(hover.contents, lsp.MarkupContent)
        text = "left_wheel_joint: continuous about 0 1 0, from `base_link` to `left_wheel`"
        assert text in hover.contents.value
        nothing = lsp.HoverParams(document, lsp.Position(0, 0))
        assert await one.client.text_document_hover_async(nothing) is None

    in_diffdrive(act)


@pytest.mark.slow
def test_says_what_a_parameter_is(in_diffdrive: Run) -> None:
    async def act(one: Editor) -> None:
        at, document = one.position(_CONTROLLERS, "wheel_radius"), one.document(_CONTROLLERS)
        hover = await one.client.text_document_hover_async(lsp.HoverParams(document, at))
        assert hover is not None
        assert isinstance(hover.contents, lsp.MarkupContent)
        assert "type: double" in hover.contents.value
        await one.open(_CONTROLLERS)
        await one.type(_CONTROLLERS, one.text(_CONTROLLERS).replace("wheel_radius:", "whe"))
        rows = one.text(_CONTROLLERS).split("\n")
        row = next(number for number, line in enumerate(rows) if "wheel_radius:" in line)
        end = rows[row].index("wheel_radius") + len("whe")
        asked = lsp.CompletionParams(document, lsp.Position(row, end))
        found = await one.client.text_document_completion_async(asked)
        assert isinstance(found, lsp.CompletionList)
        assert found.items[0].label == "wheel_radius"

    in_diffdrive(act)


def test_finds_definitions_and_uses(in_diffdrive: Run) -> None:
    async def act(one: Editor) -> None:
        at, document = one.position(_CONTROLLERS, "left_wheel_joint"), one.document(_CONTROLLERS)
        asked = lsp.DefinitionParams(document, at)
        found = await one.client.text_document_definition_async(asked)
        assert isinstance(found, list | tuple)
        assert [it.uri for it in found if isinstance(it, lsp.Location)] == [one.uri(_ROBOT)]
        every = lsp.ReferenceParams(lsp.ReferenceContext(True), document, at)
        uses = await one.client.text_document_references_async(every)
        assert uses is not None
        assert {it.uri for it in uses} == {one.uri(_ROBOT), one.uri(_SYSTEM), one.uri(_CONTROLLERS)}

    in_diffdrive(act)


def test_completes_names(in_diffdrive: Run) -> None:
    async def act(one: Editor) -> None:
        at = one.position(_CONTROLLERS, "left_wheel_joint", inside=4)
        asked = lsp.CompletionParams(one.document(_CONTROLLERS), at)
        found = await one.client.text_document_completion_async(asked)
        assert isinstance(found, lsp.CompletionList)
        assert {"left_wheel_joint", "right_wheel_joint"} <= {item.label for item in found.items}

    in_diffdrive(act)


@pytest.mark.slow
def test_completes_types_of_joints(in_lab6: Run) -> None:
    """Also in a file that is not well-formed, as while a tag is typed."""

    async def act(one: Editor) -> None:
        await one.open(_LAB6)
        text = one.text(_LAB6)
        start = '<joint name="base_lidar_joint" type="'
        row = next(number for number, line in enumerate(text.split("\n")) if start in line)
        await one.type(_LAB6, text.replace(f'{start}fixed">', start))
        asked = lsp.CompletionParams(one.document(_LAB6), lsp.Position(row, 2 + len(start)))
        found = await one.client.text_document_completion_async(asked)
        assert isinstance(found, lsp.CompletionList)
        expected = ["fixed", "continuous", "revolute", "prismatic", "planar", "floating"]
        assert [item.label for item in found.items] == expected
        assert all(item.detail for item in found.items)

    in_lab6(act)


def test_lists_names(in_lab6: Run) -> None:
    async def act(one: Editor) -> None:
        asked = lsp.DocumentSymbolParams(one.document(_LAB6))
        in_file = await one.client.text_document_document_symbol_async(asked)
        assert in_file is not None
        below = [*in_file]
        names = set()
        while below:
            symbol = below.pop()
            names.add(symbol.name)
            below += getattr(symbol, "children", None) or ()
        assert {"base_link", "lidar", "base_lidar_joint"} <= names
        everywhere = await one.client.workspace_symbol_async(lsp.WorkspaceSymbolParams("LIDAR"))
        assert everywhere is not None
        assert {item.name for item in everywhere} >= {"lidar", "base_lidar_joint"}

    in_lab6(act)


def test_corrects_a_name(in_diffdrive: Run) -> None:
    async def act(one: Editor) -> None:
        await one.open(_CONTROLLERS)
        text = one.text(_CONTROLLERS)
        await one.type(_CONTROLLERS, text.replace("left_wheel_joint", "left_weel_joint", 1))
        [found] = one.client.diagnostics[one.uri(_CONTROLLERS)]
        context = lsp.CodeActionContext([found])
        asked = lsp.CodeActionParams(one.document(_CONTROLLERS), found.range, context)
        offered = await one.client.text_document_code_action_async(asked)
        assert offered is not None
        [action] = corrections(offered)
        assert isinstance(action, lsp.CodeAction)
        assert action.title == "Change 'left_weel_joint' to 'left_wheel_joint'"
        assert action.edit is not None
        assert action.edit.changes is not None
        [edit] = action.edit.changes[one.uri(_CONTROLLERS)]
        assert (edit.range, edit.new_text) == (found.range, "left_wheel_joint")

    in_diffdrive(act)


@pytest.mark.slow
def test_corrects_each_of_two_equal_names_in_one_line(in_diffdrive: Run) -> None:
    async def act(one: Editor) -> None:
        await one.open(_CONTROLLERS)
        right, wrong = "[left_wheel_joint]", "[left_weel_joint, left_weel_joint]"
        await one.type(_CONTROLLERS, one.text(_CONTROLLERS).replace(right, wrong, 1))
        found = [it for it in one.client.diagnostics[one.uri(_CONTROLLERS)] if it.code == "REF002"]
        context = lsp.CodeActionContext(found)
        asked = lsp.CodeActionParams(one.document(_CONTROLLERS), found[0].range, context)
        offered = await one.client.text_document_code_action_async(asked) or ()
        starts = set()
        for action in corrections(offered):
            assert action.edit is not None
            assert action.edit.changes is not None
            [edit] = action.edit.changes[one.uri(_CONTROLLERS)]
            starts.add(edit.range.start.character)
        assert starts == {it.range.start.character for it in found}
        assert len(starts) == 2

    in_diffdrive(act)


@pytest.mark.slow
def test_adds_an_import_that_a_node_lacks(in_diffdrive: Run) -> None:
    async def act(one: Editor) -> None:
        script = _CONTROLLERS.replace("config/controllers.yaml", "scripts/drive_circle.py")
        await one.open(script)
        await one.type(script, one.text(script).replace("import rclpy\n", "", 1))
        found = [it for it in one.client.diagnostics[one.uri(script)] if "rclpy" in it.message]
        context = lsp.CodeActionContext(found)
        asked = lsp.CodeActionParams(one.document(script), found[0].range, context)
        offered = await one.client.text_document_code_action_async(asked) or ()
        [action] = [it for it in offered if it.title == "Add 'import rclpy'"]
        assert isinstance(action, lsp.CodeAction)
        assert action.edit is not None
        assert action.edit.changes is not None
        [edit] = action.edit.changes[one.uri(script)]
        assert edit.new_text == "import rclpy\n"

    in_diffdrive(act)


@pytest.mark.slow
def test_corrects_where_the_name_is_written(in_diffdrive: Run) -> None:
    """The problem is at the call, and the name some lines below it."""

    async def act(one: Editor) -> None:
        await one.open(_LAUNCH)
        spawned = "joint_state_broadcaster"
        text = one.text(_LAUNCH).replace(spawned, "joint_state_brodcaster")
        await one.type(_LAUNCH, text)
        rows = text.split("\n")
        row = next(number for number, line in enumerate(rows) if "joint_state_brodcaster" in line)
        [found] = one.client.diagnostics[one.uri(_LAUNCH)]
        assert found.range.start.line <= row
        context = lsp.CodeActionContext([])
        at = lsp.Range(lsp.Position(row, 0), lsp.Position(row, 0))
        asked = lsp.CodeActionParams(one.document(_LAUNCH), at, context)
        offered = await one.client.text_document_code_action_async(asked)
        assert offered

    in_diffdrive(act)


@pytest.mark.slow
def test_corrects_a_word_for_which_ros_2_rejects_the_file(in_lab6: Run) -> None:
    async def act(one: Editor) -> None:
        await one.open(_LAB6)
        text = one.text(_LAB6)
        for old, new in (('child link="lidar"', 'child link="lidr"'), ("continuous", "continous")):
            await one.type(_LAB6, text.replace(old, new, 1))
            found = one.client.diagnostics[one.uri(_LAB6)]
            context = lsp.CodeActionContext(found)
            asked = lsp.CodeActionParams(one.document(_LAB6), found[0].range, context)
            [action] = corrections(await one.client.text_document_code_action_async(asked))
            assert isinstance(action, lsp.CodeAction)
            assert action.edit is not None
            assert action.edit.changes is not None
            [edit] = action.edit.changes[one.uri(_LAB6)]
            start, end = edit.range.start, edit.range.end
            assert start.line == end.line
            rows = text.replace(old, new, 1).split("\n")
            row = rows[start.line]
            rows[start.line] = row[: start.character] + edit.new_text + row[end.character :]
            assert "\n".join(rows) == text

    in_lab6(act)


@pytest.mark.slow
def test_corrects_a_word_that_xacro_refuses(in_diffdrive: Run) -> None:
    """It is offered once, although two problems have the same fix."""

    async def act(one: Editor) -> None:
        await one.open(_XACRO)
        right, wrong = 'xyz="0 0 ${wheel_radius}"', 'xyz="0 0 ${wheel_radus}"'
        await one.type(_XACRO, one.text(_XACRO).replace(right, wrong, 1))
        found = one.client.diagnostics[one.uri(_XACRO)]
        context = lsp.CodeActionContext(found)
        asked = lsp.CodeActionParams(one.document(_XACRO), found[0].range, context)
        [action] = corrections(await one.client.text_document_code_action_async(asked))
        assert isinstance(action, lsp.CodeAction)
        assert action.edit is not None
        assert action.edit.changes is not None
        [edit] = action.edit.changes[one.uri(_XACRO)]
        assert edit.new_text == right

    in_diffdrive(act)


@pytest.mark.slow
def test_offers_the_edits_of_hints(lab6: Path) -> None:
    """A rubric whose hints show edits has them as corrections."""
    rubric = (lab6 / "rubric.toml").read_text(encoding="utf-8")
    (lab6 / "rubric.toml").write_text(rubric.replace('hints = "cause"', 'hints = "edit"'))

    async def act(one: Editor) -> None:
        await one.open(_LAB6)
        text = one.text(_LAB6)
        await one.type(_LAB6, text.replace('xyz="0.15 0 0.225"', 'xyz="0.25 0 0.225"'))
        [found] = one.client.diagnostics[one.uri(_LAB6)]
        asked = lsp.CodeActionParams(
            one.document(_LAB6), found.range, lsp.CodeActionContext([found])
        )
        [action] = corrections(await one.client.text_document_code_action_async(asked))
        assert isinstance(action, lsp.CodeAction)
        assert action.edit is not None
        assert action.edit.changes is not None
        [edit] = action.edit.changes[one.uri(_LAB6)]
        assert edit.new_text == 'xyz="0.15 0 0.225"'

    _edit(lab6, act, "--rubric", str(lab6 / "rubric.toml"))


def test_refuses_to_rename_what_is_made_of_parts(in_diffdrive: Run) -> None:
    async def act(one: Editor) -> None:
        at = one.position(_CONTROLLERS, "left_wheel_joint")
        asked = lsp.RenameParams(one.document(_CONTROLLERS), at, "other_joint")
        with pytest.raises(Exception, match="builds the name 'left_wheel_joint' from parts"):
            await one.client.text_document_rename_async(asked)

    in_diffdrive(act)


@pytest.mark.slow
def test_the_last_text_counts(in_diffdrive: Run) -> None:
    """Of many changes in a row, what is said at the end is about the last one."""

    async def act(one: Editor) -> None:
        await one.open(_CONTROLLERS)
        text = one.text(_CONTROLLERS)
        for number in range(20):
            one.type_on(_CONTROLLERS, text.replace("left_wheel_joint", f"left_{number}", 1))
        await one.type(_CONTROLLERS, text.replace("left_wheel_joint", "left_weel_joint", 1))
        while one.found() != [_WRONG_JOINT]:
            await one.looked()

    in_diffdrive(act)


@pytest.mark.slow
def test_a_broken_file_is_no_end(in_lab6: Run) -> None:
    async def act(one: Editor) -> None:
        await one.open(_LAB6)
        text = one.text(_LAB6)
        for broken in ("", "<robot", text[: len(text) // 2], "\x00\ufffe" * 50, text * 40):
            await one.type(_LAB6, broken)
        assert one.found()
        await one.type(_LAB6, text)
        assert one.found() == []

    in_lab6(act)


@pytest.mark.slow
def test_an_empty_folder_has_no_problems(tmp_path: Path) -> None:
    async def act(one: Editor) -> None:
        (one.root / "new.urdf").write_text("<robot name='a'><link name='b'/>", encoding="utf-8")
        await one.open("new.urdf")
        assert [row.rpartition(" ")[2] for row in one.found()] == ["URDF002"]

    root = tmp_path / "empty"
    root.mkdir()
    _edit(root, act)


@pytest.mark.slow
def test_without_the_extra_it_says_how_to_install_it() -> None:
    code = (
        "import sys; sys.modules['lsprotocol'] = None; sys.argv = ['grader', 'lsp'];"
        "from grader.__main__ import main; main()"
    )
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr == (
        "grader: grader lsp needs the extra editor: pip install 'urdf-grader[editor]'\n"
    )
