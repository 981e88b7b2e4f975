"""The edits of a package that may make criteria pass, by the files that their checks look at.

Of a file these are its differences to the reference's, entries of lists that it lacks, paths that
name no file, names that are undefined, and words that are misspelt.
"""

import ast
import builtins
import posixpath
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from itertools import islice, product
from keyword import kwlist
from typing import Any

from grader.base.markup import indentation, indented
from grader.base.merge_conflicts import find_conflicts
from grader.base.names import closest
from grader.base.source import Edit, Source
from grader.lab.hints.edits import Proposal, edited
from grader.lab.hints.package_task import WHAT, PackageTask, change, file_proposals, package_names
from grader.lab.hints.python_file import PythonFile, argument, called
from grader.ros.build.places import HOME, PREFIX, WORKING_FOLDER
from grader.ros.launch.launch_model import Launch, NamedFile
from grader.ros.package.package import SETUP, Package
from grader.ros.python.library import USUAL_NAMES
from grader.ros.python.parse import Code, SyntaxFault, parse

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
_PIECE = re.compile(r"[^\s\"'<>=(){},\[\]$;|]+")
# What is before the name of a package: get_package_share_directory(', FindPackageShare(",
# $(find-pkg-share and a space.
_PACKAGE_ARGUMENT = re.compile(
    r"(?:package_share_\w+|package_prefix|FindPackage\w*|find-pkg-\w+)[\s(]*['\"]?$"
)
_MAX_PIECES = 1000  # of one file
_MAX_CALL = 80  # characters before an argument that are looked at
_REST_OF_ARGUMENT = re.compile(r"\s*,\s*")
_ENDINGS = {
    "urdf": (".urdf", ".xacro"),
    "rviz": (".rviz",),
    "include": (".launch.py", ".launch.xml", ".launch.yaml"),
}
_ENDINGS["read"] = _ENDINGS["urdf"]
_ENDINGS["parameters"] = (".yaml", ".yml")
_SHARE_FUNCTION = "get_package_share_directory"
_MAX_PATHS = 8  # that are wrong in one file
_MAX_EDITS = 3  # of one path
_MAX_FILES = 200
_LAUNCH = "the launch file"
_DESCRIPTION = "LaunchDescription"
_MAX_AROUND = 30  # lines that are indented together
_WITH_METHOD = ast.Call | ast.Attribute
_MAX_ITEMS = 30
_MAX_MADE, _MAX_PROPOSALS = 100, 24  # for one kind of files


def package_proposals(
    package: Package,
    reference: Package | None,
    wanted: Iterable[tuple[tuple[str, ...], Mapping[str, Any]]],
) -> Iterator[Iterator[Proposal]]:
    """Yield edits of a package for checks, by the kinds of files: what each check looks at, with
    its arguments.
    """
    kinds: dict[str, None] = {}
    given: set[str] = set()
    for looks_at, arguments in wanted:
        kinds |= dict.fromkeys(looks_at)
        for value in arguments.values():
            values = value if isinstance(value, list) else [value]
            given.update(it for it in values if isinstance(it, str))
    task = PackageTask(package, reference, frozenset(given))
    for kind in ("", *kinds):
        yield _best_of_kind(task, kind)


def _best_of_kind(task: PackageTask, kind: str) -> Iterator[Proposal]:
    """Yield the best proposals for a kind of files, each edit once: a later one says better what
    changes.
    """
    own = {it.edits: it for it in islice(_of_kind(task, kind), _MAX_MADE) if it.edits}
    yield from sorted(own.values(), key=lambda it: (it.rank, it.size))[:_MAX_PROPOSALS]


def _of_kind(task: PackageTask, kind: str) -> Iterator[Proposal]:
    """Yield edits of the file of a kind, and those that rename or create one; without a kind, of
    the package's name.
    """
    if not kind:
        yield from package_names(task, task.package.lab_name or task.package.share.split("/")[1])
        return
    yield from file_proposals(task, kind)
    if kind in (SETUP, "launch"):
        yield from file_proposals(task, "urdf")
    path, like = task.file(task.package, kind), task.file(task.reference, kind)
    source = task.source(path)
    if source is not None and path is not None:
        yield from (it for it in _of_text(task, kind, source, path, like) if it.edits)


