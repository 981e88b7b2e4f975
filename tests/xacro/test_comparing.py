"""The comparison with xacro finds every kind of difference, so that agreement means something."""

from types import SimpleNamespace
from typing import Any

import pytest
from lxml import etree

from grader.base.problems import Problem
from grader.base.source import Location
from grader.ros.xacro.xacro_problems import XACRO_REDEFINED
from tests.xacro import comparing
from tests.xacro.documents.document import Dependence, Document, robot
from tests.xacro.oracle import Accepted, Refused

pytestmark = pytest.mark.slow

_ACCEPTED = Accepted(
    '<robot name="r"><link name="a"><visual><geometry><sphere radius="1.0"/></geometry></visual></link></robot>'
)
_REFUSED = Refused("no")


def difference(
    monkeypatch: pytest.MonkeyPatch,
    expected: Accepted | Refused,
    text: str = _ACCEPTED.text,
    *,
    effect: str = "",
    reason: str = "",
    warned: tuple[Problem, ...] = (),
    undetermined: Dependence = "never",
) -> str | None:
    """Return the difference of xacro's result and an expansion with this text, problem and reason."""
    problems = (
        [SimpleNamespace(message="refused", kind=SimpleNamespace(effect=effect))] if effect else []
    )
    reasons = [SimpleNamespace(reason=reason)] if reason else []
    found: Any = SimpleNamespace(
        root=etree.fromstring(text), problems=problems, undetermined=reasons, warnings=warned
    )
    monkeypatch.setattr(comparing, "expand", lambda _document: found)
    return comparing.difference(Document(robot(""), undetermined=undetermined), expected)


def test_what_xacro_accepts(monkeypatch: pytest.MonkeyPatch) -> None:
    """An accepted document is expanded to the same elements, without a refusal and without an open question."""
    assert difference(monkeypatch, _ACCEPTED) is None
    assert difference(monkeypatch, _ACCEPTED, effect="loads") is None
    assert "refuses it" in str(difference(monkeypatch, _ACCEPTED, effect="rejects"))
    assert "cannot determine" in str(difference(monkeypatch, _ACCEPTED, reason="open"))
    for old, new in (
        ("1.0", "1"),
        ("link", "joint"),
        ("radius", "r"),
        ("<visual>", "<visual>text"),
        ("<sphere", "<box/><sphere"),
    ):
        text = _ACCEPTED.text.replace(old, new)
        assert difference(monkeypatch, _ACCEPTED, text) is not None, new


def test_what_xacro_warns_of(monkeypatch: pytest.MonkeyPatch) -> None:
    """What xacro writes to stderr is a warning, and nothing else is."""
    warned = (Problem(XACRO_REDEFINED, "pi", Location("a.xacro", 1, 1)),)
    assert difference(monkeypatch, _ACCEPTED._replace(has_warned=True), warned=warned) is None
    assert "stderr" in str(difference(monkeypatch, _ACCEPTED._replace(has_warned=True)))
    assert "stderr" in str(difference(monkeypatch, _ACCEPTED, warned=warned))


def test_what_xacro_refuses(monkeypatch: pytest.MonkeyPatch) -> None:
    """A refused document is refused; a warning or an open question is not enough."""
    assert difference(monkeypatch, _REFUSED, effect="rejects") is None
    assert "does not" in str(difference(monkeypatch, _REFUSED))
    assert "does not" in str(difference(monkeypatch, _REFUSED, effect="loads"))
    assert "does not" in str(difference(monkeypatch, _REFUSED, reason="open"))


@pytest.mark.parametrize("expected", [_ACCEPTED, _REFUSED])
def test_what_depends_on_the_outside(
    monkeypatch: pytest.MonkeyPatch, expected: Accepted | Refused
) -> None:
    """What depends on the outside has to be open, or can be; an accepted document is not refused in either case."""
    assert difference(monkeypatch, expected, reason="open", undetermined="always") is None
    assert difference(monkeypatch, expected, reason="open", undetermined="perhaps") is None
    assert difference(monkeypatch, expected, undetermined="always") is not None
    assert (difference(monkeypatch, expected, undetermined="perhaps") is None) == (
        expected == _ACCEPTED
    )
    refused = difference(
        monkeypatch, expected, reason="open", effect="rejects", undetermined="perhaps"
    )
    assert (refused is None) == (expected == _REFUSED)
