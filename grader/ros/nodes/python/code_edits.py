"""The edits that fix a fault in a module, by the nodes of its syntax tree."""

import ast
from collections.abc import Sequence

from grader.base.grouping import Span
from grader.base.problems import NO_FIXES, Fix, Fixes
from grader.base.source import Source
from grader.ros.python.parse import Position, end_position, location_in, make_position

_PLAIN = (ast.Expr, ast.Assign, ast.AnnAssign, ast.Pass)


class CodeEdits:
    """Writes edits of the text of a module, each as the only fix of a fault."""

    def __init__(self, source: Source) -> None:
        self._source = source

    def span(self, node: ast.expr | ast.stmt | ast.keyword) -> Span:
        """Return the offsets at which a node begins and ends."""
        return self._offset(make_position(node)), self._offset(end_position(node))

    def _offset(self, position: Position) -> int:
        location = location_in(self._source, position)
        return self._source.start_offset(location)

    def rewrite(self, start: int, end: int, new: str) -> Fixes:
        """Return the fix that writes another text between two offsets."""
        edit = self._source.edit(start, end, new)
        return Fixes(lambda: [Fix((edit,), f"{edit.old} is read as {new}")])

    def rewrite_in(self, statement: ast.stmt, written: str, new: str) -> Fixes:
        """Return the fix that writes another text for the first one in a statement, if any."""
        start, end = self.span(statement)
        at = self._source.text.find(written, start, end)
        return self.rewrite(at, at + len(written), new) if new and at >= 0 else NO_FIXES

    def insert(self, offset: int, text: str, assumption: str) -> Fixes:
        """Return the fix that adds a text."""
        edit = self._source.edit(offset, offset, text)
        return Fixes(lambda: [Fix((edit,), assumption)])

    def add_before(self, statement: ast.stmt, code: str) -> Fixes:
        """Return the fix that adds a statement before another one."""
        start, _ = self.span(statement)
        space = self._space_before(start)
        text = f"{code}; " if space is None else f"{code}\n{space}"
        return self.insert(start, text, f"`{code}` is added")

    def add_behind(self, statement: ast.stmt, code: str) -> Fixes:
        """Return the fix that adds a statement behind another one."""
        start, end = self.span(statement)
        space = self._space_before(start)
        text = f"; {code}" if space is None else f"\n{space}{code}"
        return self.insert(end, text, f"`{code}` is added")

    def add_first(self, body: Sequence[ast.stmt], code: str) -> Fixes:
        """Return the fix that adds the first statement of a function, behind its docstring."""
        is_text = isinstance(body[0], ast.Expr) and isinstance(body[0].value, ast.Constant)
        first = body[1] if is_text and len(body) > 1 else body[0]
        return self.add_before(first, code) if isinstance(first, _PLAIN) else NO_FIXES

    def _space_before(self, offset: int) -> str | None:
        """Return the space before the first statement of a line; None for another statement."""
        text = self._source.text
        space = text[text.rfind("\n", 0, offset) + 1 : offset]
        return space if not space.strip() else None
