"""Text that a student may write to attack a viewer of reports, and submissions full of it."""

import os
from collections.abc import Mapping
from pathlib import Path
from xml.sax.saxutils import escape

from hypothesis import strategies as st

from tests.samples import ROOT

REFERENCE = ROOT / "submissions/lab6/reference"
PACKAGE = "roscourse_sim_ws/src/my_robot"

# Each is dangerous to some viewer of reports.
TERMINALS = (
    "[bold red]",
    "[/]",
    "[link=http://e.org]x[/link]",
    "\x1b[31m",
    "\x1b]8;;http://e.org\x07",
    "\x9b31m",
    "\0",
)
COMMANDS = ("::error::", "::error file=a.py,line=1::", "::stop-commands::x", "::add-mask::0", "##[error]", "##[", "::")
ESCAPES = ("%0A::error::", "%0D%0A", "%25", "%3A%3A", ":", ",line=9", ",title=x::", "\n::error::", "\r::error::x")
LINES = ("\r", "\n", "\r\n", "\x0b", "\x85", "\u2028", "\u2029", "\t", "  \n", "    x")
XML = ("</testcase>", "</failure>", "]]>", "<![CDATA[", "<!--", "-->", "&lt;", "&#10;", "&x;", "<x>", '"', "'", "<?x?>")
LINKS = ("](http://e.org)", "![x](http://e.org/y.png)", "[x]: http://e.org", "<http://e.org>", "javascript:alert(1)")
BARE = ("http://e.org", "https://e.org/x", "ftp://e.org", "www.e.org", "WWW.E.ORG", "mailto:a@e.org", "a@e.org")
BLOCKS = (
    "# h",
    "\n# h",
    "- x",
    "+ x",
    "1. x",
    "1) x",
    "> x",
    "===",
    "---",
    "| a | b |\n|---|---|",
    "|-|",
    "[ ] ",
    "~~~",
)
MARKS = ("`", "``", "```", "`````", "`" * 90, "\n" + "`" * 300 + "\n", "~~x~~", "***", "__x__", "_x_", "\\", "[^1]")
HTML = ("<script>alert(1)</script>", "<img src=x onerror=alert(1)>", "</details>", "<a href='javascript:x'>", "<b>")
MENTIONS = ("@octocat", "@org/team", "#123", "GH-123", "org/repo#1", "$math$", "$$", "$`x`$", ":tada:", "{{x}}", "${x}")
CELLS = ("=1+1", "=cmd|' /C calc'!A0", "+1", "-1", "@SUM(1)", ";", ",")
UNSEEN = ("\ud800", "\udfff", "\udc80", "\ufffe", "\uffff", "\ufeff", "\u202e", "\u2066", "\u200f", "\u200b", "\u2060")
ODD = ("\xad", "\u3000", "\xa0", "\ufffd", "x" * 300, " " * 60, "a\u0301" * 20, "\U0001f600", "\U000e0041", "e" * 5000)
PIECES = (
    *(*TERMINALS, *COMMANDS, *ESCAPES, *LINES, *XML, *LINKS, *BARE),
    *(*BLOCKS, *MARKS, *HTML, *MENTIONS, *CELLS, *UNSEEN, *ODD),
)
TEXT = st.lists(st.sampled_from(PIECES) | st.text(max_size=6), max_size=5).map("".join)


def name_of(text: str, ending: str = "") -> bytes:
    """Return a text as a file name: any bytes but the two that no name can contain."""
    data = text.encode("utf-8", "surrogatepass").replace(b"\0", b"\x01").replace(b"/", b"\\")
    return (data.strip(b".")[:120] or b"x") + ending.encode()


def attribute(text: str) -> str:
    """Return a text as the value of an attribute that keeps the file readable: ROS 2 accepts control characters, too."""
    spelt = {'"': "&quot;", "\n": "&#10;", "\r": "&#13;", "\t": "&#9;"}
    return f'"{escape(text.replace(chr(0), ""), spelt)}"'


def comment(text: str) -> str:
    """Return a text as a comment that it cannot end."""
    return f"<!-- {text.replace(chr(0), '').replace('--', '- -').replace('>', ' ')} -->"


SLOTS = ("robot", "link", "joint", "material", "comment", "file", "folder", "picture", "answer", "note")
UNASKED = ("robot", "material", "comment", "file", "folder", "note")  # text in these slots changes no mark
BREAKING = ("box", "raw", "package", "setup", "launch", "frame", "task")  # text in these slots may lose points
Texts = Mapping[str, str]


def write_submission(folder: Path, texts: Texts) -> None:
    """Write the reference solution with these texts in its slots; other slots have their normal text."""
    for file in REFERENCE.rglob("*"):
        if file.is_file() and file.name != "expected.toml":
            target = folder / file.relative_to(REFERENCE)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(_filled(file, texts))
    place = os.fsencode(folder)
    if "folder" in texts:
        place = os.path.join(place, name_of(texts["folder"]))
        os.makedirs(place, exist_ok=True)
    for slot, ending, data in (
        ("file", ".urdf", b"<robot name='other'><link name='a'/></robot>"),
        ("picture", " task 3 step 3 webcam.png", b"\x89PNG\r\n"),
        ("note", ".md", b"# nothing\n"),
    ):
        if slot in texts:
            with open(os.path.join(place, name_of(texts[slot], ending)), "wb") as out:
                out.write(data)


def _filled(file: Path, texts: Texts) -> bytes:
    text = file.read_text(encoding="utf-8") if file.suffix != ".png" else ""
    if file.suffix == ".urdf":
        text = urdf(text, texts)
    elif file.name == "answers.md" and "answer" in texts:
        text = text.replace("The robot is gone.", texts["answer"])
    elif file.name == "package.xml" and "package" in texts:
        text = text.replace("<name>my_robot<", f"<name>{attribute(texts['package'])[1:-1]}<")
    elif file.name == "setup.py" and "setup" in texts:
        text = text.replace("glob('urdf/*')", f"[{texts['setup']!a}]")
    elif file.suffix == ".py" and "launch" in texts:
        text = text.replace("'my_robot.urdf'", f"{texts['launch']!a}")
    elif file.suffix == ".rviz" and "frame" in texts:
        quoted = texts["frame"].replace("'", "''").replace("\n", " ")
        text = text.replace("Fixed Frame: base_footprint", f"Fixed Frame: '{quoted}'")
    return text.encode("utf-8", "surrogatepass") if file.suffix != ".png" else file.read_bytes()


def urdf(text: str, texts: Texts) -> str:
    """Return a URDF with the texts of its slots in it."""
    more = ""
    if "comment" in texts:
        more += comment(texts["comment"])
    if "material" in texts:
        more += f"<material name={attribute('m' + texts['material'])}><color rgba='0 0 0 1'/></material>"
    if "link" in texts:
        name, joint = attribute("l" + texts["link"]), attribute("j" + texts.get("joint", ""))
        more += f"<link name={name}/><joint name={joint} type='fixed'><parent link='base_link'/><child link={name}/></joint>"
    if "task" in texts:  # a joint without links, of an unknown type
        more += f"<joint name='x' type={attribute(texts['task'])}><parent link={attribute(texts['task'])}/></joint>"
    if "box" in texts:
        text = text.replace("0.6 0.4 0.2", attribute(texts["box"])[1:-1], 1)
    if "robot" in texts:
        text = text.replace('<robot name="my_robot"', f"<robot name={attribute(texts['robot'])}", 1)
    return text.replace("</robot>", f"{more}{texts.get('raw', '')}</robot>")
