"""The symbols, styles and words of the statuses of criteria."""

# The symbol of each status, that for a terminal in another encoding, the style on a terminal, and
# the word.
_STATUSES = (
    ("passed", "\u2713", "+", "green", "Passed"),
    ("failed", "\u2717", "X", "bold red", "Failed"),
    ("skipped", "\u2212", "-", "yellow", "Skipped"),
    ("pending", "?", "?", "cyan", "Needs manual grading"),
    ("errored", "!", "!", "bold magenta", "Could not be graded"),
    ("adjusted", "=", "=", "blue", "Corrected after grading"),
    ("partial", "~", "~", "bold yellow", "Some points"),
)
SYMBOLS, ASCII_SYMBOLS, STYLES, STATUS_WORDS = (
    {row[0]: row[column] for row in _STATUSES} for column in range(1, 5)
)
