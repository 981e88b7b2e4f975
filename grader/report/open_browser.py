"""Open an address that contains a secret in the user's browser."""

import webbrowser
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from html import escape
from pathlib import Path
from threading import Thread

from grader.base.errors import InputError
from grader.report.writing import save

_PRIVATE = 0o600


@contextmanager
def opened_in_browser(address: str, file: Path) -> Iterator[bool]:
    """Open an address while a block runs.

    Yields whether there is a browser that a window shows, and the file could be written.

    It opens a private file that leads to the address: all users of the machine see the arguments of
    a process. Some browsers cannot see the folder for temporary files.
    """
    page = f'<!DOCTYPE html><meta http-equiv="refresh" content="0; url={escape(address)}">\n'
    is_written = False
    if _has_window():
        with suppress(InputError):
            save(file, page, mode=_PRIVATE)
            is_written = True
    if not is_written:
        yield False
        return
    try:
        Thread(
            target=webbrowser.open, args=[file.resolve().as_uri()], daemon=True
        ).start()  # some wait for the page
        yield True
    finally:
        with suppress(OSError):
            file.unlink()


def _has_window() -> bool:
    """Return whether the browser is not one of the terminal.

    One of the terminal, such as w3m, would take the terminal away.
    """
    try:
        browser = webbrowser.get()
    except webbrowser.Error:
        return False
    return isinstance(browser, webbrowser.BackgroundBrowser) or not isinstance(
        browser, webbrowser.GenericBrowser
    )
