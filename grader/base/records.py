"""Values with named fields, as NamedTuple and frozen dataclasses have them, that are quick to load.

Those compile text for each class: 0.7 and 3.9 million instructions for five fields, of which these
take a tenth, and a command loads some hundred classes. It takes longer to make an instance: what a
submission has hundreds of stays a NamedTuple.
"""

import sys
from collections.abc import Mapping
from dataclasses import MISSING, Field, FrozenInstanceError, field
from operator import itemgetter
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn, Self, dataclass_transform

__all__ = ["Named", "Record"]


def _list_fields(members: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the names that a class with these members annotates."""
    if sys.version_info >= (3, 14):
        from annotationlib import (
            Format,
            call_annotate_function,
            get_annotate_from_class_namespace,
        )

        annotate = get_annotate_from_class_namespace(members)
        return tuple(call_annotate_function(annotate, Format.FORWARDREF)) if annotate else ()
    return tuple(members.get("__annotations__", ()))


if TYPE_CHECKING:
    from typing import NamedTuple as Named
else:

    class _NamedType(type):
        """The type of the named tuples, whose instances have nothing but their fields."""

        def __new__(cls, name: str, bases: tuple[type, ...], members: dict[str, Any]) -> type:
            if not hasattr(bases[0], "_fields"):  # else the fields are those of the base
                names = _list_fields(members)
                members["_field_defaults"] = {key: members[key] for key in names if key in members}
                members |= {key: property(itemgetter(place)) for place, key in enumerate(names)}
                members["__slots__"] = ()
                if names:
                    members["_fields"] = members["__match_args__"] = names
            return super().__new__(cls, name, bases, members)

    class Named(tuple, metaclass=_NamedType):  # noqa: SLOT001  the metaclass says it
        """A tuple with names for its places, which has the methods of a NamedTuple."""

        def __new__(cls, *values: object, **named: object) -> Self:  # noqa: D102
            names = cls._fields
            if named or len(values) != len(names):
                given = cls._field_defaults | dict(zip(names, values, strict=False)) | named
                if given.keys() != {*names} or len(values) > len(names):
                    raise TypeError(f"{cls.__name__} has the fields {', '.join(names)}")
                values = [given[name] for name in names]
            return tuple.__new__(cls, values)

        def __getnewargs__(self) -> tuple[object, ...]:
            return tuple(self)

        def __repr__(self) -> str:
            shown = (f"{name}={value!r}" for name, value in self._asdict().items())
            return f"{type(self).__name__}({', '.join(shown)})"

        def _asdict(self) -> dict[str, object]:
            return dict(zip(self._fields, self, strict=True))

        def _replace(self, **changes: object) -> Self:
            return type(self)(**self._asdict() | changes)


@dataclass_transform(frozen_default=True, eq_default=False, field_specifiers=(field,))
class Record:
    """An object with named fields, which can keep what it computes from them.

    They are set once, unless the class says `frozen=False`. It is equal to itself only.
    `dataclasses.replace` makes a changed copy.
    """

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]] = {}

    def __init_subclass__(cls, *, frozen: bool = True) -> None:
        known = dict(cls.__dataclass_fields__)
        for name in _list_fields(vars(cls)):
            default = vars(cls).get(name, MISSING)
            known[name] = default if isinstance(default, Field) else field(default=default)
            known[name].name = name
        cls.__dataclass_fields__ = known
        if not frozen:
            cls.__setattr__ = object.__setattr__  # type: ignore[method-assign,assignment]

    def __init__(self, *values: Any, **named: Any) -> None:
        names = self.__dataclass_fields__
        given = dict(zip(names, values, strict=False), **named)
        for name, known in names.items():
            if name in given:
                continue
            if known.default_factory is not MISSING:
                given[name] = known.default_factory()
            elif known.default is not MISSING:
                given[name] = known.default
            elif known.init:
                raise TypeError(f"{type(self).__name__} lacks {name}")
        if not given.keys() <= names.keys() or len(values) > len(names):
            raise TypeError(f"{type(self).__name__} has the fields {', '.join(names)}")
        self.__dict__.update(given)
        self.__post_init__()

    def __post_init__(self) -> None:
        """Check the fields, or compute those that are not given."""

    def __setattr__(self, name: str, _value: object) -> NoReturn:
        raise FrozenInstanceError(f"cannot assign to field {name!r}")

    def __delattr__(self, name: str) -> NoReturn:
        raise FrozenInstanceError(f"cannot delete field {name!r}")
