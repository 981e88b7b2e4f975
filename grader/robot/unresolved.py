"""What xacro leaves open of a part of a robot, and that reading it raises NotDecided."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple, NoReturn

from grader.errors import MissingElement, NotDecided
from grader.source import LazyLocation
from grader.text import quoted


class UnresolvedPart(NamedTuple):
    """A part of a link, joint or material that xacro leaves open: the reason, which is empty where xacro refuses it."""

    reason: str
    location: LazyLocation

    def check(self) -> None:
        """Raise NotDecided if the part cannot be determined."""
        if self.reason:
            raise NotDecided(self.reason)


# The parts of an element that are unresolved: "@name" for its attribute, "visual" for something in a <visual>, "" for
# more children than are known. Empty for a plain URDF.
UnresolvedParts = Mapping[str, UnresolvedPart]
_KEYS = {"name": "@name", "type": "@type", "visuals": "visual", "collisions": "collision"}


def open_part(parts: UnresolvedParts, field: str, *, is_absent: bool = False) -> UnresolvedPart | None:
    """Return why a field of a link or joint is open; if the file does not give it, it may be among unknown children."""
    return parts.get(_KEYS.get(field, field)) or (parts.get("") if is_absent else None)


class Guarded:
    """A part of a robot. A field that is not set is open: reading it raises NotDecided.

    Where xacro refuses the text of the field, MissingElement.
    """

    __slots__ = ()

    if not TYPE_CHECKING:  # pragma: no branch

        def __getattr__(self, name: str) -> NoReturn:
            if name not in self.__dataclass_fields__:
                raise AttributeError(name)
            part = open_part(self.unresolved, name, is_absent=True)
            for one in (part,) if part else self.unresolved.values():
                one.check()
            what, owner = _KEYS.get(name, name), getattr(self, "child", self.name)
            message = f"xacro cannot expand the {what} of {type(self).__name__.lower()} {quoted(self.name)}"
            raise MissingElement(what, owner, message=message, location=part and part.location)
