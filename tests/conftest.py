"""Settings of the property tests: a machine under load is no failure, so examples have no time limit of their own."""

from hypothesis import settings

settings.register_profile("patient", settings(), deadline=None)
settings.load_profile("patient")
