"""The edits of a package that may make criteria pass, by the files that their checks look at.

Of a file these are its differences to the reference's, entries of lists that it lacks, paths that
name no file, names that are undefined, and words that are misspelt.
"""

import ast
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from itertools import islice, product
from keyword import kwlist
from posixpath import dirname, normpath, splitext
from typing import Any

from grader.base.element_edits import edited
from grader.base.grouping import Span, Strings, as_list
from grader.base.markup import indentation, indented
from grader.base.merge_conflicts import find_conflicts
from grader.base.names import closest
from grader.base.patterns import on_use
from grader.base.source import Edit, Source
from grader.base.text import in_backticks, indent_of
from grader.lab.hints.edits import Proposal, Proposals
from grader.lab.hints.package_task import WHAT, PackageTask, change, file_proposals, package_names
from grader.ros.installation.places import HOME, PREFIX, WORKING_FOLDER
from grader.ros.launch.launch_model import Launch, NamedFile
from grader.ros.package.package import SETUP, Package
from grader.ros.python.library import USUAL_NAMES
from grader.ros.python.python_file import PythonFile, argument

_WORD = on_use(r"[^\W\d]\w*")
_MAX_WORDS = 8
_MAX_SUSPECTS = 60
_MAX_MEANT = 4  # names that an undefined one may stand for
_MAX_MORE = 2  # letters that one word has more than the other
_LIKENESS = 0.75
_TOKEN = on_use(r"\w+|[ \t]+|\r?\n|.", re.DOTALL)
_AROUND_TEXTS = " ,'\"\r\n"
_MAX_DIFFERENCES = 6
_MAX_TOKENS = 3000
_SETTING = on_use(r"(?P<key>[^\W\d][\w -]{0,60}?)(?::[ ]+|=\")(?P<value>[^\s\"][^\n\"]*)")
_MAX_VALUES = 4
_MAX_BEFORE = 1_000  # characters in which the key around a value is searched
_SUBSTITUTIONS = ("find-pkg-share", "var", "env", "command", "dirname")
_SUBSTITUTION = on_use(rf"(?<=\$\()(?!(?:{'|'.join(_SUBSTITUTIONS)})\b)[\w-]+")
_SINGLE = "‘’‚"
_TYPOGRAPHIC = re.compile("[‘’‚“”„]")
_PROGRAM = on_use(r"(?:(?<=['\"]xacro)|(?<=['\"]cat))(?=['\"$])")
_PIECE = on_use(r"[^\s\"'<>=(){},\[\]$;|]+")
# What is before the name of a package: get_package_share_directory(', FindPackageShare(",
# $(find-pkg-share and a space.
_PACKAGE_ARGUMENT = on_use(
    r"(?:package_share_\w{1,30}|package_prefix|FindPackage\w{0,30}|find-pkg-\w{1,30})[\s(]{0,30}['\"]?$"
)
_MAX_PIECES = 1000  # of one file
_MAX_CALL = 80  # characters before an argument that are looked at
_REST_OF_ARGUMENT = on_use(r"\s*+,\s*+")
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
_ADDRESS = on_use(
    r"\bemail\s*=\s*[\"'](?P<all>(?P<name>[\w.+-]+)(?:\s+at\s+|\s*[(\[]at[)\]]\s*)(?P<host>[\w.-]+))[\"']"
)
_DESCRIPTION = "LaunchDescription"
_MAX_AROUND = 30  # lines that are indented together
_MAX_ITEMS = 30
_MAX_MADE, _MAX_PROPOSALS = 100, 24  # for one kind of files


