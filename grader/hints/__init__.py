"""Hints: edits of a submission that are searched for and tried, and shown only if they prove right."""
