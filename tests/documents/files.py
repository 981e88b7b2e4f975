"""Word and PDF files for tests: pages of lines, with pictures."""

import io
from collections.abc import Sequence
from typing import Any

import pytest

PICTURE = "[picture]"  # a line that stands for a picture


def pdf(*pages: Sequence[str], by_word: bool = False) -> bytes:
    """Return a PDF with a page for each list of lines; each word has a place of its own, as Google Docs writes it, or each line."""
    objects = [
        "<</Type/Catalog/Pages 2 0 R>>",
        "",
        "<</Type/Font/Subtype/Type1/BaseFont/Courier>>",
        _IMAGE,
    ]
    kids = []
    for lines in pages:
        resources = "/Font<</F1 3 0 R>>" + ("/XObject<</Im1 4 0 R>>" if PICTURE in lines else "")
        number = len(objects) + 1
        kids.append(f"{number} 0 R")
        objects.append(
            f"<</Type/Page/Parent 2 0 R/MediaBox[0 0 595 842]/Resources<<{resources}>>/Contents {number + 1} 0 R>>"
        )
        objects.append(_stream((_placed if by_word else _content)(lines)))
    objects[1] = f"<</Type/Pages/Kids[{' '.join(kids)}]/Count {len(kids)}>>"
    return _written(objects)


def docx(*paragraphs: str, row: Sequence[str] = ()) -> bytes:
    """Return a Word file of paragraphs followed by a table of one row.

    A paragraph `[picture]` is a picture, and one that begins with a form feed is on a new page.
    """
    document = pytest.importorskip("docx").Document()
    for text in paragraphs:
        run = document.add_paragraph().add_run()
        if text.startswith("\f"):
            _child(run, "w:lastRenderedPageBreak")
        if text == PICTURE:
            _child(run, "w:drawing")
        else:
            run.add_text(text.removeprefix("\f"))
    if row:
        table = document.add_table(rows=1, cols=len(row))
        for cell, text in zip(table.rows[0].cells, row, strict=True):
            cell.text = text
    data = io.BytesIO()
    document.save(data)
    return data.getvalue()


def _child(run: Any, name: str) -> None:
    from docx.oxml import OxmlElement

    run._r.append(OxmlElement(name))


_IMAGE = (
    "<</Type/XObject/Subtype/Image/Width 1/Height 1/ColorSpace/DeviceGray/BitsPerComponent 8/Length 1>>\n"
    "stream\n0\nendstream"
)


def _content(lines: Sequence[str]) -> str:
    shown = []
    for index, line in enumerate(lines):
        height = 800 - 16 * index
        text = line.replace("\\", "\\\\").replace("(", "\\(").replace(")", "\\)")
        is_picture = line == PICTURE
        shown.append(
            f"q 100 0 0 10 50 {height} cm /Im1 Do Q"
            if is_picture
            else f"BT /F1 12 Tf 50 {height} Td ({text}) Tj ET"
        )
    return "\n".join(shown)


def _placed(lines: Sequence[str]) -> str:
    """Return lines as Skia/PDF writes them: upside down, without spaces, with a text object and a place for each word."""
    shown = ["1 0 0 -1 0 842 cm"]
    for index, line in enumerate(lines):
        y, column = 40 + 16 * index, 0
        for word in line.split(" "):
            if line == PICTURE:
                shown.append(f"q 100 0 0 10 50 {y} cm /Im1 Do Q")
            elif word:
                place = f"{50 + 7.2 * column:.1f} {-y} Td <{word.encode('latin-1').hex()}> Tj"  # 12 points of Courier
                shown.append(f"BT /F1 12 Tf 1 0 0 -1 0 .48 Tm {place} ET")
            column += len(word) + 1
    return "\n".join(shown)


def _stream(content: str) -> str:
    return f"<</Length {len(content)}>>\nstream\n{content}\nendstream"


def _written(objects: Sequence[str]) -> bytes:
    """Return a PDF file of these objects, numbered from 1, with its table of offsets."""
    text, offsets = "%PDF-1.4\n", []
    for number, content in enumerate(objects, start=1):
        offsets.append(len(text))
        text += f"{number} 0 obj\n{content}\nendobj\n"
    table = "".join(f"{offset:010} 00000 n \n" for offset in offsets)
    size = len(objects) + 1
    end = f"xref\n0 {size}\n0000000000 65535 f \n{table}trailer\n<</Size {size}/Root 1 0 R>>\nstartxref\n{len(text)}\n%%EOF\n"
    return (text + end).encode("latin-1")
