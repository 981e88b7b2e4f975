"""The extension for VS Code: its manifest agrees with its code and with the grader, and its package holds what it needs."""

import json
import os
import re
import subprocess
import zipfile
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest

from grader import __version__
from grader.app.cli.lsp import lsp
from grader.app.editor.logs import EXPLAIN
from tests.command_line import HANG_TIMEOUT, ROOT, run

pytestmark = pytest.mark.slow

EXTENSION = ROOT / "editors/vscode"
MANIFEST: dict[str, Any] = json.loads((EXTENSION / "package.json").read_text(encoding="utf-8"))
LOCK: dict[str, Any] = json.loads((EXTENSION / "package-lock.json").read_text(encoding="utf-8"))
CODE = (EXTENSION / "src/extension.ts").read_text(encoding="utf-8")
PACKED = os.environ.get("VSIX")
NEEDS_PACKAGE = pytest.mark.skipif(PACKED is None, reason="VSIX is not the packed extension")
INSTALLATION = "pip install 'urdf-grader[editor]'"
BROWSER = "workbench.action.browser.open"


def endings() -> set[str]:
    """Return the endings of the files whose text the server gets."""
    [found] = re.findall(r'ENDINGS = "([\w,]+)"', CODE)
    return {f".{ending}" for ending in found.split(",")}


def test_versions() -> None:
    """The extension has the version of the grader; packages are pinned, and types are those of the oldest VS Code."""
    assert MANIFEST["version"] == __version__ == LOCK["version"] == LOCK["packages"][""]["version"]
    pinned = {**MANIFEST["dependencies"], **MANIFEST["devDependencies"]}
    assert all(re.fullmatch(r"\d+\.\d+\.\d+", version) for version in pinned.values())
    assert {name: LOCK["packages"][f"node_modules/{name}"]["version"] for name in pinned} == pinned
    assert MANIFEST["engines"]["vscode"] == f"^{pinned['@types/vscode']}"
    assert not any("resolved" in package for package in LOCK["packages"].values())


def test_the_code_stays_small() -> None:
    """It starts a server, and has no logic of its own."""
    lines = sum(len(path.read_text().splitlines()) for path in (EXTENSION / "src").iterdir())
    assert lines <= 170


def test_commands_and_settings() -> None:
    """Each command of the manifest is registered, and each setting is read; there are no others."""
    contributed = MANIFEST["contributes"]
    commands = {command["command"] for command in contributed["commands"]}
    assert commands == set(re.findall(r'registerCommand\("([\w.]+)"', CODE))
    assert {entry["command"] for entry in contributed["menus"]["editor/title"]} <= commands
    read = {f"grader.{name}" for name in re.findall(r'settingOf\("(\w+)"\)', CODE)}
    assert set(contributed["configuration"]["properties"]) == read
    assert contributed["configuration"]["properties"]["grader.command"]["scope"] != "resource"
    assert MANIFEST["capabilities"]["untrustedWorkspaces"]["supported"] is False


def test_languages() -> None:
    """The server gets the text of each file that has a language by the manifest, and of those that it reads besides."""
    languages = {
        each["id"]: set(each["extensions"]) for each in MANIFEST["contributes"]["languages"]
    }
    assert languages["xml"] == {".urdf", ".xacro", ".srdf", ".sdf", ".world", ".launch"}
    assert set.union(*languages.values()) <= endings()
    assert {".xml", ".yaml", ".yml", ".py", ".cpp", ".hpp", ".h"} <= endings()
    assert '"**/CMakeLists.txt"' in CODE


def test_it_starts_where_a_package_or_a_robot_is() -> None:
    """It does not start in a folder with other XML files."""
    patterns = ("**/package.xml", "**/*.urdf", "**/*.xacro")
    started = {f"workspaceContains:{pattern}" for pattern in patterns}
    assert {*MANIFEST["activationEvents"]} == started


def test_commands_of_the_grader() -> None:
    """The extension runs what there is, with options that there are, and installs what `grader lsp` asks for."""
    for command, option in (("lsp", "--rubric"), ("view", "--rubric"), ("view", "--no-browser")):
        assert f'"{command}"' in CODE and f'"{option}"' in CODE
        assert option in run((command, "--help")).stdout.decode()
    assert f'INSTALLATION = "{INSTALLATION}"' in CODE
    assert INSTALLATION in " ".join((lsp.__doc__ or "").split())
    assert INSTALLATION in (EXTENSION / "README.md").read_text(encoding="utf-8")


