"""What an editor shows when the pointer rests on a name."""

from collections.abc import Iterator, Sequence

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace
from grader.base.errors import MissingElement, NotDecided
from grader.base.text import counted, enumerated, printable
from grader.report.inspection import main_root
from grader.ros.urdf.kinematics import Configuration
from grader.ros.workspace.names import Definition, Use

_MAX_NAMED = 3  # places


def hover(look: Look, place: TextPlace) -> lsp.Hover | None:
    """Return what is known of the name at a place; None where there is none."""
    found = place.name(look)
    if found is None:
        return None
    rows = [_summary(look, found.fact), *_of_robots(look, found.fact)]
    text = "\n\n".join(map(printable, rows))
    markup = lsp.MarkupContent(lsp.MarkupKind.Markdown, text)
    return lsp.Hover(markup, place.ranges(look).range(found.written or found.whole))


def _summary(look: Look, fact: Definition | Use) -> str:
    """Return what a name is, where it is defined, and how often it is used."""
    same = look.names.same(fact)
    defined = [it.location.file_and_line for it in same if isinstance(it, Definition)]
    used = len({it.location[:3] for it in same if isinstance(it, Use)})
    where = "defined nowhere in this workspace"
    if defined:
        where = f"defined at {enumerated([*dict.fromkeys(defined)], _MAX_NAMED)}"
    return f"**{fact.kind}** `{fact.name}`: {where}; used {counted(used, 'time')}"


def _of_robots(look: Look, fact: Definition | Use) -> Iterator[str]:
    """Yield the pose of a link and what a joint does, in each robot that has it."""
    for path, robot in look.robots.items():
        model = robot.robot
        if fact.kind in ("link", "frame") and model.has_link(fact.name):
            yield f"{_pose(robot, fact.name)} ({path})"
        if fact.kind == "joint" and model.has_joint(fact.name):
            yield f"{_joint(robot, fact.name)} ({path})"


def _pose(robot: Configuration, link: str) -> str:
    root = main_root(robot)
    if root is None:
        return f"`{link}` has no pose: the links are in a loop"
    try:
        pose = robot.pose(link, relative_to=root)
    except (MissingElement, NotDecided) as reason:
        return str(reason)
    return f"in `{root}`: xyz {_numbers(pose.translation)} m, rpy {_numbers(pose.rpy)} rad"


def _joint(robot: Configuration, name: str) -> str:
    joint = robot.robot.joint(name)
    text = f"{joint.type} joint from `{joint.parent}` to `{joint.child}`"
    if joint.type != "fixed" and joint.axis is not None:
        text += f", axis {_numbers(joint.axis)}"
    if joint.limit is not None:
        text += f", limits {_numbers((joint.limit.lower, joint.limit.upper))}"
    return text


def _numbers(values: Sequence[float]) -> str:
    return " ".join(f"{value:.4g}" for value in values)
