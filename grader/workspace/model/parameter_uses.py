"""Whether code does something with the value that it reads from a parameter."""

import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from grader.base.patterns import on_use
from grader.base.source import Location, Source
from grader.ros.nodes.node_facts import NodeFacts
from grader.workspace.model.code_text import code_alone
from grader.workspace.model.text_files import read_code
from grader.workspace.model.workspace import Workspace

_GOES_ON = ("(", "[", ",", "=", "\\", "_{")
# The variable before the = of an assignment, and what converts the value behind it.
_TARGET = on_use(r"(?:\bself\.|\bthis->|(?<![\w.>]))(\w++)\s*+(?::[^:(\n]*+)?\Z")
_CONVERTED = on_use(r"(?:\b(?:float|int|str|bool|max|min|abs)\(|(?<!\w)\(|[^()\[])*+")
_INITIALISES = on_use(r"(?<!\w)(\w++(?<=_))\s*+[({]\s*+\Z")  # a member, which by custom ends so
_INTO = on_use(
    r"[^(\"']*?get_parameter(?:_or)?+\s*+(?:<[^()]{0,80}?>)?+\s*+\(\s*+(?:std::string\()?+"
    r"\"[^\"\n]*+\"\)?+\s*+,\s*+([\w.>-]++)\s*+[,)\[]"
)
_MAX_INTO = 200  # characters of a C++ call up to its second argument
_OPEN = on_use(  # what reads parameters without their names
    r"\bget_parameters|\._parameters\b|\bsetattr\(|\bParamListener\b"
    r"|\bget_parameter(?:_or)?+(?:<[^()]{0,80}?>)?+\(\s*+(?:[^\s\"']|[\"'][^\"'\n]*+[\"']\s*+\+)"
)
_LOGS = on_use(  # a call that is not closed, and prints without a period
    r"\bcout\b"
    r"|(?:\.(?:debug|info|warn|warning|error|fatal)|\bRCLCPP_(?!\w*THROTTLE)[A-Z_]++|\bprint)"
    r"\((?!(?:[^()]|\((?:[^()]|\([^()]*+\))*+\))*+\))(?![^;]{0,200}throttle)"
)
# What stands behind a variable that is set, or declared.
_SET_BEHIND = on_use(
    r"\s*+=(?!=)|\s*+[({]\s*+(?:this->)?(?:declare|get)_parameter"
    r"|\s*+(?:\{[^}\n]*+\})?\s*+;"
)
_READS = on_use(r"\bget_parameter(?:_or)?+\s*+(?:<[^()]{0,80}?>)?+\([^()]*+\Z")
# What stands before a variable that is declared.
_DECLARES = on_use(r"\A\s*+(?!return\b|throw\b)(?:const\s++)?[\w:<>]++[&*\s]++\Z")


class _ParameterUse(NamedTuple):
    """Where a node uses a parameter, or else declares or reads it; `doubt` is why that is open."""

    at: Location | None
    is_used: bool
    doubt: str = ""


def find_parameter_use(workspace: Workspace, node: str, name: str) -> _ParameterUse:
    """Return what the code of a node does with a parameter.

    What only sets another variable, or is printed, is not used. `at` is None where no code has the
    parameter.
    """
    every_fact = _find_facts(workspace, node)
    declared = [parameter for facts in every_fact for parameter in facts.parameters]
    places = [each.location for each in declared if each.name == name and not each.is_guard]
    if places:
        package = next(one for one in workspace.packages if one.holds(places[0].path))
        return _ParameterReader(read_code(workspace.texts, package), name).find(places)
    doubts = [facts for facts in every_fact if facts.doubts]
    is_read = every_fact and not doubts and None not in [each.name for each in declared]
    for package in workspace.packages:
        reader = _ParameterReader(read_code(workspace.texts, package), name)
        is_read = is_read and not reader.may_read()
    return _ParameterUse(None, False, "" if is_read else "its code is not known")


