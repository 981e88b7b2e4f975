"""Hints: edits of a submission that are searched for and tried, and shown only if they prove right.

Begin with `generators.py`, which lists what is tried, and `search.py`, which grades it. A `Piece`
is what one mistake needs, a `Proposal` one way to write it into the files, a `FoundHint` what
grading proves.
"""
