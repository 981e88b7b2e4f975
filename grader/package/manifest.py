"""package.xml: name, build type and problems of a package (REP 127, 140 and 149)."""

from collections.abc import Iterator
from dataclasses import dataclass

from grader.package import package_problems as kinds
from grader.problems import Problem
from grader.reuse import reuse
from grader.source import Location, Source
from grader.xml.parsing import XmlFault, XmlFile


@dataclass(frozen=True, slots=True)
class Manifest:
    """The content of a package.xml. `name` is None where it cannot be read; `build_type` is by default colcon's."""

    source: Source
    name: str | None
    build_type: str
    problems: tuple[Problem, ...]
    name_location: Location
    type_location: Location
    unread: str = ""  # why the file was not read at all: too large, damaged
    dependencies: frozenset[str] = frozenset()  # the packages that it depends on, in any way


@reuse
def read_manifest(data: bytes, path: str) -> Manifest:
    """Read a package.xml. Never raises: errors are among the problems."""
    source = Source(path, data.decode("utf-8", "replace"))
    start = Location(path, 1, 1)
    try:
        file = XmlFile(data, source)
    except XmlFault as fault:
        problem = Problem(kinds.BAD_MANIFEST, f"package.xml is not readable as XML: {fault}", fault.location)
        return Manifest(source, None, "", (problem,), start, start)
    root = file.root
    if root.tag != "package":
        problem = Problem(kinds.BAD_MANIFEST, f"the root of package.xml is <{root.tag}>, not <package>", start)
        return Manifest(source, None, "", (problem,), start, start)
    name = root.find("name")
    kind = next((element for element in root.findall("export/build_type") if not element.get("condition")), None)
    return Manifest(
        source,
        (name.text or "").strip() or None if name is not None else None,
        (kind.text or "").strip() if kind is not None else "catkin",
        tuple(_problems(file)),
        file.location(name if name is not None else root),
        file.location(kind if kind is not None else root),
        dependencies=frozenset((it.text or "").strip() for it in root.iterchildren("*") if it.tag.endswith("depend")),
    )


def _problems(file: XmlFile) -> Iterator[Problem]:
    root = file.root
    for tag in ("name", "version", "description", "maintainer", "license"):
        found = root.findall(tag)
        if not any((element.text or "").strip() for element in found):
            message = f"<{tag}> of package.xml is empty" if found else f"package.xml has no <{tag}>"
            yield Problem(kinds.INCOMPLETE_MANIFEST, message, file.location(found[0] if found else root))
        for element in found:
            email = element.get("email") or ""
            if tag == "maintainer" and not email.strip():
                message = "<maintainer> of package.xml has no email"
                yield Problem(kinds.INCOMPLETE_MANIFEST, message, file.location(element))
            is_text = tag in ("license", "maintainer", "description")
            if is_text and "todo" in f"{element.text or ''} {email}".lower():
                yield Problem(kinds.STILL_TO_DO, f"<{tag}> of package.xml is still TODO", file.location(element))
    version = root.get("format", "1")
    if version not in ("2", "3"):
        message = f"package.xml has format {version[:20]}; ROS 2 packages use format 3"
        yield Problem(kinds.OLD_FORMAT, message, file.location(root))
