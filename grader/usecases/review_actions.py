"""What the page of a review asks for: marks, undo, and moves in the queue."""

import json
from collections.abc import Mapping
from typing import Any

from grader.classroom.review.queue import ITEM_STATES, ReviewFilter
from grader.classroom.review.session import ReviewSession
from grader.classroom.typed_names import read_points
from grader.usecases.review import move

# What the page sends besides `do`, with the type of each value.
_ACTIONS: Mapping[str, Mapping[str, type]] = {
    "mark": {"points": str, "comment": str, "shown": int, "item": str},
    "filter": {"criterion": str, "section": str, "state": str},
    "find": {"student": str},
    **{name: {} for name in ("next", "back", "undo", "keep", "split")},
}


def read_action(body: bytes) -> dict[str, Any] | None:
    """Return the action that the page has sent, or None if it is malformed."""
    try:
        sent = json.loads(body)
    except (ValueError, RecursionError):
        return None
    wanted = _ACTIONS.get(str(sent.get("do"))) if isinstance(sent, dict) else None
    if wanted is None or not all(type(sent.get(name)) is kind for name, kind in wanted.items()):
        return None
    return sent if "state" not in wanted or sent["state"] in ITEM_STATES else None


def follow(session: ReviewSession, sent: Mapping[str, Any]) -> str:
    """Execute an action, and return a notice about it. Raises InputError and NewerMarkError."""
    match sent["do"]:
        case "mark":
            criterion = session.current_item().result.criterion
            points = read_points(sent["points"], criterion.id, criterion.points)
            session.mark(points, sent["comment"].strip(), sent["shown"])
            session.next()
        case "find":
            session.find(sent["student"].strip())
        case "filter":
            session.show_only(ReviewFilter(*(sent[name] for name in ReviewFilter._fields)))
        case name:
            notice = move(session, name)
            return f"{notice[:1].upper()}{notice[1:]}"
    return ""
