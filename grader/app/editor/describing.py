"""What an editor shows when the pointer rests on a name."""

from collections.abc import Collection, Iterator, Sequence

from lsprotocol.types import Hover, MarkupContent, MarkupKind

from grader.app.editor.completions import typed_place
from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace
from grader.base.errors import MissingElement, NotDecided
from grader.base.text import counted, enumerated, printable
from grader.report.inspection import joint_text, main_root, pose_text
from grader.report.writers.escaped_markdown import code, escape, escape_words
from grader.ros.api import Configuration
from grader.workspace.api import KEY, offered_at

_MAX_NAMED = 3  # places


def hover(look: Look, place: TextPlace) -> Hover | None:
    """Return what is known of the name at a place; None where there is none."""
    name = look.names.at(*place.triple)
    if not name:
        rows = _parameter_rows(look, place)
        return Hover(_markdown(rows)) if rows else None
    same = look.names.same(name)
    defined = [
        same_name.location.file_and_line for same_name in same if same_name.role == "definition"
    ]
    where = "defined nowhere in this workspace"
    if defined:
        where = f"defined at {enumerated(dict.fromkeys(defined), _MAX_NAMED)}"
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
    return Hover(_markdown(rows), place.ranges(look).range(name.location))


def _parameter_rows(look: Look, place: TextPlace) -> list[str]:
    """Return what is known of the parameter whose key is at a place; nothing elsewhere."""
    line = place.text_line
    end = line.find(":", place.column - 1)
    typed = typed_place(place._replace(column=end + 1)) if end >= 0 else None
    if not typed or typed.holder.slot != KEY:
        return []
    for offer in offered_at([look.opened.workspace], typed):
        if offer.name == typed.typed and offer.text:
            text = escape_words(printable(f"{offer.detail}\n{offer.text}"))
            return [f"**parameter** {_code(offer.name)}", *text.split("\n")]
    return []


def _markdown(rows: Sequence[str]) -> MarkupContent:
    return MarkupContent(MarkupKind.Markdown, "\n\n".join(rows))


def _code(name: str) -> str:
    """Return a name as code, whatever its letters are."""
    return code(printable(name))


def _plain(text: str) -> str:
    """Return a text of the files as its letters."""
    return escape(printable(text))


def _of_robots(look: Look, kind: str, name: str, owners: Collection[str]) -> Iterator[str]:
    """Yield the pose of a link and what a joint does, in each robot that has it.

    Where the file belongs to some robots, they are yielded only of these.
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
