"""A table as a spreadsheet of Excel, with the library of the extra `excel`."""

from collections.abc import Iterable, Sequence
from datetime import datetime
from io import BytesIO

from grader.base.errors import GraderError
from grader.classroom.tables import CellValue, spelt_out

SPREADSHEET = ".xlsx"
_CREATED = datetime(2000, 1, 1)  # noqa: DTZ001  so that equal grades give equal files


def write_spreadsheet(header: Sequence[str], rows: Iterable[Sequence[CellValue]]) -> bytes:
    """Return a table as a file of Excel: numbers are numbers, and no text is a formula or a link.

    Raises:
        GraderError: The library is not installed.
    """
    try:
        import xlsxwriter
    except ImportError:
        raise GraderError(
            "a file .xlsx needs XlsxWriter: pip install 'urdf-grader[excel]', or name a .csv file"
        ) from None
    data = BytesIO()
    book = xlsxwriter.Workbook(data, {"in_memory": True})  # grades are in no temporary file
    book.set_properties({"created": _CREATED})
    sheet = book.add_worksheet("grades")
    for at, row in enumerate([header, *rows]):
        for column, value in enumerate(row):
            if isinstance(value, str):
                sheet.write_string(at, column, spelt_out(value))
            elif value is not None:
                sheet.write_number(at, column, float(value))
    sheet.freeze_panes(1, 2)  # below the header, after id and name
    sheet.autofit()
    book.close()
    return data.getvalue()
