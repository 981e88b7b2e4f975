"""Word and PDF files are converted in this process; tests/checks/test_converter.py tests the processes."""

import pytest

from tests.conversion import convert_here


@pytest.fixture(autouse=True)
def _convert_here(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("grader.lab.documents.collection.DocumentCollection._run", convert_here)
