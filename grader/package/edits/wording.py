"""Words and values that a file writes otherwise than the reference, and names that it uses without an import."""

import ast
import re
from collections.abc import Iterator
from difflib import SequenceMatcher

from grader.edits import Proposal
from grader.package.edits.python_file import PythonFile
from grader.package.edits.task import change
from grader.source import Source

_TOKEN = re.compile(r"\w+|[ \t]+|\r?\n|.", re.DOTALL)
_PART = re.compile(r"(?<![\w/])\w")  # a word that is not the name in a closing tag
_MAX_DIFFERENCES, _MAX_TOKENS = 6, 3000
_SETTING = re.compile(r"(?P<key>[^\W\d][\w -]*?)(?::[ ]+|=\")(?P<value>[^\s\"][^\n\"]*)")
_MAX_VALUES = 4


def reword(source: Source, wanted: str, what: str) -> Iterator[Proposal]:
    """Yield edits that undo one difference each between a file and the text that it should have, if there are few.

    Of what is missing only signs are added, such as a bracket: a hint never writes a missing part.
    """
    start_of_text = int(source.text.startswith("\ufeff"))
    own, right = _TOKEN.findall(source.text[start_of_text:]), _TOKEN.findall(wanted)
    if len(own) + len(right) > _MAX_TOKENS:
        return
    changes = [it for it in SequenceMatcher(None, own, right, autojunk=False).get_opcodes() if it[0] != "equal"]
    for _, first, last, start, end in changes if len(changes) <= _MAX_DIFFERENCES else ():
        offset, old = start_of_text + len("".join(own[:first])), "".join(own[first:last])
        new = "".join(right[start:end])
        if old or not _PART.search(new):
            yield change([source.edit(offset, offset + len(old), new)], "a line", what)


def other_values(source: Source, wanted: str, what: str) -> Iterator[Proposal]:
    """Yield edits that give a key of YAML, or an attribute of XML, a value that the reference has for it."""
    known: dict[str, list[str]] = {}
    for found in _SETTING.finditer(wanted):
        known.setdefault(found["key"], []).append(found["value"])
    for found in _SETTING.finditer(source.text):
        values = dict.fromkeys(known.get(found["key"], ()))
        for value in [*values][:_MAX_VALUES] if found["value"] not in values else ():
            yield change([source.edit(*found.span("value"), value)], f"the value of `{found['key']}`", what)


def imports(file: PythonFile, what: str) -> Iterator[Proposal]:
    """Yield edits that import what is used, and glob as it is used."""
    used = {it.id for it in file.nodes if isinstance(it, ast.Name) and isinstance(it.ctx, ast.Load)}
    yield change(file.with_imports(sorted(used)), "the imports", what)
    for statement in file.imports:  # the function glob instead of the module, or the reverse
        if [alias.name for alias in statement.names] == ["glob"]:
            new = "from glob import glob" if isinstance(statement, ast.Import) else "import glob"
            found = change([file.replaced(statement, new)], "an import", what)
            yield found._replace(rank=-1)  # says better what changes than the difference of the lines
