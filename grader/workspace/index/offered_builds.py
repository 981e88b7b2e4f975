"""What may be written at a place of package.xml, CMakeLists.txt, xacro and other markup."""

import re
from collections.abc import Iterator

from grader.base.names import first_part
from grader.base.patterns import on_use
from grader.ros.known.cmake_words import cmake_words
from grader.ros.launch.frontend import attributes_of_element, elements_in
from grader.ros.xacro.tags import HANDLERS
from grader.ros.xml.urdf_format import TAGS
from grader.workspace.index.offered_names import defined, find_packages
from grader.workspace.index.offers import (
    BEST,
    GOOD,
    POSSIBLE,
    UNLIKELY,
    Offer,
    Offers,
    offers,
    package_at,
)
from grader.workspace.index.typed_places import TypedPlace
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.used_packages import used_packages

_MACRO = "xacro:macro"
_MAX_TEXT = 512 * 1024  # bytes of a file
_DEPENDS = on_use(r"depend>\s*([\w-]+)\s*</")
_FOUND = on_use(r"find_package\(\s*([\w-]+)")
_TARGETS = on_use(r"add_(?:executable|library)\(\s*([\w-]+)")
_ROBOT = (".urdf", ".xacro")
_ENDINGS = {"rosidl_generate_interfaces": (".msg", ".srv", ".action"), "install": ("",)}


# --- package.xml and CMake