def _of_text(
    task: PackageTask, kind: str, source: Source, path: str, like: str | None
) -> Iterator[Proposal]:
    """Yield the edits of a file: its difference to the reference, its syntax, its names, its
    paths and its words.
    """
    what, wanted = WHAT.get(kind, kind), task.wanted(like) or ""
    removed = [span for conflict in find_conflicts(source.text) for span in conflict.removed]
    if removed:  # whose marker lines no other edit removes together
        yield change(
            [source.edit(*span, "") for span in removed], "an unresolved merge conflict", what
        )
        return
    own = PythonFile(source)
    ending, other = (posixpath.splitext(it or "")[1] for it in (path, like))
    is_python = ending in (".py", "")
    if wanted and (ending == other or is_python):
        yield from _reword(source, wanted, what)
    if is_python:
        yield from _missing_entries(own, PythonFile(Source(source.path, wanted)), what)
        yield from _undefined_names(own, what)
    elif ending == other:
        yield from _other_values(source, wanted, what)
    if kind == "launch":
        launch = task.launch(path, source)
        yield from _launch_paths(task, launch, source)
        yield from _programs(task, launch, source)
    elif kind == SETUP:
        yield from _setup_paths(task)
    yield from _respellings(
        source, [wanted, *(task.files if kind == SETUP else task.package.installed)], what
    )
    if is_python:  # these rarely find a mistake
        yield from _unquoted_names(own, what)
        yield from _missing_calls(own, what)
        yield from _indentations(own, what)


def _respellings(source: Source, known: Iterable[str], what: str) -> Iterator[Proposal]:
    """Yield edits that replace a misspelt word everywhere, rare ones first.

    `known` are texts with words that are spelt as they should be; the file's other words may be the
    right ones, too.
    """
    places: dict[str, list[re.Match[str]]] = {}
    for match in _WORD.finditer(source.text):
        places.setdefault(match[0], []).append(match)
    right = {word for text in (*known, *kwlist, *USUAL_NAMES) for word in _WORD.findall(text)}
    bound = PythonFile(source).bound if source.path.endswith(".py") else frozenset()
    suspects = sorted(
        (word for word in places if word not in right and len(word) > 1),
        key=lambda it: len(places[it]),
    )
    guesses = (
        (word, _slip(word, right) or _slip(word, places)) for word in suspects[:_MAX_SUSPECTS]
    )
    slips = (
        (word, guess) for word, guess in guesses if guess and not {word, guess} <= bound
    )  # two things
    for word, guess in islice(slips, _MAX_WORDS):
        yield change(
            [source.edit(*place.span(), guess) for place in places[word]],
            "the spelling of a word",
            what,
        )
    yield from _replace_words(source, _PROGRAM, [" "], what)
    quotes = [
        source.edit(*it.span(), "'" if it[0] in _SINGLE else '"')
        for it in _TYPOGRAPHIC.finditer(source.text)
    ]
    yield change(quotes, "a syntax error", what)
    if not source.path.endswith(".py"):
        yield from _replace_words(source, _SUBSTITUTION, _SUBSTITUTIONS, what)


def _replace_words(
    source: Source, pattern: re.Pattern[str], words: Iterable[str], what: str
) -> Iterator[Proposal]:
    """Yield edits that write another word everywhere for what a pattern finds."""
    places = [*pattern.finditer(source.text)]
    for old, word in product(dict.fromkeys(it[0] for it in places), words):
        yield change(
            [source.edit(*it.span(), word) for it in places if it[0] == old], "a word", what
        )


def _slip(word: str, known: Iterable[str]) -> str | None:
    """Return the known word that a slip of the hand makes this one: a letter or two more, less,
    other or swapped.
    """
    guess = closest(word, (other for other in known if abs(len(other) - len(word)) <= _MAX_MORE))
    same = SequenceMatcher(None, word.lower(), (guess or "").lower(), autojunk=False).ratio()
    return guess if same >= _LIKENESS else None


