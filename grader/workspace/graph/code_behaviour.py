"""What the code of nodes does that no name says: frames of messages, and goals of actions."""

import re
from collections.abc import Iterator

from grader.base.errors import NotDecided
from grader.base.patterns import on_use
from grader.base.source import Location
from grader.ros.launch.launch_model import StartedNode
from grader.ros.nodes.node_facts import FieldUse
from grader.workspace.graph.code_ends import End, list_frames, opened_by
from grader.workspace.model.code_text import code_alone
from grader.workspace.model.text_files import read_code
from grader.workspace.model.workspace import Workspace

# What the code of a server has that does something with goals, by the argument of serves_action;
# and what is said without it. Source: rclpy/action/server.py, rclcpp_action/server.hpp.
_GOALS = {
    "feedback": {"publishes no feedback": on_use(r"(?:\.|->|::)publish_feedback\b")},
    "cancel": {
        "accepts no request to cancel": on_use(r"\bCancelResponse\s*+(?:\.|::)\s*+ACCEPT\b"),
        "is not told of a request to cancel": on_use(
            r"cancel_callback\b|\bcreate_server\b|[(,]\s*+\*\*"
        ),
        "ends no goal as cancelled": on_use(r"(?:\.|->|::)canceled\b"),
    },
    "rejects": {
        "rejects no goal": on_use(r"\bGoalResponse\s*+(?:\.|::)\s*+REJECT\b"),
        "is not asked whether it accepts a goal": on_use(
            r"goal_callback\b|\bcreate_server\b|[(,]\s*+\*\*"
        ),
    },
}
# The server of nav2_util does this itself; and responses under another name.
_OTHER_SERVER = on_use(
    r"\bSimpleActionServer\b|\b(?:Cancel|Goal)Response(?:\s++as\b|[\[(])"
    r"|=\s*+[\w.:]*?\b(?:Cancel|Goal)Response\b(?!\.|::)"
)


def frames_published(
    workspace: Workspace, node: StartedNode, topic: str
) -> Iterator[tuple[str, Location]]:
    """Yield the frames in headers of what a node publishes on a topic; one not known is empty."""
    is_own = node.when is not False and workspace.find_package(node) is not None
    for end in opened_by(workspace, node) if is_own else ():
        if end.kind != "publisher" or end.name != topic:
            continue
        named = {}  # by lines
        for frame, fact in list_frames(workspace, node):
            if fact.use == "names":
                named[fact.location.file_and_line] = frame
        for use in _uses_of_frame(workspace, end):
            literal = next(iter(use.literal), named.get(use.location.file_and_line))
            yield str(literal or "").removeprefix("/"), use.location


def _uses_of_frame(workspace: Workspace, end: End) -> list[FieldUse]:
    """Return where code sets the frame in the messages of a publisher, or else in headers."""
    in_messages = []
    in_headers = []
    for code in workspace.code.by_package.values():
        for use in code.field_uses:
            if use.location.path == end.location.path:
                if use.type == end.type and use.path[-2:] == ("header", "frame_id"):
                    in_messages.append(use)
                elif (use.type, use.path) == ("std_msgs.msg.Header", ("frame_id",)):
                    in_headers.append(use)
    return in_messages or in_headers


def lack_of_goals(workspace: Workspace, server: Location, argument: str) -> str:
    """Return what an argument of serves_action asks for and a server lacks; empty if nothing.

    Raises NotDecided.
    """
    for lack, pattern in _GOALS[argument].items():
        if _lacks(workspace, server.path, pattern):
            return lack
    return ""


def _lacks(workspace: Workspace, path: str, pattern: re.Pattern[str]) -> bool:
    """Return whether code that serves an action has no such part.

    Raises NotDecided where another file has it, or a library may.
    """
    texts = {}
    for package in workspace.packages:
        for source in read_code(workspace.texts, package):
            texts[source.path] = code_alone(source.text, source.path)
    code = texts.get(path, "")
    if pattern.search(code):
        return False
    if _OTHER_SERVER.search(code) or any(map(pattern.search, texts.values())):
        raise NotDecided("cannot determine statically what the server does with its goals")
    return True


def names_text(workspace: Workspace, text: str) -> bool:
    """Return whether a text is written anywhere in code, but for defaults of parameters."""
    pattern = re.compile(rf"""(?m)^(?!.*declare_).*["']/?{re.escape(text)}["']""")
    return any(
        pattern.search(source.text)
        for package in workspace.packages
        for source in read_code(workspace.texts, package)
    )