def package_proposals(
    package: Package,
    reference: Package | None,
    wanted: Iterable[tuple[Strings, Mapping[str, Any]]],
) -> Iterator[Proposals]:
    """Yield edits of a package for checks, by the kinds of files.

    The kinds are what each check looks at, with its arguments.
    """
    kinds: dict[str, None] = {}
    given: set[str] = set()
    for looks_at, arguments in wanted:
        kinds |= dict.fromkeys(looks_at)
        for value in arguments.values():
            texts = as_list(value)
            given.update(text for text in texts if isinstance(text, str))
    task = PackageTask(package, reference, frozenset(given))
    for kind in ("", *kinds):
        yield _best_of_kind(task, kind)


def _best_of_kind(task: PackageTask, kind: str) -> Proposals:
    """Yield the best proposals for a kind of files, each edit once.

    A later one says better what changes.
    """
    proposals = {}
    for proposal in islice(_proposals_of_kind(task, kind), _MAX_MADE):
        if proposal.edits:
            proposals[proposal.edits] = proposal
    in_order = sorted(proposals.values(), key=lambda proposal: (proposal.rank, proposal.size))
    yield from in_order[:_MAX_PROPOSALS]


def _proposals_of_kind(task: PackageTask, kind: str) -> Proposals:
    """Yield edits of the file of a kind, and those that rename or create one.

    Without a kind, they are those of the package's name.
    """
    if not kind:
        yield from package_names(task, task.package.wanted_name or task.package.share.split("/")[1])
        return
    yield from file_proposals(task, kind)
    if kind in (SETUP, "launch"):
        yield from file_proposals(task, "urdf")
    path = task.file(task.package, kind)
    like = task.file(task.reference, kind)
    source = task.source(path)
    if source and path is not None:
        for proposal in _proposals_of_file(task, kind, source, path, like):
            if proposal.edits and not any(map(_writes_address, proposal.edits)):
                yield proposal._replace(cause=f"{proposal.cause} in {WHAT.get(kind, kind)}")


def _writes_address(edit: Edit) -> bool:
    """Return whether an edit writes an e-mail address of others: those of the reference's file."""
    words = {*_WORD.findall(edit.old)}
    return "@" in edit.new and not words.issuperset(_WORD.findall(edit.new))


def _proposals_of_file(
    task: PackageTask, kind: str, source: Source, path: str, like: str | None
) -> Proposals:
    """Yield the edits of a file.

    They are about its difference to the reference, its syntax, its names, its paths and its
    words.
    """
    wanted = task.wanted(like) or ""
    removed = [span for conflict in find_conflicts(source.text) for span in conflict.removed]
    if removed:  # whose marker lines no other edit removes together
        edits = [source.edit(*span, "") for span in removed]
        yield change(edits, "an unresolved merge conflict")
        return
    file = PythonFile(source)
    ending = splitext(path)[1]
    ending_of_like = splitext(like or "")[1]
    is_python = ending in (".py", "")
    if wanted and (ending == ending_of_like or is_python):
        yield from _reword(source, file, wanted)
    if is_python:
        yield from _missing_entries(file, PythonFile(Source(source.path, wanted)))
        yield from _undefined_names(file)
    elif ending == ending_of_like:
        yield from _other_values(source, wanted)
    for address in _ADDRESS.finditer(source.text):
        edit = source.edit(*address.span("all"), f"{address['name']}@{address['host']}")
        yield change([edit], "an e-mail address without @")
    if kind == "launch":
        launch = task.launch(path, source)
        yield from _launch_paths(task, launch, source)
        yield from _programs(task, launch, source)
    elif kind == SETUP:
        yield from _setup_paths(task)
    paths = task.files if kind == SETUP else task.package.installed
    yield from _respellings(source, [wanted, *paths])
    if is_python:  # these rarely find a mistake
        yield from _unquoted_names(file)
        yield from _missing_calls(file)
        yield from _missing_brackets(file)
        yield from _missing_slashes(file)
        yield from _indentations(file)


