"""Attributes and calls of any value."""

from pathlib import PurePosixPath

from grader.static_python.evaluation import Evaluation
from grader.static_python.imports import attribute_error
from grader.static_python.methods import call_method, path_attribute
from grader.static_python.operators import type_name
from grader.static_python.positions import Position
from grader.static_python.values import BoundMethod, Call, Function, QualifiedName, Unknown, Value

_EXITS = ("sys.exit", "os._exit", "builtins.exit", "builtins.quit")
_BINDS_NAMES = ("builtins.exec", "builtins.globals", "builtins.locals", "builtins.vars")
_CONSTANTS = {
    "os.sep": "/",
    "os.path.sep": "/",
    "os.linesep": "\n",
    "os.curdir": ".",
    "os.pardir": "..",
    "os.name": "posix",
}


def attribute(evaluation: Evaluation, owner: Value, name: str, at: Position) -> Value:
    """Return the value of an attribute; a method is returned as a BoundMethod."""
    match owner:
        case Unknown():
            return owner
        case QualifiedName(name="?glob"):  # used without an import: an attribute shows that the module is meant
            return QualifiedName(f"glob.{name}")
        case QualifiedName(name="glob.glob") if name in ("glob", "iglob"):
            message = f"glob is a function here, so glob.{name} is not defined: write glob(...)"
            evaluation.error(message, at, AttributeError)
            return owner
        case QualifiedName(name=module):
            full = f"{module}.{name}"
            if full in evaluation.functions:
                return QualifiedName(full)
            error = attribute_error(module, name)
            if error is not None:
                evaluation.error(error, at, AttributeError)
            return _CONSTANTS.get(full, QualifiedName(full))
        case PurePosixPath():
            return path_attribute(owner, name, at)
        case _:
            return BoundMethod(owner, name)


def call_value(evaluation: Evaluation, function: Value, call: Call) -> Value:
    """Return the value of a call of any value. The call gets its name here; one that is not evaluated is recorded."""
    match function:
        case Unknown():
            evaluation.may_fail()
            return function
        case Function():
            return evaluation.call_function(function, call)
        case QualifiedName(name=name):
            if name == "glob":
                evaluation.error("glob is a module here and cannot be called: write glob.glob(...)", call.at)
            call.name = "glob.glob" if name in ("glob", "?glob") else name
        case BoundMethod(owner=Call() as owner, name=name):
            call.name, call.owner = f"{owner.name}.{name}", owner
            if call.name not in evaluation.functions:
                owner.method_calls.append(call)
        case BoundMethod(owner=owner, name=name):
            return call_method(evaluation, owner, name, call)
        case _:
            if type_name(function):
                evaluation.error(
                    f"{type_name(function)} cannot be called: is there a comma missing before it?", call.at
                )
            return Unknown("this call is not supported", call.at)
    evaluate = evaluation.functions.get(call.name)
    if evaluate is not None:
        return evaluate(evaluation, call)
    if call.name in _EXITS:
        evaluation.exit(call)
    if call.name in _BINDS_NAMES:
        evaluation.module.names["*"] = Unknown("names may be bound here", call.at)
    return evaluation.record(call)
