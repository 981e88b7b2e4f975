"""The word of the root of a robot, which can only be <robot>."""

import re
from collections.abc import Iterator

from grader.base import markup
from grader.base.names import near
from grader.base.slips import Slip
from grader.base.source import Source

_PROLOGUE = re.compile(r"(?s)(?:\s|\ufeff|<\?.*?\?>|<!--.*?-->|<!DOCTYPE(?:[^\[>]|\[[^\]]*\])*>)*")


def root_slips(source: Source) -> Iterator[Slip]:
    """Yield the slip of a root that has another word than robot: <Robot>, <robott>."""
    prologue = _PROLOGUE.match(source.text)
    start = prologue.end() if prologue is not None else 0
    end = markup.name_end(source.text, start)
    word = source.text[start + 1 : end].strip()
    is_similar = word.casefold().startswith("robo") or near(word, ["robot"]) is not None
    if word == "robot" or not is_similar:
        return
    edits = [source.edit(start, end, "<robot")]
    closings = [*re.finditer(rf"</\s*{re.escape(word)}\s*>", source.text)]
    if closings:
        name = source.text.index(word, closings[-1].start())
        edits.append(source.edit(name, name + len(word), "robot"))
    reaction = f"ROS 2 looks for <robot>, and the root is <{word}>"
    assumption = f"<{word}> is read as <robot>"
    yield Slip(tuple(edits), reaction, assumption, source.at(start), is_refused=True)
