"""Expand hostile documents in this process, and print what happened to each: `python -m tests.xacro.hostile_run 1`.

A process of its own, because an audit hook cannot be removed, and because a crash or an endless loop then is a failed test.
"""

import json
import os
import resource
import sys
from typing import Any

from grader.ros.python.budget import READING
from tests.work import TooMuchWork, limited_work
from tests.xacro.comparing import expand
from tests.xacro.documents.document import Document, named, robot, shown
from tests.xacro.hostile import HOSTILE, LARGE
from tests.xacro.hostile_costs import COSTS

CONTROL = "control"
"""The name of a harmless document, during which a file is opened."""
LIMIT = 30_000_000  # calls
PARTS, LIMIT_OF_PARTS = READING // 4, 9_000_000  # of the budget, and the calls that they allow
_HARMLESS = {
    "compile",
    "object.__getattr__",
    "sys._getframe",
    "gc.collect",
    "signal.signal",
    "builtins.id",
}

_events: list[str] = []
_is_watched = False


def _watch(event: str, arguments: tuple[Any, ...]) -> None:
    if _is_watched and event not in _HARMLESS:
        _events.append(f"{event} {arguments!r}"[:200])


def _memory() -> int:
    """Return the largest size of this process so far, in megabytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024


class _Opening(list[str]):
    """Paths; when one is added a file is opened, as the grader never does."""

    def append(self, path: str, /) -> None:
        super().append(path)
        open(os.devnull).close()


def _watched(
    document: Document, paths: list[str], parts: int = READING, limit: int = LIMIT
) -> dict[str, Any]:
    """Return what happened while a document was expanded; `paths` receives those that it reads."""
    global _is_watched
    _events.clear()
    memory = _memory()
    outcome = "expanded"
    try:
        with limited_work(limit):
            _is_watched = True
            found = expand(document, paths, parts)
            _is_watched = False
        if found.undetermined or any(
            problem.kind.effect == "rejects" for problem in found.problems
        ):
            outcome = "refused"
    except TooMuchWork:
        outcome = "too much work"
    except BaseException as error:  # noqa: BLE001 - MemoryError, RecursionError and SystemExit are results
        outcome = f"raised {error!r}"[:200]
    _is_watched = False
    return {
        "outcome": outcome,
        "megabytes": _memory() - memory,
        "events": list(_events),
        "paths": paths[:100],
    }


def main(step: int) -> None:
    """Print a line of JSON for each document, or for every third and so on: first its name, then what happened."""
    files = {"urdf/a.yaml": "a: !degrees 1\n", "urdf/b.xacro": robot("")}
    warm = (
        named("y", "${xacro.load_yaml('a.yaml')}")
        + '<xacro:include filename="b.xacro"/>'
        + shown("${y.a + sin(1)}", "${1 +}", "$(eval 1)")
    )
    expand(Document(robot(warm), files))  # everything is imported before the events count
    expand(Document("<robot"))
    sys.addaudithook(_watch)
    print(json.dumps([CONTROL, _watched(Document(robot(warm), files), _Opening())]), flush=True)
    for name, document in list({**HOSTILE, **LARGE}.items())[::step]:
        print(json.dumps([name, _watched(document, [])]), flush=True)
    for name, document in list(COSTS.items())[::step]:
        print(
            json.dumps([f"cost-{name}", _watched(document, [], PARTS, LIMIT_OF_PARTS)]), flush=True
        )


if __name__ == "__main__":
    main(int(sys.argv[1]))
