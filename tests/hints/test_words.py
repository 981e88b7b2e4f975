"""Hints say what is wrong in the words of the file, and name other edits that are as good."""

import pytest

from grader.lab.grading.grade import grade
from grader.lab.hints.edits import FoundHint, Proposal
from grader.lab.hints.hinting import hinted, message
from grader.lab.hints.package_edits import package_proposals
from grader.lab.submission.edited import content, with_files
from grader.lab.submission.submission import Submission
from tests.samples import LAB6, reference

pytestmark = pytest.mark.slow
RVIZ, LAUNCH = "rviz/my_robot.rviz", "launch/my_robot_rviz.launch.py"


def changed(path: str, old: str, new: str) -> Submission:
    """Return the reference with another text in a file."""
    text = (content(reference(), path) or b"").decode()
    assert old in text
    return with_files(reference(), {path: text.replace(old, new, 1).encode()})


@pytest.mark.parametrize(
    ("path", "old", "new", "words"),
    [
        (RVIZ, "/robot_description", "/robot", "the value of `Value` of `Description Topic`"),
        (RVIZ, "Fixed Frame: base_footprint", "Fixed Frame: x", "the value of `Fixed Frame`"),
    ],
)
def test_a_cause_names_the_setting(path: str, old: str, new: str, words: str) -> None:
    """A value with its key, that of a topic also with the key around it."""
    submission = changed(path, old, new)
    results = hinted(grade(LAB6, submission), submission, "cause").report.results
    messages = [result.hint.message for result in results if result.hint is not None]
    assert any(words in one for one in messages), messages


def test_a_cause_has_both_quotes_of_a_text() -> None:
    """What is too much in a launch file is shown whole."""
    submission = changed(LAUNCH, "package='rviz2'", "package='rviz2', namespace='a'")
    assert submission.package is not None
    wanted = [
        (criterion.check.about.looks_at, criterion.arguments)
        for criterion in LAB6.criteria
        if criterion.part == "task2"
    ]
    made = package_proposals(submission.package, reference().package, wanted)
    causes = {proposal.cause for proposals in made for proposal in proposals}
    assert "`namespace='a'` in the launch file" in causes


def test_an_edit_that_is_as_good_is_named() -> None:
    """Where it is at another place; not twice."""
    submission = changed(RVIZ, "/robot_description", "/robot")
    source = submission.source(RVIZ)
    assert source is not None
    start = source.text.index("/robot")
    edit, other = (source.edit(at, at + 6, "x") for at in (start, 0))
    hint = FoundHint(Proposal((edit,), "one"), {}, equal=Proposal((other,), "another"))
    line = source.text[:start].count("\n") + 1
    text = f"Check {RVIZ}, line {line}: one"
    shown = message(hint, "cause", submission, ())
    assert shown == f"{text}; or check {RVIZ}, line 1: another."
    same = hint._replace(equal=hint.proposal)
    assert message(same, "cause", submission, ()) == f"{text}."
