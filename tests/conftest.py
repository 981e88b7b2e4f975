"""What holds for all tests: a machine under load is no failure, and Ctrl-C is heard wherever they are run."""

import signal

from hypothesis import settings

settings.register_profile("patient", settings(), deadline=None)  # examples have no time limit of their own
settings.load_profile("patient")

# A shell that runs a command behind `&` has it ignore Ctrl-C, and so would the commands that the tests start and interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
