"""Figures of how dense the code is, in nodes of the syntax tree, which no formatter changes."""

import ast
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
MAX_NODES_OF_A_STATEMENT = 18  # in the mean of a large function: one with more is packed
MAX_NODES_OF_A_TINY_FUNCTION = 25
TEXTS = frozenset({"message", "reason", "messages", "reasons"})
TEXT_METHODS = frozenset({"startswith", "endswith", "partition", "rpartition", "split", "replace"})


class Function(NamedTuple):
    """A function with the nodes and statements of its body, without the docstring."""

    place: str
    node: ast.FunctionDef
    nodes: int
    statements: int

    def is_packed(self, nodes: int) -> bool:
        """Return whether it is larger than this, and its statements are full."""
        return self.nodes > nodes and self.nodes > MAX_NODES_OF_A_STATEMENT * self.statements


def size(node: ast.AST) -> int:
    """Return how many nodes a part of a syntax tree has."""
    return sum(1 for _ in ast.walk(node))


def holds_another(node: ast.AST, kinds: tuple[type[ast.AST], ...]) -> bool:
    """Return whether a part of the tree holds one of these kinds, besides itself."""
    return any(isinstance(inner, kinds) for inner in ast.walk(node) if inner is not node)


class Prose:
    """The code of some modules."""

    def __init__(self, modules: Mapping[str, Path]) -> None:
        self.trees = {
            name: ast.parse(path.read_text(encoding="utf-8")) for name, path in modules.items()
        }
        self.docstrings = {
            id(node.body[0])
            for tree in self.trees.values()
            for node in ast.walk(tree)
            if isinstance(node, DOCUMENTED) and ast.get_docstring(node, clean=False) is not None
        }

    @cached_property
    def kinds(self) -> Counter[type[ast.AST]]:
        """How many nodes of each kind there are."""
        return Counter(type(node) for tree in self.trees.values() for node in ast.walk(tree))

    @cached_property
    def simple_statements(self) -> list[ast.stmt]:
        """The statements that hold no other one, without imports and docstrings, the smallest first."""
        statements = []
        for tree in self.trees.values():
            for node in ast.walk(tree):
                if not isinstance(node, ast.stmt) or id(node) in self.docstrings:
                    continue
                is_import = isinstance(node, ast.Import | ast.ImportFrom)
                if not is_import and not holds_another(node, (ast.stmt, ast.match_case)):
                    statements.append(node)
        return sorted(statements, key=size)

    @cached_property
    def functions(self) -> list[Function]:
        """All functions and methods."""
        functions = []
        for module, tree in self.trees.items():
            for node in ast.walk(tree):
                if isinstance(node, ast.FunctionDef):
                    body = [part for part in node.body if id(part) not in self.docstrings]
                    inner = [part for statement in body for part in ast.walk(statement)]
                    statements = sum(isinstance(part, ast.stmt) for part in inner)
                    place = f"{module}.{node.name}"
                    functions.append(Function(place, node, len(inner), statements))
        return functions

    def holding(self, kinds: tuple[type[ast.AST], ...]) -> list[str]:
        """Return the places of expressions of these kinds that hold another one."""
        return [
            f"{module}:{getattr(node, 'lineno', 0)}"
            for module, tree in self.trees.items()
            for node in ast.walk(tree)
            if isinstance(node, kinds) and holds_another(node, kinds)
        ]

    def crowded_statements(self) -> int:
        """Return how many simple statements hold several comprehensions."""
        counts = (
            sum(isinstance(inner, COMPREHENSIONS) for inner in ast.walk(statement))
            for statement in self.simple_statements
        )
        return sum(count > 1 for count in counts)

    def tiny_functions(self) -> list[str]:
        """Return the small private functions that their module uses once, by a plain name."""
        tiny = []
        for module, tree in self.trees.items():
            uses = Counter(
                node.id if isinstance(node, ast.Name) else node.attr
                for node in ast.walk(tree)
                if isinstance(node, ast.Name | ast.Attribute)
            )
            handed_on = set(_names_in_tables_and_calls(tree))
            for node in tree.body:
                if not isinstance(node, ast.FunctionDef) or node.decorator_list:
                    continue
                is_candidate = node.name.startswith("_") and uses[node.name] == 1
                body = [part for part in node.body if id(part) not in self.docstrings]
                is_small = sum(map(size, body)) <= MAX_NODES_OF_A_TINY_FUNCTION
                if is_candidate and is_small and node.name not in handed_on:
                    tiny.append(f"{module}.{node.name}")
        return tiny

    def repeated_class_names(self) -> dict[str, list[str]]:
        """Return the names that several classes have, with their modules."""
        modules = defaultdict(list)
        for module, tree in self.trees.items():
            for node in ast.walk(tree):
                if isinstance(node, ast.ClassDef):
                    modules[node.name].append(module)
        return {name: places for name, places in modules.items() if len(places) > 1}

    def comparisons_of_messages(self) -> list[str]:
        """Return the places where code learns something from the text of a message or a reason."""
        return [
            f"{module}:{getattr(node, 'lineno', 0)}"
            for module, tree in self.trees.items()
            for node in ast.walk(tree)
            if _reads_a_message(node)
        ]


def _names_in_tables_and_calls(tree: ast.AST) -> Iterator[str]:
    """Yield the names in lists, tuples and dictionaries, and those that are arguments."""
    for node in ast.walk(tree):
        if isinstance(node, ast.List | ast.Tuple | ast.Dict):
            handed: list[ast.AST] = [*ast.iter_child_nodes(node)]
        elif isinstance(node, ast.Call):
            handed = [*node.args]
        else:
            continue
        yield from (part.id for part in handed if isinstance(part, ast.Name))


def _is_message(node: ast.AST) -> bool:
    return isinstance(node, ast.Attribute) and node.attr in TEXTS


def _is_known_text(node: ast.AST) -> bool:
    """Return whether an expression is a text that is written in the code, or a constant."""
    match node:
        case ast.Constant(value=str(text)):
            return bool(text)
        case ast.Name(id=name):
            return name.isupper()
    return False


def _reads_a_message(node: ast.AST) -> bool:
    """Return whether an expression compares a message with a text, or takes it apart."""
    match node:
        case ast.Compare(left=left, comparators=[right]):
            sides = (left, right)
            return any(map(_is_known_text, sides)) and any(map(_is_message, sides))
        case ast.Call(func=ast.Attribute(value=value, attr=method)):
            return method in TEXT_METHODS and _is_message(value)
    return False
