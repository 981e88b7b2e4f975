"""What an editor shows when the pointer rests on a name."""

from collections.abc import Collection, Iterator, Sequence

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.parameter_keys import parameter_key
from grader.app.editor.places import TextPlace
from grader.base.errors import MissingElement, NotDecided
from grader.base.text import counted, enumerated, printable
from grader.report.inspection import joint_text, main_root, pose_text
from grader.report.writers.escaped_markdown import code, escape, escape_words
from grader.ros.api import Configuration

_MAX_NAMED = 3  # places


def hover(look: Look, place: TextPlace) -> lsp.Hover | None:
    """Return what is known of the name at a place; None where there is none."""
    name = look.names.at(*place.triple)
    if name is None:
        rows = _parameter_rows(look, place)
        return lsp.Hover(_markdown(rows)) if rows else None
    same = look.names.same(name)
    defined = [
        same_name.location.file_and_line for same_name in same if same_name.role == "definition"
    ]
    where = "defined nowhere in this workspace"
    if defined:
        where = f"defined at {enumerated([*dict.fromkeys(defined)], _MAX_NAMED)}"
    uses = {same_name.location for same_name in same if same_name.role == "use"}
    used = counted(len(uses), "time")
    rows = [f"**{name.kind}** {_code(name.name)}: {_plain(where)}; used {used}"]
    owners = {
        place_of_name.owner for place_of_name in same if place_of_name.location.path == place.path
    }
    rows += _of_robots(look, name.kind, name.name, owners)
    rows += map(_plain, look.names.list_texts(name))
    rows += (f"value: {_code(value)}" for value in look.names.values(name)[:_MAX_NAMED])
    if name.kind == "parameter":
        rows += _parameter_rows(look, place)
    return lsp.Hover(_markdown(rows), place.ranges(look).range(name.location))


def _parameter_rows(look: Look, place: TextPlace) -> list[str]:
    """Return what is known of the parameter whose key is in a line of YAML; nothing elsewhere."""
    if not place.path.endswith((".yaml", ".yml")):
        return []
    lines = place.lines.text.split("\n")[: place.line]
    key = parameter_key(lines[:-1], lines[-1])
    text = look.names.parameter_text(key.node, key.name) if key is not None else ""
    if key is None or not text:
        return []
    return [
        f"**parameter** {_code(key.name)}",
        *(escape_words(printable(row)) for row in text.split("\n")),
    ]


def _markdown(rows: Sequence[str]) -> lsp.MarkupContent:
    return lsp.MarkupContent(lsp.MarkupKind.Markdown, "\n\n".join(rows))


def _code(name: str) -> str:
    """Return a name as code, whatever its letters are."""
    return code(printable(name))


def _plain(text: str) -> str:
    """Return a text of the files as its letters."""
    return escape(printable(text))


def _of_robots(look: Look, kind: str, name: str, owners: Collection[str]) -> Iterator[str]:
    """Yield the pose of a link and what a joint does, in each robot that has it.

    Where the file belongs to some robots, only in these.
    """
    are_known = any(path in owners for path in look.robots)
    for path, robot in look.robots.items():
        model = robot.robot
        if are_known and path not in owners:
            continue
        if kind in ("link", "frame") and model.has_link(name):
            yield f"{_pose(robot, name)} ({_plain(path)})"
        if kind == "joint" and model.has_joint(name):
            joint = model.joint(name)
            text = joint_text(joint).strip()
            ends = f"from {_code(joint.parent)} to {_code(joint.child)}"
            yield f"{_plain(text)}, {ends} ({_plain(path)})"


def _pose(robot: Configuration, link: str) -> str:
    root = main_root(robot)
    if root is None:
        return f"{_code(link)} has no pose: the links are in a loop"
    try:
        pose = robot.pose(link, relative_to=root)
    except (MissingElement, NotDecided) as reason:
        return _plain(str(reason))
    return f"pose in {_code(root)} (x y z in m, roll pitch yaw in rad): {pose_text(pose)}"
