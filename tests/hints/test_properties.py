"""Hints never cost a point: over random robots with random mistakes, and over random edits of random texts."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from grader.mutation.mutants import mutants
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
    for index, found in enumerate([*search.found, None]):
        earlier = search.found[:index] if found is None or found.is_late else []
        edits = tuple(edit for it in (*earlier, found) if it is not None for edit in it.edits)
        gains = found.gains if found is not None else {}
        files = edited_files(submission, edits) or {}
        assert files == ({PATH: applied(data, edits)} if edits else {})
        after = graded(with_edits(submission, edits))
        passed = {name for name, result in after.items() if result.outcome.status == "passed"}
        had = {name for name, result in before.items() if result.outcome.status == "passed"}
        assert had <= passed
        assert all(after[name].points >= before[name].points for name in before)
        known = {name for it in search.found[:index] for name in it.gains}  # promised by hints before it
        if gains:
            assert passed - had - known == set(gains) - known
            assert gains == {name: after[name].points - before[name].points for name in gains}
