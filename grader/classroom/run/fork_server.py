"""Loaded only by the process that workers are forked from: one that starts while the command ends says so to nobody."""

import sys

sys.excepthook = lambda *_: None  # what goes wrong in a worker is told by the one that waits for it
