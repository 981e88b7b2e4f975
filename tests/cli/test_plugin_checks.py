"""Plug-in checks: a faulty one is an error of its package, never a result."""

import json
from pathlib import Path

import pytest

from tests.classroom.class_runs import HOSTILE_RUBRIC
from tests.command_line import run

pytestmark = pytest.mark.usefixtures("hostile_checks")
FAULTY = "the check behaves of the package hostile-checks is faulty: "


def robot(folder: Path, name: str) -> str:
    """Write a URDF whose robot's name tells the check how to behave."""
    path = folder / "my_robot.urdf"
    path.write_text(f"<robot name='{name}'><link name='base_link'/></robot>")
    return str(path)


FAULTS = {
    "exits_with_0": "SystemExit: 0",
    "exits": "SystemExit: out",
    "raises": "RuntimeError: as asked",
    "raises_unusually": "Unusual: as asked",
    "returns_nothing": "it returned NoneType, not an Outcome",
    "returns_text": "it returned str, not an Outcome",
    "returns_a_tuple": "it returned tuple, not an Outcome",
    "returns_another_status": "it returned the status 'fine'; a check returns passed, failed or pending",
    "returns_skipped": "it returned the status 'skipped'; a check returns passed, failed or pending",
    "returns_no_message": "it returned an Outcome with an invalid message",
    "raises_without_words": "Wordless",
    "returns_nan": "it returned an Outcome with an invalid measured",
    "returns_objects": "it returned an Outcome with an invalid expected",
    "returns_a_value_of_no_report": "it returned an Outcome with an invalid measured",
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_faulty_check_is_errored(tmp_path: Path, name: str) -> None:
    """Whatever it raises or returns, the criterion is errored, the message names the package, and the exit code is 3."""
    requested = ("grade", robot(tmp_path, name), "--rubric", HOSTILE_RUBRIC, "--format", "json")
    for done in (run(requested), run((*requested, "--fail-under", "0"))):
        assert (done.returncode, b"Traceback" in done.stderr) == (3, False)
        loads, behaves = json.loads(done.stdout)["results"]
        assert (loads["status"], loads["points"]) == ("passed", 1)
        assert (behaves["status"], behaves["message"]) == ("errored", FAULTY + FAULTS[name])


INVALID = {
    "without_annotation": "hostile_checks.without_annotation) cannot be used: its argument at_least has no annotation",
    "without_subject": "hostile_checks.without_subject) cannot be used: its argument robot has no annotation",
    "without_names": "hostile_checks.without_names) cannot be used: its argument *values: float cannot be given by name",
    "leaves_when_loaded": "hostile_exit.check) cannot be used: SystemExit: 0",
    "is_not_there": "hostile_checks.nothing) cannot be used: AttributeError: ",
}


@pytest.mark.parametrize("check", INVALID)
def test_an_invalid_check_is_a_mistake_of_the_rubric(tmp_path: Path, check: str) -> None:
    """The message has the rubric's line, and names package, function and argument; nothing is graded."""
    lab = tmp_path / "lab.toml"
    lab.write_text(
        Path(HOSTILE_RUBRIC).read_text().replace('check = "behaves"', f'check = "{check}"')
    )
    for command in (("grade", robot(tmp_path, "fine"), "--rubric", lab), ("rubric", "check", lab)):
        done = run(command)
        assert (done.returncode, done.stdout, done.stderr.count(b"\n")) == (2, b"", 1)
        assert b"lab.toml:20: the check " in done.stderr
        assert f"{check} of the package hostile-checks ({INVALID[check]}".encode() in done.stderr


def test_the_list_of_checks_names_the_faulty_ones() -> None:
    """They hide none of the others."""
    done = run(("rubric", "checks"))
    assert done.returncode == 0
    assert (
        b"without_annotation\n  the check without_annotation of the package hostile-checks"
        in done.stdout
    )
    assert b"shows_box" in done.stdout
    assert b"\nbehaves (hostile-checks)\n" in done.stdout


def test_the_schema_has_the_usable_ones() -> None:
    """An editor completes the names of all, and knows the arguments of those that can be used."""
    done = run(("schema", "rubric"))
    assert (done.returncode, done.stderr) == (0, b"")
    schema = json.loads(done.stdout)
    named = schema["properties"]["criterion"]["items"]["properties"]["check"]["enum"]
    assert {"behaves", "without_annotation", "with_endless_default"} <= set(named)
    assert "without_annotation" not in schema["$defs"]
    assert schema["$defs"]["with_endless_default"]["properties"] == {"at_most": {"type": "number"}}
