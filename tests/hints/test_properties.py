"""Hints never cost a point: over random robots with random mistakes, and over random edits of random texts."""

from collections.abc import Mapping

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from grader.lab.authoring.mutants import mutants
from grader.lab.grading.report import Result
from grader.lab.submission.edited import edited_files
from grader.lab.submission.opening import read_submission
from tests.examples import examples
from tests.hints.trials import BASES, applied, graded, hints_for, search_for, with_edits
from tests.rewriting import parse, rewritings

REFERENCE = parse(BASES["reference"].text.encode())
PATH = "my_robot.urdf"


def _passed(results: Mapping[str, Result]) -> set[str]:
    return {name for name, result in results.items() if result.outcome.status == "passed"}


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
    """Each hint alone, and all hints together, applied to the file: what passed passes, the points that are promised are given, and nothing else passes.

    A criterion that is carried has its points. With a hint go the corrections with which the file is graded.
    """
    submission = read_submission(data, identity="student", path=PATH)
    before = graded(submission)
    search = search_for(submission, before)
    for index, found in enumerate([*search.found, None]):
        earlier = [it.edits for it in search.found]
        if found is not None:
            corrected = [it.edits for it in search.slips if it is not found]
            earlier = [*found.after, *(corrected if found not in search.slips else ())]
        needed = tuple(edit for edits in earlier for edit in edits)
        edits = (*needed, *(found.edits if found is not None else ()))
        gains = found.gains if found is not None else {}
        files = edited_files(submission, edits) or {}
        assert files == ({PATH: applied(data, edits)} if edits else {})
        without = graded(with_edits(submission, needed)) if found is not None and needed else before
        after = graded(with_edits(submission, edits))
        assert _passed(before) <= _passed(after)
        assert all(after[name].points >= before[name].points for name in before)
        known = {
            name for it in search.found[:index] for name in it.gains
        }  # promised by hints before it
        assert not gains or _passed(after) - _passed(without) <= known | gains.keys()
        for name, points in gains.items():
            risen = after[name].points - without[name].points
            assert risen == points or (after[name].carried and risen > points)


def test_a_hint_does_not_wait_for_that_of_a_dropped_visual() -> None:
    """What is known of a visual that ROS 2 drops counts in a trial as in the report."""
    base = BASES["reference"]
    assert base.text.count('<cylinder radius="0.1" length="0.05"/>') == 3
    mistakes = (("0.15 0 0.225", "0.15 0 0.2"), (' length="0.05"', ""))
    text = base.text
    for right, wrong in mistakes:
        text = wrong.join(text.rsplit(right, 1))
    hints = hints_for(base.changed(text))
    assert hints.is_full
    of_lidar = [
        hint for hint in hints.found if hint.gains.keys() == {"lidar-frame", "lidar-on-top"}
    ]
    assert [(hint.after, len(hint.edits)) for hint in of_lidar] == [((), 1)]
