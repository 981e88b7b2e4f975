"""One mistake is one diagnostic, at the word."""

from itertools import combinations
from pathlib import Path

import pytest
from lsprotocol import types as lsp

from grader.app.editor.diagnostics import make_diagnostics
from grader.app.editor.session import EditorSession
from tests.command_line import ROOT

_TOPS = ("submissions", "rubrics", "tests/labs", "tests/corpus/given")
# Codes that are two mistakes, though their ranges overlap: both are of one tag or call.
_TWO_MISTAKES = (
    {"URDF065"},  # two numbers that <limit> lacks
    {"REF011"},  # a program and a topic of one node
    {"PKG014", "PKG015"},  # two entries that data_files lacks
    {"URDF064", "URDF072"},  # a joint without <limit> and without <axis>
    {"REF018", "URDF072"},  # a joint without <axis>, above a link without mass
)


def _diagnostics(root: Path) -> list[tuple[str, lsp.Diagnostic]]:
    shown = make_diagnostics(EditorSession(root).look(), root)
    return [(path, each) for path, of_file in shown.items() for each in of_file]


def _write(root: Path, files: dict[str, str]) -> Path:
    for path, text in files.items():
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        (root / path).write_text(text)
    return root.resolve()


def _overlap(one: lsp.Range, other: lsp.Range) -> bool:
    return (
        one.start.line == other.start.line
        and one.start.character < other.end.character
        and other.start.character < one.end.character
    )


def _workspaces(top: Path) -> list[Path]:
    """Return the outermost folders below one that have a package or a robot."""
    folders: list[Path] = []
    for path in sorted(top.rglob("*")):
        is_root = path.suffix in (".urdf", ".xacro") or path.name == "package.xml"
        if is_root and not any(path.is_relative_to(folder) for folder in folders):
            folders.append(path.parent)
    return folders


@pytest.mark.slow
@pytest.mark.parametrize("top", _TOPS)
def test_no_two_diagnostics_are_one_mistake(top: str) -> None:
    """No two have one cause, or overlap, in the samples, the labs and the files of the corpus."""
    for root in _workspaces(ROOT / top):
        look = EditorSession(root).look()
        shown = make_diagnostics(look, root)
        causes = {}
        for finding in look.findings:
            if finding.cause:
                causes[finding.message, finding.location.path] = finding.rule.id, finding.cause
        seen = []
        for path, rows in shown.items():
            seen += [causes[row.message, path] for row in rows if (row.message, path) in causes]
            for one, other in combinations(rows, 2):
                codes = {str(one.code), str(other.code)}
                assert not _overlap(one.range, other.range) or codes in _TWO_MISTAKES, (root, one)
        assert len(seen) == len(set(seen)), root


@pytest.mark.parametrize(
    ("body", "code", "word", "note"),
    [
        ('<link name="a"><visual><geometry>\n<cylinder radius="1" lenght="2"/></geometry></visual></link>',
         "URDF041", 'lenght="2"', "URDF091: "),
        ('<link name="a"><visual><geometry><box size="1 1 1"/>\n<origin xyz="0 0 1"/></geometry></visual></link>',
         "URDF090", '<origin xyz="0 0 1"/>', "URDF091: "),
        ('<!-- a -- b -->\n<link name="a"/><link name="b"/><joint name="c" type="continuous"><parent link="a"/><child link="b"/></joint>',
         "URDF009", "<!-- a -- b -->", "URDF095: "),
    ],
)  # fmt: skip
def test_the_other_problem_is_said_with_it(
    tmp_path: Path, body: str, code: str, word: str, note: str
) -> None:
    """The more serious one is shown, at the shorter word."""
    text = f'<robot name="r">\n{body}\n</robot>\n'
    [(_, shown)] = [
        row for row in _diagnostics(_write(tmp_path, {"r.urdf": text})) if row[1].code == code
    ]
    assert [each.message[: len(note)] for each in shown.related_information or ()] == [note]
    line = text.split("\n")[shown.range.start.line]
    at = line[shown.range.start.character : shown.range.end.character]
    assert at in word


def test_a_macro_that_is_called_twice_has_one_mistake(tmp_path: Path) -> None:
    text = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:macro name="wheel" params="side">
<joint name="${side}_joint" type="fixed"><parent link="base"/><child link="${side}_whel"/></joint>
<link name="${side}_wheel"/>
</xacro:macro>
<link name="base"/>
<xacro:wheel side="left"/><xacro:wheel side="right"/>
</robot>
"""
    rows = _diagnostics(_write(tmp_path, {"r.urdf.xacro": text}))
    [shown] = [row for _, row in rows if row.code == "URDF071"]
    notes = [each.message for each in shown.related_information or ()]
    assert any("'right_whel'" in note for note in notes)


def test_problems_of_one_cause_are_one_diagnostic(tmp_path: Path) -> None:
    """What a build does not install is said once, at the first file that is missing, with the places of the others."""
    root = ROOT / "submissions/diffdrive"
    joined = 0
    for folder in sorted(root.iterdir()):
        for _, shown in _diagnostics(folder) if folder.is_dir() else ():
            others = [
                each for each in shown.related_information or () if "installs no" in each.message
            ]
            joined += shown.code == "REF001" and bool(others)
    assert joined