def _find_facts(workspace: Workspace, node: str) -> list[NodeFacts]:
    """Return the nodes in code that have a name, or are started with it."""
    nodes: list[NodeFacts] = []
    for started in workspace.launches.nodes:
        if workspace.code.find_name(started) == node:
            nodes += workspace.code.find_all_nodes(started)
    nodes += [facts for facts in workspace.code.nodes if facts.name == node]
    return nodes


class _ParameterReader:
    """The code of a package, in which the uses of one parameter are searched."""

    def __init__(self, sources: Iterable[Source], name: str) -> None:
        self._sources = {source.path: source for source in sources}
        self._alone = {
            path: code_alone(source.text, path) for path, source in self._sources.items()
        }
        self._name = re.compile(rf"""(["']){re.escape(name)}\1""")

    def find(self, places: Sequence[Location]) -> _ParameterUse:
        """Return what is done with the values of the calls at these places."""
        has_only_known = True
        known: set[tuple[str, int]] = set()  # where the name is written in these calls
        for at in places:
            source = self._sources.get(at.path)
            written = source and self._name.search(source.text, source.start_offset(at))
            if not source or not written:
                has_only_known = False
                continue
            known.add((at.path, written.start()))
            use = self._find_use(source, source.start_offset(at), written.end())
            if use:
                return _ParameterUse(use, True)
        for source in self._sources.values():
            for match in self._name.finditer(source.text):
                has_only_known = has_only_known and (source.path, match.start()) in known
            has_only_known = has_only_known and not _OPEN.search(source.text)
        doubt = "" if has_only_known else "its code may read it in other ways"
        return _ParameterUse(places[0], False, doubt)

    def may_read(self) -> bool:
        """Return whether code may read the parameter in a way that is not known."""
        texts = [source.text for source in self._sources.values()]
        return any(self._name.search(text) or _OPEN.search(text) for text in texts)

    def _find_use(self, source: Source, start: int, end: int) -> Location | None:
        """Return where the value of a call, whose first argument ends there, is used."""
        before = _begin_statement(source.text, start)
        into = _INTO.match(source.text, start, end + _MAX_INTO)
        if into and not source.path.endswith(".py"):
            return self._find_variable(into[1].replace("->", ".").rpartition(".")[2])
        variable = _find_assigned(before)
        if variable:
            return self._find_variable(variable)
        is_statement = not before.strip() or before.strip().endswith(("->", "::", "."))
        if is_statement or _LOGS.search(before):
            return None
        return source.at(start)

    def _find_variable(self, name: str) -> Location | None:
        """Return where a variable is used, and not only set, declared or printed."""
        pattern = re.compile(rf"\b{re.escape(name)}\b")
        for path, text in self._alone.items():
            for match in pattern.finditer(text):
                before = _begin_statement(text, match.start())
                behind = _SET_BEHIND.match(text, match.end())
                is_set = behind is not None and (
                    not behind[0].endswith(";") or _DECLARES.match(before) is not None
                )
                if not (is_set or _READS.search(before) or _LOGS.search(before)):
                    return self._sources[path].at(match.start())
        return None


def _begin_statement(text: str, offset: int) -> str:
    """Return the text of a statement before a place in it; lines that go on are of one."""
    start = text.rfind("\n", 0, offset) + 1
    while start:
        previous = text.rfind("\n", 0, start - 1) + 1
        if not text[previous:start].rstrip().endswith(_GOES_ON):
            break
        start = previous
    before = text[start:offset]
    return before[max(before.rfind(";"), before.rfind("{ ")) + 1 :]


def _find_assigned(before: str) -> str:
    """Return the own variable that gets the value of a call behind a text; empty without one."""
    member = _INITIALISES.search(before)
    if member:
        return member[1]
    head, _, value = before.rpartition("=")
    target = _TARGET.search(head)
    if not target or not _CONVERTED.fullmatch(value):
        return ""
    outside = before[: target.start()]
    is_whole = "," not in outside and outside.count("(") <= outside.count(")")
    return target[1] if is_whole else ""