def _reword(source: Source, wanted: str, what: str) -> Iterator[Proposal]:
    """Yield edits that undo one difference each between a file and the text that it should have,
    if there are few.
    """
    start_of_text = int(source.text.startswith("\ufeff"))
    own, right = _TOKEN.findall(source.text[start_of_text:]), _TOKEN.findall(wanted)
    if len(own) + len(right) > _MAX_TOKENS:
        return
    changes = [
        it
        for it in SequenceMatcher(None, own, right, autojunk=False).get_opcodes()
        if it[0] != "equal"
    ]
    if len(changes) > _MAX_DIFFERENCES:
        return
    for _, first, last, start, end in changes:
        offset, old = start_of_text + len("".join(own[:first])), "".join(own[first:last])
        cause = "a line" if first < last else "a missing line"
        yield change(
            [source.edit(offset, offset + len(old), "".join(right[start:end]))], cause, what
        )


def _other_values(source: Source, wanted: str, what: str) -> Iterator[Proposal]:
    """Yield edits that give a key of YAML, or an attribute of XML, a value that the reference
    has for it.
    """
    known: dict[str, list[str]] = {}
    for found in _SETTING.finditer(wanted):
        known.setdefault(found["key"], []).append(found["value"])
    for found in _SETTING.finditer(source.text):
        values = dict.fromkeys(known.get(found["key"], ()))
        if found["value"] in values:
            continue
        for value in [*values][:_MAX_VALUES]:
            yield change(
                [source.edit(*found.span("value"), value)], f"the value of `{found['key']}`", what
            )


def _undefined_names(file: PythonFile, what: str) -> Iterator[Proposal]:
    """Yield edits that import or correct names that are undefined, or not as they are used; and
    missing commas.
    """
    if isinstance(file.parsed, SyntaxFault):
        start = file.source.offset(file.parsed.location.line, 1)
        end = start + len(file.text[start:].partition("\n")[0].rstrip())
        yield change([file.source.edit(end, end, ",")], "a syntax error", what)
    names = [node for node in file.nodes if isinstance(node, ast.Name)]
    yield change(file.with_imports(sorted(file.used)), "the imports", what)
    for word in sorted(file.used - file.bound - {*dir(builtins)} - {*USUAL_NAMES})[:_MAX_WORDS]:
        own = sorted(file.values, key=lambda it: -SequenceMatcher(None, it, word).ratio())[
            :_MAX_MEANT
        ]
        for other in own:
            edits = [file.replaced(node, other) for node in names if node.id == word]
            yield change(edits, f"the spelling of `{word}`", what)
    for statement in file.imports:  # the function glob instead of the module, or the reverse
        if [alias.name for alias in statement.names] == ["glob"]:
            new = "from glob import glob" if isinstance(statement, ast.Import) else "import glob"
            found = change([file.replaced(statement, new)], "an import", what)
            yield found._replace(
                rank=-1
            )  # says better what changes than the difference of the lines
    for node in file.nodes:
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Tuple):
            end = file.span(node.func)[1]
            yield change([file.source.edit(end, end, ",")], "a syntax error", what)


def _unquoted_names(file: PythonFile, what: str) -> Iterator[Proposal]:
    """Yield edits that write a name without the quotes around it."""
    found = [
        (it, it.value)
        for it in file.nodes
        if isinstance(it, ast.Constant) and isinstance(it.value, str)
    ]
    for node, name in [pair for pair in found if pair[1] in file.values][:_MAX_WORDS]:
        yield change([file.replaced(node, name)], f"`{name}` in quotes, which is a text", what)


def _missing_calls(file: PythonFile, what: str) -> Iterator[Proposal]:
    """Yield edits that call a method which is only named, such as infp.read."""
    inside = {
        it.func if isinstance(it, ast.Call) else it.value
        for it in file.nodes
        if isinstance(it, _WITH_METHOD)
    }
    methods = [
        node for node in file.nodes if isinstance(node, ast.Attribute) and node not in inside
    ]
    for node in [it for it in methods if isinstance(it.ctx, ast.Load)][:_MAX_WORDS]:
        yield change(
            [file.replaced(node, f"{file.segment(node)}()")], f"`{node.attr}` without ()", what
        )


