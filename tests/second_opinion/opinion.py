"""A second opinion on the geometric criteria of a rubric: status, measured value, and whether a mistake is carried forward."""

import tomllib
from math import radians
from pathlib import Path
from typing import Any, NamedTuple

from tests.second_opinion.facts import FACTS
from tests.second_opinion.posed import Missing, Posed, Undecided, Unsure
from tests.second_opinion.robot import Robot

RUBRICS = Path(__file__).parents[2] / "rubrics"


class Opinion(NamedTuple):
    """What a criterion should say; a status `carried` is a failure with its points."""

    status: str
    measured: Any = None
    because: str = ""
    cause: str = ""


class Rubric:
    """The rows of a rubric in its order, with their defaults."""

    def __init__(self, name: str) -> None:
        with (RUBRICS / name / "rubric.toml").open("rb") as file:
            rubric = tomllib.load(file)
        solution = RUBRICS / name / rubric["reference"]
        solution = solution / rubric["urdf"] if solution.is_dir() else solution
        self.reference = Robot(solution.read_bytes()) if solution.suffix == ".urdf" else None
        self.defaults = rubric.get("defaults", {}).get("with", {})
        self._posed: dict[tuple[tuple[str, float], ...], Posed] = {}
        self.rows = [row for row in rubric["criterion"] if row["check"] in FACTS]

    def arguments(self, row: dict[str, Any]) -> dict[str, Any]:
        """Return the arguments of a check, with the rubric's defaults."""
        found: dict[str, Any] = self.defaults.get(row["check"], {}) | row.get("with", {})
        return found

    def opinions(self, robot: Robot) -> dict[str, Opinion]:
        """Return an opinion on each criterion that a fact decides."""
        found: dict[str, Opinion] = {}
        self._posed = {}
        missed: dict[tuple[str, ...], str] = {}
        for row in self.rows:
            try:
                opinion = self._decide(robot, row, row.get("at", {}))
            except Missing as missing:
                first = missed.setdefault(missing.thing, row["id"])
                opinion = (
                    Opinion("failed") if first == row["id"] else Opinion("skipped", because=first)
                )
            found[row["id"]] = self._after_mistakes(robot, row, opinion, found)
            # A mistake may also explain a failure above it.
            for above in self.rows:
                if above["id"] != row["id"] and above["id"] in found and _is_from(above, row["id"]):
                    earlier = found[above["id"]]
                    found[above["id"]] = self._after_mistakes(robot, above, earlier, found)
        return found

    def _after_mistakes(
        self, robot: Robot, row: dict[str, Any], opinion: Opinion, found: dict[str, Opinion]
    ) -> Opinion:
        """Return an opinion as carried if what counts after one of the mistakes so far holds."""
        for carried in _carried_rows(row):
            if opinion.status not in ("failed", "skipped"):
                break
            known = [name for name in carried["from"] if name in found]
            mistakes = [found[name].because or name for name in known]
            reasons = (
                {opinion.because, found[opinion.because].cause}
                if opinion.because
                else set(mistakes)
            )
            causes = [
                name
                for name in mistakes
                if name in reasons and found[name].status in ("failed", "carried")
            ]
            if causes:
                opinion = self._carried(robot, row, carried, opinion, causes[0])
        return opinion

    def _at(self, robot: Robot, positions: dict[str, float]) -> Posed:
        key = tuple(positions.items())
        if key not in self._posed:
            self._posed[key] = Posed(robot, positions)
        return self._posed[key]

    def _carried(
        self,
        robot: Robot,
        row: dict[str, Any],
        carried: dict[str, Any],
        opinion: Opinion,
        cause: str,
    ) -> Opinion:
        try:
            other = self._decide(robot, carried, carried.get("at") or row.get("at", {}))
        except Missing:
            return opinion
        statuses = {"passed": "carried", "pending": "pending", "unsure": "unsure"}
        if other.status not in statuses:
            return opinion
        return opinion._replace(status=statuses[other.status], cause=cause)

    def _decide(self, robot: Robot, row: dict[str, Any], at: dict[str, float]) -> Opinion:
        try:
            positions = {}
            for name, position in at.items():
                joint = next(
                    (
                        joint
                        for joint in robot.joints
                        if joint.name == _resolved(robot, name, is_joint=True)
                    ),
                    None,
                )
                if joint is None or joint.type == "fixed":
                    raise Missing("joint", name)
                positions[joint.name] = position if joint.type == "prismatic" else radians(position)
            arguments = {key: _resolved(robot, value) for key, value in self.arguments(row).items()}
            if row["check"] == "kinematics_match_reference":
                arguments["reference"] = self.reference
            fine, measured = FACTS[row["check"]](self._at(robot, positions), **arguments)
        except Undecided:
            return Opinion("pending")
        except Unsure:
            return Opinion("unsure")
        return Opinion("passed" if fine else "failed", measured)


def _main_root(robot: Robot, selector: str) -> str:
    """Return the root of the largest tree."""
    sizes = sorted(map(len, robot.trees.values()))
    if sizes[-2:] == sizes[-1:] * 2:
        raise Missing("selector", selector)
    return max(robot.trees, key=lambda root: len(robot.trees[root]))


def _resolved(robot: Robot, value: Any, *, is_joint: bool = False) -> Any:
    """Return a value in which the names of places in the tree are names of links: `@root`, `@moved:2`."""
    if isinstance(value, list):
        return [_resolved(robot, item) for item in value]
    if not isinstance(value, str) or not value.startswith("@"):
        return value
    if value == "@root":
        return _main_root(robot, value)
    number = int(value.removeprefix("@moved:"))
    chains = {}
    for link in robot.trees[_main_root(robot, value)]:
        chain, name = [], link
        while name in robot.parents:
            joint = robot.parents[name]
            if joint.type != "fixed" and not joint.is_mimic:
                chain.append(joint)
            name = joint.parent
        chains[link] = chain[::-1]
    longest = max(map(len, chains.values()))
    if longest < number:
        raise Missing("selector", value)
    ends = {
        chain[number - 1].name: chain[number - 1]
        for chain in chains.values()
        if len(chain) == longest
    }
    if len(ends) > 1:
        raise Undecided(value)
    joint = next(iter(ends.values()))
    return joint.name if is_joint else joint.child


def _carried_rows(row: dict[str, Any]) -> list[dict[str, Any]]:
    given = row.get("carried", [])
    return [given] if isinstance(given, dict) else given


def _is_from(row: dict[str, Any], name: str) -> bool:
    return any(name in carried["from"] for carried in _carried_rows(row))
