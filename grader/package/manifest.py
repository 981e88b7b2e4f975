"""package.xml: what a package says of itself (REP 127, 140 and 149)."""

from dataclasses import dataclass

from grader.package import catalogue
from grader.problems import Problem
from grader.source import Location, Source
from grader.xml.parsing import Element, XMLSyntaxError, parse_xml

_NEEDED = ("name", "version", "description", "maintainer", "license")
_FORMATS = ("2", "3")


@dataclass(frozen=True, slots=True)
class Manifest:
    """What a package.xml says. `name` is None where it cannot be read; `build_type` is what colcon takes where none is given."""

    source: Source
    name: str | None
    build_type: str
    problems: tuple[Problem, ...]
    name_location: Location
    type_location: Location
    unread: str = ""  # why the file could not be read at all: too large, damaged


def read_manifest(data: bytes, path: str) -> Manifest:
    """Read a package.xml; never raises: what is wrong with it is among its problems."""
    source = Source(path, data.decode("utf-8", "replace"))
    start = Location(path, 1, 1)
    try:
        root = parse_xml(data)
    except (XMLSyntaxError, ValueError) as error:
        line, column = getattr(error, "position", (1, 1))
        words = " ".join(str(getattr(error, "msg", error)).split(", line ")[0].split())
        problem = Problem(catalogue.BAD_MANIFEST, f"package.xml is not readable as XML: {words}",
                          Location(path, max(line, 1), max(column, 1)))  # fmt: skip
        return Manifest(source, None, "", (problem,), start, start)
    if root.tag != "package":
        problem = Problem(catalogue.BAD_MANIFEST, f"the root of package.xml is <{root.tag}>, not <package>", start)
        return Manifest(source, None, "", (problem,), start, start)
    return _manifest(root, source)


def _manifest(root: Element, source: Source) -> Manifest:
    places = {element: index for index, element in enumerate(root.iter("*"))}
    problems: list[Problem] = []

    def where(element: Element) -> Location:
        try:
            return source.tag(places[element])
        except IndexError:  # the text is in some encoding in which its tags are not seen
            return Location(source.path, 1, 1)

    for tag in _NEEDED:
        found = root.findall(tag)
        if not found or not any((each.text or "").strip() for each in found):
            message = f"package.xml has no <{tag}>" if not found else f"<{tag}> of package.xml is empty"
            problems.append(Problem(catalogue.INCOMPLETE_MANIFEST, message, where(found[0]) if found else where(root)))
        for element in found:
            if tag == "maintainer" and not (element.get("email") or "").strip():
                message = "<maintainer> of package.xml has no email"
                problems.append(Problem(catalogue.INCOMPLETE_MANIFEST, message, where(element)))
            text = f"{element.text or ''} {element.get('email', '')}".lower()
            if tag in ("license", "maintainer", "description") and ("todo" in text):
                problems.append(
                    Problem(catalogue.STILL_TO_DO, f"<{tag}> of package.xml is still to do", where(element))
                )
    version = root.get("format", "1")
    if version not in _FORMATS:
        message = f"package.xml is of format {version[:20]}; ROS 2 packages are written in format 3"
        problems.append(Problem(catalogue.OLD_FORMAT, message, where(root)))
    name = root.find("name")
    kinds = [each for each in root.findall("export/build_type") if not each.get("condition")]
    kind = kinds[0] if kinds else None
    return Manifest(
        source,
        (name.text or "").strip() or None if name is not None else None,
        (kind.text or "").strip() if kind is not None else "catkin",
        tuple(problems),
        where(name) if name is not None else where(root),
        where(kind) if kind is not None else where(root),
    )