def _respellings(source: Source, known: Iterable[str]) -> Proposals:
    """Yield edits that replace a misspelt word everywhere, rare ones first.

    `known` are texts with words that are spelt as they should be; the file's other words may be the
    right ones, too.
    """
    places = _group_matches(_WORD, source)
    right = set()
    for text in (*known, *kwlist, *USUAL_NAMES):
        right.update(_WORD.findall(text))
    bound = PythonFile(source).bound if source.path.endswith(".py") else frozenset()
    suspects = [word for word in places if word not in right and len(word) > 1]
    suspects.sort(key=lambda word: len(places[word]))
    count = 0
    for word in suspects[:_MAX_SUSPECTS]:
        guess = _slip(word, right) or _slip(word, places)
        if not guess or {word, guess} <= bound:  # names that are both bound are two things
            continue
        edits = [source.edit(*place.span(), guess) for place in places[word]]
        yield change(edits, f"the spelling of `{word}`")
        count += 1
        if count == _MAX_WORDS:
            break
    yield from _replace_words(source, _PROGRAM, [" "])
    quotes = [
        source.edit(*match.span(), "'" if match[0] in _SINGLE else '"')
        for match in _TYPOGRAPHIC.finditer(source.text)
    ]
    yield change(quotes, "quotation marks that are not straight")
    if not source.path.endswith(".py"):
        yield from _replace_words(source, _SUBSTITUTION, _SUBSTITUTIONS)


def _group_matches(
    pattern: re.Pattern[str], source: Source
) -> Mapping[str, Sequence[re.Match[str]]]:
    """Return where a pattern finds each text."""
    places: dict[str, list[re.Match[str]]] = {}
    for match in pattern.finditer(source.text):
        places.setdefault(match[0], []).append(match)
    return places


def _replace_words(source: Source, pattern: re.Pattern[str], words: Iterable[str]) -> Proposals:
    """Yield edits that write another word everywhere for what a pattern finds."""
    places = _group_matches(pattern, source)
    for matches, word in product(places.values(), words):
        edits = [source.edit(*match.span(), word) for match in matches]
        written = in_backticks([matches[0][0]]) or "a missing space"
        yield change(edits, written)


def _slip(word: str, known: Iterable[str]) -> str | None:
    """Return the known word that a slip of the hand makes this one.

    A slip is a letter or two more, less, other or swapped.
    """
    similar = [other for other in known if abs(len(other) - len(word)) <= _MAX_MORE]
    guess = closest(word, similar)
    likeness = SequenceMatcher(None, word.lower(), (guess or "").lower(), autojunk=False).ratio()
    return guess if likeness >= _LIKENESS else None


def _reword(source: Source, file: PythonFile, wanted: str) -> Proposals:
    """Yield edits that undo one difference each between a file and its proper text.

    There are none unless they are few.
    """
    start_of_text = int(source.text.startswith("\ufeff"))
    own_tokens = _TOKEN.findall(source.text[start_of_text:])
    right = _TOKEN.findall(wanted)
    if len(own_tokens) + len(right) > _MAX_TOKENS:
        return
    matcher = SequenceMatcher(None, own_tokens, right, autojunk=False)
    changes = [opcode for opcode in matcher.get_opcodes() if opcode[0] != "equal"]
    if len(changes) > _MAX_DIFFERENCES:
        return
    for _, first, last, start, end in changes:
        offset = start_of_text + len("".join(own_tokens[:first]))
        old = "".join(own_tokens[first:last])
        new = "".join(right[start:end])
        edit = source.edit(offset, offset + len(old), new)
        written = in_backticks([_without_quotes(old)])
        yield change([edit], written or _missing_in_words(file, offset, new))


def _without_quotes(text: str) -> str:
    """Return a text without blanks, commas and quotes around it; a pair of quotes inside stays."""
    text = text.strip(" ,\r\n")
    for quote in ("'", '"'):
        if text.startswith(quote) or text.count(quote) % 2:
            text = text.strip(quote)
    return text