def _indentations(file: PythonFile, what: str) -> Iterator[Proposal]:
    """Yield edits that indent lines as those around them, with which Python can read the file.

    These are the line at which Python stops and the one before it, each alone, and with those that
    follow it without a blank line.
    """
    if not isinstance(file.parsed, SyntaxFault):
        return
    lines = file.text.split("\n")
    at = file.parsed.location.line - 1
    for first in (it for it in (at, at - 1) if 0 <= it < len(lines) and lines[it].strip()):
        around = [
            it
            for it in (*lines[max(first - _MAX_AROUND, 0) : first], *lines[first + 1 :][:1])
            if it.strip()
        ]
        known = dict.fromkeys(map(_indent_of, reversed(around)))
        deeper = f"{next(iter(known), '')}    "
        last = next((it for it in range(first, len(lines)) if not lines[it].strip()), len(lines))
        for indent, end in product(
            dict.fromkeys((*known, deeper)), dict.fromkeys((first + 1, last))
        ):
            edits = [
                _indented_line(file, it + 1, indent)
                for it in range(first, min(end, first + _MAX_AROUND))
            ]
            text = edited(file.text, file.source.path, edits)
            if text is not None and isinstance(
                parse(text.encode("utf-8", "surrogateescape"), ""), Code
            ):
                yield change(edits, "the indentation", what)


def _indented_line(file: PythonFile, number: int, indent: str) -> Edit:
    start = file.source.offset(number, 1)
    return file.source.edit(start, start + len(_indent_of(file.source.line(number))), indent)


def _indent_of(line: str) -> str:
    return line[: len(line) - len(line.lstrip())]


def _programs(task: PackageTask, launch: Launch, source: Source) -> Iterator[Proposal]:
    """Yield edits that start the program which a check names in place of another one of its
    package, or the reverse.
    """
    named = [name.partition("/") for text in task.given for name in text.split(" or ")]
    wanted = [(package, name or package) for package, _, name in named]
    for node in [it for it in launch.nodes if (it.package, it.executable) not in wanted][
        :_MAX_PATHS
    ]:
        for package, executable in wanted:
            texts = {node.package: package, node.executable: executable}
            if len(texts) == 2 and (node.package == package) != (node.executable == executable):
                spans = [
                    (start, end)
                    for start, end in _path_offsets(source)
                    if source.text[start:end] in texts
                ]
                edits = [source.edit(*span, texts[source.text[slice(*span)]]) for span in spans]
                edits.sort(key=lambda edit: abs(edit.line - node.location.line))
                for edit in [edit for edit in edits if edit.old != edit.new][:_MAX_EDITS]:
                    rank = -1 if edit.old == node.executable else 0
                    yield change([edit], "the program of a node", _LAUNCH)._replace(rank=rank)


def _setup_paths(task: PackageTask) -> Iterator[Proposal]:
    """Yield edits of the paths and patterns in setup.py that name no file, or a folder."""
    source, setup = task.source(SETUP), task.package.installation
    if source is None or setup is None or setup.is_cmake:
        return
    wrong = [(it.path.rstrip("/"), it.at.line) for it in setup.stops] + [
        (it.pattern, it.at.line) for it in setup.empty
    ]
    files = {path: posixpath.dirname(path) for path in islice(task.files, _MAX_FILES)}
    patterns = [
        f"{folder}/*{end}"
        for path, folder in files.items()
        for end in ("", posixpath.splitext(path)[1])
    ]
    for path, line in wrong[:_MAX_PATHS]:
        is_folder, above = path in task.package.tree.folders, posixpath.dirname(path)
        known, texts = [*files, *patterns], [path]
        if is_folder:
            known = [it for it in patterns if posixpath.dirname(it) in (above, path)]
            texts.append(f"{above}/*")
        for actual in texts:
            for wanted in _similar(actual, known)[:_MAX_EDITS]:
                edits = _moved(source, actual, wanted, line)[:2]
                yield from (change([edit], "a path", SETUP) for edit in edits)


def _similar(path: str, known: Iterable[str]) -> list[str]:
    """Return known paths, the most similar first."""
    return sorted(
        dict.fromkeys(known),
        key=lambda it: -SequenceMatcher(None, it, path, autojunk=False).ratio(),
    )


