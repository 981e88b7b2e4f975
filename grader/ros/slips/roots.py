"""The root of a robot, which can only be <robot>, and what it lacks."""

import re

from grader.base import markup
from grader.base.names import near
from grader.base.patterns import on_use
from grader.base.slips import Slips, make_slip
from grader.base.source import Source
from grader.ros.xml.urdf_format import CHILDREN

_PROLOGUE = on_use(r"(?s)(?:\s|\ufeff|<\?.*?\?>|<!--.*?-->|<!DOCTYPE(?:[^\[>]|\[[^\]]*\])*>)*")

_ROBOT = on_use(r"<robot(?=[\s>])")
_NAMESPACE = ' xmlns:xacro="http://www.ros.org/wiki/xacro"'


def root_slips(source: Source) -> Slips:
    """Yield the slip of a root that has another word than robot: <Robot>, <robott>."""
    start = _find_root(source.text)
    end = markup.name_end(source.text, start)
    word = source.text[start + 1 : end].strip()
    is_similar = word.casefold().startswith("robo") or near(word, ["robot"]) is not None
    if word == "robot" or not is_similar:
        return
    edits = [source.edit(start, end, "<robot")]
    closings = list(re.finditer(rf"</\s*{re.escape(word)}\s*>", source.text))
    if closings:
        name = source.text.index(word, closings[-1].start())
        edits.append(source.edit(name, name + len(word), "robot"))
    reaction = f"ROS 2 looks for <robot>, and the root is <{word}>"
    assumption = f"<{word}> is read as <robot>"
    yield make_slip(edits, reaction, assumption, is_refused=True)


def _find_root(text: str) -> int:
    """Return where the first tag of a text begins that is no comment and no declaration."""
    prologue = _PROLOGUE.match(text)
    return prologue.end() if prologue else 0


def prefix_slips(source: Source) -> Slips:
    """Yield the slip of a root that does not declare the prefix xacro, which the text uses."""
    root = _ROBOT.search(source.text)
    if root and "<xacro:" in source.text and "xmlns:xacro" not in source.text:
        edit = source.edit(root.end(), root.end(), _NAMESPACE)
        reaction = "<robot> does not declare the prefix xacro"
        assumption = "<robot> is read with xmlns:xacro"
        yield make_slip((edit,), reaction, assumption)


def rootless_slips(source: Source) -> Slips:
    """Yield the slip of a file that has the content of a robot without <robot> around it."""
    text = source.text
    start = _find_root(text)
    end = len(text)
    word = text[start + 1 : markup.name_end(text, start)]
    is_content = word in CHILDREN["robot"] or word.startswith("xacro:")
    if is_content and not _ROBOT.search(text):
        head = source.edit(start, start, f"<robot{_NAMESPACE}>")
        edits = (head, source.edit(end, end, "</robot>"))
        reaction = f"{source.path} has no root <robot>"
        assumption = f"what is in {source.path} is read inside of <robot>"
        yield make_slip(edits, reaction, assumption)
