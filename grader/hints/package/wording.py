"""Words and names: what a file spells otherwise than the reference, uses without an import, or writes differently."""

import ast
import builtins
import keyword
import re
from collections.abc import Iterable, Iterator
from difflib import SequenceMatcher
from itertools import islice, product

from grader.hints.edits import Proposal
from grader.hints.package.python_file import PythonFile
from grader.hints.package.task import change
from grader.names import closest
from grader.python.library import USUAL_NAMES
from grader.python.parse import SyntaxFault
from grader.source import Source

_WORD = re.compile(r"[^\W\d]\w*")
_MAX_WORDS, _MAX_SUSPECTS = 8, 60
_MAX_MEANT = 4  # names that an undefined one may stand for
_MAX_MORE = 2  # letters that one word has more than the other
_LIKENESS = 0.75
_TOKEN = re.compile(r"\w+|[ \t]+|\r?\n|.", re.DOTALL)
_MAX_DIFFERENCES, _MAX_TOKENS = 6, 3000
_SETTING = re.compile(r"(?P<key>[^\W\d][\w -]*?)(?::[ ]+|=\")(?P<value>[^\s\"][^\n\"]*)")
_MAX_VALUES = 4
_SUBSTITUTIONS = ("find-pkg-share", "var", "env", "command", "dirname")
_SUBSTITUTION = re.compile(rf"(?<=\$\()(?!(?:{'|'.join(_SUBSTITUTIONS)})\b)[\w-]+")
_SINGLE, _TYPOGRAPHIC = "‘’‚", re.compile("[‘’‚“”„]")
_PROGRAM = re.compile(r"(?:(?<=['\"]xacro)|(?<=['\"]cat))(?=['\"$])")


def respellings(source: Source, known: Iterable[str], what: str) -> Iterator[Proposal]:
    """Yield edits that replace a misspelt word everywhere, rare ones first.

    `known` are texts with words that are spelt as they should be; the file's other words may be the right ones, too.
    """
    places: dict[str, list[re.Match[str]]] = {}
    for match in _WORD.finditer(source.text):
        places.setdefault(match[0], []).append(match)
    right = {word for text in (*known, *keyword.kwlist, *USUAL_NAMES) for word in _WORD.findall(text)}
    suspects = sorted((word for word in places if word not in right and len(word) > 1), key=lambda it: len(places[it]))
    guesses = ((word, slip(word, right) or slip(word, places)) for word in suspects[:_MAX_SUSPECTS])
    for word, guess in islice(((word, guess) for word, guess in guesses if guess), _MAX_WORDS):
        yield change([source.edit(*place.span(), guess) for place in places[word]], "the spelling of a word", what)
    yield from _replace_words(source, _PROGRAM, [" "], what)
    quotes = [source.edit(*it.span(), "'" if it[0] in _SINGLE else '"') for it in _TYPOGRAPHIC.finditer(source.text)]
    yield change(quotes, "a syntax error", what)
    yield from () if source.path.endswith(".py") else _replace_words(source, _SUBSTITUTION, _SUBSTITUTIONS, what)


def _replace_words(source: Source, pattern: re.Pattern[str], words: Iterable[str], what: str) -> Iterator[Proposal]:
    """Yield edits that write another word everywhere for what a pattern finds."""
    places = [*pattern.finditer(source.text)]
    for old, word in product(dict.fromkeys(it[0] for it in places), words):
        yield change([source.edit(*it.span(), word) for it in places if it[0] == old], "a word", what)


def slip(word: str, known: Iterable[str]) -> str | None:
    """Return the known word that a slip of the hand makes this one: a letter or two more, less, other or swapped."""
    guess = closest(word, (other for other in known if abs(len(other) - len(word)) <= _MAX_MORE))
    same = SequenceMatcher(None, word.lower(), (guess or "").lower(), autojunk=False).ratio()
    return guess if same >= _LIKENESS else None


def reword(source: Source, wanted: str, what: str) -> Iterator[Proposal]:
    """Yield edits that undo one difference each between a file and the text that it should have, if there are few."""
    start_of_text = int(source.text.startswith("\ufeff"))
    own, right = _TOKEN.findall(source.text[start_of_text:]), _TOKEN.findall(wanted)
    if len(own) + len(right) > _MAX_TOKENS:
        return
    changes = [it for it in SequenceMatcher(None, own, right, autojunk=False).get_opcodes() if it[0] != "equal"]
    for _, first, last, start, end in changes if len(changes) <= _MAX_DIFFERENCES else ():
        offset, old = start_of_text + len("".join(own[:first])), "".join(own[first:last])
        yield change([source.edit(offset, offset + len(old), "".join(right[start:end]))], "a line", what)


def other_values(source: Source, wanted: str, what: str) -> Iterator[Proposal]:
    """Yield edits that give a key of YAML, or an attribute of XML, a value that the reference has for it."""
    known: dict[str, list[str]] = {}
    for found in _SETTING.finditer(wanted):
        known.setdefault(found["key"], []).append(found["value"])
    for found in _SETTING.finditer(source.text):
        values = dict.fromkeys(known.get(found["key"], ()))
        for value in [*values][:_MAX_VALUES] if found["value"] not in values else ():
            yield change([source.edit(*found.span("value"), value)], f"the value of `{found['key']}`", what)


def undefined_names(file: PythonFile, what: str) -> Iterator[Proposal]:
    """Yield edits that import or correct names that are undefined, or not as they are used; and missing commas."""
    if isinstance(file.parsed, SyntaxFault):
        start = file.source.offset(file.parsed.location.line, 1)
        end = start + len(file.text[start:].partition("\n")[0].rstrip())
        yield change([file.source.edit(end, end, ",")], "a syntax error", what)
    names = [node for node in file.nodes if isinstance(node, ast.Name)]
    used = {node.id for node in names if isinstance(node.ctx, ast.Load)}
    yield change(file.with_imports(sorted(used)), "the imports", what)
    for word in sorted(used - file.bound - {*dir(builtins)} - {*USUAL_NAMES})[:_MAX_WORDS]:
        own = sorted(file.values, key=lambda it: -SequenceMatcher(None, it, word).ratio())[:_MAX_MEANT]
        for other in own:
            edits = [file.replaced(node, other) for node in names if node.id == word]
            yield change(edits, f"the spelling of `{word}`", what)
    for statement in file.imports:  # the function glob instead of the module, or the reverse
        if [alias.name for alias in statement.names] == ["glob"]:
            new = "from glob import glob" if isinstance(statement, ast.Import) else "import glob"
            found = change([file.replaced(statement, new)], "an import", what)
            yield found._replace(rank=-1)  # says better what changes than the difference of the lines
    for node in file.nodes:
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Tuple):
            end = file.span(node.func)[1]
            yield change([file.source.edit(end, end, ",")], "a syntax error", what)