def _launch_paths(task: PackageTask, launch: Launch, source: Source) -> Iterator[Proposal]:
    """Yield edits with which a launch file finds its files: of all together, then of one path
    each.
    """
    installed = task.package.installed
    named = [it for it in launch.references[:_MAX_PATHS] if it.path is not None]
    wrong = [
        it
        for it in named
        if posixpath.normpath(it.path or "").removeprefix(f"{PREFIX}/") not in installed
    ]
    ways = [
        way for way in (_edits_of_path(task, source, named)[:_MAX_EDITS] for named in wrong) if way
    ]
    if len(ways) > 1:
        yield change([edit for way in ways for edit in way[0]], "the paths", _LAUNCH)
    for way in ways:
        yield from (change(edits, "a path", _LAUNCH) for edits in way)


def _targets(task: PackageTask, purpose: str) -> list[str]:
    """Return the paths in the package's share folder of the files that it installs for a
    purpose.
    """
    share = f"share/{task.package.name}/"
    own = (it.removeprefix(share) for it in task.package.installed if it.startswith(share))
    return [it for it in own if it.lower().endswith(_ENDINGS[purpose])]


def _edits_of_path(task: PackageTask, source: Source, named: NamedFile) -> list[list[Edit]]:
    """Return the edits with which a path becomes the one that the file is installed at."""
    actual, share = named.path or "", f"{PREFIX}/share/{task.package.name}/"
    for below in _similar(actual.removeprefix(share), _targets(task, named.purpose))[:1]:
        if actual.startswith(PREFIX):
            return [[edit] for edit in _moved(source, actual, share + below, named.location.line)]
        if source.path.endswith(".py"):
            return [*_of_one_machine(task.package.name, PythonFile(source), actual, below)]
    return []


def _of_one_machine(name: str, file: PythonFile, actual: str, target: str) -> Iterator[list[Edit]]:
    """Yield the edits that replace a path of one machine, or relative to the working folder, by the
    share folder.

    The difference to the reference has no answer where the file is built in another way:
    launch-home-path, sensors-launch-home-path.
    """
    share = f"{_SHARE_FUNCTION}({name!r})"
    for literal in [
        it
        for it in file.nodes
        if isinstance(it, ast.Constant) and it.value and isinstance(it.value, str)
    ]:
        for path in (
            str(literal.value).rstrip("/").replace("~", HOME, 1),
            f"{WORKING_FOLDER}/{literal.value!s}",
        ):
            if f"{actual}/".startswith(f"{path}/"):
                rest = actual.removeprefix(path).strip("/")
            else:
                rest = None
            others = _moved(file.source, rest, target)[:1] if rest and rest != target else []
            if rest in ("", target) or others:
                new = share if rest else f"os.path.join({share}, {target!r})"
                imports = file.with_imports([_SHARE_FUNCTION] if rest else [_SHARE_FUNCTION, "os"])
                yield [*imports, file.replaced(literal, new), *others]


def _path_offsets(source: Source) -> Iterator[tuple[int, int]]:
    """Yield the offsets of the texts in a file that a path may be put together from."""
    if not source.path.endswith(".py"):
        yield from (match.span() for match in _PIECE.finditer(source.text))
        return
    yield from ((it.start, it.end) for it in PythonFile(source).literals)


def _moved(source: Source, actual: str, wanted: str, line: int = 1) -> list[Edit]:
    """Return the edits of one text each with which a path becomes the wanted one; those nearest
    to a line first.
    """
    found: dict[Edit, int] = {}
    for start, end in islice(_path_offsets(source), _MAX_PIECES):
        piece = source.text[start:end]
        if piece.strip("./") and piece in actual:
            is_package = (
                _PACKAGE_ARGUMENT.search(source.text, max(start - _MAX_CALL, 0), start) is not None
            )
            for new in _replacements(piece, actual, wanted):
                if is_package and ("/" in new or not new):
                    continue  # the name of a package has no folders
                edit = source.edit(start, end, new) if new else _without(source, start, end)
                found.setdefault(edit, abs(edit.line - line))
    return sorted(found, key=lambda edit: (found[edit], -edit.line))


