"""Lists and dicts of a followed file: what is in them, and what becomes of them where that cannot be told."""

from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from grader.static_python.values import Function, Spot, Steering, TooHard, Unknown, Value

if TYPE_CHECKING:
    from grader.static_python.machine import Machine

MOST_ITEMS = 20_000
MOST_TEXT = 100_000


def extend(machine: "Machine", target: list[Value], value: Value, spot: Spot) -> None:
    """Add what a list is extended by; an unknown part of it stays in its place."""
    items = items_of(value)
    machine.step(len(items or ()) // 64)
    if items is None:
        target.append(value if isinstance(value, Unknown) else Unknown("what is added here is not followed", spot))
    elif machine.unsure is not None:
        target += [machine.unsure] * bool(items)
    elif isinstance(target, Steering):
        lose(target, Unknown("it is steered", spot))
    elif len(target) + len(items) > MOST_ITEMS:
        target.append(Unknown("it grows too long", spot))
    else:
        target += items


def items_of(value: Value) -> list[Value] | None:
    """What a loop over a value goes through; None where that cannot be told."""
    if isinstance(value, list | tuple | dict):
        return list(value)
    if isinstance(value, str):
        return list(value) if len(value) < MOST_ITEMS else None
    return None


def truth(value: Value) -> bool | None:
    """Whether a condition holds; None where only a run would tell."""
    if value is None or isinstance(value, str | int | float | list | tuple | dict):
        if isinstance(value, list | tuple) and value and all(isinstance(each, Unknown) for each in value):
            return None
        if isinstance(value, dict) and "**" in value:
            return None
        return bool(value)
    return True if isinstance(value, PurePosixPath | Function) else None


def is_known(machine: "Machine", items: "list[Value] | tuple[Value, ...]") -> bool:
    """Whether it can be told at which place of a list its items stand."""
    machine.step(len(items) // 64)
    return not any(isinstance(each, Unknown) for each in items)


def store(machine: "Machine", container: Value, key: Value, value: Value, spot: Spot) -> None:
    """Put a value into a dict or list; where it cannot be told which place is meant, nothing of it is known any more."""
    if isinstance(container, dict) and isinstance(key, str | int) and len(container) < MOST_ITEMS:
        container[key] = value
    elif isinstance(container, list) and isinstance(key, int) and is_known(machine, container):
        if -len(container) <= key < len(container):
            container[key] = value
    else:
        lose(container, Unknown("what is put here is not followed", spot))


def remove(machine: "Machine", container: Value, key: Value, unknown: Unknown) -> None:
    """Take something out of a dict or list; `unknown` says why, where it cannot be told what."""
    is_place = isinstance(container, list) and isinstance(key, int) and -len(container) <= key < len(container)
    is_key = isinstance(container, dict) and isinstance(key, str | int) and key in container and "**" not in container
    if (
        machine.unsure is None
        and not isinstance(container, Steering)
        and (is_key or (is_place and is_known(machine, container)))
    ):
        del container[key]
    else:
        lose(container, unknown)


def lose(container: Value, unknown: Unknown) -> None:
    """Forget what is in a list or dict, which is changed in a way that is not followed."""
    if isinstance(container, Steering):
        raise TooHard("a walk through folders that is steered on its way is not followed")
    if isinstance(container, list):
        container[:] = [unknown]
    elif isinstance(container, dict):
        for key in container:
            container[key] = unknown
        container["**"] = unknown


def distinct(values: list[Value]) -> list[Value]:
    """The values of a set: each once."""
    plain = all(isinstance(each, str | int | float | PurePosixPath | None) for each in values)
    return list(dict.fromkeys(values)) if plain else values
