"""Tables as spreadsheets: what Excel finds in the cells, read as XML."""

import builtins
from decimal import Decimal
from io import BytesIO
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET
from zipfile import ZipFile

import pytest

from grader.classroom.spreadsheet import write_spreadsheet
from grader.classroom.tables import CellValue
from tests.classroom.class_runs import grader
from tests.command_line import ROOT

pytestmark = pytest.mark.slow

_MAIN = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
SMALL = ROOT / "tests/corpus/class/small"


def cells_in(data: bytes) -> list[dict[str, str | float]]:
    """Return the cells of each row of a spreadsheet, by column; no cell may be a formula or link."""
    with ZipFile(BytesIO(data)) as opened:
        assert not [name for name in opened.namelist() if "sheet1.xml.rels" in name]
        sheet = ET.fromstring(opened.read("xl/worksheets/sheet1.xml"))
        strings = ET.fromstring(opened.read("xl/sharedStrings.xml"))
    assert sheet.find(f".//{_MAIN}f") is None
    texts = ["".join(text.itertext()) for text in strings.iter(f"{_MAIN}si")]
    rows = []
    for row in sheet.iter(f"{_MAIN}row"):
        cells: dict[str, str | float] = {}
        for cell in row:
            value = cell.findtext(f"{_MAIN}v", "")
            is_text = cell.get("t") == "s"
            cells[cell.attrib["r"].rstrip("0123456789")] = (
                texts[int(value)] if is_text else float(value)
            )
        rows.append(cells)
    return rows


def test_texts_are_texts_and_numbers_numbers() -> None:
    """No text is a formula, a link or a number; what Excel cannot hold is spelt out."""
    texts = ["=1+1", "0012", "http://a.example", "+1", "Öz, Ali", "a\x00b\ud800", "1e5", "{=A1}"]
    numbers: list[CellValue] = [Decimal("2.5"), 3, None, Decimal(0), Decimal("-1.1")]
    data = write_spreadsheet(["id", "=name"], [list[CellValue](texts), numbers])
    head, first, second = cells_in(data)
    assert head == {"A": "id", "B": "=name"}
    assert list(first.values()) == [*texts[:5], "a\\x00b\\xd800", *texts[6:]]
    assert second == {"A": 2.5, "B": 3, "D": 0, "E": -1.1}
    assert data == write_spreadsheet(["id", "=name"], [list[CellValue](texts), numbers])


def test_an_export_is_what_its_name_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file .xlsx has the cells of the CSV file; without the library the way that works is named."""
    book, sheet, table = (tmp_path / name for name in ("book", "grades.XLSX", "grades.csv"))
    batch = ("batch", SMALL / "class", "--gradebook", book, "--jobs", "1")
    done = grader(*batch, "--rubric", SMALL / "small.toml", "--roster", SMALL / "roster.csv")
    assert done.returncode == 0, done.stderr
    export = ("export", "csv", "--excel", "--gradebook", book, "--output")
    assert grader(*export, table).returncode == grader(*export, sheet).returncode == 0
    head, anna, *_ = cells_in(sheet.read_bytes())
    titles = table.read_text("utf-8-sig").splitlines()[0].split(",")
    assert [*head.values()] == titles
    row = {head[column]: value for column, value in anna.items()}
    assert (row["id"], row["grade"], row["box"]) == ("anna", 6, 2.5)
    for target, ending in (("csv", ".ods"), ("json", ".xlsx")):
        wrong = tmp_path / f"wrong{ending}"
        done = grader("export", target, "--gradebook", book, "--output", wrong)
        assert (done.returncode, wrong.exists()) == (2, False)
        assert f"cannot write {wrong}: export {target} writes " in done.stderr
    imported = builtins.__import__

    def without(name: str, *rest: Any) -> Any:
        if name == "xlsxwriter":
            raise ImportError
        return imported(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    before = sheet.read_bytes()
    done = grader(*export, sheet)
    assert (done.returncode, sheet.read_bytes()) == (2, before)
    assert "pip install 'urdf-grader[excel]', or name a .csv file" in done.stderr
