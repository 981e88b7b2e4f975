"""Attributes and calls of a followed file."""

from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from grader.static_python import methods
from grader.static_python.containers import MOST_ITEMS
from grader.static_python.names import attribute_fault
from grader.static_python.operators import KINDS
from grader.static_python.values import Bound, Function, Made, Named, Spot, Unknown, Value, unknown_in

if TYPE_CHECKING:
    from grader.static_python.machine import Machine

_LEAVES = ("sys.exit", "os._exit", "builtins.exit", "builtins.quit")
_NAMING = ("builtins.exec", "builtins.globals", "builtins.locals", "builtins.vars")
_CONSTANTS = {
    "os.sep": "/",
    "os.path.sep": "/",
    "os.linesep": "\n",
    "os.curdir": ".",
    "os.pardir": "..",
    "os.name": "posix",
}


def attribute(machine: "Machine", owner: Value, name: str, spot: Spot) -> Value:
    """The value of an attribute; a method that is about to be called is Bound."""
    match owner:
        case Unknown():
            return owner
        case Named(name="?glob"):
            return Named(f"glob.{name}")
        case Named(name="glob.glob") if name in ("glob", "iglob"):
            machine.fault(
                f"glob is a function here, so glob.{name} is not defined: write glob(...)", spot, AttributeError
            )
            return Named("glob.glob")
        case Named(name=full):
            known = machine.library.get(f"{full}.{name}")
            fault = attribute_fault(full, name) if known is None else None
            if fault is not None:
                machine.fault(fault, spot, AttributeError)
            constant = _CONSTANTS.get(f"{full}.{name}")
            return constant if known is None and constant is not None else Named(f"{full}.{name}")
        case PurePosixPath():
            return methods.path_attribute(owner, name)
        case _:
            return Bound(owner, name)


def call(
    machine: "Machine",
    function: Value,
    args: list[Value],
    kwargs: dict[str, Value],
    spot: Spot,
    *,
    is_unpacked: bool = False,
) -> Value:
    """The value of a call; `is_unpacked` tells that some of its arguments come from a list."""
    match function:
        case Unknown():
            machine.may_fail()
            return function
        case Function() if is_unpacked and unknown_in(args) is not None:
            return Unknown("arguments are unpacked that are not followed", spot)
        case str() | int() | float() | list() | tuple() | dict() | None | PurePosixPath():
            machine.fault(
                f"{KINDS.get(type(function), 'a number')} cannot be called: is there a comma missing before it?", spot
            )
            return Unknown("what is called here is not followed", spot)
        case Function():
            return machine.call_function(function, args, kwargs, spot)
        case Named(name="glob" | "?glob" as name):
            if name == "glob":
                machine.fault("glob is a module here, which cannot be called: write glob.glob(...)", spot)
            return _named(machine, "glob.glob", args, kwargs, spot)
        case Named(name=name):
            return _named(machine, name, args, kwargs, spot)
        case Bound(owner=Made() as owner, name=name) if f"{owner.name}.{name}" in machine.library:
            return machine.library[f"{owner.name}.{name}"](machine, args, kwargs, spot)
        case Bound(owner=Made() as owner, name=name):
            made = Made(f"{owner.name}.{name}", args, kwargs, spot, owner)
            owner.calls.append(made)
            return _make(machine, made)
        case Bound(owner=owner, name=name):
            return methods.call(machine, owner, name, args, kwargs, spot)
        case _:
            return Unknown("what is called here is not followed", spot)


def _named(machine: "Machine", name: str, args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
    known = machine.library.get(name)
    return known(machine, args, kwargs, spot) if known is not None else _make(machine, Made(name, args, kwargs, spot))


def _make(machine: "Machine", made: Made) -> Value:
    if made.name in _LEAVES:
        machine.leave(made)
    if made.name in _NAMING:
        machine.module.names["*"] = Unknown("names may be set here", made.at)
    if not made.name.startswith("builtins.open"):
        machine.may_fail()
    if len(machine.made) < MOST_ITEMS:
        machine.made.append(made)
    if machine.unsure is not None:
        made.kwargs.setdefault("?", machine.unsure)
    return made
