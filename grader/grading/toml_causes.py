"""The common mistakes in TOML files, by what tomllib says and by the text around the place."""

import re
from typing import NamedTuple

OPEN_STRING = "Unterminated string|Expected \"'"

_SMART = "“”„‟‘’‚‛«»‹›"
_INVISIBLE = "\u00a0\u00ad\u2000-\u200f\u2028-\u202f\u205f\u2060\u3000\ufeff"
_END = r"\s*(?:#.*)?$"
_VALUE, _EQUALS, _NEWLINE = "Invalid value", "Expected '=' after a key", "Expected newline or end"
_LIST, _TABLE = "Unclosed array", "Unclosed inline table"
_KEY = r"(?P<word>[\w.\"'-]+)"


class Cause(NamedTuple):
    """A mistake: how the message of tomllib begins, the text before and after the place, and what to say of it.

    All but the last are regular expressions. In `message`, {key} is the key whose value is read, {start} the line on which that
    begins, {code} the number of the character at the place, {rest} the line from there on; other names are groups.
    """

    error: str
    before: str
    after: str
    message: str

    def match(self, error: str, before: str, after: str) -> dict[str, str] | None:
        """Return the named groups, None for another mistake."""
        found = [re.match(self.error, error), re.search(f"(?:{self.before})$", before), re.match(self.after, after)]
        groups = [match.groupdict() for match in found if match is not None]
        return {name: text for group in groups for name, text in group.items()} if len(groups) == len(found) else None


