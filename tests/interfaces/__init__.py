"""Tests of the readers of messages, services and actions."""
