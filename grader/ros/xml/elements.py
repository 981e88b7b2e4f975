"""The names and texts of XML elements, and whether a text is an expected value."""

from grader.base.patterns import on_use
from grader.ros.xml.parsing import Element
from grader.ros.xml.urdf_format import numbers_in

_Scalar = str | float | bool

_MADE_UP = on_use(r"ns\d+")  # a prefix that lxml gives an element that is made, not read
_SLACK = 1e-12  # a tolerance includes its end
_BOOLEANS = {"true": True, "1": True, "false": False, "0": False}
FOREIGN = (
    "gazebo",
    "ros2_control",
    "transmission",
    "sensor",
)  # below <robot>; ROS 2 itself ignores them
_INSTALLED = on_use(
    r"/install/([^/\s]+)/share/\1(?=[/\s]|\Z)"
)  # what the expansion makes of $(find package)


def read_name(element: Element) -> str:
    """Return the name of an element as it is written, with its prefix."""
    return _name_with_prefix(str(element.tag), element)


def _name_with_prefix(name: str, element: Element) -> str:
    space, _, local = name.removeprefix("{").rpartition("}")
    if not space:
        return local
    prefix = next((prefix for prefix, uri in element.nsmap.items() if prefix and uri == space), "")
    return f"{space if not prefix or _MADE_UP.fullmatch(prefix) else prefix}:{local}"


def list_attributes(element: Element) -> list[tuple[str, str]]:
    """Return the attributes of an element, by their names as they are written."""
    return [(_name_with_prefix(str(key), element), str(value)) for key, value in element.items()]


def first_text(element: Element) -> str:
    """Return the text in an element before what else is in it."""
    return (element.text or "").strip()


def text_in(element: Element) -> str:
    """Return the text in an element, without that in its children."""
    return "".join([element.text or "", *(child.tail or "" for child in element)]).strip()


def matches_value(text: str, expected: _Scalar, tolerance: float) -> bool:
    """Return whether a text is an expected value.

    Numbers and lists are compared as numbers, true and 1 are equal.
    """
    wanted = xml_text(expected)
    one = text.strip().lower()
    other = wanted.strip().lower()
    if "true" in (one, other) or "false" in (one, other):
        if one not in _BOOLEANS:
            return one == other
        return _BOOLEANS[one] == _BOOLEANS.get(other)
    actual = numbers_in(text)
    numbers = numbers_in(wanted)
    if actual and numbers:
        pairs = zip(actual, numbers, strict=False)
        return len(actual) == len(numbers) and all(
            abs(a - b) <= tolerance + _SLACK for a, b in pairs
        )
    return text.split() == wanted.split()


def xml_text(value: _Scalar) -> str:
    """Return a value as XML writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return value
    return f"{value:.12g}"


def readable(text: str) -> str:
    """Return a text in which paths of installed packages are as xacro writes them.

    Such a path begins with $(find package).
    """
    return _INSTALLED.sub(r"$(find \1)", text)


def foreign_elements(root: Element) -> list[Element]:
    """Return the elements of <robot> for simulators and controllers."""
    return [child for child in root if child.tag in FOREIGN]


def words_of_foreign(root: Element) -> set[str]:
    """Return the words in the elements for simulators and controllers.

    Among them are names of joints and paths.
    """
    foreign = [inner for element in foreign_elements(root) for inner in element.iter("*")]
    texts = [
        text for inner in foreign for text in (inner.text or "", *map(str, inner.attrib.values()))
    ]
    return {word for text in texts for word in text.split()}
