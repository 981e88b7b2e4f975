"""Text from a submission, made harmless for a terminal."""


def printable(text: str) -> str:
    """The text with everything spelt out that is no visible character or plain space.

    That is controls and escapes, bidirectional marks, odd spaces, and bytes that are no UTF-8. A tab becomes a space.
    """
    if text.isprintable():
        return text
    return "".join(each if each.isprintable() else _spelt(each) for each in text)


def _spelt(character: str) -> str:
    if character == "\t":
        return " "
    code = ord(character)
    if 0xDC80 <= code <= 0xDCFF:  # a byte that could not be decoded
        return f"\\x{code - 0xDC00:02x}"
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}"
