"""Labels: the task and step that a name refers to, in any spelling."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.lab.documents.headings import matches, read_label
from tests.work import limited_work

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    ("text", "task", "steps"),
    [
        ("Task1_Step8.png", 1, {8}),
        ("task 1 step 8", 1, {8}),
        ("T1S8.jpg", 1, {8}),
        ("t1_s8", 1, {8}),
        ("lab6_task1_q8.PNG", 1, {8}),
        ("TASK-01-STEP-08", 1, {8}),
        ("Task 2, Question 5: the frames", 2, {5}),
        ("task1/step8/camera.png", 1, {8}),
        ("Task1/Task2_Step3", 2, {3}),
        ("step 8", None, {8}),
        ("Tast1_Step8", 1, {8}),
        ("tsk1stp8", 1, {8}),
        ("Task 1 Steps 8 9", 1, {8, 9}),
        ("task1_8", 1, {8}),
        ("Task 1 - 8.", 1, {8}),
        ("step8_step9", None, {8, 9}),
        ("Task 1", 1, set()),
        ("task", None, set()),
        ("Lab6", None, set()),
        ("8", None, set()),
        ("", None, set()),
        ("Screenshot 2026-03-01 at 10.15.12", None, set()),
        ("task 20260301 step 8", None, {8}),
        ("ｔask１", None, set()),
        ("Taskforce 1 stepwise 8", None, set()),
        ("no8", None, {8}),
        ("Aufgabe 1", 1, set()),
        ("Aufgabe 2, Schritt 6", 2, {6}),
        ("Übung 1", None, set()),
    ],
)
def test_labels(text: str, task: int | None, steps: set[int]) -> None:
    """Task and steps are read from a name."""
    found = read_label(text)
    assert (found.task, set(found.steps)) == (task, steps)


@pytest.mark.parametrize(
    ("expected", "found", "known", "is_it"),
    [
        ("task 1 step 8", "Task1_Step8.png", None, True),
        ("task 1 step 8", "T1S8", None, True),
        ("task 1 step 8", "step8", 1, True),
        ("task 1 step 8", "step8", None, False),
        ("task 1 step 8", "step8", 2, False),
        ("task 1 step 8", "task2_step8", 1, False),
        ("task 1 step 8", "task1_step18", None, False),
        ("task 1 step 8", "task1", None, False),
        ("task 1 step 8", "task1_steps_7_8", None, True),
        ("step 8", "task 3 step 8", None, True),
        ("task 1", "task1_step8", None, True),
        ("task 1", "anything", 1, True),
        ("task 1", "task 2", 1, False),
        ("camera", "my camera frame", None, True),
        ("cam", "camera.png", None, True),
        ("camera", "cam.png", None, False),
        ("lidar frame", "the lidar_frame picture", None, True),
        ("lidar frame", "frame lidar", None, False),
        ("lidar frame", "lidar", None, False),
        ("", "camera", None, False),
        ("", "", None, False),
        ("camera", "", None, False),
    ],
)
def test_meaning(expected: str, found: str, known: int | None, is_it: bool) -> None:
    """A name matches if task, steps and words agree."""
    assert matches(read_label(expected), read_label(found), known) is is_it


@given(st.text(max_size=60), st.text(max_size=60), st.none() | st.integers())
def test_any_text(expected: str, found: str, known: int | None) -> None:
    """Any two texts can be compared."""
    assert matches(read_label(expected), read_label(found), known) in (True, False)


@given(
    st.integers(1, 99),
    st.integers(1, 99),
    st.sampled_from(["task{}_step{}", "T{}S{}", "Task {} - Question {}", "{0}/task{0}/step{1}"]),
)
def test_numbers_are_found_in_every_spelling(task: int, step: int, spelling: str) -> None:
    """In every spelling the numbers are found."""
    found = read_label(spelling.format(task, step))
    assert (found.task, set(found.steps)) == (task, {step})


@pytest.mark.parametrize(
    "text",
    ["task " * 100_000, "1 " * 300_000, "t1s" * 200_000, "²" * 10_000, "task" + "1" * 100_000],
)
def test_long_texts(text: str) -> None:
    """A long text takes no longer than a short one."""
    with limited_work(80_000):
        matches(read_label(text), read_label(text))