def _missing_in_words(file: PythonFile, offset: int, new: str) -> str:
    """Return what is missing at an offset: an import, white space, or a part of a list or call."""
    if not new.strip():
        return "missing white space" if "\n" in new else "a missing space"
    undefined = file.used - file.bound
    names = [word for word in _WORD.findall(new) if word in undefined]
    if new.lstrip().startswith(("import ", "from ")):
        return f"the import of {in_backticks(names)}" if names else "a missing import"
    around = ""
    for node in file.nodes:
        if isinstance(node, ast.Call | ast.keyword):
            start, end = file.span(node)
            name = node.arg if isinstance(node, ast.keyword) else file.segment(node.func)
            if start < offset < end and name:
                around = name
    if around:
        return f"a missing part of `{around}`"
    return "a missing line" if "\n" in new else "a missing word or sign"


def _other_values(source: Source, wanted: str) -> Proposals:
    """Yield edits that give a key or an attribute a value of the reference.

    This is a key of YAML, or an attribute of XML.
    """
    known: dict[str, list[str]] = {}
    for setting in _SETTING.finditer(wanted):
        known.setdefault(setting["key"], []).append(setting["value"])
    for setting in _SETTING.finditer(source.text):
        values = dict.fromkeys(known.get(setting["key"], ()))
        if setting["value"] in values:
            continue
        for value in list(values)[:_MAX_VALUES]:
            edit = source.edit(*setting.span("value"), value)
            around = _key_around(source, setting.start()) if setting["key"] == "Value" else ""
            inside = f" of `{around}`" if around else ""
            yield change([edit], f"the value of `{setting['key']}`{inside}")


def _key_around(source: Source, offset: int) -> str:
    """Return the key of YAML in whose mapping an offset is; empty if it is not near."""
    lines = source.text[max(0, offset - _MAX_BEFORE) : offset].split("\n")
    indent = len(lines[-1])
    for line in reversed(lines[:-1]):
        key = line.strip()
        if key.endswith(":") and len(indent_of(line)) < indent:
            return key.removesuffix(":")
    return ""


def _undefined_names(file: PythonFile) -> Proposals:
    """Yield edits that import or correct names, and missing commas.

    The names are undefined, or not as they are used.
    """
    undefined = sorted(file.undefined)
    imported = in_backticks(name for name in undefined if name in USUAL_NAMES)
    yield change(file.with_imports(sorted(file.used)), f"the import of {imported}")
    yield from _meant_names(file)
    yield from _other_imports(file)
    for node in file.nodes:
        # ("a", "b")("c", "d") is two tuples without a comma between them
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Tuple):
            end = file.span(node.func)[1]
            yield change([file.source.edit(end, end, ",")], "a missing comma")


def _meant_names(file: PythonFile) -> Proposals:
    """Yield edits that write the most similar names that have values for undefined ones."""
    names = [node for node in file.nodes if isinstance(node, ast.Name)]
    undefined = file.undefined - {*USUAL_NAMES}
    for word in sorted(undefined)[:_MAX_WORDS]:
        uses = [node for node in names if node.id == word]

        def likeness(other: str, word: str = word) -> float:
            return SequenceMatcher(None, other, word).ratio()

        for other in sorted(file.values, key=likeness, reverse=True)[:_MAX_MEANT]:
            edits = [file.replaced(node, other) for node in uses]
            yield change(edits, f"the spelling of `{word}`")


def _other_imports(file: PythonFile) -> Proposals:
    """Yield edits that import the function glob instead of the module, or the reverse."""
    for statement in file.imports:
        if [alias.name for alias in statement.names] == ["glob"]:
            new = "from glob import glob" if isinstance(statement, ast.Import) else "import glob"
            cause = in_backticks([file.segment(statement)])
            proposal = change([file.replaced(statement, new)], cause)
            # It says better what changes than the difference of the lines.
            yield proposal._replace(rank=-1)


