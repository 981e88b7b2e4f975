"""Submissions, and which of their files are graded."""
