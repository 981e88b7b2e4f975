"""The expressions and assignments of a file, besides what xacro has as well."""

import ast
from collections.abc import Sequence
from copy import copy
from operator import setitem
from pathlib import PurePosixPath
from typing import Any

from grader.python import values as py
from grader.python.calls import Calls
from grader.python.evaluation import NOT_EVALUATED
from grader.python.knowledge import call_plain, iterate, known, refuse, str_of
from grader.python.library import CONSTANTS, attribute_error
from grader.python.operators import has_attribute, operate
from grader.python.parse import Position, kinds_of, position_of

_PARTS = ("name", "stem", "suffix", "parent", "parents", "parts")  # of a path


class FileExpressions(Calls):
    """Adds attributes, literals, comprehensions and assignments, as a file may have them."""

    def _of_attribute(self, node: ast.Attribute, scope: py.Scope) -> py.Value:
        owner, name = self.evaluate(node.value, scope), node.attr
        match owner:
            case py.QualifiedName(name="?glob"):  # used without an import: an attribute shows that the module is meant
                return py.QualifiedName(f"glob.{name}")
            case py.QualifiedName(name="glob.glob") if name in ("glob", "iglob"):
                message = f"glob is a function here, so glob.{name} is not defined: write glob(...)"
                self.error(message, position_of(node))
                return owner
            case py.QualifiedName(name=module):
                full = f"{module}.{name}"
                error = attribute_error(module, name) if full not in self.functions else None
                if error is not None:
                    raise py.EvaluationFails(error)
                return CONSTANTS.get(full, py.QualifiedName(full))
            case PurePosixPath() if name in _PARTS:
                value = getattr(owner, name)
                return self.budget.checked(list(value) if name == "parents" else value, "path")
        if isinstance(owner, py.PLAIN) and not has_attribute(owner, name):
            raise py.EvaluationFails(f"{type(owner).__name__!r} has no attribute {name!r}")
        return py.BoundMethod(owner, name)

    def item(self, owner: py.Value, key: py.Value, node: ast.expr) -> py.Value:
        """Return the value of owner[key]; of something outside of the file, by the table."""
        if not isinstance(owner, py.QualifiedName | py.Call):
            return super().item(owner, key, node)
        made = py.Call(f"{owner.name}.__getitem__", [key], {}, position_of(node))
        function = self.functions.get(made.name)
        if function is None or isinstance(function, py.PlainFunction):
            raise py.Undetermined(f"{owner.name}[...] {NOT_EVALUATED}")
        return function(self, made)

    def elements(self, nodes: Sequence[ast.expr], scope: py.Scope) -> list[py.Value]:
        """Return the values of the elements of a list, or of the arguments of a call."""
        values: list[py.Value] = []
        for node in nodes:
            if not isinstance(node, ast.Starred):
                values.append(self.evaluate(node, scope))
                continue
            try:
                values += iterate(self.evaluate(node.value, scope))
            except py.Undetermined as error:
                raise py.Undetermined(str(error), error.at or position_of(node), is_final=True) from None
        return values

    def _of_dict(self, node: ast.Dict, scope: py.Scope) -> py.Value:
        table: dict[Any, py.Value] = {}
        for key, value in zip(node.keys, node.values, strict=True):
            found = self.evaluate(value, scope)
            if key is not None:
                call_plain(table.__setitem__, known(self.evaluate(key, scope)), found)
            elif isinstance(found, dict):
                table |= found
            else:
                refuse(found, "this dict is not supported")
        return table

    def _of_joinedstr(self, node: ast.JoinedStr, scope: py.Scope) -> py.Value:
        pieces = [self.evaluate(piece, scope) for piece in node.values]
        self.budget.measure(pieces, "text")
        return self.budget.checked("".join(pieces), "text")

    def _of_formattedvalue(self, node: ast.FormattedValue, scope: py.Scope) -> py.Value:
        value = self.evaluate(node.value, scope)
        self.budget.measure(value, "text")
        if node.format_spec is not None or node.conversion not in (-1, ord("s")):
            raise py.Undetermined("a format of this kind is not supported")
        return str_of(value)

    def _of_generatorexp(self, node: ast.GeneratorExp, scope: py.Scope) -> py.Value:
        """Return a generator: the items of its first loop are evaluated now, the rest when it is iterated."""
        first = iterate(self.evaluate(node.generators[0].iter, scope))
        rounds = self.rounds(node.generators, py.Scope({}, scope), first)
        return py.Items(self.evaluate(node.elt, inner) for inner in rounds)

    def _of_dictcomp(self, node: ast.DictComp, scope: py.Scope) -> py.Value:
        return {
            known(self.evaluate(node.key, inner)): self.evaluate(node.value, inner)
            for inner in self.rounds(node.generators, py.Scope({}, scope))
        }

    def _of_lambda(self, node: ast.Lambda, scope: py.Scope) -> py.Value:
        return self.function(node.args, scope, position_of(node), lambda inner: self.evaluate(node.body, inner))

    def bind(self, target: ast.expr, value: py.Value, scope: py.Scope) -> None:
        """Bind the names of a target to a value, or change an item."""
        match target:
            case ast.Subscript(value=owner, slice=key):
                self._store(self.evaluate(owner, scope), known(self.key(key, scope)), value, position_of(target))
            case ast.Attribute(value=owner, attr=name):
                changed = self.evaluate(owner, scope)
                if isinstance(changed, py.PLAIN):
                    raise py.EvaluationFails(f"{type(changed).__name__!r} has no attribute {name!r}")
                reason = f"a change of the attribute {name} is not evaluated"
                raise py.Undetermined(reason, position_of(target), is_final=True)
            case _:
                super().bind(target, value, scope)

    def _store(self, owner: py.Value, key: py.Value, value: py.Value, at: Position) -> None:
        """Set an item of a list or dict."""
        if isinstance(owner, py.QualifiedName | py.Call):
            made = py.Call(f"{owner.name}.__setitem__", [key, value], {}, at)
            self.call_value(py.QualifiedName(made.name), made)
            return
        if not isinstance(owner, py.PLAIN) or isinstance(key, slice):
            refuse(owner, "this assignment to an item is not supported")
        call_plain(setitem, owner, key, value)
        self.budget.charge(len(owner))

    def _on_assign(self, node: ast.Assign, scope: py.Scope) -> None:
        value = self.evaluate(node.value, scope)
        for target in node.targets:
            self.bind(target, value, scope)

    def _on_augassign(self, node: ast.AugAssign, scope: py.Scope) -> None:
        target = node.target
        if any(isinstance(part, ast.Call | ast.NamedExpr) for part in ast.walk(target)):
            raise py.Undetermined("this target is not supported")
        load = copy(target)
        load.ctx = ast.Load()
        before, value = self.evaluate(load, scope), self.evaluate(node.value, scope)
        if not isinstance(before, py.PLAIN):
            refuse(before, "this value is not supported")
        if isinstance(before, list) and isinstance(node.op, ast.Add):
            before.extend(list(iterate(value)))
            self.budget.measure(before, "holds")
        elif isinstance(before, list | dict):
            raise py.Undetermined("this operator is not supported")
        else:
            self.bind(target, operate(node.op, before, value, self.budget), scope)


FileExpressions.KINDS = kinds_of(FileExpressions)
