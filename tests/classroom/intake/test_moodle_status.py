"""The lateness in the Status of a Moodle worksheet."""

from pathlib import Path

import pytest

from grader.classroom.intake.roster_file import read_roster
from grader.classroom.intake.roster_values import days_late

SUBMITTED = "Submitted for grading"
GERMAN = "Zur Bewertung abgegeben"


@pytest.mark.parametrize(
    ("status", "days"),
    [
        (SUBMITTED, 0),
        ("No submission", 0),
        ("No submission - Assignment is overdue by: 3 days 2 hours", 0),
        (f"{SUBMITTED} - Graded - Extension granted until: Friday, 27 November 2026, 11:59 PM", 0),
        (f"{SUBMITTED} - 1 day 2 hours late", 1 + 2 / 24),
        (f"{SUBMITTED} - 1 day late - Graded", 1),
        (f"{SUBMITTED} - 2 days 1 hour late - Submission changes not allowed", 2 + 1 / 24),
        (f"{SUBMITTED} - 5 hours 1 min late", 5 / 24 + 1 / 1440),
        (f"{SUBMITTED} - 10 mins 30 secs late", 10 / 1440 + 30 / 86400),
        (f"{SUBMITTED} - 1 sec late", 1 / 86400),
        (f"{SUBMITTED} - 1 year 2 days late", 367),
        ("Draft (not submitted) - 3 days 4 hours late", 3 + 4 / 24),
        (f"{GERMAN} - 1 Tag 2 Stunden später - Bewertet", 1 + 2 / 24),
        ("Remis pour évaluation - En retard de 3 jours 1 heure", 3 + 1 / 24),
        ("Remis pour évaluation - En retard de 10 min 30 s", 10 / 1440 + 30 / 86400),
        ("Enviado para calificar - 2 días 5 horas después", 2 + 5 / 24),
        ("Consegnato per la valutazione - 2 giorni 5 ore in ritardo", 2 + 5 / 24),
        ("Enviado para avaliação - 1 dia 3 horas atrasado", 1 + 3 / 24),
        ("Ingestuurd voor beoordeling - 1 dag 2 uren laat", 1 + 2 / 24),
        ("Ingestuurd voor beoordeling - 1 dag 2 uren te laat", 1 + 2 / 24),
        ("Przesłane do oceny - 1 dzień 2 godz. spóźnienia", None),  # a language that is not known
        (f"{SUBMITTED} - a while late", None),
        (f"{SUBMITTED} - 3 moons late", None),
        ("提交 - 1 天后", None),
    ],
)
def test_statuses(status: str, days: float | None) -> None:
    """The time after the deadline in days; 0 for any status without one, None for what is not understood."""
    assert days_late(status) == (None if days is None else pytest.approx(days))


HEADER = "Identifier,Full name,Email address,Status"


@pytest.mark.parametrize(
    ("columns", "values", "late"),
    [
        ("", "", (True, 1.25)),
        (",extension", ",1", (True, 0.25)),
        (",extension", ",2", (False, 0.0)),
        (",due", ",2026-09-02", (True, None)),  # Moodle measures from another deadline
        (",late", ",no", (False, None)),
        (",late", ",3", (True, 3.0)),
        (",submitted", ",2026-09-02T10:00", (None, None)),
    ],
)
def test_a_worksheet_as_roster(
    tmp_path: Path, columns: str, values: str, late: tuple[bool | None, float | None]
) -> None:
    """The Status is the lateness, minus the roster's extension; what the instructor has written takes precedence."""
    worksheet = tmp_path / "worksheet.csv"
    row = f"Participant 11,Ann Ash,ash@example.org,{SUBMITTED} - 1 day 6 hours late{values}"
    worksheet.write_text(f"{HEADER}{columns}\n{row}\n")
    (entry,) = read_roster(worksheet).entries
    assert (entry.is_late, entry.days_late) == late


def test_a_status_that_is_not_understood(tmp_path: Path) -> None:
    """One note for all lines says what to do; a column Status in another roster says nothing."""
    worksheet = tmp_path / "worksheet.csv"
    rows = [f"Participant {number},N{number},n{number}@example.org,Przesłane - 1 dzień spóźnienia" for number in (1, 2)]
    worksheet.write_text("\n".join((HEADER, *rows)))
    roster = read_roster(worksheet)
    assert [(entry.is_late, entry.days_late) for entry in roster.entries] == [(None, None)] * 2
    assert roster.notes == (
        (
            f"line 2 of {worksheet}: the status 'Przesłane - 1 dzień spóźnienia' does not say clearly how late the submission is"
            " (2 lines): add a column `late` with `no` or a number of days"
        ),
    )
    worksheet.write_text("id,status\nash,enrolled 2 days late\n")
    assert read_roster(worksheet).notes == ()
    assert read_roster(worksheet).entries[0].days_late is None
