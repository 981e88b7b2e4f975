"""Attribute values: decoded as TinyXML2 decodes them, and escaped for XML."""

import re

_ENTITIES = {b"quot;": b'"', b"amp;": b"&", b"apos;": b"'", b"lt;": b"<", b"gt;": b">"}
_REFERENCE = re.compile(rb"&(?:(quot;|amp;|apos;|lt;|gt;)|#)")
_DECIMAL, _HEXADECIMAL = b"0123456789", b"0123456789abcdefABCDEF"
_LAST_CODE_POINT, _FIVE_BYTES = 0x10FFFF, 0x200000
_ESCAPES = str.maketrans(
    {"&": "&amp;", "<": "&lt;", '"': "&quot;", "\t": "&#9;", "\n": "&#10;", "\r": "&#13;", "\v": "&#9;", "\f": "&#9;"}
)

# A bare & or an entity that XML does not define.
REFERENCE = re.compile(r"&(?!(?:amp|lt|gt|quot|apos|#[0-9]+|#x[0-9a-fA-F]+);)")
# Characters that XML 1.0 does not allow, not even as a reference; bytes that are not UTF-8 are surrogates here.
ILLEGAL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


def decode(raw: str) -> str:
    """Return an attribute's value as TinyXML2's StrPair::GetStr does, up to the first NUL."""
    if "\r" in raw or "\n" in raw:
        raw = re.sub("\r\n|\n\r|\r", "\n", raw)
    if "&" not in raw:
        return raw
    source = raw.encode("utf-8", "surrogateescape")
    references = _References(source)
    decoded = bytearray()
    read = 0
    while (found := _REFERENCE.search(source, read)) is not None:
        _copy(source, read, found.start(), decoded)
        piece, width = (_ENTITIES[found[1]], len(found[0])) if found[1] else references.at(found.start())
        decoded += piece
        read = found.start() + width
    _copy(source, read, len(source), decoded)
    return bytes(decoded).split(b"\0")[0].decode("utf-8", "surrogateescape")


def _copy(source: bytes, start: int, end: int, decoded: bytearray) -> None:
    """Append the text between two references.

    TinyXML2 decodes in place and skips an & that begins no reference without writing it: the byte that was there stays.
    """
    write = len(decoded)
    decoded += source[start:end]
    if write == start:
        return
    at = source.find(b"&", start, end)
    while at >= 0:
        decoded[write + at - start] = source[write + at - start]
        at = source.find(b"&", at + 1, end)


class _References:
    """The characters that each &# of a value refers to (`XMLUtil::GetCharacterRef`), asked from left to right.

    A numeric reference extends to the next semicolon, and its digits are read backwards from there.
    """

    def __init__(self, source: bytes) -> None:
        self._source = source
        self._semicolon = -1
        # The offset of the digits before the semicolon, and their value.
        self._hexadecimal: tuple[int, int] | None = None
        self._decimal: tuple[int, int] | None = None

    def at(self, offset: int) -> tuple[bytes, int]:
        """Return the bytes that the &# at this offset refers to, and how many bytes it takes itself."""
        source = self._source
        if len(source) == offset + 2:
            return b"", 1
        if self._semicolon < offset:
            found = source.find(b";", offset)
            self._semicolon = found if found >= 0 else len(source)
            self._hexadecimal = self._decimal = None
        if self._semicolon == len(source):
            return b"&", 1
        if source.startswith(b"x", offset + 2):
            self._hexadecimal = self._hexadecimal or self._number(_HEXADECIMAL, 16)
            first, code = self._hexadecimal
            complete = first > offset + 2 and source[first - 1 : first] == b"x"
        else:
            self._decimal = self._decimal or self._number(_DECIMAL, 10)
            first, code = self._decimal
            complete = first > offset + 1 and source[first - 1 : first] == b"#"
        return (_encode(code), self._semicolon + 1 - offset) if complete else (b"&", 1)

    def _number(self, digits: bytes, radix: int) -> tuple[int, int]:
        # TinyXML2 10 multiplies in 32 bits and adds in 64, so very long numbers overflow.
        first, code, factor = self._semicolon, 0, 1
        while first > 0 and self._source[first - 1] in digits:
            first -= 1
            code += factor * int(chr(self._source[first]), radix) % 2**32
            factor = factor * radix % 2**32
        return first, code


def _encode(code: int) -> bytes:
    """Return a code point as UTF-8, as TinyXML2 does for surrogates and beyond the last; nothing over four bytes."""
    if code <= _LAST_CODE_POINT:
        return chr(code).encode("utf-8", "surrogatepass")
    if code < _FIVE_BYTES:
        return bytes((0xF0 | code >> 18, 0x80 | code >> 12 & 0x3F, 0x80 | code >> 6 & 0x3F, 0x80 | code & 0x3F))
    return b""


def escape(value: str) -> str:
    """Return a value for double quotes in XML; characters that XML forbids are spelt out, so that names differ."""
    return ILLEGAL.sub(_spell, value.translate(_ESCAPES))


def _spell(match: re.Match[str]) -> str:
    code = ord(match[0])
    if 0xDC80 <= code <= 0xDCFF:
        return f"\\x{code - 0xDC00:02x}"
    return chr(0x2400 + code) if code < 0x20 else f"\\u{code:04x}"
