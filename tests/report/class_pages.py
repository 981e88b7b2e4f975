"""Read the class's page back: its figures, its lists, its table of students."""

import json
from pathlib import Path
from typing import Any

from tests.report.readers import read_page


class ClassPageReader:
    """The class's page in a file, as a reader sees it."""

    def __init__(self, file: Path) -> None:
        self.root: Any = read_page(file.read_text(encoding="utf-8"))
        (data,) = self.root.xpath("//script[@id='data']")
        self.groups = json.loads(data.text)["groups"]

    def texts(self, path: str) -> list[str]:
        """Return the text of the elements at an XPath, without line breaks."""
        return [words(element) for element in self.root.xpath(path)]

    def table(self, name: str) -> list[dict[str, str]]:
        """Return the rows of a table by the names of its columns."""
        columns = self.root.xpath(f"//table[@id='{name}']/thead/tr/th/@data-column")
        rows = self.root.xpath(f"//table[@id='{name}']/tbody/tr")
        return [dict(zip(columns, map(words, row), strict=True)) for row in rows]

    def links(self) -> list[str]:
        """Return the addresses of the students' pages in the table of students."""
        return [str(link) for link in self.root.xpath("//table[@id='students']//th/a/@href")]

    def members(self, group: str) -> list[str]:
        """Return the names of the students in a group."""
        names = self.texts("//table[@id='students']/tbody/tr/th")
        return [names[number] for number in self.groups[group][2]] if group in self.groups else []


def words(element: Any) -> str:
    """Return the text of an element without line breaks."""
    return " ".join(str(element.text_content()).split())
