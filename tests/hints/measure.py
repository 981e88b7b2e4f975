"""Measure the hints: python -m tests.hints.measure [--count 100] [--seed 1] [--bad] [BASE...], or --samples, or --students.

Every mutant of the correct robots that loses points is searched. For each mutation it prints how many have a verified hint
(`hint`), how many get full marks with all edits (`full`), how many are then the same robot (`same`) or the same text (`undo`), and how many
have a hint that changes the line of the mistake (`there`).
"""

import argparse
from collections.abc import Iterable, Iterator
from random import Random
from statistics import mean
from time import perf_counter
from typing import NamedTuple

from grader.lab.authoring.mutants import mutants
from grader.lab.hints.hinting import message
from tests.hints.behaviour import behaviour, differences
from tests.hints.students import MISTAKES
from tests.hints.trials import BASES, Base, Hints, hints_for, text_after
from tests.samples import SAMPLES


class Marks(NamedTuple):
    """Whether there is a hint, and all lead to full marks, to the same robot, to the same text; and one is at the mistake."""

    has_hint: bool
    is_full: bool
    is_same: bool
    is_undo: bool
    is_there: bool


class Verdict(NamedTuple):
    """What the hints for one mutant achieve."""

    mutation: str
    label: str
    hints: Hints
    is_undo: bool
    differs: tuple[str, ...]
    milliseconds: float
    place: tuple[str, int] = ("", 0)  # path and line of the mistake, where they are known

    @property
    def marks(self) -> "Marks":
        """What the hints achieve, from little to much."""
        full = self.hints.is_full
        lines = {(edit.path, edit.line) for found in self.hints.found for edit in found.edits}
        return Marks(
            bool(self.hints.found),
            full,
            full and not self.differs,
            self.is_undo,
            self.place in lines,
        )

    @property
    def told(self) -> str:
        """The hints in lines."""
        lines = [
            f"{self.mutation} | {self.label} | lost {len(self.hints.lost)}: {' '.join(self.hints.lost[:4])}"
        ]
        for found in self.hints.found:
            lines.append(f"     + {message(found, 'edit', self.hints.submission, ())}")
            lines.append(f"       {found.proposal.cause}")
        left = f"     left: {' '.join(self.hints.left[:6])}" if not self.hints.is_full else ""
        return "\n".join([*lines, left or f"     differs: {', '.join(self.differs)}"])


def verdicts(base: Base, count: int | None, random: Random) -> Iterator[Verdict]:
    """Yield the verdict on those of `count` mutants of a base that lose points; of all without a count."""
    expected = behaviour(base.submission)
    those = list(mutants(base.text))
    for mutant in those if count is None else random.sample(those, min(count, len(those))):
        submission = base.changed(mutant.applied(base.text))
        start = perf_counter()
        hints = hints_for(submission)
        milliseconds = (perf_counter() - start) * 1e3
        if hints.lost:
            differs = differences(expected, behaviour(hints.fixed))
            is_undo = hints.is_full and text_after(base, hints) == base.text
            label, place = f"{base.name} {mutant.id}", (base.path, mutant.line)
            yield Verdict(
                mutant.mutation, label, hints, is_undo, tuple(differs), milliseconds, place
            )


def of_samples() -> Iterator[Verdict]:
    """Yield the verdict on every mistake sample."""
    for sample in SAMPLES.values():
        submission = sample.open()
        start = perf_counter()
        hints = hints_for(submission, sample.rubric)
        if hints.lost:
            yield Verdict("sample", sample.name, hints, False, (), (perf_counter() - start) * 1e3)


def of_students() -> Iterator[Verdict]:
    """Yield the verdict on every mistake of students; its label says what a teacher would say."""
    for mistake in MISTAKES.values():
        submission = mistake.base.changed(mistake.text)
        start = perf_counter()
        hints = hints_for(submission)
        milliseconds = (perf_counter() - start) * 1e3
        differs = differences(behaviour(mistake.base.submission), behaviour(hints.fixed))
        is_undo = hints.is_full and text_after(mistake.base, hints) == mistake.base.text
        yield Verdict(
            "student",
            f"{mistake.name} | {mistake.teacher}",
            hints,
            is_undo,
            tuple(differs),
            milliseconds,
        )


def table(found: Iterable[Verdict]) -> Iterator[str]:
    """Yield the shares by mutation, the worst first, and of all."""
    mutations: dict[str, list[Verdict]] = {}
    for verdict in found:
        mutations.setdefault(verdict.mutation, []).append(verdict)
        mutations.setdefault("all", []).append(verdict)
    yield f"{'mutation':22}{'count':>7}{'hint':>8}{'full':>8}{'same':>8}{'undo':>8}{'there':>8}{'steps':>8}{'ms':>8}"
    for mutation, those in sorted(
        mutations.items(), key=lambda pair: mean(found.marks.is_full for found in pair[1])
    ):
        shares = "".join(
            f"{100 * mean(found.marks[index] for found in those):8.1f}" for index in range(5)
        )
        steps, time = (
            mean(found.hints.steps for found in those),
            mean(found.milliseconds for found in those),
        )
        yield f"{mutation:22}{len(those):7}{shares}{steps:8.0f}{time:8.1f}"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--samples", action="store_true")
    parser.add_argument("--students", action="store_true")
    parser.add_argument("--count", type=int, help="mutants of each base (default: all)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--bad", action="store_true", help="show those without full marks or another robot"
    )
    parser.add_argument("--all", action="store_true", help="show every hint")
    options = parser.parse_args()
    random = Random(options.seed)
    chosen = (base for base in BASES.values() if not options.names or base.name in options.names)
    mutated = (verdict for base in chosen for verdict in verdicts(base, options.count, random))
    found = list(
        of_samples() if options.samples else of_students() if options.students else mutated
    )
    for verdict in found:
        if options.all or (options.bad and not (verdict.marks.is_full and not verdict.differs)):
            print(verdict.told)
    print("\n".join(table(found)))


if __name__ == "__main__":
    main()
