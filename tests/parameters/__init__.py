"""Tests of the parameters of well-known nodes."""
