"""What the tools of ROS 2 refuse in a package.xml: colcon then builds the package as plain Python.

The rules, their order and their words are those of catkin_pkg 1.1, `parse_package` and
`Package.validate`.
"""

import re
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence

from grader.base.grouping import Strings
from grader.base.patterns import on_use
from grader.base.text import enumerated
from grader.ros.xml.parsing import Element

# What is refused, in the words of catkin_pkg, and the element that is meant.
_Refusal = tuple[str, Element]
_Refusals = Iterator[_Refusal]
_Children = Mapping[str, Sequence[Element]]

_NAME = on_use(r"[a-zA-Z0-9][a-zA-Z0-9_-]*\n?")
_VERSION = on_use(r"[0-9]+\.[0-9]+\.[0-9]+\n?")
_EMAIL = on_use(
    r"[-a-zA-Z0-9_%+]+(\.[-a-zA-Z0-9_%+]+)*@[-a-zA-Z0-9%]+(\.[-a-zA-Z0-9%]+)*\.[a-zA-Z]{2,}\n?",
    re.ASCII,
)
_VERSIONS = ("version_lt", "version_lte", "version_eq", "version_gte", "version_gt")
_DEPENDS = ("build_depend", "buildtool_depend", "test_depend", "conflict", "replace")
_DEPENDS_BY_FORMAT = {
    1: ("run_depend",),
    2: ("build_export_depend", "buildtool_export_depend", "depend", "exec_depend", "doc_depend"),
}
# The kinds of dependencies that <depend> and <run_depend> stand for.
_STANDS_FOR = {
    "depend": ("build_depend", "build_export_depend", "exec_depend"),
    "run_depend": ("build_export_depend", "exec_depend"),
}


def find_refusals(root: Element) -> _Refusals:
    """Yield why the tools of ROS 2 refuse a package.xml with this root, and where.

    Nothing is yielded if they accept it.
    """
    children = defaultdict(list)
    for element in root.iterchildren("*"):
        children[read_tag(element)].append(element)
    version = _read_format(root)
    if version is None:
        yield f"Unable to handle package.xml format version '{root.get('format')}'", root
        version = 3
    for tag in ("name", "version", "description"):
        if len(children.get(tag, ())) != 1:
            yield (
                f'The manifest must contain exactly one "{tag}" tag',
                (children.get(tag) or [root])[-1],
            )
    if len(children.get("export", ())) > 1:
        yield 'The manifest must not contain more than one "export" tags', children["export"][1]
    yield from _redundant_dependencies(children, version)
    yield from _unknown_parts(root, children, version)
    yield from _invalid_texts(root, children)
    yield from _own_dependencies(children, version)


def read_tag(element: Element) -> str:
    """Return the tag of an element as it is written: catkin_pkg ignores namespaces."""
    name = str(element.tag).rpartition("}")[2]
    if element.prefix:
        return f"{element.prefix}:{name}"
    return name


def read_text(element: Element) -> str:
    """Return the text directly in an element."""
    pieces = [element.text, *(child.tail for child in element)]
    return "".join(piece for piece in pieces if piece).strip(" \n\r\t")


def read_email(person: Element) -> str:
    """Return the email of a maintainer or author, without quotes.

    A quoted git configuration puts quotes around it.
    """
    return (person.get("email") or "").strip("\"'")


def _read_format(root: Element) -> int | None:
    try:
        number = int(root.get("format", "1"))
    except ValueError:
        return None
    return number if number in (1, 2, 3) else None


def _tags_of_dependencies(version: int) -> Strings:
    return _DEPENDS + _DEPENDS_BY_FORMAT[min(version, 2)]


def _make_key(dependency: Element) -> tuple[str | None, ...]:
    """Return what makes two dependencies equal."""
    return (read_text(dependency), *(dependency.get(name) for name in (*_VERSIONS, "condition")))


def _redundant_dependencies(children: _Children, version: int) -> _Refusals:
    general = "depend"
    tags = _STANDS_FOR["depend"]
    words = "The generic dependency on '{}' is redundant with: {}"
    if version == 1:
        general = "test_depend"
        tags = ("build_depend", "run_depend")
        words = 'The test dependency on "{}" is redundant with: {}'
    counts = {tag: Counter(map(_make_key, children.get(tag, ()))) for tag in tags}
    for dependency in children.get(general, ()):
        key = _make_key(dependency)
        same = [tag for tag in tags if counts[tag][key]]
        if same:
            yield words.format(read_text(dependency), ", ".join(same)), dependency
        if version != 1:
            for tag in tags:
                counts[tag][key] += 1


