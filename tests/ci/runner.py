"""Run the steps of an action or a workflow as GitHub's runner does: with environment files, contexts and outputs."""

import os
import re
import subprocess
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from tests.command_line import HANG_TIMEOUT

Step = dict[str, Any]
_EXPRESSION = re.compile(r"\$\{\{\s*(.+?)\s*\}\}")
_KEPT = (
    "HOME",
    "PATH",
    "LANG",
    "TMPDIR",
    "PIP_NO_INDEX",
    "PIP_FIND_LINKS",
    "PIP_CONFIG_FILE",
    "GIT_CONFIG_GLOBAL",
)


def load(path: Path) -> dict[str, Any]:
    """Return a YAML file; `on`, which YAML reads as a boolean, stays text."""
    data = yaml.safe_load(path.read_text(encoding="utf-8"))
    assert isinstance(data, dict)
    return data


@dataclass
class Done:
    """The result of one step."""

    code: int
    stdout: str
    stderr: str


@dataclass
class Runner:
    """A job's machine: its workspace, its temporary folder, and the results of its steps so far."""

    workspace: Path
    temp: Path
    variables: dict[str, str] = field(default_factory=dict)
    contexts: dict[str, str] = field(default_factory=dict)
    actions: dict[str, Callable[["Runner", Mapping[str, str]], Done]] = field(default_factory=dict)
    done: list[tuple[str, Done]] = field(default_factory=list)
    summary: str = ""

    def job(self, steps: list[Step], variables: Mapping[str, str] = {}) -> int:
        """Run the steps of a job and return the exit code of the first that failed.

        Later ones run only with `always()`.
        """
        failed = 0
        for step in steps:
            if not self._is_due(step.get("if", "success()"), failed):
                continue
            done = self.step(step, variables)
            self.done.append((str(step.get("name", step.get("uses"))), done))
            failed = failed or done.code
        return failed

    def step(self, step: Step, variables: Mapping[str, str] = {}) -> Done:
        """Run one step, and read its outputs and its summary."""
        if "uses" in step:
            given = {key: self.value(str(value)) for key, value in step.get("with", {}).items()}
            return self.actions[step["uses"]](self, given)
        assert _EXPRESSION.search(step["run"]) is None, (
            "an expression in a script is how commands are injected"
        )
        files = {
            name: self.temp / f"_{name}"
            for name in ("GITHUB_OUTPUT", "GITHUB_STEP_SUMMARY", "GITHUB_ENV")
        }
        for file in files.values():
            file.write_text("")
        script = self.temp / "_script.sh"
        script.write_text(step["run"], encoding="utf-8")
        given = {key: self.value(str(value)) for key, value in step.get("env", {}).items()}
        options = (
            ["--noprofile", "--norc", "-e", "-o", "pipefail"]
            if step.get("shell") == "bash"
            else ["-e"]
        )
        ran = subprocess.run(
            ["bash", *options, str(script)],
            cwd=self.workspace,
            env={
                **self._environment(),
                **variables,
                **{key: str(file) for key, file in files.items()},
                **given,
            },
            capture_output=True,
            text=True,
            check=False,
            timeout=HANG_TIMEOUT,
        )
        self._take(step.get("id", ""), files)
        return Done(ran.returncode, ran.stdout, ran.stderr)

    def value(self, text: str) -> str:
        """Return a text with its expressions replaced by values of the contexts; unknown names are errors."""
        return _EXPRESSION.sub(lambda found: self._context(found[1]), text)

    def _context(self, name: str) -> str:
        if name.startswith("steps."):
            return self.contexts.get(name, "")
        about = {"runner.temp": str(self.temp), "runner.os": "Linux", "runner.arch": "X64"}
        return {**about, **self.contexts}[name]

    def _is_due(self, condition: str, failed: int) -> bool:
        terms = [term.strip() for term in condition.split("&&")]
        known = {"always()": True, "success()": not failed}
        bound = [known[term] if term in known else bool(self._context(term)) for term in terms]
        return all(bound) and (not failed or "always()" in terms)

    def _environment(self) -> dict[str, str]:
        kept = {name: os.environ[name] for name in _KEPT if name in os.environ}
        return {
            **kept,
            "CI": "true",
            "GITHUB_ACTIONS": "true",
            "GITHUB_WORKSPACE": str(self.workspace),
            "GITHUB_SERVER_URL": "https://github.com",
            "RUNNER_TEMP": str(self.temp),
            **self.variables,
        }

    def _take(self, identity: str, files: Mapping[str, Path]) -> None:
        for line in files["GITHUB_OUTPUT"].read_text(encoding="utf-8").splitlines():
            key, equals, value = line.partition("=")
            assert equals, f"no output: {line}"
            self.contexts[f"steps.{identity}.outputs.{key}"] = value
        self.summary += files["GITHUB_STEP_SUMMARY"].read_text(encoding="utf-8")


def composite(path: Path, only: str) -> Callable[[Runner, Mapping[str, str]], Done]:
    """Return the action in a folder as a callable for the runner: one of its steps, with its inputs and outputs."""

    def use(runner: Runner, given: Mapping[str, str]) -> Done:
        action = load(path / "action.yml")
        assert set(given) <= set(action["inputs"]), "an input that the action does not have"
        inner = Runner(runner.workspace, runner.temp, runner.variables)
        inner.contexts = {"github.action_path": str(path), "github.action_repository": ""}
        for name, about in action["inputs"].items():
            inner.contexts[f"inputs.{name}"] = given.get(name, about["default"])
        code = inner.job([step for step in action["runs"]["steps"] if step["name"] == only])
        runner.summary += inner.summary
        for name, about in action["outputs"].items():
            runner.contexts[f"steps.grade.outputs.{name}"] = inner.value(about["value"])
        outputs = "".join(done.stdout for _, done in inner.done)
        return Done(code, outputs, "".join(done.stderr for _, done in inner.done))

    return use
