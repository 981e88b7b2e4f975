"""Edits of the tags of an XML text."""

import re

from grader.base import markup
from grader.base.source import Edits, Source


def tag_edits(source: Source, start: int, old: str, new: str) -> Edits:
    """Return the edits of the start tag of the element at an offset, and of its end tag if it has
    one; none if its tag is another one.
    """
    if source.text[start : markup.name_end(source.text, start)] != f"<{old}":
        return ()
    edits = [source.edit(start, start + len(old) + 1, f"<{new}")]
    end = markup.element_end(source.text, start)
    closing = re.search(rf"</{re.escape(old)}\s*>\Z", source.text[start:end])
    if closing is not None:
        edits.append(source.edit(start + closing.start(), end, f"</{new}>"))
    return tuple(edits)
