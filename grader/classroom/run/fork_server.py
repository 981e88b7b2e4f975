"""Loaded only by the fork server: keep it silent when a worker starts while the command ends."""

import sys

sys.excepthook = lambda *_: None  # the parent process reports what goes wrong in a worker