def _unquoted_names(file: PythonFile) -> Proposals:
    """Yield edits that write a name without the quotes around it."""
    constants = [node for node in file.nodes if isinstance(node, ast.Constant)]
    names = [node for node in constants if node.value in file.values]
    for node in names[:_MAX_WORDS]:
        cause = f"`{node.value!s}` in quotes, which is a text"
        yield change([file.replaced(node, str(node.value))], cause)


def _missing_calls(file: PythonFile) -> Proposals:
    """Yield edits that call a method which is only named, such as infp.read."""
    inside = set()  # of a call or of another attribute
    for node in file.nodes:
        if isinstance(node, ast.Call):
            inside.add(node.func)
        elif isinstance(node, ast.Attribute):
            inside.add(node.value)
    attributes = [node for node in file.nodes if isinstance(node, ast.Attribute)]
    outside = [node for node in attributes if node not in inside and isinstance(node.ctx, ast.Load)]
    for method in outside[:_MAX_WORDS]:
        edit = file.replaced(method, f"{file.segment(method)}()")
        yield change([edit], f"`{method.attr}` without ()")


def _missing_brackets(file: PythonFile) -> Proposals:
    """Yield edits that put brackets around actions, or around the file of an entry."""
    groups = [call.args for call in file.calls(_DESCRIPTION) if len(call.args) > 1]
    for item in _items(file):
        if isinstance(item, ast.Tuple) and len(item.elts) > 1:
            groups.append(item.elts[1:])
    for group in groups[:_MAX_WORDS]:
        start = file.span(group[0])[0]
        end = file.span(group[-1])[1]
        edits = [file.source.edit(start, start, "["), file.source.edit(end, end, "]")]
        if len(group) == 1:
            edits = [file.source.edit(start, end, f"[{file.text[start:end]}]")]
        yield change(edits, "missing brackets")


def _missing_slashes(file: PythonFile) -> Proposals:
    """Yield edits that separate a folder from the name that it is added to."""
    for node in file.nodes:
        match node:
            case ast.BinOp(op=ast.Add(), right=ast.Constant(value=str(folder)) as right):
                edit = file.replaced(right, repr(f"/{folder}"))
                yield change([edit], f"`{folder}` without /")


def _find_blank_line(lines: Sequence[str], first: int) -> int:
    """Return the index of the next blank line, or the number of lines."""
    at = first
    while at < len(lines) and lines[at].strip():
        at += 1
    return at


def _indentations(file: PythonFile) -> Proposals:
    """Yield edits that indent lines as those around them, with which Python can read the file.

    These are the line at which Python stops and the one before it, each alone, and with those that
    follow it without a blank line.
    """
    if not file.fault:
        return
    lines = file.text.split("\n")
    stop = file.fault.location.line - 1
    for first in (stop, stop - 1):
        if not 0 <= first < len(lines) or not lines[first].strip():
            continue
        end_of_block = _find_blank_line(lines, first)
        indents = _indents_around(lines, first)
        for indent, end in product(indents, dict.fromkeys((first + 1, end_of_block))):
            rows = range(first, min(end, first + _MAX_AROUND))
            edits = [_indented_line(file, row + 1, indent) for row in rows]
            text = edited(file.text, file.source.path, edits)
            if text is not None and not PythonFile(Source("", text)).fault:
                yield change(edits, "the indentation")


def _indents_around(lines: Sequence[str], row: int) -> list[str]:
    """Return the indentations of the lines around one, the nearest first, and a deeper one."""
    around = [*lines[max(row - _MAX_AROUND, 0) : row], *lines[row + 1 : row + 2]]
    known = dict.fromkeys(_read_indent(line) for line in reversed(around) if line.strip())
    deeper = f"{next(iter(known), '')}    "
    return list(dict.fromkeys((*known, deeper)))


def _indented_line(file: PythonFile, number: int, indent: str) -> Edit:
    start = file.source.offset(number, 1)
    return file.source.edit(start, start + len(_read_indent(file.source.line(number))), indent)


def _read_indent(line: str) -> str:
    return indent_of(line)


