"""Words of a Python file that surely stand for other ones."""

import ast

from grader.base.slips import Slip
from grader.ros.python.parse import Code


def read_as(
    code: Code,
    node: ast.alias | ast.expr | ast.keyword | ast.stmt,
    written: str,
    meant: str,
    reaction: str,
    *,
    is_refused: bool = True,
) -> Slip:
    """Return the slip of a word that is written in a node and stands for another one."""
    source = code.source
    at = code.at(node)
    start = source.text.find(written, source.start_offset(at))
    edit = source.edit(start, start + len(written), meant)
    assumption = f"{written} is read as {meant}"
    return Slip((edit,), reaction, assumption, source.at(start), is_refused)