def _known_attributes(version: int) -> dict[str, Strings]:
    """Return the tags that a package.xml of a format may have, each with its attributes."""
    of_condition = ("condition",) if version == 3 else ()  # since REP 149
    known = {
        "name": (),
        "version": ("compatibility",),
        "description": (),
        "maintainer": ("email",),
        "license": ("file",) if of_condition else (),
        "url": ("type",),
        "author": ("email",),
        "export": (),
    }
    known |= dict.fromkeys(_tags_of_dependencies(version), _VERSIONS + of_condition)
    if of_condition:
        known |= dict.fromkeys(("group_depend", "member_of_group"), of_condition)
    return known


def _unknown_parts(root: Element, children: _Children, version: int) -> _Refusals:
    """Yield what has no place in a package.xml: tags, attributes, and elements in others."""
    known = _known_attributes(version)
    yield from _unknown_attributes(root, ("format",))
    for tag, elements in children.items():
        if tag not in known:
            yield (
                (
                    f"The manifest (with format version {version}) must not contain the "
                    f"following tags: {tag}"
                ),
                elements[0],
            )
            continue
        for element in elements:
            yield from _unknown_attributes(element, known[tag])
            inner = [read_tag(child) for child in element.iterchildren("*")]
            if inner and tag not in ("description", "export"):
                yield (
                    f'The "{tag}" tag must not contain the following children: {enumerated(inner)}',
                    element,
                )


def _unknown_attributes(element: Element, known: Sequence[str]) -> _Refusals:
    unknown = [name for name in map(str, element.attrib) if name not in known and "}" not in name]
    if unknown:
        words = (
            f'The "{read_tag(element)}" tag must not have the following attributes: '
            f"{enumerated(unknown)}"
        )
        yield words, element


def _invalid_texts(root: Element, children: _Children) -> _Refusals:
    """Yield what `Package.validate` refuses.

    This is an invalid name, version or email, or a text or element that is missing.
    """
    for element in children.get("name", ()):
        yield from _invalid_names(element)
    for element in children.get("version", ()):
        yield from _invalid_versions(element)
    for element in children.get("description", ()):
        if not read_text(element) and not len(element):
            yield "Package description must not be empty", element
    for element in children.get("license", ()):
        if not read_text(element).strip():
            yield "The license tag must neither be empty nor only contain whitespaces", element
    for element in (*children.get("maintainer", ()), *children.get("author", ())):
        yield from _invalid_emails(element)
    if "maintainer" not in children:
        yield "The package must declare at least one maintainer", root
    if "license" not in children:
        yield 'The package node must contain at least one "license" tag', root


def _invalid_names(element: Element) -> _Refusals:
    if not _NAME.fullmatch(read_text(element)):
        yield f'Package name "{read_text(element)}" does not follow naming conventions', element


def _invalid_versions(element: Element) -> _Refusals:
    version = read_text(element)
    compatibility = element.get("compatibility")
    if not version:
        yield "Package version must not be empty", element
    elif not _VERSION.fullmatch(version):
        yield (
            (
                f'Package version "{version}" does not follow version conventions: write three '
                "numbers, as 0.1.0"
            ),
            element,
        )
    if compatibility and not _VERSION.fullmatch(compatibility):
        yield (
            f"Package compatibility version '{compatibility}' does not follow version conventions",
            element,
        )


def _invalid_emails(person: Element) -> _Refusals:
    email = person.get("email")
    tag = read_tag(person)
    if email is None and tag == "maintainer":
        yield 'The "maintainer" tag must have the attribute "email"', person
    elif email is not None and not _EMAIL.fullmatch(read_email(person)):
        yield f'Invalid email "{email}" for person "{read_text(person)}"', person


def _own_dependencies(children: _Children, version: int) -> _Refusals:
    """Yield the dependencies of a package on itself, and on a group that it is a member of."""
    names = {read_text(element) for element in children.get("name", ())}
    for tag in _tags_of_dependencies(version):
        if tag in ("conflict", "replace"):
            continue
        for element in children.get(tag, ()):
            if read_text(element) in names:
                kinds = enumerated([f'"{kind}"' for kind in _STANDS_FOR.get(tag, (tag,))])
                yield (
                    f"The package must not {kinds} on a package with the same name as this package",
                    element,
                )
    groups = {read_text(element) for element in children.get("member_of_group", ())}
    for element in children.get("group_depend", ()):
        if read_text(element) in groups:
            words = (
                "The package must not 'group_depend' on a package which it also declares to be "
                "a member of"
            )
            yield words, element
