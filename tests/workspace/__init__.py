"""Tests of the names that files of a workspace define and use."""