def _programs(task: PackageTask, launch: Launch, source: Source) -> Proposals:
    """Yield edits that start another program of a package.

    The program that a check names takes the place of another one, or the reverse.
    """
    wanted = []
    for text in task.given:
        for name in text.split(" or "):
            package, _, executable = name.partition("/")
            wanted.append((package, executable or package))
    wrong = [node for node in launch.nodes if (node.package, node.executable) not in wanted]
    for node in wrong[:_MAX_PATHS]:
        for package, executable in wanted:
            texts = {node.package: package, node.executable: executable}
            is_half_right = (node.package == package) != (node.executable == executable)
            if len(texts) < 2 or not is_half_right:
                continue
            edits = []
            for start, end in _path_offsets(source):
                text = source.text[start:end]
                if texts.get(text, text) != text:
                    edits.append(source.edit(start, end, texts[text]))
            edits.sort(key=lambda edit: abs(edit.line - node.location.line))
            for edit in edits[:_MAX_EDITS]:
                rank = -1 if edit.old == node.executable else 0
                yield change([edit], f"the program `{edit.old}` of a node")._replace(rank=rank)


def _setup_paths(task: PackageTask) -> Proposals:
    """Yield edits of the paths and patterns in setup.py that name no file, or a folder."""
    source = task.source(SETUP)
    setup = task.package.installation
    if not source or not setup or setup.is_cmake:
        return
    wrong = [(named.path.rstrip("/"), named.at.line) for named in setup.stops]
    wrong += [(named.pattern, named.at.line) for named in setup.empty]
    files = list(islice(task.files, _MAX_FILES))
    patterns = []
    for path in files:
        folder = dirname(path)
        ending = splitext(path)[1]
        patterns += [f"{folder}/*", f"{folder}/*{ending}"]
    for path, line in wrong[:_MAX_PATHS]:
        known = files + patterns
        texts = [path]
        if path in task.package.tree.folders:
            above = dirname(path)
            known = [pattern for pattern in patterns if dirname(pattern) in (above, path)]
            texts.append(f"{above}/*")
        for actual in texts:
            for wanted in _similar(actual, known)[:_MAX_EDITS]:
                for edit in _moved(source, actual, wanted, line)[:2]:
                    yield change([edit], f"the path `{edit.old}`")


def _similar(path: str, known: Iterable[str]) -> list[str]:
    """Return known paths, the most similar first."""
    return sorted(
        dict.fromkeys(known),
        key=lambda known_path: -SequenceMatcher(None, known_path, path, autojunk=False).ratio(),
    )


def _launch_paths(task: PackageTask, launch: Launch, source: Source) -> Proposals:
    """Yield edits with which a launch file finds its files.

    That of all together comes first, then those of one path each.
    """
    ways = []
    for reference in launch.references[:_MAX_PATHS]:
        if reference.path is None:
            continue
        path = normpath(reference.path).removeprefix(f"{PREFIX}/")
        if path not in task.package.installed:
            edits_of_path = _edits_of_path(task, source, reference)[:_MAX_EDITS]
            if edits_of_path:
                ways.append(edits_of_path)
    if len(ways) > 1:
        yield _paths_changed([edit for way in ways for edit in way[0]])
    for way in ways:
        yield from map(_paths_changed, way)


def _paths_changed(edits: Sequence[Edit]) -> Proposal:
    """Return the proposal that changes paths in the launch file."""
    paths = [edit.old.strip(_AROUND_TEXTS) for edit in edits if edit.old]
    return change(edits, f"the path{'s' if len(paths) > 1 else ''} {in_backticks(paths)}")


def _targets(task: PackageTask, purpose: str) -> list[str]:
    """Return the paths of the files that a package installs for a purpose.

    They are in the package's share folder.
    """
    share = f"share/{task.package.name}/"
    return [
        path.removeprefix(share)
        for path in task.package.installed
        if path.startswith(share) and path.lower().endswith(_ENDINGS[purpose])
    ]


