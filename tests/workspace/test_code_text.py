"""Code without its comments and texts, with all places as they were."""

import pytest

from grader.workspace.model.code_text import code_alone


@pytest.mark.parametrize(
    ("path", "text", "code"),
    [
        ("a.py", "a = 'b # c'  # 'd\ne", "a =\ne"),
        (
            "a.py",
            'def f():\n    """Say "x"\n\n    and y."""\n    return y',
            "def f():\n\n\n\n    return y",
        ),
        ("a.py", "a = '''b'c\\'d''' + e", "a =              + e"),
        ("a.py", "f'at {place:.2f}' + rf\"{x}\"", "f    {place:.2f}  + rf {x}"),
        ("a.py", "'open\na", "\na"),
        ("a.py", '"""open\na', "\n"),
        ("a.cpp", 'a("b // c"); // d\ne', "a(        );\ne"),
        ("a.hpp", "a /* b\n * c */ + 'd' /* e", "a\n        +"),
    ],
)
def test_code_is_left_where_it_is(path: str, text: str, code: str) -> None:
    """Comments and texts become blanks; what a text is filled with is code."""
    alone = code_alone(text, path)
    assert len(alone) == len(text)
    assert "\n".join(line.rstrip() for line in alone.split("\n")) == code