def _replacements(piece: str, actual: str, wanted: str) -> Iterator[str]:
    for place in re.finditer(re.escape(piece), actual):
        head, tail = actual[: place.start()], actual[place.end() :]
        if (
            wanted.startswith(head)
            and wanted.endswith(tail)
            and len(head) + len(tail) <= len(wanted)
        ):
            new = wanted[len(head) : len(wanted) - len(tail)]
            if new != piece:
                yield new


def _without(source: Source, start: int, end: int) -> Edit:
    """Return the edit that removes a text, as an argument with its quotes and comma where it is
    one.
    """
    text = source.text
    after = _REST_OF_ARGUMENT.match(text, end + 1)
    if (
        text[start - 1 : start] in "'\""
        and text[end : end + 1] == text[start - 1 : start]
        and after is not None
    ):
        return source.edit(start - 1, after.end(), "")
    return source.edit(start, end + 1 if text.startswith("/", end) else end, "")


def _missing_entries(own: PythonFile, like: PythonFile, what: str) -> Iterator[Proposal]:
    """Yield edits that add what the file makes and does not use, or entries of the reference's
    list: one, or all.

    A node of a package of which the file has one is not added: that one is wrong.
    """
    made = [
        name
        for name, value in own.values.items()
        if isinstance(value, ast.Call) and called(value)[:1].isupper()
    ]
    unused = [name for name in made if name not in own.used]
    known = {own.plain(it) for it in _items(own)}
    known |= {own.plain(it.elts[-1]) for it in _items(own) if isinstance(it, ast.Tuple) and it.elts}
    known |= {
        package for call in own.calls("Node") if (package := _package_of(own, call)) is not None
    }
    missing = [
        it for it in _items(like) if known.isdisjoint((like.plain(it), _package_of(like, it)))
    ]
    missing = [
        it for it in missing if not (isinstance(it, ast.Tuple) and like.plain(it.elts[-1]) in known)
    ]
    for codes in (unused, [like.written(item, own.bound) for item in missing]):
        for code in codes:
            yield from _adding(own, [code], what)
        if len(codes) > 1:
            yield from _adding(own, codes, what)


def _adding(own: PythonFile, codes: Sequence[str], what: str) -> Iterator[Proposal]:
    edit = _add(own, codes)
    if edit is not None:
        needs = own.with_imports(sorted({name for code in codes for name in own.names_in(code)}))
        yield change([*needs, edit], f"a missing part of {what}")


def _package_of(file: PythonFile, code: ast.expr) -> str | None:
    """Return the package of the program that a node starts."""
    given = argument(code, "package") if isinstance(code, ast.Call) else None
    if given is not None:
        return file.plain(given.value)
    return None


def _list(file: PythonFile) -> ast.expr | None:
    """Return the list of files to install, or of actions to start."""
    for call in file.calls("setup"):
        entries = argument(call, "data_files")
        if entries is not None:
            return file.meant(entries.value)
        return None
    return next((file.meant(call.args[0]) for call in file.calls(_DESCRIPTION) if call.args), None)


def _items(file: PythonFile) -> list[ast.expr]:
    """Return the entries of the list, and those that are added to it."""
    found = _list(file)
    own = found.elts if isinstance(found, ast.List) else []
    return [
        *map(file.meant, own),
        *(file.meant(it.args[0]) for it in file.calls("add_action") if it.args),
    ][:_MAX_ITEMS]


def _add(file: PythonFile, codes: Sequence[str]) -> Edit | None:
    """Return the edit that adds code after the last entry, in lines of their own if that has
    one.
    """
    found, actions = _list(file), file.calls("add_action")
    if isinstance(found, ast.List) and not (actions and not found.elts):
        nodes: Sequence[ast.expr] = found.elts
        start, end = file.span(nodes[-1] if nodes else found)
        if not nodes:
            return file.source.edit(end - 1, end - 1, ", ".join(codes))
        before = ","
    elif actions:
        start, end = file.span(actions[-1])
        owner = file.segment(actions[-1].func)
        codes, before = [f"{owner}({code})" for code in codes], ""
    else:
        return None
    line = indentation(file.text, start)
    space = f"{file.newline}{line}" if line else " "
    return file.source.edit(
        end, end, "".join(f"{before}{space}{indented(it, line, file.newline)}" for it in codes)
    )
