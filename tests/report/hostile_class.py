"""A class whose students write markup, formulas and commands wherever they can, graded and exported as pages."""

from pathlib import Path
from xml.sax.saxutils import quoteattr

from tests.classroom.gradebooks import grader
from tests.samples import ROOT

LIDAR = (ROOT / "submissions/lab6/lidar-buried/my_robot/urdf/my_robot.urdf").read_text(encoding="utf-8")
CORPUS = (
    "<script>document.title='run'</script>",
    "<img src=x onerror=\"document.title='run'\">",
    "\"><svg onload=document.title='run'>",
    "</title></style></script><iframe src=javascript:alert(1)>",
    "javascript:alert(1)//{{7*7}}{% x %}",
    "=1+1 ##[error]y ::error::",
)


def file_name(text: str) -> str:
    """Return a text as the name of a folder."""
    return text.replace("/", "\u2215")


def export_hostile_class(top: Path) -> Path:
    """Grade a class with the corpus in names, ids, folders, files, robots, reasons and comments; return its pages."""
    rows = ["id,name"]
    for number, text in enumerate(CORPUS):
        folder = top / "class" / file_name(text)
        folder.mkdir(parents=True)
        name = quoteattr(text)
        urdf = LIDAR.replace('name="my_robot"', f"name={name}").replace('"white"', name)
        urdf = urdf.replace("</robot>", f"<!-- {text} --><link name={name}/></robot>" if number % 2 else "</robot>")
        (folder / file_name(f"{text}.urdf")).write_text(urdf, encoding="utf-8")
        rows.append(",".join('"' + value.replace('"', '""') + '"' for value in (file_name(text), text)))
    (top / "class" / file_name(f"z{CORPUS[1]}.zip")).write_bytes(b"no zip")
    (top / "roster.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")
    book = top / "book"
    done = grader("batch", top / "class", "--gradebook", book, "--roster", top / "roster.csv", "--jobs", "2")
    assert done.returncode == 0, done.stderr
    for text in CORPUS[:2]:
        done = grader("mark", file_name(text), "lidar-frame", "1", "--gradebook", book, "--comment", text, "--by", text)
        assert done.returncode == 0, done.stderr
    done = grader("export", "html", "--gradebook", book, "--output", top / "pages")
    assert done.returncode == 0, done.stderr
    return top / "pages"
