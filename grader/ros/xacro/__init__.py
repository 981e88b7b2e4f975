"""xacro text to expanded elements, each with the place that it came from, without running anything.

It imports `python`, `xml` and `files`. Begin with `expander.py`, which walks the elements, and
`scopes.py`, what names mean.
"""
