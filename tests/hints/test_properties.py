"""Hints never cost a point: over random robots with random mistakes, and over random edits of random texts."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from grader.edits import composed, edited
from grader.mutation.mutants import mutants
from grader.source import Edit, Source
from grader.submission.editing import edited_files
from grader.submission.opening import read_submission
from tests.examples import examples
from tests.hints.trials import BASES, applied, graded, search_for, with_edits
from tests.rewriting import parse, rewritings

REFERENCE = parse(BASES["reference"].text.encode())
PATH = "my_robot.urdf"


@st.composite
def mistaken(draw: st.DrawFn) -> bytes:
    """Draw a robot in any form with one to four mistakes."""
    text = draw(rewritings(REFERENCE)).decode("utf-8", "surrogateescape")
    for _ in range(draw(st.integers(1, 4))):
        text = draw(st.sampled_from(list(mutants(text)))).applied(text)
    data = text.encode("utf-8", "surrogateescape")
    if draw(st.booleans()):
        data = data.replace(b"\n", b"\r\n").replace(b"</robot", b"\t<!-- \xff -->\r\n</robot")
    return data


@pytest.mark.exhaustive
@settings(examples(20), suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(data=mistaken())
def test_hints_gain_what_they_promise_and_lose_nothing(data: bytes) -> None:
    """Each hint alone, and all hints together, applied to the file: what passed passes, and what is promised as well."""
    submission = read_submission(data, identity="student", path=PATH)
    before = graded(submission)
    search = search_for(submission, before)
    for edits, gains in (*((found.edits, found.gains) for found in search.found), (search.final.edits, {})):
        files = edited_files(submission, edits) or {}
        assert files == ({PATH: applied(data, edits)} if edits else {})
        after = graded(with_edits(submission, edits))
        passed = {name for name, result in after.items() if result.outcome.status == "passed"}
        had = {name for name, result in before.items() if result.outcome.status == "passed"}
        assert had <= passed
        assert all(after[name].points >= before[name].points for name in before)
        if gains:
            assert passed - had == set(gains)
            assert gains == {name: after[name].points - before[name].points for name in gains}


_TEXTS = st.lists(st.sampled_from([*"ab <>\t\n\u00e9\udcff", "\r\n"]), max_size=40).map("".join)


@st.composite
def edits_of(draw: st.DrawFn, text: str) -> list[Edit]:
    """Draw edits of a text that do not touch each other; none before a byte-order mark, which editors do not show."""
    first = int(text.startswith("\ufeff"))
    ends = sorted(draw(st.lists(st.integers(first, len(text)), max_size=6, unique=True)))
    spans = list(zip(ends[::2], ends[1::2], strict=False))
    return [Source(PATH, text).edit(start, end, draw(_TEXTS)) for start, end in spans]


@examples(20)
@given(data=st.data(), text=_TEXTS, mark=st.sampled_from(("", "\ufeff")))
def test_composed_edits_do_what_edits_do_one_after_the_other(data: st.DataObject, text: str, mark: str) -> None:
    """Also where the later touch the earlier, in any line breaks, and nothing else changes."""
    text = mark + text
    first = data.draw(edits_of(text))
    middle = edited(text, PATH, first)
    assert middle is not None
    second = data.draw(edits_of(middle))
    last = edited(middle, PATH, second)
    assert edited(text, PATH, composed(text, PATH, first, second)) == last
    assert _bytes(middle) == applied(_bytes(text), first)
    assert last is not None
    assert _bytes(last) == applied(_bytes(text), composed(text, PATH, first, second))


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogateescape")
