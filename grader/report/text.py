"""Text from a submission, made harmless for a terminal and for the log of a CI job."""

import re

# The runner of GitHub Actions takes a line for a command that begins with `::`, whatever space is before it, or that holds
# `##[` anywhere.
_LINE_COMMAND = re.compile(r"^(\s*):(?=:)", re.MULTILINE)


def printable(text: str) -> str:
    """The text with everything spelt out that is no visible character or plain space.

    That is controls and escapes, bidirectional marks, odd spaces, and bytes that are no UTF-8. A tab becomes a space.
    """
    if text.isprintable():
        return text
    return "".join(each if each.isprintable() else _spelt(each) for each in text)


def without_commands(text: str) -> str:
    """The text with a space put in wherever a CI system's runner would take a line of its log for a command."""
    return _LINE_COMMAND.sub(r"\1: ", text).replace("##[", "## [")


def _spelt(character: str) -> str:
    if character == "\t":
        return " "
    code = ord(character)
    if 0xDC80 <= code <= 0xDCFF:  # a byte that could not be decoded
        return f"\\x{code - 0xDC00:02x}"
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}"