@pytest.mark.exhaustive
@NEEDS_PACKAGE
def test_the_package() -> None:
    """It has the code in one file, the licences of the packages in it, its own licence, an icon, and no sources."""
    with zipfile.ZipFile(Path(PACKED or "")) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    assert json.loads(files["extension/package.json"]) == MANIFEST
    assert f"extension/{Path(MANIFEST['main']).as_posix()}" in files
    assert files["extension/LICENSE.txt"] == (ROOT / "LICENSE").read_bytes()
    needed = {name for name, package in LOCK["packages"].items() if name and not package.get("dev")}
    licences = files["extension/dist/licences.txt"].decode()
    bundled = re.findall(r"(?m)^(?:@[\w-]+/)?[a-z][\w.-]+ \d+\.\d+\.\d+$", licences)
    assert len(bundled) >= 5
    versions = {
        f"{name.rpartition('node_modules/')[2]} {LOCK['packages'][name]['version']}"
        for name in needed
    }
    assert {*bundled} <= versions
    icon = files[f"extension/{MANIFEST['icon']}"]
    assert (icon[:4], icon[16:24]) == (b"\x89PNG", b"\0\0\0\x80" * 2)
    assert len(files) == 8
    assert not any(
        re.search(r"/src/|\.ts$|\.map$|\.mjs$|package-lock|tsconfig|node_modules", file)
        for file in files
    )
    tree = ET.fromstring(files["extension.vsixmanifest"])
    [identity] = [element for element in tree.iter() if element.tag.endswith("}Identity")]
    assert (identity.get("Version"), identity.get("Publisher")) == (
        __version__,
        MANIFEST["publisher"],
    )


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the code without the packages that it needs, in place of which Node gets stubs."""
    target = tmp_path_factory.mktemp("extension")
    compiler = EXTENSION / "node_modules/.bin/tsc"
    subprocess.run(
        [compiler, "--project", EXTENSION, "--outDir", target], check=True, timeout=HANG_TIMEOUT
    )
    return target / "extension.js"


def activate(compiled: Path, situation: dict[str, Any]) -> dict[str, Any]:
    """Return what the extension does, in Node with a stub of VS Code."""
    done = subprocess.run(
        ["node", Path(__file__).with_name("extension.js"), compiled, json.dumps(situation)],
        capture_output=True, check=True, timeout=HANG_TIMEOUT,
    )  # fmt: skip
    results: dict[str, Any] = json.loads(done.stdout)
    return results


def make_program(path: Path, says: str) -> Path:
    """Make a program that prints something and waits to be ended."""
    path.parent.mkdir(parents=True)
    path.write_text(f"#!/bin/sh\necho {says}\nexec sleep 60\n")
    path.chmod(0o755)
    return path


@pytest.mark.exhaustive
@NEEDS_PACKAGE
def test_which_grader_starts(compiled: Path, tmp_path: Path) -> None:
    """That of the setting, else of .venv, else beside the interpreter of the Python extension, else of the path."""
    python = make_program(tmp_path / "other/bin/grader", "").with_name("python")
    folder = {"folder": str(tmp_path)}
    chosen = {**folder, "interpreter": str(python)}
    assert activate(compiled, folder)["server"] == ["grader", "lsp"]
    assert activate(compiled, {})["server"] == ["grader", "lsp"]
    assert activate(compiled, chosen)["server"] == [str(python.with_name("grader")), "lsp"]
    own = make_program(tmp_path / ".venv/bin/grader", "")
    assert activate(compiled, chosen)["server"] == [str(own), "lsp"]
    for setting, program in (("env/grader", str(tmp_path / "env/grader")), ("grade2", "grade2")):
        settings = {"command": setting, "rubric": "lab6"}
        done = activate(compiled, {**chosen, "settings": settings})
        assert done["server"] == [program, "lsp", "--rubric", "lab6"]
        assert done["messages"] == []


@pytest.mark.exhaustive
@NEEDS_PACKAGE
def test_a_server_that_does_not_start(compiled: Path) -> None:
    """A message says how to install it; the command is typed in a terminal, and not run."""
    done = activate(compiled, {"fails": True})
    [message] = done["messages"]
    assert message.startswith("'grader lsp' does not start.") and message.endswith(INSTALLATION)
    assert done["typed"] == [[INSTALLATION, False]]


@pytest.mark.exhaustive
@NEEDS_PACKAGE
@pytest.mark.parametrize("commands", [[], [BROWSER]])
def test_the_robot_is_shown(compiled: Path, tmp_path: Path, commands: list[str]) -> None:
    """The page of the file in the editor is opened beside it, or else in the browser; of another file that of the folder."""
    program = tmp_path / ".venv/bin/grader"
    make_program(program, '"http://$1/$2/$3"')
    situation = {"folder": str(tmp_path), "run": "grader.view", "commands": commands}
    for file, shown in (("/a/b.xacro", "/a/b.xacro"), ("/a/b.py", tmp_path), (None, tmp_path)):
        done = activate(compiled, {**situation, "file": file})
        address = f"http://view/{shown}/--no-browser"
        beside = [[BROWSER, {"url": address, "openToSide": True}]]
        assert (done["beside"], done["opened"]) == ((beside, []) if commands else ([], [address]))


def test_the_command_for_outputs_is_that_of_the_server() -> None:
    """The extension asks the server with the command that it has."""
    assert f'"{EXPLAIN}"' in CODE


@pytest.mark.exhaustive
@NEEDS_PACKAGE
@pytest.mark.parametrize("source", ["selected", "copied", "written"])
def test_an_output_is_explained(compiled: Path, tmp_path: Path, source: str) -> None:
    """The text is that which is selected, else copied, else typed; the answers are in the output of the extension."""
    line = "/a/b.yaml:3 explains line 1 of the log: boom"
    situation = {"folder": str(tmp_path), "run": "grader.explainLog", "file": "/a/b.py"}
    done = activate(compiled, {**situation, source: "boom", "answers": [line]})
    assert done["beside"] == [[EXPLAIN, "boom"]]
    assert done["said"][-1] == line


@pytest.mark.exhaustive
@NEEDS_PACKAGE
def test_a_robot_that_cannot_be_shown(compiled: Path, tmp_path: Path) -> None:
    """Without a file, a message asks for one; what the grader says is shown."""
    [message] = activate(compiled, {"run": "grader.view"})["messages"]
    assert message == "Open a URDF or a folder first."
    program = make_program(tmp_path / "failing/grader", "")
    program.write_text("#!/bin/sh\necho 'grader: no robot' >&2\nexit 2\n")
    settings = {"command": str(program)}
    situation = {"folder": str(tmp_path), "run": "grader.view", "settings": settings}
    assert activate(compiled, situation)["messages"] == ["grader: no robot"]
