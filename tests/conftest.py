"""What holds for all tests: a machine under load is no failure, Ctrl-C is heard wherever they are run, and a CI job is no job of theirs."""

import os
import signal

from hypothesis import settings

settings.register_profile("patient", settings(), deadline=None)  # examples have no time limit of their own
settings.load_profile("patient")

# A shell that runs a command behind `&` has it ignore Ctrl-C, and so would the commands that the tests start and interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# On a CI system the grader annotates, and takes the checkout for the repository: tests that want it so say so.
for name in [each for each in os.environ if each in ("CI", "CI_PROJECT_DIR") or each.startswith("GITHUB_")]:
    del os.environ[name]
