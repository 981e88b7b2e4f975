"""Written answers are shown without the signs of Markdown, wherever a person reads them."""

from grader.report.details import written_lines


def test_signs_without_a_partner_take_linear_time() -> None:
    """A student can write the longest answer of nothing but openings."""
    for signs in (" *a", "*a*a ", "` a", "[a", "![a](", "[a](b", "> ", "#", "- "):
        assert written_lines("x" + signs * (32_000 // len(signs)))