# fmt: off
CAUSES = (
    # Characters that an editor or a web page put there.
    Cause("", "", f"(?P<word>[{_SMART}])", "{word} is not a TOML quote: write straight quotes, \" or '"),
    Cause("Illegal", f"(?P<word>[{_SMART}])\\s*", "$", "{word} does not close a string: write a straight quote, \" or '"),
    Cause("", "", f"[{_INVISIBLE}]", "there is an invisible character, {code}: delete it, and type a space if one belongs here"),
    Cause("", "", "\r", "a line ends in a carriage return only: save the file with the line endings of Linux or Windows"),
    Cause("", "", "\0", "there is a null byte: save the file as UTF-8 text"),
    Cause("", "", r"[\x01-\x08\x0b-\x1f\x7f]", "there is a control character, {code}: delete it"),
    Cause("", "", r"<{7}|={7}|>{7}|\|{7}", "this is a git merge conflict marker: keep one of the two versions and remove the markers"),
    Cause("", "", r"//|/\*|--|;\s*\w", "a comment begins with #"),
    # Strings.
    Cause(OPEN_STRING, "", "\"\"\"|'''", "the string that begins here has no end: close it with three quotes"),
    Cause(f"Illegal|Found invalid|{OPEN_STRING}", "", "", 'the string has no closing quote on its line: add it, or put a long string between """ and """'),
    Cause("Unescaped", "^", "", 'a string over several lines must begin and end with """'),
    Cause("Unescaped|Invalid hex", "", "", "a backslash begins an escape such as \\n: write paths with /, or the string in single quotes"),
    Cause(_NEWLINE, r'=\s*""', r"[^\s#\"]", 'a long string must begin with three quotes, """'),
    Cause(_NEWLINE, r'""".*', r"[^\s#]", 'there is text after """: does a string above lack its closing """?'),
    Cause(_NEWLINE, '"', r"[^\s#].*\"", 'there is a quote inside the string: write it as \\", or the string in single quotes'),
    Cause(_NEWLINE, "'", r"[^\s#].*'", "there is a quote inside the string: write the string in double quotes"),
    # Values.
    Cause(_VALUE, r"=\s*", _END, "{key} has no value"),
    Cause(_VALUE, r"(?:^|\[|,)\s*", "$", "the list that begins on line {start} has no closing ]"),
    Cause(_VALUE, r"[\[,{=]\s*", r"(?P<word>[,\]}])", "there is no value before {word}"),
    Cause(_VALUE, r"=\s*", "=", "write = only once"),
    Cause(_VALUE, "", r"(?P<word>[Tt][Rr][Uu][Ee]|[Yy]es|[Oo]n)\b", "write true instead of {word}"),
    Cause(_VALUE, "", r"(?P<word>[Ff][Aa][Ll][Ss][Ee]|[Nn]o|[Oo]ff)\b", "write false instead of {word}"),
    Cause(_VALUE, "", r"(?P<word>None|null|nil|undefined)\b", "TOML has no {word}: remove the key"),
    Cause(_VALUE, "", r"[-+]?\.\d", "a number needs a digit before the point, such as 0.5"),
    Cause(_VALUE, "", r"\(", "write a list in square brackets, such as [0, 1]"),
    Cause(_VALUE, "", r"[-+]?(?:math\.|np\.)?pi\b", "TOML has no expressions: write the result"),
    Cause(_VALUE, "", r"[^\s\"'#,\]}][^\"'#,\]}]*[\"']\s*(?:[,\]}#]|$)", "the string has no opening quote"),
    Cause(_VALUE, r"=\s*", r"[\w.-]+\s*=", "write a table in braces, such as {{ key = 1 }}"),
    Cause(_VALUE, "", r"(?P<word>[^\W\d][^,\]}#\"']*?)\s*(?:[,\]}#]|$)", 'a string needs quotes: write "{word}"'),
    Cause(_VALUE, "", "`", "a string needs straight quotes, \" or '"),
    Cause(_VALUE, "", "", "this is not a TOML value: {rest}"),
    Cause(_NEWLINE, r"=\s*[-+]?\d+", r",\d", "write a decimal point instead of a comma, such as 0.5"),
    Cause(_NEWLINE, r"\d{4}-\d\d-\d\d\s*|=\s*\d{4}|\d\.\d+", r"[-T.]?\d", "write a date and time as 2026-11-20T23:59:00+01:00"),
    Cause(_NEWLINE, r"=\s*[-+]?0", r"\d", "a number must not begin with 0"),
    Cause(_NEWLINE, r"\d", r"\.(?!\d)", "a number needs a digit after the point, such as 5.0"),
    Cause(_NEWLINE, "", r"[-+*/]", "TOML has no expressions: write the result"),
    Cause(_NEWLINE, r"\d\s*", r"(?:[^\W\d]+|[%°])" + _END, "a number must not have a unit: write the number alone"),
    # Keys and headers.
    Cause(_EQUALS, "", r"\s*:", "write = instead of :"),
    Cause(_EQUALS, "", r"\s*\]", "the header of a table needs brackets on both sides, such as [[criterion]]"),
    Cause(_EQUALS, "", r"[^\x00-\x7f]", "a key may contain only the letters a to z, digits, _ and -: put any other key in quotes"),
    Cause(_EQUALS, r"(?P<word>\S+)\s*", r"\w[\w -]*=", "a key must be one word: there is a space after {word}"),
    Cause(_EQUALS, r"(?P<word>[^\s{,]+)\s*", _END, "{word} has no = and no value"),
    Cause(_EQUALS, r"(?P<word>[^\s{,]+)\s*", "", "a = is missing after {word}"),
    Cause("Invalid statement", "", "=", "there is no key before ="),
    Cause("Invalid statement", "", "", "a line must be a key with = and a value, or the header of a table in brackets: {rest}"),
    Cause("Expected '\\]", "", "", "the header of a table must be one name in brackets on both sides, such as [[criterion]]"),
    Cause("Invalid initial", r"\[\s*", r"\s*\[", "write [[ and ]] without a space between the brackets"),
    Cause(_NEWLINE, "", r"[,;]" + _END, "a line must not end in a comma or semicolon: remove it"),
    Cause(_NEWLINE, "", r"[\]}]", "there is no opening bracket for this one: remove it"),
    Cause(_NEWLINE, "", _KEY + r"\s*=", "write {word} on a line of its own"),
    Cause(_NEWLINE, "", "", "there is text after the end of the value: {rest}"),
    # Lists, and tables in braces.
    Cause(_LIST, "", r":|=", "a list must not contain keys: write a table in braces, such as {{ key = 1 }}"),
    Cause(_LIST, "", r"(?:[\w.-]+\s*=|\[\[?[A-Za-z_]|$)", "the list that begins on line {start} has no closing ]"),
    Cause(_LIST, "", r"(?P<word>\"[^\"]*\"|'[^']*'|[^\s,\]]+)", "a comma is missing before {word}"),
    Cause(f"{_TABLE}|Invalid initial", r"\{.*", _END, "a table in braces must be on one line: join the lines, or write it as a [table] after the other keys"),
    Cause("Invalid initial", r",\s*", r"\}", "remove the comma before }}"),
    Cause("Invalid initial", "", "", "there is no key here: {rest}"),
    Cause(_TABLE, "", _KEY + r"\s*=", "a comma is missing before {word}"),
    Cause(_TABLE, "", "", "the table in braces has no closing }}, or a comma is missing"),
    Cause("Duplicate inline table key '(?P<word>.*)'", "", "", "the table in braces has the key {word} twice"),
    Cause("Cannot", "", "", "the table in braces has a key twice: remove one of the two"),
)
# fmt: on
