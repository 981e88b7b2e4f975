"""The messages, services and actions of well-known packages, by release.

They are the tables of known/packages, each of which is read when it is needed.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cache
from typing import get_args

from grader.base.grouping import StringsByName
from grader.ros.interfaces.interface_file import read_type
from grader.ros.interfaces.interface_types import (
    FieldType,
    Interface,
    InterfaceField,
    InterfaceKind,
    InterfaceSection,
)
from grader.ros.known.package_tables import interface_table
from grader.ros.known.releases import RELEASES, Release, is_before

_ABSENT = "absent"
MORE_CONSTANTS = "*"  # among the constants of a type: others whose names are not known
# The last release whose branches were read whole; of later ones only what a changelog says.
_READ: Release = "kilted"
_OF_SEVERAL = FieldType("", "")  # of a field that has other types in other releases


@cache
def known_interfaces(
    package: str, releases: Collection[Release] = ()
) -> Mapping[str, Interface] | None:
    """Return the interfaces of a package by their names, msg.Twist.

    Their fields are those that they have in any of some releases, or of all. The result is None
    for a package that is not known.
    """
    table = interface_table(package)
    if table is None:
        return None
    interfaces = {}
    for kind in get_args(InterfaceKind):
        for name, row in table.get(kind, {}).items():
            forms = [form for form in _forms(row, releases or RELEASES) if form != _ABSENT]
            if forms:
                interfaces[f"{kind}.{name}"] = _merged(kind, package, forms)
    return interfaces


def is_open_in(releases: Collection[Release]) -> bool:
    """Return whether one of some releases may have types that the tables do not have."""
    return any(is_before(_READ, release) for release in releases)


def find_change(package: str, name: str, releases: Collection[Release]) -> str:
    """Return since or until when there is a type, in words: `before Lyrical`.

    It is a type that none of some releases has. The result is empty for one that one of them has,
    and one that no release has.
    """
    kind, _, short = name.partition(".")
    row = (interface_table(package) or {}).get(kind, {}).get(short, _ABSENT)
    if isinstance(row, str) or not releases or {*_forms(row, releases)} != {_ABSENT}:
        return ""
    having = [release for release in RELEASES if {*_forms(row, (release,))} != {_ABSENT}]
    if not having:
        return ""
    first = min(releases, key=RELEASES.index)
    if is_before(first, having[0]):
        return f"before {having[0].title()}"
    return f"from {RELEASES[RELEASES.index(having[-1]) + 1].title()} on"


def _forms(row: str | StringsByName, releases: Collection[Release]) -> Iterator[str]:
    """Yield the texts of a type in some releases, each once."""
    if isinstance(row, str):
        yield row
        return
    said = set()
    text = _ABSENT
    for release in RELEASES:
        text = row.get(release, text)
        if release in releases and text not in said:
            said.add(text)
            yield text


def _merged(kind: InterfaceKind, package: str, forms: Iterable[str]) -> Interface:
    """Return an interface with the fields of all its forms."""
    sections: list[InterfaceSection] = []
    for form in forms:
        for number, text in enumerate(form.split("---")):
            section = _section(text, package)
            if number < len(sections):
                section = _with(sections[number], section)
                sections[number] = section
            else:
                sections.append(section)
    return Interface(kind, tuple(sections))


def _section(text: str, package: str) -> InterfaceSection:
    fields, _, constants = text.partition("|")
    section_fields = {}
    for written in fields.split(";"):
        if written.strip():
            type_text, name = written.split()
            section_fields[name] = InterfaceField(name, read_type(type_text, package))
    return InterfaceSection(section_fields, frozenset(constants.split()))


def _with(one: InterfaceSection, other: InterfaceSection) -> InterfaceSection:
    fields = {**one.fields, **other.fields}
    for name in one.fields.keys() & other.fields.keys():
        if one.fields[name].type != other.fields[name].type:
            fields[name] = InterfaceField(name, _OF_SEVERAL)
    return InterfaceSection(fields, one.constants | other.constants)