def _edits_of_path(task: PackageTask, source: Source, named: NamedFile) -> list[list[Edit]]:
    """Return the edits with which a path becomes the one that the file is installed at."""
    actual = named.path or ""
    share = f"{PREFIX}/share/{task.package.name}/"
    for below in _similar(actual.removeprefix(share), _targets(task, named.purpose))[:1]:
        if actual.startswith(PREFIX):
            return [[edit] for edit in _moved(source, actual, share + below, named.location.line)]
        if source.path.endswith(".py"):
            return list(_share_edits(task.package.name, PythonFile(source), actual, below))
    return []


def _share_edits(name: str, file: PythonFile, actual: str, target: str) -> Iterator[list[Edit]]:
    """Yield the edits that put the share folder into a path.

    It replaces a path of one machine, or relative to the working folder.

    The difference to the reference has no answer where the file is built in another way:
    launch-home-path, sensors-launch-home-path.
    """
    share = f"{_SHARE_FUNCTION}({name!r})"
    for node in file.nodes:
        if not isinstance(node, ast.Constant) or not isinstance(node.value, str) or not node.value:
            continue
        at_home = node.value.rstrip("/").replace("~", HOME, 1)
        for path in (at_home, f"{WORKING_FOLDER}/{node.value}"):
            if not f"{actual}/".startswith(f"{path}/"):
                continue
            rest = actual.removeprefix(path).strip("/")
            if not rest:  # the text is the whole path
                new = f"os.path.join({share}, {target!r})"
                imports = file.with_imports([_SHARE_FUNCTION, "os"])
                yield [*imports, file.replaced(node, new)]
                continue
            imports = file.with_imports([_SHARE_FUNCTION])
            edits = [*imports, file.replaced(node, share)]
            if rest != target:
                others = _moved(file.source, rest, target)[:1]
                if not others:
                    continue
                edits += others
            yield edits


def _path_offsets(source: Source) -> Iterator[Span]:
    """Yield the offsets of the texts in a file that a path may be put together from."""
    if not source.path.endswith(".py"):
        yield from (match.span() for match in _PIECE.finditer(source.text))
        return
    yield from ((literal.start, literal.end) for literal in PythonFile(source).literals)


def _moved(source: Source, actual: str, wanted: str, line: int = 1) -> list[Edit]:
    """Return the edits of one text each with which a path becomes the wanted one.

    Those nearest to a line come first.
    """
    distances: dict[Edit, int] = {}  # in lines
    for start, end in islice(_path_offsets(source), _MAX_PIECES):
        piece = source.text[start:end]
        if not piece.strip("./") or piece not in actual:
            continue
        before = max(start - _MAX_CALL, 0)
        is_package = _PACKAGE_ARGUMENT.search(source.text, before, start) is not None
        for new in _replacements(piece, actual, wanted):
            if is_package and ("/" in new or not new):
                continue  # the name of a package has no folders
            edit = source.edit(start, end, new) if new else _without(source, start, end)
            distances.setdefault(edit, abs(edit.line - line))
    return sorted(distances, key=lambda edit: (distances[edit], -edit.line))


def _replacements(piece: str, actual: str, wanted: str) -> Iterator[str]:
    for place in re.finditer(re.escape(piece), actual):
        head = actual[: place.start()]
        tail = actual[place.end() :]
        if len(head) + len(tail) > len(wanted):
            continue
        if wanted.startswith(head) and wanted.endswith(tail):
            new = wanted[len(head) : len(wanted) - len(tail)]
            if new != piece:
                yield new