def find_dependencies(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the packages that package.xml may name, first those that files use and it lacks."""
    package = package_at(workspace, place.path)
    declared = [*_DEPENDS.findall(place.text), package.name if package else ""]
    for use in used_packages(workspace, package) if package else ():
        if use.name not in declared:
            rank = BEST if place.holder.name in (use.tag, "depend") else GOOD
            yield Offer(use.name, "used here", f"at {use.location.file_and_line}", rank)
    for offer in find_packages(workspace, place):
        if offer.name not in declared:
            yield offer._replace(rank=offer.rank + 1)


def find_found_packages(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield what find_package() may find, first what package.xml names and CMake does not find."""
    package = package_at(workspace, place.path)
    manifest = package.manifest if package else None
    before = place.text[: place.offset - len(place.typed)]
    listed = _FOUND.findall(before + place.text[place.offset :])
    declared = [each.name for each in manifest.declared] if manifest is not None else []
    yield from offers([name for name in declared if name not in listed], "in package.xml")
    for offer in find_packages(workspace, place):
        if offer.name not in listed:
            yield offer._replace(rank=offer.rank + 1)


def find_needed_targets(_: Workspace, place: TypedPlace) -> Offers:
    """Yield what a target may need: first the target, then packages and libraries."""
    is_first = place.holder.slot == "0" and "target" in place.holder.name
    for name in _FOUND.findall(place.text):
        rank = UNLIKELY if is_first else BEST
        if place.holder.name == "target_link_libraries":
            is_of_messages = name.endswith(("_msgs", "_srvs", "_interfaces"))
            target = f"${{{name}_TARGETS}}" if is_of_messages else f"{name}::{name}"
            yield Offer(target, "target", rank=rank + int(name.startswith("ament_")))
        else:
            yield Offer(name, "package", rank=rank)
    yield from offers(_TARGETS.findall(place.text), "target", BEST if is_first else POSSIBLE)


def find_targets(_: Workspace, place: TypedPlace) -> Offers:
    """Yield the targets of a CMakeLists.txt."""
    return offers(_TARGETS.findall(place.text), "target")


def find_sources(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the files or folders that a command of CMake may take, first those that none names."""
    package = package_at(workspace, place.path)
    endings = _ENDINGS.get(place.holder.name, (".cpp", ".cc", ".cxx", ".c"))
    paths = package.tree.files if package else ()
    listed = [path for path in paths if path.endswith(endings)]
    if place.holder.slot == "DIRECTORY":
        listed = sorted({first_part(path) for path in paths if "/" in path})
    for path in listed:
        is_named = re.search(rf"[\s(]{re.escape(path)}[\s/)]", place.text)
        yield Offer(path, "in the package", rank=int(is_named is not None))


def find_commands(_: Workspace, _place: TypedPlace) -> Offers:
    """Yield the commands of CMake and ament, first those that most files have."""
    words = cmake_words()
    usual = ("find_package", "add_executable", "install", "target_link_libraries", "ament_package")
    yield from offers(usual, "command")
    yield from offers((*words.harmless, *words.named_targets), "command", GOOD)
    for name, provider in words.providers.items():
        yield Offer(name, f"command of {provider}", rank=GOOD)


# --- xacro


_DEFINED = on_use(r"<xacro:macro\s(?P<given>(?:[^<>\"']|\"[^\"<]*\"|'[^'<]*')*+)>")
_NAME = on_use(r"\bname\s*=\s*[\"'](?:xacro:)?(?P<value>[^\"'<]*)[\"']")
_PARAMETERS = on_use(r"\bparams\s*=\s*[\"'](?P<value>[^\"<]*)[\"']")
# A default may hold spaces in quotes, brackets or an expression.
_PARAMETER = on_use(
    r"(?:[^\s'\"\[{(]|'[^']*+'?|\"[^\"]*+\"?|\[[^\]]*+\]?|\{[^}]*+\}?|\([^)]*+\)?)+"
)


def find_macros(workspace: Workspace) -> Iterator[tuple[str, str, list[str]]]:
    """Yield the macros of a workspace: file, name, and parameters as they are written."""
    for path in workspace.tree.files:
        data = workspace.tree.read(path, _MAX_TEXT) if path.endswith(".xacro") else None
        for match in _DEFINED.finditer((data or b"").decode("utf-8", "replace")):
            name = _NAME.search(match["given"])
            given = _PARAMETERS.search(match["given"])
            written = given["value"] if given else ""
            if name:
                yield path, name["value"], _PARAMETER.findall(written)


def _name_parameter(written: str) -> str:
    """Return the name of a parameter of a macro, without its default."""
    return re.split(":=|=|:", written)[0].lstrip("*")


def find_properties(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield what an expression may name: parameters of the macro around it, and properties."""
    for level in place.levels:
        if level.name == _MACRO:
            written = _PARAMETER.findall(level.given.get("params", ""))
            yield from offers(map(_name_parameter, written), "parameter of the macro")
    yield from defined(workspace, place, "xacro property")


# --- Elements and attributes


def find_elements(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the elements that may be in the one around a place, and macros."""
    if not place.path.endswith(_ROBOT):
        yield from offers(elements_in(place.holder.name), f"in <{place.holder.name}>")
        return
    if place.path.endswith(".xacro"):
        for path, macro, parameters in find_macros(workspace):
            is_meant = place.before and {*place.holder.given} <= {*map(_name_parameter, parameters)}
            text = " ".join(parameters)
            yield Offer(f"xacro:{macro}", f"macro of {path}", text, BEST if is_meant else GOOD)
        yield from offers(HANDLERS, "element of xacro", POSSIBLE)
    yield from _elements_of_robot(place)


def _elements_of_robot(place: TypedPlace) -> Offers:
    """Yield the elements of the one around a place; a macro may have what a robot has."""
    for level in place.levels:
        if level.name == _MACRO or not level.name.startswith("xacro:"):
            parent = TAGS.get("robot" if level.name == _MACRO else level.name)
            for child in parent.children if parent else ():
                yield Offer(child, f"in <{level.name}>")
            return


def find_attributes(workspace: Workspace, place: TypedPlace) -> Offers:
    """Yield the attributes that an element may have and has not."""
    return (one for one in _attributes(workspace, place) if one.name not in place.holder.given)


def _attributes(workspace: Workspace, place: TypedPlace) -> Offers:
    tag = place.holder.name
    for path, macro, parameters in find_macros(workspace):
        for written in parameters if f"xacro:{macro}" == tag else ():
            yield Offer(_name_parameter(written), f"parameter in {path}", written)
    if not place.path.endswith(_ROBOT):
        for name, is_needed in attributes_of_element(tag):
            yield Offer(name, f"of <{tag}>", rank=int(not is_needed))
    elif tag in TAGS:
        yield from _attributes_of_robot(tag)


def _attributes_of_robot(tag: str) -> Offers:
    """Yield the attributes of an element of a URDF in their usual order."""
    for number, (name, about) in enumerate(TAGS[tag].attributes.items()):
        parts = " ".join(about.parts) if len(about.parts) > 1 else ""
        unit = f"in {about.unit}" if about.unit not in ("", "1") else ""
        last = "needed" if about.default is None else f"default: {about.default}"
        yield Offer(name, f"{parts} {unit}".strip(), last, number)
