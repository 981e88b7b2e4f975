"""Text that a student may write to attack a viewer of reports, and submissions full of it."""

import json
import os
from collections.abc import Mapping
from pathlib import Path
from xml.sax.saxutils import escape

from hypothesis import strategies as st

from tests.samples import ROOT

REFERENCE = ROOT / "submissions/lab6/reference"
PACKAGE = "roscourse_sim_ws/src/my_robot"

# Each is dangerous to some viewer of reports: texts by the viewer or the sign, those for pages as `attacks`.
HOSTILE: dict[str, list[str]] = json.loads(
    (Path(__file__).parent / "hostile.json").read_text(encoding="utf-8")
)
LONG = ("`" * 90, "\n" + "`" * 300 + "\n", "x" * 300, "e" * 5000)
PIECES = (*(text for name, texts in HOSTILE.items() if name != "attacks" for text in texts), *LONG)
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


SLOTS = (
    "robot",
    "link",
    "joint",
    "material",
    "comment",
    "file",
    "folder",
    "picture",
    "answer",
    "note",
)
UNASKED = (
    "robot",
    "material",
    "comment",
    "file",
    "folder",
    "note",
)  # text in these slots changes no mark
BREAKING = (
    "box",
    "raw",
    "package",
    "setup",
    "launch",
    "frame",
    "task",
)  # text in these slots may lose points
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