def _without(source: Source, start: int, end: int) -> Edit:
    """Return the edit that removes a text.

    Where it is an argument, its quotes and comma go with it.
    """
    text = source.text
    quote = text[start - 1 : start]
    is_quoted = quote in "'\"" and text[end : end + 1] == quote
    rest_of_argument = _REST_OF_ARGUMENT.match(text, end + 1)
    if is_quoted and rest_of_argument:
        return source.edit(start - 1, rest_of_argument.end(), "")
    if text.startswith("/", end):
        return source.edit(start, end + 1, "")
    return source.edit(start, end, "")


def _missing_entries(file: PythonFile, like: PythonFile) -> Proposals:
    """Yield edits that add missing entries: one, or all.

    These are what the file makes and does not use, or entries of the reference's list.

    A node of a package of which the file has one is not added: that one is wrong.
    """
    unused = [name for name in file.made if name not in file.used]
    known = set()
    for item in _items(file):
        known |= _codes_of_entry(file, item)
    for call in file.calls("Node"):
        known |= _find_package(file, call)
    missing = [
        like.written(item, file.bound)
        for item in _items(like)
        if known.isdisjoint(_codes_of_entry(like, item) | _find_package(like, item))
    ]
    for codes_to_add in (unused, missing):
        for code in codes_to_add:
            yield from _adding(file, [code])
        if len(codes_to_add) > 1:
            yield from _adding(file, codes_to_add)


def _adding(file: PythonFile, codes: Sequence[str]) -> Proposals:
    edit = _add(file, codes)
    if edit:
        names = set()
        for code in codes:
            names |= file.names_in(code)
        cause = f"a missing part of `{'data_files' if file.calls('setup') else _DESCRIPTION}`"
        if imports := file.with_imports(sorted(names)):
            missing = in_backticks(sorted(names & USUAL_NAMES.keys() - file.bound))
            cause = f"{cause}, and the import of {missing}"
        yield change([edit, *imports], cause)


def _codes_of_entry(file: PythonFile, item: ast.expr) -> set[str]:
    """Return what an entry is recognised by: its code, and that of the files of data_files."""
    codes = {file.plain(item)}
    if isinstance(item, ast.Tuple) and item.elts:
        codes.add(file.plain(item.elts[-1]))
    return codes


def _find_package(file: PythonFile, code: ast.expr) -> set[str]:
    """Return the package of the program that a node starts, if it names one."""
    given = argument(code, "package") if isinstance(code, ast.Call) else None
    if given:
        return {file.plain(given.value)}
    return set()


def _list(file: PythonFile) -> ast.expr | None:
    """Return the list of files to install, or of actions to start."""
    for call in file.calls("setup"):
        entries = argument(call, "data_files")
        if entries:
            return file.meant(entries.value)
        return None
    return next((file.meant(call.args[0]) for call in file.calls(_DESCRIPTION) if call.args), None)


def _items(file: PythonFile) -> list[ast.expr]:
    """Return the entries of the list, and those that are added to it."""
    entries = _list(file)
    items = list(entries.elts) if isinstance(entries, ast.List) else []
    items += [call.args[0] for call in file.calls("add_action") if call.args]
    return [file.meant(item) for item in items[:_MAX_ITEMS]]


def _add(file: PythonFile, codes: Sequence[str]) -> Edit | None:
    """Return the edit that adds code after the last entry.

    The code is in lines of its own if that entry has one.
    """
    entries = _list(file)
    actions = file.calls("add_action")
    if isinstance(entries, ast.List) and not (actions and not entries.elts):
        if not entries.elts:
            _, end = file.span(entries)
            return file.source.edit(end - 1, end - 1, ", ".join(codes))
        start, end = file.span(entries.elts[-1])
        before = ","
    elif actions:
        start, end = file.span(actions[-1])
        owner = file.segment(actions[-1].func)
        codes = [f"{owner}({code})" for code in codes]
        before = ""
    else:
        return None
    indent = indentation(file.text, start)
    space = f"{file.newline}{indent}" if indent else " "
    added = [f"{before}{space}{indented(code, indent, file.newline)}" for code in codes]
    return file.source.edit(end, end, "".join(added))
